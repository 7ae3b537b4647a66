//! Times of Downpour's rain beside those of two crates of particles for Bevy, on one device in one run.

mod bevy_app;
mod contender;
mod device;
mod elements;
mod hanabi;
mod measure;
mod ours;
mod picture;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;

use contender::Entry;
use device::Device;
use measure::{Rounds, Row};

/// Columns and rows of every picture.
const SIZE: [u32; 2] = [1280, 720];

/// Vertical field of view of every camera, rad.
const FOV_Y: f32 = 0.87;

/// Height of every camera above the ground, m. It looks along -Z.
const EYE_M: f32 = 1.7;

/// Time from frame to frame in every simulation, s.
const STEP_S: f64 = 1.0 / 60.0;

/// Edge of the box of drops around the camera, m, where it can be chosen.
const BOX_M: f64 = 20.0;

/// Most drops that can be asked for: what a 32-bit float counts exactly, as `bevy_hanabi` takes the number.
const MAX_DROPS: i64 = 1 << 24;

/// Times Downpour's rain and the particles of `bevy_hanabi` and `bevy_elements` on one device, and prints a table in Markdown.
#[derive(Debug, Parser)]
#[command(name = "peers")]
struct Arguments {
    /// Numbers of drops, each 1 to 16777216.
    #[arg(long, value_delimiter = ',', default_values_t = [10_000, 100_000, 1_000_000],
        value_parser = clap::value_parser!(u32).range(1..=MAX_DROPS))]
    drops: Vec<u32>,
    /// Timed frames of a round.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// Rounds: in each, everything is timed once, by turns forward and backward.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
    /// Frames before the first round, after the first that shows drops.
    #[arg(long, default_value_t = 30)]
    warm_up: u32,
    /// Frames after which the CPU waits until the device is idle.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    wait_every: u32,
    /// Seconds after which a round of an entry ends with fewer frames, but at least one.
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..))]
    seconds: u32,
    /// Text in the name or the driver of the adapter, ignoring case; without it, the best adapter.
    #[arg(long)]
    adapter: Option<String>,
    /// Folder for the last picture of everything that draws.
    #[arg(long)]
    save: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("peers: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let device = Device::open(arguments.adapter.as_deref())?;
    let rounds = Rounds {
        frames: arguments.frames,
        rounds: arguments.rounds,
        warm_up: arguments.warm_up,
        wait_every: arguments.wait_every,
        limit: Duration::from_secs(arguments.seconds.into()),
    };
    println!("{}", rounds.caption(&device));
    println!("\n{}", Row::HEAD);
    for &drops in &arguments.drops {
        // What is compared with each other lives at the same time, and only that.
        let mut entries = entries(&device, drops)?;
        for row in rounds.run(&device, &mut entries)? {
            println!("{row}");
        }
        if let Some(folder) = &arguments.save {
            picture::save(&device, folder, drops, &entries)?;
        }
    }
    Ok(())
}

/// Returns everything that is timed with a number of drops. What an entry is compared with stands before it.
fn entries(device: &Device, drops: u32) -> Result<Vec<Entry>, String> {
    let mut all = vec![ours::step(device, drops)?];
    let groups =
        [ours::pictures(device, drops)?, hanabi::entries(device, drops)?, elements::entries(device, drops)?];
    for group in groups {
        let before = all.len();
        all.extend(group.into_iter().map(|entry| Entry { empty: entry.empty.map(|k| k + before), ..entry }));
    }
    Ok(all)
}
