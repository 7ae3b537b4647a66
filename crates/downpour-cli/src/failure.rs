//! Failures of the command: a message of one line, and an exit code.

use std::fmt;
use std::io;
use std::path::Path;

use crate::exit_code::ExitCode;
pub(crate) use crate::exit_code::{FILES, INPUT, LIMIT, OTHER};

/// A message of one line, and an exit code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    pub(crate) code: u8,
    message: String,
}

impl Failure {
    pub(crate) fn new(code: u8, message: impl Into<String>) -> Self {
        Self { code, message: message.into() }
    }

    /// A file that the system does not let us write.
    pub(crate) fn file(path: &Path, error: &io::Error) -> Self {
        // The innermost error is the system's own; what is around it names the temporary file.
        let mut inner: &dyn std::error::Error = error;
        while let Some(source) = inner.source() {
            inner = source;
        }
        Self::new(FILES, format!("{}: {inner}", shown(path)))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl<E: ExitCode> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::new(error.exit_code(), error.message())
    }
}

impl From<&clap::Error> for Failure {
    /// clap writes paragraphs: what is wrong, tips, the usage. The first ones are kept, as one line.
    fn from(error: &clap::Error) -> Self {
        use clap::error::ErrorKind;
        let text = error.to_string();
        if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Self::new(INPUT, "no subcommand; `downpour --help` lists them");
        }
        let end = ["\n\nUsage:", "\n\nFor more information"].iter().filter_map(|mark| text.find(mark)).min();
        let kept = &text[..end.unwrap_or(text.len())];
        let kept = kept.strip_prefix("error: ").unwrap_or(kept);
        let paragraphs = kept.split("\n\n").map(|part| part.split_whitespace().collect::<Vec<_>>().join(" "));
        Self::new(INPUT, paragraphs.collect::<Vec<_>>().join("; "))
    }
}

/// A path in a message. A very long one is shown by its ends.
pub(crate) fn shown(path: &Path) -> String {
    const END: usize = 100;
    let text: Vec<char> = path.to_string_lossy().chars().collect();
    if text.len() <= 2 * END {
        return text.into_iter().collect();
    }
    let (head, tail) = (&text[..END], &text[text.len() - END..]);
    format!("{}...{}", head.iter().collect::<String>(), tail.iter().collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_paths_are_shown_by_their_ends() {
        assert_eq!(shown(Path::new("a/b.exr")), "a/b.exr");
        let long = format!("begin/{}/end.exr", "x".repeat(70_000));
        let short = shown(Path::new(&long));
        assert_eq!(short.chars().count(), 203);
        assert!(short.starts_with("begin/xx") && short.ends_with("x/end.exr"), "{short}");
    }
}
