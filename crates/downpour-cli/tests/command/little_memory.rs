//! Limits of memory that leave no room for a thread on each core.

use crate::child::Downpour;

/// The work is done with the threads that there is room for, and with none of them by the first.
#[test]
fn a_weather_is_checked_where_no_thread_can_start() {
    let mut alone = 0;
    for mebibytes in [40, 64, 96, 160, 512] {
        let limit = format!("-v {}", mebibytes * 1024);
        let run = Downpour::limited(&[&limit], &["check", "a.toml"]).env("RAYON_NUM_THREADS", "64");
        let ended = run.with_file("a.toml", "[rain]\nrate_mm_h = 5\n").run();
        assert!(!ended.stderr.contains("internal error"), "{mebibytes} MiB: {}", ended.stderr);
        // Below some size the loader finds no room for the program itself.
        if ended.code.is_none() || ended.code == Some(127) {
            assert!(mebibytes < 160, "{mebibytes} MiB: {}", ended.stderr);
        } else {
            alone += usize::from(mebibytes < 160);
            ended.succeeded();
        }
    }
    println!("{alone} runs under limits that hold no 64 threads");
}
