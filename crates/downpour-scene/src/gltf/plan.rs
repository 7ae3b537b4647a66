//! Plan of reading: selection and size of the data, before any of it is read.
//!
//! A small file can ask for a great deal: primitives that share one accessor, accessors without data, a mesh on
//! ten thousand nodes. The sums are computed first, in 64 bits, and compared with the budget and with the size
//! of the file: memory may grow, but with a bound.

use super::growth::GrowthBudget;
use super::instances::Instance;
use crate::Budget;
use crate::error::SceneError;
use crate::warning::{WarningKind, Warnings};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, Root};
use std::collections::BTreeMap;
use std::fmt;

/// Bytes of a vertex (position, normal) and of a triangle, and cost in time of a primitive of an instance.
const PER_VERTEX: u64 = 24;
const PER_TRIANGLE: u64 = 12;
const PER_PART: u64 = 128;

/// The vertices of one or more primitives.
pub(super) struct Pool {
    pub(super) positions: Index<Accessor>,
    pub(super) normals: Option<Index<Accessor>>,
}

/// The triangles of one primitive.
pub(super) struct Part {
    pub(super) primitive: usize,
    pub(super) pool: usize,
    pub(super) indices: Option<Index<Accessor>>,
    pub(super) mode: Mode,
}

/// Data to read of one mesh.
#[derive(Default)]
pub(super) struct MeshPlan {
    pub(super) pools: Vec<Pool>,
    pub(super) parts: Vec<Part>,
    vertices: u64,
    triangles: u64,
}

/// Data to read of a document.
pub(super) struct Plan {
    /// One for each mesh; empty for meshes that the scene does not use.
    pub(super) meshes: Vec<MeshPlan>,
    pub(super) vertices: usize,
    pub(super) triangles: usize,
    pub(super) has_normals: bool,
}

/// Plans the reading of all instances and takes its cost from the budget.
pub(super) fn make(
    root: &Root,
    instances: &[Instance],
    source: u64,
    budget: &mut Budget,
    warnings: &mut Warnings,
) -> Result<Plan, SceneError> {
    let mut used = vec![false; root.meshes.len()];
    for instance in instances {
        if let Some(used) = used.get_mut(instance.mesh) {
            *used = true;
        }
    }
    let one = |(index, used)| if used { mesh(root, index, warnings) } else { MeshPlan::default() };
    let meshes: Vec<MeshPlan> = used.into_iter().enumerate().map(one).collect();
    let (mut vertices, mut triangles, mut parts) = (0u64, 0u64, 0u64);
    for mesh in instances.iter().filter_map(|instance| meshes.get(instance.mesh)) {
        vertices = vertices.saturating_add(mesh.vertices);
        triangles = triangles.saturating_add(mesh.triangles);
        parts = parts.saturating_add(mesh.parts.len() as u64).saturating_add(1);
    }
    let cost = [(vertices, PER_VERTEX), (triangles, PER_TRIANGLE), (parts, PER_PART)]
        .into_iter()
        .fold(0u64, |sum, (count, each)| sum.saturating_add(count.saturating_mul(each)));
    let path = "meshes";
    budget.take_vertices(vertices, path)?;
    GrowthBudget::new(budget, source).take(cost, path)?;
    let fits = |count: u64| u32::try_from(count).ok().and_then(|count| usize::try_from(count).ok());
    match (fits(vertices), fits(triangles)) {
        (Some(vertices), Some(triangles)) => {
            let has_normals = meshes.iter().flat_map(|mesh| &mesh.pools).any(|pool| pool.normals.is_some());
            Ok(Plan { meshes, vertices, triangles, has_normals })
        }
        _ => Err(SceneError::limit(
            path,
            format!("{vertices} vertices, {triangles} triangles"),
            "2^32 of each",
        )),
    }
}

fn mesh(root: &Root, index: usize, warnings: &mut Warnings) -> MeshPlan {
    let mut plan = MeshPlan::default();
    let Some(mesh) = root.meshes.get(index) else { return plan };
    let mut pools: BTreeMap<(usize, Option<usize>), usize> = BTreeMap::new();
    for (primitive, json) in mesh.primitives.iter().enumerate() {
        let path = format_args!("meshes[{index}].primitives[{primitive}]");
        let Some(Shape { positions, mode, triangles }) = shape(root, json, path, warnings) else { continue };
        let normals = json.attributes.get(&Checked::Valid(Semantic::Normals)).copied();
        if json.targets.is_some() && mesh.weights.iter().flatten().any(|&weight| weight != 0.0) {
            warnings.add(WarningKind::Ignored, path, || {
                "morph targets are not read: the base shape is taken".into()
            });
        }
        let next = plan.pools.len();
        let pool = *pools.entry((positions.value(), normals.map(|n| n.value()))).or_insert(next);
        if pool == next {
            plan.vertices = plan.vertices.saturating_add(count(root, positions));
            plan.pools.push(Pool { positions, normals });
        }
        plan.triangles = plan.triangles.saturating_add(triangles);
        plan.parts.push(Part { primitive, pool, indices: json.indices, mode });
    }
    plan
}

/// Readable data of a primitive.
pub(super) struct Shape {
    pub(super) positions: Index<Accessor>,
    pub(super) mode: Mode,
    pub(super) triangles: u64,
}

/// Number of elements of an accessor.
pub(super) fn count(root: &Root, accessor: Index<Accessor>) -> u64 {
    root.get(accessor).map_or(0, |accessor| accessor.count.0)
}

/// Examines a primitive; `None`, with a warning, if it has nothing to read.
pub(super) fn shape(
    root: &Root,
    json: &Primitive,
    path: fmt::Arguments<'_>,
    warnings: &mut Warnings,
) -> Option<Shape> {
    let mode = match json.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
        Checked::Valid(_) | Checked::Invalid => {
            warnings.add(WarningKind::Ignored, path, || "points or lines: skipped".into());
            return None;
        }
    };
    let Some(&positions) = json.attributes.get(&Checked::Valid(Semantic::Positions)) else {
        warnings.add(WarningKind::Ignored, path, || "no POSITION: skipped".into());
        return None;
    };
    // Without data all numbers are 0; files whose data is in an unsupported extension look the same.
    if root.get(positions).is_none_or(|accessor| accessor.buffer_view.is_none() && accessor.sparse.is_none())
    {
        warnings.add(WarningKind::Dropped, path, || "dropped: POSITION has no data".into());
        return None;
    }
    let corners = count(root, json.indices.unwrap_or(positions));
    let triangles = match mode {
        Mode::Triangles => corners / 3,
        _ => corners.saturating_sub(2),
    };
    if triangles == 0 || (mode == Mode::Triangles && !corners.is_multiple_of(3)) {
        warnings.add(WarningKind::Irregular, path, || {
            format!("{corners} corners are not a multiple of 3: the last are ignored")
        });
    }
    Some(Shape { positions, mode, triangles })
}
