//! Pictures as files: linear OpenEXR, and PNG to look at. Bytes only; publishing them is the caller's.

use std::io::Cursor;

use ::exr::prelude::*;
use image::{ImageFormat, RgbImage};

use crate::RenderError;

/// Linear radiance as the bytes of an OpenEXR file: channels R, G, B of 32 bits, ZIP compressed. Rows from the top.
///
/// # Errors
/// [`RenderError::Encode`] if the pixels are not `width` times `height`, or the encoder fails.
pub fn write_exr(width: u32, height: u32, pixels: &[[f32; 3]]) -> core::result::Result<Vec<u8>, RenderError> {
    let encode = |reason: String| RenderError::Encode { format: "OpenEXR", reason };
    let size = (width as usize, height as usize);
    if pixels.len() != size.0 * size.1 {
        return Err(encode(format!("{} pixels for {width} x {height}", pixels.len())));
    }
    let channel =
        |name: &str, k: usize| AnyChannel::new(name, FlatSamples::F32(pixels.iter().map(|p| p[k]).collect()));
    let channels = [channel("R", 0), channel("G", 1), channel("B", 2)].into_iter().collect();
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|error| encode(error.to_string()))?;
    Ok(bytes.into_inner())
}

/// 8-bit sRGB pixels as the bytes of a PNG file. Rows from the top.
///
/// # Errors
/// As [`write_exr`].
pub fn write_png(width: u32, height: u32, pixels: &[[u8; 3]]) -> core::result::Result<Vec<u8>, RenderError> {
    let encode = |reason: String| RenderError::Encode { format: "PNG", reason };
    let picture = RgbImage::from_raw(width, height, pixels.concat())
        .filter(|p| p.as_raw().len() == pixels.len() * 3)
        .ok_or_else(|| encode(format!("{} pixels for {width} x {height}", pixels.len())))?;
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|error| encode(error.to_string()))?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_have_all_their_pixels() {
        assert!(write_exr(2, 2, &[[0.5; 3]; 4]).is_ok_and(|b| b.starts_with(&[0x76, 0x2f, 0x31, 0x01])));
        assert!(write_png(2, 1, &[[1, 2, 3]; 2]).is_ok_and(|b| b.starts_with(b"\x89PNG")));
        assert!(write_exr(2, 2, &[[0.5; 3]; 3]).is_err());
        assert!(write_png(2, 2, &[[0; 3]; 3]).is_err());
    }
}
