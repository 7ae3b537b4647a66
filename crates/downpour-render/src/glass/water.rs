//! Water on a pane as smooth surfaces. Twin of `shaders/wgsl/render/glass_picture_water.wgsl`.
//!
//! Each drop is a cap of a sphere over its disk, with an outline that is not quite round, drawn out behind if it runs, and
//! steeper on the side to which its weight pulls it: from the receding angle to the advancing one. Water ahead of a wiper is a ridge:
//! pieces of a cylinder with round ends, which overlap.

use downpour_shaders::render::glass::GLASS_PICTURE_TURNS;
use glam::{Vec2, Vec3};

/// A drop on a pane, in meters: x right, y down, z out of the pane. The same layout as `GlassPictureDrop` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassPictureDrop {
    /// Middle of the disk.
    pub center: [f32; 2],
    /// Radius of the disk.
    pub radius: f32,
    /// Radius of the sphere whose cap it is.
    pub sphere: f32,
    /// Direction in which it runs, of length 1.
    pub along: [f32; 2],
    /// Inverse of how much longer it is behind its middle than before it.
    pub behind: f32,
    /// Relative excess of the slope on one side over that on the other.
    pub lean: f32,
    /// Direction of the steeper side, of length 1.
    pub droop: [f32; 2],
    /// Half of the axis of a ridge: the cap is that of the nearest position of the axis. 0: a drop.
    pub axis: [f32; 2],
    /// Harmonics of the outline: added to the squared distance with the cosine and sine of twice and of three times the angle.
    pub lobes: [f32; 4],
}

impl GlassPictureDrop {
    /// Distance from its center beyond which it is nowhere, m.
    pub(super) fn reach(&self) -> f32 {
        1.5 * self.radius / self.behind + Vec2::from(self.axis).length()
    }
}

/// Vector from the center of a drop, or the nearest position of a ridge's axis, to a position.
#[must_use]
pub fn glass_picture_water_away(drop: &GlassPictureDrop, position: Vec2) -> Vec2 {
    let away = position - Vec2::from(drop.center);
    let axis = Vec2::from(drop.axis);
    let squared = axis.x * axis.x + axis.y * axis.y;
    let fraction = (away.x * axis.x + away.y * axis.y) / squared.max(1.0e-18);
    away - axis * fraction.clamp(-1.0, 1.0)
}

/// Height over the glass, and its slopes along x and y. Beyond the outline the height is below 0.
#[must_use]
pub fn glass_picture_water_cap(drop: &GlassPictureDrop, position: Vec2) -> Vec3 {
    let away = glass_picture_water_away(drop, position);
    let (along, droop) = (Vec2::from(drop.along), Vec2::from(drop.droop));
    let ahead = away.x * along.x + away.y * along.y;
    let stretch = if ahead > 0.0 { 1.0 } else { drop.behind };
    let x = ahead * stretch;
    let y = away.y * along.x - away.x * along.y;
    let l = drop.lobes;
    let r = 1.0 / drop.radius;
    let squared = x * x
        + y * y
        + l[0] * (x * x - y * y)
        + l[1] * (2.0 * x * y)
        + (l[2] * (x * x * x - 3.0 * x * y * y) + l[3] * (3.0 * x * x * y - y * y * y)) * r;
    let of_x = 2.0 * x
        + l[0] * (2.0 * x)
        + l[1] * (2.0 * y)
        + (l[2] * (3.0 * x * x - 3.0 * y * y) + l[3] * (6.0 * x * y)) * r;
    let of_y = 2.0 * y - l[0] * (2.0 * y)
        + l[1] * (2.0 * x)
        + (l[3] * (3.0 * x * x - 3.0 * y * y) - l[2] * (6.0 * x * y)) * r;
    let whole = drop.sphere * drop.sphere;
    let root = (whole - squared).max(whole * 1.0e-4).sqrt();
    let height = root - (whole - drop.radius * drop.radius).sqrt();
    let steep = -0.5 / root;
    let down_x = steep * of_x * stretch;
    let down_y = steep * of_y;
    let slope = along * down_x + Vec2::new(-along.y, along.x) * down_y;
    let pulled = drop.lean * r;
    // A ridge grows along its axis.
    let off = position - Vec2::from(drop.center);
    let fraction = (1.0 + pulled * (off.x * droop.x + off.y * droop.y)).max(0.1);
    let slope = slope * fraction + droop * (height * pulled);
    Vec3::new(height * fraction, slope.x, slope.y)
}

/// Maximum height of a drop.
#[must_use]
pub fn glass_picture_water_top(drop: &GlassPictureDrop) -> f32 {
    let whole = drop.sphere * drop.sphere;
    (drop.sphere - (whole - drop.radius * drop.radius).sqrt()) * (1.0 + 1.5 * drop.lean)
}

/// Height at which a ray that enters a drop at a position of the glass leaves it. `aside` is how far it goes along the pane for
/// each meter away from it. The bracket of regula falsi (Illinois).
#[must_use]
pub fn glass_picture_water_leave(drop: &GlassPictureDrop, position: Vec2, aside: Vec2) -> f32 {
    let mut low = 0.0;
    let mut high = glass_picture_water_top(drop);
    let mut above = glass_picture_water_cap(drop, position).x;
    let mut below = glass_picture_water_cap(drop, position + aside * high).x - high;
    if below >= 0.0 {
        return high;
    }
    let mut z = 0.0;
    let mut side = 0;
    for _ in 0..GLASS_PICTURE_TURNS {
        z = low + (high - low) * (above / (above - below));
        let off = glass_picture_water_cap(drop, position + aside * z).x - z;
        if off > 0.0 {
            low = z;
            above = off;
            below = if side == 1 { 0.5 * below } else { below };
            side = 1;
        } else {
            high = z;
            below = off;
            above = if side == 2 { 0.5 * above } else { above };
            side = 2;
        }
    }
    z
}

/// The unit normal of a surface from its slopes.
#[must_use]
pub fn glass_picture_water_normal(slope: Vec2) -> Vec3 {
    Vec3::new(-slope.x, -slope.y, 1.0) / (1.0 + slope.x * slope.x + slope.y * slope.y).sqrt()
}
