//! Direction from which a drop is seen.

use downpour_math::in_range;
use downpour_math::ops;

use crate::MaskError;

/// The direction of the viewer relative to the drop's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    elevation: f64,
}

impl View {
    /// The viewer level with the drop.
    pub const SIDE: Self = Self { elevation: 0.0 };

    /// View from `elevation` radians above the drop's horizon: pi/2 looks straight down on it, -pi/2 straight up.
    ///
    /// # Errors
    /// [`MaskError::OutOfRange`] outside [-pi/2, pi/2] or if not finite.
    pub fn from_elevation(elevation: f64) -> Result<Self, MaskError> {
        let most = std::f64::consts::FRAC_PI_2 + 1.0e-12;
        let degrees = 1.0_f64.to_degrees();
        in_range("view elevation", elevation, "degrees", &(-most..=most), degrees, "-90 to 90")?;
        Ok(Self { elevation })
    }

    /// The elevation in radians.
    #[must_use]
    pub fn elevation(self) -> f64 {
        self.elevation
    }

    /// The drop's upward axis in the frame of the view (x right, y up, z toward the viewer).
    ///
    /// ```
    /// use downpour_mask::View;
    /// assert_eq!(View::SIDE.up(), [0.0, 1.0, 0.0]);
    /// let above = View::from_elevation(std::f64::consts::FRAC_PI_2)?;
    /// assert!((above.up()[2] - 1.0).abs() < 1e-15); // the top of the drop faces the viewer
    /// # Ok::<(), downpour_mask::MaskError>(())
    /// ```
    #[must_use]
    pub fn up(self) -> [f64; 3] {
        [0.0, ops::f64::cos(self.elevation), ops::f64::sin(self.elevation)]
    }
}
