//! Mask of objects, inside which no wind blows (Rousseau 2008, 5.1.2).

use downpour_math::in_range;
use glam::{UVec3, Vec3};

use crate::error::WindError;
use crate::field_grid::{WindFieldGrid, wind_field_center};
use crate::grid::WindGrid;

/// Openness of each cell of a grid to the wind: 0 inside objects, 1 away from them.
///
/// A cell counts as inside if its center is, so objects thinner than a cell may be missed. Between the centers of a
/// closed cell and an open one the wind rises linearly, as in the paper; [`WindMask::with_cut_off`] makes the ramp
/// wider.
#[derive(Clone, Debug, PartialEq)]
pub struct WindMask {
    pub(crate) openness: Vec<f32>,
}

impl WindMask {
    /// Creates a mask without objects.
    #[must_use]
    pub fn open(grid: &WindGrid) -> Self {
        Self { openness: vec![1.0; grid.cells()] }
    }

    /// Creates a mask by testing the center of each cell, m, with `inside`; in the order of memory.
    #[must_use]
    pub fn from_fn(grid: &WindGrid, mut inside: impl FnMut(Vec3) -> bool) -> Self {
        let uniform = WindFieldGrid::new(grid, 0, 0);
        let openness = (0..grid.cells())
            .map(|i| {
                let at = wind_field_center(&uniform, UVec3::from(grid.coordinates(i)));
                if inside(at) { 0.0 } else { 1.0 }
            })
            .collect();
        Self { openness }
    }

    /// Creates a mask from flags, true for a cell inside an object, in the order of memory.
    ///
    /// # Errors
    /// [`WindError::MaskSize`] if the number of flags is not that of the cells.
    pub fn from_occupancy(grid: &WindGrid, inside: &[bool]) -> Result<Self, WindError> {
        if inside.len() != grid.cells() {
            return Err(WindError::MaskSize { found: inside.len(), allowed: grid.cells() });
        }
        Ok(Self { openness: inside.iter().map(|&inside| if inside { 0.0 } else { 1.0 }).collect() })
    }

    /// The same objects with a wider cut-off: the openness of a cell rises linearly with its distance from the nearest
    /// closed cell (center to center), to 1 at `width`, m. A width of a cell or less leaves the mask unchanged.
    ///
    /// # Errors
    /// [`WindError::OutOfRange`] if the width is not 0 to 16 of the shortest edges of a cell; [`WindError::MaskSize`] if the
    /// mask does not match the grid.
    pub fn with_cut_off(&self, grid: &WindGrid, width: f32) -> Result<Self, WindError> {
        self.check(grid)?;
        let cell = grid.cell();
        let widest = 16.0 * cell.min_element();
        in_range("width of the wind's cut-off", width, "m", &(0.0..=widest), 1.0, "0 to 16 cells")?;
        let mut squared: Vec<f32> =
            self.openness.iter().map(|&open| if open > 0.0 { f32::INFINITY } else { 0.0 }).collect();
        let mut stride = 1;
        for (n, edge) in grid.size().map(|n| n as usize).into_iter().zip(cell.to_array()) {
            squared = nearest_along(&squared, n, stride, edge, width);
            stride *= n;
        }
        let openness = squared
            .into_iter()
            .map(|s| {
                let distance = s.sqrt();
                if distance < width { distance / width } else { 1.0 }
            })
            .zip(&self.openness)
            .map(|(ramp, &open)| ramp.min(open))
            .collect();
        Ok(Self { openness })
    }

    /// Openness of each cell, in the order of memory.
    #[must_use]
    pub fn openness(&self) -> &[f32] {
        &self.openness
    }

    pub(crate) fn check(&self, grid: &WindGrid) -> Result<(), WindError> {
        if self.openness.len() == grid.cells() {
            Ok(())
        } else {
            Err(WindError::MaskSize { found: self.openness.len(), allowed: grid.cells() })
        }
    }
}

/// One axis of the squared Euclidean distance: the minimum over neighbors of their value plus squared distance, within
/// `width`. After all axes it is exact for distances up to `width`.
fn nearest_along(values: &[f32], n: usize, stride: usize, edge: f32, width: f32) -> Vec<f32> {
    let reach = (width / edge).ceil() as usize;
    let line = n * stride;
    let mut out = Vec::with_capacity(values.len());
    for block in values.chunks(line) {
        for i in 0..block.len() {
            let at = i / stride;
            let (first, last) = (at.saturating_sub(reach), (at + reach).min(n - 1));
            let column = block.iter().skip(i % stride + first * stride).step_by(stride);
            let nearest = (first..=last)
                .zip(column)
                .map(|(k, &value)| {
                    let away = k.abs_diff(at) as f32 * edge;
                    value + away * away
                })
                .fold(f32::INFINITY, f32::min);
            out.push(nearest);
        }
    }
    out
}
