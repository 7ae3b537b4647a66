//! Workers as processes: each receives one mutant after the other, and is killed when it takes too long.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Outcome of a mutant, and the time it took.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The mutant's number in the population.
    pub mutant: usize,
    /// The worker's word: `seen CASE`, `refused`, `survived`; `unjudged: ...` if none sees it and a case fails without any mutant; or
    /// `seen by a hang`, `seen by a crash`; or `failed ...` if a case hangs without any mutant.
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
            // As many threads in all as there are cores, of twins and of software drivers.
            .env("RAYON_NUM_THREADS", &threads)
            .env("LP_NUM_THREADS", &threads)
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

    /// Asks about mutants of one function and gives each answer to `tell`. `Err`: the worker is gone; the mutant that it was
    /// busy with, if any, and what its end says.
    fn ask(
        &mut self,
        mutants: &[usize],
        tell: &mut dyn FnMut(usize, &str),
    ) -> Result<(), (Option<usize>, &'static str)> {
        let line: Vec<String> = mutants.iter().map(ToString::to_string).collect();
        if writeln!(self.input, "{}", line.join(" ")).and_then(|()| self.input.flush()).is_err() {
            return Err((None, "failed: a worker ended"));
        }
        // Until it says more: time to open its device.
        let (mut patience, mut busy) = (Duration::from_secs(600), None);
        let mut left = mutants.len();
        while left > 0 {
            match self.lines.recv_timeout(patience) {
                Ok(line) => match line.strip_prefix("allow ") {
                    Some(rest) => {
                        let mut words = rest.split(' ');
                        let seconds = words.next().and_then(|word| word.parse().ok());
                        patience = Duration::from_secs_f64(seconds.unwrap_or(600.0));
                        busy = words.next().and_then(|word| word.parse().ok());
                    }
                    None => {
                        let (number, word) = line.split_once(' ').unwrap_or((&line, ""));
                        if let Ok(number) = number.parse() {
                            tell(number, word);
                            left -= 1;
                        }
                    }
                },
                Err(RecvTimeoutError::Timeout) if busy.is_some() => return Err((busy, "seen by a hang")),
                Err(RecvTimeoutError::Timeout) => return Err((None, "failed: a case hangs")),
                Err(RecvTimeoutError::Disconnected) if busy.is_some() => {
                    return Err((busy, "seen by a crash"));
                }
                Err(RecvTimeoutError::Disconnected) => return Err((None, "failed: a worker ended")),
            }
        }
        Ok(())
    }

    fn end(mut self) {
        // It may be gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Tries batches of mutants, each of one function, with `jobs` workers of `program`. `tell` gets each verdict.
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
            let mut left = batch;
            while !left.is_empty() {
                let mut asked = match worker.take() {
                    Some(worker) => worker,
                    None => Worker::start(program, jobs)?,
                };
                let mut start = Instant::now();
                let mut answered = Vec::new();
                let ended = asked.ask(&left, &mut |mutant, word| {
                    answered.push(mutant);
                    tell(Verdict { mutant, word: word.to_owned(), took: start.elapsed() });
                    start = Instant::now();
                });
                left.retain(|mutant| !answered.contains(mutant));
                match ended {
                    Ok(()) => worker = Some(asked),
                    Err((busy, word)) => {
                        asked.end();
                        // Without a mutant to blame, the whole batch is given up.
                        let blamed = busy.map_or_else(|| left.clone(), |mutant| vec![mutant]);
                        left.retain(|mutant| !blamed.contains(mutant));
                        for mutant in blamed {
                            tell(Verdict { mutant, word: word.to_owned(), took: start.elapsed() });
                        }
                    }
                }
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
