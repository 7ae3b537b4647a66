//! The subcommands, one file each.

mod adapters;
mod check;
mod drop;
mod input;
mod lattice;
mod mask;
mod pattern;
mod rain;
mod render;
mod schema;
mod specimen;
mod streaks;
mod street;
#[cfg(feature = "view")]
mod view;
mod wind;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Subcommand};
use downpour::drop::fall_speed::FallSpeedModel;
use downpour::scene::Warning;

use crate::failure::Failure;
use crate::interrupt::Interrupt;

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Render(render::RenderArguments),
    Check(check::CheckArguments),
    /// Print the JSON schema of weather files, for editors
    Schema,
    Mask(mask::MaskArguments),
    Drop(drop::DropArguments),
    Rain(rain::RainArguments),
    Specimen(specimen::SpecimenArguments),
    Wind(wind::WindArguments),
    Lattice(lattice::LatticeArguments),
    Street(street::StreetArguments),
    #[cfg(feature = "view")]
    View(view::ViewArguments),
    Adapters(adapters::AdaptersArguments),
}

impl Command {
    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        match self {
            Self::Render(arguments) => arguments.run(interrupt),
            Self::Check(arguments) => arguments.run(),
            Self::Schema => schema::run(),
            Self::Mask(arguments) => arguments.run(interrupt),
            Self::Drop(arguments) => arguments.run(),
            Self::Rain(arguments) => arguments.run(),
            Self::Specimen(arguments) => arguments.run(interrupt),
            Self::Wind(arguments) => arguments.run(interrupt),
            Self::Lattice(arguments) => arguments.run(interrupt),
            Self::Street(arguments) => arguments.run(interrupt),
            #[cfg(feature = "view")]
            Self::View(arguments) => arguments.run(),
            Self::Adapters(arguments) => arguments.run(),
        }
    }
}

/// Warnings of a file that are shown.
const MAX_WARNINGS: usize = 5;

/// Prints the first warnings of a file, and the number of the others.
fn say_warnings(name: &str, warnings: &[Warning], say: impl Fn(&str)) {
    for warning in warnings.iter().take(MAX_WARNINGS) {
        say(&format!("warning: {name}: {warning}"));
    }
    if let Some(more @ 1..) = warnings.len().checked_sub(MAX_WARNINGS) {
        say(&format!("warning: {name}: and {more} more"));
    }
}

/// The law of terminal speed.
#[derive(Clone, Copy, Debug, Args)]
struct FallSpeedArgument {
    /// Law of terminal speed, by its paper.
    #[arg(id = "fall-speed", long = "fall-speed", value_name = "NAME", default_value = "beard-1976")]
    #[arg(value_parser = fall_speeds())]
    model: FallSpeedModel,
}

fn fall_speeds() -> impl TypedValueParser<Value = FallSpeedModel> {
    let names = FallSpeedModel::ALL.map(FallSpeedModel::name);
    PossibleValuesParser::new(names)
        .try_map(|name| FallSpeedModel::from_name(&name).ok_or("no such law of fall speed"))
}
