//! Spans of time whose impacts are kept, for the splashes of pictures.
//!
//! The impacts of a span have one origin, and their times count from its beginning. Steps of 1/60 s and more have spans of their own;
//! shorter ones share one as long as the origin stays. There are enough for the longest splash unless the origin moves in steps shorter
//! than that: then the oldest are given up early.

use downpour_shaders::sim::step::STEP_SPANS;
use glam::DVec3;

/// Number of spans that are kept.
pub(crate) const SPANS: usize = STEP_SPANS as usize;

/// Longest span of several steps, s.
const SPAN_S: f64 = 1.0 / 60.0 + 1.0e-9;

/// A span.
#[derive(Clone, Copy, Debug)]
struct Span {
    /// Of its positions, m.
    origin: DVec3,
    /// Time from its beginning to the state, s.
    ago_s: f64,
}

/// The span of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpanOfStep {
    pub(crate) number: u32,
    /// Time from its beginning to that of the step, s.
    pub(crate) since_s: f64,
    /// True if the step is its first: what was kept under its number is out of date.
    pub(crate) is_new: bool,
}

/// The last spans before a state.
#[derive(Clone, Debug, Default)]
pub(crate) struct RecentSpans {
    spans: [Option<Span>; SPANS],
    current: usize,
}

impl RecentSpans {
    /// Goes on by a step.
    pub(crate) fn step(&mut self, origin: DVec3, time_s: f64) -> SpanOfStep {
        for span in self.spans.iter_mut().flatten() {
            span.ago_s += time_s;
        }
        let last = self.spans[self.current];
        let same = last.filter(|span| span.origin == origin && span.ago_s <= SPAN_S);
        if same.is_none() {
            self.current = (self.current + 1) % SPANS;
            self.spans[self.current] = Some(Span { origin, ago_s: time_s });
        }
        let since_s = same.map_or(0.0, |span| span.ago_s - time_s);
        SpanOfStep { number: self.current as u32, since_s, is_new: same.is_none() }
    }

    /// The spans in a picture some time after the state, s: origin relative to the eye, m, and time from the beginning to the picture, s.
    pub(crate) fn before(&self, after_s: f64, eye: DVec3) -> [[f32; 4]; SPANS] {
        let of_picture = |span: Option<Span>| {
            let of = |span: Span| (span.origin - eye).as_vec3().extend((span.ago_s + after_s) as f32);
            span.map_or([0.0; 4], |span| of(span).to_array())
        };
        self.spans.map(of_picture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_shaders::sim::splash::SPLASH_MAX_S;

    /// Whatever the steps, spans reach back as far as the longest splash.
    #[test]
    fn spans_reach_back_far_enough() {
        for time_s in [1.0e-4, 1.0 / 240.0, 1.0 / 119.0, 1.0 / 61.0, 1.0 / 60.0, 1.0 / 59.0, 1.0 / 30.0] {
            let mut recent = RecentSpans::default();
            let (mut begun, mut now_s) = ([0.0; SPANS], 0.0);
            while now_s < 1.0 {
                let span = recent.step(DVec3::ZERO, time_s);
                if span.is_new {
                    begun[span.number as usize] = now_s;
                }
                assert!((begun[span.number as usize] + span.since_s - now_s).abs() < 1.0e-9);
                now_s += time_s;
            }
            let oldest = begun.iter().fold(f64::INFINITY, |a, &b| a.min(b));
            assert!(now_s - oldest > f64::from(SPLASH_MAX_S), "{time_s}: {}", now_s - oldest);
            let before = recent.before(0.25, DVec3::X);
            for ([x, _, _, ago], begun) in before.iter().zip(begun) {
                assert!((f64::from(*ago) - 0.25 - now_s + begun).abs() < 1.0e-6 && *x == -1.0);
            }
        }
    }

    /// Positions of one span have one origin.
    #[test]
    fn another_origin_begins_a_span() {
        let mut recent = RecentSpans::default();
        let step = |recent: &mut RecentSpans, x: f64| recent.step(DVec3::X * x, 0.004);
        let first = step(&mut recent, 0.0);
        assert_eq!(step(&mut recent, 0.0), SpanOfStep { since_s: 0.004, is_new: false, ..first });
        let other = step(&mut recent, 1.0);
        assert!(other.is_new && other.number != first.number && other.since_s == 0.0);
    }
}
