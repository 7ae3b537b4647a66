//! The process that tries mutants: reads which on its input and writes the outcome of each on its output.
//!
//! Before each step it says how long that may take; the pool ends a worker that takes longer.

use std::collections::{BTreeSet, HashMap};
use std::io::{BufRead as _, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use downpour_gpu::{Gpu, GpuError};
use downpour_shaders::compose;

use super::bundle::bundle;
use super::population::{Mutant, population};
use crate::function::{Run, Twin};
use crate::relay::Relay;
use crate::signature::{WordKind, parse};
use crate::{FunctionCase, KernelCase, cases, reach};

/// Number of calls of a function at first; mutants that nothing sees get all calls of their case.
const FEW_CALLS: u32 = 1024;

/// Time allowed for a step that no mutant is in.
const WITHOUT: Duration = Duration::from_secs(600);

/// Time allowed for a mutant above twenty times what the right shader takes.
const WITH: Duration = Duration::from_secs(40);

/// A case to try: a function's, with so many calls, or a kernel's.
#[derive(Clone, Copy)]
enum Step {
    Function(usize, u32),
    Kernel(usize),
}

/// Outcome of a mutant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A case is no longer within its tolerance, or fails in another way. Its name.
    Seen(String),
    /// Naga refuses the text.
    Refused,
    /// Every case that reaches the function passes.
    Survived,
    /// None sees it, but this one fails without any mutant, as where there is not enough memory.
    Unjudged(&'static str),
}

/// The cases, and what of them stays the same from mutant to mutant.
pub struct Bench {
    relay: Relay,
    gpu: Gpu,
    functions: Vec<FunctionBench>,
    kernels: Vec<KernelBench>,
}

struct FunctionBench {
    case: FunctionCase,
    reaches: BTreeSet<String>,
    /// Shader and twin that are ready to run, by the number of calls; `None` where the case fails as it is.
    ready: HashMap<u32, Option<Ready>>,
}

/// Shader and twin of a case, and how long the shader took.
struct Ready {
    text: String,
    kinds: Vec<WordKind>,
    twin: Twin,
    took: Duration,
}

struct KernelBench {
    case: KernelCase,
    reaches: BTreeSet<String>,
    /// Time that the case takes; the inner `None`: it fails as it is.
    took: Option<Option<Duration>>,
}

/// Largest number of kernel-level cases that a mutant is shown to, where its function has a case of its own; where it has none, it
/// is shown to all. The first of each kernel come first.
const MAX_KERNEL_CASES: usize = 2;

/// Largest number of function-level cases that a mutant is shown to, its own first.
const MAX_FUNCTION_CASES: usize = 12;

impl Bench {
    /// All cases before a device.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let (relay, gpu) = Relay::before(gpu);
        let functions = cases::functions().into_iter().map(|case| FunctionBench {
            reaches: reach::from_function(&parse(&compose(&[case.module])), case.function),
            case,
            ready: HashMap::new(),
        });
        let mut kernels: Vec<KernelBench> = cases::kernels()
            .into_iter()
            .map(|case| KernelBench { reaches: case.reaches(), case, took: None })
            .collect();
        // What calls least is compiled fastest.
        kernels.sort_by_key(|bench| bench.reaches.len());
        let mut functions: Vec<FunctionBench> = functions.collect();
        functions.sort_by_key(|bench| bench.reaches.len());
        Self { relay, gpu, functions, kernels }
    }

    /// Shows mutants of one function to the cases that reach it, each until one sees it. `allow` is told how long each step
    /// may take and of which mutant it is (by its index), `tell` what became of each.
    pub fn judge(
        &mut self,
        mutants: &[&Mutant],
        allow: &mut dyn FnMut(Duration, Option<usize>),
        tell: &mut dyn FnMut(usize, Outcome),
    ) {
        let (valid, refused): (Vec<usize>, Vec<usize>) =
            (0..mutants.len()).partition(|&k| mutants[k].refused().is_none());
        refused.into_iter().for_each(|k| tell(k, Outcome::Refused));
        let Some(&first) = valid.first() else { return };
        let chosen: Vec<&Mutant> = valid.iter().map(|&k| mutants[k]).collect();
        let Some(swap) = bundle(&chosen).or_else(|| (chosen.len() == 1).then(|| chosen[0].swap.clone()))
        else {
            // Entry points: one by one.
            for k in valid {
                self.judge(&[mutants[k]], &mut |time, of| allow(time, of.map(|_| k)), &mut |_, what| {
                    tell(k, what);
                });
            }
            return;
        };
        let name = mutants[first].swap.function.clone();
        let mut left: Vec<(u32, usize)> = (1..).zip(valid).collect();
        let mut failing = None;
        for step in self.steps(&name) {
            if left.is_empty() {
                break;
            }
            if !self.is_ready(step, &mut |time| allow(time, None)) {
                // With few calls it may be by chance; all of them come later.
                if self.is_whole(step) {
                    failing = Some(self.name(step));
                }
                continue;
            }
            self.relay.swap(Some(swap.clone()));
            left.retain(|&(number, k)| {
                self.relay.choose(number);
                let seen = self.sees(step, &mut |time| allow(time, Some(k)));
                if seen {
                    tell(k, Outcome::Seen(self.name(step).to_owned()));
                }
                !seen
            });
            self.relay.swap(None);
        }
        left.into_iter().for_each(|(_, k)| tell(k, failing.map_or(Outcome::Survived, Outcome::Unjudged)));
    }

    /// The cases that reach a function, in the order in which they are tried.
    fn steps(&self, name: &str) -> Vec<Step> {
        let reaching = (0..self.functions.len()).filter(|&at| self.functions[at].reaches.contains(name));
        let mut functions: Vec<usize> = reaching.collect();
        functions.sort_by_key(|&at| self.functions[at].case.function != name);
        let own = functions.iter().copied().filter(|&at| self.functions[at].case.function == name);
        let few = functions.iter().take(MAX_FUNCTION_CASES).map(|&at| Step::Function(at, FEW_CALLS));
        let all = own.map(|at| Step::Function(at, self.functions[at].case.calls));
        few.chain(all).chain(self.kernels_for(name).into_iter().map(Step::Kernel)).collect()
    }

    /// The names of the cases that reach a function, in the order in which they are tried.
    #[must_use]
    pub fn cases(&self, function: &str) -> Vec<&'static str> {
        self.steps(function).into_iter().map(|step| self.name(step)).collect()
    }

    /// True if the step is all of its case.
    fn is_whole(&self, step: Step) -> bool {
        match step {
            Step::Function(at, calls) => calls >= self.functions[at].case.calls,
            Step::Kernel(_) => true,
        }
    }

    fn name(&self, step: Step) -> &'static str {
        match step {
            Step::Function(at, _) => self.functions[at].case.function,
            Step::Kernel(at) => self.kernels[at].case.name,
        }
    }

    /// Runs a case as it is, at its first use; whether it passes.
    fn is_ready(&mut self, step: Step, allow: &mut dyn FnMut(Duration)) -> bool {
        match step {
            Step::Function(at, calls) => {
                let bench = &mut self.functions[at];
                let case = FunctionCase { calls: bench.case.calls.min(calls), ..bench.case.clone() };
                let ready = bench.ready.entry(case.calls).or_insert_with(|| {
                    allow(WITHOUT);
                    let twin = case.twin();
                    let (text, kinds) = case.shader(&compose(&[case.module]), twin.arguments[0].len());
                    let start = Instant::now();
                    let run = quietly(|| case.run_shader(&self.gpu, &text, kinds.clone(), twin.clone()));
                    // With few calls a fraction of outliers may be over its limit by chance.
                    let passes = run.is_some_and(|run| run.compare(&case.tol).failure.is_none());
                    passes.then(|| Ready { text, kinds, twin, took: start.elapsed() })
                });
                ready.is_some()
            }
            Step::Kernel(at) => {
                let bench = &mut self.kernels[at];
                let took = bench.took.get_or_insert_with(|| {
                    allow(WITHOUT);
                    let start = Instant::now();
                    let run = quietly(|| (bench.case.run)(&self.gpu));
                    let passes = run.is_some_and(|run| run.compare(&bench.case.tol).failure.is_none());
                    passes.then(|| start.elapsed())
                });
                took.is_some()
            }
        }
    }

    /// True if a case fails with what the relay has been told.
    fn sees(&self, step: Step, allow: &mut dyn FnMut(Duration)) -> bool {
        let (run, tol) = match step {
            Step::Function(at, calls) => {
                let bench = &self.functions[at];
                let case = FunctionCase { calls: bench.case.calls.min(calls), ..bench.case.clone() };
                let Some(Some(Ready { text, kinds, twin, took })) = bench.ready.get(&case.calls) else {
                    return false;
                };
                allow(*took * 20 + WITH);
                (quietly(|| case.run_shader(&self.gpu, text, kinds.clone(), twin.clone())), case.tol)
            }
            Step::Kernel(at) => {
                let bench = &self.kernels[at];
                allow(bench.took.flatten().unwrap_or_default() * 20 + WITH);
                (quietly(|| (bench.case.run)(&self.gpu)), bench.case.tol)
            }
        };
        // A twin that asserts, an error of the device: what a test would show as well.
        run.is_none_or(|run| run.compare(&tol).failure.is_some())
    }

    /// The kernel-level cases that reach a function, in the order in which they are tried.
    fn kernels_for(&self, name: &str) -> Vec<usize> {
        let mut ranks: HashMap<&str, usize> = HashMap::new();
        let mut order: Vec<(usize, usize)> = Vec::new();
        for (at, bench) in self.kernels.iter().enumerate() {
            if bench.reaches.contains(name) {
                let rank = ranks.entry(bench.case.entry()).or_default();
                order.push((*rank, at));
                *rank += 1;
            }
        }
        order.sort_unstable();
        let has_own = self.functions.iter().any(|bench| bench.case.function == name);
        order
            .into_iter()
            .take(if has_own { MAX_KERNEL_CASES } else { usize::MAX })
            .map(|(_, at)| at)
            .collect()
    }
}

/// Result of a run; `None` if it ends in an error or a panic.
fn quietly(run: impl FnOnce() -> Result<Run, GpuError>) -> Option<Run> {
    catch_unwind(AssertUnwindSafe(run)).ok().and_then(Result::ok)
}

/// Tries mutants until the input ends. A line of it has the numbers of mutants of one function. Lines of the output:
/// `allow SECONDS`, with a mutant's number if the step is its own; then, for each, `NUMBER seen CASE`, `NUMBER refused`,
/// `NUMBER survived` or `NUMBER unjudged: ...`.
pub fn work(gpu: &Gpu) {
    crate::kept::keep();
    // Twins of many small loops wait for their helpers at each: this thread is one of them.
    // It fails only where somebody has made the pool before, which serves as well.
    let _ = rayon::ThreadPoolBuilder::new().use_current_thread().build_global();
    std::panic::set_hook(Box::new(|_| {}));
    let all = population();
    let mut bench = Bench::new(gpu);
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        let numbers: Vec<usize> =
            line.split(' ').filter_map(|n| n.parse().ok()).filter(|&n| n < all.len()).collect();
        let mutants: Vec<&Mutant> = numbers.iter().map(|&n| &all[n]).collect();
        bench.judge(
            &mutants,
            &mut |time, of| {
                let of = of.map(|k| format!(" {}", numbers[k])).unwrap_or_default();
                say(&format!("allow {}{of}", time.as_secs_f64()));
            },
            &mut |k, outcome| match outcome {
                Outcome::Seen(case) => say(&format!("{} seen {case}", numbers[k])),
                Outcome::Refused => say(&format!("{} refused", numbers[k])),
                Outcome::Survived => say(&format!("{} survived", numbers[k])),
                Outcome::Unjudged(case) => {
                    say(&format!("{} unjudged: {case} fails as it is", numbers[k]));
                }
            },
        );
    }
}

fn say(line: &str) {
    let mut out = std::io::stdout().lock();
    // A pool that is gone is noticed when the input ends.
    let _ = writeln!(out, "{line}").and_then(|()| out.flush());
}
