//! One run of the command, and its results.

use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

/// Time limit for a run on a busy machine, after which it counts as hanging.
pub(crate) const PATIENCE: Duration = Duration::from_secs(600);

/// A run of the command in a separate folder.
pub(crate) struct Downpour {
    folder: TempDir,
    output: TempDir,
    command: Command,
}

/// A run that has ended.
pub(crate) struct Ended {
    /// The folder that it ran in.
    pub(crate) folder: TempDir,
    /// Exit code; `None` if a signal ended it.
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Downpour {
    /// The command with its arguments.
    pub(crate) fn new<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_downpour"));
        command.args(arguments);
        Self::of(command)
    }

    /// Any command line, such as one that sets limits first.
    fn of(mut command: Command) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let output = tempfile::tempdir().expect("a folder");
        // Mesa needs a separate folder, and complains without one.
        command.current_dir(&folder).stdin(Stdio::null()).env("XDG_RUNTIME_DIR", output.path());
        command.env_remove("DOWNPOUR_INJECT");
        Self { folder, output, command }
    }

    /// The command under limits of a Unix shell: `ulimit` with these options.
    #[cfg(unix)]
    pub(crate) fn limited<S: AsRef<std::ffi::OsStr>>(limits: &[&str], arguments: &[S]) -> Self {
        let limits: String = limits.iter().map(|limit| format!("ulimit {limit} && ")).collect();
        let mut command = Command::new("sh");
        command.arg("-c").arg(format!("{limits}exec \"$0\" \"$@\"")).arg(env!("CARGO_BIN_EXE_downpour"));
        command.args(arguments);
        Self::of(command)
    }

    pub(crate) fn env(mut self, key: &str, value: impl AsRef<std::ffi::OsStr>) -> Self {
        self.command.env(key, value);
        self
    }

    /// A file in the folder that the command will run in.
    pub(crate) fn with_file(self, name: &str, bytes: impl AsRef<[u8]>) -> Self {
        fs::write(self.folder.path().join(name), bytes).expect("a file");
        self
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Starts it.
    pub(crate) fn start(mut self) -> Running {
        let file = |name: &str| File::create(self.output.path().join(name)).expect("a file");
        self.command.stdout(file("stdout")).stderr(file("stderr"));
        let child = self.command.spawn().expect("the command starts");
        Running { child, folder: self.folder, output: self.output }
    }

    /// Runs it to its end.
    pub(crate) fn run(self) -> Ended {
        self.start().end()
    }
}

/// A run that has not ended.
pub(crate) struct Running {
    child: Child,
    folder: TempDir,
    output: TempDir,
}

impl Running {
    #[cfg(unix)]
    pub(crate) fn signal(&self, name: &str) {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args(["-s", name, &id]).status().expect("kill").success());
    }

    pub(crate) fn end(mut self) -> Ended {
        let begin = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().expect("a child") {
                break status;
            }
            if begin.elapsed() > PATIENCE {
                self.child.kill().expect("a child that can be ended");
                panic!("the command did not end within {PATIENCE:?}");
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        let text = |name: &str| -> io::Result<String> {
            Ok(String::from_utf8_lossy(&fs::read(self.output.path().join(name))?).into_owned())
        };
        Ended {
            code: status.code(),
            stdout: text("stdout").expect("what it wrote"),
            stderr: text("stderr").expect("what it wrote"),
            folder: self.folder,
        }
    }
}

impl Ended {
    /// It succeeded.
    #[track_caller]
    pub(crate) fn succeeded(self) -> Self {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
        self
    }

    /// It ended with this code, one line of error with these words, and no result.
    #[track_caller]
    pub(crate) fn failed(self, code: i32, words: &[&str]) -> Self {
        assert_eq!(self.code, Some(code), "{}", self.stderr);
        let lines: Vec<&str> =
            self.stderr.lines().filter(|line| line.starts_with("downpour: error: ")).collect();
        let [line] = lines[..] else { panic!("not one line of error: {}", self.stderr) };
        assert!(!line.contains("internal error"), "{line}");
        for word in words {
            assert!(line.contains(word), "no \"{word}\" in: {line}");
        }
        self
    }

    /// Nothing but the one line of error was written to standard error, and nothing to standard output.
    #[track_caller]
    pub(crate) fn with_one_line(self) -> Self {
        assert_eq!(self.stderr.lines().count(), 1, "{}", self.stderr);
        assert_eq!(self.stdout, "");
        self
    }

    /// Nothing was written to standard error.
    #[track_caller]
    pub(crate) fn without_a_word(self) -> Self {
        assert_eq!(self.stderr, "");
        self
    }

    /// The files of its folder are these, and no others: no temporary file either.
    #[track_caller]
    pub(crate) fn left(self, names: &[&str]) -> Self {
        assert_eq!(names_in(self.folder.path()), names);
        self
    }

    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).expect("JSON")
    }

    #[track_caller]
    pub(crate) fn file(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder.path().join(name)).expect("a file")
    }
}

/// The names in a folder, in order.
pub(crate) fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("a name").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Runs the command with arguments.
pub(crate) fn downpour(arguments: &[&str]) -> Ended {
    Downpour::new(arguments).run()
}
