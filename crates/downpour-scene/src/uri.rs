//! Addresses inside a scene file: inline data, or a relative path inside the scene's folder.
//!
//! All others are rejected: schemes (`http:`, `file:`, drive letters), absolute paths, `..`, backslashes,
//! zero bytes, and text that does not decode to UTF-8. The test uses the percent-decoded text, since that is
//! the path that the system opens.

use crate::error::quoted;

/// A checked address.
#[derive(Debug, PartialEq, Eq)]
pub enum Address<'a> {
    /// `data:mime;base64,text`.
    Data {
        /// The media type, with its parameters; may be empty.
        mime: &'a str,
        /// Base64, not looked at yet.
        text: &'a str,
    },
    /// A file inside the folder.
    File(RelativePath),
}

/// A path of plain names, joined by `/`: no root, no drive, no `.` or `..`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RelativePath(String);

impl RelativePath {
    /// The path with `/` between its names.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// Reason why an address is rejected.
#[derive(Debug)]
pub struct Refused {
    /// Value found.
    pub found: String,
    /// Values allowed.
    pub allowed: &'static str,
}

const RELATIVE_OR_DATA: &str = "only relative paths inside the scene folder, or data:…;base64,…";

/// Checks an address as it stands in the file.
///
/// # Errors
/// [`Refused`]: neither a relative path that stays inside its folder nor data in base64.
pub fn check(uri: &str) -> Result<Address<'_>, Refused> {
    let refuse = |why: &str, allowed| Err(Refused { found: format!("{} {why}", quoted(uri)), allowed });
    if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
        return match data(uri.get(5..).unwrap_or_default()) {
            Some((mime, text)) => Ok(Address::Data { mime, text }),
            None => refuse("is not a base64 data address", "data:type/subtype;base64,…"),
        };
    }
    let Some(bytes) = percent_decoded(uri) else {
        return refuse("has a broken percent sign", "%00 to %ff, two hexadecimal digits");
    };
    let Ok(path) = String::from_utf8(bytes) else {
        return refuse("is not UTF-8 after decoding", "UTF-8 names");
    };
    if path.contains('\0') {
        return refuse("holds a zero byte", "names without control characters");
    }
    if path.contains(':') {
        return refuse("has a scheme or a drive", RELATIVE_OR_DATA);
    }
    if path.starts_with('/') || path.contains('\\') {
        return refuse("is absolute or holds a backslash", RELATIVE_OR_DATA);
    }
    if path.split('/').any(|name| name == "..") {
        return refuse("leaves the scene folder", RELATIVE_OR_DATA);
    }
    let names: Vec<&str> = path.split('/').filter(|name| !name.is_empty() && *name != ".").collect();
    if names.is_empty() || path.ends_with('/') || path.ends_with("/.") {
        return refuse("names no file", RELATIVE_OR_DATA);
    }
    if cfg!(windows) && names.iter().any(|name| is_windows_device(name)) {
        return refuse("names a device", RELATIVE_OR_DATA);
    }
    Ok(Address::File(RelativePath(names.join("/"))))
}

/// The media type and the text of what follows `data:`.
fn data(rest: &str) -> Option<(&str, &str)> {
    let (head, text) = rest.split_once(',')?;
    let mime = head.strip_suffix(";base64")?;
    let plain = |c: char| c.is_ascii_alphanumeric() || "/+-._=;".contains(c);
    let whole = mime.is_empty() || mime.split(';').all(|part| !part.is_empty());
    (whole && mime.chars().all(plain)).then_some((mime, text))
}

/// `%41` becomes `A`; `None` when two hexadecimal digits are missing.
fn percent_decoded(text: &str) -> Option<Vec<u8>> {
    let digit = |byte: Option<u8>| u8::try_from(char::from(byte?).to_digit(16)?).ok();
    let mut out = Vec::with_capacity(text.len());
    let mut bytes = text.bytes();
    while let Some(byte) = bytes.next() {
        out.push(if byte == b'%' {
            let high = digit(bytes.next())?;
            (high << 4) | digit(bytes.next())?
        } else {
            byte
        });
    }
    Some(out)
}

/// Names that open a device in any folder of that system, whatever follows their first dot.
fn is_windows_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_ascii_uppercase();
    let numbered = |prefix| {
        stem.strip_prefix(prefix).is_some_and(|rest: &str| {
            matches!(rest, "¹" | "²" | "³") || (rest.len() == 1 && rest.bytes().all(|b| b.is_ascii_digit()))
        })
    };
    matches!(stem.as_str(), "CON" | "PRN" | "AUX" | "NUL" | "CONIN$" | "CONOUT$")
        || numbered("COM")
        || numbered("LPT")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_paths_are_made_plain() {
        for (uri, plain) in [
            ("buffer.bin", "buffer.bin"),
            ("./a//b.bin", "a/b.bin"),
            ("Textures/my%20map.png", "Textures/my map.png"),
            ("gr%C3%BCn.bin", "grün.bin"),
            ("a..b", "a..b"),
        ] {
            assert_eq!(check(uri).unwrap(), Address::File(RelativePath(plain.into())), "{uri}");
        }
    }

    #[test]
    fn nothing_leaves_the_folder() {
        for (uri, why) in [
            ("../../etc/passwd", "leaves the scene folder"),
            ("a/../../b", "leaves the scene folder"),
            ("%2e%2e/%2E%2E/x", "leaves the scene folder"),
            ("..", "leaves the scene folder"),
            ("file:///etc/passwd", "has a scheme"),
            ("FILE:/dev/zero", "has a scheme"),
            ("http://example.com/a.bin", "has a scheme"),
            ("C:\\x", "has a scheme or a drive"),
            ("a%3Ab", "has a scheme or a drive"),
            ("/etc/passwd", "is absolute"),
            ("%2fetc/passwd", "is absolute"),
            ("\\\\server\\share", "is absolute"),
            ("a%00b.bin", "holds a zero byte"),
            ("%ff%fe.bin", "is not UTF-8"),
            ("a%zz", "broken percent"),
            ("a%4", "broken percent"),
            (".", "names no file"),
            ("", "names no file"),
            ("a/", "names no file"),
            ("data:text/plain,hello", "not a base64 data address"),
            ("data:;;base64,AA==", "not a base64 data address"),
        ] {
            let refused = check(uri).expect_err(uri);
            assert!(refused.found.contains(why), "{uri}: {}", refused.found);
        }
    }

    #[test]
    fn data_is_taken_apart() {
        let mime = "application/octet-stream";
        assert_eq!(
            check("DATA:application/octet-stream;base64,AA==").unwrap(),
            Address::Data { mime, text: "AA==" }
        );
        assert_eq!(check("data:;base64,").unwrap(), Address::Data { mime: "", text: "" });
    }

    #[test]
    fn devices_of_another_system() {
        for name in ["NUL", "con.bin", "Com1.x", "lpt9", "AUX "] {
            assert!(is_windows_device(name), "{name}");
        }
        for name in ["nullable.bin", "com10", "console", "company.bin"] {
            assert!(!is_windows_device(name), "{name}");
        }
    }
}
