//! Wind over time as a sum of primitives, gusts and turbulence, and the wind field over a box of cells.
//!
//! After P. Rousseau, V. Jolivet, D. Ghazanfarpour, "GPU rainfall", 2008, section 3 and 5.1.2, who follow J. Wejchert,
//! D. Haumann 1991.
//!
//! - [`design`]: the five primitives with their ranges: uniform, source, sink, vortex, tornado;
//! - [`matrix`]: the paper's 3x3 matrix of a primitive, encoded and decoded;
//! - [`primitive`]: the velocity of a primitive, with a core that keeps it finite;
//! - [`grid`], [`mask`], [`field`]: the sum in the cells of a box, 0 inside objects, trilinear between the cells;
//! - [`field_spread`]: how much the wind of a field differs about a position;
//! - [`timeline`], [`part`]: parameters with keys over time;
//! - [`gusts`], [`turbulence`]: fluctuations in time and in space, with the spectra of Kaimal and von Karman;
//! - [`wind`]: the complete wind; [`uniform`]: uniform wind, and the response of drops to it;
//! - `gpu` (feature `wgpu`): the field in a buffer of a GPU.
//!
//! Units are SI: meters, m/s. A strength is in m^2/s for line forms (flow per length, circulation) and in m^3/s for
//! point forms (flow, circulation times length). Axes are those of glTF: right-handed, +Y up.
//!
//! Uniform wind, vortices and tornadoes have no divergence. Sources and sinks have theirs around their line or point; a
//! fraction of at most e^2 / r^2 (line) or 1.5 e^2 / r^2 (point) of it is farther away than r, where e is the core
//! radius. The same holds for the rotation of a line vortex. Flows without divergence and rotation solve the steady
//! Navier-Stokes equations, and so do their sums; only the cores, point vortices and updrafts do not.
//!
//! Functions whose names start with `wind_` are twins of WGSL functions.
//!
//! ```
//! use downpour_wind::{WindField, WindGrid, WindMask, WindPrimitive, WindUniform};
//! use glam::Vec3;
//!
//! let grid = WindGrid::new(Vec3::ZERO, Vec3::splat(16.0), [16, 16, 16])?;
//! let wind = WindPrimitive::Uniform(WindUniform { speed: 4.0, direction: Vec3::X });
//! let house = WindMask::from_fn(&grid, |at| at.x > 8.0 && at.y < 6.0);
//! let field = WindField::new(&grid, &[wind], &house)?;
//! assert_eq!(field.sample(Vec3::new(3.2, 1.0, 5.0)), Vec3::new(4.0, 0.0, 0.0));
//! assert_eq!(field.sample(Vec3::new(12.0, 1.0, 5.0)), Vec3::ZERO);
//! # Ok::<(), downpour_wind::WindError>(())
//! ```

pub mod design;
mod error;
pub mod field;
mod field_grid;
pub mod field_spread;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod grid;
pub mod gusts;
pub mod mask;
pub mod matrix;
pub mod part;
pub mod primitive;
pub mod timeline;
pub mod turbulence;
pub mod uniform;
pub mod wind;

pub use design::{WindCore, WindForm, WindPrimitive, WindSingularity, WindTornado, WindUniform};
pub use error::WindError;
pub use field::WindField;
pub use grid::WindGrid;
pub use gusts::Gusts;
pub use mask::WindMask;
pub use matrix::WindMatrix;
pub use part::{KeyedSingularity, KeyedTornado, WindPart};
pub use timeline::{Keyed, WIND_KEY_TIMES, WIND_KEYS};
pub use turbulence::{Turbulence, WindTurbulenceMode};
pub use uniform::{Followed, UniformWind, UniformWindAt};
pub use wind::{WIND_PARTS, Wind};

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
