//! `wgsl/sim`: where drops are. The Rust twins are in `downpour-sim`.

pub mod collision;
pub mod enter;
pub mod step;
