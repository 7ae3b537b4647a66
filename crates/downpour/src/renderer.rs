//! A weather file in, frames out: one pipeline for a picture, a clip, a window and a program of your own.

mod clip_light;
mod computer;
mod display;
mod drops;
mod error;
mod flash;
mod frame;
#[cfg(feature = "wgpu")]
mod on_gpu;
mod set_weather;
mod shower_of_model;
mod source;
mod truth;

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use crate::shower::{MovingEye, MovingScenery, Scenery, Shower, ShowerError, Still};
use downpour_atlas::{StreakAtlas, StreakPick};
use downpour_render::camera::{Viewpoint, check_size};
use downpour_render::glass::WetPane;
use downpour_render::glow::Glow;
use downpour_render::picture::{PictureOptions, noise_seed};
use downpour_render::rain::light::{DropLightForm, DropLightOptions};
use downpour_render::rain::{DropMasks, EnvironmentFrame, Exposure, RainMedium, RainOptions, RefractionForm};
use downpour_scene::Budget;
use downpour_scene::scene::Scene;
use downpour_trace::capture::trace_environment;
use downpour_trace::data::RenderFrame;
use downpour_trace::frame_scene::{FrameScene, LATEST_S};
use downpour_trace::kept::PlateUse;
use downpour_trace::pane_shadow::{is_lit_through, set_pane};
use downpour_trace::scene::SceneView;
use downpour_trace::wet_ground::WetGround;
use downpour_weather::{CameraPath, Loaded, StreakLook, Weather};

pub use clip_light::ClipLight;
pub use computer::{Backend, Computer, Device};
use computer::{Drawer, Painted, PaneView};
pub use display::{DisplayFrame, PendingDisplay};
use drops::Drops;
pub use error::RendererError;
pub use frame::{Frame, PendingFrame};
pub use source::Source;
use truth::TruthOf;
pub use truth::{PixelDrop, Truth};

/// Options of frames.
#[derive(Clone, Debug, PartialEq)]
pub struct RendererOptions {
    /// Samples along an edge of a pixel, 1 to 16.
    pub samples: u32,
    /// Rays that look for the light of sky and surfaces per sample, 0 to 64; with 0 nothing hides the sky. A pixel of one surface has so many
    /// in all: [`RendererOptions::sky_rays_for`] follows the samples.
    pub sky_rays: u32,
    /// Distance in pixels between those whose rays look for the light of sky and surfaces, and of lamps on unresolved rain, which
    /// the pixels between take from them: 1 to 4; 1: all do. Fewer rays are faster and leave more noise. Of a plate that is kept it is
    /// the first frame's.
    pub ray_spacing: u32,
    /// Refraction of drops; `None` takes the weather's.
    pub refraction: Option<RefractionForm>,
    /// The streak atlas, for a weather that takes the light of lamps on streaks from one.
    pub atlas: Option<StreakAtlas>,
    /// True if each frame has its measured rain rate. That takes time.
    pub measure: bool,
    /// True if each frame has the truth about its pixels ([`Frame::truth`]). That takes time, on the CPU.
    pub truth: bool,
    /// Time of the first frame, s: puddles and panes have been rained on for a while by then.
    pub first_s: f64,
    /// Frames of rays over which the picture of a scene without its rain is refined while neither scene nor camera moves, from frame to
    /// frame; then it stays, and a frame costs its rain alone. 0: each frame has a picture of its own, and does not depend on those
    /// before it.
    pub kept_frames: u32,
    /// Number of frames over which the light of sky and surfaces of plates that may stay goes on as a running mean while the eye or the scene
    /// moves; 1: each has its own. Where no plate is kept it is not used.
    pub running_frames: u32,
    /// Frames of a clip over which the light of sky and surfaces is averaged; `None`: each frame has its own. A plate that is kept has its
    /// mean over frames without it.
    pub clip_light: Option<ClipLight>,
}

impl RendererOptions {
    /// Rays that look for the light of sky and surfaces per sample that go with a number of samples along an edge of a pixel: one less,
    /// and one at least. All samples of a pixel that shows one surface share the rays of the first, so that more samples alone leave
    /// as much noise there.
    #[must_use]
    pub fn sky_rays_for(samples: u32) -> u32 {
        samples.saturating_sub(1).max(1)
    }
}

impl Default for RendererOptions {
    /// 2 x 2 samples with a ray to the sky each, from time 0 on.
    fn default() -> Self {
        Self {
            samples: 2,
            sky_rays: Self::sky_rays_for(2),
            ray_spacing: 1,
            refraction: None,
            atlas: None,
            measure: false,
            truth: false,
            first_s: 0.0,
            kept_frames: 0,
            running_frames: 1,
            clip_light: None,
        }
    }
}

/// Progress of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Name of the work.
    pub what: &'static str,
    /// Parts that are done, and how many there are; 0 where they are not counted.
    pub parts: [u32; 2],
}

/// A weather whose frames are made one after the other.
///
/// The scene, the masks of the drops and the pipelines are made once. Frames of rising times share what holds water: the drops
/// of rain that goes step by step, ripples, the pane. A frame of an earlier time begins these anew.
#[derive(Debug)]
pub struct Renderer {
    weather: Weather,
    loaded: Loaded,
    options: RendererOptions,
    /// The scene at the first time.
    first: FrameScene,
    masks: Arc<DropMasks>,
    /// The streak atlas that was given, also where the weather takes no streaks from it.
    atlas: Option<StreakAtlas>,
    drawer: Drawer,
    shower: Shower,
    water: Option<Water>,
    exposure: Option<f32>,
    /// Frames that were drawn.
    drawn: u32,
}

/// Water on ground and pane, from frame to frame.
#[derive(Debug)]
struct Water {
    pane: Option<WetPane>,
    ground: Option<WetGround>,
    time_s: f64,
}

impl Water {
    /// True if the CPU does not see the ripples on the ground.
    fn is_on_device(&self) -> bool {
        self.ground.as_ref().is_some_and(WetGround::is_on_device)
    }

    /// Puts the water on the ground of a frame, and what the pane does to light that falls through it.
    fn lay(&self, frame_scene: &mut FrameScene) -> Result<(), RendererError> {
        if let Some(ground) = &self.ground {
            ground.lay(frame_scene);
        }
        if let Some(pane) = &self.pane
            && is_lit_through(pane, frame_scene)
        {
            set_pane(pane, frame_scene)?;
        }
        Ok(())
    }
}

impl Renderer {
    /// Opens a weather file (.toml), or a bare model (.glb, .gltf) in a shower.
    ///
    /// # Errors
    /// [`RendererError`]: what is wrong with the file or what it names, or with the GPU that was asked for.
    pub fn open(path: impl AsRef<Path>, backend: Backend) -> Result<Self, RendererError> {
        let source = Source::read(path.as_ref(), &[], &mut Budget::default())?;
        Self::new(source.weather, source.loaded, RendererOptions::default(), backend.device()?)
    }

    /// A weather with its files.
    ///
    /// # Errors
    /// [`RendererError`]: what is wrong with the weather, or what the GPU says.
    pub fn new(
        weather: Weather,
        mut loaded: Loaded,
        mut options: RendererOptions,
        device: Device,
    ) -> Result<Self, RendererError> {
        check_size(weather.size)?;
        options.clip_light.as_ref().map_or(Ok(()), ClipLight::check)?;
        let atlas = options.atlas.take();
        options.atlas = atlas_of(&weather, atlas.clone())?;
        let first = FrameScene::new(&weather, &loaded, options.first_s)?;
        let mut shower = Shower::new(&weather)?;
        let masks = set_weather::masks(&weather, &loaded, &shower, &options)?;
        if !loaded.is_animated() {
            forget_meshes(&mut loaded.scene);
        } else if shower.has_drips() {
            shower.find_drips(&FrameScene::new(&weather, &loaded, 0.0)?)?;
        }
        let drawer = Drawer::new(device)?;
        Ok(Self {
            weather,
            loaded,
            options,
            first,
            masks,
            atlas,
            drawer,
            shower,
            water: None,
            exposure: None,
            drawn: 0,
        })
    }

    /// The weather.
    #[must_use]
    pub fn weather(&self) -> &Weather {
        &self.weather
    }

    /// Options of its frames. The atlas is there if the weather takes streaks from it.
    #[must_use]
    pub fn options(&self) -> &RendererOptions {
        &self.options
    }

    /// Its files, as far as they are still needed: of a scene that stands still no mesh.
    #[must_use]
    pub fn loaded(&self) -> &Loaded {
        &self.loaded
    }

    /// The scene at the first time.
    #[must_use]
    pub fn first_scene(&self) -> &FrameScene {
        &self.first
    }

    /// Device that draws.
    #[must_use]
    pub fn computer(&self) -> &Computer {
        self.drawer.computer()
    }

    /// Sets where the eye is and looks, from the next frame on: over the time of all frames, so that streaks and rain that goes
    /// step by step know how it moves. Rain that goes step by step, and what holds water, begin anew.
    ///
    /// # Errors
    /// [`RendererError::FrameScene`] for an eye over 1 km from where the first one was.
    pub fn set_camera(&mut self, path: impl Into<CameraPath>) -> Result<(), RendererError> {
        let before = self.weather.camera.path.replace(path.into());
        match self.first.seen_at(&self.weather, &self.loaded, self.options.first_s) {
            Ok(first) => self.first = first,
            Err(error) => {
                self.weather.camera.path = before;
                return Err(error.into());
            }
        }
        self.shower = Shower::new(&self.weather)?.with_drips_of(&self.shower);
        self.water = None;
        self.drawer.forget_light();
        Ok(())
    }

    /// The factor from radiance to the pixels of a frame: that of the first frame, unless it was set. Keys of
    /// `camera.exposure_ev` multiply it in each frame ([`Weather::exposure_factor`]).
    #[must_use]
    pub fn exposure(&self) -> Option<f32> {
        self.exposure
    }

    /// Sets the factor from radiance to pixels; `None` takes it from the next frame.
    pub fn set_exposure(&mut self, exposure: Option<f32>) {
        self.exposure = exposure;
    }

    /// The frame of a time in seconds.
    ///
    /// # Errors
    /// [`RendererError`]: a time beyond 1e6 s or none, or what the work or the GPU says. Nothing of the renderer is lost by it,
    /// unless the device is.
    pub fn frame(&mut self, time_s: f64) -> Result<Frame, RendererError> {
        self.frame_with(time_s, &mut |_| {})
    }

    /// The same for who wants to know how far it is.
    ///
    /// # Errors
    /// As [`Renderer::frame`].
    pub fn frame_with(
        &mut self,
        time_s: f64,
        told: &mut dyn FnMut(Progress),
    ) -> Result<Frame, RendererError> {
        self.begin_frame_with(time_s, told)?.finish()
    }

    /// Begins the frame of a time in seconds: on a GPU it is finished while the next ones are begun, on another thread if need be.
    /// The first frame is finished here, since the others take their exposure from it.
    ///
    /// # Errors
    /// As [`Renderer::frame`].
    pub fn begin_frame(&mut self, time_s: f64) -> Result<PendingFrame, RendererError> {
        self.begin_frame_with(time_s, &mut |_| {})
    }

    /// The same for who wants to know how far it is.
    ///
    /// # Errors
    /// As [`Renderer::frame`].
    pub fn begin_frame_with(
        &mut self,
        time_s: f64,
        told: &mut dyn FnMut(Progress),
    ) -> Result<PendingFrame, RendererError> {
        let begin = Instant::now();
        let mut frame_scene = match self.seen(time_s, told) {
            Err(error) if self.drawn == 0 && self.drawer.falls_back(&error) => {
                self.water = None;
                self.seen(time_s, told)?
            }
            seen => seen?,
        };
        let mut drops = self.drops(&frame_scene, time_s, told)?;
        let measured = || self.shower.measured_rate_mm_h(&frame_scene, time_s);
        let measured_rate_mm_h = self.options.measure.then(measured).transpose()?;
        told(Progress { what: "drawing", parts: [0; 2] });
        // The first picture says whether the device can draw it, and how bright all are.
        let waits = self.drawn == 0 || self.exposure.is_none();
        let of = self.plate_use(&frame_scene, time_s);
        let mut medium = self.shower.medium(&frame_scene, drops.resolved(), &self.masks, time_s)?;
        let mut options = self.picture_options(&frame_scene, time_s, medium)?;
        let picture = match self.draw(&frame_scene, &drops, &options, of, waits) {
            Err(error) if self.drawn == 0 && self.drawer.falls_back(&error) => {
                // What the device holds has to be found anew.
                if self.water.as_ref().is_some_and(Water::is_on_device) || of.light.is_some() {
                    self.water = None;
                    frame_scene = self.seen(time_s, told)?;
                }
                drops = self.drops(&frame_scene, time_s, told)?;
                medium = self.shower.medium(&frame_scene, drops.resolved(), &self.masks, time_s)?;
                options = self.picture_options(&frame_scene, time_s, medium)?;
                self.draw(&frame_scene, &drops, &options, of, waits)?
            }
            drawn => drawn?,
        };
        self.drawn += 1;
        let exposure = match (self.exposure, picture.done()) {
            (None, Some(picture)) => *self.exposure.insert(frame_scene.exposure(&picture.clean)),
            (exposure, _) => exposure.unwrap_or(1.0),
        };
        let flashes = self.flashes(time_s, &drops, told)?;
        let triangles = frame_scene.triangles;
        let truth = self
            .options
            .truth
            .then(|| Box::new(TruthOf { masks: Arc::clone(&self.masks), options, frame_scene }));
        let begin_ms = begin.elapsed().as_secs_f64() * 1.0e3;
        Ok(PendingFrame {
            picture,
            flashes,
            begin,
            begin_ms,
            time_s,
            triangles,
            drops,
            medium,
            measured_rate_mm_h,
            exposure: exposure * self.weather.exposure_factor(time_s),
            tone: self.weather.camera.tone,
            edges: self.weather.camera.edges,
            truth,
        })
    }

    /// Lets the rain go on past a time in seconds without a frame: what later frames depend on is as if there had been one.
    ///
    /// # Errors
    /// As [`Renderer::frame`].
    pub fn pass(&mut self, time_s: f64) -> Result<(), RendererError> {
        check_time(time_s)?;
        if !self.weather.puddles.is_empty() {
            self.water_at(time_s)?;
            if let Some(ground) = self.water.as_mut().and_then(|water| water.ground.as_mut()) {
                ground.advance(&self.loaded, time_s)?;
            }
        }
        if !self.shower.can_seek() {
            let frame_scene = self.frame_scene(time_s)?;
            self.drops(&frame_scene, time_s, &mut |_| {})?;
        }
        Ok(())
    }

    /// The scene at a time with its water, when the light of the frames before it is there.
    fn seen(&mut self, time_s: f64, told: &mut dyn FnMut(Progress)) -> Result<FrameScene, RendererError> {
        self.find_light_before(time_s, told)?;
        self.wet(time_s, told)
    }

    /// The scene at a time. A copy costs little: what does not change is shared.
    fn frame_scene(&self, time_s: f64) -> Result<FrameScene, RendererError> {
        check_time(time_s)?;
        if time_s.to_bits() == self.options.first_s.to_bits() {
            return Ok(self.first.clone());
        }
        let (weather, loaded) = (&self.weather, &self.loaded);
        // What stands still gets wet and dries all the same.
        let at = if loaded.is_animated() { FrameScene::moved } else { FrameScene::seen_at };
        Ok(at(&self.first, weather, loaded, time_s)?)
    }

    /// Water on ground and pane, not later than a time.
    fn water_at(&mut self, time_s: f64) -> Result<&mut Water, RendererError> {
        let known = self.water.take().filter(|water| water.time_s <= time_s);
        let water = match known {
            Some(water) => water,
            None => {
                let first_s = self.options.first_s.min(time_s);
                Water {
                    pane: self.drawer.pane(
                        &self.weather,
                        &widest(&self.first.viewpoint, &self.weather),
                        first_s,
                    )?,
                    ground: self.drawer.ground(
                        &self.weather,
                        &self.loaded,
                        &self.first,
                        first_s,
                        self.refraction(),
                    )?,
                    time_s,
                }
            }
        };
        let water = self.water.insert(water);
        water.time_s = time_s;
        Ok(water)
    }

    /// The scene at a time with the water on its ground, and with what a pane does to the light that falls through it.
    fn wet(&mut self, time_s: f64, told: &mut dyn FnMut(Progress)) -> Result<FrameScene, RendererError> {
        let mut frame_scene = self.frame_scene(time_s)?;
        if self.weather.puddles.is_empty() && self.weather.glass.is_none() {
            return Ok(frame_scene);
        }
        told(Progress { what: "rain on puddles and glass", parts: [0; 2] });
        let field = self.shower.on_water().cloned();
        self.water_at(time_s)?;
        let Some(water) = &mut self.water else { return Ok(frame_scene) };
        if let Some(ground) = &mut water.ground {
            ground.advance(&self.loaded, time_s)?;
            if let Some(field) = &field {
                let dripped = match ground.ringed() {
                    Some(water) => self.shower.dripped(&frame_scene, time_s, &|at| water.holds(at))?,
                    None => Vec::new(),
                };
                ground.find_rings(field, &dripped, &frame_scene, time_s)?;
            }
        }
        if let Some(pane) = &mut water.pane {
            rain_on(pane, time_s, told)?;
        }
        water.lay(&mut frame_scene)?;
        Ok(frame_scene)
    }

    /// The drops of a time, or what the device is asked for that finds them.
    fn drops(
        &mut self,
        frame_scene: &FrameScene,
        time_s: f64,
        told: &mut dyn FnMut(Progress),
    ) -> Result<Drops, RendererError> {
        let scenery = scenery(&self.first, &self.weather, &self.loaded);
        let mut passed = |done, all| told(Progress { what: "rain: step", parts: [done, all] });
        #[cfg(feature = "wgpu")]
        if let Some(device) = self.drawer.finder() {
            match self.shower.on_device(device, &*scenery, frame_scene, time_s, &mut passed) {
                Ok(view) => return Ok(Drops::OfDevice(Box::new(view))),
                Err(error) => {
                    // What is too much for the device the CPU does for it.
                    let error = RendererError::from(error);
                    if !error.is_too_much_for_gpu() {
                        return Err(error);
                    }
                }
            }
        }
        Ok(Drops::Listed(self.shower.at(&*scenery, frame_scene, time_s, &mut passed)?))
    }

    fn picture_options(
        &self,
        frame_scene: &FrameScene,
        time_s: f64,
        medium: RainMedium,
    ) -> Result<PictureOptions, ShowerError> {
        let form = self.refraction();
        Ok(PictureOptions {
            size: frame_scene.size,
            grid: self.options.samples,
            sky_rays: self.options.sky_rays,
            // The exposure is that of the first frame, and noise would raise it.
            ray_spacing: if self.options.kept_frames > 0 && self.drawn == 0 {
                1
            } else {
                self.options.ray_spacing
            },
            seed: noise_seed(self.weather.rain.seed, time_s),
            rain: RainOptions {
                form,
                capture_size: form.capture_size(),
                medium,
                exposure: Exposure::of_weather(&self.weather.at(time_s), frame_scene.motion, time_s),
                light: DropLightOptions::of_weather(&self.weather),
                visibility: self.weather.look_at(time_s).visibility,
                layers: self.weather.rain.layers,
                spray: self.shower.spray(time_s)?,
                ..RainOptions::default()
            },
            glow: Glow::of_weather(&self.weather, &medium, time_s),
        })
    }

    /// Refraction of drops.
    #[must_use]
    pub fn refraction(&self) -> RefractionForm {
        self.options.refraction.unwrap_or_else(|| self.weather.rain.refraction.into())
    }

    /// Draws a frame, seen through the pane if there is one, and waits for it if asked to.
    fn draw(
        &self,
        frame_scene: &FrameScene,
        drops: &Drops,
        options: &PictureOptions,
        of: PlateUse,
        waits: bool,
    ) -> Result<Painted, RendererError> {
        let pane = self.water.as_ref().and_then(|water| water.pane.as_ref());
        let through = pane.map(|pane| through(pane, frame_scene, options)).transpose()?;
        // What is seen through a pane glows when that is known.
        let behind = PictureOptions { glow: Glow::default(), ..*options };
        let drawn = if through.is_some() { &behind } else { options };
        let painted = self.drawer.paint(of, frame_scene, drops, &self.masks, drawn, through.as_ref())?;
        if waits { painted.wait() } else { Ok(painted) }
    }
}

/// The scene over time: still, before an eye that moves, or moving itself.
fn scenery<'a>(first: &'a FrameScene, weather: &'a Weather, loaded: &'a Loaded) -> Box<dyn Scenery + 'a> {
    if loaded.is_animated() {
        return Box::new(MovingScenery { frame_scene: first, weather, loaded });
    }
    match &weather.camera.path {
        Some(path) if !path.is_still() => Box::new(MovingEye { frame_scene: first, weather, loaded }),
        // Light or field of view change.
        _ if !weather.keys.is_empty() => Box::new(MovingEye { frame_scene: first, weather, loaded }),
        _ => Box::new(Still(first)),
    }
}

/// The viewpoint with the largest field of view that keys give it: a pane fills it at all times.
fn widest(viewpoint: &Viewpoint, weather: &Weather) -> Viewpoint {
    let fov_y = weather.keys.max_fov().map_or(viewpoint.fov_y, |fov| fov as f32);
    Viewpoint { fov_y, ..*viewpoint }
}

/// # Errors
/// [`RendererError::Time`] for a time beyond [`LATEST_S`], or none.
fn check_time(time_s: f64) -> Result<(), RendererError> {
    if (-LATEST_S..=LATEST_S).contains(&time_s) { Ok(()) } else { Err(RendererError::Time { found: time_s }) }
}

/// The atlas as a weather takes streaks from it, if it does.
fn atlas_of(weather: &Weather, atlas: Option<StreakAtlas>) -> Result<Option<StreakAtlas>, RendererError> {
    if DropLightOptions::of_weather(weather).form != DropLightForm::Atlas {
        return Ok(None);
    }
    let pick = match weather.streaks.look {
        StreakLook::AtlasRandom => StreakPick::Random,
        _ => StreakPick::ByAngle,
    };
    let atlas = atlas.ok_or(RendererError::NoAtlas)?;
    Ok(Some(atlas.with_pick(pick).with_seed(weather.rain.seed)))
}

/// Lets rain fall on a pane until a time in seconds.
fn rain_on(pane: &mut WetPane, time_s: f64, told: &mut dyn FnMut(Progress)) -> Result<(), RendererError> {
    let begin_s = pane.time_s();
    let seconds = (time_s - begin_s).floor().max(0.0) as u32;
    if seconds > 1 {
        for second in 1..=seconds {
            pane.advance(begin_s + f64::from(second))?;
            told(Progress { what: "second of rain on the glass", parts: [second, seconds] });
        }
    }
    Ok(pane.advance(time_s)?)
}

/// Forgets what of a scene that stands still has become buffers; materials are asked for by name at any time.
fn forget_meshes(scene: &mut Scene) {
    *scene = Scene { materials: std::mem::take(&mut scene.materials), ..Scene::default() };
}

/// The pane that a picture is seen through.
fn through(
    pane: &WetPane,
    frame_scene: &FrameScene,
    options: &PictureOptions,
) -> Result<PaneView, RendererError> {
    let PictureOptions { size, grid, sky_rays, seed, .. } = *options;
    let frame = RenderFrame::new(&frame_scene.data, &frame_scene.viewpoint, size, grid, sky_rays, seed)?;
    let camera = frame.camera;
    let lighting = SceneView { data: &frame_scene.data, frame: &frame };
    let of_drops = EnvironmentFrame::new(&camera, &options.rain);
    let (layout, environment) = if options.rain.form == RefractionForm::Direction {
        (of_drops, None)
    } else {
        // The papers' capture does not show all that is round the eye.
        let layout = EnvironmentFrame::new(&camera, &RainOptions::default());
        (layout, Some(trace_environment(&frame_scene.data, &frame, &layout).texels))
    };
    let texels = layout.texels() as usize;
    let glass = pane.picture(
        &frame_scene.viewpoint,
        &camera,
        frame.grid,
        &lighting,
        texels,
        options.rain.exposure.shutter_s,
    )?;
    Ok(PaneView { glass, environment, glow: options.glow, camera })
}
