//! Part of space in which drops are simulated. Twin of `shaders/wgsl/sim/volume.wgsl`.
//!
//! In a box (Rousseau 2006, 7; 2008, 2.1) the rain is periodic: a drop moves to the opposite face. In a view the
//! volume is the frustum of the picture up to the distance at which a size is resolved (after Im & Sung 2022, 3.A and
//! B), widened by the path of a drop during the horizon, the time that pictures of one state cover: five planes and a
//! ball.

use bytemuck::{Pod, Zeroable};
use downpour_math::ops;
use downpour_math::ops::f64 as ops64;
use downpour_shaders::sim::step::{VOLUME_BALL, VOLUME_INSIDE, VOLUME_PLANES, VOLUME_RADIUS, VOLUME_TURN};
use glam::{DVec3, Vec2, Vec3, Vec4, Vec4Swizzles as _};

use crate::view::View;

/// Eye and its view, in the layout of `VolumeEye` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct VolumeEye {
    /// Position, m, relative to the origin of its time.
    pub position: [f32; 3],
    /// Half the width of the picture at distance 1.
    pub half_width: f32,
    /// Unit vector to the right.
    pub right: [f32; 3],
    /// Half the height of the picture at distance 1.
    pub half_height: f32,
    /// Unit vector up.
    pub up: [f32; 3],
    /// Padding of the WGSL layout.
    pub unused_1: u32,
    /// Unit vector forward.
    pub forward: [f32; 3],
    /// Padding of the WGSL layout.
    pub unused_2: u32,
}

impl VolumeEye {
    /// Eye of a view, relative to `origin`.
    #[must_use]
    pub fn new(view: &View, origin: DVec3) -> Self {
        Self {
            position: (view.eye - origin).as_vec3().to_array(),
            half_width: view.half_width as f32,
            right: view.right.as_vec3().to_array(),
            half_height: view.half_height as f32,
            up: view.up.as_vec3().to_array(),
            unused_1: 0,
            forward: view.forward.as_vec3().to_array(),
            unused_2: 0,
        }
    }
}

/// Frustum of a picture with margins, for drops at their positions in the middle of the horizon. The layout of
/// `VolumeFrustum` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct VolumeFrustum {
    /// Outward unit normals of right, left, top, bottom and back; fourth component: speed along them of the air at the
    /// eye relative to the eye, m/s. All planes pass through the eye.
    pub planes: [[f32; 4]; VOLUME_PLANES as usize],
    /// Position of the eye, m.
    pub eye: [f32; 3],
    /// Speed of the air at the eye relative to the eye, m/s.
    pub air: f32,
    /// Half the time that pictures of one state cover, s.
    pub half_horizon: f32,
    /// Half the longest time from a state to the opening of the shutter, s.
    pub half_wait: f32,
    /// Bound on the deviation of the wind, and of the drops' velocity due to it, from the wind at the eye, m/s.
    pub spread: f32,
    /// Increase of that bound per m of distance, 1/s.
    pub spread_slope: f32,
    /// Maximum of that bound, m/s.
    pub spread_max: f32,
    /// Distance at which a drop is resolved, per diameter.
    pub range: f32,
    /// Maximum of that distance, m.
    pub farthest: f32,
    /// Padding of the WGSL layout.
    pub unused: u32,
}

/// Number of edges of a box around `center` between a position and its periodic image in the box.
#[must_use]
pub fn volume_images(position: Vec3, center: Vec3, size: Vec3) -> Vec3 {
    ((position - center) / size + 0.5).floor()
}

/// Distance at which a diameter is resolved, m.
#[must_use]
pub fn volume_range(frustum: &VolumeFrustum, diameter: f32) -> f32 {
    (diameter * frustum.range).min(frustum.farthest)
}

/// Bound on the deviation of the wind, and of the drops' velocity due to it, within a distance of the eye, m/s.
#[must_use]
pub fn volume_spread(frustum: &VolumeFrustum, range: f32) -> f32 {
    (frustum.spread + frustum.spread_slope * range).min(frustum.spread_max)
}

/// Index of the first limit of the frustum that a drop at `offset` from the eye violates: a plane, `VOLUME_BALL`,
/// or `VOLUME_INSIDE`. `speed` is its terminal speed.
#[must_use]
pub fn volume_limit(frustum: &VolumeFrustum, offset: Vec3, diameter: f32, speed: f32) -> u32 {
    let range = volume_range(frustum, diameter);
    let spread = volume_spread(frustum, range);
    let radius = VOLUME_RADIUS * diameter;
    for (k, plane) in (0..).zip(&frustum.planes) {
        let plane = Vec4::from(*plane);
        let margin = radius + frustum.half_horizon * ((plane.w - speed * plane.y).abs() + spread);
        if plane.xyz().dot(offset) > margin {
            return k;
        }
    }
    let reach = range + frustum.half_wait * (speed + frustum.air + spread);
    if offset.dot(offset) > reach * reach { VOLUME_BALL } else { VOLUME_INSIDE }
}

/// Converts an offset from the eye to camera space: right, up, and forward.
#[must_use]
pub fn volume_local(eye: &VolumeEye, offset: Vec3) -> Vec3 {
    Vec3::new(
        offset.dot(Vec3::from(eye.right)),
        offset.dot(Vec3::from(eye.up)),
        offset.dot(Vec3::from(eye.forward)),
    )
}

/// Converts camera space to an offset from the eye.
#[must_use]
pub fn volume_offset(eye: &VolumeEye, local: Vec3) -> Vec3 {
    Vec3::from(eye.right) * local.x + Vec3::from(eye.up) * local.y + Vec3::from(eye.forward) * local.z
}

/// True if a position is in the rain area of Im & Sung: in the pyramid and in the sphere between eye and `range`.
#[must_use]
pub fn volume_in_area(eye: &VolumeEye, local: Vec3, range: f32) -> bool {
    let radius = 0.5 * range;
    let from_middle = local - Vec3::new(0.0, 0.0, radius);
    local.x.abs() <= local.z * eye.half_width
        && local.y.abs() <= local.z * eye.half_height
        && from_middle.dot(from_middle) <= radius * radius
}

/// Position in the sphere by Im & Sung, (3) and (4): three random numbers in [0, 1). Dense near the middle.
#[must_use]
pub fn volume_in_sphere(random: Vec3, range: f32) -> Vec3 {
    let radius = 0.5 * range;
    let along = 2.0 * random.y - 1.0;
    let across = (1.0 - along * along).max(0.0).sqrt();
    let angle = VOLUME_TURN * (random.x - 0.5);
    let distance = radius * (2.0 * random.z - 1.0);
    Vec3::new(
        distance * across * ops::cos(angle),
        distance * across * ops::sin(angle),
        radius + distance * along,
    )
}

/// Position on a disk of radius 1, from two random numbers in [0, 1).
#[must_use]
pub fn volume_on_disk(random: Vec2) -> Vec2 {
    let angle = VOLUME_TURN * (random.x - 0.5);
    random.y.sqrt() * Vec2::new(ops::cos(angle), ops::sin(angle))
}

/// Solid angle of a picture, sr.
#[must_use]
pub fn solid_angle(half_width: f64, half_height: f64) -> f64 {
    let (a, b) = (half_width, half_height);
    4.0 * ops64::asin(a * b / ((1.0 + a * a) * (1.0 + b * b)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use downpour_math::rng::{rng_draw, rng_unit};

    #[test]
    fn a_box_of_one_image() {
        let (center, size) = (Vec3::new(100.0, -3.0, 7.0), Vec3::new(4.0, 5.0, 6.0));
        for k in 0..1000 {
            let [x, y, z, _] = rng_draw([1, 2], k, 0, 0).map(|w| 400.0 * rng_unit(w) - 200.0);
            let position = Vec3::new(x, y, z);
            let kept = position - size * volume_images(position, center, size);
            assert!(((kept - center).abs() * 2.0).cmple(size + 1.0e-4).all(), "{kept}");
            let boxes = (kept - position) / size;
            assert!((boxes - boxes.round()).abs().max_element() < 1.0e-4, "{boxes}");
        }
    }

    /// A cube face seen from the center has 4 pi / 6.
    #[test]
    fn the_face_of_a_cube() {
        assert_relative_eq!(solid_angle(1.0, 1.0), 4.0 * std::f64::consts::PI / 6.0, max_relative = 1.0e-12);
    }
}
