//! The header of an OpenEXR file, checked before a decoder sees it.
//!
//! Source: Academy Software Foundation, "OpenEXR File Layout". A header is a list of attributes: name, type,
//! length, value, all little-endian. Decoders allocate by these values, so all that they rely on is
//! checked first: sizes, channels, tiles, the compression scheme, the table of blocks.
//!
//! Refused are schemes whose decoders are not safe on hostile files or are missing (B44, B44A, DWAA, DWAB,
//! HTJ2K), deep data, files of several parts, and subsampled channels.

use super::check_cost;
use crate::Budget;
use crate::error::{SceneError, quoted};
use crate::warning::{WarningKind, Warnings};

mod cursor;
mod tiles;

use cursor::Bytes;
pub(super) use tiles::Tiles;

/// The largest number of attributes, and of channels.
const MAX_ATTRIBUTES: u32 = 1024;
const MAX_CHANNELS: usize = 64;

/// The largest number of blocks: scan-line groups or tiles, all levels together.
pub(super) const MAX_BLOCKS: u64 = 1 << 20;

/// Coordinates of windows are within this, so that no difference of them overflows.
const REACH: i32 = (1 << 30) - 1;

const CONVERT: &str = "save the file again with ZIP compression, as one flat part";
const NAME: &str = "names of 1 to 255 bytes of text";

/// Meaning of the pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Color {
    /// `R`, `G`, `B`, perhaps `A`.
    Rgb,
    /// `Y`, perhaps `A`.
    Gray,
}

/// Header for the decoder.
#[derive(Debug)]
pub(super) struct Header {
    /// Columns of the data window.
    pub(super) width: u32,
    /// Rows of the data window.
    pub(super) height: u32,
    /// Meaning of the pixels.
    pub(super) color: Color,
    /// All blocks of all levels.
    pub(super) blocks: u64,
    /// The bytes of one unpacked block.
    pub(super) block_bytes: u64,
    /// Offset of the table of blocks.
    table: usize,
}

impl Header {
    /// Refuses more blocks than a decoder should list, or than the file has a table for.
    pub(super) fn check_blocks(&self, bytes: &[u8]) -> Result<(), SceneError> {
        let blocks = self.blocks;
        if blocks > MAX_BLOCKS {
            let found = format!("{blocks} blocks");
            return Err(
                SceneError::limit("tiles", found, format!("at most {MAX_BLOCKS}")).with_advice(CONVERT)
            );
        }
        let rest = (bytes.len() as u64).saturating_sub(self.table as u64);
        if blocks.saturating_mul(8) > rest {
            let found = format!("{rest} bytes after the header, for {blocks} blocks");
            return Err(SceneError::bad("pixels", found, "a whole file"));
        }
        Ok(())
    }
}

/// Attributes that are used.
#[derive(Debug, Default)]
struct Found {
    data: Option<Window>,
    display: Option<Window>,
    compression: Option<u8>,
    channels: Option<Vec<Channel>>,
    tiles: Option<Tiles>,
    chunk_count: Option<i32>,
}

/// A rectangle of pixels, its corners within it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Window {
    low: [i32; 2],
    high: [i32; 2],
}

/// One channel.
#[derive(Debug)]
struct Channel {
    name: String,
    bytes: u64,
}

/// Checks a header.
pub(super) fn check(file: &[u8], warnings: &mut Warnings) -> Result<Header, SceneError> {
    let mut bytes = Bytes::new(file);
    bytes.take(4)?;
    let tiled = version(bytes.u32()?)?;
    let found = attributes(&mut bytes, warnings)?;
    let missing = |name: &'static str| SceneError::bad("header", format!("no {name}"), "a whole header");
    let data = found.data.ok_or_else(|| missing("dataWindow"))?;
    let (width, height) = data.size("dataWindow")?;
    let display = found.display.ok_or_else(|| missing("displayWindow"))?;
    display.size("displayWindow")?;
    if data != display {
        warnings.add(WarningKind::Irregular, "dataWindow", || {
            let [x, y] = data.low;
            format!("is not the display window: the picture is the {width} x {height} pixels from ({x}, {y})")
        });
    }
    // Sizes are checked here, since the number of blocks needs them; the memory later, when that is known.
    check_cost("dataWindow", (width, height), 0, &[], &Budget { pixels: u64::MAX, ..Budget::default() })?;
    let lines = block_lines(found.compression.ok_or_else(|| missing("compression"))?)?;
    let channels = found.channels.ok_or_else(|| missing("channels"))?;
    let color = color(&channels)?;
    let pixel_bytes = channels.iter().map(|channel| channel.bytes).fold(0, u64::saturating_add);
    let (blocks, block_area) = if tiled {
        let tiles = found.tiles.ok_or_else(|| missing("tiles"))?;
        (tiles.count(width, height), tiles.area(width, height))
    } else {
        let lines = u64::from(lines);
        (u64::from(height).div_ceil(lines), u64::from(width).saturating_mul(lines.min(u64::from(height))))
    };
    if let Some(count) = found.chunk_count
        && u64::try_from(count).ok() != Some(blocks)
    {
        return Err(SceneError::bad("chunkCount", count.to_string(), format!("{blocks}, as the size says")));
    }
    let block_bytes = block_area.saturating_mul(pixel_bytes);
    Ok(Header { width, height, color, blocks, block_bytes, table: bytes.position() })
}

/// True if the file has tiles; all other flags of the version must be 0.
fn version(word: u32) -> Result<bool, SceneError> {
    const TILED: u32 = 0x200;
    const LONG_NAMES: u32 = 0x400;
    let refuse = |found: String| {
        Err(SceneError::bad("version", found, "one flat part, version 2").with_advice(CONVERT))
    };
    if word & 0xff != 2 {
        return refuse(format!("version {}", word & 0xff));
    }
    if word & 0x800 != 0 {
        return refuse("deep data".into());
    }
    if word & 0x1000 != 0 {
        return refuse("several parts".into());
    }
    match word & !(0xff | TILED | LONG_NAMES) {
        0 => Ok(word & TILED != 0),
        flags => refuse(format!("unknown flags {flags:#x}")),
    }
}

/// Reads the list of attributes to its end.
fn attributes(bytes: &mut Bytes<'_>, warnings: &mut Warnings) -> Result<Found, SceneError> {
    let mut found = Found::default();
    for _ in 0..MAX_ATTRIBUTES {
        let name = bytes.text()?;
        if name.is_empty() {
            return Ok(found);
        }
        if name.len() > 255 {
            return Err(SceneError::bad("header", format!("the name {}", quoted(&name)), NAME));
        }
        let kind = bytes.text()?;
        let length = bytes.i32()?;
        let value =
            usize::try_from(length).ok().and_then(|length| bytes.take(length).ok()).ok_or_else(|| {
                SceneError::bad(
                    "header",
                    format!("{} of {length} bytes", quoted(&name)),
                    "a length within the file",
                )
            })?;
        attribute(&mut found, &name, &kind, Bytes::new(value), warnings)?;
    }
    Err(SceneError::bad("header", "more attributes", format!("at most {MAX_ATTRIBUTES}")))
}

/// Stores the value of one attribute, if it is used.
fn attribute(
    found: &mut Found,
    name: &str,
    kind: &str,
    mut value: Bytes<'_>,
    warnings: &mut Warnings,
) -> Result<(), SceneError> {
    let expected = match name {
        "dataWindow" | "displayWindow" => "box2i",
        "compression" => "compression",
        "channels" => "chlist",
        "tiles" => "tiledesc",
        "chunkCount" => "int",
        "pixelAspectRatio" => "float",
        "type" => "string",
        _ => return Ok(()),
    };
    if kind != expected {
        return Err(SceneError::bad(name, format!("the type {}", quoted(kind)), expected));
    }
    match name {
        "dataWindow" => put(&mut found.data, name, Window::read(&mut value, name)?)?,
        "displayWindow" => put(&mut found.display, name, Window::read(&mut value, name)?)?,
        "compression" => put(&mut found.compression, name, value.u8()?)?,
        "channels" => put(&mut found.channels, name, channels(&mut value)?)?,
        "tiles" => put(&mut found.tiles, name, Tiles::read(&mut value)?)?,
        "chunkCount" => put(&mut found.chunk_count, name, value.i32()?)?,
        "pixelAspectRatio" => {
            let ratio = f32::from_bits(value.u32()?);
            if !(ratio.is_finite() && ratio > 0.0) {
                warnings.add(WarningKind::Irregular, name, || format!("{ratio}, taken as 1"));
            }
        }
        _ => {
            let kind = String::from_utf8_lossy(value.rest()).into_owned();
            if !matches!(kind.as_str(), "scanlineimage" | "tiledimage") {
                let allowed = "scanlineimage or tiledimage";
                return Err(SceneError::bad(name, quoted(&kind), allowed).with_advice(CONVERT));
            }
        }
    }
    Ok(())
}

/// Stores a value that may occur once.
fn put<T>(slot: &mut Option<T>, name: &str, value: T) -> Result<(), SceneError> {
    if slot.replace(value).is_some() {
        return Err(SceneError::bad(name, "occurs twice", "each attribute once"));
    }
    Ok(())
}

impl Window {
    fn read(value: &mut Bytes<'_>, name: &str) -> Result<Self, SceneError> {
        let low = [value.i32()?, value.i32()?];
        let high = [value.i32()?, value.i32()?];
        for coordinate in low.into_iter().chain(high) {
            if !(-REACH..=REACH).contains(&coordinate) {
                return Err(SceneError::bad(name, coordinate.to_string(), format!("within {REACH} of 0")));
            }
        }
        Ok(Self { low, high })
    }

    /// Columns and rows.
    fn size(self, name: &str) -> Result<(u32, u32), SceneError> {
        let ([left, top], [right, bottom]) = (self.low, self.high);
        // Within `REACH`, neither step overflows.
        let side = |low: i32, high: i32| u32::try_from(high.saturating_sub(low).saturating_add(1)).ok();
        match (side(left, right).filter(|&w| w > 0), side(top, bottom).filter(|&h| h > 0)) {
            (Some(width), Some(height)) => Ok((width, height)),
            _ => {
                let found = format!("from ({left}, {top}) to ({right}, {bottom})");
                Err(SceneError::bad(
                    name,
                    found,
                    "a right lower corner that is not left of or above the other",
                ))
            }
        }
    }
}

/// The lines of a block; refuses schemes that are not decoded here.
fn block_lines(scheme: u8) -> Result<u32, SceneError> {
    let name = match scheme {
        0..=2 => return Ok(1),
        3 | 5 => return Ok(16),
        4 => return Ok(32),
        6 => "B44",
        7 => "B44A",
        8 => "DWAA",
        9 => "DWAB",
        10 | 11 => "HTJ2K",
        _ => "an unknown scheme",
    };
    let found = format!("{name} ({scheme}) is not supported");
    Err(SceneError::bad("compression", found, "none, RLE, ZIPS, ZIP, PIZ or PXR24").with_advice(CONVERT))
}

/// The list of channels: sorted by name, each once, none subsampled.
fn channels(value: &mut Bytes<'_>) -> Result<Vec<Channel>, SceneError> {
    let mut list: Vec<Channel> = Vec::new();
    loop {
        let name = value.text()?;
        if name.is_empty() {
            return Ok(list);
        }
        if list.len() == MAX_CHANNELS {
            return Err(SceneError::bad("channels", "more channels", format!("at most {MAX_CHANNELS}")));
        }
        if name.len() > 255 {
            return Err(SceneError::bad("channels", quoted(&name), NAME));
        }
        let path = || format!("channels[{}]", list.len());
        if list.last().is_some_and(|last| last.name.as_str() >= &*name) {
            let found = format!("{} out of order", quoted(&name));
            return Err(SceneError::bad(path(), found, "names in rising order, each once"));
        }
        let bytes = match value.u32()? {
            0 | 2 => 4,
            1 => 2,
            kind => return Err(SceneError::bad(path(), format!("pixel type {kind}"), "0, 1 or 2")),
        };
        value.take(4)?;
        let (x, y) = (value.i32()?, value.i32()?);
        if (x, y) != (1, 1) {
            let found = format!("{} subsampled by {x} x {y}", quoted(&name));
            return Err(SceneError::bad(path(), found, "1 x 1").with_advice(CONVERT));
        }
        list.push(Channel { name: name.into_owned(), bytes });
    }
}

/// Meaning of the channels.
fn color(channels: &[Channel]) -> Result<Color, SceneError> {
    let has = |name: &str| channels.iter().any(|channel| channel.name == name);
    if ["R", "G", "B"].into_iter().all(has) {
        return Ok(Color::Rgb);
    }
    if has("Y") && !has("RY") && !has("BY") {
        return Ok(Color::Gray);
    }
    let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
    let found = format!("the channels {}", quoted(&names.join(", ")));
    Err(SceneError::bad("channels", found, "R, G and B, or Y"))
}
