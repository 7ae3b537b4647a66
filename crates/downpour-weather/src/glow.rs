//! `[glow]`: light around lights.

use super::fault::Positions;
use super::quantity::{Fraction, GlowWidth};
use super::wind::keys::{Given, NumberKeys, number_given};
use downpour_scene::error::SceneError;
use serde::Deserialize;

/// Default fraction of light that a lens scatters.
pub const GLARE: f64 = 0.01;

/// Filter that spreads glare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum GlowFilter {
    /// A pyramid, whose levels have the law of the CIE.
    #[default]
    Pyramid,
    /// Successive passes of Kawase's filter, as in Tatarchuk & Isidoro 2006.
    Kawase,
}

/// Light that goes beside its image, in the air and in the lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glow {
    /// Fraction of light that lens or eye scatter, 0 to 1.
    pub glare: f64,
    /// Factor of the angles of glare.
    pub width: f64,
    /// Filter that spreads glare.
    pub filter: GlowFilter,
    /// True if drops between light and eye diffract.
    pub has_diffraction: bool,
}

impl Default for Glow {
    /// A lens in fair condition.
    fn default() -> Self {
        Self { glare: GLARE, width: 1.0, filter: GlowFilter::Pyramid, has_diffraction: true }
    }
}

impl Glow {
    /// No glow.
    pub const NONE: Self =
        Self { glare: 0.0, width: 1.0, filter: GlowFilter::Pyramid, has_diffraction: false };
}

#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct GlowTable {
    glare: Option<NumberKeys<Fraction>>,
    width: Option<NumberKeys<GlowWidth>>,
    filter: Option<GlowFilter>,
    diffraction: Option<bool>,
}

impl GlowTable {
    /// The glow of time 0, and glare and width over time, of those that the file gives.
    pub(super) fn checked(&self, positions: &Positions<'_>) -> Result<(Glow, [Given; 2]), SceneError> {
        let default = Glow::default();
        let glare = number_given(self.glare.as_ref(), "glow.glare", positions)?;
        let width = number_given(self.width.as_ref(), "glow.width", positions)?;
        let glow = Glow {
            glare: glare.as_ref().map_or(default.glare, |glare| glare.at(0.0)),
            width: width.as_ref().map_or(default.width, |width| width.at(0.0)),
            filter: self.filter.unwrap_or_default(),
            has_diffraction: self.diffraction.unwrap_or(default.has_diffraction),
        };
        Ok((glow, [glare, width]))
    }
}
