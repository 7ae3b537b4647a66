//! Closed mesh of a drop: triangles that face outward.
//!
//! Vertices at the same position count as one, however a file splits them for texture coordinates. Requirements:
//! each edge has exactly two triangles, which run along it in opposite directions; the volume is positive (the
//! triangles face outward); numbers are finite. Triangles that collapse to a line or a point when equal vertices
//! are merged (poles of a sphere) are dropped.

use std::collections::HashMap;

use downpour_math::vector::{add, cross, dot, normalize, scale, sub};

use crate::MaskError;

/// Maximum number of triangles of a drop model.
pub const MAX_TRIANGLES: usize = 4_000_000;

/// Requirements of a model, for messages.
const ALLOWED: &str = "a closed surface of outward-facing triangles, each edge shared by exactly two";

/// A closed mesh, centered on the centroid of its volume and scaled to the volume-equivalent radius 1.
#[derive(Clone, Debug)]
pub struct ClosedMesh {
    /// Positions of the vertices, in equivalent radii from the centroid.
    pub positions: Vec<[f32; 3]>,
    /// Normals for shading, of length 1, one per vertex.
    pub normals: Vec<[f32; 3]>,
    /// Vertices of each triangle, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Volume-equivalent diameter in the units of the given positions.
    pub diameter: f64,
}

impl ClosedMesh {
    /// Checks and normalizes a mesh. Missing normals are averaged over the triangles at a vertex, weighted by angle.
    ///
    /// ```
    /// use downpour_mask::ClosedMesh;
    /// let tetrahedron = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    /// let outward = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// assert!(ClosedMesh::new(&tetrahedron, None, &outward).is_ok());
    /// assert!(ClosedMesh::new(&tetrahedron, None, &outward[..3]).is_err()); // a hole
    /// ```
    ///
    /// # Errors
    /// [`MaskError::Mesh`] with the defect and its position.
    pub fn new(
        positions: &[[f32; 3]],
        normals: Option<&[[f32; 3]]>,
        triangles: &[[u32; 3]],
    ) -> Result<Self, MaskError> {
        check_numbers(positions, normals, triangles)?;
        let merged = merge(positions);
        let kept: Vec<[u32; 3]> = triangles
            .iter()
            .copied()
            .filter(|t| {
                let [a, b, c] = t.map(|i| merged[i as usize]);
                a != b && b != c && c != a
            })
            .collect();
        check_closed(&merged, &kept, positions)?;
        let (volume, centroid) = volume_and_centroid(positions, &kept)?;
        let radius = downpour_math::ops::f64::cbrt(volume * 3.0 / (4.0 * std::f64::consts::PI));
        let normals = match normals {
            Some(given) if given.iter().all(|n| dot(*n, *n) > 1.0e-12) => {
                given.iter().map(|n| normalize(*n)).collect()
            }
            _ => averaged_normals(positions, &merged, &kept),
        };
        let positions = positions
            .iter()
            .map(|p| std::array::from_fn(|k| ((f64::from(p[k]) - centroid[k]) / radius) as f32))
            .collect();
        Ok(Self { positions, normals, triangles: kept, diameter: 2.0 * radius })
    }
}

fn bad<T>(found: String) -> Result<T, MaskError> {
    Err(MaskError::Mesh { found, allowed: ALLOWED })
}

fn check_numbers(
    positions: &[[f32; 3]],
    normals: Option<&[[f32; 3]]>,
    triangles: &[[u32; 3]],
) -> Result<(), MaskError> {
    if triangles.is_empty() || positions.is_empty() {
        return bad(format!("it has {} vertices and {} triangles", positions.len(), triangles.len()));
    }
    if triangles.len() > MAX_TRIANGLES {
        return bad(format!("it has {} triangles, more than {MAX_TRIANGLES}", triangles.len()));
    }
    if let Some(i) = positions.iter().position(|p| p.iter().any(|c| !c.is_finite())) {
        return bad(format!("vertex {i} is at {:?}", positions[i]));
    }
    if let Some(normals) = normals {
        if normals.len() != positions.len() {
            return bad(format!("it has {} vertices and {} normals", positions.len(), normals.len()));
        }
        if let Some(i) = normals.iter().position(|n| n.iter().any(|c| !c.is_finite())) {
            return bad(format!("normal {i} is {:?}", normals[i]));
        }
    }
    match triangles.iter().position(|t| t.iter().any(|&i| i as usize >= positions.len())) {
        Some(i) => bad(format!("triangle {i} refers to {:?}, of {} vertices", triangles[i], positions.len())),
        None => Ok(()),
    }
}

/// First vertex at the same position, for each vertex.
fn merge(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(positions.len());
    (0u32..)
        .zip(positions)
        // -0 and 0 are the same position.
        .map(|(i, p)| *first.entry(p.map(|c| (c + 0.0).to_bits())).or_insert(i))
        .collect()
}

fn check_closed(merged: &[u32], triangles: &[[u32; 3]], positions: &[[f32; 3]]) -> Result<(), MaskError> {
    if triangles.is_empty() {
        return bad("all triangles are degenerate: they collapse to lines or points".to_owned());
    }
    let mut edges: HashMap<(u32, u32), u32> = HashMap::with_capacity(triangles.len() * 3);
    for t in triangles {
        let [a, b, c] = t.map(|i| merged[i as usize]);
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    // In the order of the triangles, so that the message is the same every time.
    let mut open = 0;
    let mut first_open = None;
    for t in triangles {
        let [a, b, c] = t.map(|i| merged[i as usize]);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let edge = || format!("{:?} to {:?}", positions[from as usize], positions[to as usize]);
            if edges[&(from, to)] > 1 {
                return bad(format!(
                    "the edge {} has the same direction in {} triangles (one has the wrong winding, or more than two meet)",
                    edge(),
                    edges[&(from, to)]
                ));
            }
            if !edges.contains_key(&(to, from)) {
                open += 1;
                first_open.get_or_insert_with(edge);
            }
        }
    }
    match first_open {
        Some(edge) => bad(format!("it is open: {open} edges have one triangle only, the first {edge}")),
        None => Ok(()),
    }
}

/// Volume and centroid by the divergence theorem, in f64 relative to the first vertex.
fn volume_and_centroid(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<(f64, [f64; 3]), MaskError> {
    let origin = positions[triangles[0][0] as usize].map(f64::from);
    let mut volume = 0.0;
    let mut moment = [0.0; 3];
    let mut area = 0.0;
    for t in triangles {
        let [a, b, c] = t.map(|i| sub(positions[i as usize].map(f64::from), origin));
        let part = dot(a, cross(b, c)) / 6.0;
        volume += part;
        moment = add(moment, scale(add(add(a, b), c), part / 4.0));
        let normal = cross(sub(b, a), sub(c, a));
        area += 0.5 * dot(normal, normal).sqrt();
    }
    // A sphere has the largest volume for its area; below a millionth of it the mesh is a sheet.
    let sphere = area * area.sqrt() / (6.0 * std::f64::consts::PI.sqrt());
    if !volume.is_finite() || volume.abs() <= 1.0e-6 * sphere {
        return bad(format!("it is degenerate: its volume is {volume:e} for an area of {area:e}"));
    }
    if volume < 0.0 {
        return bad(format!("it is inside out: the triangles face inward (volume {volume:e})"));
    }
    Ok((volume, add(origin, scale(moment, 1.0 / volume))))
}

/// Normals at each position: mean over its triangles, weighted by their angle there.
fn averaged_normals(positions: &[[f32; 3]], merged: &[u32], triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
    let mut sums = vec![[0.0f64; 3]; positions.len()];
    for t in triangles {
        let corners = t.map(|i| positions[i as usize].map(f64::from));
        let normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
        let length = dot(normal, normal).sqrt();
        if length == 0.0 {
            continue;
        }
        for k in 0..3 {
            let (a, b) = (sub(corners[(k + 1) % 3], corners[k]), sub(corners[(k + 2) % 3], corners[k]));
            let turned = cross(a, b);
            let angle = downpour_math::ops::f64::atan2(dot(turned, turned).sqrt(), dot(a, b));
            let vertex = merged[t[k] as usize] as usize;
            sums[vertex] = add(sums[vertex], scale(normal, angle / length));
        }
    }
    merged
        .iter()
        .map(|&vertex| {
            let n = sums[vertex as usize];
            let length = dot(n, n).sqrt();
            // A position that no kept triangle uses has no normal, which is never read.
            if length > 0.0 { n.map(|c| (c / length) as f32) } else { [0.0, 1.0, 0.0] }
        })
        .collect()
}
