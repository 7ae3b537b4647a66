//! Comparison of Downpour with other renderers, and with the figures of papers.

mod figures;
mod quantity;
mod truth;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Holds Downpour against other renderers, and against the figures of papers.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    Truth(truth::Options),
    Figures(figures::Figures),
}

/// Arguments of a task alone, for its tests.
#[cfg(test)]
fn read<T: clap::Args>(arguments: &[&str]) -> Result<T, String> {
    let command = T::augment_args(clap::Command::new("task")).no_binary_name(true);
    let matches = command.try_get_matches_from(arguments).map_err(|error| error.to_string())?;
    T::from_arg_matches(&matches).map_err(|error| error.to_string())
}

fn main() -> ExitCode {
    let done = match Arguments::parse().task {
        Task::Truth(options) => truth::run(&options),
        Task::Figures(figures) => figures::run(&figures),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("validation: {message}");
            ExitCode::FAILURE
        }
    }
}
