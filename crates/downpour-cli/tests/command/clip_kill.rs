//! A clip that is stopped, orderly or not, resumes: its frames are those of a clip that was not stopped.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::child::{PATIENCE, Running, names_in};
use crate::clip::{clip, content};

const ARGUMENTS: [&str; 6] = ["--frames", "0..8", "-o", "@%02d.png", "--dump-drops", "@%02d.csv"];

fn start(folder: &Path, arguments: &[&str]) -> Running {
    clip(folder, arguments).start()
}

/// Waits until there are `count` files of this kind.
fn wait_for(folder: &Path, end: &str, count: usize) {
    let begin = Instant::now();
    while names_in(folder).iter().filter(|name| name.ends_with(end)).count() < count {
        assert!(begin.elapsed() < PATIENCE, "{count} files {end}");
        sleep(Duration::from_millis(1));
    }
}

/// Killed repeatedly, at moments that move through the making of a frame, a file with a frame's name is the frame.
#[test]
fn a_kill_never_leaves_half_a_frame_and_the_clip_goes_on() {
    let reference = tempfile::tempdir().unwrap();
    start(reference.path(), &ARGUMENTS).end().succeeded();
    let whole = content(reference.path());
    assert_eq!(whole.len(), 16);
    let folder = tempfile::tempdir().unwrap();
    let mut killed = 0;
    for run in 0..16 {
        let before = names_in(folder.path()).iter().filter(|name| name.ends_with(".png")).count();
        let running = start(folder.path(), &ARGUMENTS);
        // Every third run is killed before it has made anything.
        if run % 3 != 0 && before < 8 {
            wait_for(folder.path(), ".png", before + 1);
        }
        sleep(Duration::from_micros(700 * run));
        running.signal("KILL");
        let ended = running.end();
        killed += usize::from(ended.code.is_none());
        assert!(ended.code.is_none() || ended.code == Some(0), "{}", ended.stderr);
        for (name, bytes) in content(folder.path()).iter().filter(|(name, _)| !name.ends_with(".part")) {
            assert!(
                whole.iter().any(|(known, other)| known == name && other == bytes),
                "{name} is not whole"
            );
        }
    }
    assert!(killed > 4, "{killed} runs were killed");
    start(folder.path(), &ARGUMENTS).end().succeeded();
    assert!(content(folder.path()) == whole, "other files");
}

#[test]
fn an_interrupt_drops_the_frame_and_keeps_the_clip() {
    let folder = tempfile::tempdir().unwrap();
    for signal in ["INT", "TERM"] {
        let before = names_in(folder.path()).iter().filter(|name| name.ends_with(".png")).count();
        let running = start(folder.path(), &["--frames", "0..100000", "-q", "-o", "@%d.png"]);
        wait_for(folder.path(), ".png", before + 2);
        running.signal(signal);
        let ended = running.end();
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(6), "downpour: canceled\n"));
        assert!(names_in(folder.path()).iter().all(|name| !name.ends_with(".part")));
    }
    let ended = start(folder.path(), &["--frames", "0..3", "-o", "@%d.png"]).end().succeeded();
    assert!(ended.stderr.contains("0 made now"), "{}", ended.stderr);
    let other = tempfile::tempdir().unwrap();
    start(other.path(), &["--frames", "0..3", "-o", "@%d.png"]).end().succeeded();
    let made = content(folder.path());
    assert!(content(other.path()).iter().all(|frame| made.contains(frame)));
}

#[test]
fn a_second_process_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--frames", "0..100000", "-o", "@%d.png"];
    let first = start(folder.path(), &arguments);
    wait_for(folder.path(), ".png", 1);
    for more in [&[][..], &["--overwrite"]] {
        let second = start(folder.path(), &[&arguments[..], more].concat()).end();
        second.failed(5, &["another downpour works on this clip", "allowed: to wait"]);
    }
    first.signal("INT");
    assert_eq!(first.end().code, Some(6));
    assert!(fs::metadata(folder.path().join("0.png")).is_ok());
    start(folder.path(), &["--frames", "0..1", "-o", "@%d.png"]).end().succeeded();
}
