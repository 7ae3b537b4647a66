//! Arguments in general, and a standard output that takes nothing.

use crate::child::downpour;

#[test]
fn help_and_version_are_results() {
    let help = downpour(&["--help"]).succeeded().stdout;
    for word in ["render", "check", "mask", "drop", "rain", "schema", "adapters", "Exit codes"] {
        assert!(help.contains(word), "{help}");
    }
    assert_eq!(
        downpour(&["--version"]).succeeded().stdout,
        format!("downpour {}\n", env!("CARGO_PKG_VERSION"))
    );
    for command in ["render", "check", "mask", "drop", "rain", "schema", "adapters"] {
        assert!(downpour(&[command, "--help"]).succeeded().stdout.contains("Usage: downpour"), "{command}");
    }
}

#[test]
fn what_is_not_known_is_refused_in_one_line() {
    for (arguments, words) in [
        (&[][..], &["no subcommand", "--help"][..]),
        (&["rian", "--rate", "1"], &["unrecognized subcommand 'rian'", "'rain'"]),
        (&["drop", "--diamter", "2"], &["'--diamter'", "'--diameter'"]),
        (&["drop", "--diameter", "2", "--diameter", "3"], &["--diameter", "multiple times"]),
        (&["drop", "--diameter", "2", "3"], &["'3'"]),
        (&["drop", "--diameter"], &["--diameter", "value is required"]),
        (&["drop", "--diameter", "a\nb\u{1b}[2J"], &["not a number"]),
        (&["adapters", "--verbose"], &["'--verbose'"]),
    ] {
        let ended = downpour(arguments).failed(2, words).with_one_line();
        assert!(!ended.stderr.contains('\u{1b}'), "{:?}", ended.stderr);
    }
    let long = "9".repeat(100_000);
    assert!(
        downpour(&["drop", "--diameter", &long])
            .failed(2, &["--diameter", "allowed: 0.001 to 9 mm"])
            .with_one_line()
            .stderr
            .len()
            < 3000
    );
}

#[test]
fn the_schema_is_json_with_the_keys_of_a_weather() {
    let schema: serde_json::Value = serde_json::from_str(&downpour(&["schema"]).succeeded().stdout).unwrap();
    assert_eq!(schema["properties"]["rain"]["properties"]["seed"]["minimum"], 0);
    downpour(&["schema", "rain"]).failed(2, &["'rain'"]);
}

/// A panic of `println!` would be exit code 101.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_an_error_of_files() {
    use std::fs::File;
    use std::process::{Command, Stdio};
    let full = || File::options().write(true).open("/dev/full").unwrap();
    for arguments in [&["drop", "--diameter", "2"][..], &["rain", "--rate", "2", "--json"], &["--help"]] {
        let output =
            Command::new(env!("CARGO_BIN_EXE_downpour")).args(arguments).stdout(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(5));
        assert!(String::from_utf8_lossy(&output.stderr).contains("downpour: error: standard output: "));
        let mut both = Command::new(env!("CARGO_BIN_EXE_downpour"));
        let status = both.args(arguments).stdout(full()).stderr(Stdio::from(full())).status().unwrap();
        assert_eq!(status.code(), Some(5));
    }
}

/// `downpour rain | head -0`.
#[cfg(unix)]
#[test]
fn a_closed_pipe_is_an_error_of_files() {
    use std::process::{Command, Stdio};
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = Command::new(env!("CARGO_BIN_EXE_downpour"));
    let status =
        command.args(["drop", "--diameter", "2"]).stdout(Stdio::from(writer)).stderr(Stdio::null()).status();
    assert_eq!(status.unwrap().code(), Some(5));
}
