//! A drop as a closed triangle mesh with exact normals.
//!
//! Positions are in meters from the drop's origin, in glTF's axes: right-handed, +Y up, the bottom of the
//! drop toward -Y. Triangles are counter-clockwise seen from outside. All triangles that meet at a point share
//! one vertex, the poles included, so the mesh is watertight by its indices: each edge belongs to two
//! triangles that traverse it in opposite directions.
//!
//! Vertices lie on the surface, and normals are those of the surface, not of the triangles. The volume is
//! below the drop's by an error of second order in the spacing.

use downpour_math::in_range;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use downpour_math::ops;

use crate::DropError;
use crate::shape::{DropShape, drop_shape_normal, drop_shape_radius};

/// A star-shaped surface: each ray from the origin leaves it once.
pub trait DropSurface {
    /// Distance from the origin to the surface, in meters, along a unit vector (+Y up).
    fn radius_along(&self, direction: [f64; 3]) -> f64;

    /// Outward unit normal at that point.
    fn normal_along(&self, direction: [f64; 3]) -> [f64; 3];
}

impl DropSurface for DropShape {
    fn radius_along(&self, direction: [f64; 3]) -> f64 {
        self.equivalent_radius() * drop_shape_radius(&self.coefficients(), -direction[1])
    }

    fn normal_along(&self, direction: [f64; 3]) -> [f64; 3] {
        drop_shape_normal(&self.coefficients(), direction, [0.0, 1.0, 0.0])
    }
}

/// A closed triangle mesh.
///
/// ```
/// use downpour_drop::mesh::DropMesh;
/// use downpour_drop::shape::DropShape;
/// let drop = DropShape::new(3.0e-3)?;
/// let mesh = DropMesh::latitude_longitude(&drop, 32, 64)?;
/// assert_eq!(mesh.positions().len(), 2 + 31 * 64);
/// assert!((mesh.volume() / drop.volume() - 1.0).abs() < 0.01);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DropMesh {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl DropMesh {
    /// Creates a mesh of bands of equal angle: `latitudes` bands from pole to pole, each of `longitudes` cells. The
    /// first vertex is the bottom, the last the top.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if `latitudes` is not 2 to 2048, or `longitudes` not 3 to 4096.
    pub fn latitude_longitude(
        surface: &impl DropSurface,
        latitudes: u32,
        longitudes: u32,
    ) -> Result<Self, DropError> {
        check_count("number of latitudes", latitudes, 2..=2048, "2 to 2048")?;
        check_count("number of longitudes", longitudes, 3..=4096, "3 to 4096")?;
        let mut mesh = Self::default();
        mesh.push_vertex(surface, [0.0, -1.0, 0.0]);
        for i in 1..latitudes {
            let theta = PI * f64::from(i) / f64::from(latitudes);
            let (away, up) = (ops::f64::sin(theta), -ops::f64::cos(theta));
            for j in 0..longitudes {
                let phi = TAU * f64::from(j) / f64::from(longitudes);
                mesh.push_vertex(surface, [away * ops::f64::cos(phi), up, -away * ops::f64::sin(phi)]);
            }
        }
        mesh.push_vertex(surface, [0.0, 1.0, 0.0]);
        let (bottom, top) = (0, 1 + (latitudes - 1) * longitudes);
        let vertex = |ring: u32, j: u32| 1 + (ring - 1) * longitudes + j % longitudes;
        for j in 0..longitudes {
            mesh.triangles.push([bottom, vertex(1, j + 1), vertex(1, j)]);
            for ring in 1..latitudes - 1 {
                let [a, b] = [vertex(ring, j), vertex(ring, j + 1)];
                let [c, d] = [vertex(ring + 1, j), vertex(ring + 1, j + 1)];
                mesh.triangles.extend([[a, b, d], [a, d, c]]);
            }
            mesh.triangles.push([top, vertex(latitudes - 1, j), vertex(latitudes - 1, j + 1)]);
        }
        Ok(mesh)
    }

    /// Creates a mesh of nearly equal triangles: an icosahedron on the sphere of directions whose triangles are
    /// split into four, `subdivisions` times. It has 20 * 4^subdivisions triangles.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if `subdivisions` is above 8.
    pub fn icosphere(surface: &impl DropSurface, subdivisions: u32) -> Result<Self, DropError> {
        check_count("number of subdivisions", subdivisions, 0..=8, "0 to 8")?;
        let golden = 0.5 * (1.0 + 5.0f64.sqrt());
        // Three golden rectangles, in the planes x = 0, y = 0 and z = 0.
        let mut directions = Vec::new();
        for axis in 0..3 {
            for [long, short] in [[golden, 1.0], [golden, -1.0], [-golden, 1.0], [-golden, -1.0]] {
                let mut corner = [0.0; 3];
                corner[(axis + 1) % 3] = short;
                corner[(axis + 2) % 3] = long;
                directions.push(unit(corner));
            }
        }
        let mut triangles = icosahedron_faces(&directions);
        for _ in 0..subdivisions {
            triangles = subdivide(&mut directions, &triangles);
        }
        let mut mesh = Self { triangles, ..Self::default() };
        for direction in directions {
            mesh.push_vertex(surface, direction);
        }
        Ok(mesh)
    }

    fn push_vertex(&mut self, surface: &impl DropSurface, direction: [f64; 3]) {
        let r = surface.radius_along(direction);
        self.positions.push(direction.map(|d| (r * d) as f32));
        self.normals.push(surface.normal_along(direction).map(|n| n as f32));
    }

    /// Positions of the vertices, in meters.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Outward unit normals of the surface at the vertices.
    #[must_use]
    pub fn normals(&self) -> &[[f32; 3]] {
        &self.normals
    }

    /// Vertex indices of each triangle, counter-clockwise from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Volume within the triangles, in cubic meters.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let corner = |i: u32| self.positions[i as usize].map(f64::from);
        self.triangles.iter().map(|&[a, b, c]| determinant(corner(a), corner(b), corner(c)) / 6.0).sum()
    }
}

fn check_count(
    quantity: &'static str,
    found: u32,
    range: std::ops::RangeInclusive<u32>,
    allowed: &'static str,
) -> Result<(), DropError> {
    in_range(quantity, found, "in all", &range, 1.0, allowed)?;
    Ok(())
}

/// Triples of adjacent corners among the twelve, counter-clockwise from outside.
fn icosahedron_faces(corners: &[[f64; 3]]) -> Vec<[u32; 3]> {
    // Adjacent corners are 63.4 degrees apart, others 116.6 and more.
    let near = |a: usize, b: usize| dot(corners[a], corners[b]) > 0.0;
    let mut faces = Vec::new();
    for a in 0..corners.len() {
        for b in a + 1..corners.len() {
            for c in b + 1..corners.len() {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outward = determinant(corners[a], corners[b], corners[c]) > 0.0;
                    let [b, c] = if outward { [b, c] } else { [c, b] };
                    faces.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    faces
}

/// Splits each triangle into four at the middles of its edges, which neighbors share.
fn subdivide(directions: &mut Vec<[f64; 3]>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = HashMap::new();
    let mut middle = |a: u32, b: u32| -> u32 {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let (p, q) = (directions[a as usize], directions[b as usize]);
            directions.push(unit([p[0] + q[0], p[1] + q[1], p[2] + q[2]]));
            directions.len() as u32 - 1
        })
    };
    let mut finer = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    finer
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drop() -> DropShape {
        DropShape::new(5.0e-3).expect("in range")
    }

    /// Each edge is traversed twice, once in each direction; vertices - edges + faces = 2; the volume is positive.
    fn check_closed(mesh: &DropMesh) {
        let mut edges = HashMap::new();
        for &[a, b, c] in mesh.triangles() {
            assert!(a != b && b != c && c != a);
            for edge in [(a, b), (b, c), (c, a)] {
                assert_eq!(edges.insert(edge, ()), None, "{edge:?} is passed twice in one sense");
            }
        }
        assert!(edges.keys().all(|&(a, b)| edges.contains_key(&(b, a))), "an edge is open");
        let vertices = mesh.positions().len();
        assert_eq!(mesh.normals().len(), vertices);
        assert_eq!(vertices + mesh.triangles().len(), edges.len() / 2 + 2);
        let used: std::collections::HashSet<u32> = mesh.triangles().iter().flatten().copied().collect();
        assert_eq!(used.len(), vertices, "a vertex is not used");
        assert!(mesh.volume() > 0.0, "inside out");
    }

    #[test]
    fn meshes_are_closed() {
        for (latitudes, longitudes) in [(2, 3), (3, 3), (2, 7), (16, 24), (33, 17)] {
            check_closed(&DropMesh::latitude_longitude(&drop(), latitudes, longitudes).expect("in range"));
        }
        for subdivisions in 0..4 {
            let mesh = DropMesh::icosphere(&drop(), subdivisions).expect("in range");
            assert_eq!(mesh.triangles().len(), 20 << (2 * subdivisions));
            check_closed(&mesh);
        }
    }

    #[test]
    fn every_triangle_and_normal_looks_outwards() {
        for mesh in [DropMesh::latitude_longitude(&drop(), 24, 32), DropMesh::icosphere(&drop(), 3)] {
            let mesh = mesh.expect("in range");
            for triangle in mesh.triangles() {
                let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize].map(f64::from));
                let (u, v): ([f64; 3], [f64; 3]) =
                    (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
                let face = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
                for &i in triangle {
                    let normal = mesh.normals()[i as usize].map(f64::from);
                    assert!(dot(unit(face), normal) > 0.9, "{triangle:?}");
                    assert!((dot(normal, normal) - 1.0).abs() < 1.0e-6);
                }
            }
        }
    }

    /// Halving the spacing leaves a quarter of the error.
    #[test]
    fn the_volume_converges_at_second_order() {
        let exact = drop().volume();
        let error = |mesh: Result<DropMesh, DropError>| 1.0 - mesh.expect("in range").volume() / exact;
        for n in [16, 32, 64] {
            let coarse = error(DropMesh::latitude_longitude(&drop(), n, 2 * n));
            let fine = error(DropMesh::latitude_longitude(&drop(), 2 * n, 4 * n));
            assert!((3.9..4.1).contains(&(coarse / fine)), "{n}: {coarse} {fine}");
        }
        let (coarse, fine) = (error(DropMesh::icosphere(&drop(), 3)), error(DropMesh::icosphere(&drop(), 4)));
        assert!((3.8..4.2).contains(&(coarse / fine)), "{coarse} {fine}");
    }

    #[test]
    fn the_bottom_is_down() {
        let mesh = DropMesh::latitude_longitude(&drop(), 8, 8).expect("in range");
        let (bottom, top) = (mesh.positions()[0], mesh.positions()[mesh.positions().len() - 1]);
        assert!(bottom[1] < 0.0 && top[1] > 0.0 && -bottom[1] < top[1], "{bottom:?} {top:?}");
        assert!((f64::from(-bottom[1]) / drop().radius(0.0) - 1.0).abs() < 1.0e-6);
        assert_eq!(mesh.normals()[0], [0.0, -1.0, 0.0]);
    }

    #[test]
    fn counts_are_limited() {
        for (latitudes, longitudes) in [(1, 8), (8, 2), (2049, 8), (8, 4097), (0, 0), (u32::MAX, 8)] {
            assert!(DropMesh::latitude_longitude(&drop(), latitudes, longitudes).is_err());
        }
        let error = DropMesh::icosphere(&drop(), 9).expect_err("too fine");
        assert_eq!(error.to_string(), "number of subdivisions is 9 in all; allowed: 0 to 8");
    }
}
