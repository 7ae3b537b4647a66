//! Segment of a drop's path within a texel.

use downpour_shaders::sim::collision::{
    COLLISION_CLEARANCE, COLLISION_OPEN, COLLISION_START, COLLISION_SURFACE, COLLISION_WALL,
};
use glam::Vec3;

use super::surface::{collision_count, collision_depths, collision_shallow, collision_solid};
use super::{CollisionFrame, CollisionTexel};

/// Segment of a drop's path within a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionPiece {
    /// Start: texels from the center, and meters of depth.
    pub start: Vec3,
    /// End, as `start`.
    pub end: Vec3,
    /// Number of surfaces above the drop when it left the previous texel; `COLLISION_START` if there was none.
    pub before: u32,
}

/// Hit of a drop within a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionMeeting {
    /// `COLLISION_OPEN`, `COLLISION_SURFACE` or `COLLISION_WALL`.
    pub kind: u32,
    /// Fraction of the segment, 0 to 1.
    pub fraction: f32,
    /// Index of the surface.
    pub layer: u32,
    /// 1 if the surface was hit from below.
    pub beneath: u32,
    /// Number of surfaces above the end of the segment.
    pub count: u32,
}

/// Finds the hit of a drop within a texel (Rousseau 2008, 5.1.2 and algorithm 1).
#[must_use]
pub fn collision_column(
    map: &CollisionFrame,
    texel: &CollisionTexel,
    piece: &CollisionPiece,
) -> CollisionMeeting {
    // Most drops are far above all surfaces.
    if piece.start.z.max(piece.end.z) + map.steep < texel.depths[0] {
        return CollisionMeeting { kind: COLLISION_OPEN, fraction: 1.0, layer: 0, beneath: 0, count: 0 };
    }
    let first = piece.before == COLLISION_START;
    let start = collision_depths(map, texel, piece.start.truncate());
    let end = collision_depths(map, texel, piece.end.truncate());
    let count = collision_count(&start, piece.start.z - if first { COLLISION_CLEARANCE } else { 0.0 });
    let count_end = collision_count(&end, piece.end.z);
    let surface = |fraction, layer, beneath, count| CollisionMeeting {
        kind: COLLISION_SURFACE,
        fraction,
        layer,
        beneath,
        count,
    };
    if count > 0 {
        let layer = count - 1;
        let solid = collision_solid(texel.surfaces[layer as usize]);
        let below = piece.start.z - start[layer as usize];
        let shallow = below <= collision_shallow(map, texel.surfaces[layer as usize]);
        // A drop that has bounced may still be a little below the surface that it leaves.
        let leaves = first && shallow && piece.end.z - end[layer as usize] <= below;
        if solid && !leaves {
            let kind = if shallow { COLLISION_SURFACE } else { COLLISION_WALL };
            return CollisionMeeting { kind, ..surface(0.0, layer, 0, count) };
        }
        // Planes of neighboring texels do not join exactly at the border.
        if !solid && count > piece.before && shallow {
            return surface(0.0, layer, 0, count);
        }
    }
    if count_end > count {
        let before = piece.start.z - start[count as usize];
        let after = piece.end.z - end[count as usize];
        let fraction = fraction(-before, after - before);
        return surface(fraction, count, 0, count_end);
    }
    if count_end < count {
        let layer = count - 1;
        if !collision_solid(texel.surfaces[layer as usize]) {
            let before = piece.start.z - start[layer as usize];
            let after = piece.end.z - end[layer as usize];
            let fraction = fraction(before, before - after);
            return surface(fraction, layer, 1, count_end);
        }
    }
    CollisionMeeting { kind: COLLISION_OPEN, fraction: 1.0, layer: 0, beneath: 0, count: count_end }
}

/// Part of a whole as a fraction, 0 to 1.
#[expect(clippy::manual_clamp, reason = "the bits of the twin, and 0 for what is not a number")]
fn fraction(part: f32, whole: f32) -> f32 {
    (part / whole.max(1.0e-12)).max(0.0).min(1.0)
}
