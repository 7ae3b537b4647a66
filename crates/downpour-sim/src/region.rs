//! Regions of space from which drops enter.

use bytemuck::{Pod, Zeroable};

/// Region of space of the candidates of a bin of sizes, in the layout of `EnterRegion` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct EnterRegion {
    /// Plane, or `VOLUME_BALL`.
    pub face: u32,
    /// Index of the bin.
    pub bin: u32,
    /// Number of its first candidate among all.
    pub first: u32,
    /// Number of its first candidate among those of its bin.
    pub first_of_bin: u32,
    /// Minimum distance from the plane, or radius, m.
    pub low: f32,
    /// Maximum distance from the plane, or radius, m.
    pub high: f32,
    /// Start along the tangent, m.
    pub begin: f32,
    /// End along the tangent, m.
    pub end: f32,
    /// Increase of half the width per m along the tangent. For the ball, 1 - cos of the cone's half angle.
    pub slope: f32,
    /// Half the width at the eye, m; below 0 where a margin takes the plane away from the view.
    pub width: f32,
    /// Center across, m.
    pub middle: f32,
    /// Padding of the WGSL layout.
    pub unused: u32,
}
