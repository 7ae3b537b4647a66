//! The part of a streak's path on which its profile stands. Twin of `shaders/wgsl/render/streak_span.wgsl`, where the method is
//! described.

use downpour_shaders::render::rain::{STREAK_SPAN_MAX, STREAK_SPAN_ROOM};
use glam::Vec2;

use super::streak::{ScreenDrop, streak_time};

/// Path of a streak's profile, and how rays go through its drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreakSpan {
    /// Fractions of the path by which it is longer at either end.
    pub before: f32,
    /// See `before`.
    pub after: f32,
    /// Times of its ends: at most 0, and 1 or more.
    pub first: f32,
    /// See `first`.
    pub last: f32,
    /// 1: the rays of a chord are those of one pixel, which are parallel; 0: those of one instant.
    pub parallel: f32,
    /// Growth of a ray's distance from the path per equivalent radius that the drop has ahead of the ray.
    pub funnel: f32,
}

/// The span of a streak.
#[must_use]
pub fn streak_span(drop: &ScreenDrop) -> StreakSpan {
    let ratio = drop.depth_ratio.max(1.0e-6);
    let along = Vec2::from(drop.along);
    let moves = along.dot(along).sqrt().max(1.0e-20);
    // An equivalent radius when the exposure begins.
    let radius = drop.slope * (1.0 + ratio) * 0.5 / moves;
    let wanted = (drop.half_extent * radius).max(1.0e-6);
    let [before, after] = [wanted, wanted / ratio];
    let least = (STREAK_SPAN_ROOM * ratio / (1.0 - ratio).max(1.0e-6)).min(STREAK_SPAN_MAX);
    let most = (STREAK_SPAN_ROOM / (ratio - 1.0).max(1.0e-6)).min(STREAK_SPAN_MAX);
    let parallel = (least / before).min(most / after).min(1.0);
    let [before, after] = [before * parallel, after * parallel];
    StreakSpan {
        before,
        after,
        first: streak_time(ratio, -before),
        last: streak_time(ratio, 1.0 + after),
        parallel,
        funnel: parallel * radius * (1.0 - ratio) / ratio,
    }
}

/// Time of a row of a profile, by the fraction of the rows before it.
#[must_use]
pub fn streak_span_time(span: &StreakSpan, row: f32) -> f32 {
    span.first + (span.last - span.first) * row
}
