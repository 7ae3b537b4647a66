//! Textures on their way into a scene.

use downpour_math::color::srgb_to_linear;
use downpour_math::pyramid::{PyramidRounding, pyramid, pyramid_levels};
use downpour_shaders::render::scene::{
    SCENE_RELIEF, SCENE_REPEAT_U, SCENE_REPEAT_V, SCENE_ROOTED, TEXTURE_SHARE_SHIFT, TEXTURE_SLOPE_STEPS,
    TEXTURE_STEEPEST,
};

use super::SceneBuilder;
use crate::material::{TextureSlot, TextureUse};

/// The largest edge of a texture: larger ones are halved until they fit.
const MAX_EDGE: u32 = 2048;

/// Cosine below which a normal of a relief is no steeper.
const MIN_COSINE: f32 = 0.05;

/// Slopes of a texel of a map of normals (red, green and blue from 0 to 1), and the sum of their squares.
fn relief([r, g, b, _]: [f32; 4]) -> [f32; 4] {
    let up = (2.0 * b - 1.0).max(MIN_COSINE);
    let [x, y] = [r, g].map(|v| ((2.0 * v - 1.0) / up).clamp(-TEXTURE_STEEPEST, TEXTURE_STEEPEST));
    [x, y, x * x + y * y, 1.0]
}

/// Part of the variance of the slopes of a relief that is the square of the alpha of its lobe, in 255ths, where a texture's flags have it.
/// The median of the slopes of GGX's microfacets is their alpha: a relief of flat stones with steep joints has a narrow lobe in spite of
/// its variance.
fn relief_share(texels: &[[f32; 4]]) -> u32 {
    let count = texels.len().max(1) as f64;
    let mean = |k: usize| texels.iter().map(|texel| f64::from(texel[k])).sum::<f64>() / count;
    let [x, y, square] = [0, 1, 2].map(mean);
    let variance = square - x * x - y * y;
    let mut squares: Vec<f32> = texels
        .iter()
        .map(|texel| {
            let (dx, dy) = (texel[0] - x as f32, texel[1] - y as f32);
            dx * dx + dy * dy
        })
        .collect();
    let middle = squares.len() / 2;
    if middle == 0 || variance < 1.0e-8 {
        return 255 << TEXTURE_SHARE_SHIFT;
    }
    let median = f64::from(*squares.select_nth_unstable_by(middle, f32::total_cmp).1);
    ((median / variance).min(1.0) * 255.0).round() as u32 * (1 << TEXTURE_SHARE_SHIFT)
}

/// Means of slopes and of the sum of their squares in a word: both slopes, and the root of their variance, in 11, 11 and 10 bits.
fn pack_relief([x, y, square, _]: [f32; 4]) -> u32 {
    let steps = |value: f32| (value * (TEXTURE_SLOPE_STEPS / TEXTURE_STEEPEST)).round();
    let variance = (square - x * x - y * y).max(0.0);
    // Of one texel there is none; what rounding leaves is not one.
    let deviation = if variance > 1.0e-6 { variance.sqrt() } else { 0.0 };
    let [x, y] = [x, y].map(|slope| {
        (steps(slope).clamp(-TEXTURE_SLOPE_STEPS, TEXTURE_SLOPE_STEPS) + TEXTURE_SLOPE_STEPS) as u32
    });
    x | y << 11 | (steps(deviation).clamp(0.0, TEXTURE_SLOPE_STEPS) as u32) << 22
}

impl SceneBuilder {
    /// Adds a texture of 8-bit texels with all its levels, repeating in both directions. Its slot can be changed
    /// before it is added.
    ///
    /// Colors are stored as square roots of linear values, 8 bits each: as fine as sRGB, and decoded by one product. Normals become
    /// slopes of a relief, up to 4, with the variance of what a texel of a coarser level has in place of many.
    #[must_use]
    pub fn texture(&mut self, width: u32, height: u32, texels: &[[u8; 4]], of: TextureUse) -> TextureSlot {
        let decode: Vec<f32> = (0..=255u8)
            .map(|v| f32::from(v) / 255.0)
            .map(|v| if of == TextureUse::Color { srgb_to_linear(v) } else { v })
            .collect();
        let mut all: Vec<[f32; 4]> = texels
            .iter()
            .map(|&[r, g, b, a]| {
                let [r, g, b] = [r, g, b].map(|v| decode[usize::from(v)]);
                [r, g, b, f32::from(a) / 255.0]
            })
            .map(|texel| if of == TextureUse::Normals { relief(texel) } else { texel })
            .collect();
        let stored_as = match of {
            TextureUse::Color => SCENE_ROOTED,
            TextureUse::Data => 0,
            TextureUse::Normals => SCENE_RELIEF | relief_share(&all),
        };
        pyramid(&mut all, [width, height], PyramidRounding::Down);
        let mut sizes = vec![([width, height], 0)];
        let coarser = pyramid_levels([width, height], PyramidRounding::Down);
        sizes.extend(coarser.iter().map(|level| (level.size, level.target_texel)));
        sizes.retain(|(size, _)| size.iter().all(|&edge| edge <= MAX_EDGE));
        let ([top_width, top_height], top) = sizes[0];
        let levels = sizes.len() as u32;
        let store = |v: f32| {
            let v = v.clamp(0.0, 1.0);
            ((if of == TextureUse::Color { v.sqrt() } else { v }) * 255.0).round() as u8
        };
        let pack = |&[r, g, b, a]: &[f32; 4]| {
            u32::from_le_bytes([store(r), store(g), store(b), (a.clamp(0.0, 1.0) * 255.0).round() as u8])
        };
        let pack =
            |texel: &[f32; 4]| if of == TextureUse::Normals { pack_relief(*texel) } else { pack(texel) };
        let packed: Vec<u32> = all[top as usize..].iter().map(pack).collect();
        let first = self.push_texels(&packed);
        TextureSlot {
            matrix: [1.0, 0.0, 0.0, 1.0],
            offset: [0.0; 2],
            uv_set: 0,
            flags: SCENE_REPEAT_U | SCENE_REPEAT_V | stored_as,
            width: top_width,
            height: top_height,
            first,
            levels,
        }
    }
}
