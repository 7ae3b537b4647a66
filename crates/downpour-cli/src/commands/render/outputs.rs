//! Output files of a single picture.

use std::fs;
use std::path::{Path, PathBuf};

use crate::failure::{Failure, INPUT, shown};
use crate::interrupt::Interrupt;
use crate::output::OutputFile;

/// Format by the extension of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Exr,
    Png,
}

/// All output files of a run.
#[derive(Debug)]
pub(super) struct Outputs {
    pub(super) format: Format,
    picture: OutputFile,
    stats: Option<OutputFile>,
    drops: Option<OutputFile>,
    paths: Vec<PathBuf>,
}

/// The bytes of the files.
pub(super) struct Bytes {
    pub(super) picture: Vec<u8>,
    pub(super) stats: Vec<u8>,
    pub(super) drops: Vec<u8>,
}

impl Outputs {
    /// Checks all paths before any work is done.
    ///
    /// # Errors
    /// Exit code 2 for a name of another format, or the same name twice; 5 for a path that cannot be written.
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
        let file = |path: Option<&Path>| path.map(|path| OutputFile::new(path, overwrite)).transpose();
        Ok(Self {
            format,
            picture: OutputFile::new(picture, overwrite)?,
            stats: file(stats)?,
            drops: file(drops)?,
            paths,
        })
    }

    /// Refuses to overwrite the inputs of the picture.
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

    /// Publishes the files, the picture last: if it exists, the others do.
    ///
    /// # Errors
    /// Exit code 5, with the error of the system.
    pub(super) fn publish(&self, bytes: &Bytes, interrupt: &Interrupt) -> Result<(), Failure> {
        if let Some(file) = &self.drops {
            file.publish(&bytes.drops, interrupt)?;
        }
        if let Some(file) = &self.stats {
            file.publish(&bytes.stats, interrupt)?;
        }
        self.picture.publish(&bytes.picture, interrupt)
    }
}

/// Rejects tables whose names have another format.
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
