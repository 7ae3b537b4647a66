//! A model: meshes, transforms of their copies, and lamps.

use crate::mesh::Mesh;

/// A mesh and its copies.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Name in files.
    pub name: String,
    /// The mesh.
    pub mesh: Mesh,
    /// Positions of its copies.
    pub copies: Vec<Placement>,
    /// For wheels: their radius in meters. They roll about their x axis.
    pub rolls_on_m: Option<f32>,
}

/// Position and turn about the vertical of a copy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// Meters.
    pub position: [f32; 3],
    /// Degrees about +Y, counter-clockwise seen from above.
    pub turn_deg: f32,
}

impl Placement {
    /// A placement at x, y, z with a turn in degrees.
    #[must_use]
    pub fn new(x: f32, y: f32, z: f32, turn_deg: f32) -> Self {
        Self { position: [x, y, z], turn_deg }
    }
}

/// A lamp that burns at night.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Sort of lamp.
    pub name: &'static str,
    /// Meters.
    pub position: [f32; 3],
    /// Direction of its light, not necessarily of unit length; `None` for all directions.
    pub direction: Option<[f32; 3]>,
    /// Half angles of the full and the whole cone, degrees.
    pub cone_deg: [f32; 2],
    /// Linear color, brightest component 1.
    pub color: [f32; 3],
    /// Luminous intensity on the axis.
    pub intensity_cd: f32,
    /// Distance at which its light has faded to zero.
    pub range_m: f32,
}

impl Piece {
    /// A mesh with one copy at the origin.
    pub(crate) fn single(name: &str, mesh: Mesh) -> Self {
        Self { name: name.to_owned(), mesh, copies: vec![Placement::default()], rolls_on_m: None }
    }

    /// Triangles of all copies.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.mesh.triangle_count() * self.copies.len()
    }
}
