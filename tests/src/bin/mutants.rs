//! `cargo xtask mutants`: tries mutants of every WGSL function on the machine's adapter.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use downpour_tests::mutants::bundle;
use downpour_tests::mutants::known::{Known, known, reason};
use downpour_tests::mutants::pool::{self, Verdict};
use downpour_tests::mutants::population::{Mutant, population, sample};
use downpour_tests::mutants::worker::{self, Bench};
use downpour_tests::{adapter, cases};

const USAGE: &str = "\
cargo xtask mutants [OPTIONS]
  --function NAME   mutants of one function
  --own             functions that have a case of their own only; these take milliseconds each
  --others          functions that have none: cases of kernels, and of what calls them, reach these
  --sample N        so many, drawn by the seed
  --seed S          of the sample (default 1)
  --list            say which, and try none
  --cases           say which cases reach their functions, in the order in which they are tried, and try none
  --jobs N          processes (default: one per core)
  --report FILE     a line per mutant; those that are in it already are left out (default target/mutants.tsv)
  --least PERCENT   fail if fewer are seen, or named in tests/mutants.txt
  --strict          fail if a mutant survives that tests/mutants.txt does not name";

#[derive(Default)]
struct Options {
    function: Option<String>,
    own: bool,
    others: bool,
    sample: Option<usize>,
    seed: u32,
    list: bool,
    cases: bool,
    jobs: usize,
    report: Option<PathBuf>,
    least: usize,
    strict: bool,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut options = Self { seed: 1, ..Self::default() };
        let mut rest = arguments.iter();
        while let Some(name) = rest.next() {
            let mut value = || rest.next().cloned().ok_or_else(|| format!("{name} wants a value\n{USAGE}"));
            let number = |text: String| text.parse().map_err(|_| format!("{name}: \"{text}\" is no number"));
            match name.as_str() {
                "--function" => options.function = Some(value()?),
                "--own" => options.own = true,
                "--others" => options.others = true,
                "--sample" => options.sample = Some(number(value()?)?),
                "--seed" => options.seed = number(value()?)? as u32,
                "--list" => options.list = true,
                "--cases" => options.cases = true,
                "--jobs" => options.jobs = number(value()?)?,
                "--report" => options.report = Some(value()?.into()),
                "--least" => options.least = number(value()?)?,
                "--strict" => options.strict = true,
                _ => return Err(format!("no option \"{name}\"\n{USAGE}")),
            }
        }
        if options.jobs == 0 {
            options.jobs = std::thread::available_parallelism().map_or(1, usize::from);
        }
        Ok(options)
    }

    /// The numbers of the mutants that were asked for.
    fn chosen(&self, all: &[Mutant]) -> Vec<usize> {
        let own: BTreeSet<&str> = cases::functions().iter().map(|case| case.function).collect();
        let fits = |mutant: &Mutant| {
            let name = mutant.swap.function.as_str();
            let its_own = own.contains(name);
            self.function.as_deref().is_none_or(|wanted| wanted == name)
                && !(self.own && !its_own || self.others && its_own)
        };
        let mut chosen: Vec<usize> = (0..all.len()).filter(|&at| fits(&all[at])).collect();
        if let Some(count) = self.sample {
            chosen = sample(all, &chosen, count, self.seed);
        }
        chosen
    }
}

/// Mutants of one function each, as many as share a text.
fn batches(all: &[Mutant], chosen: &[usize]) -> Vec<Vec<usize>> {
    let mut by_function: BTreeMap<(&str, &str), Vec<usize>> = BTreeMap::new();
    for &at in chosen {
        by_function.entry((all[at].module.path, &all[at].swap.function)).or_default().push(at);
    }
    by_function.values().flat_map(|one| one.chunks(bundle::MAX_MUTANTS).map(<[usize]>::to_vec)).collect()
}

/// The lines of a report by the mutants that they are about.
fn read(report: &Path) -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(report).unwrap_or_default();
    let split = |line: &str| line.split_once('\t').map(|(word, mutant)| (mutant.to_owned(), word.to_owned()));
    text.lines().filter_map(split).collect()
}

fn run(arguments: &[String]) -> Result<(), String> {
    let options = Options::parse(arguments)?;
    let all = population();
    let chosen = options.chosen(&all);
    if options.list {
        chosen.iter().for_each(|&at| println!("{}", all[at].describe()));
        return Ok(());
    }
    if options.cases {
        let functions: BTreeSet<&str> = chosen.iter().map(|&at| all[at].swap.function.as_str()).collect();
        let bench = Bench::new(&adapter::open().map_err(|error| adapter::missing(&error))?);
        functions.into_iter().for_each(|name| println!("{name}: {}", bench.cases(name).join("; ")));
        return Ok(());
    }
    let report = options.report.unwrap_or_else(|| PathBuf::from("target/mutants.tsv"));
    let done = read(&report);
    let left: Vec<usize> =
        chosen.iter().copied().filter(|&at| !done.contains_key(&all[at].describe())).collect();
    let told = |error: std::io::Error| format!("{}: {error}", report.display());
    let file = std::fs::OpenOptions::new().create(true).append(true).open(&report).map_err(told)?;
    let progress = Mutex::new((file, 0));
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    pool::run(&program, options.jobs, batches(&all, &left), |Verdict { mutant, word, .. }| {
        let mut progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
        // A report that cannot be written shows as mutants that are missing from it.
        let _ = writeln!(progress.0, "{word}\t{}", all[mutant].describe());
        progress.1 += 1;
        if progress.1 % 100 == 0 {
            println!("{} of {}", progress.1, left.len());
        }
    })
    .map_err(|error| error.to_string())?;
    let unlisted = tell(&all, &chosen, &read(&report), &known());
    check(&unlisted, if options.strict { 100 } else { options.least })
}

/// Numbers of mutants that survive without a reason, and of all that were tried.
struct Unlisted {
    count: usize,
    of: usize,
}

/// Fails if fewer than `least` percent of the mutants are seen or listed.
fn check(unlisted: &Unlisted, least: usize) -> Result<(), String> {
    let &Unlisted { count, of } = unlisted;
    if 100 * (of - count) < least * of {
        return Err(format!(
            "{count} of {of} mutants survive and are not in tests/mutants.txt; at least {least} % have to be seen or listed"
        ));
    }
    Ok(())
}

/// Prints what was seen, and what was not.
fn tell(all: &[Mutant], chosen: &[usize], done: &BTreeMap<String, String>, list: &[Known]) -> Unlisted {
    let word = |at: usize| done.get(&all[at].describe()).map_or("failed: no answer", String::as_str);
    let valid: Vec<usize> = chosen.iter().copied().filter(|&at| word(at) != "refused").collect();
    let seen = valid.iter().filter(|&&at| word(at).starts_with("seen")).count();
    let (mut listed, mut unlisted) = (0, 0);
    let mut kinds: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    for &at in &valid {
        let survives = !word(at).starts_with("seen");
        let counts = kinds.entry(all[at].kind.to_string()).or_default();
        counts[0] += 1;
        counts[1] += usize::from(survives);
        if survives {
            match reason(list, &all[at]) {
                Some(reason) => {
                    listed += 1;
                    println!("listed: {}: {reason}", all[at].describe());
                }
                None => {
                    unlisted += 1;
                    println!("{}: {}", word(at), all[at].describe());
                }
            }
        }
    }
    for (kind, [count, survive]) in kinds {
        println!("{kind}: {} of {count} seen", count - survive);
    }
    let fraction = 100.0 * seen as f64 / valid.len().max(1) as f64;
    println!(
        "{} mutants, {seen} seen ({fraction:.1} %), {listed} listed with a reason, {unlisted} not",
        valid.len()
    );
    Unlisted { count: unlisted, of: valid.len() }
}

fn work() -> Result<(), String> {
    worker::work(&adapter::open().map_err(|error| adapter::missing(&error))?);
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = if arguments == ["--worker"] { work() } else { run(&arguments) };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("mutants: {message}");
            ExitCode::FAILURE
        }
    }
}
