//! Rain that can be measured, in front of scenes: a weather file in, frames out.
//!
//! ```no_run
//! use downpour::{Backend, Renderer};
//!
//! let mut renderer = Renderer::open("street.toml", Backend::Auto)?;
//! let frame = renderer.frame(2.5)?; // seconds
//! frame.save("rain.png")?;
//! println!("{} drops drawn on {}", frame.picture.drawn.len(), renderer.computer().adapter);
//! # Ok::<(), downpour::RendererError>(())
//! ```
//!
//! - [`Renderer`] makes the frames of a weather, one after the other: a picture, a clip, with a camera of the file or one that is
//!   set from code ([`Renderer::set_camera`]). The command `downpour render` is built on it.
//! - `Rain` (feature `wgpu`) draws rain over the frames of your own wgpu application: your device, your command encoder, your color
//!   and depth textures.
//! - [`Frame`] has the layers of a frame, the drops in it, and its files.
//! - [`Source`] reads weather files; its [`Weather`](weather::Weather) may be changed, or built from nothing.
//! - [`Backend`] and [`Device`] say what draws: a GPU, your GPU, or the CPU, with the same drops.
//!
//! The examples `render_weather`, `clip` and `your_wgpu_app` are whole programs. Below the front door are the parts:
//!
//! | module | crate | what is in it |
//! |---|---|---|
//! | [`atlas`] | `downpour-atlas` | streaks of oscillating drops by the directions of light and viewer |
//! | [`bvh`] | `downpour-bvh` | the nearest hit of a ray among triangles |
//! | [`mod@drop`] | `downpour-drop` | one drop (shape, fall speed, oscillation, optics) and many (size distributions) |
//! | [`lattice`] | `downpour-lattice` | water on surfaces: ripples of puddles, drops on glass |
//! | [`mask`] | `downpour-mask` | what a drop does to light: refraction masks, traced, written and read |
//! | [`scene`] | `downpour-scene` | glTF scenes, pictures and sky maps, behind a guard and a budget |
//! | [`weather`] | `downpour-weather` | the weather file: keys with units, ranges, keyframes |
//! | [`sim`] | `downpour-sim` | where the drops of a rain are, counted from mm/h |
//! | [`wind`] | `downpour-wind` | wind primitives and the field that they make |
//! | [`render`] | `downpour-render` | rain on a plate: drops, streaks, their light, panes of glass, tone |
//! | [`trace`] | `downpour-trace` | scenes by rays, which make plates; puddles |
//! | [`specimen`] | `downpour-specimen` | one exact drop in front of a sky map |
//! | [`street`] | `downpour-street` | an old street from a seed, as glTF |
//! | `gpu` (feature `wgpu`) | `downpour-gpu` | a checked layer over wgpu, on a device of its own or on yours |
//! | [`shaders`] | `downpour-shaders` | every WGSL file as composable modules |
//! | [`math`] | `downpour-math` | reproducible scalar functions and random numbers |
//!
//! Nothing here needs a GPU. With the feature `wgpu`, whatever runs on one also runs on a caller's device and queue.
//! The physics alone is in `downpour-drop`, which builds in seconds.
//!
//! ```
//! use downpour::drop::air::Air;
//! use downpour::drop::distribution::{DropSizeDistribution, DropSizeLaw};
//! use downpour::drop::fall_speed::{FallSpeedModel, terminal_speed};
//!
//! let speed = terminal_speed(FallSpeedModel::Beard1976, 2.0e-3, &Air::standard())?;
//! let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 10.0)?;
//! println!("a drop of 2 mm falls at {speed:.2} m/s");
//! println!("10 mm/h are {:.0} drops per cubic meter", rain.number_density());
//! # assert!((speed - 6.506).abs() < 0.001);
//! # Ok::<(), downpour::drop::DropError>(())
//! ```
//!
//! Units are SI (meters, seconds, kilograms, radians); a name says so where it is something else (`rate_mm_h`,
//! `temperature_c`). Axes are those of glTF: right-handed, +Y up.

pub mod output_file;
#[cfg(feature = "wgpu")]
pub mod rain;
mod renderer;
pub mod shower;

#[cfg(feature = "wgpu")]
pub use rain::{ObstacleMesh, PlateTextures, Rain, RainError, RainSettings, RainView};
pub use renderer::{
    Backend, ClipLight, Computer, Device, DisplayFrame, Frame, PendingDisplay, PendingFrame, PixelDrop,
    Progress, Renderer, RendererError, RendererOptions, Source, Truth,
};

pub use downpour_atlas as atlas;
pub use downpour_bvh as bvh;
pub use downpour_drop as drop;
#[cfg(feature = "wgpu")]
pub use downpour_gpu as gpu;
pub use downpour_lattice as lattice;
pub use downpour_mask as mask;
pub use downpour_math as math;
pub use downpour_render as render;
pub use downpour_scene as scene;
pub use downpour_shaders as shaders;
pub use downpour_sim as sim;
pub use downpour_specimen as specimen;
pub use downpour_street as street;
pub use downpour_trace as trace;
pub use downpour_weather as weather;
pub use downpour_wind as wind;

/// The text of README.md, whose Rust parts are compiled and run.
#[cfg(all(doctest, feature = "wgpu"))]
#[doc = include_str!("../README.md")]
struct Readme;
