//! Puddles against dispersion, conservation and rain.

mod bad_input;
mod conservation;
mod dispersion;
mod rain;
mod seeds;

use downpour_lattice::puddle::{Puddle, PuddleDamping, PuddleForm, PuddleOptions};

/// Real water without damping.
fn undamped(size: [u32; 2]) -> PuddleOptions {
    PuddleOptions { size, damping: PuddleDamping::None, ..PuddleOptions::default() }
}

/// The paper's membrane without damping: 0.3 m/s, cells of 1 cm.
fn membrane(size: [u32; 2]) -> PuddleOptions {
    let form = PuddleForm::Membrane { speed_m_s: 0.3 };
    PuddleOptions { form, cell_m: 0.01, ..undamped(size) }
}

/// Sets heights by a function of the cell, at rest.
fn set(puddle: &mut Puddle, height: impl Fn(usize, usize) -> f64) {
    let [nx, ny] = puddle.options().size.map(|n| n as usize);
    let heights: Vec<f32> = (0..nx * ny).map(|i| height(i % nx, i / nx) as f32).collect();
    puddle.set_state(&heights, &vec![0.0; nx * ny]).expect("as many heights as cells");
}

/// A smooth hill of 1 mm.
fn hill(x: usize, y: usize, center: [f64; 2], cells: f64) -> f64 {
    let (dx, dy) = (x as f64 + 0.5 - center[0], y as f64 + 0.5 - center[1]);
    1.0e-3 * downpour_math::ops::f64::exp(-(dx * dx + dy * dy) / (cells * cells))
}
