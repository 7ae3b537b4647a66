//! Parts of space where obstacles are.

use std::collections::HashMap;

use downpour_bvh::bvh_bounds_within;
use glam::{DVec3, Vec3};

use crate::shelter::Obstacles;
use crate::view::Bounds;

/// Edge of a cell, m.
const CELL_M: f64 = 2.0;

/// Maximum number of cells along an axis of a box: larger boxes have larger cells.
const MAX_CELLS: f64 = 32.0;

/// What rounding may put aside a surface, m.
const SLACK_M: f64 = 0.01;

/// Bounds of the obstacles in each cell of a lattice, found when they are asked for.
pub(super) struct Places<'a> {
    obstacles: &'a Obstacles<'a>,
    edge: f64,
    found: HashMap<[i64; 3], Option<Bounds>>,
}

impl<'a> Places<'a> {
    /// Places in boxes that are within `all`.
    pub(super) fn new(obstacles: &'a Obstacles<'a>, all: &Bounds) -> Self {
        let edge = ((all.high - all.low).max_element() / MAX_CELLS).max(CELL_M);
        Self { obstacles, edge, found: HashMap::new() }
    }

    /// Boxes in `bounds`, apart from each other along x or z, that hold all obstacles in it, of those cells that are asked for. Neighbors
    /// along x are one box where that has less volume when each box is larger by `around`, m.
    pub(super) fn within(
        &mut self,
        bounds: &Bounds,
        around: DVec3,
        wanted: impl Fn(&Bounds) -> bool,
    ) -> Vec<Bounds> {
        let cell = |at: DVec3| (at / self.edge).floor().to_array().map(|x| x as i64);
        let (first, last) = (cell(bounds.low), cell(bounds.high));
        let volume = |b: &Bounds| (b.high - b.low + around).element_product();
        let mut boxes: Vec<Bounds> = Vec::new();
        for z in first[2]..=last[2] {
            let mut run: Option<Bounds> = None;
            for x in first[0]..=last[0] {
                let in_cell =
                    |y| self.of_cell([x, y, z]).and_then(|place| place.common(bounds)).filter(&wanted);
                let place = (first[1]..=last[1]).filter_map(in_cell).reduce(|a, b| a.union(&b));
                let joined = match (&run, &place) {
                    (Some(run), Some(place)) => {
                        Some(run.union(place)).filter(|both| volume(both) <= volume(run) + volume(place))
                    }
                    _ => None,
                };
                if joined.is_none() {
                    boxes.extend(run.take());
                }
                run = joined.or(place);
            }
            boxes.extend(run);
        }
        boxes
    }

    /// Bounds of the obstacles in a cell.
    fn of_cell(&mut self, cell: [i64; 3]) -> Option<Bounds> {
        let (edge, obstacles) = (self.edge, self.obstacles);
        *self.found.entry(cell).or_insert_with(|| {
            let low = DVec3::from_array(cell.map(|k| k as f64)) * edge;
            let whole = Bounds { low, high: low + edge };
            let [low, high] = [low - SLACK_M, low + edge + SLACK_M]
                .map(|corner| (corner - obstacles.origin).as_vec3().to_array());
            let [low, high] = bvh_bounds_within(obstacles.nodes, obstacles.triangles, low, high)?
                .map(|corner| Vec3::from(corner).as_dvec3() + obstacles.origin);
            Bounds { low: low - SLACK_M, high: high + SLACK_M }.common(&whole)
        })
    }
}
