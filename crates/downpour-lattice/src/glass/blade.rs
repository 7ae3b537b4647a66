//! Blade of a wiper, or a part of its length, during one tick. Twin of `shaders/wgsl/lattice/glass_blade.wgsl`.

use downpour_shaders::lattice::glass::{GLASS_BLADE_AHEAD, GLASS_CELL};
use glam::IVec2;

/// A part of a blade during one tick, in the layout of `GlassBlade` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassBlade {
    /// Direction of the blade before the tick: a unit vector of length 16384.
    pub before: [i32; 2],
    /// Direction of the blade after the tick.
    pub after: [i32; 2],
    /// Pivot, in half cells from the corner of the pane.
    pub pivot: [i32; 2],
    /// Start and end along the blade, in half cells.
    pub reach: [i32; 2],
    /// Sense of rotation: 1 from +x toward +y, -1 the other way, 0 at rest.
    pub turn: i32,
    /// Fraction of the water that stays behind, in units of 1/256.
    pub leaves: u32,
    /// Mass that stays behind as a film, in units of mass / 65536 for each cell.
    pub film: u32,
    /// Padding, 0.
    pub unused: u32,
}

/// Cross product of two vectors: positive if `b` is on the +y side of `a` along +x. |a| is 16384, |b| below 2^15.
#[inline]
#[must_use]
pub fn glass_blade_side(a: IVec2, b: IVec2) -> i32 {
    a.x * b.y - a.y * b.x
}

/// True if the blade passes over a cell in this tick.
#[inline]
#[must_use]
pub fn glass_blade_sweeps(blade: &GlassBlade, cell: IVec2) -> bool {
    let (before, after) = (IVec2::from(blade.before), IVec2::from(blade.after));
    let at = cell * 2 + 1 - IVec2::from(blade.pivot);
    let along = (after.x * at.x + after.y * at.y) >> 14;
    // Once per pass: `after` of one tick is `before` of the next.
    let side_before = blade.turn * glass_blade_side(before, at);
    let side_after = blade.turn * glass_blade_side(after, at);
    blade.turn != 0 && side_before >= 0 && side_after < 0 && along >= blade.reach[0] && along < blade.reach[1]
}

/// Direction in which the blade moves: a vector of length 16384, at right angles to it.
#[inline]
#[must_use]
pub fn glass_blade_ahead(blade: &GlassBlade) -> IVec2 {
    blade.turn * IVec2::new(-blade.after[1], blade.after[0])
}

/// Whole cells that the blade moves in the tick at a cell's distance from the pivot, at least 1.
#[inline]
#[must_use]
pub fn glass_blade_moved(blade: &GlassBlade, cell: IVec2) -> i32 {
    let at = cell * 2 + 1 - IVec2::from(blade.pivot);
    let along = (blade.after[0] * at.x + blade.after[1] * at.y) >> 14;
    let turned = (blade.turn * glass_blade_side(blade.before.into(), blade.after.into())) >> 14;
    ((along * turned + GLASS_CELL) >> 15).clamp(1, 8)
}

/// Cell ahead of the blade to which it pushes the water of a cell, and that many half cells outward along the blade; not
/// beyond its ends.
#[inline]
#[must_use]
pub fn glass_blade_push(blade: &GlassBlade, cell: IVec2, outward: i32) -> IVec2 {
    let (after, pivot) = (IVec2::from(blade.after), IVec2::from(blade.pivot));
    let at = cell * 2 + 1 - pivot;
    let here = (after.x * at.x + after.y * at.y) >> 14;
    let along = (here + outward).max(blade.reach[0]).min(blade.reach[1] - 1);
    let ahead = glass_blade_ahead(blade);
    let to = (after * along + ahead * GLASS_BLADE_AHEAD + GLASS_CELL / 2) >> 14;
    (pivot + to) >> 1
}
