//! Textures in a buffer, filtered by our own code, so that CPU and GPU filter in the same way. Twin of
//! `shaders/wgsl/render/texture.wgsl`.

use downpour_math::ops;
use downpour_shaders::render::scene::{
    SCENE_MIRROR_U, SCENE_MIRROR_V, SCENE_REPEAT_U, SCENE_REPEAT_V, SCENE_ROOTED,
};
use glam::{Vec2, Vec4};

use crate::data::SceneData;
use crate::material::RenderSlot;

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
    /// One texel, linear.
    fn texture_texel(&self, index: u32, flags: u32) -> Vec4 {
        let [r, g, b, a] = self.texels[index as usize].to_le_bytes();
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

    /// A slot at the corner's two sets of coordinates. `spread` is the logarithm to base 2 of the width of the pixel
    /// in units of texture coordinates.
    #[must_use]
    pub fn texture_sample(&self, slot: u32, uv: Vec4, spread: f32) -> Vec4 {
        let RenderSlot { matrix, offset, uv_set, flags, image } = self.material_slot(slot);
        let chosen = if uv_set == 1 { Vec2::new(uv.z, uv.w) } else { Vec2::new(uv.x, uv.y) };
        let moved = Vec2::new(
            matrix[0] * chosen.x + matrix[1] * chosen.y + offset[0],
            matrix[2] * chosen.x + matrix[3] * chosen.y + offset[1],
        );
        // Far outside, a coordinate has no fraction left.
        let inside = moved.clamp(Vec2::splat(-4096.0), Vec2::splat(4096.0));
        let texels = 0.5 * ops::log2(image[0] as f32 * image[1] as f32);
        let lod = (spread + texels).clamp(0.0, (image[3] - 1) as f32);
        let (mut first, mut width, mut height) = (image[2], image[0] as i32, image[1] as i32);
        let level = lod as u32;
        for _ in 0..level {
            first += (width * height) as u32;
            width = (width / 2).max(1);
            height = (height / 2).max(1);
        }
        let fraction = if level + 1 >= image[3] { 0.0 } else { lod - level as f32 };
        let near = self.texture_level(first, width, height, inside, flags) * (1.0 - fraction);
        if fraction == 0.0 {
            return near;
        }
        let next = first + (width * height) as u32;
        let far = self.texture_level(next, (width / 2).max(1), (height / 2).max(1), inside, flags);
        near + far * fraction
    }
}
