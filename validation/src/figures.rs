//! Reproduced figures of papers, with our rain beside theirs.

mod city;
mod im_sung;
mod persistence;

use clap::{Args, Subcommand};

/// Make a paper's figures again, with our rain beside theirs.
#[derive(Args, Debug)]
pub(crate) struct Figures {
    #[command(subcommand)]
    which: Which,
}

#[derive(Debug, Subcommand)]
enum Which {
    City(city::Options),
    ImSung(im_sung::Options),
    Persistence(persistence::Options),
}

/// Makes the figures of a name.
pub(crate) fn run(figures: &Figures) -> Result<(), String> {
    match &figures.which {
        Which::City(options) => city::run(options),
        Which::ImSung(options) => im_sung::run(options),
        Which::Persistence(options) => persistence::run(options),
    }
}
