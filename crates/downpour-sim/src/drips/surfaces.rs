//! Surfaces under the sky, as heights above the cells of a lattice that is fixed to the world.

use downpour_math::OutOfRange;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::SimError;
use crate::collision::collision_map_walk;
use crate::shelter::Obstacles;

/// Edge of a cell, m.
pub const CELL_M: f64 = 0.05;

/// Maximum number of cells of a region: a square of 80 m.
pub const MAX_CELLS: u64 = 1600 * 1600;

/// Edge in cells of the region of a scene that is larger, and of the blocks by which it follows the eye.
const NEAR_CELLS: i64 = 1600;
const BLOCK_CELLS: i64 = 320;

/// Maximum number of surfaces of a cell; those below are left out, but for the lowest.
const MAX_SHEETS: usize = 6;

/// Surfaces that are no farther from each other, m, are one.
const MERGED_M: f32 = 0.02;

/// Maximum slope of a surface; steeper ones count as this.
const MAX_SLOPE: f32 = 10.0;

/// Part of the ground in which drip points are searched, in cells of [`CELL_M`] from the world's origin on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DripRegion {
    /// First cell along X and Z.
    pub first: [i64; 2],
    /// Number of cells along X and Z.
    pub cells: [u32; 2],
}

impl DripRegion {
    /// The region between two corners, m.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for corners that are not finite or more than 1e7 m from the origin, or a region of more than [`MAX_CELLS`].
    pub fn new(low: DVec3, high: DVec3) -> Result<Self, SimError> {
        let region = Self::covering(low, high).ok_or_else(|| {
            let found = low.abs().max(high.abs()).max_element();
            out_of_range("a corner of the region of drips", found, "m", "-1e7 to 1e7, low below high")
        })?;
        if region.count() > MAX_CELLS {
            let area = region.count() as f64 * CELL_M * CELL_M;
            return Err(out_of_range("area of the region of drips", area, "m^2", "up to 6400"));
        }
        Ok(region)
    }

    /// The region of a scene between two corners, m: all of it if it has no more than [`MAX_CELLS`]. Else a square of 80 m around the eye,
    /// which follows it in steps of 16 m; `None` where nothing is.
    #[must_use]
    pub fn around(low: DVec3, high: DVec3, eye: DVec3) -> Option<Self> {
        let whole = Self::covering(low, high)?;
        if whole.count() <= MAX_CELLS {
            return Some(whole);
        }
        if !(eye.is_finite() && eye.abs().max_element() <= 1.0e7) {
            return None;
        }
        let middle = [eye.x, eye.z].map(|x| ((x / CELL_M).floor() as i64).div_euclid(BLOCK_CELLS));
        let near = middle.map(|block| block * BLOCK_CELLS + BLOCK_CELLS / 2 - NEAR_CELLS / 2);
        let [x, z] = [0, 1].map(|k| {
            let begin = near[k].max(whole.first[k]);
            let end = (near[k] + NEAR_CELLS).min(whole.first[k] + i64::from(whole.cells[k]));
            (begin, u32::try_from(end - begin).unwrap_or(0))
        });
        (x.1 > 0 && z.1 > 0).then_some(Self { first: [x.0, z.0], cells: [x.1, z.1] })
    }

    fn covering(low: DVec3, high: DVec3) -> Option<Self> {
        let found = low.abs().max(high.abs()).max_element();
        if !(low.is_finite() && high.is_finite() && found <= 1.0e7 && low.cmple(high).all()) {
            return None;
        }
        let first = [low.x, low.z].map(|x| (x / CELL_M).floor() as i64);
        let last = [high.x, high.z].map(|x| (x / CELL_M).floor() as i64);
        let cells = [0, 1].map(|k| (last[k] - first[k] + 1) as u32);
        Some(Self { first, cells })
    }

    fn count(&self) -> u64 {
        u64::from(self.cells[0]) * u64::from(self.cells[1])
    }
}

pub(super) fn out_of_range(
    quantity: &'static str,
    found: f64,
    unit: &'static str,
    allowed: &'static str,
) -> SimError {
    SimError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() })
}

/// A surface in a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    /// Height at the middle of the cell, m, relative to the obstacles' origin.
    pub(super) height: f32,
    /// Slope along X and Z.
    pub(super) slope: [f32; 2],
    /// Cell that it is in.
    pub(super) cell: u32,
}

impl Sheet {
    /// Height of its plane beside the middle of the cell, m.
    pub(super) fn height_at(&self, x: f32, z: f32) -> f32 {
        self.height + self.slope[0] * x + self.slope[1] * z
    }
}

/// Surfaces of all cells of a region.
#[derive(Debug)]
pub(super) struct Surfaces {
    pub(super) region: DripRegion,
    /// Position of the region's corner relative to the obstacles' origin, m.
    corner: [f64; 2],
    /// Surfaces, those of a cell together, the highest first.
    pub(super) sheets: Vec<Sheet>,
    /// Index of the first surface of each cell, and the number of all.
    firsts: Vec<u32>,
}

impl Surfaces {
    /// Casts a ray from above through the middle of each cell.
    pub(super) fn new(obstacles: &Obstacles<'_>, region: DripRegion) -> Self {
        let [columns, rows] = region.cells.map(|n| n as usize);
        let origin = [obstacles.origin.x, obstacles.origin.z];
        let corner = [0, 1].map(|k| region.first[k] as f64 * CELL_M - origin[k]);
        let mut surfaces = Self { region, corner, sheets: Vec::new(), firsts: Vec::new() };
        let Some([_, high]) = obstacles.corners() else {
            surfaces.firsts = vec![0; columns * rows + 1];
            return surfaces;
        };
        let top = high.y + 1.0;
        let row = |row: usize| {
            let cells = row * columns..(row + 1) * columns;
            let mut sheets = Vec::new();
            let ends: Vec<u32> = cells
                .map(|cell| {
                    let [x, z] = surfaces.middle(cell as u32);
                    add_sheets(obstacles, Vec3::new(x, top, z), cell as u32, &mut sheets);
                    sheets.len() as u32
                })
                .collect();
            (ends, sheets)
        };
        let parts: Vec<(Vec<u32>, Vec<Sheet>)> = (0..rows).into_par_iter().map(row).collect();
        let mut firsts = Vec::with_capacity(columns * rows + 1);
        firsts.push(0);
        let mut sheets: Vec<Sheet> = Vec::with_capacity(parts.iter().map(|part| part.1.len()).sum());
        for (ends, of_row) in parts {
            let before = sheets.len() as u32;
            firsts.extend(ends.into_iter().map(|end| before + end));
            sheets.extend(of_row);
        }
        Self { sheets, firsts, ..surfaces }
    }

    /// Middle of a cell along X and Z, m, relative to the obstacles' origin.
    pub(super) fn middle(&self, cell: u32) -> [f32; 2] {
        let columns = self.region.cells[0];
        let at = |k: u32, corner: f64| (corner + (f64::from(k) + 0.5) * CELL_M) as f32;
        [at(cell % columns, self.corner[0]), at(cell / columns, self.corner[1])]
    }

    /// The cell that is a number of cells beside another; `None` outside.
    pub(super) fn beside(&self, cell: u32, [x, z]: [i32; 2]) -> Option<u32> {
        let [columns, rows] = self.region.cells;
        let column = (cell % columns).checked_add_signed(x).filter(|&column| column < columns)?;
        let row = (cell / columns).checked_add_signed(z).filter(|&row| row < rows)?;
        Some(row * columns + column)
    }

    /// Surfaces of a cell by their indices, the highest first.
    pub(super) fn of(&self, cell: u32) -> std::ops::Range<u32> {
        let at = |cell: usize| self.firsts.get(cell).copied().unwrap_or(0);
        at(cell as usize)..at(cell as usize + 1)
    }

    /// A surface by its index.
    pub(super) fn sheet(&self, index: u32) -> &Sheet {
        &self.sheets[index as usize]
    }
}

/// Adds the surfaces on a ray downwards that water can lie on.
fn add_sheets(obstacles: &Obstacles<'_>, from: Vec3, cell: u32, sheets: &mut Vec<Sheet>) {
    let Obstacles { nodes, triangles, holes, .. } = *obstacles;
    let hits = collision_map_walk(nodes, triangles, holes, from, Vec3::NEG_Y, 16);
    let begin = sheets.len();
    let mut last = f32::NEG_INFINITY;
    for k in 0..hits.count {
        let triangle = &triangles[hits.slots[k] as usize];
        let normal = Vec3::from(triangle.edge_1).cross(triangle.edge_2.into());
        let is_top = normal.y > 0.0;
        // Undersides carry nothing, but for that of the first surface, whose winding is taken to be wrong.
        let apart = hits.depths[k] > last + MERGED_M;
        if k > 0 && !(is_top && apart) {
            continue;
        }
        last = hits.depths[k];
        let slope = [normal.x, normal.z].map(|n| (-n / normal.y).clamp(-MAX_SLOPE, MAX_SLOPE));
        let slope = if slope.iter().all(|s| s.is_finite()) { slope } else { [0.0; 2] };
        let sheet = Sheet { height: from.y - last, slope, cell };
        if sheets.len() - begin == MAX_SHEETS {
            sheets.pop();
        }
        sheets.push(sheet);
    }
}
