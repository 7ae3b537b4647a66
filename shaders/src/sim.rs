//! `wgsl/sim`: positions and motion of drops. The Rust twins are in `downpour-sim`.

pub mod bounce;
pub mod collision;
pub mod drip;
pub mod enter;
pub mod field;
pub mod splash;
pub mod step;
pub mod step_list;
