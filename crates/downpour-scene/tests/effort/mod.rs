//! CPU time of a piece of work: the same on a busy machine as on an idle one.

use std::time::Duration;

/// CPU time of this thread so far. Always 0 if the system does not report it.
#[cfg(unix)]
fn taken() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).unwrap_or(0))
}

#[cfg(not(unix))]
fn taken() -> Duration {
    Duration::ZERO
}

/// Result of a piece of work, and the CPU time that it used on this thread.
pub(crate) fn measured<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let before = taken();
    let made = work();
    (made, taken() - before)
}
