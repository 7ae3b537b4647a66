//! Area of a puddle's water near the eye, from some of the cells of its map.

use downpour_shaders::render::puddle_water::PUDDLE_WATER_MIN_DEPTH;
use glam::Vec2;

use super::map::PuddleMap;
use super::rings::REACH_M;

/// Cells of a puddle's map that are looked at, at most, along an edge.
const AREA_SAMPLES: usize = 32;

/// Points of a map that are under water: some of them, evenly spread.
#[derive(Debug)]
pub(super) struct WetSamples {
    /// m from the origin of the maps.
    points: Vec<Vec2>,
    /// Area for which each stands, m^2.
    area: f64,
}

impl WetSamples {
    pub(super) fn new(map: &PuddleMap) -> Self {
        let [columns, rows] = map.size;
        let [x_step, y_step] = map.size.map(|count| count.div_ceil(AREA_SAMPLES).max(1));
        let mut all = 0u32;
        let mut points = Vec::new();
        for y in (y_step / 2..rows).step_by(y_step) {
            for x in (x_step / 2..columns).step_by(x_step) {
                all += 1;
                if map.cells[y * columns + x][2] < PUDDLE_WATER_MIN_DEPTH {
                    continue;
                }
                let part = |at: usize, count: usize| (at as f32 + 0.5) / count as f32;
                let at = map.ground.position(part(x, columns), part(y, rows));
                points.push(Vec2::new(at.x, at.z));
            }
        }
        let area = f64::from(map.ground.size.x * map.ground.size.y) / f64::from(all.max(1));
        Self { points, area }
    }

    /// Area of the water within reach of an eye, m^2.
    pub(super) fn area_near(&self, middle: Vec2) -> f64 {
        let is_near = |at: &&Vec2| at.distance_squared(middle) < (REACH_M * REACH_M) as f32;
        self.area * self.points.iter().filter(is_near).count() as f64
    }
}
