//! The one crate that turns bytes from outside into checked data.
//!
//! A file from outside is hostile until it has been checked: it may name other files, claim sizes that it does
//! not have, point in circles, or hold numbers that are none. What leaves this crate is finite, in range and
//! within the caller's [`Budget`]; what does not is a [`SceneError`] of one line that says where, what was found
//! and what would be accepted.
//!
//! - [`gltf`]: scenes of glTF 2.0 files (`.gltf`, `.glb`), and their triangles alone in world space;
//! - [`scene`]: what a scene is, and where everything in it is at a time;
//! - [`picture`]: PNG, JPEG, Radiance HDR and OpenEXR;
//! - [`sky`]: equirectangular maps of the sky's radiance, and their sun;
//! - [`beneath`]: opening a relative path that cannot leave its folder;
//! - [`budget`]: what a caller is willing to spend on somebody else's file;
//! - [`uri`]: relative paths and data addresses, checked;
//! - [`error`], [`warning`]: what was wrong, and what was left out.
//!
//! ```no_run
//! use downpour_scene::{Budget, gltf::read_triangles};
//! let model = read_triangles("drop.glb".as_ref(), &mut Budget::default())?;
//! for warning in &model.warnings {
//!     eprintln!("{warning}");
//! }
//! println!("{} triangles", model.indices.len());
//! # Ok::<(), downpour_scene::SceneError>(())
//! ```

#![forbid(unsafe_code)]
#![cfg_attr(
    not(test),
    deny(
        clippy::arithmetic_side_effects,
        clippy::cast_possible_truncation,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        clippy::unwrap_used,
    )
)]

mod base64;
mod magic;

pub mod beneath;
pub mod budget;
pub mod error;
pub mod gltf;
pub mod picture;
pub mod scene;
pub mod sky;
pub mod uri;
pub mod warning;

pub use budget::Budget;
pub use error::{Fault, SceneError};
pub use warning::{Warning, WarningKind};
