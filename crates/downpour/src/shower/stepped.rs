//! Rain step by step before an eye: its volume, the map of what stops it, the field of its wind.
//!
//! Time goes by sixtieths of a second that are counted from time 0, whatever pictures are taken and whichever is the first.
//! A picture shows the last state before its shutter opens, gone on from there; nothing of that is stored. Wind and map are
//! looked at every tenth of a second, and made anew where they have changed. So neither the frame rate nor other pictures have a say.
//!
//! Rain in view forgets: its drops depend on the last seconds alone, and whoever seeks simulates those. Rain in a box or a
//! cylinder remembers: it is simulated from time 0 on, up to a minute; a rain that is first looked at later begins then.

#[cfg(feature = "wgpu")]
mod device;

use std::sync::Arc;

use downpour_bvh::{BvhNode, BvhTriangle};
use downpour_drop::distribution::DropSizeDistribution;
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::field::VisibleDrops;
use downpour_sim::impacts::SplashOptions;
use downpour_sim::simulation::{Drag, SimVolume, Simulation, SimulationOptions, StepInput, least_pixels};
use downpour_sim::view::View;
use downpour_weather::{RAIN_BOX_M, RainDrag, RainVolume, Weather};
use downpour_wind::turbulence::WindTurbulenceMode;
use downpour_wind::{UniformWindAt, WindField, WindGrid, WindMask, WindPrimitive};
use glam::{DVec3, Vec3};

#[cfg(feature = "wgpu")]
use device::SteppedOnGpu;
#[cfg(feature = "wgpu")]
pub use device::SteppedPicture;

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

/// Impacts of a step that may show splashes, at most: there is room for so many on a device.
const MAX_SPLASHES: u32 = 1 << 15;

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
    drops: StepDrops,
    /// Steps from time 0 to the state.
    step: i64,
    step_scenery: StepScenery,
    /// True if the next step looks at wind and map, whatever its number: the weather has changed.
    is_stale: bool,
}

/// The drops, on what steps them.
#[derive(Clone, Debug)]
enum StepDrops {
    Cpu(Box<Simulation>),
    #[cfg(feature = "wgpu")]
    Device(SteppedOnGpu),
}

/// A device that steps drops in place of the CPU.
#[cfg(feature = "wgpu")]
type StepDevice = downpour_gpu::Gpu;
/// There is none without the feature `wgpu`.
#[cfg(not(feature = "wgpu"))]
type StepDevice = std::convert::Infallible;

impl StepDrops {
    /// Begins with the drops of a simulation, on a device if there is one.
    fn new(simulation: Simulation, device: Option<&StepDevice>) -> Result<Self, ShowerError> {
        match device {
            #[cfg(feature = "wgpu")]
            Some(gpu) => Ok(Self::Device(SteppedOnGpu::new(gpu, &simulation)?)),
            #[cfg(not(feature = "wgpu"))]
            Some(never) => match *never {},
            None => Ok(Self::Cpu(Box::new(simulation))),
        }
    }

    /// True if a device steps them, or the CPU without one.
    fn are_on(&self, device: Option<&StepDevice>) -> bool {
        match (self, device) {
            (Self::Cpu(_), None) => true,
            #[cfg(feature = "wgpu")]
            (Self::Device(on), Some(gpu)) => on.is_on(gpu),
            _ => false,
        }
    }

    /// Makes a step.
    fn step(
        &mut self,
        scenery: &StepScenery,
        view: &View,
        air: &UniformWindAt<'_>,
    ) -> Result<(), ShowerError> {
        match self {
            Self::Cpu(simulation) => {
                simulation.advance(1.0 / STEPS_PER_S, &scenery.input(view, air))?;
                Ok(())
            }
            #[cfg(feature = "wgpu")]
            Self::Device(on) => on.step(scenery, view, air),
        }
    }

    /// Drops that a picture can show some time after the state, s.
    fn visible_after(
        &self,
        after_s: f64,
        view: &View,
        map: Option<&CollisionMap>,
        splashes: Option<&SplashOptions>,
    ) -> Result<VisibleDrops, ShowerError> {
        match self {
            Self::Cpu(simulation) => Ok(simulation.visible_after(after_s, view, map, splashes)),
            #[cfg(feature = "wgpu")]
            Self::Device(on) => on.visible_after(after_s, view, map, splashes),
        }
    }

    fn measured_rate_mm_h(&self, map: Option<&CollisionMap>) -> Result<f64, ShowerError> {
        match self {
            Self::Cpu(simulation) => Ok(simulation.measured_rate_mm_h(map)),
            #[cfg(feature = "wgpu")]
            Self::Device(on) => on.measured_rate_mm_h(map),
        }
    }
}

/// Obstacles and wind of the drops.
#[derive(Clone, Debug)]
struct StepScenery {
    /// Digest of the scene that the map was made of.
    made_of: Option<(u64, CollisionOptions)>,
    map: Option<Arc<CollisionMap>>,
    wind: Option<Arc<Blown>>,
    /// Origin of map and field.
    origin: DVec3,
}

/// A wind that differs from place to place, and what its field was made of beside the map.
#[derive(Clone, Debug)]
struct Blown {
    parts: Vec<WindPrimitive>,
    modes: Vec<WindTurbulenceMode>,
    grid: WindGrid,
    mask: Arc<WindMask>,
    /// Its cells; `None` where a device fills them.
    field: Option<WindField>,
}

impl StepScenery {
    /// The state at the end of a step on the CPU.
    fn input<'a>(&'a self, view: &'a View, air: &'a UniformWindAt<'a>) -> StepInput<'a> {
        StepInput {
            field: self.wind.as_ref().and_then(|wind| wind.field.as_ref()),
            map: self.map.as_deref(),
            air: Some(air),
            ..StepInput::new(view, self.origin, air.velocity().as_vec3())
        }
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
            // Only splashes take them up.
            max_events: 0,
            max_kept: if weather.splashes.is_enabled { MAX_SPLASHES } else { 0 },
            ..SimulationOptions::default()
        };
        let speeds = TerminalSpeed::new(law.options().fall_speed, &law.options().air);
        Self { law, speeds, weather: weather.clone(), options, least_pixels: None, running: None }
    }

    /// Takes over the drops of the same rain in another wind or before another camera; of the same camera what was asked once, too.
    pub(super) fn go_on_from(&mut self, other: &Self) {
        self.running = other.running.clone().map(|running| Running { is_stale: true, ..running });
        let (weather, before) = (&self.weather, &other.weather);
        if weather.camera == before.camera && weather.size == before.size {
            self.options.clone_from(&other.options);
            self.least_pixels = other.least_pixels;
        }
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
        splashes: Option<&SplashOptions>,
        passed: &mut dyn FnMut(u32, u32),
    ) -> Result<VisibleDrops, ShowerError> {
        let (running, view, after_s) = self.run(None, scenery, frame_scene, time_s, passed)?;
        let now = self.map_now(scenery, frame_scene, &view, &running.step_scenery, time_s)?;
        let map = now.as_ref().or(running.step_scenery.map.as_deref());
        let visible = running.drops.visible_after(after_s, &view, map, splashes)?;
        self.running = Some(running);
        Ok(visible)
    }

    /// The same on a device, which lists the drops for the picture; with the view that it is of.
    #[cfg(feature = "wgpu")]
    pub(super) fn on_device(
        &mut self,
        gpu: &downpour_gpu::Gpu,
        scenery: &dyn Scenery,
        frame_scene: &FrameScene,
        time_s: f64,
        passed: &mut dyn FnMut(u32, u32),
    ) -> Result<(View, SteppedPicture), ShowerError> {
        let (running, view, after_s) = self.run(Some(gpu), scenery, frame_scene, time_s, passed)?;
        let now = self.map_now(scenery, frame_scene, &view, &running.step_scenery, time_s)?;
        let on = match &running.drops {
            StepDrops::Device(on) => on.clone(),
            StepDrops::Cpu(simulation) => SteppedOnGpu::new(gpu, simulation)?,
        };
        let picture = on.picture(&view, after_s, &running.step_scenery, now.as_ref())?;
        self.running = Some(running);
        Ok((view, picture))
    }

    /// Steps the drops up to the last whole step before the shutter of a picture opens; the view of that picture, and the time
    /// from there to the picture, s.
    fn run(
        &mut self,
        device: Option<&StepDevice>,
        scenery: &dyn Scenery,
        frame_scene: &FrameScene,
        time_s: f64,
        passed: &mut dyn FnMut(u32, u32),
    ) -> Result<(Running, View, f64), ShowerError> {
        self.begin(scenery)?;
        let view = self.viewed(frame_scene.view()?);
        let open_s = time_s - 0.5 * view.shutter_s;
        // Times that are meant to be whole steps are, in spite of rounding.
        let step = (open_s * STEPS_PER_S + 1.0e-6).floor() as i64;
        let memory =
            if self.forgets() { (self.options.oldest_s * STEPS_PER_S).ceil() as i64 + 1 } else { REMEMBERED };
        let last = self.running.take().filter(|last| last.drops.are_on(device));
        let mut running = match last.filter(|last| (0..=memory).contains(&(step - last.step))) {
            Some(last) => last,
            None => {
                let first = if self.forgets() {
                    step - memory
                } else if (0..=REMEMBERED).contains(&step) {
                    -STEPS_BEFORE
                } else {
                    step - STEPS_BEFORE
                };
                self.started(device, scenery, first.div_euclid(STEPS_PER_WIND) * STEPS_PER_WIND)?
            }
        };
        let all = (step - running.step) as u32;
        for done in 1..=all {
            running.step += 1;
            let now_s = running.step as f64 / STEPS_PER_S;
            if running.step % STEPS_PER_WIND == 0 || std::mem::take(&mut running.is_stale) {
                let before = Some(running.step_scenery);
                running.step_scenery = self.step_scenery(scenery, now_s, before, device.is_none())?;
            }
            let view = self.view(scenery, now_s)?;
            let air = self.weather.wind.air().prepared(now_s);
            running.drops.step(&running.step_scenery, &view, &air)?;
            passed(done, all);
        }
        let after_s = (time_s - running.step as f64 / STEPS_PER_S).max(0.0);
        Ok((running, view, after_s))
    }

    /// The map of where things are in a picture of a scene in which they move; the next step is not told of it. `None` where that of
    /// the steps serves.
    fn map_now(
        &self,
        scenery: &dyn Scenery,
        frame_scene: &FrameScene,
        view: &View,
        step_scenery: &StepScenery,
        time_s: f64,
    ) -> Result<Option<CollisionMap>, ShowerError> {
        if scenery.has_still_things() || frame_scene.origin != step_scenery.origin {
            return Ok(None);
        }
        let wind = self.weather.wind.air().velocity(time_s).as_vec3();
        Ok(self.map(frame_scene, false, &[*view], wind, None)?.and_then(|(_, map)| map))
    }

    /// The wind that a step at a time meets.
    pub(super) fn wind_field(
        &mut self,
        scenery: &dyn Scenery,
        time_s: f64,
    ) -> Result<Option<WindField>, ShowerError> {
        self.begin(scenery)?;
        let wind = self.step_scenery(scenery, time_s, None, true)?.wind;
        Ok(wind.and_then(|wind| wind.field.clone()))
    }

    pub(super) fn measured_rate_mm_h(&self) -> Result<f64, ShowerError> {
        let Some(running) = &self.running else { return Ok(0.0) };
        running.drops.measured_rate_mm_h(running.step_scenery.map.as_deref())
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
        self.options.shutter_s = self.weather.longest_drop_exposure_s();
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

    /// The view in the middle of the time that pictures of a state cover, as wide and as fine as any of them: they may zoom meanwhile.
    fn view(&self, scenery: &dyn Scenery, time_s: f64) -> Result<View, ShowerError> {
        let horizon_s = self.options.shutter_s + self.options.wait_s;
        let [begin, middle, end] = [0.0, 0.5, 1.0].map(|part| scenery.view(time_s + part * horizon_s));
        let mut view = middle?;
        for at in [begin?, end?] {
            view.half_width = view.half_width.max(at.half_width);
            view.half_height = view.half_height.max(at.half_height);
            view.pixel_angle = view.pixel_angle.min(at.pixel_angle);
        }
        Ok(self.viewed(view))
    }

    /// A rain that begins at a step.
    fn started(
        &self,
        device: Option<&StepDevice>,
        scenery: &dyn Scenery,
        step: i64,
    ) -> Result<Running, ShowerError> {
        let time_s = step as f64 / STEPS_PER_S;
        let step_scenery = self.step_scenery(scenery, time_s, None, true)?;
        let view = self.view(scenery, time_s)?;
        let air = self.weather.wind.air().prepared(time_s);
        let options = SimulationOptions {
            first_step: (STEP_ZERO + step).clamp(1, i64::from(u32::MAX)) as u32,
            // What a view may hold is in its least diameter.
            max_drops: if self.forgets() { 1 << 28 } else { self.options.max_drops },
            ..self.options.clone()
        };
        let simulation = Simulation::new(&self.law, &options, &step_scenery.input(&view, &air))?;
        Ok(Running { drops: StepDrops::new(simulation, device)?, step, step_scenery, is_stale: false })
    }

    /// Wind and map for the steps from a time on until they are made anew. `has_cells`: the CPU fills the cells of the wind.
    fn step_scenery(
        &self,
        scenery: &dyn Scenery,
        time_s: f64,
        before: Option<StepScenery>,
        has_cells: bool,
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
        let made = self.map(&frame_scene, scenery.has_still_things(), &views, wind, before.made_of)?;
        // A field knows the map that it was made with.
        let same_map = matches!(made, Some((_, None))) || (made.is_none() && before.made_of.is_none());
        let known = before.wind.filter(|_| same_map && before.origin == frame_scene.origin);
        let (made_of, map) = match made {
            Some((made_of, map)) => (Some(made_of), map.map(Arc::new).or(before.map)),
            None => (None, None),
        };
        let wind = if uniform {
            None
        } else {
            Some(self.blown(&frame_scene, &views[0], time_s, map.as_deref(), known, has_cells)?)
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

    /// The wind at a time in the cells around the eye; what is `known` where it is the same.
    fn blown(
        &self,
        frame_scene: &FrameScene,
        view: &View,
        time_s: f64,
        map: Option<&CollisionMap>,
        known: Option<Arc<Blown>>,
        has_cells: bool,
    ) -> Result<Arc<Blown>, ShowerError> {
        let wind = &self.weather.wind;
        let grid = self.weather.wind_box.grid(view.eye)?;
        let (parts, modes) = (wind.at(time_s), wind.modes(time_s, &grid));
        if let Some(known) = &known
            && (&known.parts, &known.modes, known.grid) == (&parts, &modes, grid)
            && known.field.is_some() == has_cells
        {
            return Ok(Arc::clone(known));
        }
        let origin = frame_scene.origin.as_vec3();
        let mask = match (known.filter(|known| known.grid == grid), map) {
            (Some(known), _) => Arc::clone(&known.mask),
            (None, Some(map)) => Arc::new(WindMask::from_fn(&grid, |at| map.inside(at - origin))),
            (None, None) => Arc::new(WindMask::open(&grid)),
        };
        let cells = || WindField::with_turbulence(&grid, &parts, &modes, &mask);
        let field = has_cells.then(cells).transpose()?.map(|field| field.relative_to(frame_scene.origin));
        Ok(Arc::new(Blown { parts, modes, grid, mask, field }))
    }

    /// Part of the scene that the map has to cover; `None` without obstacles.
    fn region(
        &self,
        frame_scene: &FrameScene,
        views: &[View],
        wind: Vec3,
    ) -> Result<Option<CollisionOptions>, ShowerError> {
        let Some([lowest, highest]) = frame_scene.data.bounding_box() else { return Ok(None) };
        let each = views.iter().map(|view| self.reached(frame_scene, view));
        let (low, high) = each
            .reduce(|(low, high), (a, b)| (low.min(a), high.max(b)))
            .unwrap_or((DVec3::ZERO, DVec3::ZERO));
        // A meter more: drops that are on their way into the picture are above it.
        let low = (low.as_vec3() - 1.0).max(lowest) - 0.1;
        let high = (high.as_vec3() + 1.0).min(highest) + 0.1;
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
