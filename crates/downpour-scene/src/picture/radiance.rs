//! Radiance HDR: RGBE pixels, divided by the exposures in the header.
//!
//! Source: Ward, "Radiance File Formats": every `EXPOSURE` line multiplies; the radiance is the pixel divided by
//! the product.

use super::{Picture, Pixels, damaged, guarded, raster};
use crate::Budget;
use crate::error::{SceneError, quoted};
use crate::warning::{WarningKind, Warnings};
use image::{ColorType, DynamicImage, ImageFormat};
use std::borrow::Cow;

/// The longest header that is looked at, in bytes.
const HEADER: usize = 64 << 10;

/// The other first line that programs write.
const OTHER: &[u8] = b"#?RGBE";

/// First line that the decoder accepts.
const SIGNATURE: &[u8] = b"#?RADIANCE";

/// Decodes to radiance.
pub(super) fn decode(bytes: &[u8], budget: &Budget) -> Result<Picture, SceneError> {
    let mut warnings = Warnings::default();
    let exposure = exposure(bytes, &mut warnings)?;
    let file = match bytes.strip_prefix(OTHER) {
        Some(rest) => {
            budget.clone().take_bytes(bytes.len() as u64, "")?;
            Cow::Owned([SIGNATURE, rest].concat())
        }
        None => Cow::Borrowed(bytes),
    };
    let image = guarded(|| raster::open(&file, ImageFormat::Hdr, budget, working_cost))?;
    let DynamicImage::ImageRgb32F(image) = image else {
        return Err(damaged(&"no floating-point pixels"));
    };
    let (width, height) = image.dimensions();
    let mut pixels = Budget::vec_with_capacity(image.len() / 3, "pixels")?;
    let mut unusable = 0u64;
    for &image::Rgb([r, g, b]) in image.pixels() {
        let [r, g, b] = [r, g, b].map(|value| divided(value, exposure));
        let whole = r.is_finite() && g.is_finite() && b.is_finite();
        unusable = unusable.saturating_add(u64::from(!whole));
        pixels.push(if whole { [r, g, b, 1.0] } else { [0.0, 0.0, 0.0, 1.0] });
    }
    super::exr::report_unusable(unusable, &mut warnings);
    let pixels = Pixels::RgbaF32(pixels);
    Ok(Picture { name: String::new(), width, height, pixels, warnings: warnings.finish() })
}

/// The nearest `f32`; infinite if the value is out of range.
#[expect(clippy::cast_possible_truncation, reason = "rounding is meant, and what overflows is counted")]
fn divided(value: f32, exposure: f64) -> f32 {
    (f64::from(value) / exposure) as f32
}

/// Three `f32` as they are decoded, four as they are handed out.
fn working_cost(pixels: u64, _: ColorType, _: ImageFormat) -> u64 {
    pixels.saturating_mul(12 + 16)
}

/// The product of all exposures; 1 without any.
fn exposure(bytes: &[u8], warnings: &mut Warnings) -> Result<f64, SceneError> {
    let head = bytes.get(..HEADER).unwrap_or(bytes);
    let mut product = 1.0;
    for line in head.split(|&byte| byte == b'\n').take_while(|line| !line.is_empty()) {
        let Ok(line) = str::from_utf8(line) else { continue };
        let Some((key, value)) = line.split_once('=') else { continue };
        match key.trim() {
            "EXPOSURE" => {
                let one = value.trim().parse().ok().filter(|one: &f64| one.is_finite() && *one > 0.0);
                product *= one.ok_or_else(|| {
                    SceneError::bad("header.EXPOSURE", quoted(value.trim()), "a finite number above 0")
                })?;
            }
            "COLORCORR" | "PIXASPECT" => {
                let what = format!("{} is not applied", quoted(line));
                warnings.add(WarningKind::Ignored, "header", || what);
            }
            _ => {}
        }
    }
    if product > 0.0 && product.is_finite() {
        return Ok(product);
    }
    Err(SceneError::bad("header.EXPOSURE", format!("a product of {product}"), "a finite number above 0"))
}
