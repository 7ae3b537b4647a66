//! Classes of drops that have a mean in the streak radiance table: each of about one size.

use super::DropMasks;
use super::exposure::Exposure;
use super::masks::DIAMETER_STEP;
use super::streak_path::StreakPath;

/// Rows of the masks' diameters: 0.5, 1, 1.5, 2, 3, 4, 5 and 6.5 mm.
const ROWS: [f32; 8] = [0.0, 1.0, 2.0, 3.0, 5.0, 7.0, 9.0, 12.0];

/// The class of a row.
pub(super) fn of_row(row: f32) -> u32 {
    let nearer = |a: &u32, b: &u32| {
        let off = |k: u32| (ROWS[k as usize] - row).abs();
        off(*a).total_cmp(&off(*b))
    };
    (0..ROWS.len() as u32).min_by(nearer).unwrap_or(0)
}

/// The classes; none of them is wanted yet.
pub(super) fn classes(masks: &DropMasks, exposure: &Exposure) -> Vec<StreakPath> {
    let amplitudes = exposure.oscillation.pair().map(|a| a as f32);
    let diameter = |row: f32| (row + 1.0) * DIAMETER_STEP as f32;
    ROWS.iter().map(|&row| StreakPath { amplitudes, ..masks.streak_shape(diameter(row)) }).collect()
}
