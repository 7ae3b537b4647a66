//! Ripples of rain on the water of all puddles: a lattice, and its slopes in levels. On a device both stay there.

use std::sync::Arc;

use downpour_drop::distribution::DropSizeDistribution;
use downpour_lattice::LatticeError;
#[cfg(feature = "wgpu")]
use downpour_lattice::gpu::puddle::{GpuPuddle, PuddleKernels};
use downpour_lattice::puddle::{
    Impact, Puddle, PuddleBorder, PuddleForm, PuddleOptions, PuddleRain, slope_levels as levels_below,
};
use downpour_math::pyramid::pyramid_append;
use downpour_wind::Keyed;

use super::PuddleError;
#[cfg(feature = "wgpu")]
use super::craters_ahead::{CratersAhead, finished};

/// Cells along an edge of the lattice: a power of two, so that each level has half of those of the one before.
const CELLS: u32 = 512;

/// Edge of a cell, m. Ripples of drops are longer than 8 mm.
const CELL_M: f32 = 2.5e-3;

/// Depth of the water for the speed of ripples, m.
const DEPTH_M: f32 = 8.0e-3;

/// Length of a step, s: rain is drawn for each.
const STEP_S: f64 = 5.0e-3;

/// Ripples older than this have gone, s.
pub(super) const MEMORY_S: f64 = 2.5;

/// Steps after those of a picture whose craters are made beside it, at most.
#[cfg(feature = "wgpu")]
const MAX_AHEAD: i64 = 16;

/// Steps that a device gets in one submission.
#[cfg(feature = "wgpu")]
const STEPS_TOGETHER: i64 = 50;

/// Part of the kinetic energy of a rain that its smallest drops bring, which make no waves.
const WEAKEST_PART: f64 = 0.01;

/// Steps with rain of one rate, where the rate changes: a quarter of a second.
const STEPS_OF_RATE: i64 = 50;

/// Ripples of water in the rain.
#[derive(Debug)]
pub struct Ripples {
    lattice: Lattice,
    form: PuddleForm,
    /// True if nothing has fallen since the water was level: steps leave it so.
    is_level: bool,
    rain: Option<Arc<PuddleRain>>,
    changes: Option<Changes>,
    /// Number of the last step, counted from time 0.
    step: i64,
}

/// The lattice, on the CPU or on a device.
#[derive(Debug)]
enum Lattice {
    Cpu(Box<Puddle>),
    #[cfg(feature = "wgpu")]
    Gpu {
        lattice: Box<GpuPuddle>,
        /// Bytes that the lattice had uploaded when its slopes were last asked for.
        counted: std::cell::Cell<u64>,
        /// Craters of the next steps.
        ahead: CratersAhead,
    },
}

impl Lattice {
    fn set_level(&mut self, form: PuddleForm) -> Result<(), PuddleError> {
        match self {
            Self::Cpu(lattice) => **lattice = Puddle::new(&options(form))?,
            #[cfg(feature = "wgpu")]
            Self::Gpu { lattice, .. } => lattice.set_level()?,
        }
        Ok(())
    }
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
    fn follow(&mut self, step: i64, rain: &mut Option<Arc<PuddleRain>>) -> Result<(), PuddleError> {
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
            *rain = Some(Arc::new(rain_on_water(&sizes, self.seed)));
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
        let form = PuddleForm::GravityCapillary;
        let lattice = Lattice::Cpu(Box::new(Puddle::new(&options(form))?));
        let rain = rain.map(|rain| Arc::new(rain_on_water(rain, seed)));
        Ok(Self { lattice, form, is_level: true, rain, changes: None, step: step_of(time_s - MEMORY_S) })
    }

    /// The same with waves of another law, beginning with level water.
    ///
    /// # Errors
    /// As [`Ripples::new`].
    pub fn with_form(mut self, form: PuddleForm) -> Result<Self, PuddleError> {
        self.form = form;
        self.lattice = Lattice::Cpu(Box::new(Puddle::new(&options(form))?));
        self.is_level = true;
        Ok(self)
    }

    /// Holds and steps the lattice on a device from now on, beginning with level water. After an error it stays where it is.
    ///
    /// # Errors
    /// [`PuddleError::Gpu`]: what the device says.
    #[cfg(feature = "wgpu")]
    pub fn move_to_device(&mut self, kernels: &PuddleKernels) -> Result<(), PuddleError> {
        let lattice = Box::new(GpuPuddle::with_kernels(kernels, &options(self.form))?);
        let ahead = CratersAhead::new(lattice.crater_maker());
        self.lattice = Lattice::Gpu { lattice, counted: std::cell::Cell::default(), ahead };
        self.is_level = true;
        Ok(())
    }

    /// True if a device holds the lattice.
    #[must_use]
    pub fn is_on_device(&self) -> bool {
        !matches!(self.lattice, Lattice::Cpu(_))
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
            self.lattice.set_level(self.form)?;
            (self.is_level, self.step) = (true, anew);
        }
        match &mut self.lattice {
            Lattice::Cpu(lattice) => {
                while self.step < until {
                    follow(&mut self.changes, self.step, &mut self.rain)?;
                    let rain = self.rain.as_ref();
                    let impacts = rain.map_or(Ok(Vec::new()), |rain| impacts_of(rain, self.step))?;
                    self.is_level &= impacts.is_empty();
                    if !self.is_level {
                        lattice.seed(&impacts)?;
                        lattice.step(STEP_S as f32)?;
                    }
                    self.step += 1;
                }
                Ok(())
            }
            #[cfg(feature = "wgpu")]
            Lattice::Gpu { .. } => self.rain_on_device(until),
        }
    }

    /// Steps the rain of a lattice on a device up to a step.
    #[cfg(feature = "wgpu")]
    fn rain_on_device(&mut self, until: i64) -> Result<(), PuddleError> {
        let Lattice::Gpu { lattice, ahead, .. } = &mut self.lattice else { return Ok(()) };
        let first = self.step;
        while self.step < until {
            let steps = self.step..until.min(self.step + STEPS_TOGETHER);
            let mut craters = Vec::new();
            for step in steps.clone() {
                follow(&mut self.changes, step, &mut self.rain)?;
                craters.push(ahead.take(step, self.rain.as_ref()));
            }
            let mut craters = finished(craters)?;
            if self.is_level {
                // Steps leave level water as it is.
                let dry = craters.iter().take_while(|craters| craters.is_empty()).count();
                craters.drain(..dry);
            }
            self.is_level &= craters.is_empty();
            if !self.is_level {
                lattice.rain(&craters, STEP_S as f32)?;
            }
            self.step = steps.end;
        }
        // The next picture is as far away as the last one, and has the same rain unless that changes.
        let next = until..until + (until - first).min(MAX_AHEAD) + 1;
        let number = |step: i64| Some(step.div_euclid(STEPS_OF_RATE));
        let is_known =
            |changes: &Changes| changes.number == number(until) && number(next.end) == number(until);
        if until > first && self.changes.as_ref().is_none_or(is_known) {
            ahead.begin(next, self.rain.as_ref());
        }
        Ok(())
    }

    /// Cells along an edge of the finest level, the number of levels, and the edge of a cell (m).
    #[must_use]
    pub fn shape(&self) -> (u32, u32, f32) {
        (CELLS, CELLS.ilog2(), CELL_M)
    }

    /// Slopes along the lattice's axes, and the mean of the square of the slope, of all levels, the finest first. Empty if a device holds
    /// the lattice.
    #[must_use]
    pub fn slopes(&self) -> Vec<[f32; 4]> {
        match &self.lattice {
            Lattice::Cpu(lattice) => slope_levels(lattice.slopes(), CELLS as usize),
            #[cfg(feature = "wgpu")]
            Lattice::Gpu { .. } => Vec::new(),
        }
    }

    /// Ripples of the present step on the device that holds them. `None` for level water, and if the CPU holds the lattice.
    #[cfg(feature = "wgpu")]
    #[must_use]
    pub fn on_device(&self) -> Option<crate::gpu::RipplesOnGpu> {
        let Lattice::Gpu { lattice, counted, .. } = &self.lattice else { return None };
        let bytes_uploaded = lattice.bytes_uploaded() - counted.replace(lattice.bytes_uploaded());
        let (_, levels, cell_m) = self.shape();
        (!self.is_level).then(|| crate::gpu::RipplesOnGpu {
            slopes: lattice.slopes(),
            step: self.step,
            levels,
            cell_m,
            bytes_uploaded,
        })
    }
}

/// Makes a rain that of a step, if it changes.
fn follow(
    changes: &mut Option<Changes>,
    step: i64,
    rain: &mut Option<Arc<PuddleRain>>,
) -> Result<(), PuddleError> {
    changes.as_mut().map_or(Ok(()), |changes| changes.follow(step, rain))
}

/// Impacts of a step on the lattice.
pub(super) fn impacts_of(rain: &PuddleRain, step: i64) -> Result<Vec<Impact>, LatticeError> {
    rain.impacts([CELLS as f32 * CELL_M; 2], step as u64, STEP_S as f32)
}

/// Impacts of a rain that make waves.
fn rain_on_water(rain: &DropSizeDistribution, seed: u64) -> PuddleRain {
    PuddleRain::new(rain, seed).without_weakest(rain, WEAKEST_PART)
}

/// Options of the lattice.
pub(super) fn options(form: PuddleForm) -> PuddleOptions {
    PuddleOptions {
        form,
        size: [CELLS; 2],
        cell_m: CELL_M,
        depth_m: DEPTH_M,
        border: PuddleBorder::Open,
        ..PuddleOptions::default()
    }
}

/// A square of texels, `size` (a power of two) each way, with all levels that are means of four of the one before, down to
/// two by two: what [`PuddleRows`](super::PuddleRows) takes.
#[must_use]
pub fn slope_levels(mut texels: Vec<[f32; 4]>, size: usize) -> Vec<[f32; 4]> {
    for level in levels_below([size as u32; 2]) {
        pyramid_append(&mut texels, &level);
    }
    texels
}

/// Number of the step that ends at or before a time, from time 0.
fn step_of(time_s: f64) -> i64 {
    (time_s / STEP_S + 1.0e-6).floor() as i64
}
