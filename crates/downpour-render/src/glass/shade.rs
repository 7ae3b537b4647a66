//! The drops of a pane as a picture that light of lamps is cast through: where they are, and where they gather it.

use downpour_math::ops;
use downpour_math::pyramid::{PyramidRounding, pyramid_append, pyramid_levels};
use downpour_shaders::render::pane_shadow::{
    PANE_SHADOW_LENS, PANE_SHADOW_LEVELS, PANE_SHADOW_PEAK, PANE_SHADOW_TATARCHUK,
};
use glam::{Vec2, Vec3};

use super::water::{GlassPictureDrop, glass_picture_water_cap};

/// Least edge of a texel, m: small drops are two of them across.
const TEXEL_M: f64 = 2.5e-4;

/// Most texels of the finest level.
const MAX_TEXELS: f64 = 1048576.0;

/// Width of the spot to which a drop gathers light, in its radii: with the drop's light it is not quite
/// [`PANE_SHADOW_PEAK`] high.
const SPOT: f32 = 0.26;

/// Radii at which the spot ends.
const SPOT_END: f32 = 0.7;

/// Sample positions in a texel that are tested against the drops, from its center in units of its edge.
const CORNERS: [[f32; 2]; 4] = [[-0.125, -0.375], [0.375, -0.125], [0.125, 0.375], [-0.375, 0.125]];

/// Model of the light of lamps and the sun that falls through a wet pane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PaneShadows {
    /// Each drop is a lens: its light converges at its focus and spreads behind it.
    #[default]
    Lens,
    /// The shadow of a heavy drop has a highlight in its middle at any distance (Tatarchuk & Isidoro 2006).
    Tatarchuk2006,
}

/// Coverage and focused light of the drops on a pane, as a mip pyramid.
#[derive(Clone, Debug)]
pub struct PaneShade {
    size_m: [f32; 2],
    per_meter: f32,
    form: u32,
    /// Mean radius and focal length of the drops, m.
    mean: [f32; 2],
    /// Columns, rows and first texel of each level.
    levels: Vec<[u32; 3]>,
    /// Cover and gathered cover over [`PANE_SHADOW_PEAK`], in 255ths.
    texels: Vec<[u8; 2]>,
}

impl PaneShade {
    /// Computes the shade of a pane of a size in meters with these drops. Those whose disk is at least `gathers_m` in
    /// radius gather light; `water` is their refractive index.
    #[must_use]
    pub fn new(
        size_m: [f64; 2],
        drops: &[GlassPictureDrop],
        form: PaneShadows,
        gathers_m: f32,
        water: f32,
    ) -> Self {
        let edge = TEXEL_M.max((size_m[0] * size_m[1] / MAX_TEXELS).sqrt());
        let [columns, rows] = size_m.map(|size| ((size / edge).round() as usize).max(1));
        let edge = edge as f32;
        let mut finest = vec![Vec2::ZERO; columns * rows];
        let mut sums = [0.0f32; 3];
        for drop in drops.iter().filter(|drop| drop.radius > 0.0) {
            // Pieces of a ridge overlap: their light goes on in its direction.
            let is_drop = drop.axis == [0.0; 2];
            let area = if is_drop { drop.radius * drop.radius } else { 0.0 };
            sums[0] += area;
            sums[1] += area * drop.radius;
            sums[2] += area * drop.sphere / (water - 1.0).max(0.01);
            cast(&mut finest, [columns, rows], edge, drop, is_drop && drop.radius >= gathers_m);
        }
        let area = sums[0].max(1.0e-20);
        let mean = if sums[0] > 0.0 { [sums[1] / area, sums[2] / area] } else { [1.0e-3, 1.0e-2] };
        let size = [columns as u32, rows as u32];
        let mut all: Vec<[f32; 2]> = finest.iter().map(Vec2::to_array).collect();
        let mut levels = vec![[size[0], size[1], 0]];
        // Down to the first level that has one row or one column.
        for level in pyramid_levels(size, PyramidRounding::Down) {
            if level.source_size.contains(&1) {
                break;
            }
            pyramid_append(&mut all, &level);
            levels.push([level.size[0], level.size[1], level.target_texel]);
        }
        let byte = |part: f32| (part.clamp(0.0, 1.0) * 255.0).round() as u8;
        let texels =
            all.iter().map(|&[cover, gathered]| [byte(cover), byte(gathered / PANE_SHADOW_PEAK)]).collect();
        let form = if form == PaneShadows::Tatarchuk2006 { PANE_SHADOW_TATARCHUK } else { PANE_SHADOW_LENS };
        Self { size_m: size_m.map(|edge| edge as f32), per_meter: 1.0 / edge, form, mean, levels, texels }
    }
}

/// Adds a drop. Its gathered light is as much as its cover, texel by texel, whatever their edge.
fn cast(texels: &mut [Vec2], [columns, rows]: [usize; 2], edge: f32, drop: &GlassPictureDrop, gathers: bool) {
    let center = Vec2::from(drop.center);
    let reach = drop.reach();
    let range = |at: f32, most: usize| {
        let low = ((at - reach) / edge).floor().max(0.0) as usize;
        low.min(most)..(((at + reach) / edge).ceil().max(0.0) as usize).min(most)
    };
    let spot = |position: Vec2| {
        let away = (position - center).length_squared() / (drop.radius * drop.radius);
        if away < SPOT_END * SPOT_END { ops::exp(-0.5 * away / (SPOT * SPOT)) } else { 0.0 }
    };
    let (mut covered, mut spots) = (0.0, 0.0);
    for step in [false, true] {
        for row in range(center.y, rows) {
            for column in range(center.x, columns) {
                let position = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) * edge;
                let cover = CORNERS
                    .iter()
                    .filter(|&&at| glass_picture_water_cap(drop, position + Vec2::from(at) * edge).x > 0.0)
                    .count() as f32
                    * 0.25;
                let texel = &mut texels[row * columns + column];
                if !step {
                    covered += cover;
                    spots += spot(position);
                } else if cover > 0.0 || spot(position) > 0.0 {
                    // Drops may overlap: none takes more light than there is.
                    let taken = cover * (1.0 - texel.x);
                    let fraction = if spots > 0.0 { covered * spot(position) / spots } else { cover };
                    texel.x += taken;
                    texel.y += if gathers { fraction } else { taken };
                }
            }
        }
    }
}

impl PaneShade {
    /// Returns the rows of the pane in a table, which do not depend on their position there. `axes`: corner, right, down
    /// and outward of the pane, in the coordinates of the table.
    #[must_use]
    pub fn rows(&self, axes: [Vec3; 4]) -> Vec<[u32; 4]> {
        let [corner, across, down, outward] = axes;
        let first = PANE_SHADOW_LEVELS + self.levels.len() as u32;
        // There is at least one level.
        let [columns, rows, _] = self.levels.first().copied().unwrap_or_default();
        let last = (self.levels.len() as u32).saturating_sub(1);
        let row = |v: Vec3, w: f32| [v.x, v.y, v.z, w].map(f32::to_bits);
        let form = f32::from_bits(self.form);
        let mut table = vec![
            row(corner, self.per_meter),
            row(across, self.size_m[0]),
            row(down, self.size_m[1]),
            row(outward, form),
            [columns, rows, first, last],
            [self.mean[0].to_bits(), self.mean[1].to_bits(), 0, 0],
        ];
        table.extend(self.levels.iter().map(|&[columns, rows, first]| [columns, rows, first, 0]));
        let word = |pairs: &[[u8; 2]]| {
            pairs.iter().rev().fold(0u32, |word, &[a, b]| (word << 16) | u32::from(a) | (u32::from(b) << 8))
        };
        table.extend(self.texels.chunks(8).map(|eight| {
            let mut words = [0; 4];
            words.iter_mut().zip(eight.chunks(2)).for_each(|(into, pairs)| *into = word(pairs));
            words
        }));
        table
    }
}

/// A pane in front of the lamps, as the shaders read it. Twin of the struct of the same name in `shaders/wgsl/render/pane.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderPane {
    /// Upper left corner, meters.
    pub corner: Vec3,
    /// Texels per meter.
    pub texels_per_meter: f32,
    /// Unit vector to the right.
    pub across: Vec3,
    /// Width, m.
    pub width: f32,
    /// Unit vector down.
    pub down: Vec3,
    /// Height, m.
    pub height: f32,
    /// Unit normal away from the eye.
    pub outward: Vec3,
    /// `PANE_SHADOW_LENS` or `PANE_SHADOW_TATARCHUK`.
    pub form: u32,
    /// First row of the texels.
    pub first: u32,
    /// Index of the coarsest level.
    pub last: u32,
    /// Mean radius and focal length of the drops, m.
    pub drops: [f32; 2],
}

impl RenderPane {
    /// Reads the pane whose rows ([`PaneShade::rows`]) begin at row `row` of a table.
    #[must_use]
    pub fn pane_load(table: &[[u32; 4]], row: u32) -> Self {
        let rows = &table[row as usize..(row + PANE_SHADOW_LEVELS) as usize];
        let vector = |k: usize| Vec3::from_array([rows[k][0], rows[k][1], rows[k][2]].map(f32::from_bits));
        let last = |k: usize| f32::from_bits(rows[k][3]);
        Self {
            corner: vector(0),
            texels_per_meter: last(0),
            across: vector(1),
            width: last(1),
            down: vector(2),
            height: last(2),
            outward: vector(3),
            form: rows[3][3],
            first: row + rows[4][2],
            last: rows[4][3],
            drops: [rows[5][0], rows[5][1]].map(f32::from_bits),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;

    /// A texel that no drop is on is clear, a drop covers its disk, and gathers as much.
    #[test]
    fn a_drop_covers_its_disk_and_gathers_as_much() {
        let drop = GlassPictureDrop {
            center: [0.01, 0.012],
            radius: 2.0e-3,
            sphere: 2.5e-3,
            along: [0.0, 1.0],
            behind: 1.0,
            droop: [0.0, 1.0],
            ..Default::default()
        };
        let shade = PaneShade::new([0.02, 0.024], &[drop], PaneShadows::Lens, 0.0, 1.333);
        let [columns, rows, _] = shade.levels[0];
        let finest = &shade.texels[..(columns * rows) as usize];
        let area = |channel: usize, peak: f32| {
            finest.iter().map(|texel| f32::from(texel[channel]) / 255.0 * peak).sum::<f32>() * 6.25e-8
        };
        let disk = PI * 4.0e-6;
        assert!((area(0, 1.0) / disk - 1.0).abs() < 0.02, "{}", area(0, 1.0) / disk);
        assert!(
            (area(1, PANE_SHADOW_PEAK) / disk - 1.0).abs() < 0.03,
            "{}",
            area(1, PANE_SHADOW_PEAK) / disk
        );
        assert_eq!(finest[0], [0, 0]);
        assert!((shade.mean[0] - 2.0e-3).abs() < 1.0e-8 && (shade.mean[1] - 2.5e-3 / 0.333).abs() < 1.0e-6);
    }

    /// Below the threshold by mass a drop focuses no light: its light continues in its direction.
    #[test]
    fn small_drops_do_not_gather() {
        let drop = GlassPictureDrop {
            center: [0.01, 0.01],
            radius: 1.0e-3,
            sphere: 1.2e-3,
            along: [0.0, 1.0],
            behind: 1.0,
            droop: [0.0, 1.0],
            ..Default::default()
        };
        let shade = PaneShade::new([0.02, 0.02], &[drop], PaneShadows::Lens, 1.5e-3, 1.333);
        assert!(shade.texels.iter().all(|&[cover, gathered]| gathered <= cover));
    }
}
