//! Grid of a field in the layout of the shader.

use glam::{UVec3, Vec3};

use crate::grid::WindGrid;

/// Grid in the layout of the shader, as `WindFieldGrid` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct WindFieldGrid {
    /// Edges of a cell, m.
    pub cell: [f32; 3],
    /// Number of turbulence modes.
    pub modes: u32,
    /// Lower corner of the box, m.
    pub low: [f32; 3],
    /// Number of matrices.
    pub primitives: u32,
    /// Inverse edges of a cell, 1/m.
    pub per_cell: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding_2: u32,
    /// Number of cells along each edge.
    pub size: [u32; 3],
    /// Padding of the WGSL layout.
    pub padding_3: u32,
}

impl WindFieldGrid {
    /// Creates a grid with `primitives` matrices and `modes` modes of turbulence.
    #[must_use]
    pub fn new(grid: &WindGrid, primitives: u32, modes: u32) -> Self {
        let cell = grid.cell();
        Self {
            low: grid.low().to_array(),
            primitives,
            cell: cell.to_array(),
            modes,
            per_cell: cell.recip().to_array(),
            padding_2: 0,
            size: grid.size(),
            padding_3: 0,
        }
    }
}

/// Center of a cell, m.
#[must_use]
pub fn wind_field_center(grid: &WindFieldGrid, cell: UVec3) -> Vec3 {
    Vec3::from(grid.low) + (cell.as_vec3() + 0.5) * Vec3::from(grid.cell)
}
