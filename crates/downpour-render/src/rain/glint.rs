//! Position on a drop at which the light of a lamp leaves it, as the viewer sees it. Twin of
//! `shaders/wgsl/render/drop_glint.wgsl`.
//!
//! `light` leads from the drop to the lamp, `towards` from the eye to the drop; directions have length 1. Positions on the
//! disk are in radii, along the right and the up of the view.

use downpour_math::octant::octant_turns;
use downpour_shaders::render::drop_light::{
    DROP_GLINT_AXIS, DROP_GLINT_MASK, DROP_GLINT_NUMBER, DROP_GLINT_RANGE, DROP_GLINT_STEPS, DROP_GLINT_TINY,
    DROP_GLINT_WIDTH_MASK, DROP_GLINT_WIDTHS, DROP_LIGHT_EXTERNAL, DROP_LIGHT_INTERNAL,
};
use glam::{Vec2, Vec3};

/// Right axis of the view of a drop, horizontal; +x where the view is vertical. Up is `right.cross(toward)`.
#[must_use]
pub fn drop_glint_right(towards: Vec3) -> Vec3 {
    let sideways = Vec3::new(-towards.z, 0.0, towards.x);
    let level = sideways.dot(sideways);
    if level > DROP_GLINT_AXIS { sideways / level.max(DROP_GLINT_TINY).sqrt() } else { Vec3::X }
}

/// The scattering angle over pi: 0 for a lamp behind the drop, 1 for one behind the eye.
///
/// ```
/// use downpour_render::rain::glint::drop_glint_angle;
/// use glam::Vec3;
/// assert_eq!(drop_glint_angle(Vec3::Z, Vec3::Z), 0.0);
/// assert_eq!(drop_glint_angle(Vec3::Y, Vec3::Z), 0.5);
/// assert_eq!(drop_glint_angle(Vec3::NEG_Z, Vec3::Z), 1.0);
/// ```
#[must_use]
pub fn drop_glint_angle(light: Vec3, towards: Vec3) -> f32 {
    let apart = light - towards;
    let along = light + towards;
    // Sine and cosine of half the angle, twice: exact at both ends, where a cosine of the angle would not be.
    let (s, c) = (apart.dot(apart).sqrt(), along.dot(along).sqrt());
    let t = s.min(c) / s.max(c).max(DROP_GLINT_TINY);
    let octant = octant_turns(t);
    4.0 * if c < s { 0.25 - octant } else { octant }
}

/// Unit vector on the disk to the side of the lamp; right if the lamp is on the axis.
#[must_use]
pub fn drop_glint_side(light: Vec3, right: Vec3, up: Vec3) -> Vec2 {
    let side = Vec2::new(light.dot(right), light.dot(up));
    let square = side.dot(side);
    if square > DROP_GLINT_AXIS { side / square.max(DROP_GLINT_TINY).sqrt() } else { Vec2::X }
}

/// Packs a position on the disk and the radius of a lamp's image there, up to a radius of the disk, into the bits of one number: the
/// position to within 1/1022 of a radius, the image finer the smaller it is.
#[must_use]
pub fn drop_glint_pack(position: Vec2, image: f32) -> f32 {
    let steps =
        (position.clamp(Vec2::NEG_ONE, Vec2::ONE) * DROP_GLINT_STEPS + 0.5 * DROP_GLINT_RANGE).floor();
    let width = (image.clamp(0.0, 1.0).sqrt() * DROP_GLINT_WIDTHS + 0.5) as u32;
    f32::from_bits(DROP_GLINT_NUMBER | (steps.x as u32) << 19 | (steps.y as u32) << 9 | width)
}

/// Unpacks a position.
#[must_use]
pub fn drop_glint_unpack(word: f32) -> Vec2 {
    let bits = word.to_bits();
    let steps = [bits >> 19, bits >> 9].map(|steps| (steps & DROP_GLINT_MASK) as f32);
    (Vec2::from(steps) + (0.5 - 0.5 * DROP_GLINT_RANGE)) / DROP_GLINT_STEPS
}

/// Unpacks the radius of an image.
#[must_use]
pub fn drop_glint_image(word: f32) -> f32 {
    let width = (word.to_bits() & DROP_GLINT_WIDTH_MASK) as f32 / DROP_GLINT_WIDTHS;
    width * width
}

/// Sine of the scattering angle: twice that of its half times the cosine of its half, exact at both ends.
#[must_use]
pub fn drop_glint_sine(light: Vec3, towards: Vec3) -> f32 {
    let (apart, along) = (light - towards, light + towards);
    0.5 * (apart.dot(apart) * along.dot(along)).sqrt()
}

/// The part of a bump from -1 to 1 that lies before a position, 0 to 1.
#[must_use]
pub fn drop_glint_before(position: f32) -> f32 {
    let t = (0.5 + 0.5 * position).clamp(0.0, 1.0);
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// The part of a glint that a pixel has: a bump that reaches `reach` pixels from its middle, which is `offset` pixels from the pixel's
/// upper left corner. All pixels together have all of it.
#[must_use]
pub fn drop_glint_pixel(offset: Vec2, reach: f32) -> f32 {
    let part = |offset: f32| drop_glint_before((1.0 - offset) / reach) - drop_glint_before(-offset / reach);
    part(offset.x) * part(offset.y)
}

/// Normalized horizontal part (x, z) of a direction; 0 for a vertical one.
#[must_use]
pub fn drop_glint_level(direction: Vec3) -> Vec2 {
    let level = Vec2::new(direction.x, direction.z);
    level / level.dot(level).max(DROP_GLINT_TINY).sqrt()
}

/// Rousseau 2006, section 6, at a position with a normal: `(V_PE . V_N) (A_2 + A_3)`, to be multiplied with the lamp's color
/// and attenuation. The plane in which rays do not go sideways is the level one. `terms` is `DROP_LIGHT_EXTERNAL` (1) for `A_2`,
/// `DROP_LIGHT_INTERNAL` (2) for `A_3`, or both (3).
#[must_use]
pub fn drop_glint_rousseau(normal: Vec3, to_eye: Vec3, light: Vec3, terms: u32) -> f32 {
    let facing = to_eye.dot(normal);
    let lit = light.dot(normal);
    let outside = lit.max(0.0);
    let across = -drop_glint_level(light).dot(drop_glint_level(normal));
    let within = (across * (1.0 + lit)).max(0.0);
    let outside = if terms & DROP_LIGHT_EXTERNAL == 0 { 0.0 } else { outside };
    let within = if terms & DROP_LIGHT_INTERNAL == 0 { 0.0 } else { within };
    facing * (outside + within)
}
