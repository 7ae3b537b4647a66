//! Directions of light, and the frame of a streak.
//!
//! The committed directions stand on rings about the line of sight, so that a ring is one scattering angle: 0 is light
//! from behind the drop, 180 degrees light from the viewer. What a sphere scatters depends on that angle alone.

use downpour_math::ops::f64 as ops;

/// Scattering angle in degrees of each ring, and its directions from below to above, both on the plane of symmetry.
const RINGS: [(f64, u32); 9] =
    [(0.0, 1), (20.0, 4), (40.0, 5), (60.0, 6), (80.0, 7), (105.0, 7), (130.0, 6), (155.0, 4), (180.0, 1)];

/// The directions towards the light of the committed atlas, in the frame of the streak, x >= 0.
#[must_use]
pub fn light_directions() -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for (degrees, count) in RINGS {
        let (away, along) = (ops::sin(degrees.to_radians()), ops::cos(degrees.to_radians()));
        for k in 0..count {
            // The ends are exactly on the plane x = 0.
            let end = k == 0 || k + 1 == count;
            let turn = if count == 1 { 0.0 } else { f64::from(k) / f64::from(count - 1) - 0.5 };
            let (up, right) = match (count, end) {
                (1, _) => (0.0, 0.0),
                (_, true) => (2.0 * turn, 0.0),
                _ => (ops::sin(turn * std::f64::consts::PI), ops::cos(turn * std::f64::consts::PI)),
            };
            all.push([away * right, away * up, -along]);
        }
    }
    all
}

/// Right, up and towards the viewer of the streak of a drop with the axis +Y, seen from `elevation` radians above its
/// horizontal plane.
#[must_use]
pub fn streak_frame(elevation: f64) -> [[f64; 3]; 3] {
    let (sine, cosine) = (ops::sin(elevation), ops::cos(elevation));
    [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]]
}
