//! Viewpoint of a photographer.

use downpour_math::ops::f64 as ops;
use glam::{DVec3, Vec3};

use downpour_render::camera::Viewpoint;

/// Angle of the camera above the horizon of what is photographed, in radians: 12 degrees.
const ABOVE: f64 = 12.0 * std::f64::consts::PI / 180.0;

/// Fraction of the picture that it fills.
const FILLED: f64 = 0.85;

/// Height of a person's eyes, meters.
const EYES_M: f32 = 1.6;

/// A camera in front of a box, on the side of +Z as glTF has it, and a little above: the whole box is in the picture and
/// as large as it may be.
pub(super) fn of_bounds((low, high): (Vec3, Vec3), size: [u32; 2], fov: f64) -> Viewpoint {
    let (low, high) = (low.as_dvec3(), high.as_dvec3());
    let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
    let forward = DVec3::new(0.0, -ops::sin(ABOVE), -ops::cos(ABOVE));
    let right = DVec3::X;
    let up = right.cross(forward);
    let half_height = ops::tan(fov * 0.5) * FILLED;
    let half_width = half_height * f64::from(size[0]) / f64::from(size[1].max(1));
    let mut distance: f64 = 0.0;
    for k in 0..8u32 {
        let sign = |bit: u32| if k & bit == 0 { -1.0 } else { 1.0 };
        let corner = half * DVec3::new(sign(1), sign(2), sign(4));
        let depth = corner.dot(forward);
        let needed = (corner.dot(right).abs() / half_width).max(corner.dot(up).abs() / half_height);
        distance = distance.max(needed - depth);
    }
    // A point, or a line away from the camera, has no size.
    let eye = middle - forward * distance.max(1.0e-3);
    Viewpoint { eye: eye.as_vec3(), forward: forward.as_vec3(), up: Vec3::Y, fov_y: fov as f32 }
}

/// A camera where a person stands, with nothing to look at but the sky.
pub(super) fn standing(fov: f64) -> Viewpoint {
    Viewpoint { eye: Vec3::Y * EYES_M, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: fov as f32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All corners are within the part of the picture that is to be filled, and one of them is on its edge.
    #[test]
    fn a_box_fills_the_picture() {
        for (low, high) in [
            (Vec3::new(-1.0, 0.0, -2.0), Vec3::new(1.0, 2.0, 2.0)),
            (Vec3::new(500.0, -3.0, 70.0), Vec3::new(540.0, -2.9, 71.0)),
            (Vec3::new(-0.02, 0.0, -0.01), Vec3::new(0.02, 30.0, 0.01)),
        ] {
            for size in [[1280, 720], [100, 400], [1, 1]] {
                let seen = of_bounds((low, high), size, 0.8);
                let [right, up, forward] = seen.axes().expect("a camera");
                let tangent = downpour_math::ops::tan(0.4);
                let aspect = size[0] as f32 / size[1] as f32;
                let mut most: f32 = 0.0;
                for k in 0..8 {
                    let pick = |bit: u32, a: f32, b: f32| if k & bit == 0 { a } else { b };
                    let corner =
                        Vec3::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z));
                    let offset = corner - seen.eye;
                    let depth = offset.dot(forward);
                    assert!(depth > 0.0, "{low} {size:?}: a corner behind the eye");
                    most = most.max(offset.dot(right).abs() / (depth * tangent * aspect));
                    most = most.max(offset.dot(up).abs() / (depth * tangent));
                }
                assert!((most - 0.85).abs() < 2.0e-3, "{low} {size:?}: {most}");
            }
        }
    }
}
