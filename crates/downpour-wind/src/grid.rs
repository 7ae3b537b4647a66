//! A box of cells.

use downpour_math::in_range;
use glam::Vec3;

use crate::error::WindError;

/// Maximum number of cells of a grid: at 16 bytes each, the 128 MiB that WebGPU binds as one buffer.
pub const WIND_GRID_CELLS: u64 = 1 << 23;

/// A box of cells, `x` the fastest in memory. The paper uses 64 x 64 x 64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindGrid {
    low: Vec3,
    high: Vec3,
    size: [u32; 3],
}

impl WindGrid {
    /// Creates a box from `low` to `high`, meters, with `size` cells along each axis.
    ///
    /// # Errors
    /// [`WindError::OutOfRange`] if a corner is beyond 1e6 m, an edge is not 0.01 to 1e6 m, or the cells along it are not 1
    /// to 4096; [`WindError::TooManyCells`] beyond [`WIND_GRID_CELLS`].
    pub fn new(low: Vec3, high: Vec3, size: [u32; 3]) -> Result<Self, WindError> {
        for (from, to) in low.to_array().into_iter().zip(high.to_array()) {
            in_range("lower corner of the wind's box", from, "m", &(-1.0e6..=1.0e6), 1.0, "-1e6 to 1e6")?;
            in_range("edge of the wind's box", to - from, "m", &(0.01..=1.0e6), 1.0, "0.01 to 1e6")?;
        }
        for n in size {
            in_range("number of cells along an edge", n, "(a count)", &(1..=4096), 1.0, "1 to 4096")?;
        }
        let found = size.into_iter().map(u64::from).product();
        if found > WIND_GRID_CELLS {
            return Err(WindError::TooManyCells { found, allowed: WIND_GRID_CELLS });
        }
        Ok(Self { low, high, size })
    }

    /// Lower corner, m.
    #[must_use]
    pub fn low(&self) -> Vec3 {
        self.low
    }

    /// Upper corner, m.
    #[must_use]
    pub fn high(&self) -> Vec3 {
        self.high
    }

    /// Cells along each axis.
    #[must_use]
    pub fn size(&self) -> [u32; 3] {
        self.size
    }

    /// Edges of a cell, m.
    #[must_use]
    pub fn cell(&self) -> Vec3 {
        (self.high - self.low) / Vec3::from(self.size.map(|n| n as f32))
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.size.iter().map(|&n| n as usize).product()
    }

    /// Smallest core radius that the grid resolves, m: two of its longest cells.
    #[must_use]
    pub fn min_core_radius(&self) -> f32 {
        2.0 * self.cell().max_element()
    }

    /// Coordinates of the cell at `index` in memory.
    #[must_use]
    pub fn coordinates(&self, index: usize) -> [u32; 3] {
        let [x, y, _] = self.size.map(|n| n as usize);
        [(index % x) as u32, (index / x % y) as u32, (index / (x * y)) as u32]
    }
}
