//! Resolution that keeps the window fluid while something moves, and that grows at rest.

use super::machine::KEPT_FRAMES;

/// Fractions of the size of the window at which pictures are drawn.
pub const SCALES: [f64; 8] = [1.0, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.125, 0.0625];

/// Time in which pictures are to come while something moves, ms.
const TARGET_MS: f64 = 1000.0 / 30.0;

/// Time that the scene of a larger picture may take, ms.
const MAX_PLATE_MS: f64 = 700.0;

/// Pictures in a row that must have time left before the next larger scale is tried.
const PATIENCE: u32 = 6;

/// Time that a picture at rest may take, ms: the next change waits for it.
const REFINED_MS: f64 = 1500.0;

/// Part of the rest so far that a picture may take beyond that: who has looked for a minute waits for a few seconds.
const REFINED_PART: f64 = 0.25;

/// What is known of pictures while nothing changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Scale of the newest picture.
    pub scale: f64,
    /// Pictures that were drawn at this scale only to refine it.
    pub repeats: u32,
    /// Time of that picture without that of the scene without rain, ms.
    pub rain_ms: f64,
    /// Time of the scene without rain at the size of the window, ms.
    pub plate_ms: f64,
}

impl Rest {
    /// The picture that is drawn next: a larger one if there is time for it, else one of more rays, until it has all that are kept.
    /// `None`: none for now. `rest_s`: time without a change, s.
    #[must_use]
    pub fn next(&self, rest_s: f64) -> Option<Self> {
        let larger = SCALES.iter().rev().find(|&&scale| scale > self.scale * 1.01);
        let time_ms = |scale: f64| {
            let ratio = scale / self.scale;
            self.rain_ms * ratio * ratio + self.plate_ms * scale * scale
        };
        let most_ms = REFINED_MS.max(rest_s * 1.0e3 * REFINED_PART);
        match larger {
            Some(&scale) if time_ms(scale) < most_ms => Some(Self { scale, repeats: 0, ..*self }),
            _ if self.repeats < KEPT_FRAMES => Some(Self { repeats: self.repeats + 1, ..*self }),
            _ => None,
        }
    }
}

/// Choice of a scale by the time that pictures took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    index: usize,
    /// Time of a picture, ms.
    target_ms: f64,
    /// Pictures in a row that had time left.
    early: u32,
}

impl Default for Pace {
    fn default() -> Self {
        Self::new(TARGET_MS)
    }
}

impl Pace {
    /// A pace that begins at a quarter of the size.
    #[must_use]
    pub fn new(target_ms: f64) -> Self {
        Self { index: 4, target_ms, early: 0 }
    }

    /// Fraction of the size of the window.
    #[must_use]
    pub fn scale(&self) -> f64 {
        SCALES.get(self.index).copied().unwrap_or(1.0)
    }

    /// Takes note of the time of a picture that was drawn at this scale, ms. `plate_ms` is the time of its scene without rain, which
    /// later pictures keep if nothing moves: a larger one is not begun where it would take more than a good half second.
    pub fn note(&mut self, frame_ms: f64, plate_ms: f64) {
        // Time goes as the number of pixels at best, and a part of it does not shrink: one step down at a time, two if far off.
        if frame_ms > self.target_ms * 1.15 {
            self.early = 0;
            let steps = if frame_ms > self.target_ms * 3.0 { 2 } else { 1 };
            self.index = (self.index + steps).min(SCALES.len() - 1);
            return;
        }
        let Some(&larger) = self.index.checked_sub(1).and_then(|index| SCALES.get(index)) else { return };
        let ratio = larger / self.scale();
        let pixels = ratio * ratio;
        self.early = if frame_ms * pixels < self.target_ms && plate_ms * pixels < MAX_PLATE_MS {
            self.early + 1
        } else {
            0
        };
        if self.early >= PATIENCE {
            self.early = 0;
            self.index -= 1;
        }
    }

    /// Size of a picture in a window of some pixels, at least 16 x 16 where the window has them.
    #[must_use]
    pub fn size(&self, window: [u32; 2], scale: f64) -> [u32; 2] {
        window.map(|edge| ((f64::from(edge) * scale).round() as u32).clamp(edge.min(16), edge.max(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device whose time is a fixed part and one for each pixel settles where it holds the target.
    #[test]
    fn the_scale_settles_where_the_target_is_held() {
        // Of the second, 0.375 would take 31 ms; by the number of pixels alone it looks like 35.
        for (fixed_ms, full_ms, expected) in
            [(1.0, 10.0, 1.0), (3.0, 200.0, 0.25), (5.0, 2000.0, 0.125), (500.0, 10.0, 0.0625)]
        {
            let mut pace = Pace::default();
            for _ in 0..200 {
                pace.note(fixed_ms + full_ms * pace.scale() * pace.scale(), 0.0);
            }
            assert_eq!(pace.scale(), expected, "{fixed_ms} + {full_ms}");
        }
    }

    /// Rain alone is fast before a scene that is slow: the scale does not rise to where the scene takes seconds.
    #[test]
    fn a_slow_scene_bounds_the_scale() {
        let mut pace = Pace::default();
        for _ in 0..200 {
            pace.note(5.0, 4000.0 * pace.scale() * pace.scale());
        }
        assert_eq!(pace.scale(), 0.375);
    }

    /// At rest a picture grows to the size of the window on any device, the slower the later, and no change waits for longer than a
    /// quarter of the rest before it.
    #[test]
    fn a_picture_at_rest_grows_to_the_whole_window() {
        for (rain_ms, plate_ms, at_least_s, at_most_s) in
            [(5.0, 20.0, 0.0, 0.2), (2500.0, 12_000.0, 45.0, 90.0)]
        {
            let mut rest = Rest { scale: 0.25, repeats: 0, rain_ms: rain_ms / 16.0, plate_ms };
            let mut time_s = 0.0;
            while rest.scale < 1.0 {
                let Some(next) = rest.next(time_s) else {
                    time_s += 0.25;
                    assert!(time_s < 200.0, "{rest:?}");
                    continue;
                };
                let rain_ms = rain_ms * next.scale * next.scale;
                let taken_s = (rain_ms + plate_ms * next.scale * next.scale) * 1.0e-3;
                assert!(next.scale == rest.scale || taken_s <= 1.5_f64.max(0.25 * time_s));
                time_s += taken_s;
                rest = Rest { rain_ms, ..next };
            }
            assert!((at_least_s..at_most_s).contains(&time_s), "{time_s}");
            // Then it is refined, and then that is all.
            let all = (0..10).map_while(|_| rest.next(time_s).inspect(|next| rest = *next)).count();
            assert_eq!(all, KEPT_FRAMES as usize);
        }
    }

    #[test]
    fn a_slow_picture_among_fast_ones_does_not_swing() {
        let mut pace = Pace::default();
        for i in 0..100 {
            pace.note(if i == 50 { 45.0 } else { 20.0 }, 0.0);
        }
        assert_eq!(pace.scale(), 0.1875, "20 ms leave no room for the next larger scale");
        assert_eq!(pace.size([960, 540], 0.25), [240, 135]);
        assert_eq!(pace.size([10, 1], 0.25), [10, 1]);
    }
}
