//! Contact sheet of streaks: a row for each set, seen from the side, a column for each light.

use std::io::Cursor;

use downpour_atlas::StreakSet;
use image::{GrayImage, ImageFormat, Luma};

/// Turns of a streak.
const TURNS: u32 = 3;
/// Pixels between streaks.
const GAP: u32 = 6;

/// The picture as a PNG. Each streak is scaled to its brightest texel; the tone is a root.
pub(super) fn sheet(sets: &[StreakSet]) -> Result<Vec<u8>, String> {
    let Some(first) = sets.first() else { return Err("no streaks to show".to_owned()) };
    let (columns, rows) = (first.options.columns, first.options.rows);
    let level = first.elevations.iter().position(|e| e.abs() < 1.0e-9).unwrap_or(0);
    let lights = first.directions[level].len() as u32;
    let width = lights * (columns + GAP) + GAP;
    let height = sets.len() as u32 * (TURNS * rows + GAP) + GAP;
    let mut picture = GrayImage::from_pixel(width, height, Luma([24]));
    for (set, top) in sets.iter().zip((GAP..).step_by((TURNS * rows + GAP) as usize)) {
        for (light, left) in (0..lights).zip((GAP..).step_by((columns + GAP) as usize)) {
            let Some(texels) = set.layer(level, light as usize) else { continue };
            let most = texels.iter().map(|v| v.to_f32()).fold(f32::MIN_POSITIVE, f32::max);
            for y in 0..TURNS * rows {
                for x in 0..columns {
                    let value = texels[((y % rows) * columns + x) as usize].to_f32() / most;
                    picture.put_pixel(left + x, top + y, Luma([(value.sqrt() * 255.0).round() as u8]));
                }
            }
        }
    }
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}
