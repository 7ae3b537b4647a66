//! Texture arrays of one level as KTX2 files, with project-specific keys.

use ktx2::dfd::{Basic, Block};
use ktx2::{Format, Header, Index, LevelIndex, SupercompressionScheme};

use crate::MaskError;

/// Level of the deflate encoder: 0 to 10.
const DEFLATE_LEVEL: u8 = 9;

/// A texture array of one level.
#[derive(Clone, Copy, Debug)]
pub struct TextureArray<'a> {
    /// Texel format.
    pub format: Format,
    /// Bytes per component of a texel.
    pub type_size: u32,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Number of layers.
    pub layers: u32,
    /// Project-specific keys and their values, in the order of the keys' bytes. A NUL is appended to each value.
    pub keys: &'a [(&'a str, &'a [u8])],
    /// Texels by layer, rows from the top.
    pub texels: &'a [u8],
}

/// Encodes a texture array as a KTX2 file, its texels deflated.
///
/// # Errors
/// [`MaskError::Encode`] for a format that has no descriptor.
pub fn write_array(array: &TextureArray<'_>) -> Result<Vec<u8>, MaskError> {
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(array.texels, DEFLATE_LEVEL);
    let descriptor = data_format(array.format)?;
    // Keys in the order of their bytes, as the format requires.
    let version = concat!("downpour-mask ", env!("CARGO_PKG_VERSION"));
    let keys =
        [array.keys, &[("KTXorientation", b"rd".as_slice()), ("KTXwriter", version.as_bytes())]].concat();
    let keys = key_values(&keys);
    let descriptor_at = Header::LENGTH + LevelIndex::LENGTH;
    let keys_at = descriptor_at + descriptor.len();
    let level_at = keys_at + keys.len();
    let header = Header {
        format: Some(array.format),
        type_size: array.type_size,
        pixel_width: array.size[0],
        pixel_height: array.size[1],
        pixel_depth: 0,
        layer_count: array.layers,
        face_count: 1,
        level_count: 1,
        supercompression_scheme: Some(SupercompressionScheme::ZLIB),
        index: Index {
            dfd_byte_offset: descriptor_at as u32,
            dfd_byte_length: descriptor.len() as u32,
            kvd_byte_offset: keys_at as u32,
            kvd_byte_length: keys.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let level = LevelIndex {
        byte_offset: level_at as u64,
        byte_length: packed.len() as u64,
        uncompressed_byte_length: array.texels.len() as u64,
    };
    Ok([&header.as_bytes()[..], &level.as_bytes(), &descriptor, &keys, &packed].concat())
}

/// The data format descriptor: its length and one basic block.
fn data_format(format: Format) -> Result<Vec<u8>, MaskError> {
    let (basic, _) = Basic::from_format(format)
        .map_err(|error| MaskError::Encode { format: "KTX2", reason: error.to_string() })?;
    let block = Block::Basic(basic).to_vec();
    Ok([&(block.len() as u32 + 4).to_le_bytes()[..], &block].concat())
}

fn key_values(pairs: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (key, value) in pairs {
        bytes.extend((key.len() as u32 + value.len() as u32 + 2).to_le_bytes());
        bytes.extend(key.bytes().chain([0]).chain(value.iter().copied()).chain([0]));
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}

/// Bytes of a part of the file; `None` if it is not inside.
#[must_use]
pub fn part(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(offset).ok()?;
    let end = start.checked_add(usize::try_from(length).ok()?)?;
    bytes.get(start..end)
}

/// Text of a key; `None` if there is no such key, or its value is no text.
#[must_use]
pub fn find_text(keys: &[u8], wanted: &str) -> Option<String> {
    String::from_utf8(find_key(keys, wanted)?.to_vec()).ok()
}

/// Value of a key, without the NUL behind it; `None` if there is no such key, or the keys are truncated.
#[must_use]
pub fn find_key<'a>(mut keys: &'a [u8], wanted: &str) -> Option<&'a [u8]> {
    while let Some((length, rest)) = keys.split_first_chunk::<4>() {
        let length = u32::from_le_bytes(*length) as usize;
        let pair = rest.get(..length)?;
        let split = pair.iter().position(|&b| b == 0)?;
        if &pair[..split] == wanted.as_bytes() {
            return Some(pair[split + 1..].strip_suffix(&[0]).unwrap_or(&pair[split + 1..]));
        }
        keys = rest.get(length.checked_next_multiple_of(4)?..)?;
    }
    None
}
