//! Errors of files, each in one line that a person can act on.
//!
//! Text that came from outside is shown through `quoted`: shortened, and with control characters escaped, so
//! that a message never moves a terminal's cursor or breaks a log into two lines.

use std::fmt;
use std::io;
use std::path::Path;

/// The longest piece of foreign text in a message, in characters.
const SHOWN: usize = 80;

/// Reason why a file could not be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The content of the file is invalid or not supported.
    #[error("{0}")]
    BadInput(Box<Fault>),
    /// The content of the file is valid, but costs more than a budget or a fixed limit allows.
    #[error("{0}")]
    OverLimit(Box<Fault>),
    /// The file is not there, or cannot be opened or read.
    #[error("{0}")]
    Unreadable(Box<Fault>),
}

/// One fault: where it is, what was found there and what would be accepted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The file as the user knows it; empty until the reader has named it.
    pub file: String,
    /// The location inside the file, as `accessors[3].count`; empty when it is the file as a whole.
    pub location: String,
    /// The content found.
    pub found: String,
    /// The accepted content.
    pub allowed: String,
    /// Advice for the user.
    pub advice: Option<&'static str>,
}

impl SceneError {
    /// Error of input that cannot be.
    #[must_use]
    pub fn bad(location: impl fmt::Display, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self::BadInput(Fault::boxed(location, found, allowed))
    }

    /// Error of input that costs too much.
    #[must_use]
    pub fn limit(location: impl fmt::Display, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self::OverLimit(Fault::boxed(location, found, allowed))
    }

    /// A file that the system does not hand out. A name that no file can have is the input's fault.
    ///
    /// `name` is empty when the message begins with the file anyway.
    pub(crate) fn io(location: impl fmt::Display, name: &str, error: &io::Error) -> Self {
        let found = format!("{}cannot be read: {}", subject(name), escaped(&error.to_string()));
        let allowed = "a file that can be opened and read";
        match error.kind() {
            io::ErrorKind::InvalidFilename | io::ErrorKind::InvalidInput => {
                Self::bad(location, found, allowed)
            }
            _ => Self::Unreadable(Fault::boxed(location, found, allowed)),
        }
    }

    /// The same error with advice at its end.
    #[must_use]
    pub fn with_advice(mut self, advice: &'static str) -> Self {
        self.fault_mut().advice = Some(advice);
        self
    }

    /// The same error with the file named; a name that is there already stays.
    #[must_use]
    pub fn in_file(mut self, file: &str) -> Self {
        let fault = self.fault_mut();
        if fault.file.is_empty() {
            file.clone_into(&mut fault.file);
        }
        self
    }

    /// The same error with its location; a location that is set already is kept.
    #[must_use]
    pub fn at(mut self, location: impl fmt::Display) -> Self {
        let fault = self.fault_mut();
        if fault.location.is_empty() {
            fault.location = location.to_string();
        }
        self
    }

    /// The same error, of a file that another file names at `location`: that location and the file name come first.
    #[must_use]
    pub fn inside(mut self, location: impl fmt::Display) -> Self {
        let fault = self.fault_mut();
        let file = std::mem::take(&mut fault.file);
        let mut whole = location.to_string();
        for part in [file, std::mem::take(&mut fault.location)] {
            if !part.is_empty() {
                whole.push_str(": ");
                whole.push_str(&part);
            }
        }
        fault.location = whole;
        self
    }

    /// The parts of the message.
    #[must_use]
    pub fn fault(&self) -> &Fault {
        match self {
            Self::BadInput(fault) | Self::OverLimit(fault) | Self::Unreadable(fault) => fault,
        }
    }

    fn fault_mut(&mut self) -> &mut Fault {
        match self {
            Self::BadInput(fault) | Self::OverLimit(fault) | Self::Unreadable(fault) => fault,
        }
    }
}

impl Fault {
    fn boxed(location: impl fmt::Display, found: impl Into<String>, allowed: impl Into<String>) -> Box<Self> {
        let (location, found, allowed) = (location.to_string(), found.into(), allowed.into());
        Box::new(Self { file: String::new(), location, found, allowed, advice: None })
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for part in [&self.file, &self.location] {
            if !part.is_empty() {
                write!(f, "{part}: ")?;
            }
        }
        write!(f, "{}; allowed: {}", self.found, self.allowed)?;
        self.advice.map_or(Ok(()), |advice| write!(f, " ({advice})"))
    }
}

/// Foreign text in quotes, at most 80 characters, on one line.
#[must_use]
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", shortened(text, &['\'']))
}

/// A name at the beginning of a sentence; nothing if there is none.
pub(crate) fn subject(name: &str) -> String {
    if name.is_empty() { String::new() } else { format!("{} ", quoted(name)) }
}

/// Foreign text without quotes, at most 80 characters, on one line.
#[must_use]
pub fn escaped(text: &str) -> String {
    shortened(text, &['\'', '"'])
}

/// Text with everything escaped that does not print, but for quotation marks that do no harm.
fn shortened(text: &str, harmless: &[char]) -> String {
    let mut shown = String::new();
    let mut left = SHOWN;
    for c in text.chars() {
        let piece = if harmless.contains(&c) { c.to_string() } else { c.escape_debug().to_string() };
        // One character is kept for the ellipsis.
        match left.checked_sub(piece.chars().count()).filter(|&rest| rest > 0) {
            Some(rest) => left = rest,
            None => {
                shown.push('…');
                break;
            }
        }
        shown.push_str(&piece);
    }
    shown
}

/// A path for a message: a long one is shown by its end.
#[must_use]
pub fn shown_path(path: &Path) -> String {
    let text = path.to_string_lossy();
    match text.char_indices().rev().nth(SHOWN.saturating_sub(3)) {
        Some((at, _)) if at > 0 => format!("…{}", escaped(text.get(at..).unwrap_or_default())),
        _ => escaped(&text),
    }
}

/// A number of bytes in a readable unit.
pub(crate) fn size(bytes: u64) -> String {
    let mut scale = (bytes as f64, "bytes");
    for unit in ["KiB", "MiB", "GiB", "TiB", "PiB", "EiB"] {
        if scale.0 < 10_240.0 {
            break;
        }
        scale = (scale.0 / 1024.0, unit);
    }
    format!("{:.0} {}", scale.0, scale.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_text_is_short_and_on_one_line() {
        assert_eq!(quoted("it's a \"name\""), r#""it's a \"name\"""#);
        assert_eq!(quoted("a\n\u{1b}[2J\u{202e}b"), r#""a\n\u{1b}[2J\u{202e}b""#);
        for long in ["x".repeat(70_000), "\u{1b}".repeat(70_000), "ß".repeat(81)] {
            let shown = escaped(&long);
            assert!(shown.chars().count() <= SHOWN && shown.ends_with('…'), "{shown}");
        }
        assert_eq!(escaped(&"y".repeat(79)), "y".repeat(79));
        let path = format!("{}/end.glb", "folder/".repeat(10_000));
        let shown = shown_path(Path::new(&path));
        assert!(shown.chars().count() <= SHOWN && shown.ends_with("/end.glb"), "{shown}");
        assert_eq!(shown_path(Path::new("a/b.glb")), "a/b.glb");
    }

    #[test]
    fn sizes_keep_their_meaning() {
        assert_eq!(size(10_239), "10239 bytes");
        assert_eq!(size(10_240), "10 KiB");
        assert_eq!(size(2 << 40), "2048 GiB");
        assert_eq!(size(u64::MAX), "16 EiB");
    }
}
