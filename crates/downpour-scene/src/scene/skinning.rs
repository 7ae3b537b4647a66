//! Bending on the CPU: morph targets, then linear blend skinning (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
//!
//! `p' = (sum_i w_i J_i) (p + sum_k v_k dp_k)` with the weights `w` of up to four joints, their matrices `J`, the
//! weights `v` of the morph targets and their displacements `dp`. Normals take the inverse transpose of the blended
//! matrix, tangents its linear part.
#![allow(clippy::arithmetic_side_effects, reason = "vectors of floats do not overflow into a panic")]

use super::{Instance, Primitive};
use glam::{Affine3A, Mat3A, Vec3, Vec3A, Vec4};

/// The vertices of a primitive in the world.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinnedPrimitive {
    /// In meters.
    pub positions: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the sign of the bitangent in `w`; empty if the primitive has none.
    pub tangents: Vec<Vec4>,
}

/// Transforms the vertices of a primitive into the world. The order of corners is not changed: if the instance is
/// mirrored, triangles are clockwise.
///
/// ```
/// use downpour_scene::scene::{Mesh, Node, Primitive, Scene, skin_primitive};
/// let positions = vec![[0.0, 0.0, 0.0].into(), [1.0, 0.0, 0.0].into(), [0.0, 1.0, 0.0].into()];
/// let triangle = Primitive { positions, normals: vec![glam::Vec3::Z; 3], ..Primitive::default() };
/// let mesh = Mesh { primitives: vec![triangle], ..Mesh::default() };
/// let node = Node { mesh: Some(0), ..Node::default() };
/// let scene = Scene { meshes: vec![mesh], nodes: vec![node], roots: vec![0], ..Scene::default() };
/// let pose = scene.pose(None, 0.0);
/// let skinned = skin_primitive(&scene.meshes[0].primitives[0], &pose.instances[0]);
/// assert_eq!(skinned.positions, scene.meshes[0].primitives[0].positions);
/// ```
#[must_use]
pub fn skin_primitive(primitive: &Primitive, instance: &Instance) -> SkinnedPrimitive {
    let mut skinned = SkinnedPrimitive {
        positions: Vec::with_capacity(primitive.positions.len()),
        normals: Vec::with_capacity(primitive.normals.len()),
        tangents: Vec::with_capacity(primitive.tangents.len()),
    };
    let is_skinned = primitive.is_skinned() && !instance.joints.is_empty();
    let sign = if instance.mirrored { -1.0 } else { 1.0 };
    let whole = (instance.world, Mat3A::from(instance.normal));
    for vertex in 0..primitive.positions.len() {
        let (matrix, normal_map) = if is_skinned {
            let matrix = blended(primitive, instance, vertex);
            (matrix, cofactors(&matrix.matrix3))
        } else {
            whole
        };
        let (position, normal) = morphed(primitive, instance, vertex);
        skinned.positions.push(matrix.transform_point3(position));
        if let Some(normal) = normal {
            skinned
                .normals
                .push((normal_map * Vec3A::from(normal)).try_normalize().map_or(normal, Vec3::from));
        }
        if let Some(tangent) = primitive.tangents.get(vertex) {
            let turned = matrix.transform_vector3(tangent.truncate());
            let turned = turned.try_normalize().unwrap_or(tangent.truncate());
            skinned.tangents.push(turned.extend(tangent.w * sign));
        }
    }
    skinned
}

/// Position and normal after the morph targets.
fn morphed(primitive: &Primitive, instance: &Instance, vertex: usize) -> (Vec3, Option<Vec3>) {
    let mut position = primitive.positions.get(vertex).copied().unwrap_or_default();
    let mut normal = primitive.normals.get(vertex).copied();
    for (morph, &weight) in primitive.morphs.iter().zip(&instance.weights) {
        if let Some(&delta) = morph.positions.get(vertex) {
            position += weight * delta;
        }
        if let (Some(normal), Some(&delta)) = (&mut normal, morph.normals.get(vertex)) {
            *normal += weight * delta;
        }
    }
    (position, normal)
}

/// The mean of the joints of a vertex.
fn blended(primitive: &Primitive, instance: &Instance, vertex: usize) -> Affine3A {
    let joints = primitive.joints.get(vertex).copied().unwrap_or_default();
    let weights = primitive.weights.get(vertex).copied().unwrap_or_default();
    let mut sum = Affine3A::ZERO;
    for (joint, weight) in joints.into_iter().zip(weights) {
        if let Some(matrix) = instance.joints.get(usize::from(joint)).filter(|_| weight != 0.0) {
            sum.matrix3 += matrix.matrix3 * weight;
            sum.translation += matrix.translation * weight;
        }
    }
    sum
}

/// Cofactors with the sign of the determinant: the inverse transpose but for a positive factor, also for a matrix
/// without inverse.
fn cofactors(m: &Mat3A) -> Mat3A {
    let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    // Columns of about length 1, so that products neither overflow nor vanish.
    let largest = m.x_axis.abs().max(m.y_axis.abs()).max(m.z_axis.abs()).max_element();
    let m = if largest > 0.0 { *m * (1.0 / largest) } else { *m };
    Mat3A::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis)) * sign
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{MorphTarget, Pose};
    use glam::{Mat3, Quat};

    fn instance(joints: Vec<Affine3A>) -> Instance {
        Instance {
            node: 0,
            mesh: 0,
            world: Affine3A::IDENTITY,
            normal: Mat3::IDENTITY,
            mirrored: false,
            joints,
            weights: vec![0.5],
        }
    }

    fn close(a: Vec3, b: Vec3) -> bool {
        a.distance(b) < 1e-6
    }

    #[test]
    fn cofactors_turn_normals_like_the_inverse_transpose() {
        for scale in [Vec3::new(2.0, 3.0, 0.5), Vec3::new(-1.0, 4.0, 1.0), Vec3::splat(1e-20)] {
            let turn = Affine3A::from_quat(Quat::from_xyzw(0.1, 0.5, 0.7, 0.5).normalize());
            let matrix = (turn * Affine3A::from_scale(scale)).matrix3;
            let unit = matrix * (1.0 / scale.max_element());
            let exact = (unit.inverse().transpose() * Vec3A::ONE).normalize();
            assert!((cofactors(&matrix) * Vec3A::ONE).normalize().distance(exact) < 1e-5, "{scale}");
        }
        // Flat: the normal of the plane is left.
        let flat = cofactors(&Mat3A::from_diagonal(Vec3::new(1.0, 0.0, 1.0)));
        assert_eq!((flat * Vec3A::new(1.0, 2.0, 3.0)).normalize(), Vec3A::Y);
    }

    /// Half of a shift and half of none is half a shift; morphs come first.
    #[test]
    fn joints_are_blended_after_morphs() {
        let primitive = Primitive {
            positions: vec![Vec3::X; 2],
            normals: vec![Vec3::Z; 2],
            tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 2],
            joints: vec![[0, 1, 0, 0], [1, 0, 0, 0]],
            weights: vec![[0.5, 0.5, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]],
            morphs: vec![MorphTarget {
                positions: vec![Vec3::Y, Vec3::ZERO],
                normals: vec![Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0)],
                farthest: 1.0,
            }],
            ..Primitive::default()
        };
        let quarter = Affine3A::from_quat(Quat::from_xyzw(0.0, 0.0, 0.5f32.sqrt(), 0.5f32.sqrt()));
        let shifted = Affine3A::from_translation(Vec3::new(0.0, 0.0, 4.0));
        let moved = skin_primitive(&primitive, &instance(vec![Affine3A::IDENTITY, shifted]));
        assert!(close(moved.positions[0], Vec3::new(1.0, 0.5, 2.0)));
        assert!(close(moved.normals[1], Vec3::new(0.5f32.sqrt(), 0.0, 0.5f32.sqrt())));
        let turned = skin_primitive(&primitive, &instance(vec![Affine3A::IDENTITY, quarter]));
        assert!(close(turned.positions[1], Vec3::Y));
        assert!(close(turned.tangents[1].truncate(), Vec3::Y));
        assert_eq!(Pose::default().left_out, 0);
    }
}
