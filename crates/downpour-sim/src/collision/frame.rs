//! Position and resolution of a map.

use downpour_bvh::{Bvh, BvhNode, BvhTriangle, bvh_bounds};
use downpour_math::OutOfRange;
use downpour_math::ops;
use downpour_shaders::sim::collision::COLLISION_STEEP;
use glam::Vec3;

use crate::SimError;

/// Cosine of the largest angle between the fall and the vertical: 80 degrees.
const MIN_DOWN: f32 = 0.173_648_18;
/// Distance below which surfaces are merged, m.
const MERGE_M: f32 = 1.0e-3;
/// The same as a fraction of the largest coordinate: rounding error.
const MERGE_FRACTION: f32 = 1.0e-6;
/// Maximum coordinate, m.
const MAX_COORDINATE_M: f32 = 1.0e7;
/// Maximum number of texels along an edge.
const MAX_TEXELS: u32 = 4096;

/// Position and resolution of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionOptions {
    /// Mean fall direction of the drops, of any length, within 80 degrees of down.
    pub fall: Vec3,
    /// Position below the center of the map, m.
    pub center: Vec3,
    /// Edges of the map across and along, perpendicular to the fall, m.
    pub size: [f32; 2],
    /// Number of texels across and along, 1 to 4096.
    pub texels: [u32; 2],
    /// Origin of the drops' coordinates in those of the triangles, m: the offset that is added to the position of a
    /// drop. It keeps precision far from the origin of the scene; all other positions here are in the drops'
    /// coordinates.
    pub anchor: Vec3,
}

impl Default for CollisionOptions {
    /// Straight down on 50 m around the origin, 512 x 512 texels of 10 cm.
    fn default() -> Self {
        Self { fall: Vec3::NEG_Y, center: Vec3::ZERO, size: [50.0; 2], texels: [512; 2], anchor: Vec3::ZERO }
    }
}

impl CollisionOptions {
    /// Options of a map that covers a box, as seen along the fall.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] if the fall is not within 80 degrees of down, or the box is not valid.
    pub fn covering(low: Vec3, high: Vec3, fall: Vec3, texels: [u32; 2]) -> Result<Self, SimError> {
        let [across, along, _] = axes(fall)?;
        let half = (high - low) * 0.5;
        // Half the extent of a box along an axis: the sum of its edges' parts.
        let size = [across, along].map(|axis| 2.0 * axis.abs().dot(half));
        let options = Self { fall, center: low + half, size, texels, anchor: Vec3::ZERO };
        options.check()?;
        Ok(options)
    }

    fn check(&self) -> Result<(), SimError> {
        let error = |quantity, found: f32, unit, allowed: &'static str| {
            Err(SimError::OutOfRange(OutOfRange {
                quantity,
                found: f64::from(found),
                unit,
                allowed: allowed.into(),
            }))
        };
        for position in [self.center, self.anchor] {
            let farthest = position.abs().max_element();
            if !(position.is_finite() && farthest <= MAX_COORDINATE_M) {
                return error("position of the collision map", farthest, "m", "-1e7 to 1e7");
            }
        }
        for edge in self.size {
            if !(edge > 0.0 && edge <= MAX_COORDINATE_M) {
                return error("edge of the collision map", edge, "m", "above 0, at most 1e7");
            }
        }
        for texels in self.texels {
            if !(1..=MAX_TEXELS).contains(&texels) {
                return error("edge of the collision map", texels as f32, "texels", "1 to 4096");
            }
        }
        Ok(())
    }
}

/// Unit vectors across, along and of the fall: right-handed in this order.
fn axes(fall: Vec3) -> Result<[Vec3; 3], SimError> {
    let length = fall.length();
    let down = -fall.y / length;
    if !(length.is_finite() && down >= MIN_DOWN) {
        // To a tenth: the angle of a unit vector in f32 is no more accurate.
        let found = (f64::from(ops::acos(down.clamp(-1.0, 1.0))).to_degrees() * 10.0).round() / 10.0;
        let (quantity, unit, allowed) = ("angle of the fall from down", "degrees", "0 to 80");
        return Err(SimError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() }));
    }
    let fall = fall / length;
    // Never parallel to the fall, and always near X while the wind turns.
    let across = (Vec3::X - fall * fall.x).normalize();
    Ok([across, fall.cross(across), fall])
}

/// Position of a map, in the layout of `CollisionMap` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct CollisionFrame {
    /// Corner of the first texel, m. The map's plane, depth 0, is above everything.
    pub low: [f32; 3],
    /// Number of triangles of the scene.
    pub triangles: u32,
    /// Unit vector along the rows.
    pub across: [f32; 3],
    /// Maximum deviation of a surface from the depth at its texel's center, m.
    pub steep: f32,
    /// Unit vector along the columns.
    pub along: [f32; 3],
    /// Distance below which surfaces are merged, m.
    pub merge: f32,
    /// Unit vector of the fall.
    pub fall: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding_1: u32,
    /// Edges of a texel, m.
    pub edge: [f32; 2],
    /// Inverse edges, 1/m.
    pub per_edge: [f32; 2],
    /// Origin of the drops' coordinates in those of the triangles, m.
    pub anchor: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding_2: u32,
    /// Number of texels across and along.
    pub size: [u32; 2],
    /// Padding of the WGSL layout.
    pub padding_3: [u32; 2],
}

impl CollisionFrame {
    /// Computes the position of a map above a scene.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`]: the fall is not within 80 degrees of down, a number is not finite or outside its range, or
    /// the scene reaches farther than 1e7 m.
    pub fn new(options: &CollisionOptions, scene: &Bvh) -> Result<Self, SimError> {
        Self::from_arrays(options, &scene.nodes, &scene.triangles)
    }

    /// Computes the position as [`CollisionFrame::new`], from the arrays of a [`Bvh`].
    ///
    /// # Errors
    /// As [`CollisionFrame::new`].
    pub fn from_arrays(
        options: &CollisionOptions,
        nodes: &[BvhNode],
        triangles: &[BvhTriangle],
    ) -> Result<Self, SimError> {
        options.check()?;
        let [across, along, fall] = axes(options.fall)?;
        let anchor = options.anchor;
        let bounds = bvh_bounds(nodes);
        let [low, high] =
            bounds.map_or([options.center; 2], |corners| corners.map(|corner| Vec3::from(corner) - anchor));
        let farthest = low.abs().max(high.abs()).max_element();
        if !(low.is_finite() && high.is_finite() && farthest <= 2.0 * MAX_COORDINATE_M) {
            return Err(SimError::OutOfRange(OutOfRange {
                quantity: "reach of the scene from the drops",
                found: f64::from(farthest),
                unit: "m",
                allowed: "at most 2e7".into(),
            }));
        }
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let top = fall.dot(middle) - fall.abs().dot(half);
        let [width, height] = options.size;
        // The plane is a little above the scene, so that a ray does not start on a surface.
        let plane = top - (1.0 + 1.0e-4 * half.max_element());
        let corner = options.center + fall * (plane - fall.dot(options.center))
            - across * (0.5 * width)
            - along * (0.5 * height);
        let edge = [width / options.texels[0] as f32, height / options.texels[1] as f32];
        let largest = farthest.max(anchor.abs().max_element()).max(corner.abs().max_element());
        Ok(Self {
            low: corner.to_array(),
            triangles: triangles.len() as u32,
            across: across.to_array(),
            steep: COLLISION_STEEP * edge[0].max(edge[1]),
            along: along.to_array(),
            merge: MERGE_M + MERGE_FRACTION * largest,
            fall: fall.to_array(),
            padding_1: 0,
            edge,
            per_edge: edge.map(|e| 1.0 / e),
            anchor: anchor.to_array(),
            padding_2: 0,
            size: options.texels,
            padding_3: [0; 2],
        })
    }
}
