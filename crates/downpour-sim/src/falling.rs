//! Drops in the form that a picture needs.

use glam::DVec3;

use crate::resolved::Resolved;

/// Origin of a drop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum DropKind {
    /// Falls from the sky.
    #[default]
    Falling,
    /// Rebounds from a surface that another drop hit.
    Bounced,
}

impl DropKind {
    /// Name in lists of drops.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Falling => "falling",
            Self::Bounced => "bounced",
        }
    }
}

/// A drop at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingDrop {
    /// Position of its center, m, at [`FallingDrop::seen_s`].
    pub position: DVec3,
    /// Velocity, m/s.
    pub velocity: [f32; 3],
    /// Volume-equivalent diameter, meters.
    pub diameter: f32,
    /// Id of the drop: the same at other times and in other pictures.
    pub id: u64,
    /// Origin of the drop.
    pub kind: DropKind,
    /// Part of the exposure in which the drop exists, s from the picture's time: [`FallingDrop::ALWAYS`] unless it
    /// lands or starts while the shutter is open.
    pub present_s: [f32; 2],
}

impl FallingDrop {
    /// Value of `present_s` for a drop that exists all the time.
    pub const ALWAYS: [f32; 2] = [f32::NEG_INFINITY, f32::INFINITY];

    /// Time relative to the picture's, s, at which the drop is at its position: 0 if it exists at the picture's time,
    /// else the time at which it lands or starts.
    #[must_use]
    pub fn seen_s(&self) -> f32 {
        let [begin, end] = self.present_s;
        if end < 0.0 { end } else { begin.max(0.0) }
    }
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
