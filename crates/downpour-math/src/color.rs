//! Colors of linear BT.709, and the sRGB transfer function. Twin of `shaders/wgsl/common/color.wgsl`.

use crate::ops;

/// Luminance of a color.
#[inline]
#[must_use]
pub fn color_luminance([r, g, b]: [f32; 3]) -> f32 {
    r * 0.2126 + g * 0.7152 + b * 0.0722
}

/// Linear value of an sRGB value (IEC 61966-2-1), both 0 to 1.
///
/// ```
/// use downpour_math::color::{linear_to_srgb, srgb_to_linear};
/// assert!((srgb_to_linear(0.5) - 0.214_041).abs() < 1e-6);
/// assert!((linear_to_srgb(srgb_to_linear(0.02)) - 0.02).abs() < 1e-6);
/// ```
#[must_use]
pub fn srgb_to_linear(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ops::pow((value + 0.055) / 1.055, 2.4) }
}

/// sRGB value of a linear value (IEC 61966-2-1), both 0 to 1.
#[must_use]
pub fn linear_to_srgb(value: f32) -> f32 {
    if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * ops::pow(value, 1.0 / 2.4) - 0.055 }
}
