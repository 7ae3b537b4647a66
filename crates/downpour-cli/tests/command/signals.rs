//! Signals: an orderly end, or a sudden one.

use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use downpour::mask::file::exr;

use crate::child::{Downpour, Ended, Running, names_in};
use crate::scene_files::storm;

/// Sends a signal after some milliseconds: the work ends early with a message.
fn interrupted(running: Running, signal: &str, wait: u64) -> Ended {
    sleep(Duration::from_millis(wait));
    running.signal(signal);
    let ended = running.end();
    assert_eq!(ended.code, Some(6), "{}", ended.stderr);
    assert_eq!(ended.stderr, "downpour: canceled\n");
    ended
}

#[test]
fn an_interrupt_ends_the_work_at_once_and_leaves_nothing() {
    for (signal, wait) in [("INT", 300), ("TERM", 300), ("INT", 1500)] {
        let arguments = ["mask", "--diameter", "2", "--size", "4096", "--backend", "cpu", "-o", "m.exr"];
        let running = Downpour::new(&arguments).start();
        interrupted(running, signal, wait).left(&[]);
    }
}

/// In the middle of a picture, and while a weather is read.
#[test]
fn an_interrupt_ends_a_picture_at_once_and_leaves_nothing() {
    for (signal, wait) in [("INT", 100), ("TERM", 1200)] {
        let arguments = ["render", "--size=4096x2304", "-o", "a.png", "--stats", "a.json"];
        let running = storm(&arguments).start();
        interrupted(running, signal, wait).left(&["floor.gltf", "storm.toml"]);
    }
}

/// The file under the final name is the old one or the new one, whenever the process is killed; the next run removes
/// leftovers.
#[test]
fn a_kill_never_leaves_half_a_file_under_the_final_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.exr");
    let size_of = |path: &Path| exr::read_exr(&std::fs::read(path).unwrap()).unwrap().size;
    let mask = |size: &str| {
        Downpour::new(&[
            "mask",
            "--diameter",
            "2",
            "--backend=cpu",
            "--overwrite",
            "--size",
            size,
            "-o",
            path.to_str().unwrap(),
        ])
    };
    mask("16").run().succeeded();
    let begin = Instant::now();
    mask("256").run().succeeded();
    let mut whole = begin.elapsed();
    mask("16").run().succeeded();
    let mut killed = 0;
    for part in 0..16u32 {
        let running = mask("256").start();
        // Most of the time is spent on the work; the last part is the writing.
        sleep(whole.mul_f64(0.6 + 0.5 * f64::from(part) / 16.0));
        running.signal("KILL");
        if running.end().code.is_none() {
            killed += 1;
        } else {
            // It was finished: the machine is less busy than when the run was timed.
            whole = whole.mul_f64(0.8);
        }
        assert!(matches!(size_of(&path), 16 | 256));
        mask("16").run().succeeded();
        assert_eq!(names_in(folder.path()), ["m.exr"]);
    }
    assert!(killed > 0, "every run was over before its kill");
}
