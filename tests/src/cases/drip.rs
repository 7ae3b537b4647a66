//! `shaders/wgsl/sim/drip.wgsl` against `downpour_sim::drips`.

use std::sync::Arc;

use downpour_drop::air::Air;
use downpour_drop::fall_speed::{FallSpeedModel, TerminalSpeed};
use downpour_drop::splash::{FILM_M, SplashLaw};
use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_pcg4d, rng_unit};
use downpour_shaders::sim::drip::{DRIP, DRIP_FIND_KERNEL, DRIP_SPLASH_KERNEL};
use downpour_shaders::sim::field::{FIELD_DRIPPED, FIELD_SPLASH};
use downpour_sim::drips::row::{DripClock, drip_begin, drip_fall, drip_hanging, drip_number, drip_rest};
use downpour_sim::drips::{DripOptions, DripPoint, DripRain, Drips, SetDrip};
use downpour_sim::field::{EyeDrop, FallingDrop};
use downpour_sim::gpu::{DripPipeline, DripSearch, FieldSearch};
use downpour_sim::impacts::SplashOptions;
use downpour_sim::shelter::Obstacles;
use downpour_sim::view::View;
use glam::{DVec3, Vec3};

use super::field::{
    Kind, Setting, crown_words, kind, listed_by, moving_words, paired, setting, steady, still,
};
use crate::Domain::{LogUniform, Made, Or, Uniform};
use crate::function::Run;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

/// A clock: of a rain that goes on, one that ends soon, or one that has ended.
fn clock(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let end = [1.0e30, 3.0 * a, -60.0 * a][(random[0] % 3) as usize];
    [0.01 + 20.0 * b, c, end, 60.0 + 40.0 * d].map(f32::to_bits).to_vec()
}

/// A clock and a number of drops, near the picture's time or, where the rain has ended, near that of the last ones.
fn numbered(random: [u32; 4]) -> Vec<u32> {
    let words = clock(random);
    let [per_s, part, end, drain] = [0, 1, 2, 3].map(|k: usize| f32::from_bits(words[k]));
    let at = rng_unit(random[1] ^ random[2]);
    let drops = if end < 0.0 { part + 1.0 - 1.2 * drain * per_s * at * at } else { 60.0 * at - 20.0 };
    [words, vec![drops.to_bits()]].concat()
}

/// A number of two words with a sign, most of them near a word's end.
fn number(random: [u32; 4]) -> Vec<u32> {
    let high = [0, 1, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, random[2]][(random[0] % 6) as usize];
    let low = [random[1] % 5, 0u32.wrapping_sub(random[1] % 5), (1 << 30) - 2 + random[1] % 5, random[3]];
    vec![high, low[(random[0] / 8 % 4) as usize]]
}

/// A small number with a sign.
fn near(random: [u32; 4]) -> Vec<u32> {
    vec![(random[0] % 4001).wrapping_sub(2000)]
}

fn clock_of(a: &mut Args<'_>) -> DripClock {
    let [per_s, part, end, drain] = a.f32s();
    DripClock { per_s, part, end, drain }
}

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let exact = Tol::exact("integers throughout");
    let [terminal, age] = [Or(&Uniform(0.1, 9.5), &[0.0]), Or(&Uniform(-0.1, 4.0), &[0.0])];
    vec![
        FunctionCase::new(
            "drip_reached",
            &DRIP,
            &[Made(clock), Uniform(-2.0, 4.0)],
            Tol::absolute(
                2.0e-3,
                "drops: an exponential (2^-21) of up to 2000 of them, and 20 a second for 64 s",
            ),
            |a| clock_of(a).drip_reached(a.f32()).words(),
        ),
        FunctionCase::new(
            "drip_time",
            &DRIP,
            &[Made(numbered)],
            Tol::relative(4.0e-6, 2.0e-4, "seconds: a logarithm (2^-21) times up to 100 s, and quotients"),
            |a| clock_of(a).drip_time(a.f32()).words(),
        ),
        FunctionCase::new("drip_begin", &DRIP, &[Made(number)], exact, |a| {
            (drip_begin(a.u32s()) as u32).words()
        }),
        FunctionCase::new("drip_number", &DRIP, &[Made(number), Made(near)], exact, |a| {
            drip_number(a.u32s(), a.u32() as i32).words()
        }),
        FunctionCase::new(
            "drip_rest",
            &DRIP,
            &[terminal, age],
            Tol::absolute(3.0e-5, "m and m/s: a logarithm and exponentials (2^-21) times up to 9.5"),
            |a| drip_rest(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "drip_fall",
            &DRIP,
            &[terminal, Uniform(-9.0, 9.0), Uniform(-9.0, 9.0), Uniform(-9.0, 9.0), age],
            Tol::absolute(4.0e-5, "m and m/s: as drip_rest, and a wind of up to 9 m/s times an exponential"),
            |a| {
                let (terminal, wind) = (a.f32(), Vec3::from(a.f32s()));
                drip_fall(terminal, wind, a.f32()).map(|v| v.to_array().words()).concat()
            },
        ),
        FunctionCase::new(
            "drip_hanging",
            &DRIP,
            &[LogUniform(1.0e-9, 3.0e-7), LogUniform(1.0e-9, 3.0e-7), Uniform(-0.1, 1.1)],
            Tol::absolute(1.0e-7, "m: a power of up to 7 mm, of a difference whose last digits count"),
            |a| drip_hanging(a.f32(), a.f32(), a.f32()).words(),
        ),
    ]
}

/// Points over the floor, of all rates from a drop in minutes to a jet; some set by hand.
fn points(origin: DVec3, wind: downpour_wind::UniformWind, end_s: f64, on_cpu: &Obstacles<'_>) -> Drips {
    let place = |k: u32| {
        let [x, y, z, size] = rng_pcg4d([k, 5, 7, 11]).map(|word| f64::from(rng_unit(word)));
        (origin + DVec3::new(9.0 * x - 4.5, 1.2 + 2.8 * y, 1.0 - 9.5 * z), size)
    };
    let found: Vec<DripPoint> = (0..1500)
        .map(|k| {
            let (position, size) = place(k);
            // At 60 mm/h 0.01 m^2 are some 5 drops a second.
            let catchment_m2 = if k % 50 == 0 {
                2.0
            } else if k == 7 {
                50.0
            } else {
                1.0e-4 + 0.02 * size * size
            };
            DripPoint {
                position,
                catchment_m2,
                flow_m: 3.0 * size,
                radius_m: (k % 3 == 0).then_some(1.0e-3 + 2.0e-3 * size),
            }
        })
        .collect();
    let set: Vec<SetDrip> = (2000..2200)
        .map(|k| {
            let (position, size) = place(k);
            SetDrip { position, per_s: 0.01 + 12.0 * size, diameter_m: 2.0e-3 + 3.0e-3 * size }
        })
        .collect();
    let rain = DripRain { rate_m_s: 60.0e-3 / 3600.0, begin_s: -3600.0, end_s, storage_m: 0.3e-3 };
    let speed = TerminalSpeed::new(FallSpeedModel::Beard1976, &Air::standard());
    let options = DripOptions { seed: 7, temperature_c: 10.0, wind, speed };
    Drips::new(on_cpu, &found, Some(&rain), &set, &options).expect("points")
}

/// Drops of points, and their crowns, as both sides list them: the CPU's first.
struct Listed {
    drops: [Vec<EyeDrop>; 2],
    crowns: [Vec<EyeDrop>; 2],
}

fn listed(gpu: &Gpu, kind: Kind, end_s: f64, pixel_angle: Option<f64>) -> Result<Listed, GpuError> {
    let Setting { field, view, scene, origin } = setting(kind);
    let view = View { pixel_angle: pixel_angle.unwrap_or(view.pixel_angle), ..view };
    let on_cpu = Obstacles { nodes: &scene.nodes, triangles: &scene.triangles, holes: None, origin };
    let drips = Arc::new(points(origin, (kind.wind)(), end_s, &on_cpu));
    let least_pixels = 0.3;
    let splashes = SplashOptions { law: SplashLaw::new(FILM_M, 20.0).expect("a law"), size: 1.5 };
    let of_drips = View { max_drops: 1 << 18, ..view };
    let on_device = DripPipeline::new(gpu)?.upload(&drips)?.expect("a steady wind");
    let of_search = DripSearch {
        drips: &on_device,
        view: &of_drips,
        least_pixels,
        time_s: kind.time_s,
        splashes: Some(&splashes),
    };
    let search = FieldSearch {
        view: &View { far: 3.0, ..view },
        time_s: kind.time_s,
        max_room: 1 << 20,
        pane: kind.pane,
        known: &[],
        drips: Some(of_search),
        splashes: None,
        bounce: None,
    };
    let (found, _) = listed_by(gpu, &field, (&scene, false, origin), &search)?;
    let dripped = |drop: &&EyeDrop| drop.speed.to_bits() == FIELD_DRIPPED.to_bits();
    let outside = |drop: FallingDrop| match kind.pane {
        Some([x, y, z, distance]) => drop.beyond(Vec3::new(x, y, z), distance, &view),
        None => Some(drop),
    };
    let expected = drips.visible(&on_cpu, &of_drips, least_pixels, kind.time_s).expect("in range");
    let crowns = drips.splashes(&on_cpu, &of_drips, kind.time_s, &splashes).expect("in range");
    let on_cpu = |all: Vec<FallingDrop>| -> Vec<EyeDrop> {
        all.into_iter().filter_map(outside).map(|drop| EyeDrop::new(&drop, view.eye)).collect()
    };
    Ok(Listed {
        drops: [on_cpu(expected), found.iter().filter(dripped).copied().collect()],
        crowns: [on_cpu(crowns), found.iter().filter(|drop| drop.speed <= FIELD_SPLASH).copied().collect()],
    })
}

/// Drops of points as both sides list them.
fn dripping_case(gpu: &Gpu, kind: Kind, end_s: f64) -> Result<Run, GpuError> {
    let [expected, found] = listed(gpu, kind, end_s, None)?.drops;
    assert!(expected.len() > 400, "{} drops", expected.len());
    let hang = expected.iter().filter(|drop| drop.velocity == [0.0; 3]).count();
    assert!((100..expected.len() - 100).contains(&hang), "{hang} of {} hang", expected.len());
    let finite = |time: f32| time.clamp(-9.0, 9.0);
    let words = |drop: &EyeDrop| moving_words(drop, finite);
    Ok(paired(&expected, &found, words))
}

/// Crowns of drops that have dripped, as both sides list them.
fn crowns_case(gpu: &Gpu, kind: Kind, end_s: f64) -> Result<Run, GpuError> {
    let [expected, found] = listed(gpu, kind, end_s, Some(2.0e-4))?.crowns;
    assert!(expected.len() > 60, "{} crowns", expected.len());
    Ok(paired(&expected, &found, crown_words))
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    let of = |name, wander: f64, run: fn(&Gpu) -> Result<Run, GpuError>| {
        let tol = Tol::absolute(wander, "meters, seconds and 20 m/s; drops at an edge of the picture");
        KernelCase::new(name, &DRIP_FIND_KERNEL, tol.with_outliers(2.0e-3), run)
    };
    const FOREVER: f64 = f64::INFINITY;
    let crowns = |name, wander: f64, run: fn(&Gpu) -> Result<Run, GpuError>| {
        let tol = Tol::absolute(wander, "meters and seconds; crowns at an edge, and as they begin and end");
        KernelCase::new(name, &DRIP_SPLASH_KERNEL, tol.with_outliers(6.0e-3), run)
    };
    vec![
        of("main_drip_find: steady wind", 2.0e-5, |gpu| {
            dripping_case(gpu, kind(steady, 7.125, 1.0 / 60.0), FOREVER)
        }),
        of("main_drip_find: still air, far away and late", 2.0e-5, |gpu| {
            dripping_case(gpu, Kind { far: true, ..kind(still, 987_654.321, 0.02) }, FOREVER)
        }),
        of("main_drip_find: before time 0, as the first drops leave", 2.0e-5, |gpu| {
            dripping_case(gpu, kind(steady, -3566.4, 1.0 / 60.0), FOREVER)
        }),
        // Times are logarithms, of which a device has 2^-21, times up to 100 s.
        of("main_drip_find: minutes after the rain, behind a pane", 5.0e-4, |gpu| {
            let pane = Some([0.0, 0.6, -0.8, 0.5]);
            dripping_case(gpu, Kind { pane, ..kind(steady, 3.3, 1.0 / 60.0) }, -300.0)
        }),
        of("main_drip_find: as the rain ends, a long exposure", 5.0e-4, |gpu| {
            dripping_case(gpu, kind(steady, 3.3, 0.25), 3.25)
        }),
        crowns("main_drip_splash: steady wind", 2.0e-5, |gpu| {
            crowns_case(gpu, kind(steady, 7.125, 1.0 / 60.0), FOREVER)
        }),
        crowns("main_drip_splash: still air, far away and late", 2.0e-5, |gpu| {
            crowns_case(gpu, Kind { far: true, ..kind(still, 987_654.321, 0.02) }, FOREVER)
        }),
        crowns("main_drip_splash: as the rain ends, behind a pane", 5.0e-4, |gpu| {
            let pane = Some([0.0, 0.6, -0.8, 0.5]);
            crowns_case(gpu, Kind { pane, ..kind(steady, 3.3, 1.0 / 60.0) }, 2.25)
        }),
    ]
}
