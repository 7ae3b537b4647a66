//! PNG and JPEG, through the `image` crate with its limits set.

use super::{MAX_SIDE, Picture, Pixels, check_cost, damaged, guarded};
use crate::Budget;
use crate::error::SceneError;
use image::{ColorType, DynamicImage, ImageDecoder as _, ImageError, ImageFormat, ImageReader, Limits};
use std::io::Cursor;

const WHOLE: &str = "a whole and undamaged picture";

/// Decodes to 8 bits for each channel.
pub(super) fn decode(bytes: &[u8], format: ImageFormat, budget: &Budget) -> Result<Picture, SceneError> {
    if format == ImageFormat::Jpeg && !jpeg_ends(bytes) {
        return Err(SceneError::bad("pixels", "a JPEG image that is cut short", WHOLE));
    }
    let image = guarded(|| open(bytes, format, budget, working_cost))?;
    let (width, height) = (image.width(), image.height());
    let raw = image.into_rgba8().into_raw();
    let pixels = bytemuck::allocation::try_cast_vec(raw).unwrap_or_else(|(_, raw)| {
        let (whole, _) = raw.as_chunks::<4>();
        whole.to_vec()
    });
    let pixels = Pixels::Rgba8(pixels);
    Ok(Picture { name: String::new(), width, height, pixels, warnings: Vec::new() })
}

/// Decodes an image in the file's channels. The size is checked before anything large is allocated.
///
/// `cost` is an upper bound of the memory for decoding, from the size in pixels, the kind of the decoded pixels and the format.
pub(super) fn open(
    bytes: &[u8],
    format: ImageFormat,
    budget: &Budget,
    cost: fn(u64, ColorType, ImageFormat) -> u64,
) -> Result<DynamicImage, SceneError> {
    let reader = || {
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        let mut limits = Limits::default();
        limits.max_image_width = Some(MAX_SIDE);
        limits.max_image_height = Some(MAX_SIDE);
        limits.max_alloc = Some(budget.bytes);
        reader.limits(limits);
        reader
    };
    let decoder = reader().into_decoder().map_err(|error| refused("header", &error))?;
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width).saturating_mul(u64::from(height));
    check_cost("header", (width, height), cost(pixels, decoder.color_type(), format), bytes, budget)?;
    drop(decoder);
    reader().decode().map_err(|error| refused("pixels", &error))
}

/// Decoded pixels in the file's channels, then in four of 8 bits; a progressive JPEG keeps its coefficients too.
fn working_cost(pixels: u64, color: ColorType, format: ImageFormat) -> u64 {
    let converted = if color == ColorType::Rgba8 { 0 } else { 4 };
    let coefficients = if format == ImageFormat::Jpeg { 8 } else { 0 };
    let each = u64::from(color.bytes_per_pixel()).saturating_add(converted).saturating_add(coefficients);
    pixels.saturating_mul(each)
}

/// A limit stays a limit, all else is damage.
fn refused(path: &str, error: &ImageError) -> SceneError {
    match error {
        ImageError::Limits(limit) => {
            let found = format!("asks for too much: {}", crate::error::escaped(&limit.to_string()));
            let allowed = format!("sides of at most {MAX_SIDE} pixels, within the budget");
            SceneError::limit(path, found, allowed).with_advice("scale the picture down")
        }
        error => damaged(error).at(path),
    }
}

/// True if the end marker follows the last scan: the decoder fills missing data with gray, without an error.
fn jpeg_ends(bytes: &[u8]) -> bool {
    let last = |mark: [u8; 2]| bytes.windows(2).rposition(|pair| pair == mark);
    match (last([0xff, 0xda]), last([0xff, 0xd9])) {
        (Some(scan), Some(end)) => scan < end,
        // No scan at all: the decoder reports it.
        (None, _) => true,
        (Some(_), None) => false,
    }
}
