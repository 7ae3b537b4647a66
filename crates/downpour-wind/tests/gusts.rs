//! Gusts have the stated variance, spectrum and mean, at any time.

use downpour_math::ops::f64 as ops;
use downpour_wind::{Gusts, Keyed, UniformWind, Wind, WindPart};
use glam::DVec3;
use std::f64::consts::TAU;

const SPEED: f64 = 8.0;
const GUSTS: Gusts = Gusts { intensity: 0.25, length: 60.0, seed: 5 };

/// A wind to +X.
fn air(gusts: Gusts) -> UniformWind {
    let part = WindPart::Uniform(DVec3::new(SPEED, 0.0, 0.0).into());
    Wind::new(vec![part], Some(gusts), None).expect("a wind").uniform().expect("even")
}

/// Moments over 8192 random times within a span of many periods: the slowest sinusoid has a period of about 7500 s.
fn moments(seed: u64, take: fn(DVec3) -> f64) -> (f64, f64) {
    let air = air(Gusts { seed, ..GUSTS });
    let n = 8192;
    let values: Vec<f64> = (0..n).map(|k| take(air.velocity(f64::from(k) * 997.13))).collect();
    let mean = values.iter().sum::<f64>() / f64::from(n);
    (mean, values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / f64::from(n))
}

#[test]
fn mean_and_variance_are_those_that_were_asked() {
    let sigma = GUSTS.intensity * SPEED;
    for seed in [0, 5, u64::MAX] {
        for (take, mean, wanted) in [
            ((|v| v.x) as fn(DVec3) -> f64, SPEED, sigma * sigma),
            (|v| v.z, 0.0, 0.64 * sigma * sigma),
            (|v| v.y, 0.0, 0.0),
        ] {
            let (found, variance) = moments(seed, take);
            // 8192 values: a standard error of 0.011 sigma for the mean, 1.6 % for the variance.
            assert!((found - mean).abs() < 0.045 * sigma, "seed {seed}: mean {found}, not {mean}");
            assert!(
                (variance - wanted).abs() <= 0.06 * wanted,
                "seed {seed}: variance {variance}, not {wanted}"
            );
        }
    }
}

/// The power in a third of an octave, measured by correlation with sinusoids over a long time, is the integral of the
/// stated spectrum, in the mean over many seeds.
#[test]
fn the_spectrum_is_kaimals() {
    // The autocovariance: sum of a^2 / 2 cos(omega s) against the cosine transform of S(f).
    let lags = [0.5, 2.0, 5.0, 12.0, 30.0];
    let (seeds, times) = (24, 600);
    let mut found = [[0.0; 5]; 2];
    for seed in 0..seeds {
        let air = air(Gusts { seed, ..GUSTS });
        for k in 0..times {
            let time = f64::from(k) * 1013.7;
            let here = air.velocity(time);
            for (j, lag) in lags.into_iter().enumerate() {
                let there = air.velocity(time + lag);
                found[0][j] += (here.x - SPEED) * (there.x - SPEED);
                found[1][j] += here.z * there.z;
            }
        }
    }
    let number = f64::from(times) * seeds as f64;
    let spectra: [&dyn Fn(f64) -> f64; 2] =
        [&|f| GUSTS.spectrum_along(f, SPEED), &|f| GUSTS.spectrum_across(f, SPEED)];
    for (component, spectrum) in spectra.into_iter().enumerate() {
        let variance = transform(spectrum, 0.0);
        for (j, lag) in lags.into_iter().enumerate() {
            let (got, wanted) = (found[component][j] / number, transform(spectrum, lag));
            assert!(
                (got - wanted).abs() < 0.05 * variance,
                "component {component}, {lag} s: {got}, not {wanted}"
            );
        }
    }
}

/// The integral of S(f) cos(2 pi f s) over all frequencies, by the midpoint rule in ln f.
fn transform(spectrum: impl Fn(f64) -> f64, lag: f64) -> f64 {
    let (low, high, steps) = (ops::ln(1.0e-7), ops::ln(1.0e3), 60_000);
    let step = (high - low) / f64::from(steps);
    (0..steps)
        .map(|k| {
            let f = ops::exp(low + step * (f64::from(k) + 0.5));
            // For lags that the steps do not resolve, the cosine averages out.
            let turns = f * lag;
            let wave = if turns > 300.0 { 0.0 } else { ops::cos(TAU * turns) };
            spectrum(f) * wave * f * step
        })
        .sum()
}

/// The formula of the standard, and its integral.
#[test]
fn the_stated_spectrum_is_the_formula() {
    let sigma = 0.25 * 8.0;
    for f in [1.0e-3, 0.02, 0.5, 7.0] {
        let x = f * 60.0 / 8.0;
        let formula = 4.0 * x / ops::pow(1.0 + 6.0 * x, 5.0 / 3.0) * sigma * sigma / f;
        assert!((GUSTS.spectrum_along(f, 8.0) / formula - 1.0).abs() < 1.0e-12);
        let x = x / 3.0;
        let formula = 4.0 * x / ops::pow(1.0 + 6.0 * x, 5.0 / 3.0) * 0.64 * sigma * sigma / f;
        assert!((GUSTS.spectrum_across(f, 8.0) / formula - 1.0).abs() < 1.0e-12);
    }
    let whole = transform(|f| GUSTS.spectrum_along(f, 8.0), 0.0);
    assert!((whole / (sigma * sigma) - 1.0).abs() < 2.0e-3, "{whole}");
    let slope = ops::ln(GUSTS.spectrum_along(80.0, 8.0) / GUSTS.spectrum_along(40.0, 8.0)) / ops::ln(2.0);
    assert!((slope + 5.0 / 3.0).abs() < 0.01, "{slope}");
}

#[test]
fn gusts_are_a_function_of_seed_and_time() {
    let (one, other) = (air(GUSTS), air(Gusts { seed: 6, ..GUSTS }));
    for time in [-1.0e6, -3.0, 0.0, 12.345, 1.0e6] {
        assert_eq!(one.velocity(time), air(GUSTS).velocity(time));
        assert!(one.velocity(time).distance(other.velocity(time)) > 1.0e-3, "{time}");
        // Continuous: no jump within a tenth of a millisecond.
        assert!(one.velocity(time).distance(one.velocity(time + 1.0e-4)) < 0.05);
    }
    for time in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.0e300] {
        assert!(one.velocity(time).is_finite() && one.followed(time, 0.5).displacement.is_finite(), "{time}");
    }
}

/// Gusts scale with the current wind, and a calm has none.
#[test]
fn a_calm_does_not_gust() {
    let speed = Keyed::new(vec![(0.0, 0.0), (100.0, 20.0)]).expect("good keys");
    let part = WindPart::uniform(&speed, &DVec3::Z.into()).expect("a wind");
    let wind = Wind::new(vec![part], Some(GUSTS), None).expect("a wind");
    let air = wind.uniform().expect("even");
    assert_eq!(air.velocity(-5.0), DVec3::ZERO);
    assert!((air.velocity(50.0) - air.mean(50.0)).length() > 0.01);
    let still = Wind::new(vec![], Some(GUSTS), None).expect("a wind");
    assert_eq!(still.uniform().expect("even").velocity(3.0), DVec3::ZERO);
    // The field includes them, as one more uniform wind.
    let sum: DVec3 = wind
        .at(50.0)
        .iter()
        .map(|p| match p {
            downpour_wind::WindPrimitive::Uniform(w) => w.direction.as_dvec3() * f64::from(w.speed),
            other => panic!("{other:?}"),
        })
        .sum();
    assert!(sum.distance(air.velocity(50.0)) < 1.0e-5, "{sum}");
}
