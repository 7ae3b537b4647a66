//! Streaks of unresolved drops: how many more or fewer of them a pixel sees than are to be expected. Twin of
//! `shaders/wgsl/render/medium_streaks.wgsl`.
//!
//! The drops that a picture does not draw are many, but not endlessly many: of those of a shell of distances some number crosses a pixel
//! while the shutter is open, by Poisson's law, and each takes out what its outline covers of it. So the medium has the variance of the
//! drops that it stands for: for cross sections `s` and `n` drops per volume, in a shell of the thickness `d` at the distance `r`, seen
//! by a pixel of the solid angle `w` that a streak crosses within `L` pixels, the variance of the optical depth is
//! `n <s^2> d / (r^2 w L)`, and that of a Poisson number times its mean square if the number has the mean
//! `(n <s>)^2 d r^2 w L / (n <s^2>)`.
//!
//! The lattice of streaks goes with the eye, but turns with the world, and falls as the drops do. Limits: all sizes of a shell fall
//! alike; near the axis of motion, where streaks are points, the medium is even.

use downpour_math::ops;
use downpour_math::rng::{rng_pcg4d, rng_unit};
use downpour_shaders::render::medium::{
    MEDIUM_NEAR, MEDIUM_SLICES, MEDIUM_STREAKS_CHANCE, MEDIUM_STREAKS_DIMENSION, MEDIUM_STREAKS_MANY,
    MEDIUM_STREAKS_MAX, MEDIUM_STREAKS_PART, MEDIUM_STREAKS_SINE,
};
use glam::{Vec2, Vec3};

use super::frame::{MediumFrame, MediumShell, medium_node};
use super::{MediumGrain, RainMedium};
use crate::camera::Camera;
use crate::rain::Exposure;

/// Unresolved drops of a shell of distances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Shell {
    /// Mean over its thickness of the sum of the squares of the outlines' areas per volume, m.
    pub(super) squares: f32,
    /// Mean fall speed, weighted by these squares, m/s.
    pub(super) speed: f32,
}

/// First and last distance of a shell, m.
pub(super) fn shell_of(index: u32) -> [f32; 2] {
    let begin = if index == 0 { 0.0 } else { medium_node(2 * index - 1) };
    [begin, medium_node(2 * index + 1)]
}

impl MediumFrame {
    /// The frame with the streaks of the medium's drops in a picture, if it has any.
    #[must_use]
    pub(crate) fn with_streaks(self, medium: &RainMedium, camera: &Camera, exposure: &Exposure) -> Self {
        if medium.grain == MediumGrain::Even || medium.all <= 0.0 {
            return self;
        }
        // Past the eye, as the drops of all sizes fall in the mean.
        let passing = medium.velocity - exposure.eye.velocity;
        let axis = (-passing).try_normalize().unwrap_or(Vec3::Y);
        let (across, beside) = axis.any_orthonormal_pair();
        let pixel = camera.pixel_angle;
        let mut shells = [MediumShell::default(); MEDIUM_SLICES as usize];
        for (index, (shell, of)) in (0u32..).zip(shells.iter_mut().zip(&medium.shells)) {
            let [begin, end] = shell_of(index);
            let depth = self.medium_within(end) - self.medium_within(begin);
            if of.squares <= 0.0 || depth <= 0.0 {
                continue;
            }
            let (distance, thickness) = (0.5 * (begin + end), end - begin);
            let width = distance * pixel;
            let speed = f64::from((passing + Vec3::Y * (medium.fall_speed - of.speed)).length());
            let row = f64::from(width).max(speed * exposure.drops_s());
            // Rows count from time 0.
            let rows = speed * exposure.time_s / row;
            *shell = MediumShell {
                count: depth * depth * width * width / (of.squares * thickness),
                pixels: (speed * exposure.drops_s()) as f32 / width,
                row: (rows.floor() as i64) as u32,
                part: (rows - rows.floor()) as f32,
            };
        }
        Self {
            axis: axis.into(),
            seed: exposure.seed as u32 ^ (exposure.seed >> 32) as u32,
            across: across.into(),
            is_grainy: 1,
            beside: beside.into(),
            shells,
            ..self
        }
    }

    /// The drops of a shell over a pixel, over those that are to be expected, where the ray has this sine and cosine to the axis of
    /// motion. `part`: of the shell that is before the scene.
    fn medium_streaks_shell(
        &self,
        index: u32,
        column: [u32; 2],
        [sine, cosine]: [f32; 2],
        part: f32,
        pixel: f32,
    ) -> f32 {
        let shell = &self.shells[index as usize];
        if shell.count <= 0.0 || part <= 0.0 || sine < MEDIUM_STREAKS_SINE {
            return 1.0;
        }
        let [x, y, z, w] = rng_pcg4d([column[0], column[1], MEDIUM_STREAKS_DIMENSION + index, self.seed]);
        // Drops of neighboring columns begin at other heights; a row is as high as a streak is long, or a pixel.
        let height = cosine / (sine * pixel * shell.pixels.max(1.0)) + shell.part + rng_unit(x);
        let row = shell.row.wrapping_add((height.floor() as i32) as u32);
        let number = rng_unit(rng_pcg4d([y, row, z, w])[0]);
        medium_streaks_poisson(shell.count * part * (1.0 + shell.pixels * sine), number)
    }

    /// The same of a ray of unit direction: of its optical depth from the eye to a distance, and about a distance `light` on it. `pixel`:
    /// angle of a pixel.
    pub(crate) fn medium_streaks_at(
        &self,
        direction: Vec3,
        span: Vec3,
        end: f32,
        light: f32,
        pixel: f32,
    ) -> Vec2 {
        if self.is_grainy == 0 {
            return Vec2::ONE;
        }
        let cosine = direction.dot(Vec3::from(self.axis));
        let across =
            Vec2::new(direction.dot(Vec3::from(self.across)), direction.dot(Vec3::from(self.beside)));
        let sine = across.dot(across).sqrt();
        let column = medium_streaks_column(across, pixel);
        // The place of the distance among the middles of the shells.
        let place = 0.5 * (3.0 * ops::log2((light / MEDIUM_NEAR).max(1.0e-6)) + 1.0) - 0.5;
        let place = place.clamp(0.0, (MEDIUM_SLICES - 1) as f32);
        let (mut about, mut sum, mut whole) = (0.0, 0.0, 0.0);
        let (mut before, mut begin) = (0.0, 0.0);
        for k in 0..MEDIUM_SLICES {
            let last = medium_node(2 * k + 1);
            let until = self.medium_depth(last.min(end), span, 1.0);
            let weight = (1.0 - (place - k as f32).abs()).max(0.0);
            let part = ((end - begin) / (last - begin)).clamp(0.0, 1.0);
            if part > 0.0 || weight > 0.0 {
                let part = part.max(MEDIUM_STREAKS_PART);
                let drops = self.medium_streaks_shell(k, column, [sine, cosine], part, pixel);
                sum += drops * (until - before);
                whole += until - before;
                about += drops * weight;
            }
            (before, begin) = (until, last);
        }
        Vec2::new(if whole <= 0.0 { 1.0 } else { sum / whole.max(1.0e-20) }, about)
    }
}

/// A number of Poisson's law over its mean, for a number in [0, 1).
#[must_use]
pub fn medium_streaks_poisson(mean: f32, number: f32) -> f32 {
    if mean >= MEDIUM_STREAKS_MANY {
        // Evenly spread about 1, with the same variance.
        return 1.0 + (number - 0.5) * (12.0 / mean).sqrt();
    }
    let mut chance = ops::exp(-mean);
    let mut sum = chance;
    let mut count = 0u16;
    // Beyond the least chance the sum is as near to 1 as its digits.
    while u32::from(count) < MEDIUM_STREAKS_MAX && number >= sum && chance > MEDIUM_STREAKS_CHANCE {
        count += 1;
        chance *= mean / f32::from(count);
        sum += chance;
    }
    f32::from(count) / mean
}

/// The column of a direction, by its part across the axis of motion, and the number of columns: half a pixel to a pixel wide.
#[must_use]
pub fn medium_streaks_column(across: Vec2, pixel: f32) -> [u32; 2] {
    // A coordinate along the edges of a square, 0 to 4, in place of the angle: the same on each device.
    let edge = (across.x.abs() + across.y.abs()).max(1.0e-9);
    let part = across.y / edge;
    let turn = if across.x >= 0.0 { 1.0 + part } else { 3.0 - part };
    let sine = across.dot(across).sqrt();
    let wide = edge / sine.max(1.0e-9);
    let columns = (4.0 * sine * wide * wide / pixel).clamp(1.0, 1.0e7);
    let count = 1u32 << (ops::log2(columns).ceil() as u32);
    [(turn * 0.25 * count as f32) as u32, count]
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_math::ops::f64 as exact;

    /// Mean and variance are those of Poisson's law over its mean: 1, and 1 over the mean.
    #[test]
    fn poisson_numbers_have_their_mean_and_variance() {
        for mean in [0.02f32, 0.3, 2.0, 7.0, 11.9, 12.1, 90.0] {
            let count = 1 << 20;
            let numbers =
                (0..count).map(|k| f64::from(medium_streaks_poisson(mean, (k as f32 + 0.5) / count as f32)));
            let (sum, squares) = numbers.fold((0.0, 0.0), |(sum, squares), x| (sum + x, squares + x * x));
            let (first, second) = (sum / f64::from(count), squares / f64::from(count));
            let variance = (second - first * first) * f64::from(mean);
            assert!((first - 1.0).abs() < 2.0e-3, "{mean}: {first}");
            assert!((variance - 1.0).abs() < 5.0e-3, "{mean}: {variance}");
        }
    }

    /// The last number below 1 is few drops, however few there are.
    #[test]
    fn no_pixel_has_drops_without_end() {
        for mean in [1.0e-4f32, 0.01, 0.1, 1.0, 5.0, 11.9] {
            let most = medium_streaks_poisson(mean, 1.0 - f32::EPSILON / 2.0) * mean;
            assert!(most <= 4.0 + mean + 8.0 * mean.sqrt(), "{mean}: {most}");
        }
    }

    /// Columns go round once, and are between half a pixel and a pixel wide.
    #[test]
    fn columns_are_no_wider_than_a_pixel() {
        let pixel = 8.0e-4f32;
        for sine in [1.0f32, 0.7, 0.4] {
            let steps = 200_000u32;
            let (mut changes, mut last) = (0u32, u32::MAX);
            for k in 0..steps {
                let angle = f64::from(k) / f64::from(steps) * std::f64::consts::TAU;
                let across = Vec2::new(exact::cos(angle) as f32, exact::sin(angle) as f32) * sine;
                let [column, count] = medium_streaks_column(across, pixel);
                assert!(column <= count && count.is_power_of_two(), "{angle}: {column} of {count}");
                changes += u32::from(column != last);
                last = column;
            }
            let width = std::f32::consts::TAU * sine / pixel / changes as f32;
            assert!((0.49..1.01).contains(&width), "{sine}: {width}");
        }
    }
}
