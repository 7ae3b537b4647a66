//! The adapter that the tests run on.

use downpour_gpu::{AdapterChoice, Gpu, GpuError, GpuOptions, LimitSet};
use downpour_shaders::render::scene::TRACE_STORAGE_BUFFERS;

/// Set to `no`, GPU tests show as ignored. Anything else, or nothing, and a missing adapter is a failure.
pub const SWITCH: &str = "DOWNPOUR_GPU_TESTS";

/// Part of the name of the adapter to take; by default a real GPU before a software driver.
pub const ADAPTER: &str = "DOWNPOUR_ADAPTER";

/// True if GPU tests were switched off explicitly.
#[must_use]
pub fn switched_off() -> bool {
    std::env::var(SWITCH).is_ok_and(|v| v == "no")
}

/// Advice on what to do if no adapter opens, in one line.
#[must_use]
pub fn missing(error: &GpuError) -> String {
    let said = error.to_string().replace('\n', " ");
    format!(
        "no GPU to test on ({said}): run `cargo xtask test`, which installs a software driver where it may, or install one \
         (Debian: apt-get install libvulkan1 mesa-vulkan-drivers), or set {SWITCH}=no to leave these tests out"
    )
}

/// A device with the limits that every WebGPU implementation has, but for the storage buffers of the kernel that traces all samples at once.
///
/// # Errors
/// Returns the error of [`Gpu::open_with`]: with no adapter, the drivers that were tried.
pub fn open() -> Result<Gpu, GpuError> {
    let adapter = match std::env::var(ADAPTER) {
        Ok(name) if !name.is_empty() => AdapterChoice::Named(name),
        _ => AdapterChoice::Auto,
    };
    let limits = LimitSet::WebGpuWithBuffers(TRACE_STORAGE_BUFFERS);
    Gpu::open_with(&GpuOptions { adapter, limits, ..GpuOptions::default() })
}
