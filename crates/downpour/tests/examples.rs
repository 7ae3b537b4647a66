//! The examples `render_weather` and `clip` run and write pictures.

use std::path::{Path, PathBuf};
use std::process::Command;

/// An example beside this test: cargo builds both.
fn example(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("the path of this test");
    let folder = test.parent().and_then(|deps| deps.parent()).expect("the folder of the build");
    folder.join("examples").join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

/// Runs an example, and returns what it printed.
fn run(name: &str, arguments: &[&str]) -> String {
    let ended = Command::new(example(name)).args(arguments).output().expect("the example");
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    String::from_utf8_lossy(&ended.stdout).into_owned()
}

fn picture(path: &Path) -> image::RgbImage {
    image::open(path).expect("a picture").to_rgb8()
}

#[test]
fn a_weather_file_is_a_picture_in_twenty_lines() {
    let source = include_str!("../examples/render_weather.rs");
    assert!(source.lines().count() <= 20, "{} lines", source.lines().count());
    let folder = tempfile::tempdir().expect("a folder");
    let [input, output] = ["in.toml", "out.png"].map(|name| folder.path().join(name));
    let weather = "[rain]\nrate_mm_h = 60\n[sky]\nzenith_color = [0.4, 0.45, 0.5]\n[camera]\nposition_m = [0, 1.6, 0]\n\
                   fov_deg = 30\n[output]\nsize = [64, 48]\n";
    std::fs::write(&input, weather).expect("a weather file");
    let printed = run("render_weather", &[&input, &output].map(|path| path.to_str().expect("a name")));
    assert!(printed.contains("drops on"), "{printed}");
    let made = picture(&output);
    assert_eq!(made.dimensions(), (64, 48));
    assert!(made.pixels().any(|pixel| pixel != made.get_pixel(0, 0)), "a picture of one color");
}

#[test]
fn a_clip_is_a_folder_of_frames() {
    let folder = tempfile::tempdir().expect("a folder");
    let printed = run("clip", &[folder.path().to_str().expect("a name"), "2", "96"]);
    assert!(printed.starts_with("2 frames in"), "{printed}");
    let [first, second] = ["0000.png", "0001.png"].map(|name| picture(&folder.path().join(name)));
    assert_eq!(
        (first.dimensions(), std::fs::read_dir(folder.path()).expect("a folder").count()),
        ((96, 54), 2)
    );
    let differ = first.pixels().zip(second.pixels()).filter(|(a, b)| a != b).count();
    assert!(differ > 96 * 54 / 20, "{differ} pixels differ between two frames");
}
