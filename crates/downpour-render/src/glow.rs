//! Glow around bright light: light that goes beside its image, in the air and in the lens. Twin of `shaders/wgsl/render/glow.wgsl`, where
//! the method is described.
//!
//! Two causes, one after the other, each a sum of Gaussians ([`GlowKernel`]) that take light from each pixel and put it around it:
//!
//! - Drops between a light and the eye diffract as much light as their outlines cover (Babinet), in the pattern of a disk of their
//!   diameter (Airy). The first ring of a drop of 2 mm is 0.02 degrees away: it shows with long lenses alone.
//! - A lens, or an eye, scatters a fraction of all light: the law of the CIE for the eye (CIE 146:2002, small angle disability glare, age
//!   term left out), `L / E = 10 / angle^3 + 5 / angle^2`, with the angle in degrees from 0.1 to 30. Integrated it is 27 % for an eye; a
//!   camera's fraction is its veiling glare (ISO 9358), a few percent.
//!
//! Light is kept: what is taken comes back around, mirrored at the borders, and a picture of one color stays as it is. A pixel's angle is
//! that in the middle of the picture.

mod kernel;
mod plan;
mod spread;

use downpour_weather::{GlowFilter, Weather};

pub use kernel::GlowKernel;
pub(crate) use plan::GlowPlan;
#[cfg(feature = "wgpu")]
pub(crate) use plan::GlowStep;
pub use plan::{GlowCoarse, GlowLevel};
pub use spread::{
    glow_down_weights, glow_fraction, glow_mirrored, glow_overlap, glow_taken, glow_up_first, glow_up_weight,
};

use crate::rain::RainMedium;

/// Wavelength of green light, m.
const WAVELENGTH_M: f64 = 0.55e-6;

/// Light that goes beside its image. The default is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Glow {
    /// Fraction of the light that lens or eye scatter, 0 to 1.
    pub glare: f32,
    /// Factor of the angles of glare.
    pub width: f32,
    /// Filter that spreads glare.
    pub filter: GlowFilter,
    /// Diffraction by the drops between light and eye.
    pub diffraction: Option<GlowDiffraction>,
}

/// Light that drops diffract.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlowDiffraction {
    /// Area of the drops' outlines per volume, 1/m.
    pub extinction: f32,
    /// Wavelength over pi times the diameter of the drops, radians.
    pub angle: f32,
}

impl Glow {
    /// The glow of a weather at a time in seconds, before unresolved and drawn rain. Rain whose extinction counts diffracted light as lost diffracts none.
    #[must_use]
    pub fn of_weather(weather: &Weather, medium: &RainMedium, time_s: f64) -> Self {
        let glow = weather.glow_at(time_s);
        let is_kept = weather.rain.extinction == downpour_weather::RainExtinction::Camera;
        let diffraction = medium.mean_diameter_m().filter(|_| glow.has_diffraction && is_kept);
        Self {
            glare: glow.glare as f32,
            width: glow.width as f32,
            filter: glow.filter,
            diffraction: diffraction.map(|diameter| GlowDiffraction {
                extinction: medium.extinction() as f32,
                angle: (WAVELENGTH_M / (std::f64::consts::PI * diameter)) as f32,
            }),
        }
    }
}
