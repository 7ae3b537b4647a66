//! Means of pictures of one scene with other rays: what stands still is seen the better the longer. Twin of
//! `shaders/wgsl/render/refine.wgsl`.
//!
//! Each picture of the mean has its own seed and its pixels shifted by a part of a pixel ([`refine_shift`]), so that edges and noise
//! are averaged alike.

use glam::Vec2;

use crate::camera::Camera;

/// The mean of `count` pictures with one more, the `count`-th from 1 on: radiance, and the distance of what stands nearest in any.
#[must_use]
pub fn refine_pixel(mean: [f32; 4], next: [f32; 4], count: u32) -> [f32; 4] {
    if count <= 1 {
        return next;
    }
    let part = 1.0 / count as f32;
    let [r, g, b] = std::array::from_fn(|k| mean[k] + (next[k] - mean[k]) * part);
    [r, g, b, mean[3].min(next[3])]
}

/// Shift of the pixels of picture `count` from 1 on, in pixels, each within half a pixel: the first has none, the others are spread evenly
/// by the additive sequence of the plastic number (M. Roberts, 2018), whatever their number.
#[must_use]
pub fn refine_shift(count: u32) -> Vec2 {
    let turn = |golden: f64| {
        let part = f64::from(count.saturating_sub(1)) * golden + 0.5;
        (part - part.floor() - 0.5) as f32
    };
    Vec2::new(turn(0.754_877_666_246_692_8), turn(0.569_840_290_998_053_3))
}

/// A camera whose rays go through the pixels shifted by parts of a pixel, to the right and down.
#[must_use]
pub fn shifted(camera: &Camera, shift: Vec2) -> Camera {
    let right = camera.right * (2.0 * shift.x / camera.width as f32);
    let down = camera.up * (-2.0 * shift.y / camera.height as f32);
    Camera { forward: camera.forward + right + down, ..*camera }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Viewpoint;
    use glam::Vec3;

    #[test]
    fn a_mean_of_pictures_is_their_mean() {
        let pictures = [[1.0, 2.0, 3.0, 9.0], [3.0, 2.0, 1.0, 7.0], [5.0, 5.0, 5.0, 1.0e30]];
        let mut mean = [f32::NAN; 4];
        for (count, picture) in (1..).zip(pictures) {
            mean = refine_pixel(mean, picture, count);
        }
        assert_eq!(mean, [3.0, 3.0, 3.0, 7.0]);
    }

    #[test]
    fn shifts_stay_in_the_pixel_and_fill_it_evenly() {
        assert_eq!(refine_shift(1), Vec2::ZERO);
        let mut cells = [0u32; 16];
        for count in 1..=64 {
            let shift = refine_shift(count);
            assert!(shift.abs().max_element() <= 0.5);
            let cell = ((shift + 0.5) * 4.0).min(Vec2::splat(3.0)).as_uvec2();
            cells[(cell.y * 4 + cell.x) as usize] += 1;
        }
        // Of random numbers the sum is 15 in the mean, and below 5 in one of a hundred.
        let sum: f32 = cells.iter().map(|&count| (count as f32 - 4.0) * (count as f32 - 4.0) / 4.0).sum();
        assert!(sum < 5.0, "{sum}: {cells:?}");
    }

    #[test]
    fn a_shifted_camera_sees_what_is_beside() {
        let viewpoint = Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.8 };
        let camera = viewpoint.camera([64, 36], 0).expect("a camera");
        let moved = shifted(&camera, Vec2::new(0.3, -0.2)).camera_ray(10.0, 20.0);
        assert!((moved - camera.camera_ray(10.3, 19.8)).length() < 1.0e-6);
    }
}
