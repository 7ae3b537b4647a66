//! The vertical blur of the reflection buffer. Twin of `shaders/wgsl/render/impostor_blur.wgsl`.

use downpour_render::camera::Camera;
use glam::{UVec2, Vec3};
use rayon::prelude::*;

use super::{impostor_pack, impostor_unpack};

/// Standard deviation of the blur, radians.
pub const BLUR_RAD: f32 = 0.008;

/// Maximum number of passes.
const MAX_PASSES: u32 = 16;

/// Number of passes for a camera's picture, whose means are together as wide as the blur at least: pass `k` takes texels `k` and `k + 1`
/// rows away, of variance `k^2 + k + 1/2`.
#[must_use]
pub fn pass_count(camera: &Camera) -> u32 {
    let width = BLUR_RAD / (2.0 * camera.pixel_angle);
    let mut variance = 0.0;
    for count in 0..MAX_PASSES {
        if variance >= width * width {
            return count;
        }
        let k = count as f32;
        variance += k * k + k + 0.5;
    }
    MAX_PASSES
}

/// The buffer after pass `turn`.
pub(super) fn blurred(before: &[[u32; 2]], size: UVec2, turn: u32) -> Vec<[u32; 2]> {
    (0..size.y)
        .into_par_iter()
        .flat_map_iter(|y| {
            (0..size.x).map(move |x| impostor_pack(impostor_blur_mean(before, x, y, size, turn)))
        })
        .collect()
}

/// A texel of a column; beyond its ends, the last one.
fn impostor_blur_texel(before: &[[u32; 2]], column: u32, row: i32, size: UVec2) -> Vec3 {
    let row = row.clamp(0, size.y as i32 - 1) as u32;
    impostor_unpack(before[(row * size.x + column) as usize])
}

/// The mean of pass `turn` at a texel.
fn impostor_blur_mean(before: &[[u32; 2]], column: u32, row: u32, size: UVec2, turn: u32) -> Vec3 {
    let (near, at) = (turn as i32, row as i32);
    let texel = |row: i32| impostor_blur_texel(before, column, row, size);
    let above = texel(at - near - 1) + texel(at - near);
    let below = texel(at + near) + texel(at + near + 1);
    (above + below) * 0.25
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blur_is_as_wide_as_it_says_and_keeps_the_sum() {
        let size = UVec2::new(1, 101);
        let camera = Camera { pixel_angle: 0.5 * BLUR_RAD / 6.0, ..Camera::default() };
        let mut texels = vec![[0; 2]; 101];
        texels[50] = impostor_pack(Vec3::X * 1024.0);
        for turn in 0..pass_count(&camera) {
            texels = blurred(&texels, size, turn);
        }
        let light: Vec<f32> = texels.iter().map(|&texel| impostor_unpack(texel).x).collect();
        let sum: f32 = light.iter().sum();
        assert!((sum / 1024.0 - 1.0).abs() < 2.0e-3, "{sum}");
        let square: f32 =
            light.iter().zip(-50i8..).map(|(light, row)| light * f32::from(row) * f32::from(row)).sum();
        let deviation = (square / sum).sqrt();
        assert!((6.0..8.0).contains(&deviation), "{deviation}");
    }
}
