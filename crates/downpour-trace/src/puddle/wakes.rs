//! Waves of what moves through puddles: wheels, feet, boats.
//!
//! A puddle that something moves through gets a lattice of its own, whose land is the puddle's: waves run to the shores and back.
//! At each step the parts of moving triangles that are below the water are found, and what hangs together is a body: round, as large as it
//! is, and as deep. A body that is slower than waves presses the water down where it is and lets it rise where it was
//! ([`Puddle::displace`]). From a faster one water cannot get away by waves: it is thrown to both sides, and its track is
//! empty until waves fill it. The part that is thrown is `1 - c / v`, with the speeds of the longest waves and of the body; a body never
//! moves more water than there is before it.
//!
//! Errors: waves are those of low amplitude, of one depth, the median of the puddle's; a wave as high as the water is deep would break. What is
//! thrown lands beside the track, without flight and without drops in the air. Shores stay those of the time when the puddle was first
//! moved through.

use std::collections::BTreeMap;
use std::sync::Arc;

use downpour_lattice::puddle::{Puddle, PuddleForm, PuddleOptions, Wake};
use downpour_shaders::render::puddle_water::PUDDLE_WATER_MIN_DEPTH;
use glam::{Vec2, Vec3};

use super::bodies::Region;
use super::map::{PuddleMap, turned};
use super::{PuddleError, PuddleLook};

/// Length of a step, s.
const STEP_S: f64 = 0.01;

/// Waves older than this have gone, s: friction on the ground takes a tenth of their height in each second and shores most of the rest.
const MEMORY_S: f64 = 8.0;

/// Edge of a cell, at least, m: waves of wheels are longer than 0.1 m.
const CELL_M: f32 = 0.025;

/// Most cells of a lattice; cells of larger puddles are larger.
const MAX_CELLS: f32 = 131_072.0;

/// Fewest cells along an edge of a lattice, and most.
const EDGE_CELLS: [usize; 2] = [64, 4096];

/// Farthest that a body moves in a step, m: what is farther away is another body.
const MAX_MOVE_M: f32 = 0.75;

/// A body that moves less than this in a step stands still, m.
const MIN_MOVE_M: f32 = 1.0e-4;

/// Integral over its diameter of the height of a footprint, (1 - q^2)^2, in radii: what one that moves by a radius leaves of its depth.
const FOOTPRINT: f32 = 16.0 / 15.0;

/// Distance between two footprints of a body in its track, in radii.
const SPACING: f32 = 0.5;

/// Where thrown water lands beside the track, in radii from its middle.
const ASIDE: f32 = 2.0;

/// Most points of a triangle along each of its edges that are asked whether they are below the water.
const MAX_POINTS: u32 = 64;

/// Cells on each side over which the square of the slope is averaged.
const AROUND: usize = 4;

/// Waves in one puddle, as rows of the scene's table.
#[derive(Clone, Debug, PartialEq)]
pub struct WakeRows {
    /// Number of the puddle.
    pub puddle: usize,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Edge of a cell, m; the first begins at the corner of the puddle's map.
    pub cell_m: f32,
    /// For each cell the slopes along x and z, the mean of the square of the slope around it, and 0.
    pub slopes: Vec<[f32; 4]>,
}

/// Something that is in the water, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Body {
    /// Middle, m from the corner of the map along its axes.
    at: Vec2,
    /// m.
    radius: f32,
    /// Depth to which it reaches, m.
    draft: f32,
}

/// The water of a puddle that something has moved through.
#[derive(Debug)]
struct Basin {
    water: Puddle,
    bodies: Vec<Body>,
    is_level: bool,
}

/// Where the water of a puddle is.
#[derive(Clone, Debug)]
struct WaterRegion {
    /// Cells of the map of which that was found.
    cells: Arc<[[f32; 4]]>,
    /// `None` without water.
    region: Option<Region>,
}

/// Waves of what moves through the puddles of a scene.
#[derive(Debug)]
pub struct Wakes {
    form: PuddleForm,
    basins: BTreeMap<usize, Basin>,
    /// Of each puddle.
    regions: Vec<WaterRegion>,
    /// Number of the last step, counted from time 0.
    step: Option<i64>,
}

impl Wakes {
    /// Level water, with waves of a law.
    #[must_use]
    pub fn new(form: PuddleForm) -> Self {
        Self { form, basins: BTreeMap::new(), regions: Vec::new(), step: None }
    }

    /// Steps the water to a time in seconds; `moving` finds the triangles of what moves at a time that may reach into a region, relative
    /// to what the maps are relative to, m. A time earlier than the last one, or much later, begins anew, so long before that waves are
    /// as many as they will be.
    ///
    /// # Errors
    /// [`PuddleError`] if a lattice refuses.
    pub fn advance(
        &mut self,
        time_s: f64,
        puddles: &[(PuddleMap, PuddleLook)],
        moving: impl Fn(f64, &Region) -> Vec<[Vec3; 3]>,
    ) -> Result<(), PuddleError> {
        let until = step_of(time_s);
        let anew = step_of(time_s - MEMORY_S);
        let mut step = match self.step {
            Some(step) if (anew..=until).contains(&step) => step,
            _ => {
                self.basins.clear();
                anew
            }
        };
        let before = std::mem::take(&mut self.regions);
        self.regions = puddles
            .iter()
            .enumerate()
            .map(|(k, (map, _))| match before.get(k) {
                Some(known) if Arc::ptr_eq(&known.cells, &map.cells) => known.clone(),
                _ => WaterRegion { cells: Arc::clone(&map.cells), region: region(map) },
            })
            .collect();
        let regions: Vec<Option<Region>> = self.regions.iter().map(|known| known.region).collect();
        let Some(all) = regions.iter().flatten().copied().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
        else {
            self.step = Some(until);
            return Ok(());
        };
        while step < until {
            step += 1;
            let triangles = moving(step as f64 * STEP_S, &all);
            for (number, ((map, _), region)) in puddles.iter().zip(&regions).enumerate() {
                let bodies = region.map_or_else(Vec::new, |region| bodies(map, &region, &triangles));
                if !bodies.is_empty() && !self.basins.contains_key(&number) {
                    self.basins.insert(number, Basin::new(map, self.form)?);
                }
                if let Some(basin) = self.basins.get_mut(&number) {
                    basin.step(bodies)?;
                }
            }
        }
        self.step = Some(until);
        Ok(())
    }

    /// The waves of each puddle whose water is not level.
    #[must_use]
    pub fn rows(&self, puddles: &[(PuddleMap, PuddleLook)]) -> Vec<WakeRows> {
        let moved = self.basins.iter().filter(|(_, basin)| !basin.is_level);
        moved.filter_map(|(&puddle, basin)| Some(basin.rows(puddle, &puddles.get(puddle)?.0))).collect()
    }
}

impl Basin {
    /// Level water of a map.
    fn new(map: &PuddleMap, form: PuddleForm) -> Result<Self, PuddleError> {
        let edges = map.ground.size;
        let cell = cell_of(map);
        let [columns, lines] = [edges.x, edges.y]
            .map(|edge| ((edge / cell).ceil() as usize).clamp(EDGE_CELLS[0], EDGE_CELLS[1]));
        let place = |i: usize| Vec2::new((i % columns) as f32 + 0.5, (i / columns) as f32 + 0.5) * cell;
        let depths: Vec<Option<f32>> =
            (0..columns * lines).map(|i| map.water_at(place(i)).map(|water| water.depth)).collect();
        let mut wet: Vec<f32> = depths.iter().copied().flatten().collect();
        wet.sort_unstable_by(f32::total_cmp);
        let depth = wet.get(wet.len() / 2).copied().unwrap_or(PUDDLE_WATER_MIN_DEPTH);
        let land: Vec<bool> = depths.iter().map(Option::is_none).collect();
        let options = PuddleOptions {
            form,
            size: [columns as u32, lines as u32],
            cell_m: cell,
            depth_m: depth,
            ..PuddleOptions::default()
        };
        Ok(Self { water: Puddle::with_land(&options, &land)?, bodies: Vec::new(), is_level: true })
    }

    /// Moves the bodies to where they are at the end of a step, and the water.
    fn step(&mut self, bodies: Vec<Body>) -> Result<(), PuddleError> {
        let mut before = std::mem::take(&mut self.bodies);
        // Waves before this step say how much water is in a body's way.
        let heights: Vec<f32> = bodies.iter().map(|body| self.water.height_at(body.at.to_array())).collect();
        for (body, height) in bodies.iter().zip(heights) {
            let way = |(_, other): &(usize, &Body)| body.at.distance(other.at);
            let nearest = before.iter().enumerate().min_by(|a, b| way(a).total_cmp(&way(b)));
            if let Some((number, from)) = nearest.map(|(number, other)| (number, other.at))
                && from.distance(body.at) < MAX_MOVE_M
            {
                before.swap_remove(number);
                self.displace(body, from, height)?;
            }
        }
        self.bodies = bodies;
        if !self.is_level {
            self.water.step(STEP_S as f32)?;
        }
        Ok(())
    }

    /// Moves a body from a position to its own, where the water has a height over its level, m.
    fn displace(&mut self, body: &Body, from: Vec2, height: f32) -> Result<(), PuddleError> {
        let options = self.water.options();
        let (cell, depth) = (options.cell_m, options.depth_m);
        let way = body.at - from;
        let distance = way.length();
        if distance < MIN_MOVE_M {
            return Ok(());
        }
        self.is_level = false;
        let radius = body.radius.max(2.001 * cell);
        // With what waves have taken away or brought.
        let draft = body.draft.min(depth + height).clamp(0.0, depth);
        let speed = distance / STEP_S as f32;
        // Of the longest waves.
        let waves = (options.water.gravity as f32 * depth).sqrt();
        let thrown = (1.0 - waves / speed).max(0.0);
        let count = (distance / (SPACING * radius)).ceil().max(1.0);
        let moved = distance / count;
        let across = way.perp() / distance * (ASIDE * radius);
        // Footprints that overlap make the track as deep as the body reaches.
        let carved = draft * (moved / (FOOTPRINT * radius)).min(1.0);
        for k in 0..count as u32 {
            let [start, end] = [k, k + 1].map(|k| from + way * (k as f32 / count));
            let mut displace = |from: Vec2, to: Vec2, draft: f32| {
                let wake = Wake {
                    from_m: from.to_array(),
                    to_m: to.to_array(),
                    radius_m: radius,
                    draft_m: draft.min(depth),
                };
                self.water.displace(&wake)
            };
            displace(start, end, draft * (1.0 - thrown))?;
            for side in [across, -across] {
                displace(end + side, end, 0.5 * carved * thrown)?;
            }
        }
        Ok(())
    }

    /// The waves as rows.
    fn rows(&self, puddle: usize, map: &PuddleMap) -> WakeRows {
        let options = self.water.options();
        let size = options.size.map(|n| n as usize);
        let turn = turned(map.ground.turn);
        let mut slopes = self.water.slopes();
        let squares = smoothed(&slopes.iter().map(|slope| slope[2]).collect::<Vec<f32>>(), size);
        for (slope, square) in slopes.iter_mut().zip(squares) {
            let world = turn.rotate(Vec2::new(slope[0], slope[1]));
            *slope = [world.x, world.y, square, 0.0];
        }
        WakeRows { puddle, size, cell_m: options.cell_m, slopes }
    }
}

/// Edge of the cells of a puddle's lattice, m.
fn cell_of(map: &PuddleMap) -> f32 {
    (map.ground.size.x * map.ground.size.y / MAX_CELLS).sqrt().max(CELL_M)
}

/// The box in which a puddle's water is; `None` without water.
fn region(map: &PuddleMap) -> Option<Region> {
    let reach = map.ground.extent().as_vec2();
    let wet = map.cells.iter().filter(|cell| cell[2] >= PUDDLE_WATER_MIN_DEPTH);
    let heights = wet.map(|cell| [cell[0] - cell[2], cell[0] + cell[1]]);
    let [low, high] = heights.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
    let middle = map.ground.middle;
    Some([middle + Vec3::new(-reach.x, low, -reach.y), middle + Vec3::new(reach.x, high, reach.y)])
}

/// What of some triangles is below the water of a puddle whose water is in a region, in the order of the cells of its map.
fn bodies(map: &PuddleMap, region: &Region, triangles: &[[Vec3; 3]]) -> Vec<Body> {
    let cell = cell_of(map);
    let turn = turned(map.ground.turn);
    let columns = (map.ground.size.x / cell).ceil() as u32;
    let mut drafts: BTreeMap<[u32; 2], f32> = BTreeMap::new();
    let mut ask = |point: Vec3| {
        let place = map.place(turn, point);
        let Some(water) = map.water_at(place) else { return };
        // What stands on the model's ground stands on that of the water: relief may be finer than the model.
        let draft = water.depth - (point.y - map.ground.middle.y - water.ground).max(0.0);
        if draft > 0.0 {
            let at = (place / cell).as_uvec2();
            let deepest = drafts.entry([at.y, at.x.min(columns)]).or_default();
            *deepest = deepest.max(draft);
        }
    };
    for corners in triangles {
        let (low, high) =
            corners[1..].iter().fold((corners[0], corners[0]), |(a, b), &at| (a.min(at), b.max(at)));
        if !(low.cmple(region[1]).all() && high.cmpge(region[0]).all()) {
            continue;
        }
        let [a, b, c] = *corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let count = ((2.0 * longest / cell).ceil() as u32).clamp(1, MAX_POINTS);
        for i in 0..=count {
            for j in 0..=count - i {
                let [u, v] = [i, j].map(|k| k as f32 / count as f32);
                ask(a + (b - a) * u + (c - a) * v);
            }
        }
    }
    let mut found = Vec::new();
    while let Some((first, _)) = drafts.first_key_value() {
        let mut rest = vec![*first];
        let (mut sum, mut area, mut volume) = (Vec2::ZERO, 0.0, 0.0);
        while let Some([y, x]) = rest.pop() {
            let Some(draft) = drafts.remove(&[y, x]) else { continue };
            sum += Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            area += 1.0;
            volume += draft;
            let near = |at: u32| [at.wrapping_sub(1), at, at + 1];
            rest.extend(near(y).into_iter().flat_map(|y| near(x).map(|x| [y, x])));
        }
        found.push(Body {
            at: sum * (cell / area),
            radius: cell * (area / std::f32::consts::PI).sqrt(),
            draft: volume / area,
        });
    }
    found
}

/// Means over the cells around each.
fn smoothed(values: &[f32], [columns, lines]: [usize; 2]) -> Vec<f32> {
    let along = averaged(values, columns, 1);
    averaged(&along, lines, columns)
}

/// Means along one axis, of `count` cells that are `stride` values apart.
fn averaged(values: &[f32], count: usize, stride: usize) -> Vec<f32> {
    let mean = |i: usize| {
        let at = i / stride % count;
        let near = at.saturating_sub(AROUND)..(at + AROUND + 1).min(count);
        let number = near.len() as f32;
        near.map(|k| values[i - at * stride + k * stride]).sum::<f32>() / number
    };
    (0..values.len()).map(mean).collect()
}

/// Number of the step that ends at or before a time, from time 0.
fn step_of(time_s: f64) -> i64 {
    (time_s / STEP_S + 1.0e-6).floor() as i64
}
