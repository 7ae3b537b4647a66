//! `downpour render --frames` on the CPU: a clip is its pictures, and resumes where it stopped.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::child::{Downpour, Ended, names_in};
use crate::scene_files::{model, storm};

/// The storm in few pixels, with its files in a folder that stays.
pub(crate) fn clip(folder: &Path, arguments: &[&str]) -> Downpour {
    let output = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let small = ["render", "--size", "32x18", "--fps", "8"].map(str::to_owned);
    // Names of files with a mark before them are in the folder.
    let named = arguments.iter().map(|text| text.strip_prefix('@').map_or((*text).to_owned(), output));
    let all: Vec<String> = small.into_iter().chain(named).collect();
    storm(&all.iter().map(String::as_str).collect::<Vec<_>>())
}

fn read(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// All files of a folder but journals, which contain times.
pub(crate) fn content(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let names = names_in(folder).into_iter().filter(|name| !name.ends_with(".downpour-job"));
    names.map(|name| (name.clone(), read(folder, &name))).collect()
}

/// Frame k is the picture at --time + k / fps, with its drops and statistics.
#[test]
fn a_clip_is_its_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let lists = ["--stats", "@clip.json", "--dump-drops", "@%02d.csv", "--time", "1"];
    let ended =
        clip(folder.path(), &[&["--frames", "3..6", "-o", "@%02d.exr", "--layers"], &lists[..]].concat());
    let ended = ended.run().succeeded();
    assert!(ended.stderr.contains("%02d.exr: 3 frames of 32 x 18, 3 made now"), "{}", ended.stderr);
    assert_eq!(ended.stdout, "");
    let journal = ".%02d.exr.downpour-job";
    let names = ["03.csv", "03.exr", "04.csv", "04.exr", "05.csv", "05.exr", "clip.json"];
    assert_eq!(names_in(folder.path()), [&[journal], &names[..]].concat());
    let clip: Value = serde_json::from_slice(&read(folder.path(), "clip.json")).unwrap();
    let frames = clip["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 3);
    let mut drawn = 0;
    for (k, frame) in (3u32..).zip(frames) {
        let time = (1.0 + f64::from(k) / 8.0).to_string();
        let arguments = ["render", "--size", "32x18", "--layers", "-o", "a.exr", "--time", &time];
        let single = storm(&[&arguments[..], &["--stats", "a.json", "--dump-drops", "a.csv"]].concat());
        let single = single.run().succeeded();
        assert!(single.file("a.exr") == read(folder.path(), &format!("{k:02}.exr")), "picture {k}");
        assert!(single.file("a.csv") == read(folder.path(), &format!("{k:02}.csv")), "drops of {k}");
        let stats: Value = serde_json::from_slice(&single.file("a.json")).unwrap();
        assert_eq!(frame["frame"], k);
        for (key, value) in stats.as_object().unwrap() {
            assert!(!clip[key].is_null(), "{key} of the clip");
            if !["begin_ms", "frame_ms", "passes"].contains(&key.as_str()) {
                assert_eq!(&frame[key], value, "{key} of frame {k}");
            }
        }
        drawn += frame["drops_drawn"].as_u64().unwrap();
    }
    // Statistics of the clip are the mean of its frames.
    let number = |key: &str| clip[key].as_f64().unwrap();
    assert!((number("drops_drawn") * 3.0 - drawn as f64).abs() < 1.0e-6 && drawn > 0);
    let measured: f64 = frames.iter().map(|frame| frame["measured_rate_mm_h"].as_f64().unwrap()).sum();
    assert!((number("measured_rate_mm_h") * 3.0 - measured).abs() < 1.0e-6);
    assert_eq!((number("fps"), number("time_s"), number("first_frame")), (8.0, 1.375, 3.0));
    assert_eq!((number("frame_count"), number("frames_made")), (3.0, 3.0));
}

/// A frame alone is that of the clip, with the water on a pane and in a flash of lightning, too.
#[test]
fn a_frame_alone_is_that_of_the_clip() {
    let text = "[rain]\nrate_mm_h = 60\n[sky]\nzenith_color = [0.4, 0.45, 0.5]\n[camera]\nposition_m = [0, 1.6, 0]\n\
                [lightning]\nper_minute = 600\nlimit = false\n\
                [glass]\ntilt_deg = 60\nbefore_s = 0.5\ncell_mm = 5\nspeed_m_s = 9\n[output]\nsize = [32, 18]\n";
    let made = |range: &str| {
        let run = Downpour::new(&[
            "render",
            "w.toml",
            "--backend",
            "cpu",
            "--fps",
            "8",
            "--frames",
            range,
            "-q",
            "-o",
            "%d.exr",
        ]);
        run.with_file("w.toml", text).run().succeeded()
    };
    let (clip, alone) = (made("0..4"), made("3..4"));
    assert!(clip.file("3.exr") == alone.file("3.exr") && clip.file("2.exr") != alone.file("3.exr"));
}

/// So it is if its light is averaged with that of the frames before it, which are found first.
#[test]
fn a_frame_alone_has_the_light_of_the_frames_before() {
    let made = |range: &str, frames: &str| {
        let folder = tempfile::tempdir().unwrap();
        let arguments = ["--frames", range, "--light-frames", frames, "-q", "-o", "@%d.exr"];
        clip(folder.path(), &arguments).run().succeeded();
        read(folder.path(), "3.exr")
    };
    let whole = made("0..4", "3");
    assert!(made("3..4", "3") == whole && made("3..4", "1") != whole);
}

#[test]
fn a_clip_says_nothing_that_is_not_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    clip(folder.path(), &["--frames", "0..2", "-q", "-o", "@%d.png"]).run().succeeded().without_a_word();
    assert_eq!(names_in(folder.path()), [".%d.png.downpour-job", "0.png", "1.png"]);
}

/// The scene of the storm, whose floor falls 50 m in the first second.
fn falling_floor() -> String {
    let mut document: Value = serde_json::from_str(&model()).unwrap();
    // Times 0 and 1; positions 0, 0, 0 and 0, -50, 0.
    let bytes = "data:application/octet-stream;base64,AAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAABIwgAAAAA=";
    let push = |list: &mut Value, value: Value| list.as_array_mut().unwrap().push(value);
    push(&mut document["buffers"], serde_json::json!({ "byteLength": 32, "uri": bytes }));
    for (offset, length) in [(0, 8), (8, 24)] {
        let view = serde_json::json!({ "buffer": 1, "byteOffset": offset, "byteLength": length });
        push(&mut document["bufferViews"], view);
    }
    for accessor in [
        serde_json::json!({ "bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1] }),
        serde_json::json!({ "bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3" }),
    ] {
        push(&mut document["accessors"], accessor);
    }
    document["animations"] = serde_json::json!([{
        "samplers": [{ "input": 2, "output": 3 }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }]
    }]);
    document.to_string()
}

/// Moving objects are at their positions at the time of each frame; all frames have the exposure of the first, in any order.
#[test]
fn a_moving_scene_keeps_its_exposure() {
    let moving =
        |folder: &Path, arguments: &[&str]| clip(folder, arguments).with_file("floor.gltf", falling_floor());
    let folder = tempfile::tempdir().unwrap();
    moving(folder.path(), &["--frames", "0..3", "-o", "@%d.png"]).run().succeeded();
    moving(folder.path(), &["--frames", "0..3", "-o", "@%d.exr"]).run().succeeded();
    let whole = content(folder.path());
    let single = |name: &str| {
        let arguments = ["render", "--size", "32x18", "--time", "0.25", "-o", name];
        let run = storm(&arguments).with_file("floor.gltf", falling_floor());
        run.run().succeeded().file(name)
    };
    assert!(single("a.exr") == read(folder.path(), "2.exr"));
    assert!(read(folder.path(), "0.exr") != read(folder.path(), "2.exr"));
    // A single picture would be exposed for the sky that the floor has uncovered.
    assert!(single("a.png") != read(folder.path(), "2.png"));
    fs::remove_file(folder.path().join("2.png")).unwrap();
    let ended = moving(folder.path(), &["--frames", "0..3", "-o", "@%d.png"]).run().succeeded();
    assert!(ended.stderr.contains("2 frames are there, 1 are missing"), "{}", ended.stderr);
    assert!(content(folder.path()) == whole, "other files");
}

/// Complete frames stay, changed or missing ones are rendered again, and a later end makes the clip longer.
#[test]
fn a_clip_goes_on_where_it_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let run = |frames: &str, more: &[&str]| -> Ended {
        clip(folder.path(), &[&["--frames", frames, "-o", "@%03d.png"], more].concat()).run().succeeded()
    };
    let lists = ["--dump-drops", "@%03d.csv"];
    run("0..5", &lists);
    let whole = content(folder.path());
    assert_eq!(whole.len(), 10);
    let ended = run("0..5", &lists);
    assert!(ended.stderr.contains("5 frames of 32 x 18, 0 made now"), "{}", ended.stderr);
    assert!(content(folder.path()) == whole, "other files");
    // One byte of one, all bytes of another, a list.
    let mut bytes = read(folder.path(), "001.png");
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(path("001.png"), bytes).unwrap();
    fs::remove_file(path("003.png")).unwrap();
    fs::write(path("004.csv"), "").unwrap();
    let ended = run("0..5", &lists);
    assert!(ended.stderr.contains("5 frames of 32 x 18, 3 made now"), "{}", ended.stderr);
    assert!(content(folder.path()) == whole, "other files");
    // Statistics of frames that were made without being measured have to be measured.
    let ended = run("0..2", &["--stats", "@a.json"]);
    assert!(ended.stderr.contains("2 frames of 32 x 18, 2 made now"), "{}", ended.stderr);
    fs::remove_file(path("a.json")).unwrap();
    let ended = run("0..3", &["--stats", "@a.json"]);
    assert!(ended.stderr.contains("3 frames of 32 x 18, 1 made now"), "{}", ended.stderr);
    let stats: Value = serde_json::from_slice(&read(folder.path(), "a.json")).unwrap();
    assert!(stats["frames"].as_array().unwrap().iter().all(|frame| frame["measured_rate_mm_h"].is_number()));
    fs::remove_file(path("a.json")).unwrap();
    // Longer, and the same as in one go.
    let ended = run("0..7", &lists);
    assert!(ended.stderr.contains("7 frames of 32 x 18, 2 made now"), "{}", ended.stderr);
    let other = tempfile::tempdir().unwrap();
    let arguments = ["--frames", "0..7", "-o", "@%03d.png", "--dump-drops", "@%03d.csv"];
    clip(other.path(), &arguments).run().succeeded();
    assert!(content(folder.path()) == content(other.path()), "other files");
}

/// A damaged journal costs frames, not the clip; files that it does not list are not replaced.
#[test]
fn a_damaged_journal_costs_what_it_knew() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join(".%d.png.downpour-job");
    let run = || clip(folder.path(), &["--frames", "0..3", "-o", "@%d.png"]).run();
    run().succeeded();
    let whole = content(folder.path());
    let text = fs::read_to_string(&journal).unwrap();
    // Header, exposure, three frames.
    assert_eq!(text.lines().count(), 5);
    // The digest of frame 2 does not match its file.
    let edited = text.replacen("\"frame\":2,\"picture\":\"", "\"frame\":2,\"picture\":\"0", 1);
    fs::write(&journal, &edited).unwrap();
    run().failed(5, &["2.png exists", "--overwrite"]);
    fs::remove_file(folder.path().join("2.png")).unwrap();
    assert!(run().succeeded().stderr.contains("1 made now"));
    assert!(content(folder.path()) == whole, "other files");
    // Without its exposure the whole clip is rendered again.
    let lines: Vec<&str> = text.lines().filter(|line| !line.contains("exposure")).collect();
    fs::write(&journal, lines.join("\n") + "\n").unwrap();
    assert!(run().succeeded().stderr.contains("3 made now"));
    assert!(content(folder.path()) == whole, "other files");
    fs::write(&journal, text.replacen("downpour_job", "another_job", 1)).unwrap();
    run().failed(2, &["downpour-job", "the first line is damaged", "--overwrite"]);
    assert!(content(folder.path()) == whole, "other files");
}

/// A clip is not continued with other options or another scene; the message names the remedies.
#[test]
fn another_clip_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| clip(folder.path(), &[&["--frames", "0..2", "-o", "@%d.png"], more].concat());
    run(&[]).run().succeeded();
    let whole = content(folder.path());
    for (more, words) in [
        (&["--rate", "40"][..], &["begun with rate 400, and now it is 40"][..]),
        (&["--seed", "8"], &["begun with seed 7, and now it is 8"]),
        (&["--time", "0.5"], &["time 0, and now it is 0.5"]),
        (&["--refraction", "rousseau-2006"], &["refraction Direction"]),
    ] {
        let words =
            [words, &["allowed: the same as before to resume, another name, or --overwrite"]].concat();
        run(more).run().failed(2, &words);
    }
    let later = clip(folder.path(), &["--frames", "1..2", "-o", "@%d.png"]).run();
    later.failed(2, &["begun with first frame 0, and now it is 1"]);
    let weather =
        crate::scene_files::weather("").replace("zenith_color = [2, 3, 4]", "zenith_color = [2, 3, 5]");
    run(&[]).with_file("storm.toml", weather).run().failed(2, &["begun with another scene", "--overwrite"]);
    assert!(content(folder.path()) == whole, "other files");
    run(&["--rate", "40", "--overwrite"]).run().succeeded();
    assert!(content(folder.path()) != whole, "the same files");
    run(&["--overwrite"]).run().succeeded();
    assert!(content(folder.path()) == whole, "other files");
    // A clip that was started over files resumes without --overwrite.
    fs::remove_file(folder.path().join("1.png")).unwrap();
    run(&[]).run().succeeded();
    assert!(content(folder.path()) == whole, "other files");
}
