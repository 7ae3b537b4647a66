//! Traces the rays of the profiles of streaks. Twin of `shaders/wgsl/render/streak_rays.wgsl`, where method and layout are
//! described. Rays are traced as many at a time as a machine vector has lanes.

use downpour_mask::wobble::{
    WobbleDrop, WobbleLight, mask_wobble_light, mask_wobble_nearest, mask_wobble_surface,
};
use downpour_math::ops;
use downpour_math::packing::{packing_octahedral_encode, packing_pack_snorm, packing_pack_unorm};
use downpour_math::real::{Lanes, Simd, WithLanes, with_widest_lanes};
use downpour_math::vector::dot;
use downpour_shaders::render::rain::{
    STREAK_OUTLINE, STREAK_OUTLINE_MAX, STREAK_OUTLINE_MIN, STREAK_OUTLINE_SLOPE, STREAK_OUTLINE_STEPS,
    STREAK_TURN,
};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::glint::drop_glint_right;
use super::streak::ScreenDrop;
use super::streak_cell::streak_cell_position;
use super::streak_path::{StreakInstant, StreakPath, streak_path_axes, streak_path_instant};

/// More lanes than any vector has.
const MAX_LANES: usize = 64;

/// A traced ray of a streak profile. The same layout as `StreakRay` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct StreakRay {
    /// Directions of its exits, octahedral, two numbers of 16 bits each.
    pub exits: [u32; 4],
    /// Fractions of the light of the exits, two numbers of 16 bits each.
    pub fractions: [u32; 2],
    /// Interfaces passed before each exit, 8 bits each; 0: no such exit.
    pub interfaces: u32,
    /// 0.
    pub unused: u32,
}

/// The chords of a row and its rays.
struct Row {
    chords: Vec<[f32; 4]>,
    rays: Vec<StreakRay>,
}

/// Of the pixel that sees a point at a radius and an angle from the motion: the distance from the path, and how far ahead it is.
fn streak_rays_beside(instant: &StreakInstant, radius: f32, c: f32, s: f32) -> Vec2 {
    Vec2::new(radius * s / (1.0 + instant.funnel * radius * c), radius * c)
}

/// A point of the outline at an angle from the motion.
fn streak_rays_outline(path: &StreakPath, drop: &ScreenDrop, instant: &StreakInstant, angle: f32) -> Vec2 {
    let [along_axis, across_axis] = streak_path_axes(drop);
    let (c, s) = (ops::cos(angle), ops::sin(angle));
    let way = along_axis * c + across_axis * s;
    let towards = Vec3::from(drop.towards);
    let right = drop_glint_right(towards);
    let up = right.cross(towards);
    let radial = path.streak_path_turned(right * way.x + up * way.y);
    let coefficients = path.coefficients();
    let (mut radius, mut along) = (1.0f32, 0.0f32);
    for _ in 0..STREAK_OUTLINE_STEPS {
        let time = instant.time - radius * c * instant.pace;
        let body = path.streak_path_body(coefficients, path.streak_path_displacement(drop, time));
        let [origin, direction] =
            path.streak_path_line(drop, instant, streak_rays_beside(instant, radius, c, s));
        along = mask_wobble_nearest(&body, origin.to_array(), direction.to_array(), along);
        let point = (origin + direction * along).to_array();
        let surface = mask_wobble_surface(&body.coefficients, body.state, point);
        let gauge = (surface.excess + 1.0).max(0.0).sqrt();
        let slope = dot(surface.half_gradient, radial.to_array()).max(STREAK_OUTLINE_SLOPE);
        let next = radius - surface.excess / (gauge + 1.0) * gauge / slope;
        radius = next.clamp(STREAK_OUTLINE_MIN, STREAK_OUTLINE_MAX);
    }
    streak_rays_beside(instant, radius, c, s)
}

/// Middle and half of the outline's width.
fn streak_rays_width(points: &[Vec2]) -> Vec2 {
    let (mut low, mut high) = (points[0].x, points[0].x);
    for point in points {
        (low, high) = (low.min(point.x), high.max(point.x));
    }
    Vec2::new(0.5 * (high + low), 0.5 * (high - low))
}

/// Middle and half of the chord at a position across the motion.
fn streak_rays_chord(points: &[Vec2], across: f32) -> Vec2 {
    let (mut low, mut high) = (STREAK_OUTLINE_MAX, -STREAK_OUTLINE_MAX);
    for (k, p) in points.iter().enumerate() {
        let q = points[(k + 1) % points.len()];
        if (p.x - across) * (q.x - across) <= 0.0 && p.x != q.x {
            let along = p.y + (q.y - p.y) * (across - p.x) / (q.x - p.x);
            (low, high) = (low.min(along), high.max(along));
        }
    }
    Vec2::new(0.5 * (high + low), (0.5 * (high - low)).max(0.0))
}

/// Rays of a row that are traced together.
struct Rays<'a> {
    path: &'a StreakPath,
    drop: &'a ScreenDrop,
    instant: &'a StreakInstant,
    /// Points across and along the motion.
    points: &'a [Vec2],
    rays: &'a mut [StreakRay],
}

impl WithLanes for Rays<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let lanes = Lanes::<S>::COUNT;
        debug_assert!(lanes <= MAX_LANES, "a machine with vectors of more than {MAX_LANES} numbers");
        let Self { path, drop, instant, points, rays } = self;
        let coefficients = path.coefficients();
        for (points, rays) in points.chunks(lanes).zip(rays.chunks_mut(lanes)) {
            // Origin, direction, state, and both numbers of the spheroid; lanes past the end repeat the last ray.
            let mut numbers = [[0.0f32; MAX_LANES]; 11];
            for k in 0..lanes {
                let point = points[k.min(points.len() - 1)];
                let [origin, direction] = path.streak_path_line(drop, instant, point);
                let time = instant.time - point.y * instant.pace;
                let body = path.streak_path_body(coefficients, path.streak_path_displacement(drop, time));
                let [s2, s3, size] = body.state;
                let all = [
                    origin.x,
                    origin.y,
                    origin.z,
                    direction.x,
                    direction.y,
                    direction.z,
                    s2,
                    s3,
                    size,
                    body.inverse_wide,
                    body.inverse_tall,
                ];
                for (number, value) in numbers.iter_mut().zip(all) {
                    number[k] = value;
                }
            }
            let load = |k: usize| Lanes::load(simd, &numbers[k][..lanes]);
            let body = WobbleDrop {
                coefficients,
                state: [load(6), load(7), load(8)],
                index: path.index.into(),
                inverse_wide: load(9),
                inverse_tall: load(10),
            };
            let light = mask_wobble_light(&body, [load(0), load(1), load(2)], [load(3), load(4), load(5)]);
            store(path, &light, rays);
        }
    }
}

/// Packs the lanes of the light of rays.
#[inline(always)]
fn store<S: Simd>(path: &StreakPath, light: &WobbleLight<Lanes<S>>, rays: &mut [StreakRay]) {
    let mut exits = [[[0.0f32; MAX_LANES]; 3]; 4];
    let mut fractions = [[0.0f32; MAX_LANES]; 4];
    let mut passed = [[0.0f32; MAX_LANES]; 4];
    for n in 0..4 {
        for (lanes, into) in light.exits[n].iter().zip(&mut exits[n]) {
            lanes.store(into);
        }
        light.fractions[n].store(&mut fractions[n]);
        light.interfaces[n].store(&mut passed[n]);
    }
    for (k, ray) in rays.iter_mut().enumerate() {
        let exit = |n: usize| {
            let [x, y, z] = &exits[n];
            let world = path.streak_path_back(Vec3::new(x[k], y[k], z[k]));
            packing_pack_snorm(packing_octahedral_encode(world.to_array()))
        };
        let pair = |n: usize| packing_pack_unorm([fractions[n][k], fractions[n + 1][k]]);
        let count = |n: usize| (passed[n][k] as u32) << (8 * n);
        *ray = StreakRay {
            exits: [exit(0), exit(1), exit(2), exit(3)],
            fractions: [pair(0), pair(2)],
            interfaces: count(0) | count(1) | count(2) | count(3),
            unused: 0,
        };
    }
}

/// One row of a streak.
fn row(path: &StreakPath, drop: &ScreenDrop, row: u32) -> Row {
    let instant = streak_path_instant(drop, row as f32 / (path.rows - 1) as f32);
    let step = STREAK_TURN / STREAK_OUTLINE as f32;
    let outline: Vec<Vec2> =
        (0..STREAK_OUTLINE).map(|k| streak_rays_outline(path, drop, &instant, step * k as f32)).collect();
    let columns = path.columns;
    let width = streak_rays_width(&outline);
    let mut chords = Vec::with_capacity(columns as usize);
    let mut points = Vec::with_capacity((columns * columns) as usize);
    for column in 0..columns {
        let position = streak_cell_position(column as f32 + 0.5, columns);
        let across = width.x + width.y * position;
        let chord = streak_rays_chord(&outline, across);
        let round = chord.y / (1.0 - position * position).max(1.0e-6).sqrt();
        chords.push([width.x, width.y, chord.x, round]);
        let along = |tap: u32| chord.x + chord.y * streak_cell_position(tap as f32 + 0.5, columns);
        points.extend((0..columns).map(|tap| Vec2::new(across, along(tap))));
    }
    let mut rays = vec![StreakRay::default(); points.len()];
    with_widest_lanes(Rays { path, drop, instant: &instant, points: &points, rays: &mut rays });
    Row { chords, rays }
}

/// Traces all rows of all paths into the table and the rays, in parallel; the same bits for any number of threads.
pub(super) fn trace(
    paths: &[StreakPath],
    drops: &[ScreenDrop],
    jobs: &[[u32; 2]],
    table: &mut [[f32; 4]],
    rays: &mut [StreakRay],
) {
    let made: Vec<Row> = jobs
        .par_iter()
        .map(|&[path, number]| {
            let path = &paths[path as usize];
            row(path, &drops[path.drop as usize], number)
        })
        .collect();
    for (&[path, number], made) in jobs.iter().zip(made) {
        let path = &paths[path as usize];
        let first = path.first_entry as usize;
        if number == 0 {
            table[first] = [path.rows, path.columns, path.profile_rows, path.fine].map(|n| n as f32);
        }
        let chords = first + 1 + (number * path.columns) as usize;
        table[chords..chords + made.chords.len()].copy_from_slice(&made.chords);
        let first = (path.first_ray + number * path.columns * path.columns) as usize;
        rays[first..first + made.rays.len()].copy_from_slice(&made.rays);
    }
}
