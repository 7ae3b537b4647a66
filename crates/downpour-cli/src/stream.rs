//! Standard output and standard error. Neither being closed nor being full may end in a panic.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{self, Write as _};

use crate::failure::{FILES, Failure};

/// Maximum length of a message, in characters. Arguments come from scripts too.
const MAX_CHARS: usize = 2000;

/// Writes a result to standard output.
///
/// # Errors
/// A closed pipe or a full disk: exit code 5.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|error| Failure::new(FILES, format!("standard output: {error}")))
}

/// Writes one line to standard error, prefixed with the name of the command. If it cannot be written, the error is
/// ignored.
pub(crate) fn message(text: &str) {
    let line = format!("downpour: {}\n", one_line(text));
    let _ = io::stderr().lock().write_all(line.as_bytes());
}

/// Text with everything escaped that would break the line or steer a terminal, and shortened if it is very long.
pub(crate) fn one_line(text: &str) -> String {
    let mut line = String::new();
    for c in shortened(text).chars() {
        if c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        {
            let _ = write!(line, "{}", c.escape_default());
        } else {
            line.push(c);
        }
    }
    line
}

/// Shortens a very long text to its ends: the error is at the beginning, the allowed values at the end.
fn shortened(text: &str) -> Cow<'_, str> {
    const END: usize = MAX_CHARS / 2;
    let count = text.chars().count();
    if count <= MAX_CHARS {
        return Cow::Borrowed(text);
    }
    let head = text.chars().take(END);
    let tail = text.chars().skip(count - END);
    Cow::Owned(head.chain("...".chars()).chain(tail).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_one_harmless_line() {
        assert_eq!(one_line("a\nb\u{1b}[2J\u{202e}ß \"c\""), "a\\nb\\u{1b}[2J\\u{202e}ß \"c\"");
        let long = one_line(&format!("begin{}end", "x".repeat(100_000)));
        assert_eq!(long.len(), MAX_CHARS + 3);
        assert!(long.starts_with("beginxx") && long.ends_with("xxend"));
    }
}
