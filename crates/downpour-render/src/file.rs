//! Pictures as files: linear OpenEXR, and PNG to look at. Bytes only; publishing them is the caller's.
//!
//! [`write_exr_layers`] names its channels as compositing programs expect them, layer and component with a point between:
//!
//! | channels | hold |
//! |---|---|
//! | `R`, `G`, `B` | the picture: `clean * transmittance + rain`, or that through a pane of wet glass; the other channels are behind the pane |
//! | `clean.R`, `clean.G`, `clean.B` | radiance of the scene without rain |
//! | `rain.R`, `rain.G`, `rain.B` | radiance that the rain adds |
//! | `glow.R`, `glow.G`, `glow.B` | what glow adds, if anything glows |
//! | `transmittance.Y` | fraction of the scene's light that comes through the rain, 0 to 1 |
//! | `depth.Z` | distance of the nearest surface from the eye along the ray, meters; 1e30 for the sky |
//!
//! [`write_exr_channels`] takes whatever channels there are.

use std::io::Cursor;

use ::exr::prelude::*;
use image::{ImageFormat, RgbImage};

use crate::RenderError;
use crate::picture::through_rain;

/// Encodes linear radiance as an OpenEXR file: channels R, G, B of 32 bits, ZIP compressed. Rows from the top.
///
/// # Errors
/// [`RenderError::Encode`] if the pixels are not `width` times `height`, or the encoder fails.
pub fn write_exr(width: u32, height: u32, pixels: &[[f32; 3]]) -> core::result::Result<Vec<u8>, RenderError> {
    let channels = ["R", "G", "B"].into_iter().zip(0..);
    let of = |k: usize| Samples::F32(pixels.iter().map(|p: &[f32; 3]| p[k]).collect());
    write_exr_channels([width, height], channels.map(|(name, k)| (name, of(k))).collect())
}

/// Encodes a picture with all its layers as one OpenEXR file: see [the module](self) for the channels.
///
/// `clean` is radiance and distance of the scene, `rain` radiance and transmittance of the rain, `seen` the picture
/// itself where it is not both together: with glow, or through a pane.
///
/// # Errors
/// As [`write_exr`].
pub fn write_exr_layers(
    width: u32,
    height: u32,
    clean: &[[f32; 4]],
    rain: &[[f32; 4]],
    seen: Option<&[[f32; 3]]>,
) -> core::result::Result<Vec<u8>, RenderError> {
    write_exr_channels([width, height], layer_channels(clean, rain, seen))
}

/// The channels of [`write_exr_layers`].
#[must_use]
pub fn layer_channels(
    clean: &[[f32; 4]],
    rain: &[[f32; 4]],
    seen: Option<&[[f32; 3]]>,
) -> Vec<(&'static str, Samples)> {
    let layer = |pixels: &[[f32; 4]], k: usize| Samples::F32(pixels.iter().map(|p| p[k]).collect());
    let mut channels = Vec::new();
    for (k, name) in ["R", "G", "B"].into_iter().enumerate() {
        let radiance = match seen {
            Some(seen) => seen.iter().map(|pixel| pixel[k]).collect(),
            None => through_rain(clean, rain).map(|pixel| pixel[k]).collect(),
        };
        channels.push((name, Samples::F32(radiance)));
    }
    for (k, name) in ["clean.R", "clean.G", "clean.B", "depth.Z"].into_iter().enumerate() {
        channels.push((name, layer(clean, k)));
    }
    for (k, name) in ["rain.R", "rain.G", "rain.B", "transmittance.Y"].into_iter().enumerate() {
        channels.push((name, layer(rain, k)));
    }
    channels
}

/// The channels of a glow; none if there is none.
#[must_use]
pub fn glow_channels(glow: &[[f32; 4]]) -> Vec<(&'static str, Samples)> {
    let names = if glow.is_empty() { &[][..] } else { &["glow.R", "glow.G", "glow.B"] };
    let samples = |k: usize| Samples::F32(glow.iter().map(|pixel| pixel[k]).collect());
    names.iter().enumerate().map(|(k, &name)| (name, samples(k))).collect()
}

/// Numbers of a channel, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Numbers.
    F32(Vec<f32>),
    /// Whole numbers.
    U32(Vec<u32>),
}

impl Samples {
    fn len(&self) -> usize {
        match self {
            Self::F32(samples) => samples.len(),
            Self::U32(samples) => samples.len(),
        }
    }
}

/// Encodes channels of 32 bits as an OpenEXR file of one part, ZIP compressed.
///
/// # Errors
/// As [`write_exr`].
pub fn write_exr_channels(
    [width, height]: [u32; 2],
    channels: Vec<(&str, Samples)>,
) -> core::result::Result<Vec<u8>, RenderError> {
    let encode = |reason: String| RenderError::Encode { format: "OpenEXR", reason };
    let size = (width as usize, height as usize);
    let count = size.0 * size.1;
    if let Some((_, found)) = channels.iter().find(|(_, samples)| samples.len() != count) {
        return Err(encode(format!("{} pixels for {width} x {height}", found.len())));
    }
    let channel = |(name, samples): (&str, Samples)| {
        let samples = match samples {
            Samples::F32(samples) => FlatSamples::F32(samples),
            Samples::U32(samples) => FlatSamples::U32(samples),
        };
        AnyChannel::new(name, samples)
    };
    let channels = channels.into_iter().map(channel).collect();
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

/// Encodes 8-bit sRGB pixels as a PNG file. Rows from the top.
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

    /// Every number of every layer comes back from the file.
    #[test]
    fn layers_are_channels() {
        let clean = [[1.0, 2.0, 3.0, 5.0], [4.0, 5.0, 6.0, 1.0e30]];
        let rain = [[0.5, 0.25, 0.125, 0.5], [0.0, 0.0, 0.0, 1.0]];
        let expected = [
            ("B", [1.625, 6.0]),
            ("G", [1.25, 5.0]),
            ("R", [1.0, 4.0]),
            ("clean.B", [3.0, 6.0]),
            ("clean.G", [2.0, 5.0]),
            ("clean.R", [1.0, 4.0]),
            ("depth.Z", [5.0, 1.0e30]),
            ("rain.B", [0.125, 0.0]),
            ("rain.G", [0.25, 0.0]),
            ("rain.R", [0.5, 0.0]),
            ("transmittance.Y", [0.5, 1.0]),
        ];
        let written = |glass| channels(write_exr_layers(2, 1, &clean, &rain, glass).expect("a file"));
        assert_eq!(written(None), expected.map(|(name, values)| (name.to_owned(), values.to_vec())));
        // Through glass: the picture alone is another.
        let mut seen = expected;
        seen[..3].copy_from_slice(&[("B", [0.3, 0.6]), ("G", [0.2, 0.5]), ("R", [0.1, 0.4])]);
        let glass = [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]];
        assert_eq!(written(Some(&glass)), seen.map(|(name, values)| (name.to_owned(), values.to_vec())));
        assert!(write_exr_layers(2, 2, &clean, &rain, None).is_err());
        assert!(write_exr_layers(2, 1, &clean, &rain[..1], None).is_err());
        assert!(write_exr_layers(2, 1, &clean, &rain, Some(&glass[..1])).is_err());
    }

    fn channels(bytes: Vec<u8>) -> Vec<(String, Vec<f32>)> {
        let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = image.all_attributes().from_buffered(Cursor::new(bytes)).expect("an image");
        let list = &image.layer_data.channel_data.list;
        list.iter()
            .map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().collect()))
            .collect()
    }
}
