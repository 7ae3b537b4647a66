//! Retention of a drop on glass by the contact line.
//!
//! Retention (Furmidge 1962): `F = k w sigma (cos receding - cos advancing)`, w the width of the contact. A drop is
//! the cap of a sphere at the mean of the two angles. k is 1 in the classic form, 24 / pi^3 = 0.774 for the contact
//! angle that varies as a cubic around the line (`ElSherbini` & Jacobi 2006). SI units, angles in radians.

use downpour_math::in_range;
use std::f64::consts::PI;

use downpour_math::ops::f64 as ops;

use super::error::GlassError;

/// Contact angles of water on a surface, and their retention.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassContact {
    /// Advancing contact angle, rad: 5 to 120 degrees.
    pub advancing_rad: f64,
    /// Receding contact angle, rad: 0 degrees to the advancing one.
    pub receding_rad: f64,
    /// Factor k of the retention, 0.5 to 1.
    pub retention: f64,
    /// Friction of a moving drop relative to that of a resting one, 0 to 1.
    pub kinetic: f64,
    /// Viscous drag of the contact line: `F = 6 mu U w l / theta`, where l is this number (the logarithm of the drop's
    /// size over the slip length, including all that the wedge model neglects), 1 to 1000. 20 gives 5 to 20 cm/s for
    /// 10 to 50 ul.
    pub line_drag: f64,
}

impl Default for GlassContact {
    /// An ordinary window: 60 and 20 degrees, k = 24 / pi^3.
    fn default() -> Self {
        Self {
            advancing_rad: 60f64.to_radians(),
            receding_rad: 20f64.to_radians(),
            retention: 24.0 / (PI * PI * PI),
            kinetic: 0.75,
            line_drag: 20.0,
        }
    }
}

impl GlassContact {
    /// Checks that all numbers are in their ranges.
    ///
    /// # Errors
    /// [`GlassError::OutOfRange`].
    pub fn check(&self) -> Result<(), GlassError> {
        let degrees = 180.0 / PI;
        let smallest = 5f64.to_radians();
        in_range(
            "advancing contact angle",
            self.advancing_rad,
            "degrees",
            &(smallest..=120f64.to_radians()),
            degrees,
            "5 to 120",
        )?;
        in_range(
            "receding contact angle",
            self.receding_rad,
            "degrees",
            &(0.0..=self.advancing_rad),
            degrees,
            "0 to the advancing angle",
        )?;
        in_range("retention factor", self.retention, "", &(0.5..=1.0), 1.0, "0.5 to 1")?;
        in_range("kinetic fraction of the friction", self.kinetic, "", &(0.0..=1.0), 1.0, "0 to 1")?;
        in_range("line drag", self.line_drag, "", &(1.0..=1000.0), 1.0, "1 to 1000")?;
        Ok(())
    }

    /// Contact angle of the cap, rad.
    #[must_use]
    pub fn mean_rad(&self) -> f64 {
        0.5 * (self.advancing_rad + self.receding_rad)
    }

    /// Radius of the wetted disk of a drop, m, from its volume in m^3.
    #[must_use]
    pub fn radius(&self, volume: f64) -> f64 {
        ops::cbrt(volume / (PI * self.cap()))
    }

    /// Volume of a cap over pi r^3, `(2 - 3 cos + cos^3) / (3 sin^3)`.
    fn cap(&self) -> f64 {
        let theta = self.mean_rad();
        let (sin, cos) = (ops::sin(theta), ops::cos(theta));
        // (2 - 3 cos + cos^3) = (1 - cos)^2 (2 + cos), which keeps its digits at small angles.
        (1.0 - cos) * (1.0 - cos) * (2.0 + cos) / (3.0 * sin * sin * sin)
    }

    /// Radius of the sphere whose cap is rendered over a disk of radius `radius`, m. The angle is limited to 85
    /// degrees, since a height field has one value per cell.
    #[must_use]
    pub fn sphere(&self, radius: f64) -> f64 {
        radius / ops::sin(self.mean_rad().min(85f64.to_radians()))
    }

    /// Frontal area of a cap over a disk of radius `radius` to the wind along the pane, m^2.
    #[must_use]
    pub fn frontal_area(&self, radius: f64) -> f64 {
        let theta = self.mean_rad();
        let (sin, cos) = (ops::sin(theta), ops::cos(theta));
        radius * radius / (sin * sin) * (theta - sin * cos)
    }

    /// Half of the width of a ridge with this cross-section in m^2, m: a segment of a circle at the mean contact angle.
    #[must_use]
    pub fn ridge(&self, area: f64) -> f64 {
        (area / self.frontal_area(1.0)).sqrt()
    }

    /// Mean speed of the water down a ridge with this cross-section in m^2, m/s, from its weight in N/m^3 along the ridge and its
    /// viscosity in Pa s: lubrication flow under a parabola of height h, `integral of h^3 / (3 integral of h)`, which is 8/35 of
    /// `weight h^2 / mu`.
    #[must_use]
    pub fn ridge_speed(&self, area: f64, weight: f64, mu: f64) -> f64 {
        let height = self.ridge(area) * ops::tan(0.5 * self.mean_rad());
        8.0 / 35.0 * weight * height * height / mu
    }

    /// Retention force on a drop of radius `radius`, N, with the surface tension `sigma` in N/m.
    #[must_use]
    pub fn hold(&self, radius: f64, sigma: f64) -> f64 {
        self.retention
            * 2.0
            * radius
            * sigma
            * (ops::cos(self.receding_rad) - ops::cos(self.advancing_rad)).max(0.0)
    }

    /// Viscous drag over the speed, N s/m, with the viscosity `mu` in Pa s.
    #[must_use]
    pub fn drag(&self, radius: f64, mu: f64) -> f64 {
        6.0 * mu * 2.0 * radius * self.line_drag / self.mean_rad()
    }

    /// Volume, m^3, from which drops slide on a dry pane tilted by `tilt_rad` from the horizontal, without wind:
    /// `rho g sin(tilt) V = F(V)`. Infinite on a level pane.
    #[must_use]
    pub fn sliding_volume(&self, tilt_rad: f64, density: f64, sigma: f64) -> f64 {
        let weight = density * downpour_drop::air::STANDARD_GRAVITY * ops::sin(tilt_rad).max(0.0);
        // F = f V^(1/3), so V^(2/3) = f / weight.
        let per_radius = self.hold(1.0, sigma) * self.radius(1.0);
        let fraction = per_radius / weight;
        fraction * fraction.sqrt()
    }
}
