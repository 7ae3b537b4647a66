//! Parts of space that drops come in from.

use bytemuck::{Pod, Zeroable};

/// A part of space that candidates of a bin of sizes come from. The same layout as `EnterRegion` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct EnterRegion {
    /// The plane, or `VOLUME_BALL`.
    pub face: u32,
    /// The bin.
    pub bin: u32,
    /// Number of its first candidate among all.
    pub first: u32,
    /// Number of its first candidate among those of its bin.
    pub first_of_bin: u32,
    /// Least distance from the plane, or radius, m.
    pub low: f32,
    /// Largest distance from the plane, or radius, m.
    pub high: f32,
    /// Beginning along the tangent, m.
    pub begin: f32,
    /// End along the tangent, m.
    pub end: f32,
    /// Growth of half the width per m along the tangent. Of the ball 1 - cos of the cone's half angle.
    pub slope: f32,
    /// Half the width at the eye, m.
    pub width: f32,
    /// Middle across, m.
    pub middle: f32,
    /// Padding of the WGSL layout.
    pub unused: u32,
}
