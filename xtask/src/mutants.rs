//! Programs of `downpour-tests`: mutants of the shaders, and the limits of mean errors.

use xtask::run;

use crate::driver;

/// The sample that every run of the tests tries, of functions with a case: seconds.
const SAMPLE: [&str; 8] = ["--own", "--sample", "40", "--seed", "1", "--least", "95", "--report"];

/// Tries those that the arguments ask for.
pub(crate) fn try_all(arguments: &[&str]) -> Result<(), String> {
    driver::ensure()?;
    program("mutants", arguments)
}

/// Writes `tests/mean_errors.txt`.
pub(crate) fn mean_errors() -> Result<(), String> {
    program("mean_errors", &[])
}

/// Tries the sample; fails if more than a twentieth survive that are not listed.
pub(crate) fn try_sample() -> Result<(), String> {
    if std::env::var("DOWNPOUR_GPU_TESTS").is_ok_and(|v| v == "no") {
        return Ok(());
    }
    let report = run::root().join("target/mutants-sample.tsv");
    // Of the shaders as they are now.
    match std::fs::remove_file(&report) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            return Err(format!("{}: {error}", report.display()));
        }
        _ => {}
    }
    program("mutants", &[&SAMPLE[..], &[&report.display().to_string()]].concat())
}

fn program(name: &str, arguments: &[&str]) -> Result<(), String> {
    // With the tests of its package, of the whole workspace: the features are those of `cargo xtask test`, and nothing is built twice.
    run::cargo(&["test", "--workspace", "--all-features", "--locked", "--no-run", "--test", "parity"], &[])?;
    let mut command = run::command(&run::built("debug", name).display().to_string(), arguments);
    let what = format!("{name} {}", arguments.join(" "));
    run::finish(command.env("XDG_RUNTIME_DIR", driver::runtime()?), &what)
}
