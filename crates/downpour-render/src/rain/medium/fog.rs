//! Fog: a second medium, of droplets that no picture resolves.

use downpour_math::ops::{self, f64 as exact};
use downpour_shaders::render::medium::{MEDIUM_ANGLES, MEDIUM_FAR};
use downpour_weather::Fog;
use glam::{Vec3, Vec4};

use super::{MediumFrame, RainMedium};

impl RainMedium {
    /// The same medium with fog; `origin_m` is the height of the scene's origin, to which heights of eyes are relative, m.
    #[must_use]
    pub fn with_fog(self, fog: Option<&Fog>, origin_m: f64) -> Self {
        let relative = |fog: &Fog| Fog { base_m: fog.base_m - origin_m, ..*fog };
        Self { fog: fog.map(relative), ..self }
    }
}

/// Numbers of fog for the uniforms of an eye at a height, m: `fog` and `fog_phase`.
pub(super) fn uniforms(fog: &Fog, eye: f32) -> [[f32; 4]; 2] {
    let inverse = fog.height_m.map_or(0.0, |height| 1.0 / height);
    let above = f64::from(eye) - fog.base_m;
    // An even cone with this mean cosine has the solid angle 4 pi (1 - g).
    let width = (4.0 * std::f64::consts::PI * (1.0 - fog.asymmetry)).sqrt();
    let numbers = [fog.extinction_per_m, inverse, above, fog.albedo].map(|number| number as f32);
    [numbers, [width as f32, fog.asymmetry as f32, 0.0, 0.0]]
}

/// Integral of the phase function of Henyey & Greenstein (1941) over an interval of the scattering angle, 1/sr, by Simpson's
/// rule of 4 parts.
pub(super) fn phase_integral(asymmetry: f64, interval: u32) -> f64 {
    let width = std::f64::consts::PI / f64::from(MEDIUM_ANGLES);
    let phase = |angle: f64| {
        let square = 1.0 + asymmetry * asymmetry - 2.0 * asymmetry * exact::cos(angle);
        (1.0 - asymmetry * asymmetry) / (4.0 * std::f64::consts::PI * square * square.sqrt())
    };
    let at = |part: f64| phase((f64::from(interval) + part) * width);
    (at(0.0) + 4.0 * at(0.25) + 2.0 * at(0.5) + 4.0 * at(0.75) + at(1.0)) * width / 12.0
}

/// Mean of `exp(-x')` for `x'` from 0 to `x`: `(1 - exp(-x)) / x`, by its series where the difference would lose digits.
pub(in crate::rain) fn medium_decay_mean(x: f32) -> f32 {
    if x > 0.02 { (1.0 - ops::exp(-x)) / x } else { 1.0 - x * (0.5 - x / 6.0) }
}

/// Optical depth of fog along a ray whose direction has the upward part `rise`, up to a distance in meters. `fog`: as
/// [`MediumFrame::fog`].
#[must_use]
pub fn medium_fog_depth(fog: Vec4, rise: f32, distance: f32) -> f32 {
    let (begin, end) = (fog.z, fog.z + rise * distance);
    let (low, high) = (begin.min(end), begin.max(end));
    if high <= 0.0 || fog.y <= 0.0 {
        return fog.x * distance;
    }
    let (mut below, mut above) = (0.0, distance);
    if low < 0.0 {
        below = distance * (-low / (high - low));
        above = distance * (high / (high - low));
    }
    let foot = low.max(0.0);
    fog.x * (below + above * ops::exp(-foot * fog.y) * medium_decay_mean((high - foot) * fog.y))
}

impl MediumFrame {
    /// Part of the light that fog lets through up to a distance along a ray of unit direction from the eye.
    pub(crate) fn medium_fog(&self, direction: Vec3, distance: f32) -> f32 {
        ops::exp(-medium_fog_depth(self.fog.into(), direction.y, distance.min(MEDIUM_FAR)))
    }
}
