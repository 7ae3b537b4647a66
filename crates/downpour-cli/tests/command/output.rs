//! Output files are complete or absent, and never replace files of others.

use std::fs;
use std::path::Path;

use downpour::mask::file::exr;

use crate::child::{Downpour, downpour, names_in};

const MASK: [&str; 8] = ["mask", "--diameter", "2", "--size", "16", "--backend", "cpu", "-o"];

fn to<'a>(output: &'a str, more: &[&'a str]) -> Downpour {
    Downpour::new(&[&MASK[..], &[output], more].concat())
}

#[test]
fn an_existing_file_is_kept_unless_it_is_to_be_overwritten() {
    let kept = to("m.exr", &[]).with_file("m.exr", "precious").run();
    let kept = kept.failed(5, &["m.exr exists", "--overwrite"]).with_one_line().left(&["m.exr"]);
    assert_eq!(kept.file("m.exr"), b"precious");
    let replaced = to("m.exr", &["--overwrite"]).with_file("m.exr", "old").run().succeeded().left(&["m.exr"]);
    assert!(exr::read_exr(&replaced.file("m.exr")).is_ok());
}

#[cfg(unix)]
#[test]
fn a_symbolic_link_is_neither_followed_nor_replaced() {
    for more in [&[][..], &["--overwrite"]] {
        for target in ["precious", "nothing"] {
            let run = to("m.exr", more).with_file("precious", "precious");
            std::os::unix::fs::symlink(target, run.folder().join("m.exr")).unwrap();
            let ended = run
                .run()
                .failed(5, &["m.exr is a symbolic link"])
                .with_one_line()
                .left(&["m.exr", "precious"]);
            assert_eq!(ended.file("precious"), b"precious");
            assert!(fs::symlink_metadata(ended.folder.path().join("m.exr")).unwrap().is_symlink());
        }
    }
}

#[test]
fn a_folder_that_is_not_there_is_an_error_of_files() {
    to("none/m.exr", &[]).run().failed(5, &["folder none"]).with_one_line().left(&[]);
    to("file/m.exr", &[]).with_file("file", "").run().failed(5, &["file is not a folder"]).left(&["file"]);
    let run = to("m.exr", &["--overwrite"]);
    fs::create_dir(run.folder().join("m.exr")).unwrap();
    run.run().failed(5, &["m.exr is not a plain file"]).with_one_line().left(&["m.exr"]);
    to(&format!("{}.exr", "x".repeat(300)), &[]).run().failed(5, &["xxx"]).with_one_line().left(&[]);
}

/// A folder without the right to write. Root may write anywhere, but not in /sys.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files_is_an_error_of_files() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
    let root = fs::write(folder.path().join("probe"), "").is_ok();
    let parent = if root { Path::new("/sys/kernel") } else { folder.path() };
    let output = parent.join("downpour-test.exr");
    to(output.to_str().unwrap(), &[]).run().failed(5, &["downpour-test.exr", "denied"]).with_one_line();
    assert!(!output.exists());
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn an_unknown_format_is_refused_before_anything_else() {
    for name in ["m.jpg", "m", "m.exr.gz", ".exr", "none/", "m.ex\u{202e}r"] {
        let ended =
            to(name, &[]).run().failed(2, &["allowed: .exr, .png or .ktx2"]).with_one_line().left(&[]);
        assert!(!ended.stderr.contains('\u{202e}'));
    }
    // Even before a model is looked for.
    downpour(&["mask", "--model", "none.glb", "-o", "m.gif"])
        .failed(2, &["m.gif", "allowed: .exr"])
        .left(&[]);
}

#[cfg(unix)]
#[test]
fn a_file_has_the_rights_of_the_umask() {
    use std::os::unix::fs::PermissionsExt;
    let run = Downpour::limited(&["-c 0 && umask 027"], &[&MASK[..], &["m.exr"]].concat());
    let ended = run.run().succeeded();
    let mode = fs::metadata(ended.folder.path().join("m.exr")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
}

/// As on a full disk: nothing under the final name, and no temporary file.
#[cfg(target_os = "linux")]
#[test]
fn a_write_that_fails_leaves_nothing() {
    // One block of 512 or 1024 bytes.
    Downpour::limited(&["-f 1"], &[&MASK[..], &["m.exr"]].concat())
        .run()
        .failed(5, &["error: m.exr: File too large (os error 27)"])
        .left(&[]);
    let run = Downpour::limited(&["-f 1"], &[&MASK[..], &["m.exr", "--overwrite"]].concat());
    let kept = run.with_file("m.exr", "old").run().failed(5, &["m.exr"]).left(&["m.exr"]);
    assert_eq!(kept.file("m.exr"), b"old");
}

#[test]
fn what_a_killed_process_left_is_removed() {
    let run = to("m.exr", &[]).with_file(".downpour-dead12.part", "half of a mask");
    assert_eq!(names_in(run.folder()), [".downpour-dead12.part"]);
    run.run().succeeded().left(&["m.exr"]);
}
