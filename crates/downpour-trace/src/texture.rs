//! Textures in a buffer, filtered by our own code, so that CPU and GPU filter in the same way. Twin of
//! `shaders/wgsl/render/texture.wgsl`.

use downpour_math::ops;
use downpour_shaders::render::scene::{
    SCENE_MIRROR_U, SCENE_MIRROR_V, SCENE_RELIEF, SCENE_REPEAT_U, SCENE_REPEAT_V, SCENE_ROOTED,
    TEXTURE_SHARE_SHIFT, TEXTURE_SLOPE_STEPS, TEXTURE_SPACE, TEXTURE_STEEPEST, TEXTURE_TENT,
};
use glam::{Vec2, Vec3, Vec4, Vec4Swizzles as _};

use crate::data::SceneData;
use crate::material::RenderSlot;

/// The place where a ray's cone meets a surface, an ellipse, in both sets of texture coordinates (the second in `zw`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureFootprint {
    /// Its longer diameter on the surface.
    pub along: Vec4,
    /// Its shorter diameter.
    pub across: Vec4,
    /// Samples along the longer one, at most; those below 1 are 1.
    pub taps: f32,
}

impl TextureFootprint {
    /// As wide in all directions, in units of texture coordinates.
    #[must_use]
    pub fn round(width: f32) -> Self {
        Self {
            along: Vec4::new(width, 0.0, width, 0.0),
            across: Vec4::new(0.0, width, 0.0, width),
            taps: 1.0,
        }
    }
}

/// Samples of a texture in place of a footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureTaps {
    /// The line on which they lie with equal spaces, texels: the first and the last are half a space from its ends.
    pub line: Vec2,
    /// Their number.
    pub taps: f32,
    /// Edge of the texels that each of them interpolates, in texels of the finest level; at least 1.
    pub texel: f32,
}

/// Samples in place of an ellipse with two diameters in texels: `most` of them at most. They are no farther apart than the texels reach that
/// each interpolates, and have together the ellipse's variance.
#[must_use]
pub fn texture_taps(along: Vec2, across: Vec2, most: f32) -> TextureTaps {
    let (first, second) = (along.dot(along), across.dot(across));
    let length = first.max(second).sqrt();
    let reach = TEXTURE_SPACE * most;
    let shortest = if most > 1.0 {
        length / (TEXTURE_TENT * TEXTURE_TENT + reach * reach).sqrt()
    } else {
        length / TEXTURE_TENT
    };
    let texel = (first.min(second).sqrt() / TEXTURE_TENT).max(shortest).max(1.0);
    let wide = TEXTURE_TENT * texel;
    let line = (length * length - wide * wide).max(0.0).sqrt();
    let taps = (line / (TEXTURE_SPACE * texel)).ceil().clamp(1.0, most.max(1.0));
    // Samples in the middle of their parts have less variance than the line.
    let part = line / (length.max(1.0e-20) * (1.0 - 1.0 / (taps * taps).max(2.0)).sqrt());
    let longer = if first >= second { along } else { across };
    TextureTaps { line: longer * if taps > 1.0 { part } else { 0.0 }, taps, texel }
}

/// Variance of the slopes of a relief in a footprint that has two diameters in texels, from the means of the slopes (x, y) and of the sum
/// of their squares (z). Between the middles of texels a relief is taken to be smooth: a footprint far smaller than a texel has none.
#[must_use]
pub fn texture_variance(means: Vec4, along: Vec2, across: Vec2) -> f32 {
    let texels = along.dot(along).max(across.dot(across)) / (TEXTURE_TENT * TEXTURE_TENT);
    (means.z - means.xy().dot(means.xy())).max(0.0) * texels.min(1.0)
}

/// Two neighbors, the `i`-th and the next, brought into the texture: indices of texels along an edge of `n`. Integers are divided
/// once: that is slow.
#[must_use]
pub fn texture_wrap(i: i32, n: i32, repeats: bool, mirrors: bool) -> [i32; 2] {
    if repeats || mirrors {
        let period = if repeats { n } else { 2 * n };
        let rest = i % period;
        let at = if rest < 0 { rest + period } else { rest };
        let both = [at, if at + 1 == period { 0 } else { at + 1 }];
        return if repeats { both } else { both.map(|at| at.min(2 * n - 1 - at)) };
    }
    [i, i + 1].map(|i| i.clamp(0, n - 1))
}

impl SceneData {
    /// One texel, linear; of a relief: both slopes, the mean of the sum of their squares, and 1.
    fn texture_texel(&self, index: u32, flags: u32) -> Vec4 {
        let word = self.texels[index as usize];
        if flags & SCENE_RELIEF != 0 {
            let steps = [word & 2047, (word >> 11) & 2047, word >> 22].map(|bits| bits as f32);
            let middle = Vec3::new(TEXTURE_SLOPE_STEPS, TEXTURE_SLOPE_STEPS, 0.0);
            let slope = (Vec3::from(steps) - middle) * (TEXTURE_STEEPEST / TEXTURE_SLOPE_STEPS);
            return Vec4::new(slope.x, slope.y, slope.dot(slope), 1.0);
        }
        let [r, g, b, a] = word.to_le_bytes();
        let texel = Vec4::new(r.into(), g.into(), b.into(), a.into()) / 255.0;
        if flags & SCENE_ROOTED != 0 {
            return Vec4::new(texel.x * texel.x, texel.y * texel.y, texel.z * texel.z, texel.w);
        }
        texel
    }

    /// A level at texture coordinates, bilinear.
    fn texture_level(&self, first: u32, width: i32, height: i32, uv: Vec2, flags: u32) -> Vec4 {
        let x = uv.x * width as f32 - 0.5;
        let y = uv.y * height as f32 - 0.5;
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let (ix, iy) = (x.floor() as i32, y.floor() as i32);
        let u = texture_wrap(ix, width, flags & SCENE_REPEAT_U != 0, flags & SCENE_MIRROR_U != 0);
        let v = texture_wrap(iy, height, flags & SCENE_REPEAT_V != 0, flags & SCENE_MIRROR_V != 0);
        let mixed = |v: i32| {
            let [left, right] = u.map(|u| self.texture_texel(first + (v * width + u) as u32, flags));
            left * (1.0 - fx) + right * fx
        };
        let [top, bottom] = v.map(mixed);
        top * (1.0 - fy) + bottom * fy
    }

    /// A slot at the corner's two sets of coordinates; of a relief: the mean of both slopes, the square of the alpha of the lobe of what varies
    /// of them, and 1.
    #[must_use]
    pub fn texture_sample(&self, slot: u32, uv: Vec4, footprint: &TextureFootprint) -> Vec4 {
        let RenderSlot { matrix, offset, uv_set, flags, image } = self.material_slot(slot);
        let chosen = |both: Vec4| if uv_set == 1 { both.zw() } else { both.xy() };
        let turned =
            |uv: Vec2| Vec2::new(matrix[0] * uv.x + matrix[1] * uv.y, matrix[2] * uv.x + matrix[3] * uv.y);
        let moved = turned(chosen(uv)) + Vec2::from(offset);
        // Far outside, a coordinate has no fraction left.
        let inside = moved.clamp(Vec2::splat(-4096.0), Vec2::splat(4096.0));
        let size = Vec2::new(image[0] as f32, image[1] as f32);
        let [along, across] = [footprint.along, footprint.across].map(|axis| turned(chosen(axis)) * size);
        let TextureTaps { line, taps, texel } = texture_taps(along, across, footprint.taps);
        let lod = ops::log2(texel).clamp(0.0, (image[3] - 1) as f32);
        let (mut first, mut width, mut height) = (image[2], image[0] as i32, image[1] as i32);
        let level = lod as u32;
        for _ in 0..level {
            first += (width * height) as u32;
            width = (width / 2).max(1);
            height = (height / 2).max(1);
        }
        let fraction = if level + 1 >= image[3] { 0.0 } else { lod - level as f32 };
        let mean = |first: u32, width: i32, height: i32| {
            let level = |tap: u32| {
                let at = inside + line / size * ((tap as f32 + 0.5) / taps - 0.5);
                self.texture_level(first, width, height, at, flags)
            };
            (0..taps as u32).map(level).sum::<Vec4>() / taps
        };
        let mut sum = mean(first, width, height) * (1.0 - fraction);
        if fraction > 0.0 {
            let next = first + (width * height) as u32;
            sum += mean(next, (width / 2).max(1), (height / 2).max(1)) * fraction;
        }
        if flags & SCENE_RELIEF != 0 {
            let share = ((flags >> TEXTURE_SHARE_SHIFT) & 255) as f32 / 255.0;
            sum.z = texture_variance(sum, along, across) * share;
        }
        sum
    }
}
