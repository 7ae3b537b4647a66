//! A model: meshes, transforms of their copies, and lamps.

use super::mesh::Mesh;

/// A mesh and its copies.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) name: String,
    pub(super) mesh: Mesh,
    pub(super) copies: Vec<Placement>,
}

/// Position and turn about the vertical of a copy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) position: [f32; 3],
    pub(super) turn_deg: f32,
}

/// A lamp that burns at night.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lamp {
    pub(super) name: &'static str,
    pub(super) position: [f32; 3],
    /// Direction of its light, not necessarily of unit length; `None` for all directions.
    pub(super) direction: Option<[f32; 3]>,
    /// Half angles of the full and the whole cone, degrees.
    pub(super) cone_deg: [f32; 2],
    /// Linear color, brightest component 1.
    pub(super) color: [f32; 3],
    /// Luminous intensity on the axis.
    pub(super) intensity_cd: f32,
    /// Distance at which its light has faded to zero.
    pub(super) range_m: f32,
}

/// A model to be written to files.
#[derive(Clone, Debug, Default)]
pub(super) struct Model {
    pub(super) name: &'static str,
    pub(super) pieces: Vec<Piece>,
    pub(super) lamps: Vec<Lamp>,
    /// Names of variants: color of the car paint.
    pub(super) paints: Vec<(&'static str, [f64; 3])>,
}

impl Model {
    /// A model of one mesh at the origin.
    pub(super) fn single(name: &'static str, mesh: Mesh) -> Self {
        let copies = vec![Placement { position: [0.0; 3], turn_deg: 0.0 }];
        Self { name, pieces: vec![Piece { name: name.to_owned(), mesh, copies }], ..Self::default() }
    }

    /// Triangles of all copies.
    pub(super) fn triangle_count(&self) -> usize {
        self.pieces.iter().map(|piece| piece.mesh.triangle_count() * piece.copies.len()).sum()
    }
}
