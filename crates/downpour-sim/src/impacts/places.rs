//! Parts of space where obstacles are.

use std::collections::HashMap;

use downpour_bvh::{BvhTriangle, bvh_bounds_within};
use glam::{DVec3, Vec3};

use crate::shelter::Obstacles;
use crate::view::Bounds;

/// Least edge of a cell, m.
const CELL_M: f64 = 2.0;

/// Maximum number of cells along an axis of a box: larger boxes have cells of twice the edge, or of four times.
const MAX_CELLS: f64 = 32.0;

/// Distance by which rounding may put a point beside a surface, m.
const SLACK_M: f64 = 0.01;

/// Bounds of the obstacles in each cell of lattices, found when they are asked for.
pub(super) struct Places<'a> {
    obstacles: &'a Obstacles<'a>,
    /// Least vertical component of the normals of the surfaces that are asked for, on either side.
    least_level: f32,
    /// By the doublings of the least edge, and the cell.
    found: HashMap<(i32, [i64; 3]), Option<Bounds>>,
}

/// Edge of a cell after some doublings, m.
fn edge(cells: i32) -> f64 {
    CELL_M * f64::from(1 << cells)
}

/// True if the normal of a triangle has a vertical component of `least` or more, on either side.
fn is_level(triangle: &BvhTriangle, least: f32) -> bool {
    let normal = Vec3::from(triangle.edge_1).cross(triangle.edge_2.into());
    // A triangle of no area has no normal.
    normal.y.abs() >= least * normal.length()
}

impl<'a> Places<'a> {
    /// Places of surfaces whose normal has a vertical component of `least_level` or more, on either side.
    pub(super) fn new(obstacles: &'a Obstacles<'a>, least_level: f32) -> Self {
        Self { obstacles, least_level, found: HashMap::new() }
    }

    /// Cells for boxes that are within `all`, as doublings of the least edge.
    pub(super) fn cells(all: &Bounds) -> i32 {
        let extent = (all.high - all.low).max_element();
        // Boxes are 2e7 m at most.
        (0..20).find(|&cells| edge(cells) * MAX_CELLS >= extent).unwrap_or(20)
    }

    /// Boxes in `bounds`, apart from each other, that hold all obstacles in it, of those cells of a size that are asked for. Neighbors
    /// along y or x are one box where that has less volume when each box is larger by `around`, m.
    pub(super) fn within(
        &mut self,
        cells: i32,
        bounds: &Bounds,
        around: DVec3,
        wanted: impl Fn(&Bounds) -> bool,
    ) -> Vec<Bounds> {
        let edge = edge(cells);
        let cell = |at: DVec3| (at / edge).floor().to_array().map(|x| x as i64);
        let (first, last) = (cell(bounds.low), cell(bounds.high));
        let volume = |b: &Bounds| (b.high - b.low + around).element_product();
        let joined = |a: &Bounds, b: &Bounds| {
            let both = a.union(b);
            (volume(&both) <= volume(a) + volume(b)).then_some(both)
        };
        let mut boxes: Vec<Bounds> = Vec::new();
        for z in first[2]..=last[2] {
            // The boxes of the last column; one alone may go on.
            let mut before: Vec<Bounds> = Vec::new();
            for x in first[0]..=last[0] {
                let mut column: Vec<Bounds> = Vec::new();
                for y in first[1]..=last[1] {
                    let place = self.of_cell(cells, [x, y, z]).and_then(|place| place.common(bounds));
                    let Some(place) = place.filter(&wanted) else { continue };
                    match column.last_mut().and_then(|last| Some((joined(last, &place)?, last))) {
                        Some((both, last)) => *last = both,
                        None => column.push(place),
                    }
                }
                if let ([last], [place]) = (&before[..], &column[..])
                    && let Some(both) = joined(last, place)
                {
                    before = vec![both];
                } else {
                    boxes.append(&mut before);
                    before = column;
                }
            }
            boxes.append(&mut before);
        }
        boxes
    }

    /// Bounds of the obstacles in a cell.
    fn of_cell(&mut self, cells: i32, cell: [i64; 3]) -> Option<Bounds> {
        let (obstacles, least) = (self.obstacles, self.least_level);
        let edge = edge(cells);
        *self.found.entry((cells, cell)).or_insert_with(|| {
            let low = DVec3::from_array(cell.map(|k| k as f64)) * edge;
            let whole = Bounds { low, high: low + edge };
            let [low, high] = [low - SLACK_M, low + edge + SLACK_M]
                .map(|corner| (corner - obstacles.origin).as_vec3().to_array());
            let level = |triangle: &BvhTriangle| is_level(triangle, least);
            let wanted: Option<&dyn Fn(&BvhTriangle) -> bool> = if least > 0.0 { Some(&level) } else { None };
            let [low, high] = bvh_bounds_within(obstacles.nodes, obstacles.triangles, low, high, wanted)?
                .map(|corner| Vec3::from(corner).as_dvec3() + obstacles.origin);
            Bounds { low: low - SLACK_M, high: high + SLACK_M }.common(&whole)
        })
    }
}
