//! Rings of single drops on water, as sums of closed forms. Twin of `shaders/wgsl/render/puddle_rings.wgsl`.
//!
//! A drop that hits water makes a ring whose waves have their own speeds ([`DropRing`](downpour_lattice::puddle::DropRing)); waves of
//! low amplitude add up. Rings are those of the drops that fall in the picture ([`Rings`](crate::puddle::Rings)), at any resolution, where the
//! lattice of the other ripples has cells. They are added in whole numbers: in any order the sum is the same.

use downpour_shaders::render::puddle_rings::{
    PUDDLE_RINGS_CELL, PUDDLE_RINGS_COARSE, PUDDLE_RINGS_CRATER, PUDDLE_RINGS_DISTANCE,
    PUDDLE_RINGS_DISTANCES, PUDDLE_RINGS_FINE, PUDDLE_RINGS_LIFE, PUDDLE_RINGS_SIZES, PUDDLE_RINGS_SPEED,
    PUDDLE_RINGS_TIME, PUDDLE_RINGS_TIMES, PUDDLE_RINGS_UNITS,
};
use glam::{IVec2, Vec2, Vec4};
use half::f16;

use crate::data::SceneData;

/// Position of the rings in the scene's table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PuddleRings {
    /// Cells along x and z; 0: there are no rings.
    pub(crate) cells: [u32; 2],
    /// First row of the cells.
    pub(crate) first_cell: u32,
    /// First row of the rings.
    pub(crate) first_ring: u32,
    /// First row of the slopes.
    pub(crate) first_slope: u32,
    /// Part of the mean square of the slope that rings have where they are whole.
    pub(crate) part: f32,
    /// Distance from the middle within which there are all rings, m.
    pub(crate) reach: f32,
    /// Corner of the cells along x and z, m.
    pub(crate) corner: Vec2,
    /// Middle of the rings along x and z, m.
    pub(crate) middle: Vec2,
}

/// 0 up to `low`, 1 from `high` on, and smooth between.
pub(super) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl SceneData {
    /// Reads where the rings are.
    pub(crate) fn puddle_rings_load(&self) -> PuddleRings {
        let row = self.ripples_row() as usize + 1;
        let [head, look, place] = [0, 1, 2].map(|k| self.table[row + k]);
        let place = Vec4::from(place.map(f32::from_bits));
        PuddleRings {
            cells: [head[0], head[1]],
            first_cell: head[2],
            first_ring: head[3],
            first_slope: look[0],
            part: f32::from_bits(look[1]),
            reach: f32::from_bits(look[2]),
            corner: Vec2::new(place.x, place.y),
            middle: Vec2::new(place.z, place.w),
        }
    }

    /// A word of rows.
    fn puddle_rings_word(&self, first: u32, index: u32) -> u32 {
        self.row(first + index / 4)[(index % 4) as usize]
    }

    /// Number of the first ring of a cell.
    fn puddle_rings_first(&self, rings: &PuddleRings, cell: u32) -> u32 {
        self.puddle_rings_word(rings.first_cell, cell / 2) >> (16 * (cell & 1)) & 0xffff
    }

    /// A slope of the table: of a node of sizes, at a step of time and a step of distance.
    fn puddle_rings_node(&self, first: u32, node: u32, time: u32, step: u32) -> f32 {
        let index = (node * PUDDLE_RINGS_TIMES + time) * PUDDLE_RINGS_DISTANCES + step;
        let pair = self.puddle_rings_word(first, index / 2);
        f16::from_bits((pair >> (16 * (index & 1))) as u16).to_f32()
    }

    /// Slope of a ring of a size, in nodes, of an age, in steps, away from its middle at a distance, in steps: linear between all.
    fn puddle_rings_slope(&self, first: u32, size: f32, age: f32, distance: f32) -> f32 {
        let node = (size as u32).min(PUDDLE_RINGS_SIZES - 2);
        let time = (age as u32).min(PUDDLE_RINGS_TIMES - 2);
        let step = (distance as u32).min(PUDDLE_RINGS_DISTANCES - 2);
        let along = distance - step as f32;
        let slopes = [0, 1, 2, 3].map(|k| {
            let a = self.puddle_rings_node(first, node + k / 2, time + k % 2, step);
            let b = self.puddle_rings_node(first, node + k / 2, time + k % 2, step + 1);
            a * (1.0 - along) + b * along
        });
        let (later, larger) = (age - time as f32, size - node as f32);
        (slopes[0] * (1.0 - later) + slopes[1] * later) * (1.0 - larger)
            + (slopes[2] * (1.0 - later) + slopes[3] * later) * larger
    }

    /// Slopes of a ring at a place relative to the corner of its cell, in units of 1 / `PUDDLE_RINGS_UNITS`.
    fn puddle_rings_one(&self, rings: &PuddleRings, number: u32, place: Vec2) -> IVec2 {
        let words = [0, 1].map(|k| self.puddle_rings_word(rings.first_ring, 2 * number + k));
        let [low, high] = [words[0] & 0xffff, words[0] >> 16].map(|word| word as f32);
        let away = place - Vec2::new(low, high) * (PUDDLE_RINGS_CELL / 65536.0);
        let distance = away.dot(away).sqrt();
        let age = (words[1] & 0xffff) as f32 * (PUDDLE_RINGS_LIFE / 65536.0);
        // Waves are no faster than this.
        if distance >= (PUDDLE_RINGS_CRATER + age * PUDDLE_RINGS_SPEED).min(PUDDLE_RINGS_CELL) {
            return IVec2::ZERO;
        }
        let size = (words[1] >> 16) as f32 * ((PUDDLE_RINGS_SIZES - 1) as f32 / 65536.0);
        let [age, step] = [age / PUDDLE_RINGS_TIME, distance / PUDDLE_RINGS_DISTANCE];
        let slope = self.puddle_rings_slope(rings.first_slope, size, age, step);
        (away * (slope * PUDDLE_RINGS_UNITS / distance.max(1.0e-6))).as_ivec2()
    }

    /// Slopes along x and z of all rings over a position.
    pub(crate) fn puddle_rings_sum(&self, rings: &PuddleRings, position: Vec2) -> Vec2 {
        let place = (position - rings.corner) / PUDDLE_RINGS_CELL;
        let own = place.floor().as_ivec2();
        let mut sum = IVec2::ZERO;
        for near in 0..9 {
            let cell = own + IVec2::new(near % 3 - 1, near / 3 - 1);
            let [columns, lines] = rings.cells.map(|count| count as i32);
            if cell.x < 0 || cell.y < 0 || cell.x >= columns || cell.y >= lines {
                continue;
            }
            let index = (cell.y * columns + cell.x) as u32;
            let [begin, end] = [index, index + 1].map(|at| self.puddle_rings_first(rings, at));
            let in_cell = (place - cell.as_vec2()) * PUDDLE_RINGS_CELL;
            for ring in begin..end {
                sum += self.puddle_rings_one(rings, ring, in_cell);
            }
        }
        sum.as_vec2() / PUDDLE_RINGS_UNITS
    }
}

/// Fraction of rings that is shown so far from their middle with a footprint, m: none where waves are smaller than the footprint, and far
/// away.
#[must_use]
pub fn puddle_rings_shown(away: Vec2, reach: f32, footprint: f32) -> f32 {
    let near = 1.0 - smoothstep(0.8 * reach, reach, away.dot(away).sqrt());
    near * (1.0 - smoothstep(PUDDLE_RINGS_FINE, PUDDLE_RINGS_COARSE, footprint))
}
