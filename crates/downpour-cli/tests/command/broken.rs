//! Broken files: those of the tests of `downpour-scene`, and, if present, those of other sources, in the folder in
//! `DOWNPOUR_DATA` or in `shared/data` beside the repository.

use std::fs;
use std::path::{Path, PathBuf};

use crate::document::broken;

/// Writes every made file into the folder: their paths, and those of others' files.
pub(crate) fn bad_inputs(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for file in broken::chosen().into_iter().chain(broken::others()) {
        let path = folder.join(&file.name);
        fs::write(&path, &file.bytes).unwrap();
        found.push(path);
    }
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    let data = std::env::var_os("DOWNPOUR_DATA").map_or_else(beside, PathBuf::from).join("bad_inputs");
    match fs::read_dir(&data) {
        Ok(entries) => found.extend(entries.map(|entry| entry.unwrap().path())),
        Err(_) => println!("no folder {}: only files that the tests make", data.display()),
    }
    found.sort();
    found
}
