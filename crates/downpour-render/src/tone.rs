//! From scene-referred radiance to a picture. Twin of `shaders/wgsl/render/tone.wgsl`.
//!
//! Colors up to 0.8 less the toe stay as they are in both curves ([`ToneCurve`]), brighter ones are compressed: by [`tone_hue`], which keeps
//! hues, or by the neutral tone mapper of Khronos (2024, [`tone_neutral`]). Exposure is a factor of 2 per stop; automatic exposure puts
//! the logarithmic mean of the picture at middle gray. Edges of things brighter than white are filtered behind the curve ([`tone_edges`]).

mod edge;
mod hue;

use std::sync::LazyLock;

use downpour_math::color::{color_luminance, linear_to_srgb};
use downpour_math::ops;
use downpour_shaders::render::tone::{
    TONE_DESATURATION, TONE_EDGE_WHITE, TONE_KEEPS_HUE, TONE_KHRONOS, TONE_START,
};
use glam::{IVec2, Vec3};
use rayon::prelude::*;

pub use downpour_weather::{ToneCurve, ToneEdges};
pub use edge::{
    tone_edge, tone_edge_weight, tone_edges, tone_glow_around, tone_glowing, tone_index, tone_rise,
    tone_seen, tone_step, tone_sum,
};
pub use hue::{tone_hue, tone_linear, tone_oklab, tone_whiteness, tone_with_hue, tone_within};

/// Middle gray.
pub const GRAY: f32 = 0.18;

/// A color of no channel below 0, less what a surface of gloss reflects of white surroundings.
#[must_use]
pub fn tone_lifted(color: Vec3) -> Vec3 {
    let least = color.min_element();
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    color - Vec3::splat(offset)
}

/// Value of a largest channel from `TONE_START` on, below 1.
#[must_use]
pub fn tone_compressed(peak: f32) -> f32 {
    let d = 1.0 - TONE_START;
    1.0 - d * d / (peak + d - TONE_START)
}

/// Applies the neutral tone curve of Khronos; the result is in [0, 1].
#[must_use]
pub fn tone_neutral(color: Vec3) -> Vec3 {
    let lifted = tone_lifted(color.max(Vec3::ZERO));
    let peak = lifted.max_element();
    if peak < TONE_START {
        return lifted;
    }
    let new_peak = tone_compressed(peak);
    let scaled = lifted * (new_peak / peak);
    let g = 1.0 - 1.0 / (TONE_DESATURATION * (peak - new_peak) + 1.0);
    scaled.lerp(Vec3::splat(new_peak), g)
}

/// The sRGB transfer function (IEC 61966-2-1), to 8 bits.
#[must_use]
pub fn tone_srgb(linear: f32) -> u8 {
    let v = linear.clamp(0.0, 1.0);
    (linear_to_srgb(v) * 255.0).round() as u8
}

/// The exposure that puts the logarithmic mean of the picture at middle gray, within 16 stops of 1. Pixels are
/// radiance and anything.
#[must_use]
pub fn tone_automatic_exposure(pixels: &[[f32; 4]]) -> f32 {
    let (mut sum, mut count) = (0.0f64, 0u32);
    for [r, g, b, _] in pixels {
        let y = color_luminance([*r, *g, *b]);
        if y.is_finite() {
            sum += f64::from(ops::log2(y.max(1.0e-6)));
            count += 1;
        }
    }
    if count == 0 {
        return 1.0;
    }
    let mean = ops::exp2((sum / f64::from(count)) as f32);
    (GRAY / mean).clamp(1.0 / 65_536.0, 65_536.0)
}

/// Table of [`tone_srgb`], by the bits of linear numbers: numbers above 0 have the order of their bits. A picture has millions of
/// numbers, and a power of each would take longer than its rain.
struct Encoded {
    /// For each value but 0 the least number that becomes it.
    steps: [u32; 255],
    /// The value of the least number with these upper 16 bits.
    first: Vec<u8>,
}

static ENCODED: LazyLock<Encoded> = LazyLock::new(|| {
    let step = |k: usize| {
        let (mut below, mut at) = (0.0f32.to_bits(), 1.0f32.to_bits());
        while at - below > 1 {
            let middle = below + (at - below) / 2;
            if usize::from(tone_srgb(f32::from_bits(middle))) > k { at = middle } else { below = middle }
        }
        at
    };
    let steps = std::array::from_fn(step);
    let first = |upper: u32| steps.partition_point(|&step| step <= upper << 16) as u8;
    Encoded { steps, first: (0..=1.0f32.to_bits() >> 16).map(first).collect() }
});

impl Encoded {
    /// [`tone_srgb`] of a linear number, from the table.
    fn of(&self, linear: f32) -> u8 {
        // A number that is none becomes 0, as there, and 0 has no sign.
        let bits = (linear.clamp(0.0, 1.0).max(0.0) + 0.0).to_bits();
        let mut value = self.first[(bits >> 16) as usize];
        while self.steps.get(usize::from(value)).is_some_and(|&step| step <= bits) {
            value += 1;
        }
        value
    }
}

/// Number of a curve in shaders.
#[must_use]
pub fn tone_number(curve: ToneCurve) -> u32 {
    match curve {
        ToneCurve::KhronosNeutral => TONE_KHRONOS,
        ToneCurve::Hue => TONE_KEEPS_HUE,
    }
}

/// Way from radiance to a picture to look at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Factor from radiance to display.
    pub exposure: f32,
    /// Curve from exposed radiance to the display.
    pub curve: ToneCurve,
    /// Filter of the edges of things brighter than white.
    pub edges: ToneEdges,
}

/// Constants of a picture to look at. The same layout as `ToneFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ToneFrame {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Curve, a [`tone_number`].
    pub curve: u32,
    /// Factor from radiance to display.
    pub exposure: f32,
    /// 1: there is glow.
    pub has_glow: u32,
    /// 1: edges of things brighter than white are filtered ([`tone_edges`]).
    pub has_edges: u32,
    /// Nothing.
    pub pad_a: u32,
    /// Nothing.
    pub pad_b: u32,
}

/// A picture in linear radiance, rows from the top.
#[derive(Clone, Copy, Debug)]
pub struct ToneLayers<'a> {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Radiance of each pixel, glow included.
    pub radiance: &'a [[f32; 3]],
    /// Part of the radiance that glow has added; empty if nothing glows.
    pub glow: &'a [[f32; 4]],
}

/// Applies a curve to an exposed color; the result is in [0, 1].
#[must_use]
pub fn tone_color(color: Vec3, curve: u32) -> Vec3 {
    if curve == TONE_KEEPS_HUE { tone_hue(color) } else { tone_neutral(color) }
}

/// A color of the display as 8 bits each of red, green, blue and an alpha of 255, red lowest.
#[must_use]
pub fn tone_pack(toned: Vec3) -> u32 {
    let [r, g, b] = toned.to_array().map(tone_srgb).map(u32::from);
    r | g << 8 | b << 16 | 255 << 24
}

/// Converts linear radiance to an 8-bit picture.
///
/// # Panics
/// If there are not as many pixels as the size says.
#[must_use]
pub fn tone_picture(layers: &ToneLayers<'_>, tone: &Tone) -> Vec<[u8; 3]> {
    let encoded = &*ENCODED;
    let curve = tone_number(tone.curve);
    let [width, height] = layers.size.map(|count| count as usize);
    assert_eq!(layers.radiance.len(), width * height, "as many pixels as the size says");
    let exposed = |pixel: [f32; 3]| Vec3::from(pixel) * tone.exposure;
    let bright: Vec<bool> = match tone.edges {
        ToneEdges::Linear => vec![false; width * height],
        ToneEdges::ToneAware => {
            let is_bright = |&pixel: &[f32; 3]| exposed(pixel).max_element() > TONE_EDGE_WHITE;
            layers.radiance.par_iter().with_min_len(4096).map(is_bright).collect()
        }
    };
    let row_of = |(y, row): (usize, &mut [[u8; 3]])| {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let mut near = vec![false; width];
        for of in bright[rows.start * width..rows.end * width].chunks_exact(width) {
            near.iter_mut().zip(of).for_each(|(near, bright)| *near |= bright);
        }
        for (x, shown) in row.iter_mut().enumerate() {
            let mut toned = tone_color(exposed(layers.radiance[y * width + x]), curve);
            // Elsewhere no neighbor is brighter than white, and nothing is taken.
            if near[x.saturating_sub(1)..(x + 2).min(width)].contains(&true) {
                let at = IVec2::new(x as i32, y as i32);
                toned = tone_edges(layers, tone.exposure, curve, at, toned);
            }
            *shown = toned.to_array().map(|v| encoded.of(v));
        }
    };
    let mut picture = vec![[0; 3]; width * height];
    picture.par_chunks_mut(width.max(1)).enumerate().for_each(row_of);
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dark_colors_stay_and_bright_ones_end_at_white() {
        let dark = Vec3::new(0.2, 0.3, 0.4);
        assert!((tone_neutral(dark) - (dark - Vec3::splat(0.04))).length() < 1.0e-6);
        let bright = tone_neutral(Vec3::new(1.0e4, 10.0, 10.0));
        assert!(bright.min_element() > 0.9 && bright.max_element() <= 1.0, "{bright}");
        assert_eq!(tone_neutral(Vec3::ZERO), Vec3::ZERO);
    }

    #[test]
    fn exposure_brings_the_mean_to_gray() {
        let exposure = tone_automatic_exposure(&[[4.0, 4.0, 4.0, 0.0]; 10]);
        assert!((exposure - 0.045).abs() < 1.0e-4, "{exposure}");
        assert_eq!(tone_automatic_exposure(&[]), 1.0);
    }

    #[test]
    fn a_picture_has_the_values_of_the_transfer_function() {
        let numbers = (0..=200_000u32).map(|k| f32::from_bits(k.wrapping_mul(0x0000_54ab) % 0x4000_0000));
        let special = [-0.0, -1.0, 0.003_130_8, 1.0, 1.000_000_1, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        for linear in numbers.chain(special) {
            assert_eq!(ENCODED.of(linear), tone_srgb(linear), "{linear:e}");
        }
    }

    #[test]
    fn srgb_ends_and_middle() {
        assert_eq!([tone_srgb(0.0), tone_srgb(1.0), tone_srgb(0.5), tone_srgb(2.0)], [0, 255, 188, 255]);
    }
}
