//! A pane of glass on either side: the same bits.

#[cfg(feature = "gpu")]
use downpour::gpu::Gpu;
use downpour::lattice::glass::{Glass, GlassOptions, GlassTotals};
#[cfg(feature = "gpu")]
use downpour::lattice::gpu::glass::GpuGlass;
use glam::Vec3;

use super::device::{Device, RunError};

/// A pane of glass.
pub(super) enum Pane {
    Cpu(Box<Glass>),
    #[cfg(feature = "gpu")]
    Gpu(Gpu, Box<GpuGlass>),
}

impl Device for Pane {
    type Options = GlassOptions;

    fn on_cpu(options: &GlassOptions) -> Result<Self, RunError> {
        Ok(Self::Cpu(Box::new(Glass::new(options)?)))
    }

    #[cfg(feature = "gpu")]
    fn on_gpu(gpu: &Gpu, options: &GlassOptions) -> Result<Self, RunError> {
        Ok(Self::Gpu(gpu.clone(), Box::new(GpuGlass::new(gpu, options)?)))
    }
}

impl Pane {
    /// Advances by a time in seconds, and waits for the device.
    pub(super) fn step(&mut self, dt_s: f64) -> Result<(), RunError> {
        match self {
            Self::Cpu(glass) => glass.step(dt_s)?,
            #[cfg(feature = "gpu")]
            Self::Gpu(gpu, glass) => {
                glass.step(dt_s)?;
                gpu.wait()?;
            }
        }
        Ok(())
    }

    /// The length of a tick, s.
    pub(super) fn tick_s(&self) -> f64 {
        match self {
            Self::Cpu(glass) => glass.tick_s(),
            #[cfg(feature = "gpu")]
            Self::Gpu(_, glass) => glass.tick_s(),
        }
    }

    /// Number of ticks so far.
    pub(super) fn ticks(&self) -> u64 {
        match self {
            Self::Cpu(glass) => glass.ticks(),
            #[cfg(feature = "gpu")]
            Self::Gpu(_, glass) => glass.ticks(),
        }
    }

    /// Mass of each cell, nl.
    pub(super) fn mass(&self) -> Result<Vec<u32>, RunError> {
        match self {
            Self::Cpu(glass) => Ok(glass.mass().to_vec()),
            #[cfg(feature = "gpu")]
            Self::Gpu(_, glass) => Ok(glass.mass()?),
        }
    }

    /// Height of the water in each cell, m.
    pub(super) fn heights(&self) -> Result<Vec<f32>, RunError> {
        match self {
            Self::Cpu(glass) => Ok(glass.heights()),
            #[cfg(feature = "gpu")]
            Self::Gpu(_, glass) => Ok(glass.heights()?),
        }
    }

    /// Unit normals.
    pub(super) fn normals(&self) -> Result<Vec<Vec3>, RunError> {
        match self {
            Self::Cpu(glass) => Ok(glass.normals()),
            #[cfg(feature = "gpu")]
            Self::Gpu(_, glass) => Ok(glass.normals()?),
        }
    }

    /// Volumes of water by state, nl.
    pub(super) fn totals(&self) -> Result<GlassTotals, RunError> {
        match self {
            Self::Cpu(glass) => Ok(glass.totals()),
            #[cfg(feature = "gpu")]
            Self::Gpu(_, glass) => Ok(glass.totals()?),
        }
    }

    /// True if the state is valid. A GPU checks less of it: masses, and that no water is lost.
    pub(super) fn is_sound(&self) -> Result<bool, RunError> {
        match self {
            Self::Cpu(glass) => Ok(glass.is_sound()),
            #[cfg(feature = "gpu")]
            Self::Gpu(_, glass) => {
                use downpour::shaders::lattice::glass::GLASS_MAX_MASS;
                let held = glass.mass()?.into_iter().all(|mass| mass <= GLASS_MAX_MASS);
                Ok(held && glass.totals()?.lost() == 0)
            }
        }
    }
}
