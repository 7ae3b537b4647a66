//! Edges of things brighter than the display's white.
//!
//! A pixel on such an edge has the linear mean `p = d + c (b - d)` of a dark and a bright side, with the coverage `c` of the bright one. Where
//! `b` is far above white, the tone curve makes white of any coverage, and the edge shows stairs. Here the two sides are taken from
//! opposite neighbors, the coverage is found again, and the sides are mixed in the light of the display: `tone(d) + c (tone(b) - tone(d))`.
//!
//! Of the four pairs of neighbors that diagonal which crosses a straight edge has both sides whole: a pixel is as wide across any edge as
//! that step is long. So pairs with the strongest correction count most. What is no such edge stays: a pixel of a plateau, whose dark
//! neighbor is as bright as itself; points of light and the core of lines of one pixel, beyond whose bright neighbor it is dark again;
//! the texture of what is dim; the slope of what is soft, whose dark side is not even; glow, which is even over a pixel. All weights are
//! smooth, so that nothing pops from frame to frame, and a corrected pixel is between its dark neighbor and itself, so that no ring appears.

use downpour_math::color::color_luminance;
use downpour_shaders::render::tone::{
    TONE_EDGE_BRIGHT, TONE_EDGE_CLIPPED, TONE_EDGE_CONTRAST, TONE_EDGE_COVERAGE, TONE_EDGE_FLOOR,
    TONE_EDGE_SLOPE, TONE_EDGE_SLOPE_FLOOR, TONE_EDGE_WHITE, TONE_MAX_CHANNEL, TONE_START,
};
use glam::{IVec2, Vec3, Vec4};

use super::{ToneLayers, tone_color};

/// Smooth rise from 0 at `low` to 1 at `high`.
#[must_use]
pub fn tone_rise(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Sum of the channels.
#[must_use]
pub fn tone_sum(color: Vec3) -> f32 {
    color.x + color.y + color.z
}

/// Weight from 0 to 1 with which a pixel is the edge of something brighter than white: of its color, its dark neighbor and the pixel behind
/// that one, its bright neighbor, and the coverage that follows from them.
#[must_use]
pub fn tone_edge_weight(color: Vec3, dark: Vec3, behind: Vec3, bright: Vec3, coverage: f32) -> f32 {
    let sum = tone_sum(dark);
    let above = tone_rise(TONE_EDGE_WHITE, TONE_EDGE_BRIGHT, bright.max_element());
    let contrast = (tone_sum(color) - sum) / (sum + TONE_EDGE_FLOOR);
    let differs = tone_rise(0.25 * TONE_EDGE_CONTRAST, TONE_EDGE_CONTRAST, contrast);
    let covered = tone_rise(0.25 * TONE_EDGE_COVERAGE, TONE_EDGE_COVERAGE, coverage);
    let clips = tone_rise(TONE_START, TONE_EDGE_CLIPPED, color.max_element());
    // A dark side that rises toward the edge is the slope of something soft.
    let slope = (sum - tone_sum(behind)) / (tone_sum(behind) + TONE_EDGE_SLOPE_FLOOR);
    let is_even = 1.0 - tone_rise(0.25 * TONE_EDGE_SLOPE, TONE_EDGE_SLOPE, slope);
    above * differs * is_even * covered.max(clips)
}

/// Radiance that a pair of neighbors takes from a pixel, times the pair's weight among pairs, and that weight. `toned` is the pixel's color through
/// the curve; the others are exposed colors from 0 to `TONE_MAX_CHANNEL`: of the pixel, its dark neighbor and the pixel behind that one, its
/// bright neighbor and the pixel beyond that one.
#[must_use]
pub fn tone_edge(
    toned: Vec3,
    color: Vec3,
    dark: Vec3,
    behind: Vec3,
    bright: Vec3,
    beyond: Vec3,
    curve: u32,
) -> Vec4 {
    let sum = tone_sum(dark);
    let covered = tone_sum(color) - sum;
    let whole = tone_sum(bright).min(tone_sum(beyond)) - sum;
    if !(covered > 0.0 && covered < whole) {
        return Vec4::ZERO;
    }
    let coverage = covered / whole;
    let weight = tone_edge_weight(color, dark, behind, bright, coverage);
    if weight <= 0.0 {
        return Vec4::ZERO;
    }
    let through = tone_color(dark, curve);
    // The bright side in the pixel's own color.
    let side = tone_color(dark + (color - dark) / coverage, curve);
    let taken = (toned - (through + (side - through) * coverage)) * weight;
    let strength = color_luminance(taken.to_array()).max(0.0);
    let square = strength * strength;
    (taken * (square * square)).extend(square * square)
}

/// Index of a pixel; beyond the borders that of the nearest one.
#[must_use]
pub fn tone_index(layers: &ToneLayers<'_>, at: IVec2) -> usize {
    let [width, height] = layers.size.map(|count| count as i32);
    (at.y.clamp(0, height - 1) * width + at.x.clamp(0, width - 1)) as usize
}

/// Exposed color of a pixel from 0 to `TONE_MAX_CHANNEL`; beyond the borders that of the nearest pixel.
#[must_use]
pub fn tone_seen(layers: &ToneLayers<'_>, exposure: f32, at: IVec2) -> Vec3 {
    let seen = Vec3::from(layers.radiance[tone_index(layers, at)]);
    (seen * exposure).clamp(Vec3::ZERO, Vec3::splat(TONE_MAX_CHANNEL))
}

/// Exposed glow of a pixel; beyond the borders that of the nearest pixel.
#[must_use]
pub fn tone_glowing(layers: &ToneLayers<'_>, exposure: f32, at: IVec2) -> Vec3 {
    let glow = layers.glow.get(tone_index(layers, at)).copied().unwrap_or_default();
    Vec3::from_slice(&glow) * exposure
}

/// Step to one neighbor of a pair; the other is opposite. Pairs 0 to 3 are a row, a column and two diagonals.
#[must_use]
pub const fn tone_step(pair: u32) -> IVec2 {
    match pair {
        0 => IVec2::new(1, 0),
        1 => IVec2::new(0, 1),
        2 => IVec2::new(1, 1),
        _ => IVec2::new(1, -1),
    }
}

/// Largest glow of the 3 x 3 pixels around a pixel, channel by channel. A bright pixel gives more than it gets; those beside it show what
/// comes.
#[must_use]
pub fn tone_glow_around(layers: &ToneLayers<'_>, exposure: f32, at: IVec2) -> Vec3 {
    let mut glow = tone_glowing(layers, exposure, at);
    for step in (0..4).map(tone_step) {
        let ahead = tone_glowing(layers, exposure, at + step);
        let behind = tone_glowing(layers, exposure, at - step);
        glow = glow.max(ahead.max(behind));
    }
    glow
}

/// A pixel's color through the curve, `toned`, less what clips at the edges of bright things.
#[must_use]
pub fn tone_edges(layers: &ToneLayers<'_>, exposure: f32, curve: u32, at: IVec2, toned: Vec3) -> Vec3 {
    let color = tone_seen(layers, exposure, at);
    let sum = tone_sum(color);
    let mut taken = Vec4::ZERO;
    for step in (0..4).map(tone_step) {
        let ahead = tone_seen(layers, exposure, at + step);
        let behind = tone_seen(layers, exposure, at - step);
        let is_ahead = tone_sum(ahead) > tone_sum(behind);
        let (bright, plain) = if is_ahead { (ahead, behind) } else { (behind, ahead) };
        let least = tone_sum(plain) + 0.25 * TONE_EDGE_CONTRAST * (tone_sum(plain) + TONE_EDGE_FLOOR);
        // Most pixels, whose pairs have no weight.
        if bright.max_element() <= TONE_EDGE_WHITE || sum >= tone_sum(bright) || sum <= least {
            continue;
        }
        let way = if is_ahead { step } else { -step };
        // Glow is no coverage: the dark side has as much of it as there is around the pixel.
        let glow = tone_glow_around(layers, exposure, at);
        let dark = plain + (glow - tone_glowing(layers, exposure, at - way));
        let behind_it = at - way * 2;
        let deep =
            tone_seen(layers, exposure, behind_it) + (glow - tone_glowing(layers, exposure, behind_it));
        let most = Vec3::splat(TONE_MAX_CHANNEL);
        let beyond = tone_seen(layers, exposure, at + way * 2);
        taken += tone_edge(toned, color, dark.min(most), deep.clamp(Vec3::ZERO, most), bright, beyond, curve);
    }
    // The constant is far below a step of the display.
    toned - taken.truncate() / (taken.w + 1.0e-12)
}
