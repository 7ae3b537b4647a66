//! Options of a simulation: its volume, number of drops, drag and bounces.

use crate::SimError;
use crate::step::StepCaught;
use downpour_math::in_range;

/// Number of drops of one work item.
pub(crate) const PIECE: usize = 1 << 14;

/// Maximum number of drops that a word can number.
pub(crate) const MAX_DROPS: u64 = 1 << 30;

/// Maximum number of drops in memory: 8.5 GiB of them.
pub(crate) const MAX_DROPS_IN_MEMORY: u64 = 1 << 28;

/// The part of space that is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum SimVolume {
    /// The view of the picture while the shutter is open, each size up to the distance at which it is resolved (after
    /// Im & Sung 2022, 3.A and B, with the density of the rain): drops enter from the surrounding rain, and are gone
    /// when they leave or hit something.
    #[default]
    View,
    /// A periodic box that follows eye and view (Rousseau 2006, 7). Edges 1 to 1000 m.
    Box {
        /// Edges, m.
        size_m: [f64; 3],
    },
    /// The view of Im & Sung 2022 with their sampling: dense near the middle, and random again after each exit.
    ImSung,
    /// A box around the eye; drops start at its top, wherever the eye is then (after S. Tariq, "Rain", 2007, as Im &
    /// Sung compare with it). Edges 1 to 1000 m.
    Tariq {
        /// Edges, m.
        size_m: [f64; 3],
    },
    /// An upright cylinder, fixed in the world (after C. Creus and G. Patow, "R4: realistic rain rendering in
    /// realtime", 2013, as Im & Sung compare with it).
    Cylinder {
        /// Center of the base, m.
        base_m: [f64; 3],
        /// Radius, 0.5 to 1000 m.
        radius_m: f64,
        /// Height, 1 to 1000 m.
        height_m: f64,
    },
}

/// Response of drops to the wind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Drag {
    /// The slip relaxes with v / g across the fall and v / 2g along it.
    #[default]
    Relaxation,
    /// Each step halves the difference to the wind (Rousseau 2008, 5.1.2): depends on the frame rate.
    Rousseau2008,
}

/// Rebound of drops that hit a surface.
///
/// By default a tenth of the impacts produce a droplet, of which the papers say little: "a low-motion quasi-spherical
/// refractive drop". 1 for `fraction` is Rousseau 2008.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounce {
    /// Fraction of impacts that rebound, 0 to 1.
    pub fraction: f32,
    /// Fraction of the normal speed that is reflected, 0 to 1.
    pub restitution: f32,
    /// Fraction of the tangential speed that is lost, 0 to 1.
    pub grip: f32,
    /// Diameter of the droplet relative to that of the drop, 0.05 to 1.
    pub size: f32,
    /// Maximum time of the droplet, 0.01 to 10 s.
    pub max_time_s: f32,
}

impl Default for Bounce {
    fn default() -> Self {
        Self { fraction: 0.1, restitution: 0.25, grip: 0.7, size: 0.25, max_time_s: 1.0 }
    }
}

/// A horizontal rectangle that measures the rain through it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gauge {
    /// Height, m.
    pub height_m: f64,
    /// Lower x and z, m.
    pub low_m: [f64; 2],
    /// Upper x and z, m.
    pub high_m: [f64; 2],
}

impl Gauge {
    /// Rate, mm/h, of a volume in units of [`StepCaught`] that was caught in a time.
    #[must_use]
    pub fn rate_mm_h(&self, caught: &StepCaught, time_s: f64) -> f64 {
        let area = (self.high_m[0] - self.low_m[0]) * (self.high_m[1] - self.low_m[1]);
        caught.volume as f64 * 1.0e-13 / (area * time_s) * 3.6e6
    }
}

/// Options of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulationOptions {
    /// Simulated volume.
    pub volume: SimVolume,
    /// Random seed; the same seed gives the same drops.
    pub seed: u64,
    /// Maximum expected number of drops, 1 to 2^28. A view leaves out drops that are small on the picture, other
    /// volumes small drops.
    pub max_drops: u32,
    /// Number of the first step: steps of the same number draw the same random numbers.
    pub first_step: u32,
    /// Maximum exposure of a picture, s, 0 to 10; for a view.
    pub shutter_s: f64,
    /// Maximum time from a state to the opening of the shutter of a picture of it, s, 0 to 1; for a view.
    pub wait_s: f64,
    /// Age at which a drop is removed from a view, 0.1 to 1000 s: only a few in an updraft reach it.
    pub oldest_s: f64,
    /// Response of drops to the wind.
    pub drag: Drag,
    /// Rebound of drops that hit a surface.
    pub bounce: Bounce,
    /// Maximum number of impacts recorded per step; the others are only counted.
    pub max_events: u32,
    /// Maximum number of impacts of 1/60 s (or of a longer step) that are kept for the splashes of pictures, 0 to 2^17; 0: there are no
    /// splashes. The CPU keeps all of them unless there are none.
    pub max_kept: u32,
    /// Rain gauge.
    pub gauge: Option<Gauge>,
}

impl Default for SimulationOptions {
    /// Two million drops in view; 65 536 impacts per step, of which 32 768 may splash.
    fn default() -> Self {
        Self {
            volume: SimVolume::View,
            seed: 0,
            max_drops: 2_000_000,
            first_step: 0,
            shutter_s: 0.0,
            wait_s: 0.0,
            oldest_s: 30.0,
            drag: Drag::Relaxation,
            bounce: Bounce::default(),
            max_events: 1 << 16,
            max_kept: 1 << 15,
            gauge: None,
        }
    }
}

impl SimulationOptions {
    /// Time that pictures of one state cover, s.
    pub(crate) fn horizon_s(&self) -> f64 {
        self.shutter_s + self.wait_s
    }

    pub(crate) fn check(&self) -> Result<(), SimError> {
        match self.volume {
            SimVolume::Box { size_m } | SimVolume::Tariq { size_m } => {
                for edge in size_m {
                    in_range("edge of the rain box", edge, "m", &(1.0..=1000.0), 1.0, "1 to 1000")?;
                }
            }
            SimVolume::Cylinder { base_m, radius_m, height_m } => {
                for position in base_m {
                    in_range(
                        "position of the rain cylinder",
                        position,
                        "m",
                        &(-1.0e7..=1.0e7),
                        1.0,
                        "-1e7 to 1e7",
                    )?;
                }
                in_range("radius of the rain cylinder", radius_m, "m", &(0.5..=1000.0), 1.0, "0.5 to 1000")?;
                in_range("height of the rain cylinder", height_m, "m", &(1.0..=1000.0), 1.0, "1 to 1000")?;
            }
            SimVolume::View | SimVolume::ImSung => {}
        }
        in_range("most drops", f64::from(self.max_drops), "", &(1.0..=MAX_DROPS as f64), 1.0, "1 to 2^30")?;
        if u64::from(self.max_drops) > MAX_DROPS_IN_MEMORY {
            return Err(SimError::memory(self.max_drops.into()));
        }
        in_range("most impacts kept", f64::from(self.max_kept), "", &(0.0..=131_072.0), 1.0, "0 to 2^17")?;
        in_range("time of the shutter", self.shutter_s, "s", &(0.0..=10.0), 1.0, "0 to 10")?;
        in_range(
            "time from a state to the shutter's opening",
            self.wait_s,
            "s",
            &(0.0..=1.0),
            1.0,
            "0 to 1",
        )?;
        in_range("time of a drop in view", self.oldest_s, "s", &(0.1..=1000.0), 1.0, "0.1 to 1000")?;
        let Bounce { fraction, restitution, grip, size, max_time_s } = self.bounce;
        in_range("fraction of impacts that bounce", f64::from(fraction), "", &(0.0..=1.0), 1.0, "0 to 1")?;
        in_range("restitution", f64::from(restitution), "", &(0.0..=1.0), 1.0, "0 to 1")?;
        in_range("grip", f64::from(grip), "", &(0.0..=1.0), 1.0, "0 to 1")?;
        in_range("size of a bounced drop", f64::from(size), "", &(0.05 - 1.0e-6..=1.0), 1.0, "0.05 to 1")?;
        in_range(
            "time of a bounced drop",
            f64::from(max_time_s),
            "s",
            &(0.01 - 1.0e-6..=10.0),
            1.0,
            "0.01 to 10",
        )?;
        if let Some(Gauge { height_m, low_m, high_m }) = self.gauge {
            for position in [height_m, low_m[0], low_m[1], high_m[0], high_m[1]] {
                in_range("position of the gauge", position, "m", &(-1.0e7..=1.0e7), 1.0, "-1e7 to 1e7")?;
            }
            let edge = (high_m[0] - low_m[0]).min(high_m[1] - low_m[1]);
            in_range("edge of the gauge", edge, "m", &(1.0e-3..=1.0e4), 1.0, "0.001 to 1e4")?;
        }
        Ok(())
    }
}
