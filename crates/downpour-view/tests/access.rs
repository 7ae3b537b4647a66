//! The window as a keyboard and a screen reader meet it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour::Backend;
use downpour_view::app::{App, AppOptions, Dialog};
use downpour_view::document::Document;
use downpour_view::engine::DeviceChoice;
use downpour_view::objects::ObjectId;
use downpour_view::theme;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use tempfile::TempDir;

const TEXT: &str = "\
# By hand.
[rain]
rate_mm_h = 20

[camera]
position_m = [0, 2, 8]
look_at_m = [0, 1, 0]

[[wind]]
vortex = { strength_m2_s = 40, center_m = [0, 1, 0], core_m = 2 }

[output]
size = [320, 180]
";

/// A window on a text that is in no file; what it may write for recovery is in `folder`.
fn window(folder: &TempDir, text: &str) -> Harness<'static, App> {
    let document = Document::from_text("test.toml", text, folder.path()).unwrap();
    let device = DeviceChoice { backend: Backend::Cpu, adapter: None };
    let app = App::new(document, AppOptions { device, scale: Some(0.1), ..AppOptions::default() }).unwrap();
    let mut harness = Harness::builder()
        .with_size(egui::vec2(1200.0, 800.0))
        .with_max_steps(3)
        .with_context_setup(theme::apply)
        .build_ui_state(|ui, app: &mut App| app.frame(ui), app);
    harness.run_steps(3);
    harness
}

/// With the tab key alone the focus comes to menus, panels and the timeline.
#[test]
fn the_tab_key_reaches_every_part() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window(&folder, TEXT);
    let mut reached = std::collections::BTreeSet::new();
    for _ in 0..80 {
        harness.key_press(Key::Tab);
        harness.run_steps(2);
        let focused = harness.root().children_recursive().find(egui_kittest::Node::is_focused);
        let label = focused.and_then(|node| node.accesskit_node().label());
        reached.extend(label);
    }
    for name in ["File", "Help", "Wind slice", "Add", "vortex 1", "play", "time", "Rain"] {
        assert!(reached.contains(name), "{name} is not reached: {reached:?}");
    }
}

/// Whatever takes the focus has a name to be read aloud.
#[test]
fn every_control_has_a_name() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window(&folder, TEXT);
    harness.state_mut().select([ObjectId { list: "wind", index: 0 }]);
    harness.run_steps(3);
    let mut count = 0;
    for node in harness.root().children_recursive() {
        let inner = node.accesskit_node();
        let is_control = matches!(
            inner.role(),
            Role::Button | Role::CheckBox | Role::SpinButton | Role::ComboBox | Role::Slider
        );
        if is_control {
            count += 1;
            let has_name = inner.label().is_some_and(|label| !label.is_empty());
            assert!(has_name, "a {:?} without a name at {:?}", inner.role(), node.rect());
        }
    }
    assert!(count > 25, "{count}");
}

/// A number that is typed changes the file and nothing else of it; undo brings the old one back.
#[test]
fn a_number_is_typed_into_the_panel() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window(&folder, TEXT);
    harness.state_mut().select([ObjectId { list: "wind", index: 0 }]);
    harness.run_steps(3);
    harness.get_by_label("wind[0].vortex.strength_m2_s").set_value_accesskit(75.0);
    harness.run_steps(3);
    let expected = TEXT.replace("strength_m2_s = 40", "strength_m2_s = 75");
    assert_eq!(harness.state().document().text(), expected);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().document().text(), TEXT);
}

/// What the parser refuses is said in its words, and the last good weather stays.
#[test]
fn an_edit_that_is_refused_is_explained() {
    let text = TEXT.replace("[rain]\n", "[rain]\nvolume = \"closed-form\"\n").replace(
        "vortex = { strength_m2_s = 40, center_m = [0, 1, 0], core_m = 2 }",
        "uniform = { speed_m_s = 3, towards_deg = 0 }",
    );
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window(&folder, &text);
    let path = downpour_view::key_path::KeyPath::parse("camera.near_m").unwrap();
    let far = downpour_view::plain::Plain::Number(9000.0);
    let error = harness.state_mut().set(&path, far).unwrap_err().to_string();
    assert!(error.contains("near_m") && error.contains("allowed"), "{error}");
    assert_eq!(harness.state().document().text(), text);
}

/// The shortcuts are listed under F1, and Escape closes the list.
#[test]
fn the_help_lists_the_shortcuts() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window(&folder, TEXT);
    harness.key_press(Key::F1);
    harness.run_steps(3);
    assert_eq!(harness.state().dialog(), Some(&Dialog::Help));
    assert!(harness.query_by_label("Duplicate").is_some());
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert_eq!(harness.state().dialog(), None);
}

/// A window with changes asks before it closes; without changes it does not.
#[test]
fn unsaved_changes_are_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window(&folder, TEXT);
    assert!(harness.state_mut().may_close());
    harness.state_mut().add("tornado", None).unwrap();
    assert!(!harness.state_mut().may_close());
    harness.run_steps(3);
    assert!(harness.query_by_label("Discard").is_some() && harness.query_by_label("Cancel").is_some());
    harness.get_by_label("Cancel").click();
    harness.run_steps(3);
    assert_eq!(harness.state().dialog(), None);
}

/// A file is chosen by the keyboard: from the list of the folder, or by its name. What is not a file of its kind is refused in the dialog.
#[test]
fn files_are_opened_from_a_dialog() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("other.toml"), TEXT.replace("20", "30")).unwrap();
    std::fs::write(folder.path().join("notes.txt"), "no weather").unwrap();
    std::fs::write(folder.path().join("broken.toml"), "[rain]\nrate = 3\n").unwrap();
    std::fs::create_dir(folder.path().join("clips")).unwrap();
    let mut harness = window(&folder, TEXT);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    harness.run_steps(3);
    assert!(harness.query_by_label("other.toml").is_some() && harness.query_by_label("clips/").is_some());
    assert!(harness.query_by_label("notes.txt").is_none());
    // The field has the focus: a name and Enter. What is refused is explained there.
    harness.event(egui::Event::Text("broken.toml".to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert!(harness.state().dialog().is_some());
    assert!(
        harness.state().message().is_some_and(|(text, is_error)| *is_error && text.contains("broken.toml"))
    );
    harness.get_by_label("other.toml").click();
    harness.run_steps(3);
    harness.get_by_label("Open").click();
    harness.run_steps(3);
    assert_eq!(harness.state().dialog(), None);
    assert_eq!(harness.state().document().title(), "other.toml");
}

/// Another file is replaced only after a question; the own name is saved as it is.
#[test]
fn a_file_that_exists_is_replaced_only_when_told_twice() {
    let folder = tempfile::tempdir().unwrap();
    let other = folder.path().join("other.toml");
    std::fs::write(&other, "# kept\n").unwrap();
    let mut harness = window(&folder, TEXT);
    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
    harness.run_steps(3);
    harness.get_by_label("other.toml").click();
    harness.run_steps(3);
    let press = |harness: &mut Harness<'static, App>, label: &str| {
        let buttons = harness.get_all_by_role_and_label(Role::Button, label);
        buttons.last().unwrap().click();
        harness.run_steps(3);
    };
    press(&mut harness, "Save");
    assert_eq!(std::fs::read_to_string(&other).unwrap(), "# kept\n");
    press(&mut harness, "Replace");
    assert_eq!(harness.state().dialog(), None);
    assert_eq!(std::fs::read_to_string(&other).unwrap(), TEXT);
    assert_eq!(harness.state().document().path(), Some(other.as_path()));
}

/// A model is taken into the weather from the dialog.
#[test]
fn models_and_skies_are_imported_from_a_dialog() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("house.glb"), "no model, but a name").unwrap();
    let mut harness = window(&folder, TEXT);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::I);
    harness.run_steps(3);
    harness.get_by_label("house.glb").click();
    harness.run_steps(3);
    harness.get_by_label("Import").click();
    harness.run_steps(3);
    assert_eq!(harness.state().dialog(), None);
    assert!(harness.state().document().text().contains("file = \"house.glb\""));
}
