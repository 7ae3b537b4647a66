//! Textures on their way into a scene.

use downpour_shaders::render::scene::{SCENE_REPEAT_U, SCENE_REPEAT_V, SCENE_ROOTED};

use super::SceneBuilder;
use crate::material::{TextureSlot, TextureUse};

/// The largest edge of a texture: larger ones are halved until they fit.
const LARGEST_EDGE: u32 = 2048;

impl SceneBuilder {
    /// Adds a texture of 8-bit texels with all its levels, repeating in both directions. Its slot can be changed
    /// before it is added.
    ///
    /// Colours are stored as square roots of linear values, 8 bits each: as fine as sRGB, and decoded by one product.
    #[must_use]
    pub fn texture(&mut self, width: u32, height: u32, texels: &[[u8; 4]], of: TextureUse) -> TextureSlot {
        let decode: Vec<f32> = (0..=255u8)
            .map(|v| if of == TextureUse::Colour { srgb_to_linear(v) } else { f32::from(v) / 255.0 })
            .collect();
        let mut level: Vec<[f32; 4]> = texels
            .iter()
            .map(|&[r, g, b, a]| {
                let [r, g, b] = [r, g, b].map(|v| decode[usize::from(v)]);
                [r, g, b, f32::from(a) / 255.0]
            })
            .collect();
        let (mut w, mut h) = (width, height);
        while w.max(h) > LARGEST_EDGE {
            (level, w, h) = halve(&level, w, h);
        }
        let (top_width, top_height) = (w, h);
        let mut packed = Vec::new();
        let mut levels = 0;
        loop {
            packed.extend(level.iter().map(|&[r, g, b, a]| {
                let store = |v: f32| {
                    let v = v.clamp(0.0, 1.0);
                    ((if of == TextureUse::Colour { v.sqrt() } else { v }) * 255.0).round() as u8
                };
                u32::from_le_bytes([store(r), store(g), store(b), (a.clamp(0.0, 1.0) * 255.0).round() as u8])
            }));
            levels += 1;
            if w == 1 && h == 1 {
                break;
            }
            (level, w, h) = halve(&level, w, h);
        }
        let first = self.push_texels(&packed);
        TextureSlot {
            matrix: [1.0, 0.0, 0.0, 1.0],
            offset: [0.0; 2],
            uv_set: 0,
            flags: SCENE_REPEAT_U | SCENE_REPEAT_V | if of == TextureUse::Colour { SCENE_ROOTED } else { 0 },
            width: top_width,
            height: top_height,
            first,
            levels,
        }
    }
}

/// The next level: means of 2 x 2 texels. The last row or column of an odd size counts for itself.
fn halve(level: &[[f32; 4]], width: u32, height: u32) -> (Vec<[f32; 4]>, u32, u32) {
    let (w, h) = ((width / 2).max(1), (height / 2).max(1));
    let at = |x: u32, y: u32| level[(y.min(height - 1) * width + x.min(width - 1)) as usize];
    let half = (0..h)
        .flat_map(|y| (0..w).map(move |x| (x, y)))
        .map(|(x, y)| {
            let four =
                [at(2 * x, 2 * y), at(2 * x + 1, 2 * y), at(2 * x, 2 * y + 1), at(2 * x + 1, 2 * y + 1)];
            std::array::from_fn(|k| four.iter().map(|t| t[k]).sum::<f32>() * 0.25)
        })
        .collect();
    (half, w, h)
}

/// The sRGB transfer function (IEC 61966-2-1).
fn srgb_to_linear(value: u8) -> f32 {
    let v = f32::from(value) / 255.0;
    if v <= 0.04045 { v / 12.92 } else { downpour_math::ops::pow((v + 0.055) / 1.055, 2.4) }
}
