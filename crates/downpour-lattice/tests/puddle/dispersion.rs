//! Phase speeds of waves agree with the law.

use std::f64::consts::{PI, TAU};

use downpour_lattice::puddle::{Puddle, PuddleForm, PuddleOptions, PuddleWater, phase_speed};
use downpour_math::ops::f64 as ops;

use crate::{hill, membrane, set, undamped};

/// Phase speed of a standing wave with `half_waves` along the rows of a closed basin.
fn measured(options: &PuddleOptions, half_waves: u32, dt: f32) -> (f64, f64) {
    let mut puddle = Puddle::new(options).expect("a puddle");
    let nx = f64::from(options.size[0]);
    let mode = |x: usize| ops::cos(PI * f64::from(half_waves) * (x as f64 + 0.5) / nx);
    set(&mut puddle, |x, _| 1.0e-3 * mode(x));
    let mut series = Vec::new();
    for _ in 0..120 {
        let row = &puddle.heights()[..options.size[0] as usize];
        series.push(row.iter().enumerate().map(|(x, &h)| f64::from(h) * mode(x)).sum::<f64>());
        assert_eq!(puddle.step(dt).expect("a step"), 1);
    }
    // The recurrence of a sine: p(n + 1) + p(n - 1) = 2 cos(omega dt) p(n).
    let (mut above, mut below) = (0.0, 0.0);
    for w in series.windows(3).skip(1) {
        above += w[1] * (w[0] + w[2]);
        below += 2.0 * w[1] * w[1];
    }
    let omega = ops::acos(above / below) / f64::from(dt);
    let wavelength = 2.0 * nx * f64::from(options.cell_m) / f64::from(half_waves);
    (wavelength, omega * wavelength / TAU)
}

#[test]
fn thin_water_is_right_at_every_wavelength() {
    let water = PuddleWater::default();
    for depth_m in [1.0e-3, 2.0e-3, 5.0e-3] {
        let options = PuddleOptions { depth_m, ..undamped([256, 64]) };
        // 512 mm of half waves: 8, 10, 12.8, 17, 30, 51, 102 and 512 mm.
        for (half_waves, allowed) in [
            (128, 0.025),
            (102, 0.012),
            (80, 0.013),
            (60, 0.013),
            (34, 0.013),
            (20, 0.013),
            (10, 0.013),
            (2, 0.015),
        ] {
            for dt in [1.0e-3, 3.9e-3] {
                let (wavelength, speed) = measured(&options, half_waves, dt);
                let law = phase_speed(wavelength, f64::from(depth_m), &water);
                let error = speed / law - 1.0;
                assert!(
                    error.abs() < allowed,
                    "{depth_m} m, wave of {wavelength} m, dt {dt}: {speed}, law {law}"
                );
                let mut puddle = Puddle::new(&options).expect("a puddle");
                puddle.step(dt).expect("a step");
                let told = puddle.speed_error(wavelength);
                assert!((error - told).abs() < 1.0e-3, "{wavelength} m: {error}, told {told}");
            }
        }
    }
}

/// Deep water: the slowest wave is at 17 mm and has 0.231 m/s.
#[test]
fn deep_water_has_its_slowest_wave() {
    let options =
        PuddleOptions { depth_m: 1.0, cell_m: 1.5e-3, max_wave_m: Some(0.045), ..undamped([256, 64]) };
    let water = PuddleWater::default();
    let speeds: Vec<(f64, f64)> =
        [76, 64, 56, 50, 45, 40, 36, 30, 25, 20].iter().map(|&m| measured(&options, m, 1.5e-3)).collect();
    for &(wavelength, speed) in &speeds {
        let law = phase_speed(wavelength, 1.0, &water);
        assert!((speed / law - 1.0).abs() < 0.015, "{wavelength} m: {speed}, law {law}");
    }
    let slowest = speeds.iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("speeds");
    assert!((slowest.1 - 0.2312).abs() < 0.0025, "{slowest:?}");
    assert!((14.0e-3..21.0e-3).contains(&slowest.0), "{slowest:?}");
}

/// Real water spreads a ring into ripples, short ones ahead; a membrane has one speed.
#[test]
fn a_membrane_has_one_speed() {
    let options = membrane([256, 64]);
    for half_waves in [4, 8, 16] {
        let (wavelength, speed) = measured(&options, half_waves, 0.01);
        let cells = wavelength / 0.01;
        assert!((speed / 0.3 - 1.0).abs() < 2.0 / (cells * cells), "{wavelength} m: {speed}");
    }
}

/// A ring is as wide along the diagonal as along the rows.
#[test]
fn rings_are_round() {
    let mut puddle = Puddle::new(&undamped([256, 256])).expect("a puddle");
    set(&mut puddle, |x, y| hill(x, y, [128.0, 128.0], 3.0));
    for _ in 0..40 {
        puddle.step(0.01).expect("a step");
    }
    let heights = puddle.heights();
    let along = |cos: f64, sin: f64| {
        // Energy-weighted mean radius.
        let (mut above, mut below) = (0.0, 0.0);
        for i in 0..1000 {
            let r = f64::from(i) * 0.12;
            let (x, y) = (127.5 + r * cos, 127.5 + r * sin);
            let (x0, y0) = (x.floor(), y.floor());
            let at = |x: f64, y: f64| f64::from(heights[y as usize * 256 + x as usize]);
            let (fx, fy) = (x - x0, y - y0);
            let low = at(x0, y0) * (1.0 - fx) + at(x0 + 1.0, y0) * fx;
            let high = at(x0, y0 + 1.0) * (1.0 - fx) + at(x0 + 1.0, y0 + 1.0) * fx;
            let h = low * (1.0 - fy) + high * fy;
            above += h * h * r * r;
            below += h * h * r;
        }
        above / below
    };
    let (row, slant) = (along(1.0, 0.0), along(ops::cos(PI / 4.0), ops::sin(PI / 4.0)));
    assert!(row > 40.0, "{row} cells in 0.4 s");
    assert!((row / slant - 1.0).abs() < 0.01, "{row} and {slant} cells");
}

/// The form of the paper does not depend on the depth; shallower real water is slower.
#[test]
fn depth_counts_for_real_water_only() {
    let speed = |options: &PuddleOptions| measured(options, 8, 1.0e-3).1;
    let thin = PuddleOptions { depth_m: 1.0e-3, ..undamped([128, 64]) };
    let thick = PuddleOptions { depth_m: 5.0e-3, ..undamped([128, 64]) };
    assert!(speed(&thick) > 2.0 * speed(&thin));
    let form = PuddleForm::Membrane { speed_m_s: 0.3 };
    let [thin, thick] = [thin, thick].map(|options| PuddleOptions { form, ..options });
    assert_eq!(speed(&thick), speed(&thin));
}
