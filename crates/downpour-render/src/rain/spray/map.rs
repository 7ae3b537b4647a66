//! Heights of what rain hits. Twin of `shaders/wgsl/render/spray_map.wgsl`, where the layout is described.

use downpour_shaders::render::spray::{SPRAY_CELL, SPRAY_CELLS, SPRAY_LEVELS, SPRAY_NOTHING, SPRAY_SIZE};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::SprayFrame;
use crate::plate::Lighting;

/// Heights of the first surfaces that the mean fall meets about an eye, m, relative to the scene's origin.
#[derive(Clone, Debug, PartialEq)]
pub struct SprayMap {
    /// Squares of heights, then the largest of each cell.
    pub words: Vec<f32>,
}

impl SprayMap {
    /// Number of words of a map.
    #[must_use]
    pub fn len() -> u32 {
        SPRAY_LEVELS * (SPRAY_SIZE * SPRAY_SIZE + SPRAY_CELLS * SPRAY_CELLS)
    }

    /// Looks along the mean fall at what stands in a scene.
    #[must_use]
    pub fn new(frame: &SprayFrame, lighting: &dyn Lighting) -> Self {
        let texels = (0..SPRAY_LEVELS * SPRAY_SIZE * SPRAY_SIZE).into_par_iter();
        let mut words: Vec<f32> = texels
            .map(|k| {
                let [column, row] = [k % SPRAY_SIZE, k / SPRAY_SIZE % SPRAY_SIZE];
                spray_map_height(frame, lighting, k / (SPRAY_SIZE * SPRAY_SIZE), column, row)
            })
            .collect();
        let highest = |cell: u32| {
            let [level, row, column] =
                [cell / (SPRAY_CELLS * SPRAY_CELLS), cell / SPRAY_CELLS % SPRAY_CELLS, cell % SPRAY_CELLS];
            let rows = row * SPRAY_CELL..(row + 1) * SPRAY_CELL;
            let of_row = |row: u32| {
                let first = ((level * SPRAY_SIZE + row) * SPRAY_SIZE + column * SPRAY_CELL) as usize;
                words[first..first + SPRAY_CELL as usize].iter().copied().fold(SPRAY_NOTHING, f32::max)
            };
            rows.map(of_row).fold(SPRAY_NOTHING, f32::max)
        };
        let cells: Vec<f32> = (0..SPRAY_LEVELS * SPRAY_CELLS * SPRAY_CELLS).map(highest).collect();
        words.extend(cells);
        Self { words }
    }
}

/// Height of the first surface on the line of a texel, relative to the scene's origin.
fn spray_map_height(frame: &SprayFrame, lighting: &dyn Lighting, level: u32, column: u32, row: u32) -> f32 {
    let [x, z, edge, _] = frame.levels[level as usize];
    let plane = Vec2::new(x, z) + Vec2::new(column as f32, row as f32) * edge;
    let aside = plane + Vec2::from(frame.lean) * frame.top;
    let start = Vec3::new(aside.x, frame.top, aside.y);
    match lighting.first_surface(start, -Vec3::from(frame.rise)) {
        Some(distance) => frame.top - distance * frame.rise[1],
        None => SPRAY_NOTHING,
    }
}
