//! Exit codes of the errors of the libraries.

use downpour::RendererError;
use downpour::atlas::AtlasError;
use downpour::drop::DropError;
use downpour::lattice::LatticeError;
use downpour::lattice::glass::GlassError;
use downpour::mask::MaskError;
use downpour::render::RenderError;
use downpour::render::glass::PaneError;
use downpour::scene::SceneError;
use downpour::shower::ShowerError;
use downpour::sim::SimError;
use downpour::specimen::SpecimenError;
use downpour::street::StreetError;
use downpour::trace::frame_scene::FrameSceneError;
use downpour::trace::puddle::PuddleError;
use downpour::wind::WindError;

/// Any error without a specific code, such as a bug in Downpour.
pub(crate) const OTHER: u8 = 1;
/// Bad arguments or input.
pub(crate) const INPUT: u8 = 2;
/// Over a limit.
pub(crate) const LIMIT: u8 = 3;
/// No GPU, or a GPU that was lost, hangs or has no memory left.
pub(crate) const GPU: u8 = 4;
/// A file that cannot be read or written.
pub(crate) const FILES: u8 = 5;
/// Canceled by a signal.
#[cfg(unix)]
pub(crate) const CANCELED: u8 = 6;

/// Message of `render` where no option names the streak atlas that the weather asks for.
pub(crate) const NO_ATLAS: &str = "streaks.color is \"atlas\" or \"atlas-random\", and no --streaks; allowed: with --streaks \
                                   FOLDER, where the streak atlas is";

/// An error with the code that the command ends with.
pub(crate) trait ExitCode: ToString {
    /// The exit code: [`INPUT`], [`LIMIT`], [`GPU`], [`FILES`] or [`OTHER`].
    fn exit_code(&self) -> u8;

    /// The message, in the words of the command.
    fn message(&self) -> String {
        self.to_string()
    }
}

impl ExitCode for DropError {
    fn exit_code(&self) -> u8 {
        INPUT
    }
}

impl ExitCode for SceneError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::OverLimit(_) => LIMIT,
            Self::Unreadable(_) => FILES,
            _ => INPUT,
        }
    }
}

impl ExitCode for MaskError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Size { found, max, .. } if found > max => LIMIT,
            Self::Encode { .. } => OTHER,
            Self::InFile { error, .. } => error.exit_code(),
            _ => INPUT,
        }
    }
}

impl ExitCode for AtlasError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Encode(error) => error.exit_code(),
            Self::Unreadable { .. } => FILES,
            Self::InFile { error, .. } => error.exit_code(),
            _ => INPUT,
        }
    }
}

impl ExitCode for WindError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::TooManyCells { .. } | Self::TooManyParts { .. } | Self::KeyCount { found: 1.., .. } => {
                LIMIT
            }
            _ => INPUT,
        }
    }
}

impl ExitCode for SimError {
    fn exit_code(&self) -> u8 {
        if matches!(self, Self::Memory { .. }) { LIMIT } else { INPUT }
    }
}

impl ExitCode for LatticeError {
    fn exit_code(&self) -> u8 {
        INPUT
    }
}

impl ExitCode for GlassError {
    fn exit_code(&self) -> u8 {
        INPUT
    }
}

impl ExitCode for RenderError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Size { found, max, .. } if found.iter().any(|n| n > max) => LIMIT,
            Self::Encode { .. } => OTHER,
            _ => INPUT,
        }
    }
}

impl ExitCode for PaneError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Render(error) => error.exit_code(),
            #[cfg(feature = "gpu")]
            Self::Gpu(error) => error.exit_code(),
            _ => INPUT,
        }
    }
}

impl ExitCode for PuddleError {
    fn exit_code(&self) -> u8 {
        INPUT
    }
}

impl ExitCode for StreetError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Setting { .. } => INPUT,
            Self::Texture { .. } => OTHER,
        }
    }
}

impl ExitCode for FrameSceneError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Render(error) => error.exit_code(),
            Self::TooFar { .. } => INPUT,
            _ => LIMIT,
        }
    }
}

impl ExitCode for ShowerError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Sim(error) => error.exit_code(),
            Self::Wind(error) => error.exit_code(),
            Self::Render(error) => error.exit_code(),
            Self::FrameScene(error) => error.exit_code(),
            Self::Pane(error) => error.exit_code(),
            _ => INPUT,
        }
    }
}

impl ExitCode for SpecimenError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Size { found, max, .. } if found > max => LIMIT,
            Self::Mask(error) => error.exit_code(),
            Self::Render(error) => error.exit_code(),
            _ => INPUT,
        }
    }
}

impl ExitCode for RendererError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Scene(error) => error.exit_code(),
            Self::FrameScene(error) => error.exit_code(),
            Self::Shower(error) => error.exit_code(),
            Self::Pane(error) => error.exit_code(),
            Self::Mask(error) => error.exit_code(),
            Self::Render(error) => error.exit_code(),
            Self::NoGpuSupport => GPU,
            Self::Write { .. } => FILES,
            #[cfg(feature = "gpu")]
            Self::Gpu(error) => error.exit_code(),
            #[cfg(feature = "gpu")]
            Self::Picture(error) => error.exit_code(),
            _ => INPUT,
        }
    }

    fn message(&self) -> String {
        match self {
            // A library has no option of this name.
            Self::NoAtlas => NO_ATLAS.to_owned(),
            error => error.to_string(),
        }
    }
}

#[cfg(feature = "gpu")]
mod gpu {
    use downpour::gpu::GpuError;
    use downpour::lattice::gpu::glass::GpuGlassError;
    use downpour::lattice::gpu::puddle::GpuPuddleError;
    use downpour::mask::gpu::GpuMaskError;
    use downpour::specimen::gpu::GpuSpecimenError;
    use downpour::trace::gpu::GpuPictureError;

    use super::{ExitCode, GPU, INPUT, LIMIT};

    impl ExitCode for GpuError {
        fn exit_code(&self) -> u8 {
            if matches!(self, Self::OverLimit { .. }) { LIMIT } else { GPU }
        }
    }

    impl ExitCode for GpuMaskError {
        fn exit_code(&self) -> u8 {
            match self {
                Self::Mask(error) => error.exit_code(),
                Self::Gpu(error) => error.exit_code(),
                _ => INPUT,
            }
        }
    }

    impl ExitCode for GpuSpecimenError {
        fn exit_code(&self) -> u8 {
            match self {
                Self::Specimen(error) => error.exit_code(),
                Self::Gpu(error) => error.exit_code(),
                _ => INPUT,
            }
        }
    }

    impl ExitCode for GpuPictureError {
        fn exit_code(&self) -> u8 {
            match self {
                Self::Render(error) => error.exit_code(),
                Self::Gpu(error) => error.exit_code(),
                Self::NoRoom { .. } => LIMIT,
                _ => INPUT,
            }
        }
    }

    impl ExitCode for GpuGlassError {
        fn exit_code(&self) -> u8 {
            match self {
                Self::Glass(error) => error.exit_code(),
                Self::Gpu(error) => error.exit_code(),
                _ => INPUT,
            }
        }
    }

    impl ExitCode for GpuPuddleError {
        fn exit_code(&self) -> u8 {
            match self {
                Self::Lattice(error) => error.exit_code(),
                Self::Gpu(error) => error.exit_code(),
                _ => INPUT,
            }
        }
    }
}
