//! `downpour lattice`: one lattice of water alone, its invariants, and pictures of it.

mod device;
mod glass;
mod pane;
mod picture;
mod puddle;
mod water;

use clap::{Args, Subcommand};

use crate::backend::{Backend, BackendArguments};
use crate::failure::{Failure, OTHER};
use crate::interrupt::Interrupt;
use crate::listing::Entry;
use crate::{listing, stream};

/// Run one lattice of water alone, print its invariants, and draw it.
#[derive(Debug, Args)]
pub(crate) struct LatticeArguments {
    #[command(subcommand)]
    lattice: Lattice,
}

#[derive(Debug, Subcommand)]
enum Lattice {
    Glass(glass::GlassArguments),
    Puddle(puddle::PuddleArguments),
}

impl LatticeArguments {
    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        match &self.lattice {
            Lattice::Glass(arguments) => arguments.run(interrupt),
            Lattice::Puddle(arguments) => arguments.run(interrupt),
        }
    }
}

/// Arguments of both lattices.
#[derive(Debug, Args)]
struct Common {
    /// Rain rate in mm/h, 0 to 500.
    #[arg(long, value_name = "MM_H", default_value = "0", value_parser = crate::quantity::rate_mm_h)]
    #[arg(allow_hyphen_values = true)]
    rate: f64,
    /// Seed of the rain.
    #[arg(long, value_name = "N", default_value = "0", value_parser = crate::quantity::seed)]
    #[arg(allow_hyphen_values = true)]
    seed: u64,
    /// The picture: .png, or .exr with the numbers themselves. With --every a name with a number, as frames/%04d.png.
    #[arg(short, long, value_name = "OUT")]
    output: Option<std::path::PathBuf>,
    /// Make a clip: a picture every N steps, the first before any step.
    #[arg(long, value_name = "N", requires = "output", value_parser = crate::quantity::steps)]
    #[arg(allow_hyphen_values = true)]
    every: Option<u64>,
    /// Replace files that exist.
    #[arg(long)]
    overwrite: bool,
    /// Write the invariants as JSON.
    #[arg(long)]
    json: bool,
    /// Compute backend. A lattice alone is small: the CPU is done before a software driver of a GPU has started, and gives
    /// the same bits on every machine. A GPU is for large ones.
    #[arg(long, value_enum, default_value = "cpu")]
    backend: Backend,
    /// Part of the name of the GPU to take, as `downpour adapters` lists them.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Print errors only.
    #[arg(short, long)]
    quiet: bool,
}

impl Common {
    /// # Errors
    /// As [`BackendArguments::check`].
    fn backend(&self) -> Result<BackendArguments, Failure> {
        let backend = BackendArguments { backend: self.backend, adapter: self.adapter.clone() };
        backend.check()?;
        Ok(backend)
    }

    fn say(&self, text: &str) {
        if !self.quiet {
            stream::message(text);
        }
    }
}

/// Prints the list, then fails if a checked invariant does not hold.
///
/// # Errors
/// Exit code 1 for a law that is broken: a defect of the lattice.
fn report(common: &Common, entries: &[Entry], broken: Option<String>) -> Result<(), Failure> {
    if common.json {
        stream::print(&listing::json(entries))?;
    } else if !common.quiet {
        stream::print(&listing::text(entries))?;
    }
    match broken {
        Some(what) => Err(Failure::new(OTHER, what)),
        None => Ok(()),
    }
}
