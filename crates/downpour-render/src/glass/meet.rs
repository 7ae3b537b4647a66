//! Intersection of a ray with a pane: the cap of a drop, the film where water has run, or dry glass. Twin of a part of
//! `shaders/wgsl/render/glass_picture.wgsl`.

use glam::{Vec2, Vec3};

use super::picture::PaneTracer;
use super::water::{glass_picture_water_cap, glass_picture_water_leave, glass_picture_water_normal};

/// Surface of the pane that a ray meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct PaneHit {
    pub(super) normal: Vec3,
    pub(super) wet: bool,
    /// Rate at which the normal turns, 1/m.
    pub(super) curvature: f32,
    /// A drop that shows lamps.
    pub(super) lit: bool,
}

/// Weight of the cell before, at or after a position, and how it changes; t is -0.5 to 0.5.
#[must_use]
pub fn glass_picture_spline(t: f32, which: i32) -> Vec2 {
    match which {
        0 => Vec2::new(0.5 * (0.5 - t) * (0.5 - t), t - 0.5),
        1 => Vec2::new(0.75 - t * t, -2.0 * t),
        _ => Vec2::new(0.5 * (0.5 + t) * (0.5 + t), t + 0.5),
    }
}

impl PaneTracer<'_> {
    /// Height of the film of a cell, 0 to 1.
    fn glass_picture_wetness(&self, column: i32, row: i32) -> f32 {
        let [width, height] = self.glass.frame.wet_size;
        let x = column.clamp(0, width as i32 - 1) as u32;
        let y = row.clamp(0, height as i32 - 1) as u32;
        let index = y * width + x;
        let height = (self.glass.wet[index as usize / 2] >> (16 * (index % 2))) & 65535;
        height as f32 / 65535.0
    }

    /// Height of the film and its slopes: the quadratic B-spline over the cells.
    fn glass_picture_film(&self, position: Vec2) -> Vec3 {
        let frame = &self.glass.frame;
        let at = position * frame.cells - 0.5;
        let middle = (at + 0.5).floor();
        let t = at - middle;
        let mut sum = Vec3::ZERO;
        for j in 0..3 {
            let wy = glass_picture_spline(t.y, j);
            for i in 0..3 {
                let wet = self.glass_picture_wetness(middle.x as i32 + i - 1, middle.y as i32 + j - 1);
                let wx = glass_picture_spline(t.x, i);
                sum += Vec3::new(wx.x * wy.x, wx.y * wy.x, wx.x * wy.y) * wet;
            }
        }
        let per_meter = frame.film * frame.cells;
        Vec3::new(sum.x * frame.film, sum.y * per_meter, sum.z * per_meter)
    }

    /// The surface that a ray leaves by, which enters the water at a position of the glass.
    pub(super) fn glass_picture_meet(&self, position: Vec2, aside: Vec2) -> PaneHit {
        let frame = &self.glass.frame;
        let column = ((position.x * frame.bins).max(0.0) as u32).min(frame.columns - 1);
        let row = ((position.y * frame.bins).max(0.0) as u32).min(frame.rows - 1);
        let bin = (row * frame.columns + column) as usize;
        let bins = &self.glass.bins;
        let mut highest = 0.0;
        let mut found = 0;
        for &index in &bins[bins[bin] as usize..bins[bin + 1] as usize] {
            let height = glass_picture_water_cap(&self.glass.drops[index as usize], position).x;
            if height > highest {
                highest = height;
                found = index;
            }
        }
        if highest > 0.0 {
            let drop = &self.glass.drops[found as usize];
            let z = glass_picture_water_leave(drop, position, aside);
            let cap = glass_picture_water_cap(drop, position + aside * z);
            let normal = glass_picture_water_normal(Vec2::new(cap.y, cap.z));
            let lit = drop.radius >= frame.lit_from;
            return PaneHit { normal, wet: true, curvature: 1.0 / drop.sphere, lit };
        }
        if frame.film <= 0.0 {
            return PaneHit { normal: Vec3::Z, wet: false, curvature: 0.0, lit: false };
        }
        let film = self.glass_picture_film(position);
        let normal = glass_picture_water_normal(Vec2::new(film.y, film.z));
        PaneHit { normal, wet: film.x > 0.0, curvature: 0.0, lit: false }
    }
}
