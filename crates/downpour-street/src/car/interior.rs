//! What is seen through the windows of a car: lining, seats, dashboard, steering wheel.
//!
//! As coarse as it may be behind tinted panes. Forward is +z, left is +x; it is steered on the left.

use downpour_math::ops;
use glam::{Vec2, Vec3};

use super::{GLASS_FROM, GLASS_TO, PILLARS_M, section};
use crate::material::Material;
use crate::mesh::{ABOVE, Mesh, Paint, plain, tinted};
use crate::noise::hash;

/// Stations of the lining, from the hatch to the windscreen; between some of them are pillars.
const STATIONS_M: [f32; 11] = [-1.93, -1.55, -1.45, -1.18, -1.06, -0.64, -0.21, -0.11, 0.25, 0.62, 0.97];
/// Points of a cross-section between which it is drawn: the floor's edge, the door's pocket, the window, the edge of the roof, its middle.
const AROUND: [usize; 7] = [1, 4, 6, GLASS_FROM, GLASS_TO, 11, 13];
/// Distance of the lining from the body.
const INSET_M: f32 = 0.018;
/// Height of the floor.
const FLOOR_M: f32 = 0.27;
/// Distance of the front seats from the middle.
const SEAT_ASIDE_M: f32 = 0.35;

/// Color of the roof's lining, linear.
const ROOF: [f32; 3] = [0.36, 0.35, 0.32];
/// Colors of doors and seats, linear: gray, blue, beige, black.
const CLOTHS: [[f32; 3]; 4] =
    [[0.075, 0.075, 0.08], [0.035, 0.045, 0.07], [0.17, 0.14, 0.10], [0.028, 0.028, 0.03]];

/// The interior of a car, which differs with a number.
pub(super) fn interior(mesh: &mut Mesh, number: u32) {
    let cloth = CLOTHS[(hash(number as i32, 0, 443) * CLOTHS.len() as f32) as usize % CLOTHS.len()];
    lining(mesh, cloth);
    for side in [-1.0, 1.0] {
        front_seat(mesh, tinted(Material::Goods, cloth), side * SEAT_ASIDE_M);
    }
    rear_bench(mesh, tinted(Material::Goods, cloth));
    dashboard(mesh);
    steering_wheel(mesh);
}

/// Doors, pillars and roof from within, open where the windows are, and the floor.
fn lining(mesh: &mut Mesh, cloth: [f32; 3]) {
    let rows = STATIONS_M.len() - 1;
    for side in [1.0, -1.0] {
        let point = |i: usize, j: usize| {
            let p = section(if side > 0.0 { STATIONS_M[rows - j] } else { STATIONS_M[j] }, AROUND[i]);
            let inside = Vec3::new((p.x - INSET_M).max(0.0), p.y - INSET_M, p.z);
            let tint = if AROUND[i] >= GLASS_TO { ROOF } else { cloth };
            (inside * Vec3::new(side, 1.0, 1.0), Vec2::ZERO, tint.into())
        };
        mesh.grid([AROUND.len() - 1, rows], point, |i, j| {
            let row = if side > 0.0 { rows - 1 - j } else { j };
            let z = (STATIONS_M[row] + STATIONS_M[row + 1]) * 0.5;
            let is_pillar = PILLARS_M.iter().any(|[middle, half]| (z - middle).abs() < *half);
            let is_side = AROUND[i] == GLASS_FROM && z > -1.55 && z < 0.62 && !is_pillar;
            let is_end = AROUND[i] >= 11 && !(-1.45..0.25).contains(&z);
            (!is_side && !is_end).then_some(Material::Goods)
        });
    }
    let carpet = tinted(Material::Goods, [0.025; 3]);
    mesh.cuboid(carpet, Vec3::new(-0.8, FLOOR_M - 0.02, -1.9), Vec3::new(0.8, FLOOR_M, 0.95), !ABOVE);
    // The shelf over the boot, and the panel below the hatch, which keeps the light of tail lamps out.
    let shelf = tinted(Material::Goods, [0.04; 3]);
    mesh.cuboid(shelf, Vec3::new(-0.66, 0.86, -1.93), Vec3::new(0.66, 0.885, -1.36), 0);
    mesh.cuboid(shelf, Vec3::new(-0.78, FLOOR_M, -1.95), Vec3::new(0.78, 1.0, -1.92), 0);
}

/// A cushion with rounded edges: its middle, the half width along x, and half the length and half the thickness along two other directions.
fn cushion(mesh: &mut Mesh, paint: Paint, middle: Vec3, half_width: f32, length: Vec3, thickness: Vec3) {
    // Corners of its cross-section, in the half width and the thickness, and sizes of cross-sections along the length.
    const SECTION: [[f32; 2]; 8] = [
        [1.0, 0.4],
        [0.8, 1.0],
        [-0.8, 1.0],
        [-1.0, 0.4],
        [-1.0, -0.4],
        [-0.8, -1.0],
        [0.8, -1.0],
        [1.0, -0.4],
    ];
    const ALONG: [[f32; 2]; 6] =
        [[-1.0, 0.0], [-1.0, 0.82], [-0.8, 1.0], [0.8, 1.0], [1.0, 0.82], [1.0, 0.0]];
    let is_right = Vec3::X.cross(thickness).dot(length) > 0.0;
    mesh.grid(
        [SECTION.len(), ALONG.len() - 1],
        |i, j| {
            let k = if is_right { i } else { SECTION.len() - i };
            let ([x, t], [along, size]) = (SECTION[k % SECTION.len()], ALONG[j]);
            let position =
                middle + Vec3::X * (half_width * x * size) + thickness * (t * size) + length * along;
            (position, Vec2::ZERO, paint.tint)
        },
        |_, _| Some(paint.material),
    );
}

/// Directions along a back that leans, and through it to the front, both of length 1.
fn leaning(degrees: f32) -> [Vec3; 2] {
    let lean = degrees.to_radians();
    let (s, c) = (ops::sin(lean), ops::cos(lean));
    [Vec3::new(0.0, c, -s), Vec3::new(0.0, s, c)]
}

fn front_seat(mesh: &mut Mesh, cloth: Paint, x: f32) {
    let [up, ahead] = leaning(22.0);
    let hip = Vec3::new(x, 0.47, -0.30);
    cushion(mesh, cloth, Vec3::new(x, 0.43, -0.03), 0.25, Vec3::new(0.0, 0.02, 0.27), Vec3::Y * 0.075);
    cushion(mesh, cloth, hip + up * 0.31, 0.235, up * 0.31, ahead * 0.07);
    cushion(mesh, cloth, hip + up * 0.72, 0.13, up * 0.085, ahead * 0.045);
    mesh.bar(plain(Material::Trim), hip + up * 0.6, hip + up * 0.66, 0.05);
}

fn rear_bench(mesh: &mut Mesh, cloth: Paint) {
    let [up, ahead] = leaning(20.0);
    let hip = Vec3::new(0.0, 0.47, -1.12);
    cushion(mesh, cloth, Vec3::new(0.0, 0.43, -0.88), 0.62, Vec3::new(0.0, 0.02, 0.24), Vec3::Y * 0.075);
    cushion(mesh, cloth, hip + up * 0.28, 0.62, up * 0.28, ahead * 0.06);
    for side in [-1.0, 1.0] {
        let head = hip + up * 0.62 + Vec3::X * (side * SEAT_ASIDE_M);
        cushion(mesh, cloth, head, 0.12, up * 0.06, ahead * 0.04);
    }
}

/// The dashboard from the windscreen down to the feet, and the hood over the dials.
fn dashboard(mesh: &mut Mesh) {
    let profile = [
        [0.94, 0.93],
        [0.62, 0.925],
        [0.53, 0.89],
        [0.50, 0.82],
        [0.55, 0.66],
        [0.62, 0.58],
        [0.66, FLOOR_M],
    ];
    for pair in profile.windows(2) {
        let [[za, ya], [zb, yb]] = [pair[0], pair[1]];
        let half = 0.74;
        mesh.quad(
            plain(Material::Trim),
            [[-half, yb, zb], [half, yb, zb], [half, ya, za], [-half, ya, za]].map(Vec3::from),
        );
    }
    mesh.block(plain(Material::Trim), [SEAT_ASIDE_M - 0.17, 0.88, 0.50], [0.34, 0.075, 0.14]);
    // The mirror on the windscreen.
    mesh.block(plain(Material::Trim), [-0.12, 1.265, 0.30], [0.24, 0.06, 0.03]);
}

fn steering_wheel(mesh: &mut Mesh) {
    const SEGMENTS: usize = 14;
    let [up, ahead] = leaning(-28.0);
    let hub = Vec3::new(SEAT_ASIDE_M, 0.84, 0.36);
    let trim = plain(Material::Trim);
    let rim: Vec<(Vec3, f32)> = (0..=SEGMENTS)
        .map(|k| {
            let angle = k as f32 / SEGMENTS as f32 * std::f32::consts::TAU;
            (hub + Vec3::X * (0.185 * ops::cos(angle)) + up * (0.185 * ops::sin(angle)), 0.014)
        })
        .collect();
    mesh.tube(trim, &rim, 4);
    mesh.bar(trim, hub - Vec3::X * 0.18, hub + Vec3::X * 0.18, 0.03);
    cushion(mesh, trim, hub, 0.075, up * 0.055, ahead * 0.025);
    mesh.bar(trim, hub, hub + ahead * 0.2, 0.05);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::car;

    /// No part of it stands out of the body: at each height and place along the car it is narrower.
    #[test]
    fn it_is_within_the_body() {
        for number in 0..6 {
            let mut mesh = Mesh::default();
            interior(&mut mesh, number);
            for vertex in mesh.parts.values().flat_map(|part| &part.vertices) {
                let p = vertex.position;
                assert!(p.x.abs() < car::half_width(p.z) && p.y < car::top(p.z), "{p}");
                assert!(p.y >= FLOOR_M - 0.03, "{p}");
            }
        }
    }

    /// Panes have nothing close behind them but what is at their edges: the lining is open there.
    #[test]
    fn it_is_open_behind_the_windows() {
        let mut mesh = Mesh::default();
        lining(&mut mesh, [0.1; 3]);
        let part = &mesh.parts[&Material::Goods];
        let behind = |at: Vec3| {
            part.indices.chunks_exact(3).any(|t| {
                let [a, b, c] = [0, 1, 2].map(|k| part.vertices[t[k] as usize].position);
                let middle = (a + b + c) / 3.0;
                (middle - at).length() < 0.05
            })
        };
        assert!(!behind(section(-0.64, 8)) && !behind(section(0.3, 8)));
    }

    /// Fronts of cushions look outward.
    #[test]
    fn cushions_are_closed_and_look_outward() {
        let mut mesh = Mesh::default();
        let [up, ahead] = leaning(20.0);
        for (length, thickness) in [(up * 0.3, ahead * 0.07), (Vec3::Z * 0.3, Vec3::Y * 0.07)] {
            mesh.parts.clear();
            cushion(&mut mesh, plain(Material::Goods), Vec3::ZERO, 0.2, length, thickness);
            let volume = mesh.volume_m3();
            // A box of the same size has 8 a b c, and the rounded edges take some of it.
            let whole = 8.0 * 0.2 * 0.3 * 0.07;
            assert!((0.75 * whole..whole).contains(&volume), "{volume} of {whole}");
        }
    }
}
