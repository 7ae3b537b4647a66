//! Tables 1 and 2 of Rousseau 2008: the example `persistence` of the facade, on a scene of the project.

use clap::Args;

use xtask::run::cargo;

/// Tables 1 and 2 of Rousseau 2008: cost and error of streaks.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Fewer rows.
    #[arg(long)]
    quick: bool,
    /// The scene.
    #[arg(value_name = "WEATHER.toml", default_value = "assets/scenes/street/night.toml")]
    weather: String,
}

/// Prints the tables.
pub(crate) fn run(options: &Options) -> Result<(), String> {
    let mut call =
        vec!["run", "--release", "-p", "downpour", "--features", "wgpu", "--example", "persistence"];
    call.extend(["--", &options.weather]);
    if options.quick {
        call.push("--quick");
    }
    cargo(&call, &[])
}
