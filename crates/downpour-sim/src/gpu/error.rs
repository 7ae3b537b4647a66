//! Errors of simulations on a GPU.

use downpour_gpu::GpuError;

use crate::SimError;

/// Error of a simulation on a GPU.
#[derive(Clone, Debug, thiserror::Error)]
pub enum GpuSimError {
    /// The simulation is not valid.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}
