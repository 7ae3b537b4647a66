//! Rain in a volume that follows the camera, step by step: any wind, and whatever stands in its way.
//!
//! What is the same again:
//! - the same options, rain and steps give the same bits, for any number of threads;
//! - a view ([`SimVolume::View`]) forgets: its drops depend on the steps of the last [`SimulationOptions::oldest_s`] alone,
//!   so that a simulation that begins so much earlier, at any step of the same numbering, has the same drops with the same
//!   ids. They belong to their camera and to the size of its picture;
//! - a box ([`SimVolume::Box`]) begins with the same drops for every camera and size of the picture, and as long as nothing
//!   is in their way they stay the same for all cameras that step alike from the same beginning;
//! - rain that is the same for any number of cameras, at any time, is that of [`crate::field`].

use downpour_drop::distribution::DropSizeDistribution;
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_shaders::sim::enter::ENTER_SIZES;
use downpour_shaders::sim::step::{STEP_FALLING, STEP_GONE, STEP_HIDDEN};
use downpour_wind::{UniformWindAt, WindField};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::SimError;
use crate::collision::CollisionMap;
use crate::enter::EnterRegion;
use crate::field::VisibleDrops;
use crate::fill::fill;
use crate::list::{Listing, listed};
use crate::motion::{motion_diameter, motion_settled, motion_table, speed_of};
use crate::options::PIECE;
pub use crate::options::{Bounce, Drag, Gauge, SimVolume, SimulationOptions};
use crate::plan::{AirAtEye, Plan, Turn, lags};
use crate::population::{Population, affordable_pixels, bins, place};
use crate::step::{StepCaught, StepDrop, StepEvent, StepFrame, StepMade, StepWorld, step_word};
use crate::view::View;

/// Regions of one piece of work.
const REGIONS: usize = 1 << 6;

/// The least diameter on the picture, pixels, of the drops of a view that holds about as many drops as its options allow; no
/// less than the view asks for.
///
/// # Errors
/// [`SimError::OutOfRange`] for options or a camera outside their ranges, [`SimError::Drop`].
pub fn least_pixels(
    rain: &DropSizeDistribution,
    options: &SimulationOptions,
    view: &View,
) -> Result<f64, SimError> {
    options.check()?;
    view.check()?;
    let times = [options.horizon_s(), options.wait_s];
    Ok(affordable_pixels(&bins(rain)?, view, times, options.most_drops))
}

/// What there is at the end of a step. Wind and map are relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The camera; for a view the one in the middle of the time that pictures of this state cover.
    pub view: &'a View,
    /// What single precision is relative to, m. It may move from step to step.
    pub origin: DVec3,
    /// The wind where there is no field, m/s.
    pub wind: Vec3,
    /// The wind.
    pub field: Option<&'a WindField>,
    /// What stops drops.
    pub map: Option<&'a CollisionMap>,
    /// The part of the wind that is the same everywhere, as it changes: what comes into a view lags behind it as the drops
    /// that are there. `None`: it does not change.
    pub air: Option<&'a UniformWindAt<'a>>,
}

impl<'a> Moment<'a> {
    /// A camera in a wind that is the same everywhere and does not change; nothing stops drops.
    #[must_use]
    pub fn new(view: &'a View, origin: DVec3, wind: Vec3) -> Self {
        Self { view, origin, wind, field: None, map: None, air: None }
    }
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
    /// Drops that came into a view on a GPU and found no slot: they are missing.
    pub lost: u64,
}

impl Moment<'_> {
    /// What the air does about the eye.
    fn air(&self, reach: f64) -> AirAtEye {
        let lags = lags(self.air);
        let Some(field) = self.field else { return AirAtEye { wind: self.wind, spread: [0.0; 2], lags } };
        let eye = (self.view.eye - self.origin).as_vec3();
        AirAtEye { wind: field.sample(eye), spread: field.spread(eye, reach as f32), lags }
    }
}

/// A rain on the CPU.
#[derive(Clone, Debug)]
pub struct Simulation {
    pub(crate) plan: Plan,
    pub(crate) speeds: Vec<f32>,
    pub(crate) sizes: Vec<[f32; ENTER_SIZES as usize]>,
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
        let air = moment.air(moment.view.far);
        let mut plan = Plan::new(rain, options, moment.view, moment.origin, air)?;
        let law = TerminalSpeed::new(rain.options().fall_speed, &rain.options().air);
        let speeds = motion_table(&law);
        let sizes = plan.sizes();
        let drops = if plan.is_open() {
            let frame = plan.standing(air);
            filled(&plan, &world(&frame, &speeds, &sizes, &[], moment))?
        } else {
            let (view, seed) = (plan.view(), options.seed);
            let population = Population::new(&plan.bins, &options.volume, view, options.most_drops, seed)?;
            plan.least_diameter = population.least_diameter;
            begin(&plan, &population, &speeds, moment)?
        };
        Ok(Self { plan, speeds, sizes, drops })
    }

    /// Lets time pass, up to 1 s; the camera comes to the moment's. Times above 1/30 s are cut into equal steps.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for a time that is none or a camera that is none; nothing has moved then.
    /// [`SimError::Memory`].
    pub fn advance(&mut self, time_s: f64, moment: &Moment<'_>) -> Result<Happened, SimError> {
        let air = moment.air(self.plan.farthest(moment.view));
        let turns = self.plan.turns(time_s, moment.view, moment.origin, air)?;
        let mut happened = Happened::default();
        for turn in &turns {
            if self.plan.is_open() {
                self.step_open(turn, moment, &mut happened)?;
            } else {
                self.step_slots(turn, moment, &mut happened);
            }
        }
        Ok(happened)
    }

    /// A step of a view.
    fn step_open(
        &mut self,
        turn: &Turn,
        moment: &Moment<'_>,
        happened: &mut Happened,
    ) -> Result<(), SimError> {
        let frame = &turn.frame;
        let world = world(frame, &self.speeds, &self.sizes, &turn.regions, moment);
        if frame.elsewhere == 1 {
            self.drops = filled(&self.plan, &world)?;
            return Ok(());
        }
        let told = self.drops.par_chunks_mut(PIECE).map(|drops| {
            let mut told = Told::default();
            for drop in drops {
                *drop = told.note(world.step_view(&shifted(drop, frame)));
            }
            told
        });
        let told: Vec<Told> = told.collect();
        self.drops.retain(|drop| drop.kind() != STEP_GONE);
        let come = turn.regions.par_windows(2).with_min_len(REGIONS).map(|pair| {
            let (mut told, mut come) = (Told::default(), Vec::new());
            if let [region, next] = pair {
                for number in 0..next.first - region.first {
                    come.extend(world.enter_drop(region, number).map(|made| told.note(made)));
                }
            }
            come.retain(|drop: &StepDrop| drop.kind() != STEP_GONE);
            (told, come)
        });
        let come: Vec<(Told, Vec<StepDrop>)> = come.collect();
        let count = come.iter().map(|(_, drops)| drops.len()).sum();
        self.drops.try_reserve(count).map_err(|_| SimError::memory((self.drops.len() + count) as u64))?;
        let mut room = frame.events as usize;
        for told in told {
            told.tell(&mut room, happened);
        }
        for (told, drops) in come {
            self.drops.extend_from_slice(&drops);
            told.tell(&mut room, happened);
        }
        Ok(())
    }

    /// A step of a volume that keeps its number of drops.
    fn step_slots(&mut self, turn: &Turn, moment: &Moment<'_>, happened: &mut Happened) {
        let frame = &turn.frame;
        let world = world(frame, &self.speeds, &self.sizes, &[], moment);
        let pieces = self.drops.par_chunks_mut(PIECE).enumerate().map(|(piece, drops)| {
            let mut told = Told::default();
            for (drop, number) in drops.iter_mut().zip((piece * PIECE) as u32..) {
                *drop = told.note(world.step_slot(number, &shifted(drop, frame)));
            }
            told
        });
        let pieces: Vec<Told> = pieces.collect();
        let mut room = frame.events as usize;
        for told in pieces {
            told.tell(&mut room, happened);
        }
    }

    /// The state: of a view in the order in which drops came, else in the order of their numbers.
    #[must_use]
    pub fn drops(&self) -> &[StepDrop] {
        &self.drops
    }

    /// The least diameter, m: smaller drops are unresolved.
    #[must_use]
    pub fn least_diameter(&self) -> f64 {
        self.plan.least_diameter
    }

    /// The farthest distance from the eye of a view at which a drop is resolved, m.
    #[must_use]
    pub fn farthest_m(&self, view: &View) -> f64 {
        self.plan.farthest(view)
    }

    /// The drops that a picture of now can show. While the shutter is open they go on at their velocity.
    #[must_use]
    pub fn visible(&self, view: &View) -> VisibleDrops {
        self.visible_after(0.0, view, None)
    }

    /// The drops that a picture can show some time after the state, s: no less than half the time of its shutter, if drops
    /// that land meanwhile are to be among them. Nothing is stored.
    #[must_use]
    pub fn visible_after(&self, after_s: f64, view: &View, map: Option<&CollisionMap>) -> VisibleDrops {
        listed(&Listing { plan: &self.plan, speeds: &self.speeds, view, after_s, map }, &self.drops)
    }

    /// The rate, mm/h, of the drops that fall in the volume, by the part of it that is open to the sky; of a view, in the
    /// picture as far as each size is resolved.
    #[must_use]
    pub fn measured_rate_mm_h(&self, map: Option<&CollisionMap>) -> f64 {
        crate::disdrometer::rate_mm_h(&self.plan, &self.drops, map)
    }
}

/// The drops of a frustum that is filled anew.
fn filled(plan: &Plan, world: &StepWorld<'_>) -> Result<Vec<StepDrop>, SimError> {
    let mut drops = fill(plan, world)?;
    drops.par_iter_mut().for_each(|drop| *drop = world.step_begin(drop));
    drops.retain(|drop| drop.kind() != STEP_GONE);
    Ok(drops)
}

/// What a step reads.
fn world<'a>(
    frame: &'a StepFrame,
    speeds: &'a [f32],
    sizes: &'a [[f32; ENTER_SIZES as usize]],
    regions: &'a [EnterRegion],
    moment: &Moment<'a>,
) -> StepWorld<'a> {
    StepWorld { frame, speeds, sizes, regions, field: moment.field, map: moment.map }
}

/// A drop relative to the origin after the step.
fn shifted(drop: &StepDrop, frame: &StepFrame) -> StepDrop {
    let place = Vec3::from(drop.place) - Vec3::from(frame.shift);
    StepDrop { place: place.to_array(), ..*drop }
}

/// What has happened to some of the drops.
#[derive(Default)]
struct Told {
    events: Vec<StepEvent>,
    caught: StepCaught,
}

impl Told {
    /// Notes what happened to a drop.
    fn note(&mut self, made: StepMade) -> StepDrop {
        self.events.extend(made.event);
        if let Some(volume) = made.caught {
            self.caught.drops += 1;
            self.caught.volume += u64::from(volume);
        }
        made.drop
    }

    /// Adds it to what is told; `room` is how many events may still be noted.
    fn tell(self, room: &mut usize, happened: &mut Happened) {
        let noted = self.events.len().min(*room);
        *room -= noted;
        happened.overflow += (self.events.len() - noted) as u64;
        happened.events.extend_from_slice(&self.events[..noted]);
        happened.caught.drops += self.caught.drops;
        happened.caught.volume += self.caught.volume;
    }
}

/// The drops at first of a volume that keeps its number of drops, at rest in the air about them.
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
        let (at, count) = place(number as u32, &options.volume, plan.view(), plan.origin(), options.seed);
        let speed = speed_of(speeds, motion_diameter(size.into()));
        let wind = moment.field.map_or(moment.wind, |field| field.sample(at));
        let open = moment.map.is_none_or(|map| map.open(at));
        let kind = if open { STEP_FALLING } else { STEP_HIDDEN };
        StepDrop {
            place: at.to_array(),
            word: step_word(size.into(), kind, count),
            velocity: motion_settled(wind, speed).to_array(),
            last: 0,
        }
    }));
    Ok(drops)
}
