//! Progress on a terminal.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Duration of work after which progress is shown.
const PATIENCE: Duration = Duration::from_secs(1);

/// Does work whose parts are not counted. Work that takes longer than a second is named on a terminal, with the time that it
/// has taken.
pub(crate) fn doing<T>(what: &str, quiet: bool, work: impl FnOnce() -> T) -> T {
    let doing = Doing::new(what, quiet);
    let done = work();
    drop(doing);
    done
}

/// Progress of frames that need more than a second.
pub(crate) struct FrameProgress {
    quiet: bool,
    begin: Instant,
    counted: Option<Progress>,
    uncounted: Option<Doing>,
}

impl FrameProgress {
    pub(crate) fn new(quiet: bool) -> Self {
        Self { quiet, begin: Instant::now(), counted: None, uncounted: None }
    }

    pub(crate) fn tell(&mut self, progress: downpour::Progress) {
        let downpour::Progress { what, parts: [done, all] } = progress;
        if self.counted.as_ref().is_some_and(|counted| counted.what != what) {
            self.counted = None;
        }
        if all == 0 {
            self.uncounted = Doing::new(what, self.quiet);
            return;
        }
        self.uncounted = None;
        if self.counted.is_some() || self.begin.elapsed() > PATIENCE {
            self.counted.get_or_insert_with(|| Progress::new(what, all, self.quiet)).set(done);
        }
    }
}

/// Work without countable parts, named on a terminal once it takes long. Dropped at the end of the work.
struct Doing {
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Doing {
    /// `None` without a terminal, or if there is no memory for a thread.
    fn new(what: &str, quiet: bool) -> Option<Self> {
        if !is_shown(quiet) {
            return None;
        }
        let what = what.to_owned();
        let (end, ended) = channel::<()>();
        let tell = move || {
            let begin = Instant::now();
            let mut shown = false;
            while ended.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                write_over(&format!("{what}, {} s", begin.elapsed().as_secs()));
                shown = true;
            }
            if shown {
                write_over("");
            }
        };
        let thread = thread::Builder::new().name("progress".to_owned()).spawn(tell).ok()?;
        Some(Self { end: Some(end), thread: Some(thread) })
    }
}

impl Drop for Doing {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            // It only writes.
            let _ = thread.join();
        }
    }
}

/// True if standard error is a terminal and progress is enabled.
fn is_shown(quiet: bool) -> bool {
    !quiet && io::stderr().is_terminal()
}

/// Overwrites the last line. The cursor returns to its start, so that a message replaces it.
fn write_over(text: &str) {
    let _ = write!(io::stderr().lock(), "\r\x1b[K{text}\r");
}

/// A line on standard error that is overwritten: frames done, time for each, time left. Not shown if
/// standard error is not a terminal.
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

    /// Sets the number of finished parts.
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
