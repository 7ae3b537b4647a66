//! Transform of each mesh: the walk over the nodes of the scene, in double precision.
//!
//! The local matrix of a node is its `matrix`, or translation x rotation x scale; the world matrix is the parent's times
//! the local one (glTF 2.0, section 3.5.3). The guard has checked that the nodes are a forest of bounded depth.

use crate::Budget;
use crate::error::SceneError;
use crate::warning::{WarningKind, Warnings};
use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf::json::{Index, Node, Root};
use std::fmt;

/// Minimum ratio of the volume of a matrix to the product of the lengths of its columns. Below it the columns lie in
/// one plane but for rounding.
const FLAT: f64 = 1e-10;

/// Bytes of a node during the walk: its matrix as a parent, and as an instance.
const PER_NODE: u64 = 320;

/// One mesh with its transform.
pub(super) struct Instance {
    /// The node, unless the file has none.
    node: Option<usize>,
    pub(super) mesh: usize,
    world: DMat4,
}

impl fmt::Display for Instance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.node {
            Some(node) => write!(f, "nodes[{node}]"),
            None => write!(f, "meshes[{}]", self.mesh),
        }
    }
}

/// Transform of points, directions and windings into the world.
pub(super) struct Placement {
    world: DMat4,
    normal: DMat3,
    /// True if the matrix mirrors, which reverses triangles.
    pub(super) mirrored: bool,
}

impl Instance {
    /// The maps of this instance; `None` when they have no inverse.
    pub(super) fn placement(&self) -> Option<Placement> {
        let linear = DMat3::from_mat4(self.world);
        let volume = linear.determinant();
        let lengths = linear.x_axis.length() * linear.y_axis.length() * linear.z_axis.length();
        // NaN and infinity fail both comparisons.
        let solid = volume.abs() > FLAT * lengths && volume.abs() < f64::MAX && self.world.is_finite();
        let normal = linear.inverse().transpose();
        let placement = Placement { world: self.world, normal, mirrored: volume < 0.0 };
        (solid && normal.is_finite()).then_some(placement)
    }
}

impl Placement {
    /// A point in the world.
    pub(super) fn point(&self, [x, y, z]: [f64; 3]) -> DVec3 {
        self.world.transform_point3(DVec3::new(x, y, z))
    }

    /// Unit normal in the world; zero if undefined.
    pub(super) fn normal(&self, [x, y, z]: [f64; 3]) -> DVec3 {
        self.normal.mul_vec3(DVec3::new(x, y, z).normalize_or_zero()).normalize_or_zero()
    }
}

/// All meshes of the scene: the default scene, or the first, or all nodes, or (without any) all meshes.
pub(super) fn find(
    root: &Root,
    budget: &mut Budget,
    warnings: &mut Warnings,
) -> Result<Vec<Instance>, SceneError> {
    let most = root.nodes.len().max(root.meshes.len()) as u64;
    budget.take_bytes(most.saturating_mul(PER_NODE), "nodes")?;
    if root.nodes.is_empty() {
        let mut all = Budget::vec_with_capacity(root.meshes.len(), "meshes")?;
        all.extend((0..root.meshes.len()).map(|mesh| Instance { node: None, mesh, world: DMat4::IDENTITY }));
        return Ok(all);
    }
    let mut all = Budget::vec_with_capacity(root.nodes.len(), "nodes")?;
    // Matrices of the nodes whose children are not visited yet; the last is the next.
    let mut open = Budget::vec_with_capacity(root.nodes.len(), "nodes")?;
    open.extend(roots(root).into_iter().rev().map(|index| (index, DMat4::IDENTITY)));
    while let Some((index, parent)) = open.pop() {
        let Some(node) = root.nodes.get(index) else { continue };
        let world = parent.mul_mat4(&local(node));
        if let Some(mesh) = node.mesh {
            if node.skin.is_some() {
                warnings.add(WarningKind::Ignored, format_args!("nodes[{index}].skin"), || {
                    "skins are not read: the mesh is unposed and has the transform of its node".into()
                });
            }
            all.push(Instance { node: Some(index), mesh: mesh.value(), world });
        }
        open.extend(indices(node.children.as_deref()).rev().map(|child| (child, world)));
    }
    Ok(all)
}

/// Root nodes of the walk.
pub(super) fn roots(root: &Root) -> Vec<usize> {
    let scene = root.scene.and_then(|scene| root.get(scene)).or(root.scenes.first());
    if let Some(scene) = scene {
        return indices(Some(&scene.nodes)).collect();
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| indices(node.children.as_deref())) {
        if let Some(is_child) = is_child.get_mut(child) {
            *is_child = true;
        }
    }
    is_child.iter().enumerate().filter(|(_, is_child)| !**is_child).map(|(index, _)| index).collect()
}

fn indices(list: Option<&[Index<Node>]>) -> impl DoubleEndedIterator<Item = usize> {
    list.unwrap_or_default().iter().map(Index::value)
}

/// Local matrix of the node.
fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        let columns = DMat4::from_cols_array(&matrix.map(f64::from));
        // The last row is 0 0 0 1 by the specification: other values have been warned of.
        return DMat4::from_cols(
            columns.x_axis.truncate().extend(0.0),
            columns.y_axis.truncate().extend(0.0),
            columns.z_axis.truncate().extend(0.0),
            columns.w_axis.truncate().extend(1.0),
        );
    }
    let vector =
        |parts: Option<[f32; 3]>, or| parts.map_or(or, |parts| DVec3::from_array(parts.map(f64::from)));
    let scale = vector(node.scale, DVec3::ONE);
    let translation = vector(node.translation, DVec3::ZERO);
    let quaternion = node.rotation.map_or(DQuat::IDENTITY, |turn| DQuat::from_array(turn.0.map(f64::from)));
    let length = quaternion.length();
    if length == 0.0 {
        // No rotation at all: a matrix without inverse, which is warned of if a mesh uses it.
        return DMat4::from_scale(DVec3::ZERO);
    }
    let [x, y, z, w] = quaternion.to_array().map(|part| part / length);
    DMat4::from_scale_rotation_translation(scale, DQuat::from_xyzw(x, y, z, w), translation)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(world: DMat4) -> Option<Placement> {
        Instance { node: None, mesh: 0, world }.placement()
    }

    #[test]
    fn flat_and_endless_matrices_have_no_placement() {
        for scale in
            [DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0), DVec3::splat(f64::INFINITY), DVec3::splat(f64::NAN)]
        {
            assert!(placed(DMat4::from_scale(scale)).is_none(), "{scale}");
        }
        let skewed = DMat4::from_cols_array(&[
            1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0,
        ]);
        assert!(placed(skewed).is_none());
        for scale in [1e-9, 1e-3, 1.0, 1e9] {
            assert!(placed(DMat4::from_scale(DVec3::new(scale, 1.0, 1.0))).is_some(), "{scale}");
        }
    }

    /// A normal stays perpendicular to its plane under scaling, and on its side under mirroring.
    #[test]
    fn normals_stay_on_their_planes() {
        let plane = [DVec3::new(1.0, -1.0, 0.0), DVec3::new(0.0, 1.0, -1.0)];
        let normal = [1.0, 1.0, 1.0];
        for scale in [DVec3::new(2.0, 3.0, 0.5), DVec3::new(-1.0, 4.0, 1.0)] {
            let placement = placed(DMat4::from_scale(scale)).unwrap();
            let turned = placement.normal(normal);
            for edge in plane {
                let moved = placement.point(edge.to_array());
                assert!(turned.dot(moved).abs() < 1e-15);
            }
            assert!(turned.dot(placement.point(normal)) > 0.0);
            assert_eq!(placement.mirrored, scale.x < 0.0);
        }
    }
}
