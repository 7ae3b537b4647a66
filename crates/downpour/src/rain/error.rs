//! Errors of rain in a host application.

use downpour_drop::DropError;
use downpour_gpu::GpuError;
use downpour_mask::MaskError;
use downpour_math::OutOfRange;
use downpour_render::RenderError;
use downpour_sim::SimError;
use downpour_sim::gpu::GpuSimError;

/// Reason why a frame has no rain. Nothing was recorded that blends into the host's color texture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RainError {
    /// A number is not finite or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// A texture does not fit.
    #[error("the {what} has {found}; allowed: {allowed}")]
    Texture {
        /// The texture.
        what: &'static str,
        /// Property that does not fit.
        found: String,
        /// Allowed values of it.
        allowed: String,
    },
    /// A view of a texture does not show its first level, in the texture's format.
    #[error(
        "the view of the {what} does not fit; allowed: one layer of its first level, in the texture's format ({reason})"
    )]
    View {
        /// The texture.
        what: &'static str,
        /// Message of wgpu.
        reason: String,
    },
    /// There are too many of something.
    #[error("{found} {quantity}; allowed: up to {allowed}")]
    TooMany {
        /// Name of what there is too much of.
        quantity: &'static str,
        /// Number found.
        found: u64,
        /// Largest number.
        allowed: u64,
    },
    /// The wind differs from place to place.
    #[error("the wind is not uniform; allowed: uniform parts and gusts, no vortices, sources or turbulence")]
    WindNotUniform,
    /// The drops cannot be.
    #[error(transparent)]
    Drop(#[from] DropError),
    /// The masks of the drops cannot be.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The positions of the drops cannot be found.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// The view cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The device refused, is lost or has no memory left.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The device cannot find the drops.
    #[error(transparent)]
    GpuSim(#[from] GpuSimError),
}
