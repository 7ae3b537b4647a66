//! Output files of the command: complete or absent ([`downpour::output_file`]).
//!
//! An existing name gets new contents only if requested, and only if it is a plain file: a
//! symbolic link is neither followed nor replaced. A temporary file of a process that was killed is removed by
//! the next one that publishes in the folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use downpour::output_file::{PartialFile, sync_folder};
pub(crate) use downpour::output_file::{folder_of, remove_leftovers};

use crate::failure::{FILES, Failure, shown};
use crate::interrupt::Interrupt;

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
            let part = PartialFile::new(&self.folder).map_err(|error| failed(&error))?;
            *unfinished = Some(part.path().to_owned());
            part
        };
        let written = part.write(bytes);
        let mut unfinished = interrupt.unfinished();
        let renamed = match written {
            Ok(()) => self
                .check_name()
                .and_then(|()| part.rename(&self.path, self.overwrite).map_err(|error| failed(&error))),
            Err(error) => {
                drop(part);
                Err(failed(&error))
            }
        };
        *unfinished = None;
        drop(unfinished);
        sync_folder(&renamed?);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;

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
