//! The JSON schema of a weather file: it takes what the parser takes, and refuses what one value alone shows to be wrong.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour_weather::{PRESETS, Weather, json_schema};
use serde_json::Value;
use std::path::Path;

fn as_json(text: &str) -> Value {
    toml::from_str(text).unwrap()
}

/// Every weather file of the project.
fn files() -> Vec<(String, String)> {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    let mut folders = vec![assets];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "toml") {
                let text = std::fs::read_to_string(&path).unwrap();
                if Weather::parse("w.toml", &text).is_ok() {
                    files.push((path.display().to_string(), text));
                }
            }
        }
    }
    files
}

#[test]
fn it_takes_every_weather_of_the_project() {
    let schema = jsonschema::validator_for(&json_schema()).unwrap();
    let presets = PRESETS.map(|(name, text)| (name.to_owned(), text.to_owned()));
    let all: Vec<_> = files().into_iter().chain(presets).collect();
    assert!(all.len() > 40, "{} files", all.len());
    for (name, text) in all {
        let errors: Vec<String> =
            schema.iter_errors(&as_json(&text)).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
    }
}

/// Each is refused by the parser, too.
#[test]
fn it_refuses_what_no_weather_has() {
    let schema = jsonschema::validator_for(&json_schema()).unwrap();
    for text in [
        "preset = 'hail'",
        "rian = 3",
        "[rain]\nrate = 3",
        "[rain]\nrate_mm_h = 501",
        "[rain]\nrate_mm_h = 0.0001",
        "[rain]\nrate_mm_h = [[0, 501]]",
        "[rain]\nrate_mm_h = [[0, 1, 2]]",
        "[rain]\nrate_mm_h = []",
        "[rain]\nrate_mm_h = 'much'",
        "[rain]\ndistribution = 'marshal'",
        "[rain]\nseed = -1",
        "[rain]\nmax_drops = 0",
        "[rain]\nbounce = { fraction = 2 }",
        "[sky]\nyaw_deg = [[0, 1]]",
        "[sky]\nzenith_color = [1, 2]",
        "[sky]\nzenith_color = [[0, [1, 2]]]",
        "[camera]\nfov_deg = 171",
        "[camera]\ntone = 'film'",
        "[[light]]\npoint = { intensity_cd = 3 }",
        "[[light]]\nlaser = { position_m = [0, 0, 0] }",
        "[[model]]\nscale = 1",
        "[[model]]\nfile = 'a.glb'\nscale = [1, 2]",
        "[[material]]\nname = 'brick'",
        "[[material]]\nporosity = 0.5",
        "[[material]]\nname = 'brick'\nporosity = 1.5",
        "[[material]]\nname = 'brick'\nporosity = 1\nwet = false",
        "[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [1, 1]\nfill = 'half'",
        "[streaks]\nsamples = 0",
        "[streaks]\nsamples = 'tables'",
        "[glass]\n[[glass.wiper]]\npivot_m = [0, 0]",
        "[[wind]]\nvortex = { strength_m2_s = 1e7, center_m = [0, 0, 0] }",
        "[output]\nsize = [0, 5]",
    ] {
        assert!(Weather::parse("w.toml", text).is_err(), "the parser takes {text:?}");
        assert!(!schema.is_valid(&as_json(text)), "the schema takes {text:?}");
    }
}

/// An editor shows what each key is: no key is missing in the table of the documentation.
#[test]
fn every_key_has_a_text() {
    fn undescribed(path: &str, schema: &Value, found: &mut Vec<String>) {
        match schema {
            Value::Array(forms) => forms.iter().for_each(|form| undescribed(path, form, found)),
            Value::Object(map) => {
                for inner in ["anyOf", "oneOf", "items"] {
                    map.get(inner).into_iter().for_each(|form| undescribed(path, form, found));
                }
                let Some(Value::Object(keys)) = map.get("properties") else { return };
                for (key, value) in keys {
                    let path = format!("{path}.{key}");
                    if value.get("description").is_none() {
                        found.push(path.clone());
                    }
                    undescribed(&path, value, found);
                }
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    undescribed("", &json_schema(), &mut found);
    // The parts of inline tables stand in the text of their table.
    let parts = [".rain.drops.", ".rain.cylinder.", ".rain.bounce.", ".model.repeat.", ".glass.wiper.worn."];
    found.retain(|path| !parts.iter().any(|part| path.starts_with(part)));
    // One of these is a light or a wind.
    found.retain(|path| {
        !(path.starts_with(".light.") || path.starts_with(".wind.")) || path.matches('.').count() > 2
    });
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn it_has_no_null_and_is_the_same_at_each_call() {
    let text = json_schema().to_string();
    assert!(!text.contains("null"), "{text}");
    assert_eq!(text, json_schema().to_string());
}

#[test]
fn texts_are_those_of_the_table_of_keys() {
    let schema = json_schema();
    let text =
        |path: &str| schema.pointer(path).and_then(|text| text["description"].as_str()).unwrap().to_owned();
    let rate = text("/properties/rain/properties/rate_mm_h");
    assert!(
        rate.starts_with("mm/h; 0, or 0.001 to 500; may be keys: rain rate")
            && rate.ends_with("(default: 10)"),
        "{rate}"
    );
}
