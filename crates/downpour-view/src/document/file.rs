//! Files of documents: read, written in one piece, watched, recovered.

use std::fs;
use std::path::{Path, PathBuf};

use downpour::output_file::{folder_of, replace_file};
use downpour::scene::error::shown_path;
use downpour::weather::MAX_FILE;
use sha2::{Digest, Sha256};

use super::{Document, DocumentError};

/// Work that was not saved before the window ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovery {
    /// The recovery file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
}

impl Document {
    /// Opens a weather file, or makes a new document for a model (.glb, .gltf) with a shower over it.
    ///
    /// # Errors
    /// [`DocumentError::File`], [`DocumentError::Refused`].
    pub fn open(path: &Path) -> Result<Self, DocumentError> {
        let extension = path.extension().map(|end| end.to_string_lossy().to_lowercase());
        let folder = path.parent().unwrap_or(Path::new(""));
        let name = shown_path(path);
        match extension.as_deref() {
            Some("toml") => {
                let bytes = read(path)?;
                let text = str::from_utf8(&bytes).map_err(|error| {
                    let at = error.valid_up_to();
                    DocumentError::Refused(format!("{name}: byte {at} is not UTF-8; allowed: text in UTF-8"))
                })?;
                let mut document = Self::from_text(&name, text, folder).map_err(newer)?;
                document.path = Some(path.to_owned());
                document.saved = Some(document.text());
                document.digest = Some(digest(&bytes));
                Ok(document)
            }
            Some("glb" | "gltf") => {
                read(path)?;
                let file = path.file_name().unwrap_or_default().to_string_lossy();
                let text = format!(
                    "# A model in a shower.\n\n[rain]\nrate_mm_h = 50\n\n[sky]\nzenith_color = [0.3, 0.33, 0.38]\n\n\
                     [camera]\nshutter_s = 0.004\n\n\
                     [[model]]\nfile = {}\n",
                    toml_edit::Value::from(file.as_ref())
                );
                Self::from_text(&name, &text, folder)
            }
            _ => {
                let allowed = "a weather file (.toml) or a model (.glb, .gltf)";
                Err(DocumentError::Refused(format!("input {name}; allowed: {allowed}")))
            }
        }
    }

    /// Writes the file in one piece.
    ///
    /// # Errors
    /// [`DocumentError::NoFile`], [`DocumentError::ChangedOnDisk`], [`DocumentError::File`].
    pub fn save(&mut self) -> Result<(), DocumentError> {
        let path = self.path.clone().ok_or(DocumentError::NoFile)?;
        if self.is_changed_on_disk() {
            return Err(DocumentError::ChangedOnDisk { path: shown_path(&path) });
        }
        self.write(&path)
    }

    /// Writes the file over what another program has left there.
    ///
    /// # Errors
    /// [`DocumentError::NoFile`], [`DocumentError::File`].
    pub fn save_over(&mut self) -> Result<(), DocumentError> {
        let path = self.path.clone().ok_or(DocumentError::NoFile)?;
        self.write(&path)
    }

    /// Writes the text to another file of the same folder, which is the document's from then on.
    ///
    /// # Errors
    /// [`DocumentError::Refused`] for a name that does not end with .toml, or a folder in which the files of the weather are not;
    /// [`DocumentError::File`].
    pub fn save_as(&mut self, path: &Path) -> Result<(), DocumentError> {
        if path.extension().is_none_or(|end| !end.eq_ignore_ascii_case("toml")) {
            let name = shown_path(path);
            return Err(DocumentError::Refused(format!("{name}; allowed: a weather file (.toml)")));
        }
        let place = self.place();
        let (own, other) = (folder_of(&place), folder_of(path));
        let weather = self.weather();
        let names_files = !weather.models.is_empty() || self.names_a_file();
        if names_files && fs::canonicalize(own).ok() != fs::canonicalize(other).ok() {
            return Err(DocumentError::Refused(format!(
                "{}: the files of the weather are in {}; allowed: the same folder",
                shown_path(path),
                shown_path(own)
            )));
        }
        let before = self.recovery_path();
        self.write(path)?;
        self.path = Some(path.to_owned());
        self.folder = other.to_owned();
        if before != self.recovery_path() {
            let _ = fs::remove_file(before);
        }
        Ok(())
    }

    fn names_a_file(&self) -> bool {
        let sky = matches!(self.weather().sky.source, downpour::weather::SkySource::File { .. });
        sky || self.weather().drop_model.is_some() || self.text().contains("mask = ")
    }

    fn write(&mut self, path: &Path) -> Result<(), DocumentError> {
        if fs::symlink_metadata(path).is_ok_and(|meta| meta.file_type().is_symlink()) {
            let (path, reason) = (shown_path(path), "a symbolic link is not replaced".to_owned());
            return Err(DocumentError::File { path, reason });
        }
        let text = self.text();
        write_whole(path, text.as_bytes())?;
        self.digest = Some(digest(text.as_bytes()));
        self.saved = Some(text);
        self.recovered = self.revision;
        let _ = fs::remove_file(self.recovery_path());
        Ok(())
    }

    /// True if another program has changed or deleted the file since it was read or written here.
    #[must_use]
    pub fn is_changed_on_disk(&self) -> bool {
        let (Some(path), Some(known)) = (&self.path, self.digest) else { return false };
        read(path).map_or(true, |bytes| digest(&bytes) != known)
    }

    /// Takes what is on disk, as one step of the history.
    ///
    /// # Errors
    /// [`DocumentError::File`], [`DocumentError::Refused`]: the document stays as it is.
    pub fn reload(&mut self) -> Result<(), DocumentError> {
        let path = self.path.clone().ok_or(DocumentError::NoFile)?;
        let other = Self::open(&path)?;
        self.replace_text("reload", &other.text())?;
        self.saved = other.saved;
        self.digest = other.digest;
        Ok(())
    }

    /// Takes note of what is on disk, so that the next save replaces it.
    pub fn keep_mine(&mut self) {
        let bytes = self.path.as_deref().and_then(|path| read(path).ok());
        self.digest = bytes.as_deref().map(digest);
        self.saved = bytes.and_then(|bytes| String::from_utf8(bytes).ok());
    }

    /// File beside the weather in which changes wait that were not saved.
    #[must_use]
    pub fn recovery_path(&self) -> PathBuf {
        let place = self.place();
        let name = place.file_name().unwrap_or_default().to_string_lossy().into_owned();
        place.with_file_name(format!(".{name}.recovery"))
    }

    /// Writes the changes to the recovery file, if there are new ones.
    ///
    /// # Errors
    /// [`DocumentError::File`].
    pub fn autosave(&mut self) -> Result<(), DocumentError> {
        if self.recovered == self.revision {
            return Ok(());
        }
        self.recovered = self.revision;
        if self.is_dirty() {
            return write_whole(&self.recovery_path(), self.text().as_bytes());
        }
        let _ = fs::remove_file(self.recovery_path());
        Ok(())
    }

    /// Changes that an earlier window did not save, if there are any.
    #[must_use]
    pub fn recovery(&self) -> Option<Recovery> {
        let path = self.recovery_path();
        let text = String::from_utf8(read(&path).ok()?).ok()?;
        (text != self.text()).then_some(Recovery { path, text })
    }

    /// Takes the changes of an earlier window, as one step of the history.
    ///
    /// # Errors
    /// [`DocumentError::Refused`].
    pub fn recover(&mut self, recovery: &Recovery) -> Result<(), DocumentError> {
        self.replace_text("recover", &recovery.text)
    }

    /// Drops the recovery file.
    pub fn discard_recovery(&mut self) {
        self.recovered = self.revision;
        let _ = fs::remove_file(self.recovery_path());
    }
}

/// Adds to an unknown key that the file may be newer than this program.
fn newer(error: DocumentError) -> DocumentError {
    match error {
        DocumentError::Refused(message) if message.contains("unknown key") => {
            let version = env!("CARGO_PKG_VERSION");
            DocumentError::Refused(format!(
                "{message}; this is Downpour {version}: a file of a newer version may have keys that it does not know"
            ))
        }
        error => error,
    }
}

fn failed(path: &Path, error: &std::io::Error) -> DocumentError {
    DocumentError::File { path: shown_path(path), reason: error.to_string() }
}

/// Bytes of a regular file that is not longer than a weather file may be.
fn read(path: &Path) -> Result<Vec<u8>, DocumentError> {
    let meta = fs::metadata(path).map_err(|error| failed(path, &error))?;
    let refused = |found: String| DocumentError::File { path: shown_path(path), reason: found };
    if !meta.is_file() {
        return Err(refused("not a regular file".to_owned()));
    }
    let is_model = path.extension().is_some_and(|end| !end.eq_ignore_ascii_case("toml") && end != "recovery");
    if is_model {
        return Ok(Vec::new());
    }
    if meta.len() > MAX_FILE {
        return Err(refused(format!("a file of {} bytes; allowed: at most {MAX_FILE} bytes", meta.len())));
    }
    fs::read(path).map_err(|error| failed(path, &error))
}

/// Writes pixels, rows from the top, as a PNG in one piece.
pub(crate) fn write_picture(
    path: &Path,
    [width, height]: [u32; 2],
    pixels: &[[u8; 3]],
) -> Result<(), String> {
    let png = downpour::render::file::write_png(width, height, pixels).map_err(|error| error.to_string())?;
    write_whole(path, &png).map_err(|error| error.to_string())
}

/// Writes a file: all of its bytes, or nothing.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), DocumentError> {
    replace_file(path, bytes).map_err(|error| failed(path, &error))
}

fn digest(bytes: &[u8]) -> [u8; 32] {
    Sha256::digest(bytes).into()
}
