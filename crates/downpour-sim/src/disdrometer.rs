//! Rain rate of the drops in a volume.

use std::f64::consts::FRAC_PI_6;

use downpour_math::ops::f64 as ops;
use downpour_math::rng::rng_draw;
use downpour_shaders::sim::step::STEP_FALLING;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::collision::CollisionMap;
use crate::frustum::Frustum;
use crate::options::{PIECE, SimVolume};
use crate::plan::Plan;
use crate::population::volume_of;
use crate::step::StepDrop;
use crate::view::within;

/// Number of points at which a volume is tested for openness.
const POINTS: u32 = 2048;

/// Dimension of the random numbers.
const POINT: u32 = 8260;

/// Rate, mm/h, of the drops that fall in the volume, relative to its part that is open to the sky. For a frustum: in
/// the picture, up to the distance at which each size is resolved.
pub(crate) fn rate_mm_h(plan: &Plan, drops: &[StepDrop], map: Option<&CollisionMap>) -> f64 {
    let view = plan.view();
    let (open, sides) = (Openness::new(plan, map), view.sides());
    let flux = |drop: &StepDrop| {
        if drop.kind() != STEP_FALLING {
            return 0.0;
        }
        let diameter = f64::from(drop.diameter());
        let volume = if plan.is_open() {
            let ahead = Vec3::from(drop.position).as_dvec3()
                + Vec3::from(drop.velocity).as_dvec3() * plan.frustum().half_horizon;
            let offset = plan.origin() + ahead - view.eye;
            let range = view.range(diameter, plan.least_pixels);
            if offset.length() > range || !within(&sides, offset, 0.0) {
                return 0.0;
            }
            Frustum::volume(view, range) * open.up_to(range / view.far)
        } else {
            volume_of(&plan.options.volume, view) * open.up_to(1.0)
        };
        -f64::from(drop.velocity[1]) * diameter * diameter * diameter / volume.max(1.0e-12)
    };
    // In chunks of fixed size, so that the sum does not depend on the threads.
    let pieces: Vec<f64> = drops.par_chunks(PIECE).map(|piece| piece.iter().map(flux).sum()).collect();
    FRAC_PI_6 * pieces.iter().sum::<f64>() * 3.6e6
}

/// Openness of a volume to the sky, by the distance from the eye relative to that of the farthest drops.
struct Openness {
    /// Distances of points in order.
    distances: Vec<f64>,
    /// Cumulative space of the points, and its open part.
    sums: Vec<[f64; 2]>,
}

impl Openness {
    fn new(plan: &Plan, map: Option<&CollisionMap>) -> Self {
        let Some(map) = map else { return Self { distances: Vec::new(), sums: Vec::new() } };
        let view = plan.view();
        let (sides, eye) = (view.sides(), view.eye - plan.origin());
        let mut points: Vec<[f64; 3]> = (0..16 * POINTS)
            .filter_map(|k| {
                let [x, y, z, _] = rng_draw([0, 0], k, 0, POINT);
                let random = DVec3::new(x.into(), y.into(), z.into()) / 4_294_967_296.0;
                let (offset, distance, weight) = point(plan, random)?;
                let seen = !plan.is_open() || within(&sides, offset, 0.0);
                let open = if map.open((eye + offset).as_vec3()) { weight } else { 0.0 };
                seen.then_some([distance, weight, open])
            })
            .take(POINTS as usize)
            .collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut sum = [0.0; 2];
        let sums = points.iter().map(|&[_, all, open]| {
            sum = [sum[0] + all, sum[1] + open];
            sum
        });
        Self { sums: sums.collect(), distances: points.iter().map(|point| point[0]).collect() }
    }

    /// Fraction of a volume that is open, up to a distance.
    fn up_to(&self, distance: f64) -> f64 {
        let count = self.distances.partition_point(|&of_point| of_point <= distance);
        match count.checked_sub(1).and_then(|last| self.sums.get(last)) {
            Some(&[all, open]) => open / all,
            None => 1.0,
        }
    }
}

/// Point of a volume as an offset from the eye, its distance relative to that of the farthest drops, and the space
/// that it represents; `random` is in the unit cube.
fn point(plan: &Plan, random: DVec3) -> Option<(DVec3, f64, f64)> {
    let view = plan.view();
    match plan.options.volume {
        SimVolume::Box { size_m } => {
            let size = DVec3::from(size_m);
            Some(((random - 0.5) * size + view.forward * size / 3.0, 1.0, 1.0))
        }
        SimVolume::Tariq { size_m } => Some(((random - 0.5) * DVec3::from(size_m), 1.0, 1.0)),
        SimVolume::Cylinder { base_m, radius_m, height_m } => {
            let disk = (random - 0.5) * 2.0 * radius_m;
            let inside = disk.x * disk.x + disk.z * disk.z <= radius_m * radius_m;
            let base = DVec3::from(base_m) - view.eye;
            inside.then_some((base + DVec3::new(disk.x, random.y * height_m, disk.z), 1.0, 1.0))
        }
        SimVolume::View | SimVolume::ImSung => {
            // As many points for each size: uniform in the logarithm of the distance.
            let distance = ops::exp(-5.5 * random.z);
            let [wide, high] = [view.half_width, view.half_height].map(|half| half.min(4.0));
            let (x, y) = ((2.0 * random.x - 1.0) * wide, (2.0 * random.y - 1.0) * high);
            let direction = (view.right * x + view.up * y + view.forward).normalize();
            let weight = distance * distance * distance / ops::pow(1.0 + x * x + y * y, 1.5);
            Some((direction * (distance * view.far), distance, weight))
        }
    }
}
