//! The reflection buffer. Twin of `shaders/wgsl/render/impostor_draw.wgsl`.

use downpour_math::packing::{packing_octahedral_encode, packing_octahedral_texel};
use downpour_shaders::render::impostor::{IMPOSTOR_MAX, IMPOSTOR_NEAREST, IMPOSTOR_PROBE, IMPOSTOR_STRETCH};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::blur::{blurred, pass_count};
use super::impostor_pack;
use crate::billboards::Impostors;
use crate::scene::SceneView;

/// Part of a texel, of width 1, from `offset` on either side of which a line of half length `half` is.
#[must_use]
pub fn impostor_draw_overlap(offset: f32, half: f32) -> f32 {
    ((offset + 0.5).min(half) - (offset - 0.5).max(-half)).clamp(0.0, 1.0)
}

/// Coverage of a texel by a billboard of half size `half` at an offset from its center, right and down, in texels. It is stretched down
/// by `stretch` texels, over which it fades; what it gives in all stays the same.
#[must_use]
pub fn impostor_draw_cover(offset: Vec2, half: Vec2, stretch: f32) -> f32 {
    let across = impostor_draw_overlap(offset.x, half.x);
    let below = offset.y - half.y;
    let tail = if below > 0.0 { (1.0 - below / stretch).max(0.0) } else { 0.0 };
    let along = (impostor_draw_overlap(offset.y, half.y) + tail).min(1.0);
    let kept = 2.0 * half.y / (2.0 * half.y + 0.5 * stretch);
    across * along * kept
}

impl SceneView<'_> {
    /// The buffer of a frame: two pairs of halves a texel, rows from the top. Empty if reflections are found by rays.
    #[must_use]
    pub fn mirrored_picture(&self) -> Vec<[u32; 2]> {
        let Some(impostors) = &self.data.impostors else { return Vec::new() };
        let size = self.impostor_size();
        let mut texels: Vec<[u32; 2]> = (0..size.y)
            .into_par_iter()
            .flat_map_iter(|y| {
                (0..size.x).map(move |x| {
                    let light = self.impostor_draw_texel(impostors, x, y).min(Vec3::splat(IMPOSTOR_MAX));
                    impostor_pack(light)
                })
            })
            .collect();
        for turn in 0..pass_count(&self.frame.camera) {
            texels = blurred(&texels, size, turn);
        }
        texels
    }

    /// Radiance of a texel.
    fn impostor_draw_texel(&self, impostors: &Impostors, x: u32, y: u32) -> Vec3 {
        let camera = &self.frame.camera;
        let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        let seen = camera.camera_direction(2.0 * at.x, 2.0 * at.y);
        let mut sum = impostors.impostor_draw_environment(Vec3::new(seen.x, -seen.y, seen.z));
        let texel_angle = 2.0 * camera.pixel_angle;
        let stretch = IMPOSTOR_STRETCH / texel_angle;
        for billboard in &impostors.billboards {
            let from_eye = billboard.center - camera.eye;
            let depth = from_eye.dot(camera.forward);
            if depth < IMPOSTOR_NEAREST {
                continue;
            }
            let center = camera.camera_project(from_eye) * 0.5;
            let half = billboard.half / (depth * texel_angle);
            let cover = impostor_draw_cover(at - center, half, stretch);
            sum += (billboard.radiance - sum) * cover;
        }
        sum
    }
}

impl Impostors {
    /// Radiance of the environment in a direction, bilinear.
    fn impostor_draw_environment(&self, direction: Vec3) -> Vec3 {
        let place = packing_octahedral_encode(direction.to_array());
        let at = place.map(|x| (x * 0.5 + 0.5) * IMPOSTOR_PROBE as f32 - 0.5);
        let low = at.map(f32::floor);
        let part = [at[0] - low[0], at[1] - low[1]];
        let mut sum = Vec3::ZERO;
        for k in 0..4i32 {
            let upper = [k & 1, k >> 1];
            let weight: [f32; 2] =
                std::array::from_fn(|axis| if upper[axis] == 1 { part[axis] } else { 1.0 - part[axis] });
            let [column, row] =
                packing_octahedral_texel(IMPOSTOR_PROBE, low[0] as i32 + upper[0], low[1] as i32 + upper[1]);
            sum += self.environment[(row * IMPOSTOR_PROBE + column) as usize] * (weight[0] * weight[1]);
        }
        sum
    }
}
