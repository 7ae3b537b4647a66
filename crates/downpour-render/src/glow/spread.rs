//! The passes of a glow on the CPU.

use downpour_math::ops;
use downpour_shaders::render::glow::GLOW_BRIGHTEST;
use downpour_shaders::render::medium::{MEDIUM_SKY, MEDIUM_SKY_REACH};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::plan::{GlowLevel, GlowPlan, GlowStep};
use crate::picture::compose_pixel;

/// Fraction of the light of a pixel that is taken, whose scene is at a distance, m.
#[must_use]
pub fn glow_fraction(level: &GlowLevel, distance: f32) -> f32 {
    let reach = if distance >= MEDIUM_SKY { MEDIUM_SKY_REACH } else { distance };
    level.fraction + 1.0 - ops::exp(-level.extinction * reach)
}

/// Light that is taken from a pixel of a plate (radiance and distance), the rain before it (radiance and transmittance) and a glow.
#[must_use]
pub fn glow_taken(level: &GlowLevel, plate: [f32; 4], rain: [f32; 4], glow: [f32; 4]) -> [f32; 4] {
    let mut seen = Vec4::from(compose_pixel(plate, rain)).truncate();
    if level.is_added == 1 {
        seen += Vec4::from(glow).truncate();
    }
    let seen = seen.clamp(Vec3::ZERO, Vec3::splat(GLOW_BRIGHTEST));
    (seen * glow_fraction(level, plate[3])).extend(0.0).into()
}

/// Length that two cells of two lattices over one line share: cell `a` of edge `a_edge`, cell `b` of edge `b_edge`.
#[must_use]
pub fn glow_overlap(a: u32, a_edge: u32, b: u32, b_edge: u32) -> u32 {
    let low = (a * a_edge).max(b * b_edge);
    ((a + 1) * a_edge).min((b + 1) * b_edge).max(low) - low
}

/// Weights of five texels of a line of `fine`, from the one before the first below texel `i` of `coarse` on.
#[must_use]
pub fn glow_down_weights(i: u32, fine: u32, coarse: u32) -> [f32; 5] {
    let first = i * fine / coarse;
    let of = |k: u32| glow_overlap(i, fine, first + k, coarse) as f32 / fine as f32;
    let (a, b, c) = (of(0), of(1), of(2));
    [0.25 * a, 0.5 * a + 0.25 * b, 0.25 * a + 0.5 * b + 0.25 * c, 0.25 * b + 0.5 * c, 0.25 * c]
}

/// First texel of a line of `coarse` over texel `i` of `fine` and its neighbors.
#[must_use]
pub fn glow_up_first(i: u32, fine: u32, coarse: u32) -> u32 {
    (i.max(1) - 1) * coarse / fine
}

/// Weight of texel `k` of a line of `coarse` for texel `i` of `fine`.
#[must_use]
pub fn glow_up_weight(k: u32, i: u32, fine: u32, coarse: u32) -> f32 {
    let before = glow_overlap(k, fine, i.max(1) - 1, coarse) as f32;
    let here = glow_overlap(k, fine, i, coarse) as f32;
    let after = glow_overlap(k, fine, (i + 1).min(fine - 1), coarse) as f32;
    (0.25 * before + 0.5 * here + 0.25 * after) / coarse as f32
}

/// Index of a texel at a signed position of a line, mirrored at its ends.
#[must_use]
pub fn glow_mirrored(position: i32, size: u32) -> u32 {
    let period = 2 * size as i32;
    let wrapped = (position % period + period) % period;
    wrapped.min(period - 1 - wrapped) as u32
}

/// A texel of the coarser level.
fn glow_down(level: &GlowLevel, texels: &[Vec4], x: u32, y: u32) -> Vec4 {
    let [width, height] = level.size;
    let across = glow_down_weights(x, width, level.coarse[0]);
    let along = glow_down_weights(y, height, level.coarse[1]);
    let left = x * width / level.coarse[0];
    let top = y * height / level.coarse[1];
    let mut sum = Vec4::ZERO;
    for (j, along) in (0..).zip(along) {
        let row = ((top + j).max(1) - 1).min(height - 1);
        let mut line = Vec4::ZERO;
        for (i, across) in (0..).zip(across) {
            let column = ((left + i).max(1) - 1).min(width - 1);
            line += across * texels[(level.first + row * width + column) as usize];
        }
        sum += along * line;
    }
    sum
}

/// The coarser level at a texel of the level; `coarse` is the texels of that level alone.
fn glow_up(level: &GlowLevel, coarse: &[Vec4], x: u32, y: u32) -> Vec4 {
    let [columns, rows] = level.coarse;
    let left = glow_up_first(x, level.size[0], columns);
    let top = glow_up_first(y, level.size[1], rows);
    let mut sum = Vec4::ZERO;
    for j in 0..3 {
        let row = (top + j).min(rows - 1);
        let mut line = Vec4::ZERO;
        for i in 0..3 {
            let column = (left + i).min(columns - 1);
            let weight = glow_up_weight(left + i, x, level.size[0], columns);
            line += weight * coarse[(row * columns + column) as usize];
        }
        sum += glow_up_weight(top + j, y, level.size[1], rows) * line;
    }
    sum
}

/// A texel of a pass of Kawase's filter: the mean of four taps between four texels each, and its own as far as the pass is a part of one.
fn glow_kawase(level: &GlowLevel, texels: &[Vec4], x: u32, y: u32) -> Vec4 {
    let mut sum = Vec4::ZERO;
    for k in 0..16u32 {
        let away = |bit: u32| {
            let reach = level.offset as i32 + (k >> bit & 1) as i32;
            if k >> (bit + 2) & 1 == 1 { reach } else { -reach }
        };
        let column = glow_mirrored(x as i32 + away(0), level.size[0]);
        let row = glow_mirrored(y as i32 + away(1), level.size[1]);
        sum += texels[(level.first + row * level.size[0] + column) as usize];
    }
    let own = texels[(level.first + y * level.size[0] + x) as usize];
    sum * (0.0625 * level.weight) + own * (1.0 - level.weight)
}

/// The texels of a level, row by row on all threads.
fn each_texel(texels: &mut [Vec4], width: u32, of: impl Fn(u32, u32, Vec4) -> Vec4 + Sync) {
    texels.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
        for (texel, x) in row.iter_mut().zip(0u32..) {
            *texel = of(x, y as u32, *texel);
        }
    });
}

impl GlowPlan {
    /// The glow of a picture: what comes to each pixel less what was taken from it. `plate` is radiance and distance of each pixel,
    /// `rain` radiance and transmittance. The same bits for any number of threads.
    pub(crate) fn glow(&self, plate: &[[f32; 4]], rain: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let mut texels = vec![Vec4::ZERO; self.texels];
        let mut glow = vec![Vec4::ZERO; plate.len()];
        for (step, level) in &self.steps {
            let [width, height] = level.size;
            let pixels = (width * height) as usize;
            let (first, coarse_first) = (level.first as usize, level.coarse_first as usize);
            let coarse = (level.coarse[0] * level.coarse[1]) as usize;
            match step {
                GlowStep::Take => each_texel(&mut texels[..pixels], width, |x, y, _| {
                    let i = (y * width + x) as usize;
                    glow_taken(level, plate[i], rain[i], glow[i].into()).into()
                }),
                GlowStep::Down => {
                    let (source, target) = texels.split_at_mut(coarse_first);
                    each_texel(&mut target[..coarse], level.coarse[0], |x, y, _| {
                        glow_down(level, source, x, y)
                    });
                }
                GlowStep::Up => {
                    let (target, source) = texels.split_at_mut(coarse_first);
                    each_texel(&mut target[first..first + pixels], width, |x, y, own| {
                        level.weight * own + level.coarse_weight * glow_up(level, source, x, y)
                    });
                }
                GlowStep::Kawase => {
                    let mut made = vec![Vec4::ZERO; pixels];
                    each_texel(&mut made, width, |x, y, _| glow_kawase(level, &texels, x, y));
                    texels[coarse_first..coarse_first + pixels].copy_from_slice(&made);
                }
                GlowStep::Add => {
                    let come = &texels[coarse_first..coarse_first + coarse];
                    each_texel(&mut glow, width, |x, y, before| {
                        let before = if level.is_added == 1 { before } else { Vec4::ZERO };
                        let own = texels[first + (y * width + x) as usize];
                        before + level.coarse_weight * glow_up(level, come, x, y) - level.weight * own
                    });
                }
            }
        }
        glow.into_iter().map(Vec4::into).collect()
    }
}
