//! Presets of weather files.

use downpour_scene::SceneError;
use downpour_weather::{PRESETS, SkySource, Weather};

fn parse(text: &str) -> Result<Weather, SceneError> {
    Weather::parse("w.toml", text)
}

/// A preset is the file of its name: named, it gives the same weather as its text; it names no model, camera or lamp.
#[test]
fn presets_are_weather_files() {
    for (name, text) in PRESETS {
        let own = parse(text).unwrap();
        assert_eq!(parse(&format!("preset = \"{name}\"")).unwrap(), own, "{name}");
        assert!(own.models.is_empty() && own.lights.is_empty() && own.camera == Weather::default().camera);
        assert!(own.wind.uniform().is_some(), "{name} is in closed form");
        assert_eq!(own.size, Weather::default().size);
        own.rain.sizes().unwrap();
    }
}

/// All presets rain more from one to the next by day.
#[test]
fn presets_differ_by_their_rain() {
    let rates = PRESETS.map(|(_, text)| parse(text).unwrap().rain.rate_mm_h);
    assert_eq!(rates, [0.5, 4.0, 30.0, 100.0, 12.0]);
}

/// Keys of the file override those of the preset, one by one; lists replace lists.
#[test]
fn a_file_overrides_its_preset() {
    let storm = parse("preset = \"storm\"").unwrap();
    let own = parse(
        "preset = 'storm'\n[rain]\nrate_mm_h = 55\nseed = 18446744073709551615\n[sky]\nintensity = [[0, 1], [9, 2]]",
    )
    .unwrap();
    assert_eq!((own.rain.rate_mm_h, own.rain.seed), (55.0, u64::MAX));
    assert_eq!((own.rain.law, own.rain.air), (storm.rain.law, storm.rain.air));
    assert_eq!((&own.sky.source, &own.wind), (&storm.sky.source, &storm.wind));
    assert_eq!(own.at(9.0).sky.scale, 2.0);
    // A list replaces the list, and takes the gusts with it.
    let calm = parse("preset = 'storm'\n[[wind]]\nvortex = { strength_m2_s = 4 }").unwrap();
    assert_eq!(calm.wind.parts().len(), 1);
    // What excludes a key of the preset stands in its place.
    let gray = parse("preset = 'storm'\n[sky]\ncolor = [1, 2, 3]").unwrap();
    assert_eq!(gray.sky.source, SkySource::Uniform([1.0, 2.0, 3.0]));
    for text in [
        "[sky]\nfile = 'a.hdr'",
        "[rain]\ndrops = { count = 9000, diameter_mm = 2 }",
        "[rain]\nrate_mm_h = 0",
        "[wetness]\nwetness = 0.5",
        "[wetness]\nenabled = false",
        "[wetness]\nrained_s = 60",
        "[lightning]\nenabled = false",
    ] {
        for (name, _) in PRESETS {
            let found = parse(&format!("preset = '{name}'\n{text}"));
            assert!(found.is_ok(), "{name} {text}: {}", found.unwrap_err());
        }
    }
}

/// Errors name the line of the file, and the nearest preset.
#[test]
fn unknown_presets_are_refused() {
    let error = parse("preset = \"strom\"").unwrap_err().to_string();
    assert!(
        error.starts_with("w.toml: line 1, column 1: preset: unknown preset \"strom\", perhaps storm"),
        "{error}"
    );
    assert!(error.contains("drizzle, steady, heavy, storm, night-city"), "{error}");
    for (text, wanted) in [
        ("preset = 3", "line 1"),
        ("preset = 'storm'\n[rain]\nrate_mm_h = 900", "line 3, column 13: rain.rate_mm_h"),
        ("preset = 'storm'\n[rain]\nmedian_diameter_mm = 2", "line 3, column 1: rain.median_diameter_mm"),
    ] {
        let error = parse(text).unwrap_err().to_string();
        assert!(error.contains(wanted), "{error}");
    }
}
