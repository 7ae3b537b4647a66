//! `cargo xtask mutants`: tries mutants of every WGSL function on the machine's adapter.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use downpour_tests::adapter;
use downpour_tests::mutants::pool;
use downpour_tests::mutants::population::{Mutant, population, sample};
use downpour_tests::mutants::worker;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments == ["--worker"] {
        return match adapter::open() {
            Ok(gpu) => {
                worker::work(&gpu);
                ExitCode::SUCCESS
            }
            Err(error) => {
                eprintln!("{}", adapter::missing(&error));
                ExitCode::FAILURE
            }
        };
    }
    let get =
        |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1).cloned());
    let all = population();
    let mut chosen: Vec<usize> = (0..all.len()).collect();
    if let Some(f) = get("--function") {
        chosen.retain(|&i| all[i].swap.function == f);
    }
    if let Some(n) = get("--sample") {
        let seed = get("--seed").map_or(1, |s| s.parse().unwrap());
        let drawn = sample(chosen.len(), n.parse().unwrap(), seed);
        chosen = drawn.into_iter().map(|i| chosen[i]).collect();
    }
    if let Some(part) = get("--part") {
        let (a, b) = part.split_once('/').unwrap();
        let (a, b): (usize, usize) = (a.parse().unwrap(), b.parse().unwrap());
        chosen = chosen.into_iter().enumerate().filter(|(k, _)| k % b == a - 1).map(|(_, i)| i).collect();
    }
    if arguments.iter().any(|a| a == "--list") {
        for &i in &chosen {
            println!("{}", all[i].describe());
        }
        return ExitCode::SUCCESS;
    }
    let jobs = get("--jobs")
        .map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), |j| j.parse().unwrap());
    let report = PathBuf::from(get("--report").unwrap_or_else(|| "target/mutants.tsv".to_owned()));
    let done: BTreeSet<String> = std::fs::read_to_string(&report)
        .unwrap_or_default()
        .lines()
        .filter_map(|l| l.split('\t').nth(3).map(str::to_owned))
        .collect();
    chosen.retain(|&i| !done.contains(&all[i].describe()));
    let mut batches: BTreeMap<(&str, &str, usize), Vec<usize>> = BTreeMap::new();
    for (k, &i) in chosen.iter().enumerate() {
        batches.entry((all[i].module.path, &all[i].swap.function, k / 24)).or_default().push(i);
    }
    let file = Mutex::new(std::fs::OpenOptions::new().create(true).append(true).open(&report).unwrap());
    let count = Mutex::new((0usize, 0usize));
    let total = chosen.len();
    let mut order: Vec<Vec<usize>> = batches.into_values().collect();
    if arguments.iter().any(|a| a == "--shuffle") { order.sort_by_key(|b| downpour_math::rng::rng_draw([9, 9], b[0] as u32, 0, 0)[0]); }
    pool::run(&std::env::current_exe().unwrap(), jobs, order, |v| {
        let m: &Mutant = &all[v.mutant];
        let mut f = file.lock().unwrap_or_else(PoisonError::into_inner);
        writeln!(f, "{}\t{}\t{:.2}\t{}", v.mutant, v.word, v.took.as_secs_f64(), m.describe()).unwrap();
        let mut c = count.lock().unwrap();
        c.0 += 1;
        if v.word == "survived" || v.word.starts_with("failed") {
            c.1 += 1;
            println!("{} {}", v.word, m.describe());
        }
        if c.0 % 100 == 0 {
            println!("-- {} of {total}, {} unseen", c.0, c.1);
        }
    })
    .unwrap();
    ExitCode::SUCCESS
}
