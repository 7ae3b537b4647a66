//! Rain in volumes that follow a camera: counted, uniform, and independent of the step length.

mod setting;

use downpour_bvh::Bvh;
use downpour_drop::air::Air;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
use downpour_math::ops::f64 as ops;
use downpour_sim::SimError;
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::simulation::{Bounce, Drag, Gauge, SimVolume, Simulation, SimulationOptions, StepInput};
use downpour_sim::view::View;
use glam::{DVec3, Vec3};
use setting::{looking, vortex};

fn rain(rate_mm_h: f64) -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h).expect("in range")
}

fn input<'a>(view: &'a View, wind: Vec3) -> StepInput<'a> {
    StepInput::new(view, DVec3::ZERO, wind)
}

/// A walk with pans of up to 360 degrees a second, dollies, and jumps.
fn walk(step: u32) -> View {
    let t = f64::from(step) / 60.0;
    let jump = f64::from(step / 20) * 1234.5;
    let eye = DVec3::new(3.0 * ops::sin(2.0 * t) + jump, 1.7 + ops::cos(3.0 * t), 5.0 * t);
    looking(eye, std::f64::consts::TAU * t, 0.4 * ops::sin(5.0 * t))
}

/// Chi-square per degree of freedom of counts that should be equal, in units of its standard deviation above 1.
fn excess(counts: &[u32]) -> f64 {
    let mean = counts.iter().map(|&n| f64::from(n)).sum::<f64>() / counts.len() as f64;
    assert!(mean > 20.0, "{mean} in a cell");
    let chi: f64 = counts.iter().map(|&n| (f64::from(n) - mean) * (f64::from(n) - mean) / mean).sum();
    let freedom = counts.len() as f64 - 1.0;
    (chi - freedom) / (2.0 * freedom).sqrt()
}

/// The same test rejects the paper's sampling.
#[test]
fn the_sampling_of_im_and_sung_is_not_uniform() {
    let view = looking(DVec3::new(0.0, 2.0, 0.0), 0.0, 0.0);
    let options =
        SimulationOptions { volume: SimVolume::ImSung, max_drops: 30_000, ..SimulationOptions::default() };
    let simulation = Simulation::new(&rain(25.0), &options, &input(&view, Vec3::ZERO)).expect("in range");
    let middle = view.eye + view.forward * 4.0;
    let near = simulation
        .drops()
        .iter()
        .filter(|drop| (Vec3::from(drop.position).as_dvec3() - middle).length() < 0.5)
        .count();
    // A radius uniform in (-r, r): an eighth of it holds an eighth of the drops of the sphere, and more of those in
    // view.
    assert!(near as f64 > 0.125 * simulation.drops().len() as f64, "{near}");
}

#[test]
fn a_box_stays_uniform_however_the_camera_moves() {
    let size = DVec3::new(8.0, 6.0, 8.0);
    let options = SimulationOptions {
        volume: SimVolume::Box { size_m: size.to_array() },
        max_drops: 60_000,
        ..SimulationOptions::default()
    };
    let wind = Vec3::new(-6.0, 0.0, 3.0);
    let mut simulation = Simulation::new(&rain(25.0), &options, &input(&walk(0), wind)).expect("in range");
    let all = simulation.drops().len();
    for step in 1..=90 {
        let view = walk(step);
        simulation.advance(1.0 / 60.0, &input(&view, wind)).expect("in range");
        if step % 15 == 0 {
            let center = view.eye + view.forward * size / 3.0;
            let mut counts = vec![0; 216];
            for drop in simulation.drops() {
                let fraction = (Vec3::from(drop.position).as_dvec3() - center) / size + 0.5;
                assert!(
                    (fraction.cmpge(DVec3::splat(-1.0e-4)) & fraction.cmple(DVec3::splat(1.0001))).all(),
                    "{fraction}"
                );
                let [x, y, z] = (fraction * 6.0).floor().clamp(DVec3::ZERO, DVec3::splat(5.0)).to_array();
                counts[x as usize * 36 + y as usize * 6 + z as usize] += 1;
            }
            let found = excess(&counts);
            assert!(found < 4.0, "step {step}: {found} standard deviations");
        }
    }
    assert_eq!(simulation.drops().len(), all);
}

/// Relative standard deviation of the rate of the drops of a volume: that of a sum over Poisson numbers.
fn scatter(rain: &DropSizeDistribution, volume: f64) -> f64 {
    let speed = |d: f64| terminal_speed(FallSpeedModel::Beard1976, d, &Air::standard()).expect("in range");
    let sum = |power: i32| -> f64 {
        let of = |k: u32| {
            let d = 0.1e-3 + 7.9e-3 * (f64::from(k) + 0.5) / 2000.0;
            rain.concentration(d) * ops::pow(d * d * d * speed(d), f64::from(power)) * 7.9e-3 / 2000.0
        };
        (0..2000).map(of).sum()
    };
    (sum(2) / volume).sqrt() / sum(1)
}

/// The rate through a plane is that of the drops in the volume, with wind too, and equals the requested one within the
/// statistical error.
#[test]
fn the_gauge_reads_what_was_asked_for() {
    let view = View { eye: DVec3::new(0.0, 10.0, 0.0), ..View::default() };
    // The center of the box is a third of it ahead of the eye.
    let size_m = if cfg!(debug_assertions) { [4.0, 4.0, 4.0] } else { [8.0, 6.0, 8.0] };
    let middle = view.eye + view.forward * size_m[2] / 3.0;
    let half = 0.49 * size_m[0];
    let gauge = Gauge {
        height_m: 10.1,
        low_m: [middle.x - half, middle.z - half],
        high_m: [middle.x + half, middle.z + half],
    };
    for rate in [5.0, 25.0, 100.0] {
        let options = SimulationOptions {
            volume: SimVolume::Box { size_m },
            max_drops: 400_000,
            gauge: Some(gauge),
            ..SimulationOptions::default()
        };
        let now = input(&view, Vec3::new(5.0, 0.0, -3.0));
        let mut simulation = Simulation::new(&rain(rate), &options, &now).expect("in range");
        let state = simulation.measured_rate_mm_h(None);
        let chance = scatter(&rain(rate), size_m.iter().product());
        assert!((state / rate - 1.0).abs() < 4.0 * chance, "{rate}: the drops make {state}, +- {chance}");
        let mut caught = downpour_sim::step::StepCaught::default();
        let steps = 300;
        for _ in 0..steps {
            let outcome = simulation.advance(10.0 / f64::from(steps), &now).expect("in range");
            caught.drops += outcome.caught.drops;
            caught.volume += outcome.caught.volume;
        }
        let found = gauge.rate_mm_h(&caught, 10.0);
        assert!(
            (found / state - 1.0).abs() < 0.02,
            "{rate}: {found} through the gauge, {state} in the volume, {} drops",
            caught.drops
        );
    }
}

/// In a vortex drops reach the same positions at 30, 60 and 240 steps a second; with the papers' average they do not.
#[test]
fn the_frame_rate_does_not_matter() {
    let field = vortex();
    let view = View { eye: DVec3::new(0.0, 0.0, 6.0), ..View::default() };
    let positions = |drag: Drag, per_second: u32| {
        let options = SimulationOptions {
            volume: SimVolume::Box { size_m: [30.0; 3] },
            max_drops: 2_000,
            drag,
            ..SimulationOptions::default()
        };
        let now = StepInput { field: Some(&field), ..input(&view, Vec3::ZERO) };
        let mut simulation = Simulation::new(&rain(10.0), &options, &now).expect("in range");
        for _ in 0..per_second / 2 {
            simulation.advance(1.0 / f64::from(per_second), &now).expect("in range");
        }
        simulation.drops().iter().map(|drop| Vec3::from(drop.position)).collect::<Vec<_>>()
    };
    // Drops that have passed a face did so some time later in one run than in the other.
    let median = |a: &[Vec3], b: &[Vec3]| {
        let mut apart: Vec<f32> = a.iter().zip(b).map(|(a, b)| (*a - *b).length()).collect();
        apart.sort_by(f32::total_cmp);
        [apart[apart.len() / 2], apart[apart.len() * 4 / 5]]
    };
    let fine = positions(Drag::Relaxation, 240);
    for per_second in [30, 60] {
        let [half, most] = median(&positions(Drag::Relaxation, per_second), &fine);
        assert!(half < 2.0e-3 && most < 2.0e-2, "{per_second}: {half} m, {most} m");
    }
    let [average, _] = median(&positions(Drag::Rousseau2008, 30), &positions(Drag::Rousseau2008, 240));
    let [half, _] = median(&positions(Drag::Relaxation, 30), &fine);
    println!("30 against 240 steps a second: {half} m, with the papers' average {average} m");
    assert!(average > 3.0 * half, "the papers' average: {average} m, relaxation: {half} m");
}

/// 10 km from the origin the drops of a view are the same as near it, with a moving origin.
#[test]
fn far_from_the_origin() {
    let run = |far: DVec3| {
        let options = SimulationOptions { max_drops: 5_000, ..SimulationOptions::default() };
        let at = |step: u32| {
            looking(far + DVec3::new(0.05, 0.01, 0.02) * f64::from(step), 0.01 * f64::from(step), 0.1)
        };
        let origin = |step: u32| if far == DVec3::ZERO { far } else { at(step).eye.round() };
        let first = at(0);
        let start = StepInput { origin: origin(0), ..input(&first, Vec3::X) };
        let mut simulation = Simulation::new(&rain(25.0), &options, &start).expect("in range");
        for step in 1..=60 {
            let view = at(step);
            let now = StepInput { origin: origin(step), ..input(&view, Vec3::X) };
            simulation.advance(1.0 / 60.0, &now).expect("in range");
        }
        let offset = origin(60) - far;
        simulation.drops().iter().map(|d| Vec3::from(d.position).as_dvec3() + offset).collect::<Vec<_>>()
    };
    let (near, far) = (run(DVec3::ZERO), run(DVec3::new(10_000.0, 0.0, -10_000.0)));
    let same = near.iter().zip(&far).filter(|(a, b)| a.distance(**b) < 1.0e-3).count();
    assert!(same as f64 > 0.99 * near.len() as f64, "{same} of {}", near.len());
}

/// Nearly all drops of a view are in the picture; few of a box are.
#[test]
fn drops_of_a_view_are_on_the_screen() {
    let fraction = |volume: SimVolume| {
        let options = SimulationOptions { volume, max_drops: 40_000, ..SimulationOptions::default() };
        let mut simulation =
            Simulation::new(&rain(25.0), &options, &input(&walk(0), Vec3::X)).expect("in range");
        let mut fractions = Vec::new();
        for step in 1..20 {
            let view = walk(step);
            simulation.advance(1.0 / 60.0, &input(&view, Vec3::X)).expect("in range");
            let seen = simulation.visible(&View { near: 1.0e-3, least_pixels: 0.0, ..view });
            fractions.push(seen.drops.len() as f64 / simulation.drops().len() as f64);
        }
        fractions.iter().sum::<f64>() / fractions.len() as f64
    };
    assert!(fraction(SimVolume::View) > 0.95);
    assert!(fraction(SimVolume::Box { size_m: [16.0; 3] }) < 0.3);
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("in range");
        pool.install(|| {
            let options = SimulationOptions { max_drops: 50_000, ..SimulationOptions::default() };
            let field = vortex();
            let now = walk(0);
            let start = StepInput { field: Some(&field), ..input(&now, Vec3::ZERO) };
            let mut simulation = Simulation::new(&rain(25.0), &options, &start).expect("in range");
            for step in 1..10 {
                let view = walk(step);
                simulation
                    .advance(1.0 / 60.0, &StepInput { field: Some(&field), ..input(&view, Vec3::ZERO) })
                    .expect("in range");
            }
            (simulation.drops().to_vec(), simulation.measured_rate_mm_h(None))
        })
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn what_is_out_of_range_is_refused() {
    let view = View::default();
    let now = input(&view, Vec3::ZERO);
    let made = |options: SimulationOptions| Simulation::new(&rain(10.0), &options, &now).map(|_| ());
    let of = |volume: SimVolume| SimulationOptions { volume, ..SimulationOptions::default() };
    for volume in [
        SimVolume::Box { size_m: [0.0, 4.0, 4.0] },
        SimVolume::Box { size_m: [f64::NAN, 4.0, 4.0] },
        SimVolume::Tariq { size_m: [4.0, 4.0, 1001.0] },
        SimVolume::Cylinder { base_m: [0.0; 3], radius_m: 0.0, height_m: 3.0 },
        SimVolume::Cylinder { base_m: [f64::INFINITY; 3], radius_m: 1.0, height_m: 3.0 },
    ] {
        let error = made(of(volume)).unwrap_err();
        assert!(error.to_string().contains("allowed"), "{error}");
    }
    assert!(made(SimulationOptions { max_drops: 0, ..SimulationOptions::default() }).is_err());
    assert!(made(SimulationOptions { max_drops: u32::MAX, ..SimulationOptions::default() }).is_err());
    let mut simulation =
        Simulation::new(&rain(10.0), &SimulationOptions { max_drops: 100, ..of(SimVolume::View) }, &now)
            .expect("in range");
    let before = simulation.drops().to_vec();
    for time in [0.0, -1.0, 10.0, f64::NAN, 1.0e-9] {
        let error = simulation.advance(time, &now).unwrap_err();
        assert_eq!(error.to_string(), format!("time of a step is {time} s; allowed: 1e-5 to 1"));
    }
    let lost = View { eye: DVec3::splat(f64::NAN), ..view };
    assert!(simulation.advance(0.01, &input(&lost, Vec3::ZERO)).is_err());
    assert_eq!(simulation.drops(), before);
}

/// Without rain there are no drops and no division by zero.
#[test]
fn dry() {
    let view = View::default();
    let now = input(&view, Vec3::ZERO);
    let mut simulation = Simulation::new(&rain(0.0), &SimulationOptions::default(), &now).expect("in range");
    simulation.advance(0.1, &now).expect("in range");
    assert_eq!((simulation.drops().len(), simulation.measured_rate_mm_h(None)), (0, 0.0));
}

/// Too many drops: the required memory, before anything is computed.
#[test]
fn too_many_drops_say_what_they_need() {
    let view = View::default();
    let options = SimulationOptions { max_drops: 1_000_000_000, ..SimulationOptions::default() };
    let error = Simulation::new(&rain(100.0), &options, &input(&view, Vec3::ZERO)).unwrap_err();
    assert!(matches!(error, SimError::Memory { .. }));
    assert!(
        error.to_string().starts_with("1000000000 drops need 31.7 GiB; allowed: up to 268435456"),
        "{error}"
    );
}

/// A floor at height 0, as a map of what stops drops.
fn floor() -> CollisionMap {
    let corner = |x: f32, z: f32| [12.0 * x, 0.0, 12.0 * z];
    let corners = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let triangles = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    let options = CollisionOptions { size: [20.0; 2], texels: [200; 2], ..CollisionOptions::default() };
    CollisionMap::new(&options, &Bvh::new(&triangles)).expect("a map")
}

/// Volumes, m^3, of the parts of a picture between heights, in which drops are on average during an exposure that fall at
/// `speed` and are within `range` of the eye in its middle.
fn bands<const N: usize>(view: &View, range: f64, speed: f64, heights: [[f64; 2]; N]) -> [f64; N] {
    let (cells, steps, times) = (40, 40, 6);
    let at = |k: u32, half: f64| half * (2.0 * (f64::from(k) + 0.5) / f64::from(cells) - 1.0);
    let farthest = range + 0.5 * speed * view.shutter_s;
    let area = 4.0 * view.half_width * view.half_height / f64::from(cells * cells);
    let mut volumes = [0.0; N];
    for k in 0..cells * cells {
        let across = view.right * at(k % cells, view.half_width) + view.up * at(k / cells, view.half_height);
        let (ray, length) = ((view.forward + across).normalize(), (view.forward + across).length());
        for step in 0..steps {
            let distance = farthest * (f64::from(step) + 0.5) / f64::from(steps);
            let offset = ray * distance;
            let volume =
                area / (length * length * length) * distance * distance * farthest / f64::from(steps);
            let band =
                heights.iter().position(|[low, high]| (*low..*high).contains(&(view.eye.y + offset.y)));
            let Some(band) = band else { continue };
            let in_range = (0..times).filter(|&time| {
                let time_s = view.shutter_s * ((f64::from(time) + 0.5) / f64::from(times) - 0.5);
                (offset + DVec3::Y * (speed * time_s)).length() < range
            });
            volumes[band] += volume * in_range.count() as f64 / f64::from(times);
        }
    }
    volumes
}

/// Drops that land while the shutter is open are listed until they do, and cover the picture down to the floor.
#[test]
fn drops_that_land_during_the_exposure_are_there_until_they_do() {
    let (map, shutter_s, wait_s) = (floor(), 0.075, 1.0 / 60.0);
    let view = View { shutter_s, ..looking(DVec3::new(0.0, 0.5, 0.0), 0.0, 0.0) };
    let options = SimulationOptions {
        shutter_s,
        wait_s,
        bounce: Bounce { fraction: 0.0, ..Bounce::default() },
        ..SimulationOptions::default()
    };
    let now = StepInput { map: Some(&map), ..input(&view, Vec3::ZERO) };
    let mut simulation = Simulation::new(&rain(50.0), &options, &now).expect("in range");
    let heights = [[0.0, 0.05], [0.05, 0.15], [0.15, 0.3], [0.3, 0.6], [0.6, 1.2]];
    let (mut covered, mut landed, states, times) = ([0.0; 5], [0; 2], 5, 16);
    let half = 0.5 * shutter_s;
    for _ in 0..states {
        for _ in 0..40 {
            simulation.advance(1.0 / 60.0, &now).expect("in range");
        }
        for drop in &simulation.visible_after(half + 0.5 * wait_s, &view, Some(&map), None).drops {
            let velocity = Vec3::from(drop.velocity).as_dvec3();
            let at = |time: f64| drop.position + velocity * (time - f64::from(drop.seen_s()));
            let lands = at(0.0).y / -velocity.y;
            let until = f64::from(drop.present_s[1]);
            if lands < half {
                assert!((until - lands).abs() < 1.0e-4, "{drop:?} lands after {lands} s");
                landed[usize::from(lands < 0.0)] += 1;
            } else {
                assert_eq!(until, f64::INFINITY, "{drop:?} lands after {lands} s");
            }
            for k in 0..times {
                let time = half * ((2.0 * f64::from(k) + 1.0) / f64::from(times) - 1.0);
                let (at, offset) = (at(time), at(time) - view.eye);
                let depth = offset.dot(view.forward);
                let is_seen = time < until
                    && offset.dot(view.right).abs() < depth * view.half_width
                    && offset.dot(view.up).abs() < depth * view.half_height;
                let band = heights.iter().position(|[low, high]| (*low..*high).contains(&at.y));
                if let (true, Some(band)) = (is_seen, band) {
                    covered[band] += 1.0 / f64::from(times);
                }
            }
        }
    }
    println!("{landed:?} land after the middle of the exposure, and before");
    assert!(landed[0] > 200 && landed[1] > 200, "{landed:?}");
    let (rain, air, sizes) = (rain(50.0), Air::standard(), 60);
    let mut expected = [0.0; 5];
    for k in 0..sizes {
        let d = 0.1e-3 + 7.9e-3 * (f64::from(k) + 0.5) / f64::from(sizes);
        let range = (d / (view.pixel_angle * view.least_pixels)).min(view.far);
        let speed = terminal_speed(FallSpeedModel::Beard1976, d, &air).expect("in range");
        let drops = rain.concentration(d) * 7.9e-3 / f64::from(sizes) * f64::from(states);
        for (sum, volume) in expected.iter_mut().zip(bands(&view, range, speed, heights)) {
            *sum += drops * volume;
        }
    }
    for ((found, expected), heights) in covered.iter().zip(expected).zip(heights) {
        println!("{heights:?} m: {found:.1} of {expected:.1} drops");
        assert!(expected > 100.0);
        assert!((found - expected).abs() < 4.0 * expected.sqrt(), "{heights:?} m: {found}, not {expected}");
    }
}
