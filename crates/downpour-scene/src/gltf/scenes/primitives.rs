//! The vertices and triangles of a primitive.

use super::{flat, tangents, vertices, weights};
use crate::error::SceneError;
use crate::gltf::accessor::Elements;
use crate::gltf::buffers::Buffers;
use crate::gltf::growth::GrowthBudget;
use crate::gltf::plan::{self, Shape};
use crate::gltf::{REACH, assembly, irregular};
use crate::scene::{Bounds, Material, MorphTarget, Primitive, TextureRef};
use crate::warning::{WarningKind, Warnings};
use glam::Vec3;
use gltf::json::mesh::{self, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, Root};

/// Sources of the data.
pub(super) struct Reading<'a> {
    pub(super) root: &'a Root,
    pub(super) buffers: &'a Buffers<'a>,
}

impl<'a> Reading<'a> {
    /// The elements of an accessor.
    pub(super) fn open(&self, accessor: Index<Accessor>) -> Result<Elements<'a>, SceneError> {
        Elements::open(self.root, self.buffers, accessor)
    }

    /// The elements of an attribute.
    pub(super) fn attribute(
        &self,
        json: &mesh::Primitive,
        semantic: Semantic,
    ) -> Result<Option<Elements<'a>>, SceneError> {
        let accessor = json.attributes.get(&Checked::Valid(semantic));
        accessor.map(|&accessor| self.open(accessor)).transpose()
    }
}

/// Bytes of a vertex with all that it may have, but for morph targets; and of a corner.
const PER_VERTEX: u64 = 12 + 12 + 16 + 8 + 8 + 16 + 8 + 16;
const PER_CORNER: u64 = 4;

/// Reads a primitive; `None`, with a warning, if its data is unusable. `uses` is the number of nodes that draw it.
#[expect(clippy::too_many_arguments, reason = "one call, and all of them are of different kinds")]
pub(super) fn read(
    reading: &Reading<'_>,
    json: &mesh::Primitive,
    shape: &Shape,
    path: &str,
    uses: u64,
    normal_map: Option<TextureRef>,
    remaining: &mut GrowthBudget<'_>,
    warnings: &mut Warnings,
) -> Result<Option<Primitive>, SceneError> {
    let targets = json.targets.as_deref().unwrap_or_default();
    let mut vertices = plan::count(reading.root, shape.positions);
    let corners = shape.triangles.saturating_mul(3);
    let has = |semantic| json.attributes.contains_key(&Checked::Valid(semantic));
    let has_normals = has(Semantic::Normals);
    let makes_tangents = normal_map.is_some() && has_normals && !has(Semantic::Tangents);
    if !has_normals || makes_tangents {
        // In the worst case no two corners share a vertex any more; both lists are held for a while.
        vertices = vertices.saturating_add(corners);
    }
    remaining.budget.take_vertices(vertices.saturating_mul(uses), path)?;
    let each = PER_VERTEX.saturating_add((targets.len() as u64).saturating_mul(24));
    let cost = vertices.saturating_mul(each).saturating_add(corners.saturating_mul(PER_CORNER));
    remaining.take(cost, path)?;

    let mut bad = 0usize;
    let positions = vertices::vectors(reading.open(shape.positions)?, &mut bad)?;
    let mut part = Primitive { positions, ..Primitive::default() };
    let reach = part.positions.iter().fold(0.0f32, |all, point| all.max(point.abs().max_element()));
    if let Some(normals) = reading.attribute(json, Semantic::Normals)? {
        part.normals = vertices::vectors(normals, &mut bad)?;
        if let Some(tangents) = reading.attribute(json, Semantic::Tangents)? {
            part.tangents = vertices::tangents(tangents, &mut bad)?;
        }
    }
    for (set, uvs) in (0u32..).zip(&mut part.uvs) {
        if let Some(elements) = reading.attribute(json, Semantic::TexCoords(set))? {
            *uvs = vertices::pairs(elements, &mut bad)?;
        }
    }
    if let Some(colors) = reading.attribute(json, Semantic::Colors(0))? {
        part.colors = Some(vertices::colors(colors, &mut bad)?);
    }
    weights::read(reading, json, &mut part, path, warnings)?;
    for (index, target) in targets.iter().enumerate() {
        part.morphs.push(morph(reading, target, has_normals, &mut bad)?);
        if target.positions.is_none() && target.normals.is_none() {
            irregular(warnings, format_args!("{path}.targets[{index}]"), || "changes no vertex data".into());
        }
    }
    if bad > 0 {
        warnings.add(WarningKind::Dropped, path, || {
            format!("dropped: {bad} positions, normals or other vertex data are not finite")
        });
        return Ok(None);
    }
    let farthest = part.morphs.iter().fold(reach, |all, morph| all.max(morph.farthest));
    if f64::from(farthest) > REACH {
        warnings.add(WarningKind::Dropped, path, || {
            format!("dropped: a vertex is farther than {REACH:e} m from the origin")
        });
        return Ok(None);
    }

    let indices = json.indices.map(|accessor| reading.open(accessor)).transpose()?;
    let room = usize::try_from(corners).unwrap_or(usize::MAX);
    part.indices = crate::Budget::vec_with_capacity(room, path)?;
    assembly::triangles(indices, shape.mode, part.positions.len(), path, |corners| {
        part.indices.extend(corners);
    })?;
    if part.indices.is_empty() {
        return Ok(None);
    }
    if has_normals {
        let made = vertices::unit_normals(&mut part);
        if made > 0 {
            irregular(warnings, path, || format!("{made} normals of length 0: made from the faces"));
        }
    } else {
        flat::shade(&mut part);
    }
    if let Some(used) = normal_map.filter(|_| part.tangents.is_empty()) {
        tangents::make(&mut part, used.uv_set);
    }
    part.bounds = Bounds::of(&part.positions);
    Ok(Some(part))
}

fn morph(
    reading: &Reading<'_>,
    target: &mesh::MorphTarget,
    has_normals: bool,
    bad: &mut usize,
) -> Result<MorphTarget, SceneError> {
    let mut read = |accessor: Option<Index<Accessor>>| match accessor {
        None => Ok(Vec::new()),
        Some(accessor) => vertices::vectors(reading.open(accessor)?, bad),
    };
    let positions = read(target.positions)?;
    let normals = read(target.normals.filter(|_| has_normals))?;
    let longest = positions.iter().copied().map(Vec3::length_squared).fold(0.0, f32::max);
    // A square beyond the range is beyond the reach too.
    Ok(MorphTarget { positions, normals, farthest: longest.sqrt() })
}

/// Warns if a material uses texture coordinates that are missing.
pub(super) fn check_uvs(part: &Primitive, material: &Material, path: &str, warnings: &mut Warnings) {
    let missing = |set: &usize| part.uvs.get(*set).is_none_or(Vec::is_empty);
    if let Some(set) = material.textures().map(|used| used.uv_set).find(missing) {
        irregular(warnings, path, || format!("no TEXCOORD_{set}, which its material uses: taken as (0, 0)"));
    }
}
