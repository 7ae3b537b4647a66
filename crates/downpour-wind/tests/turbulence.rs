//! Turbulence: no divergence, the variance and the spectrum of von Karman, carried by the mean wind.

use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_wind::turbulence::{wind_turbulence_velocity, wind_turbulence_wave};
use downpour_wind::{Turbulence, Wind, WindField, WindGrid, WindMask, WindPart, WindTurbulenceMode};
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;

const SIGMA: f64 = 1.5;
const LENGTH: f64 = 10.0;

fn turbulence(seed: u64) -> Turbulence {
    Turbulence { speed: SIGMA, length: LENGTH, seed }
}

/// Velocity of all waves in double precision.
fn velocity(eddies: &Turbulence) -> impl Fn(DVec3) -> DVec3 + use<> {
    let waves = eddies.waves();
    move |at| waves.iter().map(|w| w.amplitude * ops::cos(TAU * (w.wave.dot(at) + w.phase))).sum()
}

fn position(seed: u64, k: u32) -> DVec3 {
    let [x, y, z, _] = rng_draw([seed as u32, 9], k, 0, 0).map(|w| f64::from(rng_unit(w)));
    DVec3::new(x, y, z) * 4000.0
}

#[test]
fn there_is_no_divergence() {
    for seed in 0..20 {
        let eddies = turbulence(seed);
        for wave in eddies.waves() {
            let along = wave.wave.normalize().dot(wave.amplitude);
            assert!(along.abs() < 1.0e-12 * wave.amplitude.length().max(1.0e-6), "{along}");
        }
        // The same numerically, against the actual rates of strain.
        let (field, h) = (velocity(&eddies), 1.0e-4);
        for k in 0..50 {
            let at = position(seed, k);
            let slope = |axis: DVec3| (field(at + axis * h) - field(at - axis * h)) / (2.0 * h);
            let (x, y, z) = (slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
            let rate = x.length() + y.length() + z.length();
            assert!(rate > 0.1 && (x.x + y.y + z.z).abs() < 1.0e-4 * rate, "{at}");
        }
    }
}

/// Each component has sigma^2, none is preferred, and two are uncorrelated.
#[test]
fn every_component_has_its_variance() {
    let (seeds, points) = (300, 24);
    let (mut sums, mut shear, mut mean) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for seed in 0..seeds {
        let field = velocity(&turbulence(seed));
        for k in 0..points {
            let v = field(position(seed, k));
            sums += v * v;
            shear += v * DVec3::new(v.y, v.z, v.x);
            mean += v;
        }
    }
    let n = seeds as f64 * f64::from(points);
    for (found, axis) in (sums / n).to_array().into_iter().zip(["x", "y", "z"]) {
        // 7200 values whose squares spread by 1.5: a standard error of 1.8 %.
        assert!((found / (SIGMA * SIGMA) - 1.0).abs() < 0.07, "{axis}: {found}");
    }
    assert!((shear / n).abs().max_element() < 0.07 * SIGMA * SIGMA, "{}", shear / n);
    assert!((mean / n).length() < 0.05 * SIGMA, "{}", mean / n);
    // Of a single field too: no seed is far off.
    for seed in 0..40 {
        let crests: DVec3 = turbulence(seed).waves().iter().map(|w| w.amplitude * w.amplitude * 0.5).sum();
        assert!((crests.element_sum() / (3.0 * SIGMA * SIGMA) - 1.0).abs() < 1.0e-12);
        assert!(crests.min_element() > 0.4 * SIGMA * SIGMA, "seed {seed}: {crests}");
    }
}

/// The printed spectrum: its integral is 3/2 sigma^2, its longitudinal integral length L, its slope -5/3.
#[test]
fn the_spectrum_is_von_karmans() {
    let eddies = turbulence(0);
    let (low, high, steps) = (ops::ln(1.0e-5), ops::ln(1.0e6), 200_000);
    let step = (high - low) / f64::from(steps);
    let (mut energy, mut length) = (0.0, 0.0);
    for n in 0..steps {
        let k = ops::exp(low + step * (f64::from(n) + 0.5));
        energy += eddies.spectrum(k) * k * step;
        // L = pi / (2 sigma^2) times the integral of E / k.
        length += eddies.spectrum(k) * step;
    }
    assert!((energy / (1.5 * SIGMA * SIGMA) - 1.0).abs() < 1.0e-3, "{energy}");
    let length = length * std::f64::consts::PI / (2.0 * SIGMA * SIGMA);
    assert!((length / LENGTH - 1.0).abs() < 1.0e-4, "{length}");
    let slope = ops::ln(eddies.spectrum(20.0) / eddies.spectrum(10.0)) / ops::ln(2.0);
    assert!((slope + 5.0 / 3.0).abs() < 1.0e-3, "{slope}");
}

/// The waves have the energy of the spectrum in each half decade, from that of the largest eddies to the smallest.
#[test]
fn the_waves_have_the_energy_of_the_spectrum() {
    let eddies = turbulence(3);
    let peak = 0.746_834 / LENGTH;
    for band in -2..6 {
        let edge = |n: i32| peak * ops::pow(10.0, 0.5 * f64::from(n));
        let (from, to) = (edge(band), edge(band + 1));
        let step = ops::ln(to / from) / 1000.0;
        let wanted: f64 = (0..1000)
            .map(|n| from * ops::exp(step * (f64::from(n) + 0.5)))
            .map(|k| eddies.spectrum(k) * k * step)
            .sum();
        let found: f64 = eddies
            .waves()
            .iter()
            .filter(|w| (from..to).contains(&(TAU * w.wave.length())))
            .map(|w| w.amplitude.length_squared() / 4.0)
            .sum();
        // The energy above all bands, 1.5 %, is distributed over all.
        assert!((found / wanted - 1.0).abs() < 0.02, "band {band}: {found}, not {wanted}");
    }
}

/// Measured in the field: the longitudinal structure function grows as r^(2/3) in the inertial range, which is the
/// slope -5/3 of the spectrum, and with Kolmogorov's factor.
#[test]
fn differences_grow_as_in_the_inertial_range() {
    let distances = [0.3, 0.6, 1.2];
    let mut found = [0.0; 3];
    let (seeds, points) = (150, 40);
    for seed in 0..seeds {
        let field = velocity(&turbulence(seed));
        for k in 0..points {
            let at = position(seed, k);
            let axis = [DVec3::X, DVec3::Y, DVec3::Z][k as usize % 3];
            let here = field(at).dot(axis);
            for (sum, r) in found.iter_mut().zip(distances) {
                let step = field(at + axis * r).dot(axis) - here;
                *sum += step * step / (f64::from(points) * seeds as f64);
            }
        }
    }
    // D(r) = 4 int E(k) (1/3 - j(k r)) dk, j = (sin x - x cos x) / x^3, over the range of the waves.
    let (low, high, steps) = (ops::ln(1.0e-4), ops::ln(746.8 / LENGTH), 20_000);
    let step = (high - low) / f64::from(steps);
    let eddies = turbulence(0);
    for (r, found) in distances.into_iter().zip(found) {
        let wanted: f64 = (0..steps)
            .map(|n| {
                let k = ops::exp(low + step * (f64::from(n) + 0.5));
                let x = k * r;
                let j = if x < 0.01 {
                    1.0 / 3.0 - x * x / 30.0
                } else {
                    (ops::sin(x) - x * ops::cos(x)) / (x * x * x)
                };
                4.0 * eddies.spectrum(k) * (1.0 / 3.0 - j) * k * step
            })
            .sum();
        assert!((found / wanted - 1.0).abs() < 0.1, "{r} m: {found}, not {wanted}");
    }
    let slope = ops::ln(found[2] / found[0]) / ops::ln(4.0);
    // The cut-off of the waves makes it steeper by 0.03 at 0.3 m, the largest eddies flatter at 1.2 m.
    assert!((slope - 2.0 / 3.0).abs() < 0.06, "{slope}");
}

#[test]
fn waves_that_a_grid_cannot_show_are_left_out() {
    let grid = |cells| WindGrid::new(Vec3::splat(-16.0), Vec3::splat(16.0), [cells; 3]).expect("a grid");
    let counts = [4, 16, 64, 256].map(|n| turbulence(0).modes(&grid(n.min(200)), DVec3::ZERO).len());
    assert!(counts.windows(2).all(|w| w[0] < w[1]), "{counts:?}");
    for cells in [4, 64] {
        let shortest = 2.0 * 32.0 / cells as f32;
        for mode in turbulence(0).modes(&grid(cells), DVec3::ZERO) {
            assert!(Vec3::from(mode.wave).length() * shortest <= 1.0 + 1.0e-6);
            assert!((0.0..=1.0).contains(&mode.phase));
        }
    }
    // A finer grid has the same eddies, and more.
    let (coarse, fine) =
        (turbulence(7).modes(&grid(16), DVec3::ZERO), turbulence(7).modes(&grid(64), DVec3::ZERO));
    assert_eq!(coarse[..], fine[..coarse.len()]);
}

/// Taylor: at time t the field is that of time 0, moved by the mean wind; far from the origin and late as well.
#[test]
fn the_mean_wind_carries_the_eddies() {
    let drift = DVec3::new(3.0, 0.0, -4.0);
    let eddies = turbulence(2);
    let wind = Wind::new(vec![WindPart::Uniform(drift.into())], None, Some(eddies)).expect("a wind");
    let exact = velocity(&eddies);
    for time in [0.0, 7.3, 86_400.0] {
        // A box that moves along sees the same; 2e5 m away as well.
        let low = Vec3::new(-200.0, 40.0, 3.0e5);
        let grid = WindGrid::new(low, low + 16.0, [16; 3]).expect("a grid");
        let shown = wind.modes(time, &grid);
        let waves = eddies.waves();
        assert!(shown.len() > 10 && shown.len() < waves.len());
        for k in 0..50 {
            let [x, y, z, _] = rng_draw([1, 1], k, 0, 0).map(rng_unit);
            let offset = Vec3::new(x, y, z) * 16.0;
            let found: Vec3 = shown.iter().map(|m| wind_turbulence_velocity(m, offset)).sum();
            let at = low.as_dvec3() + offset.as_dvec3() - drift * time;
            let short: DVec3 = waves[shown.len()..]
                .iter()
                .map(|w| w.amplitude * ops::cos(TAU * (w.wave.dot(at) + w.phase)))
                .sum();
            let wanted = exact(at) - short;
            assert!(found.as_dvec3().distance(wanted) < 2.0e-4, "{time} s: {found}, not {wanted}");
        }
    }
}

/// The cells contain primitives and eddies; gusts do not carry the eddies.
#[test]
fn the_field_holds_the_eddies() {
    let grid = WindGrid::new(Vec3::ZERO, Vec3::splat(16.0), [16; 3]).expect("a grid");
    let mask = WindMask::from_fn(&grid, |at| at.x > 12.0);
    let part = || WindPart::Uniform(DVec3::new(2.0, 0.0, 0.0).into());
    let wind = Wind::new(vec![part()], None, Some(turbulence(1))).expect("a wind");
    let field = wind.field(4.0, &grid, &mask).expect("a field");
    let modes: Vec<WindTurbulenceMode> = wind.modes(4.0, &grid);
    assert_eq!(field.modes(), &modes[..]);
    let calm = WindField::new(&grid, &wind.at(4.0), &mask).expect("a field");
    for (i, (with, without)) in field.cells().iter().zip(calm.cells()).enumerate() {
        let at = (Vec3::from(grid.coordinates(i).map(|c| c as f32)) + 0.5) * grid.cell();
        let eddies: Vec3 = modes.iter().map(|m| wind_turbulence_velocity(m, at)).sum();
        let open = without[3];
        let difference = Vec3::new(with[0] - without[0], with[1] - without[1], with[2] - without[2]);
        assert!((difference - eddies * open).length() < 1.0e-5, "{at}");
        assert_eq!(with[3], open);
    }
    let mean_square =
        field.cells().iter().filter(|c| c[3] > 0.0).map(|c| (c[0] - 2.0) * (c[0] - 2.0)).sum::<f32>();
    assert!(mean_square > 100.0, "{mean_square}");
}

#[test]
fn the_wave_is_a_cosine() {
    for k in -40_000..40_000 {
        let turns = k as f32 * 1.0e-3 + 0.000_37;
        let wanted = ops::cos(TAU * f64::from(turns));
        assert!((f64::from(wind_turbulence_wave(turns)) - wanted).abs() < 1.2e-6, "{turns}");
    }
    assert_eq!((wind_turbulence_wave(0.0), wind_turbulence_wave(-3.0)), (1.0, 1.0));
}
