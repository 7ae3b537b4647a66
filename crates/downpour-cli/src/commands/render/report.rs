//! What was done, for scripts: `--stats` and `--dump-drops`.

use std::fmt::Write as _;

use downpour::render::picture::Picture;
use downpour::sim::field::{FallingDrop, VisibleDrops};
use serde_json::{Map, Value, json};

use crate::listing::number;

/// What computed a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Computer {
    /// The adapter as its driver names it, or the CPU.
    pub(super) adapter: String,
    /// `gpu` or `cpu`.
    pub(super) backend: &'static str,
}

/// What `--stats` tells beside the picture.
pub(super) struct Told<'a> {
    pub(super) computer: &'a Computer,
    pub(super) rain: &'a VisibleDrops,
    pub(super) asked_rate_mm_h: f64,
    pub(super) measured_rate_mm_h: f64,
    pub(super) time_s: f64,
    pub(super) seed: u64,
    pub(super) triangles: usize,
    /// All of the picture, from the drops to the last pass.
    pub(super) frame_ms: f64,
}

/// The text of `--stats`.
pub(super) fn stats(picture: &Picture, told: &Told<'_>) -> String {
    let mut passes = Map::new();
    for (name, ms) in &picture.passes {
        passes.insert((*name).to_owned(), number(*ms));
    }
    let object = json!({
        "adapter": told.computer.adapter,
        "backend": told.computer.backend,
        "width": picture.size[0],
        "height": picture.size[1],
        "drops_simulated": told.rain.simulated,
        "drops_drawn": picture.drawn.len(),
        "drops_on_screen": picture.drops_on_screen,
        "asked_rate_mm_h": number(told.asked_rate_mm_h),
        "measured_rate_mm_h": number(told.measured_rate_mm_h),
        "least_pixels": number(told.rain.least_pixels),
        "time_s": number(told.time_s),
        "seed": told.seed,
        "triangles": told.triangles,
        "frame_ms": number(told.frame_ms),
        "passes": Value::Object(passes),
    });
    format!("{object:#}\n")
}

/// The text of `--dump-drops`: each drop that was drawn, nearest first, in the world.
pub(super) fn drops(drawn: &[u32], drops: &[FallingDrop]) -> String {
    let mut text = String::from("id,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,diameter_mm,kind\n");
    for drop in drawn.iter().filter_map(|&index| drops.get(index as usize)) {
        let [x, y, z] = drop.position.to_array();
        let [vx, vy, vz] = drop.velocity.map(|v| v + 0.0);
        let mm = drop.diameter * 1.0e3;
        let _ = writeln!(text, "{},{x},{y},{z},{vx},{vy},{vz},{mm},falling", drop.id);
    }
    text
}
