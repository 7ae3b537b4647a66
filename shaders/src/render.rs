//! `wgsl/render`: pictures. The Rust twins are in `downpour-render`.

pub mod brdf;
pub mod camera;
pub mod drop_light;
pub mod glass;
pub mod glazing;
pub mod glow;
pub mod host;
pub mod impostor;
pub mod layers;
pub mod medium;
pub mod pane_shadow;
pub mod path;
pub mod puddle_flow;
pub mod puddle_rings;
pub mod puddle_wake;
pub mod puddle_water;
pub mod rain;
pub mod refine;
pub mod scatter;
pub mod scene;
pub mod specimen;
pub mod spray;
pub mod table;
pub mod tone;
pub mod translucent;
pub mod wet;
