//! The adapter that the tests run on.

use downpour_gpu::{AdapterChoice, Gpu, GpuError, GpuOptions, LimitSet};

/// Set to `no`, GPU tests show as ignored. Anything else, or nothing, and a missing adapter is a failure.
pub const SWITCH: &str = "DOWNPOUR_GPU_TESTS";

/// Part of the name of the adapter to take; by default a real GPU before a software driver.
pub const ADAPTER: &str = "DOWNPOUR_ADAPTER";

/// Whether GPU tests were switched off out loud.
#[must_use]
pub fn switched_off() -> bool {
    std::env::var(SWITCH).is_ok_and(|v| v == "no")
}

/// A device with the limits that every WebGPU implementation has.
///
/// # Errors
/// What [`Gpu::open_with`] says: with no adapter, the drivers that were tried.
pub fn open() -> Result<Gpu, GpuError> {
    let adapter = match std::env::var(ADAPTER) {
        Ok(name) if !name.is_empty() => AdapterChoice::Named(name),
        _ => AdapterChoice::Auto,
    };
    Gpu::open_with(&GpuOptions { adapter, limits: LimitSet::WebGpuDefault, ..GpuOptions::default() })
}
