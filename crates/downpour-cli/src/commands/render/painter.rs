//! What makes the pictures: opened once for all of them.

use downpour::render::RenderError;
use downpour::render::picture::{Picture, PictureOptions, render_picture};
use downpour::render::rain::DropMasks;
use downpour::render::stage::Stage;
use downpour::sim::field::FallingDrop;

use super::pane::Through;
use super::report::Computer;
use crate::backend::{BackendArguments, compute};
use crate::failure::Failure;
use crate::interrupt::Interrupt;

/// A GPU with its pipelines, or the CPU.
pub(super) struct Painter {
    computer: Computer,
    #[cfg(feature = "gpu")]
    renderer: Option<downpour::render::gpu::PictureRenderer>,
    #[cfg(feature = "gpu")]
    glass: Option<downpour::gpu::Gpu>,
    #[cfg(feature = "gpu")]
    glass_renderer: std::cell::OnceCell<downpour::render::gpu::GlassRenderer>,
}

/// Why there is no picture: what was wrong with it, or with what makes it.
#[derive(Debug)]
pub(super) enum PaintError {
    Failed(Failure),
    #[cfg(feature = "gpu")]
    Gpu(downpour::render::gpu::GpuPictureError),
}

impl Painter {
    fn cpu() -> Self {
        let computer =
            Computer { adapter: "CPU".to_owned(), backend: "cpu", driver: std::env::consts::ARCH.to_owned() };
        Self {
            computer,
            #[cfg(feature = "gpu")]
            renderer: None,
            #[cfg(feature = "gpu")]
            glass: None,
            #[cfg(feature = "gpu")]
            glass_renderer: std::cell::OnceCell::new(),
        }
    }

    #[cfg(feature = "gpu")]
    fn gpu(gpu: &downpour::gpu::Gpu) -> Result<Self, PaintError> {
        let adapter = gpu.adapter();
        let computer = Computer {
            adapter: adapter.name.clone(),
            backend: "gpu",
            driver: format!("{} {} {}", adapter.backend, adapter.driver, adapter.driver_info),
        };
        let renderer = Some(downpour::render::gpu::PictureRenderer::new(gpu)?);
        Ok(Self { computer, renderer, glass: Some(gpu.clone()), glass_renderer: std::cell::OnceCell::new() })
    }

    pub(super) fn computer(&self) -> &Computer {
        &self.computer
    }

    /// Makes a picture.
    ///
    /// # Errors
    /// What the picture or the GPU says.
    pub(super) fn paint(
        &self,
        stage: &Stage,
        drops: &[FallingDrop],
        masks: &DropMasks,
        options: &PictureOptions,
    ) -> Result<Picture, PaintError> {
        let drops = stage.place(drops);
        #[cfg(feature = "gpu")]
        if let Some(renderer) = &self.renderer {
            return Ok(renderer.render(&stage.data, &stage.viewpoint, &drops, masks, options)?);
        }
        Ok(render_picture(&stage.data, &stage.viewpoint, &drops, masks, options)?)
    }
}

impl Painter {
    /// Looks at a picture through a pane, if there is one.
    ///
    /// # Errors
    /// What the GPU says.
    pub(super) fn look(&self, picture: &mut Picture, through: Option<Through>) -> Result<(), PaintError> {
        let Some(Through { glass, behind, capture }) = through else { return Ok(()) };
        let begin = std::time::Instant::now();
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.glass {
            use downpour::render::gpu::{GlassRenderer, GpuPictureError};
            // Made for the first picture that is seen through a pane.
            let renderer = match self.glass_renderer.get() {
                Some(renderer) => renderer,
                None => {
                    let made = GlassRenderer::new(gpu).map_err(GpuPictureError::from)?;
                    self.glass_renderer.get_or_init(|| made)
                }
            };
            let seen = renderer.through(&glass, &behind, &capture).map_err(GpuPictureError::from)?;
            picture.through_glass = Some(seen);
        }
        if picture.through_glass.is_none() {
            picture.through_glass = Some(glass.through(&behind, &capture));
        }
        picture.passes.push(("glass", begin.elapsed().as_secs_f64() * 1.0e3));
        Ok(())
    }
}

/// Does work with what the arguments ask for. `auto` begins the work again on the CPU where it is too much for a GPU.
///
/// # Errors
/// As [`compute`].
pub(super) fn with_painter<T>(
    arguments: &BackendArguments,
    interrupt: &Interrupt,
    say: impl Fn(&str),
    work: impl Fn(&Painter) -> Result<T, PaintError>,
) -> Result<T, Failure> {
    let on_cpu = || work(&Painter::cpu()).map_err(Failure::from);
    #[cfg(feature = "gpu")]
    return compute(arguments, interrupt, say, |gpu| work(&Painter::gpu(gpu)?), on_cpu);
    #[cfg(not(feature = "gpu"))]
    {
        // A signal ends the work wherever it is.
        let _ = interrupt;
        compute(arguments, say, on_cpu)
    }
}

impl From<Failure> for PaintError {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl From<RenderError> for PaintError {
    fn from(error: RenderError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<PaintError> for Failure {
    fn from(error: PaintError) -> Self {
        match error {
            PaintError::Failed(failure) => failure,
            #[cfg(feature = "gpu")]
            PaintError::Gpu(error) => error.into(),
        }
    }
}

#[cfg(feature = "gpu")]
mod gpu {
    use std::fmt;

    use downpour::gpu::GpuError;
    use downpour::render::gpu::GpuPictureError;

    use super::PaintError;
    use crate::backend::FromGpu;

    impl From<GpuPictureError> for PaintError {
        fn from(error: GpuPictureError) -> Self {
            Self::Gpu(error)
        }
    }

    impl fmt::Display for PaintError {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            match self {
                Self::Failed(failure) => failure.fmt(f),
                Self::Gpu(error) => error.fmt(f),
            }
        }
    }

    impl FromGpu for PaintError {
        fn gpu(&self) -> Option<&GpuError> {
            if let Self::Gpu(error) = self { error.gpu() } else { None }
        }
    }
}
