//! Rain in a volume that follows the camera, step by step: any wind, and whatever stands in its way.
//!
//! What is the same again:
//! - the same options, rain and steps give the same bits, for any number of threads;
//! - a box ([`SimVolume::Box`]) begins with the same drops for every camera, and as long as nothing is in their way they
//!   stay the same for all cameras that step alike;
//! - the drops of a view belong to its camera and its steps; who seeks begins anew. Rain that can be seeked, and looked at
//!   by any number of cameras, is that of [`crate::field`].

use std::f64::consts::FRAC_PI_6;

use downpour_drop::distribution::DropSizeDistribution;
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_shaders::sim::step::{STEP_BOUNCED, STEP_FALLING, STEP_HIDDEN, STEP_KIND};
use downpour_wind::WindField;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::SimError;
use crate::collision::CollisionMap;
use crate::field::{DropKind, FallingDrop, VisibleDrops};
use crate::motion::{motion_diameter, motion_settled, motion_table, motion_table_entry, motion_table_speed};
use crate::plan::Plan;
use crate::population::{MOST_DROPS, MOST_IN_MEMORY, Population, volume_of};
use crate::step::{StepCaught, StepDrop, StepEvent, StepFrame, StepWorld, step_shown};
use crate::view::View;

/// How much wider than the picture a view is simulated.
pub(crate) const WIDER: f64 = 1.02;

/// Drops of one piece of work.
const PIECE: usize = 1 << 14;

/// The part of space that is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum SimVolume {
    /// What the picture shows, each size up to the distance at which it is resolved (Im & Sung 2022, 3.A and B, with
    /// uniform density).
    #[default]
    View,
    /// A periodic box that follows eye and view (Rousseau 2006, 7). Edges 1 to 1000 m.
    Box {
        /// Edges, m.
        size_m: [f64; 3],
    },
    /// The view of Im & Sung 2022 with their sampling: dense about the middle, and random again after each way out.
    ImSung,
    /// A box round the eye; drops begin at its top, wherever the eye is then (in the manner of S. Tariq, "Rain", 2007, as
    /// Im & Sung compare with it). Edges 1 to 1000 m.
    Tariq {
        /// Edges, m.
        size_m: [f64; 3],
    },
    /// An upright cylinder that stands in the world (in the manner of C. Creus and G. Patow, "R4: realistic rain
    /// rendering in realtime", 2013, as Im & Sung compare with it).
    Cylinder {
        /// Middle of the base, m.
        base_m: [f64; 3],
        /// 0.5 to 1000 m.
        radius_m: f64,
        /// 1 to 1000 m.
        height_m: f64,
    },
}

/// How drops follow the wind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Drag {
    /// The slip relaxes with v / g across the fall and v / 2g along it.
    #[default]
    Relaxation,
    /// Each step halves the difference to the wind (Rousseau 2008, 5.1.2): depends on the frame rate.
    Rousseau2008,
}

/// What happens to drops that meet a surface.
///
/// The default lets a tenth of the impacts send up a droplet, of which the papers say little: "a low-motion quasi-spherical
/// refractive drop". 1 for `share` is Rousseau 2008.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounce {
    /// Share of impacts after which a drop comes back, 0 to 1.
    pub share: f32,
    /// Share of the speed along the normal that comes back, 0 to 1.
    pub restitution: f32,
    /// Share of the speed along the surface that is lost, 0 to 1.
    pub grip: f32,
    /// Diameter of what comes back, in that of the drop, 0.05 to 1.
    pub size: f32,
    /// After this time it is gone, 0.01 to 10 s.
    pub longest_s: f32,
}

impl Default for Bounce {
    fn default() -> Self {
        Self { share: 0.1, restitution: 0.25, grip: 0.7, size: 0.25, longest_s: 1.0 }
    }
}

/// A level rectangle that measures what falls through it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gauge {
    /// m.
    pub height_m: f64,
    /// Lower x and z, m.
    pub low_m: [f64; 2],
    /// Upper x and z, m.
    pub high_m: [f64; 2],
}

impl Gauge {
    /// The rate, mm/h, of a volume in units of [`StepCaught`] that was caught in a time.
    #[must_use]
    pub fn rate_mm_h(&self, caught: &StepCaught, time_s: f64) -> f64 {
        let area = (self.high_m[0] - self.low_m[0]) * (self.high_m[1] - self.low_m[1]);
        caught.volume as f64 * 1.0e-13 / (area * time_s) * 3.6e6
    }
}

/// A simulation's choices.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulationOptions {
    /// Where.
    pub volume: SimVolume,
    /// Same seed, same drops.
    pub seed: u64,
    /// 1 to 2^28. A view leaves out drops that are small on the picture, other volumes small drops, to have no more.
    pub most_drops: u32,
    /// How drops follow the wind.
    pub drag: Drag,
    /// What happens to drops that meet a surface.
    pub bounce: Bounce,
    /// Impacts that are noted in a step; the others are counted.
    pub most_events: u32,
    /// Measures what falls through it.
    pub gauge: Option<Gauge>,
}

impl Default for SimulationOptions {
    /// Two million drops in view; 65 536 impacts a step.
    fn default() -> Self {
        Self {
            volume: SimVolume::View,
            seed: 0,
            most_drops: 2_000_000,
            drag: Drag::Relaxation,
            bounce: Bounce::default(),
            most_events: 1 << 16,
            gauge: None,
        }
    }
}

impl SimulationOptions {
    pub(crate) fn check(&self) -> Result<(), SimError> {
        let within = |quantity, found: f64, unit, range: std::ops::RangeInclusive<f64>, allowed| {
            if range.contains(&found) {
                return Ok(());
            }
            Err(SimError::OutOfRange { quantity, found, unit, allowed })
        };
        match self.volume {
            SimVolume::Box { size_m } | SimVolume::Tariq { size_m } => {
                for edge in size_m {
                    within("edge of the rain box", edge, "m", 1.0..=1000.0, "1 to 1000")?;
                }
            }
            SimVolume::Cylinder { base_m, radius_m, height_m } => {
                for place in base_m {
                    within("place of the rain cylinder", place, "m", -1.0e7..=1.0e7, "-1e7 to 1e7")?;
                }
                within("radius of the rain cylinder", radius_m, "m", 0.5..=1000.0, "0.5 to 1000")?;
                within("height of the rain cylinder", height_m, "m", 1.0..=1000.0, "1 to 1000")?;
            }
            SimVolume::View | SimVolume::ImSung => {}
        }
        within("most drops", self.most_drops.into(), "", 1.0..=MOST_DROPS as f64, "1 to 2^30")?;
        if u64::from(self.most_drops) > MOST_IN_MEMORY {
            return Err(SimError::memory(self.most_drops.into()));
        }
        let Bounce { share, restitution, grip, size, longest_s } = self.bounce;
        within("share of impacts that bounce", share.into(), "", 0.0..=1.0, "0 to 1")?;
        within("restitution", restitution.into(), "", 0.0..=1.0, "0 to 1")?;
        within("grip", grip.into(), "", 0.0..=1.0, "0 to 1")?;
        within("size of a bounced drop", size.into(), "", 0.05 - 1.0e-6..=1.0, "0.05 to 1")?;
        within("time of a bounced drop", longest_s.into(), "s", 0.01 - 1.0e-6..=10.0, "0.01 to 10")?;
        if let Some(Gauge { height_m, low_m, high_m }) = self.gauge {
            for place in [height_m, low_m[0], low_m[1], high_m[0], high_m[1]] {
                within("place of the gauge", place, "m", -1.0e7..=1.0e7, "-1e7 to 1e7")?;
            }
            let edge = (high_m[0] - low_m[0]).min(high_m[1] - low_m[1]);
            within("edge of the gauge", edge, "m", 1.0e-3..=1.0e4, "0.001 to 1e4")?;
        }
        Ok(())
    }
}

/// What there is at the end of a step. Wind and map are relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The camera.
    pub view: &'a View,
    /// What single precision is relative to, m. It may move from step to step.
    pub origin: DVec3,
    /// The wind where there is no field, m/s.
    pub wind: Vec3,
    /// The wind.
    pub field: Option<&'a WindField>,
    /// What stops drops.
    pub map: Option<&'a CollisionMap>,
}

/// What happened in a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Happened {
    /// Impacts, in the order of steps and then of drops' numbers; places are relative to the origin.
    pub events: Vec<StepEvent>,
    /// Impacts that were counted and not noted.
    pub overflow: u64,
    /// What went through the gauge.
    pub caught: StepCaught,
}

/// A rain on the CPU.
#[derive(Clone, Debug)]
pub struct Simulation {
    pub(crate) plan: Plan,
    pub(crate) speeds: Vec<f32>,
    pub(crate) drops: Vec<StepDrop>,
}

impl Simulation {
    /// The rain of a distribution.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for options or a camera outside their ranges, [`SimError::Memory`], [`SimError::Drop`].
    pub fn new(
        rain: &DropSizeDistribution,
        options: &SimulationOptions,
        moment: &Moment<'_>,
    ) -> Result<Self, SimError> {
        let (plan, population) = Plan::new(rain, options, moment.view, moment.origin)?;
        let law = TerminalSpeed::new(rain.options().fall_speed, &rain.options().air);
        let speeds = motion_table(&law);
        let drops = begin(&plan, &population, &speeds, moment)?;
        Ok(Self { plan, speeds, drops })
    }

    /// Lets time pass, up to 1 s; the camera comes to the moment's. Times above 1/30 s are cut into equal steps.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for a time that is none or a camera that is none; nothing has moved then.
    pub fn advance(&mut self, time_s: f64, moment: &Moment<'_>) -> Result<Happened, SimError> {
        let frames = self.plan.frames(time_s, moment.view, moment.origin, moment.wind)?;
        let mut happened = Happened::default();
        for frame in &frames {
            self.step(frame, moment, &mut happened);
        }
        Ok(happened)
    }

    fn step(&mut self, frame: &StepFrame, moment: &Moment<'_>, happened: &mut Happened) {
        let world = StepWorld { frame, speeds: &self.speeds, field: moment.field, map: moment.map };
        let pieces: Vec<(Vec<StepEvent>, StepCaught)> = self
            .drops
            .par_chunks_mut(PIECE)
            .enumerate()
            .map(|(piece, drops)| {
                let (mut events, mut caught) = (Vec::new(), StepCaught::default());
                for (drop, number) in drops.iter_mut().zip((piece * PIECE) as u32..) {
                    let made = world.step(number, drop);
                    *drop = made.drop;
                    events.extend(made.event);
                    if let Some(volume) = made.caught {
                        caught.drops += 1;
                        caught.volume += u64::from(volume);
                    }
                }
                (events, caught)
            })
            .collect();
        let mut room = frame.events as usize;
        for (events, caught) in pieces {
            let noted = events.len().min(room);
            room -= noted;
            happened.overflow += (events.len() - noted) as u64;
            happened.events.extend_from_slice(&events[..noted]);
            happened.caught.drops += caught.drops;
            happened.caught.volume += caught.volume;
        }
    }

    /// The state, in the order of the drops' numbers.
    #[must_use]
    pub fn drops(&self) -> &[StepDrop] {
        &self.drops
    }

    /// The least diameter, m: smaller drops are left to extinction.
    #[must_use]
    pub fn least_diameter(&self) -> f64 {
        self.plan.least_diameter
    }

    /// The drops that a picture can show.
    #[must_use]
    pub fn visible(&self, view: &View) -> VisibleDrops {
        visible(&self.plan, &self.drops, view)
    }

    /// The rate, mm/h, of the drops in the volume, those that something hides among them.
    #[must_use]
    pub fn measured_rate_mm_h(&self) -> f64 {
        measured(&self.plan, &self.drops)
    }
}

/// The drops at first, at rest in the air about them.
fn begin(
    plan: &Plan,
    population: &Population,
    speeds: &[f32],
    moment: &Moment<'_>,
) -> Result<Vec<StepDrop>, SimError> {
    let count = population.sizes.len();
    let mut drops = Vec::new();
    drops.try_reserve_exact(count).map_err(|_| SimError::memory(count as u64))?;
    let options = &plan.options;
    drops.par_extend(population.sizes.par_iter().enumerate().map(|(number, &size)| {
        let place =
            population.place(number as u32, &options.volume, plan.view(), plan.origin(), options.seed);
        let diameter = motion_diameter(size.into());
        let entry = motion_table_entry(diameter) as usize;
        let at = |k: usize| speeds.get(k).copied().unwrap_or(0.0);
        let speed = motion_table_speed(at(entry), at(entry + 1), diameter);
        let wind = moment.field.map_or(moment.wind, |field| field.sample(place));
        let open = moment.map.is_none_or(|map| map.open(place));
        let kind = if open { STEP_FALLING } else { STEP_HIDDEN };
        StepDrop {
            place: place.to_array(),
            word: u32::from(size) | kind << STEP_KIND,
            velocity: motion_settled(wind, speed).to_array(),
            seconds: 0.0,
        }
    }));
    Ok(drops)
}

/// The drops of a state that a picture can show.
pub(crate) fn visible(plan: &Plan, drops: &[StepDrop], view: &View) -> VisibleDrops {
    let bounced_size = plan.options.bounce.size;
    let least_pixels = plan.least_pixels;
    let shown = |(number, drop): (usize, &StepDrop)| {
        let diameter = step_shown(drop.word, bounced_size);
        let position = plan.origin() + Vec3::from(drop.place).as_dvec3();
        let range = view.range(diameter.into(), least_pixels);
        let kind = match drop.kind() {
            STEP_FALLING => DropKind::Falling,
            STEP_BOUNCED => DropKind::Bounced,
            _ => return None,
        };
        let seen = view.touches(position, 0.6 * f64::from(diameter), range);
        seen.then_some(FallingDrop { position, velocity: drop.velocity, diameter, id: number as u64, kind })
    };
    VisibleDrops {
        drops: drops.par_iter().enumerate().filter_map(shown).collect(),
        simulated: drops.len() as u64,
        resolved: plan.resolved(view),
    }
}

/// The rate of a state, mm/h.
pub(crate) fn measured(plan: &Plan, drops: &[StepDrop]) -> f64 {
    let flux = |drop: &StepDrop| {
        if drop.kind() == STEP_BOUNCED {
            return 0.0;
        }
        let diameter = f64::from(drop.diameter());
        let volume = volume_of(&plan.options.volume, plan.view(), plan.least_pixels, diameter);
        -f64::from(drop.velocity[1]) * diameter * diameter * diameter / volume
    };
    // In pieces, so that the sum does not depend on the threads.
    let pieces: Vec<f64> = drops.par_chunks(PIECE).map(|piece| piece.iter().map(flux).sum()).collect();
    FRAC_PI_6 * pieces.iter().sum::<f64>() * 3.6e6
}
