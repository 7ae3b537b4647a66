//! CPU time of a piece of work: on a busy machine it is what it is on an idle one.

use std::time::Duration;

/// CPU time that this thread has taken so far. Where the system does not tell, always 0.
#[cfg(unix)]
fn taken() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).unwrap_or(0))
}

#[cfg(not(unix))]
fn taken() -> Duration {
    Duration::ZERO
}

/// What a piece of work gives, and the CPU time that it takes of this thread.
pub(crate) fn measured<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let before = taken();
    let made = work();
    (made, taken() - before)
}
