//! Frames in flight: other threads wait for their pictures and encode them while the next ones are begun.

use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, Scope, ScopedJoinHandle};

use downpour::PendingFrame;
use serde_json::Value;

use crate::failure::{Failure, OTHER};

/// Pixels of all frames in flight together: 8 frames of 1920 x 1080.
const MAX_PIXELS: u64 = 1 << 24;

/// Most frames in flight.
const MAX_FRAMES: u64 = 8;

/// Files of a frame, and its entry in `--stats`.
pub(super) struct Encoded {
    pub(super) picture: Vec<u8>,
    /// Digest of the picture.
    pub(super) digest: String,
    pub(super) drops: Option<String>,
    pub(super) stats: Value,
}

/// A frame that is being finished: on another thread, or, where none could start, by now.
pub(super) enum Flying<'scope> {
    There(ScopedJoinHandle<'scope, Result<Encoded, Failure>>),
    Here(Box<Result<Encoded, Failure>>),
}

/// Number of frames of a size that may be in flight on so many threads, as far as there is memory for them and for the next one.
pub(super) fn most_in_flight(
    [width, height]: [u32; 2],
    threads: usize,
    has_room: impl Fn(u64) -> bool,
) -> usize {
    let pixels = (u64::from(width) * u64::from(height)).max(1);
    let most = threads.min((MAX_PIXELS / pixels).min(MAX_FRAMES) as usize).max(1);
    (2..=most).rev().find(|&frames| has_room(frames as u64 + 1)).unwrap_or(1)
}

/// Starts to finish a frame on another thread, or finishes it here if none can start.
pub(super) fn take_off<'scope, F>(
    scope: &'scope Scope<'scope, '_>,
    frame: PendingFrame,
    encode: F,
) -> Flying<'scope>
where
    F: Fn(PendingFrame) -> Result<Encoded, Failure> + Clone + Send + 'scope,
{
    // A thread that cannot start must not take the frame with it.
    let frame = Arc::new(Mutex::new(Some(frame)));
    let (there, taken) = (encode.clone(), Arc::clone(&frame));
    let body = move || finish(&taken, &there);
    match thread::Builder::new().name("encoder".to_owned()).spawn_scoped(scope, body) {
        Ok(thread) => Flying::There(thread),
        Err(_) => Flying::Here(Box::new(finish(&frame, &encode))),
    }
}

impl Flying<'_> {
    /// Waits for the frame.
    pub(super) fn land(self) -> Result<Encoded, Failure> {
        match self {
            Flying::There(thread) => thread.join().unwrap_or_else(|_| Err(ended())),
            Flying::Here(encoded) => *encoded,
        }
    }
}

fn finish(
    frame: &Mutex<Option<PendingFrame>>,
    encode: &impl Fn(PendingFrame) -> Result<Encoded, Failure>,
) -> Result<Encoded, Failure> {
    let frame = frame.lock().unwrap_or_else(PoisonError::into_inner).take();
    encode(frame.ok_or_else(ended)?)
}

fn ended() -> Failure {
    Failure::new(OTHER, "a thread that encodes frames has ended".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_in_flight_are_limited_by_threads_size_and_memory() {
        let most = |size, threads| most_in_flight(size, threads, |_| true);
        assert_eq!(most([1920, 1080], 16), 8);
        assert_eq!(most([1920, 1080], 2), 2);
        assert_eq!(most([3840, 2160], 16), 2);
        assert_eq!(most([16384, 16384], 16), 1);
        assert_eq!(most([64, 36], 0), 1);
        assert_eq!(most_in_flight([1920, 1080], 16, |frames| frames < 5), 3);
        assert_eq!(most_in_flight([1920, 1080], 16, |_| false), 1);
    }
}
