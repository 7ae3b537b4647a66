//! What can go wrong between a program and its GPU.

use std::time::Duration;

/// Why a GPU did not do what was asked.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter at all.
    #[error("no GPU adapter found; tried: {tried}. {way_out}")]
    NoAdapter {
        /// Which backends and drivers were looked for, and what was found of each.
        tried: String,
        /// What a person can do about it.
        way_out: &'static str,
    },
    /// No adapter has the wanted name.
    #[error("no GPU adapter's name contains \"{wanted}\"; there are: {found}")]
    AdapterNotFound {
        /// The part of a name that was asked for.
        wanted: String,
        /// The names that there are.
        found: String,
    },
    /// The adapter does not give a device.
    #[error("adapter \"{adapter}\" gives no device: {reason}")]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// What wgpu says.
        reason: String,
    },
    /// The device was lost; nothing that it computed may be used.
    #[error("the GPU device was lost ({reason}); nothing was published")]
    Lost {
        /// What the driver says, if anything.
        reason: String,
    },
    /// The device did not finish in time. Dropping it would block: save what is needed and end the process.
    #[error("the GPU did not finish within {waited:?}; it hangs or the work is too large for it")]
    Hung {
        /// How long was waited.
        waited: Duration,
    },
    /// The device has no memory left.
    #[error("the GPU has not enough memory for {what} ({need_bytes} bytes)")]
    OutOfMemory {
        /// What was to be made.
        what: String,
        /// Its size.
        need_bytes: u64,
    },
    /// A size is above what the device allows.
    #[error("{what} is {found}; this device allows {limit_name} = {allowed}")]
    OverLimit {
        /// What was to be made.
        what: String,
        /// Its size.
        found: u64,
        /// The wgpu name of the limit.
        limit_name: &'static str,
        /// The limit.
        allowed: u64,
    },
    /// A caller's device lacks something that is needed.
    #[error("this device lacks {missing}")]
    Missing {
        /// The features or limits, by their wgpu names.
        missing: String,
    },
    /// wgpu refused a call. This is a defect of Downpour (or of the driver), not of the input.
    #[error("the GPU refused {what}: {reason}")]
    Refused {
        /// What was to be made or done.
        what: String,
        /// What wgpu says.
        reason: String,
    },
}

impl GpuError {
    /// The exit code of the command for this error: 3 over a limit, 4 everything else of a GPU.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::OverLimit { .. } => 3,
            _ => 4,
        }
    }
}
