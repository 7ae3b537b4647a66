//! Surfaces of a texel.

use downpour_math::packing::{packing_octahedral_encode, packing_pack_snorm, packing_unpack_snorm};
use downpour_shaders::sim::collision::{
    COLLISION_LAYERS, COLLISION_NONE, COLLISION_SHALLOW, COLLISION_SOLID,
};
use glam::{Vec2, Vec3};

use super::CollisionFrame;

/// Number of surfaces of a texel.
const LAYERS: usize = COLLISION_LAYERS as usize;

/// Surfaces of a column, in the layout of `CollisionTexel` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct CollisionTexel {
    /// Depths at the center, m, ascending; `COLLISION_NONE` for no surface.
    pub depths: [f32; LAYERS],
    /// Packed normals, and the state of the space below: see [`collision_pack`].
    pub surfaces: [u32; LAYERS],
}

impl CollisionTexel {
    /// A texel without surfaces.
    pub const OPEN: Self = Self { depths: [COLLISION_NONE; LAYERS], surfaces: [0; LAYERS] };
}

/// Packs a normal in the frame of the map (across, along, against the fall) that faces the rain, and a flag of solid
/// below.
///
/// Octahedral, 16 and 15 bits: within 2e-4 rad.
#[must_use]
pub fn collision_pack(normal: Vec3, solid: bool) -> u32 {
    let square = packing_octahedral_encode([normal.x, normal.y, normal.z.max(0.0)]);
    (packing_pack_snorm(square) & !COLLISION_SOLID) | if solid { COLLISION_SOLID } else { 0 }
}

/// True if the space below a surface, up to the next, is solid.
#[must_use]
pub fn collision_solid(surface: u32) -> bool {
    surface & COLLISION_SOLID != 0
}

/// Normal of a surface, not normalized.
#[must_use]
pub fn collision_square(surface: u32) -> Vec3 {
    let [x, y] = packing_unpack_snorm(surface & !COLLISION_SOLID);
    Vec3::new(x, y, (1.0 - x.abs() - y.abs()).max(0.0))
}

/// Unit normal of a surface, in the frame of the map.
#[must_use]
pub fn collision_normal(surface: u32) -> Vec3 {
    let square = collision_square(surface);
    square * (1.0 / square.dot(square).sqrt())
}

/// Slope of a surface: increase of depth per meter across and along.
#[must_use]
pub fn collision_slope(surface: u32) -> Vec2 {
    let square = collision_square(surface);
    Vec2::new(square.x, square.y) * (1.0 / square.z.max(1.0e-4))
}

/// Depths of a texel's surfaces at an offset from its center, m, ascending. `offset` is in texels.
#[must_use]
pub fn collision_depths(map: &CollisionFrame, texel: &CollisionTexel, offset: Vec2) -> [f32; LAYERS] {
    let meters = offset * Vec2::from(map.edge);
    let mut above = -COLLISION_NONE;
    std::array::from_fn(|k| {
        let deeper = collision_slope(texel.surfaces[k]).dot(meters);
        // Planes that cross within the texel coincide from there on.
        above = above.max(texel.depths[k] + deeper.max(-map.steep).min(map.steep));
        above
    })
}

/// Number of surfaces above a depth.
#[must_use]
pub fn collision_count(depths: &[f32; LAYERS], depth: f32) -> u32 {
    depths.iter().map(|&d| u32::from(d < depth)).sum()
}

/// Maximum depth below a surface at which it may continue in the next texel, m.
#[must_use]
pub fn collision_shallow(map: &CollisionFrame, surface: u32) -> f32 {
    let slope = collision_slope(surface);
    let [width, height] = map.edge;
    (width.max(height) * (COLLISION_SHALLOW + slope.dot(slope).sqrt())).min(map.steep)
}
