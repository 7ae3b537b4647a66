//! Drops before a scene: refractive particles that face the camera, drawn through precomputed masks.
//!
//! 1. [`DropMasks`]: masks of drops of all sizes from all elevations, traced once, in milliseconds;
//! 2. [`Rain`]: the drops of a picture, nearest first, and for each tile of 8 x 8 pixels those that touch it;
//! 3. [`capture`]: what is round the eye, on an octahedral map (default) or as the papers' wide picture;
//! 4. [`drops`]: pixel by pixel, what the drops show of it.
//!
//! Source: Rousseau, Jolivet, Ghazanfarpour 2006, section 4. Where the default differs it is said at
//! [`RefractionForm`].

pub mod capture;
pub mod drops;
pub mod masks;
mod reduce;
mod tiles;
mod veil;

use downpour_shaders::render::rain::{DROPS_DIRECTION, DROPS_SHIFT};

pub use capture::{Capture, CaptureFrame};
pub use drops::{DropsDrop, DropsFrame};
pub use masks::DropMasks;
pub use reduce::{ReduceLevel, reduce_levels, reduce_texel};
pub use tiles::Rain;
pub use veil::Veil;

/// How a drop's pixel finds its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum RefractionForm {
    /// The direction of the refracted light is looked up in everything round the eye, and what the drop reflects is
    /// added: exact for a scene that is far compared with the drop's distance.
    #[default]
    Direction = DROPS_DIRECTION,
    /// Rousseau 2006, 4.2.3: the place of the pixel in a picture 165 degrees wide is shifted by the mask. No reflection.
    /// Their perspective loses the middle (1.7 degrees per pixel at 512), and directions beyond its edge are the edge.
    Rousseau2006 = DROPS_SHIFT,
}

/// How drops are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainOptions {
    /// How a drop's pixel finds its colour.
    pub form: RefractionForm,
    /// Texels along an edge of the capture: a power of two, 16 to 2048.
    pub capture_size: u32,
    /// Samples along an edge of a texel of the capture, 1 to 16.
    pub capture_grid: u32,
    /// Drops that are not drawn one by one.
    pub veil: Veil,
}

impl Default for RainOptions {
    /// 256 x 256 texels of one sample: 0.8 degrees, finer than a pixel of any drop of less than 200 pixels.
    fn default() -> Self {
        Self { form: RefractionForm::Direction, capture_size: 256, capture_grid: 1, veil: Veil::default() }
    }
}
