//! Drops as a picture takes them.

use glam::DVec3;

use crate::resolved::Resolved;

/// Where a drop comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum DropKind {
    /// The sky.
    #[default]
    Falling,
    /// A surface that another drop met.
    Bounced,
}

impl DropKind {
    /// As lists of drops name it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Falling => "falling",
            Self::Bounced => "bounced",
        }
    }
}

/// A drop at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingDrop {
    /// Position of its center, m, at [`FallingDrop::seen_s`].
    pub position: DVec3,
    /// Velocity, m/s.
    pub velocity: [f32; 3],
    /// Volume-equivalent diameter, metres.
    pub diameter: f32,
    /// The same drop at another time or in another picture has the same number.
    pub id: u64,
    /// Where it comes from.
    pub kind: DropKind,
    /// Part of the exposure in which it is there, s from the picture's time: [`FallingDrop::ALWAYS`] unless it lands or
    /// begins while the shutter is open.
    pub present_s: [f32; 2],
}

impl FallingDrop {
    /// A drop that is there all the time.
    pub const ALWAYS: [f32; 2] = [f32::NEG_INFINITY, f32::INFINITY];

    /// Time from the picture's, s, at which it is at its position: 0 if it is there at the picture's time, else when it lands
    /// or begins.
    #[must_use]
    pub fn seen_s(&self) -> f32 {
        let [begin, end] = self.present_s;
        if end < 0.0 { end } else { begin.max(0.0) }
    }
}

/// The drops that a camera can resolve.
#[derive(Clone, Debug, PartialEq)]
pub struct VisibleDrops {
    /// The drops, in an order that depends on nothing but the question.
    pub drops: Vec<FallingDrop>,
    /// How many drops were looked at to find them.
    pub simulated: u64,
    /// Limits of the list; all other drops of the rain are unresolved. `least_pixels` is raised where there would have been
    /// too many.
    pub resolved: Resolved,
}
