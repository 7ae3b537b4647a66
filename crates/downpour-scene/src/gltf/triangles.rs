//! The reading itself: vertices into world space, primitives into triangles.
//!
//! Front faces are counter-clockwise in each file; a mirroring transform reverses them, so the last two corners are
//! swapped then.

use super::accessor::Elements;
use super::buffers::Buffers;
use super::instances::{self, Instance, Placement};
use super::plan::{self, Part, Pool};
use super::{REACH, TriangleModel, assembly, normals};
use crate::Budget;
use crate::error::SceneError;
use crate::warning::{WarningKind, Warnings};
use glam::DVec3;
use gltf::json::Root;

/// Reason why the vertices of a primitive are skipped.
enum SkipReason {
    NotFinite(usize),
    OutOfReach,
}

/// The vertices of a pool in the model.
struct Placed {
    start: usize,
    count: usize,
}

/// Triangles collected so far.
struct Gathering<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    positions: Vec<[f32; 3]>,
    /// Normals, as many as positions, or none at all. A zero vector marks a normal to compute.
    normals: Option<Vec<[f32; 3]>>,
    indices: Vec<[u32; 3]>,
}

/// Reads all triangles of the scene. `source` is the number of bytes that were read from files.
pub(super) fn gather(
    root: &Root,
    buffers: &Buffers<'_>,
    source: u64,
    budget: &mut Budget,
    mut warnings: Warnings,
) -> Result<TriangleModel, SceneError> {
    let instances = instances::find(root, budget, &mut warnings)?;
    let plan = plan::make(root, &instances, source, budget, &mut warnings)?;
    let mut model = Gathering {
        root,
        buffers,
        positions: Budget::vec_with_capacity(plan.vertices, "meshes")?,
        normals: if plan.has_normals {
            Some(Budget::vec_with_capacity(plan.vertices, "meshes")?)
        } else {
            None
        },
        indices: Budget::vec_with_capacity(plan.triangles, "meshes")?,
    };
    for instance in &instances {
        let Some(mesh) = plan.meshes.get(instance.mesh).filter(|mesh| !mesh.parts.is_empty()) else {
            continue;
        };
        let Some(placement) = instance.placement() else {
            warnings.add(WarningKind::Dropped, instance, || {
                "dropped: its transform has no inverse (a scale or rotation of 0, or numbers without end)"
                    .into()
            });
            continue;
        };
        let mut pools = Vec::with_capacity(mesh.pools.len());
        for pool in &mesh.pools {
            pools.push(model.vertices(pool, &placement)?);
        }
        for part in &mesh.parts {
            match pools.get(part.pool) {
                Some(Ok(vertices)) => model.part(instance, part, vertices, placement.mirrored)?,
                Some(Err(useless)) => useless.warn(instance, part, &mut warnings),
                None => {}
            }
        }
    }
    Ok(model.finish(warnings))
}

impl Gathering<'_> {
    /// Adds the vertices of a pool, or none of them.
    fn vertices(
        &mut self,
        pool: &Pool,
        placement: &Placement,
    ) -> Result<Result<Placed, SkipReason>, SceneError> {
        let start = self.positions.len();
        let mut positions = Elements::open(self.root, self.buffers, pool.positions)?;
        let mut bad = 0usize;
        let mut reach = 0.0f64;
        while let Some(point) = positions.vector()? {
            let finite = point.iter().all(|part| part.is_finite());
            bad = bad.saturating_add(usize::from(!finite));
            let world = placement.point(point);
            // `max` passes NaN over, but then the point is counted already or the product overflowed to infinity.
            reach =
                reach.max(world.abs().max_element()).max(if world.is_finite() { 0.0 } else { f64::INFINITY });
            self.positions.push(narrow(world));
        }
        if let Some(all) = &mut self.normals {
            match pool.normals {
                None => all.resize(self.positions.len(), [0.0; 3]),
                Some(accessor) => {
                    let mut normals = Elements::open(self.root, self.buffers, accessor)?;
                    while let Some(normal) = normals.vector()? {
                        bad = bad.saturating_add(usize::from(!normal.iter().all(|part| part.is_finite())));
                        all.push(narrow(placement.normal(normal)));
                    }
                }
            }
        }
        let useless = match bad {
            0 if reach <= REACH => None,
            0 => Some(SkipReason::OutOfReach),
            bad => Some(SkipReason::NotFinite(bad)),
        };
        let Some(useless) = useless else { return Ok(Ok(Placed { start, count: positions.count() })) };
        self.positions.truncate(start);
        if let Some(normals) = &mut self.normals {
            normals.truncate(start);
        }
        Ok(Err(useless))
    }

    /// Adds the triangles of a primitive.
    fn part(
        &mut self,
        instance: &Instance,
        part: &Part,
        vertices: &Placed,
        mirrored: bool,
    ) -> Result<(), SceneError> {
        let elements = match part.indices {
            Some(accessor) => Some(Elements::open(self.root, self.buffers, accessor)?),
            None => None,
        };
        let path = format_args!("meshes[{}].primitives[{}]", instance.mesh, part.primitive);
        // The plan has checked that all vertices of the model have a 32-bit index.
        let start = u32::try_from(vertices.start).unwrap_or(u32::MAX);
        assembly::triangles(elements, part.mode, vertices.count, path, |corners| {
            let [a, b, c] = corners.map(|corner| start.saturating_add(corner));
            self.indices.push(if mirrored { [a, c, b] } else { [a, b, c] });
        })
    }

    fn finish(mut self, mut warnings: Warnings) -> TriangleModel {
        if let Some(normals) = &mut self.normals {
            let made = normals::fill(&self.positions, &self.indices, normals);
            if made > 0 {
                warnings.add(WarningKind::Irregular, "meshes", || {
                    format!(
                        "{made} vertices without a normal among others that have one: made from the faces"
                    )
                });
            }
        }
        if self.indices.is_empty() {
            warnings.add(WarningKind::Empty, "", || "no triangles".into());
        }
        TriangleModel {
            positions: self.positions,
            normals: self.normals,
            indices: self.indices,
            warnings: warnings.finish(),
            ..TriangleModel::default()
        }
    }
}

impl SkipReason {
    fn warn(&self, instance: &Instance, part: &Part, warnings: &mut Warnings) {
        let path = format_args!("meshes[{}].primitives[{}]", instance.mesh, part.primitive);
        match self {
            Self::NotFinite(count) => warnings.add(WarningKind::Dropped, path, || {
                format!("dropped: {count} positions or normals are not finite")
            }),
            Self::OutOfReach => warnings.add(WarningKind::Dropped, path, || {
                format!("dropped at {instance}: a vertex is farther than {REACH:e} m from the origin")
            }),
        }
    }
}

/// Double to single precision.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is meant; what overflows is dropped afterwards"
)]
fn narrow(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
