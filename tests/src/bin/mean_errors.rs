//! `cargo xtask mean-errors`: adds to `tests/mean_errors.txt` what the reports of the parity tests say.

use std::process::ExitCode;

use downpour_tests::{mean_errors, report};

fn main() -> ExitCode {
    let (folder, path) = (report::folder(), mean_errors::path());
    let done = mean_errors::with_reports(&folder)
        .map_err(|error| format!("{}: {error}", folder.display()))
        .and_then(|text| std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display())));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("mean-errors: {message}");
            ExitCode::FAILURE
        }
    }
}
