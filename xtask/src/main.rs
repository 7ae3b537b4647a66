//! Tasks of the workspace. `cargo xtask` without a task lists them.

mod checks;
mod driver;
mod goldens;
mod mutants;
mod shaders;

use std::process::ExitCode;

use xtask::run;

const USAGE: &str = "\
cargo xtask test [--all]      run every test; makes sure of a Vulkan driver first; --all: the long sweeps too
cargo xtask ci                formatting, lints, each crate alone, documentation, then every test and sweep
cargo xtask lint              the same without the tests
cargo xtask masks [--check]   write assets/masks; with --check compare them with what the code makes, byte for byte
cargo xtask scenes [--check]  write assets/scenes/street; with --check compare it, byte for byte
cargo xtask scenes skies      capture the street into the sky maps of assets/skies, minutes each; with --check compare them, byte
                              for byte (--command FILE: a `downpour` that is built)
cargo xtask atlas [OPTIONS]   write assets/streaks; --check compares them; --columbia imports the streak database
cargo xtask goldens [--bless] compare the golden masks and pictures of tests/goldens; with --bless write them from the CPU
cargo xtask mutants [OPTIONS] change one thing in every WGSL function and list what no case sees (--sample N --seed S, --function
                              NAME, --own, --others, --list, --cases, --jobs N, --report FILE, --strict)
cargo xtask mean-errors       add to tests/mean_errors.txt what the parity reports of target/parity say
cargo xtask shaders [FOLDER]  write the complete WGSL text of every kernel (default target/shaders)
cargo xtask truth [OPTIONS]   hold `downpour specimen` against Mitsuba 3 (needs python3 and the network)
cargo xtask figures [NAME]    make a paper's figures again, with our rain beside theirs; without a name list them
cargo xtask bench             run every benchmark";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["test"] => checks::test(false),
        ["test", "--all"] => checks::test(true),
        ["ci"] => checks::lint().and_then(|()| checks::test(true)),
        ["lint"] => checks::lint(),
        ["masks" | "atlas" | "scenes", ..] => program("downpour-assets", &words),
        ["goldens"] => goldens::compare(),
        ["goldens", "--bless"] => goldens::bless(),
        ["mutants", rest @ ..] => mutants::try_all(rest),
        ["mean-errors"] => mutants::mean_errors(),
        ["shaders"] => shaders::write("target/shaders"),
        ["shaders", folder] => shaders::write(folder),
        ["truth" | "figures", ..] => program("downpour-validation", &words),
        ["bench"] => checks::bench(),
        [] => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        _ => Err(format!("no task \"{}\"; there are:\n{USAGE}", words.join(" "))),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

/// A task of another crate. This one is small, so that tests and lints start at once.
fn program(package: &str, words: &[&str]) -> Result<(), String> {
    run::cargo(&[&["run", "--quiet", "--locked", "-p", package, "--"], words].concat(), &[])
}
