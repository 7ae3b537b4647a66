//! Options of a specimen's picture.

use downpour_drop::DropShape;
use downpour_drop::optics::WATER_INDEX;
use downpour_drop::oscillation::Amplitudes;
use downpour_math::ops::f64 as ops;
use downpour_math::{OutOfRange, in_range};
pub use downpour_render::camera::MAX_EXPOSURE_S;
use downpour_shaders::render::specimen::{SPECIMEN_SAMPLES, SPECIMEN_STREAK_INSTANTS};

use super::SpecimenError;
use super::camera::{bounding_radius, default_fov, path_fov};
use super::motion::{SpecimenMotion, fall_speed};

/// Maximum width and height of a picture, in pixels.
pub const MAX_SIZE: u32 = 16_384;

const MAX_DISTANCE_M: f64 = 1000.0;
pub(crate) const MAX_FOV_DEG: f64 = 175.0;
const MAX_INDEX: f64 = 4.0;

/// The camera, the picture and the water. By default the drop fills 80 % of the height from 0.1 m, seen level from
/// +Z, in 960 x 540 pixels of 4 x 4 samples.
///
/// A raindrop above 4 mm is so much wider than high that 80 % of the height do not fit into a square picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecimenOptions {
    /// Distance of the camera from the drop's origin, in meters: outside the drop, up to 1000.
    pub distance_m: f64,
    /// Azimuth of the camera in radians, from +Z toward +X.
    pub yaw: f64,
    /// Elevation of the camera above the drop's horizon in radians, -pi/2 to pi/2.
    pub pitch: f64,
    /// Vertical field of view in radians, above 0 and up to 175 degrees; `None` for [`default_fov`].
    pub fov: Option<f64>,
    /// Width and height of the picture in pixels, each 1 to [`MAX_SIZE`].
    pub size: [u32; 2],
    /// Samples along an edge of a pixel, 1 to 16: a pixel is the mean of the square of it. Lines of samples are shifted
    /// against each other.
    pub samples: u32,
    /// Refractive index of water against air for red, green and blue, each 1 to 4. Three different ones take three
    /// times as long (`downpour_drop::optics::rgb_indices` has those of real water).
    pub refractive_index: [f64; 3],
    /// Exposure in seconds, 0 to [`MAX_EXPOSURE_S`]: the drop falls at its terminal speed and
    /// is at the origin at mid-exposure.
    pub exposure_s: f64,
    /// Instants for each sample of a pixel, 1 to 4096, spread over the time in which the drop may cover it.
    pub instants: u32,
    /// Amplitudes of the oscillation about the shape at rest.
    pub oscillation: Amplitudes,
    /// Phases of the modes (2,0) and (3,1) at mid-exposure, in turns: any finite numbers.
    pub phase: [f64; 2],
}

impl Default for SpecimenOptions {
    fn default() -> Self {
        Self {
            distance_m: 0.1,
            yaw: 0.0,
            pitch: 0.0,
            fov: None,
            size: [960, 540],
            samples: 4,
            refractive_index: [WATER_INDEX; 3],
            exposure_s: 0.0,
            instants: 4,
            oscillation: Amplitudes::NONE,
            phase: [0.0; 2],
        }
    }
}

impl SpecimenOptions {
    /// Checks the options for a drop.
    ///
    /// # Errors
    /// [`SpecimenError::OutOfRange`] or [`SpecimenError::Size`], naming the option.
    pub fn check(&self, shape: &DropShape) -> Result<(), SpecimenError> {
        let degrees = 1.0_f64.to_degrees();
        let nearest = bounding_radius(shape);
        if !(self.distance_m > nearest && self.distance_m <= MAX_DISTANCE_M) {
            return Err(SpecimenError::OutOfRange(OutOfRange {
                quantity: "camera distance",
                found: self.distance_m,
                unit: "m",
                allowed: format!("above {nearest:.6} (outside the drop), up to {MAX_DISTANCE_M}").into(),
            }));
        }
        in_range("camera yaw", self.yaw, "degrees", &(f64::MIN..=f64::MAX), degrees, "a finite number")?;
        let quarter = std::f64::consts::FRAC_PI_2 * (1.0 + 1.0e-9);
        in_range("camera pitch", self.pitch, "degrees", &(-quarter..=quarter), degrees, "-90 to 90")?;
        if let Some(fov) = self.fov {
            let most = MAX_FOV_DEG.to_radians() * (1.0 + 1.0e-9);
            in_range(
                "field of view",
                fov,
                "degrees",
                &(f64::MIN_POSITIVE..=most),
                degrees,
                "above 0, up to 175",
            )?;
        }
        for index in self.refractive_index {
            in_range("refractive index", index, "(no unit)", &(1.0..=MAX_INDEX), 1.0, "1 to 4")?;
        }
        let size = |quantity, found: u32, most: u32| {
            if (1..=most).contains(&found) {
                return Ok(());
            }
            Err(SpecimenError::Size { quantity, found: found.into(), min: 1, max: most.into() })
        };
        size("picture width", self.size[0], MAX_SIZE)?;
        size("picture height", self.size[1], MAX_SIZE)?;
        size("samples along an edge of a pixel", self.samples, SPECIMEN_SAMPLES)?;
        size("instants of an exposure", self.instants, SPECIMEN_STREAK_INSTANTS)?;
        in_range("exposure", self.exposure_s, "s", &(0.0..=MAX_EXPOSURE_S), 1.0, "0 to 1")?;
        for turns in self.phase {
            in_range(
                "phase of the oscillation",
                turns,
                "turns",
                &(f64::MIN..=f64::MAX),
                1.0,
                "a finite number",
            )?;
        }
        self.check_path(shape)
    }

    /// Checks that the path of the drop does not meet the camera.
    fn check_path(&self, shape: &DropShape) -> Result<(), SpecimenError> {
        let Some(motion) = SpecimenMotion::of(shape, self)? else { return Ok(()) };
        let (sin, cos) = (ops::sin(self.pitch), ops::cos(self.pitch));
        let height = self.distance_m * sin;
        let beyond = height - height.clamp(-self.half_path(shape)?, self.half_path(shape)?);
        let (found, nearest) = (ops::hypot(self.distance_m * cos, beyond), motion.bounding_radius());
        if found > nearest {
            return Ok(());
        }
        Err(SpecimenError::OutOfRange(OutOfRange {
            quantity: "distance of the camera from the path of the drop",
            found,
            unit: "m",
            allowed: format!("above {nearest:.6}").into(),
        }))
    }

    /// Fall in half of the exposure, in meters.
    pub(crate) fn half_path(&self, shape: &DropShape) -> Result<f64, SpecimenError> {
        Ok(0.5 * self.exposure_s * fall_speed(shape)?)
    }

    /// True if the picture is that of a streak: the drop moves, or its shape is not that at rest.
    #[must_use]
    pub fn is_streak(&self) -> bool {
        self.exposure_s > 0.0 || self.oscillation != Amplitudes::NONE
    }

    /// Motion of the drop during the exposure; `None` for a drop at rest.
    ///
    /// # Errors
    /// As [`SpecimenOptions::check`].
    pub fn motion(&self, shape: &DropShape) -> Result<Option<SpecimenMotion>, SpecimenError> {
        self.check(shape)?;
        SpecimenMotion::of(shape, self)
    }

    /// The vertical field of view in radians: the one given, or that in which the drop, or all of its path in the
    /// exposure, fills 80 % of the height, but at most 175 degrees.
    ///
    /// # Errors
    /// As [`default_fov`].
    pub fn fov(&self, shape: &DropShape) -> Result<f64, SpecimenError> {
        match self.fov {
            Some(fov) => Ok(fov),
            None if self.exposure_s > 0.0 => {
                path_fov(shape, self.distance_m, self.pitch, self.half_path(shape)?)
            }
            None => default_fov(shape, self.distance_m, self.pitch),
        }
    }
}
