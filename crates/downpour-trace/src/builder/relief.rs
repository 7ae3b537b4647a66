//! Maps of normals as slopes of a relief, with what a coarser texel stands for.

use downpour_shaders::render::scene::{TEXTURE_SHARE_SHIFT, TEXTURE_SLOPE_STEPS, TEXTURE_STEEPEST};

/// Cosine below which a normal of a relief is no steeper.
const MIN_COSINE: f32 = 0.05;

/// Both slopes of a normal (red, green and blue from 0 to 1), the sum of their squares, and 1.
pub(super) fn relief_of_normal([r, g, b]: [f32; 3]) -> [f32; 4] {
    let up = (2.0 * b - 1.0).max(MIN_COSINE);
    let [x, y] = [r, g].map(|v| ((2.0 * v - 1.0) / up).clamp(-TEXTURE_STEEPEST, TEXTURE_STEEPEST));
    [x, y, x * x + y * y, 1.0]
}

/// Part of the variance of the slopes of a relief that is the square of the alpha of its lobe, in 255ths, where a texture's flags have it.
/// The median of the slopes of GGX's microfacets is their alpha: a relief of flat stones with steep joints has a narrow lobe in spite of
/// its variance.
pub(super) fn relief_share(texels: &[[f32; 4]]) -> u32 {
    let count = texels.len().max(1) as f64;
    let mean = |k: usize| texels.iter().map(|texel| f64::from(texel[k])).sum::<f64>() / count;
    let [x, y, square] = [0, 1, 2].map(mean);
    let variance = square - x * x - y * y;
    let (x, y) = (x as f32, y as f32);
    let of = |texel: &[f32; 4]| (texel[0] - x) * (texel[0] - x) + (texel[1] - y) * (texel[1] - y);
    let mut squares: Vec<f32> = texels.iter().map(of).collect();
    let middle = squares.len() / 2;
    let mut share = 1.0;
    if middle > 0 && variance >= 1.0e-8 {
        let median = f64::from(*squares.select_nth_unstable_by(middle, f32::total_cmp).1);
        share = (median / variance).min(1.0);
    }
    ((share * 255.0).round() as u32) << TEXTURE_SHARE_SHIFT
}

/// Means of both slopes and of the sum of their squares in a word: the slopes, and the root of their variance, in 11, 11 and 10 bits.
pub(super) fn pack_relief(&[x, y, square, _]: &[f32; 4]) -> u32 {
    let steps = |value: f32| (value * (TEXTURE_SLOPE_STEPS / TEXTURE_STEEPEST)).round();
    let variance = (square - x * x - y * y).max(0.0);
    // Of one texel there is none; what rounding leaves is not one.
    let deviation = if variance > 1.0e-6 { variance.sqrt() } else { 0.0 };
    let [x, y] = [x, y].map(|slope| (steps(slope) + TEXTURE_SLOPE_STEPS) as u32);
    x | y << 11 | (steps(deviation).min(TEXTURE_SLOPE_STEPS) as u32) << 22
}
