//! Waves of what moves through puddles. Twin of `shaders/wgsl/render/puddle_wake.wgsl`.
//!
//! Rain is everywhere alike, so that one lattice of ripples serves all water. What a wheel leaves behind is in one place: each puddle that
//! something moves through has a lattice of its own ([`Wakes`](crate::puddle::Wakes)), with the puddle's shores. Waves of low amplitude
//! add up: slopes and variances of both are added.

use downpour_shaders::render::puddle_wake::{PUDDLE_WAKE_COARSE, PUDDLE_WAKE_FINE, PUDDLE_WAKE_ROW};
use downpour_shaders::render::puddle_water::PUDDLE_WATER_ROWS;
use glam::{Vec3, Vec4};

use super::puddle_rings::smoothstep;
use crate::data::SceneData;

/// The lattice of a puddle's wakes as the shaders read it. Twin of the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PuddleWake {
    /// Columns, rows and first texel; 0 columns: nothing has moved through the water.
    pub(crate) lattice: [u32; 3],
    /// Edge of a cell, m.
    pub(crate) cell: f32,
}

impl SceneData {
    /// Reads the lattice of a puddle's wakes.
    pub(crate) fn puddle_wake_load(&self, puddle: u32) -> PuddleWake {
        let row = (self.puddles + puddle * PUDDLE_WATER_ROWS + PUDDLE_WAKE_ROW) as usize;
        let [columns, lines, first, cell] = self.table[row];
        PuddleWake { lattice: [columns, lines, first], cell: f32::from_bits(cell) }
    }

    /// A texel of the lattice: slopes along x and z, and the mean of the square of the slope around it.
    fn puddle_wake_texel(&self, [columns, lines, first]: [u32; 3], x: i32, y: i32) -> Vec4 {
        let column = x.clamp(0, columns as i32 - 1) as u32;
        let line = y.clamp(0, lines as i32 - 1) as u32;
        self.puddle_texel(first + line * columns + column)
    }

    /// Slopes along x and z of the waves in a puddle, and the variance of the slope within a footprint (m).
    pub(crate) fn puddle_wake_slope(&self, number: u32, position: Vec3, footprint: f32, depth: f32) -> Vec3 {
        let wake = self.puddle_wake_load(number);
        if wake.lattice[0] == 0 {
            return Vec3::ZERO;
        }
        let puddle = self.puddle_load(number);
        let axes = puddle.axes;
        let (dx, dz) = (position.x - puddle.middle.x, position.z - puddle.middle.z);
        let u = (dx * axes.x + dz * axes.y + axes.z) / wake.cell - 0.5;
        let v = (dz * axes.x - dx * axes.y + axes.w) / wake.cell - 0.5;
        let (x, y) = (u.floor() as i32, v.floor() as i32);
        let (fx, fy) = (u - u.floor(), v - v.floor());
        let texel = |x, y| self.puddle_wake_texel(wake.lattice, x, y);
        let upper = texel(x, y) * (1.0 - fx) + texel(x + 1, y) * fx;
        let lower = texel(x, y + 1) * (1.0 - fx) + texel(x + 1, y + 1) * fx;
        let mixed = upper * (1.0 - fy) + lower * fy;
        let shown = puddle_wake_shown(footprint / wake.cell);
        let strength = puddle.ripples.w * smoothstep(0.0, puddle.own.x.max(1.0e-6), depth);
        let slope = mixed.truncate().truncate() * (strength * shown);
        slope.extend(mixed.z * strength * strength * (1.0 - shown * shown))
    }
}

/// How much of the waves is shown as slopes with a footprint, in cells: none where they are smaller than the footprint.
#[must_use]
pub fn puddle_wake_shown(footprint: f32) -> f32 {
    1.0 - smoothstep(PUDDLE_WAKE_FINE, PUDDLE_WAKE_COARSE, footprint)
}
