//! Work that goes on beside its caller until the result is asked for.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::sync::{Mutex, PoisonError};
use std::thread;

use rayon::Yield;

/// Work on a thread of rayon's pool. If nobody asks for its result, it ends without one.
#[derive(Debug)]
pub(crate) struct Background<T> {
    result: Mutex<Receiver<thread::Result<T>>>,
}

impl<T: Send + 'static> Background<T> {
    /// Begins some work.
    pub(crate) fn begin(work: impl FnOnce() -> T + Send + 'static) -> Self {
        let (sender, result) = mpsc::channel();
        rayon::spawn(move || {
            let made = catch_unwind(AssertUnwindSafe(work));
            // Whoever began it may have gone.
            let _ = sender.send(made);
        });
        Self { result: Mutex::new(result) }
    }

    /// Waits for the result; a panic of the work goes on here.
    pub(crate) fn finish(self) -> T {
        let result = self.result.into_inner().unwrap_or_else(PoisonError::into_inner);
        loop {
            match result.try_recv() {
                Ok(made) => return made.unwrap_or_else(|panic| resume_unwind(panic)),
                // A thread of the pool works on other things meanwhile: perhaps on this.
                Err(TryRecvError::Empty) => match rayon::yield_now() {
                    Some(Yield::Executed) => {}
                    _ => thread::yield_now(),
                },
                Err(TryRecvError::Disconnected) => unreachable!("the work tells its result"),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_arrive_on_threads_of_the_pool_and_beside_it() {
        let sum = || {
            let parts: Vec<_> = (0..20u32).map(|k| Background::begin(move || k * k)).collect();
            parts.into_iter().map(Background::finish).sum::<u32>()
        };
        assert_eq!(sum(), 2470);
        // One thread, which waits for what it has to do itself.
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
        assert_eq!(alone.install(sum), 2470);
    }

    #[test]
    fn a_panic_is_told_to_who_asks() {
        let work = Background::begin(|| -> u32 { panic!("no result") });
        let panic = catch_unwind(AssertUnwindSafe(|| work.finish())).expect_err("a panic");
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"no result"));
    }
}
