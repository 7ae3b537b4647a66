//! The drop that each pixel shows most of, for those who need to know it.

use downpour_shaders::render::rain::{DROPS_OPAQUE, DROPS_STILL};
use glam::Vec2;
use rayon::prelude::*;

use super::Rain;
use super::drops::{drops_before, drops_depth, drops_position};
use super::streak::{ScreenDrop, streak_chord, streak_cover};
use super::tiles::TileLists;

/// Samples along an edge of a pixel, of drops that are not smaller.
const GRID: u32 = 4;

/// The drop that a pixel shows most of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropTruth {
    /// Its place among the drops that were given.
    pub drop: u32,
    /// Distance before the pixel, m.
    pub distance: f32,
    /// Fraction of the pixel's light that comes by way of it, 0 to 1: what it covers for a part of the exposure, and nearer drops do not.
    pub alpha: f32,
}

impl Rain {
    /// For each pixel of a plate the drop that it shows most of; `None` where no drop is drawn.
    #[must_use]
    pub fn truth(&self, clean: &[[f32; 4]]) -> Vec<Option<DropTruth>> {
        let [width, height] = self.frame.camera.size();
        let tiles = TileLists::of_all(&self.list, [width, height]);
        let pixel = |(y, x): (u32, u32)| {
            let scene = clean[(y * width + x) as usize][3];
            let mut most: Option<DropTruth> = None;
            let mut left = 1.0;
            for &index in tiles.of_pixel(x, y) {
                let drop = &self.list[index as usize];
                if drop.nearest >= scene || left < DROPS_OPAQUE {
                    break;
                }
                let distance = drops_depth(&self.frame.camera, drop, x, y);
                let alpha = self.cover(drop, x, y) * drops_before(drop, scene, distance) * left;
                if alpha > most.map_or(0.0, |most| most.alpha) {
                    most = Some(DropTruth { drop: self.given[index as usize], distance, alpha });
                }
                left -= alpha;
            }
            most
        };
        (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| (y, x))).map(pixel).collect()
    }

    /// Fraction of a pixel that a drop covers, times the fraction of the exposure for which it does.
    fn cover(&self, drop: &ScreenDrop, x: u32, y: u32) -> f32 {
        if drop.grid == 0 {
            return streak_cover(drop, x, y);
        }
        let sample = |k: u32| {
            let at = |k: u32| (k as f32 + 0.5) / GRID as f32;
            let position =
                drops_position(&self.frame.camera, drop, x as f32 + at(k % GRID), y as f32 + at(k / GRID));
            if drop.kind == DROPS_STILL {
                let [half_width, half_height, up] = drop.oval;
                let from = Vec2::new(position.x, position.y - up * drop.slope) / drop.slope;
                let part = from / Vec2::new(half_width, half_height);
                return if part.length_squared() < 1.0 { 1.0 } else { 0.0 };
            }
            let chord = streak_chord(drop, position);
            if chord.high > chord.low { chord.fraction * (chord.high - chord.low) * 0.5 } else { 0.0 }
        };
        ((0..GRID * GRID).map(sample).sum::<f32>() / (GRID * GRID) as f32).clamp(0.0, 1.0)
    }
}
