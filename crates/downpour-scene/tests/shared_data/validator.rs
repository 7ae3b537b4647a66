//! The test files of the Khronos glTF validator, as they are and with the data that most of them lack.
//!
//! Nothing panics; an error of the validator is an error or a warning here too, if it concerns data that
//! is read; and a file that it calls valid is read.

use crate::document::{check, check_message, check_scene, data_uri};
use crate::exit_code::ExitCode as _;
use crate::folder;
use downpour_scene::gltf::{read_scene, read_triangles};
use downpour_scene::{Budget, WarningKind};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// Errors of the validator that do not concern triangles, with reasons.
const OTHER_CONCERNS: [(&str, &str); 12] = [
    ("ACCESSOR_INVALID_FLOAT", "an accessor that no mesh uses is not read"),
    ("ACCESSOR_MIN_MISMATCH", "bounds are made from the data, never taken from the file"),
    ("ACCESSOR_MAX_MISMATCH", "bounds are made from the data"),
    ("ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", "bounds are made from the data"),
    ("ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", "bounds are made from the data"),
    ("MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", "bounds are made from the data"),
    ("BUFFER_VIEW_TARGET_OVERRIDE", "targets are hints for graphics interfaces"),
    ("IMAGE_DATA_INVALID", "images are not opened"),
    ("IMAGE_UNEXPECTED_EOS", "images are not opened"),
    ("IMAGE_MIME_TYPE_INVALID", "images are not opened"),
    ("IO_ERROR", "images are not opened"),
    ("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "materials are not read"),
];

/// Files without errors that are not read, with reasons.
const NOT_READ: [(&str, &str); 3] = [
    ("accessor/unknown_type.gltf", "an accessor of unknown size cannot be checked"),
    ("buffer/non_relative_uri.gltf", "nothing is fetched from elsewhere"),
    ("buffer/data_uri.glb", "data that is not base64"),
];

/// Outcome of a file: an exit code, or 0 and whether there is a warning of more than emptiness.
fn outcome(path: &Path) -> (u8, bool, String) {
    match read_triangles(path, &mut Budget::default()) {
        Ok(model) => {
            check(&model);
            let lines: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
            lines.iter().for_each(|line| check_message(line));
            (0, model.warnings.iter().any(|warning| warning.kind != WarningKind::Empty), lines.join("; "))
        }
        Err(error) => {
            check_message(&error.to_string());
            (error.exit_code(), true, error.to_string())
        }
    }
}

/// Adds zeros of the declared length to each buffer without data. `None` if all have data.
fn filled(path: &Path) -> Option<Value> {
    let mut document: Value = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
    let mut changed = false;
    for buffer in document.get_mut("buffers")?.as_array_mut()? {
        let length = buffer.get("byteLength").and_then(Value::as_u64);
        if let (Some(length), None) = (length, buffer.get("uri")) {
            buffer["uri"] = json!(data_uri(&vec![0; length as usize]));
            changed = true;
        }
    }
    changed.then_some(document)
}

/// A file with the validator's verdict.
struct Judged {
    name: String,
    path: PathBuf,
    errors: u64,
    codes: Vec<String>,
}

/// All files of the validator that have a report beside them.
fn judged() -> Vec<Judged> {
    let root = folder("gltf_invalid/validator");
    let mut found = Vec::new();
    for group in fs::read_dir(&root).expect("the validator's files") {
        let group = group.expect("readable").path();
        for entry in fs::read_dir(&group).into_iter().flatten() {
            let report = entry.expect("readable").path();
            let Some(name) = report.to_str().and_then(|text| text.strip_suffix(".report.json")) else {
                continue;
            };
            let said: Value = serde_json::from_slice(&fs::read(&report).expect("a report")).expect("JSON");
            let messages = said["issues"]["messages"].as_array().cloned().unwrap_or_default();
            let is_error = |message: &&Value| message["severity"] == 0;
            found.push(Judged {
                name: name
                    .rsplit('/')
                    .take(2)
                    .collect::<Vec<_>>()
                    .into_iter()
                    .rev()
                    .collect::<Vec<_>>()
                    .join("/"),
                path: PathBuf::from(name),
                errors: said["issues"]["numErrors"].as_u64().expect("a number of errors"),
                codes: messages
                    .iter()
                    .filter(is_error)
                    .filter_map(|message| message["code"].as_str().map(str::to_owned))
                    .collect(),
            });
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    found
}

pub(crate) fn files() {
    let made = tempfile::tempdir().expect("a folder");
    let (mut count, mut fillings, mut wrong) = (0, 0, Vec::new());
    for Judged { name, path, errors, codes } in judged() {
        count += 1;
        let mut outcome = outcome(&path);
        if let Some(document) = filled(&path) {
            fillings += 1;
            assert_eq!(outcome.0, 2, "{name}: a buffer without data was read");
            let path = made.path().join("filled.gltf");
            fs::write(&path, document.to_string()).expect("a file can be made");
            outcome = self::outcome(&path);
        }
        let (code, speaks, said) = outcome;
        if errors == 0 {
            let known = NOT_READ.iter().any(|(file, _)| *file == name) || said.contains("no binary chunk");
            if code != 0 && !known {
                wrong.push(format!("{name}: valid, but {said}"));
            }
        } else if !speaks && !codes.iter().all(|code| OTHER_CONCERNS.iter().any(|(other, _)| other == code)) {
            wrong.push(format!("{name}: {codes:?}, but only {code} {said:?}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(count > 150 && fillings > 10, "{count} files, {fillings} filled");
}

/// Whole scenes: nothing panics, and of the files without errors all are read whose data and images exist.
pub(crate) fn files_as_scenes() {
    let (mut read, mut wrong) = (0, Vec::new());
    for Judged { name, path, errors, .. } in judged() {
        match read_scene(&path, &mut Budget::default()) {
            Ok(scene) => {
                check_scene(&scene);
                scene.warnings.iter().for_each(|warning| check_message(&warning.to_string()));
                read += 1;
            }
            Err(error) => {
                let said = error.to_string();
                check_message(&said);
                let known =
                    NOT_READ.iter().any(|(file, _)| *file == name) || said.contains("no binary chunk");
                if errors == 0 && !known {
                    wrong.push(format!("{name}: valid, but {said}"));
                }
            }
        }
    }
    assert!(wrong.is_empty() && read > 30, "{read} read:\n{}", wrong.join("\n"));
}
