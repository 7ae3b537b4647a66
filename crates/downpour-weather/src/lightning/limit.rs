//! Limit of flashes for viewers who are sensitive to them.
//!
//! WCAG 2.2, success criterion 2.3.1: not more than three general flashes within any one second. Each stroke is a rise and a fall of
//! the light, so a second has [`MAX_PER_SECOND`] strokes at most. Strokes that would be one too many are left out, in order of
//! time. Lightning from a seed has no first stroke to begin with: it is limited by [`SPAN_S`] of time, each by itself, with a dark
//! second at its end if there are too many flashes about it.

use super::StrokeOf;
use super::storm::{MAX_FLASH_S, Storm};

/// Strokes within any one second.
pub(super) const MAX_PER_SECOND: usize = 3;

/// The time in which they are counted, s: a little more, so that a frame's exposure does not bring a fourth one into a second.
pub(super) const SECOND_S: f64 = 1.05;

/// Lightning from a seed is limited in spans of this time, s.
const SPAN_S: f64 = 60.0;

/// True if a stroke at a time would be one too many among others; `times` are those within a second of it at least.
fn is_too_many(times: impl Iterator<Item = f64>, time_s: f64) -> bool {
    let mut near: Vec<f64> = times.filter(|other| (other - time_s).abs() < SECOND_S).collect();
    near.push(time_s);
    near.sort_by(f64::total_cmp);
    near.windows(MAX_PER_SECOND.saturating_add(1))
        .any(|run| run.last().zip(run.first()).is_some_and(|(last, first)| last - first < SECOND_S))
}

/// The strokes, in order of time, that are not too many.
pub(super) fn limited(strokes: Vec<StrokeOf>) -> Vec<StrokeOf> {
    let mut kept: Vec<StrokeOf> = Vec::new();
    for stroke in strokes {
        let time_s = stroke.pulse.begin_s;
        let before = kept.iter().rev().take(MAX_PER_SECOND).map(|other| other.pulse.begin_s);
        if !is_too_many(before, time_s) {
            kept.push(stroke);
        }
    }
    kept
}

/// Strokes of a storm that are kept, of flashes that begin from `from_s` to before `to_s`, beside those that were given by hand, which
/// are in order of time.
pub(super) fn limited_storm(storm: &Storm, hand: &[StrokeOf], from_s: f64, to_s: f64) -> Vec<StrokeOf> {
    let mut kept = Vec::new();
    let mut span = (from_s / SPAN_S).floor();
    while span * SPAN_S < to_s {
        kept.extend(limited_span(storm, hand, span * SPAN_S));
        span += 1.0;
    }
    kept
}

/// Strokes of a storm that are kept, of the flashes that begin in the span at a time.
fn limited_span(storm: &Storm, hand: &[StrokeOf], begin_s: f64) -> Vec<StrokeOf> {
    let end_s = begin_s + SPAN_S;
    // What the span before has left behind its end.
    let mut taken: Vec<f64> = Vec::new();
    if !is_crowded(storm, hand, begin_s) {
        taken = strokes(storm, begin_s - MAX_FLASH_S, begin_s).map(|of| of.pulse.begin_s).collect();
        taken.sort_by(f64::total_cmp);
    }
    let crowded = is_crowded(storm, hand, end_s);
    let mut candidates: Vec<StrokeOf> = strokes(storm, begin_s, end_s).collect();
    candidates.sort_by(|a, b| a.pulse.begin_s.total_cmp(&b.pulse.begin_s));
    let mut kept = Vec::new();
    for stroke in candidates {
        let time_s = stroke.pulse.begin_s;
        if crowded && time_s > end_s - SECOND_S {
            continue;
        }
        let near = near(hand, time_s).iter().map(|other| other.pulse.begin_s);
        let before = taken.iter().rev().take_while(|other| time_s - **other < SECOND_S).copied();
        if !is_too_many(near.chain(before), time_s) {
            taken.push(time_s);
            kept.push(stroke);
        }
    }
    kept
}

/// True if there are too many strokes about the border of two spans to keep them all.
fn is_crowded(storm: &Storm, hand: &[StrokeOf], border_s: f64) -> bool {
    let (from_s, to_s) = (border_s - SECOND_S, border_s + SECOND_S);
    let drawn = strokes(storm, from_s - MAX_FLASH_S, to_s);
    let inside = |of: &StrokeOf| (from_s..=to_s).contains(&of.pulse.begin_s);
    let by_hand = near(hand, border_s).iter().filter(|of| inside(of)).count();
    drawn.filter(inside).count().saturating_add(by_hand) > MAX_PER_SECOND
}

/// Strokes within a second of a time, of strokes in order of time.
fn near(strokes: &[StrokeOf], time_s: f64) -> &[StrokeOf] {
    let first = strokes.partition_point(|of| of.pulse.begin_s < time_s - SECOND_S);
    let last = strokes.partition_point(|of| of.pulse.begin_s <= time_s + SECOND_S);
    strokes.get(first..last).unwrap_or_default()
}

/// All strokes of the flashes of a storm that begin from `from_s` to before `to_s`.
fn strokes(storm: &Storm, from_s: f64, to_s: f64) -> impl Iterator<Item = StrokeOf> {
    storm.between(from_s, to_s).into_iter().flat_map(|flash| flash.strokes_of().collect::<Vec<_>>())
}
