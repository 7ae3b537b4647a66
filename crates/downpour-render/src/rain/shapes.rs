//! Classes of drops for the streak radiance table: about one size, about one velocity.

use downpour_shaders::render::rain::{DROPS_LOOP, DROPS_STILL, DROPS_TABLE, STREAK_CHORDS, STREAK_MEAN};
use glam::{DVec3, Vec3};

use super::DropMasks;
use super::drops_mask::drops_mask_right;
use super::project::Projected;
use super::streak_table::{StreakShape, streak_table_direction};

/// Rows of the masks' diameters: 0.5, 1, 1.5, 2, 3, 4, 5 and 6.5 mm.
const ROWS: [f32; 8] = [0.0, 1.0, 2.0, 3.0, 5.0, 7.0, 9.0, 12.0];

/// A drop whose motion differs from that of its class by more than this cosine is averaged by a loop: 20 degrees.
const ALIKE: f32 = 0.94;

/// The class of a row.
pub(super) fn of_row(row: f32) -> u32 {
    let nearer = |a: &u32, b: &u32| {
        let off = |k: u32| (ROWS[k as usize] - row).abs();
        off(*a).total_cmp(&off(*b))
    };
    (0..ROWS.len() as u32).min_by(nearer).unwrap_or(0)
}

/// The classes of these drops, none if no drop moves. Drops that move otherwise than their class go to the loop. Of the
/// class `medium`, if there is one, the mean is wanted in any case.
pub(super) fn classify(
    drops: &mut [(u32, Projected)],
    masks: &DropMasks,
    medium: Option<u32>,
) -> Vec<StreakShape> {
    let mut sums = [(DVec3::ZERO, 0u32); ROWS.len()];
    let moves = |projected: &Projected| projected.velocity != Vec3::ZERO;
    for (_, projected) in drops.iter().filter(|(_, projected)| moves(projected)) {
        let (sum, count) = &mut sums[projected.drop.shape as usize];
        *sum += projected.velocity.as_dvec3();
        *count += 1;
    }
    if medium.is_none() && sums.iter().all(|(_, count)| *count == 0) {
        return Vec::new();
    }
    let mut shapes = ROWS.map(|row| masks.shape(row));
    for (shape, (sum, count)) in shapes.iter_mut().zip(sums) {
        shape.velocity = (sum / f64::from(count.max(1))).as_vec3().into();
    }
    if let Some(shape) = medium.and_then(|medium| shapes.get_mut(medium as usize)) {
        shape.wanted = STREAK_MEAN;
    }
    for (_, projected) in drops.iter_mut() {
        let drop = &mut projected.drop;
        let shape = &mut shapes[drop.shape as usize];
        if drop.kind != DROPS_STILL && drop.grid == 0 {
            shape.wanted = shape.wanted.max(STREAK_MEAN);
        }
        if drop.kind != DROPS_TABLE || drop.grid == 0 {
            continue;
        }
        let towards = Vec3::from(drop.towards);
        let right = drops_mask_right(towards);
        let up = right.cross(towards);
        let oval = Vec3::from(drop.oval);
        let way = |velocity: Vec3| streak_table_direction(right, up, velocity, oval);
        if way(shape.velocity.into()).dot(way(projected.velocity)) < ALIKE {
            drop.kind = DROPS_LOOP;
        } else {
            shape.wanted = STREAK_CHORDS;
        }
    }
    shapes.into()
}
