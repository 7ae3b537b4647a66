//! Carriageway with crown and hollows, gutters, curbs and pavements: a street along -z that ends in a cross street.
//!
//! Heights are above the bottom of the gutters. The crown and the fall of the pavements are those of common practice: 2.5 %
//! and 2 %; curbs stand 12 cm high, 3 cm at the crossing.

use downpour_math::ops;
use glam::{Vec2, Vec3};

use super::material::Material;
use super::mesh::{Mesh, Paint, plain, tinted};
use super::noise::{hash, mix, smooth, world};

/// Half the width of the carriageway between curbs.
pub(super) const HALF_ROAD_M: f32 = 3.4;
/// Distance of the houses from the middle.
pub(super) const HALF_STREET_M: f32 = 6.0;
/// Start of the street, behind the eye.
pub(super) const START_M: f32 = 25.0;
/// The near curb of the cross street, and its far one.
pub(super) const CROSS_NEAR_M: f32 = -46.4;
pub(super) const CROSS_FAR_M: f32 = -53.0;
/// Length of the cross street to both sides.
pub(super) const CROSS_REACH_M: f32 = 27.0;
/// The zebra crossing: its middle and half its depth.
pub(super) const ZEBRA_M: [f32; 2] = [-13.8, 1.6];

/// Width of the gutters of setts.
const GUTTER_M: f32 = 0.3;
/// Half the width of the asphalt.
const HALF_ASPHALT_M: f32 = HALF_ROAD_M - GUTTER_M;
/// Radius of the curbs at the corners.
const CORNER_M: f32 = 3.0;
/// Height of the middle of the road.
const CROWN_M: f32 = 0.085;
/// Height of the curbs.
const CURB_HEIGHT_M: f32 = 0.12;
/// Width of curb and pavement.
const PAVEMENT_M: f32 = HALF_STREET_M - HALF_ROAD_M + 0.05;

/// Hollows of the carriageway: middle, half-widths and depth, meters.
const HOLLOWS: [[f32; 5]; 9] = [
    [-0.9, 2.5, 0.75, 1.2, 0.026],
    [0.8, -2.8, 0.9, 0.7, 0.022],
    [-0.3, -6.4, 0.8, 1.6, 0.024],
    [0.9, -10.2, 0.6, 0.9, 0.022],
    [-0.7, -17.6, 0.7, 1.3, 0.025],
    [0.5, -21.5, 1.0, 0.8, 0.022],
    [-0.4, -27.0, 0.7, 1.5, 0.024],
    [0.6, -33.0, 0.8, 1.2, 0.022],
    [0.2, 7.5, 0.7, 1.0, 0.022],
];

/// Repaired rectangles of the carriageway: from x, to x, from z, to z, tint.
const REPAIRS: [[f32; 5]; 4] = [
    [-2.05, -1.45, -9.0, 14.0, 0.78],
    [0.35, 1.95, -7.6, -4.4, 0.66],
    [-2.05, 2.2, -30.6, -29.7, 0.74],
    [-1.0, 0.3, -24.4, -22.9, 1.22],
];

/// Height of the pavement at a distance from the middle of the street.
pub(super) fn pavement_height(x: f32) -> f32 {
    CURB_HEIGHT_M + 0.02 * (x.abs() - HALF_ROAD_M - 0.15).max(0.0)
}

/// Unevenness along a gutter, meters: water stands in the low parts.
fn gutter_wave(s: f32, side: u32) -> f32 {
    (world(s, side as f32 * 31.0, 4.6, 2, 201 + side) - 0.5) * 0.038
}

/// Height of the carriageway.
pub(super) fn road_height(x: f32, z: f32) -> f32 {
    let t = x / HALF_ROAD_M;
    // The crown ends at the start of the cross street.
    let open = smooth(CROSS_NEAR_M, -38.0, z);
    let edge = CROWN_M * (1.0 - (HALF_ASPHALT_M / HALF_ROAD_M) * (HALF_ASPHALT_M / HALF_ROAD_M));
    let crown = edge + (CROWN_M * (1.0 - t * t) - edge).max(0.0) * open;
    let side = u32::from(x > 0.0);
    let wave = gutter_wave(z, side) * smooth(1.0, HALF_ASPHALT_M, x.abs()) * open;
    let hollow: f32 = HOLLOWS
        .iter()
        .map(|&[cx, cz, rx, rz, depth]| {
            let (a, b) = ((x - cx) / rx, (z - cz) / rz);
            depth * ops::exp(-(a * a + b * b))
        })
        .sum();
    crown + wave - hollow
}

/// Tint of the asphalt: tires polish and darken, dust gathers at the edges, repairs differ.
fn road_tint(x: f32, z: f32) -> f32 {
    let patchy = mix(0.90, 1.06, world(x, z, 7.0, 3, 211));
    let track = |at: f32| {
        let d = (x.abs() - at) / 0.28;
        ops::exp(-d * d)
    };
    let tires = 1.0 - 0.13 * (track(0.55) + track(1.95).min(1.0));
    let oil = 1.0 - 0.10 * ops::exp(-(x.abs() - 1.25) * (x.abs() - 1.25) / 0.06);
    let dust = mix(1.0, 1.16, smooth(2.3, 3.1, x.abs()));
    let repair = REPAIRS
        .iter()
        .find(|[x0, x1, z0, z1, _]| (*x0..*x1).contains(&x) && (*z0..*z1).contains(&z))
        .map_or(1.0, |repair| repair[4]);
    (patchy * tires * oil * dust * repair * 0.86).min(1.0)
}

/// True if a point is painted: dashes along the middle and the bars of the crossing.
fn is_painted(x: f32, z: f32) -> bool {
    let zebra = (z - ZEBRA_M[0]).abs();
    if zebra < ZEBRA_M[1] {
        return x.abs() < 2.75 && ((x + 2.75) * 2.0).floor() as i32 % 2 == 0;
    }
    let dash = (z - 1.0).rem_euclid(6.0) < 2.0;
    x.abs() < 0.05 && dash && zebra > ZEBRA_M[1] + 1.5 && (-40.0..22.0).contains(&z)
}

/// Sorted cuts without those that are closer than a millimeter.
fn cuts(mut all: Vec<f32>) -> Vec<f32> {
    all.sort_by(f32::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 1.0e-3);
    all
}

/// The whole ground.
pub(super) fn ground() -> Mesh {
    let mut mesh = Mesh::default();
    carriageway(&mut mesh);
    cross_street(&mut mesh);
    for mirror in [1.0, -1.0] {
        sidewalk(&mut mesh, mirror);
    }
    far_sidewalk(&mut mesh);
    covers(&mut mesh);
    // Below everything, so that gaps are not visible.
    let base = -0.25;
    let corner = |x: f32, z: f32| Vec3::new(x, base, z);
    mesh.quad(
        plain(Material::Soil),
        [corner(-60.0, 45.0), corner(60.0, 45.0), corner(60.0, -80.0), corner(-60.0, -80.0)],
    );
    mesh
}

fn carriageway(mesh: &mut Mesh) {
    const JOINT: f32 = 0.025;
    let mut across: Vec<f32> = (-8..=8).map(|k| k as f32 * HALF_ASPHALT_M / 8.0).collect();
    across.extend([-0.05, 0.05]);
    across.extend((0..12).map(|k| -2.75 + 0.5 * k as f32));
    let mut along: Vec<f32> =
        (0..=110).map(|k| mix(START_M, CROSS_NEAR_M - GUTTER_M, k as f32 / 110.0)).collect();
    along.extend([ZEBRA_M[0] - ZEBRA_M[1], ZEBRA_M[0] + ZEBRA_M[1]]);
    for k in -8..4 {
        along.extend([1.0 + 6.0 * k as f32, 3.0 + 6.0 * k as f32]);
    }
    for [x0, x1, z0, z1, _] in REPAIRS {
        across.extend([x0, x1].iter().flat_map(|&x| [x - JOINT * 0.5, x + JOINT * 0.5]));
        along.extend([z0, z1].iter().flat_map(|&z| [z - JOINT * 0.5, z + JOINT * 0.5]));
    }
    let across = cuts(across);
    let mut along = cuts(along);
    along.reverse();
    let width = |z: f32| {
        // Between the corners' arcs the asphalt widens.
        let down = (CROSS_NEAR_M + CORNER_M - z).clamp(0.0, CORNER_M + GUTTER_M);
        let radius = CORNER_M + GUTTER_M;
        HALF_ROAD_M + CORNER_M - (radius * radius - down * down).max(0.0).sqrt()
    };
    let position = |i: usize, j: usize| {
        let z = along[j];
        let x = across[i] / HALF_ASPHALT_M * width(z);
        Vec3::new(x, road_height(x, z), z)
    };
    mesh.grid(
        [across.len() - 1, along.len() - 1],
        |i, j| {
            let p = position(i, j);
            let uv = Vec2::new(p.x, p.z) / Material::Asphalt.tile_m();
            (p, uv, Vec3::splat(road_tint(p.x, p.z)))
        },
        |i, j| {
            let middle = (position(i, j) + position(i + 1, j + 1)) * 0.5;
            Some(if is_painted(middle.x, middle.z) { Material::RoadPaint } else { Material::Asphalt })
        },
    );
}

fn cross_street(mesh: &mut Mesh) {
    let (near, far) = (CROSS_NEAR_M - GUTTER_M, CROSS_FAR_M + GUTTER_M);
    mesh.grid(
        [54, 8],
        |i, j| {
            let x = mix(-CROSS_REACH_M, CROSS_REACH_M, i as f32 / 54.0);
            let t = j as f32 / 8.0;
            let z = mix(near, far, t);
            let edge = CROWN_M * (1.0 - (HALF_ASPHALT_M / HALF_ROAD_M) * (HALF_ASPHALT_M / HALF_ROAD_M));
            let y = edge + (CROWN_M - edge) * 4.0 * t * (1.0 - t);
            let tint = mix(0.78, 0.92, world(x, z, 6.0, 3, 231));
            (Vec3::new(x, y, z), Vec2::new(x, z) / Material::Asphalt.tile_m(), Vec3::splat(tint))
        },
        |_, _| Some(Material::Asphalt),
    );
}

/// A station of a curb line: position, direction to the houses, length so far, and height of the curb relative to 1.
struct Station {
    at: Vec2,
    out: Vec2,
    length: f32,
    curb: f32,
}

/// Profile of gutter, curb and pavement: distance from the curb's face, height as a fraction of the curb's, additional
/// height, and the material up to the next point.
const PROFILE: [(f32, f32, f32, Material); 15] = [
    (-GUTTER_M, 0.0, 0.0143, Material::Setts),
    (-0.17, 0.0, 0.004, Material::Setts),
    (-0.06, 0.0, 0.0, Material::Setts),
    (0.0, 0.0, 0.004, Material::Kerb),
    (0.004, 0.85, 0.0, Material::Kerb),
    (0.009, 0.95, 0.0, Material::Kerb),
    (0.022, 1.0, 0.0, Material::Kerb),
    (0.15, 1.0, 0.001, Material::Kerb),
    (0.153, 1.0, -0.004, Material::Slabs),
    (0.157, 1.0, 0.0, Material::Slabs),
    (0.55, 1.0, 0.008, Material::Slabs),
    (1.05, 1.0, 0.018, Material::Slabs),
    (1.6, 1.0, 0.029, Material::Slabs),
    (2.2, 1.0, 0.041, Material::Slabs),
    (PAVEMENT_M, 1.0, 0.050, Material::Slabs),
];

/// Draws the profile along stations; `mirror` is -1 for the other side of the street.
fn sweep(mesh: &mut Mesh, stations: &[Station], mirror: f32, side: u32) {
    let columns = PROFILE.len() - 1;
    // Mirrored, the columns run the other way, so that the front stays above.
    let column = |i: usize| if mirror > 0.0 { i } else { columns - i };
    mesh.grid(
        [columns, stations.len() - 1],
        |i, j| {
            let (distance, fraction, more, material) = PROFILE[column(i)];
            let station = &stations[j];
            // Behind a dropped curb the pavement rises to its height over 1.2 m.
            let curb = mix(station.curb, 1.0, smooth(0.15, 1.35, distance));
            let wave = if distance < 0.01 { gutter_wave(station.at.y, side) * (1.0 - fraction) } else { 0.0 };
            let flat = station.at + station.out * distance;
            let y = fraction * CURB_HEIGHT_M * curb + more + wave * smooth(-39.0, -36.0, station.at.y);
            let p = Vec3::new(flat.x * mirror, y, flat.y);
            let (uv, tint) = match material {
                Material::Kerb => {
                    // From the foot of the face over the edge to the back.
                    let over = fraction * 0.12 + distance.max(0.0);
                    let dirt = mix(0.62, 1.0, smooth(0.0, 0.6, fraction));
                    (
                        Vec2::new(station.length, over / 0.5),
                        dirt * mix(0.85, 1.1, hash(station.length as i32, 3, 241)),
                    )
                }
                Material::Setts => {
                    let dark = mix(0.7, 1.0, smooth(0.02, -0.2, distance));
                    (Vec2::new(distance, station.length) / Material::Setts.tile_m(), dark)
                }
                _ => {
                    let foot = mix(1.0, 0.72, smooth(1.9, 2.65, distance));
                    let patchy = mix(0.9, 1.06, world(p.x, p.z, 4.0, 2, 242));
                    (Vec2::new(distance, station.length) / Material::Slabs.tile_m(), foot * patchy)
                }
            };
            (p, uv, Vec3::splat(tint.min(1.0)))
        },
        |i, _| {
            let (from, to) = (column(i), column(i + 1));
            Some(PROFILE[from.min(to)].3)
        },
    );
}

/// Gutter, curb and pavement of one side, around the corner into the cross street.
fn sidewalk(mesh: &mut Mesh, mirror: f32) {
    let side = u32::from(mirror > 0.0);
    let mut stations = Vec::new();
    let mut length = 0.0;
    let mut add = |at: Vec2, out: Vec2, curb: f32, step: f32| {
        length += step;
        stations.push(Station { at, out, length, curb });
    };
    let straight = START_M - (CROSS_NEAR_M + CORNER_M);
    let count = (straight / 0.5).round() as i32;
    for k in 0..=count {
        let z = START_M - straight * k as f32 / count as f32;
        let dropped = smooth(2.4, 1.7, (z - ZEBRA_M[0]).abs());
        add(
            Vec2::new(HALF_ROAD_M, z),
            Vec2::X,
            mix(1.0, 0.25, dropped),
            if k == 0 { 0.0 } else { straight / count as f32 },
        );
    }
    let center = Vec2::new(HALF_ROAD_M + CORNER_M, CROSS_NEAR_M + CORNER_M);
    for k in 1..=12 {
        let angle = k as f32 / 12.0 * std::f32::consts::FRAC_PI_2;
        let out = Vec2::new(ops::cos(angle), ops::sin(angle));
        add(center - out * CORNER_M, out, 1.0, CORNER_M * std::f32::consts::FRAC_PI_2 / 12.0);
    }
    for k in 1..=20 {
        let x = mix(center.x, CROSS_REACH_M, k as f32 / 20.0);
        add(Vec2::new(x, CROSS_NEAR_M), Vec2::Y, 1.0, (CROSS_REACH_M - center.x) / 20.0);
    }
    sweep(mesh, &stations, mirror, side);
}

fn far_sidewalk(mesh: &mut Mesh) {
    let stations: Vec<Station> = (0..=54)
        .map(|k| Station {
            at: Vec2::new(CROSS_REACH_M - k as f32, CROSS_FAR_M),
            out: Vec2::new(0.0, -1.0),
            length: k as f32,
            curb: 1.0,
        })
        .collect();
    sweep(mesh, &stations, 1.0, 2);
}

/// Manhole covers in the road, gullies in the gutters.
fn covers(mesh: &mut Mesh) {
    for [x, z] in [[-0.65, -1.4], [0.9, -18.4], [-0.5, -36.0], [0.7, 12.0]] {
        let y = road_height(x, z);
        let foot = Vec3::new(x, y - 0.02, z);
        mesh.lathe(
            tinted(Material::Iron, [0.05, 0.048, 0.045]),
            foot,
            &[[0.36, 0.018], [0.36, 0.024], [0.31, 0.024], [0.31, 0.021]],
            28,
        );
        let rim: Vec<Vec3> = (0..28)
            .map(|k| {
                let angle = k as f32 / 28.0 * std::f32::consts::TAU;
                foot + Vec3::new(0.31 * ops::cos(angle), 0.022, -0.31 * ops::sin(angle))
            })
            .collect();
        mesh.polygon(plain(Material::Cover), &rim);
    }
    let bars = Paint { material: Material::Iron, tint: Vec3::splat(0.045) };
    for side in [-1.0, 1.0] {
        for k in 0..4 {
            let z = 16.0 - 18.0 * k as f32;
            let x = side * (HALF_ROAD_M - 0.16);
            mesh.block(tinted(Material::Trim, [0.3; 3]), [x - 0.15, -0.05, z - 0.22], [0.30, 0.046, 0.44]);
            for bar in 0..6 {
                let z = z - 0.21 + bar as f32 * 0.078;
                mesh.block(bars, [x - 0.15, -0.02, z], [0.30, 0.028, 0.032]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Water runs off the middle and stands in the hollows.
    #[test]
    fn the_road_has_a_crown_and_hollows() {
        assert!(road_height(0.0, -20.0) > road_height(3.1, -20.0) + 0.04);
        for [x, z, _, reach, depth] in HOLLOWS {
            for end in [z - 2.0 * reach, z + 2.0 * reach] {
                let fall = road_height(x, end) - road_height(x, z);
                assert!(fall > 0.4 * depth, "{fall} of {depth} at {x}, {z}");
            }
        }
    }

    #[test]
    fn the_ground_looks_up() {
        for part in ground().parts.values() {
            assert!(part.vertices.iter().all(|v| v.normal.is_finite()));
        }
        let ground = ground();
        let asphalt = &ground.parts[&Material::Asphalt];
        assert!(asphalt.vertices.iter().all(|v| v.normal.y > 0.95), "the carriageway is even");
        let slabs = &ground.parts[&Material::Slabs];
        assert!(slabs.vertices.iter().all(|v| v.normal.y > 0.3), "pavements look up");
    }
}
