//! `downpour view` without a display: scripts, and what bad input gets.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use downpour::weather::Weather;
use downpour::wind::WindMatrix;
use downpour::wind::primitive::wind_primitive_velocity;
use glam::{DVec3, Vec3};

/// A square of ground of 80 m, as glTF without other files.
fn ground() -> String {
    let corners = [[-40.0f32, 0.0, -40.0], [-40.0, 0.0, 40.0], [40.0, 0.0, 40.0], [40.0, 0.0, -40.0]];
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let data: String = bytes
        .chunks(3)
        .flat_map(|three| {
            let word = three.iter().fold(0u32, |word, &byte| word << 8 | u32::from(byte));
            [18, 12, 6, 0].map(|shift| char::from(letters[(word >> shift & 63) as usize]))
        })
        .collect();
    let length = bytes.len();
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "buffers": [{{"byteLength": {length}, "uri": "data:application/octet-stream;base64,{data}"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 12}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                        "min": [-40, 0, -40], "max": [40, 0, 40]}},
                      {{"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}}]}}"#
    )
}

const SCENE: &str = "\
# A field in the rain, by hand.
[rain]
rate_mm_h = 200 # a cloudburst
seed = 7

[[model]]
file = \"ground.gltf\"

[camera]
position_m = [0, 2, 14]
look_at_m = [0, 2, 0] # the middle

[output]
size = [320, 180]
";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ground.gltf"), ground()).unwrap();
    fs::write(folder.path().join("field.toml"), SCENE).unwrap();
    folder
}

fn view(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_downpour"))
        .arg("view")
        .args(arguments)
        .current_dir(folder)
        .env("XDG_RUNTIME_DIR", folder)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap()
}

fn script(folder: &Path, steps: &str) -> Output {
    fs::write(folder.join("steps.txt"), steps).unwrap();
    let scale = ["--size", "900x600", "--scale", "0.4", "--backend", "cpu"];
    view(folder, &[&["field.toml", "--script", "steps.txt"], &scale[..]].concat())
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A tornado is added and dragged by 10 m, its strength is raised, it gets two keyframes, a puddle is painted: the file holds exactly
/// that and everything that it held before, and the drops go with the air of the field.
#[test]
fn a_session_is_in_the_file_and_in_the_drops() {
    let folder = folder();
    let steps = "\
        press G\n\
        add tornado 0 0 0\n\
        drag x 10\n\
        name Funnel\n\
        set wind[0].tornado.circulation_m2_s 150\n\
        key wind[0].tornado.discharge_m3_s 0 20\n\
        key wind[0].tornado.discharge_m3_s 4 80\n\
        paint -2 6 1.5 -1 6 1\n\
        time 1.5\n\
        drops drops.csv\n\
        screenshot window.png\n\
        save\n\
        close\n\
        open field.toml\n\
        screenshot again.png\n";
    let output = script(folder.path(), steps);
    assert!(output.status.success(), "{}", message(&output));
    let text = fs::read_to_string(folder.path().join("field.toml")).unwrap();
    let added = "\n# name: Funnel\n[[wind]]\ntornado = { circulation_m2_s = 150, base_m = [10, 0, 0], height_m = 20, core_m = 2, \
                 discharge_m3_s = [[0, 20], [4, 80]] }\n\n\
                 [[puddle]]\nposition_m = [-2, 0, 6]\nsize_m = [16, 16]\nmask = \"field_puddle_1.png\"\ndepth_mm = 12\n";
    assert_eq!(text, format!("{SCENE}{added}"));
    assert_eq!(fs::read(folder.path().join("window.png")).unwrap()[..4], *b"\x89PNG");
    assert!(!folder.path().join(".field.toml.recovery").exists());

    // Horizontally drops follow the air: the velocity of most has a part along that of the field at their place.
    let weather = Weather::parse("field.toml", &text).unwrap();
    let air = WindMatrix::encode(&weather.wind.at(1.5)).unwrap();
    let wind =
        |at: DVec3| -> Vec3 { air.iter().map(|part| wind_primitive_velocity(part, at.as_vec3())).sum() };
    let drops = fs::read_to_string(folder.path().join("drops.csv")).unwrap();
    let (mut along, mut count) = (0, 0);
    for line in drops.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').skip(1).take(6).map(|cell| cell.parse().unwrap()).collect();
        let air = wind(DVec3::new(numbers[0], numbers[1], numbers[2])) * Vec3::new(1.0, 0.0, 1.0);
        if air.length() > 0.5 && line.ends_with("falling") {
            count += 1;
            let drop = Vec3::new(numbers[3] as f32, 0.0, numbers[5] as f32);
            along += i32::from(drop.dot(air) > 0.3 * air.length_squared());
        }
    }
    assert!(count > 20, "{count} drops in moving air");
    assert!(f64::from(along) > 0.8 * f64::from(count), "{along} of {count}");
}

/// Undo takes back everything, step by step, by the keyboard; then nothing is to be saved.
#[test]
fn undo_brings_the_file_back() {
    let folder = folder();
    let steps = "add vortex 0 1 0\ncommand Duplicate\nset rain.rate_mm_h 12\npress Ctrl+Z\npress Ctrl+Z\npress Ctrl+Z\n\
                 save\nclose\n";
    let output = script(folder.path(), steps);
    assert!(output.status.success(), "{}", message(&output));
    assert_eq!(fs::read_to_string(folder.path().join("field.toml")).unwrap(), SCENE);
}

/// A puddle is placed, sized and turned by its handles; the picture and the window are saved; a file is chosen by its name; the speed is told.
#[test]
fn handles_dialogs_and_commands_work_without_a_display() {
    let folder = folder();
    let steps = "add puddle -2 0 6\ndrag width 2\ndrag length 0.5\ndrag turn 30\n\
                 command Save picture\ncommand Save screenshot\nmeasure 3\n\
                 command Save as\npress Ctrl+A\ntype turned.toml\npress Enter\nclose\n";
    let output = script(folder.path(), steps);
    assert!(output.status.success(), "{}", message(&output));
    assert!(message(&output).contains("pictures per second"), "{}", message(&output));
    assert_eq!(fs::read_to_string(folder.path().join("field.toml")).unwrap(), SCENE);
    let weather =
        Weather::parse("turned.toml", &fs::read_to_string(folder.path().join("turned.toml")).unwrap());
    let puddle = &weather.unwrap().puddles[0];
    let [width, length] = puddle.size;
    let turn = puddle.turn.to_degrees();
    assert!(
        (width - 8.0).abs() < 0.1 && (length - 2.0).abs() < 0.1 && (turn - 30.0).abs() < 1.0,
        "{puddle:?}"
    );
    let sizes: Vec<(u32, u32)> = ["field_001.png", "field_002.png"]
        .map(|name| image::image_dimensions(folder.path().join(name)).unwrap())
        .to_vec();
    assert!(sizes[0].0 < 400 && sizes[1] == (900, 600), "{sizes:?}");
}

/// What is wrong is said with file and line or key, what was found and what is allowed, and the exit code is that of the command.
#[test]
fn bad_input_is_explained() {
    let folder = folder();
    let said = |output: &Output, code: i32, words: &[&str]| {
        let text = message(output);
        assert_eq!(output.status.code(), Some(code), "{text}");
        for word in words {
            assert!(text.contains(word), "{word}: {text}");
        }
        assert!(!text.contains("panicked"), "{text}");
    };
    said(&view(folder.path(), &["field.toml"]), 4, &["no display", "allowed", "--script"]);
    said(&view(folder.path(), &["none.toml", "--script", "x"]), 5, &["none.toml"]);
    said(&view(folder.path(), &["field.toml", "--script", "none.txt"]), 5, &["none.txt"]);
    said(&view(folder.path(), &["field.toml", "--adapter", "no such", "--script", "x"]), 4, &["no such"]);
    said(&view(folder.path(), &["field.toml", "--size", "10x10"]), 2, &["--size is 10x10", "allowed"]);
    for (steps, words) in [
        ("\nhail", ["steps.txt: line 2", "step \"hail\"; allowed: open"]),
        ("set rain.rate_mm_h -4", ["line 1", "rain.rate_mm_h"]),
        ("set rain.rate_mm_h four", ["line 1", "allowed: a value of TOML"]),
        ("set rain.hail 4", ["unknown key", "hail"]),
        ("set wind[3].uniform.speed_m_s 4", ["wind[3]", "allowed"]),
        ("drag x 3", ["no handle x", "selection"]),
        ("add hail 0 0 0", ["hail", "allowed: uniform"]),
        ("set rain.seed 1\nclose", ["line 2", "not saved"]),
        ("unkey rain.rate_mm_h 2", ["rain.rate_mm_h", "no keyframes"]),
        ("save-as other.txt", ["other.txt", "allowed"]),
    ] {
        said(&script(folder.path(), steps), 2, &words);
    }
    assert_eq!(fs::read_to_string(folder.path().join("field.toml")).unwrap(), SCENE, "the file is as it was");
    fs::write(folder.path().join("newer.toml"), "[hail]\nsize_mm = 3\n").unwrap();
    said(&view(folder.path(), &["newer.toml", "--script", "x"]), 2, &["newer version", "hail"]);
    // The model is deleted while the window is open: the question after it says so, and the file is still saved.
    fs::remove_file(folder.path().join("ground.gltf")).unwrap();
    said(&script(folder.path(), "set rain.seed 9\nsave\nscreenshot a.png"), 2, &["line 3", "ground.gltf"]);
    assert!(fs::read_to_string(folder.path().join("field.toml")).unwrap().contains("seed = 9"));
}
