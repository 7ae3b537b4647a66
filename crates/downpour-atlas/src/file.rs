//! A set of streaks as a KTX2 texture array.
//!
//! Format `R16_SFLOAT`, one level, ZLIB supercompression. Layer `e D + d` of D directions is the streak at elevation e
//! and direction d; rows from the top, which is the order of time. The key `DownpourStreaks` holds the parameters of the
//! streaks, their directions, and a digest of itself, the texels and the amounts. The key `DownpourStreakAmounts` holds the
//! amounts: half floats, little-endian, 25 elevations of 41 rows of 41. A set without amounts has no such key.
//!
//! The reader accepts files of this module's writer, and checks every size before it allocates memory.

use half::f16;
use ktx2::{Format, Header, LevelIndex, SupercompressionScheme};

use crate::AtlasError;
use crate::set::AMOUNTS;
use crate::{StreakSet, description};
use downpour_mask::file::shorten;
use downpour_mask::file::texture_array::{TextureArray, find_key, find_text, part, write_array};

const FORMAT: Format = Format::R16_SFLOAT;
const TEXEL_BYTES: usize = 2;
/// The keys, in the order of their bytes.
const AMOUNTS_KEY: &str = "DownpourStreakAmounts";
const STREAKS_KEY: &str = "DownpourStreaks";
/// Maximum number of layers of a texture array on common GPUs; WebGPU guarantees 256.
const MAX_LAYERS: u32 = 2048;
/// Maximum memory for the texels of a file, in bytes.
const MAX_BYTES: u64 = 64 << 20;

/// A set as the bytes of a KTX2 file. The same set gives the same bytes on every machine.
///
/// # Errors
/// As [`StreakSet::check`]; [`AtlasError::File`] if it has more than 2048 layers or 64 MiB.
pub fn write_streaks(set: &StreakSet) -> Result<Vec<u8>, AtlasError> {
    set.check()?;
    let (columns, rows, layers) = (set.options.columns, set.options.rows, set.layers() as u32);
    check_size(columns, rows, layers)?;
    let texels: Vec<u8> = set.texels.iter().flat_map(|v| v.to_le_bytes()).collect();
    let amounts: Vec<u8> = set.amounts.iter().flat_map(|v| v.to_le_bytes()).collect();
    let text = description::write(set, &texels, &amounts);
    let mut keys = vec![(STREAKS_KEY, text.as_bytes())];
    if !amounts.is_empty() {
        keys.insert(0, (AMOUNTS_KEY, &amounts));
    }
    let size = [columns, rows];
    let type_size = TEXEL_BYTES as u32;
    Ok(write_array(&TextureArray { format: FORMAT, type_size, size, layers, keys: &keys, texels: &texels })?)
}

/// Reads a set that [`write_streaks`] has written.
///
/// # Errors
/// [`AtlasError::File`] with the part of the file and what was found: it is truncated, not a streak file, of another version,
/// too large, or holds values that are not numbers.
pub fn read_streaks(bytes: &[u8]) -> Result<StreakSet, AtlasError> {
    let truncated =
        |location| file(location, format!("a file of {} bytes", bytes.len()), "a complete KTX2 file");
    let header: &[u8; Header::LENGTH] = bytes.first_chunk().ok_or_else(|| truncated("header"))?;
    let header = Header::from_bytes(header)
        .map_err(|error| file("header", shorten(&error.to_string()), "a KTX2 texture array of streaks"))?;
    let expected = check_header(&header)?;
    let level: &[u8; LevelIndex::LENGTH] =
        bytes[Header::LENGTH..].first_chunk().ok_or_else(|| truncated("level index"))?;
    let level = LevelIndex::from_bytes(level);
    if level.uncompressed_byte_length != expected as u64 {
        let found = format!("{} bytes", level.uncompressed_byte_length);
        return Err(file("level 0, uncompressed length", found, "the length of all texels"));
    }
    let packed = part(bytes, level.byte_offset, level.byte_length).ok_or_else(|| truncated("level 0"))?;
    let keys = part(bytes, header.index.kvd_byte_offset.into(), header.index.kvd_byte_length.into())
        .ok_or_else(|| truncated("keys"))?;
    let text = find_text(keys, STREAKS_KEY)
        .ok_or_else(|| file("keys", "no DownpourStreaks".to_owned(), "streaks written by Downpour"))?;
    let texels = match header.supercompression_scheme {
        Some(_) => miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(packed, expected)
            .map_err(|error| file("level 0", shorten(&error.to_string()), "a ZLIB stream of all texels"))?,
        None => packed.to_vec(),
    };
    if texels.len() != expected {
        return Err(file("level 0", format!("{} bytes", texels.len()), "the length of all texels"));
    }
    let amounts = find_key(keys, AMOUNTS_KEY).unwrap_or_default();
    let size = [header.pixel_width, header.pixel_height, header.layer_count];
    let mut set = description::read(&text, size, &texels, amounts)?;
    let (pairs, _) = texels.as_chunks::<TEXEL_BYTES>();
    set.texels = pairs.iter().map(|&pair| f16::from_le_bytes(pair)).collect();
    let (pairs, left) = amounts.as_chunks::<TEXEL_BYTES>();
    if !left.is_empty() {
        return Err(file(AMOUNTS, format!("{} bytes", amounts.len()), "two bytes for each amount"));
    }
    set.amounts = pairs.iter().map(|&pair| f16::from_le_bytes(pair)).collect();
    set.check()?;
    Ok(set)
}

fn file(location: &'static str, found: String, allowed: &'static str) -> AtlasError {
    AtlasError::File { location, found, allowed }
}

/// The bytes of all texels.
fn check_size(columns: u32, rows: u32, layers: u32) -> Result<usize, AtlasError> {
    let bytes = u64::from(columns) * u64::from(rows) * u64::from(layers) * TEXEL_BYTES as u64;
    // Each factor is checked first: the product of three of them fits 64 bits.
    let fits = columns <= 256 && rows <= 4096 && (1..=MAX_LAYERS).contains(&layers) && bytes <= MAX_BYTES;
    match usize::try_from(bytes) {
        Ok(bytes) if fits && bytes > 0 => Ok(bytes),
        _ => {
            let found = format!("{columns} x {rows}, {layers} layers");
            Err(file("dimensions", found, "1 x 1 to 256 x 4096, 1 to 2048 layers, 64 MiB in all"))
        }
    }
}

/// The bytes of all texels, if the header is that of streaks.
fn check_header(header: &Header) -> Result<usize, AtlasError> {
    if header.format != Some(FORMAT) {
        return Err(file("vkFormat", format!("{:?}", header.format), "76 (R16_SFLOAT)"));
    }
    if !matches!(header.supercompression_scheme, None | Some(SupercompressionScheme::ZLIB)) {
        let found = format!("{:?}", header.supercompression_scheme);
        return Err(file("supercompressionScheme", found, "0 (none) or 3 (ZLIB)"));
    }
    if header.pixel_depth != 0 || header.face_count != 1 || header.level_count != 1 {
        let found = format!(
            "depth {}, {} faces, {} levels",
            header.pixel_depth, header.face_count, header.level_count
        );
        return Err(file("dimensions", found, "a flat texture, one face, one level"));
    }
    check_size(header.pixel_width, header.pixel_height, header.layer_count)
}
