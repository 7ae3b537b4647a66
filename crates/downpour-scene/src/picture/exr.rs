//! OpenEXR pixels, through the `exr` crate, after our own check of the header.
//!
//! Supported are `R`, `G`, `B` and optionally `A`; or `Y` alone as gray. Only the largest resolution level is read. A
//! pixel with a NaN or an infinity becomes black and is counted.

use super::exr_header::{self, Color, Header};
use super::{Picture, Pixels, check_cost, damaged, guarded};
use crate::Budget;
use crate::error::SceneError;
use crate::warning::{WarningKind, Warnings};
use ::exr::prelude::{ReadChannels as _, ReadLayers as _, ReadSpecificChannel as _, Vec2};
use std::io::Cursor;

/// Pixels while they are filled in.
struct Canvas {
    width: usize,
    pixels: Vec<[f32; 4]>,
}

impl Canvas {
    /// A transparent canvas; empty if the sizes do not agree or memory is exhausted.
    fn new(asked: Vec2<usize>, header: &Header) -> Self {
        let (width, height) = (header.width as usize, header.height as usize);
        let mut pixels = Vec::new();
        if asked == Vec2(width, height) {
            let area = width.saturating_mul(height);
            if pixels.try_reserve_exact(area).is_ok() {
                pixels.resize(area, [0.0; 4]);
            }
        }
        Self { width, pixels }
    }

    fn set(&mut self, at: Vec2<usize>, pixel: [f32; 4]) {
        let index = at.1.saturating_mul(self.width).saturating_add(at.0);
        if let Some(slot) = self.pixels.get_mut(index) {
            *slot = pixel;
        }
    }
}

/// Decodes to linear values.
pub(super) fn decode(bytes: &[u8], budget: &Budget) -> Result<Picture, SceneError> {
    let mut warnings = Warnings::default();
    let header = exr_header::check(bytes, &mut warnings)?;
    let size = (header.width, header.height);
    let area = u64::from(header.width).saturating_mul(u64::from(header.height));
    // The result, one block packed and unpacked, and the lists of all blocks.
    let blocks = header.block_bytes.saturating_mul(3).saturating_add(header.blocks.saturating_mul(128));
    check_cost("dataWindow", size, area.saturating_mul(16).saturating_add(blocks), bytes, budget)?;
    header.check_blocks(bytes)?;
    let mut pixels = guarded(|| pixels(bytes, &header))?;
    if pixels.len() as u64 != area {
        return Err(SceneError::limit("pixels", "out of memory", "the memory of the machine"));
    }
    report_unusable(clean(&mut pixels), &mut warnings);
    let pixels = Pixels::RgbaF32(pixels);
    let (width, height) = size;
    Ok(Picture { name: String::new(), width, height, pixels, warnings: warnings.finish() })
}

/// Pixels in the order of the file.
fn pixels(bytes: &[u8], header: &Header) -> Result<Vec<[f32; 4]>, SceneError> {
    let source = Cursor::new(bytes);
    let read = ::exr::prelude::read().no_deep_data().largest_resolution_level().specific_channels();
    // Decoding stays on this thread: a panic on another would end the process.
    let canvas = match header.color {
        Color::Rgb => read
            .required::<f32>("R")
            .required::<f32>("G")
            .required::<f32>("B")
            .optional::<f32>("A", 1.0)
            .collect_pixels(
                |size, _| Canvas::new(size, header),
                |canvas: &mut Canvas, at, (r, g, b, a): (f32, f32, f32, f32)| canvas.set(at, [r, g, b, a]),
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(source)
            .map(|image| image.layer_data.channel_data.pixels),
        Color::Gray => read
            .required::<f32>("Y")
            .optional::<f32>("A", 1.0)
            .collect_pixels(
                |size, _| Canvas::new(size, header),
                |canvas: &mut Canvas, at, (y, a): (f32, f32)| canvas.set(at, [y, y, y, a]),
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(source)
            .map(|image| image.layer_data.channel_data.pixels),
    };
    canvas.map(|canvas| canvas.pixels).map_err(|error| damaged(&error))
}

/// Replaces pixels with a NaN or an infinity by black, and counts them.
fn clean(pixels: &mut [[f32; 4]]) -> u64 {
    let mut count = 0u64;
    for pixel in pixels {
        if pixel.iter().any(|value| !value.is_finite()) {
            let [_, _, _, alpha] = *pixel;
            *pixel = [0.0, 0.0, 0.0, if alpha.is_finite() { alpha } else { 1.0 }];
            count = count.saturating_add(1);
        }
    }
    count
}

/// Warns of the number of replaced pixels, if any.
pub(super) fn report_unusable(count: u64, warnings: &mut Warnings) {
    if count > 0 {
        let what = format!("{count} pixels that are not finite, taken as 0");
        warnings.add(WarningKind::Dropped, "pixels", || what);
    }
}
