//! Running water as rays meet it. Twin of `shaders/wgsl/render/puddle_flow.wgsl`.
//!
//! Ripples go with the water that they are on. A pattern that moved with different speeds for long would be torn, so two patterns are
//! shown, each for a time around which it is whole: while one fades the other comes (N. Max & B. Becker, Flow visualization using
//! moving textures, NASA Conference Publication 3321, 1995). Their weights are divided by the root of the sum of their squares, so that
//! the variance of the slopes stays.

use downpour_math::packing::packing_unpack_half;
use downpour_shaders::render::puddle_flow::{PUDDLE_FLOW_PERIOD, PUDDLE_FLOW_ROW, PUDDLE_FLOW_SLOW};
use downpour_shaders::render::puddle_water::PUDDLE_WATER_ROWS;
use glam::{Vec2, Vec3, Vec4};

use super::puddle_rings::smoothstep;
use crate::data::SceneData;
use crate::puddle::RenderPuddle;

/// How the water of a puddle runs, as the shaders read it. Twin of the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PuddleFlow {
    /// First row of the texels; 0: all water stands.
    pub(crate) first: u32,
    /// Part of the present cycle that is over.
    pub(crate) phase: f32,
    /// Number of the cycle.
    pub(crate) cycle: u32,
}

impl SceneData {
    /// Reads how the water of a puddle runs.
    pub(crate) fn puddle_flow_load(&self, puddle: u32) -> PuddleFlow {
        let row = (self.puddles + puddle * PUDDLE_WATER_ROWS + PUDDLE_FLOW_ROW) as usize;
        let [first, phase, cycle, _] = self.table[row];
        PuddleFlow { first, phase: f32::from_bits(phase), cycle }
    }

    /// Velocity along x and z, m/s, and slopes of the surface along them, of a cell of a map.
    fn puddle_flow_texel(&self, first: u32, [columns, lines, _]: [u32; 3], x: i32, y: i32) -> Vec4 {
        let column = x.clamp(0, columns as i32 - 1) as u32;
        let line = y.clamp(0, lines as i32 - 1) as u32;
        let index = line * columns + column;
        let row = self.row(first + index / 2);
        let [velocity, slope] = if index & 1 == 1 { [row[2], row[3]] } else { [row[0], row[1]] };
        let ([a, b], [c, d]) = (packing_unpack_half(velocity), packing_unpack_half(slope));
        Vec4::new(a, b, c, d)
    }

    /// The same over a position of a puddle, bilinear.
    pub(crate) fn puddle_flow_at(&self, first: u32, puddle: &RenderPuddle, position: Vec3) -> Vec4 {
        let (axes, map) = (puddle.axes, puddle.map);
        let (dx, dz) = (position.x - puddle.middle.x, position.z - puddle.middle.z);
        let u = ((dx * axes.x + dz * axes.y) / axes.z * 0.5 + 0.5) * map[0] as f32 - 0.5;
        let v = ((dz * axes.x - dx * axes.y) / axes.w * 0.5 + 0.5) * map[1] as f32 - 0.5;
        let (x, y) = (u.floor() as i32, v.floor() as i32);
        let (fx, fy) = (u - u.floor(), v - v.floor());
        let texel = |x, y| self.puddle_flow_texel(first, map, x, y);
        let upper = texel(x, y) * (1.0 - fx) + texel(x + 1, y) * fx;
        let lower = texel(x, y + 1) * (1.0 - fx) + texel(x + 1, y + 1) * fx;
        upper * (1.0 - fy) + lower * fy
    }
}

/// The row that says how water runs, but for the first texel, at a time in s: phase and number of the cycle.
pub(crate) fn cycle_row(time_s: f64) -> [u32; 4] {
    let cycles = time_s / f64::from(PUDDLE_FLOW_PERIOD);
    let phase = (cycles - cycles.floor()) as f32;
    [0, phase.to_bits(), cycles.floor() as i64 as u32, 0]
}

/// How much ripples move with water of a speed, m/s: 0 those of standing water.
#[must_use]
pub fn puddle_flow_moves(speed: f32) -> f32 {
    smoothstep(0.0, PUDDLE_FLOW_SLOW, speed)
}

/// Of the first or the second pattern: time since it was whole, s, and how much of it is shown.
#[must_use]
pub fn puddle_flow_phase(phase: f32, second: u32) -> Vec2 {
    let own = phase + 0.5 * second as f32;
    let part = own - own.floor();
    Vec2::new((part - 0.5) * PUDDLE_FLOW_PERIOD, 1.0 - (2.0 * part - 1.0).abs())
}

/// Place of the first or the second pattern in the ripples, another in each cycle.
#[must_use]
pub fn puddle_flow_place(phase: f32, cycle: u32, second: u32) -> Vec2 {
    // The second begins in the middle of the first.
    let own = cycle.wrapping_add(u32::from(second == 1 && phase >= 0.5));
    let number = own.wrapping_mul(2).wrapping_add(second);
    Vec2::new((number % 61) as f32 * 1.37, (number % 67) as f32 * 2.11)
}
