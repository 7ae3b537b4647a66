//! From a posed scene to the triangles that a simulator takes.

use super::TriangleModel;
use crate::scene::{Pose, Scene, skin_primitive};
use glam::Vec3;

impl Scene {
    /// All triangles of a pose in the world, as one model; front faces are counter-clockwise, also in mirrored
    /// instances.
    ///
    /// ```no_run
    /// use downpour_scene::{Budget, gltf::read_scene};
    /// let street = read_scene("street.glb".as_ref(), &mut Budget::default())?;
    /// let roofs = street.triangles(&street.pose(None, 0.0));
    /// println!("{} triangles", roofs.indices.len());
    /// # Ok::<(), downpour_scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn triangles(&self, pose: &Pose) -> TriangleModel {
        let mut model = TriangleModel { name: self.name.clone(), ..TriangleModel::default() };
        let mut normals = Vec::new();
        for instance in &pose.instances {
            let Some(mesh) = self.meshes.get(instance.mesh) else { continue };
            for part in &mesh.primitives {
                let start = u32::try_from(model.positions.len()).unwrap_or(u32::MAX);
                // More than 2^32 vertices have no index.
                let count =
                    u32::try_from(part.positions.len()).ok().filter(|&n| start.checked_add(n).is_some());
                let Some(count) = count else { continue };
                let skinned = skin_primitive(part, instance);
                model.positions.extend(skinned.positions.iter().map(Vec3::to_array));
                normals.extend(skinned.normals.iter().map(Vec3::to_array));
                normals.resize(model.positions.len(), [0.0, 1.0, 0.0]);
                for corners in part.indices.chunks_exact(3) {
                    let &[a, b, c] = corners else { continue };
                    if corners.iter().any(|&corner| corner >= count) {
                        continue;
                    }
                    let [a, b, c] = [a, b, c].map(|corner| start.saturating_add(corner));
                    model.indices.push(if instance.mirrored { [a, c, b] } else { [a, b, c] });
                }
            }
        }
        model.normals = (!normals.is_empty()).then_some(normals);
        model
    }
}
