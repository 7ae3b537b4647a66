//! Triangles with normals, texture coordinates and tints, built from quads, boxes, grids, lathed and extruded shapes.

use std::collections::BTreeMap;

use downpour_math::ops;
use glam::{Vec2, Vec3};

use crate::material::Material;

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Meters.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Multiplies the color of the material; in [0, 1].
    pub tint: Vec3,
}

/// Triangles of one material.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Corners.
    pub vertices: Vec<Vertex>,
    /// Three for each triangle, counter-clockwise from the front.
    pub indices: Vec<u32>,
}

/// Triangles of several materials.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Triangles by material.
    pub parts: BTreeMap<Material, Part>,
}

/// A material with a tint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Paint {
    pub(crate) material: Material,
    pub(crate) tint: Vec3,
}

/// A material as it is.
pub(crate) fn plain(material: Material) -> Paint {
    Paint { material, tint: Vec3::ONE }
}

/// A material times a color.
pub(crate) fn tinted(material: Material, tint: [f32; 3]) -> Paint {
    Paint { material, tint: tint.into() }
}

/// Sides of a box, to be left out.
pub(crate) const LEFT: u8 = 1;
pub(crate) const RIGHT: u8 = 2;
pub(crate) const BELOW: u8 = 4;
pub(crate) const ABOVE: u8 = 8;
pub(crate) const BEHIND: u8 = 16;
pub(crate) const FRONT: u8 = 32;

/// Corners of a circle around a point that looks along +z, counter-clockwise.
pub(crate) fn circle(center: Vec3, radius: f32, sides: usize) -> Vec<Vec3> {
    let corner = |k: usize| {
        let angle = k as f32 / sides as f32 * std::f32::consts::TAU;
        Vec3::new(center.x + radius * ops::cos(angle), center.y + radius * ops::sin(angle), center.z)
    };
    (0..sides).map(corner).collect()
}

/// Edges of a turned or drawn-out shape sharper than this stay sharp: cosine of 40 degrees.
const CREASE: f32 = 0.766;

/// Square of twice the area of the smallest triangle that is kept, m^4: one of 5e-7 m^2.
const MIN_CROSS_SQUARED: f32 = 1.0e-12;

impl Mesh {
    /// The part of a material.
    pub(crate) fn part(&mut self, material: Material) -> &mut Part {
        self.parts.entry(material).or_default()
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.parts.values().map(|part| part.indices.len() / 3).sum()
    }

    /// Volume that it encloses, m^3: less than 0 where its fronts look inward.
    #[cfg(test)]
    pub(crate) fn volume_m3(&self) -> f32 {
        let of_part = |part: &Part| -> f32 {
            let corner = |k: u32| part.vertices[k as usize].position;
            part.indices
                .chunks_exact(3)
                .map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0)
                .sum()
        };
        self.parts.values().map(of_part).sum()
    }

    /// A flat quad, corners counter-clockwise, with given coordinates.
    pub(crate) fn quad_uv(&mut self, paint: Paint, corners: [Vec3; 4], uvs: [Vec2; 4]) {
        let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero();
        let part = self.part(paint.material);
        let first = part.vertices.len() as u32;
        for (position, uv) in corners.into_iter().zip(uvs) {
            part.vertices.push(Vertex { position, normal, uv, tint: paint.tint });
        }
        part.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }

    /// A flat quad, corners counter-clockwise, with the material's texture laid on in meters.
    pub(crate) fn quad(&mut self, paint: Paint, corners: [Vec3; 4]) {
        let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
        let uvs = corners.map(|corner| laid_on(corner, normal, paint.material.tile_m()));
        self.quad_uv(paint, corners, uvs);
    }

    /// A flat convex polygon, corners counter-clockwise.
    pub(crate) fn polygon(&mut self, paint: Paint, corners: &[Vec3]) {
        let [a, b, c, ..] = corners else { return };
        let normal = (*b - *a).cross(*c - *a).normalize_or_zero();
        let part = self.part(paint.material);
        let first = part.vertices.len() as u32;
        for &position in corners {
            let uv = laid_on(position, normal, paint.material.tile_m());
            part.vertices.push(Vertex { position, normal, uv, tint: paint.tint });
        }
        for k in 1..corners.len() as u32 - 1 {
            part.indices.extend([first, first + k, first + k + 1]);
        }
    }

    /// A box without the sides in `left_out`; its front looks along +z.
    pub(crate) fn cuboid(&mut self, paint: Paint, low: Vec3, high: Vec3, left_out: u8) {
        let p = |x: u8, y: u8, z: u8| {
            let pick = |bit: u8, low: f32, high: f32| if bit == 1 { high } else { low };
            Vec3::new(pick(x, low.x, high.x), pick(y, low.y, high.y), pick(z, low.z, high.z))
        };
        let sides: [(u8, [Vec3; 4]); 6] = [
            (FRONT, [p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)]),
            (BEHIND, [p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0)]),
            (LEFT, [p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)]),
            (RIGHT, [p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1)]),
            (ABOVE, [p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0)]),
            (BELOW, [p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)]),
        ];
        for (side, corners) in sides {
            if left_out & side == 0 {
                self.quad(paint, corners);
            }
        }
    }

    /// A box from its lowest corner and its size, with all sides.
    pub(crate) fn block(&mut self, paint: Paint, low: [f32; 3], size: [f32; 3]) {
        let low = Vec3::from(low);
        self.cuboid(paint, low, low + Vec3::from(size), 0);
    }

    /// A smooth surface over a grid of points: `at(column, row)` returns position, texture coordinates and tint;
    /// `paint(column, row)` the material of a cell, or `None` for a hole. Its front is in the direction columns x rows.
    pub(crate) fn grid(
        &mut self,
        size: [usize; 2],
        at: impl Fn(usize, usize) -> (Vec3, Vec2, Vec3),
        paint: impl Fn(usize, usize) -> Option<Material>,
    ) {
        let [columns, rows] = size;
        let points: Vec<(Vec3, Vec2, Vec3)> =
            (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j))).map(|(i, j)| at(i, j)).collect();
        let index = |i: usize, j: usize| j * (columns + 1) + i;
        let normal = |i: usize, j: usize| {
            let p = |i: usize, j: usize| points[index(i, j)].0;
            let along = p((i + 1).min(columns), j) - p(i.saturating_sub(1), j);
            let across = p(i, (j + 1).min(rows)) - p(i, j.saturating_sub(1));
            along.cross(across).normalize_or_zero()
        };
        let mut known: BTreeMap<(Material, usize), u32> = BTreeMap::new();
        for j in 0..rows {
            for i in 0..columns {
                let Some(material) = paint(i, j) else { continue };
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
                    *known.entry((material, index(i, j))).or_insert_with(|| {
                        let (position, uv, tint) = points[index(i, j)];
                        let part = self.part(material);
                        part.vertices.push(Vertex { position, normal: normal(i, j), uv, tint });
                        part.vertices.len() as u32 - 1
                    })
                });
                let part = self.part(material);
                for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                    let p = [corners[a], corners[b], corners[c]].map(|k| part.vertices[k as usize].position);
                    if (p[1] - p[0]).cross(p[2] - p[0]).length_squared() > 1e-14 {
                        part.indices.extend([corners[a], corners[b], corners[c]]);
                    }
                }
            }
        }
    }

    /// A shape turned about the vertical through `foot`: `profile` is radius and height from below, its front outside.
    pub(crate) fn lathe(&mut self, paint: Paint, foot: Vec3, profile: &[[f32; 2]], segments: usize) {
        let ring = |k: usize| {
            let angle = k as f32 / segments as f32 * std::f32::consts::TAU;
            (ops::cos(angle), ops::sin(angle))
        };
        let tile = paint.material.tile_m();
        let across = |k: usize| {
            let [a, b] = [profile[k], profile[k + 1]];
            Vec2::new(b[1] - a[1], a[0] - b[0]).normalize_or_zero()
        };
        let last = profile.len() - 2;
        for k in 0..=last {
            let own = across(k);
            let shared = |other: Vec2| if own.dot(other) > CREASE { (own + other).normalize() } else { own };
            let ends = [shared(across(k.saturating_sub(1))), shared(across((k + 1).min(last)))];
            let part = self.part(paint.material);
            let first = part.vertices.len() as u32;
            for step in 0..=segments {
                let (c, s) = ring(step);
                for (end, [radius, height]) in ends.into_iter().zip([profile[k], profile[k + 1]]) {
                    let wide = profile[k][0].max(profile[k + 1][0]);
                    let around = step as f32 / segments as f32 * std::f32::consts::TAU * wide;
                    part.vertices.push(Vertex {
                        position: foot + Vec3::new(radius * c, height, -radius * s),
                        normal: Vec3::new(end.x * c, end.y, -end.x * s),
                        uv: Vec2::new(around, -height) / tile,
                        tint: paint.tint,
                    });
                }
            }
            for step in 0..segments as u32 {
                let a = first + 2 * step;
                if profile[k][0] > 0.0 {
                    part.indices.extend([a, a + 2, a + 1]);
                }
                if profile[k + 1][0] > 0.0 {
                    part.indices.extend([a + 1, a + 2, a + 3]);
                }
            }
        }
    }

    /// A round tube along a path of points with radii, open at its ends.
    pub(crate) fn tube(&mut self, paint: Paint, path: &[(Vec3, f32)], segments: usize) {
        let tile = paint.material.tile_m();
        let part = self.part(paint.material);
        let first = part.vertices.len() as u32;
        let (mut side, mut length) = (Vec3::ZERO, 0.0);
        for (k, &(center, radius)) in path.iter().enumerate() {
            let before = path[k.saturating_sub(1)].0;
            let after = path[(k + 1).min(path.len() - 1)].0;
            let along = (after - before).normalize_or_zero();
            // The frame is carried along the path, so that the tube does not twist.
            let start = if side == Vec3::ZERO { along.any_orthonormal_vector() } else { side };
            side = (start - along * start.dot(along)).normalize_or_zero();
            let other = along.cross(side);
            length += (center - before).length();
            for step in 0..=segments {
                let angle = step as f32 / segments as f32 * std::f32::consts::TAU;
                let normal = side * ops::cos(angle) + other * ops::sin(angle);
                part.vertices.push(Vertex {
                    position: center + normal * radius,
                    normal,
                    uv: Vec2::new(angle * radius, length) / tile,
                    tint: paint.tint,
                });
            }
        }
        let row = segments as u32 + 1;
        for k in 0..path.len() as u32 - 1 {
            for step in 0..segments as u32 {
                let a = first + k * row + step;
                part.indices.extend([a, a + 1, a + row + 1, a, a + row + 1, a + row]);
            }
        }
    }

    /// A molding along x over a wall in the plane z = `z`, with closed ends: `profile` is projection and height, from below.
    pub(crate) fn molding(&mut self, paint: Paint, x: [f32; 2], z: f32, profile: &[[f32; 2]]) {
        let point = |x: f32, [out, y]: [f32; 2]| Vec3::new(x, y, z + out);
        for pair in profile.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            self.quad(paint, [point(x[0], a), point(x[1], a), point(x[1], b), point(x[0], b)]);
        }
        // The ends as strips between the wall and the profile.
        for pair in profile.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let (wall_a, wall_b) = ([0.0, a[1]], [0.0, b[1]]);
            self.quad(paint, [a, wall_a, wall_b, b].map(|p| point(x[1], p)));
            self.quad(paint, [wall_a, a, b, wall_b].map(|p| point(x[0], p)));
        }
    }

    /// A block before a wall whose front edges are cut off by `bevel`; its back is open.
    pub(crate) fn beveled(&mut self, paint: Paint, low: Vec3, high: Vec3, bevel: f32) {
        let back = |x: f32, y: f32| Vec3::new(x, y, low.z);
        let edge = |x: f32, y: f32| Vec3::new(x, y, (high.z - bevel).max(low.z));
        let front = |x: f32, y: f32| {
            let inset = |v: f32, from: f32, to: f32| v.clamp(from + bevel, (to - bevel).max(from + bevel));
            Vec3::new(inset(x, low.x, high.x), inset(y, low.y, high.y), high.z)
        };
        let ring = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
        self.quad(paint, ring.map(|(x, y)| front(x, y)));
        for k in 0..4 {
            let ((ax, ay), (bx, by)) = (ring[k], ring[(k + 1) % 4]);
            self.quad(paint, [edge(ax, ay), edge(bx, by), front(bx, by), front(ax, ay)]);
            if edge(ax, ay) != back(ax, ay) {
                self.quad(paint, [back(ax, ay), back(bx, by), edge(bx, by), edge(ax, ay)]);
            }
        }
    }

    /// A bar of square section from one point to another, without ends, as thick as `thick`.
    pub(crate) fn bar(&mut self, paint: Paint, from: Vec3, to: Vec3, thick: f32) {
        let along = (to - from).normalize_or_zero();
        let side = if along.y.abs() > 0.9 { Vec3::X } else { Vec3::Y.cross(along).normalize_or_zero() }
            * (thick / 2.0);
        let up = side.cross(along);
        let ring = |p: Vec3| [p + side + up, p - side + up, p - side - up, p + side - up];
        let (a, b) = (ring(from), ring(to));
        for k in 0..4 {
            let n = (k + 1) % 4;
            self.quad(paint, [a[k], b[k], b[n], a[n]]);
        }
    }

    /// Leaves out triangles without area and corners without triangles, and makes normals unit.
    pub(crate) fn clean(&mut self) {
        for part in self.parts.values_mut() {
            let corner = |k: u32| part.vertices[k as usize].position;
            let kept: Vec<[u32; 3]> = part
                .indices
                .chunks_exact(3)
                .map(|t| [t[0], t[1], t[2]])
                .filter(|&[a, b, c]| {
                    let [a, b, c] = [a, b, c].map(corner);
                    (b - a).cross(c - a).length_squared() > MIN_CROSS_SQUARED
                })
                .collect();
            let mut moved = vec![u32::MAX; part.vertices.len()];
            let mut vertices = Vec::new();
            part.indices.clear();
            for triangle in kept {
                let [a, b, c] = triangle.map(|k| part.vertices[k as usize].position);
                let face = (b - a).cross(c - a).normalize_or_zero();
                for k in triangle {
                    let slot = &mut moved[k as usize];
                    if *slot == u32::MAX {
                        *slot = vertices.len() as u32;
                        let mut vertex = part.vertices[k as usize];
                        vertex.normal = vertex.normal.try_normalize().unwrap_or(face);
                        vertex.tint = vertex.tint.clamp(Vec3::ZERO, Vec3::ONE);
                        vertices.push(vertex);
                    }
                    part.indices.push(*slot);
                }
            }
            part.vertices = vertices;
        }
        self.parts.retain(|_, part| !part.indices.is_empty());
    }

    /// Adds a copy of another mesh, turned about the vertical by an angle in degrees and moved.
    pub(crate) fn add(&mut self, other: &Self, position: [f32; 3], turn_deg: f32) {
        let (c, s) = turn(turn_deg);
        let turned = |v: Vec3| Vec3::new(c * v.x + s * v.z, v.y, -s * v.x + c * v.z);
        for (&material, part) in &other.parts {
            let own = self.part(material);
            let first = own.vertices.len() as u32;
            own.vertices.extend(part.vertices.iter().map(|vertex| Vertex {
                position: turned(vertex.position) + Vec3::from(position),
                normal: turned(vertex.normal),
                ..*vertex
            }));
            own.indices.extend(part.indices.iter().map(|k| first + k));
        }
    }
}

/// Cosine and sine of an angle in degrees, exact for quarter turns.
pub(crate) fn turn(degrees: f32) -> (f32, f32) {
    match degrees.rem_euclid(360.0) {
        0.0 => (1.0, 0.0),
        90.0 => (0.0, 1.0),
        180.0 => (-1.0, 0.0),
        270.0 => (0.0, -1.0),
        angle => (ops::cos(angle.to_radians()), ops::sin(angle.to_radians())),
    }
}

/// Texture coordinates of a point of a face, projected along the axis that is nearest to its normal.
fn laid_on(point: Vec3, normal: Vec3, tile_m: f32) -> Vec2 {
    let n = normal.abs();
    let meters = if n.y >= n.x && n.y >= n.z {
        Vec2::new(point.x, point.z)
    } else if n.x >= n.z {
        Vec2::new(-point.z * normal.x.signum(), -point.y)
    } else {
        Vec2::new(point.x * normal.z.signum(), -point.y)
    };
    meters / tile_m
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume within a closed surface (divergence theorem): positive if its faces look outwards.
    fn volume(mesh: &Mesh) -> f32 {
        let of = |part: &Part| -> f32 {
            let corner = |k: u32| part.vertices[k as usize].position;
            let six: f32 = part
                .indices
                .chunks_exact(3)
                .map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))))
                .sum();
            six / 6.0
        };
        mesh.parts.values().map(of).sum()
    }

    #[test]
    fn closed_shapes_look_outwards() {
        let mut mesh = Mesh::default();
        mesh.block(plain(Material::Stone), [1.0, 2.0, 3.0], [0.5, 2.0, 4.0]);
        assert!((volume(&mesh) - 4.0).abs() < 1e-4);
        let mut mesh = Mesh::default();
        let profile = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]];
        mesh.lathe(plain(Material::Stone), Vec3::new(3.0, 1.0, 0.0), &profile, 256);
        assert!((volume(&mesh) - std::f32::consts::TAU).abs() < 5e-3, "{}", volume(&mesh));
        // A tube looks outwards too: its normals and its faces agree.
        let mut mesh = Mesh::default();
        let path = [(Vec3::ZERO, 0.1), (Vec3::new(0.0, 1.0, 0.0), 0.1), (Vec3::new(0.4, 1.5, 0.0), 0.1)];
        mesh.tube(plain(Material::Stone), &path, 12);
        for part in mesh.parts.values() {
            for t in part.indices.chunks_exact(3) {
                let [a, b, c] = [t[0], t[1], t[2]].map(|k| part.vertices[k as usize]);
                let face = (b.position - a.position).cross(c.position - a.position).normalize();
                assert!(face.dot(a.normal) > 0.7, "{face} {}", a.normal);
            }
        }
    }

    #[test]
    fn a_turned_copy_keeps_its_volume() {
        let mut one = Mesh::default();
        one.block(plain(Material::Stone), [0.0; 3], [1.0, 2.0, 3.0]);
        let mut mesh = Mesh::default();
        mesh.add(&one, [5.0, 0.0, -3.0], 37.0);
        assert!((volume(&mesh) - 6.0).abs() < 1e-3);
        assert_eq!(mesh.triangle_count(), 12);
    }
}
