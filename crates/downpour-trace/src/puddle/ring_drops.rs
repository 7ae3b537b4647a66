//! The drops that come through the water of puddles near the eye, found a span of time and a square of the world at a time and kept from
//! picture to picture. Those of the next span are looked for beside the pictures before it.

use std::collections::BTreeMap;
use std::sync::Arc;

use downpour_math::ops::f64 as ops;
use downpour_shaders::render::puddle_rings::PUDDLE_RINGS_LIFE;
use downpour_shaders::render::puddle_water::PUDDLE_WATER_MIN_DEPTH;
use downpour_sim::field::RainField;
use downpour_sim::impacts::Crossing;
use glam::{DVec2, DVec3, Vec2};
use rayon::prelude::*;

use super::map::{PuddleMap, turned};
use super::rings::{REACH_M, RainOnWater};
use super::wet_samples::WetSamples;
use super::{PuddleError, PuddleLook};
use crate::background::Background;

/// Span of time whose drops are found together, s: whole sixteenths of a second.
const CHUNK_S: f64 = 0.25;

/// Edge of the squares of the world whose drops are found together, m.
const BLOCK_M: f64 = 4.0;

/// The wind carries drops aside by less than this between the height of a map's middle and the surface, m.
const ASIDE_M: f64 = 0.25;

/// Drops that are worth a thread of their own.
const DROPS_TOGETHER: usize = 256;

/// Cells of a row of a map that are bounded together.
const CELLS_BOUNDED: usize = 16;

/// Pictures among which the search for the drops of the next span of time is divided where it is not known how many there are before it.
const SHARES: usize = 6;

/// Puddle, square of the world and span of time whose drops are found together.
type Block = (usize, [i64; 2], i64);

/// Two corners of a rectangle in the world, m.
type Corners = [DVec2; 2];

/// Drops that come through the plane at the height of a map's middle.
#[derive(Debug)]
struct Found {
    /// Where they were looked for.
    part: Corners,
    crossings: Vec<Crossing>,
    /// Those of them that meet the water of a map.
    impacts: Vec<Impact>,
    /// The cells of that map.
    cells: Arc<[[f32; 4]]>,
}

/// A drop that meets water.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impact {
    /// Where, m from the origin of the maps.
    pub(super) at: Vec2,
    /// Velocity of the water there, along x and z, m/s.
    pub(super) drift: Vec2,
    /// When it comes through the plane at the height of the map's middle (or lands), s, and how much later it meets the water; below 0: before.
    pub(super) time_s: f64,
    pub(super) later_s: f32,
    /// m.
    pub(super) diameter: f32,
    /// Where its diameter's logarithm is between those of the smallest and the largest, 0 to 1.
    pub(super) size: f32,
    pub(super) id: u64,
}

/// Where the water of a map is.
#[derive(Debug)]
struct Shores {
    cells: Arc<[[f32; 4]]>,
    /// In each square of the world the part in which drops may come to the water.
    squares: BTreeMap<[i64; 2], Corners>,
    wet: WetSamples,
}

/// Drops on the water of puddles.
#[derive(Debug)]
pub(super) struct RingDrops {
    /// Smallest diameter that is looked for, and the largest that there is, m.
    diameters: [f64; 2],
    found: BTreeMap<Block, Found>,
    /// Those of the next span that are being looked for.
    begun: BTreeMap<Block, Background<Result<Found, PuddleError>>>,
    /// Of each puddle with rings.
    shores: BTreeMap<usize, Shores>,
    /// Of the maps.
    origin: DVec3,
    /// Time of the last picture, s.
    last_s: f64,
}

impl RingDrops {
    /// None yet; drops from the first of two diameters, m, on will be looked for, and none is larger than the second.
    pub(super) fn new(diameters: [f64; 2]) -> Self {
        Self {
            diameters,
            found: BTreeMap::new(),
            begun: BTreeMap::new(),
            shores: BTreeMap::new(),
            origin: DVec3::ZERO,
            last_s: f64::NAN,
        }
    }

    /// Those that are known, puddle by puddle.
    pub(super) fn impacts(&self) -> impl Iterator<Item = &Impact> {
        self.found.values().flat_map(|found| &found.impacts)
    }

    /// Area of the water with rings within reach of an eye, m^2, as it was found last.
    pub(super) fn area_near(&self, middle: Vec2) -> f64 {
        self.shores.values().map(|shores| shores.wet.area_near(middle)).sum()
    }

    /// Finds the drops whose rings are in a picture, and begins to look for some of those of the pictures to come; forgets all others.
    pub(super) fn find(
        &mut self,
        rain: &RainOnWater<'_>,
        puddles: &[(PuddleMap, PuddleLook)],
        origin: DVec3,
    ) -> Result<(), PuddleError> {
        if self.origin != origin {
            self.found.clear();
            self.begun.clear();
            self.shores.clear();
            self.origin = origin;
        }
        let mut wanted = Vec::new();
        let mut shores_before = std::mem::take(&mut self.shores);
        for (k, (map, _)) in puddles.iter().enumerate().filter(|(_, (_, look))| look.has_rings()) {
            let known = shores_before.remove(&k).filter(|shores| Arc::ptr_eq(&shores.cells, &map.cells));
            let shores = self.shores.entry(k).or_insert(known.unwrap_or_else(|| Shores::new(map, origin)));
            wanted.extend(blocks(k, map, shores, rain));
        }
        let mut before = std::mem::take(&mut self.found);
        let mut begun = std::mem::take(&mut self.begun);
        let mut anew = Vec::new();
        let is_unknown = |wanted: &&Wanted| {
            wanted.is_next && !before.contains_key(&wanted.block) && !begun.contains_key(&wanted.block)
        };
        let next = wanted.iter().filter(is_unknown).min_by_key(|wanted| wanted.block.2);
        let pictures = next.map_or(1, |wanted| {
            pictures_before(wanted, &puddles[wanted.block.0].0, [self.last_s, rain.time_s])
        });
        // More at once would keep the picture waiting for a thread.
        let mut room = wanted.iter().filter(is_unknown).count().div_ceil(pictures);
        self.last_s = rain.time_s;
        for Wanted { block, part, is_next } in wanted {
            let map = &puddles[block.0].0;
            let task = begun.remove(&block);
            if is_next && !before.contains_key(&block) {
                let task = task.or_else(|| {
                    room = room.checked_sub(1)?;
                    let (field, map, diameters) = (Arc::clone(rain.field), map.clone(), self.diameters);
                    let look = move || find_block((&field, &map), origin, (block, part), None, diameters);
                    Some(Background::begin(look))
                });
                self.begun.extend(task.map(|task| (block, task)));
                continue;
            }
            // An error of a search before its time says nothing: it is looked for again.
            let known = before.remove(&block).or_else(|| task.and_then(|task| task.finish().ok()));
            let known = known
                .filter(|found| found.part[0].cmple(part[0]).all() && found.part[1].cmpge(part[1]).all());
            match known {
                Some(found) if Arc::ptr_eq(&found.cells, &map.cells) => {
                    self.found.insert(block, found);
                }
                known => anew.push((block, part, known)),
            }
        }
        let found = anew.into_par_iter().map(|(block, part, known)| {
            let of = (&**rain.field, &puddles[block.0].0);
            Ok((block, find_block(of, origin, (block, part), known, self.diameters)?))
        });
        let found = found.collect::<Result<Vec<_>, PuddleError>>()?;
        self.found.extend(found);
        Ok(())
    }
}

/// The drops of a block that come to the water of a map, of which those that come through the plane may be known.
fn find_block(
    (field, map): (&RainField, &PuddleMap),
    origin: DVec3,
    (block, part): (Block, Corners),
    known: Option<Found>,
    diameters: [f64; 2],
) -> Result<Found, PuddleError> {
    let (part, crossings) = match known {
        Some(found) => (found.part, found.crossings),
        None => {
            let span_s = [block.2, block.2 + 1].map(|k| k as f64 * CHUNK_S);
            let height = origin.y + f64::from(map.ground.middle.y);
            (part, field.crossings(part, height, span_s, diameters[0])?)
        }
    };
    let impacts = impacts(map, origin, &crossings, diameters);
    Ok(Found { part, crossings, impacts, cells: Arc::clone(&map.cells) })
}

/// A block whose drops are wanted.
struct Wanted {
    block: Block,
    /// Where they may come to the water.
    part: Corners,
    /// True for the span of time after those of the picture.
    is_next: bool,
}

/// Number of pictures until the drops of a block are needed, from the times of the last picture and of the present one, s.
fn pictures_before(wanted: &Wanted, map: &PuddleMap, [last_s, time_s]: [f64; 2]) -> usize {
    let needed_s = wanted.block.2 as f64 * CHUNK_S - slack(map);
    let pictures = (needed_s - time_s) / (time_s - last_s);
    if time_s > last_s { (pictures as usize).max(1) } else { SHARES }
}

/// Drops may come to the surface so long, in s, before or after they come to the height of a map's middle.
fn slack(map: &PuddleMap) -> f64 {
    f64::from(map.ground.reach) / 4.0
}

/// Squares of the world and spans of time in which drops come through the water of puddle `k` that make rings in a picture, and then
/// those of the span after them.
fn blocks(
    k: usize,
    map: &PuddleMap,
    shores: &Shores,
    rain: &RainOnWater<'_>,
) -> impl Iterator<Item = Wanted> {
    let eye = DVec2::new(rain.eye.x, rain.eye.z);
    let squares: Vec<([i64; 2], Corners)> = shores
        .squares
        .iter()
        .filter(|([x, z], _)| {
            let corner = DVec2::new(*x as f64, *z as f64) * BLOCK_M;
            corner.cmplt(eye + REACH_M).all() && (corner + BLOCK_M).cmpgt(eye - REACH_M).all()
        })
        .map(|(&square, &part)| (square, part))
        .collect();
    let life = f64::from(PUDDLE_RINGS_LIFE);
    let slack = slack(map);
    let spans = [rain.time_s - life - slack, rain.time_s + slack].map(|time| (time / CHUNK_S).floor() as i64);
    (spans[0]..=spans[1] + 1).flat_map(move |span| {
        let wanted =
            move |(square, part)| Wanted { block: (k, square, span), part, is_next: span > spans[1] };
        squares.clone().into_iter().map(wanted)
    })
}

/// The drops, of two diameters and between, that meet the water of a map.
fn impacts(map: &PuddleMap, origin: DVec3, crossings: &[Crossing], [low, high]: [f64; 2]) -> Vec<Impact> {
    let range = ops::ln(high / low);
    let turn = turned(map.ground.turn);
    let impact = |crossing: &Crossing| {
        let at = (crossing.position - origin).as_vec3();
        let rise = map.water_at(map.place(turn, at))?.level;
        // From the height of the map's middle to the surface.
        let later_s = rise / crossing.velocity.y.min(-0.1);
        let at = at + crossing.velocity * later_s;
        let water = map.water_at(map.place(turn, at))?;
        // Where a part of the rain arrives, a part of the drops does.
        let chance = (crossing.id >> 40) as f32 / 16_777_216.0;
        let (time_s, diameter, id) = (crossing.time_s, crossing.diameter, crossing.id);
        let size = (ops::ln(f64::from(diameter) / low) / range) as f32;
        let (at, drift) = (Vec2::new(at.x, at.z), water.velocity);
        (chance < water.open).then_some(Impact { at, drift, time_s, later_s, diameter, size, id })
    };
    crossings.par_iter().with_min_len(DROPS_TOGETHER).filter_map(impact).collect()
}

impl Shores {
    /// Of a map whose position is relative to `origin`.
    fn new(map: &PuddleMap, origin: DVec3) -> Self {
        let mut squares: BTreeMap<[i64; 2], Corners> = BTreeMap::new();
        let [columns, rows] = map.size;
        let origin = DVec2::new(origin.x, origin.z);
        for y in 0..rows {
            let row = &map.cells[y * columns..(y + 1) * columns];
            for (k, cells) in row.chunks(CELLS_BOUNDED).enumerate() {
                let is_wet = |cell: &[f32; 4]| cell[2] >= PUDDLE_WATER_MIN_DEPTH;
                let (Some(first), Some(last)) =
                    (cells.iter().position(is_wet), cells.iter().rposition(is_wet))
                else {
                    continue;
                };
                let part = |at: usize, count: usize| at as f32 / count as f32;
                let across = [first, last + 1].map(|x| part(k * CELLS_BOUNDED + x, columns));
                let down = [y, y + 1].map(|y| part(y, rows));
                let corners =
                    across.iter().flat_map(|&u| down.iter().map(move |&v| map.ground.position(u, v)));
                let corners = corners.map(|at| origin + DVec2::new(f64::from(at.x), f64::from(at.z)));
                let (low, high) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), at| {
                    (low.min(at), high.max(at))
                });
                // In whole steps: water that rises a little moves nothing.
                let low = (low / ASIDE_M - 1.0).floor() * ASIDE_M;
                let high = (high / ASIDE_M + 1.0).ceil() * ASIDE_M;
                let [from, to] = [(low / BLOCK_M).floor().as_i64vec2(), (high / BLOCK_M).ceil().as_i64vec2()];
                for square in (from.x..to.x).flat_map(|x| (from.y..to.y).map(move |z| [x, z])) {
                    let corner = DVec2::new(square[0] as f64, square[1] as f64) * BLOCK_M;
                    let part = [corner.max(low), (corner + BLOCK_M).min(high)];
                    let bounds = squares.entry(square).or_insert(part);
                    *bounds = [bounds[0].min(part[0]), bounds[1].max(part[1])];
                }
            }
        }
        Self { cells: Arc::clone(&map.cells), squares, wet: WetSamples::new(map) }
    }
}
