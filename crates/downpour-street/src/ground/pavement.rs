//! Gutters, curbs of stones with joints, and pavements of slabs.

use downpour_math::ops;
use glam::{Vec2, Vec3};

use super::covers::GULLY_REACH_M;
use super::{CURB_HEIGHT_M, CURB_M, GUTTER_LOW_M, GUTTER_M, Ground, LANE_M};
use crate::material::Material;
use crate::mesh::Mesh;
use crate::noise::{hash, mix, smooth, world};

/// A station of a curb line: position, direction to the houses, length so far, and the stone of the curb.
struct Station {
    at: Vec2,
    out: Vec2,
    length: f32,
    stone: i32,
    is_joint: bool,
}

/// Stations of a line, stone by stone.
#[derive(Default)]
struct Line {
    stations: Vec<Station>,
    length: f32,
    stone: i32,
}

impl Line {
    /// A stone from one point to another; directions to the houses at both.
    fn stone(&mut self, from: (Vec2, Vec2), to: (Vec2, Vec2)) {
        let long = (to.0 - from.0).length();
        self.stone += 1;
        let gap = 0.006 / long;
        for (t, is_joint) in [(0.0, true), (gap, false), (1.0 - gap, false)] {
            self.stations.push(Station {
                at: from.0.lerp(to.0, t),
                out: from.1.lerp(to.1, t).normalize_or_zero(),
                length: self.length + long * t,
                stone: self.stone,
                is_joint,
            });
        }
        self.length += long;
    }

    /// Stones of about a meter along a straight line.
    fn straight(&mut self, from: Vec2, to: Vec2, out: Vec2) {
        let count = ((to - from).length() / 1.0).round().max(1.0) as i32;
        for k in 0..count {
            let at = |k: i32| from.lerp(to, k as f32 / count as f32);
            self.stone((at(k), out), (at(k + 1), out));
        }
    }

    /// Stations at both ends of an opening of the gutter, of a line along z.
    fn cut(&mut self, opening: [f32; 2]) {
        for z in opening {
            let after = self.stations.windows(2).position(|pair| {
                let [from, to] = [pair[0].at.y, pair[1].at.y];
                pair.iter().all(|station| station.out == Vec2::X) && (from.min(to)..from.max(to)).contains(&z)
            });
            let Some(after) = after else { continue };
            let [from, to] = [&self.stations[after], &self.stations[after + 1]];
            let t = (z - from.at.y) / (to.at.y - from.at.y);
            let station = Station {
                at: from.at.lerp(to.at, t),
                out: from.out,
                length: mix(from.length, to.length, t),
                stone: from.stone,
                is_joint: false,
            };
            self.stations.insert(after + 1, station);
        }
    }

    /// Stones around a corner: a quarter of a circle between two directions to the houses.
    fn corner(&mut self, center: Vec2, radius: f32, from: Vec2, to: Vec2) {
        const STONES: i32 = 6;
        for k in 0..STONES {
            let at = |k: i32| {
                let angle = k as f32 / STONES as f32 * std::f32::consts::FRAC_PI_2;
                let out = from * ops::cos(angle) + to * ops::sin(angle);
                (center - out * radius, out)
            };
            self.stone(at(k), at(k + 1));
        }
    }
}

/// Points of the profile of gutter, curb and pavement.
#[derive(Clone, Copy)]
struct ProfilePoint {
    /// Distance from the face of the curb.
    distance: f32,
    /// Height as a fraction of the curb's.
    fraction: f32,
    /// Additional height.
    more: f32,
    /// Material up to the next point.
    material: Material,
    /// Material whose texture and tint it has: at the end of a material that of the one before.
    skin: Material,
}

fn profile(ground: &Ground) -> Vec<ProfilePoint> {
    let point = |distance: f32, fraction: f32, more: f32, material: Material| ProfilePoint {
        distance,
        fraction,
        more,
        material,
        skin: material,
    };
    let mut all = vec![
        point(-GUTTER_M, 0.0, ground.edge(), Material::Setts),
        point(-0.16, 0.0, 0.004, Material::Setts),
        point(-GUTTER_LOW_M, 0.0, 0.0, Material::Setts),
        point(0.0, 0.0, 0.003, Material::Curb),
        point(0.006, 0.80, 0.0, Material::Curb),
        point(0.013, 0.93, 0.0, Material::Curb),
        point(0.030, 1.0, 0.0, Material::Curb),
        point(CURB_M - 0.012, 1.0, 0.002, Material::Curb),
        point(CURB_M - 0.003, 1.0, -0.008, Material::Slabs),
        point(CURB_M + 0.004, 1.0, 0.0, Material::Slabs),
    ];
    let rest = ground.pavement + 0.05 - CURB_M;
    for k in 1..=6 {
        let d = rest * k as f32 / 6.0;
        all.push(point(CURB_M + d, 1.0, 0.02 * d, Material::Slabs));
    }
    // Where materials meet there are two points: each has coordinates in its own texture.
    let mut twice: Vec<ProfilePoint> = Vec::new();
    for next in all {
        if let Some(last) = twice.last().filter(|last| last.material != next.material) {
            twice.push(ProfilePoint { skin: last.skin, ..next });
        }
        twice.push(next);
    }
    twice
}

/// Draws the profile along stations; `mirror` is -1 for the other side of the street.
fn sweep(ground: &Ground, mesh: &mut Mesh, line: &Line, mirror: f32, side: u32) {
    let profile = profile(ground);
    let stations = &line.stations;
    let columns = profile.len() - 1;
    let random = |stone: i32, n: u32| hash(stone, side as i32, 241 + n + ground.seed);
    let openings = ground.openings(side);
    // Mirrored, the columns run the other way, so that the front stays above.
    let column = |i: usize| if mirror > 0.0 { i } else { columns - i };
    mesh.grid(
        [columns, stations.len() - 1],
        |i, j| {
            let ProfilePoint { distance, fraction, more, material, skin } = profile[column(i)];
            let station = &stations[j];
            let z = station.at.y;
            let open = ground.open(z);
            let wave =
                if distance < 0.01 { ground.gutter_wave(z, side) * (1.0 - fraction) * open } else { 0.0 };
            let is_curb = matches!(material, Material::Curb) && distance > -0.01;
            let lean = if is_curb { (random(station.stone, 0) - 0.5) * 0.009 } else { 0.0 };
            let joint = if is_curb && station.is_joint && fraction > 0.0 { 0.008 } else { 0.0 };
            let settled = if distance > CURB_M {
                (world(station.at.x * mirror, z, 2.4, 2, 244 + ground.seed) - 0.5) * 0.016 * ground.age
            } else {
                0.0
            };
            let flat = station.at + station.out * (distance + joint + lean * fraction);
            let y = fraction * CURB_HEIGHT_M + more + wave + (lean - joint) * fraction + settled;
            let p = Vec3::new(flat.x * mirror, y, flat.y);
            let (uv, tint) = match skin {
                Material::Curb => {
                    // From the foot of the face over the edge to the back.
                    let over = fraction * CURB_HEIGHT_M + distance.max(0.0);
                    let dirt = mix(0.55, 1.0, smooth(0.0, 0.8, fraction));
                    let tone = mix(0.78, 1.0, random(station.stone, 1));
                    let gap = if station.is_joint { 0.35 } else { 1.0 };
                    (Vec2::new(station.length + 0.37 * station.stone as f32, over), dirt * tone * gap)
                }
                Material::Setts => {
                    let dark = mix(0.62, 0.86, smooth(0.02, -0.25, distance));
                    (Vec2::new(station.length, distance) / Material::Setts.tile_m(), dark)
                }
                _ => {
                    let foot = mix(1.0, 0.70, smooth(ground.pavement - 0.5, ground.pavement, distance));
                    let edge = mix(0.75, 1.0, smooth(CURB_M, CURB_M + 0.15, distance));
                    let patchy = mix(0.80, 1.0, world(p.x, p.z, 2.6, 4, 242 + ground.seed));
                    (Vec2::new(distance, station.length) / Material::Slabs.tile_m(), foot * edge * patchy)
                }
            };
            (p, uv, Vec3::splat(tint.min(1.0)))
        },
        |i, j| {
            let (from, to) = (column(i).min(column(i + 1)), column(i).max(column(i + 1)));
            let distances = -GULLY_REACH_M[1]..=-GULLY_REACH_M[0];
            let is_low = [from, to].iter().all(|&k| distances.contains(&profile[k].distance));
            let z = mix(stations[j].at.y, stations[j + 1].at.y, 0.5);
            let is_open = |[low, high]: [f32; 2]| is_low && (low..high).contains(&z);
            (!openings.iter().copied().any(is_open)).then_some(profile[from].skin)
        },
    );
}

/// One side of the street, with its corners into the lanes.
pub(super) fn along(ground: &Ground, mesh: &mut Mesh, mirror: f32) {
    let radius = ground.corner();
    let (x, reach) = (ground.half_road, ground.reach() + 0.5);
    let (near, far) = (ground.pavement, -(ground.length + ground.pavement));
    let mut line = Line::default();
    let center = |z: f32| Vec2::new(x + radius, z);
    let (near_center, far_center) = (center(near - radius), center(far + radius));
    line.straight(Vec2::new(reach, near), Vec2::new(near_center.x, near), Vec2::NEG_Y);
    line.corner(near_center, radius, Vec2::NEG_Y, Vec2::X);
    line.straight(Vec2::new(x, near_center.y), Vec2::new(x, far_center.y), Vec2::X);
    line.corner(far_center, radius, Vec2::X, Vec2::Y);
    line.straight(Vec2::new(far_center.x, far), Vec2::new(reach, far), Vec2::Y);
    let side = u32::from(mirror > 0.0);
    for opening in ground.openings(side) {
        line.cut(opening);
    }
    sweep(ground, mesh, &line, mirror, side);
}

/// The far side of a lane.
pub(super) fn across(ground: &Ground, mesh: &mut Mesh, is_far: bool) {
    let reach = ground.reach() + 0.5;
    let mut line = Line::default();
    if is_far {
        let z = -(ground.length + ground.pavement + LANE_M);
        line.straight(Vec2::new(reach, z), Vec2::new(-reach, z), Vec2::NEG_Y);
    } else {
        let z = ground.pavement + LANE_M;
        line.straight(Vec2::new(-reach, z), Vec2::new(reach, z), Vec2::Y);
    }
    sweep(ground, mesh, &line, 1.0, 2 + u32::from(is_far));
}
