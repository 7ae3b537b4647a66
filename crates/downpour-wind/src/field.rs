//! Wind in the cells of a box (Rousseau 2008, 3.2 and 5.1.2). Twin of `shaders/wgsl/wind/field.wgsl`.

use glam::{DVec3, UVec3, Vec3};
use rayon::prelude::*;

use crate::design::WindPrimitive;
use crate::error::WindError;
pub use crate::field_grid::{WindFieldGrid, wind_field_center};
use crate::field_spread::{wind_field_spread, wind_field_spread_wind};
use crate::grid::WindGrid;
use crate::mask::WindMask;
use crate::matrix::WindMatrix;
use crate::primitive::velocity;
use crate::turbulence::{WindTurbulenceMode, wind_turbulence_velocity};

/// The eight cells whose centers surround a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindFieldPosition {
    /// Lower cell along each axis.
    pub cell: UVec3,
    /// Upper cell along each axis.
    pub next: UVec3,
    /// Fraction of the distance from the lower to the upper cell, 0 to 1.
    pub fraction: Vec3,
}

/// Index of a cell in memory.
#[must_use]
pub fn wind_field_index(grid: &WindFieldGrid, cell: UVec3) -> u32 {
    let [x, y, _] = grid.size;
    (cell.z * y + cell.y) * x + cell.x
}

/// Finds the cells around a position. A position outside the outermost centers is clamped to them, NaN to the
/// lowest.
#[must_use]
pub fn wind_field_locate(grid: &WindFieldGrid, at: Vec3) -> WindFieldPosition {
    let last = UVec3::from(grid.size) - 1;
    let x = (at - Vec3::from(grid.low)) * Vec3::from(grid.per_cell) - 0.5;
    let x = Vec3::from_array(std::array::from_fn(|k| x[k].max(0.0).min(last[k] as f32)));
    let lower = x.floor();
    let cell = lower.as_uvec3().min(last);
    WindFieldPosition { cell, next: (cell + 1).min(last), fraction: x - lower }
}

/// One of the eight cells: bits 0, 1 and 2 of `corner` select along x, y and z.
#[must_use]
pub fn wind_field_corner(position: &WindFieldPosition, corner: u32) -> UVec3 {
    let choose = |bit: u32, cell: u32, next: u32| if corner & bit != 0 { next } else { cell };
    UVec3::new(
        choose(1, position.cell.x, position.next.x),
        choose(2, position.cell.y, position.next.y),
        choose(4, position.cell.z, position.next.z),
    )
}

/// Trilinear interpolation of the values of the eight cells, in the order of their corners.
#[must_use]
pub fn wind_field_mix(corners: &[Vec3; 8], fraction: Vec3) -> Vec3 {
    let [c0, c1, c2, c3, c4, c5, c6, c7] = *corners;
    let c00 = c0 + (c1 - c0) * fraction.x;
    let c10 = c2 + (c3 - c2) * fraction.x;
    let c01 = c4 + (c5 - c4) * fraction.x;
    let c11 = c6 + (c7 - c6) * fraction.x;
    let c0 = c00 + (c10 - c00) * fraction.y;
    let c1 = c01 + (c11 - c01) * fraction.y;
    c0 + (c1 - c0) * fraction.z
}

/// Wind in a cell, m/s, and its openness.
#[must_use]
pub fn wind_field_cell(
    grid: &WindFieldGrid,
    matrices: &[WindMatrix],
    modes: &[WindTurbulenceMode],
    openness: f32,
    cell: UVec3,
) -> [f32; 4] {
    if openness <= 0.0 {
        return [0.0; 4];
    }
    let at = wind_field_center(grid, cell);
    let offset = at - Vec3::from(grid.low);
    let sum =
        modes.iter().fold(velocity(matrices, at), |sum, mode| sum + wind_turbulence_velocity(mode, offset));
    let [x, y, z] = (sum * openness).to_array();
    [x, y, z, openness]
}

/// Wind over a box, computed once at the centers of the cells and interpolated between them.
#[derive(Clone, Debug, PartialEq)]
pub struct WindField {
    grid: WindGrid,
    uniform: WindFieldGrid,
    matrices: Vec<WindMatrix>,
    modes: Vec<WindTurbulenceMode>,
    cells: Vec<[f32; 4]>,
}

impl WindField {
    /// Creates the sum of any number of primitives, 0 inside the objects of a mask. The bits do not depend on the
    /// number of threads.
    ///
    /// # Errors
    /// As [`WindMatrix::encode`]; [`WindError::MaskSize`] if the mask does not match the grid.
    pub fn new(grid: &WindGrid, primitives: &[WindPrimitive], mask: &WindMask) -> Result<Self, WindError> {
        Self::with_turbulence(grid, primitives, &[], mask)
    }

    /// The same with modes of turbulence, as [`Wind::modes`](crate::Wind::modes) computes them for this grid.
    ///
    /// # Errors
    /// As [`WindField::new`].
    pub fn with_turbulence(
        grid: &WindGrid,
        primitives: &[WindPrimitive],
        modes: &[WindTurbulenceMode],
        mask: &WindMask,
    ) -> Result<Self, WindError> {
        mask.check(grid)?;
        let matrices = WindMatrix::encode(primitives)?;
        let uniform = WindFieldGrid::new(grid, matrices.len() as u32, modes.len() as u32);
        let cells = mask
            .openness
            .par_iter()
            .enumerate()
            .map(|(i, &openness)| {
                wind_field_cell(&uniform, &matrices, modes, openness, UVec3::from(grid.coordinates(i)))
            })
            .collect();
        Ok(Self { grid: *grid, uniform, matrices, modes: modes.to_vec(), cells })
    }

    /// The same wind for positions relative to `origin`, m. Single precision is coarse far from the world's origin, and
    /// this keeps it fine near the eye. The grid and the primitives stay in world coordinates.
    #[must_use]
    pub fn relative_to(mut self, origin: DVec3) -> Self {
        self.uniform.low = (self.grid.low().as_dvec3() - origin).as_vec3().to_array();
        self
    }

    /// Wind at a position, m/s, trilinear between the centers of the cells. Beyond the outermost centers it is that of
    /// the nearest point between them.
    #[must_use]
    pub fn sample(&self, at: Vec3) -> Vec3 {
        wind_field_spread_wind(&self.uniform, &self.cells, at)
    }

    /// Bounds on the difference between the wind within `reach` meters of a position and the wind at the position: per
    /// meter of distance, 1/s, and in total, m/s.
    #[must_use]
    pub fn spread(&self, at: Vec3, reach: f32) -> [f32; 2] {
        wind_field_spread(&self.uniform, &self.cells, at, reach)
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &WindGrid {
        &self.grid
    }

    /// Grid in the layout of the shader.
    #[must_use]
    pub fn uniform(&self) -> &WindFieldGrid {
        &self.uniform
    }

    /// Matrices of the primitives.
    #[must_use]
    pub fn matrices(&self) -> &[WindMatrix] {
        &self.matrices
    }

    /// Modes of turbulence.
    #[must_use]
    pub fn modes(&self) -> &[WindTurbulenceMode] {
        &self.modes
    }

    /// Velocity, m/s, and openness of each cell, in the order of memory.
    #[must_use]
    pub fn cells(&self) -> &[[f32; 4]] {
        &self.cells
    }
}
