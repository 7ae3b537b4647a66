//! What moves and may reach into water: its triangles.

use downpour_scene::scene::{Bounds, Instance, Pose, Primitive, Scene, skin_primitive};
use glam::{DVec3, Vec3};

use crate::assemble::relative;

/// A box: its lowest and highest corner, m.
pub(crate) type Region = [Vec3; 2];

/// Triangles of the nodes of a pose that move, relative to `origin`, m, as far as they are of parts that reach into a region.
pub(crate) fn moving_triangles(
    scene: &Scene,
    pose: &Pose,
    origin: DVec3,
    moves: &[bool],
    region: &Region,
) -> Vec<[Vec3; 3]> {
    let mut triangles = Vec::new();
    for instance in pose.instances.iter().filter(|instance| moves.get(instance.node) == Some(&true)) {
        let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
        let instance = relative(instance, pose, origin);
        for primitive in mesh.primitives.iter().filter(|primitive| may_reach(primitive, &instance, region)) {
            let positions = skin_primitive(primitive, &instance).positions;
            let (corners, _) = primitive.indices.as_chunks::<3>();
            triangles.extend(corners.iter().filter_map(|corners| {
                let at = |k: usize| positions.get(corners[k] as usize).copied();
                Some([at(0)?, at(1)?, at(2)?])
            }));
        }
    }
    triangles
}

/// False if a part of an instance is outside of a region for certain.
fn may_reach(primitive: &Primitive, instance: &Instance, [low, high]: &Region) -> bool {
    if primitive.is_skinned() || !primitive.morphs.is_empty() {
        return true;
    }
    let corners = primitive.bounds.corners().map(|corner| instance.world.transform_point3(corner));
    let Bounds { min, max } = Bounds::of(&corners);
    min.cmple(*high).all() && max.cmpge(*low).all()
}
