//! The rain of a weather before an eye, at one time after the other: in closed form, or step by step.

mod dripping;
mod error;
mod scenery;
mod stepped;

use std::sync::{Arc, Mutex, PoisonError};

use downpour_drop::DropError;
use downpour_drop::air::Air;
use downpour_drop::distribution::{DropSizeDistribution, ExtinctionEfficiency};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_drop::splash::SplashLaw;
use downpour_drop::spray::Spray;
use downpour_sim::SimError;
use downpour_sim::drips::Drips;
use downpour_sim::field::{FallingDrop, RainField, VisibleDrops};
use downpour_sim::impacts::{Impact, SplashOptions};
use downpour_sim::resolved::Resolved;
use downpour_sim::shelter::Obstacles;
use downpour_sim::simulation::Bounce;
use downpour_sim::view::View;
use downpour_weather::{Look, Rain, RainDrag, RainExtinction, RainUnresolved, RainVolume, Splashes, Weather};
use downpour_wind::WindField;
use glam::DVec3;

use downpour_render::glass::pane_plane;
use downpour_render::rain::{DropMasks, MediumGrain, MediumOptions, PanePlane, RainMedium};
use downpour_trace::frame_scene::FrameScene;
use dripping::Dripping;
pub use error::ShowerError;
pub use scenery::{MovingEye, MovingScenery, Scenery, Still};
use stepped::Stepped;
#[cfg(feature = "wgpu")]
pub use stepped::SteppedPicture;

/// Method by which the drops are found.
#[derive(Clone, Debug)]
enum Form {
    Closed(Arc<RainField>),
    Stepped(Box<Stepped>),
}

/// The part of a rain that a picture shows, for a device that finds its drops.
#[derive(Clone, Debug)]
pub struct ShowerView {
    /// The rain.
    pub rain: ShowerRain,
    /// Time of the picture, s.
    pub time_s: f64,
    /// The picture, in the world.
    pub view: View,
    /// Limits of the list of drops.
    pub resolved: Resolved,
    /// The pane before the eye: there is no rain on the eye's side.
    pub pane: Option<PanePlane>,
    /// Drops that drip, splashes and droplets that rebound, unless the device finds them, in the world: these are found already.
    pub droplets: Vec<FallingDrop>,
    /// Drops that drip, and their splashes, if the device finds them.
    pub drips: Option<DripView>,
}

/// Drops that drip before a picture, and their splashes, for a device that finds them.
#[derive(Clone, Debug)]
pub struct DripView {
    /// Where they drip.
    pub drips: Arc<Drips>,
    /// The picture, in the world; where more drops than its most might be seen, the nearest are.
    pub view: View,
    /// Least diameter of a drop, pixels.
    pub least_pixels: f64,
    /// Their splashes.
    pub splashes: Option<SplashOptions>,
}

/// A rain whose drops a device finds.
#[derive(Clone, Debug)]
pub enum ShowerRain {
    /// In closed form.
    Closed {
        /// The rain.
        field: Arc<RainField>,
        /// Splashes that the device is to find.
        splashes: Option<SplashOptions>,
        /// Rebounds whose droplets the device is to find.
        bounce: Option<Bounce>,
        /// Drops that the device has room for.
        max_room: u32,
    },
    /// Step by step, on the device.
    #[cfg(feature = "wgpu")]
    Stepped {
        /// The drops.
        picture: SteppedPicture,
        /// Splashes that the device is to find.
        splashes: Option<SplashOptions>,
    },
}

/// The rain of a weather.
#[derive(Clone, Debug)]
pub struct Shower {
    /// Sizes of the drops at the largest rate.
    law: DropSizeDistribution,
    weather: Weather,
    bounce: Bounce,
    /// Splashes of drops, unless there are none.
    splashes: Option<SplashOptions>,
    dripping: Option<Dripping>,
    /// The spray of a rain that does not change; without rain that of none.
    spray: Option<Spray>,
    form: Form,
    /// The rain in closed form, in the uniform wind: that of the drops or, for puddles, one beside drops that go step by step.
    on_water: Option<Arc<RainField>>,
    /// The last medium of a rain that does not change.
    last: Arc<Mutex<Option<LastMedium>>>,
}

/// Drops that a picture did not draw one by one, with all that they depend on.
#[derive(Debug)]
struct LastMedium {
    resolved: Resolved,
    options: MediumOptions,
    masks: DropMasks,
    medium: RainMedium,
}

impl Shower {
    /// The rain of a weather.
    ///
    /// # Errors
    /// [`ShowerError::NotUniform`] if closed form is asked for in a wind that differs from place to place,
    /// [`ShowerError::DragByStep`] for a drag that has none; [`ShowerError::RateByStep`] for a rate that changes, step by step;
    /// [`ShowerError::Sim`], [`ShowerError::Drop`] for a rain that is none.
    pub fn new(weather: &Weather) -> Result<Self, ShowerError> {
        let rain = &weather.heaviest_rain();
        let law = rain.sizes()?;
        // The papers' drag has no closed form.
        let relaxes = rain.drag == RainDrag::Relaxation;
        let is_closed = match (rain.volume, weather.wind.uniform()) {
            // Layers need a rain, but no drops.
            _ if rain.layers.is_some() => true,
            (RainVolume::Auto, Some(_)) if relaxes => true,
            (RainVolume::ClosedForm, Some(_)) if !relaxes => return Err(ShowerError::DragByStep),
            (RainVolume::ClosedForm, Some(_)) => true,
            (RainVolume::ClosedForm, None) => return Err(ShowerError::NotUniform),
            _ if weather.keys.rate().is_some() => return Err(ShowerError::RateByStep),
            _ => false,
        };
        let has_field = is_closed || !weather.puddles.is_empty();
        let on_water = has_field.then(|| closed(&law, weather).map(Arc::new)).transpose()?;
        let form = match &on_water {
            Some(field) if is_closed => Form::Closed(Arc::clone(field)),
            _ => Form::Stepped(Box::new(Stepped::new(law.clone(), weather))),
        };
        let spray = spray(&weather.spray, &weather.splashes, &law)?;
        let (dripping, splashes) = (Dripping::new(weather)?, splashes(&weather.splashes, &weather.rain.air)?);
        let last = Arc::default();
        Ok(Self {
            law,
            weather: weather.clone(),
            bounce: bounce(rain),
            dripping,
            splashes,
            spray,
            form,
            on_water,
            last,
        })
    }

    /// Finds where water drips in a scene, which takes a while. Else it is found for the first picture, in the scene of that: of a scene
    /// that moves pictures are the same in any order only if this is its scene of one time.
    ///
    /// # Errors
    /// [`ShowerError::Sim`] for more than [`MAX_POINTS`](downpour_sim::drips::MAX_POINTS) drip points.
    pub fn find_drips(&mut self, frame_scene: &FrameScene) -> Result<(), ShowerError> {
        self.dripping.as_ref().map_or(Ok(()), |dripping| dripping.find(frame_scene))
    }

    /// Takes over the drip points that the rain of the same weather has found.
    pub(crate) fn with_drips_of(self, other: &Self) -> Self {
        Self { dripping: other.dripping.clone(), ..self }
    }

    /// Goes on from the rain of another weather over the same scene: the drops that are there step by step stay, in the new wind and
    /// before the new camera; the drip points stay where the same rain drips in the same way.
    pub(crate) fn going_on_from(mut self, other: &Self) -> Self {
        let (weather, before) = (&self.weather, &other.weather);
        let rains_alike = weather.rain == before.rain && weather.keys.rate() == before.keys.rate();
        if rains_alike {
            self.last = Arc::clone(&other.last);
        }
        if let (Form::Stepped(stepped), Form::Stepped(before), true) =
            (&mut self.form, &other.form, rains_alike)
        {
            stepped.go_on_from(before);
        }
        let drips_alike = rains_alike && weather.drips == before.drips && weather.wetness == before.wetness;
        if drips_alike && weather.wind == before.wind { self.with_drips_of(other) } else { self }
    }

    /// Splashes of a picture at a time in seconds.
    fn splashes_at(&self, time_s: f64) -> Option<SplashOptions> {
        let size = self.weather.splashes_at(time_s).size;
        self.splashes.map(|splashes| SplashOptions { size, ..splashes })
    }

    /// Drops that drip, and their splashes, as a picture shows them.
    fn drips(
        &self,
        frame_scene: &FrameScene,
        view: &View,
        least: f64,
        time_s: f64,
    ) -> Result<Vec<FallingDrop>, ShowerError> {
        let splashes = self.splashes_at(time_s);
        let listed =
            |dripping: &Dripping| dripping.visible(frame_scene, (view, least), time_s, splashes.as_ref());
        self.dripping.as_ref().map_or(Ok(Vec::new()), listed)
    }

    /// The same for a picture whose drops a device finds: those that it is to find, or else a list.
    fn drips_of_device(
        &self,
        frame_scene: &FrameScene,
        view: &View,
        least: f64,
        time_s: f64,
    ) -> Result<(Option<DripView>, Vec<FallingDrop>), ShowerError> {
        #[cfg(feature = "wgpu")]
        if let Some(dripping) = &self.dripping
            && let Some(view) = dripping.of_device(frame_scene, (view, least), self.splashes_at(time_s))?
        {
            return Ok((Some(view), Vec::new()));
        }
        Ok((None, self.drips(frame_scene, view, least, time_s)?))
    }

    /// Drops that have dripped near the eye of a picture, in places, m, where they make rings on puddles.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub(crate) fn dripped(
        &self,
        frame_scene: &FrameScene,
        time_s: f64,
        is_water: &(dyn Fn(DVec3) -> bool + Sync),
    ) -> Result<Vec<Impact>, ShowerError> {
        let landed = |dripping: &Dripping| dripping.landed(frame_scene, time_s, is_water);
        self.dripping.as_ref().map_or(Ok(Vec::new()), landed)
    }

    /// True if drops splash, where there is rain or something drips.
    #[must_use]
    pub fn has_splashes(&self) -> bool {
        self.splashes.is_some() && (self.law.rate_mm_h() > 0.0 || self.has_drips())
    }

    /// True if something may drip.
    #[must_use]
    pub fn has_drips(&self) -> bool {
        self.dripping.is_some()
    }

    /// True if the drops are found in closed form, and not step by step.
    #[must_use]
    pub fn is_closed_form(&self) -> bool {
        matches!(self.form, Form::Closed(_))
    }

    /// The rain in closed form whose drops make rings on puddles: that of the picture, or of drops that go step by step one of the same
    /// rate, sizes and seed in the uniform part of their wind. (Drops of a view are followed where the picture shows them; rings
    /// last longer, and are wanted where the eye has only just turned.) `None` for drops that go step by step where no puddle is.
    #[must_use]
    pub fn on_water(&self) -> Option<&Arc<RainField>> {
        self.on_water.as_ref()
    }

    /// True if a picture of any time can be made by itself, and is the same as among others. If not, pictures of a clip are
    /// made in order of time, and each of them has to be asked for.
    #[must_use]
    pub fn can_seek(&self) -> bool {
        match &self.form {
            Form::Closed(_) => true,
            Form::Stepped(stepped) => stepped.forgets(),
        }
    }

    /// The drops that a picture of a scene shows at a time in seconds; `frame_scene` is the scene at that time. Of work that takes
    /// long `passed` is told how many steps are done, and how many there are to do.
    ///
    /// # Errors
    /// As [`RainField::visible`] and [`Simulation::advance`](downpour_sim::simulation::Simulation::advance);
    /// [`ShowerError::Wind`] for a wind field that is none; [`ShowerError::FrameScene`].
    pub fn at(
        &mut self,
        scenery: &dyn Scenery,
        frame_scene: &FrameScene,
        time_s: f64,
        passed: &mut dyn FnMut(u32, u32),
    ) -> Result<VisibleDrops, ShowerError> {
        let splashes = self.splashes_at(time_s);
        let mut visible = match &mut self.form {
            Form::Closed(field) => {
                let view = View { max_drops: self.weather.rain.max_drops, ..frame_scene.view()? };
                let view = drops_view(&self.weather.rain, view);
                let obstacles = obstacles(frame_scene);
                let impacts = (splashes.as_ref(), Some(&self.bounce));
                drops_among(field, &obstacles, &view, time_s, impacts)?
            }
            Form::Stepped(stepped) => stepped.at(scenery, frame_scene, time_s, splashes.as_ref(), passed)?,
        };
        let view = View { max_drops: self.weather.rain.max_drops, ..frame_scene.view()? };
        let least = drips_least(&self.weather.rain, &visible.resolved);
        let dripped = self.drips(frame_scene, &view, least, time_s)?;
        visible.drops.extend(dripped);
        // A pane keeps the rain outside.
        if let Some(pane) = pane_plane(&self.weather, &frame_scene.viewpoint)? {
            keep_outside(&mut visible.drops, &pane, &view);
        }
        Ok(visible)
    }

    /// Request to a device that finds the drops of [`Shower::at`] and has room for `max_room`; `None` for rain that is not in
    /// closed form.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub fn view_at(
        &self,
        frame_scene: &FrameScene,
        time_s: f64,
        max_room: u32,
    ) -> Result<Option<ShowerView>, ShowerError> {
        match &self.form {
            Form::Closed(field) => Ok(Some(self.closed_view(field, frame_scene, time_s, max_room)?)),
            Form::Stepped(_) => Ok(None),
        }
    }

    /// Request to a device that finds drops in closed form.
    fn closed_view(
        &self,
        field: &Arc<RainField>,
        frame_scene: &FrameScene,
        time_s: f64,
        max_room: u32,
    ) -> Result<ShowerView, ShowerError> {
        // Room for a quarter more is kept.
        let max_drops = self.weather.rain.max_drops.min(max_room / 5 * 4);
        let of_drips = View { max_drops, ..frame_scene.view()? };
        let view = drops_view(&self.weather.rain, of_drips);
        let resolved = field.resolved(&view, time_s, max_room)?;
        let least = resolved.least_pixels;
        let obstacles = obstacles(frame_scene);
        let least_of_drips = drips_least(&self.weather.rain, &resolved);
        let (drips, mut droplets) = self.drips_of_device(frame_scene, &of_drips, least_of_drips, time_s)?;
        let splashes = self.splashes_at(time_s);
        #[cfg(feature = "wgpu")]
        let (on_device, bounce) = (
            splashes.filter(|splashes| splashes.fits_device(field, &view, time_s, &obstacles)),
            Some(self.bounce).filter(|bounce| bounce.fits_device(field, &view, least, time_s, &obstacles)),
        );
        #[cfg(not(feature = "wgpu"))]
        let (on_device, bounce) = (None, None);
        if bounce.is_none() {
            droplets.extend(field.bounced(&obstacles, &view, least, time_s, &self.bounce)?);
        }
        if let (Some(splashes), None) = (&splashes, on_device) {
            droplets.extend(field.splashes(&obstacles, &view, time_s, splashes)?);
        }
        let pane = pane_plane(&self.weather, &frame_scene.viewpoint)?;
        if let Some(pane) = &pane {
            keep_outside(&mut droplets, pane, &view);
        }
        let rain = ShowerRain::Closed { field: Arc::clone(field), splashes: on_device, bounce, max_room };
        Ok(ShowerView { rain, time_s, view, resolved, pane, droplets, drips })
    }

    /// Request to a device that finds the drops of [`Shower::at`]: drops in closed form, of which it has room for `max_room`, or
    /// those that it steps. `passed` as there.
    ///
    /// # Errors
    /// As [`Shower::at`]; [`ShowerError::Gpu`].
    #[cfg(feature = "wgpu")]
    pub fn on_device(
        &mut self,
        (gpu, max_room): (&downpour_gpu::Gpu, u32),
        scenery: &dyn Scenery,
        frame_scene: &FrameScene,
        time_s: f64,
        passed: &mut dyn FnMut(u32, u32),
    ) -> Result<ShowerView, ShowerError> {
        let stepped = match &mut self.form {
            Form::Closed(field) => {
                let field = Arc::clone(field);
                return self.closed_view(&field, frame_scene, time_s, max_room);
            }
            Form::Stepped(stepped) => stepped,
        };
        let (view, picture) = stepped.on_device(gpu, scenery, frame_scene, time_s, passed)?;
        let resolved = picture.resolved();
        let of_drips = View { max_drops: self.weather.rain.max_drops, ..frame_scene.view()? };
        let (drips, mut droplets) =
            self.drips_of_device(frame_scene, &of_drips, resolved.least_pixels, time_s)?;
        let pane = pane_plane(&self.weather, &frame_scene.viewpoint)?;
        if let Some(pane) = &pane {
            keep_outside(&mut droplets, pane, &view);
        }
        let rain = ShowerRain::Stepped { picture, splashes: self.splashes_at(time_s) };
        Ok(ShowerView { rain, time_s, view, resolved, pane, droplets, drips })
    }

    /// The drops of a device a little later than those of `shown`, at `time_s`, as a picture of part of its exposure shows them.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub(crate) fn later(
        &self,
        shown: &ShowerView,
        frame_scene: &FrameScene,
        time_s: f64,
    ) -> Result<ShowerView, ShowerError> {
        match &shown.rain {
            #[cfg(feature = "wgpu")]
            ShowerRain::Stepped { picture, splashes } => {
                let least_pixels = shown.view.least_pixels;
                let view = View { least_pixels, ..frame_scene.view()? };
                let picture = picture.later(time_s - shown.time_s);
                let rain = ShowerRain::Stepped { picture, splashes: *splashes };
                let drips = shown.drips.clone().map(|drips| {
                    let max_drops = drips.view.max_drops;
                    DripView { view: View { max_drops, ..view }, ..drips }
                });
                Ok(ShowerView { rain, view, time_s, drips, ..shown.clone() })
            }
            ShowerRain::Closed { field, max_room, .. } => {
                self.closed_view(field, frame_scene, time_s, *max_room)
            }
        }
    }

    /// The wind that the drops feel at a time in seconds, in its cells and relative to the scene's origin: none blows in
    /// objects. `None` where it is the same everywhere, which drops in closed form feel in the lee of objects too.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub fn wind_field(
        &mut self,
        scenery: &dyn Scenery,
        time_s: f64,
    ) -> Result<Option<WindField>, ShowerError> {
        match &mut self.form {
            Form::Closed(_) => Ok(None),
            Form::Stepped(stepped) => stepped.wind_field(scenery, time_s),
        }
    }

    /// The drops that were not listed for a picture at a time in seconds: `resolved` has the limits of the list.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub fn medium(
        &self,
        frame_scene: &FrameScene,
        resolved: &Resolved,
        masks: &DropMasks,
        time_s: f64,
    ) -> Result<RainMedium, ShowerError> {
        let options = MediumOptions {
            efficiency: match self.weather.rain.extinction {
                RainExtinction::Total => ExtinctionEfficiency::Total,
                _ => ExtinctionEfficiency::Camera,
            },
            velocity: (self.weather.wind.air().velocity(time_s) - DVec3::Y * fall_speed(&self.law)).as_vec3(),
            origin: frame_scene.origin,
            pane: pane_plane(&self.weather, &frame_scene.viewpoint)?,
            grain: match self.weather.rain.unresolved {
                RainUnresolved::Even => MediumGrain::Even,
                _ if self.weather.rain.layers.is_some() => MediumGrain::Even,
                _ => MediumGrain::Streaks,
            },
            visibility: self.weather.look_at(time_s).visibility,
        };
        let fog = self.weather.fog_at(time_s);
        let with_fog = |medium: RainMedium| medium.with_fog(fog.as_ref(), frame_scene.origin.y);
        if self.weather.keys.rate().is_none() {
            return Ok(with_fog(self.steady_medium(resolved, masks, &options)?));
        }
        // The drops about the eye pass the height of the rate at another time.
        let above = frame_scene.view()?.eye.y - self.weather.rain.rate_height_m;
        let passing_s = time_s + above / fall_speed(&self.law).max(0.1);
        let rain = self.weather.rain_at(passing_s);
        Ok(with_fog(RainMedium::new(&rain.sizes()?, resolved, masks, &options)?))
    }

    /// The spray over what the rain hits in a picture at a time in seconds, as visible as `[look]` makes it; `None` if there is none.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub fn spray(&self, time_s: f64) -> Result<Option<Spray>, ShowerError> {
        let (weather, look) = (&self.weather, self.weather.look_at(time_s));
        let spray = if weather.spray.is_enabled && weather.keys.rate().is_some() {
            spray(&weather.spray, &weather.splashes, &weather.rain_at(time_s).sizes()?)?
        } else {
            self.spray
        };
        Ok(spray.map(|spray| looking(spray, &look)))
    }

    /// The medium of a rain that does not change: from frame to frame only its velocity does.
    fn steady_medium(
        &self,
        resolved: &Resolved,
        masks: &DropMasks,
        options: &MediumOptions,
    ) -> Result<RainMedium, DropError> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let moving = |of: &MediumOptions| MediumOptions { velocity: options.velocity, ..*of };
        let known = last.as_ref().filter(|last| {
            last.resolved == *resolved && moving(&last.options) == *options && last.masks.is_same(masks)
        });
        if let Some(last) = known {
            return Ok(last.medium.with_velocity(options.velocity));
        }
        let medium = RainMedium::new(&self.law, resolved, masks, options)?;
        let (resolved, options, masks) = (*resolved, *options, masks.clone());
        *last = Some(LastMedium { resolved, options, masks, medium });
        Ok(medium)
    }

    /// The rate, mm/h, of the drops about the eye (in closed form) or in the simulated volume, with those that something
    /// hides.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub fn measured_rate_mm_h(&self, frame_scene: &FrameScene, time_s: f64) -> Result<f64, ShowerError> {
        match &self.form {
            Form::Closed(field) => Ok(field.measured_rate_mm_h(frame_scene.view()?.eye, time_s)?),
            Form::Stepped(stepped) => stepped.measured_rate_mm_h(),
        }
    }
}

/// Drops of a rain in closed form that a picture shows at a time in s, with droplets that rebounded and splashes, in this order.
pub(crate) fn drops_among(
    field: &RainField,
    obstacles: &Obstacles<'_>,
    view: &View,
    time_s: f64,
    (splashes, bounce): (Option<&SplashOptions>, Option<&Bounce>),
) -> Result<VisibleDrops, SimError> {
    let mut visible = field.visible_among(obstacles, view, time_s)?;
    if let Some(bounce) = bounce {
        let least = visible.resolved.least_pixels;
        visible.drops.extend(field.bounced(obstacles, view, least, time_s, bounce)?);
    }
    if let Some(splashes) = splashes {
        visible.drops.extend(field.splashes(obstacles, view, time_s, splashes)?);
    }
    Ok(visible)
}

/// Least diameter on the picture, pixels, of drops of a rain that shows none.
const NONE_PIXELS: f64 = 1.0e9;

/// The view of a picture, for the drops of a rain that is drawn drop by drop; one without drops for layers.
fn drops_view(rain: &Rain, view: View) -> View {
    if rain.layers.is_some() { View { least_pixels: NONE_PIXELS, ..view } } else { view }
}

/// Least diameter on the picture, pixels, of drops that drip.
fn drips_least(rain: &Rain, resolved: &Resolved) -> f64 {
    if rain.layers.is_some() { View::default().least_pixels } else { resolved.least_pixels }
}

/// Obstacles that stop drops in a scene.
fn obstacles(frame_scene: &FrameScene) -> Obstacles<'_> {
    Obstacles {
        nodes: &frame_scene.data.nodes,
        triangles: &frame_scene.data.triangles,
        holes: Some(&frame_scene.data),
        origin: frame_scene.origin,
    }
}

/// Ends the paths of drops at a pane, and removes the drops that are on the eye's side all the time.
fn keep_outside(drops: &mut Vec<FallingDrop>, pane: &PanePlane, view: &View) {
    drops.retain_mut(|drop| {
        let kept = drop.beyond(pane.outward, pane.distance, view);
        *drop = kept.unwrap_or(*drop);
        kept.is_some()
    });
}

/// Terminal speed, m/s, of drops of the effective diameter of a rain.
pub(crate) fn fall_speed(sizes: &DropSizeDistribution) -> f64 {
    let speeds = TerminalSpeed::new(sizes.options().fall_speed, &sizes.options().air);
    speeds.at(sizes.effective_diameter()).unwrap_or_default()
}

/// The rain of a weather in closed form, in the uniform part of its wind.
fn closed(law: &DropSizeDistribution, weather: &Weather) -> Result<RainField, SimError> {
    let rain = &weather.rain;
    let field = match weather.keys.rate() {
        Some(rates) => RainField::changing(law, rates, rain.rate_height_m, rain.seed)?,
        None => RainField::new(law, rain.seed)?,
    };
    Ok(field.with_wind(weather.wind.air().clone()))
}

/// Splashes in an air, if drops splash.
pub(crate) fn splashes(splashes: &Splashes, air: &Air) -> Result<Option<SplashOptions>, DropError> {
    if !splashes.is_enabled {
        return Ok(None);
    }
    let law = SplashLaw::new(splashes.film_m, air.temperature_c())?;
    Ok(Some(SplashOptions { law, size: splashes.size }))
}

/// Spray of drops of a rain, if there is any.
pub(crate) fn spray(
    spray: &downpour_weather::Spray,
    splashes: &Splashes,
    rain: &DropSizeDistribution,
) -> Result<Option<Spray>, DropError> {
    if !spray.is_enabled {
        return Ok(None);
    }
    let law = SplashLaw::new(splashes.film_m, rain.options().air.temperature_c())?;
    Ok(Some(Spray::of_rain(rain, &law, spray.droplet_m, spray.height_m)?))
}

/// Spray that is as visible as artistic multipliers make it.
pub(crate) fn looking(spray: Spray, look: &Look) -> Spray {
    Spray { extinction: spray.extinction * look.spray * look.visibility, ..spray }
}

/// Bounce of drops that meet a surface.
fn bounce(rain: &Rain) -> Bounce {
    let bounce = &rain.bounce;
    Bounce {
        fraction: bounce.fraction as f32,
        restitution: bounce.restitution as f32,
        grip: bounce.grip as f32,
        size: bounce.size as f32,
        max_time_s: bounce.max_time_s as f32,
    }
}
