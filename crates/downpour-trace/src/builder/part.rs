//! Some of the triangles of a scene with their hierarchy: all of them, or those of what stands still, which is built once.

use downpour_bvh::Bvh;
use rayon::prelude::*;

use crate::data::RenderCorner;
use crate::material::MaterialLook;

/// Triangles of a scene in the order of the leaves of their hierarchy.
#[derive(Clone, Debug)]
pub(crate) struct ScenePart {
    /// The hierarchy; `index` of each triangle is its own index.
    pub(super) bvh: Bvh,
    /// Three corners per triangle.
    pub(super) corners: Vec<RenderCorner>,
    /// Triangles that shine, in rising order.
    pub(super) shining: Vec<u32>,
}

impl ScenePart {
    /// Builds the hierarchy over triangles, given by positions and by what else their corners have, of some materials, of which there is one
    /// at least.
    pub(super) fn new(
        positions: &[[[f32; 3]; 3]],
        triangles: &[[RenderCorner; 3]],
        materials: &[MaterialLook],
    ) -> Self {
        let mut bvh = Bvh::new(positions);
        let last = materials.len() as u32 - 1;
        let mut corners = Vec::with_capacity(3 * positions.len());
        let mut shining = Vec::new();
        for (leaf, triangle) in (0u32..).zip(&mut bvh.triangles) {
            let own = triangles[triangle.index as usize];
            corners.extend(own.map(|corner| RenderCorner { material: corner.material.min(last), ..corner }));
            let look = &materials[own[0].material.min(last) as usize];
            triangle.index = leaf;
            triangle.lets_through = u32::from(look.lets_through());
            if look.shines() {
                shining.push(leaf);
            }
        }
        Self { bvh, corners, shining }
    }

    /// The triangles of this part, and then those of another.
    pub(super) fn joined(&self, other: &Self) -> Self {
        let count = self.bvh.triangles.len() as u32;
        Self {
            bvh: self.bvh.joined(&other.bvh),
            corners: concatenated(&self.corners, &other.corners),
            shining: self
                .shining
                .iter()
                .copied()
                .chain(other.shining.iter().map(|leaf| leaf + count))
                .collect(),
        }
    }

    /// Number of triangles.
    pub(crate) fn triangle_count(&self) -> usize {
        self.bvh.triangles.len()
    }

    /// Number of nodes of its hierarchy.
    pub(crate) fn node_count(&self) -> usize {
        self.bvh.nodes.len()
    }
}

/// Elements of two arrays, one behind the other: copied on all cores, since most of the work is to get the memory.
pub(super) fn concatenated<T: Copy + Send + Sync>(first: &[T], second: &[T]) -> Vec<T> {
    first.par_iter().chain(second).copied().collect()
}
