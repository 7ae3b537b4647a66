//! `downpour lattice glass`: drops on a pane.

use std::cell::RefCell;

use clap::{Args, ValueEnum};
use downpour::lattice::glass::{GlassAir, GlassOptions, GlassRain};

use super::device::{RunError, with_device};
use super::pane::Pane;
use super::picture::{Field, Target};
use super::{Common, report};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::listing::{Datum, Entry};
use crate::quantity;

/// Let rain fall on a pane of glass.
///
/// A step is a tick of the lattice: as long as no drop moves farther than a cell (2 ms for cells of 0.6 mm).
#[derive(Debug, Args)]
pub(super) struct GlassArguments {
    /// Cells of the pane, 8 to 4096 along each edge.
    #[arg(long, value_name = "WxH", default_value = "256x256", value_parser = quantity::picture_size)]
    size: [u32; 2],
    /// Edge of a cell in mm, 0.25 to 5.
    #[arg(long, value_name = "MM", default_value = "0.6", value_parser = quantity::cell_mm)]
    #[arg(allow_hyphen_values = true)]
    cell: f64,
    /// Tilt of the pane from the horizontal, 0 to 90 degrees.
    #[arg(long, value_name = "DEG", default_value = "90", value_parser = quantity::tilt_deg)]
    #[arg(allow_hyphen_values = true)]
    tilt: f64,
    /// Speed of the air with the rain toward the pane, 0 to 100 m/s; at 0 no rain reaches a window.
    #[arg(long, value_name = "M_S", default_value = "3", value_parser = quantity::speed_m_s)]
    #[arg(allow_hyphen_values = true)]
    speed: f64,
    /// Number of steps.
    #[arg(long, value_name = "N", default_value = "1000", value_parser = quantity::steps)]
    #[arg(allow_hyphen_values = true)]
    steps: u64,
    /// Invariant to check: the exit code is 1 if it does not hold.
    #[arg(long, value_enum)]
    check: Option<Check>,
    /// Quantity that the picture shows.
    #[arg(long, value_enum, default_value = "height")]
    show: Show,
    #[command(flatten)]
    common: Common,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Check {
    /// Water that came is water that is there and water that went, to the nanoliter.
    Mass,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Show {
    /// Height of the water in meters; in a .png white is 1.2 mm.
    Height,
    /// Normals: x right, y down, z out of the pane.
    Normal,
    /// Mass of each cell in nanoliters; in a .png by the cube root, white is 10 mm^3.
    Mass,
}

impl GlassArguments {
    pub(super) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        let backend = self.common.backend()?;
        let options = GlassOptions {
            size: self.size,
            cell_m: self.cell * 1.0e-3,
            tilt_rad: self.tilt.to_radians(),
            rain: GlassRain { rate_mm_h: self.common.rate, towards_m_s: self.speed, ..GlassRain::default() },
            air: GlassAir {
                speed_m_s: self.speed * downpour::math::ops::f64::cos(self.tilt.to_radians()),
                ..GlassAir::default()
            },
            seed: self.common.seed,
            ..GlassOptions::default()
        };
        let target = RefCell::new(Target::new(&self.common, self.steps)?);
        let say = |text: &str| self.common.say(text);
        let (entries, broken) = with_device(&backend, interrupt, say, &options, |mut pane| {
            self.step(&mut pane, target.borrow_mut().as_mut(), interrupt)?;
            self.invariants(&pane)
        })?;
        if self.check.is_some() && broken.is_none() {
            self.common.say("mass: every nanoliter is there");
        }
        report(&self.common, &entries, broken)
    }

    /// Makes all steps, with their pictures.
    fn step(
        &self,
        pane: &mut Pane,
        mut target: Option<&mut Target>,
        interrupt: &Interrupt,
    ) -> Result<(), RunError> {
        let mut done = 0;
        loop {
            if let Some(target) = target.as_mut().filter(|target| target.is_due(done)) {
                target.write(&self.field(pane)?, done, interrupt)?;
            }
            if done == self.steps {
                return Ok(());
            }
            // A second or so at once.
            let most = target.as_ref().map_or(500, |target| target.steps_to_next(done).min(500));
            let count = most.min(self.steps - done);
            pane.step(count as f64 * pane.tick_s())?;
            done += count;
        }
    }

    /// Final report, and the first checked invariant that does not hold.
    fn invariants(&self, pane: &Pane) -> Result<([Entry; 11], Option<String>), RunError> {
        let totals = pane.totals()?;
        let entry = Entry::new;
        let count = Datum::Count;
        let drops = pane.mass()?.iter().filter(|&&mass| mass != 0).count();
        let lost = totals.lost();
        let sound = pane.is_sound()?;
        let entries = [
            entry("steps", "steps", count(pane.ticks()), ""),
            entry("step_s", "length of a step", Datum::Computed(pane.tick_s(), 6), "s"),
            entry("drops", "drops", count(drops as u64), ""),
            entry("landed_nl", "landed", count(totals.landed), "nl"),
            entry("stored_nl", "on the pane", count(totals.stored), "nl"),
            entry("over_edge_nl", "over the edge", count(totals.over_edge), "nl"),
            entry("evaporated_nl", "dried", count(totals.evaporated), "nl"),
            entry("wiped_nl", "wiped", count(totals.wiped), "nl"),
            entry("spilled_nl", "spilled", count(totals.spilled), "nl"),
            entry("lost_nl", "lost", Datum::Given(lost as f64), "nl"),
            entry("sound", "sound", Datum::Word(if sound { "yes" } else { "no" }.to_owned()), ""),
        ];
        let broken = match self.check {
            Some(Check::Mass) if lost != 0 || !sound => {
                Some(format!("mass: {lost} nl are lost; allowed: 0, and a sound lattice"))
            }
            _ => None,
        };
        Ok((entries, broken))
    }

    fn field(&self, pane: &Pane) -> Result<Field, RunError> {
        let size = self.size;
        let gray = |numbers: Vec<f32>| numbers.into_iter().map(|n| [n; 3]).collect();
        Ok(match self.show {
            Show::Height => {
                Field { size, numbers: gray(pane.heights()?), shade: |h, scale| h / scale, scale: 1.2e-3 }
            }
            Show::Normal => Field {
                size,
                numbers: pane.normals()?.into_iter().map(|n| n.to_array()).collect(),
                shade: |n, _| 0.5 * n + 0.5,
                scale: 1.0,
            },
            Show::Mass => Field {
                size,
                numbers: gray(pane.mass()?.into_iter().map(|m| m as f32).collect()),
                shade: |m, scale| downpour::math::ops::cbrt(m / scale),
                scale: 1.0e4,
            },
        })
    }
}
