//! Options of a pane.

use downpour_drop::air::Air;
use downpour_drop::distribution::{DistributionOptions, DropSizeLaw};
use downpour_drop::fall_speed::FallSpeedModel;
use downpour_math::in_range;

use super::contact::GlassContact;
use super::error::GlassError;
use super::wiper::GlassWiper;

/// Range of the number of cells along an edge.
const EDGE: std::ops::RangeInclusive<u32> = 8..=4096;

/// Rain on the pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassRain {
    /// Rate on level ground, mm/h: 0 to 500.
    pub rate_mm_h: f64,
    /// Drop size distribution.
    pub law: DropSizeLaw,
    /// Smallest and largest diameter of the distribution, m. Drops from 0.2 to 7.5 mm land.
    pub diameters_m: [f64; 2],
    /// Model of terminal speed.
    pub fall_speed: FallSpeedModel,
    /// Air that the rain falls through: temperature and pressure determine the fall speed.
    pub air: Air,
    /// Horizontal speed of the air with the rain toward the pane, m/s: the car's speed, or the wind on a window. 0 to
    /// 100. At 0 no rain reaches a vertical pane.
    pub towards_m_s: f64,
}

impl Default for GlassRain {
    /// No rain.
    fn default() -> Self {
        let drops = DistributionOptions::default();
        Self {
            rate_mm_h: 0.0,
            law: DropSizeLaw::default(),
            diameters_m: [drops.min_diameter_m, drops.max_diameter_m],
            fall_speed: drops.fall_speed,
            air: drops.air,
            towards_m_s: 0.0,
        }
    }
}

/// Air that flows along the pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassAir {
    /// Speed along the pane, m/s: 0 to 100.
    pub speed_m_s: f64,
    /// Direction along the pane, radians from +x toward the top: pi/2 is up, as over a windshield.
    pub direction_rad: f64,
    /// Drag coefficient of a drop for the speed far from the pane; it includes the effect of the boundary layer: 0 to
    /// 2.
    pub drag: f64,
}

impl Default for GlassAir {
    /// Still air.
    fn default() -> Self {
        Self { speed_m_s: 0.0, direction_rad: std::f64::consts::FRAC_PI_2, drag: 0.5 }
    }
}

/// Beads that a running drop leaves behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassTrail {
    /// Mean distance between beads, m: 1e-4 to 1; infinite for none.
    pub spacing_m: f64,
    /// Diameter of the sphere with a bead's mean volume, m: 0 to 2e-3.
    pub bead_m: f64,
}

impl Default for GlassTrail {
    fn default() -> Self {
        Self { spacing_m: 3.0e-3, bead_m: 0.55e-3 }
    }
}

/// Difference between wet and dry glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassWetting {
    /// Time that glass stays wet, s: 0.1 to 3600.
    pub life_s: f64,
    /// Fraction by which fresh wetness reduces the friction, 0 to 1.
    pub ease: f64,
    /// Attraction of drops by wetness, 0 to 4: with 1, wet glass is twice as likely as dry.
    pub pull: f64,
    /// Mean time in which the film behind a blade dries, s: 0.05 to 3600; infinite for never. It breaks into droplets finer than a
    /// unit of mass: cells of one or two units stand for several of them.
    pub film_life_s: f64,
}

impl Default for GlassWetting {
    fn default() -> Self {
        Self { life_s: 20.0, ease: 0.35, pull: 1.5, film_life_s: 0.7 }
    }
}

/// Texture with a number per cell of the pane.
#[derive(Clone, Debug, PartialEq)]
pub enum GlassTexture {
    /// The same everywhere.
    Even,
    /// Smooth noise from the seed, as on a pane that is not quite clean.
    Noise {
        /// Width of the largest spots, m: 1e-4 to 1.
        spot_m: f64,
        /// Amplitude as a fraction of the range, 0 to 1.
        amplitude: f64,
    },
    /// Given row by row from the top.
    Given(Vec<f32>),
}

/// Options of a pane of glass.
#[derive(Clone, Debug, PartialEq)]
pub struct GlassOptions {
    /// Number of cells along x (right) and y (down): 8 to 4096 each.
    pub size: [u32; 2],
    /// Edge of a cell, m: 0.25e-3 to 5e-3. Drops should be wider than a cell: 0.6e-3 is good.
    pub cell_m: f64,
    /// Tilt from the horizontal, rad: 0 to pi/2, a window.
    pub tilt_rad: f64,
    /// Contact angles.
    pub contact: GlassContact,
    /// Temperature of the water, Celsius: -20 to 40.
    pub temperature_c: f64,
    /// Rain.
    pub rain: GlassRain,
    /// Air along the pane.
    pub air: GlassAir,
    /// Trails.
    pub trail: GlassTrail,
    /// Wet glass.
    pub wetting: GlassWetting,
    /// Affinity of the glass for water: 0 repels, 1 attracts.
    pub affinity: GlassTexture,
    /// Attraction of drops by affinity, 0 to 4.
    pub affinity_pull: f64,
    /// Friction of the glass as a multiple of Furmidge's: 0 to 1.99. Noise is centered at 1, with its amplitude.
    pub friction: GlassTexture,
    /// Cells that cannot hold water, row by row from the top.
    pub obstacles: Option<Vec<bool>>,
    /// Evaporation as depth of water over the wetted area, mm/h: 0 to 100.
    pub evaporation_mm_h: f64,
    /// Wipers.
    pub wipers: Vec<GlassWiper>,
    /// Maximum speed of drops, m/s: 0.01 to 5. It determines the length of a tick: a drop moves by at most a cell.
    pub speed_limit_m_s: f64,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Default for GlassOptions {
    /// A dry vertical window of 256 x 256 cells of 0.6 mm.
    fn default() -> Self {
        Self {
            size: [256, 256],
            cell_m: 0.6e-3,
            tilt_rad: std::f64::consts::FRAC_PI_2,
            contact: GlassContact::default(),
            temperature_c: 20.0,
            rain: GlassRain::default(),
            air: GlassAir::default(),
            trail: GlassTrail::default(),
            wetting: GlassWetting::default(),
            affinity: GlassTexture::Noise { spot_m: 8.0e-3, amplitude: 1.0 },
            affinity_pull: 1.0,
            friction: GlassTexture::Noise { spot_m: 12.0e-3, amplitude: 0.35 },
            obstacles: None,
            evaporation_mm_h: 0.0,
            wipers: Vec::new(),
            speed_limit_m_s: 0.3,
            seed: 0,
        }
    }
}

impl GlassOptions {
    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Checks that all numbers are in their ranges.
    ///
    /// # Errors
    /// [`GlassError`] that names the first number out of range.
    pub fn check(&self) -> Result<(), GlassError> {
        for (quantity, edge) in ["columns of the pane", "rows of the pane"].into_iter().zip(self.size) {
            in_range(quantity, edge, "cells", &EDGE, 1.0, "8 to 4096")?;
        }
        let degrees = 180.0 / std::f64::consts::PI;
        in_range("edge of a cell", self.cell_m, "mm", &(0.25e-3..=5.0e-3), 1.0e3, "0.25 to 5")?;
        in_range("tilt", self.tilt_rad, "degrees", &(0.0..=std::f64::consts::FRAC_PI_2), degrees, "0 to 90")?;
        self.contact.check()?;
        in_range("temperature", self.temperature_c, "C", &(-20.0..=40.0), 1.0, "-20 to 40")?;
        in_range("rain rate", self.rain.rate_mm_h, "mm/h", &(0.0..=500.0), 1.0, "0 to 500")?;
        in_range("speed of the rain's air", self.rain.towards_m_s, "m/s", &(0.0..=100.0), 1.0, "0 to 100")?;
        in_range("air speed", self.air.speed_m_s, "m/s", &(0.0..=100.0), 1.0, "0 to 100")?;
        in_range("air direction", self.air.direction_rad, "rad", &(-10.0..=10.0), 1.0, "-10 to 10")?;
        in_range("drag coefficient", self.air.drag, "", &(0.0..=2.0), 1.0, "0 to 2")?;
        if self.trail.spacing_m != f64::INFINITY {
            in_range("spacing of beads", self.trail.spacing_m, "mm", &(1.0e-4..=1.0), 1.0e3, "0.1 to 1000")?;
        }
        in_range("diameter of beads", self.trail.bead_m, "mm", &(0.0..=2.0e-3), 1.0e3, "0 to 2")?;
        in_range("life of wetness", self.wetting.life_s, "s", &(0.1..=3600.0), 1.0, "0.1 to 3600")?;
        in_range("ease of wet glass", self.wetting.ease, "", &(0.0..=1.0), 1.0, "0 to 1")?;
        in_range("pull of wet glass", self.wetting.pull, "", &(0.0..=4.0), 1.0, "0 to 4")?;
        if self.wetting.film_life_s != f64::INFINITY {
            in_range("life of a film", self.wetting.film_life_s, "s", &(0.05..=3600.0), 1.0, "0.05 to 3600")?;
        }
        in_range("pull of affinity", self.affinity_pull, "", &(0.0..=4.0), 1.0, "0 to 4")?;
        in_range("evaporation", self.evaporation_mm_h, "mm/h", &(0.0..=100.0), 1.0, "0 to 100")?;
        in_range("speed limit", self.speed_limit_m_s, "m/s", &(0.01..=5.0), 1.0, "0.01 to 5")?;
        for (index, wiper) in self.wipers.iter().enumerate() {
            wiper.check(index, self)?;
        }
        Ok(())
    }
}
