//! Rain in a volume that follows the camera, step by step: any wind, and any obstacles.
//!
//! Reproducibility:
//! - the same options, rain and steps give the same bits, for any number of threads;
//! - a view ([`SimVolume::View`]) forgets: its drops depend on the steps of the last [`SimulationOptions::oldest_s`]
//!   only. A simulation that starts that much earlier, at any step of the same numbering, has the same drops with the
//!   same ids. They belong to their camera and to the size of its picture;
//! - a box ([`SimVolume::Box`]) starts with the same drops for every camera and size of the picture. As long as they
//!   hit nothing they stay the same for all cameras with the same steps from the same start;
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
use crate::impacts::SplashOptions;
use crate::motion::{motion_diameter, motion_settled, motion_table, speed_of};
use crate::options::PIECE;
pub use crate::options::{Bounce, Drag, Gauge, SimVolume, SimulationOptions};
use crate::plan::{AirAtEye, Plan, Turn, lags};
use crate::population::{Population, affordable_pixels, bins, initial_position};
use crate::recent::SPANS;
use crate::step::{
    StepCaught, StepDrop, StepEvent, StepFrame, StepMade, StepWorld, step_splashes, step_word,
};
use crate::step_list::{Listing, listed};
use crate::view::View;

/// Number of regions of one work item.
const REGIONS: usize = 1 << 6;

/// Minimum diameter on the picture, pixels, of the drops of a view that holds about as many drops as its options
/// allow; at least that of the view.
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
    Ok(affordable_pixels(&bins(rain)?, view, times, options.max_drops))
}

/// Input of a step: the state at its end. Wind and map are relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct StepInput<'a> {
    /// Camera; for a view the one in the middle of the time that pictures of this state cover.
    pub view: &'a View,
    /// Origin of single-precision positions, m. It may move from step to step.
    pub origin: DVec3,
    /// Wind without a field, m/s.
    pub wind: Vec3,
    /// Wind field.
    pub field: Option<&'a WindField>,
    /// Collision map.
    pub map: Option<&'a CollisionMap>,
    /// Uniform part of the wind, as it changes: drops that enter a view lag behind it as those inside do. `None`: it is
    /// constant.
    pub air: Option<&'a UniformWindAt<'a>>,
}

impl<'a> StepInput<'a> {
    /// Creates the input of a camera in a constant uniform wind without a collision map.
    #[must_use]
    pub fn new(view: &'a View, origin: DVec3, wind: Vec3) -> Self {
        Self { view, origin, wind, field: None, map: None, air: None }
    }
}

/// Events of a step or of several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepEvents {
    /// Impacts, in the order of steps and then of drops' numbers; positions are relative to the origin.
    pub events: Vec<StepEvent>,
    /// Number of impacts that were counted but not recorded.
    pub overflow: u64,
    /// Rain through the gauge.
    pub caught: StepCaught,
    /// Number of drops that entered a view on a GPU and found no slot: they are missing.
    pub lost: u64,
}

impl StepInput<'_> {
    /// Air around the eye.
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
    /// Impacts that may show splashes, by the spans of the plan.
    pub(crate) kept: [Vec<StepEvent>; SPANS],
}

impl Simulation {
    /// Creates the rain of a distribution.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for options or a camera outside their ranges, [`SimError::Memory`], [`SimError::Drop`].
    pub fn new(
        rain: &DropSizeDistribution,
        options: &SimulationOptions,
        input: &StepInput<'_>,
    ) -> Result<Self, SimError> {
        let air = input.air(input.view.far);
        let mut plan = Plan::new(rain, options, input.view, input.origin, air)?;
        let law = TerminalSpeed::new(rain.options().fall_speed, &rain.options().air);
        let speeds = motion_table(&law);
        let sizes = plan.sizes();
        let drops = if plan.is_open() {
            let frame = plan.standing(air);
            filled(&plan, &world(&frame, &speeds, &sizes, &[], input))?
        } else {
            let (view, seed) = (plan.view(), options.seed);
            let population = Population::new(&plan.bins, &options.volume, view, options.max_drops, seed)?;
            plan.min_diameter = population.min_diameter;
            begin(&plan, &population, &speeds, input)?
        };
        Ok(Self { plan, speeds, sizes, drops, kept: Default::default() })
    }

    /// Advances by a time of up to 1 s; the camera moves to that of the input. Times above 1/30 s are divided into
    /// equal steps.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for an invalid time or camera; nothing has moved then.
    /// [`SimError::Memory`].
    pub fn advance(&mut self, time_s: f64, input: &StepInput<'_>) -> Result<StepEvents, SimError> {
        let air = input.air(self.plan.farthest(input.view));
        let turns = self.plan.turns(time_s, input.view, input.origin, air)?;
        let mut outcome = StepEvents::default();
        for turn in &turns {
            if turn.begins_span {
                self.kept[turn.frame.kept_span as usize].clear();
            }
            if self.plan.is_open() {
                self.step_open(turn, input, &mut outcome)?;
            } else {
                self.step_slots(turn, input, &mut outcome);
            }
        }
        Ok(outcome)
    }

    /// Makes a step of a view.
    fn step_open(
        &mut self,
        turn: &Turn,
        input: &StepInput<'_>,
        outcome: &mut StepEvents,
    ) -> Result<(), SimError> {
        let frame = &turn.frame;
        let world = world(frame, &self.speeds, &self.sizes, &turn.regions, input);
        if frame.elsewhere == 1 {
            self.drops = filled(&self.plan, &world)?;
            return Ok(());
        }
        let records = self.drops.par_chunks_mut(PIECE).map(|drops| {
            let mut record = EventRecord::default();
            for drop in drops {
                *drop = record.add(world.step_view(&shifted(drop, frame)));
            }
            record
        });
        let records: Vec<EventRecord> = records.collect();
        self.drops.retain(|drop| drop.kind() != STEP_GONE);
        let come = turn.regions.par_windows(2).with_min_len(REGIONS).map(|pair| {
            let (mut record, mut come) = (EventRecord::default(), Vec::new());
            if let [region, next] = pair {
                for number in 0..next.first - region.first {
                    come.extend(world.enter_drop(region, number).map(|made| record.add(made)));
                }
            }
            come.retain(|drop: &StepDrop| drop.kind() != STEP_GONE);
            (record, come)
        });
        let come: Vec<(EventRecord, Vec<StepDrop>)> = come.collect();
        let count = come.iter().map(|(_, drops)| drops.len()).sum();
        self.drops.try_reserve(count).map_err(|_| SimError::memory((self.drops.len() + count) as u64))?;
        let mut room = frame.events as usize;
        for record in records {
            self.keep(frame, &record);
            record.append_to(&mut room, outcome);
        }
        for (record, drops) in come {
            self.drops.extend_from_slice(&drops);
            self.keep(frame, &record);
            record.append_to(&mut room, outcome);
        }
        Ok(())
    }

    /// Makes a step of a volume with a constant number of drops.
    fn step_slots(&mut self, turn: &Turn, input: &StepInput<'_>, outcome: &mut StepEvents) {
        let frame = &turn.frame;
        let world = world(frame, &self.speeds, &self.sizes, &[], input);
        let pieces = self.drops.par_chunks_mut(PIECE).enumerate().map(|(piece, drops)| {
            let mut record = EventRecord::default();
            for (drop, number) in drops.iter_mut().zip((piece * PIECE) as u32..) {
                *drop = record.add(world.step_slot(number, &shifted(drop, frame)));
            }
            record
        });
        let pieces: Vec<EventRecord> = pieces.collect();
        let mut room = frame.events as usize;
        for record in pieces {
            self.keep(frame, &record);
            record.append_to(&mut room, outcome);
        }
    }

    /// Keeps the impacts of a step that may show splashes.
    fn keep(&mut self, frame: &StepFrame, record: &EventRecord) {
        if frame.kept_room == 0 {
            return;
        }
        let kept = record.events.iter().filter(|event| step_splashes(event));
        let from_span = kept.map(|event| StepEvent { time: event.time + frame.kept_since, ..*event });
        self.kept[frame.kept_span as usize].extend(from_span);
    }

    /// State: for a view in the order in which drops entered, else in the order of their numbers.
    #[must_use]
    pub fn drops(&self) -> &[StepDrop] {
        &self.drops
    }

    /// Minimum diameter, m: smaller drops are unresolved.
    #[must_use]
    pub fn min_diameter(&self) -> f64 {
        self.plan.min_diameter
    }

    /// Maximum distance from the eye of a view at which a drop is resolved, m.
    #[must_use]
    pub fn farthest_m(&self, view: &View) -> f64 {
        self.plan.farthest(view)
    }

    /// Drops that a picture of the current time can show. During the exposure they move at their velocity.
    #[must_use]
    pub fn visible(&self, view: &View) -> VisibleDrops {
        self.visible_after(0.0, view, None, None)
    }

    /// Drops that a picture can show some time after the state, s: at least half of its exposure, to include drops
    /// that land meanwhile; with the crowns of splashes if drops splash, which are those of the simulated drops. Nothing is stored.
    #[must_use]
    pub fn visible_after(
        &self,
        after_s: f64,
        view: &View,
        map: Option<&CollisionMap>,
        splashes: Option<&SplashOptions>,
    ) -> VisibleDrops {
        let listing = Listing { plan: &self.plan, speeds: &self.speeds, view, after_s, map, splashes };
        let kept = if splashes.is_some() { &self.kept[..] } else { &[] };
        listed(&listing, &self.drops, kept)
    }

    /// Rate, mm/h, of the drops that fall in the volume, relative to its part that is open to the sky; for a view, in
    /// the picture up to the distance at which each size is resolved.
    #[must_use]
    pub fn measured_rate_mm_h(&self, map: Option<&CollisionMap>) -> f64 {
        crate::disdrometer::rate_mm_h(&self.plan, &self.drops, map)
    }
}

/// Drops of a refilled frustum.
fn filled(plan: &Plan, world: &StepWorld<'_>) -> Result<Vec<StepDrop>, SimError> {
    let mut drops = fill(plan, world)?;
    drops.par_iter_mut().for_each(|drop| *drop = world.step_begin(drop));
    drops.retain(|drop| drop.kind() != STEP_GONE);
    Ok(drops)
}

/// Inputs of a step.
fn world<'a>(
    frame: &'a StepFrame,
    speeds: &'a [f32],
    sizes: &'a [[f32; ENTER_SIZES as usize]],
    regions: &'a [EnterRegion],
    input: &StepInput<'a>,
) -> StepWorld<'a> {
    StepWorld { frame, speeds, sizes, regions, field: input.field, map: input.map }
}

/// A drop relative to the origin after the step.
fn shifted(drop: &StepDrop, frame: &StepFrame) -> StepDrop {
    let position = Vec3::from(drop.position) - Vec3::from(frame.shift);
    StepDrop { position: position.to_array(), ..*drop }
}

/// Events of some of the drops.
#[derive(Default)]
struct EventRecord {
    events: Vec<StepEvent>,
    caught: StepCaught,
}

impl EventRecord {
    /// Records the events of a drop.
    fn add(&mut self, made: StepMade) -> StepDrop {
        self.events.extend(made.event);
        if let Some(volume) = made.caught {
            self.caught.drops += 1;
            self.caught.volume += u64::from(volume);
        }
        made.drop
    }

    /// Appends to the events; `room` is the number of events that may still be recorded.
    fn append_to(self, room: &mut usize, outcome: &mut StepEvents) {
        let recorded = self.events.len().min(*room);
        *room -= recorded;
        outcome.overflow += (self.events.len() - recorded) as u64;
        outcome.events.extend_from_slice(&self.events[..recorded]);
        outcome.caught.drops += self.caught.drops;
        outcome.caught.volume += self.caught.volume;
    }
}

/// Initial drops of a volume with a constant number of drops, at rest in the surrounding air.
fn begin(
    plan: &Plan,
    population: &Population,
    speeds: &[f32],
    input: &StepInput<'_>,
) -> Result<Vec<StepDrop>, SimError> {
    let count = population.sizes.len();
    let mut drops = Vec::new();
    drops.try_reserve_exact(count).map_err(|_| SimError::memory(count as u64))?;
    let options = &plan.options;
    drops.par_extend(population.sizes.par_iter().enumerate().map(|(number, &size)| {
        let (at, count) =
            initial_position(number as u32, &options.volume, plan.view(), plan.origin(), options.seed);
        let speed = speed_of(speeds, motion_diameter(size.into()));
        let wind = input.field.map_or(input.wind, |field| field.sample(at));
        let open = input.map.is_none_or(|map| map.open(at));
        let kind = if open { STEP_FALLING } else { STEP_HIDDEN };
        StepDrop {
            position: at.to_array(),
            word: step_word(size.into(), kind, count),
            velocity: motion_settled(wind, speed).to_array(),
            last: 0,
        }
    }));
    Ok(drops)
}
