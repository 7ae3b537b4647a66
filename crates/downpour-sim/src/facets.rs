//! Normals of the triangles of obstacles.

use std::sync::OnceLock;

use downpour_bvh::Hit;
use glam::Vec3;

use crate::shelter::Obstacles;

/// Triangles of obstacles by their numbers.
pub(crate) struct Facets<'a> {
    pub(crate) obstacles: &'a Obstacles<'a>,
    /// Index of the triangle of each number, unless they are sorted by number; made for the first normal.
    by_number: OnceLock<Option<Vec<u32>>>,
}

impl<'a> Facets<'a> {
    pub(crate) fn new(obstacles: &'a Obstacles<'a>) -> Self {
        Self { obstacles, by_number: OnceLock::new() }
    }

    fn by_number(&self) -> Option<&Vec<u32>> {
        let triangles = self.obstacles.triangles;
        let sorted = || {
            let in_order = (0u32..).zip(triangles).all(|(k, triangle)| triangle.index == k);
            (!in_order).then(|| {
                let most = triangles.iter().map(|triangle| triangle.index as usize).max().unwrap_or(0);
                let mut indices = vec![u32::MAX; most + 1];
                for (k, triangle) in (0u32..).zip(triangles) {
                    indices[triangle.index as usize] = k;
                }
                indices
            })
        };
        self.by_number.get_or_init(sorted).as_ref()
    }

    /// Unit normal of the front of a triangle.
    pub(crate) fn normal(&self, hit: &Hit) -> Vec3 {
        let index = match self.by_number() {
            None => Some(hit.triangle),
            Some(indices) => indices.get(hit.triangle as usize).copied(),
        };
        let triangle = index.and_then(|index| self.obstacles.triangles.get(index as usize));
        let facet = triangle.map_or(Vec3::Y, |t| Vec3::from(t.edge_1).cross(t.edge_2.into()));
        facet.normalize_or(Vec3::Y)
    }

    /// Unit normal on the side that a drop of a velocity came from.
    pub(crate) fn facing(&self, hit: &Hit, velocity: Vec3) -> Vec3 {
        let normal = self.normal(hit);
        if normal.dot(velocity) > 0.0 { -normal } else { normal }
    }
}
