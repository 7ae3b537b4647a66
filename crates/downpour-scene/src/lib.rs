//! The one crate that turns bytes from outside into checked data.
//!
//! A file from outside is hostile until it has been checked: it may name other files, claim sizes that it does
//! not have, point in circles, or hold values that are not numbers. Results of this crate are finite, in range and
//! within the caller's [`Budget`]; otherwise the result is a [`SceneError`] of one line with the position, the value
//! found and the values allowed.
//!
//! - [`gltf`]: scenes of glTF 2.0 files (`.gltf`, `.glb`), and their triangles alone in world space;
//! - [`scene`]: scenes as plain data, and their poses at a time;
//! - [`picture`]: PNG, JPEG, Radiance HDR and OpenEXR;
//! - [`sky`]: equirectangular maps of the sky's radiance, and their sun;
//! - [`sandbox`]: opening a relative path that cannot leave its folder;
//! - [`budget`]: limits of memory, time and nodes for a file from outside;
//! - [`uri`]: relative paths and data addresses, checked;
//! - [`error`], [`warning`]: errors, and warnings about dropped parts.
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

pub mod budget;
pub mod error;
pub mod gltf;
pub mod picture;
pub mod sandbox;
pub mod scene;
pub mod sky;
pub mod uri;
pub mod warning;

pub use budget::Budget;
pub use error::{Fault, SceneError};
pub use warning::{Warning, WarningKind};

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
