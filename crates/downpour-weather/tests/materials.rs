//! `[[material]]`: overrides of the materials of the models.

#![expect(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;

use downpour_scene::{Budget, SceneError};
use downpour_weather::{Loaded, MAX_MATERIALS, MaterialOverride, Weather, load};
use exit_code::ExitCode as _;
use std::collections::BTreeMap;

#[track_caller]
fn says(text: &str, expected: &str) {
    let error = Weather::parse("w.toml", text).expect_err("a value that is not allowed");
    let message = error.to_string();
    assert!(message.starts_with("w.toml: line ") && message.contains(expected), "{message}");
}

fn entry(name: &str, porosity: &str) -> String {
    format!("[[material]]\nname = \"{name}\"\nporosity = {porosity}\n")
}

#[test]
fn every_key_is_read() {
    let text = entry("brick", "0.75") + &entry("", "0").replace("\"\"", "'roof tile'") + &entry("ß", "1");
    let of = |name: &str, porosity| MaterialOverride { name: name.to_owned(), porosity };
    let found = Weather::parse("w.toml", &text).unwrap().materials;
    assert_eq!(found, [of("brick", 0.75), of("roof tile", 0.0), of("ß", 1.0)]);
    assert!(Weather::parse("w.toml", "").unwrap().materials.is_empty());
    // What a surface is like does not depend on whether it is wet.
    let dry = text + "[wetness]\nenabled = false";
    assert_eq!(Weather::parse("w.toml", &dry).unwrap().materials.len(), 3);
}

#[test]
fn values_are_rejected() {
    says("[[material]]\nporosity = 1", "material[0]: no name; allowed: name is needed");
    says("[[material]]\nname = \"a\"", "material[0]: no porosity; allowed: porosity is needed");
    says(&entry("", "1"), "line 2, column 1: material[0].name: 0 bytes; allowed: a name of 1 to 256 bytes");
    says(&entry(&"x".repeat(257), "1"), "material[0].name: 257 bytes");
    assert!(Weather::parse("w.toml", &entry(&"x".repeat(256), "1")).is_ok());
    says(&entry("a", "1.01"), "line 3, column 12: material[0].porosity: 1.01; allowed: 0 to 1");
    says(&entry("a", "-0.1"), "material[0].porosity: -0.1; allowed: 0 to 1");
    for number in ["nan", "inf", "-inf", "1e39", "2"] {
        says(&entry("a", number), "allowed: 0 to 1");
    }
    for other in ["\"wet\"", "true", "[0.5]", "[[0, 0.5], [1, 1]]", "{ x = 1 }"] {
        says(&entry("a", other), "material[0].porosity: ");
    }
    says("[[material]]\nname = 3\nporosity = 1", "material[0].name: ");
    says("[material]\nname = \"a\"\nporosity = 1", "line 1, column 1: material: invalid type: map");
    let unknown = format!("{}porosty = 1", entry("a", "1"));
    says(&unknown, "line 4, column 1: material[0].porosty: unknown key \"porosty\", perhaps porosity");
    says(&format!("{}wet = false", entry("a", "1")), "unknown key \"wet\"; allowed: name, porosity");
}

#[test]
fn a_name_comes_once() {
    let text = entry("brick", "1") + &entry("roof", "0") + &entry("brick", "0.5");
    let expected = "line 8, column 1: material[2].name: \"brick\" again, as in material[0].name; allowed: each name once";
    says(&text, expected);
    // Names are compared letter by letter, as those of glTF are.
    assert!(Weather::parse("w.toml", &(entry("brick", "1") + &entry("Brick", "0"))).is_ok());
}

#[test]
fn their_number_is_limited() {
    let many = |count: usize| (0..count).map(|k| entry(&format!("m{k}"), "0.5")).collect::<String>();
    assert_eq!(Weather::parse("w.toml", &many(MAX_MATERIALS)).unwrap().materials.len(), 1024);
    let error = Weather::parse("w.toml", &many(MAX_MATERIALS + 1)).unwrap_err();
    assert_eq!(error.exit_code(), 3, "{error}");
    assert!(error.to_string().contains("1025 times [[material]]; allowed: at most 1024"), "{error}");
}

/// Two models: both have brick, one by its extras.
fn files() -> BTreeMap<String, Vec<u8>> {
    let model = |materials: &str| {
        format!(r#"{{"asset": {{"version": "2.0"}}, "materials": [{materials}]}}"#).into_bytes()
    };
    let house = r#"{"name": "brick", "extras": {"porosity": 0.25}}, {"name": "roof"}, {}"#;
    let wall = r#"{"name": "brick"}, {"name": "plaster", "extras": {"porosity": 0.5}}"#;
    let many: Vec<String> = (0..40).map(|k| format!(r#"{{"name": "stone_{k:02}"}}"#)).collect();
    [("house.gltf", model(house)), ("wall.gltf", model(wall)), ("many.gltf", model(&many.join(", ")))]
        .map(|(name, bytes)| (name.to_owned(), bytes))
        .into()
}

/// A weather over models of those files.
fn weather(models: &[&str], materials: &str) -> Weather {
    let models: String = models.iter().map(|file| format!("[[model]]\nfile = \"{file}\"\n")).collect();
    Weather::parse("w.toml", &(models + materials)).unwrap()
}

fn loaded(models: &[&str], materials: &str) -> Result<Loaded, SceneError> {
    load(&weather(models, materials), &files(), &mut Budget::default())
}

/// Names and porosities of the materials of a scene.
fn porosities(loaded: &Loaded) -> Vec<(&str, Option<f32>)> {
    loaded.scene.materials.iter().map(|one| (one.name.as_str(), one.porosity)).collect()
}

#[test]
fn an_override_wins_over_extras_in_all_models() {
    // The third is a copy of the first, which shares its materials.
    let models = ["house.gltf", "wall.gltf", "house.gltf"];
    let without = loaded(&models, "").unwrap();
    let own = [("brick", Some(0.25)), ("roof", None), ("", None), ("brick", None), ("plaster", Some(0.5))];
    assert_eq!(porosities(&without), own);
    let with = loaded(&models, &(entry("brick", "0.75") + &entry("roof", "0"))).unwrap();
    let expected = [
        ("brick", Some(0.75)),
        ("roof", Some(0.0)),
        ("", None),
        ("brick", Some(0.75)),
        ("plaster", Some(0.5)),
    ];
    assert_eq!(porosities(&with), expected);
}

#[test]
fn a_name_that_no_model_has_is_an_error_with_the_nearest_ones() {
    let says = |models: &[&str], text: &str, expected: &str| {
        let error = loaded(models, text).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert_eq!(error.to_string(), format!("w.toml: {expected}"));
    };
    says(
        &["house.gltf", "wall.gltf"],
        &(entry("roof", "1") + &entry("bricks", "1")),
        "material[1].name: \"bricks\", which no model has, perhaps \"brick\"; allowed: \"brick\", \"roof\", \"plaster\"",
    );
    says(
        &[],
        &entry("brick", "1"),
        "material[0].name: \"brick\", which no model has; allowed: a model with named materials",
    );
    let many = loaded(&["many.gltf"], &entry("stone_99", "1")).unwrap_err().to_string();
    let listed = "perhaps \"stone_09\"; allowed: \"stone_09\", \"stone_19\", \"stone_29\", \"stone_39\", ";
    assert!(many.contains(listed) && many.ends_with(", and 28 more"), "{many}");
    assert!(many.len() < 600, "{many}");
    // Panes of the scene name materials in the same way.
    let pane = loaded(&["wall.gltf"], "[[pane]]\nmaterial = \"plastr\"").unwrap_err().to_string();
    let expected = "w.toml: pane[0].material: \"plastr\", which no model has, perhaps \"plaster\"; allowed: \"plaster\", \"brick\"";
    assert_eq!(pane, expected);
}

/// Another override is another scene, and without it the material is that of its file again.
#[test]
fn a_changed_override_is_read_anew() {
    let models = ["house.gltf"];
    let [none, some, other] =
        ["", &entry("brick", "0.75"), &entry("brick", "1")].map(|t| weather(&models, t));
    let mut last = load(&none, &files(), &mut Budget::default()).unwrap();
    let steps = [(&none, &some, 0.75), (&some, &other, 1.0), (&other, &none, 0.25)];
    for (before, now, expected) in steps {
        let (next, reloaded) = last.reload(before, now, &files(), &mut Budget::default()).unwrap();
        assert!(reloaded.models);
        assert_eq!(next.scene.materials[0].porosity, Some(expected));
        let (same, reloaded) = next.reload(now, now, &files(), &mut Budget::default()).unwrap();
        assert!(!reloaded.models);
        assert_eq!(same.scene.materials[0].porosity, Some(expected));
        last = next;
    }
}
