//! The streak radiance table. Twin of `shaders/wgsl/render/streak_lookup.wgsl`, where its layout is described.

use downpour_shaders::render::rain::{STREAK_RAYS, STREAK_SUMS};
use glam::{Vec2, Vec3, Vec4};

use super::streak::{ScreenDrop, streak_depth, streak_time, streak_weight};
use super::streak_cell::{streak_cell_index, streak_cell_position};
use super::streak_span::streak_span;

/// Entries of the mean of a class of drops.
pub(super) const STREAK_MEAN_ENTRIES: u32 = STREAK_RAYS * STREAK_RAYS;

/// Streak radiance table of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreakTable {
    /// Means of classes of drops, then the profiles of streaks.
    pub entries: Vec<[f32; 4]>,
}

/// Position in the profile of a drop at which a ray passes it.
#[derive(Clone, Copy, Debug)]
struct StreakPassage {
    /// First entry of the profile.
    first: u32,
    /// Rows and columns of chords.
    rows: u32,
    columns: u32,
    /// Rows of the profile, and fine columns of each column.
    profile_rows: u32,
    fine: u32,
    /// Fraction of the rows before the time at which the drop is nearest.
    row: f32,
    /// Position across the outline in fractions of its columns, 0 to 1.
    across: f32,
    /// The part of the chord that passes during the exposure, -1 to 1; none if `high` is not above `low`.
    low: f32,
    high: f32,
    /// Fraction of the exposure in which the whole chord would pass, by the weight in the middle of the part that does.
    fraction: f32,
}

impl StreakTable {
    fn entry(&self, k: u32) -> Vec4 {
        Vec4::from(self.entries[k as usize])
    }

    /// The chords between columns of a row: middle and half of the outline's width, middle and half of the chord.
    fn streak_lookup_chord(&self, first: u32, columns: u32, row: u32, at: f32) -> Vec4 {
        let low = (at as u32).min(columns - 2);
        let part = at - low as f32;
        let entry = first + 1 + row * columns + low;
        self.entry(entry) * (1.0 - part) + self.entry(entry + 1) * part
    }

    /// Returns the position in a drop's profile for a point of the plane.
    fn streak_lookup_passage(&self, drop: &ScreenDrop, at: Vec2) -> StreakPassage {
        let first = drop.profile;
        let [rows, columns, profile_rows, fine] = self.entry(first).to_array().map(|n| n as u32);
        let span = streak_span(drop);
        let along = Vec2::from(drop.along);
        let moves = along.dot(along).sqrt().max(1.0e-20);
        let nearest = (at - Vec2::from(drop.start)).dot(along) / (moves * moves);
        let way = nearest.clamp(-span.before, 1.0 + span.after);
        let time = streak_time(drop.depth_ratio, way);
        let scale = drop.slope / streak_depth(drop.depth_ratio, time);
        let path = along / moves;
        let offset = (at - Vec2::from(drop.start) - along * way) / scale;
        let aside = offset.x * path.y - offset.y * path.x;
        let ahead = offset.dot(path);
        let fraction = ((time - span.first) / (span.last - span.first)).clamp(0.0, 1.0);
        let row_at = fraction * (rows - 1) as f32;
        let row = (row_at as u32).min(rows - 2);
        let row_part = row_at - row as f32;
        let width_of = |row: u32| self.entry(first + 1 + row * columns);
        let width = width_of(row) * (1.0 - row_part) + width_of(row + 1) * row_part;
        let position = (aside - width.x) / width.y.max(1.0e-6);
        let across = streak_cell_index(position, 1);
        let column_at = (across * columns as f32 - 0.5).clamp(0.0, (columns - 1) as f32);
        let chord = self.streak_lookup_chord(first, columns, row, column_at) * (1.0 - row_part)
            + self.streak_lookup_chord(first, columns, row + 1, column_at) * row_part;
        let half = chord.w * (1.0 - position * position).max(0.0).sqrt();
        let per_half = 1.0 / half.max(1.0e-6);
        let faster = way + (1.0 - way) * drop.depth_ratio;
        // Time in which it moves by an equivalent radius.
        let pace = drop.depth_ratio / (faster * faster).max(1.0e-12) * scale / moves;
        let low = (((ahead - chord.z) - (1.0 - time) / pace) * per_half).max(-1.0);
        let high =
            if half <= 1.0e-6 { -2.0 } else { (((ahead - chord.z) + time / pace) * per_half).min(1.0) };
        let middle = time + ((ahead - chord.z) - 0.5 * half * (low + high)) * pace;
        let weight = streak_weight(drop.weights, middle);
        StreakPassage {
            first,
            rows,
            columns,
            profile_rows,
            fine,
            row: fraction,
            across,
            low,
            high,
            fraction: 2.0 * half * pace * drop.fraction * weight,
        }
    }

    /// A running sum of a row of a profile, between its fine columns; sum 0 is nothing.
    fn streak_lookup_column(&self, passage: &StreakPassage, row: u32, sums: u32) -> Vec3 {
        if sums == 0 {
            return Vec3::ZERO;
        }
        let columns = passage.columns * passage.fine;
        let at = (passage.across * columns as f32 - 0.5).clamp(0.0, (columns - 1) as f32);
        let low = (at as u32).min(columns - 2);
        let part = at - low as f32;
        let chords = passage.first + 1 + passage.rows * passage.columns;
        let entry = chords + (row * columns + low) * STREAK_SUMS + sums - 1;
        self.entry(entry).truncate() * (1.0 - part) + self.entry(entry + STREAK_SUMS).truncate() * part
    }

    /// The same between rows.
    fn streak_lookup_sum(&self, passage: &StreakPassage, sums: u32) -> Vec3 {
        let at = passage.row * (passage.profile_rows - 1) as f32;
        let low = (at as u32).min(passage.profile_rows - 2);
        let part = at - low as f32;
        self.streak_lookup_column(passage, low, sums) * (1.0 - part)
            + self.streak_lookup_column(passage, low + 1, sums) * part
    }

    /// The running sum up to a position on the chord, -1 to 1.
    fn streak_lookup_until(&self, passage: &StreakPassage, position: f32) -> Vec3 {
        let at = streak_cell_index(position, STREAK_SUMS);
        let low = (at as u32).min(STREAK_SUMS - 1);
        // By length: in a uniform environment light is proportional to coverage.
        let first = streak_cell_position(low as f32, STREAK_SUMS);
        let length = streak_cell_position((low + 1) as f32, STREAK_SUMS) - first;
        let part = ((position - first) / length).clamp(0.0, 1.0);
        self.streak_lookup_sum(passage, low) * (1.0 - part) + self.streak_lookup_sum(passage, low + 1) * part
    }

    /// A streak at a position of the plane: radiance times the fraction of the exposure in which it is covered, and this fraction.
    pub(super) fn streak_lookup_shown(&self, drop: &ScreenDrop, at: Vec2) -> Vec4 {
        let passage = self.streak_lookup_passage(drop, at);
        let (low, high) = (passage.low, passage.high);
        if high <= low {
            return Vec4::ZERO;
        }
        let light = if low <= -1.0 && high >= 1.0 {
            self.streak_lookup_sum(&passage, STREAK_SUMS)
        } else {
            self.streak_lookup_until(&passage, high) - self.streak_lookup_until(&passage, low)
        };
        light.extend((high - low) * 0.5) * passage.fraction
    }

    /// The mean radiance of a whole drop of a class. `position` is in [0, 1] from the top left of the picture.
    pub(super) fn streak_lookup_mean(&self, shape: u32, position: Vec2) -> Vec3 {
        let at = position.clamp(Vec2::ZERO, Vec2::ONE) * (STREAK_RAYS - 1) as f32;
        let low = [at.x, at.y].map(|a| (a as u32).min(STREAK_RAYS - 2));
        let part = at - Vec2::new(low[0] as f32, low[1] as f32);
        let first = (shape * STREAK_RAYS + low[1]) * STREAK_RAYS + low[0];
        let entry = |k: u32| self.entry(first + k).truncate();
        let upper = entry(0) * (1.0 - part.x) + entry(1) * part.x;
        let lower = entry(STREAK_RAYS) * (1.0 - part.x) + entry(STREAK_RAYS + 1) * part.x;
        upper * (1.0 - part.y) + lower * part.y
    }
}
