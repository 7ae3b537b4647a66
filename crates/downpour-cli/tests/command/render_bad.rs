//! Invalid input of `render` and `check`: arguments, keys of a weather file, files of other kinds. Code, one line, nothing
//! written, and at most 4 GiB used.

use std::fs;

use crate::child::{Downpour, Ended, downpour};
use crate::gltf_file::{empty, gltf, tetrahedron};
use crate::scene_files::{model, storm, weather};

/// The scene under a limit of memory, if a shell can set one.
fn limited(arguments: &[&str]) -> Downpour {
    #[cfg(unix)]
    let run = Downpour::limited(&["-v 4194304"], arguments);
    #[cfg(not(unix))]
    let run = Downpour::new(arguments);
    run.with_file("storm.toml", weather("")).with_file("floor.gltf", model())
}

fn render(arguments: &[&str]) -> Ended {
    let fixed = ["render", "storm.toml", "--backend", "cpu", "--samples", "1"];
    limited(&[&fixed, arguments].concat()).run()
}

#[test]
fn bad_arguments_are_refused() {
    let rate = "allowed: 0 to 500 mm/h";
    for (arguments, code, words) in [
        (&["-o", "a.png", "--rate", "NaN"][..], 2, &["--rate", "'NaN'", rate][..]),
        (&["-o", "a.png", "--rate", "inf"], 2, &["--rate", rate]),
        (&["-o", "a.png", "--rate", "-1"], 2, &["--rate", "'-1'", rate]),
        (&["-o", "a.png", "--rate", "501"], 2, &["--rate", "'501'", rate]),
        (&["-o", "a.png", "--rate", "1e39"], 2, &["--rate", rate]),
        (&["-o", "a.png", "--rate", "1e-46"], 2, &["--rate", rate]),
        (&["-o", "a.png", "--rate", "ten"], 2, &["--rate", rate]),
        (&["-o", "a.png", "--time", "nan"], 2, &["--time", "0 to 1000000 s"]),
        (&["-o", "a.png", "--time", "-1"], 2, &["--time", "0 to 1000000 s"]),
        (&["-o", "a.png", "--time", "1e39"], 2, &["--time", "0 to 1000000 s"]),
        (&["-o", "a.png", "--size", "0x0"], 2, &["--size", "1 to 16384"]),
        (&["-o", "a.png", "--size", "64"], 2, &["--size", "WxH"]),
        (&["-o", "a.png", "--size", "64xx36"], 2, &["--size", "WxH"]),
        (&["-o", "a.png", "--size", "-64x36"], 2, &["--size", "WxH"]),
        (&["-o", "a.png", "--size", "1e2x1e2"], 2, &["--size", "WxH"]),
        (&["-o", "a.png", "--size", "16385x1"], 3, &["16385 x 1", "1 to 16384"]),
        (&["-o", "a.png", "--size", "99999999999x1"], 3, &["1 to 16384"]),
        (&["-o", "a.png", "--seed", "-1"], 2, &["--seed", "0 to 18446744073709551615"]),
        (&["-o", "a.png", "--seed", "18446744073709551616"], 2, &["--seed", "0 to 18446744073709551615"]),
        (&["-o", "a.png", "--light-frames", "9"], 2, &["--light-frames", "1 to 8"]),
        (&["-o", "a.png", "--light-frames", "4"], 2, &["--light-frames 4 without --frames", "allowed"]),
        (&["-o", "a.png", "--sky-rays", "65"], 2, &["--sky-rays", "0 to 64"]),
        (&["-o", "a.png", "--layers"], 2, &["--layers", "allowed: for .exr only"]),
        (&["-o", "a.png", "--adapter", "x"], 2, &["--adapter", "--backend gpu or auto"]),
        (&["-o", "a.png", "--asset-root", "none"], 5, &["none"]),
        (&["-o", "a.jpg"], 2, &["a.jpg", "allowed: .exr or .png"]),
        (&["-o", "a"], 2, &["allowed: .exr or .png"]),
        (&["-o", "storm.toml", "--overwrite"], 2, &["storm.toml", "allowed: .exr or .png"]),
        (&["-o", "-"], 2, &["allowed: .exr or .png"]),
        (&["-o", "none/a.png"], 5, &["folder none"]),
        (&["-o", "floor.gltf/a.png"], 5, &["floor.gltf is not a folder"]),
        (&["-o", "a.png", "--stats", "a.png"], 2, &["output a.png", "allowed: .json"]),
        (&["-o", "a.png", "--stats", "storm.toml", "--overwrite"], 2, &["allowed: .json"]),
        (&["-o", "a.png", "--dump-drops", "drops.txt"], 2, &["drops.txt", "allowed: .csv"]),
        (&["-o", "a.png", "--stats", "none/a.json"], 5, &["folder none"]),
        (&["-o", "a.png", "-o", "b.png"], 2, &["--output", "multiple times"]),
        (&[], 2, &["--output"]),
    ] {
        render(arguments).failed(code, words).with_one_line().left(&["floor.gltf", "storm.toml"]);
    }
    let samples = limited(&["render", "storm.toml", "-o", "a.png", "--samples", "9"]).run();
    samples.failed(2, &["--samples", "1 to 8"]).with_one_line();
    downpour(&["render", "-o", "a.png"]).failed(2, &["INPUT"]).with_one_line().left(&[]);
}

#[test]
fn a_picture_of_one_pixel_is_one() {
    render(&["-q", "-o", "a.exr", "--size", "1x1"]).succeeded().left(&["a.exr", "floor.gltf", "storm.toml"]);
}

/// 268 million pixels need more memory than the process may use: reported before anything is traced.
#[cfg(unix)]
#[test]
fn a_picture_beyond_the_memory_is_over_a_limit() {
    let ended = render(&["-o", "a.exr", "--size", "16384x16384"]);
    ended
        .failed(3, &["16384 x 16384 pixels", "MiB", "--size"])
        .with_one_line()
        .left(&["floor.gltf", "storm.toml"]);
}

/// Both commands report the same for an input.
#[track_caller]
fn both(input: &str, files: &[(&str, &[u8])], code: i32, words: &[&str]) {
    for arguments in [
        &["check", input][..],
        &["render", input, "--backend=cpu", "--samples=1", "--size=8x8", "-o", "a.png"],
    ] {
        let run = files.iter().fold(limited(arguments), |run, (name, bytes)| run.with_file(name, bytes));
        let before: Vec<String> = crate::child::names_in(run.folder());
        let before: Vec<&str> = before.iter().map(String::as_str).collect();
        run.run().failed(code, words).with_one_line().left(&before);
    }
}

#[test]
fn bad_inputs_are_refused() {
    both("none.toml", &[], 5, &["none.toml"]);
    both("none.glb", &[], 5, &["none.glb"]);
    both("a.txt", &[("a.txt", b"")], 2, &["input a.txt", ".toml", ".glb, .gltf"]);
    both("sky.hdr", &[], 2, &["input sky.hdr", ".toml"]);
    both("storm", &[], 2, &["input storm", ".toml"]);
    both("a.glb", &[("a.glb", b"")], 2, &["a.glb", "allowed: "]);
    both("a.gltf", &[("a.gltf", b"\x89PNG\r\n\x1a\n0000")], 2, &["a.gltf", "PNG"]);
    both("a.glb", &[("a.glb", b"not a model")], 2, &["a.glb", "allowed: "]);
    both("a.toml", &[("a.toml", b"\x89PNG\r\n\x1a\n0000")], 2, &["a.toml", "UTF-8"]);
    both("a.toml", &[("a.toml", b"glTF\x02\x00\x00\x00")], 2, &["a.toml"]);
    both("a.toml", &[("a.toml", b"rain = ")], 2, &["a.toml", "line 1"]);
    let long: Vec<u8> = b"# ".iter().copied().chain(std::iter::repeat_n(b'x', 5 << 20)).collect();
    both("a.toml", &[("a.toml", &long)], 3, &["a.toml", "at most 4194304"]);
    for name in ["folder.toml", "folder.glb"] {
        let run = limited(&["check", name]);
        fs::create_dir(run.folder().join(name)).unwrap();
        run.run().failed(2, &[name, "a folder"]).with_one_line();
    }
    #[cfg(unix)]
    for name in ["fifo.toml", "fifo.glb"] {
        let run = limited(&["check", name]);
        let made = std::process::Command::new("mkfifo").arg(run.folder().join(name)).status().unwrap();
        assert!(made.success());
        run.run().failed(2, &[name, "a FIFO"]).with_one_line();
    }
}

/// An empty weather file is the default weather, and one with a byte order mark and Windows' line ends is one too.
#[test]
fn unusual_inputs_that_are_good() {
    for text in ["", "\u{feff}[rain]\r\nrate_mm_h = 5\r\n"] {
        let run = limited(&["render", "a.toml", "--backend=cpu", "--samples=1", "--size=8x8", "-o", "a.png"]);
        let ended = run.with_file("a.toml", text).run().succeeded();
        assert!(ended.stderr.contains("no triangles: a picture of the sky alone"), "{}", ended.stderr);
    }
    // Without meshes, and without a camera: the sky, with a warning.
    let run = limited(&["render", "a.gltf", "--backend=cpu", "--samples=1", "--size=8x8", "-o", "a.png"]);
    let ended = run.with_file("a.gltf", empty()).run().succeeded();
    assert!(ended.stderr.contains("warning: a.gltf: no triangles"), "{}", ended.stderr);
    let (positions, triangles) = tetrahedron();
    let run = limited(&["check", "a.gltf", "--json"]).with_file("a.gltf", gltf(&positions, &triangles));
    assert_eq!(run.run().succeeded().without_a_word().json()["camera"], "in front of all that there is");
}

/// The error of a key has its line and the allowed values.
#[test]
fn bad_keys_are_refused() {
    let rain = |line: &str| weather("").replace("rate_mm_h = 400", line);
    let camera = |line: &str| weather("").replace("fov_deg = 12", line);
    let floor = |line: &str| weather("").replace("file = 'floor.gltf'", line);
    let output = |line: &str| weather("").replace("size = [64, 36]", line);
    for (text, code, words) in [
        (rain("rate_mm_h = nan"), 2, &["rain.rate_mm_h", "0.001 to 500 mm/h"][..]),
        (rain("rate_mm_h = inf"), 2, &["rain.rate_mm_h", "0.001 to 500 mm/h"]),
        (rain("rate_mm_h = 1e39"), 2, &["rain.rate_mm_h", "0.001 to 500 mm/h"]),
        (rain("rate_mm_h = -1"), 2, &["rain.rate_mm_h", "-1", "0.001 to 500 mm/h"]),
        (rain("rate_mm_h = 'ten'"), 2, &["rain.rate_mm_h"]),
        (rain("rate_mm_h = 1\nrate_mm_h = 2"), 2, &["line 3"]),
        (rain("rate_mmh = 1"), 2, &["rain.rate_mmh", "unknown key", "rate_mm_h"]),
        (rain("rate_mm_h = 1\n[rain]"), 2, &["line 3"]),
        (rain("rate_mm_h = 1\nseeds = 2"), 2, &["unknown key", "seed"]),
        (camera("fov_deg = 180"), 2, &["camera.fov_deg", "1 to 170"]),
        (camera("near_m = 5000"), 2, &["near_m below far_m"]),
        (camera("shutter_s = nan"), 2, &["camera.shutter_s"]),
        (floor("file = 'none.gltf'"), 5, &["none.gltf"]),
        (floor("file = '../floor.gltf'"), 2, &["model[0].file", ".."]),
        (floor("file = '/etc/passwd'"), 2, &["model[0].file"]),
        (floor("file = 'file:///etc/passwd'"), 2, &["model[0].file"]),
        (floor("file = 'floor.gltf'\nscale = 1e39"), 2, &["model[0].scale"]),
        (floor("file = 'floor.gltf'\nanimation = 'walk'"), 2, &["floor.gltf", "no animation"]),
        (floor("file = 'storm.toml'"), 2, &["storm.toml"]),
        (output("size = [0, 0]"), 2, &["output.size", "1 to 16384"]),
        (output("size = [16385, 1]"), 2, &["output.size", "1 to 16384"]),
        (output("size = [64]"), 2, &["output.size"]),
        (weather("[sky]"), 2, &["line"]),
        (weather("").replace("zenith_color = [2, 3, 4]", "file = 'floor.gltf'"), 2, &["floor.gltf"]),
    ] {
        both("storm.toml", &[("storm.toml", text.as_bytes())], code, words);
    }
}

/// Many copies of a model: as many as a renderer accepts, then a limit, without loss of time and memory.
#[test]
fn copies_are_limited() {
    let of = |count: &str, model: &str| {
        weather("").replace(
            "file = 'floor.gltf'",
            &format!("file = '{model}'\nrepeat = {{ count = [{count}], step_m = [9, 9, 9] }}"),
        )
    };
    let run = storm(&["check", "--json"]).with_file("storm.toml", of("100, 1, 100", "floor.gltf"));
    assert_eq!(run.run().succeeded().json()["triangles"], 50_000);
    // A ball of 2 x 64 x 64 triangles, 65536 times.
    let shape = downpour::drop::DropShape::new(2.0e-3).unwrap();
    let ball = downpour::drop::mesh::DropMesh::latitude_longitude(&shape, 64, 64).unwrap();
    let ball = gltf(ball.positions(), ball.triangles());
    let text = of("65536, 1, 1", "ball.gltf");
    both(
        "storm.toml",
        &[("storm.toml", text.as_bytes()), ("ball.gltf", ball.as_bytes())],
        3,
        &["triangles of the scene", "at most 4194304"],
    );
    // A lamp 65536 times.
    let lamp = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 800}]}}}"#;
    let text = of("65536, 1, 1", "lamp.gltf");
    both(
        "storm.toml",
        &[("storm.toml", text.as_bytes()), ("lamp.gltf", lamp.as_bytes())],
        3,
        &["lamps of the scene", "at most 1024"],
    );
}

/// A link that leads out of the folder is not followed.
#[cfg(unix)]
#[test]
fn nothing_outside_the_folder_is_read() {
    let outside = tempfile::tempdir().unwrap();
    fs::write(outside.path().join("floor.gltf"), model()).unwrap();
    let run = storm(&["check"]);
    let link = run.folder().join("floor.gltf");
    fs::remove_file(&link).unwrap();
    std::os::unix::fs::symlink(outside.path().join("floor.gltf"), &link).unwrap();
    run.run().failed(2, &["floor.gltf", "leaves the scene folder"]).with_one_line();
    // Named as an asset root, the folder may be read.
    let run = storm(&["check", "--json", "--asset-root", outside.path().to_str().unwrap()]);
    fs::remove_file(run.folder().join("floor.gltf")).unwrap();
    assert_eq!(run.run().succeeded().json()["triangles"], 5);
    let (positions, triangles) = tetrahedron();
    limited(&["check", "a.gltf", "--asset-root", "."])
        .with_file("a.gltf", gltf(&positions, &triangles))
        .run()
        .failed(2, &["--asset-root", ".toml"]);
}

/// A weather with streaks of an atlas, and values of `--streaks`.
#[test]
fn a_streak_atlas_that_is_none_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| {
        fs::create_dir_all(folder.path().join(name)).unwrap();
        fs::write(folder.path().join(name).join("streak_2mm_1.ktx2"), bytes).unwrap();
    };
    let whole =
        fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/streaks/streak_2mm_1.ktx2")).unwrap();
    put("cut", &whole[..whole.len() / 2]);
    put("none", b"no streaks at all");
    fs::create_dir(folder.path().join("empty")).unwrap();
    // A word of the key that holds all numbers: another version has another.
    let at = whole.windows(15).position(|w| w == b"DownpourStreaks").unwrap();
    let mut other = whole.clone();
    other[at + 8] = b'X';
    put("other", &other);
    for word in ["atlas", "atlas-random"] {
        let run = |more: &[&str]| {
            let fixed = ["render", "storm.toml", "--backend", "cpu", "--samples", "1", "-o", "a.png"];
            Downpour::new(&[&fixed, more].concat())
                .with_file("storm.toml", weather(&format!("[streaks]\ncolor = '{word}'\n")))
                .with_file("floor.gltf", model())
                .run()
        };
        let check = |more: &[&str]| {
            Downpour::new(&[&["check", "storm.toml", "--json"], more].concat())
                .with_file("storm.toml", weather(&format!("[streaks]\ncolor = '{word}'\n")))
                .with_file("floor.gltf", model())
                .run()
        };
        let files = ["floor.gltf", "storm.toml"];
        let told = run(&[]).failed(2, &["streaks.color", "--streaks FOLDER"]).with_one_line().left(&files);
        // The check lists the rest, and ends as the picture does.
        let checked = check(&[]).failed(2, &["streaks.color", "--streaks FOLDER"]).left(&files);
        assert_eq!(checked.stderr, told.stderr);
        assert!(checked.json()["streak_atlas"].as_str().unwrap().contains("no --streaks: render ends"));
        for (name, code, words) in [
            ("missing", 5, "missing"),
            ("empty", 5, "no .ktx2 file"),
            ("cut", 2, "streak_2mm_1.ktx2"),
            ("none", 2, "streak_2mm_1.ktx2"),
            ("other", 2, "streak_2mm_1.ktx2"),
        ] {
            let path = folder.path().join(name).display().to_string();
            let told = run(&["--streaks", &path]).failed(code, &[words]).with_one_line().left(&files);
            let checked = check(&["--streaks", &path]).failed(code, &[words]).with_one_line().left(&files);
            assert_eq!(checked.stderr, told.stderr);
        }
    }
}
