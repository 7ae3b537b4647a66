//! Impostors for reflections on wet surfaces, as data; [`impostor`](crate::impostor) finds and draws them.

use std::sync::Arc;

use downpour_bvh::BvhNode;
use downpour_render::camera::Viewpoint;
use glam::{Vec2, Vec3};

/// A shining object, mirrored in level ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Billboard {
    /// Its center, below the ground.
    pub center: Vec3,
    /// Half its width and height, m.
    pub half: Vec2,
    /// Radiance.
    pub radiance: Vec3,
}

/// The impostors of a frame.
#[derive(Clone, Debug)]
pub struct Impostors {
    /// Edge coefficient of reflections: the paper's f0.
    pub edge: f32,
    /// Radiance of the environment, without shining objects: texels of an octahedral map, rows from the top.
    pub environment: Vec<Vec3>,
    /// Shining objects, the farthest first.
    pub billboards: Vec<Billboard>,
    /// The inputs for which they were found.
    pub(crate) of: Basis,
}

/// Inputs of impostors, by which they are found again.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    pub(crate) nodes: Arc<Vec<BvhNode>>,
    pub(crate) sky: Arc<Vec<[f32; 4]>>,
    pub(crate) lights: Vec<[u32; 4]>,
    pub(crate) viewpoint: Viewpoint,
}

impl Basis {
    /// True if it is the same.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.nodes, &other.nodes)
            && Arc::ptr_eq(&self.sky, &other.sky)
            && self.lights == other.lights
            && self.viewpoint == other.viewpoint
    }
}

impl Impostors {
    /// The rows that the device reads.
    #[must_use]
    pub fn rows(&self) -> Vec<[f32; 4]> {
        let environment = self.environment.iter().map(|light| [light.x, light.y, light.z, 0.0]);
        let billboards = self.billboards.iter().flat_map(|billboard| {
            let (center, light) = (billboard.center, billboard.radiance);
            [[center.x, center.y, center.z, billboard.half.x], [light.x, light.y, light.z, billboard.half.y]]
        });
        environment.chain(billboards).collect()
    }
}
