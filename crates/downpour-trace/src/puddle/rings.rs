//! Rings of single drops on puddles near the eye: of which drops, where and since when, and the slopes of their waves.
//!
//! The rain in closed form knows which drops come through the surface of a puddle, and when ([`RainField::crossings`]): those that the
//! picture shows falling. The larger ones near the eye make the ring of [`DropRing`] there; all the others are in the lattice of the
//! ripples, from which the part of the larger ones is taken off. Rings are a function of time and eye alone.

use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};
use std::sync::Arc;

use downpour_drop::distribution::DropSizeDistribution;
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_lattice::puddle::{DropRing, PuddleForm};
use downpour_math::bins::Bins;
use downpour_math::ops::f64 as ops;
use downpour_shaders::render::puddle_rings::{
    PUDDLE_RINGS_CELL, PUDDLE_RINGS_DISTANCE, PUDDLE_RINGS_DISTANCES, PUDDLE_RINGS_LIFE, PUDDLE_RINGS_ROWS,
    PUDDLE_RINGS_SIZES, PUDDLE_RINGS_TIME, PUDDLE_RINGS_TIMES,
};
use downpour_sim::field::RainField;
use downpour_sim::impacts::Impact as Dripped;
use glam::{DVec3, Vec2, Vec3};
use half::f16;
use rayon::prelude::*;

use super::map::{Ground, PuddleMap};
use super::ring_drops::{Impact, RingDrops};
use super::ripples::{MEMORY_S, options};
use super::{PuddleError, PuddleLook};

/// Distance along the ground from the eye up to which drops have rings, m. Farther away no picture shows waves of two centimeters.
pub(super) const REACH_M: f64 = 10.0;

/// Cells along an edge of the square around the eye: a cell more than its edge, since they begin at whole cells.
const CELLS: usize = 81;

/// Most rings of a picture.
const MAX_RINGS: usize = 4096;

/// Expected number of rings of a picture, at most: some rooms stay free for chance.
const EXPECTED_RINGS: f64 = 3200.0;

/// Expected number of rings in a cell, at most.
const EXPECTED_IN_CELL: f64 = 24.0;

/// Diameters of drops, m, and the number of classes between, for the energy of their waves.
const DIAMETERS_M: [f64; 2] = [0.4e-3, 8.0e-3];
const BINS: u32 = 32;

/// Smallest drop with a ring, m.
const MIN_DIAMETER_M: f64 = 1.5e-3;

/// Drops of some diameter, with the integrals over time of their squared slope, m^2 s: of all of it, and of that of a ring.
#[derive(Clone, Copy, Debug)]
struct Bin {
    diameter: f64,
    /// m/s.
    speed: f64,
    /// m.
    width: f64,
    whole: f64,
    ring: f64,
}

impl Bin {
    /// Drops of a rain through a square meter in a second.
    fn flux(&self, rain: &DropSizeDistribution) -> f64 {
        rain.concentration(self.diameter) * self.speed * self.width
    }
}

/// Rings of the drops of a rain.
#[derive(Debug)]
pub struct Rings {
    heaviest: DropSizeDistribution,
    bins: Vec<Bin>,
    /// Smallest drop with a ring, m.
    smallest: f64,
    slopes: Arc<[[u32; 4]]>,
    drops: RingDrops,
    law: TerminalSpeed,
}

/// The rain on the water of a picture.
#[derive(Clone, Copy, Debug)]
pub struct RainOnWater<'a> {
    /// The drops.
    pub field: &'a Arc<RainField>,
    /// Their present sizes; `None`: those of the heaviest rain.
    pub sizes: Option<&'a DropSizeDistribution>,
    /// Time, s.
    pub time_s: f64,
    /// Eye, m in the world.
    pub eye: DVec3,
    /// Drops that have dripped near the eye: [`Rings::asked`].
    pub dripped: &'a [Dripped],
}

/// Rings of a picture, as rows of the scene's table.
#[derive(Clone, Debug, PartialEq)]
pub struct RingRows {
    slopes: Arc<[[u32; 4]]>,
    /// Number of the first ring of each cell, and that behind the last.
    cells: Vec<u32>,
    /// Place in the cell, age and size.
    rings: Vec<[u32; 2]>,
    /// Part of the mean square of the slope.
    part: f32,
    corner: Vec2,
    middle: Vec2,
}

/// Rings in a picture.
struct Placing {
    time_s: f64,
    /// Of the cells, m from the origin of the maps.
    corner: Vec2,
    /// The eye, m from there.
    middle: Vec2,
}

/// A ring in a picture: its cell, and its words.
type Placed = (usize, [u32; 2]);

/// Drops, by their ids.
type IdSet = HashSet<u64, IdHash>;

/// Hashes ids of drops, which nobody chooses.
type IdHash = BuildHasherDefault<IdHasher>;

/// Hash of a number: its product with an odd one, whose upper bits depend on all of it.
#[derive(Default)]
struct IdHasher(u64);

impl Hasher for IdHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(byte.into()));
    }

    fn write_u64(&mut self, number: u64) {
        // The golden ratio, in 64 bits.
        let mixed = (self.0 ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 32);
    }
}

impl Rings {
    /// Makes the slopes of the rings of a rain, whose rate is never larger.
    ///
    /// # Errors
    /// [`PuddleError::Rain`], [`PuddleError::Lattice`] for drops that are none.
    pub fn new(heaviest: &DropSizeDistribution) -> Result<Self, PuddleError> {
        let law = TerminalSpeed::new(heaviest.options().fall_speed, &heaviest.options().air);
        let ratio = ops::pow(DIAMETERS_M[1] / DIAMETERS_M[0], 1.0 / f64::from(BINS));
        let bin = |k: u32| {
            let low = DIAMETERS_M[0] * ops::pow(ratio, f64::from(k));
            let diameter = low * ratio.sqrt();
            let speed = law.at(diameter)?;
            let ring = DropRing::new(&options(PuddleForm::GravityCapillary), diameter, speed)?;
            let integral = |until: f64, weight: &dyn Fn(f64) -> f64| {
                let steps = 48;
                let step = until / f64::from(steps);
                let at = |n: u32| step * (f64::from(n) + 0.5);
                (0..steps).map(|n| ring.mean_squared_slope(at(n)) * weight(at(n))).sum::<f64>() * step
            };
            let whole = integral(MEMORY_S, &|_| 1.0);
            let ring = integral(f64::from(PUDDLE_RINGS_LIFE), &|time| fade(time) * fade(time));
            Ok(Bin { diameter, speed, width: low * (ratio - 1.0), whole, ring })
        };
        let bins = (0..BINS).into_par_iter().map(bin).collect::<Result<Vec<Bin>, PuddleError>>()?;
        let area = f64::from(PUDDLE_RINGS_CELL * PUDDLE_RINGS_CELL);
        let smallest = smallest_of(&bins, heaviest, EXPECTED_IN_CELL / area).max(MIN_DIAMETER_M);
        let slopes = slopes(&law, smallest)?.into();
        let drops = RingDrops::new([smallest, DIAMETERS_M[1]]);
        Ok(Self { heaviest: heaviest.clone(), bins, smallest, slopes, drops, law })
    }

    /// Corners of the box, m in the world, and span of time, s, in which drops that drip make rings of a picture.
    #[must_use]
    pub fn asked(eye: DVec3, time_s: f64) -> ([DVec3; 2], [f64; 2]) {
        let reach = DVec3::splat(REACH_M + f64::from(PUDDLE_RINGS_CELL));
        ([eye - reach, eye + reach], [time_s - f64::from(PUDDLE_RINGS_LIFE), time_s])
    }

    /// Finds the rings of a picture on puddles whose positions are relative to `origin`.
    ///
    /// # Errors
    /// [`PuddleError::Sim`] for a time or an eye out of range.
    pub fn find(
        &mut self,
        rain: &RainOnWater<'_>,
        puddles: &[(PuddleMap, PuddleLook)],
        origin: DVec3,
    ) -> Result<RingRows, PuddleError> {
        let eye = rain.eye - origin;
        let middle = Vec2::new(eye.x as f32, eye.z as f32);
        let with_rings = || puddles.iter().filter(|(_, look)| look.has_rings());
        self.drops.find(rain, puddles, origin)?;
        let area = self.drops.area_near(middle);
        let life = f64::from(PUDDLE_RINGS_LIFE);
        let most = EXPECTED_RINGS / (life * area.max(1.0e-6));
        let smallest = smallest_of(&self.bins, &self.heaviest, most).max(self.smallest);
        let corner = ((middle - REACH_M as f32) / PUDDLE_RINGS_CELL).floor() * PUDDLE_RINGS_CELL;
        let placing = Placing { time_s: rain.time_s, corner, middle };
        // Where puddles overlap, the ring is the first one's.
        let grounds: Vec<&Ground> = with_rings().map(|(map, _)| &map.ground).collect();
        let overlap = grounds.iter().enumerate().any(|(k, a)| grounds[..k].iter().any(|b| a.may_overlap(b)));
        let mut known =
            IdSet::with_capacity_and_hasher(if overlap { MAX_RINGS } else { 0 }, IdHash::default());
        let mut placed: Vec<Placed> = Vec::with_capacity(MAX_RINGS);
        let dripped: Vec<Impact> = with_rings()
            .flat_map(|(map, _)| rain.dripped.iter().filter_map(|drop| self.dripped(drop, map, origin)))
            .collect();
        let all = self.drops.impacts().chain(&dripped);
        for impact in all.filter(|impact| f64::from(impact.diameter) >= smallest) {
            let ring = placed_ring(impact, &placing);
            placed.extend(ring.filter(|_| !overlap || known.insert(impact.id)));
        }
        let (cells, rings) = binned(&placed);
        let part = self.part(rain.sizes.unwrap_or(&self.heaviest), smallest);
        Ok(RingRows { slopes: Arc::clone(&self.slopes), cells, rings, part, corner, middle })
    }

    /// A drop that has dripped, as it meets the water of a map; `None` if it does not, or if its ring is too small. Its ring is that of a drop
    /// of the rain with the same energy.
    fn dripped(&self, drop: &Dripped, map: &PuddleMap, origin: DVec3) -> Option<Impact> {
        let at = (drop.position - origin).as_vec3();
        // It has landed on the ground below the water, and not on what stands above it.
        let (water, deep) = map.water_over(at)?;
        let mut diameter = f64::from(drop.diameter);
        let energy = diameter * diameter * diameter * f64::from(drop.velocity.length_squared());
        // Terminal speeds change slowly with the diameter: each round has a third of the error before it.
        for _ in 0..8 {
            let speed = self.law.at(diameter.clamp(DIAMETERS_M[0], DIAMETERS_M[1])).ok()?;
            diameter = ops::cbrt(energy / (speed * speed));
        }
        let diameter = diameter.min(DIAMETERS_M[1]);
        let size = (ops::ln(diameter / self.smallest) / ops::ln(DIAMETERS_M[1] / self.smallest)) as f32;
        let later_s = deep.max(0.0) / drop.velocity.y.min(-0.1);
        (diameter >= self.smallest).then_some(Impact {
            at: Vec2::new(at.x, at.z),
            drift: water.velocity,
            time_s: drop.time_s,
            later_s,
            diameter: diameter as f32,
            size,
            id: drop.id,
        })
    }

    /// Part of the mean square of the slope of a rain's ripples that rings of drops from a diameter on have.
    fn part(&self, rain: &DropSizeDistribution, smallest: f64) -> f32 {
        let whole: f64 = self.bins.iter().map(|bin| bin.flux(rain) * bin.whole).sum();
        let with_rings = self.bins.iter().filter(|bin| bin.diameter >= smallest);
        let rings: f64 = with_rings.map(|bin| bin.flux(rain) * bin.ring).sum();
        if whole > 0.0 { (rings / whole).min(0.999) as f32 } else { 0.0 }
    }
}

/// The ring of a drop in a picture; `None` if there is none.
fn placed_ring(impact: &Impact, placing: &Placing) -> Option<Placed> {
    let Placing { time_s, corner, middle } = *placing;
    let age_s = (time_s - impact.time_s) as f32 - impact.later_s;
    let age = age_s / PUDDLE_RINGS_LIFE;
    // Running water takes its rings along.
    let at = impact.at + impact.drift * age_s;
    // No ring is wider than a cell.
    let is_near = at.distance(middle) < REACH_M as f32 + PUDDLE_RINGS_CELL;
    if !is_near || !(0.0..1.0).contains(&age) {
        return None;
    }
    let place = (at - corner) / PUDDLE_RINGS_CELL;
    let cell = place.floor();
    let [x, z] = [cell.x, cell.y].map(|n| if n >= 0.0 && n < CELLS as f32 { Some(n as usize) } else { None });
    let units = |part: f32| (part * 65536.0).clamp(0.0, 65535.0) as u32;
    let within = place - cell;
    let words = [units(within.x) | units(within.y) << 16, units(age) | units(impact.size) << 16];
    Some((z? * CELLS + x?, words))
}

/// Number of the first ring of each cell, and of one more, and the rings, cell by cell, in an order that does not depend on theirs.
/// Those for which there is no room are in the last cells.
fn binned(placed: &[Placed]) -> (Vec<u32>, Vec<[u32; 2]>) {
    let touched = |ring: u32, touches: &mut dyn FnMut(usize)| touches(placed[ring as usize].0);
    let Bins { mut starts, items } = Bins::new(CELLS * CELLS, placed.len() as u32, touched);
    let mut rings: Vec<[u32; 2]> = items.iter().map(|&ring| placed[ring as usize].1).collect();
    for cell in starts.windows(2).filter(|cell| cell[1] - cell[0] > 1) {
        rings[cell[0] as usize..cell[1] as usize].sort_unstable();
    }
    rings.truncate(MAX_RINGS);
    starts.iter_mut().for_each(|start| *start = (*start).min(MAX_RINGS as u32));
    (starts, rings)
}

/// Smallest diameter, m, from which on no more than `most` drops come through a square meter in a second.
fn smallest_of(bins: &[Bin], rain: &DropSizeDistribution, most: f64) -> f64 {
    let mut flux = 0.0;
    for bin in bins.iter().rev() {
        flux += bin.flux(rain);
        if flux > most {
            return bin.diameter + 0.5 * bin.width;
        }
    }
    DIAMETERS_M[0]
}

/// Part of a ring that is left some time after the impact: it ends when the next drops have long hidden it.
fn fade(time_s: f64) -> f64 {
    let life = f64::from(PUDDLE_RINGS_LIFE);
    let part = ((time_s / life - 0.6) / 0.4).clamp(0.0, 1.0);
    1.0 - part * part * (3.0 - 2.0 * part)
}

/// The table of slopes of drops from a diameter, m, on: two numbers of 16 bits in a word.
fn slopes(law: &TerminalSpeed, smallest: f64) -> Result<Vec<[u32; 4]>, PuddleError> {
    let ratio = DIAMETERS_M[1] / smallest;
    let times: Vec<f64> =
        (0..PUDDLE_RINGS_TIMES).map(|n| f64::from(n) * f64::from(PUDDLE_RINGS_TIME)).collect();
    let of_size = |k: u32| {
        let diameter = smallest * ops::pow(ratio, f64::from(k) / f64::from(PUDDLE_RINGS_SIZES - 1));
        let ring = DropRing::new(&options(PuddleForm::GravityCapillary), diameter, law.at(diameter)?)?;
        let count = PUDDLE_RINGS_DISTANCES as usize;
        let mut slopes = ring.slopes(&times, f64::from(PUDDLE_RINGS_DISTANCE), count);
        for (row, &time) in slopes.chunks_mut(count).zip(&times) {
            row.iter_mut().for_each(|slope| *slope *= fade(time) as f32);
        }
        Ok(slopes)
    };
    let sizes = (0..PUDDLE_RINGS_SIZES).into_par_iter().map(of_size);
    let all = sizes.collect::<Result<Vec<_>, PuddleError>>()?.concat();
    let word = |pair: &[f32; 2]| {
        let [low, high] = pair.map(|slope| u32::from(f16::from_f32(slope).to_bits()));
        low | high << 16
    };
    let words: Vec<u32> = all.as_chunks().0.iter().map(word).collect();
    Ok(words.as_chunks().0.to_vec())
}

impl RingRows {
    /// Number of rings.
    #[must_use]
    pub fn count(&self) -> usize {
        self.rings.len()
    }

    /// Slopes of rings of all sizes and ages, which all pictures of a rain share.
    pub(super) fn slopes(&self) -> Arc<[[u32; 4]]> {
        Arc::clone(&self.slopes)
    }

    /// Rows that say where the others are: cells and rings begin at row `first`, and of the slopes nobody knows it yet; positions are
    /// shifted by so many meters.
    pub(super) fn head(&self, first: u32, shift: Vec3) -> [[u32; 4]; PUDDLE_RINGS_ROWS as usize] {
        let rings = first + self.cells.len().div_ceil(8) as u32;
        let shift = Vec2::new(shift.x, shift.z);
        let (corner, middle) = (self.corner + shift, self.middle + shift);
        [
            [CELLS as u32, CELLS as u32, first, rings],
            [0, self.part.to_bits(), (REACH_M as f32).to_bits(), 0],
            [corner.x, corner.y, middle.x, middle.y].map(f32::to_bits),
        ]
    }

    /// Adds the rows of cells and rings: as many for any number of rings.
    pub(super) fn extend(&self, table: &mut Vec<[u32; 4]>) {
        let row = |words: &[u32]| std::array::from_fn(|k| words.get(k).copied().unwrap_or_default());
        // Two cells in a word: there are not as many rings as would not fit.
        let pair = |k: usize| self.cells[k] | self.cells.get(k + 1).map_or(0, |next| next << 16);
        let cells: Vec<u32> = (0..self.cells.len()).step_by(2).map(pair).collect();
        table.reserve(cells.len() / 4 + 1 + MAX_RINGS / 2);
        table.extend(cells.chunks(4).map(row));
        let end = table.len() + MAX_RINGS / 2;
        table.extend(self.rings.as_flattened().chunks(4).map(row));
        table.resize(end, [0; 4]);
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::builder::SceneBuilder;
    use crate::data::SceneData;
    use crate::puddle::map::turned;
    use crate::puddle::{Ground, PuddleRows, Ripples};
    use crate::sky_light::SkyLight;
    use downpour_drop::distribution::DropSizeLaw;

    const SEED: u64 = 5;

    fn rain(rate_mm_h: f64) -> DropSizeDistribution {
        DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h).unwrap()
    }

    /// Water of 4 x 4 m, of which a strip without rain.
    fn pool() -> (PuddleMap, PuddleLook) {
        let ground =
            Ground { middle: Vec3::new(1.0, 0.2, -2.0), size: Vec2::splat(4.0), turn: 0.3, reach: 0.3 };
        let open = |i: usize| if i % 40 < 10 { 0.0 } else { 1.0 };
        let cells = (0..1600).map(|i| [-0.01, 0.02, 0.02, open(i)]).collect();
        (PuddleMap { ground, size: [40, 40], cells, flow: None }, PuddleLook::default())
    }

    fn scene_of(rings: &RingRows, puddles: &[(PuddleMap, PuddleLook)], slopes: &[[f32; 4]]) -> SceneData {
        let mut scene = SceneBuilder::new().build(&SkyLight::new(1, 1, &[[1.0; 3]]));
        scene.set_puddles(&PuddleRows {
            puddles,
            shape: (512, 9, 2.5e-3),
            slopes,
            shift: Vec3::ZERO,
            rings: Some(rings),
            wakes: &[],
            time_s: 0.0,
        });
        scene
    }

    fn on_water(field: &Arc<RainField>, time_s: f64) -> RainOnWater<'_> {
        RainOnWater { field, sizes: None, time_s, eye: DVec3::new(1.0, 1.8, 0.0), dripped: &[] }
    }

    /// A picture of a clip has the rings that it has alone, also where the water has risen in between.
    #[test]
    fn rings_do_not_depend_on_pictures_before() {
        let law = rain(60.0);
        let field = Arc::new(RainField::new(&law, SEED).unwrap());
        let puddles = |wet: usize| {
            let (map, look) = pool();
            let cells = (0..1600).map(|i| {
                let depth = if i / 40 < wet { 0.02 } else { -1.0 };
                [-0.01, 0.02, depth, 1.0]
            });
            let far = Ground { middle: Vec3::new(3.5, 0.2, -3.0), ..map.ground };
            let other = PuddleMap { ground: far, ..map.clone() };
            [(PuddleMap { cells: cells.collect(), ..map }, look), (other, look)]
        };
        let before = puddles(9);
        let (mut clip, origin) = (Rings::new(&law).unwrap(), DVec3::new(1000.0, 0.0, 0.0));
        let mut counts = Vec::new();
        for frame in 0..40u8 {
            let time_s = 5.0 + f64::from(frame) / 30.0;
            let now = if frame < 17 { before.clone() } else { puddles(usize::from(frame)) };
            let eye = origin + DVec3::new(1.0 + 0.3 * f64::from(frame), 1.8, 0.0);
            let picture = RainOnWater { field: &field, sizes: None, time_s, eye, dripped: &[] };
            let rings = clip.find(&picture, &now, origin).unwrap();
            if frame % 3 == 1 {
                let alone = Rings::new(&law).unwrap().find(&picture, &now, origin).unwrap();
                assert!(alone == rings, "{frame}: {} and {}", alone.count(), rings.count());
            }
            counts.push(rings.count());
        }
        assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    }

    /// Rings have the part of the mean square of the slope that is taken off the lattice.
    #[test]
    fn rings_have_their_part_of_the_slope() {
        for rate in [10.0, 40.0] {
            let law = rain(rate);
            let field = Arc::new(RainField::new(&law, SEED).unwrap());
            let mut ripples = Ripples::new(Some(&law), SEED, 3.0).unwrap();
            let mut rings = Rings::new(&law).unwrap();
            let puddles = [pool()];
            let (mut of_rings, mut of_lattice, mut part) = (0.0, 0.0, 0.0);
            for k in 0..6u32 {
                let time_s = 3.0 + f64::from(k) * 0.7;
                ripples.advance(time_s).unwrap();
                let slopes = ripples.slopes();
                let finest = &slopes[..512 * 512];
                // Within the border that takes ripples away.
                let inner = (64..448).flat_map(|y| finest[y * 512 + 64..y * 512 + 448].iter());
                of_lattice += inner.map(|slope| f64::from(slope[2])).sum::<f64>() / (384.0 * 384.0);
                let rows = rings.find(&on_water(&field, time_s), &puddles, DVec3::ZERO).unwrap();
                let scene = scene_of(&rows, &puddles, &slopes);
                let found = scene.puddle_rings_load();
                part = f64::from(found.part);
                let mut sum = 0.0;
                for i in 0..2000u16 {
                    let at = Vec2::new(f32::from(i % 40) * 0.05 + 0.5, f32::from(i / 40) * 0.04 - 3.0);
                    sum += f64::from(scene.puddle_rings_sum(&found, at).length_squared());
                }
                of_rings += sum / 2000.0;
                println!("{rate} mm/h: {} rings", rows.count());
            }
            let ratio = of_rings / of_lattice;
            println!(
                "{rate} mm/h: {ratio:.3} of the lattice's, {part:.3} taken off; slope {:.4}",
                (of_lattice / 6.0).sqrt()
            );
            assert!((ratio / part - 1.0).abs() < 0.2, "{rate}: {ratio}, {part}");
        }
    }

    /// A drop that drips has the ring of a drop of its energy, where it lands in the water: not above it, and not if it is too slow.
    #[test]
    fn drops_that_drip_have_rings() {
        let law = rain(20.0);
        let field = Arc::new(RainField::new(&law, SEED).unwrap());
        let mut rings = Rings::new(&law).unwrap();
        let (time_s, origin) = (4.3, DVec3::new(500.0, 10.0, -300.0));
        let (map, look) = pool();
        let puddles = [(map, look)];
        let landed = |position: DVec3, speed: f32, age_s: f64| Dripped {
            position: position + origin,
            normal: Vec3::Y,
            velocity: Vec3::NEG_Y * speed,
            diameter: 5.0e-3,
            id: 7,
            time_s: time_s - age_s,
        };
        let at = DVec3::new(2.5, 0.2, -2.0);
        let dripped = [landed(at, 6.0, 0.1)];
        let mut of = |dripped: &[Dripped]| {
            let eye = DVec3::new(1.0, 1.8, 0.0) + origin;
            let picture = RainOnWater { field: &field, sizes: None, time_s, eye, dripped };
            rings.find(&picture, &puddles, origin).unwrap()
        };
        let [without, with] = [of(&[]), of(&dripped)];
        assert_eq!(with.count(), without.count() + 1);
        let of_cell = |rows: &RingRows, cell: usize| {
            rows.rings[rows.cells[cell] as usize..rows.cells[cell + 1] as usize].to_vec()
        };
        let cell = (0..CELLS * CELLS).find(|&cell| of_cell(&with, cell) != of_cell(&without, cell)).unwrap();
        let old = of_cell(&without, cell);
        let [place, words] = of_cell(&with, cell).into_iter().find(|ring| !old.contains(ring)).unwrap();
        let halves = |word: u32| [word & 0xffff, word >> 16].map(|part| part as f32 / 65536.0);
        let corner = Vec2::new((cell % CELLS) as f32, (cell / CELLS) as f32);
        let place = with.corner + (corner + Vec2::from(halves(place))) * PUDDLE_RINGS_CELL;
        let [age, size] = halves(words);
        assert!(place.distance(Vec2::new(2.5, -2.0)) < 1.0e-4, "{place}");
        // 1 cm of water take a drop of 6 m/s less than 2 ms.
        let expected = (0.1 + 0.01 / 6.0) / PUDDLE_RINGS_LIFE;
        assert!((age - expected).abs() < 1.0e-3 && age < expected + 1.0e-4, "{age} and {expected}");
        // A drop at terminal speed of 5 mm falls at 9.1 m/s; one of the same energy as here is smaller.
        let of_size = |diameter: f64| {
            (ops::ln(diameter / rings.smallest) / ops::ln(DIAMETERS_M[1] / rings.smallest)) as f32
        };
        assert!(size < of_size(4.6e-3) && size > of_size(3.6e-3), "{size}");
        let has_ring = |position: DVec3, speed: f32| {
            rings.dripped(&landed(position, speed, 0.1), &puddles[0].0, origin).is_some()
        };
        assert!(has_ring(at, 6.0));
        assert!(!has_ring(at + DVec3::Y, 6.0), "on a roof");
        assert!(!has_ring(at - DVec3::Y * 0.2, 6.0), "in a cellar");
        assert!(!has_ring(at + DVec3::X * 40.0, 6.0), "on land");
        assert!(!has_ring(at, 0.3), "too slow");
    }

    /// A ring is where its drop comes through the water, if rain gets there, and is once where puddles overlap.
    #[test]
    fn rings_are_where_drops_fall() {
        let law = rain(20.0);
        let field = Arc::new(RainField::new(&law, SEED).unwrap());
        let mut rings = Rings::new(&law).unwrap();
        let time_s = 4.3;
        let rows = rings.find(&on_water(&field, time_s), &[pool()], DVec3::ZERO).unwrap();
        let twice = rings.find(&on_water(&field, time_s), &[pool(), pool()], DVec3::ZERO).unwrap();
        assert!(rows.count() > 500, "{}", rows.count());
        // Over twice the area, by its maps, fewer drops have rings.
        assert!(twice.count() <= rows.count(), "{} and {}", twice.count(), rows.count());
        // The surface is 1 cm over the middle's height.
        let [low, high] = [DVec2::new(-2.0, -5.0), DVec2::new(4.0, 1.0)];
        let life = f64::from(PUDDLE_RINGS_LIFE);
        let drops = field.crossings([low, high], 0.21, [time_s - life, time_s], 1.0e-3).unwrap();
        let places: Vec<Vec2> =
            drops.iter().map(|drop| Vec2::new(drop.position.x as f32, drop.position.z as f32)).collect();
        let ground = pool().0.ground;
        for cell in 0..CELLS * CELLS {
            for ring in rows.cells[cell]..rows.cells[cell + 1] {
                let [place, _] = rows.rings[ring as usize];
                let within = Vec2::new((place & 0xffff) as f32, (place >> 16) as f32) / 65536.0;
                let corner = Vec2::new((cell % CELLS) as f32, (cell / CELLS) as f32);
                let at = rows.corner + (corner + within) * PUDDLE_RINGS_CELL;
                let away = places.iter().map(|drop| drop.distance(at)).fold(f32::INFINITY, f32::min);
                assert!(away < 1.0e-4, "{at} is {away} m from the next drop");
                let from = at - Vec2::new(ground.middle.x, ground.middle.z);
                let along = from.dot(turned(ground.turn)) / ground.size.x + 0.5;
                assert!(along > 0.249, "{at} has a roof");
            }
        }
    }
}
