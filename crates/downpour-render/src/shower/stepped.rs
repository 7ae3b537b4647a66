//! Rain step by step before an eye: its volume, the map of what stops it, the field of its wind.

use downpour_bvh::{BvhNode, BvhTriangle};
use downpour_drop::distribution::DropSizeDistribution;
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_scene::weather::{RainDrag, RainVolume, Weather};
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::field::VisibleDrops;
use downpour_sim::simulation::{Bounce, Drag, Moment, SimVolume, Simulation, SimulationOptions};
use downpour_sim::view::View;
use downpour_wind::{WindField, WindMask};
use glam::{DVec3, Vec3};

use super::ShowerError;
use crate::stage::Stage;

/// Side of a box of rain where the weather does not say, m.
const BOX_M: f64 = 10.0;

/// A rain has fallen for so long before its first picture, s: drops have bounced by then.
const BEFORE_S: f64 = 0.5;

/// Pictures that are farther apart are two rains, s.
const APART_S: f64 = 10.0;

/// The longest step, s.
const STEP_S: f64 = 1.0 / 60.0;

/// The wind and the map are made anew after so many steps, and for each picture.
const STEPS_PER_WIND: u32 = 6;

/// Edge of a texel of the map of what stops drops, m, where the map is not too large for it.
const TEXEL_M: f32 = 0.06;

/// The most texels along an edge of it.
const MOST_TEXELS: f32 = 512.0;

/// Steps of the slope at which the map looks.
const SLOPE_STEP: f32 = 0.125;

/// The map looks at most so far from straight down: tan of the angle.
const STEEPEST: f32 = 4.0;

/// A rain that goes from picture to picture.
#[derive(Clone, Debug)]
pub(super) struct Stepped {
    law: DropSizeDistribution,
    speed: f32,
    weather: Weather,
    options: SimulationOptions,
    running: Option<Running>,
}

#[derive(Clone, Debug)]
struct Running {
    simulation: Simulation,
    time_s: f64,
    surroundings: Surroundings,
}

/// What the drops meet.
#[derive(Clone, Debug)]
struct Surroundings {
    /// What the map was made of.
    made_of: Option<(u64, CollisionOptions)>,
    map: Option<CollisionMap>,
    field: Option<WindField>,
    wind: Vec3,
}

impl Stepped {
    pub(super) fn new(law: DropSizeDistribution, weather: &Weather) -> Self {
        let rain = &weather.rain;
        let size_m = [rain.box_m.unwrap_or(BOX_M); 3];
        let bounce = &rain.bounce;
        let options = SimulationOptions {
            volume: match rain.volume {
                RainVolume::Box => SimVolume::Box { size_m },
                RainVolume::ImSung2022 => SimVolume::ImSung,
                RainVolume::Tariq2007 => SimVolume::Tariq { size_m },
                RainVolume::CreusPatow2013 => SimVolume::Cylinder {
                    base_m: rain.cylinder.base_m.unwrap_or_default(),
                    radius_m: rain.cylinder.radius_m,
                    height_m: rain.cylinder.height_m,
                },
                _ => SimVolume::View,
            },
            seed: rain.seed,
            most_drops: rain.most_drops,
            drag: match rain.drag {
                RainDrag::Rousseau2008 => Drag::Rousseau2008,
                _ => Drag::Relaxation,
            },
            bounce: Bounce {
                share: bounce.share as f32,
                restitution: bounce.restitution as f32,
                grip: bounce.grip as f32,
                size: bounce.size as f32,
                longest_s: bounce.longest_s as f32,
            },
            // Nothing takes them up yet.
            most_events: 0,
            gauge: None,
        };
        // Half of the water falls faster, half slower.
        let speeds = TerminalSpeed::new(law.options().fall_speed, &law.options().air);
        let speed = speeds.at(law.median_volume_diameter()).unwrap_or(6.0) as f32;
        Self { law, speed, weather: weather.clone(), options, running: None }
    }

    /// The drops at a time: those of the last picture, if that was not long before, have gone on.
    pub(super) fn at(
        &mut self,
        stage: &Stage,
        view: &View,
        time_s: f64,
    ) -> Result<VisibleDrops, ShowerError> {
        let last = self.running.take().filter(|last| (0.0..=APART_S).contains(&(time_s - last.time_s)));
        let mut running = match last {
            Some(last) => last,
            None => self.begin(stage, view, time_s - BEFORE_S)?,
        };
        let steps = ((time_s - running.time_s) / STEP_S - 1.0e-6).ceil().max(0.0);
        let step_s = (time_s - running.time_s) / steps.max(1.0);
        for step in 1..=steps as u32 {
            let now = running.time_s + step_s * f64::from(step);
            if step == 1 || step.is_multiple_of(STEPS_PER_WIND) {
                running.surroundings = self.surroundings(stage, view, now, running.surroundings)?;
            }
            let moment = running.surroundings.moment(view, stage.origin);
            running.simulation.advance(step_s, &moment)?;
        }
        running.time_s = time_s;
        let visible = running.simulation.visible(view);
        self.running = Some(running);
        Ok(visible)
    }

    pub(super) fn measured_rate_mm_h(&self) -> f64 {
        self.running.as_ref().map_or(0.0, |running| running.simulation.measured_rate_mm_h())
    }

    fn begin(&mut self, stage: &Stage, view: &View, time_s: f64) -> Result<Running, ShowerError> {
        if let SimVolume::Cylinder { base_m, height_m, .. } = &mut self.options.volume
            && self.weather.rain.cylinder.base_m.is_none()
        {
            *base_m = (view.eye - DVec3::Y * (0.5 * *height_m)).to_array();
        }
        let empty = Surroundings { made_of: None, map: None, field: None, wind: Vec3::ZERO };
        let surroundings = self.surroundings(stage, view, time_s, empty)?;
        let simulation = Simulation::new(&self.law, &self.options, &surroundings.moment(view, stage.origin))?;
        Ok(Running { simulation, time_s, surroundings })
    }

    fn surroundings(
        &self,
        stage: &Stage,
        view: &View,
        time_s: f64,
        before: Surroundings,
    ) -> Result<Surroundings, ShowerError> {
        let wind = self.weather.wind.air().velocity(time_s).as_vec3();
        let fall = slanted(wind, self.speed);
        let (made_of, map) = match self.region(stage, view, fall)? {
            None => (None, None),
            Some(options) => {
                let made_of = (digest(&stage.data.nodes, &stage.data.triangles), options);
                if before.made_of == Some(made_of) {
                    (before.made_of, before.map)
                } else {
                    let data = &stage.data;
                    let map = CollisionMap::from_arrays(&options, &data.nodes, &data.triangles, Some(data))?;
                    (Some(made_of), Some(map))
                }
            }
        };
        let uniform = self.weather.wind.uniform().is_some();
        let field = if uniform { None } else { Some(self.field(stage, view, time_s, map.as_ref())?) };
        Ok(Surroundings { made_of, map, field, wind })
    }

    fn field(
        &self,
        stage: &Stage,
        view: &View,
        time_s: f64,
        map: Option<&CollisionMap>,
    ) -> Result<WindField, ShowerError> {
        let grid = self.weather.wind_box.grid(view.eye)?;
        let origin = stage.origin.as_vec3();
        let mask = match map {
            Some(map) => WindMask::from_fn(&grid, |at| map.inside(at - origin)),
            None => WindMask::open(&grid),
        };
        let field = self.weather.wind.field(time_s, &grid, &mask)?;
        Ok(field.relative_to(stage.origin))
    }

    /// What of the scene the map has to cover; nothing where nothing stands.
    fn region(
        &self,
        stage: &Stage,
        view: &View,
        fall: Vec3,
    ) -> Result<Option<CollisionOptions>, ShowerError> {
        let (Some(root), false) = (stage.data.nodes.first(), stage.data.triangles.is_empty()) else {
            return Ok(None);
        };
        let eye = view.eye - stage.origin;
        let (low, high) = match self.options.volume {
            SimVolume::Box { size_m } | SimVolume::Tariq { size_m } => {
                (eye - DVec3::from(size_m), eye + DVec3::from(size_m))
            }
            SimVolume::Cylinder { base_m, radius_m, height_m } => {
                let base = DVec3::from(base_m) - stage.origin;
                let across = DVec3::new(radius_m, 0.0, radius_m);
                (base - across, base + across + DVec3::Y * height_m)
            }
            _ => {
                let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y)| {
                    let across = view.right * (x * view.half_width) + view.up * (y * view.half_height);
                    eye + (view.forward + across).normalize() * view.far
                });
                let all = corners.iter().chain([&eye]);
                all.fold((eye + view.forward * view.far, eye), |(low, high), &at| (low.min(at), high.max(at)))
            }
        };
        // A tenth of a metre more: drops that move on are still above it.
        let low = low.as_vec3().max(Vec3::from(root.low)) - 0.1;
        let high = high.as_vec3().min(Vec3::from(root.high)) + 0.1;
        if low.cmpge(high).any() {
            return Ok(None);
        }
        let mut options = CollisionOptions::covering(low, high, fall, [1, 1])?;
        options.texels = options.size.map(|edge| (edge / TEXEL_M).clamp(16.0, MOST_TEXELS) as u32);
        Ok(Some(options))
    }
}

impl Surroundings {
    fn moment<'a>(&'a self, view: &'a View, origin: DVec3) -> Moment<'a> {
        Moment { view, origin, wind: self.wind, field: self.field.as_ref(), map: self.map.as_ref() }
    }
}

/// The mean fall in a wind, no farther from down than a map looks.
fn slanted(wind: Vec3, speed: f32) -> Vec3 {
    let down = (speed - wind.y).max(0.1);
    let across = Vec3::new(wind.x, 0.0, wind.z);
    // In steps, so that gusts do not ask for a new map each time: drops that fall otherwise than the map looks are stopped too.
    let slope = (across / down).clamp_length_max(STEEPEST);
    let snapped = (slope / SLOPE_STEP).round() * SLOPE_STEP;
    (snapped - Vec3::Y).normalize()
}

/// A number that is the same for the same triangles.
fn digest(nodes: &[BvhNode], triangles: &[BvhTriangle]) -> u64 {
    let words = bytemuck::cast_slice::<_, u32>(nodes).iter().chain(bytemuck::cast_slice::<_, u32>(triangles));
    // FNV-1a, by words.
    words.fold(0xcbf2_9ce4_8422_2325, |hash, &word| (hash ^ u64::from(word)).wrapping_mul(0x0100_0000_01b3))
}
