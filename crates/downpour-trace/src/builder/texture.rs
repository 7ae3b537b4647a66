//! Textures on their way into a scene.

use downpour_math::color::srgb_to_linear;
use downpour_math::pyramid::{PyramidRounding, pyramid, pyramid_levels};
use downpour_shaders::render::scene::{SCENE_RELIEF, SCENE_REPEAT_U, SCENE_REPEAT_V, SCENE_ROOTED};

use super::SceneBuilder;
use super::relief::{pack_relief, relief_of_normal, relief_share};
use crate::material::{TextureSlot, TextureUse};

/// The largest edge of a texture: larger ones are halved until they fit.
const MAX_EDGE: u32 = 2048;

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
                if of == TextureUse::Normals {
                    relief_of_normal([r, g, b])
                } else {
                    [r, g, b, f32::from(a) / 255.0]
                }
            })
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
        let pack = |texel: &[f32; 4]| {
            if of == TextureUse::Normals {
                return pack_relief(texel);
            }
            let [r, g, b, a] = *texel;
            u32::from_le_bytes([store(r), store(g), store(b), (a.clamp(0.0, 1.0) * 255.0).round() as u8])
        };
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
