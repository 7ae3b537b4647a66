//! Operator in f64, cell by cell: for energies, and for tests of the fast path.

use downpour_shaders::lattice::puddle::{
    PUDDLE_LINK_EAST, PUDDLE_LINK_NORTH, PUDDLE_LINK_NORTH_EAST, PUDDLE_LINK_NORTH_WEST, PUDDLE_LINK_SOUTH,
    PUDDLE_LINK_SOUTH_EAST, PUDDLE_LINK_SOUTH_WEST, PUDDLE_LINK_WEST,
};

use super::lattice::Links;
use super::symbol::Symbol;

/// x of the polynomial, applied to a field: weighted differences to linked neighbors over the largest sum.
fn normalized_laplacian(links: &Links, symbol: &Symbol, field: &[f64]) -> Vec<f64> {
    const STRAIGHT: [(u32, isize, isize); 4] = [
        (PUDDLE_LINK_WEST, -1, 0),
        (PUDDLE_LINK_EAST, 1, 0),
        (PUDDLE_LINK_NORTH, 0, -1),
        (PUDDLE_LINK_SOUTH, 0, 1),
    ];
    const DIAGONAL: [(u32, u32, u32); 4] = [
        (PUDDLE_LINK_NORTH_WEST, PUDDLE_LINK_NORTH, PUDDLE_LINK_WEST),
        (PUDDLE_LINK_NORTH_EAST, PUDDLE_LINK_NORTH, PUDDLE_LINK_EAST),
        (PUDDLE_LINK_SOUTH_WEST, PUDDLE_LINK_SOUTH, PUDDLE_LINK_WEST),
        (PUDDLE_LINK_SOUTH_EAST, PUDDLE_LINK_SOUTH, PUDDLE_LINK_EAST),
    ];
    let nx = links.size[0];
    let [_, straight, diagonal] = symbol.stencil.weights.map(f64::from);
    (0..field.len())
        .map(|i| {
            let bits = u32::from(links.bytes[i / nx * links.stride() + i % nx]);
            let step = |link: u32| {
                let found = STRAIGHT.iter().find(|&&(bit, ..)| bit == link && bits & bit != 0);
                found.map_or(0, |&(_, dx, dy)| dy * nx as isize + dx)
            };
            let mut sum = 0.0;
            for (bit, ..) in STRAIGHT {
                sum += straight * (field[i] - field[i.wrapping_add_signed(step(bit))]);
            }
            for (bit, a, b) in DIAGONAL {
                // With both or neither of the straight neighbors: the diagonal itself, or nothing.
                let whole = bits & a != 0 && bits & b != 0;
                let away = if bits & bit != 0 {
                    let (_, _, dy) = STRAIGHT.into_iter().find(|s| s.0 == a).unwrap_or((0, 0, 0));
                    let (_, dx, _) = STRAIGHT.into_iter().find(|s| s.0 == b).unwrap_or((0, 0, 0));
                    dy * nx as isize + dx
                } else if whole {
                    0
                } else {
                    step(a) + step(b)
                };
                sum += diagonal * (field[i] - field[i.wrapping_add_signed(away)]);
            }
            sum / symbol.stencil.largest
        })
        .collect()
}

/// A applied to a field, 1/s^2 times its unit.
pub(crate) fn apply(links: &Links, symbol: &Symbol, field: &[f64]) -> Vec<f64> {
    // Sum of c_j T_j(2 X - 1) by the recurrence of T, then X.
    let turned = |field: &[f64]| -> Vec<f64> {
        normalized_laplacian(links, symbol, field).iter().zip(field).map(|(s, f)| 2.0 * s - f).collect()
    };
    let mut sum = vec![0.0; field.len()];
    let (mut before, mut now) = (turned(field), field.to_vec());
    for c in &symbol.coefficients {
        for (sum, now) in sum.iter_mut().zip(&now) {
            *sum += c * now;
        }
        let next = turned(&now).iter().zip(&before).map(|(t, b)| 2.0 * t - b).collect();
        before = std::mem::replace(&mut now, next);
    }
    normalized_laplacian(links, symbol, &sum)
}

/// Sum of `(v^2 + eta A eta') / 2`, where eta' is a time step before eta.
pub(crate) fn energy(links: &Links, symbol: &Symbol, dt: f64, heights: &[f32], velocities: &[f32]) -> f64 {
    let after: Vec<f64> = heights.iter().copied().map(f64::from).collect();
    let force = apply(links, symbol, &after);
    let of_cell = |((&eta, &force), &v): ((&f64, &f64), &f32)| {
        let v = f64::from(v);
        0.5 * (v * v + (eta - dt * v) * force)
    };
    after.iter().zip(&force).zip(velocities).map(of_cell).sum()
}
