//! The lattice of a pane, on the CPU or on a GPU.

use downpour_lattice::glass::{Glass, GlassAir, GlassError, GlassOptions, GlassRain, GlassState};
#[cfg(feature = "wgpu")]
use downpour_lattice::gpu::glass::{GpuGlass, GpuGlassError};

use super::error::PaneError;

/// The lattice of a pane: on the CPU, or on a GPU with the same bits.
#[derive(Debug)]
#[non_exhaustive]
pub enum PaneLattice {
    /// On the CPU.
    Cpu(Box<Glass>),
    /// On a GPU.
    #[cfg(feature = "wgpu")]
    Gpu(Box<GpuGlass>),
}

impl PaneLattice {
    /// Creates a dry pane on the CPU.
    ///
    /// # Errors
    /// As [`Glass::new`].
    pub fn on_cpu(options: &GlassOptions) -> Result<Self, GlassError> {
        Ok(Self::Cpu(Box::new(Glass::new(options)?)))
    }

    /// Creates a dry pane on a GPU.
    ///
    /// # Errors
    /// As [`GpuGlass::new`].
    #[cfg(feature = "wgpu")]
    pub fn on_gpu(gpu: &downpour_gpu::Gpu, options: &GlassOptions) -> Result<Self, PaneError> {
        Ok(Self::Gpu(Box::new(GpuGlass::new(gpu, options)?)))
    }

    /// Options of the pane.
    #[must_use]
    pub fn options(&self) -> &GlassOptions {
        match self {
            Self::Cpu(glass) => glass.options(),
            #[cfg(feature = "wgpu")]
            Self::Gpu(glass) => glass.options(),
        }
    }

    /// Length of a tick, s.
    #[must_use]
    pub fn tick_s(&self) -> f64 {
        match self {
            Self::Cpu(glass) => glass.tick_s(),
            #[cfg(feature = "wgpu")]
            Self::Gpu(glass) => glass.tick_s(),
        }
    }

    /// Number of ticks that have passed.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        match self {
            Self::Cpu(glass) => glass.ticks(),
            #[cfg(feature = "wgpu")]
            Self::Gpu(glass) => glass.ticks(),
        }
    }

    /// Sets rain and air from now on.
    ///
    /// # Errors
    /// As [`Glass::set_weather`].
    pub fn set_weather(&mut self, rain: &GlassRain, air: &GlassAir) -> Result<(), PaneError> {
        match self {
            Self::Cpu(glass) => Ok(glass.set_weather(rain, air)?),
            #[cfg(feature = "wgpu")]
            Self::Gpu(glass) => Ok(glass.set_weather(rain, air)?),
        }
    }

    /// Advances the pane by `dt_s` seconds, and waits for it.
    ///
    /// # Errors
    /// As [`Glass::step`], or what the GPU says.
    pub fn step(&mut self, dt_s: f64) -> Result<(), PaneError> {
        match self {
            Self::Cpu(glass) => Ok(glass.step(dt_s)?),
            #[cfg(feature = "wgpu")]
            Self::Gpu(glass) => {
                glass.step(dt_s)?;
                Ok(glass.wait()?)
            }
        }
    }

    /// The water on the pane now.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn state(&self) -> Result<GlassState, PaneError> {
        match self {
            Self::Cpu(glass) => Ok(glass.state()),
            #[cfg(feature = "wgpu")]
            Self::Gpu(glass) => Ok(glass.state()?),
        }
    }
}

#[cfg(feature = "wgpu")]
impl From<GpuGlassError> for PaneError {
    fn from(error: GpuGlassError) -> Self {
        match error {
            GpuGlassError::Glass(error) => Self::Glass(error),
            GpuGlassError::Gpu(error) => Self::Gpu(error),
            other => Self::Gpu(downpour_gpu::GpuError::Refused {
                what: "a pane".to_owned(),
                reason: other.to_string(),
            }),
        }
    }
}
