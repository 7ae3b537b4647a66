//! `wgsl/drop`: one drop and many. The Rust twins are in `downpour-drop`.

pub mod distribution;
pub mod fall_speed;
pub mod optics;
pub mod oscillation;
pub mod shape;
