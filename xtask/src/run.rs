//! Child processes and paths of the workspace.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The root of the workspace.
#[must_use]
pub fn root() -> PathBuf {
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    here.parent().map_or_else(|| PathBuf::from("."), PathBuf::from)
}

/// A command that runs in the root of the workspace.
#[must_use]
pub fn command(program: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(root());
    command
}

/// Runs cargo.
///
/// # Errors
/// The call, if it failed.
pub fn cargo(arguments: &[&str], environment: &[(&str, &str)]) -> Result<(), String> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    println!("$ cargo {}", arguments.join(" "));
    let mut command = command(&cargo, arguments);
    finish(command.envs(environment.iter().copied()), &format!("cargo {}", arguments.join(" ")))
}

/// Runs a command, which is called `what` in errors.
///
/// # Errors
/// That it did not start, or failed.
pub fn finish(command: &mut Command, what: &str) -> Result<(), String> {
    let status = command.status().map_err(|error| format!("{what} did not start: {error}"))?;
    if status.success() { Ok(()) } else { Err(format!("{what} failed")) }
}

/// The command `downpour`: the one given, or that of this tree, built.
///
/// # Errors
/// What cargo said, or why the path cannot be made absolute.
pub fn downpour(given: Option<&Path>) -> Result<PathBuf, String> {
    if let Some(given) = given {
        return std::path::absolute(given).map_err(|error| format!("{}: {error}", given.display()));
    }
    cargo(&["build", "--release", "--locked", "-p", "downpour-cli"], &[])?;
    Ok(built("release", "downpour"))
}

/// Path of a program that was built with a profile.
#[must_use]
pub fn built(profile: &str, name: &str) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    root().join(target).join(profile).join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}
