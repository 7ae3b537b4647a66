//! Workers as processes: each is told one mutant after the other, and ended when it takes too long.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What became of a mutant, and how long it took.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The mutant's number in the population.
    pub mutant: usize,
    /// The worker's word: `seen CASE`, `refused`, `survived`; or `seen by a hang`, `seen by a crash`; or `failed ...` if a
    /// case fails without any mutant.
    pub word: String,
    /// From the question to the answer.
    pub took: Duration,
}

struct Worker {
    child: Child,
    input: ChildStdin,
    lines: Receiver<String>,
}

impl Worker {
    /// Starts a worker, one of `jobs`.
    fn start(program: &Path, jobs: usize) -> std::io::Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = (cores / jobs).max(1).to_string();
        let mut child = Command::new(program)
            .arg("--worker")
            // As many threads in all as there are cores, of twins and of software drivers; no cache of shaders that come once.
            .env("RAYON_NUM_THREADS", &threads)
            .env("LP_NUM_THREADS", &threads)
            .env("MESA_SHADER_CACHE_DISABLE", "true")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let (sender, lines) = mpsc::channel();
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(std::io::Error::other("a worker without pipes"));
        };
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Self { child, input, lines })
    }

    /// Asks about a mutant. `Err`: the worker is gone, and what that says.
    fn ask(&mut self, mutant: usize) -> Result<String, String> {
        let gone = |mutated: bool| {
            if mutated { "seen by a crash".to_owned() } else { "failed: a worker ended".to_owned() }
        };
        if writeln!(self.input, "{mutant}").and_then(|()| self.input.flush()).is_err() {
            return Err(gone(false));
        }
        // Until it says more: time to open its device.
        let (mut patience, mut mutated) = (Duration::from_secs(600), false);
        loop {
            match self.lines.recv_timeout(patience) {
                Ok(line) => match line.strip_prefix("allow ") {
                    Some(rest) => {
                        let (seconds, how) = rest.split_once(' ').unwrap_or((rest, "without"));
                        patience = Duration::from_secs_f64(seconds.parse().unwrap_or(600.0));
                        mutated = how == "with";
                    }
                    None => return Ok(line),
                },
                Err(RecvTimeoutError::Timeout) if mutated => return Err("seen by a hang".to_owned()),
                Err(RecvTimeoutError::Timeout) => return Err("failed: a case hangs".to_owned()),
                Err(RecvTimeoutError::Disconnected) => return Err(gone(mutated)),
            }
        }
    }

    fn end(mut self) {
        // It may be gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Tries batches of mutants with `jobs` workers of `program`. `tell` gets each verdict.
///
/// # Errors
/// If a worker cannot be started.
pub fn run(
    program: &Path,
    jobs: usize,
    batches: Vec<Vec<usize>>,
    tell: impl Fn(Verdict) + Sync,
) -> std::io::Result<()> {
    let queue = Mutex::new(batches.into_iter());
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let one = || -> std::io::Result<()> {
        let mut worker: Option<Worker> = None;
        while let Some(batch) = next() {
            for mutant in batch {
                let mut asked = match worker.take() {
                    Some(worker) => worker,
                    None => Worker::start(program, jobs)?,
                };
                let start = Instant::now();
                let word = match asked.ask(mutant) {
                    Ok(word) => {
                        worker = Some(asked);
                        word
                    }
                    Err(word) => {
                        asked.end();
                        word
                    }
                };
                tell(Verdict { mutant, word, took: start.elapsed() });
            }
        }
        if let Some(worker) = worker {
            worker.end();
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..jobs).map(|_| scope.spawn(one)).collect();
        threads.into_iter().try_for_each(|thread| {
            thread.join().unwrap_or_else(|_| Err(std::io::Error::other("a thread of the pool ended")))
        })
    })
}
