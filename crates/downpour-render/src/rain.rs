//! Drops before a scene: refractive particles that face the camera, drawn through precomputed masks.
//!
//! 1. [`DropMasks`]: masks of drops of all sizes from all elevations, traced once, in milliseconds;
//! 2. [`Rain`]: the drops of a picture; for each tile of 8 x 8 pixels those that touch it, nearest first;
//! 3. [`EnvironmentMap`]: radiance around the eye, on an octahedral map (default) or as the papers' wide picture;
//! 4. [`light`]: what lamps and sun add, drop by drop; [`glint`]: where on a drop;
//! 5. [`StreakTable`]: what drops that move while the shutter is open show on the mean, made once per frame: a profile of each
//!    streak that is wider than a pixel ([`StreakProfiles`]), a mean for the others;
//! 6. [`medium`]: drops that are not drawn one by one, with the light of lamps on them;
//! 7. [`drops`]: pixel by pixel, what drops and streaks show of it;
//! 8. [`spray`]: droplets over what the rain hits, behind all of these.
//!
//! Source: Rousseau, Jolivet, Ghazanfarpour 2006, sections 4 and 5; Rousseau 2008, section 2.2.3. Where the default
//! differs it is said at [`RefractionForm`] and [`StreakSamples`].

#[cfg(not(feature = "parity"))]
pub(crate) mod drops;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod drops;
mod drops_atlas;
mod drops_capture;
mod drops_frame;
mod drops_glint;
mod drops_mask;
mod drops_medium;
mod drops_shade;
#[cfg(not(feature = "parity"))]
pub(crate) mod drops_sum;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod drops_sum;
mod environment;
pub mod exposure;
#[cfg(not(feature = "parity"))]
pub(crate) mod glint;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod glint;
pub mod layers;
pub mod light;
#[cfg(not(feature = "parity"))]
pub(crate) mod list;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod list;
mod masks;
pub mod medium;
#[cfg(not(feature = "parity"))]
pub(crate) mod profiles;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod profiles;
#[cfg(not(feature = "parity"))]
pub(crate) mod project;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod project;

mod shapes;
mod splash;
pub mod spray;
#[cfg(not(feature = "parity"))]
pub(crate) mod streak;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod streak;
#[cfg(not(feature = "parity"))]
pub(crate) mod streak_cell;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod streak_cell;
mod streak_light;
mod streak_lookup;
mod streak_path;
mod streak_rays;
#[cfg(not(feature = "parity"))]
pub(crate) mod streak_span;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod streak_span;
mod streak_table;
#[cfg(not(feature = "parity"))]
pub(crate) mod tiles;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod tiles;
mod truth;
mod weather;

use downpour_drop::spray::Spray;
use downpour_shaders::render::rain::{DROPS_DIRECTION, DROPS_SHIFT};
use downpour_weather::{RainLayers, RainRefraction};

pub use crate::camera::EyeMotion;
pub use drops_frame::DropsFrame;
pub use environment::{EnvironmentFrame, EnvironmentMap};
pub use exposure::{Exposure, StreakColor, StreakSamples, TemporalResponse};
pub use glint::drop_glint_right;

use light::DropLightOptions;
pub use list::Rain;
pub use masks::{DIAMETER_STEP, DIAMETERS, DropMasks};
pub use medium::{MediumGrain, MediumOptions, PanePlane, RainMedium};
pub use profiles::StreakProfiles;
pub use streak::ScreenDrop;
pub use streak_lookup::StreakTable;
pub use streak_path::StreakPath;
pub use streak_rays::StreakRay;
pub use truth::DropTruth;
pub use weather::drop_model;

/// Glints that are kept of a drop where nothing else is said.
const GLINTS: u32 = 4;

/// Lookup of the color of a drop's pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum RefractionForm {
    /// The direction of the refracted light is looked up in an environment map around the eye, and reflected light is
    /// added: exact for a scene that is far compared with the drop's distance.
    #[default]
    Direction = DROPS_DIRECTION,
    /// Rousseau 2006, 4.2.3: the position of the pixel in a picture 165 degrees wide is shifted by the mask. No reflection.
    /// Their perspective loses the middle (1.7 degrees per pixel at 512), and directions beyond its edge are the edge.
    Rousseau2006 = DROPS_SHIFT,
}

impl RefractionForm {
    /// Texels along an edge of the usual capture: of the paper's form those of the paper (Rousseau 2006, 4.2.2).
    #[must_use]
    pub fn capture_size(self) -> u32 {
        match self {
            Self::Direction => 256,
            Self::Rousseau2006 => 512,
        }
    }
}

impl From<RainRefraction> for RefractionForm {
    fn from(refraction: RainRefraction) -> Self {
        match refraction {
            RainRefraction::Rousseau2006 => Self::Rousseau2006,
            _ => Self::Direction,
        }
    }
}

/// Options of rain in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainOptions {
    /// Lookup of the color of a drop's pixel.
    pub form: RefractionForm,
    /// Texels along an edge of the capture: a power of two, 16 to 2048.
    pub capture_size: u32,
    /// Samples along an edge of a texel of the capture, 1 to 16.
    pub capture_grid: u32,
    /// Drops that are not drawn one by one.
    pub medium: RainMedium,
    /// Exposure.
    pub exposure: Exposure,
    /// Options of the light of lamps and the sun on drops.
    pub light: DropLightOptions,
    /// Multiple of the light that a drop takes out and gives, as in [`MediumOptions`]: 1 is what physics gives.
    pub visibility: f64,
    /// Layers of a texture before the picture, in place of drops.
    pub layers: Option<RainLayers>,
    /// Spray over what the rain hits, of extinction 0 or more.
    pub spray: Option<Spray>,
}

impl Default for RainOptions {
    /// 256 x 256 texels of one sample: 0.8 degrees, finer than a pixel of any drop of less than 200 pixels.
    fn default() -> Self {
        Self {
            form: RefractionForm::Direction,
            capture_size: RefractionForm::Direction.capture_size(),
            capture_grid: 1,
            medium: RainMedium::default(),
            exposure: Exposure::default(),
            light: DropLightOptions { glints: GLINTS, ..DropLightOptions::default() },
            visibility: 1.0,
            layers: None,
            spray: None,
        }
    }
}
