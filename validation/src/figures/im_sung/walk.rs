//! Camera motion.

/// The camera rests, then moves ahead, then turns about, then rests again. s.
const STANDS_S: f64 = 0.25;
const MOVES_S: f64 = 1.0;
const TURNS_S: f64 = 0.5;
const RESTS_S: f64 = 0.25;

/// Length of the movement along -Z, m.
pub(super) const PATH_M: f64 = 9.0;

/// Start position, m: in the middle of the street's right lane, at the height of a person's eyes.
pub(super) const BEGIN_M: [f64; 3] = [0.8, 1.6, 14.0];

/// Vertical field of view, degrees.
pub(super) const FOV_DEG: f64 = 18.0;

/// Near depth, m.
pub(super) const NEAR_M: f64 = 0.05;

/// An eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Eye {
    /// m.
    pub(super) position: [f64; 3],
    /// About +Y, radians: 0 looks along -Z, a quarter of a circle along -X.
    pub(super) yaw: f64,
}

/// Moments that are shown, with their times in s.
pub(super) const MOMENTS: [(&str, f64); 6] = [
    ("before", 0.0),
    ("middle of the path", STANDS_S + 0.5 * MOVES_S),
    ("end of the path", STANDS_S + MOVES_S),
    ("half turned", STANDS_S + MOVES_S + 0.5 * TURNS_S),
    ("turned about", STANDS_S + MOVES_S + TURNS_S),
    ("at rest again", STANDS_S + MOVES_S + TURNS_S + RESTS_S),
];

/// The eye at a time, s.
pub(super) fn eye(time_s: f64) -> Eye {
    let moved = ((time_s - STANDS_S) / MOVES_S).clamp(0.0, 1.0);
    let turned = ((time_s - STANDS_S - MOVES_S) / TURNS_S).clamp(0.0, 1.0);
    let [x, y, z] = BEGIN_M;
    Eye { position: [x, y, z - PATH_M * moved], yaw: std::f64::consts::PI * turned }
}

/// Frames of the path.
pub(super) fn frames(fps: u32) -> u32 {
    let duration = STANDS_S + MOVES_S + TURNS_S + RESTS_S;
    (duration * f64::from(fps)).ceil() as u32
}

/// The frame that is nearest to a moment.
pub(super) fn frame_at(time_s: f64, fps: u32) -> u32 {
    ((time_s * f64::from(fps)).round() as u32).min(frames(fps).saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_stands_moves_turns_and_stands() {
        assert_eq!(eye(0.0), Eye { position: BEGIN_M, yaw: 0.0 });
        let moving = eye(STANDS_S + 0.25 * MOVES_S);
        assert!((moving.position[2] - (BEGIN_M[2] - 0.25 * PATH_M)).abs() < 1.0e-12 && moving.yaw == 0.0);
        let last = eye(100.0);
        assert!((last.position[2] - (BEGIN_M[2] - PATH_M)).abs() < 1.0e-12);
        assert!((last.yaw - std::f64::consts::PI).abs() < 1.0e-12);
        // It turns about within a second.
        assert_eq!(eye(STANDS_S + MOVES_S).yaw, 0.0);
        assert!((eye(STANDS_S + MOVES_S + 0.999).yaw - std::f64::consts::PI).abs() < 1.0e-12);
    }

    #[test]
    fn every_moment_is_a_frame() {
        for fps in [6, 12, 24, 60] {
            for (name, time) in MOMENTS {
                let frame = frame_at(time, fps);
                assert!(frame < frames(fps), "{name}: {frame}");
                let late = (f64::from(frame) / f64::from(fps) - time).abs();
                assert!(late <= 1.001 / f64::from(fps), "{name}: {late}");
            }
        }
        assert_eq!(frames(12), 24);
    }
}
