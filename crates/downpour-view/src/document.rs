//! The weather file that is edited: its text, what it means, its history, its file on disk.

mod edit;
mod error;
mod file;
mod history;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use downpour::weather::Weather;
use toml_edit::DocumentMut;

pub use error::DocumentError;
pub use file::Recovery;
pub(crate) use file::{write_picture, write_whole};
use history::{History, State};

use crate::key_path::KeyPath;
use crate::plain::Plain;

/// A weather file in memory. Whatever is edited, its text is one that the parser takes.
#[derive(Clone, Debug)]
pub struct Document {
    /// Name in messages.
    name: String,
    path: Option<PathBuf>,
    /// Folder whose files the weather names.
    folder: PathBuf,
    text: DocumentMut,
    plain: Plain,
    weather: Arc<Weather>,
    history: History,
    /// Text of the file, as it was read or written last.
    saved: Option<String>,
    /// Digest of the bytes on disk at that time.
    digest: Option<[u8; 32]>,
    /// Counts the changes of the text.
    revision: u64,
    /// Revision that was written to the recovery file.
    recovered: u64,
}

impl Document {
    /// A document of a text, without a file; `folder` has the files that it names.
    ///
    /// # Errors
    /// [`DocumentError::Refused`].
    pub fn from_text(name: &str, text: &str, folder: &Path) -> Result<Self, DocumentError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let (document, weather) = parsed(name, text)?;
        Ok(Self {
            name: name.to_owned(),
            path: None,
            folder: folder.to_owned(),
            plain: Plain::of_table(document.as_table()),
            text: document,
            weather: Arc::new(weather),
            history: History::default(),
            saved: None,
            digest: None,
            revision: 0,
            recovered: 0,
        })
    }

    /// The weather.
    #[must_use]
    pub fn weather(&self) -> &Arc<Weather> {
        &self.weather
    }

    /// Text of the file.
    #[must_use]
    pub fn text(&self) -> String {
        self.text.to_string()
    }

    /// Counts the changes of the text.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The file, once there is one.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Path by which the files of the weather are found: its file, or one that it would have.
    #[must_use]
    pub fn place(&self) -> PathBuf {
        self.path.clone().unwrap_or_else(|| self.folder.join("untitled.toml"))
    }

    /// Name to show.
    #[must_use]
    pub fn title(&self) -> String {
        let name = self.path.as_deref().and_then(Path::file_name);
        name.map_or_else(|| self.name.clone(), |name| name.to_string_lossy().into_owned())
    }

    /// All values of the file, without those of its preset.
    #[must_use]
    pub fn plain(&self) -> &Plain {
        &self.plain
    }

    /// Value of a key, if the file gives it.
    #[must_use]
    pub fn get(&self, path: &KeyPath) -> Option<&Plain> {
        use crate::key_path::Step;
        path.steps().iter().try_fold(&self.plain, |at, step| match step {
            Step::Key(key) => at.get(key),
            Step::Entry(index) => at.list().get(*index),
        })
    }

    /// True if there are changes that no file has.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.saved.as_ref().is_none_or(|saved| *saved != self.text.to_string())
    }

    /// Sets a key. Edits of the same key that follow each other with the same `stroke` are one step of the history, as those of a drag.
    ///
    /// # Errors
    /// [`DocumentError::Refused`] if the parser does not take the text with it, [`DocumentError::Absent`]; nothing has changed then.
    pub fn set(&mut self, path: &KeyPath, value: &Plain, stroke: Option<u64>) -> Result<(), DocumentError> {
        self.change(&format!("set {path}"), stroke, |text| edit::set(text, path, value))
    }

    /// Sets several keys at once, or none.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn set_all(
        &mut self,
        label: &str,
        values: &[(KeyPath, Plain)],
        stroke: Option<u64>,
    ) -> Result<(), DocumentError> {
        self.change(label, stroke, |text| {
            values.iter().try_for_each(|(path, value)| edit::set(text, path, value))
        })
    }

    /// Removes a key: its default holds, or the value of the preset.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn remove(&mut self, path: &KeyPath) -> Result<(), DocumentError> {
        self.change(&format!("reset {path}"), None, |text| edit::remove(text, path))
    }

    /// Sets several keys and removes others that are there, at once, or nothing.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn set_and_remove(
        &mut self,
        label: &str,
        values: &[(KeyPath, Plain)],
        removed: &[KeyPath],
    ) -> Result<(), DocumentError> {
        let removed: Vec<&KeyPath> = removed.iter().filter(|path| self.get(path).is_some()).collect();
        self.change(label, None, |text| {
            removed.iter().try_for_each(|path| edit::remove(text, path))?;
            values.iter().try_for_each(|(path, value)| edit::set(text, path, value))
        })
    }

    /// Gives a table of the root these keys and no others.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn replace_table(&mut self, table: &str, entries: Vec<(String, Plain)>) -> Result<(), DocumentError> {
        let path = KeyPath::of(table);
        let old = self.get(&path).map(Plain::entries).unwrap_or_default();
        let removed: Vec<KeyPath> = old.iter().map(|(key, _)| path.key(key)).collect();
        let values: Vec<_> = entries.into_iter().map(|(key, value)| (path.key(&key), value)).collect();
        self.set_and_remove(&format!("set {table}"), &values, &removed)
    }

    /// Adds an entry to a list such as `wind`. Returns its index.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn add_entry(&mut self, list: &KeyPath, entry: &Plain) -> Result<usize, DocumentError> {
        let mut index = 0;
        self.change(&format!("add {list}"), None, |text| {
            index = edit::add_entry(text, list, entry)?;
            Ok(())
        })?;
        Ok(index)
    }

    /// Copies entries of a list, each behind itself. Returns the indices of the copies.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn duplicate_entries(
        &mut self,
        list: &KeyPath,
        entries: &[usize],
    ) -> Result<Vec<usize>, DocumentError> {
        let mut entries = entries.to_vec();
        entries.sort_unstable();
        let mut copies = Vec::new();
        self.change(&format!("duplicate {list}"), None, |text| {
            for (before, &index) in entries.iter().enumerate() {
                copies.push(edit::duplicate_entry(text, list, index + before)?);
            }
            Ok(())
        })?;
        Ok(copies)
    }

    /// Deletes entries of a list.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn remove_entries(&mut self, list: &KeyPath, entries: &[usize]) -> Result<(), DocumentError> {
        let mut entries = entries.to_vec();
        entries.sort_unstable();
        entries.dedup();
        self.change(&format!("delete {list}"), None, |text| {
            entries.iter().rev().try_for_each(|&index| edit::remove_entry(text, list, index))
        })
    }

    /// Name of an entry of a list: a comment `# name: ...` before it.
    #[must_use]
    pub fn entry_name(&self, list: &str, index: usize) -> Option<String> {
        edit::entry_name(&self.text, list, index)
    }

    /// Names an entry of a list.
    ///
    /// # Errors
    /// As [`Document::set`].
    pub fn set_entry_name(&mut self, list: &KeyPath, index: usize, name: &str) -> Result<(), DocumentError> {
        self.change(&format!("rename {list}"), None, |text| edit::set_entry_name(text, list, index, name))
    }

    /// Replaces the whole text, as one step of the history.
    ///
    /// # Errors
    /// [`DocumentError::Refused`].
    pub fn replace_text(&mut self, label: &str, text: &str) -> Result<(), DocumentError> {
        self.change(label, None, |document| {
            *document = text.parse().map_err(|error| refused(&error))?;
            Ok(())
        })
    }

    /// Edits the text, if the parser takes the result.
    fn change(
        &mut self,
        label: &str,
        stroke: Option<u64>,
        edit: impl FnOnce(&mut DocumentMut) -> Result<(), DocumentError>,
    ) -> Result<(), DocumentError> {
        let mut edited = self.text.clone();
        edit(&mut edited)?;
        let text = edited.to_string();
        let before = self.text.to_string();
        if text == before {
            return Ok(());
        }
        let weather =
            Weather::parse(&self.name, &text).map_err(|error| DocumentError::Refused(error.to_string()))?;
        self.history.push(label, stroke, State { text: before });
        self.take(edited, weather);
        Ok(())
    }

    fn take(&mut self, text: DocumentMut, weather: Weather) {
        self.plain = Plain::of_table(text.as_table());
        self.text = text;
        self.weather = Arc::new(weather);
        self.revision += 1;
    }

    /// Takes back the last step. Returns its label, or `None` if there is none.
    pub fn undo(&mut self) -> Option<String> {
        let (label, state) = self.history.undo(State { text: self.text.to_string() })?;
        self.restore(&state);
        Some(label)
    }

    /// Does again what was taken back last. Returns its label, or `None` if there is nothing.
    pub fn redo(&mut self) -> Option<String> {
        let (label, state) = self.history.redo(State { text: self.text.to_string() })?;
        self.restore(&state);
        Some(label)
    }

    /// Label of the step that undo would take back.
    #[must_use]
    pub fn undo_label(&self) -> Option<&str> {
        self.history.undo_label()
    }

    /// Label of the step that redo would do again.
    #[must_use]
    pub fn redo_label(&self) -> Option<&str> {
        self.history.redo_label()
    }

    /// Takes a text that was parsed before.
    fn restore(&mut self, state: &State) {
        if let Ok((text, weather)) = parsed(&self.name, &state.text) {
            self.take(text, weather);
        }
    }
}

fn parsed(name: &str, text: &str) -> Result<(DocumentMut, Weather), DocumentError> {
    let weather = Weather::parse(name, text).map_err(|error| DocumentError::Refused(error.to_string()))?;
    // The parser of weather files has taken it: this one keeps its form.
    let document = text.parse().map_err(|error| refused(&error))?;
    Ok((document, weather))
}

fn refused(error: &toml_edit::TomlError) -> DocumentError {
    DocumentError::Refused(error.message().to_owned())
}

#[cfg(test)]
mod tests;
