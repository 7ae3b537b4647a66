//! The command `downpour`: scenes in the rain, physical properties of drops and rain, and refraction masks of drops.
//!
//! Arguments, files and exit codes are here; the physics is in the crates below. Scripts depend on the JSON keys and
//! on the exit codes ([`failure`]).

mod backend;
mod commands;
mod exit_code;
mod failure;
mod interrupt;
mod listing;
mod output;
mod progress;
mod quantity;
mod stream;
mod threads;

use std::process::ExitCode;

use clap::Parser;

use commands::Command;
use failure::Failure;
use interrupt::Interrupt;

/// Rain that can be measured.
#[derive(Debug, Parser)]
#[command(name = "downpour", version, arg_required_else_help = true)]
#[command(after_help = "Exit codes: 0 done, 2 bad arguments or input, 3 over a limit, 4 GPU, 5 files, \
6 canceled, 1 anything else.")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

fn main() -> ExitCode {
    // A panic is a defect of ours. It ends in one line and an exit code all the same. One in a decoder of pictures becomes an error
    // that names the file.
    std::panic::set_hook(Box::new(|panic| {
        if downpour::scene::picture::is_guarded() {
            return;
        }
        stream::message(&format!("error: internal error, please report it: {panic}"));
    }));
    match std::panic::catch_unwind(run) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            stream::message(&format!("error: {failure}"));
            ExitCode::from(failure.code)
        }
        Err(_) => ExitCode::from(failure::OTHER),
    }
}

fn run() -> Result<(), Failure> {
    // First of all whether there is memory to work with: what catches signals is a thread, too.
    threads::start()?;
    let interrupt = Interrupt::install()?;
    match Arguments::try_parse() {
        Ok(arguments) => arguments.command.run(&interrupt),
        Err(error) if error.use_stderr() => Err(Failure::from(&error)),
        // Help and version were requested.
        Err(error) => stream::print(&error.to_string()),
    }
}
