//! The device that tests of a crate run on.

use std::time::Duration;

use downpour::gpu::{AdapterChoice, Gpu, GpuOptions, LimitSet};

/// A device with some limits; `None` with `DOWNPOUR_GPU_TESTS=no`. `DOWNPOUR_ADAPTER` is part of the name of the adapter to
/// use.
///
/// # Panics
/// Panics without an adapter, and says what to do.
pub(crate) fn gpu(limits: LimitSet) -> Option<Gpu> {
    if std::env::var("DOWNPOUR_GPU_TESTS").is_ok_and(|value| value == "no") {
        return None;
    }
    let adapter = match std::env::var("DOWNPOUR_ADAPTER") {
        Ok(name) if !name.is_empty() => AdapterChoice::Named(name),
        _ => AdapterChoice::Auto,
    };
    // A software driver on a busy machine takes its time.
    let options = GpuOptions { adapter, limits, timeout: Duration::from_secs(600), ..GpuOptions::default() };
    let opened = Gpu::open_with(&options).map_err(|error| error.to_string().replace('\n', " "));
    Some(opened.unwrap_or_else(|error| {
        panic!(
            "no GPU to test on ({error}): run `cargo xtask test`, which installs a software driver where it may, or install \
             one (Debian: apt-get install libvulkan1 mesa-vulkan-drivers), or set DOWNPOUR_GPU_TESTS=no to leave these tests \
             out"
        )
    }))
}
