//! Atomic output files: complete or absent.
//!
//! The contents are written to a temporary file in the same folder, synced to the disk, and renamed in one step.
//!
//! The temporary file is locked while its process lives. One without lock is from a process that was killed;
//! [`remove_leftovers`] removes it.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

/// Prefix of the names of temporary files.
const PREFIX: &str = ".downpour-";
const SUFFIX: &str = ".part";

/// A temporary file that becomes an output file. Dropped before that, it is removed.
#[derive(Debug)]
pub struct PartialFile {
    file: NamedTempFile,
    folder: PathBuf,
}

impl PartialFile {
    /// An empty temporary file in a folder.
    ///
    /// # Errors
    /// The error of the system.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let mut builder = Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        // Temporary files are private by default; this one becomes an ordinary file, with the rights of the user's umask.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder)?;
        // A file system without locks publishes as well; only leftovers stay then.
        let _ = file.as_file().try_lock();
        Ok(Self { file, folder: folder.to_owned() })
    }

    /// Path of the temporary file.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Appends bytes, and waits until they are on the disk.
    ///
    /// # Errors
    /// The error of the system.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)?;
        self.file.as_file().sync_all()
    }

    /// Renames the file, and replaces one that has the name if `overwrite` is true. Returns the folder, to be given to
    /// [`sync_folder`].
    ///
    /// # Errors
    /// The error of the system; the temporary file is removed.
    pub fn rename(self, path: &Path, overwrite: bool) -> io::Result<PathBuf> {
        let renamed = if overwrite { self.file.persist(path) } else { self.file.persist_noclobber(path) };
        renamed.map(|_| self.folder).map_err(|error| error.error)
    }
}

/// Waits until the names in a folder are on the disk. Not every file system supports that, and its files are complete anyway.
pub fn sync_folder(folder: &Path) {
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

/// Writes a file: all of its bytes under its name, or nothing. A file that has the name is replaced, and its permissions stay; of a
/// symbolic link, the target is replaced.
///
/// # Errors
/// The error of the system.
pub fn replace_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let is_link = fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink());
    let path = if is_link { fs::canonicalize(path)? } else { path.to_owned() };
    let mut part = PartialFile::new(folder_of(&path))?;
    if let Ok(found) = fs::metadata(&path)
        && found.is_file()
    {
        part.file.as_file().set_permissions(found.permissions())?;
    }
    part.write(bytes)?;
    sync_folder(&part.rename(&path, true)?);
    Ok(())
}

/// The folder of a file.
#[must_use]
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Removes temporary files whose process is gone.
pub fn remove_leftovers(folder: &Path) {
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
