//! The sun of a sky map: its brightest compact source, taken out so that it can cast a shadow.
//!
//! Method: the pixels brighter than a multiple of the map's mean luminance that are connected to the brightest
//! one are the source. The pixels around them are the sky behind it; the excess over these is the source's
//! irradiance on a surface that faces it, `E = sum (L - L_sky) dOmega`. Source and remaining map together have the light of
//! the original map, in each color.
//!
//! The angular radius is that of a uniform disk with the same first two moments of radiance,
//! `Omega = (sum L dOmega)^2 / sum L^2 dOmega`, `cos r = 1 - Omega / 2 pi`. Photographs blur the sun's disk (0.27
//! degrees) over a few pixels, so maps of 1024 x 512 give about half a degree.

use super::model::narrowed;
use super::{SkyMap, add, luminance, scaled, uv_to_direction};
use downpour_math::ops::f64 as ops;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// Threshold for [`SkyMap::extract_sun`] that finds the sun of a clear day and ignores bright clouds.
pub const SUN_THRESHOLD: f64 = 20.0;

/// Maximum angular radius of a compact source, in radians: 10 degrees.
pub const MAX_SUN_RADIUS: f64 = PI / 18.0;

/// Minimum fraction of a map's light in a source that counts as a sun, not as a distant lamp.
const MIN_FRACTION: f64 = 0.01;

/// A compact source far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The unit direction toward it.
    pub direction: [f32; 3],
    /// Irradiance of a surface that faces it, in the map's unit of radiance times steradian.
    pub irradiance_rgb: [f32; 3],
    /// The radius of the disk that it appears as, in radians.
    pub angular_radius: f32,
}

/// Sums over the pixels of a source.
#[derive(Default)]
struct Moments {
    irradiance: [f64; 3],
    flux: f64,
    flux_squared: f64,
    direction: [f64; 3],
}

impl SkyMap {
    /// Removes the brightest compact source from the map and returns it; `None`, and the map unchanged, if nothing
    /// is `threshold` times as bright as the mean, if such pixels cover more than a disk of [`MAX_SUN_RADIUS`], or if they
    /// hold less than 1 % of the light.
    ///
    /// [`SUN_THRESHOLD`] is a good threshold. The pixels of the source are filled with the mean of their neighbors.
    ///
    /// ```
    /// use downpour_scene::sky::{SUN_THRESHOLD, SkyMap};
    /// let mut sky = SkyMap { width: 64, height: 32, ..SkyMap::uniform([1.0; 3]) };
    /// sky.radiance = vec![[1.0; 3]; 64 * 32];
    /// sky.radiance[8 * 64 + 48] = [9001.0; 3];
    /// let sun = sky.extract_sun(SUN_THRESHOLD).expect("a sun");
    /// assert!(sun.direction[1] > 0.6 && sun.direction[2] > 0.6);
    /// assert_eq!(sky.radiance[8 * 64 + 48], [1.0; 3]);
    /// ```
    pub fn extract_sun(&mut self, threshold: f64) -> Option<Sun> {
        let mean = luminance(self.mean_radiance());
        let level = threshold * mean;
        let source = self.source(level)?;
        let behind = self.around(&source);
        let moments = self.moments(&source, behind);
        let direction = unit(moments.direction)?;
        if luminance(moments.irradiance) < MIN_FRACTION * 4.0 * PI * mean {
            return None;
        }
        let spread = moments.flux * moments.flux / moments.flux_squared;
        let sun = Sun {
            direction: direction.map(narrowed),
            irradiance_rgb: moments.irradiance.map(narrowed),
            angular_radius: narrowed(ops::acos((1.0 - spread / (2.0 * PI)).clamp(-1.0, 1.0))),
        };
        for &(column, row) in &source {
            if let Some(pixel) = self.pixel_mut(column, row) {
                let ([r, g, b], [br, bg, bb]) = (*pixel, behind.map(narrowed));
                *pixel = [r.min(br), g.min(bg), b.min(bb)];
            }
        }
        Some(sun)
    }

    /// Pixels above a level that are connected to the brightest pixel; `None` if there are none or too many.
    fn source(&self, level: f64) -> Option<BTreeSet<(u32, u32)>> {
        let mut brightest: Option<(f64, (u32, u32))> = None;
        for (row, pixels) in self.rows() {
            for (column, pixel) in (0..self.width).zip(pixels) {
                let bright = luminance(pixel.map(f64::from));
                if bright > level && brightest.is_none_or(|(most, _)| bright > most) {
                    brightest = Some((bright, (column, row)));
                }
            }
        }
        let (_, seed) = brightest?;
        let most = 2.0 * PI * (1.0 - ops::cos(MAX_SUN_RADIUS));
        let (mut found, mut front, mut area) = (BTreeSet::from([seed]), vec![seed], 0.0);
        while let Some(at) = front.pop() {
            area += self.solid_angle(at.1);
            if area > most {
                return None;
            }
            for next in self.neighbors(at) {
                let bright = self.pixel(next).is_some_and(|pixel| luminance(pixel.map(f64::from)) > level);
                if bright && found.insert(next) {
                    front.push(next);
                }
            }
        }
        Some(found)
    }

    /// Mean of the pixels that touch a source, by their solid angles; black if there are none.
    fn around(&self, source: &BTreeSet<(u32, u32)>) -> [f64; 3] {
        let mut ring: BTreeMap<(u32, u32), ()> = BTreeMap::new();
        for &at in source {
            ring.extend(self.neighbors(at).filter(|next| !source.contains(next)).map(|next| (next, ())));
        }
        let (mut sum, mut area) = ([0.0; 3], 0.0);
        for at in ring.keys() {
            let weight = self.solid_angle(at.1);
            area += weight;
            sum = add(sum, scaled(self.pixel(*at).unwrap_or_default().map(f64::from), weight));
        }
        if area > 0.0 { scaled(sum, 1.0 / area) } else { [0.0; 3] }
    }

    fn moments(&self, source: &BTreeSet<(u32, u32)>, behind: [f64; 3]) -> Moments {
        let mut moments = Moments::default();
        for &(column, row) in source {
            let weight = self.solid_angle(row);
            let [r, g, b] = self.pixel((column, row)).unwrap_or_default().map(f64::from);
            // The fill is rounded to f32 first, so that no light is lost between the two parts.
            let [br, bg, bb] = behind.map(|value| f64::from(narrowed(value)));
            let above = [(r - br).max(0.0), (g - bg).max(0.0), (b - bb).max(0.0)];
            let bright = luminance(above);
            let center = |at: u32, side: u32| narrowed((f64::from(at) + 0.5) / f64::from(side));
            let towards = uv_to_direction([center(column, self.width), center(row, self.height)]);
            moments.irradiance = add(moments.irradiance, scaled(above, weight));
            moments.flux += bright * weight;
            moments.flux_squared += bright * bright * weight;
            moments.direction = add(moments.direction, scaled(towards.map(f64::from), bright * weight));
        }
        moments
    }

    /// The eight neighbors of a pixel: columns wrap, rows end at the poles.
    fn neighbors(&self, (column, row): (u32, u32)) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (width, height) = (self.width, self.height);
        let left = column.checked_sub(1).unwrap_or(width.saturating_sub(1));
        let right = column.saturating_add(1).checked_rem(width).unwrap_or(0);
        let rows = [row.checked_sub(1), Some(row), row.checked_add(1).filter(|&row| row < height)];
        rows.into_iter()
            .flatten()
            .flat_map(move |r| [(left, r), (column, r), (right, r)])
            .filter(move |&at| at != (column, row))
    }

    fn pixel(&self, (column, row): (u32, u32)) -> Option<[f32; 3]> {
        let index = (row as usize).checked_mul(self.width as usize)?.checked_add(column as usize)?;
        self.radiance.get(index).copied()
    }

    fn pixel_mut(&mut self, column: u32, row: u32) -> Option<&mut [f32; 3]> {
        let index = (row as usize).checked_mul(self.width as usize)?.checked_add(column as usize)?;
        self.radiance.get_mut(index)
    }
}

/// A vector of length 1; `None` if it has no direction.
fn unit([x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
    let length = (x * x + y * y + z * z).sqrt();
    (length.is_finite() && length > 0.0).then(|| [x / length, y / length, z / length])
}
