//! Limits of memory that do not allow a thread per core, or any work.

use crate::child::{Downpour, Ended};

/// `check` of a small weather with 64 threads, under a limit of the address space: exit code and messages.
fn checked(mebibytes: u64) -> Ended {
    let limit = format!("-v {}", mebibytes * 1024);
    let run = Downpour::limited(&[&limit], &["check", "a.toml"]).env("RAYON_NUM_THREADS", "64");
    run.with_file("a.toml", "[rain]\nrate_mm_h = 5\n").run()
}

/// The work is done with the threads that fit.
#[test]
fn a_weather_is_checked_where_few_threads_can_start() {
    for mebibytes in [256, 320, 512] {
        checked(mebibytes).succeeded();
    }
}

/// Below the minimum of any work the command reports it, if the system can load the program at all.
#[test]
fn too_little_memory_for_any_work_is_refused() {
    for mebibytes in [40, 64, 96, 160, 255] {
        let ended = checked(mebibytes);
        let loaded = !(ended.code.is_none() || ended.code == Some(127));
        assert!(loaded || mebibytes < 96, "{mebibytes} MiB: {}", ended.stderr);
        if loaded {
            assert_eq!(ended.code, Some(3), "{mebibytes} MiB: {}", ended.stderr);
            let limit = format!("{mebibytes} MiB of address space; allowed: 256 MiB or more");
            assert!(ended.stderr.contains(&limit), "{}", ended.stderr);
        }
    }
}
