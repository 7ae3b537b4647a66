//! Where the files of a single picture go.

use std::fs;
use std::path::{Path, PathBuf};

use crate::failure::{Failure, INPUT, shown};
use crate::interrupt::Interrupt;
use crate::output::Place;

/// What the end of the picture's name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Exr,
    Png,
}

/// The places of all files that a run writes.
#[derive(Debug)]
pub(super) struct Outputs {
    pub(super) format: Format,
    picture: Place,
    stats: Option<Place>,
    drops: Option<Place>,
    paths: Vec<PathBuf>,
}

/// The bytes of the files.
pub(super) struct Bytes {
    pub(super) picture: Vec<u8>,
    pub(super) stats: Vec<u8>,
    pub(super) drops: Vec<u8>,
}

impl Outputs {
    /// Looks at all places before any work is done.
    ///
    /// # Errors
    /// Exit code 2 for a name that says another format, or the same name twice; 5 for a place that cannot be written.
    pub(super) fn new(
        picture: &Path,
        stats: Option<&Path>,
        drops: Option<&Path>,
        overwrite: bool,
    ) -> Result<Self, Failure> {
        let format = match extension(picture).as_deref() {
            Some("exr") => Format::Exr,
            Some("png") => Format::Png,
            Some("mp4") => return Err(refused(picture, ".exr or .png, or --frames and --fps for a clip")),
            _ => return Err(refused(picture, ".exr or .png")),
        };
        check_tables(stats, drops)?;
        let paths: Vec<PathBuf> =
            [Some(picture), stats, drops].into_iter().flatten().map(Path::to_owned).collect();
        let place = |path: Option<&Path>| path.map(|path| Place::new(path, overwrite)).transpose();
        Ok(Self {
            format,
            picture: Place::new(picture, overwrite)?,
            stats: place(stats)?,
            drops: place(drops)?,
            paths,
        })
    }

    /// Refuses to write over what the picture is made of.
    ///
    /// # Errors
    /// Exit code 2, with the name.
    pub(super) fn keep(&self, inputs: &[PathBuf]) -> Result<(), Failure> {
        keep(self.paths.iter(), inputs)
    }

    pub(super) fn wants_stats(&self) -> bool {
        self.stats.is_some()
    }

    pub(super) fn wants_drops(&self) -> bool {
        self.drops.is_some()
    }

    /// Publishes the files, the picture last: where it is, the others are.
    ///
    /// # Errors
    /// Exit code 5, with what the system says.
    pub(super) fn publish(&self, bytes: &Bytes, interrupt: &Interrupt) -> Result<(), Failure> {
        if let Some(place) = &self.drops {
            place.publish(&bytes.drops, interrupt)?;
        }
        if let Some(place) = &self.stats {
            place.publish(&bytes.stats, interrupt)?;
        }
        self.picture.publish(&bytes.picture, interrupt)
    }
}

/// Refuses lists whose names say another format.
pub(super) fn check_tables(stats: Option<&Path>, drops: Option<&Path>) -> Result<(), Failure> {
    for (path, allowed) in [(stats, "json"), (drops, "csv")] {
        if let Some(path) = path.filter(|path| extension(path).as_deref() != Some(allowed)) {
            return Err(refused(path, &format!(".{allowed}")));
        }
    }
    Ok(())
}

/// Refuses outputs that are inputs as well.
pub(super) fn keep<P: AsRef<Path>>(
    mut outputs: impl Iterator<Item = P>,
    inputs: &[PathBuf],
) -> Result<(), Failure> {
    let kept: Vec<PathBuf> = inputs.iter().filter_map(|path| fs::canonicalize(path).ok()).collect();
    let taken = outputs.find(|path| fs::canonicalize(path).is_ok_and(|path| kept.contains(&path)));
    match taken {
        Some(path) => {
            let found = format!("output {} is an input of the picture", shown(path.as_ref()));
            Err(Failure::new(INPUT, format!("{found}; allowed: another name")))
        }
        None => Ok(()),
    }
}

pub(super) fn extension(path: &Path) -> Option<String> {
    path.extension().map(|e| e.to_string_lossy().to_lowercase())
}

pub(super) fn refused(path: &Path, allowed: &str) -> Failure {
    Failure::new(INPUT, format!("output {}; allowed: {allowed}", shown(path)))
}
