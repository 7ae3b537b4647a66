//! Light directions as triangles.
//!
//! The half sphere x >= 0 is seen from the point (-1, 0, 0) on the plane x = 0: the point (x, y, z) is at
//! (y, z) / (1 + x). This stereographic map sends circles to circles, so the Delaunay triangulation of the plane is that
//! of the sphere. The plane x = 0 becomes the unit circle, which the triangles fill but for slivers at its rim.

use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};

use crate::AtlasError;
use crate::lookup::{AtlasTriangle, atlas_map};
use downpour_shaders::atlas::ATLAS_NONE;

struct Corner {
    position: Point2<f64>,
    direction: u32,
}

impl HasPosition for Corner {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// Triangles among the directions. Their order depends on the directions alone.
///
/// # Errors
/// [`AtlasError::File`] if two directions are the same, or all lie on one circle.
pub(crate) fn triangulate(directions: &[[f64; 3]]) -> Result<Vec<AtlasTriangle>, AtlasError> {
    const LOCATION: &str = "directions of streaks";
    let wrong = |found: String| AtlasError::File {
        location: LOCATION,
        found,
        allowed: "three or more directions that differ and do not lie on one circle",
    };
    let mut mesh = DelaunayTriangulation::<Corner>::new();
    let mut positions = Vec::new();
    for (direction, d) in (0..).zip(directions) {
        let [u, v] = atlas_map(d.map(|c| c as f32));
        positions.push([u, v]);
        mesh.insert(Corner { position: Point2::new(u.into(), v.into()), direction })
            .map_err(|error| wrong(format!("{d:?}: {error}")))?;
    }
    if mesh.num_vertices() != directions.len() {
        return Err(wrong("a direction twice".to_owned()));
    }
    let mut corners: Vec<[u32; 3]> = mesh
        .inner_faces()
        .map(|face| {
            let mut found = face.vertices().map(|vertex| vertex.data().direction);
            // Start with the smallest index, keep the winding.
            let first = (0..3).min_by_key(|&k| found[k]).unwrap_or(0);
            found.rotate_left(first);
            found
        })
        .collect();
    corners.sort_unstable();
    if corners.is_empty() {
        return Err(wrong(format!("{} directions without a triangle", directions.len())));
    }
    let across = |me: usize, edge: [u32; 2]| -> u32 {
        let fractions = |other: &[u32; 3]| edge.iter().all(|corner| other.contains(corner));
        let found = corners.iter().enumerate().position(|(k, other)| k != me && fractions(other));
        found.map_or(ATLAS_NONE, |k| k as u32)
    };
    Ok(corners
        .iter()
        .enumerate()
        .map(|(k, &[a, b, c])| AtlasTriangle {
            a: positions[a as usize],
            b: positions[b as usize],
            c: positions[c as usize],
            unused: [0.0; 2],
            directions: [a, b, c],
            unused_1: 0,
            next: [across(k, [b, c]), across(k, [c, a]), across(k, [a, b])],
            unused_2: 0,
        })
        .collect())
}
