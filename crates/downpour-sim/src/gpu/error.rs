//! Errors of simulations on a GPU.

use downpour_gpu::GpuError;

use crate::SimError;

/// Error of a simulation on a GPU.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuSimError {
    /// The simulation is not valid.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

impl GpuSimError {
    /// Exit code of the command for this error.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Sim(error) => error.exit_code(),
            Self::Gpu(error) => error.exit_code(),
        }
    }
}
