//! Sizes of simulated drops are drawn independently: counts in bins are Poisson distributed.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_math::ops::f64 as ops;
use downpour_sim::simulation::{SimVolume, Simulation, SimulationOptions, StepInput};
use downpour_sim::view::View;
use glam::{DVec3, Vec3};

const BINS: usize = 21;
const SEEDS: u64 = 40;

fn edge(k: usize) -> f64 {
    // All drops of 0.2 to 3.2 mm.
    0.2e-3 * ops::pow(16.0, k as f64 / BINS as f64)
}

/// Chi-square of a state against the expected counts.
fn chi_square(simulation: &Simulation, inside: impl Fn(DVec3, f64) -> bool, expected: &[f64]) -> f64 {
    let mut counts = [0.0; BINS];
    for drop in simulation.drops() {
        let d = f64::from(drop.diameter());
        if inside(Vec3::from(drop.position).as_dvec3(), d) {
            let above = (0..=BINS).take_while(|&k| edge(k) <= d).count();
            if (1..=BINS).contains(&above) {
                counts[above - 1] += 1.0;
            }
        }
    }
    counts.iter().zip(expected).map(|(n, mean)| (n - mean) * (n - mean) / mean).sum()
}

/// Integral of a density over each bin.
fn expected(of: impl Fn(f64) -> f64) -> Vec<f64> {
    let bin = |k: usize| {
        let (from, to) = (edge(k), edge(k + 1));
        (0..500).map(|n| of(from + (to - from) * (f64::from(n) + 0.5) / 500.0)).sum::<f64>() * (to - from)
            / 500.0
    };
    (0..BINS).map(bin).collect()
}

/// Compares many values of chi-square with their distribution: mean and variance, and the largest.
fn check(name: &str, values: &[f64], expected: &[f64]) {
    let (n, freedom) = (values.len() as f64, BINS as f64);
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
    // Of Poisson counts the variance is 2 per bin and one over their mean.
    let law = 2.0 * freedom + expected.iter().map(|mean| 1.0 / mean).sum::<f64>();
    println!("{name}: mean {mean:.2} of {freedom}, variance {variance:.1} of {law:.1}");
    assert!((mean - freedom).abs() < 4.0 * (law / n).sqrt(), "{name}: mean {mean}");
    // The variance of a sample variance of chi-square: about (2 + 12 / freedom) law^2 / n.
    let spread = law * ((2.0 + 12.0 / freedom) / n).sqrt();
    assert!((variance - law).abs() < 4.0 * spread, "{name}: variance {variance}, {law} +- {spread}");
}

#[test]
fn sizes_scatter_as_chance_has_it() {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 10.0).expect("in range");
    let view = View { far: 5.0, ..View::default() };
    let now = StepInput::new(&view, DVec3::ZERO, Vec3::ZERO);
    let run = |volume: SimVolume, inside: &dyn Fn(DVec3, f64) -> bool, expected: &[f64]| -> Vec<f64> {
        let of_seed = |seed: u64| {
            let options = SimulationOptions { volume, seed, ..SimulationOptions::default() };
            let simulation = Simulation::new(&rain, &options, &now).expect("in range");
            chi_square(&simulation, inside, expected)
        };
        (0..SEEDS).map(of_seed).collect()
    };
    let size = 1.6;
    let in_box = expected(|d| rain.concentration(d) * size * size * size);
    let boxed = run(SimVolume::Box { size_m: [size; 3] }, &|_, _| true, &in_box);
    check("box", &boxed, &in_box);

    let range = |d: f64| (d / (view.pixel_angle * view.least_pixels)).min(view.far);
    let (wide, high) = (view.half_width, view.half_height);
    let solid = 4.0 * ops::asin(wide * high / ((1.0 + wide * wide) * (1.0 + high * high)).sqrt());
    let in_view = expected(|d| rain.concentration(d) * solid / 3.0 * ops::pow(range(d), 3.0));
    let inside = |at: DVec3, d: f64| {
        let depth = -at.z;
        depth > 0.0 && at.x.abs() < depth * wide && at.y.abs() < depth * high && at.length() < range(d)
    };
    let viewed = run(SimVolume::View, &inside, &in_view);
    check("view", &viewed, &in_view);
}
