//! Numbered names: `frames/%04d.png`.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, INPUT, shown};

/// The most digits that a number may be filled up to.
const MAX_DIGITS: usize = 9;

/// The longest name that file systems take, in bytes.
const MAX_NAME: usize = 255;

/// A file name with a placeholder for a number, as in C's `printf`: `%d`, or `%04d` for at least four digits. `%%` is a
/// percent sign. Only the name of the file has the placeholder; the folder is literal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Pattern {
    whole: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    /// Reads a pattern.
    ///
    /// # Errors
    /// Exit code 2 for a name without a placeholder, with several, or with an invalid one.
    pub(super) fn parse(path: &Path) -> Result<Self, Failure> {
        let refused = || {
            let allowed = "a name with one %d or %04d, for example frames/%04d.png (%% is a percent sign)";
            Failure::new(INPUT, format!("output {} for numbered files; allowed: {allowed}", shown(path)))
        };
        let name = path.file_name().and_then(|name| name.to_str()).ok_or_else(refused)?;
        let (mut parts, mut digits) = ((String::new(), String::new()), None);
        let mut rest = name.chars().peekable();
        while let Some(c) = rest.next() {
            let part = if digits.is_none() { &mut parts.0 } else { &mut parts.1 };
            if c != '%' {
                part.push(c);
                continue;
            }
            if rest.next_if_eq(&'%').is_some() {
                part.push('%');
                continue;
            }
            let mut width = String::new();
            while let Some(digit) = rest.next_if(char::is_ascii_digit) {
                width.push(digit);
            }
            // Without the 0 before it, C fills up with blanks.
            let filled = width.strip_prefix('0').and_then(|width| width.parse().ok());
            let found = if width.is_empty() { Some(1) } else { filled };
            let found = found.filter(|found| (1..=MAX_DIGITS).contains(found));
            let (Some('d'), Some(found), None) = (rest.next(), found, digits) else { return Err(refused()) };
            digits = Some(found);
        }
        let digits = digits.ok_or_else(refused)?;
        // A number may have seven digits even if fewer are requested.
        if parts.0.len() + parts.1.len() + digits.max(7) > MAX_NAME {
            let found = format!("output {} for numbered files", shown(path));
            return Err(Failure::new(INPUT, format!("{found}; allowed: a name of at most {MAX_NAME} bytes")));
        }
        Ok(Self { whole: path.to_owned(), before: parts.0, digits, after: parts.1 })
    }

    /// The file of a number.
    pub(super) fn path(&self, number: u32) -> PathBuf {
        let Self { before, digits, after, .. } = self;
        self.whole.with_file_name(format!("{before}{number:0digits$}{after}"))
    }

    /// The pattern as it was given.
    pub(super) fn whole(&self) -> &Path {
        &self.whole
    }

    /// The folder of all the files.
    pub(super) fn folder(&self) -> &Path {
        crate::output::folder_of(&self.whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_numbered_as_c_does() {
        let at = |pattern: &str, number| Pattern::parse(Path::new(pattern)).unwrap().path(number);
        for (pattern, number, name) in [
            ("frames/%04d.png", 7, "frames/0007.png"),
            ("a_%d.exr", 12, "a_12.exr"),
            ("%01d", 12345, "12345"),
            ("100%%_%09d.png", 1, "100%_000000001.png"),
            ("50%/%03d.png", 999, "50%/999.png"),
            ("%003d.png", 5, "005.png"),
        ] {
            assert_eq!(at(pattern, number), Path::new(name), "{pattern}");
        }
    }

    #[test]
    fn what_is_no_pattern_is_refused() {
        for pattern in [
            "a.png",
            "%s.png",
            "%4d.png",
            "%0d.png",
            "%00d.png",
            "%99999d.png",
            "%010d.png",
            "%d%d.png",
            "%d_%04d.png",
            "%",
            "%.png",
            "%04",
            "% d.png",
            "%+d",
            "%x.png",
            "%%d.png",
            "%d/a.png",
            "",
            "..",
            "%04i.png",
            "%-4d.png",
            "%099999999999999999999999999d.png",
        ] {
            let failure = Pattern::parse(Path::new(pattern)).expect_err(pattern);
            assert!(failure.code == INPUT && failure.to_string().contains("%04d"), "{pattern}: {failure}");
        }
        let long = format!("{}%d.png", "x".repeat(70_000));
        assert!(
            Pattern::parse(Path::new(&long)).is_err_and(|failure| failure.to_string().contains("255 bytes"))
        );
    }
}
