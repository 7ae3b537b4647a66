//! A lamp that is far away: a disk of even radiance on the sphere of the sky.
//!
//! No ray that leaves a smooth drop would hit a point. A disk of angular radius r is hit, and its irradiance on a
//! surface that faces it is pi sin^2(r) times its radiance: 3.8e-3 of it at 2 degrees. In the picture a
//! drop shows an image of the disk for each order of light.
//!
//! A direction is within the disk if its chord to the middle is shorter than 2 sin(r / 2), which keeps its digits for
//! small disks, where a cosine has none left. Twin of `shaders/wgsl/render/specimen.wgsl`.

use downpour_math::in_range;
use downpour_math::ops::f64 as ops;
use downpour_math::real::Real;
use downpour_math::vector::{dot, sub};
use downpour_shaders::render::specimen::SPECIMEN_LAMPS;

use super::SpecimenError;

/// Smallest and largest angular radius, in radians: 0.01 and 90 degrees.
const RADII: [f64; 2] = [0.01 * std::f64::consts::PI / 180.0, std::f64::consts::FRAC_PI_2];
/// Largest radiance.
const MAX_RADIANCE: f32 = 1.0e9;

/// A lamp far away. Its light adds to that of the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecimenLamp {
    /// Toward the middle, of length 1.
    pub direction: [f64; 3],
    /// The squared chord from the middle to the edge.
    pub reach: f64,
    /// Linear radiance, in the units of the sky map.
    pub radiance: [f32; 3],
}

impl SpecimenLamp {
    /// A lamp in the direction (sin yaw cos pitch, sin pitch, cos yaw cos pitch), as that of the camera: where the
    /// camera has yaw 0 and pitch 0, the lamp of yaw pi and pitch 0 is straight behind the drop. Angles in radians, `radius` 0.01
    /// to 90 degrees; `radiance` linear, in the units of the sky map, each 0 to 1e9.
    ///
    /// # Errors
    /// [`SpecimenError::OutOfRange`], naming the quantity.
    ///
    /// ```
    /// use downpour_specimen::SpecimenLamp;
    /// assert!(SpecimenLamp::new(3.0, 0.1, 0.02, [100.0, 90.0, 60.0]).is_ok());
    /// assert!(SpecimenLamp::new(3.0, 0.1, 0.0, [1.0; 3]).is_err());
    /// ```
    pub fn new(yaw: f64, pitch: f64, radius: f64, radiance: [f32; 3]) -> Result<Self, SpecimenError> {
        let [least, most] = [RADII[0] * (1.0 - 1.0e-9), RADII[1] * (1.0 + 1.0e-9)];
        let degrees = 1.0_f64.to_degrees();
        in_range("yaw of a lamp", yaw, "degrees", &(f64::MIN..=f64::MAX), 1.0, "a finite number")?;
        in_range("pitch of a lamp", pitch, "degrees", &(-most..=most), degrees, "-90 to 90")?;
        in_range("angular radius of a lamp", radius, "degrees", &(least..=most), degrees, "0.01 to 90")?;
        for color in radiance {
            let unit = "(units of the sky map)";
            in_range("radiance of a lamp", color, unit, &(0.0..=MAX_RADIANCE), 1.0, "0 to 1e9")?;
        }
        let chord = 2.0 * ops::sin(0.5 * radius);
        let level = ops::cos(pitch);
        let direction = [ops::sin(yaw) * level, ops::sin(pitch), ops::cos(yaw) * level];
        Ok(Self { direction, reach: chord * chord, radiance })
    }

    /// The angular radius, in radians.
    #[must_use]
    pub fn radius(&self) -> f64 {
        2.0 * ops::asin((0.5 * self.reach.sqrt()).min(1.0))
    }

    /// Squared sine of the angular radius: times pi and the radiance it is the irradiance of a surface that faces the lamp.
    pub(crate) fn sine_squared(&self) -> f64 {
        self.reach * (1.0 - 0.25 * self.reach)
    }

    /// Checks the number of lamps.
    ///
    /// # Errors
    /// [`SpecimenError::Size`] for more than 8.
    pub fn check_count(lamps: &[Self]) -> Result<(), SpecimenError> {
        let (found, most) = (lamps.len() as u64, SPECIMEN_LAMPS.into());
        if found > most {
            return Err(SpecimenError::Size { quantity: "number of lamps", found, min: 0, max: most });
        }
        Ok(())
    }
}

/// The radiance of one lamp in a direction of length 1.
#[inline]
#[must_use]
pub fn specimen_lamp<R: Real<Mask = bool>>(lamp: &SpecimenLamp, direction: [R; 3]) -> [R; 3] {
    let zero = direction[0].constant(0.0);
    let apart = sub(direction, lamp.direction.map(|c| zero.constant(c)));
    let met = dot(apart, apart).less(zero.constant(lamp.reach));
    lamp.radiance.map(|c| R::select(met, zero.constant(c.into()), zero))
}
