//! Kernel-level cases: a whole kernel against its CPU counterpart.

use downpour_gpu::{Gpu, GpuError};
use downpour_shaders::Kernel;

use crate::function::Run;
use crate::tolerance::Tol;

/// A kernel on some input, and what the CPU makes of the same.
pub struct KernelCase {
    /// Name of the case; the kernel's entry point and what is special about the input.
    pub name: &'static str,
    /// The kernel.
    pub kernel: &'static Kernel,
    /// WGSL functions that only make sense inside the kernel (they read its buffers), covered by this case.
    pub covers: &'static [&'static str],
    /// How far the two may differ.
    pub tol: Tol,
    /// Runs both sides. `arguments` of the run describe each element of the output.
    pub run: fn(&Gpu) -> Result<Run, GpuError>,
}
