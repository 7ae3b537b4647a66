//! Handler of SIGINT and SIGTERM: removes the unfinished file and ends the process with code 6, at once.
//!
//! A thread waits for the signals, so that no work needs to poll. On systems without such signals, a process
//! that is killed leaves its temporary file; the next one removes it
//! ([`crate::output`]).

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::failure::Failure;

/// The temporary file that must not survive.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interrupt {
    unfinished: Arc<Mutex<Option<PathBuf>>>,
}

impl Interrupt {
    /// Listens for signals from here on.
    ///
    /// # Errors
    /// If the system rejects the handler.
    pub(crate) fn install() -> Result<Self, Failure> {
        let interrupt = Self::default();
        #[cfg(unix)]
        unix::listen(interrupt.clone()).map_err(|error| {
            Failure::new(crate::failure::OTHER, format!("signals cannot be caught: {error}"))
        })?;
        Ok(interrupt)
    }

    /// The temporary file. While it is held, a signal waits: a file is made or renamed under it.
    pub(crate) fn unfinished(&self) -> MutexGuard<'_, Option<PathBuf>> {
        self.unfinished.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ends the process without destructors and without an unfinished file. For a GPU that hangs: dropping its
    /// device would wait for it.
    pub(crate) fn leave(&self, code: u8) -> ! {
        if let Some(path) = self.unfinished().take() {
            let _ = std::fs::remove_file(path);
        }
        // Not `exit`: it runs exit handlers of the drivers while their threads still work.
        #[cfg(unix)]
        signal_hook::low_level::exit(code.into());
        #[cfg(not(unix))]
        std::process::exit(code.into());
    }
}

#[cfg(unix)]
mod unix {
    use std::io;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    use signal_hook::consts::{SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;

    use super::Interrupt;
    use crate::exit_code::CANCELED;
    use crate::stream;

    pub(super) fn listen(interrupt: Interrupt) -> io::Result<()> {
        // A file above the process's limit is an error of its write, not the end of the process.
        signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
        let mut signals = Signals::new([SIGINT, SIGTERM])?;
        std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
            if signals.forever().next().is_some() {
                stream::message("canceled");
                interrupt.leave(CANCELED);
            }
        })?;
        Ok(())
    }
}
