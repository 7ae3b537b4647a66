//! `downpour lattice puddle`: ripples on shallow water.

use std::cell::RefCell;

use clap::{Args, ValueEnum};
use downpour::drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour::lattice::puddle::{Impact, Puddle, PuddleBorder, PuddleDamping, PuddleOptions, PuddleRain};

use super::device::{RunError, with_device};
use super::picture::{Field, Target};
use super::water::Water;
use super::{Common, report};
use crate::failure::{Failure, INPUT};
use crate::interrupt::Interrupt;
use crate::listing::{Datum, Entry};
use crate::quantity;

/// Tolerance of the drift of the energy, relative to it.
const ENERGY_DRIFT: f64 = 1.0e-4;

/// Tolerance of the drift of the volume, relative to the maximum above or below the level: the ripples that damping
/// leaves do not measure the moved volume.
const VOLUME_DRIFT: f64 = 1.0e-4;

/// Let rain fall on a puddle.
#[derive(Debug, Args)]
pub(super) struct PuddleArguments {
    /// Cells of the puddle, 64 to 4096 along each edge.
    #[arg(long, value_name = "WxH", default_value = "256x256", value_parser = quantity::picture_size)]
    size: [u32; 2],
    /// Edge of a cell in mm, 0.1 to 1000.
    #[arg(long, value_name = "MM", default_value = "2", value_parser = quantity::cell_mm)]
    #[arg(allow_hyphen_values = true)]
    cell: f64,
    /// Depth of the water in mm, 0.1 to 1000000.
    #[arg(long, value_name = "MM", default_value = "5", value_parser = quantity::depth_mm)]
    #[arg(allow_hyphen_values = true)]
    depth: f64,
    /// Length of a step in seconds, 0.000001 to 1.
    #[arg(long, value_name = "S", default_value = "0.005", value_parser = quantity::step_s)]
    #[arg(allow_hyphen_values = true)]
    step: f64,
    /// Number of steps.
    #[arg(long, value_name = "N", default_value = "1000", value_parser = quantity::steps)]
    #[arg(allow_hyphen_values = true)]
    steps: u64,
    /// Absorbing border, as if the water continued.
    #[arg(long)]
    open: bool,
    /// Invariant to check: the exit code is 1 if it does not hold. Checks run without rain.
    #[arg(long, value_enum)]
    check: Option<Check>,
    /// Quantity that the picture shows.
    #[arg(long, value_enum, default_value = "height")]
    show: Show,
    #[command(flatten)]
    common: Common,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Check {
    /// The energy of the ripples of a drop of 3 mm, without damping, stays within a ten-thousandth.
    Energy,
    /// The volume of the water stays.
    Mass,
    /// Level water stays level, bit for bit.
    Rest,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Show {
    /// Height over the level in meters; in a .png gray is the level, black and white are three times the rms; in a
    /// clip three times the largest rms so far.
    Height,
    /// Normals: x along the rows, y up, z along the columns.
    Normal,
}

impl PuddleArguments {
    pub(super) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        let backend = self.common.backend()?;
        if self.check.is_some() && (self.common.rate > 0.0 || self.open) {
            let message =
                "--check with --rate or --open; allowed: without them, since both bring or take energy";
            return Err(Failure::new(INPUT, message));
        }
        let target = RefCell::new(Target::new(&self.common, self.steps)?);
        let undamped = matches!(self.check, Some(Check::Energy));
        let options = PuddleOptions {
            size: self.size,
            cell_m: (self.cell * 1.0e-3) as f32,
            depth_m: (self.depth * 1.0e-3) as f32,
            damping: if undamped { PuddleDamping::None } else { PuddleDamping::Water },
            border: if self.open { PuddleBorder::Open } else { PuddleBorder::Reflecting },
            ..PuddleOptions::default()
        };
        let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, self.common.rate)?;
        let rain = (self.common.rate > 0.0).then(|| PuddleRain::new(&rain, self.common.seed));
        let say = |text: &str| self.common.say(text);
        let (entries, broken) = with_device(&backend, interrupt, say, &options, |mut water| {
            let stats = self.step(&mut water, rain.as_ref(), target.borrow_mut().as_mut(), interrupt)?;
            self.invariants(&mut water, &stats)
        })?;
        if self.check.is_some() && broken.is_none() {
            self.common.say("the check holds");
        }
        report(&self.common, &entries, broken)
    }

    /// Makes all steps, with their pictures.
    fn step(
        &self,
        water: &mut Water,
        rain: Option<&PuddleRain>,
        mut target: Option<&mut Target>,
        interrupt: &Interrupt,
    ) -> Result<RunStats, RunError> {
        if matches!(self.check, Some(Check::Energy | Check::Mass)) {
            let position_m = water.extent_m().map(|edge| 0.4 * edge);
            water.seed(&[Impact { position_m, speed_m_s: 8.0, diameter_m: 3.0e-3 }])?;
        }
        let dt = self.step as f32;
        let mut stats = RunStats { drops: 0, drift: 0.0, moved: moved_volume(water.look()?) };
        let mut first = None;
        let mut draw = |water: &mut Water, done: u64| match target
            .as_mut()
            .filter(|target| target.is_due(done))
        {
            Some(target) => target.write(&self.field(water.look()?), done, interrupt).map_err(RunError::from),
            None => Ok(()),
        };
        draw(water, 0)?;
        for step in 0..self.steps {
            if let Some(rain) = rain {
                let impacts = rain.impacts(water.extent_m(), step, dt)?;
                stats.drops += impacts.len() as u64;
                water.seed(&impacts)?;
            }
            water.step(dt)?;
            draw(water, step + 1)?;
            // Looking at all cells each time would take as long as the steps. A GPU is waited for then.
            if step < 4 || step % 64 == 0 || step + 1 == self.steps {
                let puddle = water.look()?;
                let energy = puddle.energy();
                let begun = *first.get_or_insert(energy);
                stats.moved = stats.moved.max(moved_volume(puddle));
                stats.drift = stats.drift.max((energy - begun).abs() / begun.abs().max(f64::MIN_POSITIVE));
            }
        }
        Ok(stats)
    }

    /// Final report, and the first checked invariant that does not hold.
    fn invariants(
        &self,
        water: &mut Water,
        stats: &RunStats,
    ) -> Result<([Entry; 9], Option<String>), RunError> {
        let (steps, reset_cells) = (water.steps(), water.reset_cells()?);
        let puddle = water.look()?;
        let &RunStats { drops, drift, moved } = stats;
        let heights = puddle.heights();
        let volume = puddle.volume();
        let highest = heights.iter().fold(0.0f32, |most, h| most.max(h.abs()));
        let fraction = volume.abs() / moved.max(f64::MIN_POSITIVE);
        let entry = Entry::new;
        let entries = [
            entry("steps", "steps", Datum::Count(steps), ""),
            entry("degree", "degree of the operator", Datum::Count(puddle.degree().into()), ""),
            entry("drops", "drops", Datum::Count(drops), ""),
            entry("highest_mm", "highest ripple", Datum::Computed(f64::from(highest) * 1.0e3, 4), "mm"),
            entry("energy_m4_s2", "energy", Datum::Computed(puddle.energy(), 6), "m^4/s^2"),
            entry("energy_drift", "drift of the energy", Datum::Computed(drift, 3), ""),
            entry("volume_m3", "volume over the level", Datum::Computed(volume, 3), "m^3"),
            entry("volume_share", "fraction of the maximum moved volume", Datum::Computed(fraction, 3), ""),
            entry("reset_cells", "cells that were reset", Datum::Count(reset_cells), ""),
        ];
        let level = heights.iter().all(|h| h.to_bits() == 0);
        let broken = match self.check {
            Some(Check::Energy) if drift.is_nan() || drift > ENERGY_DRIFT => {
                Some(format!("energy: it drifts by {drift:.2e}; allowed: {ENERGY_DRIFT:.0e}"))
            }
            Some(Check::Mass) if fraction.is_nan() || fraction > VOLUME_DRIFT => {
                Some(format!("mass: {fraction:.2e} of the moved volume; allowed: {VOLUME_DRIFT:.0e}"))
            }
            Some(Check::Rest) if !level => {
                Some("rest: level water has moved; allowed: heights of 0, bit for bit".to_owned())
            }
            _ => None,
        };
        Ok((entries, broken))
    }

    fn field(&self, puddle: &Puddle) -> Field {
        let size = self.size;
        match self.show {
            Show::Height => {
                let heights = puddle.heights();
                let mean = heights.iter().map(|&h| f64::from(h * h)).sum::<f64>() / heights.len() as f64;
                Field {
                    size,
                    numbers: heights.into_iter().map(|h| [h; 3]).collect(),
                    shade: |h, scale| 0.5 + h / scale,
                    scale: (6.0 * mean.sqrt()).max(1.0e-9) as f32,
                }
            }
            Show::Normal => {
                Field { size, numbers: puddle.normals(), shade: |n, _| 0.5 * n + 0.5, scale: 1.0 }
            }
        }
    }
}

/// Statistics collected during the run.
struct RunStats {
    /// Drops of the rain.
    drops: u64,
    /// Maximum drift of the energy, relative to it.
    drift: f64,
    /// The largest volume that was above or below the level, m^3.
    moved: f64,
}

/// Volume above the level and missing below it, m^3.
fn moved_volume(puddle: &Puddle) -> f64 {
    let cell = f64::from(puddle.options().cell_m);
    puddle.heights().iter().map(|&h| f64::from(h.abs())).sum::<f64>() * cell * cell
}
