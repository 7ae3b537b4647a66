//! Bounds of how much the wind around a position differs from the wind there, for drops that are carried toward it. Twin of
//! `shaders/wgsl/wind/field_spread.wgsl`.

use glam::{UVec3, Vec3, Vec4};
use rayon::prelude::*;

use crate::field::{wind_field_corner, wind_field_index, wind_field_locate, wind_field_mix};
use crate::field_grid::WindFieldGrid;

/// Wind in a cell, m/s.
fn velocity(grid: &WindFieldGrid, cells: &[[f32; 4]], cell: UVec3) -> Vec3 {
    let index = wind_field_index(grid, cell) as usize;
    // The cell is within the grid.
    cells.get(index).map_or(Vec3::ZERO, |&[x, y, z, _]| Vec3::new(x, y, z))
}

/// Wind at a position, m/s, trilinear between the centers of the cells.
#[must_use]
pub fn wind_field_spread_wind(grid: &WindFieldGrid, cells: &[[f32; 4]], at: Vec3) -> Vec3 {
    let position = wind_field_locate(grid, at);
    let corners = std::array::from_fn(|k| velocity(grid, cells, wind_field_corner(&position, k as u32)));
    wind_field_mix(&corners, position.fraction)
}

/// Differences of the wind in a cell: from its next neighbors along x, y and z up to a last cell, 1/s, and from another wind, m/s.
#[must_use]
pub fn wind_field_spread_cell(
    grid: &WindFieldGrid,
    cells: &[[f32; 4]],
    cell: UVec3,
    last: UVec3,
    there: Vec3,
) -> Vec4 {
    let here = velocity(grid, cells, cell);
    let mut rise = Vec3::ZERO;
    for (axis, step) in [UVec3::X, UVec3::Y, UVec3::Z].into_iter().enumerate() {
        if cell[axis] < last[axis] {
            rise[axis] = (velocity(grid, cells, cell + step) - here).length() * grid.per_cell[axis];
        }
    }
    rise.extend((here - there).length())
}

/// Bounds on the difference between the wind within `reach` meters of a position and the wind at the position: per meter of
/// distance, 1/s, and in total, m/s. `main_wind_field_spread` in WGSL.
pub(crate) fn wind_field_spread(grid: &WindFieldGrid, cells: &[[f32; 4]], at: Vec3, reach: f32) -> [f32; 2] {
    let [low, high] = [-reach, reach].map(|way| wind_field_locate(grid, at + Vec3::splat(way)));
    let (first, last) = (low.cell, high.next);
    let there = wind_field_spread_wind(grid, cells, at);
    let of_layer = |z: u32| {
        let rows = (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| UVec3::new(x, y, z)));
        rows.map(|cell| wind_field_spread_cell(grid, cells, cell, last, there)).fold(Vec4::ZERO, Vec4::max)
    };
    wind_field_spread_bounds(
        (first.z..=last.z).into_par_iter().map(of_layer).reduce(|| Vec4::ZERO, Vec4::max),
    )
}

/// The bounds from the greatest differences of cells.
pub(crate) fn wind_field_spread_bounds(greatest: Vec4) -> [f32; 2] {
    [greatest.truncate().length(), greatest.w]
}

/// Position and reach of a question for the spread, in the layout of `WindFieldSpreadFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct WindFieldSpreadFrame {
    /// The grid, relative to the origin of the position.
    pub grid: WindFieldGrid,
    /// The position, m.
    pub at: [f32; 3],
    /// Distance from it, m.
    pub reach: f32,
}
