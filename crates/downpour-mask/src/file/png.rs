//! Preview of a mask: directions as colors.

use std::io::Cursor;

use image::{ImageFormat, RgbaImage};

use crate::{Mask, MaskError};

/// Encodes the mask as an 8-bit PNG: red = (1 + x) / 2, green = (1 + y) / 2, blue = (1 - z) / 2 of the direction
/// through the drop, alpha = coverage. Light that passes straight through is (128, 128, 255).
///
/// # Errors
/// [`MaskError::Encode`] if the encoder fails.
pub fn write_png(mask: &Mask) -> Result<Vec<u8>, MaskError> {
    let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
    let pixels = mask
        .texels
        .iter()
        .flat_map(|t| {
            let [x, y, z] = t.direction;
            [0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 - 0.5 * z, t.coverage].map(byte)
        })
        .collect();
    let picture = RgbaImage::from_raw(mask.size, mask.size, pixels).ok_or_else(|| MaskError::Encode {
        format: "PNG",
        reason: "a mask without all its texels".to_owned(),
    })?;
    let mut bytes = Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, ImageFormat::Png)
        .map_err(|error| MaskError::Encode { format: "PNG", reason: error.to_string() })?;
    Ok(bytes.into_inner())
}
