//! PNG with one channel, all 16 bits of it: data, not a picture for viewing.

use super::{Kind, guarded, raster};
use crate::Budget;
use crate::error::SceneError;
use image::{ColorType, DynamicImage, ImageFormat};

/// A grayscale picture: rows from the top, left to right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gray16 {
    /// Pixels in a row; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// `width * height` values; 8 bits are widened, so that 255 is 65535.
    pub values: Vec<u16>,
}

/// Reads a grayscale PNG of 8 or 16 bits from the bytes of its file. Name and budget are as for [`super::decode`].
///
/// # Errors
/// [`SceneError`]: the bytes are not a PNG, are truncated or damaged, have color or alpha, or exceed the budget.
pub fn decode_gray16(name: &str, bytes: &[u8], budget: &mut Budget) -> Result<Gray16, SceneError> {
    let read = || {
        const GRAY: &str = "a PNG image with one channel";
        let kind = Kind::of(bytes)?;
        if kind != Kind::Png {
            return Err(SceneError::bad("", kind.name(), GRAY));
        }
        kind.check_name(name)?;
        let image = guarded(|| raster::open(bytes, ImageFormat::Png, budget, cost))?;
        let (width, height) = (image.width(), image.height());
        let values = match image {
            DynamicImage::ImageLuma16(gray) => gray.into_raw(),
            DynamicImage::ImageLuma8(gray) => {
                gray.into_raw().into_iter().map(|v| u16::from_ne_bytes([v, v])).collect()
            }
            other => return Err(SceneError::bad("header", format!("{:?} pixels", other.color()), GRAY)),
        };
        Ok(Gray16 { width, height, values })
    };
    let gray = read().map_err(|error: SceneError| error.in_file(name))?;
    budget.pixels = budget.pixels.saturating_sub(gray.values.len() as u64);
    budget.bytes = budget.bytes.saturating_sub((gray.values.len() as u64).saturating_mul(2));
    Ok(gray)
}

/// Decoded pixels in the file's channels, then in one of 16 bits.
fn cost(pixels: u64, color: ColorType, _: ImageFormat) -> u64 {
    pixels.saturating_mul(u64::from(color.bytes_per_pixel()).saturating_add(2))
}
