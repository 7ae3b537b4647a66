//! Leaves: twigs with leaves, as textured cards that grow from a point of a branch.

use glam::{Vec2, Vec3};

use crate::material::Material;
use crate::mesh::{Mesh, Vertex};
use crate::noise::hash;
use crate::textures::TWIGS;

/// A twig with leaves.
pub(crate) struct Twig {
    /// Where it grows from.
    pub(crate) at: Vec3,
    /// Its direction.
    pub(crate) along: Vec3,
    /// Its length, and its width with leaves, meters.
    pub(crate) size: f32,
    /// Direction out of the crown, toward which its normals are bent, so that the crown is shaded as a body.
    pub(crate) out: Vec3,
    /// Factor of the leaves' color.
    pub(crate) tint: Vec3,
    /// Number that draws the rest: tilt, roll, and the picture.
    pub(crate) id: i32,
}

impl Twig {
    /// Adds the twig: two halves, folded up along the twig. They face the sky and out of the crown.
    pub(crate) fn grow(&self, mesh: &mut Mesh) {
        let r = |n: i32| hash(self.id, n, 411);
        let random = Vec3::new(r(0) - 0.5, r(1) - 0.5, r(2) - 0.5) * 1.9;
        let along = self.along.normalize_or(Vec3::Y);
        let drawn = Vec3::Y * 0.55 + self.out * 0.45 + random;
        let facing = (drawn - along * along.dot(drawn)).normalize_or(along.any_orthonormal_vector());
        let facing = if facing.dot(self.out + Vec3::Y * 0.5) < 0.0 { -facing } else { facing };
        let right = along.cross(facing);
        let normal = (self.out * 0.5 + facing * 0.75 + Vec3::Y * 0.15).normalize_or(Vec3::Y);
        let cell = ((r(4) * (TWIGS * TWIGS) as f32) as u32).min(TWIGS * TWIGS - 1);
        let (column, row) = ((cell % TWIGS) as f32, (cell / TWIGS) as f32);
        let is_mirrored = r(5) < 0.5;
        let part = mesh.part(Material::Leaf);
        let first = part.vertices.len() as u32;
        for y in [0.0f32, 1.0] {
            for x in [-0.5f32, 0.0, 0.5] {
                let fold = facing * (0.34 * x.abs() - 0.10 * y);
                let u = if is_mirrored { 0.5 - x } else { 0.5 + x };
                part.vertices.push(Vertex {
                    position: self.at + (right * x + along * y + fold) * self.size,
                    normal: (normal - right * (0.5 * x)).normalize_or(normal),
                    uv: Vec2::new(column + u, row + 1.0 - y) / TWIGS as f32,
                    tint: self.tint,
                });
            }
        }
        part.indices.extend([0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4].map(|k| first + k));
    }
}
