//! Each bad input has its exit code and its message: rows G and B of the reliability plan. All are derived from one valid
//! triangle.

mod accessors;
mod buffers;
#[path = "../document/mod.rs"]
mod document;
#[path = "../exit_code/mod.rs"]
mod exit_code;
mod tree;

use document::{check, check_message, data_uri, floats, spoiled, triangle, triangle_of};
use downpour_scene::{Budget, WarningKind, gltf::read_triangles};
use exit_code::ExitCode as _;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// One bad input.
struct Row {
    id: &'static str,
    bytes: Vec<u8>,
    /// 0: the file is read, and the text is in a warning.
    code: u8,
    words: &'static str,
}

fn made(id: &'static str, bytes: Vec<u8>, code: u8, words: &'static str) -> Row {
    Row { id, bytes, code, words }
}

fn doc(id: &'static str, changes: &[(&str, Value)], code: u8, words: &'static str) -> Row {
    made(id, spoiled(changes).to_string().into_bytes(), code, words)
}

fn uri(id: &'static str, uri: &str, words: &'static str) -> Row {
    doc(id, &[("/buffers/0/uri", json!(uri))], 2, words)
}

/// The triangle with its text changed: for numbers that a JSON value does not hold.
fn text(id: &'static str, from: &str, to: &str, code: u8, words: &'static str) -> Row {
    let plain = triangle().to_string();
    assert!(plain.contains(from), "{from}");
    made(id, plain.replacen(from, to, 1).into_bytes(), code, words)
}

fn rows() -> Vec<Row> {
    let tables = [
        buffers::addresses(),
        buffers::ranges(),
        buffers::containers(),
        accessors::formats(),
        accessors::contents(),
        accessors::sparse(),
        tree::nodes(),
        tree::rest(),
    ];
    tables.into_iter().flatten().collect()
}

fn judge(row: &Row, path: &Path) -> Result<(), String> {
    let result = read_triangles(path, &mut Budget::default());
    let (code, said) = match &result {
        Ok(model) => {
            check(model);
            (0, model.warnings.iter().map(ToString::to_string).collect::<Vec<_>>())
        }
        Err(error) => {
            let name = path.file_name().expect("a file has a name").to_string_lossy();
            assert!(error.to_string().contains(&*name), "{error}");
            (error.exit_code(), vec![error.to_string()])
        }
    };
    said.iter().for_each(|line| check_message(line));
    let silent = row.words.is_empty() && said.is_empty();
    if code == row.code
        && (silent || said.iter().any(|line| !row.words.is_empty() && line.contains(row.words)))
    {
        return Ok(());
    }
    Err(format!("{} {}: wanted {} {:?}, got {code} {said:?}", row.id, path.display(), row.code, row.words))
}

#[test]
fn each_bad_input_has_its_code_and_its_words() {
    let folder = tempfile::tempdir().expect("a folder for made files");
    let mut wrong = Vec::new();
    for (number, row) in rows().iter().enumerate() {
        let path = folder.path().join(format!("made_{number}.gltf"));
        fs::write(&path, &row.bytes).expect("a file can be made");
        wrong.extend(judge(row, &path).err());
    }
    assert!(wrong.is_empty(), "{} rows:\n{}", wrong.len(), wrong.join("\n"));
}

/// The table is complete: each row of the plan. G7 and G9 are in `opening.rs`.
#[test]
fn nothing_is_left_out() {
    let rows = rows();
    let ids: BTreeSet<&str> = rows.iter().map(|row| row.id).collect();
    let plan = (1..=35).map(|n| format!("G{n}")).chain((1..=5).map(|n| format!("B{n}")));
    let missing: Vec<String> =
        plan.filter(|id| !ids.contains(id.as_str()) && id != "G7" && id != "G9").collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// Strict reading names the part that was lost.
#[test]
fn strict_refuses_what_was_dropped() {
    let scale = [("/nodes/0/scale", json!([0, 0, 0]))];
    let error = document::read(&spoiled(&scale)).expect("a warning").strict().expect_err("a loss");
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().starts_with("test: nodes[0]: dropped"), "{error}");
    let empty = document::read(&json!({"asset": {"version": "2.0"}})).expect("a warning");
    assert!(empty.is_empty() && empty.warnings[0].kind == WarningKind::Empty);
    assert_eq!(
        empty.strict().expect_err("nothing there").to_string(),
        "test: no triangles; allowed: a file of which all geometry is of use"
    );
    document::read(&triangle()).expect("valid").strict().expect("nothing lost");
}

/// Data that decodes to more than the buffer needs is cut there.
#[test]
fn longer_data_is_cut() {
    let bytes = [floats(&[0.0; 20]), vec![7; 100]].concat();
    let document = document::with(triangle_of(&bytes), &[("/buffers/0/byteLength", json!(80))]);
    assert!(document["buffers"][0]["uri"] == json!(data_uri(&bytes)));
    document::read(&document).expect("the rest is not looked at");
}
