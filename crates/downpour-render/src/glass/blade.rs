//! Blade and arm of a wiper on a pane, as outlines in the pane's coordinates. Twin of
//! `shaders/wgsl/render/glass_picture_blade.wgsl`.
//!
//! A rubber lip, the holder behind it, which narrows toward its ends, and the arm from the pivot to the blade's middle. They are
//! opaque, and as far from the eye as the pane: a lens that focuses beyond blurs them as it blurs the drops. The widths are those of
//! wipers of passenger cars: a lip of 6 mm, a holder of 12 mm, an arm of 15 mm at its pivot and 8 mm at its end. The diffuse reflectances
//! are those of rubber with carbon black and of black paint: 0.04 and 0.05.

use downpour_lattice::glass::GlassWiper;
use downpour_math::ops::f64 as ops;
use downpour_shaders::render::glass::{
    GLASS_PICTURE_ARM, GLASS_PICTURE_ARM_END, GLASS_PICTURE_BLADE_ROWS, GLASS_PICTURE_HOLDER,
    GLASS_PICTURE_HOLDER_END, GLASS_PICTURE_LIP, GLASS_PICTURE_METAL, GLASS_PICTURE_RUBBER,
};
use glam::Vec2;

/// Directions of a blade while the shutter is open.
const DIRECTIONS: u32 = 2 * GLASS_PICTURE_BLADE_ROWS;

/// A wiper while the shutter is open, in meters on the pane: x right, y down. The same layout as `GlassPictureBlade` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassPictureBlade {
    /// Pivot.
    pub pivot: [f32; 2],
    /// Start and end of the rubber, m from the pivot.
    pub reach: [f32; 2],
    /// Directions of the blade, of length 1, at even times from the opening of the shutter to its closing: two to a row.
    pub directions: [[f32; 4]; GLASS_PICTURE_BLADE_ROWS as usize],
}

impl GlassPictureBlade {
    /// The blade of a wiper in the middle of whose exposure the wiper's time is `time_s`. The pivot is `above` meters lower than that of
    /// the wiper is said to be.
    pub(super) fn new(wiper: &GlassWiper, time_s: f64, shutter_s: f64, above: f64) -> Self {
        let [x, y] = wiper.pivot_m;
        let mut directions = [[0.0; 4]; GLASS_PICTURE_BLADE_ROWS as usize];
        for (k, direction) in (0u32..).zip(directions.as_flattened_mut().chunks_exact_mut(2)) {
            let fraction = f64::from(k) / f64::from(DIRECTIONS - 1) - 0.5;
            let angle = wiper.angle(time_s + fraction * shutter_s);
            direction.copy_from_slice(&[ops::cos(angle) as f32, -ops::sin(angle) as f32]);
        }
        Self {
            pivot: [x as f32, (y - above) as f32],
            reach: [wiper.inner_m as f32, wiper.outer_m as f32],
            directions,
        }
    }
}

/// A direction of the blade, by its number.
#[must_use]
pub fn glass_picture_blade_direction(blade: &GlassPictureBlade, k: u32) -> Vec2 {
    let [a, b, c, d] = blade.directions[k as usize / 2];
    if k.is_multiple_of(2) { Vec2::new(a, b) } else { Vec2::new(c, d) }
}

/// Direction of the blade, of length 1, at a fraction of the time that the shutter is open.
#[must_use]
pub fn glass_picture_blade_at(blade: &GlassPictureBlade, fraction: f32) -> Vec2 {
    let last = (DIRECTIONS - 1) as f32;
    let at = fraction.clamp(0.0, 1.0) * last;
    let low = at.floor().min(last - 1.0);
    let part = at - low;
    let k = low as u32;
    let v = glass_picture_blade_direction(blade, k) * (1.0 - part)
        + glass_picture_blade_direction(blade, k + 1) * part;
    v / v.dot(v).max(1.0e-12).sqrt()
}

/// The part of a blade, which points in a direction of length 1, at a position of the pane: how far across the part the position is, -1 to
/// 1, and the part's diffuse reflectance, 0 where there is none.
#[must_use]
pub fn glass_picture_blade_part(blade: &GlassPictureBlade, direction: Vec2, position: Vec2) -> Vec2 {
    let away = position - Vec2::from(blade.pivot);
    let along = away.x * direction.x + away.y * direction.y;
    let aside = away.y * direction.x - away.x * direction.y;
    let [from, to] = blade.reach;
    let length = (to - from).max(1.0e-6);
    let share = (along - from) / length;
    if (0.0..=1.0).contains(&share) {
        if aside.abs() <= GLASS_PICTURE_LIP {
            return Vec2::new(aside / GLASS_PICTURE_LIP, GLASS_PICTURE_RUBBER);
        }
        let narrower = GLASS_PICTURE_HOLDER_END - GLASS_PICTURE_HOLDER;
        let half = GLASS_PICTURE_HOLDER + narrower * (2.0 * share - 1.0).abs();
        if aside.abs() <= half {
            return Vec2::new(aside / half, GLASS_PICTURE_METAL);
        }
    }
    let middle = (0.5 * (from + to)).max(1.0e-6);
    let of_arm = along / middle;
    if (0.0..=1.0).contains(&of_arm) {
        let half = GLASS_PICTURE_ARM + (GLASS_PICTURE_ARM_END - GLASS_PICTURE_ARM) * of_arm;
        if aside.abs() <= half {
            return Vec2::new(aside / half, GLASS_PICTURE_METAL);
        }
    }
    Vec2::ZERO
}

#[cfg(test)]
mod tests {
    use downpour_lattice::glass::{GlassWiperKey, GlassWiperMotion};

    use super::*;

    fn upright(keys: &[(f64, f64)]) -> GlassWiper {
        let key = |&(time_s, angle_rad): &(f64, f64)| GlassWiperKey { time_s, angle_rad };
        GlassWiper {
            pivot_m: [0.25, 0.56],
            inner_m: 0.1,
            outer_m: 0.3,
            motion: GlassWiperMotion::Keys(keys.iter().map(key).collect()),
            film_m: 0.0,
            worn: Vec::new(),
        }
    }

    /// At 90 degrees the blade stands above its pivot: 6 mm of rubber, 12 mm of holder in the middle, nothing beyond the end; below the
    /// blade the arm, 15 to 8 mm wide.
    #[test]
    fn a_blade_is_where_its_angle_says_and_as_wide_as_it_is() {
        let wiper = upright(&[(0.0, std::f64::consts::FRAC_PI_2)]);
        let blade = GlassPictureBlade::new(&wiper, 5.0, 0.02, 0.15);
        let direction = glass_picture_blade_at(&blade, 0.3);
        assert!((direction - Vec2::NEG_Y).length() < 1.0e-6, "{direction}");
        // Millimeters that are covered across the blade, so many meters above the pivot.
        let width = |above: f32, reflectance: f32| {
            let at = |k: i16| Vec2::new(0.25 + f32::from(k) * 1.0e-4, 0.41 - above);
            let is = |k: &i16| {
                let found = glass_picture_blade_part(&blade, direction, at(*k)).y;
                found > 0.0 && (reflectance == 0.0 || found == reflectance)
            };
            f64::from((-200i16..200).filter(is).count() as u32) * 0.1
        };
        for (above, lip, all) in [(0.2, 6.0, 12.0), (0.15, 6.0, 10.125), (0.05, 0.0, 13.25), (0.31, 0.0, 0.0)]
        {
            assert!((width(above, GLASS_PICTURE_RUBBER) - lip).abs() < 0.25, "lip at {above}");
            assert!((width(above, 0.0) - all).abs() < 0.25, "{} at {above}", width(above, 0.0));
        }
        assert_eq!(width(-0.02, 0.0), 0.0);
    }

    /// A blade that turns at 2 rad/s through an exposure of 0.1 s passes 0.2 rad, evenly, half of it before the time of the picture.
    #[test]
    fn a_blade_moves_while_the_shutter_is_open() {
        let blade = GlassPictureBlade::new(&upright(&[(0.0, 0.0), (1.0, 2.0)]), 0.5, 0.1, 0.0);
        for (fraction, angle) in [(0.0f32, 0.9f32), (0.25, 0.95), (0.5, 1.0), (1.0, 1.1)] {
            let expected = Vec2::new(downpour_math::ops::cos(angle), -downpour_math::ops::sin(angle));
            let found = glass_picture_blade_at(&blade, fraction);
            assert!((found - expected).length() < 1.0e-4, "{fraction}: {found}, not {expected}");
        }
    }
}
