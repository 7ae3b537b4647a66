//! Appearance of drops in weather files.

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;
use downpour_drop::shape::ShapeTable;
use downpour_scene::Budget;
use downpour_weather::{RainDropShape, RainRefraction, Weather, load};
use exit_code::ExitCode as _;
use std::collections::BTreeMap;

fn refused(text: &str) -> String {
    let error = Weather::parse("w.toml", text).expect_err("a weather that is refused");
    assert_eq!(error.exit_code(), 2, "{error}");
    error.to_string()
}

#[test]
fn shapes_and_refraction_have_names() {
    let rain = Weather::parse("w.toml", "").unwrap().rain;
    assert_eq!((rain.drop_shape, rain.refraction), (RainDropShape::BeardChuang, RainRefraction::Direction));
    let text = "[rain]\ndrop_shape = 'rousseau-2006'\nrefraction = 'rousseau-2006'";
    let rain = Weather::parse("w.toml", text).unwrap().rain;
    assert_eq!(rain.drop_shape.table(), ShapeTable::Rousseau2006);
    assert_eq!(rain.refraction, RainRefraction::Rousseau2006);
    let message = refused("[rain]\ndrop_shape = 'round'");
    for part in ["w.toml: line 2", "rain.drop_shape", "round", "beard-chuang", "rousseau-2006"] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn a_model_of_drops_is_refused_where_it_would_not_be_seen() {
    let table = refused("[rain]\nmask_model = 'drop.glb'");
    assert!(table.contains("rain.mask_model: ") && table.contains("allowed: "), "{table}");
    assert!(table.contains("streaks.samples = 1 to 4096"), "{table}");
    let both = "[rain]\nmask_model = 'drop.glb'\ndrop_shape = 'beard-chuang'\n[streaks]\nsamples = 8";
    assert!(refused(both).contains("rain.drop_shape"));
    for path in ["../drop.glb", "/drop.glb", "https://example.org/drop.glb"] {
        let message = refused(&format!("[rain]\nmask_model = '{path}'\n[streaks]\nsamples = 8"));
        assert!(message.contains("rain.mask_model") && message.contains("allowed: "), "{message}");
    }
}

#[test]
fn a_model_of_drops_is_read_whole_or_not_at_all() {
    let text = "[rain]\nmask_model = 'models/drop.gltf'\n[streaks]\nsamples = 8";
    let weather = Weather::parse("w.toml", text).unwrap();
    let error = |files: BTreeMap<String, Vec<u8>>| {
        load(&weather, &files, &mut Budget::default()).map(|_| ()).unwrap_err()
    };
    let missing = error(BTreeMap::new());
    assert_eq!(missing.exit_code(), 5);
    assert!(missing.to_string().contains("models/drop.gltf"), "{missing}");
    for bad in ["", "no glTF", r#"{"asset": {"version": "2.0"}}"#] {
        let refused = error([("models/drop.gltf".to_owned(), bad.into())].into());
        assert_eq!(refused.exit_code(), 2, "{refused}");
        let message = refused.to_string();
        assert!(message.contains("models/drop.gltf") && message.contains("allowed: "), "{message}");
    }
}
