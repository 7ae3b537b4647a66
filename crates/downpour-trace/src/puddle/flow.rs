//! How water runs, as texels behind those of a puddle's map.

use std::sync::Arc;

use downpour_math::packing::{packing_pack_half, packing_unpack_half};
use glam::Vec2;
use rayon::prelude::*;

use super::map::{Ground, turned};

/// Maximum slope of the surface of running water.
const MAX_SLOPE: f32 = 0.2;

/// Velocities of the water of a map along x and z, m/s, and slopes of its surface along them: two cells in a row, row by row of the map.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowMap(pub Arc<[[u32; 4]]>);

impl FlowMap {
    /// Velocity in a cell, along x and z, m/s.
    pub(super) fn velocity(&self, cell: usize) -> Vec2 {
        self.0.get(cell / 2).map_or(Vec2::ZERO, |row| Vec2::from(packing_unpack_half(row[2 * (cell % 2)])))
    }
}

/// Velocities along columns and rows, and levels of the water (m), of all cells of a rectangle, as they are in its map.
pub(super) fn flow_map(
    ground: &Ground,
    size: [usize; 2],
    levels: &[Option<f32>],
    velocities: &[Vec2],
) -> FlowMap {
    let [columns, rows] = size;
    let turn = turned(ground.turn);
    let cell_m = ground.size / Vec2::new(columns as f32, rows as f32);
    let words = |cell: usize| {
        let Some(velocity) = velocities.get(cell).filter(|velocity| **velocity != Vec2::ZERO) else {
            return [0; 2];
        };
        let (x, y) = (cell % columns, cell / columns);
        let level = |cell: usize| levels[cell].or(levels[y * columns + x]);
        let between = |a: usize, b: usize, apart: f32| match (level(a), level(b)) {
            (Some(a), Some(b)) if apart > 0.0 => ((b - a) / apart).clamp(-MAX_SLOPE, MAX_SLOPE),
            _ => 0.0,
        };
        let (left, right) = (x.saturating_sub(1), (x + 1).min(columns - 1));
        let (above, below) = (y.saturating_sub(1), (y + 1).min(rows - 1));
        let slope = Vec2::new(
            between(y * columns + left, y * columns + right, (right - left) as f32 * cell_m.x),
            between(above * columns + x, below * columns + x, (below - above) as f32 * cell_m.y),
        );
        [turn.rotate(*velocity), turn.rotate(slope)].map(|pair| packing_pack_half(pair.into()))
    };
    let row = |k: usize| {
        let ([a, b], [c, d]) =
            (words(2 * k), if 2 * k + 1 < columns * rows { words(2 * k + 1) } else { [0; 2] });
        [a, b, c, d]
    };
    let texels: Vec<[u32; 4]> = (0..(columns * rows).div_ceil(2)).into_par_iter().map(row).collect();
    FlowMap(texels.into())
}
