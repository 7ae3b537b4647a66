//! Drip points: where water that leaves over an edge of the lattice gets to on the real surface.

use std::collections::HashMap;

use downpour_math::rng::{rng_draw, rng_unit};
use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::runoff::{Outflow, runoff};
use super::surfaces::{CELL_M, DripRegion, Surfaces};
use crate::SimError;
use crate::facets::Facets;
use crate::shelter::{Obstacles, met};

/// Minimum distance between drip points, m.
const MERGED_M: f64 = 0.02;

/// Distance from the plane of a cell within which its surface is searched beside the middle, m.
const PLANE_M: f32 = 0.03;

/// Maximum number of cells beyond its own in which the edge of a cell is searched.
const MAX_CELLS: u32 = 3;

/// Number of halvings of the way from a cell to the next: an edge is found to 0.4 mm.
const HALVINGS: u32 = 7;

/// Distance from an edge at which its underside is looked at, m.
const INSET_M: f32 = 1.5e-3;

/// Maximum height of an edge at which water runs down to the lower rim, m. Higher ones are walls: the water runs down on them.
const MAX_EDGE_M: f32 = 0.3;

/// Way along an underside in a step, and the slope below which water hangs there.
const UNDER_M: f32 = 4.0e-3;
const UNDER_SLOPE: f32 = 0.2;

/// Maximum number of steps along an underside.
const MAX_STEPS: u32 = 500;

/// Minimum height of the air below a drip, m.
const AIR_M: f32 = 0.05;

/// Thickness, m, from which on an edge is broad.
const BROAD_M: f32 = 4.0e-3;

/// Dimensions of the random numbers.
const SPREAD: u32 = 8311;

/// Maximum number of drip points.
pub const MAX_POINTS: usize = 1 << 20;

/// A point from which water drips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DripPoint {
    /// Position at the lower rim of the edge, m.
    pub position: DVec3,
    /// Horizontal area whose rain drips from it, m^2.
    pub catchment_m2: f64,
    /// Length of the longest way of that water, m.
    pub flow_m: f64,
    /// Radius of a thin edge, half its thickness, m; `None` for a broad one.
    pub radius_m: Option<f64>,
}

/// Drip points of a scene, and the balance of its water.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DripPoints {
    /// The points, in an order that depends on the scene only.
    pub points: Vec<DripPoint>,
    /// Area on which the rain falls, m^2: what is under the open sky, from above.
    pub rained_m2: f64,
    /// Area of the surfaces whose water leaves over an edge but runs down a wall or a step, m^2; water that leaves over several edges
    /// counts at each.
    pub ran_down_m2: f64,
}

impl DripPoints {
    /// Finds the points of a part of a scene.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for more than [`MAX_POINTS`].
    pub fn find(obstacles: &Obstacles<'_>, region: DripRegion) -> Result<Self, SimError> {
        let surfaces = Surfaces::new(obstacles, region);
        let found = runoff(obstacles, &surfaces);
        let cell_m2 = CELL_M * CELL_M;
        let edges = Edges { obstacles, surfaces: &surfaces, facets: Facets::new(obstacles) };
        let of_each: Vec<Vec<DripPoint>> =
            found.outflows.par_iter().map(|outflow| edges.points(outflow)).collect();
        let ran_down = found.outflows.iter().zip(&of_each).filter(|(_, points)| points.is_empty());
        let ran_down_m2: f64 = ran_down.map(|(outflow, _)| f64::from(outflow.cells) * cell_m2).sum();
        let points = merged(of_each.iter().flatten());
        if points.len() > MAX_POINTS {
            return Err(super::surfaces::out_of_range(
                "number of drip points",
                points.len() as f64,
                "",
                "up to 1048576",
            ));
        }
        Ok(Self { points, rained_m2: f64::from(found.rained) * cell_m2, ran_down_m2: ran_down_m2 + 0.0 })
    }
}

/// Points without those that are too near to another, whose water it gets.
fn merged<'a>(all: impl Iterator<Item = &'a DripPoint>) -> Vec<DripPoint> {
    let mut points: Vec<DripPoint> = Vec::new();
    let mut near: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let around = |k: i32| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1].map(i64::from);
    for point in all {
        let place = (point.position / MERGED_M).floor().to_array().map(|x| x as i64);
        let beside = (0..27).map(|k| {
            let [x, y, z] = around(k);
            [place[0] + x, place[1] + y, place[2] + z]
        });
        let known = beside.filter_map(|place| near.get(&place)).flatten().copied();
        let distance = |k: &u32| points[*k as usize].position.distance_squared(point.position);
        let nearest = known.min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
        match nearest.filter(|k| distance(k) < MERGED_M * MERGED_M) {
            Some(k) => {
                let other = &mut points[k as usize];
                other.catchment_m2 += point.catchment_m2;
                other.flow_m = other.flow_m.max(point.flow_m);
            }
            None => {
                near.entry(place).or_default().push(points.len() as u32);
                points.push(*point);
            }
        }
    }
    points
}

/// Edges of the surfaces.
struct Edges<'a> {
    obstacles: &'a Obstacles<'a>,
    surfaces: &'a Surfaces,
    facets: Facets<'a>,
}

impl Edges<'_> {
    /// The points at which water that leaves a cell drips: two on its side, one where there is no room for two, none where it runs down a
    /// wall.
    fn points(&self, outflow: &Outflow) -> Vec<DripPoint> {
        let sheet = self.surfaces.sheet(outflow.sheet);
        let columns = self.surfaces.region.cells[0];
        let cell = [sheet.cell % columns, sheet.cell / columns];
        let world = [0, 1].map(|k| (self.surfaces.region.first[k] + i64::from(cell[k])) as u32);
        let way = outflow.way.map(|k| k as u32);
        let drawn = rng_draw(world, way[0].wrapping_mul(3).wrapping_add(way[1]), 0, SPREAD).map(rng_unit);
        let quarter = 0.25 * CELL_M as f32;
        // Not all as far apart as the next, and some have more water than others.
        let asides = [-quarter + 6.0e-3 * (drawn[0] - 0.5), quarter + 6.0e-3 * (drawn[1] - 0.5)];
        let first = 0.2 + 0.6 * f64::from(drawn[2]);
        let mut found: Vec<(DripPoint, f64)> = Vec::new();
        for (aside, weight) in asides.into_iter().zip([first, 1.0 - first]) {
            found.extend(self.point(outflow, aside).map(|point| (point, weight)));
        }
        if found.is_empty() {
            found.extend(self.point(outflow, 0.0).map(|point| (point, 1.0)));
        }
        let weights: f64 = found.iter().map(|(_, weight)| weight).sum();
        let area = f64::from(outflow.cells) * CELL_M * CELL_M;
        let shared = |(point, weight)| DripPoint { catchment_m2: area * weight / weights, ..point };
        found.into_iter().map(shared).collect()
    }

    /// The point on the line along the way of an outflow that is a distance beside the middle of its cell, m.
    fn point(&self, outflow: &Outflow, aside: f32) -> Option<DripPoint> {
        let sheet = self.surfaces.sheet(outflow.sheet);
        let middle = Vec2::from(self.surfaces.middle(sheet.cell));
        let way = Vec2::new(outflow.way[0] as f32, outflow.way[1] as f32);
        let beside = way.perp() * aside;
        // Height of the surface at a distance along the way, if it goes on from another place of it.
        let goes_on = |along: f32, [before, height]: [f32; 2]| {
            let offset = beside + way * along;
            let high = height.max(sheet.height_at(offset.x, offset.y)) + PLANE_M;
            self.top(middle + offset, high, height, (along - before).abs())
        };
        let mut inside = 0.0;
        let mut height = goes_on(inside, [0.0, sheet.height_at(beside.x, beside.y)])?;
        let mut outside = CELL_M as f32;
        // A curved surface ends later than its planes tell.
        let mut cells = 1;
        while let Some(found) = goes_on(outside, [inside, height]) {
            if cells == MAX_CELLS {
                return None;
            }
            cells += 1;
            (inside, height) = (outside, found);
            outside += CELL_M as f32;
        }
        for _ in 0..HALVINGS {
            let half = 0.5 * (inside + outside);
            match goes_on(half, [inside, height]) {
                Some(found) => (inside, height) = (half, found),
                None => outside = half,
            }
        }
        // On the edge itself a ray may meet the underside alone: its height is that of the surface before it, continued.
        let before = |insets: f32| goes_on(inside - insets * INSET_M, [inside, height]);
        if let (Some(near), Some(far)) = (before(1.0), before(2.0)) {
            height = 2.0 * near - far;
        }
        let at = middle + beside + way * inside;
        let edge = Vec3::new(at.x, height, at.y);
        let outward = Vec3::new(outflow.normal[0], 0.0, outflow.normal[1]);
        let (rim, is_sheet) = self.rim(edge, outward)?;
        // Air below.
        let fall = met(self.obstacles, rim - Vec3::Y * 1.0e-3, Vec3::NEG_Y, AIR_M);
        if fall.is_some() {
            return None;
        }
        let thickness = edge.y - rim.y;
        let is_thin = !is_sheet && thickness < BROAD_M && (rim - edge).length() < 2.0 * BROAD_M;
        Some(DripPoint {
            position: self.obstacles.origin + rim.as_dvec3(),
            catchment_m2: 0.0,
            flow_m: f64::from(outflow.length),
            radius_m: is_thin.then(|| f64::from(0.5 * thickness).max(0.3e-3)),
        })
    }

    /// Height, m, of the first surface below a height `high`, if it goes on from a height at a distance: it is lower by no more than it
    /// would descend by its own slope.
    fn top(&self, at: Vec2, high: f32, height: f32, distance: f32) -> Option<f32> {
        let from = Vec3::new(at.x, high, at.y);
        let hit = met(self.obstacles, from, Vec3::NEG_Y, downpour_shaders::bvh::BVH_FAR)?;
        let normal = self.facets.normal(&hit);
        let slope = Vec2::new(normal.x, normal.z).length() / normal.y.abs().max(1.0e-3);
        let found = from.y - hit.distance;
        (height - found <= PLANE_M + 1.1 * slope * distance).then_some(found)
    }

    /// The lower rim of an edge, to which water runs before it drips, and true if the surface has no underside; `None` at a wall.
    fn rim(&self, edge: Vec3, outward: Vec3) -> Option<(Vec3, bool)> {
        // What stands below the edge and is as high is a wall.
        let before = edge + outward * 0.02 - Vec3::Y * (MAX_EDGE_M + 0.05);
        if met(self.obstacles, before, -outward, 0.03).is_some() {
            return None;
        }
        let inset = edge - outward * INSET_M;
        let Some((underside, mut normal)) = self.underside(inset - Vec3::Y * 0.5e-3, f32::MAX) else {
            return Some((edge, true));
        };
        if edge.y - underside > MAX_EDGE_M {
            return None;
        }
        let mut rim = Vec3::new(inset.x, underside, inset.z);
        // Water clings to an underside that descends, as that of a pipe.
        for _ in 0..MAX_STEPS {
            let across = Vec3::new(normal.x, 0.0, normal.z);
            if across.length() < UNDER_SLOPE * -normal.y {
                break;
            }
            let next = rim - across.normalize_or_zero() * UNDER_M;
            match self.underside(next + Vec3::Y * 0.5e-3, MAX_EDGE_M) {
                Some((lower, turned)) if lower < rim.y => {
                    (rim, normal) = (Vec3 { y: lower, ..next }, turned);
                }
                _ => break,
            }
        }
        Some((rim, false))
    }

    /// Height, m, and normal of the underside below a point within a solid; `None` if the next surface below is a top.
    fn underside(&self, from: Vec3, distance: f32) -> Option<(f32, Vec3)> {
        let hit = met(self.obstacles, from, Vec3::NEG_Y, distance.min(downpour_shaders::bvh::BVH_FAR))?;
        let normal = self.facets.normal(&hit);
        (normal.y <= 0.0).then_some((from.y - hit.distance, normal))
    }
}
