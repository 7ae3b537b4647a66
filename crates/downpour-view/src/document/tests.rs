//! Documents: edits keep what they do not touch, and nothing is lost.

use super::*;
use std::fs;

const STORM: &str = "\
# A storm, by hand.
model = [
    # The houses.
    { file = \"a.glb\" },
    { file = \"b.glb\", translation_m = [1, 2, 3] }, # to the right
]

[rain]
rate_mm_h = 100 # heavy
seed = 49

# The first gust.
[[wind]]
uniform = { speed_m_s = 9, towards_deg = 80 }

[camera]
position_m = [0, 1.7, 5] # of the eye
look_at_m = [0, 2, 0]
";

fn storm() -> Document {
    Document::from_text("storm.toml", STORM, Path::new("")).unwrap()
}

fn path(text: &str) -> KeyPath {
    KeyPath::parse(text).unwrap()
}

#[test]
fn a_value_changes_and_nothing_else_does() {
    let mut document = storm();
    document.set(&path("rain.rate_mm_h"), &Plain::Number(12.5), None).unwrap();
    assert_eq!(document.text(), STORM.replace("rate_mm_h = 100", "rate_mm_h = 12.5"));
    assert_eq!(document.weather().rain.rate_mm_h, 12.5);
    document.set(&path("camera.position_m"), &Plain::of_numbers(&[0.0, 1.7, 8.0]), None).unwrap();
    document.set(&path("model[1].translation_m"), &Plain::of_numbers(&[1.0, 2.0, 4.0]), None).unwrap();
    let expected = STORM
        .replace("rate_mm_h = 100", "rate_mm_h = 12.5")
        .replace("[0, 1.7, 5]", "[0, 1.7, 8]")
        .replace("[1, 2, 3]", "[1, 2, 4]");
    assert_eq!(document.text(), expected);
    document.set(&path("wind[0].uniform.speed_m_s"), &Plain::Number(4.0), None).unwrap();
    assert_eq!(document.text(), expected.replace("speed_m_s = 9", "speed_m_s = 4"));
}

#[test]
fn keys_and_tables_are_added_and_removed() {
    let mut document = storm();
    document.set(&path("fog.visibility_m"), &Plain::Number(400.0), None).unwrap();
    assert!(document.text().ends_with("[fog]\nvisibility_m = 400\n"), "{}", document.text());
    document.set(&path("rain.temperature_c"), &Plain::Number(8.0), None).unwrap();
    assert!(document.text().contains("seed = 49\ntemperature_c = 8\n"));
    document.remove(&path("rain.temperature_c")).unwrap();
    document.remove(&path("fog")).unwrap();
    assert_eq!(document.text(), STORM);
    document.set(&path("preset"), &Plain::Text("storm".to_owned()), None).unwrap();
    assert_eq!(document.weather().models.len(), 2);
}

#[test]
fn what_the_parser_refuses_changes_nothing() {
    let mut document = storm();
    let error = document.set(&path("rain.rate_mm_h"), &Plain::Number(-3.0), None).unwrap_err();
    assert!(error.to_string().contains("rain.rate_mm_h"), "{error}");
    assert!(document.set(&path("rain.rate"), &Plain::Number(3.0), None).is_err());
    assert!(document.set(&path("wind[7].uniform.speed_m_s"), &Plain::Number(3.0), None).is_err());
    assert!(document.remove(&path("rain.nothing")).is_err());
    assert_eq!(document.text(), STORM);
    assert_eq!(document.undo(), None);
    assert_eq!(document.revision(), 0);
}

#[test]
fn entries_are_added_copied_named_and_deleted() {
    let mut document = storm();
    let vortex = Plain::Table(vec![(
        "vortex".to_owned(),
        Plain::Table(vec![("strength_m2_s".to_owned(), Plain::Number(40.0))]),
    )]);
    let wind = path("wind");
    assert_eq!(document.add_entry(&wind, &vortex), Ok(1));
    let added = "\n[[wind]]\nvortex = { strength_m2_s = 40 }\n";
    assert_eq!(document.text(), STORM.replace("\n[camera]", &format!("{added}\n[camera]")));
    assert_eq!(document.duplicate_entries(&wind, &[0, 1]), Ok(vec![1, 3]));
    assert_eq!(document.plain().get("wind").unwrap().list().len(), 4);
    assert_eq!(document.weather().wind.parts().len(), 4);
    let order: Vec<&str> =
        document.plain().get("wind").unwrap().list().iter().map(|e| e.entries()[0].0.as_str()).collect();
    assert_eq!(order, ["uniform", "uniform", "vortex", "vortex"]);
    let reread = Document::from_text("", &document.text(), Path::new("")).unwrap();
    assert_eq!(reread.plain().get("wind"), document.plain().get("wind"), "{}", document.text());
    document.set_entry_name(&wind, 2, "Square").unwrap();
    assert!(document.text().contains("# name: Square\n[[wind]]\nvortex"), "{}", document.text());
    assert_eq!(document.entry_name("wind", 2).as_deref(), Some("Square"));
    document.set_entry_name(&wind, 2, "Corner").unwrap();
    assert_eq!(document.entry_name("wind", 2).as_deref(), Some("Corner"));
    assert!(!document.text().contains("Square"));
    document.remove_entries(&wind, &[1, 2, 3]).unwrap();
    assert_eq!(document.text(), STORM);
    document.remove_entries(&wind, &[0]).unwrap();
    assert_eq!(document.plain().get("wind"), None);
    assert!(document.remove_entries(&wind, &[0]).is_err());
}

#[test]
fn entries_of_a_list_in_one_array_keep_their_lines() {
    let mut document = storm();
    let models = path("model");
    let added = Plain::Table(vec![("file".to_owned(), Plain::Text("c.glb".to_owned()))]);
    assert_eq!(document.add_entry(&models, &added), Ok(2));
    assert!(
        document.text().contains("# to the right\n    { file = \"c.glb\" }"),
        "a new entry begins a line: {}",
        document.text()
    );
    document.set_entry_name(&models, 0, "Houses").unwrap();
    assert_eq!(document.entry_name("model", 0).as_deref(), Some("Houses"));
    assert!(document.text().contains("    # The houses.\n    # name: Houses\n    { file = \"a.glb\" }"));
    document.set_entry_name(&models, 0, "").unwrap();
    document.remove_entries(&models, &[2]).unwrap();
    assert_eq!(document.text().replace(" ", ""), STORM.replace(" ", ""));
}

#[test]
fn undo_and_redo_go_through_everything() {
    let mut document = storm();
    let rate = path("rain.rate_mm_h");
    document.set(&rate, &Plain::Number(20.0), None).unwrap();
    for step in 1..=30 {
        document.set(&rate, &Plain::Number(20.0 + f64::from(step)), Some(7)).unwrap();
    }
    document.remove_entries(&path("wind"), &[0]).unwrap();
    let end = document.text();
    assert_eq!(document.undo().as_deref(), Some("delete wind"));
    assert_eq!(document.undo().as_deref(), Some("set rain.rate_mm_h"));
    assert_eq!(document.weather().rain.rate_mm_h, 20.0, "a drag is one step");
    assert_eq!(document.undo_label(), Some("set rain.rate_mm_h"));
    document.undo();
    assert_eq!(document.text(), STORM);
    assert_eq!(document.undo(), None);
    while document.redo().is_some() {}
    assert_eq!(document.text(), end);
    document.undo();
    document.set(&rate, &Plain::Number(3.0), None).unwrap();
    assert_eq!(document.redo(), None, "a new edit ends what was undone");
}

#[test]
fn files_are_saved_whole_and_changes_of_others_are_seen() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("storm.toml");
    fs::write(&file, STORM).unwrap();
    let mut document = Document::open(&file).unwrap();
    assert!(!document.is_dirty());
    document.set(&path("rain.rate_mm_h"), &Plain::Number(5.0), None).unwrap();
    assert!(document.is_dirty());
    document.save().unwrap();
    assert!(!document.is_dirty());
    assert_eq!(fs::read_to_string(&file).unwrap(), STORM.replace("= 100", "= 5"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left beside it");

    fs::write(&file, STORM.replace("= 100", "= 7")).unwrap();
    assert!(document.is_changed_on_disk());
    document.set(&path("rain.seed"), &Plain::Number(1.0), None).unwrap();
    assert!(matches!(document.save(), Err(DocumentError::ChangedOnDisk { .. })));
    assert!(fs::read_to_string(&file).unwrap().contains("= 7"), "theirs is there");
    let mut other = document.clone();
    other.reload().unwrap();
    assert_eq!((other.weather().rain.rate_mm_h, other.is_dirty()), (7.0, false));
    other.undo();
    assert_eq!(other.weather().rain.rate_mm_h, 5.0, "and mine comes back");
    document.keep_mine();
    document.save().unwrap();
    assert!(fs::read_to_string(&file).unwrap().contains("rate_mm_h = 5"));

    fs::remove_file(&file).unwrap();
    assert!(document.is_changed_on_disk());
    document.save_over().unwrap();
    assert!(file.exists());
}

#[test]
fn work_survives_a_kill() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("storm.toml");
    fs::write(&file, STORM).unwrap();
    let mut document = Document::open(&file).unwrap();
    document.autosave().unwrap();
    assert_eq!(document.recovery(), None, "nothing to recover of a file that was only looked at");
    document.set(&path("rain.rate_mm_h"), &Plain::Number(33.0), None).unwrap();
    document.autosave().unwrap();
    drop(document);
    let mut again = Document::open(&file).unwrap();
    let recovery = again.recovery().unwrap();
    again.recover(&recovery).unwrap();
    assert_eq!(again.weather().rain.rate_mm_h, 33.0);
    assert!(again.is_dirty());
    again.save().unwrap();
    assert_eq!(Document::open(&file).unwrap().recovery(), None);
    // A recovery file that is damaged is refused, and nothing of the file is lost.
    fs::write(again.recovery_path(), "rain = 3").unwrap();
    let recovery = again.recovery().unwrap();
    assert!(matches!(again.recover(&recovery), Err(DocumentError::Refused(_))));
    assert_eq!(again.weather().rain.rate_mm_h, 33.0);
}

#[test]
fn bad_files_say_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let file = folder.path().join(name);
        fs::write(&file, text).unwrap();
        file
    };
    let message = |file: &Path| Document::open(file).unwrap_err().to_string();
    let newer = message(&write("newer.toml", "[rain]\nhail = true\n"));
    assert!(newer.contains("unknown key \"hail\"") && newer.contains("newer version"), "{newer}");
    assert!(message(&write("a.txt", "")).contains("allowed: a weather file (.toml)"));
    assert!(message(&folder.path().join("none.toml")).contains("none.toml"));
    assert!(message(folder.path()).contains("allowed"));
    let long = write("long.toml", &"#".repeat(5 << 20));
    assert!(message(&long).contains("allowed: at most"));
}

#[test]
fn a_model_becomes_a_document_without_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("a \"car\".glb");
    fs::write(&model, "glTF").unwrap();
    let mut document = Document::open(&model).unwrap();
    assert_eq!(document.weather().models.len(), 1);
    assert!(document.is_dirty());
    assert_eq!(document.save(), Err(DocumentError::NoFile));
    let elsewhere = tempfile::tempdir().unwrap();
    assert!(document.save_as(&elsewhere.path().join("x.toml")).is_err(), "the model is not there");
    assert!(document.save_as(&folder.path().join("x.txt")).is_err());
    document.save_as(&folder.path().join("x.toml")).unwrap();
    assert_eq!(document.title(), "x.toml");
    assert!(!document.is_dirty());
}
