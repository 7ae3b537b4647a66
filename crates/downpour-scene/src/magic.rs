//! Kind of a file by its first bytes, for messages about files of an unexpected kind.

use crate::error::quoted;

/// First bytes and the name of the format.
const KNOWN: [(&[u8], &str); 20] = [
    (b"\x76\x2f\x31\x01", "an OpenEXR image"),
    (b"\xabKTX 20\xbb\r\n\x1a\n", "a KTX2 texture"),
    (b"\xabKTX 11\xbb\r\n\x1a\n", "a KTX1 texture"),
    (b"\x89PNG\r\n\x1a\n", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"DDS ", "a DDS texture"),
    (b"RIFF", "a RIFF file (WebP, WAV or AVI)"),
    (b"#?RADIANCE", "a Radiance HDR image"),
    (b"#?RGBE", "a Radiance HDR image"),
    (b"Kaydara FBX Binary", "an FBX model"),
    (b"BLENDER", "a Blender file"),
    (b"PXR-USDC", "a USD file"),
    (b"#usda", "a USD file"),
    (b"ply\n", "a PLY model"),
    (b"ply\r", "a PLY model"),
    (b"solid ", "an STL model"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\x28\xb5\x2f\xfd", "a Zstandard archive"),
];

/// Name of the format with these first bytes, in words.
pub(crate) fn found(bytes: &[u8]) -> String {
    if bytes.is_empty() {
        return "an empty file".into();
    }
    if let Some((_, name)) = KNOWN.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return (*name).into();
    }
    let start = bytes.get(..bytes.len().min(8)).unwrap_or_default();
    match str::from_utf8(start) {
        Ok(text) => format!("a file that begins with {}", quoted(text)),
        Err(_) => {
            let hex: Vec<String> = start.iter().map(|byte| format!("{byte:02x}")).collect();
            format!("a file that begins with the bytes {}", hex.join(" "))
        }
    }
}
