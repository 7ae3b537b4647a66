//! Device of a lattice: the CPU, or a GPU, behind one interface.

#[cfg(feature = "gpu")]
use downpour::gpu::{Gpu, GpuError};
use downpour::lattice::LatticeError;
use downpour::lattice::glass::GlassError;

use crate::backend::{BackendArguments, compute};
use crate::failure::Failure;
use crate::interrupt::Interrupt;

/// A lattice that either side can hold.
pub(super) trait Device: Sized {
    type Options;

    fn on_cpu(options: &Self::Options) -> Result<Self, RunError>;

    #[cfg(feature = "gpu")]
    fn on_gpu(gpu: &Gpu, options: &Self::Options) -> Result<Self, RunError>;
}

/// Error that ended a run early: of its input, or of its device.
#[derive(Debug)]
pub(super) enum RunError {
    Failed(Failure),
    #[cfg(feature = "gpu")]
    Gpu(GpuError),
}

/// Runs a lattice on the requested device. `auto` uses the CPU if a lattice is too large for the GPU.
///
/// # Errors
/// As [`compute`].
pub(super) fn with_device<D: Device, T>(
    arguments: &BackendArguments,
    interrupt: &Interrupt,
    say: impl Fn(&str),
    options: &D::Options,
    run: impl Fn(D) -> Result<T, RunError>,
) -> Result<T, Failure> {
    let on_cpu = || run(D::on_cpu(options)?).map_err(Failure::from);
    #[cfg(feature = "gpu")]
    return compute(
        arguments,
        interrupt,
        say,
        |gpu| run(D::on_gpu(gpu, options)?).map_err(RunError::begun),
        on_cpu,
    );
    #[cfg(not(feature = "gpu"))]
    {
        // A signal ends the work at any point.
        let _ = interrupt;
        compute(arguments, say, on_cpu)
    }
}

impl From<Failure> for RunError {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl From<GlassError> for RunError {
    fn from(error: GlassError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<LatticeError> for RunError {
    fn from(error: LatticeError) -> Self {
        Self::Failed(error.into())
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Failed(failure) => failure,
            #[cfg(feature = "gpu")]
            RunError::Gpu(error) => error.into(),
        }
    }
}

#[cfg(feature = "gpu")]
mod gpu {
    use std::fmt;

    use downpour::gpu::GpuError;
    use downpour::lattice::gpu::glass::GpuGlassError;
    use downpour::lattice::gpu::puddle::GpuPuddleError;

    use super::RunError;
    use crate::backend::FromGpu;

    impl RunError {
        /// Marks the error of a run that has started. Pictures may exist already, so it does not restart on the CPU.
        pub(super) fn begun(self) -> Self {
            match self {
                Self::Gpu(error @ (GpuError::OverLimit { .. } | GpuError::OutOfMemory { .. })) => {
                    Self::Failed(error.into())
                }
                error => error,
            }
        }
    }

    impl From<GpuError> for RunError {
        fn from(error: GpuError) -> Self {
            Self::Gpu(error)
        }
    }

    impl From<GpuGlassError> for RunError {
        fn from(error: GpuGlassError) -> Self {
            match error {
                GpuGlassError::Glass(error) => error.into(),
                GpuGlassError::Gpu(error) => Self::Gpu(error),
                // Other kinds of errors may be added.
                error => Self::Failed(error.into()),
            }
        }
    }

    impl From<GpuPuddleError> for RunError {
        fn from(error: GpuPuddleError) -> Self {
            match error {
                GpuPuddleError::Lattice(error) => error.into(),
                GpuPuddleError::Gpu(error) => Self::Gpu(error),
                error => Self::Failed(error.into()),
            }
        }
    }

    impl fmt::Display for RunError {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            match self {
                Self::Failed(failure) => failure.fmt(f),
                Self::Gpu(error) => error.fmt(f),
            }
        }
    }

    impl FromGpu for RunError {
        fn gpu(&self) -> Option<&GpuError> {
            if let Self::Gpu(error) = self { Some(error) } else { None }
        }
    }
}
