//! The streak radiance table. Twin of `shaders/wgsl/render/streak_lookup.wgsl`, where its layout is described.

use downpour_shaders::render::rain::{STREAK_ACROSS, STREAK_RAYS, STREAK_SUMS};
use glam::{Vec2, Vec3, Vec4};
use half::f16;

/// Bytes of the table of one shape.
pub const STREAK_SHAPE_BYTES: usize =
    ((STREAK_ACROSS + 1) * STREAK_RAYS * STREAK_RAYS * STREAK_SUMS * 8) as usize;

/// The averages of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreakTable {
    /// Two words of two halves per entry: radiance times coverage, and coverage.
    pub words: Vec<[u32; 2]>,
}

/// Both halves of a word.
pub(crate) fn unpack(word: u32) -> [f32; 2] {
    [f16::from_bits(word as u16).to_f32(), f16::from_bits((word >> 16) as u16).to_f32()]
}

/// Two numbers as halves, rounded to the nearest.
pub(crate) fn pack(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|x| u32::from(f16::from_f32(x).to_bits()));
    low | high << 16
}

/// The numbers of an entry.
#[must_use]
pub fn streak_numbers(entry: [u32; 2]) -> [f32; 4] {
    let [low, high] = entry.map(unpack);
    [low[0], low[1], high[0], high[1]]
}

impl StreakTable {
    /// One entry; running sum 0 is nothing.
    fn streak_lookup_entry(&self, shape: u32, across: u32, column: u32, row: u32, sums: u32) -> Vec4 {
        if sums == 0 {
            return Vec4::ZERO;
        }
        let layer = shape * (STREAK_ACROSS + 1) + across;
        let at = ((layer * STREAK_RAYS + row) * STREAK_RAYS + column) * STREAK_SUMS + sums - 1;
        Vec4::from(streak_numbers(self.words[at as usize]))
    }

    /// Between rays. `place` is in [0, 1] from the top left of the picture.
    fn streak_lookup_rays(&self, shape: u32, across: u32, place: Vec2, sums: u32) -> Vec4 {
        let at = place.clamp(Vec2::ZERO, Vec2::ONE) * (STREAK_RAYS - 1) as f32;
        let low = [at.x, at.y].map(|a| (a as u32).min(STREAK_RAYS - 2));
        let part = at - Vec2::new(low[0] as f32, low[1] as f32);
        let entry = |x, y| self.streak_lookup_entry(shape, across, low[0] + x, low[1] + y, sums);
        let upper = entry(0, 0) * (1.0 - part.x) + entry(1, 0) * part.x;
        let lower = entry(0, 1) * (1.0 - part.x) + entry(1, 1) * part.x;
        upper * (1.0 - part.y) + lower * part.y
    }

    /// Between places across the motion, -1 to 1.
    fn streak_lookup_sum(&self, shape: u32, across: f32, place: Vec2, sums: u32) -> Vec4 {
        let at = ((across * 0.5 + 0.5) * STREAK_ACROSS as f32 - 0.5).clamp(0.0, (STREAK_ACROSS - 1) as f32);
        let low = (at as u32).min(STREAK_ACROSS - 2);
        let part = at - low as f32;
        self.streak_lookup_rays(shape, low, place, sums) * (1.0 - part)
            + self.streak_lookup_rays(shape, low + 1, place, sums) * part
    }

    /// The running sum up to a place on the chord, -1 to 1.
    fn streak_lookup_until(&self, shape: u32, across: f32, place: Vec2, v: f32) -> Vec4 {
        let at = ((v * 0.5 + 0.5) * STREAK_SUMS as f32).clamp(0.0, STREAK_SUMS as f32);
        let low = at as u32;
        let part = at - low as f32;
        let sum = self.streak_lookup_sum(shape, across, place, low) * (1.0 - part);
        if part > 0.0 {
            return sum + self.streak_lookup_sum(shape, across, place, low + 1) * part;
        }
        sum
    }

    /// The part of a chord from `low` to `high`, as a share of what the whole shows.
    pub(super) fn streak_lookup_part(
        &self,
        shape: u32,
        across: f32,
        place: Vec2,
        low: f32,
        high: f32,
    ) -> Vec4 {
        if low <= -1.0 && high >= 1.0 {
            return self.streak_lookup_sum(shape, across, place, STREAK_SUMS);
        }
        self.streak_lookup_until(shape, across, place, high)
            - self.streak_lookup_until(shape, across, place, low)
    }

    /// The mean radiance of a whole drop.
    pub(super) fn streak_lookup_mean(&self, shape: u32, place: Vec2) -> Vec3 {
        self.streak_lookup_rays(shape, STREAK_ACROSS, place, 1).truncate()
    }
}
