//! The part of space that drops are simulated in, and where a drop goes that has left it. Twin of
//! `shaders/wgsl/sim/volume.wgsl`.
//!
//! In a box (Rousseau 2006, 7; 2008, 2.1) the rain is periodic: a drop goes to the opposite face. In a view (Im & Sung
//! 2022, 3.A and B) it is the pyramid of the picture up to the distance at which its size is resolved: the drop goes back
//! along the path that it came relative to the picture, to the first place on it that is in view. Both map the volume
//! onto itself and keep every part's size, so that a uniform density stays uniform however the camera moves.

use bytemuck::{Pod, Zeroable};
use downpour_math::ops;
use downpour_math::ops::f64 as ops64;
use downpour_shaders::sim::step::{STEP_BACKS, VOLUME_TURN};
use glam::{DMat3, DVec3, Mat3, Vec2, Vec3};

use crate::view::View;

/// The eye, and the part of space that it sees. The same layout as `VolumeEye` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct VolumeEye {
    /// m, relative to the origin of its time.
    pub place: [f32; 3],
    /// Half the width of the picture at distance 1.
    pub half_width: f32,
    /// Unit vector.
    pub right: [f32; 3],
    /// Half the height of the picture at distance 1.
    pub half_height: f32,
    /// Unit vector.
    pub up: [f32; 3],
    /// Padding of the WGSL layout.
    pub unused_1: u32,
    /// Unit vector.
    pub forward: [f32; 3],
    /// Padding of the WGSL layout.
    pub unused_2: u32,
}

impl VolumeEye {
    /// The eye of a view, in a place relative to `origin`.
    #[must_use]
    pub fn new(view: &View, origin: DVec3) -> Self {
        Self {
            place: (view.eye - origin).as_vec3().to_array(),
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

/// A number of steps backwards of the path relative to the picture, for a drop whose own way is `s` in each of them: from
/// c to turn c - sum s. The same layout as `VolumeBack` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct VolumeBack {
    /// Columns, each with a number of padding.
    pub turn: [[f32; 4]; 3],
    /// Columns, each with a number of padding.
    pub sum: [[f32; 4]; 3],
}

/// The widest turn of one look back, radians: between two places in view that are no farther apart on their path, the path
/// does not leave the view and come back.
const WIDEST_TURN: f64 = std::f64::consts::FRAC_PI_4;

/// 1, 2, 4, ... steps back of a camera whose axes (right, up, forward) turn from `before` to `now` in each. Where the turn
/// would be wider than an eighth of a circle, the last that is not stands again.
#[must_use]
pub fn volume_backs(before: [DVec3; 3], now: [DVec3; 3]) -> [VolumeBack; STEP_BACKS as usize] {
    let axes = |[right, up, forward]: [DVec3; 3]| DMat3::from_cols(right, up, forward);
    // A step forwards turns what the camera sees by now^T before; this is its inverse.
    let mut turn = axes(before).transpose() * axes(now);
    let mut sum = turn;
    let mut angle =
        ops64::acos(((turn.x_axis.x + turn.y_axis.y + turn.z_axis.z - 1.0) * 0.5).clamp(-1.0, 1.0));
    std::array::from_fn(|_| {
        let columns = |m: DMat3| m.to_cols_array_2d().map(|[x, y, z]| [x as f32, y as f32, z as f32, 0.0]);
        let back = VolumeBack { turn: columns(turn), sum: columns(sum) };
        if angle <= 0.5 * WIDEST_TURN {
            sum += turn * sum;
            turn *= turn;
            angle *= 2.0;
        }
        back
    })
}

fn matrix(columns: &[[f32; 4]; 3]) -> Mat3 {
    let [x, y, z] = columns.map(|[x, y, z, _]| Vec3::new(x, y, z));
    Mat3::from_cols(x, y, z)
}

/// A place in the periodic image of a box that is round `centre`.
#[must_use]
pub fn volume_wrap(place: Vec3, centre: Vec3, size: Vec3) -> Vec3 {
    place - size * ((place - centre) / size + 0.5).floor()
}

/// What the eye sees of an offset from it: to the right, up, and ahead.
#[must_use]
pub fn volume_local(eye: &VolumeEye, offset: Vec3) -> Vec3 {
    Vec3::new(
        offset.dot(Vec3::from(eye.right)),
        offset.dot(Vec3::from(eye.up)),
        offset.dot(Vec3::from(eye.forward)),
    )
}

/// The offset from the eye of what it sees.
#[must_use]
pub fn volume_offset(eye: &VolumeEye, local: Vec3) -> Vec3 {
    Vec3::from(eye.right) * local.x + Vec3::from(eye.up) * local.y + Vec3::from(eye.forward) * local.z
}

/// Whether a place is in the pyramid of the picture and no farther than `range`.
#[must_use]
pub fn volume_in_view(eye: &VolumeEye, local: Vec3, range: f32) -> bool {
    local.x.abs() <= local.z * eye.half_width
        && local.y.abs() <= local.z * eye.half_height
        && local.dot(local) <= range * range
}

/// A place on the path some steps ago.
#[must_use]
pub fn volume_back(back: &VolumeBack, local: Vec3, way: Vec3) -> Vec3 {
    matrix(&back.turn) * local - matrix(&back.sum) * way
}

/// Whether a place is in the rain area of Im & Sung: in the pyramid and in the sphere between eye and `range`.
#[must_use]
pub fn volume_in_area(eye: &VolumeEye, local: Vec3, range: f32) -> bool {
    let radius = 0.5 * range;
    let from_middle = local - Vec3::new(0.0, 0.0, radius);
    local.x.abs() <= local.z * eye.half_width
        && local.y.abs() <= local.z * eye.half_height
        && from_middle.dot(from_middle) <= radius * radius
}

/// A place in the sphere by Im & Sung, (3) and (4): three random numbers of [0, 1). Dense about the middle.
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

/// A place on a disc of radius 1, from two random numbers of [0, 1).
#[must_use]
pub fn volume_on_disc(random: Vec2) -> Vec2 {
    let angle = VOLUME_TURN * (random.x - 0.5);
    random.y.sqrt() * Vec2::new(ops::cos(angle), ops::sin(angle))
}

/// The solid angle of a picture, sr.
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
        let (centre, size) = (Vec3::new(100.0, -3.0, 7.0), Vec3::new(4.0, 5.0, 6.0));
        for k in 0..1000 {
            let [x, y, z, _] = rng_draw([1, 2], k, 0, 0).map(|w| 400.0 * rng_unit(w) - 200.0);
            let place = Vec3::new(x, y, z);
            let kept = volume_wrap(place, centre, size);
            assert!(((kept - centre).abs() * 2.0).cmple(size + 1.0e-4).all(), "{kept}");
            let boxes = (kept - place) / size;
            assert!((boxes - boxes.round()).abs().max_element() < 1.0e-4, "{boxes}");
        }
    }

    /// All of it seen from within is 4 pi / 6 through a face of a cube.
    #[test]
    fn the_face_of_a_cube() {
        assert_relative_eq!(solid_angle(1.0, 1.0), 4.0 * std::f64::consts::PI / 6.0, max_relative = 1.0e-12);
    }

    /// Powers of the step back are the step back, repeated.
    #[test]
    fn steps_back_are_repeated_steps() {
        let turned = |angle: f64| {
            let (s, c) = (downpour_math::ops::f64::sin(angle), downpour_math::ops::f64::cos(angle));
            [DVec3::new(c, 0.0, s), DVec3::Y, DVec3::new(s, 0.0, -c)]
        };
        let backs = volume_backs(turned(0.3), turned(0.31));
        let way = Vec3::new(0.01, -0.1, 0.03);
        let start = Vec3::new(0.5, 1.0, 4.0);
        let mut one = start;
        for step in 1..=64u32 {
            one = volume_back(&backs[0], one, way);
            if step.is_power_of_two() {
                let at_once = volume_back(&backs[step.ilog2() as usize], start, way);
                assert!((at_once - one).length() < 2.0e-4, "{step}: {at_once}, {one}");
            }
        }
    }
}
