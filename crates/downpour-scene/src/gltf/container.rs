//! GLB container (glTF 2.0, section 4.4) and plain JSON: ranges of the two parts of a file.

use super::irregular;
use crate::error::{SceneError, size};
use crate::magic;
use crate::warning::{WarningKind, Warnings};

pub(super) const GLTF: &str = "a glTF 2.0 file: JSON text (.gltf) or a GLB (.glb)";
const EXPORT_AGAIN: &str = "the file may be cut: copy or export it again";
const HEADER: usize = 12;
const MIN_FILE_BYTES: usize = 20;
const CHUNK_HEADER: usize = 8;
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// The parts of a file.
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// Binary chunk of a GLB; `None` if it has none.
    pub(super) binary: Option<&'a [u8]>,
}

/// Splits a file into its parts.
pub(super) fn open<'a>(bytes: &'a [u8], warnings: &mut Warnings) -> Result<Container<'a>, SceneError> {
    if bytes.starts_with(b"glTF") {
        return glb(bytes, warnings);
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match text.iter().find(|byte| !byte.is_ascii_whitespace()) {
        Some(b'{') => Ok(Container { json: bytes, binary: None }),
        _ => Err(SceneError::bad("", magic::found(bytes), GLTF)),
    }
}

fn glb<'a>(bytes: &'a [u8], warnings: &mut Warnings) -> Result<Container<'a>, SceneError> {
    let cut = |path: &str, found: String| Err(SceneError::bad(path, found, GLTF).with_advice(EXPORT_AGAIN));
    let (Some(version), Some(length), true) = (word(bytes, 4), word(bytes, 8), bytes.len() >= MIN_FILE_BYTES)
    else {
        return cut(
            "GLB header",
            format!("a file of {} bytes, cut within the first {MIN_FILE_BYTES}", bytes.len()),
        );
    };
    if version != 2 {
        return Err(SceneError::bad("GLB header", format!("version {version}"), "version 2")
            .with_advice("convert the file to glTF 2.0"));
    }
    let declared = length as usize;
    let Some(mut rest) = bytes.get(HEADER..declared).filter(|_| declared >= MIN_FILE_BYTES) else {
        let found = format!("length {length} in a file of {} bytes", bytes.len());
        let allowed = format!("{MIN_FILE_BYTES} to {}", bytes.len());
        return Err(SceneError::bad("GLB header", found, allowed).with_advice(EXPORT_AGAIN));
    };
    if declared < bytes.len() {
        let more = bytes.len().saturating_sub(declared) as u64;
        irregular(warnings, "GLB header", || format!("{} after the end are ignored", size(more)));
    }
    let mut json = None;
    let mut binary = None;
    let mut number = 0usize;
    while !rest.is_empty() {
        let path = format!("GLB chunk {number}");
        let (Some(length), Some(kind)) = (word(rest, 0), word(rest, 4)) else {
            return cut(&path, format!("{} bytes, cut within its header", rest.len()));
        };
        let body = rest.get(CHUNK_HEADER..).unwrap_or_default();
        let Some((data, after)) = body.split_at_checked(length as usize) else {
            return cut(&path, format!("{length} bytes, but only {} follow", body.len()));
        };
        if !length.is_multiple_of(4) {
            irregular(warnings, &path, || format!("length {length} is no multiple of 4"));
        }
        match (number, kind) {
            (0, JSON) if data.is_empty() => return cut(&path, "an empty JSON chunk".into()),
            (0, JSON) => json = Some(data),
            (0, _) => {
                let found = format!("type {kind:#010x}");
                return Err(SceneError::bad(&path, found, format!("JSON ({JSON:#010x}) first")));
            }
            (1, BIN) => binary = Some(data),
            (_, JSON | BIN) => {
                return Err(SceneError::bad(
                    &path,
                    "a second JSON or a misplaced BIN chunk",
                    "one JSON chunk, then at most one BIN chunk",
                ));
            }
            _ => warnings
                .add(WarningKind::Ignored, &path, || format!("type {kind:#010x} is not known: skipped")),
        }
        rest = after;
        number = number.saturating_add(1);
    }
    match json {
        Some(json) => Ok(Container { json, binary }),
        None => cut("GLB header", format!("length {length}, no JSON chunk")),
    }
}

/// Reads a little-endian 32-bit word.
fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let (word, _) = bytes.get(at..)?.split_first_chunk::<4>()?;
    Some(u32::from_le_bytes(*word))
}
