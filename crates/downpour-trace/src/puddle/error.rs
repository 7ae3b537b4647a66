//! Errors of puddles.

use downpour_drop::DropError;
use downpour_lattice::LatticeError;
use downpour_sim::SimError;

/// Error of puddles.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum PuddleError {
    /// The lattice of the ripples.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The rain on it.
    #[error(transparent)]
    Rain(#[from] DropError),
    /// The drops on it.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// The GPU that holds the lattice.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    Gpu(#[from] downpour_gpu::GpuError),
}

#[cfg(feature = "wgpu")]
impl From<downpour_lattice::gpu::puddle::GpuPuddleError> for PuddleError {
    fn from(error: downpour_lattice::gpu::puddle::GpuPuddleError) -> Self {
        use downpour_lattice::gpu::puddle::GpuPuddleError;
        match error {
            GpuPuddleError::Lattice(error) => Self::Lattice(error),
            GpuPuddleError::Gpu(error) => Self::Gpu(error),
            // A reason of a later version of the lattice.
            other => Self::Gpu(downpour_gpu::GpuError::Refused {
                what: "a puddle".to_owned(),
                reason: other.to_string(),
            }),
        }
    }
}
