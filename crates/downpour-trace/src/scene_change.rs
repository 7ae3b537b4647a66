//! What differs between two states of a scene, by what it takes to show it.

use std::ops::Range;
use std::sync::Arc;

use downpour_shaders::render::puddle_wake::PUDDLE_WAKE_ROW;
use downpour_shaders::render::puddle_water::PUDDLE_WATER_ROWS;

use crate::data::SceneData;
use crate::wet::{WET_ROWS_THAT_CHANGE, wet_fraction};

/// Change of a wetness between 0 and 1 that counts as none.
const MIN_WETTING: f32 = 1.0 / 128.0;

/// Fluxes of rain that surfaces meet, for which wetness is compared.
const FLUXES: [f32; 3] = [1.0, 0.2, 0.04];

/// Parts of a scene that differ between two of its states. Ripples on a device, and rain on panes, are not looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct SceneChange {
    /// Waves on puddles: rings of single drops, wakes, and what runs.
    pub(crate) waves: bool,
    /// Where and how deep the water of puddles is, and its look.
    pub(crate) water: bool,
    /// The wetness of surfaces, by more than nobody can tell.
    pub(crate) wetness: bool,
    /// Surfaces, lights, the sky, a pane before the camera.
    pub(crate) rest: bool,
}

impl SceneChange {
    /// The change from one state to another. What the states share is the same memory.
    pub(crate) fn between(before: &SceneData, scene: &SceneData) -> Self {
        let shares = Arc::ptr_eq(&before.nodes, &scene.nodes)
            && Arc::ptr_eq(&before.triangles, &scene.triangles)
            && Arc::ptr_eq(&before.corners, &scene.corners)
            && Arc::ptr_eq(&before.texels, &scene.texels)
            && Arc::ptr_eq(&before.sky, &scene.sky);
        let counts = |scene: &SceneData| (scene.wetness > 0, scene.glazing_rows().len(), scene.puddle_count);
        if !shares || counts(before) != counts(scene) {
            return Self { rest: true, ..Self::default() };
        }
        let puddles = puddle_rows;
        let looks = |scene| looks_of_puddles(scene).flatten();
        Self {
            waves: before.table[puddles(before)] != scene.table[puddles(scene)],
            water: !has_maps_alike(before, scene) || !looks(before).eq(looks(scene)),
            wetness: !is_wet_alike(before, scene),
            rest: rest_of_table(before) != rest_of_table(scene),
        }
    }
}

/// Rows of the wetness that change with time.
fn wet_rows(scene: &SceneData) -> Range<usize> {
    let first = scene.wetness as usize;
    first..first + if first > 0 { WET_ROWS_THAT_CHANGE } else { 0 }
}

/// Rows of the puddles and of the waves on them.
fn puddle_rows(scene: &SceneData) -> Range<usize> {
    let end = if scene.pane > 0 { scene.pane as usize } else { scene.table.len() };
    let first = if scene.puddle_count > 0 { scene.puddles as usize } else { end };
    first..end
}

/// Parts of the table with neither the wetness that changes, nor rain on panes, nor puddles.
fn rest_of_table(scene: &SceneData) -> Vec<&[[u32; 4]]> {
    let panes = scene.glazing as usize..scene.glazing as usize + scene.glazing_rows().len();
    // In their order in the table.
    let left_out = [wet_rows(scene), panes, puddle_rows(scene)];
    let mut parts = Vec::new();
    let mut first = 0;
    for rows in left_out.into_iter().filter(|rows| !rows.is_empty()) {
        parts.push(&scene.table[first..rows.start]);
        first = rows.end;
    }
    parts.push(&scene.table[first..]);
    parts
}

/// Rows with the place and the look of each puddle.
fn looks_of_puddles(scene: &SceneData) -> impl Iterator<Item = &[[u32; 4]]> {
    let of_puddle = |k: u32| (scene.puddles + k * PUDDLE_WATER_ROWS) as usize;
    (0..scene.puddle_count).map(move |k| &scene.table[of_puddle(k)..of_puddle(k) + PUDDLE_WAKE_ROW as usize])
}

/// True if water stands and runs in the same places.
fn has_maps_alike(before: &SceneData, scene: &SceneData) -> bool {
    let maps = before.shared.iter().zip(&scene.shared);
    before.shared.len() == scene.shared.len()
        && maps.into_iter().all(|(a, b)| a.is(b) || a.rows() == b.rows())
}

/// True if nobody can tell how much wetter surfaces are.
fn is_wet_alike(before: &SceneData, scene: &SceneData) -> bool {
    if scene.wetness == 0 || before.table[wet_rows(before)] == scene.table[wet_rows(scene)] {
        return true;
    }
    let wetness = |scene: &SceneData| {
        let wet = scene.wet_load();
        FLUXES.map(|flux| wet_fraction(wet.before, wet.kept, wet.since, flux))
    };
    wetness(before).iter().zip(wetness(scene)).all(|(a, b)| (a - b).abs() <= MIN_WETTING)
}
