//! The subcommands, one file each.

mod adapters;
mod drop;
mod mask;
mod rain;
mod specimen;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Subcommand};
use downpour::drop::fall_speed::FallSpeedModel;

use crate::failure::Failure;
use crate::interrupt::Interrupt;

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Mask(mask::MaskArguments),
    Drop(drop::DropArguments),
    Rain(rain::RainArguments),
    Specimen(specimen::SpecimenArguments),
    Adapters(adapters::AdaptersArguments),
}

impl Command {
    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        match self {
            Self::Mask(arguments) => arguments.run(interrupt),
            Self::Drop(arguments) => arguments.run(),
            Self::Rain(arguments) => arguments.run(),
            Self::Specimen(arguments) => arguments.run(interrupt),
            Self::Adapters(arguments) => arguments.run(),
        }
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
