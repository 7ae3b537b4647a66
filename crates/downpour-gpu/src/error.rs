//! Errors of GPU work.

use std::time::Duration;

/// Error of a GPU operation.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// The machine has no usable adapter.
    #[error("no GPU adapter found; tried: {tried}. {way_out}")]
    NoAdapter {
        /// Backends and drivers that were tried, and the result of each.
        tried: String,
        /// Advice to the user.
        way_out: &'static str,
    },
    /// No adapter matches the requested name.
    #[error("no GPU adapter's name contains \"{wanted}\"; there are: {found}")]
    AdapterNotFound {
        /// Requested part of a name.
        wanted: String,
        /// Names of the available adapters.
        found: String,
    },
    /// The adapter does not open a device.
    #[error("cannot open a device on adapter \"{adapter}\": {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// Message of wgpu.
        reason: String,
    },
    /// The device was lost; none of its results may be used.
    #[error("the GPU device was lost ({reason}); nothing was published")]
    Lost {
        /// Message of the driver, if any.
        reason: String,
    },
    /// The device did not finish in time. Dropping it would block: save all results and end the process.
    #[error("the GPU did not finish within {waited:?}; it hangs or the work is too large for it")]
    Hung {
        /// Time waited.
        waited: Duration,
    },
    /// The device is out of memory.
    #[error("the GPU has not enough memory for {what} ({need_bytes} bytes)")]
    OutOfMemory {
        /// Object that was requested.
        what: String,
        /// Its size in bytes.
        need_bytes: u64,
    },
    /// A size exceeds a limit of the device.
    #[error("{what} is {found}; this device allows {limit_name} = {allowed}")]
    OverLimit {
        /// Object that was requested.
        what: String,
        /// Its size.
        found: u64,
        /// wgpu's name of the limit.
        limit_name: &'static str,
        /// Value of the limit.
        allowed: u64,
    },
    /// A caller's device lacks a required feature or limit.
    #[error("this device lacks {missing}")]
    Missing {
        /// Missing features or limits, by their wgpu names.
        missing: String,
    },
    /// wgpu refused a call. This is a defect of Downpour or of the driver, not of the input.
    #[error("the GPU refused {what}: {reason}")]
    Refused {
        /// Object or operation that was requested.
        what: String,
        /// Message of wgpu.
        reason: String,
    },
}
