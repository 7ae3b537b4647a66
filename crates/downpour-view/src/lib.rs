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
pub mod plain;
pub mod schema;
pub mod theme;
pub mod wire;
