//! Rain step by step before an eye: its volume, the map of what stops it, the field of its wind.
//!
//! Time goes by sixtieths of a second that are counted from time 0, whatever pictures are taken and whichever is the first.
//! A picture shows the last state before its shutter opens, gone on from there; nothing of that is stored. Wind and map are
//! looked at every tenth of a second, and made anew where they have changed. So neither the frame rate nor other pictures have a say.
//!
//! Rain in view forgets: its drops depend on the last seconds alone, and whoever seeks simulates those. Rain in a box or a
//! cylinder remembers: it is simulated from time 0 on, up to a minute; a rain that is first looked at later begins then.

use downpour_bvh::{BvhNode, BvhTriangle};
use downpour_drop::distribution::DropSizeDistribution;
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::field::VisibleDrops;
use downpour_sim::simulation::{Drag, SimVolume, Simulation, SimulationOptions, StepInput, least_pixels};
use downpour_sim::view::View;
use downpour_weather::{RAIN_BOX_M, RainDrag, RainVolume, Weather};
use downpour_wind::turbulence::WindTurbulenceMode;
use downpour_wind::{WindField, WindGrid, WindMask, WindPrimitive};
use glam::{DVec3, Vec3};

use super::scenery::Scenery;
use super::{ShowerError, bounce};
use downpour_trace::frame_scene::FrameScene;

/// Steps of a second.
const STEPS_PER_S: f64 = 60.0;

/// The wind and the map are made anew after so many steps.
const STEPS_PER_WIND: i64 = 6;

/// A rain that remembers has fallen for so many steps before time 0: drops have bounced by then.
const STEPS_BEFORE: i64 = 30;

/// A rain that remembers is simulated from time 0 where it is first looked at after no more steps than this.
const REMEMBERED: i64 = 3600;

/// The number of the step at time 0: those before it have numbers too.
const STEP_ZERO: i64 = 1 << 30;

/// Times, s, for which drops may be in view.
const OLDEST_S: [f64; 2] = [2.0, 32.0];

/// Edge of a texel of the map of what stops drops, m, where the map is not too large for it.
const TEXEL_M: f32 = 0.06;

/// The most texels along an edge of it.
const MAX_TEXELS: f32 = 512.0;

/// Steps of the slope at which the map looks.
const SLOPE_STEP: f32 = 0.125;

/// The map looks at most so far from straight down: tan of the angle.
const STEEPEST: f32 = 4.0;

/// A rain that goes from picture to picture.
#[derive(Clone, Debug)]
pub(super) struct Stepped {
    law: DropSizeDistribution,
    speeds: TerminalSpeed,
    weather: Weather,
    options: SimulationOptions,
    /// The least diameter on the picture, pixels, of drops in view; known from the first question on.
    least_pixels: Option<f64>,
    running: Option<Running>,
}

#[derive(Clone, Debug)]
struct Running {
    simulation: Simulation,
    /// Steps from time 0 to the state.
    step: i64,
    step_scenery: StepScenery,
    /// True if the next step looks at wind and map, whatever its number: the weather has changed.
    is_stale: bool,
}

/// Obstacles and wind of the drops.
#[derive(Clone, Debug)]
struct StepScenery {
    /// Digest of the scene that the map was made of.
    made_of: Option<(u64, CollisionOptions)>,
    map: Option<CollisionMap>,
    wind: Option<Blown>,
    /// Origin of map and field.
    origin: DVec3,
}

/// A wind that differs from place to place, and what its field was made of beside the map.
#[derive(Clone, Debug)]
struct Blown {
    parts: Vec<WindPrimitive>,
    modes: Vec<WindTurbulenceMode>,
    grid: WindGrid,
    field: WindField,
}

impl StepScenery {
    fn field(&self) -> Option<&WindField> {
        self.wind.as_ref().map(|wind| &wind.field)
    }
}

impl Stepped {
    pub(super) fn new(law: DropSizeDistribution, weather: &Weather) -> Self {
        let rain = &weather.rain;
        let size_m = [rain.box_m.unwrap_or(RAIN_BOX_M); 3];
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
            max_drops: rain.max_drops,
            wait_s: 1.0 / STEPS_PER_S,
            drag: match rain.drag {
                RainDrag::Rousseau2008 => Drag::Rousseau2008,
                _ => Drag::Relaxation,
            },
            bounce: bounce(rain),
            // Nothing takes them up yet.
            max_events: 0,
            ..SimulationOptions::default()
        };
        let speeds = TerminalSpeed::new(law.options().fall_speed, &law.options().air);
        Self { law, speeds, weather: weather.clone(), options, least_pixels: None, running: None }
    }

    /// Takes over the drops of the same rain in another wind or before another camera.
    pub(super) fn go_on_from(&mut self, other: &Self) {
        self.running = other.running.clone().map(|running| Running { is_stale: true, ..running });
    }

    /// True if the rain of a time depends on the recent past alone.
    pub(super) fn forgets(&self) -> bool {
        self.options.volume == SimVolume::View
    }

    /// The drops of a picture at a time. `passed` is told the steps that are done, and how many there are to do.
    pub(super) fn at(
        &mut self,
        scenery: &dyn Scenery,
        frame_scene: &FrameScene,
        time_s: f64,
        passed: &mut dyn FnMut(u32, u32),
    ) -> Result<VisibleDrops, ShowerError> {
        self.begin(scenery)?;
        let view = self.viewed(frame_scene.view()?);
        let open_s = time_s - 0.5 * view.shutter_s;
        // Times that are meant to be whole steps are, in spite of rounding.
        let step = (open_s * STEPS_PER_S + 1.0e-6).floor() as i64;
        let memory =
            if self.forgets() { (self.options.oldest_s * STEPS_PER_S).ceil() as i64 + 1 } else { REMEMBERED };
        let last = self.running.take().filter(|last| (0..=memory).contains(&(step - last.step)));
        let mut running = match last {
            Some(last) => last,
            None => {
                let first = if self.forgets() {
                    step - memory
                } else if (0..=REMEMBERED).contains(&step) {
                    -STEPS_BEFORE
                } else {
                    step - STEPS_BEFORE
                };
                self.started(scenery, first.div_euclid(STEPS_PER_WIND) * STEPS_PER_WIND)?
            }
        };
        let all = (step - running.step) as u32;
        for done in 1..=all {
            running.step += 1;
            let now_s = running.step as f64 / STEPS_PER_S;
            if running.step % STEPS_PER_WIND == 0 || std::mem::take(&mut running.is_stale) {
                running.step_scenery = self.step_scenery(scenery, now_s, Some(running.step_scenery))?;
            }
            let view = self.view(scenery, now_s)?;
            let air = self.weather.wind.air().prepared(now_s);
            let step_scenery = &running.step_scenery;
            let moment = StepInput {
                field: step_scenery.field(),
                map: step_scenery.map.as_ref(),
                air: Some(&air),
                ..StepInput::new(&view, step_scenery.origin, air.velocity().as_vec3())
            };
            running.simulation.advance(1.0 / STEPS_PER_S, &moment)?;
            passed(done, all);
        }
        let after_s = (time_s - running.step as f64 / STEPS_PER_S).max(0.0);
        let visible = if scenery.is_still() {
            running.simulation.visible_after(after_s, &view, running.step_scenery.map.as_ref())
        } else {
            // Where things are in this picture; the next step is not told of it.
            let wind = self.weather.wind.air().velocity(time_s).as_vec3();
            let made = self.map(frame_scene, false, &[view], wind, None)?;
            let map = made.as_ref().and_then(|(_, map)| map.as_ref());
            let map = map.filter(|_| frame_scene.origin == running.step_scenery.origin);
            running.simulation.visible_after(after_s, &view, map.or(running.step_scenery.map.as_ref()))
        };
        self.running = Some(running);
        Ok(visible)
    }

    /// The wind that a step at a time meets.
    pub(super) fn wind_field(
        &mut self,
        scenery: &dyn Scenery,
        time_s: f64,
    ) -> Result<Option<WindField>, ShowerError> {
        self.begin(scenery)?;
        Ok(self.step_scenery(scenery, time_s, None)?.wind.map(|wind| wind.field))
    }

    pub(super) fn measured_rate_mm_h(&self) -> f64 {
        let measured =
            |running: &Running| running.simulation.measured_rate_mm_h(running.step_scenery.map.as_ref());
        self.running.as_ref().map_or(0.0, measured)
    }

    /// Sets what is asked once: at time 0, so that it does not depend on the first picture.
    fn begin(&mut self, scenery: &dyn Scenery) -> Result<(), ShowerError> {
        if self.least_pixels.is_some() {
            return Ok(());
        }
        let view = scenery.view(0.0)?;
        if let SimVolume::Cylinder { base_m, height_m, .. } = &mut self.options.volume
            && self.weather.rain.cylinder.base_m.is_none()
        {
            *base_m = (view.eye - DVec3::Y * (0.5 * *height_m)).to_array();
        }
        self.options.shutter_s = view.shutter_s;
        let least =
            if self.forgets() { least_pixels(&self.law, &self.options, &view)? } else { view.least_pixels };
        self.least_pixels = Some(least);
        // The longest way through the picture, with some room for the wind.
        let options = self.law.options();
        let (smallest, largest) = (options.min_diameter_m, options.max_diameter_m);
        let longest = (0..64)
            .map(|k| smallest + (largest - smallest) * f64::from(k) / 63.0)
            .filter_map(|d| Some(view.range(d, least) / self.speeds.at(d).ok()?.max(0.01)))
            .fold(0.0, f64::max);
        let [shortest, oldest] = OLDEST_S;
        let doubled = std::iter::successors(Some(shortest), |time| Some(time * 2.0));
        let enough = doubled.take_while(|&time| time <= oldest).find(|&time| time >= 1.5 * longest);
        self.options.oldest_s = enough.unwrap_or(oldest);
        Ok(())
    }

    /// A view as its drops are simulated.
    fn viewed(&self, view: View) -> View {
        View { least_pixels: self.least_pixels.unwrap_or(view.least_pixels), ..view }
    }

    /// The view in the middle of the time that pictures of a state cover.
    fn view(&self, scenery: &dyn Scenery, time_s: f64) -> Result<View, ShowerError> {
        let horizon_s = self.options.shutter_s + self.options.wait_s;
        Ok(self.viewed(scenery.view(time_s + 0.5 * horizon_s)?))
    }

    /// A rain that begins at a step.
    fn started(&self, scenery: &dyn Scenery, step: i64) -> Result<Running, ShowerError> {
        let time_s = step as f64 / STEPS_PER_S;
        let step_scenery = self.step_scenery(scenery, time_s, None)?;
        let view = self.view(scenery, time_s)?;
        let air = self.weather.wind.air().prepared(time_s);
        let moment = StepInput {
            field: step_scenery.field(),
            map: step_scenery.map.as_ref(),
            air: Some(&air),
            ..StepInput::new(&view, step_scenery.origin, air.velocity().as_vec3())
        };
        let options = SimulationOptions {
            first_step: (STEP_ZERO + step).clamp(1, i64::from(u32::MAX)) as u32,
            // What a view may hold is in its least diameter.
            max_drops: if self.forgets() { 1 << 28 } else { self.options.max_drops },
            ..self.options.clone()
        };
        let simulation = Simulation::new(&self.law, &options, &moment)?;
        Ok(Running { simulation, step, step_scenery, is_stale: false })
    }

    /// Wind and map for the steps from a time on until they are made anew.
    fn step_scenery(
        &self,
        scenery: &dyn Scenery,
        time_s: f64,
        before: Option<StepScenery>,
    ) -> Result<StepScenery, ShowerError> {
        let frame_scene = scenery.frame_scene(time_s)?;
        let wind = self.weather.wind.air().velocity(time_s).as_vec3();
        let uniform = self.weather.wind.uniform().is_some();
        let lasts_s = STEPS_PER_WIND as f64 / STEPS_PER_S;
        let views = if scenery.is_still() {
            vec![self.view(scenery, time_s)?]
        } else {
            let at = |share: f64| self.view(scenery, time_s + share * lasts_s);
            vec![at(0.0)?, at(0.5)?, at(1.0)?]
        };
        let before = before.unwrap_or(StepScenery {
            made_of: None,
            map: None,
            wind: None,
            origin: frame_scene.origin,
        });
        let made = self.map(&frame_scene, scenery.is_still(), &views, wind, before.made_of)?;
        // A field knows the map that it was made with.
        let same_map = matches!(made, Some((_, None))) || (made.is_none() && before.made_of.is_none());
        let known = before.wind.filter(|_| same_map && before.origin == frame_scene.origin);
        let (made_of, map) = match made {
            Some((made_of, map)) => (Some(made_of), map.or(before.map)),
            None => (None, None),
        };
        let wind = if uniform {
            None
        } else {
            Some(self.blown(&frame_scene, &views[0], time_s, map.as_ref(), known)?)
        };
        Ok(StepScenery { made_of, map, wind, origin: frame_scene.origin })
    }

    /// The map of what stops drops in some views, and what it is made of (of a scene that stands still the options alone say
    /// it); no map where that is what is known already. `None` where nothing stands.
    #[expect(clippy::type_complexity, reason = "a map and its making")]
    fn map(
        &self,
        frame_scene: &FrameScene,
        still: bool,
        views: &[View],
        wind: Vec3,
        known: Option<(u64, CollisionOptions)>,
    ) -> Result<Option<((u64, CollisionOptions), Option<CollisionMap>)>, ShowerError> {
        let Some(options) = self.region(frame_scene, views, wind)? else { return Ok(None) };
        let scene = if still { 0 } else { digest(&frame_scene.data.nodes, &frame_scene.data.triangles) };
        let made_of = (scene, options);
        if known == Some(made_of) {
            return Ok(Some((made_of, None)));
        }
        let map = CollisionMap::from_arrays(
            &options,
            &frame_scene.data.nodes,
            &frame_scene.data.triangles,
            Some(&frame_scene.data),
        )?;
        Ok(Some((made_of, Some(map))))
    }

    /// The wind at a time in the cells round the eye; what is `known` where it is the same.
    fn blown(
        &self,
        frame_scene: &FrameScene,
        view: &View,
        time_s: f64,
        map: Option<&CollisionMap>,
        known: Option<Blown>,
    ) -> Result<Blown, ShowerError> {
        let wind = &self.weather.wind;
        let grid = self.weather.wind_box.grid(view.eye)?;
        let (parts, modes) = (wind.at(time_s), wind.modes(time_s, &grid));
        if let Some(known) = known
            && (&known.parts, &known.modes, known.grid) == (&parts, &modes, grid)
        {
            return Ok(known);
        }
        let origin = frame_scene.origin.as_vec3();
        let mask = match map {
            Some(map) => WindMask::from_fn(&grid, |at| map.inside(at - origin)),
            None => WindMask::open(&grid),
        };
        let field = WindField::with_turbulence(&grid, &parts, &modes, &mask)?.relative_to(frame_scene.origin);
        Ok(Blown { parts, modes, grid, field })
    }

    /// Part of the scene that the map has to cover; `None` without obstacles.
    fn region(
        &self,
        frame_scene: &FrameScene,
        views: &[View],
        wind: Vec3,
    ) -> Result<Option<CollisionOptions>, ShowerError> {
        let (Some(root), false) = (frame_scene.data.nodes.first(), frame_scene.data.triangles.is_empty())
        else {
            return Ok(None);
        };
        let each = views.iter().map(|view| self.reached(frame_scene, view));
        let (low, high) = each
            .reduce(|(low, high), (a, b)| (low.min(a), high.max(b)))
            .unwrap_or((DVec3::ZERO, DVec3::ZERO));
        // A meter more: drops that are on their way into the picture are above it.
        let low = (low.as_vec3() - 1.0).max(Vec3::from(root.low)) - 0.1;
        let high = (high.as_vec3() + 1.0).min(Vec3::from(root.high)) + 0.1;
        if low.cmpge(high).any() {
            return Ok(None);
        }
        // Half of the water falls faster, half slower.
        let speed = self.speeds.at(self.law.median_volume_diameter()).unwrap_or(6.0) as f32;
        let mut options = CollisionOptions::covering(low, high, slanted(wind, speed), [1, 1])?;
        options.texels = options.size.map(|edge| (edge / TEXEL_M).clamp(16.0, MAX_TEXELS) as u32);
        Ok(Some(options))
    }

    /// A box, relative to the scene's origin, that holds the drops of a view.
    fn reached(&self, frame_scene: &FrameScene, view: &View) -> (DVec3, DVec3) {
        let eye = view.eye - frame_scene.origin;
        match self.options.volume {
            SimVolume::Box { size_m } | SimVolume::Tariq { size_m } => {
                (eye - DVec3::from(size_m), eye + DVec3::from(size_m))
            }
            SimVolume::Cylinder { base_m, radius_m, height_m } => {
                let base = DVec3::from(base_m) - frame_scene.origin;
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
        }
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
