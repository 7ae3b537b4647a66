//! The patterns of an atlas between their texels. Twin of `shaders/wgsl/render/drops_atlas.wgsl`, where their position behind the
//! masks is described.

use std::f32::consts::FRAC_1_PI;

use downpour_atlas::StreakAtlas;
use downpour_atlas::lookup::atlas_corner;
use downpour_shaders::render::rain::DROPS_ATLAS_HEAD;
use glam::Vec4;

/// An atlas as the shader reads it: its patterns, each row with its mean behind it.
pub(super) fn words(atlas: &StreakAtlas) -> Vec<u32> {
    let data = atlas.data();
    let [columns, rows] = data.frame.size;
    let [_, oscillations, elevations, directions] = data.frame.counts;
    let mut halves: Vec<half::f16> = Vec::new();
    let numbers = data.texels.iter().flat_map(|word| [*word as u16, (*word >> 16) as u16]);
    let numbers: Vec<half::f16> = numbers.map(half::f16::from_bits).collect();
    // Over a whole layer the mean of a pattern is that of an even disk over the width.
    let scale = 4.0 * data.frame.half_extent * FRAC_1_PI / columns as f32;
    for row in numbers.chunks_exact(columns.max(1) as usize) {
        halves.extend(row);
        halves.push(half::f16::from_f32(scale * row.iter().map(|texel| texel.to_f32()).sum::<f32>()));
    }
    let half_extent = data.frame.half_extent.to_bits();
    let mut words = vec![columns, rows, half_extent, directions, oscillations * elevations * directions];
    words.resize(DROPS_ATLAS_HEAD as usize, 0);
    let word = |pair: &[half::f16]| {
        let bits = |k: usize| pair.get(k).map_or(0, |h| u32::from(h.to_bits()));
        bits(0) | bits(1) << 16
    };
    words.extend(halves.chunks(2).map(word));
    words
}

/// The words of the masks, and where the atlas begins.
#[derive(Clone, Copy)]
pub(super) struct DropsAtlas<'a> {
    pub(super) masks: &'a [u32],
    pub(super) first: u32,
}

/// Three layers of the lower diameter and elevation, -1 if they are to be mirrored, else 1; weights of the three, weights of the
/// higher diameter and of the higher elevation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DropsAtlasStreak {
    layers: [u32; 3],
    side: f32,
    weights: [f32; 3],
    parts: [f32; 2],
}

/// A streak out of three rows of a drop's light; its color is in the first.
pub(super) fn drops_atlas_streak(first: Vec4, second: Vec4, third: Vec4) -> DropsAtlasStreak {
    DropsAtlasStreak {
        layers: [second.x, second.y, second.z].map(|layer| layer as u32),
        side: first.w,
        weights: [second.w, third.x, 1.0 - second.w - third.x],
        parts: [third.y, third.z],
    }
}

impl DropsAtlas<'_> {
    fn word(&self, k: u32) -> u32 {
        self.masks.get((self.first + k) as usize).copied().unwrap_or(0)
    }

    /// Layers from those of the lower diameter and elevation to those of one of the four neighbors.
    fn drops_atlas_step(&self, corner: u32) -> u32 {
        (corner & 1) * self.word(4) + (corner >> 1) * self.word(3)
    }

    /// A half by its number.
    fn drops_atlas_half(&self, index: u32) -> f32 {
        let word = self.word(DROPS_ATLAS_HEAD + (index >> 1));
        half::f16::from_bits((word >> (16 * (index & 1))) as u16).to_f32()
    }

    /// A texel. Rows wrap around. The column behind the last is the mean of the row.
    fn drops_atlas_texel(&self, layer: u32, column: i32, row: i32) -> f32 {
        let (columns, rows) = (self.word(0), self.word(1).max(1) as i32);
        let down = row.rem_euclid(rows) as u32;
        self.drops_atlas_half((layer * rows as u32 + down) * (columns + 1) + column as u32)
    }

    /// The same where a column that is outside is 0.
    fn drops_atlas_within(&self, layer: u32, column: i32, row: i32) -> f32 {
        if column < 0 || column >= self.word(0) as i32 {
            return 0.0;
        }
        self.drops_atlas_texel(layer, column, row)
    }

    /// A layer at so many columns and rows from its corner: bilinear.
    fn drops_atlas_layer(&self, layer: u32, across: f32, down: f32) -> f32 {
        let (u, v) = (across - 0.5, down - 0.5);
        let (left, top) = (u.floor(), v.floor());
        let (x, y) = (u - left, v - top);
        let (column, row) = (left as i32, top as i32);
        let above = self.drops_atlas_within(layer, column, row) * (1.0 - x)
            + self.drops_atlas_within(layer, column + 1, row) * x;
        let below = self.drops_atlas_within(layer, column, row + 1) * (1.0 - x)
            + self.drops_atlas_within(layer, column + 1, row + 1) * x;
        above * (1.0 - y) + below * y
    }

    /// A streak so many equivalent radii to the right of the middle, after `turns` turns of the mode (2,0).
    pub(super) fn drops_atlas_across(&self, streak: &DropsAtlasStreak, across: f32, turns: f32) -> f32 {
        let half = 0.5 * self.word(0) as f32;
        let extent = f32::from_bits(self.word(2));
        let column = half + half * (across * streak.side / extent).clamp(-2.0, 2.0);
        let row = (turns - turns.floor()) * self.word(1) as f32;
        let mut shown = 0.0;
        for corner in 0..4 {
            let weight = atlas_corner(streak.parts[0], streak.parts[1], corner);
            if weight > 0.0 {
                let [a, b, c] = streak.layers.map(|layer| layer + self.drops_atlas_step(corner));
                let mean = streak.weights[0] * self.drops_atlas_layer(a, column, row)
                    + streak.weights[1] * self.drops_atlas_layer(b, column, row)
                    + streak.weights[2] * self.drops_atlas_layer(c, column, row);
                shown += weight * mean;
            }
        }
        shown
    }

    /// The mean over the width, so many turns along.
    pub(super) fn drops_atlas_along(&self, streak: &DropsAtlasStreak, turns: f32) -> f32 {
        let columns = self.word(0) as i32;
        let row = ((turns - turns.floor()) * self.word(1) as f32) as i32;
        let mut shown = 0.0;
        for corner in 0..4 {
            let weight = atlas_corner(streak.parts[0], streak.parts[1], corner);
            if weight > 0.0 {
                let [a, b, c] = streak.layers.map(|layer| layer + self.drops_atlas_step(corner));
                let mean = streak.weights[0] * self.drops_atlas_texel(a, columns, row)
                    + streak.weights[1] * self.drops_atlas_texel(b, columns, row)
                    + streak.weights[2] * self.drops_atlas_texel(c, columns, row);
                shown += weight * mean;
            }
        }
        shown
    }
}
