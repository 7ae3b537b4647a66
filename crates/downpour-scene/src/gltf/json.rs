//! JSON text to plain values, with a known bound of the cost.
//!
//! A parsed value needs many times the memory of its text: `{"":0},` of 7 bytes needs about 350. The parser has no
//! limit of memory, so the maximum that it can allocate is deducted from the budget first, by counting the characters
//! that make it allocate. Nesting ends at 128 (the parser's limit).

use super::irregular;
use crate::Budget;
use crate::error::{SceneError, escaped};
use crate::warning::Warnings;
use serde_json::Value;

/// Upper bounds in bytes: of an object with its table and the typed object that is created from it, of an
/// array with its first capacity, and of one more element in a vector that has doubled its capacity.
const PER_OBJECT: u64 = 1024;
const PER_ARRAY: u64 = 512;
const PER_ELEMENT: u64 = 256;

/// Parses the text of a document.
pub(super) fn parse(bytes: &[u8], budget: &mut Budget, warnings: &mut Warnings) -> Result<Value, SceneError> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if text.len() < bytes.len() {
        irregular(warnings, "JSON", || "begins with a byte order mark".into());
    }
    let text = str::from_utf8(text).map_err(|error| {
        SceneError::bad("JSON", format!("not UTF-8 from byte {} on", error.valid_up_to()), "UTF-8 text")
    })?;
    budget.take_bytes(cost(text), "JSON")?;
    serde_json::from_str(text).map_err(|error| {
        let what = error.to_string();
        if what.starts_with("recursion limit exceeded") {
            let found = format!("nested deeper than 127 at line {} column {}", error.line(), error.column());
            SceneError::bad("JSON", found, "at most 127 brackets inside each other")
        } else {
            SceneError::bad("JSON", escaped(&what), "JSON text after RFC 8259")
        }
    })
}

/// The most bytes that the parsed document can take.
fn cost(text: &str) -> u64 {
    let price = |byte| match byte {
        b'{' => PER_OBJECT,
        b'[' => PER_ARRAY,
        b',' => PER_ELEMENT,
        _ => 1,
    };
    text.bytes().map(price).fold(0, u64::saturating_add)
}
