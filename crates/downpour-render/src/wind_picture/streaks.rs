//! Noise, averaged along streamlines.

use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use rayon::prelude::*;

use super::Flow;

/// Length of a step along a streamline, in pixels.
const STEP: f32 = 0.75;

/// For each pixel how bright its streak is: 0 in the mean, mostly -1 to 1, 0 where nothing flows in the slice.
pub(super) fn streaks(flow: &Flow) -> Vec<f32> {
    let noise: Vec<f32> = (0..flow.speed.len())
        .map(|i| {
            let (column, row) = ((i % flow.columns) as u32, (i / flow.columns) as u32);
            let [word, ..] = rng_draw([0, 0], column, row, 0);
            rng_unit(word) - 0.5
        })
        .collect();
    let reach = (flow.columns.min(flow.rows) / 24).clamp(8, 60);
    // A window that fades to both ends.
    let weights: Vec<f32> = (0..=reach)
        .map(|k| 0.5 + 0.5 * ops::cos(std::f32::consts::PI * k as f32 / (reach + 1) as f32))
        .collect();
    let mut sums: Vec<f32> =
        (0..flow.speed.len()).into_par_iter().map(|i| average(flow, &noise, &weights, i)).collect();
    let count = sums.len().max(1) as f64;
    let spread = (sums.iter().map(|&s| f64::from(s) * f64::from(s)).sum::<f64>() / count).sqrt();
    let scale = if spread > 1.0e-9 { (0.6 / spread) as f32 } else { 0.0 };
    for sum in &mut sums {
        *sum = (*sum * scale).clamp(-1.2, 1.2);
    }
    sums
}

/// The noise along the streamline through a pixel.
fn average(flow: &Flow, noise: &[f32], weights: &[f32], i: usize) -> f32 {
    let middle = ((i % flow.columns) as f32 + 0.5, (i / flow.columns) as f32 + 0.5);
    let (mut sum, mut whole) = (0.0, 0.0);
    for sign in [1.0, -1.0] {
        let (mut x, mut y) = middle;
        for (k, weight) in weights.iter().enumerate() {
            let Some(here) = unit(flow, x, y) else { break };
            let index = y as usize * flow.columns + x as usize;
            // The first pixel belongs to both sides.
            let fraction = if k == 0 { 0.5 * weight } else { *weight };
            sum += fraction * noise.get(index).copied().unwrap_or(0.0);
            whole += fraction;
            // The middle of the step says where it leads.
            let half = 0.5 * sign * STEP;
            let [u, v] = unit(flow, x + half * here[0], y + half * here[1]).unwrap_or(here);
            x += sign * STEP * u;
            y += sign * STEP * v;
        }
    }
    if whole > 0.0 { sum / whole.sqrt() } else { 0.0 }
}

/// The direction of the flow at a position in pixels, if there is any.
fn unit(flow: &Flow, x: f32, y: f32) -> Option<[f32; 2]> {
    let [u, v] = flow.at(x, y)?;
    let length = (u * u + v * v).sqrt();
    (length > 1.0e-4 * flow.scale).then(|| [u / length, v / length])
}
