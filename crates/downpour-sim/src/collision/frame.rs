//! Where a map is, and how fine.

use downpour_bvh::{Bvh, BvhNode, BvhTriangle};
use downpour_math::ops;
use downpour_shaders::sim::collision::COLLISION_STEEP;
use glam::Vec3;

use crate::SimError;

/// Cosine of the largest angle between the fall and the vertical: 80 degrees.
const LEAST_DOWN: f32 = 0.173_648_18;
/// Surfaces closer than this are one, m.
const MERGE_M: f32 = 1.0e-3;
/// The same, as a share of the largest coordinate: what rounding puts apart.
const MERGE_SHARE: f32 = 1.0e-6;
/// Largest coordinate, m.
const FARTHEST_M: f32 = 1.0e7;
/// Most texels along an edge.
const LARGEST: u32 = 4096;

/// Where a map looks, and how fine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionOptions {
    /// Mean fall direction of the drops, of any length, within 80 degrees of down.
    pub fall: Vec3,
    /// A place that the middle of the map is above, m.
    pub centre: Vec3,
    /// Edges of the map across and along, perpendicular to the fall, m.
    pub size: [f32; 2],
    /// Texels across and along, 1 to 4096.
    pub texels: [u32; 2],
    /// Origin of the drops' coordinates in those of the triangles, m: what is added to the place of a drop. It keeps the
    /// digits of drops far from the origin of the scene; every other place here is in the drops' coordinates.
    pub anchor: Vec3,
}

impl Default for CollisionOptions {
    /// Straight down on 50 m round the origin, 512 x 512 texels of 10 cm.
    fn default() -> Self {
        Self { fall: Vec3::NEG_Y, centre: Vec3::ZERO, size: [50.0; 2], texels: [512; 2], anchor: Vec3::ZERO }
    }
}

impl CollisionOptions {
    /// A map that covers a box, as seen along the fall.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] if the fall is not within 80 degrees of down, or the box is none.
    pub fn covering(low: Vec3, high: Vec3, fall: Vec3, texels: [u32; 2]) -> Result<Self, SimError> {
        let [across, along, _] = axes(fall)?;
        let half = (high - low) * 0.5;
        // Half the extent of a box along an axis: the sum of its edges' parts.
        let size = [across, along].map(|axis| 2.0 * axis.abs().dot(half));
        let options = Self { fall, centre: low + half, size, texels, anchor: Vec3::ZERO };
        options.check()?;
        Ok(options)
    }

    fn check(&self) -> Result<(), SimError> {
        let error = |quantity, found: f32, unit, allowed| {
            Err(SimError::OutOfRange { quantity, found: f64::from(found), unit, allowed })
        };
        for place in [self.centre, self.anchor] {
            let farthest = place.abs().max_element();
            if !(place.is_finite() && farthest <= FARTHEST_M) {
                return error("place of the collision map", farthest, "m", "-1e7 to 1e7");
            }
        }
        for edge in self.size {
            if !(edge > 0.0 && edge <= FARTHEST_M) {
                return error("edge of the collision map", edge, "m", "above 0, at most 1e7");
            }
        }
        for texels in self.texels {
            if !(1..=LARGEST).contains(&texels) {
                return error("edge of the collision map", texels as f32, "texels", "1 to 4096");
            }
        }
        Ok(())
    }
}

/// The unit vectors across, along and of the fall: right-handed in this order.
fn axes(fall: Vec3) -> Result<[Vec3; 3], SimError> {
    let length = fall.length();
    let down = -fall.y / length;
    if !(length.is_finite() && down >= LEAST_DOWN) {
        // To a tenth: the angle of a unit vector in f32 has no more digits that mean anything.
        let found = (f64::from(ops::acos(down.clamp(-1.0, 1.0))).to_degrees() * 10.0).round() / 10.0;
        let (quantity, unit, allowed) = ("angle of the fall from down", "degrees", "0 to 80");
        return Err(SimError::OutOfRange { quantity, found, unit, allowed });
    }
    let fall = fall / length;
    // Never parallel to the fall, and never far from X while the wind turns.
    let across = (Vec3::X - fall * fall.x).normalize();
    Ok([across, fall.cross(across), fall])
}

/// A map's place as the shader takes it. The same layout as `CollisionMap` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct CollisionFrame {
    /// Corner of the first texel, m. The map's plane, depth 0, is above everything.
    pub low: [f32; 3],
    /// Triangles of the scene.
    pub triangles: u32,
    /// Unit vector along the rows.
    pub across: [f32; 3],
    /// How far a surface leaves the depth at its texel's centre, at most, m.
    pub steep: f32,
    /// Unit vector along the columns.
    pub along: [f32; 3],
    /// Surfaces closer than this are one, m.
    pub merge: f32,
    /// Unit vector of the fall.
    pub fall: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding_1: u32,
    /// Edges of a texel, m.
    pub edge: [f32; 2],
    /// Their inverses, 1/m.
    pub per_edge: [f32; 2],
    /// Origin of the drops' coordinates in those of the triangles, m.
    pub anchor: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding_2: u32,
    /// Texels across and along.
    pub size: [u32; 2],
    /// Padding of the WGSL layout.
    pub padding_3: [u32; 2],
}

impl CollisionFrame {
    /// The place of a map above a scene.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`]: the fall is not within 80 degrees of down, a number is not finite or outside its range, or
    /// the scene reaches farther than 1e7 m.
    pub fn new(options: &CollisionOptions, scene: &Bvh) -> Result<Self, SimError> {
        Self::from_arrays(options, &scene.nodes, &scene.triangles)
    }

    /// As [`CollisionFrame::new`], from the arrays of a [`Bvh`].
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
        let empty = triangles.is_empty();
        let bounds = nodes.first().filter(|_| !empty);
        let [low, high] = bounds.map_or([options.centre; 2], |root| {
            [root.low, root.high].map(|corner| Vec3::from(corner) - anchor)
        });
        let farthest = low.abs().max(high.abs()).max_element();
        if !(low.is_finite() && high.is_finite() && farthest <= 2.0 * FARTHEST_M) {
            return Err(SimError::OutOfRange {
                quantity: "reach of the scene from the drops",
                found: f64::from(farthest),
                unit: "m",
                allowed: "at most 2e7",
            });
        }
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let top = fall.dot(middle) - fall.abs().dot(half);
        let [width, height] = options.size;
        // The plane is a little above the scene: a ray does not meet what it starts on.
        let plane = top - (1.0 + 1.0e-4 * half.max_element());
        let corner = options.centre + fall * (plane - fall.dot(options.centre))
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
            merge: MERGE_M + MERGE_SHARE * largest,
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
