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

/// Sizes and times of pictures while nothing changes.
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

/// Part of the target below which a larger scale is tried although it would be too slow if time went as the number of pixels.
const HOPE: f64 = 0.75;

/// Pictures before a scale that was too slow is tried in hope again; twice as many after each failure, [`MAX_FAILURES`] times at most.
const RETRY: u32 = 300;
const MAX_FAILURES: u32 = 6;

/// Choice of a scale by the time that pictures took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    index: usize,
    /// Time of a picture, ms.
    target_ms: f64,
    /// Pictures in a row that had time left.
    early: u32,
    /// True if the last picture was too slow.
    is_late: bool,
    /// For each scale how often it was too slow, and the pictures before it is tried in hope.
    failed: [(u32, u32); SCALES.len()],
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
        Self { index: 4, target_ms, early: 0, is_late: false, failed: [(0, 0); SCALES.len()] }
    }

    /// Fraction of the size of the window.
    #[must_use]
    pub fn scale(&self) -> f64 {
        SCALES.get(self.index).copied().unwrap_or(1.0)
    }

    /// Takes note of the time of a picture that was drawn at this scale, ms. `plate_ms` is the time of its scene without rain, which
    /// later pictures keep if nothing moves: a larger one is not begun where it would take more than a good half second.
    pub fn note(&mut self, frame_ms: f64, plate_ms: f64) {
        for (_, wait) in &mut self.failed {
            *wait = wait.saturating_sub(1);
        }
        if frame_ms > self.target_ms * 1.15 {
            self.slow_down(frame_ms);
            return;
        }
        self.is_late = false;
        let Some(larger) = self.index.checked_sub(1) else { return };
        let (Some(&scale), Some(&(_, wait))) = (SCALES.get(larger), self.failed.get(larger)) else { return };
        let ratio = scale / self.scale();
        let pixels = ratio * ratio;
        // Time goes as the number of pixels at most: a part of it may be the same at any scale, and how large it is only a trial tells.
        let fits = frame_ms * pixels < self.target_ms;
        let may_fit = frame_ms < self.target_ms * HOPE && wait == 0;
        let is_early = (fits || may_fit) && plate_ms * pixels < MAX_PLATE_MS;
        self.early = if is_early { self.early + 1 } else { 0 };
        if self.early >= if fits { PATIENCE } else { 4 * PATIENCE } {
            self.early = 0;
            self.index = larger;
        }
    }

    /// One step down after two slow pictures in a row, two at once if they are far off.
    fn slow_down(&mut self, frame_ms: f64) {
        self.early = 0;
        let steps = match (frame_ms > self.target_ms * 3.0, self.is_late) {
            (true, _) => 2,
            (false, true) => 1,
            (false, false) => {
                self.is_late = true;
                return;
            }
        };
        self.is_late = false;
        if let Some((failures, wait)) = self.failed.get_mut(self.index) {
            *wait = RETRY << *failures;
            *failures = (*failures + 1).min(MAX_FAILURES);
        }
        self.index = (self.index + steps).min(SCALES.len() - 1);
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

    /// A device whose time is a fixed part and one for each pixel settles at the largest scale that holds the target.
    #[test]
    fn the_scale_settles_where_the_target_is_held() {
        for (fixed_ms, full_ms, expected) in [
            (1.0, 10.0, 1.0),
            // The next would take 53 ms.
            (3.0, 200.0, 0.375),
            // It takes 36 ms, which is near enough.
            (5.0, 2000.0, 0.125),
            // By the number of pixels alone, 0.25 has no room: the fixed part is most of its 20 ms.
            (16.0, 60.0, 0.5),
            (500.0, 10.0, 0.0625),
        ] {
            let mut pace = Pace::default();
            let mut at = [0; SCALES.len()];
            for picture in 0..3000 {
                pace.note(fixed_ms + full_ms * pace.scale() * pace.scale(), 0.0);
                at[pace.index] += i32::from(picture >= 200);
            }
            let most = (0..at.len()).max_by_key(|&index| at[index]).unwrap();
            assert_eq!(SCALES[most], expected, "{fixed_ms} + {full_ms}");
            // What was too slow is tried ever more seldom.
            assert!(at[most] > 2780, "{at:?}");
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
            pace.note(if i == 50 { 45.0 } else { 25.0 }, 0.0);
        }
        assert_eq!(pace.scale(), 0.25, "25 ms leave no room for the next larger scale");
        assert_eq!(pace.size([960, 540], 0.25), [240, 135]);
        assert_eq!(pace.size([10, 1], 0.25), [10, 1]);
    }
}
