//! Queries of positions and paths in a map.

use downpour_shaders::sim::collision::{
    COLLISION_COLUMNS, COLLISION_EDGE, COLLISION_NONE, COLLISION_OPEN, COLLISION_START, COLLISION_SURFACE,
    COLLISION_WALL,
};
use glam::{IVec2, UVec2, Vec2, Vec3};

use super::column::{CollisionPiece, collision_column};
use super::surface::{collision_count, collision_depths, collision_normal, collision_solid};
use super::{CollisionFrame, CollisionTexel};

/// Hit of a drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionHit {
    /// `COLLISION_OPEN`, `COLLISION_SURFACE` (it splashes or bounces) or `COLLISION_WALL` (it is absorbed).
    pub kind: u32,
    /// Fraction of the path, 0 to 1. For `COLLISION_OPEN`: the fraction that was followed, 1 except for paths across
    /// more than 31 borders of texels.
    pub fraction: f32,
    /// Unit vector toward the side that the drop came from; 0 for `COLLISION_OPEN`.
    pub normal: Vec3,
}

/// Converts a position to map coordinates: texels across, texels along, meters of depth.
#[must_use]
pub fn collision_position(map: &CollisionFrame, at: Vec3) -> Vec3 {
    let offset = at - Vec3::from(map.low);
    let [x, y] = map.per_edge;
    Vec3::new(
        offset.dot(map.across.into()) * x,
        offset.dot(map.along.into()) * y,
        offset.dot(map.fall.into()),
    )
}

/// Converts a normal of the map to world space.
#[must_use]
pub fn collision_turn(map: &CollisionFrame, normal: Vec3) -> Vec3 {
    Vec3::from(map.across) * normal.x + Vec3::from(map.along) * normal.y - Vec3::from(map.fall) * normal.z
}

/// Normal of a wall that stops a drop: against its path across the map. `way` is in texels and meters of depth.
#[must_use]
pub fn collision_wall(map: &CollisionFrame, way: Vec3) -> Vec3 {
    let [width, height] = map.edge;
    let sideways = Vec3::from(map.across) * (way.x * width) + Vec3::from(map.along) * (way.y * height);
    let squared = sideways.dot(sideways);
    if squared < 1.0e-24 {
        return -Vec3::from(map.fall);
    }
    sideways * (-1.0 / squared.sqrt())
}

/// Texel of a cell; one without surfaces outside the map.
#[must_use]
pub fn collision_texel(map: &CollisionFrame, texels: &[CollisionTexel], cell: IVec2) -> CollisionTexel {
    let size = UVec2::from(map.size).as_ivec2();
    if cell.cmplt(IVec2::ZERO).any() || cell.cmpge(size).any() {
        return CollisionTexel::OPEN;
    }
    let index = cell.y as usize * map.size[0] as usize + cell.x as usize;
    texels.get(index).copied().unwrap_or(CollisionTexel::OPEN)
}

/// Corner of the texel of a position.
fn corner(position: Vec2) -> Vec2 {
    let edge = Vec2::splat(COLLISION_EDGE);
    position.max(-edge).min(edge).floor()
}

/// Number of surfaces above a position, and the lowest of them (0: none).
#[must_use]
pub fn collision_cover(map: &CollisionFrame, texels: &[CollisionTexel], at: Vec3) -> [u32; 2] {
    let position = collision_position(map, at);
    let corner = corner(position.truncate());
    let texel = collision_texel(map, texels, corner.as_ivec2());
    let count =
        collision_count(&collision_depths(map, &texel, position.truncate() - corner - 0.5), position.z);
    [count, if count > 0 { texel.surfaces[count as usize - 1] } else { 0 }]
}

/// True if nothing is between a position and the sky that the rain comes from.
#[must_use]
pub fn collision_open(map: &CollisionFrame, texels: &[CollisionTexel], at: Vec3) -> bool {
    collision_cover(map, texels, at)[0] == 0
}

/// True if a position is inside a solid.
#[must_use]
pub fn collision_inside(map: &CollisionFrame, texels: &[CollisionTexel], at: Vec3) -> bool {
    collision_solid(collision_cover(map, texels, at)[1])
}

/// Finds the first hit of a drop on its straight path from `start` to `end`.
#[must_use]
pub fn collision_find(
    map: &CollisionFrame,
    texels: &[CollisionTexel],
    start: Vec3,
    end: Vec3,
) -> CollisionHit {
    let origin = collision_position(map, start);
    let way = collision_position(map, end) - origin;
    let axis =
        |k: usize, if_still: f32, f: &dyn Fn(f32) -> f32| if way[k] != 0.0 { f(way[k]) } else { if_still };
    let inverse = [0, 1].map(|k| axis(k, 1.0, &|w| 1.0 / w));
    let mut cell = corner(origin.truncate()).as_ivec2();
    let mut fraction = 0.0f32;
    let mut before = COLLISION_START;
    for _ in 0..COLLISION_COLUMNS {
        let border = |k: usize| (cell[k] + i32::from(way[k] > 0.0)) as f32;
        let leave = [0, 1].map(|k| axis(k, COLLISION_NONE, &|_| (border(k) - origin[k]) * inverse[k]));
        let until = leave[0].min(leave[1]).max(fraction).min(1.0);
        let center = (cell.as_vec2() + 0.5).extend(0.0);
        let piece = CollisionPiece {
            start: origin + way * fraction - center,
            end: origin + way * until - center,
            before,
        };
        let texel = collision_texel(map, texels, cell);
        let met = collision_column(map, &texel, &piece);
        if met.kind == COLLISION_WALL {
            return CollisionHit { kind: met.kind, fraction, normal: collision_wall(map, way) };
        }
        if met.kind == COLLISION_SURFACE {
            let normal = collision_turn(map, collision_normal(texel.surfaces[met.layer as usize]));
            let side = if met.beneath == 1 { -1.0 } else { 1.0 };
            let fraction = fraction + (until - fraction) * met.fraction;
            return CollisionHit { kind: met.kind, fraction, normal: normal * side };
        }
        fraction = until;
        if until >= 1.0 {
            break;
        }
        // A drop that starts on a border has not moved yet.
        if until > 0.0 {
            before = met.count;
        }
        let next = if leave[0] <= leave[1] { 0 } else { 1 };
        cell[next] += if way[next] > 0.0 { 1 } else { -1 };
    }
    CollisionHit { kind: COLLISION_OPEN, fraction, normal: Vec3::ZERO }
}
