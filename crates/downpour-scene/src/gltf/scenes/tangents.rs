//! Tangents for primitives with a normal map but without tangents: `MikkTSpace`, as glTF 2.0 requires (section 3.7.2.1).
//!
//! Source: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008), by the crate `bevy_mikktspace`. Tangents
//! belong to corners: a vertex whose corners have different ones is split.

use super::vertices::reorder;
use crate::scene::Primitive;
use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use glam::{Vec3, Vec4};
use std::collections::BTreeMap;

/// Limit of coordinates, so that their squares stay in the range of `f32`.
const FAR: f32 = 1e9;

/// Functions with the same bits on every machine.
struct PortableOps;

impl Ops for PortableOps {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        super::fields::single(downpour_math::ops::f64::acos(f64::from(x)))
    }
}

/// A primitive under the eyes of the algorithm.
struct Corners<'a> {
    part: &'a Primitive,
    uv_set: usize,
    /// For each corner.
    tangents: Vec<Vec4>,
}

impl Corners<'_> {
    fn of<T: Copy>(&self, list: &[T], face: usize, vert: usize) -> Option<T> {
        let corner = face.checked_mul(3)?.checked_add(vert)?;
        list.get(usize::try_from(*self.part.indices.get(corner)?).ok()?).copied()
    }
}

impl Geometry<PortableOps> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.part.indices.len() / 3
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        self.of(&self.part.positions, face, vert).unwrap_or_default().to_array()
    }

    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.of(&self.part.normals, face, vert).unwrap_or(Vec3::Y).to_array()
    }

    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        let uvs = self.part.uvs.get(self.uv_set).map_or(&[][..], Vec::as_slice);
        self.of(uvs, face, vert).unwrap_or_default().to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, vert: usize) {
        let normal = Vec3::from_array(self.normal(face, vert));
        let corner = face.checked_mul(3).and_then(|first| first.checked_add(vert));
        if let Some(slot) = corner.and_then(|corner| self.tangents.get_mut(corner)) {
            // The algorithm expects the second coordinate to point up, glTF's points down: the bitangent is reversed.
            let found = space.map(|space| {
                let [x, y, z, w] = space.tangent_encoded();
                Vec4::new(x, y, z, -w)
            });
            let found = found.filter(|t| t.is_finite() && (t.truncate().length() - 1.0).abs() < 1e-3);
            *slot = found.unwrap_or_else(|| any(normal));
        }
    }
}

/// A tangent for texture coordinates without direction.
fn any(normal: Vec3) -> Vec4 {
    normal.try_normalize().unwrap_or(Vec3::Y).any_orthonormal_vector().extend(1.0)
}

/// Computes the tangents of a primitive with normals. Without texture coordinates of the set it does nothing.
pub(super) fn make(part: &mut Primitive, uv_set: usize) {
    let Some(uvs) = part.uvs.get(uv_set).filter(|uvs| !uvs.is_empty()) else { return };
    let fine = uvs.iter().all(|uv| uv.abs().max_element() <= FAR);
    let blank = part.indices.iter().map(|_| Vec4::ZERO).collect();
    let mut corners = Corners { part, uv_set, tangents: blank };
    if fine {
        // The error type has no values.
        let _ = generate_tangents(&mut corners);
    }
    let tangents = corners.tangents;
    split(part, &tangents);
}

/// Gives each corner its tangent; corners of the same vertex with the same tangent stay together.
fn split(part: &mut Primitive, tangents: &[Vec4]) {
    let mut known: BTreeMap<(u32, [u32; 4]), u32> = BTreeMap::new();
    let (mut order, mut chosen) = (Vec::new(), Vec::new());
    for (index, &tangent) in part.indices.iter_mut().zip(tangents) {
        let next = u32::try_from(order.len()).unwrap_or(u32::MAX);
        let vertex = *known.entry((*index, tangent.to_array().map(f32::to_bits))).or_insert(next);
        if vertex == next {
            order.push(*index);
            chosen.push(tangent);
        }
        *index = vertex;
    }
    reorder(part, &order);
    let bare = chosen.iter_mut().zip(&part.normals).filter(|(tangent, _)| **tangent == Vec4::ZERO);
    bare.for_each(|(tangent, &normal)| *tangent = any(normal));
    part.tangents = chosen;
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    /// A square of two triangles; its texture is aligned with it, or mirrored on the second.
    fn square(mirrored: bool) -> Primitive {
        let far = if mirrored { Vec2::Y } else { Vec2::X };
        Primitive {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)],
            normals: vec![Vec3::Z; 4],
            // The second coordinate of glTF points down.
            uvs: [vec![Vec2::Y, Vec2::ONE, Vec2::ZERO, far], Vec::new()],
            indices: vec![0, 1, 2, 2, 1, 3],
            ..Primitive::default()
        }
    }

    #[test]
    fn tangents_follow_the_first_coordinate() {
        let mut part = square(false);
        make(&mut part, 0);
        assert_eq!((part.positions.len(), part.tangents.len()), (4, 4));
        for tangent in &part.tangents {
            // Bitangent = cross(normal, tangent) w, which is up in the picture.
            assert!(tangent.distance(Vec4::new(1.0, 0.0, 0.0, 1.0)) < 1e-6, "{tangent}");
        }
    }

    #[test]
    fn a_mirrored_neighbor_splits_the_vertices_between() {
        let mut part = square(true);
        make(&mut part, 0);
        assert!(part.positions.len() > 4 && part.tangents.len() == part.positions.len());
        assert!(part.indices.iter().all(|&index| (index as usize) < part.positions.len()));
        let signs: Vec<f32> = part.indices.iter().map(|&index| part.tangents[index as usize].w).collect();
        assert!(signs[0] == -signs[5], "{signs:?}");
    }

    #[test]
    fn coordinates_without_direction_still_give_unit_tangents() {
        for uv in [Vec2::ZERO, Vec2::splat(1e30)] {
            let mut part = square(false);
            part.uvs[0] = vec![uv; 4];
            make(&mut part, 0);
            for (tangent, normal) in part.tangents.iter().zip(&part.normals) {
                assert!((tangent.truncate().length() - 1.0).abs() < 1e-5);
                assert!(tangent.truncate().dot(*normal).abs() < 1e-5);
            }
        }
    }
}
