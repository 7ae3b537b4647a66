//! Drops that enter a frustum: candidates in thin regions at its planes and its ball, with the density of the rain,
//! each moved by a step as any drop and kept if it arrives. Twin of `shaders/wgsl/sim/enter.wgsl`.
//!
//! A region's candidates are uniform between two distances from its plane and in a trapezoid along it, or between two
//! radii of the ball and in a cone of directions. The first limit that a candidate violates before the step has to be
//! that of its region: no part of space is filled twice.

use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::sim::enter::{ENTER_DRAW, ENTER_SIZES, ENTER_UNIT};
use downpour_shaders::sim::step::{STEP_COUNT, STEP_FALLING, STEP_GONE, VOLUME_BALL, VOLUME_PLANES};
use glam::{Vec3, Vec3Swizzles as _, Vec4, Vec4Swizzles as _};

use crate::motion::motion_diameter;
pub use crate::region::EnterRegion;
use crate::step::{StepDrop, StepMade, StepWorld, step_word};
use crate::volume::volume_limit;

/// Interpolates a diameter in 16 bits between two quantiles.
#[must_use]
pub fn enter_code(lower: f32, upper: f32, fraction: f32) -> u32 {
    (lower + (upper - lower) * fraction + 0.5) as u32
}

/// Number in [0, 1) from the low bits of three words, which [`rng_unit`] does not use.
#[must_use]
pub fn enter_chance([x, y, z, _]: [u32; 4]) -> f32 {
    (x & 255 | (y & 255) << 8 | (z & 255) << 16) as f32 * ENTER_UNIT
}

/// Offset from the eye of a candidate, and 1; 0 for a rejected candidate. `normal` and `tangent` are those of the
/// plane, for the ball those of the back.
#[must_use]
pub fn enter_offset(region: &EnterRegion, normal: Vec3, tangent: Vec3, random: Vec3, chance: f32) -> Vec4 {
    let across = normal.cross(tangent);
    let distance = region.low + (region.high - region.low) * random.x;
    if region.face == VOLUME_BALL {
        let disk = 2.0 * random.yz() - 1.0;
        let square = disk.dot(disk);
        let lean = square * region.slope;
        let aside = disk * (region.slope * (2.0 - lean).max(0.0)).sqrt();
        let direction = tangent * aside.x + across * aside.y - normal * (1.0 - lean);
        let there = square <= 1.0 && chance * region.high * region.high <= distance * distance;
        return (direction * distance).extend(if there { 1.0 } else { 0.0 });
    }
    // The density along the tangent grows with the width.
    let near = region.width + region.slope * region.begin;
    let far = region.width + region.slope * region.end;
    let root = (near * near + random.y * (far * far - near * near)).max(0.0).sqrt();
    let fraction = random.y * (near + far) / (near + root).max(1.0e-12);
    let along = region.begin + (region.end - region.begin) * fraction;
    let aside = region.middle + (region.width + region.slope * along) * (2.0 * random.z - 1.0);
    (normal * distance + tangent * along + across * aside).extend(1.0)
}

impl StepWorld<'_> {
    /// Returns the drop that a candidate of a region becomes, if it enters.
    #[must_use]
    pub fn enter_drop(&self, region: &EnterRegion, number: u32) -> Option<StepMade> {
        let frame = self.frame;
        let dimension = ENTER_DRAW + region.bin * (VOLUME_BALL + 1) + region.face;
        let words = rng_draw(frame.seed, number, frame.step, dimension);
        let [x, y, z, w] = words.map(rng_unit);
        let quantile = w * (ENTER_SIZES - 1) as f32;
        let sizes = self.sizes.get(region.bin as usize)?;
        let size = |entry: usize| sizes.get(entry).copied().unwrap_or(0.0);
        let entry = quantile as usize;
        let bits = enter_code(size(entry), size(entry + 1), quantile - quantile.floor());
        let plane = region.face.min(VOLUME_PLANES - 1) as usize;
        let normal = Vec4::from(frame.frustum_before.planes[plane]).xyz();
        let tangent = Vec4::from(frame.tangents[plane]).xyz();
        let offset = enter_offset(region, normal, tangent, Vec3::new(x, y, z), enter_chance(words));
        if offset.w == 0.0 {
            return None;
        }
        let diameter = motion_diameter(bits);
        let speed = self.step_speed(diameter);
        if volume_limit(&frame.frustum_before, offset.xyz(), diameter, speed) != region.face {
            return None;
        }
        // Position at the middle of the horizon, and now.
        let ahead = Vec3::from(frame.frustum_before.eye) + offset.xyz();
        let velocity = self.step_coming(ahead, speed);
        let position = ahead - velocity * frame.frustum_before.half_horizon;
        if self.map.is_some_and(|map| !map.open(position)) {
            return None;
        }
        let count = region.first_of_bin.wrapping_add(number) & STEP_COUNT;
        let made = self.step_view(&StepDrop {
            position: position.to_array(),
            word: step_word(bits, STEP_FALLING, count),
            velocity: velocity.to_array(),
            last: frame.step,
        });
        (made.drop.kind() != STEP_GONE || made.event.is_some() || made.caught.is_some()).then_some(made)
    }
}
