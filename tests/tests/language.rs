//! Identifiers use the standard terms: words that were replaced do not come back.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Identifiers that were replaced, and the standard term. `under` is the folder in which the term is taken.
const REPLACED: [(&str, &str, &str); 10] = [
    ("Stage", "", "FrameScene"),
    ("StageError", "", "FrameSceneError"),
    ("DropsDrop", "", "ScreenDrop"),
    ("Look", "crates/downpour-render", "PaneTracer"),
    ("Through", "", "PaneView, TransmittedRay"),
    ("surroundings", "crates", "environment"),
    ("Surroundings", "crates", "environment"),
    ("gather", "crates/downpour-trace", "filter, denoise, or the name of what is found"),
    ("glass_picture_round", "", "glass_picture_environment"),
    ("glass_picture_round_texel", "", "glass_picture_environment_texel"),
];

/// Words that bounds are not called by: they begin with `MIN_` or `MAX_`, behind the stem of their file.
const BOUNDS: [&str; 7] = ["LONGEST", "SHORTEST", "LEAST", "LARGEST", "SMALLEST", "GREATEST", "MOST"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Identifiers of a text without its comments and strings of one line.
fn identifiers(text: &str) -> BTreeSet<&str> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    let outside = code.flat_map(|line| line.split('"').step_by(2));
    let names = outside.flat_map(|part| part.split(move |c| !is_name(c)));
    names.filter(|name| name.starts_with(|c: char| c.is_alphabetic() || c == '_')).collect()
}

/// All Rust and WGSL files of a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if !path.ends_with("target") {
                files(&path, found);
            }
        } else if path.extension().is_some_and(|end| end == "rs" || end == "wgsl") {
            found.push(path);
        }
    }
}

/// Replaced words among the identifiers of a file at a path from the root.
fn wrong(path: &str, text: &str) -> Vec<String> {
    let of_bound = |name: &&str| {
        name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_')
            && name.split('_').any(|word| BOUNDS.contains(&word))
    };
    let replaced = |name: &str| {
        let is_it = |(word, under, _): &&(&str, &str, &str)| *word == name && path.starts_with(under);
        REPLACED.iter().find(is_it).map(|(_, _, term)| *term)
    };
    let names = identifiers(text);
    let bounds = names.iter().filter(|name| of_bound(name));
    let bounds = bounds.map(|name| format!("{path}: {name}; the standard words are MIN and MAX"));
    let words = names.iter().filter_map(|name| Some(format!("{path}: {name}; now {}", replaced(name)?)));
    bounds.chain(words).collect()
}

#[test]
fn replaced_words_do_not_come_back() {
    let mut found = Vec::new();
    for folder in ["crates", "shaders", "tests", "xtask"] {
        files(&root().join(folder), &mut found);
    }
    assert!(found.len() > 500, "{} files", found.len());
    let mut all = Vec::new();
    for path in found {
        let text = fs::read_to_string(&path).unwrap();
        let path = path.strip_prefix(root()).unwrap().to_string_lossy().replace('\\', "/");
        if !path.ends_with("tests/language.rs") {
            all.extend(wrong(&path, &text));
        }
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
}

#[test]
fn a_replaced_word_is_found() {
    let path = "crates/downpour-render/src/a.rs";
    for text in
        ["const MOST_DROPS: u32 = 1;", "const WET_LEAST: f32 = 1.0;", "struct Look;", "x.surroundings()"]
    {
        assert_eq!(wrong(path, text).len(), 1, "{text}");
    }
    for text in
        ["// the MOST_DROPS of all", "let look = \"Stage\";", "const ALMOST: u32 = 1;", "struct Lookup;"]
    {
        assert!(wrong(path, text).is_empty(), "{text}");
    }
}
