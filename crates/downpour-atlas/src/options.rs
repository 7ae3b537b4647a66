//! Options of an atlas.

use downpour_drop::optics::WATER_INDEX;
use downpour_drop::oscillation::Amplitudes;
use downpour_math::in_range;

use crate::AtlasError;

/// An oscillation of the atlas: amplitudes and phases of the two modes and azimuth to the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreakOscillation {
    /// Of the modes (2,0) and (3,1), over the radius.
    pub amplitudes: [f64; 2],
    /// Phase of the mode (3,1) at phase 0 of (2,0), in turns.
    pub phase: f64,
    /// Angle of the lobes of the mode (3,1) about the axis, in radians; 0: in the plane of the picture.
    pub azimuth: f64,
}

impl StreakOscillation {
    /// A drop at rest.
    pub const NONE: Self = Self { amplitudes: [0.0, 0.0], phase: 0.0, azimuth: 0.0 };

    /// The four of the committed atlas: both pairs of Garg & Nayar 2006, each at two phases and azimuths.
    pub const COMMITTED: [Self; 4] = [
        Self { amplitudes: [0.1, 0.1], phase: 0.0, azimuth: 0.5 },
        Self { amplitudes: [0.2, 0.1], phase: 0.15, azimuth: -0.7 },
        Self { amplitudes: [0.1, 0.1], phase: 0.35, azimuth: 2.3 },
        Self { amplitudes: [0.2, 0.1], phase: 0.65, azimuth: 1.2 },
    ];

    pub(crate) fn amplitudes(&self) -> Result<Amplitudes, AtlasError> {
        Ok(Amplitudes::new(self.amplitudes[0], self.amplitudes[1])?)
    }
}

/// Options of the tracer of streaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreakOptions {
    /// Texels across: 2 to 256, even.
    pub columns: u32,
    /// Texels along one turn of the mode (2,0): 1 to 4096.
    pub rows: u32,
    /// Rays along an edge of a texel's width: 1 to 64.
    pub rays: u32,
    /// Half of the width of a streak in equivalent radii. The drops of Garg and Nayar stay within 1.4.
    pub half_extent: f64,
    /// Angular radius of the light, in radians.
    pub light_radius: f64,
    /// Refractive index of water relative to air.
    pub refractive_index: f64,
}

impl Default for StreakOptions {
    fn default() -> Self {
        Self {
            columns: 24,
            rows: 64,
            rays: 5,
            half_extent: 1.4,
            light_radius: 8.0_f64.to_radians(),
            refractive_index: WATER_INDEX,
        }
    }
}

impl StreakOptions {
    pub(crate) fn check(&self) -> Result<(), AtlasError> {
        let even = if self.columns.is_multiple_of(2) { f64::from(self.columns) } else { f64::NAN };
        in_range("columns of a streak", even, "texels", &(2.0..=256.0), 1.0, "2 to 256, even")?;
        in_range("rows of a streak", self.rows, "texels", &(1..=4096), 1.0, "1 to 4096")?;
        in_range("rays of a texel", self.rays, "along an edge", &(1..=64), 1.0, "1 to 64")?;
        in_range("half extent of a streak", self.half_extent, "radii", &(0.5..=4.0), 1.0, "0.5 to 4")?;
        in_range(
            "radius of the light",
            self.light_radius.to_degrees(),
            "degrees",
            &(0.5..=60.0),
            1.0,
            "0.5 to 60",
        )?;
        in_range("refractive index", self.refractive_index, "", &(1.01..=3.0), 1.0, "1.01 to 3")?;
        Ok(())
    }
}
