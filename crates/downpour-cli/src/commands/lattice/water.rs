//! The water of a puddle on either side: equal to rounding.

#[cfg(feature = "gpu")]
use downpour::gpu::Gpu;
#[cfg(feature = "gpu")]
use downpour::lattice::gpu::puddle::GpuPuddle;
use downpour::lattice::puddle::{Impact, Puddle, PuddleOptions};

use super::device::{Device, RunError};

/// A puddle.
pub(super) struct Water {
    /// The puddle itself, or, with a GPU, a copy for reading its state.
    puddle: Puddle,
    #[cfg(feature = "gpu")]
    gpu: Option<GpuPuddle>,
}

impl Device for Water {
    type Options = PuddleOptions;

    fn on_cpu(options: &PuddleOptions) -> Result<Self, RunError> {
        Ok(Self {
            puddle: Puddle::new(options)?,
            #[cfg(feature = "gpu")]
            gpu: None,
        })
    }

    #[cfg(feature = "gpu")]
    fn on_gpu(gpu: &Gpu, options: &PuddleOptions) -> Result<Self, RunError> {
        Ok(Self { puddle: Puddle::new(options)?, gpu: Some(GpuPuddle::new(gpu, options)?) })
    }
}

impl Water {
    /// Edges, m.
    pub(super) fn extent_m(&self) -> [f32; 2] {
        self.puddle.extent_m()
    }

    /// Drops meet the water.
    pub(super) fn seed(&mut self, impacts: &[Impact]) -> Result<(), RunError> {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &mut self.gpu {
            return Ok(gpu.seed(impacts)?);
        }
        Ok(self.puddle.seed(impacts)?)
    }

    /// Advances by a constant time step.
    pub(super) fn step(&mut self, dt_s: f32) -> Result<(), RunError> {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &mut self.gpu {
            if gpu.steps() == 0 {
                // The energy is that of the operator which belongs to this step.
                self.puddle.step(dt_s)?;
            }
            gpu.step(dt_s)?;
            return Ok(());
        }
        self.puddle.step(dt_s)?;
        Ok(())
    }

    /// Current state of the puddle, without the number of its steps and resets.
    pub(super) fn look(&mut self) -> Result<&Puddle, RunError> {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.gpu {
            let [heights, velocities] = gpu.state()?;
            self.puddle.set_state(&heights, &velocities)?;
        }
        Ok(&self.puddle)
    }

    /// Number of time steps so far.
    pub(super) fn steps(&self) -> u64 {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.gpu {
            return gpu.steps();
        }
        self.puddle.steps()
    }

    /// Number of cells that were set to rest.
    pub(super) fn reset_cells(&self) -> Result<u64, RunError> {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.gpu {
            return Ok(gpu.reset_cells()?);
        }
        Ok(self.puddle.reset_cells())
    }
}
