//! `downpour check`: its output agrees with `render`.

use crate::child::Downpour;
use crate::gltf_file::{gltf, tetrahedron};
use crate::scene_files::{storm, weather};

#[test]
fn a_weather_is_told_of() {
    let json = storm(&["check", "--json"]).run().succeeded().json();
    let number = |key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{key} of {json}"));
    for (key, value) in [
        ("triangles", 5.0),
        ("instances", 1.0),
        ("textures", 0.0),
        ("lights", 0.0),
        ("animations", 0.0),
        ("cameras", 0.0),
        ("width", 64.0),
        ("height", 36.0),
        ("fov_deg", 12.0),
        ("rate_mm_h", 400.0),
        ("seed", 7.0),
        ("sky_height", 256.0),
    ] {
        assert!((number(key) - value).abs() < 1.0e-5, "{key}: {}", json[key]);
    }
    assert_eq!(json["camera"], "of the weather file");
    assert_eq!(json["distribution"], "marshall-palmer");
    let position: Vec<f64> =
        json["camera_position_m"].as_array().unwrap().iter().filter_map(serde_json::Value::as_f64).collect();
    assert!((position[1] - 1.2).abs() < 1.0e-6 && position[2] == 6.0, "{json}");
    // Moon & Spencer: half of the sphere has a mean of 2/3 of the zenith's 3, the other a fifth of 7/9 of it.
    let mean = json["sky_mean_radiance"][1].as_f64().unwrap();
    assert!((mean - (1.0 + 0.5 * 0.2 * 3.0 * 7.0 / 9.0)).abs() < 1.0e-3, "{mean}");
    assert!(json["sun_direction"].is_null() && json["sun_irradiance"].is_null(), "{json}");
    // The rain is that of `downpour rain`.
    let rain = crate::child::downpour(&["rain", "--rate", "400", "--json"]).succeeded().json();
    for key in ["number_m3", "median_volume_diameter_mm", "visibility_km"] {
        assert_eq!(json[key], rain[key], "{key}");
    }
    assert!(number("memory_mib") > 0.1 && number("memory_mib") < 50.0, "{json}");
}

/// Arguments are checked as for `render`.
#[test]
fn arguments_come_before_the_file() {
    let arguments = ["check", "--json", "--rate", "0", "--size", "100x50", "--seed", "18446744073709551615"];
    let json = storm(&arguments).run().succeeded().json();
    assert_eq!((json["rate_mm_h"].as_f64(), json["width"].as_u64()), (Some(0.0), Some(100)));
    assert_eq!(json["seed"].as_u64(), Some(u64::MAX));
    assert!(json["visibility_km"].is_null(), "{json}");
    storm(&["check", "--size", "16385x1"]).run().failed(3, &["16384"]).with_one_line();
}

#[test]
fn people_read_a_list() {
    let lamps = "[sun]\nazimuth_deg = 90\nelevation_deg = 0\nilluminance_lux = 10\n\
                 [[light]]\npoint = { position_m = [1, 2, 3] }\n";
    let text = storm(&["check"]).with_file("storm.toml", weather(lamps)).run().succeeded().stdout;
    let line = |label: &str| -> Vec<String> {
        let line =
            text.lines().find(|line| line.starts_with(label)).unwrap_or_else(|| panic!("{label}: {text}"));
        line[label.len()..].split_whitespace().map(str::to_owned).collect()
    };
    assert_eq!(line("triangles "), ["5"]);
    assert_eq!(line("lamps "), ["1"]);
    assert_eq!(line("rain rate "), ["400", "mm/h"]);
    assert_eq!(line("irradiance of the sun "), ["10.0", "10.0", "10.0"]);
    assert_eq!(line("camera that is taken "), ["of", "the", "weather", "file"]);
    assert_eq!(line("those that play "), ["none"]);
}

/// The camera of the model is used if the weather has none, with its field of view.
#[test]
fn the_camera_of_a_model_is_taken() {
    let (positions, triangles) = tetrahedron();
    let mut document: serde_json::Value = serde_json::from_str(&gltf(&positions, &triangles)).unwrap();
    document["nodes"] = serde_json::json!([{"mesh": 0}, {"camera": 1, "translation": [1, 2, 3]}]);
    document["scenes"] = serde_json::json!([{"nodes": [0, 1]}]);
    document["cameras"] = serde_json::json!([
        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}},
        {"name": "front\u{1b}", "type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}
    ]);
    let run = |arguments: &[&str]| {
        let run = Downpour::new(&[&["check", "a.gltf"], arguments].concat());
        run.with_file("a.gltf", document.to_string()).run().succeeded()
    };
    let json = run(&["--json"]).json();
    assert_eq!(json["camera"], "1 of the scene, front\u{1b}");
    assert_eq!(json["camera_position_m"], serde_json::json!([1.0, 2.0, 3.0]));
    assert!((json["fov_deg"].as_f64().unwrap() - 0.5f64.to_degrees()).abs() < 1.0e-4, "{json}");
    assert_eq!(json["cameras"], 2);
    let text = run(&[]).stdout;
    assert!(!text.contains('\u{1b}') && text.contains("front\\u{1b}"), "{text:?}");
}

/// The atlas is listed if the weather uses it: its files, and their memory.
#[test]
fn the_streak_atlas_is_told_of() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/streaks");
    let check = |look: &str, more: &[&str]| {
        storm(&[&["check", "--json"], more].concat())
            .with_file("storm.toml", weather(&format!("[streaks]\ncolor = '{look}'\n")))
            .run()
            .succeeded()
            .json()
    };
    let of = |json: &serde_json::Value| json["streak_atlas"].as_str().unwrap().to_owned();
    let without = check("refracted", &["--streaks", folder]);
    assert_eq!(of(&without), "not asked for");
    assert_eq!(of(&check("refracted", &["--streaks", "no such folder"])), "not asked for");
    for look in ["atlas", "atlas-random"] {
        let json = check(look, &["--streaks", folder]);
        let text = of(&json);
        assert!(text.contains(" streaks of drops of 1, 2, 2.8, 4 mm in 16 files, "), "{text}");
        let number = |word: usize| text.split_whitespace().nth(word).unwrap().parse::<f64>().unwrap();
        let bytes = number(text.split_whitespace().count() - 2);
        // Each streak has texels of two bytes.
        assert!(number(0) > 100.0 && bytes > 2.0 * 32.0 * number(0), "{text}");
        let memory = |json: &serde_json::Value| json["memory_mib"].as_f64().unwrap() * f64::from(1u32 << 20);
        let more = memory(&json) - memory(&without);
        assert!((more / bytes - 1.0).abs() < 1.0e-6, "{more} bytes more of memory for {text}");
    }
}
