//! `downpour street`: an old European street from a seed, or a car for it, as one .glb.

use std::path::{Path, PathBuf};

use clap::Args;
use downpour::street::{Car, Piece, Street, StreetSettings, TimeOfDay};

use crate::failure::{Failure, INPUT, LIMIT, shown};
use crate::interrupt::Interrupt;
use crate::output::OutputFile;
use crate::stream;

/// The greatest file of settings, bytes.
const MAX_SETTINGS: u64 = 1 << 20;

/// Make an old European street from a seed, as a .glb with its textures.
///
/// The street runs along -z from z = 0, its middle at x = 0, in meters. The same settings give the same bytes.
#[derive(Debug, Args)]
pub(crate) struct StreetArguments {
    /// Same seed, same street, 0 to 2^64 - 1 [default: the settings', else 7].
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// File of settings (TOML): length, width, paving, age, lamps, furniture, cars, shops.
    #[arg(long, value_name = "FILE.toml")]
    settings: Option<PathBuf>,
    /// Make a car that drives instead: gray, blue, red, white, black or green, 0 to 5. It stands on y = 0 and looks along +z; the wheels
    /// of its animation roll as at 1 m/s.
    #[arg(long, value_name = "PAINT", conflicts_with_all = ["seed", "settings"])]
    car: Option<usize>,
    /// Lamps burn and windows are lit.
    #[arg(long)]
    night: bool,
    /// The model: .glb.
    #[arg(short, long, value_name = "OUT.glb")]
    output: PathBuf,
    /// Replace the file if it exists.
    #[arg(long)]
    overwrite: bool,
    /// Print errors only.
    #[arg(short, long)]
    quiet: bool,
}

impl StreetArguments {
    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        let extension = self.output.extension().map(|e| e.to_string_lossy().to_lowercase());
        if extension.as_deref() != Some("glb") {
            return Err(Failure::new(INPUT, format!("output {}; allowed: .glb", shown(&self.output))));
        }
        let file = OutputFile::new(&self.output, self.overwrite)?;
        let time = if self.night { TimeOfDay::Night } else { TimeOfDay::Day };
        let (bytes, contents) = match self.car {
            Some(paint) => {
                let car = Car::new(paint)?;
                let triangles: usize = car.pieces().iter().map(Piece::triangle_count).sum();
                (car.to_glb(time)?, format!("a car, {triangles} triangles, {} lamps", car.lamps().len()))
            }
            None => self.street(time)?,
        };
        file.publish(&bytes, interrupt)?;
        if !self.quiet {
            stream::message(&format!("wrote {}: {contents}", shown(&self.output)));
        }
        Ok(())
    }

    /// The street and what is in it.
    fn street(&self, time: TimeOfDay) -> Result<(Vec<u8>, String), Failure> {
        let mut settings = match &self.settings {
            Some(path) => read(path)?,
            None => StreetSettings::default(),
        };
        settings.seed = self.seed.unwrap_or(settings.seed);
        let street = Street::generate(&settings)?;
        let contents = format!(
            "{} m, {} triangles, {} lamps, {} hollows",
            settings.length_m,
            street.triangle_count(),
            street.lamps().len(),
            street.hollows().len()
        );
        Ok((street.to_glb(time)?, contents))
    }
}

fn read(path: &Path) -> Result<StreetSettings, Failure> {
    let length = std::fs::metadata(path).map_err(|error| Failure::file(path, &error))?.len();
    if length > MAX_SETTINGS {
        let name = shown(path);
        return Err(Failure::new(
            LIMIT,
            format!("{name}: {length} bytes; allowed: at most {MAX_SETTINGS} bytes"),
        ));
    }
    let bytes = std::fs::read(path).map_err(|error| Failure::file(path, &error))?;
    let text = String::from_utf8(bytes).map_err(|_| {
        Failure::new(INPUT, format!("{}: not UTF-8; allowed: TOML with the keys of a street", shown(path)))
    })?;
    Ok(StreetSettings::from_toml(&text, &shown(path))?)
}
