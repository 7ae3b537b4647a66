//! Streaks that cover little of each pixel, summed up. Twin of `shaders/wgsl/render/drops_sum.wgsl`, where the method is described.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use downpour_math::ops;
use downpour_shaders::render::rain::{
    DROPS_FAR, DROPS_OPAQUE, DROPS_SUM_BRIGHTEST, DROPS_SUM_DEPTHS, DROPS_SUM_FAINTEST, DROPS_SUM_FEW,
    DROPS_SUM_LARGE, DROPS_SUM_MAX, DROPS_SUM_SMALL, DROPS_SUM_UNITS, DROPS_SUM_WAYS,
};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::drops::Buffers;
use super::streak::{ScreenDrop, streak_is_summed, streak_pixels};

/// The optical depth of a coverage.
#[must_use]
pub fn drops_sum_depth(cover: f32) -> f32 {
    if cover < DROPS_SUM_FEW {
        return cover * (1.0 + cover * (0.5 + cover * (1.0 / 3.0 + cover * 0.25)));
    }
    -ops::ln((1.0 - cover).max(DROPS_OPAQUE))
}

/// The coverage of an optical depth, over that depth.
#[must_use]
pub fn drops_sum_share(depth: f32) -> f32 {
    if depth < DROPS_SUM_FEW {
        return 1.0 - depth * (0.5 - depth * (1.0 / 6.0 - depth * (1.0 / 24.0)));
    }
    (1.0 - ops::exp(-depth)) / depth
}

/// The bits of the power of two that is not below a number, within the range of scales; 1 of 0.
#[must_use]
pub fn drops_sum_scale(bits: u32) -> u32 {
    if bits == 0 {
        return 1.0f32.to_bits();
    }
    ((bits + 0x7f_ffff) & 0x7f80_0000).clamp(DROPS_SUM_FAINTEST, DROPS_SUM_BRIGHTEST)
}

/// The first and last pixel across a path, on a line of pixels: a row where the path is `plumb`, else a column; `None`: there is
/// none.
#[must_use]
pub fn drops_sum_across(drop: &ScreenDrop, plumb: bool, line: u32, count: u32) -> Option<[u32; 2]> {
    let turned = |at: [f32; 2]| if plumb { Vec2::from(at) } else { Vec2::new(at[1], at[0]) };
    let (first, way) = (turned(drop.first), turned(drop.screen_delta));
    // The part of the path that is as high as this line.
    let rate = if way.y < 0.0 { way.y.min(-1.0e-6) } else { way.y.max(1.0e-6) };
    let faces = (Vec2::new(line as f32 - drop.reach, line as f32 + 1.0 + drop.reach) - first.y) / rate;
    let low = faces.min_element().clamp(0.0, 1.0);
    let high = faces.max_element().clamp(0.0, 1.0);
    let (a, b) = (first.x + way.x * low, first.x + way.x * high);
    streak_pixels(a.min(b) - drop.reach, a.max(b) + drop.reach, count)
}

/// The first and last line of pixels that a path may touch; `None`: there is none.
#[must_use]
pub fn drops_sum_lines(drop: &ScreenDrop, plumb: bool, count: u32) -> Option<[u32; 2]> {
    let axis = usize::from(plumb);
    let first = drop.first[axis];
    let last = first + drop.screen_delta[axis];
    streak_pixels(first.min(last) - drop.reach, first.max(last) + drop.reach, count)
}

/// No fewer pixels than [`drops_sum_across`] has on any line.
#[must_use]
pub fn drops_sum_width(drop: &ScreenDrop, plumb: bool) -> u32 {
    let [x, y] = drop.screen_delta.map(f32::abs);
    let (across, along) = if plumb { (x, y) } else { (y, x) };
    let slanted = across.min((1.0 + 2.0 * drop.reach) * across / along.max(1.0e-6));
    (slanted + 2.0 * drop.reach) as u32 + 3
}

/// True for a drop of a list that is summed up, with a profile or without.
#[must_use]
pub fn drops_sum_is_of(list: &[ScreenDrop], index: u32, has_profile: bool) -> bool {
    let drop = list.get(index as usize);
    drop.is_some_and(|drop| streak_is_summed(drop) && (drop.grid > 0) == has_profile)
}

/// True if a path is longer from row to row than from column to column.
#[must_use]
pub fn drops_sum_is_plumb(drop: &ScreenDrop) -> bool {
    drop.screen_delta[1].abs() >= drop.screen_delta[0].abs()
}

/// What streaks show together, of a scene at a distance: the distance, and radiance times coverage, coverage and mean distance in 96
/// bits.
#[must_use]
pub fn drops_sum_pack(shown: Vec4, distance: f32, scene: f32) -> [u32; 4] {
    let [red, green, blue] =
        shown.truncate().max(Vec3::ZERO).to_array().map(|color| (color.to_bits() + 0x200) >> 10);
    let cover = (shown.w.clamp(0.0, 1.0) * 65_535.0 + 0.5) as u32;
    [
        scene.to_bits(),
        red | (green << 21),
        (green >> 11) | (blue << 10),
        cover | (distance.to_bits() & 0xffff_0000),
    ]
}

/// Sums over the streaks of a picture.
struct Sums {
    /// For each pixel red, green, blue in small units, and the optical depth.
    small: Vec<[AtomicU32; 4]>,
    /// For each pixel red, green, blue in large units, and the optical depth times the distance.
    large: Vec<[AtomicU32; 4]>,
    scale: f32,
}

impl Buffers<'_> {
    /// Adds what a streak shows of a pixel: radiance times coverage, and coverage.
    fn drops_sum_add(&self, sums: &Sums, drop: &ScreenDrop, streak: Vec4, [x, y]: [u32; 2]) {
        let pixel = (y * self.view.frame.camera.width + x) as usize;
        let scene = self.clean[pixel][3];
        if drop.nearest >= scene {
            return;
        }
        let shown = self.drops_shown(drop, streak, x, y, scene);
        if shown.max_element() <= 0.0 {
            return;
        }
        let depth = drops_sum_depth(shown.w);
        // Light of lamps may be where there is no coverage.
        let per_cover = if shown.w > 0.0 { depth / shown.w.max(1.0e-20) } else { 1.0 };
        let light = shown.truncate().max(Vec3::ZERO) * (per_cover * (DROPS_SUM_UNITS / sums.scale));
        let (small, large) = (&sums.small[pixel], &sums.large[pixel]);
        for (k, light) in light.to_array().into_iter().enumerate() {
            if light < DROPS_SUM_SMALL {
                small[k].fetch_add((light + 0.5) as u32, Relaxed);
            } else {
                large[k].fetch_add(((light / DROPS_SUM_LARGE).min(DROPS_SUM_MAX) + 0.5) as u32, Relaxed);
            }
        }
        small[3].fetch_add((depth * DROPS_SUM_DEPTHS + 0.5) as u32, Relaxed);
        let distance = drop.distance.min(DROPS_FAR);
        large[3].fetch_add((depth * distance * DROPS_SUM_WAYS + 0.5) as u32, Relaxed);
    }

    /// The scale of the sums.
    fn scale(&self) -> f32 {
        let mean = self.view.drops_capture_texel(self.view.frame.capture_last, 0, 0);
        let mut brightest = mean.max_element().max(0.0).to_bits();
        for (index, drop) in (0..).zip(&self.rain.list) {
            if streak_is_summed(drop) {
                let [red, green, blue, _] = self.drops_glint_row(index)[0];
                brightest = brightest.max(red.max(green).max(blue.max(0.0)).to_bits());
            }
        }
        f32::from_bits(drops_sum_scale(brightest))
    }

    /// What streaks that are summed up show each pixel, as the shader has it; the same for any number of threads.
    pub(super) fn sums(&self) -> Vec<[u32; 4]> {
        let [width, height] = self.view.frame.camera.size();
        let empty = || (0..width * height).map(|_| [const { AtomicU32::new(0) }; 4]).collect::<Vec<_>>();
        let sums = Sums { small: empty(), large: empty(), scale: self.scale() };
        let list = &self.rain.list;
        (0..list.len() as u32).into_par_iter().for_each(|index| {
            let drop = &list[index as usize];
            let plumb = drops_sum_is_plumb(drop);
            let [across, along] = if plumb { [width, height] } else { [height, width] };
            let has_profile = drop.grid > 0;
            if !drops_sum_is_of(list, index, has_profile) {
                return;
            }
            let Some([first, last]) = drops_sum_lines(drop, plumb, along) else { return };
            for line in first..=last {
                let Some([low, high]) = drops_sum_across(drop, plumb, line, across) else { continue };
                for k in low..=high {
                    let [x, y] = if plumb { [k, line] } else { [line, k] };
                    let streak = if has_profile {
                        self.drops_wide(index, drop, x, y)
                    } else {
                        self.drops_thin(index, drop, x, y)
                    };
                    self.drops_sum_add(&sums, drop, streak, [x, y]);
                }
            }
        });
        let unit = sums.scale / DROPS_SUM_UNITS;
        let finished = |pixel: usize| {
            let number = |word: &AtomicU32| word.load(Relaxed) as f32;
            let [small, large] =
                [&sums.small[pixel], &sums.large[pixel]].map(|words| words.each_ref().map(number));
            let light = [0, 1, 2].map(|k| (small[k] + large[k] * DROPS_SUM_LARGE) * unit);
            let depth = small[3] / DROPS_SUM_DEPTHS;
            let distance = large[3] / DROPS_SUM_WAYS / depth.max(1.0 / DROPS_SUM_DEPTHS);
            let shown = Vec3::from(light).extend(depth) * drops_sum_share(depth);
            drops_sum_pack(shown, distance, self.clean[pixel][3])
        };
        (0..self.clean.len()).into_par_iter().map(finished).collect()
    }
}
