//! Makes the streak radiance table of a frame. Twin of `shaders/wgsl/render/streak_table.wgsl`.

use downpour_math::ops;
use downpour_shaders::render::rain::{
    DROPS_ELEVATIONS, STREAK_ACROSS, STREAK_BRIGHTEST, STREAK_CHORDS, STREAK_FINE, STREAK_MEAN,
    STREAK_MEAN_GRID, STREAK_PER_QUARTER, STREAK_RAYS, STREAK_SUMS, STREAK_TAPS,
};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::drops_frame::DropsView;
use super::drops_mask::{drops_mask_right, drops_mask_unit};
use super::drops_shade::DropsShade;
use super::streak_lookup::{StreakTable, pack};

const SUMS: usize = STREAK_SUMS as usize;

/// Drops of about one size. The same layout as `StreakShape` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct StreakShape {
    /// Mean velocity relative to the picture, m/s.
    pub velocity: [f32; 3],
    /// Row of their diameter in the masks.
    pub row: f32,
    /// Half the width of their mask, in equivalent radii.
    pub half_extent: f32,
    /// What is wanted of them: nothing, their mean ([`STREAK_MEAN`]), or chords, too ([`STREAK_CHORDS`]).
    pub wanted: u32,
    /// 0.
    pub unused: [u32; 2],
    /// For each elevation: half the width and half the height of the oval, and how far its middle is up.
    pub ovals: [[f32; 4]; DROPS_ELEVATIONS as usize],
}

/// The row of elevations of a ray of length 1.
#[must_use]
pub fn streak_table_elevation(row: f32, towards: Vec3) -> f32 {
    let half = (DROPS_ELEVATIONS - 1) as f32 * 0.5;
    if row == 0.0 {
        // A sphere is the same from everywhere.
        return half;
    }
    let elevation = ops::asin((-towards.y).clamp(-1.0, 1.0));
    ((elevation * STREAK_PER_QUARTER + 1.0) * half).clamp(0.0, 2.0 * half)
}

/// The oval between elevations.
fn streak_table_oval(shape: &StreakShape, elevation: f32) -> Vec3 {
    let low = (elevation as u32).min(DROPS_ELEVATIONS - 2);
    let part = elevation - low as f32;
    let [near, far] = [low, low + 1].map(|k| Vec4::from(shape.ovals[k as usize]));
    (near * (1.0 - part) + far * part).truncate()
}

/// The direction of the motion on the oval.
#[must_use]
pub fn streak_table_direction(right: Vec3, up: Vec3, velocity: Vec3, oval: Vec3) -> Vec2 {
    let moved = Vec2::new(velocity.dot(right), velocity.dot(up)) / Vec2::new(oval.x, oval.y);
    let length = moved.dot(moved).sqrt();
    if length > 1.0e-6 { moved / length.max(1.0e-20) } else { Vec2::NEG_Y }
}

/// An entry.
fn streak_table_write(value: Vec4) -> [u32; 2] {
    let kept = value.min(Vec4::splat(STREAK_BRIGHTEST));
    [pack([kept.x, kept.y]), pack([kept.z, kept.w])]
}

impl DropsView<'_> {
    /// The light of one part of a chord, or of a drop: the sum over its taps.
    fn streak_table_part(&self, shape: &StreakShape, place: u32, index: u32, part: u32) -> Vec4 {
        let mean = place == STREAK_ACROSS;
        let last = (STREAK_RAYS - 1) as f32;
        let (column, line) = ((index % STREAK_RAYS) as f32 / last, (index / STREAK_RAYS) as f32 / last);
        let ray = self.drops_frame_ray(column * self.frame.width as f32, line * self.frame.height as f32);
        let towards = drops_mask_unit(ray);
        let right = drops_mask_right(towards);
        let up = right.cross(towards);
        let elevation = streak_table_elevation(shape.row, towards);
        let oval = streak_table_oval(shape, elevation);
        let extent = shape.half_extent;
        let direction = streak_table_direction(right, up, Vec3::from(shape.velocity), oval);
        let taps = if mean { STREAK_MEAN_GRID * STREAK_MEAN_GRID } else { STREAK_TAPS } / STREAK_SUMS;
        let across = (place as f32 + 0.5) * (2.0 / STREAK_ACROSS as f32) - 1.0;
        let half = (1.0 - across * across).max(0.0).sqrt();
        let spacing = 2.0 * oval.x / if mean { STREAK_MEAN_GRID } else { STREAK_FINE } as f32;
        let drop = DropsShade {
            towards,
            half_extent: extent,
            lean: Vec3::ZERO,
            spacing,
            row: [shape.row, elevation],
        };
        let mut sum = Vec4::ZERO;
        for tap in part * taps..(part + 1) * taps {
            let at = if mean {
                let cell = Vec2::new((tap % STREAK_MEAN_GRID) as f32, (tap / STREAK_MEAN_GRID) as f32);
                (cell + 0.5) * (2.0 / STREAK_MEAN_GRID as f32) - 1.0
            } else {
                let v = (tap as f32 + 0.5) * (2.0 / STREAK_TAPS as f32) - 1.0;
                Vec2::new(direction.y, -direction.x) * across + direction * (v * half)
            };
            let place = (at * Vec2::new(oval.x, oval.y) + Vec2::new(0.0, oval.z)) / extent;
            if place.x.abs() < 1.0 && place.y.abs() < 1.0 {
                sum += self.drops_shade_ray(&drop, place.x, place.y);
            }
        }
        sum
    }

    /// The entries of one ray, place across the motion (or the mean), and shape.
    fn streak_table_entries(&self, shape: &StreakShape, place: u32, index: u32) -> [[u32; 2]; SUMS] {
        let mut entries = [[0; 2]; SUMS];
        let mut sum = Vec4::ZERO;
        for (entry, part) in entries.iter_mut().zip(0..STREAK_SUMS) {
            sum += self.streak_table_part(shape, place, index, part);
            let colour = sum.truncate() / sum.w.max(1.0e-20);
            let share = (part + 1) as f32 / STREAK_SUMS as f32;
            *entry = streak_table_write(colour.extend(1.0) * share);
        }
        if place == STREAK_ACROSS {
            entries = [[0; 2]; SUMS];
            entries[0] = streak_table_write(sum / sum.w.max(1.0e-20));
        }
        entries
    }

    /// The table of these shapes.
    pub(super) fn streak_table(&self, shapes: &[StreakShape]) -> StreakTable {
        let rays = STREAK_RAYS * STREAK_RAYS;
        let entries = rays * STREAK_SUMS;
        let layers: Vec<(usize, u32)> = (0..shapes.len())
            .flat_map(|shape| (0..=STREAK_ACROSS).map(move |place| (shape, place)))
            .collect();
        let words = layers
            .into_par_iter()
            .flat_map_iter(|(shape, place)| {
                let shape = &shapes[shape];
                if shape.wanted < if place < STREAK_ACROSS { STREAK_CHORDS } else { STREAK_MEAN } {
                    return vec![[0; 2]; entries as usize];
                }
                (0..rays).flat_map(|ray| self.streak_table_entries(shape, place, ray)).collect()
            })
            .collect();
        StreakTable { words }
    }
}
