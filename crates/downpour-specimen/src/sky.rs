//! A sky map: radiance by direction.
//!
//! Equirectangular, +Y up: u = 0.5 + atan2(z, x) / 2 pi, v = 0.5 - asin(y) / pi from the top. The center of texel
//! (i, j) is at u = (i + 0.5) / width, v = (j + 0.5) / height; between them the map is bilinear, wrapping in u and
//! constant beyond the first and the last row.
//!
//! Both angles come from one polynomial in units of turns ([`specimen_turns`]), within 4e-8 turns in f32: the
//! inverse functions of WGSL may be wrong by 4096 units in the last place.
//!
//! The lamps of [`super::lamp`] are added to the map's light.
//!
//! Twin of `shaders/wgsl/render/specimen.wgsl`.

use downpour_math::octant::octant_turns;
use downpour_math::ops::f64 as ops;
use downpour_math::real::Real;
use downpour_math::vector::{add, add_scaled, dot, scale, sub};
use downpour_shaders::render::specimen::SPECIMEN_TINY;

use super::SpecimenError;
use super::lamp::{SpecimenLamp, specimen_lamp};

/// The largest width and height of a sky map: more would not fit an f32's 24 bits between its texels.
const MAX_SIZE: u32 = 32_768;

/// A borrowed sky map: linear radiance, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub struct Sky<'a> {
    width: u32,
    height: u32,
    radiance: &'a [[f32; 3]],
    lamps: &'a [SpecimenLamp],
}

impl<'a> Sky<'a> {
    /// A view of `radiance`, row by row from the top (+Y).
    ///
    /// # Errors
    /// [`SpecimenError::Size`] for a map without texels, or wider or higher than 32 768; [`SpecimenError::Sky`] if there
    /// are not width x height texels, or one is not finite.
    pub fn new(width: u32, height: u32, radiance: &'a [[f32; 3]]) -> Result<Self, SpecimenError> {
        for (quantity, found) in [("sky map width", width), ("sky map height", height)] {
            if !(1..=MAX_SIZE).contains(&found) {
                let (found, most) = (found.into(), MAX_SIZE.into());
                return Err(SpecimenError::Size { quantity, found, min: 1, max: most });
            }
        }
        let texels = u64::from(width) * u64::from(height);
        if radiance.len() as u64 != texels {
            return Err(SpecimenError::Sky {
                found: format!("{} texels", radiance.len()),
                allowed: format!("{width} x {height} = {texels}"),
            });
        }
        if let Some(at) = radiance.iter().position(|texel| !texel.iter().all(|c| c.is_finite())) {
            let (column, row) = (at % width as usize, at / width as usize);
            return Err(SpecimenError::Sky {
                found: format!("radiance {:?} in column {column} of row {row}", radiance[at]),
                allowed: "finite numbers".to_owned(),
            });
        }
        Ok(Self { width, height, radiance, lamps: &[] })
    }

    /// The same map with lamps in front of it, up to 8. The light of overlapping lamps adds.
    ///
    /// # Errors
    /// [`SpecimenError::Size`] for more lamps.
    pub fn with_lamps(self, lamps: &'a [SpecimenLamp]) -> Result<Self, SpecimenError> {
        SpecimenLamp::check_count(lamps)?;
        Ok(Self { lamps, ..self })
    }

    /// The lamps.
    #[must_use]
    pub fn lamps(self) -> &'a [SpecimenLamp] {
        self.lamps
    }

    /// Texels along a row.
    #[must_use]
    pub fn width(self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(self) -> u32 {
        self.height
    }

    /// The texels, row by row from the top.
    #[must_use]
    pub fn radiance(self) -> &'a [[f32; 3]] {
        self.radiance
    }
}

/// The angle of the point (x, y) in turns, in [-0.5, 0.5]; 0 at the origin.
#[inline(always)]
#[must_use]
pub fn specimen_turns<R: Real>(y: R, x: R) -> R {
    let zero = x.constant(0.0);
    let (wide, tall) = (x.abs(), y.abs());
    let longest = wide.at_least(tall).at_least(x.constant(f64::from(SPECIMEN_TINY)));
    let t = wide.at_most(tall) / longest;
    let octant = octant_turns(t);
    let quadrant = R::select(wide.less(tall), x.constant(0.25) - octant, octant);
    let half = R::select(x.less(zero), x.constant(0.5) - quadrant, quadrant);
    R::select(y.less(zero), -half, half)
}

/// Position of a direction (of any length) on the sky map: u from the left, v from the top, both in [0, 1].
#[inline(always)]
#[must_use]
pub fn specimen_sky_position<R: Real>(direction: [R; 3]) -> [R; 2] {
    let [x, y, z] = direction;
    let half = x.constant(0.5);
    let level = (x * x + z * z).sqrt();
    let turn = specimen_turns(z, x);
    let rise = specimen_turns(y, level);
    [half + turn, half - (rise + rise)]
}

/// One texel of the sky map.
#[inline(always)]
#[must_use]
pub fn specimen_sky_texel(sky: Sky<'_>, column: u32, row: u32) -> [f32; 3] {
    sky.radiance[row as usize * sky.width as usize + column as usize]
}

/// Radiance of the sky at a position of its map.
#[inline(always)]
#[must_use]
pub fn specimen_sky(sky: Sky<'_>, [u, v]: [f32; 2]) -> [f32; 3] {
    let width = sky.width as f32;
    let last = (sky.height - 1) as f32;
    let x = u * width - 0.5;
    let y = (v * (last + 1.0) - 0.5).max(0.0).min(last);
    let (left, top) = (x.floor(), y.floor());
    let next = left + 1.0;
    let column = if left < 0.0 { width - 1.0 } else { left.min(width - 1.0) } as u32;
    let right = if next >= width { 0.0 } else { next } as u32;
    let (row, below) = (top as u32, (top + 1.0).min(last) as u32);
    let (fx, fy) = (x - left, y - top);
    let a = specimen_sky_texel(sky, column, row);
    let b = specimen_sky_texel(sky, right, row);
    let c = specimen_sky_texel(sky, column, below);
    let d = specimen_sky_texel(sky, right, below);
    let upper = add_scaled(a, sub(b, a), fx);
    let lower = add_scaled(c, sub(d, c), fx);
    add_scaled(upper, sub(lower, upper), fy)
}

/// The radiance of all lamps along a direction of length 1.
#[inline]
#[must_use]
pub fn specimen_sky_lamps<R: Real<Mask = bool>>(sky: Sky<'_>, direction: [R; 3]) -> [R; 3] {
    let none = [direction[0].constant(0.0); 3];
    sky.lamps.iter().fold(none, |light, lamp| add(light, specimen_lamp(lamp, direction)))
}

/// The radiance of the map and of the lamps along a direction of length 1.
#[inline]
#[must_use]
pub fn specimen_sky_light(sky: Sky<'_>, direction: [f32; 3]) -> [f32; 3] {
    add(specimen_sky(sky, specimen_sky_position(direction)), specimen_sky_lamps(sky, direction))
}

/// The radiance of the sky along a direction, in f64 and with the library's inverse functions: the reference.
pub(crate) fn sky_f64(sky: Sky<'_>, direction: [f64; 3]) -> [f64; 3] {
    let length = dot(direction, direction).sqrt();
    let sine = (direction[1] / length).clamp(-1.0, 1.0);
    let u = 0.5 + ops::atan2(direction[2], direction[0]) / std::f64::consts::TAU;
    let v = 0.5 - ops::asin(sine) / std::f64::consts::PI;
    let (width, last) = (f64::from(sky.width), f64::from(sky.height - 1));
    let x = u * width - 0.5;
    let y = (v * (last + 1.0) - 0.5).clamp(0.0, last);
    let texel = |column: f64, row: f64| {
        let column = column.rem_euclid(width).min(width - 1.0) as u32;
        specimen_sky_texel(sky, column, row.min(last) as u32).map(f64::from)
    };
    let (left, top) = (x.floor(), y.floor());
    let (a, b) = (texel(left, top), texel(left + 1.0, top));
    let (c, d) = (texel(left, top + 1.0), texel(left + 1.0, top + 1.0));
    let upper = add_scaled(a, sub(b, a), x - left);
    let lower = add_scaled(c, sub(d, c), x - left);
    let map = add_scaled(upper, sub(lower, upper), y - top);
    add(map, specimen_sky_lamps(sky, scale(direction, 1.0 / length)))
}
