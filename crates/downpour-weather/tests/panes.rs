//! Glass of the scene in a weather file: every key, and rejected values.

use downpour_scene::Budget;
use downpour_weather::{Roots, ScenePane, SceneRectangle, Weather, load};
use glam::DVec3;

#[track_caller]
fn says(text: &str, expected: &str) {
    let error = Weather::parse("w.toml", text).expect_err("a value that is not allowed").to_string();
    assert!(error.starts_with("w.toml: line ") && error.contains(expected), "{error}");
}

#[test]
fn every_key_is_read() {
    let text = "[[pane]]\nmaterial = \"glass\"\nheight_m = 2.5\nlargest_mm = 4\nseed = 3\n\
                [[pane]]\nposition_m = [1, 2, -3]\nsize_m = [2, 1.5]\nturn_deg = 90\ntilt_deg = 30";
    let panes = Weather::parse("w.toml", text).unwrap().panes;
    let first = ScenePane {
        material: Some("glass".to_owned()),
        rectangle: None,
        height_m: 2.5,
        largest_m: 0.004,
        seed: 3,
    };
    let rectangle = SceneRectangle {
        center: DVec3::new(1.0, 2.0, -3.0),
        size_m: [2.0, 1.5],
        turn: 90.0f64.to_radians(),
        tilt: 30.0f64.to_radians(),
    };
    let second =
        ScenePane { material: None, rectangle: Some(rectangle), height_m: 3.0, largest_m: 0.005, seed: 0 };
    assert_eq!(panes, [first, second]);
    // Toward +Z, half as high as it is far.
    let outward = rectangle.outward();
    assert!(outward.distance(DVec3::new(0.0, 0.5, 0.75f64.sqrt())) < 1.0e-12, "{outward}");
    assert!(Weather::parse("w.toml", "").unwrap().panes.is_empty());
}

#[test]
fn values_are_rejected() {
    says("[[pane]]\nsize_m = [1, 1]", "pane[0].size_m: without position_m; allowed: both, or none");
    says("[[pane]]\nposition_m = [1, 1, 1]", "pane[0].position_m: without size_m");
    says("[[pane]]\nturn_deg = 3", "pane[0].turn_deg: without a rectangle");
    says("[[pane]]\ntilt_deg = 3", "pane[0].tilt_deg: without a rectangle");
    let text = "[[pane]]\nposition_m = [1, 1, 1]\nsize_m = [1, 1]\nheight_m = 2";
    says(text, "pane[0].height_m: beside a rectangle");
    says("[[pane]]\nmaterial = \"\"", "pane[0].material: 0 bytes; allowed: a name of 1 to 256 bytes");
    says("[[pane]]\n[wetness]\nenabled = false", "pane: beside wetness.enabled = false");
    says("[[pane]]\nlargest_mm = 20", "allowed: 0.5 to 10 mm");
    says("[[pane]]\nheight_m = nan", "allowed: 0.1 to 100 m");
    says("[[pane]]\nglas = true", "unknown key \"glas\"");
    says(&"[[pane]]\n".repeat(17), "17 times [[pane]]; allowed: at most 16");
}

#[test]
fn a_material_that_no_model_has_is_an_error_with_those_that_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let model = r#"{"asset": {"version": "2.0"}, "materials": [{"name": "glass"}, {"name": "brick"}]}"#;
    std::fs::write(folder.path().join("a.gltf"), model).unwrap();
    let path = folder.path().join("w.toml");
    let of = |name: &str| {
        let text = format!("[[model]]\nfile = \"a.gltf\"\n[[pane]]\nmaterial = \"{name}\"");
        let weather = Weather::parse("w.toml", &text).unwrap();
        load(&weather, &Roots::open(&path, &[]).unwrap(), &mut Budget::default())
    };
    assert!(of("glass").is_ok(), "{:?}", of("glass").err());
    let error = of("window").unwrap_err().to_string();
    let expected = "w.toml: pane[0].material: \"window\", which no model has; allowed: \"brick\", \"glass\"";
    assert!(error.contains(expected), "{error}");
}
