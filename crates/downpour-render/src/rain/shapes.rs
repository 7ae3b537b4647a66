//! Classes of drops that have a mean in the streak radiance table: each of about one size.

use downpour_shaders::render::rain::PROJECT_CLASS_ROWS;

use super::DropMasks;
use super::exposure::Exposure;
use super::masks::DIAMETER_STEP;
use super::streak_path::StreakPath;

/// The classes; none of them is wanted yet.
pub(super) fn classes(masks: &DropMasks, exposure: &Exposure) -> Vec<StreakPath> {
    let amplitudes = exposure.oscillation.pair().map(|a| a as f32);
    let diameter = |row: f32| (row + 1.0) * DIAMETER_STEP as f32;
    PROJECT_CLASS_ROWS
        .iter()
        .map(|&row| StreakPath { amplitudes, ..masks.profiles_shape(diameter(row)) })
        .collect()
}
