//! How far the work is, for who sits before a terminal.

use std::io::{self, IsTerminal as _, Write as _};
use std::time::Instant;

/// A line on standard error that is written over and over: frames done, time for each, time left. Nothing where
/// standard error is no terminal.
pub(super) struct Progress {
    what: &'static str,
    total: u32,
    done: u32,
    begin: Instant,
    shown: bool,
}

impl Progress {
    pub(super) fn new(what: &'static str, total: u32, quiet: bool) -> Self {
        let shown = !quiet && io::stderr().is_terminal();
        let progress = Self { what, total, done: 0, begin: Instant::now(), shown };
        progress.show();
        progress
    }

    /// One more is done.
    pub(super) fn step(&mut self) {
        self.done += 1;
        self.show();
    }

    /// So many are done.
    pub(super) fn set(&mut self, done: u32) {
        self.done = done;
        self.show();
    }

    fn show(&self) {
        if self.shown {
            let text = line(self.what, self.done, self.total, self.begin.elapsed().as_secs_f64());
            // The cursor goes back to the beginning, so that a message takes the place of the line.
            let _ = write!(io::stderr().lock(), "\r\x1b[K{text}\r");
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.shown {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
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
