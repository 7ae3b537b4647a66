//! What can go wrong on a GPU.

use downpour_gpu::GpuError;

use crate::SimError;

/// Why there is no rain on the GPU.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuSimError {
    /// What was asked for.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

impl GpuSimError {
    /// The exit code of the command for this error.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Sim(error) => error.exit_code(),
            Self::Gpu(error) => error.exit_code(),
        }
    }
}
