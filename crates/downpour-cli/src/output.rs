//! Atomic output files: complete or absent.
//!
//! The contents are written to a temporary file in the same folder, synced to the disk, and renamed in one
//! step. An existing name gets new contents only if requested, and only if it is a plain file: a
//! symbolic link is neither followed nor replaced.
//!
//! The temporary file is locked while its process lives. One without lock is from a process that was killed;
//! the next one that publishes in the folder removes it.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::failure::{FILES, Failure, shown};
use crate::interrupt::Interrupt;

/// Prefix of the names of temporary files.
const PREFIX: &str = ".downpour-";
const SUFFIX: &str = ".part";

/// An output file that can be published.
#[derive(Debug)]
pub(crate) struct OutputFile {
    path: PathBuf,
    folder: PathBuf,
    overwrite: bool,
}

impl OutputFile {
    /// Checks the path before any work is done.
    ///
    /// # Errors
    /// Exit code 5: there is no such folder, or the name is taken.
    pub(crate) fn new(path: &Path, overwrite: bool) -> Result<Self, Failure> {
        let folder = folder_of(path).to_owned();
        match fs::metadata(&folder) {
            Ok(found) if found.is_dir() => {}
            Ok(_) => return Err(Failure::new(FILES, format!("{} is not a folder", shown(&folder)))),
            Err(error) => return Err(Failure::new(FILES, format!("folder {}: {error}", shown(&folder)))),
        }
        let file = Self { path: path.to_owned(), folder, overwrite };
        file.check_name()?;
        Ok(file)
    }

    /// Checks that the name is free, or that the file may be overwritten.
    fn check_name(&self) -> Result<(), Failure> {
        let refused = |found: &str, advice: &str| {
            Err(Failure::new(FILES, format!("{} {found}; allowed: {advice}", shown(&self.path))))
        };
        match fs::symlink_metadata(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(Failure::file(&self.path, &error)),
            Ok(found) if found.is_symlink() => refused("is a symbolic link", "a plain file or a new name"),
            Ok(found) if !found.is_file() => refused("is not a plain file", "a plain file or a new name"),
            Ok(_) if !self.overwrite => refused("exists", "a new name, or --overwrite"),
            Ok(_) => Ok(()),
        }
    }

    /// Publishes the bytes: all of them under the name, or nothing.
    ///
    /// # Errors
    /// Exit code 5, with the error of the system.
    pub(crate) fn publish(&self, bytes: &[u8], interrupt: &Interrupt) -> Result<(), Failure> {
        remove_leftovers(&self.folder);
        self.publish_among_many(bytes, interrupt)
    }

    /// Publishes the bytes in a folder of many files without searching it for leftovers: the caller runs
    /// [`remove_leftovers`] once.
    ///
    /// # Errors
    /// As [`publish`](Self::publish).
    pub(crate) fn publish_among_many(&self, bytes: &[u8], interrupt: &Interrupt) -> Result<(), Failure> {
        let failed = |error: &io::Error| Failure::file(&self.path, error);
        let mut part = {
            let mut unfinished = interrupt.unfinished();
            let part = create(&self.folder).map_err(|error| failed(&error))?;
            *unfinished = Some(part.path().to_owned());
            part
        };
        // A file system without locks publishes as well; only leftovers stay then.
        let _ = part.as_file().try_lock();
        let written = part.write_all(bytes).and_then(|()| part.as_file().sync_all());
        let mut unfinished = interrupt.unfinished();
        let renamed = match written {
            Ok(()) => self.check_name().and_then(|()| {
                let done = if self.overwrite {
                    part.persist(&self.path)
                } else {
                    part.persist_noclobber(&self.path)
                };
                done.map_err(|error| failed(&error.error))
            }),
            Err(error) => {
                drop(part);
                Err(failed(&error))
            }
        };
        *unfinished = None;
        drop(unfinished);
        renamed?;
        // The name is on the disk once its folder is. Not every file system supports that, and the file is complete anyway.
        let _ = File::open(&self.folder).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

/// The folder of a file.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn create(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    // Temporary files are private by default; this one becomes an ordinary file, with the rights of the user's umask.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Removes temporary files whose process is gone.
pub(crate) fn remove_leftovers(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let plain = entry.file_type().is_ok_and(|kind| kind.is_file());
        if plain
            && name.starts_with(PREFIX)
            && name.ends_with(SUFFIX)
            && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok())
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn leftovers_of_dead_processes_go_and_those_of_living_ones_stay() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in [".downpour-dead.part", ".downpour-alive.part", ".downpour-notes.txt", "x.part"] {
            fs::write(at(name), "x").unwrap();
        }
        fs::create_dir(at(".downpour-folder.part")).unwrap();
        let alive = File::open(at(".downpour-alive.part")).unwrap();
        alive.lock().unwrap();
        let file = OutputFile::new(&at("mask.exr"), false).unwrap();
        file.publish(b"whole", &Interrupt::default()).unwrap();
        assert_eq!(
            names(folder.path()),
            [".downpour-alive.part", ".downpour-folder.part", ".downpour-notes.txt", "mask.exr", "x.part"]
        );
        assert_eq!(fs::read(at("mask.exr")).unwrap(), b"whole");
    }

    /// A name that is taken between the first check and the end of the work.
    #[test]
    fn a_name_taken_meanwhile_is_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mask.exr");
        let file = OutputFile::new(&path, false).unwrap();
        fs::write(&path, "of someone else").unwrap();
        let failure = file.publish(b"ours", &Interrupt::default()).unwrap_err();
        assert_eq!(failure.code, FILES);
        assert_eq!(fs::read(&path).unwrap(), b"of someone else");
        assert_eq!(names(folder.path()), ["mask.exr"]);
        OutputFile::new(&path, true).unwrap().publish(b"ours", &Interrupt::default()).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"ours");
    }
}
