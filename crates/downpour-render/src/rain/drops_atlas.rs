//! The streaks of an atlas between their texels. Twin of `shaders/wgsl/render/drops_atlas.wgsl`, where their place behind the
//! masks is described.

use downpour_mask::atlas::StreakAtlas;
use downpour_shaders::render::rain::DROPS_ATLAS_HEAD;
use glam::Vec4;

use super::light::layer_means;

/// An atlas as the shader reads it. A texel is how many times as bright it is as a disc of even light with the layer's mean.
pub(super) fn words(atlas: &StreakAtlas) -> Vec<u32> {
    let data = atlas.data();
    let [columns, rows] = data.frame.size;
    let mut halves: Vec<half::f16> = Vec::new();
    let width = columns as usize;
    let numbers = data.texels.iter().flat_map(|word| [*word as u16, (*word >> 16) as u16]);
    let numbers: Vec<f32> = numbers.map(|bits| half::f16::from_bits(bits).to_f32()).collect();
    let layers = numbers.chunks_exact((columns * rows).max(1) as usize);
    for (layer, mean) in layers.zip(layer_means(atlas)) {
        let scale = if mean > 0.0 { 1.0 / mean } else { 0.0 };
        let whole = layer.iter().sum::<f32>() / rows as f32;
        for row in layer.chunks_exact(width.max(1)) {
            halves.extend(row.iter().map(|&texel| half::f16::from_f32(texel * scale)));
            let part = if whole > 0.0 { row.iter().sum::<f32>() / whole } else { 0.0 };
            halves.push(half::f16::from_f32(part));
        }
    }
    let mut words = vec![columns, rows, data.frame.half_extent.to_bits(), 0];
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

/// Three layers, their parts in the light, and -1 if they are to be mirrored, else 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DropsAtlasStreak {
    layers: [u32; 3],
    side: f32,
    shares: [f32; 3],
}

/// A streak out of two rows of a drop's light; its colour is in the first.
pub(super) fn drops_atlas_streak(first: Vec4, second: Vec4) -> DropsAtlasStreak {
    let share = first.w.abs() - 1.0;
    let side = if first.w < 0.0 { -1.0 } else { 1.0 };
    let layers = [second.x, second.y, second.z].map(|layer| layer as u32);
    DropsAtlasStreak { layers, side, shares: [share, second.w, 1.0 - share - second.w] }
}

impl DropsAtlas<'_> {
    fn word(&self, k: u32) -> u32 {
        self.masks.get((self.first + k) as usize).copied().unwrap_or(0)
    }

    /// A half by its number.
    fn drops_atlas_half(&self, index: u32) -> f32 {
        let word = self.word(DROPS_ATLAS_HEAD + (index >> 1));
        half::f16::from_bits((word >> (16 * (index & 1))) as u16).to_f32()
    }

    /// A texel. Rows go round. The column behind the last is the mean of the row.
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

    /// A streak so many equivalent radii to the right of the middle, so many turns of the mode (2,0) along.
    pub(super) fn drops_atlas_across(&self, streak: &DropsAtlasStreak, across: f32, turns: f32) -> f32 {
        let half = 0.5 * self.word(0) as f32;
        let extent = f32::from_bits(self.word(2));
        let column = half + half * (across * streak.side / extent).clamp(-2.0, 2.0);
        let row = (turns - turns.floor()) * self.word(1) as f32;
        streak.shares[0] * self.drops_atlas_layer(streak.layers[0], column, row)
            + streak.shares[1] * self.drops_atlas_layer(streak.layers[1], column, row)
            + streak.shares[2] * self.drops_atlas_layer(streak.layers[2], column, row)
    }

    /// The mean over the width, so many turns along.
    pub(super) fn drops_atlas_along(&self, streak: &DropsAtlasStreak, turns: f32) -> f32 {
        let columns = self.word(0) as i32;
        let row = ((turns - turns.floor()) * self.word(1) as f32) as i32;
        streak.shares[0] * self.drops_atlas_texel(streak.layers[0], columns, row)
            + streak.shares[1] * self.drops_atlas_texel(streak.layers[1], columns, row)
            + streak.shares[2] * self.drops_atlas_texel(streak.layers[2], columns, row)
    }
}
