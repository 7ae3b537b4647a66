//! Vertex data in single precision, with a count of values that are not finite.

use super::fields::single;
use crate::error::SceneError;
use crate::gltf::accessor::Elements;
use crate::gltf::normals;
use crate::scene::Primitive;
use glam::{Vec2, Vec3, Vec4};

/// All elements with `N` components; missing ones are 1, the alpha of a color.
fn all<const N: usize, T>(
    mut elements: Elements<'_>,
    bad: &mut usize,
    make: impl Fn([f64; N]) -> T,
) -> Result<Vec<T>, SceneError> {
    let mut made = crate::Budget::vec_with_capacity(elements.count(), "accessors")?;
    while let Some(parts) = elements.numbers::<N>(1.0)? {
        *bad = bad.saturating_add(usize::from(!parts.iter().all(|part| part.is_finite())));
        made.push(make(parts));
    }
    Ok(made)
}

/// Vectors as they are.
pub(super) fn vectors(elements: Elements<'_>, bad: &mut usize) -> Result<Vec<Vec3>, SceneError> {
    all(elements, bad, |[x, y, z]| Vec3::new(single(x), single(y), single(z)))
}

/// Texture coordinates.
pub(super) fn pairs(elements: Elements<'_>, bad: &mut usize) -> Result<Vec<Vec2>, SceneError> {
    all(elements, bad, |[u, v]| Vec2::new(single(u), single(v)))
}

/// Colors, clamped to [0, 1].
pub(super) fn colors(elements: Elements<'_>, bad: &mut usize) -> Result<Vec<Vec4>, SceneError> {
    all(elements, bad, |parts: [f64; 4]| Vec4::from_array(parts.map(|part| single(part.clamp(0.0, 1.0)))))
}

/// Unit tangents, with 1 or -1 for the side of the bitangent.
pub(super) fn tangents(elements: Elements<'_>, bad: &mut usize) -> Result<Vec<Vec4>, SceneError> {
    all(elements, bad, |[x, y, z, w]| {
        let tangent = Vec3::new(single(x), single(y), single(z)).try_normalize().unwrap_or(Vec3::X);
        tangent.extend(if w < 0.0 { -1.0 } else { 1.0 })
    })
}

/// Normalizes normals, and replaces those without length by the direction of their faces. Returns the number of these.
pub(super) fn unit_normals(part: &mut Primitive) -> usize {
    let unit = |normal: &Vec3| {
        // In double precision: quantized and very short ones too.
        let unit = normal.as_dvec3().normalize_or_zero().as_vec3();
        unit.to_array()
    };
    let mut normals: Vec<[f32; 3]> = part.normals.iter().map(unit).collect();
    let mut made = 0;
    if normals.contains(&[0.0; 3]) {
        let positions: Vec<[f32; 3]> = part.positions.iter().map(Vec3::to_array).collect();
        let triangles: Vec<[u32; 3]> =
            part.indices.chunks_exact(3).filter_map(|corners| corners.first_chunk().copied()).collect();
        made = normals::fill(&positions, &triangles, &mut normals);
    }
    part.normals = normals.into_iter().map(Vec3::from_array).collect();
    made
}

/// Reorders the vertices: the new vertex `i` is the old vertex `order[i]`.
pub(super) fn reorder(part: &mut Primitive, order: &[u32]) {
    fn pick<T: Copy>(list: &mut Vec<T>, order: &[u32]) {
        if !list.is_empty() {
            let old = |&index: &u32| list.get(usize::try_from(index).ok()?).copied();
            *list = order.iter().filter_map(old).collect();
        }
    }
    pick(&mut part.positions, order);
    pick(&mut part.normals, order);
    pick(&mut part.tangents, order);
    part.uvs.iter_mut().for_each(|uvs| pick(uvs, order));
    part.colors.iter_mut().for_each(|colors| pick(colors, order));
    pick(&mut part.joints, order);
    pick(&mut part.weights, order);
    for morph in &mut part.morphs {
        pick(&mut morph.positions, order);
        pick(&mut morph.normals, order);
    }
}
