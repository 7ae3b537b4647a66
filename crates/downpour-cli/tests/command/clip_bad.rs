//! Invalid input of `render --frames`. Code, one line, nothing written.

use std::fs;

use crate::child::{Downpour, Ended, downpour, names_in};
use crate::clip::clip;
use crate::scene_files::{NO_SPLASHES, model, storm, weather};

fn render(arguments: &[&str]) -> Ended {
    let fixed = ["render", "storm.toml", "--backend", "cpu", "--samples", "1", "--size", "32x18"];
    let run = Downpour::new(&[&fixed, arguments].concat());
    run.with_file("storm.toml", weather(NO_SPLASHES)).with_file("floor.gltf", model()).run()
}

#[test]
fn bad_clips_are_refused() {
    let (range, rate, name) =
        ("allowed: A..B", "allowed: 0.001 to 1000", "allowed: a name with one %d or %04d");
    for (frames, fps, output, code, words) in [
        ("0..0", "24", "%d.png", 2, &["--frames", "'0..0'", range][..]),
        ("5..2", "24", "%d.png", 2, &["--frames", range]),
        ("-1..2", "24", "%d.png", 2, &["--frames", range]),
        ("0..=2", "24", "%d.png", 2, &["--frames", range]),
        ("7", "24", "%d.png", 2, &["--frames", range]),
        ("0..nan", "24", "%d.png", 2, &["--frames", range]),
        ("0..4294967296", "24", "%d.png", 2, &["--frames", range, "1000000"]),
        ("0..2", "0", "%d.png", 2, &["--fps", "'0'", rate]),
        ("0..2", "-24", "%d.png", 2, &["--fps", rate]),
        ("0..2", "NaN", "%d.png", 2, &["--fps", rate]),
        ("0..2", "inf", "%d.png", 2, &["--fps", rate]),
        ("0..2", "1e-9", "%d.png", 2, &["--fps", rate]),
        ("0..2", "1001", "%d.png", 2, &["--fps", rate]),
        ("999..1002", "0.001", "%d.png", 2, &["frame 1001 is at", "up to 1000000 s"][..]),
        ("0..2", "24", "a.png", 2, &["a.png", name]),
        ("0..2", "24", "%d_%d.png", 2, &[name]),
        ("0..2", "24", "%99999d.png", 2, &[name]),
        ("0..2", "24", "%s.png", 2, &[name]),
        ("0..2", "24", "%4d.exr", 2, &[name]),
        ("0..2", "24", "%d/a.png", 2, &[name]),
        ("0..2", "24", "{frame:99999d}.png", 2, &[name]),
        ("0..2", "24", "%d.gif", 2, &["%d.gif", "allowed: numbered .exr or .png", ".mp4"]),
        ("0..2", "24", "%d", 2, &["allowed: numbered .exr or .png"]),
        ("0..2", "24", "none/%d.png", 5, &["folder none"]),
        ("0..2", "24", "floor.gltf/%d.png", 5, &["floor.gltf is not a folder"]),
    ] {
        let ended = render(&["--frames", frames, "--fps", fps, "-o", output]);
        ended.failed(code, words).with_one_line().left(&["floor.gltf", "storm.toml"]);
    }
    let clip = ["--frames", "0..2", "--fps", "24", "-o", "%d.png"];
    for (more, code, words) in [
        (&["--layers"][..], 2, &["--layers", "for .exr only"][..]),
        (&["--dump-drops", "drops.csv"], 2, &["drops.csv", "%04d"]),
        (&["--dump-drops", "%d.txt"], 2, &["allowed: .csv"]),
        (&["--dump-drops", "none/%d.csv"], 5, &["folder none"]),
        (&["--stats", "none/a.json"], 5, &["folder none"]),
    ] {
        let ended = render(&[&clip, more].concat());
        ended.failed(code, words).with_one_line().left(&["floor.gltf", "storm.toml"]);
    }
    render(&["--frames", "0..2", "-o", "%d.png"]).failed(2, &["--fps"]).with_one_line();
    render(&["--fps", "24", "-o", "a.png"]).failed(2, &["--frames"]).with_one_line();
    render(&["-o", "a.mp4"]).failed(2, &["a.mp4", "--frames"]).with_one_line();
    let long = format!("{}%d.png", "x".repeat(70_000));
    render(&["--frames", "0..2", "--fps", "24", "-o", &long]).failed(2, &["255 bytes"]).with_one_line();
    downpour(&["render", "none.toml", "--frames", "0..2", "--fps", "9", "-o", "%d.png"])
        .failed(5, &["none.toml"])
        .with_one_line()
        .left(&[]);
}

/// Without --frames a percent sign is one.
#[test]
fn a_single_picture_is_not_numbered() {
    let arguments = ["render", "--size", "4x4", "-q", "-o", "%d.png"];
    storm(&arguments).run().succeeded().left(&["%d.png", "floor.gltf", "storm.toml"]);
}

#[test]
fn files_that_are_not_of_the_clip_are_kept() {
    for taken in ["1.png", "1.csv", "a.json"] {
        let run = storm(&[
            "render",
            "--frames",
            "0..3",
            "--fps",
            "8",
            "-o",
            "%d.png",
            "--dump-drops",
            "%d.csv",
            "--stats",
            "a.json",
        ]);
        let ended = run.with_file(taken, "precious").run();
        let ended = ended.failed(5, &[taken, "exists", "--overwrite"]).with_one_line();
        assert_eq!(ended.file(taken), b"precious");
        let mut names = ["floor.gltf", "storm.toml", taken];
        names.sort_unstable();
        ended.left(&names);
    }
    // A frame of the clip outside the range is ignored.
    let run = storm(&["render", "--size", "8x8", "-q", "--frames", "0..1", "--fps", "8", "-o", "%d.png"]);
    let ended = run.with_file("1.png", "precious").run().succeeded();
    assert_eq!(ended.file("1.png"), b"precious");
}

/// A sky that would be overwritten by a frame.
#[test]
fn an_input_is_not_a_frame() {
    let sky = downpour::render::file::write_exr(2, 1, &[[1.0; 3]; 2]).unwrap();
    let text = weather(NO_SPLASHES).replace("zenith_color = [2, 3, 4]", "file = '01.exr'");
    let run = storm(&["render", "--frames", "0..3", "--fps", "8", "-o", "%02d.exr", "--overwrite"]);
    let ended = run.with_file("01.exr", &sky).with_file("storm.toml", &text).run();
    let ended = ended.failed(2, &["01.exr is an input", "allowed: another name"]).with_one_line();
    assert_eq!(ended.file("01.exr"), sky);
}

/// Neither a frame nor the journal is written through a link.
#[cfg(unix)]
#[test]
fn symbolic_links_are_neither_followed_nor_replaced() {
    for (link, more) in [
        ("1.png", &[][..]),
        ("1.png", &["--overwrite"]),
        (".%d.png.downpour-job", &[]),
        (".%d.png.downpour-job", &["--overwrite"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("precious"), "precious").unwrap();
        std::os::unix::fs::symlink("precious", folder.path().join(link)).unwrap();
        let run = clip(folder.path(), &[&["--frames", "0..3", "-o", "@%d.png"], more].concat());
        run.run().failed(5, &[link, "plain file"]);
        assert_eq!(fs::read(folder.path().join("precious")).unwrap(), b"precious");
        assert_eq!(names_in(folder.path()), [link, "precious"]);
    }
}

/// A folder without the right to write. Root may write anywhere, but not in /sys.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files_is_an_error_of_files() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
    let root = fs::write(folder.path().join("probe"), "").is_ok();
    let parent = if root { std::path::Path::new("/sys/kernel") } else { folder.path() };
    clip(parent, &["--frames", "0..2", "-o", "@%d.png"]).run().failed(5, &["%d.png", "denied"]);
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
}

/// As on a full disk: published files stay, unpublished ones leave nothing, and the clip resumes once there is space.
#[cfg(target_os = "linux")]
#[test]
fn a_write_that_fails_leaves_what_was_whole() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("%d.exr");
    let arguments = ["render", "storm.toml", "--backend", "cpu", "--samples", "1", "--sky-rays", "1"];
    let clip = ["--size", "64x36", "--frames", "0..2", "--fps", "8", "-o", output.to_str().unwrap()];
    let run = |limits: &[&str]| {
        let run = Downpour::limited(limits, &[&arguments[..], &clip].concat());
        run.with_file("storm.toml", weather(NO_SPLASHES)).with_file("floor.gltf", model()).run()
    };
    // Blocks of 512 or 1024 bytes: enough for the journal, not for a frame.
    run(&["-f 6"]).failed(5, &["0.exr: File too large"]);
    assert_eq!(names_in(folder.path()), [".%d.exr.downpour-job"]);
    run(&["-c 0"]).succeeded();
    assert_eq!(names_in(folder.path()), [".%d.exr.downpour-job", "0.exr", "1.exr"]);
}
