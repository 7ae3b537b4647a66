//! `render --watch`.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::scene_files::{NO_SPLASHES, storm, weather};

/// Waits until a file's bytes are others than these.
fn changed(path: &Path, before: Option<&[u8]>) -> Vec<u8> {
    let begin = Instant::now();
    loop {
        if let Ok(bytes) = fs::read(path)
            && before != Some(&bytes)
        {
            return bytes;
        }
        assert!(begin.elapsed() < Duration::from_secs(600), "the picture did not change");
        sleep(Duration::from_millis(50));
    }
}

/// The picture follows the file; a broken file leaves the last good one, bit for bit.
#[test]
fn the_picture_follows_the_file() {
    let command = storm(&["render", "-o", "a.png", "--watch"]);
    let (picture, file) = (command.folder().join("a.png"), command.folder().join("storm.toml"));
    let running = command.start();
    let first = changed(&picture, None);
    fs::write(&file, "[rain]\nrate_mm_h = 900").unwrap();
    sleep(Duration::from_secs(1));
    assert_eq!(fs::read(&picture).unwrap(), first);
    fs::write(&file, weather("[wetness]\nenabled = false\n").replace("[2, 3, 4]", "[4, 3, 2]")).unwrap();
    let second = changed(&picture, Some(&first));
    fs::write(&file, weather(NO_SPLASHES)).unwrap();
    assert_eq!(changed(&picture, Some(&second)), first);
    running.signal("INT");
    let ended = running.end();
    assert_eq!(ended.code, Some(6), "{}", ended.stderr);
    let error = "downpour: error: storm.toml: line 2, column 13: rain.rate_mm_h: 900";
    assert!(ended.stderr.contains(error), "{}", ended.stderr);
    ended.left(&["a.png", "floor.gltf", "storm.toml"]);
}

/// A picture of somebody else is not replaced.
#[test]
fn a_taken_name_is_refused() {
    let ended = storm(&["render", "-o", "a.png", "--watch"]).with_file("a.png", "mine").run();
    ended.failed(5, &["a.png exists", "--overwrite"]);
}
