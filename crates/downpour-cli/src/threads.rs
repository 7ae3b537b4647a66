//! The threads that all work is dealt out to.
//!
//! Rayon starts them on first use, and panics if the system has no memory for them. Here they are
//! started one by one before anything else: with fewer than requested the work takes longer, and with none this thread does it.

use std::num::NonZeroUsize;
use std::sync::mpsc::{Sender, channel};
use std::thread;

use rayon::{ThreadBuilder, ThreadPoolBuildError, ThreadPoolBuilder};

use crate::failure::{Failure, LIMIT};

/// Requested number of threads: Rayon's variable, or one per core.
fn wanted() -> usize {
    let asked = std::env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.parse::<NonZeroUsize>().ok());
    asked.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get)
}

/// Bytes that are left for the work: a stack is only taken while there are more.
const RESERVE: usize = 64 << 20;

/// True if the system can still allocate the reserve.
fn has_room() -> bool {
    Vec::<u8>::new().try_reserve_exact(RESERVE).is_ok()
}

/// Threads that wait for their part, as many as the system can start without exhausting memory.
fn waiting(count: usize) -> Vec<Sender<ThreadBuilder>> {
    let mut ready = Vec::new();
    for number in 0..count {
        if !has_room() {
            break;
        }
        let (send, receive) = channel::<ThreadBuilder>();
        let (started, is_started) = channel();
        let body = move || {
            // The system gives a thread an arena of its own for what it allocates first: only then the room is known that is left
            // for the next one.
            drop(std::hint::black_box(vec![0u8; 64]));
            let _ = started.send(());
            if let Ok(part) = receive.recv() {
                part.run();
            }
        };
        match thread::Builder::new().name(format!("worker {number}")).spawn(body) {
            Ok(_) => {
                let _ = is_started.recv();
                ready.push(send);
            }
            Err(_) => break,
        }
    }
    ready
}

/// A pool of threads that wait; without any, of this one.
fn pool(mut ready: Vec<Sender<ThreadBuilder>>) -> Result<(), ThreadPoolBuildError> {
    if ready.is_empty() {
        return ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
    }
    ThreadPoolBuilder::new()
        .num_threads(ready.len())
        .spawn_handler(|part| {
            let gone = || std::io::Error::other("a thread has ended");
            ready.pop().ok_or_else(gone)?.send(part).map_err(|_| gone())
        })
        .build_global()
}

/// Minimum memory that a process must be allowed: below it allocations fail without an error path.
const MIN_MEMORY: u64 = 256 << 20;

/// Address space that this process may use, in bytes, if the system reports a limit.
fn allowed_bytes() -> Option<u64> {
    // The path of Linux; elsewhere such limits are rare.
    limit_in(&std::fs::read_to_string("/proc/self/limits").ok()?)
}

/// The soft limit of the address space in a table of limits.
fn limit_in(table: &str) -> Option<u64> {
    let row = table.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    row.split_whitespace().next()?.parse().ok()
}

/// Starts the threads.
///
/// # Errors
/// Exit code 3 if there is no memory for a pool, or if the process may use less than any work needs.
pub(crate) fn start() -> Result<(), Failure> {
    if let Some(allowed) = allowed_bytes().filter(|&bytes| bytes < MIN_MEMORY) {
        let found = format!("{} MiB of address space", allowed >> 20);
        return Err(Failure::new(LIMIT, format!("{found}; allowed: {} MiB or more", MIN_MEMORY >> 20)));
    }
    pool(waiting(wanted())).map_err(|error| {
        Failure::new(LIMIT, format!("no threads: {error}; allowed: memory and processes for one"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_of_a_table() {
        let table =
            |soft: &str| format!("Limit  Soft Limit\nMax address space         {soft}  unlimited  bytes\n");
        assert_eq!(limit_in(&table("67108864")), Some(64 << 20));
        assert_eq!(limit_in(&table("unlimited")), None);
        assert_eq!(limit_in("Max file size  1 1 bytes"), None);
    }
}
