//! Tables 1 and 2 of Rousseau 2008: the example `persistence` of the facade, on a scene of the project.

use crate::run::cargo;

/// The scene, unless another one is named.
const WEATHER: &str = "assets/scenes/street/night.toml";

/// Prints the tables.
pub(crate) fn run(arguments: &[&str]) -> Result<(), String> {
    let quick = arguments.contains(&"--quick");
    let files: Vec<&str> = arguments.iter().copied().filter(|argument| *argument != "--quick").collect();
    let weather = match files[..] {
        [] => WEATHER,
        [file] if !file.starts_with('-') => file,
        _ => return Err(format!("{arguments:?}; allowed: [--quick] [WEATHER.toml]")),
    };
    let mut call =
        vec!["run", "--release", "-p", "downpour", "--features", "wgpu", "--example", "persistence"];
    call.extend(["--", weather]);
    if quick {
        call.push("--quick");
    }
    cargo(&call, &[])
}
