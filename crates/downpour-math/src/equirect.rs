//! Equirectangular maps: +Y is up; u = 0.5 + atan2(z, x) / 2 pi, v = 0.5 - asin(y) / pi from the top. Twin of
//! `shaders/wgsl/common/equirect.wgsl`.

use downpour_shaders::common::EQUIRECT_POLE;

use crate::ops;

/// Texture coordinates of a direction of length 1; u = 0.5 at the poles.
///
/// ```
/// use downpour_math::equirect::equirect_coordinates;
/// assert_eq!(equirect_coordinates([1.0, 0.0, 0.0]), [0.5, 0.5]);
/// assert_eq!(equirect_coordinates([0.0, 1.0, -0.0])[0], 0.5);
/// ```
#[must_use]
pub fn equirect_coordinates([x, y, z]: [f32; 3]) -> [f32; 2] {
    // The angle of (y, horizontal) is asin(y), and does not lose its digits near the poles.
    let horizontal = (x * x + z * z).sqrt();
    let turn = if horizontal > EQUIRECT_POLE { ops::atan2(z, x) } else { 0.0 };
    [0.5 + turn * 0.159_154_94, 0.5 - ops::atan2(y, horizontal) * 0.318_309_87]
}
