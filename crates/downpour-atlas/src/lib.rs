//! Streak atlas: appearance of a falling, oscillating drop during an exposure, by the direction of its light.
//!
//! After K. Garg, S. K. Nayar, "Photorealistic rendering of rain streaks", 2006, whose database Im & Sung 2022 (3.D)
//! assign to their particles at random. Here the streaks are traced from the shapes of `downpour-drop`, and the streak
//! of a particle is chosen by the directions of its light and of its viewer, which Im & Sung name as future work.
//!
//! # Definition of a streak
//!
//! The frame of a streak: z toward the viewer, y the drop's axis as the picture shows it (the drop falls toward -y),
//! x = y cross z, to the right. By symmetry, only light directions with x >= 0 are traced; others are mirrored.
//!
//! A texel is the radiance, in 1/sr for an irradiance of 1 across the light, at a point of the picture, averaged over
//! the time in which the drop moves on by its equivalent diameter in the picture. So with the exposure t, the
//! equivalent diameter d and the speed v of the drop across the line of sight, a streak adds
//!
//! > radiance = irradiance * texel * d / (v t)
//!
//! Columns go from left to right over the width of 2 half extents, in units of the equivalent radius. Rows go in time,
//! earliest first: row k of H is the point where the drop's center is at the phase (k + 1/2) / H of the mode (2,0). The
//! drop falls, so rows go down in the picture. One turn of that mode is stored, and streaks are tiled with it. For that
//! the mode (3,1) has twice the frequency of (2,0), 3.3 % faster than Rayleigh's ratio `sqrt(30 / 8)` = 1.936.
//!
//! # Amount and pattern
//!
//! The light of a drop falls by orders of magnitude within a few degrees of the light's direction, and its bows move with the
//! viewer's elevation and with the drop's size. So a lookup has two parts:
//!
//! - The amount is the radiance, in 1/sr for an irradiance of 1, of a disk of the equivalent radius that sends as much light to the
//!   viewer. It is traced for 41 x 41 directions of the light ([`amount_directions`]: 3 to 6 degrees apart) and 25 elevations of the
//!   viewer ([`amount_elevations`]: 4.6 degrees apart at the horizon), and interpolated linearly over directions, the sine of the
//!   elevation and the logarithm of the diameter; beyond the ends it is constant.
//! - The pattern is the ratio of the brightness at a point of the streak to that of the disk. It is a mixture of twelve layers, each
//!   divided by its mean: of the three directions nearest the light's, of two elevations and of two diameters. The mean of any mixture is
//!   1, so that the light of a streak is its amount. If elevations have different directions (Columbia's), the pattern is that of the
//!   nearest elevation.
//!
//! Both are continuous: a drop that moves or grows does not pop. A set without amounts (Columbia's files have none) has those that are
//! interpolated between the means of its layers. With [`StreakPick::Random`] a streak is one layer, with the mean of that layer.
//!
//! Against rays traced at the exact direction of the light, 20 to 175 degrees from behind the drop, the amount (mean over the four
//! oscillations of the committed atlas) is within 10 % for 79 to 97 of 100 directions at its diameters, with a root mean square of
//! 4 to 12 % and 0.76 to 1.8 times at the worst, where light falls from a bow into the dark band beside it; midway between diameters it
//! is within 10 % for 73 to 91, with 9 to 22 %, and 0.6 to 2.3 times. (`cargo test -p downpour-atlas --test amount -- --nocapture`.)
//!
//! # Light of a drop that oscillates
//!
//! The amounts are not those of a sphere. At rest they are; but with the amplitudes of Garg & Nayar 2006, 0.1 and 0.2 of the radius, the
//! light of a drop seen from the side, relative to a sphere, depends on the angle of the light from behind the drop and on the side of
//! the light (drops of 1, 2 and 4 mm, mean of the committed oscillations; the test `oscillation_takes_light_aside` of the same command
//! prints every 5 degrees):
//!
//! | light | 20 | 40 | 60 | 75 | 90 | 110 | 140 | 160 |
//! |---|---|---|---|---|---|---|---|---|
//! | aside | 1.0, 1.0, 0.9 | 1.3, 1.2, 1.0 | 1.4, 1.4, 1.1 | 1.7, 1.6, 1.3 | 2.0, 2.1, 1.7 | 1.8, 1.6, 1.0 | 1.6, 1.8, 1.9 | 2.4, 2.5, 2.1 |
//! | above | 1.0, 1.0, 0.9 | 0.8, 0.8, 0.8 | 0.7, 0.6, 0.3 | 1.0, 1.1, 0.8 | 5.3, 7.7, 1.1 | 4.7, 2.7, 1.5 | 0.3, 0.3, 0.3 | 11, 12, 6 |
//!
//! So lamps beside a drop light it more than a table of spheres, and lamps above it less. From 80 degrees on a sphere has little
//! light (0.002 to 0.04 in 1/sr, in narrow bows; 1.2 is in front), which an oscillating drop spreads.
//!
//! # Method of tracing
//!
//! Backwards: rays of the viewer, refracted and reflected up to [`INTERNAL`] times inside; each exit is
//! weighted with a light of some width (8 degrees, brightest in the middle, like a disk of 4.6 degrees). One ray then
//! serves all lights of a view, each texel has the same number of rays, and a smooth light makes the
//! sum over a regular grid converge like a quadrature. Photons of one light would serve all views instead, but atlases
//! have more lights than views, and the few photons in dim directions are noise.
//!
//! Limits: one refractive index (no rainbow colors); planes of incidence are assumed to be the same at each interface
//! (exact for a sphere); light that leaves a dent and enters again is lost; the light is at infinity.
//!
//! # Use
//!
//! ```no_run
//! use downpour_atlas::{StreakAtlas, StreakParticle, StreakPick};
//! let atlas = StreakAtlas::load("assets/streaks".as_ref())?.with_pick(StreakPick::ByAngle);
//! let particle = StreakParticle { diameter: 2.0e-3, axis: [0.0, 1.0, 0.0], id: 42 };
//! let slot = atlas.slot(&particle, [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]);
//! let texel = atlas.radiance(&slot, 0.25, 1.7); // a quarter radius to the right, after 1.7 turns
//! # Ok::<(), downpour_atlas::AtlasError>(())
//! ```

mod collection;
pub mod columbia;
mod description;
mod directions;
mod error;
mod file;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod lookup;
mod options;
mod path;
mod set;
mod streak;
mod surface;
mod triangles;

pub use collection::{MAX_SETS, StreakAtlas, StreakParticle, StreakPick};
pub use directions::{amount_directions, amount_elevations, light_directions, streak_frame};
pub use error::AtlasError;
pub use file::{read_streaks, write_streaks};
pub use options::{StreakOptions, StreakOscillation};
pub use path::INTERNAL;
pub use set::{StreakOrigin, StreakSet};
pub use streak::{StreakTracer, Streaks};

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
