//! Map of the water that stands on the ground, and of its depth.

use std::sync::Arc;

use downpour_math::ops;
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::puddle_water::PUDDLE_WATER_MIN_DEPTH;
use glam::{DVec2, Vec2, Vec3};
use rayon::prelude::*;

use super::drainage::Drainage;
use super::fill::{Basins, FillLimits, Filling, Hollows, basins, fill, levels};
use super::flow::{FlowMap, flow_map};
use super::relief::Relief;
use super::running::{Catchments, Running};
use crate::data::SceneData;

/// Land beside water tells how far it lies over the water's level up to this far, m: the shore runs between the cells.
const SHORE_M: f32 = 5.0e-3;

/// Cells around the water that know its level.
const SHORE_CELLS: u32 = 2;

/// Depth in the map of what is certainly land, m.
const LAND_M: f32 = -1.0;

/// Height over the ground from which rays look up for a roof, m.
const OVER_GROUND_M: f32 = 0.02;

/// What lies no farther than this above the water or below its ground is in the puddle, m.
const ABOVE_WATER_M: f32 = 0.03;

/// A rectangle of the ground, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Its middle, m; the ground is looked for from `reach` over it to `reach` under it.
    pub middle: Vec3,
    /// Edges, m.
    pub size: Vec2,
    /// Turn about the vertical axis, rad, from +X toward +Z.
    pub turn: f32,
    /// Largest height over the middle, and depth under it, at which the ground is looked for, m.
    pub reach: f32,
}

/// Water at a place of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WaterAt {
    /// Height of the model's ground over the map's middle, m.
    pub(super) ground: f32,
    /// Height of the surface over the map's middle, m.
    pub(super) level: f32,
    /// m.
    pub(super) depth: f32,
    /// Fraction of the rain that arrives.
    pub(super) open: f32,
    /// Velocity along x and z, m/s.
    pub(super) velocity: Vec2,
}

/// Depths of water over a rectangle of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct PuddleMap {
    /// The rectangle.
    pub ground: Ground,
    /// Columns and rows.
    pub size: [usize; 2],
    /// For each cell: height of the ground over the middle (m), rise of the water's surface over that (m), depth (m, below
    /// 0 on land), fraction of the rain that arrives.
    pub cells: Arc<[[f32; 4]]>,
    /// Velocities of the water; `None` where all of it stands.
    pub flow: Option<FlowMap>,
}

impl Ground {
    /// Half the edges of the box along x and z that the rectangle is in, m.
    pub(super) fn extent(&self) -> DVec2 {
        let half = 0.5 * self.size.as_dvec2();
        let turn = turned(self.turn).as_dvec2().abs();
        DVec2::new(half.x * turn.x + half.y * turn.y, half.x * turn.y + half.y * turn.x)
    }

    /// True if the boxes along x and z overlap that two rectangles are in.
    pub(super) fn may_overlap(&self, other: &Self) -> bool {
        let middle = |ground: &Self| DVec2::new(f64::from(ground.middle.x), f64::from(ground.middle.z));
        (middle(self) - middle(other)).abs().cmplt(self.extent() + other.extent()).all()
    }

    /// The position over a part of the rectangle, 0 to 1 along its edges, at its middle's height.
    pub(super) fn position(&self, u: f32, v: f32) -> Vec3 {
        let turn = turned(self.turn);
        let offset = turn.rotate(Vec2::new(u - 0.5, v - 0.5) * self.size);
        self.middle + Vec3::new(offset.x, 0.0, offset.y)
    }

    /// Height over the middle of the highest surface within reach, and the fraction of the rain that arrives there; not a
    /// number where there is none.
    fn measure(&self, scene: &SceneData, size: [usize; 2]) -> (Vec<f32>, Vec<f32>) {
        let [columns, rows] = size;
        let cell = |i: usize| {
            let part = |at: usize, count: usize| (at as f32 + 0.5) / count as f32;
            let top =
                self.position(part(i % columns, columns), part(i / columns, rows)) + Vec3::Y * self.reach;
            let down = scene.surface_hit(top, Vec3::NEG_Y, 0.0, 2.0 * self.reach);
            let Some(hit) = down else { return (f32::NAN, 0.0) };
            let height = self.reach - hit.distance;
            let over = Vec3::new(top.x, self.middle.y + height + OVER_GROUND_M, top.z);
            let roofed = scene.surface_blocker(over, Vec3::Y, 0.0, BVH_FAR).is_some();
            (height, if roofed { 0.0 } else { 1.0 })
        };
        (0..columns * rows).into_par_iter().map(cell).unzip()
    }
}

/// The ground within a rectangle, its hollows, and where rain gets to.
#[derive(Clone, Debug, PartialEq)]
pub struct PuddleGround {
    ground: Ground,
    size: [usize; 2],
    /// Heights of the model over the middle, m; not a number where there is none.
    model: Vec<f32>,
    /// Fraction of the rain that arrives at each cell.
    open: Vec<f32>,
    /// Heights with the relief, m.
    uneven: Vec<f32>,
    drainage: Drainage,
    basins: Basins,
}

impl PuddleGround {
    /// The ground of a scene. `relief` is what it has beside its model.
    #[must_use]
    pub fn new(scene: &SceneData, ground: &Ground, size: [usize; 2], relief: &Relief) -> Self {
        let (model, open) = ground.measure(scene, size);
        let [columns, rows] = size;
        let uneven: Vec<f32> = (0..columns * rows)
            .into_par_iter()
            .map(|i| {
                let part = |at: usize, count: usize| (at as f32 + 0.5) / count as f32;
                let position = ground.position(part(i % columns, columns), part(i / columns, rows));
                model[i] + relief.height(Vec2::new(position.x, position.z))
            })
            .collect();
        let hollows = Hollows { size, ground: &uneven, open: &open };
        let drainage = Drainage::new(&hollows);
        let basins = basins(&hollows, &drainage);
        Self { ground: *ground, size, model, open, uneven, drainage, basins }
    }

    /// Water in its hollows.
    #[must_use]
    pub fn filled(&self, filling: &Filling, limits: &FillLimits) -> PuddleMap {
        self.with_levels(&self.levels(filling, limits), None)
    }

    /// The level, m, of the water in each hollow; `None` where it is too shallow to stand.
    #[must_use]
    pub fn levels(&self, filling: &Filling, limits: &FillLimits) -> Vec<Option<f32>> {
        levels(&self.basins.basins, filling, limits)
    }

    /// The water that runs with a runoff in m/s where hollows have filled to some [`PuddleGround::levels`]; `None` if none does.
    #[must_use]
    pub fn running(&self, filled: &[Option<f32>], runoff_m_s: f32, limits: &FillLimits) -> Option<Running> {
        let [columns, rows] = self.size;
        let catchments = Catchments {
            hollows: Hollows { size: self.size, ground: &self.uneven, open: &self.open },
            drainage: &self.drainage,
            basins: &self.basins,
            cell_m: self.ground.size / Vec2::new(columns as f32, rows as f32),
        };
        catchments.running(filled, runoff_m_s, limits)
    }

    /// Water up to [`PuddleGround::levels`], and water that runs.
    #[must_use]
    pub fn with_levels(&self, filled: &[Option<f32>], running: Option<&Running>) -> PuddleMap {
        let Self { ground, size, model, open, uneven, basins, .. } = self;
        let [columns, rows] = *size;
        let mut levels = fill(columns * rows, &basins.basins, filled);
        if let Some(running) = running {
            let deeper = |(level, &runs): (&mut Option<f32>, &Option<f32>)| *level = runs.or(*level);
            levels.iter_mut().zip(&running.levels).for_each(deeper);
        }
        // Who is beside water knows its level too, so that the shore runs between the cells.
        let wet: Vec<bool> = levels.iter().map(Option::is_some).collect();
        for _ in 0..SHORE_CELLS {
            levels = spread(&levels, *size);
        }
        let cell = |i: usize| {
            let height = if model[i].is_finite() { model[i] } else { -2.0 * ground.reach };
            let Some(level) = levels[i].filter(|_| uneven[i].is_finite()) else {
                return [height, 0.0, LAND_M, open[i]];
            };
            let depth = level - uneven[i];
            // Land that is lower than water beside it is behind a shore.
            let depth = if wet[i] { depth } else { depth.clamp(-SHORE_M, -0.1 * PUDDLE_WATER_MIN_DEPTH) };
            [height, (level - model[i]).max(0.0), depth, open[i]]
        };
        let cells: Vec<[f32; 4]> = (0..columns * rows).into_par_iter().map(cell).collect();
        let flow = running.map(|running| flow_map(ground, *size, &levels, &running.velocities));
        PuddleMap { ground: *ground, size: *size, cells: cells.into(), flow }
    }
}

impl PuddleMap {
    /// Water in the hollows of a scene, filled to a fraction of their depth: [`PuddleGround::filled`]. `deepest` and `least`, m, are
    /// those of [`FillLimits`].
    #[must_use]
    pub fn found(
        scene: &SceneData,
        ground: &Ground,
        size: [usize; 2],
        relief: &Relief,
        [fraction, deepest, least]: [f32; 3],
    ) -> Self {
        let ground = PuddleGround::new(scene, ground, size, relief);
        ground.filled(&Filling::Fraction(fraction), &FillLimits { deepest, least })
    }

    /// Water as deep as is painted (m, row by row), on the surface of the model. A number that is not above 0 is land.
    ///
    /// # Panics
    /// If there are not as many depths as cells.
    #[must_use]
    pub fn painted(scene: &SceneData, ground: &Ground, size: [usize; 2], depths: &[f32]) -> Self {
        assert_eq!(depths.len(), size[0] * size[1], "as many depths as cells");
        let (model, open) = ground.measure(scene, size);
        let cell = |((&height, &open), &depth): ((&f32, &f32), &f32)| {
            if height.is_finite() {
                [height, 0.0, if depth > 0.0 { depth } else { -0.1 * PUDDLE_WATER_MIN_DEPTH }, open]
            } else {
                [-2.0 * ground.reach, 0.0, LAND_M, 0.0]
            }
        };
        let cells = model.iter().zip(&open).zip(depths).map(cell).collect();
        Self { ground: *ground, size, cells, flow: None }
    }

    /// Where a position is, m from the map's corner along its axes; `turn` is the map's.
    pub(super) fn place(&self, turn: Vec2, position: Vec3) -> Vec2 {
        let away = position - self.ground.middle;
        let away = Vec2::new(away.x, away.z);
        Vec2::new(away.dot(turn), away.dot(turn.perp())) + 0.5 * self.ground.size
    }

    /// The water at a place, m from the map's corner along its axes; `None` on land and beyond the map.
    pub(super) fn water_at(&self, place: Vec2) -> Option<WaterAt> {
        let [columns, rows] = self.size;
        let part = place / self.ground.size;
        let cell = |part: f32, count: usize| {
            (0.0..1.0).contains(&part).then(|| ((part * count as f32) as usize).min(count - 1))
        };
        let index = cell(part.y, rows)? * columns + cell(part.x, columns)?;
        let [ground, rise, depth, open] = *self.cells.get(index)?;
        let velocity = self.flow.as_ref().map_or(Vec2::ZERO, |flow| flow.velocity(index));
        let water = WaterAt { ground, level: ground + rise, depth, open, velocity };
        (depth >= PUDDLE_WATER_MIN_DEPTH).then_some(water)
    }

    /// The water above the ground at a position relative to the maps' origin, m, and the height of its surface over that; `None` on land, and
    /// above or below the puddle.
    pub(super) fn water_over(&self, at: Vec3) -> Option<(WaterAt, f32)> {
        let water = self.water_at(self.place(turned(self.ground.turn), at))?;
        let deep = self.ground.middle.y + water.level - at.y;
        (-ABOVE_WATER_M..water.depth + ABOVE_WATER_M).contains(&deep).then_some((water, deep))
    }

    /// True if a position on the ground, relative to the maps' origin, m, is in the puddle's water.
    #[must_use]
    pub fn is_in_water(&self, at: Vec3) -> bool {
        self.water_over(at).is_some()
    }

    /// Area under water, m^2.
    #[must_use]
    pub fn area_m2(&self) -> f32 {
        let wet = self.cells.iter().filter(|cell| cell[2] >= PUDDLE_WATER_MIN_DEPTH).count();
        wet as f32 * self.cell_m2()
    }

    /// Volume of the water, m^3.
    #[must_use]
    pub fn volume_m3(&self) -> f32 {
        self.cells.iter().map(|cell| cell[2].max(0.0)).sum::<f32>() * self.cell_m2()
    }

    /// Maximum depth, m.
    #[must_use]
    pub fn deepest_m(&self) -> f32 {
        self.cells.iter().map(|cell| cell[2]).fold(0.0, f32::max)
    }

    fn cell_m2(&self) -> f32 {
        self.ground.size.x * self.ground.size.y / self.cells.len().max(1) as f32
    }
}

/// The direction of an angle, the same bits on any platform.
pub(super) fn turned(angle: f32) -> Vec2 {
    Vec2::new(ops::cos(angle), ops::sin(angle))
}

/// Levels with those of their neighbors: the highest of them where there is none.
fn spread(levels: &[Option<f32>], [columns, rows]: [usize; 2]) -> Vec<Option<f32>> {
    let at = |x: isize, y: isize| {
        let inside = x >= 0 && y >= 0 && x < columns as isize && y < rows as isize;
        inside.then(|| levels[y as usize * columns + x as usize]).flatten()
    };
    let cell = |i: usize| {
        levels[i].or_else(|| {
            let (x, y) = ((i % columns) as isize, (i / columns) as isize);
            let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
            around.filter_map(|(dx, dy)| at(x + dx, y + dy)).reduce(f32::max)
        })
    };
    (0..columns * rows).into_par_iter().map(cell).collect()
}
