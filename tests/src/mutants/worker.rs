//! The process that tries mutants: it is told which on its input and says on its output what became of each.
//!
//! Before each step it says how long that may take; the pool ends a worker that takes longer.

use std::collections::{BTreeSet, HashMap};
use std::io::{BufRead as _, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use downpour_gpu::{Gpu, GpuError};
use downpour_shaders::compose;

use super::population::{Mutant, population};
use crate::compare::compare;
use crate::function::{Run, Twin};
use crate::relay::Relay;
use crate::signature::{WordKind, parse};
use crate::{FunctionCase, KernelCase, cases, reach};

/// How many calls of a function are made at first; those that nothing sees get all calls of their case.
const FEW_CALLS: u32 = 1024;

/// How long a step may take that no mutant is in.
const WITHOUT: Duration = Duration::from_secs(600);

/// How long a mutant may take above twenty times what the right shader takes.
const WITH: Duration = Duration::from_secs(15);

/// What became of a mutant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A case is no longer within its tolerance, or fails in another way. Its name.
    Seen(String),
    /// Naga refuses the text.
    Refused,
    /// Every case that reaches the function passes.
    Survived,
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
    /// What is ready to run, by the number of calls; `None` where the case fails as it is.
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
    /// How long the case takes; the inner `None`: it fails as it is.
    took: Option<Option<Duration>>,
}

/// How many kernel-level cases a mutant is shown to. The first of each kernel come first.
const MOST_KERNEL_CASES: usize = 16;

/// How many function-level cases a mutant is shown to, its own first.
const MOST_FUNCTION_CASES: usize = 12;

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

    /// Runs the cases that reach the mutant's function, until one sees it. `allow` is told how long each step may take.
    pub fn judge(&mut self, mutant: &Mutant, allow: &mut dyn FnMut(Duration, bool)) -> Outcome {
        if mutant.refused().is_some() {
            return Outcome::Refused;
        }
        let name = &mutant.swap.function;
        let mut order: Vec<usize> =
            (0..self.functions.len()).filter(|&at| self.functions[at].reaches.contains(name)).collect();
        order.sort_by_key(|&at| self.functions[at].case.function != name);
        for &at in order.iter().take(MOST_FUNCTION_CASES) {
            if self.function_sees(at, FEW_CALLS, mutant, allow) {
                return Outcome::Seen(self.functions[at].case.function.to_owned());
            }
        }
        for at in self.kernels_for(name) {
            if self.kernel_sees(at, mutant, allow) {
                return Outcome::Seen(self.kernels[at].case.name.to_owned());
            }
        }
        for &at in &order {
            let calls = self.functions[at].case.calls;
            if self.functions[at].case.function == name && self.function_sees(at, calls, mutant, allow) {
                return Outcome::Seen(self.functions[at].case.function.to_owned());
            }
        }
        Outcome::Survived
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
        order.into_iter().take(MOST_KERNEL_CASES).map(|(_, at)| at).collect()
    }

    fn function_sees(
        &mut self,
        at: usize,
        calls: u32,
        mutant: &Mutant,
        allow: &mut dyn FnMut(Duration, bool),
    ) -> bool {
        let bench = &mut self.functions[at];
        let mut case = bench.case.clone();
        case.calls = case.calls.min(calls);
        let ready = bench.ready.entry(case.calls).or_insert_with(|| {
            allow(WITHOUT, false);
            let twin = case.twin();
            let (text, kinds) = case.shader(&compose(&[case.module]), twin.arguments[0].len());
            let start = Instant::now();
            let run = case.run_shader(&self.gpu, &text, kinds.clone(), twin.clone());
            let passes = run.is_ok_and(|run| run.compare(&case.tol).failure.is_none());
            passes.then(|| Ready { text, kinds, twin, took: start.elapsed() })
        });
        // With few calls a share of outliers may be over its limit by chance.
        let Some(Ready { text, kinds, twin, took }) = ready else { return false };
        allow(*took * 20 + WITH, true);
        let run = || case.run_shader(&self.gpu, text, kinds.clone(), twin.clone());
        sees(&self.relay, mutant, run, &case.tol)
    }

    fn kernel_sees(&mut self, at: usize, mutant: &Mutant, allow: &mut dyn FnMut(Duration, bool)) -> bool {
        let bench = &mut self.kernels[at];
        let took = *bench.took.get_or_insert_with(|| {
            allow(WITHOUT, false);
            let start = Instant::now();
            let run = (bench.case.run)(&self.gpu);
            run.is_ok_and(|run| run.compare(&bench.case.tol).failure.is_none()).then(|| start.elapsed())
        });
        let Some(took) = took else { return false };
        allow(took * 20 + WITH, true);
        sees(&self.relay, mutant, || (bench.case.run)(&self.gpu), &bench.case.tol)
    }
}

/// Whether a run with the mutant in the place of its function fails.
fn sees(
    relay: &Relay,
    mutant: &Mutant,
    run: impl FnOnce() -> Result<Run, GpuError>,
    tol: &crate::Tol,
) -> bool {
    relay.swap(Some(mutant.swap.clone()));
    let run = catch_unwind(AssertUnwindSafe(run));
    relay.swap(None);
    match run {
        Ok(Ok(run)) => compare(&run.cpu, &run.gpu, &run.kinds, tol).failure.is_some(),
        // A twin that asserts, an error of the device: what a test would show as well.
        _ => true,
    }
}

/// Tries mutants until the input ends. Lines of the output: `allow SECONDS with|without`, then `seen CASE`, `refused` or
/// `survived`.
pub fn work(gpu: &Gpu) {
    crate::kept::keep();
    std::panic::set_hook(Box::new(|_| {}));
    let all = population();
    let mut bench = Bench::new(gpu);
    let mut allow = |time: Duration, mutated: bool| {
        say(&format!("allow {} {}", time.as_secs_f64(), if mutated { "with" } else { "without" }));
    };
    for line in std::io::stdin().lock().lines() {
        let Ok(Some(mutant)) = line.map(|line| line.parse().ok().and_then(|at: usize| all.get(at))) else {
            break;
        };
        match bench.judge(mutant, &mut allow) {
            Outcome::Seen(case) => say(&format!("seen {case}")),
            Outcome::Refused => say("refused"),
            Outcome::Survived => say("survived"),
        }
    }
}

fn say(line: &str) {
    let mut out = std::io::stdout().lock();
    // A pool that is gone is noticed when the input ends.
    let _ = writeln!(out, "{line}").and_then(|()| out.flush());
}
