//! Devices that draw frames: a GPU with its pipelines, or the CPU.

use std::cell::RefCell;

use downpour_render::camera::{Camera, Viewpoint};
use downpour_render::glass::{GlassPicture, WetPane};
use downpour_render::glow::Glow;
use downpour_render::picture::{Picture, PictureOptions, timed};
use downpour_render::rain::{DropMasks, RefractionForm};
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::kept::PlateUse;
use downpour_trace::picture::{KeptScene, find_light, render_picture_on};
use downpour_trace::temporal::{LightHistory, LightWindow};
use downpour_trace::wet_ground::WetGround;
use downpour_weather::{Loaded, Weather};

use super::RendererError;
use super::drops::{Drops, Found};
#[cfg(feature = "wgpu")]
use super::on_gpu::OnGpu;

/// Choice of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A GPU, else the CPU, which is faster than a software driver of a GPU; the CPU too for what is too much for the GPU.
    #[default]
    Auto,
    /// A GPU or its software driver.
    Gpu,
    /// The CPU.
    Cpu,
}

impl Backend {
    /// Opens it.
    ///
    /// # Errors
    /// [`RendererError::Gpu`] if there is no GPU and nothing else may draw; [`RendererError::NoGpuSupport`] without the feature
    /// `wgpu`.
    pub fn device(self) -> Result<Device, RendererError> {
        match self {
            Self::Cpu => Ok(Device::cpu()),
            #[cfg(not(feature = "wgpu"))]
            Self::Auto => Ok(Device::cpu()),
            #[cfg(not(feature = "wgpu"))]
            Self::Gpu => Err(RendererError::NoGpuSupport),
            #[cfg(feature = "wgpu")]
            Self::Auto | Self::Gpu => {
                use downpour_gpu::{AdapterChoice, Gpu, GpuError};
                match Gpu::open(&AdapterChoice::Auto) {
                    Ok(gpu) if self == Self::Auto && gpu.adapter().is_software() => Ok(Device::cpu()),
                    Ok(gpu) => {
                        let is_software = gpu.adapter().is_software();
                        let gpu = if is_software { gpu.with_timeout(Device::SOFTWARE_TIMEOUT) } else { gpu };
                        Ok(Device::gpu(gpu, self == Self::Auto))
                    }
                    Err(GpuError::NoAdapter { .. } | GpuError::NoDevice { .. }) if self == Self::Auto => {
                        Ok(Device::cpu())
                    }
                    Err(error) => Err(error.into()),
                }
            }
        }
    }
}

/// A device that draws.
#[derive(Clone, Debug)]
pub struct Device {
    #[cfg(feature = "wgpu")]
    gpu: Option<downpour_gpu::Gpu>,
    /// True if the CPU draws what is too much for the GPU.
    falls_back: bool,
    /// True if a software driver holds the ripples of puddles, too.
    #[cfg(feature = "wgpu")]
    drives_ripples: bool,
}

impl Device {
    /// Timeout of one submission to a software driver: it has the speed of a CPU, and its compiler alone may need half a
    /// minute. It does not hang as a device does.
    #[cfg(feature = "wgpu")]
    pub const SOFTWARE_TIMEOUT: std::time::Duration = std::time::Duration::from_secs(600);

    /// The CPU.
    #[must_use]
    pub fn cpu() -> Self {
        Self {
            #[cfg(feature = "wgpu")]
            gpu: None,
            falls_back: false,
            #[cfg(feature = "wgpu")]
            drives_ripples: false,
        }
    }

    /// A GPU. `falls_back`: the CPU draws all frames if the first is too much for it.
    #[cfg(feature = "wgpu")]
    #[must_use]
    pub fn gpu(gpu: downpour_gpu::Gpu, falls_back: bool) -> Self {
        Self { gpu: Some(gpu), falls_back, drives_ripples: false }
    }

    /// Holds and steps the ripples of puddles on a software driver, too. By itself it has those of the CPU, which is faster at them; other
    /// GPUs always hold them.
    #[cfg(feature = "wgpu")]
    #[must_use]
    pub fn with_ripples_on_software_driver(self) -> Self {
        Self { drives_ripples: true, ..self }
    }
}

/// The adapter and driver that draw frames, on which their bits depend.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Computer {
    /// The adapter as its driver names it, or the CPU.
    pub adapter: String,
    /// `gpu` or `cpu`.
    pub backend: &'static str,
    /// The driver with its version, or the processor's architecture.
    pub driver: String,
    /// Reason why the CPU draws in place of a GPU.
    pub reason: Option<String>,
}

/// A device with its pipelines.
pub(super) struct Drawer {
    computer: Computer,
    falls_back: bool,
    /// State that the last picture on the CPU has left, if it was to be kept.
    kept: RefCell<KeptScene>,
    #[cfg(feature = "wgpu")]
    on_gpu: Option<OnGpu>,
}

/// A picture, which may be on its way from the device.
#[derive(Debug)]
pub(super) enum Painted {
    Done(Box<(Picture, Option<Found>)>),
    #[cfg(feature = "wgpu")]
    OnItsWay {
        read: Box<downpour_trace::gpu::PictureReadback>,
        through_glass: Option<Box<ThroughGlass>>,
    },
}

impl Painted {
    /// The picture, if it is there.
    pub(super) fn done(&self) -> Option<&Picture> {
        match self {
            Self::Done(done) => Some(&done.0),
            #[cfg(feature = "wgpu")]
            Self::OnItsWay { .. } => None,
        }
    }

    /// Waits for the picture, and for the drops that a device has found.
    pub(super) fn finish(self) -> Result<(Picture, Option<Found>), RendererError> {
        match self {
            Self::Done(done) => Ok(*done),
            #[cfg(feature = "wgpu")]
            Self::OnItsWay { read, through_glass } => {
                let (picture, found) = read.finish()?;
                let found = found.map(|found| Found { drops: found.drops, simulated: found.simulated });
                let Some(through) = through_glass else { return Ok((picture, found)) };
                let mut picture = Picture { through_glass: Some(through.seen), ..picture };
                picture.add_glow(&through.glow, &through.camera);
                Ok((picture, found))
            }
        }
    }

    /// The same picture, which is there.
    pub(super) fn wait(self) -> Result<Self, RendererError> {
        Ok(Self::Done(Box::new(self.finish()?)))
    }
}

/// A frame as it is seen through a pane, and its glow.
#[cfg(feature = "wgpu")]
#[derive(Debug)]
pub(super) struct ThroughGlass {
    pub(super) seen: Vec<[f32; 3]>,
    pub(super) glow: Glow,
    pub(super) camera: Camera,
}

/// Pane that a frame is seen through.
pub(super) struct PaneView {
    pub(super) glass: GlassPicture,
    /// The environment map that the pane shows; `None` takes the one of the drops.
    pub(super) environment: Option<Vec<[f32; 4]>>,
    /// Glow of what is seen through it.
    pub(super) glow: Glow,
    /// Camera of the frame.
    pub(super) camera: Camera,
}

impl std::fmt::Debug for Drawer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Drawer").field("computer", &self.computer).finish_non_exhaustive()
    }
}

impl Drawer {
    #[cfg_attr(
        not(feature = "wgpu"),
        expect(clippy::needless_pass_by_value, reason = "a GPU that it holds is taken over")
    )]
    pub(super) fn new(device: Device) -> Result<Self, RendererError> {
        #[cfg(feature = "wgpu")]
        if let Some(gpu) = device.gpu {
            let adapter = gpu.adapter();
            let computer = Computer {
                adapter: adapter.name.clone(),
                backend: "gpu",
                driver: format!("{} {} {}", adapter.backend, adapter.driver, adapter.driver_info),
                reason: None,
            };
            let renderer = downpour_trace::gpu::PictureRenderer::new(&gpu);
            let kept = RefCell::default();
            let mut drawer = Self { computer, falls_back: device.falls_back, kept, on_gpu: None };
            match renderer {
                Ok(renderer) => {
                    drawer.on_gpu = Some(OnGpu::new(gpu, renderer, device.drives_ripples));
                }
                Err(error) => {
                    let error = error.into();
                    if !drawer.falls_back(&error) {
                        return Err(error);
                    }
                }
            }
            return Ok(drawer);
        }
        Ok(Self {
            computer: cpu(None),
            falls_back: device.falls_back,
            kept: RefCell::default(),
            #[cfg(feature = "wgpu")]
            on_gpu: None,
        })
    }

    pub(super) fn computer(&self) -> &Computer {
        &self.computer
    }

    /// Goes on with the CPU if that may be, and if an error says that something was too much for the GPU.
    pub(super) fn falls_back(&mut self, error: &RendererError) -> bool {
        let may = self.falls_back && error.is_too_much_for_gpu();
        if may {
            self.computer = cpu(Some(error.to_string()));
            self.falls_back = false;
            #[cfg(feature = "wgpu")]
            {
                self.on_gpu = None;
            }
        }
        may
    }

    /// The dry pane of a weather: on the GPU, where that is faster and has room for it, with the same bits.
    pub(super) fn pane(
        &self,
        weather: &Weather,
        viewpoint: &Viewpoint,
        first_s: f64,
    ) -> Result<Option<WetPane>, RendererError> {
        #[cfg(feature = "wgpu")]
        if let Some(on_gpu) = self.on_gpu.as_ref().filter(|on| !on.gpu().adapter().is_software()) {
            let made =
                WetPane::on_gpu(on_gpu.gpu(), weather, viewpoint, first_s).map_err(RendererError::from);
            if !made.as_ref().is_err_and(RendererError::is_too_much_for_gpu) {
                return made;
            }
        }
        Ok(WetPane::new(weather, viewpoint, first_s)?)
    }

    /// The puddles of a weather that are to be seen at a refraction of drops: the GPU holds their ripples, where that is faster and has room
    /// for them.
    #[cfg_attr(not(feature = "wgpu"), expect(unused_variables, reason = "the CPU holds all ripples"))]
    pub(super) fn ground(
        &self,
        weather: &Weather,
        loaded: &Loaded,
        first: &FrameScene,
        first_s: f64,
        refraction: RefractionForm,
    ) -> Result<Option<WetGround>, RendererError> {
        let ground = WetGround::new(weather, loaded, first, first_s)?;
        // A pane before the papers' captures has an environment map that the CPU traces.
        let is_seen_by_cpu = weather.glass.is_some() && refraction != RefractionForm::Direction;
        match ground {
            #[cfg(feature = "wgpu")]
            Some(mut ground) if !is_seen_by_cpu => {
                if let Some(on_gpu) = self.on_gpu.as_ref().filter(|on| on.holds_ripples())
                    && let Err(error) = on_gpu.hold_ripples(&mut ground)
                    && !error.is_too_much_for_gpu()
                {
                    return Err(error);
                }
                Ok(Some(ground))
            }
            ground => Ok(ground),
        }
    }

    /// The device that finds or steps drops, and the number of drops that it has room for.
    #[cfg(feature = "wgpu")]
    pub(super) fn finder(&self) -> Option<(&downpour_gpu::Gpu, u32)> {
        self.on_gpu.as_ref().map(|on_gpu| (on_gpu.gpu(), on_gpu.max_drops()))
    }

    /// Draws a frame for a display, if a GPU draws.
    #[cfg(feature = "wgpu")]
    pub(super) fn display(
        &self,
        of: PlateUse,
        tone: &downpour_render::tone::Tone,
        seen: (&FrameScene, &Drops),
        drawn: (&DropMasks, &PictureOptions),
        flashes: &[super::flash::FlashPicture],
    ) -> Result<Option<downpour_trace::gpu::DisplayReadback>, RendererError> {
        self.on_gpu.as_ref().map_or(Ok(None), |on_gpu| on_gpu.display(of, tone, seen, drawn, flashes))
    }

    /// Finds the light of sky and surfaces in a frame of a clip for the frames after it.
    pub(super) fn find_light(
        &self,
        window: &LightWindow,
        frame_scene: &FrameScene,
        options: &PictureOptions,
    ) -> Result<(), RendererError> {
        let (scene, eye) = (&frame_scene.data, &frame_scene.viewpoint);
        #[cfg(feature = "wgpu")]
        if let Some(on_gpu) = &self.on_gpu {
            return Ok(on_gpu.renderer().find_light(window, scene, eye, options)?);
        }
        Ok(find_light(&mut self.kept.borrow_mut(), window, scene, eye, options)?)
    }

    /// True if the light of a frame of a clip is there for the frames after it.
    pub(super) fn has_light(&self, time_s: f64) -> bool {
        #[cfg(feature = "wgpu")]
        if let Some(on_gpu) = &self.on_gpu {
            return on_gpu.renderer().has_light(time_s);
        }
        self.kept.borrow().light.has(time_s)
    }

    /// Forgets the light of all frames: others would show another scene.
    pub(super) fn forget_light(&self) {
        #[cfg(feature = "wgpu")]
        if let Some(on_gpu) = &self.on_gpu {
            on_gpu.renderer().forget_light();
        }
        self.kept.borrow_mut().light = LightHistory::default();
    }

    /// Draws a frame, seen through a pane if there is one.
    pub(super) fn paint(
        &self,
        of: PlateUse,
        frame_scene: &FrameScene,
        drops: &Drops,
        masks: &DropMasks,
        options: &PictureOptions,
        through: Option<&PaneView>,
    ) -> Result<Painted, RendererError> {
        #[cfg(feature = "wgpu")]
        if let Some(on_gpu) = &self.on_gpu {
            return on_gpu.paint(of, frame_scene, drops, masks, options, through);
        }
        let drops = match drops {
            Drops::Listed(drops) => frame_scene.place(&drops.drops),
            Drops::OfDevice(shown) => frame_scene.place(&shown.droplets),
        };
        let mut kept = self.kept.borrow_mut();
        let (scene, eye) = (&frame_scene.data, &frame_scene.viewpoint);
        let mut picture = render_picture_on(&mut kept, of, scene, eye, &drops, masks, options)?;
        drop(kept);
        if let Some(PaneView { glass, environment, glow, camera }) = through {
            let environment = environment.as_ref().unwrap_or(&picture.environment);
            let behind = picture.behind_glass();
            let seen = timed(&mut picture.passes, "glass", || glass.through(&behind, environment));
            picture.through_glass = Some(seen);
            picture.add_glow(glow, camera);
        }
        Ok(Painted::Done(Box::new((picture, None))))
    }
}

/// The CPU, and why it draws in place of a GPU.
fn cpu(reason: Option<String>) -> Computer {
    Computer { adapter: "CPU".to_owned(), backend: "cpu", driver: std::env::consts::ARCH.to_owned(), reason }
}
