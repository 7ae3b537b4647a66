//! Time of the window: play, pause, step, range, loop.

/// The clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Clock {
    /// Time that is shown, s.
    pub time_s: f64,
    /// True while it goes on.
    pub is_playing: bool,
    /// Seconds per second.
    pub speed: f64,
    /// Range that is played, s.
    pub range_s: [f64; 2],
    /// True if it begins anew at the end of the range.
    pub loops: bool,
}

/// Time of a frame of 24 a second, s.
pub(super) const FRAME_S: f64 = 1.0 / 24.0;

impl Default for Clock {
    fn default() -> Self {
        Self { time_s: 0.0, is_playing: false, speed: 1.0, range_s: [0.0, 10.0], loops: true }
    }
}

impl Clock {
    /// Lets some seconds of the wall clock pass.
    pub fn advance(&mut self, dt_s: f64) {
        if !self.is_playing {
            return;
        }
        let [begin, end] = self.range_s;
        let next = self.time_s + dt_s.clamp(0.0, 0.25) * self.speed;
        if next <= end {
            self.time_s = next;
        } else if self.loops && end > begin {
            self.time_s = begin + (next - begin) % (end - begin);
        } else {
            self.time_s = end;
            self.is_playing = false;
        }
    }

    /// Steps by some frames, and stops.
    pub fn step(&mut self, frames: f64) {
        self.is_playing = false;
        self.time_s = (((self.time_s / FRAME_S).round() + frames) * FRAME_S).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_stays_in_its_range() {
        let mut clock = Clock { is_playing: true, range_s: [2.0, 4.0], time_s: 3.9, ..Clock::default() };
        clock.advance(0.2);
        assert!((clock.time_s - 2.1).abs() < 1.0e-9);
        clock.loops = false;
        clock.time_s = 3.9;
        clock.advance(0.2);
        assert_eq!((clock.time_s, clock.is_playing), (4.0, false));
        clock.step(-1.0);
        assert!((clock.time_s - 95.0 / 24.0).abs() < 1.0e-9);
    }
}
