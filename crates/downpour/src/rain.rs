//! Rain in the frames of a host application: on its device, over its color texture, in its command encoder.

mod error;
mod obstacles;
mod settings;
mod stats;
mod textures;
mod views;

use downpour_drop::air::Air;
use downpour_drop::distribution::{DistributionOptions, DropSizeDistribution};
use downpour_drop::oscillation::{Amplitudes, Fluids};
use downpour_drop::spray::Spray;
use downpour_gpu::{BufferPool, Gpu, LossProbe, ReadbackRing, wgpu};
use downpour_render::camera::{EyeMotion, Viewpoint};
use downpour_render::gpu::{FallingOnGpu, HostPipeline, PlateOnGpu, RainOnGpu, RainPipeline};
use downpour_render::host::{HostBlendFrame, HostEnvironmentFrame, HostPlateFrame};
use downpour_render::light::LightSource;
use downpour_render::rain::{
    DropMasks, Exposure, MediumGrain, MediumOptions, Rain as PictureRain, RainMedium, RainOptions,
};
use downpour_sim::field::{RainField, VisibleDrops};
use downpour_sim::gpu::{DropListOnGpu, FieldOnGpu, FieldPipeline, FieldSearch, HolesOnGpu, ObstaclesOnGpu};
use downpour_sim::impacts::SplashOptions;
use downpour_sim::resolved::Resolved;
use downpour_sim::shelter::Obstacles;
use downpour_sim::simulation::Bounce;
use downpour_sim::view::View;
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::frame_scene::{MAX_LIGHTS, view_of};
use downpour_trace::gpu::SceneOnGpu;
use downpour_trace::scene::SceneView;
use downpour_weather::drop_exposure_s;
use glam::DVec3;

use crate::shower::{drops_among, fall_speed, looking, splashes, spray};
use obstacles::scene_of;
use views::TriedViews;

pub use downpour_render::host::DepthRange;
pub use error::RainError;
pub use obstacles::{AlphaHoles, ObstacleMesh};
pub use settings::RainSettings;
pub use stats::{RainCounts, RainStats};
pub use textures::{HostSky, PlateTextures};

/// View of a frame: a perspective camera in the host's world (right-handed, +Y up, meters), and its exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainView {
    /// The camera. The projection is symmetrical, and its pixels are square.
    pub camera: Viewpoint,
    /// Motion of the camera, for the streaks of what it passes.
    pub motion: EyeMotion,
    /// Time of the frame, s, -1e6 to 1e6: the same time shows the same drops.
    pub time_s: f64,
    /// Exposure time, s, 0 to 1: drops become streaks; 0 freezes them.
    pub shutter_s: f64,
}

/// Rain for a host application, drawn on the host's device.
///
/// [`Rain::render`] reads the color and depth textures of a frame, records compute passes and one render pass in the host's
/// command encoder, and blends the rain into the color texture: refracted and lit drops and streaks, hidden by what the depth
/// texture shows, and the extinction and the light of all smaller drops. It never waits for the device.
///
/// The device finds the drops, the same for the same seed and time as on the CPU, sorts them into tiles and draws them; the CPU
/// writes the frame's numbers, some kilobytes, and in gusts above obstacles the wind of the last minutes, some hundred. Buffers stay
/// from frame to frame. Submit the encoder before the next call of `render` of the same `Rain`: its buffers are written anew then.
/// Two views in one submission take two `Rain`s.
///
/// The numbers of drops that the device has found come back by themselves ([`RainStats::counts`]): the host need not poll the device,
/// and no frame waits for them or depends on them.
#[derive(Debug)]
pub struct Rain {
    gpu: Gpu,
    settings: RainSettings,
    sizes: DropSizeDistribution,
    field: RainField,
    fields: FieldPipeline,
    field_on_gpu: FieldOnGpu,
    /// Drops whose lists the device can bind.
    most_drops: u32,
    /// Drops that a list may have room for: as many, but in tests.
    max_room: u32,
    /// Speed of a drop of the effective diameter, m/s.
    fall_speed: f64,
    /// The drops that are not drawn one by one, for the limits of the last frame.
    medium: Option<(Resolved, RainMedium)>,
    /// Frequencies of the drops' oscillation.
    frequencies: wgpu::Buffer,
    masks: DropMasks,
    masks_on_gpu: RainOnGpu,
    /// Air that the masks are of.
    masks_air: Air,
    /// Splashes, if drops splash.
    splashes: Option<SplashOptions>,
    /// Spray, if there is any.
    spray: Option<Spray>,
    has_obstacles: bool,
    /// True if some obstacles have holes.
    has_holes: bool,
    /// Obstacles and lamps.
    scene: SceneData,
    scene_on_gpu: SceneOnGpu,
    rains: RainPipeline,
    host: HostPipeline,
    pool: BufferPool,
    /// Tells the loss of the device.
    probe: LossProbe,
    /// Views that were tried.
    views: TriedViews,
    /// Frames that were recorded.
    frames: u64,
    /// Numbers of the drops of the last frames on their way to the host, each with the frame's number and its room.
    counting: ReadbackRing<(u64, u32)>,
    /// The newest of those that have arrived.
    counts: Option<RainCounts>,
}

/// Frames whose numbers of drops may be on their way at once.
const COUNTED_FRAMES: usize = 3;

impl Rain {
    /// Creates the rain: traces the masks of its drops and compiles the pipelines, which takes some seconds. The device needs no
    /// feature and no more than WebGPU's default limits; its callbacks stay the host's.
    ///
    /// # Errors
    /// [`RainError`]: a setting outside its range, or what the GPU says: lost, out of memory, or with limits below WebGPU's.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        settings: RainSettings,
    ) -> Result<Self, RainError> {
        let gpu = Gpu::on_device(device.clone(), queue.clone());
        let probe = LossProbe::new(&gpu)?;
        let Falling { sizes, field, splashes, spray } = Falling::of(&settings)?;
        let masks = DropMasks::in_air(&settings.air)?;
        let masks = if splashes.is_some() { masks.with_splashes_in_air(&settings.air)? } else { masks };
        let rains = RainPipeline::new(&gpu)?;
        let fields = FieldPipeline::new(&gpu)?;
        let scene = scene_of(&[])?;
        let most_drops = rains.most_drops();
        Ok(Self {
            most_drops,
            max_room: most_drops,
            fall_speed: fall_speed(&sizes),
            medium: None,
            frequencies: rains.frequencies(&Fluids::in_air(&settings.air))?,
            field_on_gpu: fields.upload(&field)?,
            fields,
            masks_on_gpu: rains.upload(&masks)?,
            scene_on_gpu: SceneOnGpu::new(&gpu, &scene)?,
            host: HostPipeline::new(&gpu)?,
            pool: BufferPool::new(&gpu),
            probe,
            views: TriedViews::default(),
            frames: 0,
            counting: ReadbackRing::new(&gpu, DropListOnGpu::COUNTS_BYTES, COUNTED_FRAMES)?,
            counts: None,
            gpu,
            masks_air: settings.air,
            settings,
            sizes,
            field,
            masks,
            splashes,
            spray,
            has_obstacles: false,
            has_holes: false,
            scene,
            rains,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &RainSettings {
        &self.settings
    }

    /// Gives the list of drops less room than a frame may need, so that tests see drops that have none.
    #[doc(hidden)]
    #[must_use]
    pub fn with_max_room(self, max_room: u32) -> Self {
        Self { max_room, ..self }
    }

    /// Changes the settings from the next frame on. The refractive index of the drops stays that of the air in [`Rain::new`].
    ///
    /// # Errors
    /// [`RainError`] for a setting outside its range, or what the GPU says; the old settings stay.
    pub fn set_settings(&mut self, settings: RainSettings) -> Result<(), RainError> {
        self.probe.check(&self.gpu)?;
        let Falling { sizes, field, splashes, spray } = Falling::of(&settings)?;
        if splashes.is_some() && !self.masks.has_splashes() {
            let masks = self.masks.clone().with_splashes_in_air(&self.masks_air)?;
            self.masks_on_gpu = self.rains.upload(&masks)?;
            self.masks = masks;
        }
        self.field_on_gpu = self.fields.upload(&field)?;
        self.frequencies = self.rains.frequencies(&Fluids::in_air(&settings.air))?;
        (self.fall_speed, self.medium) = (fall_speed(&sizes), None);
        (self.sizes, self.field, self.settings) = (sizes, field, settings);
        (self.splashes, self.spray) = (splashes, spray);
        Ok(())
    }

    /// Sets the triangles that stop rain and light, in the host's world, in place of those that were set: roofs, walls, ground.
    /// Without any, rain falls everywhere that the depth texture does not hide.
    ///
    /// # Errors
    /// As [`Rain::set_obstacle_meshes`].
    pub fn set_obstacles(&mut self, triangles: &[[[f32; 3]; 3]]) -> Result<(), RainError> {
        self.set_obstacle_meshes(&[ObstacleMesh::solid(triangles)])
    }

    /// Sets the meshes that stop rain and light, in place of the obstacles that were set. Drops and light go through their holes, and
    /// drops splash on what is between.
    ///
    /// # Errors
    /// [`RainError::TooMany`] above [`MAX_TRIANGLES`](downpour_trace::frame_scene::MAX_TRIANGLES) in all, [`RainError::Texture`] for
    /// an alpha texture that does not fit, [`RainError::OutOfRange`] for its cutoff, or what the GPU says; the old obstacles stay.
    pub fn set_obstacle_meshes(&mut self, meshes: &[ObstacleMesh<'_>]) -> Result<(), RainError> {
        let scene = scene_of(meshes)?;
        self.probe.check(&self.gpu)?;
        self.scene_on_gpu = SceneOnGpu::new(&self.gpu, &scene)?;
        self.has_obstacles = !scene.triangles.is_empty();
        self.has_holes = self.has_obstacles && meshes.iter().any(|mesh| mesh.holes.is_some());
        self.scene = scene;
        Ok(())
    }

    /// Drops that a frame of a size shows, in the host's world, with splashes and droplets that rebounded: what [`Rain::render`]
    /// draws.
    ///
    /// # Errors
    /// [`RainError`] for a view outside its ranges.
    pub fn drops(&self, view: &RainView, size: [u32; 2]) -> Result<VisibleDrops, RainError> {
        let (seen, obstacles) = (self.view(view, size)?, self.obstacles());
        let impacts = self.of_impacts(&seen, view.time_s)?;
        Ok(drops_among(&self.field, &obstacles, &seen, view.time_s, impacts)?)
    }

    /// Obstacles that stop drops.
    fn obstacles(&self) -> Obstacles<'_> {
        Obstacles {
            nodes: &self.scene.nodes,
            triangles: &self.scene.triangles,
            holes: if self.has_holes { Some(&self.scene) } else { None },
            origin: DVec3::ZERO,
        }
    }

    /// Splashes and rebounds of a frame, as far as the device finds them.
    fn of_impacts(
        &self,
        view: &View,
        time_s: f64,
    ) -> Result<(Option<&SplashOptions>, Option<&Bounce>), RainError> {
        if !self.has_obstacles {
            return Ok((None, None));
        }
        let (field, obstacles) = (&self.field, self.obstacles());
        let least_pixels = field.resolved(view, time_s, self.max_room)?.least_pixels;
        let fits = |splashes: &&SplashOptions| splashes.fits_device(field, view, time_s, &obstacles);
        let bounce = Some(&self.settings.bounce).filter(|bounce| {
            bounce.fraction > 0.0 && bounce.fits_device(field, view, least_pixels, time_s, &obstacles)
        });
        Ok((self.splashes.as_ref().filter(fits), bounce))
    }

    /// Records the rain of a frame: it is blended into the color texture when `encoder` is submitted.
    ///
    /// # Errors
    /// [`RainError`]: a view outside its ranges, textures or views of them that do not fit, or what the GPU says, such as
    /// [`GpuError::Lost`](downpour_gpu::GpuError::Lost). Then nothing is blended, and later frames are as if there had been no such call.
    pub fn render(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        view: &RainView,
        textures: &PlateTextures<'_>,
    ) -> Result<RainStats, RainError> {
        self.probe.check(&self.gpu)?;
        let gpu = self.gpu.clone();
        // What wgpu says on the way, of a device that is lost or full by now, is an error here and not one of the host.
        gpu.create("the rain of a frame", 0, |_| {
            self.take_counts()?;
            self.record(encoder, view, textures)
        })?
    }

    /// Takes the numbers of drops that have arrived.
    fn take_counts(&mut self) -> Result<(), RainError> {
        let newest = &mut self.counts;
        self.counting.take(&self.gpu, |(frame, room), bytes| {
            if newest.is_none_or(|counts| counts.frame < frame) {
                *newest = Some(RainCounts::new(frame, room, bytes));
            }
        })?;
        Ok(())
    }

    fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        view: &RainView,
        textures: &PlateTextures<'_>,
    ) -> Result<RainStats, RainError> {
        let size = textures.check()?;
        settings::check_view(view)?;
        let camera = view.camera.camera(size, 0)?;
        let seen = self.view(view, size)?;
        let pipeline = self.host.blend(textures.color.texture().format())?;
        self.views.check(&self.gpu, &pipeline, textures, size)?;
        self.set_lights(textures.lights)?;
        let eye = view.camera.eye.as_dvec3();
        self.pool.begin_frame();
        let frame = RenderFrame::new(&self.scene, &view.camera, size, 1, 0, 0)?;
        let frame = frame.with_ray_spacing(self.settings.ray_spacing);
        let lighting_on_gpu = self.scene_on_gpu.lighting_of(&self.pool, &frame, &self.scene)?;
        let [_, nodes, triangles, corners, table, texels] = &lighting_on_gpu.buffers;
        let obstacles = ObstaclesOnGpu {
            nodes,
            triangles,
            holes: self.has_holes.then_some(HolesOnGpu { corners, table, texels }),
            bounds: self.scene.bounding_box().filter(|_| self.has_obstacles),
            origin: DVec3::ZERO,
        };
        let (splashes, bounce) = self.of_impacts(&seen, view.time_s)?;
        let (splashes, bounce) = (splashes.copied(), bounce.copied());
        let on_gpu = (&self.field, &mut self.field_on_gpu);
        let search = FieldSearch {
            view: &seen,
            time_s: view.time_s,
            max_room: self.max_room,
            pane: None,
            known: &[],
            drips: None,
            splashes: splashes.as_ref(),
            bounce: bounce.as_ref(),
        };
        let found = self.fields.prepare(&self.pool, on_gpu, &obstacles, &search)?;
        let medium = self.medium(found.resolved())?;
        self.medium = Some((*found.resolved(), medium));
        let options = self.options(view, medium);
        let rain = PictureRain::new(&camera, eye, &[], &self.masks, &options);
        let lighting = SceneView { data: &self.scene, frame: &frame };
        let lights = [rain.lights(&lighting, &self.masks)?, rain.streak_lights(&lighting, &self.masks)?];

        let pool = &self.pool;
        let environment = self.rains.environment(pool, &rain)?;
        let plate_frame = HostPlateFrame {
            camera,
            inverse: textures.depth_range.inverse(),
            clear: textures.depth_range.clear(),
            scale: textures.radiance_scale,
        };
        let sky_scale = textures.sky.map(|sky| sky.radiance_scale);
        let environment_frame = HostEnvironmentFrame::new(&camera, rain.environment.size, sky_scale);
        let made =
            self.host.prepare(pool, &textures.on_gpu(), &plate_frame, &environment_frame, &environment)?;
        let plate =
            PlateOnGpu { pixels: made.pixels(), environment: &environment, lighting: &lighting_on_gpu };
        let falling = FallingOnGpu {
            drops: found.list().drops(),
            count: found.list().places(),
            frequencies: &self.frequencies,
        };
        let masks = (&self.masks_on_gpu, &self.masks);
        let pass = self.rains.prepare_falling(pool, &plate, masks, (&rain, &options), &lights, falling)?;
        let mut stages = vec![[made.dispatches(), pass.environment()].concat()];
        stages.extend(found.stages_beside(pass.open_air()));
        stages.extend(pass.binning());
        stages.push([pass.lamps(), pass.streaks(), pass.medium(), pass.drops(), pass.spray()].concat());
        for stage in &stages {
            let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("rain"),
                ..Default::default()
            });
            for dispatch in stage {
                dispatch.encode(&self.gpu, &mut compute)?;
            }
        }
        let blend = HostBlendFrame { width: size[0], scale: 1.0 / textures.radiance_scale, unused: [0; 2] };
        self.host.encode_blend(pool, encoder, textures.color, pass.layer_buffer(), &blend)?;
        self.frames += 1;
        let (frame, room) = (self.frames, found.list().room());
        // While none is free, frames go without.
        self.counting.record(encoder, found.list().counts(), (frame, room));
        Ok(RainStats {
            frame,
            drops_asked: self.settings.max_drops,
            max_drops: seen.max_drops,
            room,
            columns: found.columns(),
            least_pixels_asked: seen.least_pixels,
            least_pixels: found.resolved().least_pixels,
            buffers_made: pool.made(),
            bytes_uploaded: pool.written(),
            has_splashes: splashes.is_some(),
            has_droplets: bounce.is_some(),
            counts: self.counts,
        })
    }

    fn view(&self, view: &RainView, size: [u32; 2]) -> Result<View, RainError> {
        let depth = [self.settings.near_m, self.settings.far_m];
        let shutter_s = drop_exposure_s(view.shutter_s, self.settings.look.streak_length);
        let seen = view_of(&view.camera, DVec3::ZERO, size, depth, shutter_s, &view.motion)?;
        // Room for a quarter more is kept.
        Ok(View { max_drops: self.settings.max_drops.min(self.most_drops / 5 * 4), ..seen })
    }

    fn set_lights(&mut self, lights: &[LightSource]) -> Result<(), RainError> {
        if lights.len() > MAX_LIGHTS {
            return Err(RainError::TooMany {
                quantity: "lights",
                found: lights.len() as u64,
                allowed: MAX_LIGHTS as u64,
            });
        }
        self.scene.set_lights(lights);
        Ok(())
    }

    /// The drops that are not drawn one by one.
    fn medium(&self, resolved: &Resolved) -> Result<RainMedium, RainError> {
        match self.medium.filter(|(of, _)| of == resolved) {
            Some((_, medium)) => Ok(medium),
            None => {
                let options = MediumOptions {
                    grain: MediumGrain::Streaks,
                    visibility: self.settings.look.visibility,
                    ..MediumOptions::default()
                };
                Ok(RainMedium::new(&self.sizes, resolved, &self.masks, &options)?)
            }
        }
    }

    fn options(&self, view: &RainView, medium: RainMedium) -> RainOptions {
        let settings = &self.settings;
        let velocity = settings.wind.air().velocity(view.time_s) - DVec3::Y * self.fall_speed;
        RainOptions {
            medium: medium.with_velocity(velocity.as_vec3()),
            exposure: Exposure {
                shutter_s: view.shutter_s,
                streak_length: settings.look.streak_length,
                time_s: view.time_s,
                eye: view.motion,
                oscillation: Amplitudes::GARG_NAYAR_EVEN,
                fluids: Fluids::in_air(&settings.air),
                seed: settings.seed,
                ..Exposure::default()
            },
            visibility: settings.look.visibility,
            spray: self.spray.map(|spray| looking(spray, &settings.look)),
            ..RainOptions::default()
        }
    }
}

/// Rain of some settings.
struct Falling {
    sizes: DropSizeDistribution,
    field: RainField,
    splashes: Option<SplashOptions>,
    spray: Option<Spray>,
}

impl Falling {
    fn of(settings: &RainSettings) -> Result<Self, RainError> {
        settings.check()?;
        let options = DistributionOptions { air: settings.air, ..DistributionOptions::default() };
        let sizes = DropSizeDistribution::with_options(settings.sizes, settings.rate_mm_h, &options)?;
        let field = RainField::new(&sizes, settings.seed)?.with_wind(settings.uniform_wind()?);
        let spray = spray(&settings.spray, &settings.splashes, &sizes)?;
        Ok(Self { sizes, field, splashes: splashes(&settings.splashes, &settings.air)?, spray })
    }
}
