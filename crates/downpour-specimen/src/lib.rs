//! One exact drop, large, in front of a sky map.
//!
//! Law: geometrical optics with all orders of light. A ray of the camera is reflected and refracted at the surface of
//! the drop, and again at each interface from inside ([`trace`]); each branch that leaves carries the
//! fraction of Fresnel's equations for a dielectric (Born & Wolf, Principles of Optics, 1.5.2), and the
//! radiance of the sky in its direction ([`sky`]). Each interface acts on unpolarized light, as in an RGB
//! renderer. The drop's shape is that of `downpour_drop::shape`.
//!
//! Frame: the world's, right-handed, +Y up; the drop's origin at 0, its axis vertical, the bottom down. The camera
//! is at distance (sin yaw cos pitch, sin pitch, cos yaw cos pitch), looks at the origin, +Y up. Arguments are in
//! meters and radians; inside, lengths are in units of the drop's volume-equivalent radius. Radiance is linear, in
//! the units of the map, unexposed.
//!
//! Sky maps are equirectangular: u = 0.5 + atan2(z, x) / 2 pi, v = 0.5 - asin(y) / pi from the top, bilinear
//! between the centers of texels, wrapping in u. Lamps at infinity ([`SpecimenLamp`], [`Sky::with_lamps`]) are added.
//!
//! - [`render_specimen`]: the picture on the CPU, the same bits for any number of threads;
//! - [`render_specimen_f64`]: its reference;
//! - [`gpu::SpecimenRenderer`] (feature `wgpu`): the same on a GPU;
//! - [`render_specimen_table`]: a streak as the renderer of rain draws it, by its table;
//! - [`SpecimenOptions`], [`default_fov`]: the camera;
//! - functions whose names begin with `specimen_` are the twins of `shaders/wgsl/render/specimen.wgsl` and of its two
//!   neighbors.
//!
//! With an exposure, or an oscillation, the picture is that of a streak: the mean over the exposure of the drop that falls at
//! its terminal speed, at the origin at mid-exposure, and oscillates ([`streak`], [`wobble`], [`SpecimenMotion`]). Without
//! either it is that of the drop at rest, bit for bit.
//!
//! Limits: no diffraction (drops above some hundredths of a millimeter), no absorption (below 0.4 % in 6 mm). Light
//! that is still inside after 256 internal reflections, or of which less than 10^-4 is left, leaves at the last
//! exit, so that all fractions sum to 1. Exact up to 5.9 mm, where drops are convex. The bottom of larger
//! ones has a ripple (`downpour_drop::shape`): light that leaves it and would meet it again continues, and rays that
//! graze it may be missed, which reduces the height of the outline by 0.1 % at 7 mm and up to 1.5 % at 9 mm. In a streak no
//! ray is missed, and 128 internal reflections are followed.
//!
//! ```
//! use downpour_drop::DropShape;
//! use downpour_specimen::{Sky, SpecimenOptions, render_specimen};
//! // A bright sky over dark ground.
//! let radiance = [[[1.0; 3]; 64], [[0.1; 3]; 64]].concat();
//! let sky = Sky::new(8, 16, &radiance)?;
//! let shape = DropShape::new(3.0e-3)?;
//! let options = SpecimenOptions { size: [64, 64], ..SpecimenOptions::default() };
//! let image = render_specimen(&shape, &options, sky)?;
//! let (above, below) = (image.pixel(32, 16), image.pixel(32, 48));
//! assert!(below[0] > 2.0 * above[0], "the sky is at the bottom of the drop");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(
    not(feature = "parity"),
    allow(unreachable_pub, dead_code, reason = "pub for comparisons with the shaders")
)]

mod camera;
mod error;
#[cfg(feature = "wgpu")]
pub mod gpu;
mod image;
#[cfg(not(feature = "parity"))]
mod lamp;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod lamp;
mod motion;
mod options;
mod render;
#[cfg(not(feature = "parity"))]
mod sky;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod sky;
#[cfg(not(feature = "parity"))]
mod streak;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod streak;
mod table;
#[cfg(not(feature = "parity"))]
mod trace;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod trace;
#[cfg(not(feature = "parity"))]
mod wobble;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod wobble;

pub use camera::default_fov;
pub use error::SpecimenError;
pub use image::Image;
pub use lamp::SpecimenLamp;
pub use motion::SpecimenMotion;
pub use options::{MAX_EXPOSURE_S, MAX_SIZE, SpecimenOptions};
pub use render::{render_specimen, render_specimen_f64, render_specimen_scalar, specimen_jitter};
pub use sky::Sky;
pub use table::{MAX_TABLE_LAMP_DEG, check_specimen_table, render_specimen_table};

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
