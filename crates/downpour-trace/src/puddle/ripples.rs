//! The ripples of rain on water, of all puddles: a lattice of the simulator, and its slopes in levels.

use downpour_drop::distribution::DropSizeDistribution;
use downpour_lattice::puddle::{Puddle, PuddleBorder, PuddleOptions, PuddleRain};
use downpour_math::pyramid::{PyramidRounding, pyramid_append, pyramid_levels};
use downpour_wind::Keyed;

use super::PuddleError;

/// Cells along an edge of the lattice: a power of two, so that each level has half of those of the one before.
const CELLS: u32 = 512;

/// Edge of a cell, m. Ripples of drops are longer than 8 mm.
const CELL_M: f32 = 2.5e-3;

/// Depth of the water for the speed of ripples, m.
const DEPTH_M: f32 = 8.0e-3;

/// Length of a step, s: rain is drawn for each.
const STEP_S: f64 = 5.0e-3;

/// Ripples older than this have gone, s.
const MEMORY_S: f64 = 2.5;

/// Steps with rain of one rate, where the rate changes: a quarter of a second.
const STEPS_OF_RATE: i64 = 50;

/// Ripples of water in the rain.
#[derive(Debug)]
pub struct Ripples {
    lattice: Puddle,
    rain: Option<PuddleRain>,
    changes: Option<Changes>,
    /// The step that has been made, counted from time 0.
    step: i64,
}

/// A rate that changes.
#[derive(Debug)]
struct Changes {
    heaviest: DropSizeDistribution,
    rates: Keyed<f64>,
    seed: u64,
    /// Number of the time, in [`STEPS_OF_RATE`], whose rain falls.
    number: Option<i64>,
}

impl Changes {
    /// Makes a rain that of a step: `None` in a dry time.
    fn follow(&mut self, step: i64, rain: &mut Option<PuddleRain>) -> Result<(), PuddleError> {
        let number = step.div_euclid(STEPS_OF_RATE);
        if self.number.replace(number) == Some(number) {
            return Ok(());
        }
        let middle_s = (number as f64 + 0.5) * STEPS_OF_RATE as f64 * STEP_S;
        let rate = self.rates.at(middle_s);
        *rain = None;
        if rate > 0.0 {
            let heaviest = &self.heaviest;
            let sizes = DropSizeDistribution::with_options(heaviest.law(), rate, heaviest.options())?;
            *rain = Some(PuddleRain::new(&sizes, self.seed));
        }
        Ok(())
    }
}

impl Ripples {
    /// Level water before a time in seconds, so long before that at that time ripples are as many as they will be.
    ///
    /// # Errors
    /// [`PuddleError`] if the lattice refuses.
    pub fn new(rain: Option<&DropSizeDistribution>, seed: u64, time_s: f64) -> Result<Self, PuddleError> {
        let lattice = level_water()?;
        let rain = rain.map(|rain| PuddleRain::new(rain, seed));
        Ok(Self { lattice, rain, changes: None, step: step_of(time_s - MEMORY_S) })
    }

    /// The same of a rain whose rate in mm/h changes; `heaviest` is that of the largest rate.
    ///
    /// # Errors
    /// As [`Ripples::new`].
    pub fn changing(
        heaviest: &DropSizeDistribution,
        rates_mm_h: &Keyed<f64>,
        seed: u64,
        time_s: f64,
    ) -> Result<Self, PuddleError> {
        let (heaviest, rates) = (heaviest.clone(), rates_mm_h.clone());
        let changes = Some(Changes { heaviest, rates, seed, number: None });
        Ok(Self { changes, ..Self::new(None, seed, time_s)? })
    }

    /// Steps the rain to a time in seconds. The ripples do not depend on the division of the time into parts of up to 5 s; a time
    /// longer after the last one begins anew with level water.
    ///
    /// # Errors
    /// As [`Ripples::new`].
    pub fn advance(&mut self, time_s: f64) -> Result<(), PuddleError> {
        if self.rain.is_none() && self.changes.is_none() {
            return Ok(());
        }
        let until = step_of(time_s);
        let anew = step_of(time_s - 2.0 * MEMORY_S);
        if self.step < anew {
            self.lattice = level_water()?;
            self.step = anew;
        }
        let extent = self.lattice.extent_m();
        while self.step < until {
            if let Some(changes) = &mut self.changes {
                changes.follow(self.step, &mut self.rain)?;
            }
            if let Some(rain) = &self.rain {
                self.lattice.seed(&rain.impacts(extent, self.step as u64, STEP_S as f32)?)?;
            }
            self.lattice.step(STEP_S as f32)?;
            self.step += 1;
        }
        Ok(())
    }

    /// Cells along an edge of the finest level, the number of levels, and the edge of a cell (m).
    #[must_use]
    pub fn shape(&self) -> (u32, u32, f32) {
        (CELLS, CELLS.ilog2(), CELL_M)
    }

    /// Slopes along the lattice's axes, and the mean of the square of the slope, of all levels, the finest first.
    #[must_use]
    pub fn slopes(&self) -> Vec<[f32; 4]> {
        let finest = self.lattice.normals().into_iter().map(|[x, y, z]| {
            let [sx, sz] = [-x / y.max(1.0e-3), -z / y.max(1.0e-3)];
            [sx, sz, sx * sx + sz * sz, 0.0]
        });
        slope_levels(finest.collect(), CELLS as usize)
    }
}

fn level_water() -> Result<Puddle, PuddleError> {
    Ok(Puddle::new(&PuddleOptions {
        size: [CELLS; 2],
        cell_m: CELL_M,
        depth_m: DEPTH_M,
        border: PuddleBorder::Open,
        ..PuddleOptions::default()
    })?)
}

/// A square of texels, `size` (a power of two) each way, with all levels that are means of four of the one before, down to
/// two by two: what [`PuddleRows`](super::PuddleRows) takes.
#[must_use]
pub fn slope_levels(mut texels: Vec<[f32; 4]>, size: usize) -> Vec<[f32; 4]> {
    let levels = pyramid_levels([size as u32; 2], PyramidRounding::Down);
    for level in levels.iter().filter(|level| level.size[0] > 1) {
        pyramid_append(&mut texels, level);
    }
    texels
}

/// The number of the step that ends at or before a time, from time 0.
fn step_of(time_s: f64) -> i64 {
    (time_s / STEP_S + 1.0e-6).floor() as i64
}
