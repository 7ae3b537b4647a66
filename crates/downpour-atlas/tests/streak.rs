//! Properties of streaks: energy, lines, symmetry, and effects of oscillation.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::{PI, TAU};

use downpour_atlas::{StreakOptions, StreakOscillation, StreakTracer, Streaks};
use downpour_drop::optics::deviation;
use downpour_math::ops::f64 as ops;

/// A drop of 0.2 mm is a sphere to a thousandth.
const SPHERE: f64 = 0.2e-3;

fn options() -> StreakOptions {
    StreakOptions { rows: 1, ..StreakOptions::default() }
}

fn trace(d: f64, oscillation: StreakOscillation, options: &StreakOptions, lights: &[[f64; 3]]) -> Streaks {
    StreakTracer::new(d, &oscillation, options).unwrap().trace(0.0, lights).unwrap()
}

/// Directions spread evenly over the sphere.
fn spiral(count: u32) -> Vec<[f64; 3]> {
    (0..count)
        .map(|k| {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
            let phi = TAU * 0.618_033_988_749_895 * f64::from(k);
            let r = (1.0 - z * z).sqrt();
            [r * ops::cos(phi), r * ops::sin(phi), z]
        })
        .collect()
}

/// A light at a scattering angle, `turn` radians above the horizontal.
fn light(scattering_deg: f64, turn: f64) -> [f64; 3] {
    let theta = scattering_deg.to_radians();
    [ops::sin(theta) * ops::cos(turn), ops::sin(theta) * ops::sin(turn), -ops::cos(theta)]
}

/// The integral of a streak over the picture, in squared radii: rows are the mean over half of the integral along y.
fn power(texels: &[f32], options: &StreakOptions) -> f64 {
    let width = 2.0 * options.half_extent / f64::from(options.columns);
    2.0 * width * texels.iter().map(|&v| f64::from(v)).sum::<f64>() / f64::from(options.rows)
}

/// Over all lights, a drop without absorption scatters the light that falls on its disk. Paths of more than four reflections
/// inside are missing: 0.1 %.
#[test]
fn all_lights_together_give_the_disk() {
    let options = StreakOptions { light_radius: 12.0_f64.to_radians(), rays: 6, ..options() };
    let lights = spiral(500);
    let streaks = trace(SPHERE, StreakOscillation::NONE, &options, &lights);
    let sum: f64 = streaks.radiance.iter().map(|s| power(s, &options)).sum();
    let scattered = sum * 4.0 * PI / lights.len() as f64;
    assert!((scattered / PI - 1.0).abs() < 0.015, "{scattered} of pi");
    let disk = power(&streaks.coverage, &options);
    assert!((disk / PI - 1.0).abs() < 5.0e-3, "{disk} of pi");
}

/// The same holds for a drop of any shape: the light on its outline's area is scattered.
#[test]
fn an_oscillating_drop_keeps_the_light_too() {
    let options = StreakOptions { light_radius: 12.0_f64.to_radians(), rays: 5, rows: 3, ..options() };
    let lights = spiral(500);
    let streaks = trace(4.0e-3, StreakOscillation::COMMITTED[1], &options, &lights);
    let sum: f64 = streaks.radiance.iter().map(|s| power(s, &options)).sum();
    let fraction = sum * 4.0 * PI / lights.len() as f64 / power(&streaks.coverage, &options);
    // Light that circles in the bulges for more than four reflections is lost.
    assert!((0.95..1.01).contains(&fraction), "{fraction}");
}

/// Scattering by a sphere to the side of the first rainbow is external reflection and twice refracted light: a law of
/// the impact parameter, summed over the light's width.
#[test]
fn the_power_of_one_direction_is_that_of_the_sphere() {
    // At 60 degrees only the outside reflection and p = 1 matter (p = 3 is below 1 %).
    let options = StreakOptions { rays: 12, ..options() };
    let index = options.refractive_index;
    let streaks = trace(SPHERE, StreakOscillation::NONE, &options, &[light(60.0, 0.4)]);
    let found = power(&streaks.radiance[0], &options);
    let fresnel = |b: f64| downpour_drop::optics::optics_fresnel_polarized((1.0 - b * b).sqrt(), index);
    // Cross-section per steradian: b db / (sin(theta) d theta), by differences.
    let of = |turn: &dyn Fn(f64) -> f64, fraction: &dyn Fn(f64) -> f64| -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        let falling = turn(0.0) > turn(1.0);
        for _ in 0..60 {
            let b = 0.5 * (low + high);
            if (turn(b) < 60.0_f64.to_radians()) == falling { high = b } else { low = b }
        }
        let b = low;
        let slope = (turn(b + 1.0e-5) - turn(b - 1.0e-5)) / 2.0e-5;
        b * fraction(b) / (ops::sin(turn(b)) * slope.abs())
    };
    let outside = of(&|b| PI - 2.0 * ops::asin(b), &|b| {
        let [s, p] = fresnel(b);
        0.5 * (s + p)
    });
    let through = of(&|b| deviation(b, index).unwrap(), &|b| {
        let [s, p] = fresnel(b);
        0.5 * ((1.0 - s) * (1.0 - s) + (1.0 - p) * (1.0 - p))
    });
    let law = outside + through;
    assert!((found / law - 1.0).abs() < 0.04, "{found} {law}");
}

/// The brightest line of light from behind is at the impact parameter at which the sphere deflects light by that angle, on the
/// other side.
#[test]
fn the_brightest_line_is_where_the_sphere_has_it() {
    let options = StreakOptions { columns: 64, rays: 4, ..options() };
    for degrees in [20.0f64, 30.0, 45.0] {
        let streaks = trace(SPHERE, StreakOscillation::NONE, &options, &[light(degrees, 0.0)]);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let b = 0.5 * (low + high);
            if deviation(b, options.refractive_index).unwrap() < degrees.to_radians() {
                low = b;
            } else {
                high = b;
            }
        }
        let brightest = |texels: &[f32]| {
            let best = (0..texels.len()).max_by(|&a, &b| texels[a].total_cmp(&texels[b])).unwrap();
            (best as f64 + 0.5) / 64.0 * 2.8 - 1.4
        };
        let at = brightest(&streaks.radiance[0]);
        assert!((at + low).abs() < 0.06, "{degrees} degrees: {at}, law {}", -low);
    }
}

#[test]
fn symmetric_light_makes_a_symmetric_streak() {
    let lights: Vec<_> = [0.0, 40.0, 90.0, 140.0].iter().map(|&a| light(a, 0.5 * PI)).collect();
    let still = trace(2.0e-3, StreakOscillation::NONE, &options(), &lights);
    for (k, texels) in still.radiance.iter().enumerate() {
        let most = texels.iter().copied().fold(0.0, f32::max);
        assert!(most > 1.0e-3, "light {k} is not seen");
        for (a, b) in texels.iter().zip(texels.iter().rev()) {
            assert!((a - b).abs() < 1.0e-4 * most, "light {k}: {a} {b}");
        }
    }
    // The control: with the lobes of mode (3,1) across it is not symmetric.
    let lobed = StreakOscillation { amplitudes: [0.0, 0.1], phase: 0.25, azimuth: 0.0 };
    let moved = trace(2.0e-3, lobed, &StreakOptions { rows: 4, ..options() }, &lights[1..2]);
    let row = &moved.radiance[0][..24];
    let most = row.iter().copied().fold(0.0, f32::max);
    assert!(row.iter().zip(row.iter().rev()).any(|(a, b)| (a - b).abs() > 0.05 * most));
}

/// Strength of the turns 0, 1, 2, ... of a row of numbers.
fn harmonics(values: &[f64]) -> Vec<f64> {
    let n = values.len() as f64;
    (0..6)
        .map(|turn| {
            let (mut c, mut s) = (0.0, 0.0);
            for (k, v) in values.iter().enumerate() {
                let angle = TAU * f64::from(turn) * k as f64 / n;
                c += v * ops::cos(angle) * 2.0 / n;
                s += v * ops::sin(angle) * 2.0 / n;
            }
            c.hypot_of(s)
        })
        .collect()
}

trait Hypot {
    fn hypot_of(self, other: f64) -> f64;
}

impl Hypot for f64 {
    fn hypot_of(self, other: f64) -> f64 {
        (self * self + other * other).sqrt()
    }
}

/// Left and right end of the coverage of each row, in radii. For an ellipse, coverage falls as a root at its end: the
/// square is a straight line there.
fn ends(streaks: &Streaks, options: &StreakOptions) -> Vec<[f64; 2]> {
    let width = 2.0 * options.half_extent / f64::from(options.columns);
    let end = |row: &mut dyn Iterator<Item = &f32>| -> f64 {
        // Fraction of columns without the drop, the first one with it in part.
        let mut columns = 0.0;
        for &v in row {
            if v > 0.0 {
                break;
            }
            columns += 1.0;
        }
        options.half_extent - columns * width
    };
    streaks
        .coverage
        .chunks(options.columns as usize)
        .map(|row| [end(&mut row.iter()), end(&mut row.iter().rev())])
        .collect()
}

#[test]
fn oscillation_moves_the_outline_with_the_modes_frequency() {
    let options = StreakOptions { columns: 128, rows: 32, rays: 1, ..StreakOptions::default() };
    let lights = [light(90.0, 0.0)];
    // Mode (2,0): the width swings once a turn, by -1/2 s2 of the radius.
    let even = StreakOscillation { amplitudes: [0.2, 0.0], phase: 0.0, azimuth: 0.0 };
    let ends_even = ends(&trace(1.0e-3, even, &options, &lights), &options);
    let width: Vec<f64> = ends_even.iter().map(|[l, r]| 0.5 * (l + r)).collect();
    let strength = harmonics(&width);
    assert!((strength[1] - 0.1).abs() < 0.02, "{strength:?}");
    assert!(strength[2..].iter().all(|&s| s < 0.2 * strength[1]), "{strength:?}");
    let narrowest = (0..32).min_by(|&a, &b| width[a].total_cmp(&width[b])).unwrap();
    assert!((5..12).contains(&narrowest), "narrow at a quarter of a turn, not at row {narrowest}");
    // Mode (3,1): it sways twice a turn, by 3/2 s3 at the height of its center.
    let odd = StreakOscillation { amplitudes: [0.0, 0.1], phase: 0.0, azimuth: 0.0 };
    let ends_odd = ends(&trace(1.0e-3, odd, &options, &lights), &options);
    let sway: Vec<f64> = ends_odd.iter().map(|[l, r]| 0.5 * (r - l)).collect();
    let strength = harmonics(&sway);
    assert!((strength[2] - 0.15).abs() < 0.03, "{strength:?}");
    assert!([1, 3, 4, 5].iter().all(|&k| strength[k] < 0.2 * strength[2]), "{strength:?}");
}

/// Any number of threads gives the same bits.
#[test]
fn threads_do_not_matter() {
    let options = StreakOptions { rows: 8, rays: 2, ..StreakOptions::default() };
    let lights = [light(60.0, 0.3), light(150.0, -0.3)];
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| trace(2.0e-3, StreakOscillation::COMMITTED[0], &options, &lights))
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn what_cannot_be_traced_is_an_error() {
    let new = |d, oscillation: StreakOscillation, options: StreakOptions| {
        StreakTracer::new(d, &oscillation, &options).map(|_| ()).unwrap_err().to_string()
    };
    let still = StreakOscillation::NONE;
    assert!(new(20.0e-3, still, options()).contains("20"));
    assert!(new(f64::NAN, still, options()).contains("NaN"));
    let wild = StreakOscillation { amplitudes: [0.5, 0.0], ..still };
    assert!(new(1.0e-3, wild, options()).contains("0 to 0.3"));
    let lost = StreakOscillation { azimuth: f64::INFINITY, ..still };
    assert!(new(1.0e-3, lost, options()).contains("azimuth"));
    assert!(new(1.0e-3, still, StreakOptions { columns: 7, ..options() }).contains("even"));
    assert!(new(1.0e-3, still, StreakOptions { rows: 0, ..options() }).contains("1 to 4096"));
    let tracer = StreakTracer::new(1.0e-3, &still, &options()).unwrap();
    assert!(tracer.trace(1.5, &[]).unwrap_err().to_string().contains("-80 to 80"));
}
