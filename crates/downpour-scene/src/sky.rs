//! Sky: radiance by direction, as an equirectangular map.
//!
//! Convention, the same as the Khronos sample viewer's: right-handed axes, +Y up; a unit direction (x, y, z) that
//! points away from the viewer is found at
//!
//! ```text
//! u = 0.5 + atan2(z, x) / (2 pi)      from the left edge, 0 to 1; it wraps
//! v = 0.5 - asin(y) / pi              from the top edge, 0 to 1
//! ```
//!
//! so the middle of the map looks along +X, and +Z is a quarter of the map right of it. Row j of h rows spans the
//! polar angles pi j/h to pi (j+1)/h, and each of its w pixels the solid angle
//! `2 pi/w (cos(pi j/h) - cos(pi (j+1)/h))`: exact, so the weights of all pixels add up to 4 pi.
//!
//! Radiance is linear, three colors, in the unit of the file; a weather file scales it. It is finite and between
//! 0 and [`MAX_RADIANCE`]. Between the centers of pixels it is interpolated bilinearly; beyond a pole is the row
//! next to it, half a turn on.

mod file;
mod model;
mod sun;

use downpour_math::ops;
use downpour_math::ops::f64 as ops64;
use std::f32::consts::PI;

use crate::warning::Warning;
pub use file::{from_picture, read_sky, read_sky_from_bytes};
pub use sun::{MAX_SUN_RADIUS, SUN_THRESHOLD, Sun};

/// The largest radiance of a pixel, in the unit of the file; the sun's disk is 1.6e9 cd/m^2.
pub const MAX_RADIANCE: f32 = 1e12;

/// The light of the sky from each direction: rows from the top, see [the module](self) for the directions.
///
/// ```
/// use downpour_scene::sky::SkyMap;
/// let overcast = SkyMap::overcast([3.0, 3.0, 3.0]);
/// // Three times as bright overhead as at the horizon; black below.
/// assert!((overcast.radiance([0.0, 1.0, 0.0])[0] - 3.0).abs() < 0.02);
/// assert!((overcast.radiance([1.0, 0.03, 0.0])[1] - 1.0).abs() < 0.1);
/// assert_eq!(overcast.radiance([0.0, -1.0, 0.0]), [0.0; 3]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SkyMap {
    /// Pixels in a row; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// `width * height` radiances, linear.
    pub radiance: Vec<[f32; 3]>,
    /// Parts that were dropped or repaired on reading.
    pub warnings: Vec<Warning>,
}

/// Position of a direction in the map, both parts from 0 to 1. The length of the direction does not matter; the zero
/// vector is at the middle.
///
/// ```
/// use downpour_scene::sky::direction_to_uv;
/// assert_eq!(direction_to_uv([2.0, 0.0, 0.0]), [0.5, 0.5]);
/// assert_eq!(direction_to_uv([0.0, 0.0, 1.0]), [0.75, 0.5]);
/// assert_eq!(direction_to_uv([0.0, 1.0, 0.0])[1], 0.0);
/// ```
#[must_use]
pub fn direction_to_uv(direction: [f32; 3]) -> [f32; 2] {
    let [x, y, z] = direction;
    let length = ops::hypot(ops::hypot(x, z), y);
    let up = if length > 0.0 { (y / length).clamp(-1.0, 1.0) } else { 0.0 };
    [0.5 + ops::atan2(z, x) / (2.0 * PI), 0.5 - ops::asin(up) / PI]
}

/// Unit direction of a position in the map.
///
/// ```
/// use downpour_scene::sky::{direction_to_uv, uv_to_direction};
/// let [u, v] = direction_to_uv(uv_to_direction([0.3, 0.8]));
/// assert!((u - 0.3).abs() < 1e-6 && (v - 0.8).abs() < 1e-6);
/// ```
#[must_use]
pub fn uv_to_direction([u, v]: [f32; 2]) -> [f32; 3] {
    let (azimuth, elevation) = ((u - 0.5) * (2.0 * PI), (0.5 - v) * PI);
    let flat = ops::cos(elevation);
    [flat * ops::cos(azimuth), ops::sin(elevation), flat * ops::sin(azimuth)]
}

impl SkyMap {
    /// The radiance from a direction; see [`direction_to_uv`].
    #[must_use]
    pub fn radiance(&self, direction: [f32; 3]) -> [f32; 3] {
        let [u, v] = direction_to_uv(direction);
        let (x, y) = (u * self.width as f32 - 0.5, v * self.height as f32 - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let (right, down) = (x - column, y - row);
        #[expect(clippy::cast_possible_truncation, reason = "whole, and within a side of the map")]
        let (column, row) = (column as i64, row as i64);
        let mix = |a: [f32; 3], b: [f32; 3], t: f32| {
            let ([ar, ag, ab], [br, bg, bb]) = (a, b);
            [ar + (br - ar) * t, ag + (bg - ag) * t, ab + (bb - ab) * t]
        };
        let next = |i: i64| i.saturating_add(1);
        let above = mix(self.texel(column, row), self.texel(next(column), row), right);
        let below = mix(self.texel(column, next(row)), self.texel(next(column), next(row)), right);
        mix(above, below, down)
    }

    /// A pixel; columns wrap, and a row beyond a pole is the row next to it, half a turn on.
    fn texel(&self, column: i64, row: i64) -> [f32; 3] {
        let (width, height) = (i64::from(self.width), i64::from(self.height));
        let last = height.saturating_sub(1);
        let (column, row) =
            if (0..height).contains(&row) { (column, row) } else { (column.saturating_add(width / 2), row) };
        let column = column.rem_euclid(width.max(1));
        let index = row.clamp(0, last.max(0)).saturating_mul(width).saturating_add(column);
        usize::try_from(index).ok().and_then(|index| self.radiance.get(index)).copied().unwrap_or_default()
    }

    /// The solid angle of a pixel of a row, in steradian.
    #[must_use]
    pub fn solid_angle(&self, row: u32) -> f64 {
        use std::f64::consts::PI;
        let height = f64::from(self.height);
        let (top, bottom) = (PI * f64::from(row) / height, PI * (f64::from(row) + 1.0) / height);
        // cos a - cos b as a product: no digits are lost at the poles.
        let band = 2.0 * ops64::sin((top + bottom) / 2.0) * ops64::sin((bottom - top) / 2.0);
        2.0 * PI / f64::from(self.width) * band
    }

    /// Mean radiance over the whole sphere, each pixel weighted by its solid angle.
    #[must_use]
    pub fn mean_radiance(&self) -> [f64; 3] {
        let total = self.rows().fold([0.0; 3], |total, (row, pixels)| {
            let weight = self.solid_angle(row);
            add(
                total,
                scaled(pixels.iter().fold([0.0; 3], |sum, pixel| add(sum, pixel.map(f64::from))), weight),
            )
        });
        scaled(total, 1.0 / (4.0 * std::f64::consts::PI))
    }

    /// The sky rotated about the vertical: a light along +X moves to -Z with a quarter turn (`yaw` = pi/2,
    /// counter-clockwise seen from above). Rows are interpolated for fractions of a pixel; the mean stays the same.
    #[must_use]
    pub fn rotated(&self, yaw: f64) -> Self {
        let width = f64::from(self.width);
        let shift = (yaw / (2.0 * std::f64::consts::PI)).rem_euclid(1.0) * width;
        // A turn by an integer number of pixels but for its last digits must not blur.
        let near = shift.round();
        let shift = if (shift - near).abs() < 1e-6 { near } else { shift };
        #[expect(clippy::cast_possible_truncation, reason = "from 0 to the width")]
        let (whole, part) = (shift.floor() as usize, (shift - shift.floor()) as f32);
        let mut map = self.clone();
        for row in map.radiance.chunks_mut((self.width as usize).max(1)) {
            row.rotate_left(whole.checked_rem(row.len()).unwrap_or(0));
            let Some(&first) = row.first() else { continue };
            if part > 0.0 {
                let next: Vec<[f32; 3]> = row.iter().skip(1).copied().chain([first]).collect();
                for (pixel, after) in row.iter_mut().zip(next) {
                    let ([r, g, b], [ar, ag, ab]) = (*pixel, after);
                    *pixel = [r + (ar - r) * part, g + (ag - g) * part, b + (ab - b) * part];
                }
            }
        }
        map
    }

    /// Rows with their numbers, from the top.
    fn rows(&self) -> impl Iterator<Item = (u32, &[[f32; 3]])> {
        (0..self.height).zip(self.radiance.chunks((self.width as usize).max(1)))
    }
}

/// Luminance of a linear color with the primaries of ITU-R BT.709.
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn add([ar, ag, ab]: [f64; 3], [br, bg, bb]: [f64; 3]) -> [f64; 3] {
    [ar + br, ag + bg, ab + bb]
}

fn scaled(color: [f64; 3], by: f64) -> [f64; 3] {
    color.map(|value| value * by)
}
