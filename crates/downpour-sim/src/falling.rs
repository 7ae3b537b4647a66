//! Drops in the form that a picture needs.

use downpour_math::ops;
use downpour_shaders::sim::field::{FIELD_BOUNCED, FIELD_DRIPPED, FIELD_NORMAL_STEPS, FIELD_SPLASH};
use glam::{DVec3, Vec3};

use crate::resolved::Resolved;
use crate::view::View;

/// Origin of a drop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum DropKind {
    /// Falls from the sky.
    #[default]
    Falling,
    /// Rebounds from a surface that another drop hit.
    Bounced,
    /// Crown of the splash of a drop that hit a surface.
    Splash,
    /// Hangs at an edge, or falls from it.
    Dripped,
}

impl DropKind {
    /// Name in lists of drops.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Falling => "falling",
            Self::Bounced => "bounced",
            Self::Splash => "splash",
            Self::Dripped => "dripped",
        }
    }
}

/// A drop at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingDrop {
    /// Position of its center, m, at [`FallingDrop::seen_s`]; of a splash that of the middle of its height.
    pub position: DVec3,
    /// Velocity, m/s.
    pub velocity: [f32; 3],
    /// Volume-equivalent diameter, meters; of a splash the largest diameter of its crown.
    pub diameter: f32,
    /// Id of the drop: the same at other times and in other pictures.
    pub id: u64,
    /// Origin of the drop.
    pub kind: DropKind,
    /// Part of the exposure in which the drop exists, s from the picture's time: [`FallingDrop::ALWAYS`] unless it
    /// lands or starts while the shutter is open. A splash is from the impact to the end of its crown.
    pub present_s: [f32; 2],
    /// Unit normal of the surface on which a splash stands; [`FallingDrop::LEVEL`] on level ground, and for all other drops.
    pub normal: [f32; 3],
}

impl FallingDrop {
    /// Value of `present_s` for a drop that exists all the time.
    pub const ALWAYS: [f32; 2] = [f32::NEG_INFINITY, f32::INFINITY];

    /// Normal of level ground.
    pub const LEVEL: [f32; 3] = [0.0, 1.0, 0.0];

    /// Time relative to the picture's, s, at which the drop is at its position: 0 if it exists at the picture's time,
    /// else the time at which it lands or starts.
    #[must_use]
    pub fn seen_s(&self) -> f32 {
        let [begin, end] = self.present_s;
        if end < 0.0 { end } else { begin.max(0.0) }
    }

    /// The drop in the part of a view's exposure in which it is beyond a pane that moves with the camera; `None` if it
    /// never is. `outward` and `distance` are the pane's unit normal, away from the eye, and its distance from the eye,
    /// m. A splash counts by its position at the picture's time.
    #[must_use]
    pub fn beyond(&self, outward: Vec3, distance: f32, view: &View) -> Option<Self> {
        let half_time = if self.kind == DropKind::Splash { 0.0 } else { (0.5 * view.shutter_s) as f32 };
        let (drop, velocity, turning) =
            (EyeDrop::new(self, view.eye), view.velocity.as_vec3(), view.turning.as_vec3());
        let [open, close] = [-half_time, half_time]
            .map(|time| drop.eye_drop_position(velocity, turning, time).dot(outward) - distance);
        let [begin, end] = eye_drop_outside(open, close, half_time).map(forever);
        let mut kept = *self;
        kept.present_s = [self.present_s[0].max(begin), self.present_s[1].min(end)];
        kept.position += (Vec3::from(self.velocity) * (kept.seen_s() - self.seen_s())).as_dvec3();
        (kept.present_s[0] <= kept.present_s[1]).then_some(kept)
    }
}

/// A time of [`EyeDrop::present`] with infinities.
fn forever(time: f32) -> f32 {
    if time.abs() < ALWAYS_S { time } else { time * f32::INFINITY }
}

/// Numbers beyond these are as good as infinite, s: shaders have no infinities.
const ALWAYS_S: f32 = downpour_shaders::sim::field::FIELD_ALWAYS;

/// A drop relative to the eye. The same layout as `EyeDrop` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct EyeDrop {
    /// Position at the time of the picture, or where it would be then, m.
    pub offset: [f32; 3],
    /// Volume-equivalent diameter, m; 0 for an empty place in a list.
    pub diameter: f32,
    /// Velocity, m/s.
    pub velocity: [f32; 3],
    /// Both halves of its id, one over the other: 32 bits from which its oscillation is drawn.
    pub id: u32,
    /// Part of the exposure in which it exists, s from the picture's time.
    pub present: [f32; 2],
    /// Terminal speed, m/s; `FIELD_BOUNCED` if it is not known or for a droplet that rebounded, `FIELD_DRIPPED` for a drop that drips; of a
    /// splash [`eye_drop_standing`].
    pub speed: f32,
    /// Lower half of its id.
    pub id_low: u32,
}

impl EyeDrop {
    /// A drop that is seen from `eye` (in f64, so that drops far from the origin keep their places).
    #[must_use]
    pub fn new(drop: &FallingDrop, eye: DVec3) -> Self {
        let moved = Vec3::from(drop.velocity) * drop.seen_s();
        Self {
            offset: ((drop.position - eye).as_vec3() - moved).into(),
            diameter: drop.diameter,
            velocity: drop.velocity,
            id: drop.id as u32 ^ (drop.id >> 32) as u32,
            present: drop.present_s.map(|time| time.clamp(-ALWAYS_S, ALWAYS_S)),
            speed: match drop.kind {
                DropKind::Splash => eye_drop_standing(drop.normal.into()),
                DropKind::Dripped => FIELD_DRIPPED,
                _ => FIELD_BOUNCED,
            },
            id_low: drop.id as u32,
        }
    }

    /// The drop in the world, as `eye` sees it: what [`EyeDrop::new`] has made of it, to the digits of f32.
    #[must_use]
    pub fn to_falling(&self, eye: DVec3, kind: DropKind) -> FallingDrop {
        let mut drop = FallingDrop {
            position: eye + Vec3::from(self.offset).as_dvec3(),
            velocity: self.velocity,
            diameter: self.diameter,
            id: u64::from(self.id ^ self.id_low) << 32 | u64::from(self.id_low),
            kind,
            present_s: self.present.map(forever),
            normal: match kind {
                DropKind::Splash => eye_drop_normal(self.speed).into(),
                _ => FallingDrop::LEVEL,
            },
        };
        drop.position += (Vec3::from(self.velocity) * drop.seen_s()).as_dvec3();
        drop
    }

    /// Position relative to an eye that moves and turns, at a time relative to the picture's, s. Twin of the function of this name in
    /// `shaders/wgsl/sim/eye_drop.wgsl`.
    #[must_use]
    pub fn eye_drop_position(&self, velocity: Vec3, turning: Vec3, time: f32) -> Vec3 {
        let moved = Vec3::from(self.offset) + (Vec3::from(self.velocity) - velocity) * time;
        eye_drop_turned(moved, turning * -time)
    }
}

/// The normal of a surface that does not look down, as a whole number of `FIELD_SPLASH` or below: two numbers of the upper half of an
/// octahedron, unfolded. Twin of the function of this name in `shaders/wgsl/sim/eye_drop.wgsl`.
#[must_use]
pub fn eye_drop_standing(normal: Vec3) -> f32 {
    let steps = FIELD_NORMAL_STEPS as f32;
    let size = normal.abs().element_sum().max(1.0e-20);
    let step = |part: f32| ((part / size).clamp(-1.0, 1.0) * steps + 0.5).floor() + steps;
    FIELD_SPLASH - (step(normal.x + normal.z) * (2.0 * steps + 1.0) + step(normal.x - normal.z))
}

/// The normal of the surface on which a splash stands, from its [`eye_drop_standing`]. Twin of the function of this name in
/// `shaders/wgsl/sim/eye_drop.wgsl`.
#[must_use]
pub fn eye_drop_normal(speed: f32) -> Vec3 {
    let width = 2 * FIELD_NORMAL_STEPS + 1;
    let code = (FIELD_SPLASH - speed).max(0.0) as u32;
    let [first, second] = [code / width, code % width]
        .map(|k| (k as f32 - FIELD_NORMAL_STEPS as f32) / FIELD_NORMAL_STEPS as f32);
    let (x, z) = (0.5 * (first + second), 0.5 * (first - second));
    let normal = Vec3::new(x, (1.0 - x.abs() - z.abs()).max(0.0), z);
    normal / normal.length()
}

/// Part of the exposure, s from its middle, in which a drop is beyond a pane, from its distances beyond it at the begin and
/// the end, m; the first time is above the last if it never is. Twin of the function of this name in
/// `shaders/wgsl/sim/eye_drop.wgsl`.
#[must_use]
pub fn eye_drop_outside(begin: f32, end: f32, half_time: f32) -> [f32; 2] {
    let mut part = [-ALWAYS_S, ALWAYS_S];
    if begin < 0.0 && end < 0.0 {
        return [ALWAYS_S, -ALWAYS_S];
    }
    let crossing = half_time * ((begin + end) / (begin - end).abs().max(1.0e-30));
    if begin < 0.0 {
        part[0] = -crossing;
    }
    if end < 0.0 {
        part[1] = crossing;
    }
    part
}

/// A vector turned about an axis by the axis's length, in radians.
#[doc(hidden)]
#[must_use]
pub fn eye_drop_turned(v: Vec3, axis: Vec3) -> Vec3 {
    let angle = axis.length();
    if angle < 1.0e-9 {
        return v;
    }
    let unit = axis / angle;
    let (sine, cosine) = (ops::sin(angle), ops::cos(angle));
    v * cosine + unit.cross(v) * sine + unit * (unit.dot(v) * (1.0 - cosine))
}

/// The drops that a camera can resolve.
#[derive(Clone, Debug, PartialEq)]
pub struct VisibleDrops {
    /// Drops, in an order that depends on the query only.
    pub drops: Vec<FallingDrop>,
    /// Number of drops that were examined to find them.
    pub simulated: u64,
    /// Limits of the list; all other drops of the rain are unresolved. `least_pixels` is raised if there would be too
    /// many.
    pub resolved: Resolved,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Level ground comes back exactly, other normals to a thousandth; all are told from the speeds of other drops.
    #[test]
    fn normals_of_splashes_come_back() {
        assert_eq!(eye_drop_normal(eye_drop_standing(Vec3::Y)), Vec3::Y);
        for k in 0..2000u16 {
            let (turn, up) = (f32::from(k) * 0.37, f32::from(k % 101) / 100.0);
            let level = (1.0 - up * up).sqrt();
            let normal = Vec3::new(level * ops::cos(turn), up, level * ops::sin(turn));
            let speed = eye_drop_standing(normal);
            assert!(speed <= FIELD_SPLASH && speed.fract() == 0.0, "{speed}");
            let found = eye_drop_normal(speed);
            assert!(found.distance(normal) < 1.0e-3, "{normal}: {found}");
        }
    }
}
