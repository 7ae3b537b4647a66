//! Streak atlas: how a drop that falls and oscillates looks during an exposure, by where its light stands.
//!
//! After K. Garg, S. K. Nayar, "Photorealistic rendering of rain streaks", 2006, whose database Im & Sung 2022 (3.D)
//! put on their particles at random. Here the streaks are traced from the shapes of `downpour-drop`, and the streak
//! of a particle is chosen by the directions of its light and of its viewer, which Im & Sung name as future work.
//!
//! # What a streak is
//!
//! The frame of a streak: z towards the viewer, y the drop's axis as the picture shows it (the drop falls towards -y),
//! x = y cross z, to the right. By symmetry, only light directions with x >= 0 are traced; others are mirrored.
//!
//! A texel is the radiance, in 1/sr for an irradiance of 1 across the light, at a point of the picture, averaged over
//! the time in which the drop moves on by its equivalent diameter in the picture. So with the exposure t, the
//! equivalent diameter d and the speed v of the drop across the line of sight, a streak adds
//!
//! > radiance = irradiance * texel * d / (v t)
//!
//! Columns go from left to right over the width of 2 half extents, in units of the equivalent radius. Rows go in time,
//! earliest first: row k of H is the point where the drop's centre is at the phase (k + 1/2) / H of the mode (2,0). The
//! drop falls, so rows go down in the picture. One turn of that mode is stored, and streaks are tiled with it. The mode
//! (3,1) is run at twice the frequency of (2,0) for that, 3.3 % faster than Rayleigh's ratio `sqrt(30 / 8)` = 1.936.
//!
//! # How it is traced
//!
//! Backwards: rays of the viewer, refracted and reflected up to [`INTERNAL`] times inside, and each that leaves is
//! weighted with a light of some width (8 degrees, brightest in the middle, like a disc of 4.6 degrees). One ray then
//! serves all lights of a view, each texel has the same number of rays whatever it shows, and a smooth light makes the
//! sum over a regular grid converge like a quadrature. Photons of one light would serve all views instead, but atlases
//! have more lights than views, and the few photons that go to dim directions are noise there.
//!
//! Limits: one refractive index (no rainbow colours); planes of incidence are taken to be the same at each interface
//! (exact for a sphere); light that leaves a dent and comes in again is lost; the light is far away.
//!
//! # Use
//!
//! ```no_run
//! use downpour_mask::atlas::{StreakAtlas, StreakParticle, StreakPick};
//! let atlas = StreakAtlas::load("assets/streaks".as_ref())?.with_pick(StreakPick::ByAngle);
//! let particle = StreakParticle { diameter: 2.0e-3, axis: [0.0, 1.0, 0.0], id: 42 };
//! let place = atlas.place(&particle, [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]);
//! let texel = atlas.radiance(&place, 0.25, 1.7); // a quarter radius to the right, after 1.7 turns
//! # Ok::<(), downpour_mask::MaskError>(())
//! ```

mod collection;
pub mod columbia;
mod description;
mod directions;
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

pub use collection::{MOST_SETS, StreakAtlas, StreakParticle, StreakPick};
pub use directions::{light_directions, streak_frame};
pub use file::{read_streaks, write_streaks};
pub use options::{StreakOptions, StreakOscillation};
pub use path::INTERNAL;
pub use set::{StreakOrigin, StreakSet};
pub use streak::{StreakTracer, Streaks};
