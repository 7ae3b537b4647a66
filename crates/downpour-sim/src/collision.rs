//! Collision map of the surfaces that the rain hits.
//!
//! Rousseau 2008, 4, looks down on the scene and keeps the height and the normal of the highest surface. This map
//! looks along the mean fall direction, which wind slants, and keeps four surfaces per column, so that the road under
//! a bridge stops the drops that the wind carries there. It is made by rays through the same hierarchy of triangles as
//! the pictures: moving objects are included, and the order of surfaces does not depend on a rasterizer.
//!
//! - A surface within a texel is its tangent plane at the center of the texel, so a slope has no steps. It deviates
//!   from the depth at the center by at most 4 texel edges.
//! - Below a surface that faces the rain is solid ground if the next surface faces away, or if there is none. Between
//!   other surfaces, horizontal rays decide if the space is enclosed, as in a house that stands in the ground; if it
//!   is not, the upper surface is a sheet (a thin roof, a leaf) with air below. The facing of a surface follows from
//!   the order of its corners: counter-clockwise seen from outside. Surfaces inside a solid are left out.
//! - If a column has more than four surfaces, the fourth is the deepest top of a solid: however many leaves a tree
//!   has, the ground is in the map.
//! - Edges are accurate to half a texel. Surfaces that the fall direction only grazes (walls) are not in the map; a
//!   drop that enters a solid sideways, far below its top, has hit a wall.
//!
//! Everything outside the map's rectangle is open. A drop that is placed on a surface may be up to 1 mm below it
//! ([`COLLISION_CLEARANCE`](downpour_shaders::sim::collision::COLLISION_CLEARANCE)); a drop that has to leave a thin
//! sheet downwards must start farther below.
//!
//! Twin of `shaders/wgsl/sim/collision.wgsl` and `shaders/wgsl/sim/collision_map.wgsl`.

mod column;
mod find;
mod frame;
mod make;
mod surface;

use downpour_bvh::{Bvh, BvhNode, BvhTriangle};
use glam::{UVec2, Vec3};
use rayon::prelude::*;

pub use column::{CollisionMeeting, CollisionPiece, collision_column};
pub use find::{
    CollisionHit, collision_cover, collision_find, collision_inside, collision_open, collision_position,
    collision_texel, collision_turn, collision_wall,
};
pub use frame::{CollisionFrame, CollisionOptions};
pub use make::{
    CollisionMapHits, collision_map_add, collision_map_between, collision_map_enclosed, collision_map_faces,
    collision_map_normal, collision_map_texel, collision_map_walk,
};
pub use surface::{
    CollisionTexel, collision_count, collision_depths, collision_normal, collision_pack, collision_shallow,
    collision_slope, collision_solid, collision_square,
};

use crate::SimError;
use crate::shelter::Holes;

/// Collision map on the CPU.
///
/// ```
/// use downpour_bvh::Bvh;
/// use downpour_sim::collision::{CollisionMap, CollisionOptions};
/// use glam::Vec3;
///
/// // A floor of 10 m, 2 m below the origin.
/// let (a, b, c, d) = ([-5.0, -2.0, -5.0], [5.0, -2.0, -5.0], [5.0, -2.0, 5.0], [-5.0, -2.0, 5.0]);
/// let floor = Bvh::new(&[[a, c, b], [a, d, c]]);
/// let map = CollisionMap::new(&CollisionOptions::default(), &floor)?;
/// let hit = map.find(Vec3::new(0.3, -1.9, 0.2), Vec3::new(0.3, -2.1, 0.2)).expect("the floor is there");
/// assert!((hit.fraction - 0.5).abs() < 1.0e-4 && hit.normal.y > 0.999);
/// assert!(map.open(Vec3::ZERO) && map.inside(Vec3::new(1.0, -2.5, 1.0)));
/// # Ok::<(), downpour_sim::SimError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CollisionMap {
    frame: CollisionFrame,
    texels: Vec<CollisionTexel>,
}

impl CollisionMap {
    /// Creates the map of a scene. The bits do not depend on the number of threads. Without triangles, everything is
    /// open.
    ///
    /// # Errors
    /// As [`CollisionFrame::new`].
    pub fn new(options: &CollisionOptions, scene: &Bvh) -> Result<Self, SimError> {
        Self::from_arrays(options, &scene.nodes, &scene.triangles, None)
    }

    /// Creates the map as [`CollisionMap::new`], from the arrays of a [`Bvh`], whose triangles may have holes.
    ///
    /// # Errors
    /// As [`CollisionFrame::new`].
    pub fn from_arrays(
        options: &CollisionOptions,
        nodes: &[BvhNode],
        triangles: &[BvhTriangle],
        holes: Option<&dyn Holes>,
    ) -> Result<Self, SimError> {
        let frame = CollisionFrame::from_arrays(options, nodes, triangles)?;
        let [width, height] = frame.size;
        let texels = (0..width * height)
            .into_par_iter()
            .map(|i| collision_map_texel(&frame, nodes, triangles, holes, UVec2::new(i % width, i / width)))
            .collect();
        Ok(Self { frame, texels })
    }

    /// True if nothing is between a position and the sky that the rain comes from.
    #[must_use]
    pub fn open(&self, at: Vec3) -> bool {
        collision_open(&self.frame, &self.texels, at)
    }

    /// True if a position is inside a solid.
    #[must_use]
    pub fn inside(&self, at: Vec3) -> bool {
        collision_inside(&self.frame, &self.texels, at)
    }

    /// First hit of a drop on its straight path from `start` to `end`; `None` if nothing stops it.
    ///
    /// A path is followed through 32 texels; the rest is ignored ([`collision_find`] returns the fraction that was
    /// followed).
    #[must_use]
    pub fn find(&self, start: Vec3, end: Vec3) -> Option<CollisionHit> {
        let hit = collision_find(&self.frame, &self.texels, start, end);
        (hit.kind != downpour_shaders::sim::collision::COLLISION_OPEN).then_some(hit)
    }

    /// Position of the map, in the layout of the shader.
    #[must_use]
    pub fn frame(&self) -> &CollisionFrame {
        &self.frame
    }

    /// Texels, row by row.
    #[must_use]
    pub fn texels(&self) -> &[CollisionTexel] {
        &self.texels
    }
}
