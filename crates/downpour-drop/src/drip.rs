//! Drops that leave an edge: their size, their rate, and the jet that takes their place in strong flow.
//!
//! Law of the size: T. Tate, Philosophical Magazine 27, 176 (1864), with the correction of W. D. Harkins and F. E. Brown, Journal of
//! the American Chemical Society 41, 499 (1919): `m g = 2 pi r sigma f`. Not all of a hanging drop falls: the fraction `f` depends on
//! the radius `r` of the edge over the cube root of the drop's volume ([`detached_fraction`]), 0.60 to 0.73 for edges of 1 mm and more. A
//! tube of 3 mm drips 0.0475 ml of water, so that about 20 drops are a gram, as the droppers of pharmacists are made to.
//!
//! Tate found drops of up to 136 mg, 6.4 mm, off a broad flat surface: no drop is larger.
//!
//! An edge that is level is wet all along. Drops form on it at the distance of the fastest growing wave of a layer of water that hangs
//! (Rayleigh and Taylor): `2 pi sqrt(2 sigma / (rho g))`, 24 mm (M. Fermigier et al., Journal of Fluid Mechanics 236, 349, 1992).
//!
//! More than about [`MAX_DRIPPING_PER_S`] drops a second do not come one by one: a jet runs down and breaks. A jet of the diameter `d`
//! has the Weber number `rho v^2 d / sigma` = 4 where it begins to form, and breaks into drops of 1.88 d, the volume of one wave of the
//! length 4.51 d (Rayleigh, Proc. London Math. Soc. 10, 4, 1878).
//!
//! Units: SI; temperatures in Celsius. Water at rest in air: the laws do not know of soap, wind or ice.

use std::f64::consts::{FRAC_PI_4, PI, TAU};
use std::ops::RangeInclusive;

use downpour_math::in_range;
use downpour_math::ops::f64 as ops;

use crate::DropError;
use crate::air::STANDARD_GRAVITY;
use crate::water::{density, surface_tension};

/// Maximum diameter of a drop off an edge, m (Tate 1864).
pub const MAX_DIAMETER_M: f64 = 6.4e-3;

/// Range of the radius of an edge, m.
pub const RADIUS_RANGE_M: RangeInclusive<f64> = 0.05e-3..=1.0;

/// Range of the diameter of a dripping drop, m.
pub const DIAMETER_RANGE_M: RangeInclusive<f64> = 0.5e-3..=MAX_DIAMETER_M;

/// Radius that a drop wets on a broad edge, m: it hangs by less than the capillary length, 2.7 mm. Drops are 5.1 mm large.
pub const BROAD_RADIUS_M: f64 = 2.4e-3;

/// Maximum rate of drops that come one by one, per second.
pub const MAX_DRIPPING_PER_S: f64 = 10.0;

/// Diameter of the drops of a jet over that of the jet: the volume of a wave of 4.508 diameters.
pub const JET_DROP_RATIO: f64 = 1.88;

/// Weber number at which a jet forms.
const JET_WEBER: f64 = 4.0;

/// Harkins and Brown's fraction, from `r / V^(1/3)` = 0.30 on in steps of 0.05.
const FRACTIONS: [f64; 19] = [
    0.7256, 0.7011, 0.6828, 0.6669, 0.6515, 0.6362, 0.6250, 0.6171, 0.6093, 0.6032, 0.6000, 0.5992, 0.5998,
    0.6034, 0.6098, 0.6179, 0.6280, 0.6407, 0.6535,
];

/// Fraction of Tate's ideal weight that falls, for an edge's radius over the cube root of the drop's volume.
///
/// Harkins and Brown's table from 0.3 to 1.2, straight lines between its points; below it a straight line to 1 at 0. Above 1.2, where
/// the drop would be larger than [`MAX_DIAMETER_M`] in water, the last value.
#[must_use]
pub fn detached_fraction(ratio: f64) -> f64 {
    if ratio < 0.3 {
        return 1.0 - (1.0 - FRACTIONS[0]) * ratio.max(0.0) / 0.3;
    }
    let position = ((ratio - 0.3) / 0.05).min((FRACTIONS.len() - 1) as f64);
    let lower = (position as usize).min(FRACTIONS.len() - 2);
    let fraction = position - lower as f64;
    FRACTIONS[lower] + (FRACTIONS[lower + 1] - FRACTIONS[lower]) * fraction
}

/// Volume of a sphere, m^3.
#[must_use]
pub fn sphere_volume(diameter_m: f64) -> f64 {
    PI / 6.0 * diameter_m * diameter_m * diameter_m
}

/// Diameter of the sphere of a volume, m.
#[must_use]
pub fn sphere_diameter(volume_m3: f64) -> f64 {
    ops::cbrt(volume_m3.max(0.0) * 6.0 / PI)
}

/// Distance between the drops that form on a level edge, m.
///
/// ```
/// assert!((downpour_drop::drip::spacing(20.0)? - 24.2e-3).abs() < 0.1e-3);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] outside [`TEMPERATURE_RANGE_C`](crate::water::TEMPERATURE_RANGE_C).
pub fn spacing(temperature_c: f64) -> Result<f64, DropError> {
    let length = 2.0 * surface_tension(temperature_c)? / (density(temperature_c)? * STANDARD_GRAVITY);
    Ok(TAU * length.sqrt())
}

/// Drops off an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drip {
    /// Diameter of the sphere of a drop's volume, m.
    pub diameter_m: f64,
    /// Fraction of the hanging water that falls; the rest stays and is part of the next drop.
    pub detached: f64,
    /// Surface tension over density, m^3/s^2.
    tension: f64,
}

/// Flow from an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DripFlow {
    /// Drops per second.
    pub per_s: f64,
    /// Their diameter, m.
    pub diameter_m: f64,
    /// True if they come from a jet that breaks, and do not hang before.
    pub is_jet: bool,
}

impl Drip {
    /// Drops of water off an edge whose radius, or half thickness, is `radius_m`.
    ///
    /// ```
    /// use downpour_drop::drip::Drip;
    /// let drip = Drip::new(1.0e-3, 20.0)?;
    /// assert!((drip.diameter_m - 4.0e-3).abs() < 0.05e-3);
    /// # Ok::<(), downpour_drop::DropError>(())
    /// ```
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] for a radius outside [`RADIUS_RANGE_M`], a temperature as in [`density`].
    pub fn new(radius_m: f64, temperature_c: f64) -> Result<Self, DropError> {
        in_range("radius of an edge", radius_m, "mm", &RADIUS_RANGE_M, 1.0e3, "0.05 to 1000")?;
        let tension = surface_tension(temperature_c)? / density(temperature_c)?;
        let ideal = TAU * radius_m * tension / STANDARD_GRAVITY;
        let fraction_of = |volume: f64| detached_fraction(radius_m / ops::cbrt(volume));
        // The table is flat: each turn halves the error at least.
        let mut fraction = 0.65;
        for _ in 0..40 {
            fraction = 0.5 * (fraction + fraction_of(ideal * fraction));
        }
        let diameter_m = sphere_diameter(ideal * fraction).min(MAX_DIAMETER_M);
        Ok(Self { diameter_m, detached: fraction.min(0.95), tension })
    }

    /// Drops of a diameter in m, as the edge that makes them leaves them.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] for a diameter outside [`DIAMETER_RANGE_M`], a temperature as in [`density`].
    pub fn of_diameter(diameter_m: f64, temperature_c: f64) -> Result<Self, DropError> {
        let range = *DIAMETER_RANGE_M.start() - 1.0e-12..=MAX_DIAMETER_M + 1.0e-12;
        in_range("diameter of a drip", diameter_m, "mm", &range, 1.0e3, "0.5 to 6.4")?;
        let tension = surface_tension(temperature_c)? / density(temperature_c)?;
        // The ideal volume is proportional to the radius: halving finds it.
        let volume = sphere_volume(diameter_m);
        let (mut low, mut high) = (0.0, 1.2 * ops::cbrt(volume));
        for _ in 0..60 {
            let radius = 0.5 * (low + high);
            let falls =
                TAU * radius * tension / STANDARD_GRAVITY * detached_fraction(radius / ops::cbrt(volume));
            if falls < volume { low = radius } else { high = radius }
        }
        let detached = detached_fraction(low / ops::cbrt(volume)).min(0.95);
        Ok(Self { diameter_m, detached, tension })
    }

    /// Volume of a drop, m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        sphere_volume(self.diameter_m)
    }

    /// Drops of a flow in m^3/s: one by one, or above [`MAX_DRIPPING_PER_S`] those of a jet.
    ///
    /// Of a jet, the drops are no larger than [`MAX_DIAMETER_M`], and there are as many as the flow makes.
    #[must_use]
    pub fn flow(&self, flow_m3_s: f64) -> DripFlow {
        let flow_m3_s = flow_m3_s.max(0.0);
        let per_s = flow_m3_s / self.volume();
        if per_s <= MAX_DRIPPING_PER_S {
            return DripFlow { per_s, diameter_m: self.diameter_m, is_jet: false };
        }
        let diameter_m = (JET_DROP_RATIO * self.jet_diameter(flow_m3_s)).min(MAX_DIAMETER_M);
        DripFlow { per_s: flow_m3_s / sphere_volume(diameter_m), diameter_m, is_jet: true }
    }

    /// Diameter in m of a jet of a flow in m^3/s, where it forms: `Q = pi/4 d^2 v` with `v^2 = 4 sigma / (rho d)`.
    #[must_use]
    pub fn jet_diameter(&self, flow_m3_s: f64) -> f64 {
        let root = flow_m3_s.max(0.0) / (FRAC_PI_4 * (JET_WEBER * self.tension).sqrt());
        let cube_root = ops::cbrt(root);
        cube_root * cube_root
    }

    /// Diameter in m of the sphere of the water that hangs at an edge, at a fraction of the time between two drops.
    ///
    /// After a drop has fallen, what did not fall hangs there; just before, the whole drop does.
    #[must_use]
    pub fn hanging_diameter(&self, fraction: f64) -> f64 {
        let whole = self.volume() / self.detached;
        sphere_diameter(whole - self.volume() * (1.0 - fraction.clamp(0.0, 1.0)))
    }
}
