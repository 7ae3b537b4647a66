//! Devices that draw frames: a GPU with its pipelines, or the CPU.

use downpour_render::camera::Viewpoint;
use downpour_render::glass::{GlassPicture, WetPane};
use downpour_render::picture::{Picture, PictureOptions, timed};
use downpour_render::rain::DropMasks;
use downpour_sim::field::FallingDrop;
use downpour_trace::picture::render_picture;
use downpour_trace::stage::Stage;
use downpour_weather::Weather;

use super::RendererError;

/// Choice of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A GPU, else a software driver of one, else the CPU; the CPU too for what is too much for the GPU.
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
                    Ok(gpu) => Ok(Device::gpu(gpu, self == Self::Auto)),
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
}

impl Device {
    /// The CPU.
    #[must_use]
    pub fn cpu() -> Self {
        Self {
            #[cfg(feature = "wgpu")]
            gpu: None,
            falls_back: false,
        }
    }

    /// A GPU. `falls_back`: the CPU draws all frames if the first is too much for it.
    #[cfg(feature = "wgpu")]
    #[must_use]
    pub fn gpu(gpu: downpour_gpu::Gpu, falls_back: bool) -> Self {
        Self { gpu: Some(gpu), falls_back }
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
    #[cfg(feature = "wgpu")]
    on_gpu: Option<OnGpu>,
}

#[cfg(feature = "wgpu")]
struct OnGpu {
    gpu: downpour_gpu::Gpu,
    renderer: downpour_trace::gpu::PictureRenderer,
    /// Made for the first frame that is seen through a pane.
    glass: std::cell::OnceCell<downpour_render::gpu::GlassRenderer>,
}

/// A picture, which may be on its way from the device.
#[derive(Debug)]
pub(super) enum Painted {
    Done(Picture),
    #[cfg(feature = "wgpu")]
    OnItsWay {
        read: Box<downpour_trace::gpu::PictureReadback>,
        through_glass: Option<Vec<[f32; 3]>>,
    },
}

impl Painted {
    /// The picture, if it is there.
    pub(super) fn done(&self) -> Option<&Picture> {
        match self {
            Self::Done(picture) => Some(picture),
            #[cfg(feature = "wgpu")]
            Self::OnItsWay { .. } => None,
        }
    }

    /// Waits for the picture.
    pub(super) fn finish(self) -> Result<Picture, RendererError> {
        match self {
            Self::Done(picture) => Ok(picture),
            #[cfg(feature = "wgpu")]
            Self::OnItsWay { read, through_glass } => Ok(Picture { through_glass, ..read.finish()? }),
        }
    }
}

/// Pane that a frame is seen through.
pub(super) struct Through {
    pub(super) glass: GlassPicture,
    /// The environment map that the pane shows; `None` takes the one of the drops.
    pub(super) environment: Option<Vec<[f32; 4]>>,
}

impl std::fmt::Debug for Drawer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Drawer").field("computer", &self.computer).finish_non_exhaustive()
    }
}

impl Drawer {
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
            let mut drawer = Self { computer, falls_back: device.falls_back, on_gpu: None };
            match renderer {
                Ok(renderer) => {
                    drawer.on_gpu = Some(OnGpu { gpu, renderer, glass: std::cell::OnceCell::new() });
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
        if let Some(OnGpu { gpu, .. }) = self.on_gpu.as_ref().filter(|on| !on.gpu.adapter().is_software()) {
            let made = WetPane::on_gpu(gpu, weather, viewpoint, first_s).map_err(RendererError::from);
            if !made.as_ref().is_err_and(RendererError::is_too_much_for_gpu) {
                return made;
            }
        }
        Ok(WetPane::new(weather, viewpoint, first_s)?)
    }

    /// Draws a frame, seen through a pane if there is one.
    pub(super) fn paint(
        &self,
        stage: &Stage,
        drops: &[FallingDrop],
        masks: &DropMasks,
        options: &PictureOptions,
        through: Option<&Through>,
    ) -> Result<Painted, RendererError> {
        let drops = stage.place(drops);
        #[cfg(feature = "wgpu")]
        if let Some(on_gpu) = &self.on_gpu {
            return on_gpu.paint(stage, &drops, masks, options, through);
        }
        let mut picture = render_picture(&stage.data, &stage.viewpoint, &drops, masks, options)?;
        if let Some(Through { glass, environment }) = through {
            let environment = environment.as_ref().unwrap_or(&picture.surroundings);
            let behind = picture.behind_glass();
            let seen = timed(&mut picture.passes, "glass", || glass.through(&behind, environment));
            picture.through_glass = Some(seen);
        }
        Ok(Painted::Done(picture))
    }
}

#[cfg(feature = "wgpu")]
impl OnGpu {
    fn paint(
        &self,
        stage: &Stage,
        drops: &[FallingDrop],
        masks: &DropMasks,
        options: &PictureOptions,
        through: Option<&Through>,
    ) -> Result<Painted, RendererError> {
        use downpour_render::gpu::BehindGlass;
        let mut drawn = self.renderer.draw(&stage.data, &stage.viewpoint, drops, masks, options)?;
        let Some(Through { glass, environment }) = through else {
            return Ok(Painted::OnItsWay { read: Box::new(drawn.begin_read()?), through_glass: None });
        };
        let begin = std::time::Instant::now();
        let uploaded = environment
            .as_ref()
            .map(|texels| self.gpu.storage_buffer("environment map of a pane", texels))
            .transpose()?;
        let behind = drawn.behind_glass();
        let environment = uploaded.as_ref().unwrap_or(behind.environment);
        let seen = self.pane()?.through(glass, &BehindGlass { environment, ..behind })?;
        drawn.passes.push(("glass", begin.elapsed().as_secs_f64() * 1.0e3));
        Ok(Painted::OnItsWay { read: Box::new(drawn.begin_read()?), through_glass: Some(seen) })
    }

    /// The pipelines of panes.
    fn pane(&self) -> Result<&downpour_render::gpu::GlassRenderer, RendererError> {
        if let Some(renderer) = self.glass.get() {
            return Ok(renderer);
        }
        let made = downpour_render::gpu::GlassRenderer::new(&self.gpu)?;
        Ok(self.glass.get_or_init(|| made))
    }
}

/// The CPU, and why it draws in place of a GPU.
fn cpu(reason: Option<String>) -> Computer {
    Computer { adapter: "CPU".to_owned(), backend: "cpu", driver: std::env::consts::ARCH.to_owned(), reason }
}
