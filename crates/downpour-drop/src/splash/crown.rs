//! Shape of the crown of a splash, as a closed mesh at any stage.
//!
//! Lengths are in the crown's largest radius, +Y is up, the surface that was hit is at 0. `stage` is the time since the impact over
//! the crown's duration, 0 to 1.
//!
//! The wall is a sheet that leans outward, thinner toward its rim; fingers rise from the rim, and droplets leave the tips of some.
//! Radius and height rise as the square root and the parabola of the time, until [`RISE_SHARE`]; then the wall falls back, the
//! fingers after it, and the droplets fly on.

use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::sim::splash::{SPLASH_FINGERS, SPLASH_WALL};
use std::f64::consts::{PI, TAU};

use super::RISE_SHARE;

/// Fingers of the rim: the waves of a rim of its thickness are that many.
const FINGERS: u32 = 13;

/// Steps around the wall.
const AROUND: u32 = 130;

/// Points of the outline of the wall's section.
const SECTION: u32 = 18;

/// Heights of the wall and of the fingers above it, at most.
const HEIGHTS: [f64; 2] = [SPLASH_WALL as f64, SPLASH_FINGERS as f64];

/// Depth to which the wall reaches below the surface.
const ROOT: f64 = 0.03;

/// A closed mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CrownMesh {
    /// Vertices, in largest radii of the crown.
    pub positions: Vec<[f32; 3]>,
    /// Vertices of the triangles, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Sizes of the crown at a stage.
#[derive(Clone, Copy, Debug)]
struct Wall {
    /// Radius of its foot.
    foot: f64,
    height: f64,
    /// Height of the fingers above the wall.
    fingers: f64,
    /// Distance that the rim leans outward per height.
    lean: f64,
    /// Half the thickness of its foot and of its rim.
    thickness: [f64; 2],
}

/// Half the height of the crown at a stage: the middle of pictures of it.
#[must_use]
pub fn middle(stage: f64) -> f64 {
    let wall = Wall::at(stage);
    0.5 * (wall.height + wall.fingers)
}

impl Wall {
    fn at(stage: f64) -> Self {
        let rise = (stage / RISE_SHARE).clamp(0.0, 1.0);
        let fall = ((stage - RISE_SHARE) / (1.0 - RISE_SHARE)).clamp(0.0, 1.0);
        let left = 1.0 - fall;
        let up = rise * (2.0 - rise);
        // It starts with the drop itself, and ends as a ring on the surface.
        Self {
            foot: 0.18 + 0.6 * rise.sqrt() + 0.1 * fall,
            height: 0.05 + (HEIGHTS[0] - 0.05) * up * left * left.sqrt() - 0.045 * fall,
            fingers: 0.01 + (HEIGHTS[1] - 0.01) * up * (1.0 - fall * fall) - 0.008 * fall,
            lean: 0.3 + 0.25 * fall,
            thickness: [0.035 - 0.028 * fall, 0.014 - 0.006 * fall],
        }
    }
}

/// A finger of the rim: its angle, its share of the height of the tallest, and its width as an angle.
fn finger(k: u32) -> [f64; 3] {
    let [turn, height, width, _] = rng_draw([0x5914, 0], k, 0, 0).map(|word| f64::from(rng_unit(word)));
    let angle = TAU * (f64::from(k) + 0.55 * (turn - 0.5)) / f64::from(FINGERS);
    [angle, 0.45 + 0.55 * height, 0.055 + 0.035 * width]
}

/// Height of the fingers at an angle, as a share of the tallest.
fn fingers(angle: f64) -> f64 {
    let of = |k| {
        let [at, height, width] = finger(k);
        let turns = (angle - at) / TAU;
        let off = TAU * (turns - (turns + 0.5).floor());
        height * ops::exp(-(off * off) / (width * width))
    };
    (0..FINGERS).map(of).fold(0.0, f64::max)
}

/// The crown at a stage.
#[must_use]
pub fn mesh(stage: f64) -> CrownMesh {
    let mut mesh = CrownMesh::default();
    mesh.add_wall(&Wall::at(stage));
    for k in (0..FINGERS).filter(|k| k % 2 == 0) {
        if let Some((center, radius)) = droplet(k, stage) {
            mesh.add_ball(center, radius);
        }
    }
    mesh
}

/// Center and radius of the droplet of a finger at a stage, once it has left and while it is above the surface.
fn droplet(k: u32, stage: f64) -> Option<([f64; 3], f64)> {
    let [out, up, size, when] = rng_draw([0x5914, 1], k, 0, 0).map(|word| f64::from(rng_unit(word)));
    let leaves = RISE_SHARE * (0.8 + 0.4 * when);
    let since = stage - leaves;
    if since <= 0.0 {
        return None;
    }
    let [angle, tall, _] = finger(k);
    let wall = Wall::at(leaves);
    let begin = wall.height + wall.fingers * tall;
    // Gravity over a duration of 35 ms is 0.4 of the radius.
    let height = begin + (0.25 + 0.35 * up) * since - 0.4 * since * since;
    let away = wall.foot + wall.lean * begin + (0.1 + 0.35 * out) * since;
    let radius = 0.022 + 0.02 * size;
    (height > radius).then(|| ([away * ops::cos(angle), height, away * ops::sin(angle)], radius))
}

impl CrownMesh {
    /// Adds the wall with its fingers: an outline of its section that goes around.
    fn add_wall(&mut self, wall: &Wall) {
        let first = self.positions.len() as u32;
        for i in 0..AROUND {
            let angle = TAU * f64::from(i) / f64::from(AROUND);
            let finger = fingers(angle);
            let tall = wall.height * (1.0 + 0.12 * ops::sin(3.0 * angle + 1.0)) + wall.fingers * finger;
            let round = 1.0 + 0.03 * ops::sin(2.0 * angle + 0.7) + 0.025 * ops::sin(5.0 * angle);
            let (sine, cosine) = (ops::sin(angle), ops::cos(angle));
            for j in 0..SECTION {
                let part = f64::from(j) / f64::from(SECTION);
                let [out, up] = wall.section(tall, 1.0 + 0.9 * finger, part).map(|x| x * round);
                self.positions.push([out * cosine, up, out * sine].map(|x| x as f32));
            }
        }
        for i in 0..AROUND {
            for j in 0..SECTION {
                let at = |i: u32, j: u32| first + (i % AROUND) * SECTION + j % SECTION;
                let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                self.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    /// Adds a sphere.
    fn add_ball(&mut self, center: [f64; 3], radius: f64) {
        const RINGS: u32 = 8;
        const SIDES: u32 = 12;
        let first = self.positions.len() as u32;
        for i in 0..=RINGS {
            let down = PI * f64::from(i) / f64::from(RINGS);
            for j in 0..SIDES {
                let angle = TAU * f64::from(j) / f64::from(SIDES);
                // Poles are one position.
                let wide = if i % RINGS == 0 { 0.0 } else { radius * ops::sin(down) };
                let offset = [wide * ops::cos(angle), radius * ops::cos(down), wide * ops::sin(angle)];
                self.positions.push(std::array::from_fn(|k| (center[k] + offset[k]) as f32));
            }
        }
        for i in 0..RINGS {
            for j in 0..SIDES {
                let at = |i: u32, j: u32| first + i * SIDES + j % SIDES;
                let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                self.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
}

impl Wall {
    /// A point of the outline of the section where the wall is so tall and so many times as thick: its distance from the axis, and
    /// up. The way goes up the outside, over the rim, down the inside and back through the surface; `part` is the fraction of it,
    /// 0 to 1.
    fn section(&self, tall: f64, thicker: f64, part: f64) -> [f64; 2] {
        // The outside has nine twentieths of the way, the rim two, the inside nine.
        let (share, side) = match part {
            p if p < 0.45 => (p / 0.45, 1.0),
            p if p < 0.55 => (1.0, 1.0 - (p - 0.45) / 0.05),
            p => ((1.0 - p) / 0.45, -1.0),
        };
        let up = share * (tall + ROOT) - ROOT;
        let [thick, thin] = self.thickness;
        // The rim is a bead.
        let bead = 1.0 + ((share - 0.8) / 0.2).max(0.0);
        let thin = thin * thicker * bead;
        let half = (thick + (thin - thick) * share) * side;
        let rim = if side.abs() < 1.0 { (1.0 - side * side).sqrt() * thin } else { 0.0 };
        let out = self.foot + self.lean * up.max(0.0) + half;
        [out.max(0.01), up + rim]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mesh_stays_within_its_bounds() {
        for k in 0..=20 {
            let stage = f64::from(k) / 20.0;
            let mesh = mesh(stage);
            let (mut far, mut high, mut low) = (0.0f32, 0.0f32, 0.0f32);
            for [x, y, z] in &mesh.positions {
                far = far.max((x * x + z * z).sqrt());
                (high, low) = (high.max(*y), low.min(*y));
            }
            assert!(far < 1.6 && high < 1.1 && low >= -0.05, "{stage}: {far} {high} {low}");
            assert!((0.003..0.5).contains(&middle(stage)), "{stage}");
        }
    }

    #[test]
    fn the_crown_rises_and_falls_back() {
        let top = |stage| 2.0 * middle(stage);
        assert!(top(0.0) < 0.1 && top(1.0) < 0.02);
        assert!(top(RISE_SHARE) > 0.7);
        assert!(top(0.05) < top(RISE_SHARE) && top(0.5) < top(RISE_SHARE) && top(0.8) < top(0.5));
    }
}
