//! Splash of a drop on a wet surface: whether there is one, and the size, duration and shape of its crown.
//!
//! Laws:
//! - threshold: the root of the Weber number `We = rho u^2 d / sigma` of the speed `u` toward the surface above 20, on a film (R. L. Vander
//!   Wal, G. M. Berger, S. D. Mozes, Experiments in Fluids 40, 2006). At terminal speed drops from 1.27 mm on splash on level ground; on a
//!   surface 25 degrees from the vertical those of 3 mm do, on one of 10 degrees none do. (On a dry surface `We^0.5 Re^0.25` above 57.7 is the
//!   threshold, of C. Mundo and others, 1995, which nearly all drops pass; rain falls on what is wet.)
//! - radius of the crown: `r / d = (2/3)^(1/4) (d / h)^(1/4) (u t / d)^(1/2)` on a film of depth `h` (A. L. Yarin, D. A. Weiss,
//!   J. Fluid Mech. 283, 1995), until it is highest at `u t / d =` [`RISE_TIMES`] times the drop's [`surplus`], after which it grows no more;
//! - surplus: the part `1 - We_c / We` of the drop's energy that is beyond the energy of one that just splashes. The area of a crown, whose
//!   surface energy it becomes, goes as it does: a crown has no size at the threshold, and its growth depends on the Weber number, as
//!   G. E. Cossali and others measured (Experiments in Fluids 36, 2004);
//! - duration: the crown rises in [`RISE_SHARE`] of it and falls back in the rest. For a drop of 3 mm on a film of half a
//!   millimeter this is 31 ms, about the free fall from the height of its crown.
//!
//! The threshold is from a published table. [`RISE_TIMES`] and [`RISE_SHARE`] are of the order that high-speed pictures of splashes
//! show, and are not fitted to measurements; how a crown grows beyond the threshold is an argument of scale. The shape ([`crown`]) is a model.
//!
//! Units: m, s, m/s.

pub mod crown;

use downpour_math::in_range;
use downpour_shaders::sim::splash::{SPLASH_RISE_SHARE, SPLASH_RISE_TIMES, SPLASH_THRESHOLD};

use crate::{DropError, water};

/// Root of the Weber number above which a drop splashes on a film.
pub const THRESHOLD: f64 = SPLASH_THRESHOLD as f64;

/// Time at which the crown of a drop far above the threshold is highest, in drop diameters over the drop's speed.
pub const RISE_TIMES: f64 = SPLASH_RISE_TIMES as f64;

/// Fraction of a crown's duration in which it rises.
pub const RISE_SHARE: f64 = SPLASH_RISE_SHARE as f64;

/// Depth of the film on a surface in rain, in m.
pub const FILM_M: f64 = 0.5e-3;

/// Splashes on a film of water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplashLaw {
    film_m: f64,
    density: f64,
    surface_tension: f64,
    viscosity: f64,
}

/// Splash of one drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splash {
    /// Largest radius of the crown, in m.
    pub radius_m: f64,
    /// Time from the impact to the end of the crown, in s.
    pub duration_s: f64,
}

impl SplashLaw {
    /// Splashes on a film of a depth in m, at a temperature in Celsius.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] for a film that is not 0.05 to 10 mm deep, or a temperature outside
    /// [`water::TEMPERATURE_RANGE_C`].
    pub fn new(film_m: f64, temperature_c: f64) -> Result<Self, DropError> {
        in_range("film of water", film_m, "mm", &(0.05e-3..=0.01), 1.0e3, "0.05 to 10")?;
        Ok(Self {
            film_m,
            density: water::density(temperature_c)?,
            surface_tension: water::surface_tension(temperature_c)?,
            viscosity: water::viscosity(temperature_c)?,
        })
    }

    /// Depth of the film, m.
    #[must_use]
    pub fn film_m(&self) -> f64 {
        self.film_m
    }

    /// Root of the Weber number of a drop of a diameter in m that meets a surface with a speed toward it in m/s.
    ///
    /// ```
    /// use downpour_drop::splash::{FILM_M, SplashLaw};
    /// let root = SplashLaw::new(FILM_M, 20.0)?.weber_root(2.0e-3, 6.49);
    /// assert!((root - 34.0).abs() < 0.2);
    /// # Ok::<(), downpour_drop::DropError>(())
    /// ```
    #[must_use]
    pub fn weber_root(&self, diameter_m: f64, speed_m_s: f64) -> f64 {
        (self.density * speed_m_s * speed_m_s * diameter_m / self.surface_tension).sqrt()
    }

    /// Splash parameter `K = We^0.5 Re^0.25` of Mundo and others 1995, with the Reynolds number `Re = rho u d / mu`, of a drop of a diameter
    /// in m that meets a surface with a speed toward it in m/s.
    ///
    /// ```
    /// use downpour_drop::splash::{FILM_M, SplashLaw};
    /// let k = SplashLaw::new(FILM_M, 20.0)?.parameter(2.0e-3, 6.49);
    /// assert!((k - 363.0).abs() < 4.0);
    /// # Ok::<(), downpour_drop::DropError>(())
    /// ```
    #[must_use]
    pub fn parameter(&self, diameter_m: f64, speed_m_s: f64) -> f64 {
        let reynolds = self.density * speed_m_s * diameter_m / self.viscosity;
        self.weber_root(diameter_m, speed_m_s) * reynolds.sqrt().sqrt()
    }

    /// Root of the Weber number of a drop of 1 m at 1 m/s.
    #[must_use]
    pub fn strength(&self) -> f64 {
        self.weber_root(1.0, 1.0)
    }

    /// Radius, m, of the highest crown of a drop of 1 m far above the threshold: that of others goes as the diameter to the power of 5/4, and as
    /// the root of the [`surplus`].
    #[must_use]
    pub fn unit_radius(&self) -> f64 {
        self.radius(1.0, 1.0, RISE_TIMES)
    }

    /// Splash of a drop of a diameter in m that meets a surface with a speed toward it in m/s; `None` if it does not splash.
    #[must_use]
    pub fn splash(&self, diameter_m: f64, speed_m_s: f64) -> Option<Splash> {
        let surplus = surplus(self.weber_root(diameter_m, speed_m_s.max(0.0)));
        let rise_s = RISE_TIMES * surplus * diameter_m / speed_m_s;
        (surplus > 0.0).then(|| Splash {
            radius_m: self.radius(diameter_m, speed_m_s, rise_s),
            duration_s: rise_s / RISE_SHARE,
        })
    }

    /// Radius of a crown in m at a time in s after the impact, up to the one at which the largest are highest.
    #[must_use]
    pub fn radius(&self, diameter_m: f64, speed_m_s: f64, time_s: f64) -> f64 {
        let times = (speed_m_s * time_s / diameter_m).clamp(0.0, RISE_TIMES);
        let shape = (2.0 / 3.0 * diameter_m / self.film_m).sqrt().sqrt();
        diameter_m * shape * times.sqrt()
    }
}

/// Part of the energy of a drop that is beyond the energy of one that just splashes, from the root of its Weber number: in [0, 1), 0 where it
/// does not splash.
#[must_use]
pub fn surplus(weber_root: f64) -> f64 {
    let ratio = THRESHOLD / weber_root.max(THRESHOLD);
    1.0 - ratio * ratio
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::air::Air;
    use crate::fall_speed::{FallSpeedModel, terminal_speed};

    fn law() -> SplashLaw {
        SplashLaw::new(FILM_M, 20.0).expect("a law")
    }

    fn falls(diameter: f64) -> f64 {
        terminal_speed(FallSpeedModel::Beard1976, diameter, &Air::standard()).expect("a drop")
    }

    #[test]
    fn drops_splash_from_13_tenths_of_a_millimeter_on() {
        // By hand at terminal speed: We is 223 at 1 mm, 603 at 1.5 mm, 1156 at 2 mm, 5670 at 5 mm.
        for (diameter, weber) in [(1.0e-3, 223.0f64), (1.5e-3, 603.0), (2.0e-3, 1156.0), (5.0e-3, 5670.0)] {
            let root = law().weber_root(diameter, falls(diameter));
            assert!((root * root / weber - 1.0).abs() < 0.02, "{diameter}: {root}");
        }
        for (diameter, splashes) in [(0.7e-3, false), (1.2e-3, false), (1.35e-3, true), (5.0e-3, true)] {
            assert_eq!(law().splash(diameter, falls(diameter)).is_some(), splashes, "{diameter}");
        }
        // On what is steep only the speed toward it counts.
        let on_slope = |from_vertical: f64| {
            let toward = falls(3.0e-3) * downpour_math::ops::f64::sin(from_vertical.to_radians());
            law().splash(3.0e-3, toward).is_some()
        };
        assert!(on_slope(25.0) && !on_slope(20.0));
        assert!(law().splash(3.0e-3, -1.0).is_none());
        assert!(law().splash(3.0e-3, 0.0).is_none());
    }

    #[test]
    fn a_crown_has_the_radius_of_yarin_and_weiss() {
        // d = 3 mm, h = 0.5 mm: (2/3 * 6)^(1/4) = 1.4142; u t / d = 9: sqrt 3; 3 mm * 1.4142 * 3 = 12.73 mm.
        let radius = law().radius(3.0e-3, 8.0, 9.0 * 3.0e-3 / 8.0);
        assert!((radius - 12.728e-3).abs() < 1.0e-6, "{radius}");
        let splash = law().splash(3.0e-3, 8.0).expect("it splashes");
        // We is 998 * 64 * 0.003 / 0.0727 = 2635, the surplus 1 - 400 / 2635 = 0.848: 3 mm * 1.4142 * (12 * 0.848)^(1/2) = 13.53 mm.
        assert!((splash.radius_m - 13.53e-3).abs() < 1.0e-5, "{splash:?}");
        assert!((0.030..0.033).contains(&splash.duration_s), "{splash:?}");
    }

    #[test]
    fn a_crown_grows_from_nothing_at_the_threshold() {
        let law = law();
        let speed = |root: f64| root / law.weber_root(3.0e-3, 1.0);
        assert!(law.splash(3.0e-3, speed(19.99)).is_none());
        // Just above it nothing is seen yet, and a drop of 3 mm that meets the pane of a car 25 degrees from the vertical has a small one.
        let radius = |root: f64| law.splash(3.0e-3, speed(root)).expect("it splashes").radius_m;
        assert!(radius(20.01) < 0.5e-3, "{}", radius(20.01));
        assert!((5.0e-3..6.5e-3).contains(&radius(21.7)), "{}", radius(21.7));
        // Area and energy: twice the threshold's energy leaves half of it, four times three quarters.
        let area = |root: f64| radius(root) * radius(root);
        assert!((area(40.0) / area(20.0 * 2.0f64.sqrt()) - 1.5).abs() < 1.0e-9);
    }

    #[test]
    fn films_have_limits() {
        for film in [0.0, 0.04e-3, 0.011, f64::NAN] {
            assert!(SplashLaw::new(film, 20.0).is_err(), "{film}");
        }
        assert!(SplashLaw::new(FILM_M, 60.0).is_err());
    }
}
