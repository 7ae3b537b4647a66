//! The example `your_wgpu_app` runs without a window and saves frames in which it rains.

#![cfg(feature = "wgpu")]

use std::path::PathBuf;
use std::process::Command;

/// The example beside this test: cargo builds both.
fn example() -> PathBuf {
    let test = std::env::current_exe().expect("the path of this test");
    let folder = test.parent().and_then(|deps| deps.parent()).expect("the folder of the build");
    folder.join("examples").join(format!("your_wgpu_app{}", std::env::consts::EXE_SUFFIX))
}

#[test]
fn the_example_saves_frames_without_a_window() {
    if std::env::var("DOWNPOUR_GPU_TESTS").is_ok_and(|value| value == "no") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| Command::new(example()).args(arguments).output().unwrap();
    let save = folder.path().to_str().unwrap();
    let done = run(&["--frames", "3", "--size", "192x108", "--save", save]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let frames: Vec<_> =
        (0..3).map(|k| image::open(folder.path().join(format!("{k:04}.png"))).unwrap().to_rgb8()).collect();
    for pair in frames.windows(2) {
        let differ = pair[0].pixels().zip(pair[1].pixels()).filter(|(a, b)| a != b).count();
        assert!(differ > 192 * 108 / 10, "{differ} pixels differ between two frames");
    }
    // Lamps and lit windows beside the night.
    assert!(frames[0].pixels().any(|p| p.0[0] > 240) && frames[0].pixels().any(|p| p.0[0] < 60));
    let refused = run(&["--depth", "3"]);
    assert!(!refused.status.success());
    assert!(String::from_utf8_lossy(&refused.stderr).contains("allowed: --frames N"), "{refused:?}");
}
