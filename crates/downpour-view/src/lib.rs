//! The live window of Downpour: the scene with its rain, and the weather file under it, edited by hand.

#![forbid(unsafe_code)]

pub mod app;
pub mod brush;
pub mod document;
pub mod engine;
pub mod job;
pub mod key_path;
pub mod navigation;
pub mod objects;
pub mod offscreen;
pub mod plain;
pub mod raster;
pub mod schema;
pub mod script;
pub mod theme;
pub mod window;
pub mod wire;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
