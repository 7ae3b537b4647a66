//! How far the work is, for who sits before a terminal.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// How long work may take before somebody wants to know what it is.
pub(crate) const PATIENCE: Duration = Duration::from_secs(1);

/// Does work whose parts are not counted. Work that takes longer than a second is named on a terminal, with the time that it
/// has taken.
pub(crate) fn doing<T>(what: &str, quiet: bool, work: impl FnOnce() -> T) -> T {
    if !is_shown(quiet) {
        return work();
    }
    thread::scope(|scope| {
        let (end, ended) = channel::<()>();
        // Without memory for a thread the work goes on in silence.
        let _ = thread::Builder::new().name("progress".to_owned()).spawn_scoped(scope, move || {
            let begin = Instant::now();
            let mut shown = false;
            while ended.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                write_over(&format!("{what}, {} s", begin.elapsed().as_secs()));
                shown = true;
            }
            if shown {
                write_over("");
            }
        });
        let done = work();
        drop(end);
        done
    })
}

/// Whether somebody sits before a terminal and wants to be told.
fn is_shown(quiet: bool) -> bool {
    !quiet && io::stderr().is_terminal()
}

/// Writes a line in place of the last. The cursor goes back to the beginning, so that a message takes the line's place.
fn write_over(text: &str) {
    let _ = write!(io::stderr().lock(), "\r\x1b[K{text}\r");
}

/// A line on standard error that is written over and over: frames done, time for each, time left. Nothing where
/// standard error is no terminal.
pub(crate) struct Progress {
    what: &'static str,
    total: u32,
    done: u32,
    begin: Instant,
    shown: bool,
}

impl Progress {
    pub(crate) fn new(what: &'static str, total: u32, quiet: bool) -> Self {
        let progress = Self { what, total, done: 0, begin: Instant::now(), shown: is_shown(quiet) };
        progress.show();
        progress
    }

    /// One more is done.
    pub(crate) fn step(&mut self) {
        self.done += 1;
        self.show();
    }

    /// So many are done.
    pub(crate) fn set(&mut self, done: u32) {
        self.done = done;
        self.show();
    }

    fn show(&self) {
        if self.shown {
            write_over(&line(self.what, self.done, self.total, self.begin.elapsed().as_secs_f64()));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.shown {
            write_over("");
        }
    }
}

fn line(what: &str, done: u32, total: u32, seconds: f64) -> String {
    if done == 0 {
        return format!("{what} 0/{total}");
    }
    let each = seconds / f64::from(done);
    let left = (each * f64::from(total.saturating_sub(done))).ceil();
    let (minutes, seconds) = ((left / 60.0).floor(), left % 60.0);
    format!("{what} {done}/{total}, {each:.2} s each, {minutes:.0}:{seconds:02.0} left")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_says_how_long_it_will_take() {
        assert_eq!(line("frame", 0, 24, 0.5), "frame 0/24");
        assert_eq!(line("frame", 6, 24, 30.0), "frame 6/24, 5.00 s each, 1:30 left");
        assert_eq!(line("frame", 24, 24, 30.0), "frame 24/24, 1.25 s each, 0:00 left");
    }
}
