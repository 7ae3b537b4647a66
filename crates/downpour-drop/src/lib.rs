//! Under construction.

pub mod air;
pub mod axis_ratio;
pub mod distribution;
pub mod error;
pub mod fall_speed;
pub mod mesh;
pub mod optics;
pub mod oscillation;
pub mod shape;
pub mod water;

pub use error::DropError;
pub use shape::DropShape;
