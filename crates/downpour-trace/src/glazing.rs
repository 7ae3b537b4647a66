//! Rain on panes of the scene: shop windows, parked cars. Twin of `shaders/wgsl/render/glazing.wgsl`.
//!
//! What the rain leaves on glass is a function of the depth of rain that has met it, so that any time can be seen alone:
//!
//! 1. A pane meets the flux of rain that a wall meets, `n . d / d.y` of that of level ground ([`wet`](crate::wet)): a vertical one in a wind
//!    only, and none under a roof.
//! 2. Each cell of a lattice (three sizes) may hold a drop at a place of its own. It takes up its share of the rain that has met the cell
//!    since the place was swept, as a cap that meets the glass at 45 degrees, until it is as wide as its cell lets it be, or as wide as
//!    gravity lets it stay (C. Furmidge, J. Colloid Sci. 17, 1962: some 5 mm on a steep pane).
//! 3. What meets the glass and does not stay runs down it. All of it, for each lane of 30 mm, comes down in heads of 60 mm^3 at 0.25 m/s:
//!    that says how often. A track serves for a dozen of runs, then the next one takes another way; a run sweeps the drops
//!    off its way, and smaller ones grow in its place.
//! 4. A drop mirrors what its slope faces, as the glass does, and a ray through it is refracted at its surface and at the glass, which
//!    shows what is behind it upside down. What is reflected within goes back to where it came from: none of the light is lost.
//!
//! Limits: drops do not run into one another but for runs, and do not dim the light of lamps through the pane; drops of which a pixel shows
//! several fade, and from where it is six of their radii wide they are not seen; rays that look for light do not see drops; when the rate
//! changes, runs that are on their way change their speed with it for as long as they need for the pane.

use downpour_drop::optics::{optics_reflect, optics_refract};
use downpour_math::ops;
use downpour_math::rng::{rng_pcg4d, rng_unit};
use downpour_scene::scene::Scene;
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::glazing::{
    GLAZING_COARSER, GLAZING_COSINE, GLAZING_DIMENSION, GLAZING_FADE, GLAZING_FINE, GLAZING_HEAD,
    GLAZING_LANE, GLAZING_LATE, GLAZING_LEVELS, GLAZING_MAX_RADIUS, GLAZING_MAX_STRETCH, GLAZING_MIN_FLUX,
    GLAZING_MIN_RADIUS, GLAZING_PRESENT, GLAZING_ROWS, GLAZING_RUN_M3, GLAZING_RUNS, GLAZING_SHARE,
    GLAZING_SINE, GLAZING_SMALLER, GLAZING_SPEED, GLAZING_START, GLAZING_SWAY, GLAZING_SWEEP, GLAZING_TAIL,
    GLAZING_TRACKS, GLAZING_TURN, GLAZING_VOLUME,
};
use downpour_shaders::render::path::PATH_SHARP;
use downpour_shaders::render::puddle_water::PUDDLE_WATER_INDEX;
use downpour_shaders::render::scene::SCENE_NONE;
use downpour_weather::{ScenePane, Weather};
use glam::{DVec3, Vec2, Vec3, Vec4};

use crate::data::SceneData;
use crate::scatter::scatter_gloss;
use crate::scene::SceneView;
use crate::surface::Surface;
use crate::wet::{RenderWet, wet_arrival};

/// Half the depth of the box of a pane within which glass is its own, m.
const HALF_THICKNESS_M: f32 = 0.1;

/// Rain on the panes of a scene. Twin of the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderGlazing {
    /// Rain before a pause, mm.
    pub before: f32,
    /// Fraction of the water that is kept after the pause.
    pub kept: f32,
    /// Rain after it, mm.
    pub since: f32,
    /// Its rate, mm/s.
    pub rate: f32,
    /// Number of panes.
    pub count: u32,
}

/// A pane that carries water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlazingPane {
    /// Index of the material; [`SCENE_NONE`]: any.
    pub material: u32,
    /// Way of the water down the pane, m.
    pub height: f32,
    /// Largest radius of a drop that stays, m.
    pub largest: f32,
    /// Seed of the drops.
    pub seed: u32,
    /// Center of the rectangle, m.
    pub center: Vec3,
    /// Half its width, m; 0: the pane is wherever its material is.
    pub half_width: f32,
    /// Unit vector to the right, seen from the rain.
    pub across: Vec3,
    /// Half its height, m.
    pub half_height: f32,
    /// Unit vector toward the rain.
    pub outward: Vec3,
    /// Half the depth of its box, m.
    pub half_thickness: f32,
}

/// A place on a pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlazingPlace {
    /// To the right, and down, m.
    pub at: Vec2,
    /// Unit vector to the right.
    pub across: Vec3,
    /// Unit vector down.
    pub down: Vec3,
    /// Rain that has met the surface, mm.
    pub met: f32,
    /// That since a pause, mm.
    pub since: f32,
    /// Its rate, mm/s.
    pub rate: f32,
    /// Fraction of the water that is kept of what was there before the pause.
    pub kept: f32,
}

/// Runs of water down a lane, at a height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlazingLane {
    /// Number of the lane.
    pub lane: i32,
    /// Runs that have come by.
    pub runs: f32,
    /// Rain between two of them, mm.
    pub period: f32,
    /// Height below the upper edge, m.
    pub height: f32,
}

/// A drop that a place is under.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlazingDrop {
    /// Of the place from the drop's middle, m, as if the drop were round.
    pub offset: Vec2,
    /// Radius of its edge, m; 0: there is none.
    pub radius: f32,
    /// Factor of its length down the pane.
    pub stretch: f32,
}

/// Water at a place of a pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlazingWater {
    /// Normal of its surface, toward the rain.
    pub normal: Vec3,
    /// Curvature, 1/m; 0: there is no drop.
    pub bend: f32,
}

impl GlazingDrop {
    const NONE: Self = Self { offset: Vec2::ZERO, radius: 0.0, stretch: 1.0 };
}

fn words(v: Vec4) -> [u32; 4] {
    v.to_array().map(f32::to_bits)
}

/// Rows of the table for rain on some panes.
#[must_use]
pub fn pane_rows(rain: &RenderGlazing, panes: &[GlazingPane]) -> Vec<[u32; 4]> {
    let mut rows = vec![words(Vec4::new(rain.before, rain.kept, rain.since, rain.rate))];
    rows.push([panes.len() as u32, 0, 0, 0]);
    rows.extend(panes.iter().flat_map(GlazingPane::rows));
    rows
}

/// Rows of the table for the panes of a weather at a time in s, for buffers relative to `origin`; none if all is dry.
pub(crate) fn rows(weather: &Weather, scene: &Scene, time_s: f64, origin: DVec3) -> Vec<[u32; 4]> {
    let (false, Some(at)) = (weather.panes.is_empty(), weather.wetness_at(time_s)) else { return Vec::new() };
    let storage_mm = weather.wetness.storage_m * 1.0e3;
    let rate_mm_h = weather.rates_mm_h().at(time_s);
    let [before, since] = [at.before, at.since].map(|doses| (doses * storage_mm) as f32);
    let panes: Vec<GlazingPane> =
        weather.panes.iter().flat_map(|pane| GlazingPane::of(pane, scene, origin)).collect();
    let rate = (rate_mm_h / 3600.0) as f32;
    let rain = RenderGlazing { before, kept: at.kept as f32, since, rate, count: panes.len() as u32 };
    pane_rows(&rain, &panes)
}

impl GlazingPane {
    /// A pane of a weather over a scene: one for each material of its name.
    fn of(pane: &ScenePane, scene: &Scene, origin: DVec3) -> Vec<Self> {
        let named = |name: &String| {
            let all = scene.materials.iter().enumerate();
            all.filter(|(_, material)| material.name == *name).map(|(index, _)| index as u32).collect()
        };
        let materials = pane.material.as_ref().map_or_else(|| vec![SCENE_NONE], named);
        let at = pane.rectangle.unwrap_or_default();
        let outward = at.outward().as_vec3();
        let across = Vec3::Y.cross(outward).try_normalize().unwrap_or(Vec3::X);
        let of_material = |material| Self {
            material,
            height: pane.rectangle.map_or(pane.height_m, |at| at.size_m[1]) as f32,
            largest: (0.5 * pane.largest_m) as f32,
            seed: pane.seed,
            center: (at.center - origin).as_vec3(),
            half_width: pane.rectangle.map_or(0.0, |at| 0.5 * at.size_m[0]) as f32,
            across,
            half_height: (0.5 * at.size_m[1]) as f32,
            outward,
            half_thickness: HALF_THICKNESS_M,
        };
        materials.into_iter().map(of_material).collect()
    }

    fn rows(&self) -> [[u32; 4]; GLAZING_ROWS as usize] {
        [
            [self.material, self.height.to_bits(), self.largest.to_bits(), self.seed],
            words(self.center.extend(self.half_width)),
            words(self.across.extend(self.half_height)),
            words(self.outward.extend(self.half_thickness)),
        ]
    }
}

/// True if a place of a material, which lets light through or does not, is on a pane.
#[must_use]
pub fn glazing_holds(pane: &GlazingPane, material: u32, position: Vec3, clear: bool) -> bool {
    let is_other = if pane.material == SCENE_NONE { !clear } else { pane.material != material };
    if is_other {
        return false;
    }
    if pane.half_width <= 0.0 {
        return true;
    }
    let from = position - pane.center;
    let down = pane.across.cross(pane.outward);
    from.dot(pane.across).abs() <= pane.half_width
        && from.dot(down).abs() <= pane.half_height
        && from.dot(pane.outward).abs() <= pane.half_thickness
}

/// The direction of a surface in steps of about an eighth of a turn: curved glass has the same axes from triangle to triangle.
#[must_use]
pub fn glazing_facing(facet: Vec3) -> Vec3 {
    let steps = (facet / facet.abs().max_element() + 0.5).floor();
    steps / steps.dot(steps).sqrt()
}

/// Direction down a surface of such a direction.
#[must_use]
pub fn glazing_down(facing: Vec3) -> Vec3 {
    let along = facing * facing.y - Vec3::Y;
    let length = along.dot(along).sqrt();
    // On level glass, as if it fell to the north.
    if length < 0.1 { Vec3::NEG_Z } else { along / length }
}

/// A number from -1 to 1 that changes smoothly along a line of cells.
#[must_use]
pub fn glazing_wander(at: f32, lane: i32, track: i32, seed: u32) -> f32 {
    let low = at.floor();
    let f = at - low;
    let cell = low as i32;
    let number = |cell: i32| rng_unit(rng_pcg4d([cell as u32, lane as u32, track as u32, seed])[0]);
    let (a, b) = (number(cell), number(cell.wrapping_add(1)));
    2.0 * (a + (b - a) * (f * f * (3.0 - 2.0 * f))) - 1.0
}

/// Position of a track of a lane at a height in m: distance to the right of the middle of its lane, m.
#[must_use]
pub fn glazing_track(height: f32, lane: i32, track: i32, seed: u32) -> f32 {
    GLAZING_LANE * GLAZING_SWAY * glazing_wander(height / GLAZING_TURN, lane, track, seed)
}

/// Part of the time between two runs by which a run is late; height at which it begins, over that of the pane; size of its head, over
/// the largest.
#[must_use]
pub fn glazing_run(lane: i32, run: i32, seed: u32) -> Vec3 {
    let [x, y, z, _] = rng_pcg4d([lane as u32, run as u32, seed, GLAZING_DIMENSION]);
    Vec3::new(GLAZING_LATE * rng_unit(x), GLAZING_START * rng_unit(y), 1.0 - GLAZING_SMALLER * rng_unit(z))
}

/// The runs of the lane of a place.
#[must_use]
pub fn glazing_lane(place: &GlazingPlace, at: Vec2, pane: &GlazingPane) -> GlazingLane {
    let lane = (at.x / GLAZING_LANE).floor() as i32;
    // What meets the lane over half the pane's height, in runs.
    let period = GLAZING_RUN_M3 * 1.0e3 / (GLAZING_LANE * 0.5 * pane.height);
    let phase = rng_unit(rng_pcg4d([lane as u32, pane.seed, 0, GLAZING_DIMENSION])[0]);
    // They are on their way for so long.
    let late = place.rate * at.y / GLAZING_SPEED;
    GlazingLane { lane, runs: (place.met - late) / period + phase, period, height: at.y }
}

/// Rain since a place was swept, mm.
#[must_use]
pub fn glazing_age(place: &GlazingPlace, at: Vec2, pane: &GlazingPane) -> f32 {
    let lane = glazing_lane(place, at, pane);
    let aside = at.x - (lane.lane as f32 + 0.5) * GLAZING_LANE;
    let mut age = place.met.min((GLAZING_TRACKS * GLAZING_RUNS) as f32 * lane.period);
    let mut run = lane.runs.floor() as i32;
    if lane.runs - (run as f32) < glazing_run(lane.lane, run, pane.seed).x {
        run -= 1;
    }
    let newest = (run as f32 / GLAZING_RUNS as f32).floor() as i32;
    for k in 0..GLAZING_TRACKS as i32 {
        let track = newest - k;
        // Of an old track, its last run.
        let last = run.min((track + 1) * GLAZING_RUNS as i32 - 1);
        if last < 0 {
            break;
        }
        let drawn = glazing_run(lane.lane, last, pane.seed);
        let distance = aside - glazing_track(lane.height, lane.lane, track, pane.seed);
        if lane.height > glazing_run(lane.lane, track, pane.seed).y * pane.height
            && distance.abs() < GLAZING_SWEEP * pane.largest
        {
            age = age.min((lane.runs - last as f32 - drawn.x) * lane.period);
            break;
        }
    }
    age.max(0.0)
}

/// Height of a drop over the plane of its edge at an offset, m; below 0 beside it.
#[must_use]
pub fn glazing_cap(offset: Vec2, radius: f32) -> f32 {
    let sphere = radius / GLAZING_SINE;
    let rest = sphere * sphere - offset.dot(offset);
    rest.max(0.0).sqrt() - sphere * GLAZING_COSINE
}

/// The higher of two drops at a place.
#[must_use]
pub fn glazing_higher(a: GlazingDrop, b: GlazingDrop) -> GlazingDrop {
    let is_higher = b.radius > 0.0
        && (a.radius <= 0.0 || glazing_cap(b.offset, b.radius) > glazing_cap(a.offset, a.radius));
    if is_higher { b } else { a }
}

/// The drop of a cell of a size in m, if a place is under it. `turn`: cosine and sine of the angle by which the cells are turned.
#[must_use]
pub fn glazing_still(
    place: &GlazingPlace,
    pane: &GlazingPane,
    level: u32,
    cell: f32,
    turn: Vec2,
) -> GlazingDrop {
    let turned =
        Vec2::new(place.at.x * turn.x + place.at.y * turn.y, place.at.y * turn.x - place.at.x * turn.y);
    let mut at = turned / cell;
    // Each line of cells begins elsewhere: no columns are seen.
    let line = at.y.floor() as i32 as u32;
    let stagger = rng_unit(rng_pcg4d([line, pane.seed, level, GLAZING_DIMENSION])[0]);
    at.x += stagger;
    let low = at.floor();
    let [column, line] = [low.x, low.y].map(|k| k as i32 as u32);
    let [x, y, z, w] = rng_pcg4d([column, line, pane.seed, GLAZING_DIMENSION + 1 + level]).map(rng_unit);
    if w > GLAZING_PRESENT {
        return GlazingDrop::NONE;
    }
    // Small ones are many.
    let widest = (GLAZING_MAX_RADIUS * cell * (0.3 + 0.7 * z * z)).min(pane.largest);
    let stray = (Vec2::new(x, y) - 0.5) * (1.0 - 2.0 * GLAZING_MAX_STRETCH * widest / cell);
    let along = (low + 0.5 + stray - Vec2::new(stagger, 0.0)) * cell;
    let middle = Vec2::new(along.x * turn.x - along.y * turn.y, along.x * turn.y + along.y * turn.x);
    let age = glazing_age(place, middle, pane);
    // What has dried is missing in drops that are older than the pause.
    let left = if age > place.since { place.kept } else { 1.0 };
    // The cell's share of the rain, as a cap.
    let volume = 1.0e-3 * age * left * cell * cell * GLAZING_SHARE;
    let third = 1.0 / 3.0;
    let radius = ops::pow(volume / GLAZING_VOLUME, third).min(widest * ops::pow(left, third));
    if radius < GLAZING_MIN_RADIUS {
        return GlazingDrop::NONE;
    }
    let stretch = 1.0 + (GLAZING_MAX_STRETCH - 1.0) * radius / pane.largest;
    let from = place.at - middle;
    let offset = Vec2::new(from.x, from.y / stretch);
    if offset.dot(offset) >= radius * radius {
        return GlazingDrop::NONE;
    }
    GlazingDrop { offset, radius, stretch }
}

/// The head of a run, if a place is under it.
#[must_use]
pub fn glazing_runner(place: &GlazingPlace, pane: &GlazingPane) -> GlazingDrop {
    let mut found = GlazingDrop::NONE;
    let lane = glazing_lane(place, place.at, pane);
    let aside = place.at.x - (lane.lane as f32 + 0.5) * GLAZING_LANE;
    let near = lane.runs.floor() as i32;
    for k in 0..3 {
        let run = near - 1 + k;
        let drawn = glazing_run(lane.lane, run, pane.seed);
        // Below the place, m.
        let ahead = (lane.runs - run as f32 - drawn.x) * lane.period * GLAZING_SPEED / place.rate.max(1.0e-9);
        let radius = pane.largest * GLAZING_HEAD * drawn.z;
        if run < 0 || ahead.abs() > 3.0 * radius {
            continue;
        }
        let track = (run as f32 / GLAZING_RUNS as f32).floor() as i32;
        let height = lane.height + ahead;
        if height < glazing_run(lane.lane, track, pane.seed).y * pane.height {
            continue;
        }
        let stretch = if ahead > 0.0 { GLAZING_TAIL } else { 1.0 };
        let x = aside - glazing_track(height, lane.lane, track, pane.seed);
        let offset = Vec2::new(x, -ahead / stretch);
        if offset.dot(offset) < radius * radius {
            found = glazing_higher(found, GlazingDrop { offset, radius, stretch });
        }
    }
    found
}

/// The place of a position on a pane whose facet, toward the rain, meets a flux of it, relative to level ground.
#[must_use]
pub fn glazing_place(
    rain: &RenderGlazing,
    pane: &GlazingPane,
    position: Vec3,
    shift: Vec3,
    facet: Vec3,
    flux: f32,
) -> GlazingPlace {
    let (across, down, at);
    if pane.half_width > 0.0 {
        (across, down) = (pane.across, pane.across.cross(pane.outward));
        let from = position - pane.center;
        at = Vec2::new(from.dot(across) + pane.half_width, from.dot(down) + pane.half_height);
    } else {
        let facing = glazing_facing(facet);
        down = glazing_down(facing);
        across = facing.cross(down);
        let from = position + shift;
        let line = from.dot(down) / pane.height;
        at = Vec2::new(from.dot(across), (line - line.floor()) * pane.height);
    }
    GlazingPlace {
        at,
        across,
        down,
        met: (rain.before + rain.since) * flux,
        since: rain.since * flux,
        rate: rain.rate * flux,
        kept: rain.kept,
    }
}

/// The drop that a place is under.
#[must_use]
pub fn glazing_drop(place: &GlazingPlace, pane: &GlazingPane) -> GlazingDrop {
    let mut found = glazing_runner(place, pane);
    let mut cell = GLAZING_FINE;
    let mut turn = Vec2::new(0.8, 0.6);
    for level in 0..GLAZING_LEVELS {
        found = glazing_higher(found, glazing_still(place, pane, level, cell, turn));
        cell *= GLAZING_COARSER;
        turn = Vec2::new(turn.x * 0.8 - turn.y * 0.6, turn.x * 0.6 + turn.y * 0.8);
    }
    found
}

/// Water of a drop, as a footprint (m) shows it.
#[must_use]
pub fn glazing_water(place: &GlazingPlace, found: &GlazingDrop, facet: Vec3, footprint: f32) -> GlazingWater {
    if found.radius <= 0.0 {
        return GlazingWater { normal: facet, bend: 0.0 };
    }
    let seen = (1.5 - GLAZING_FADE * footprint / found.radius).clamp(0.0, 1.0);
    let sphere = found.radius / GLAZING_SINE;
    let root = (sphere * sphere - found.offset.dot(found.offset)).max(1.0e-12).sqrt();
    let slope = Vec2::new(found.offset.x, found.offset.y / found.stretch) * (seen / root);
    // Both axes lie in the pane but for the steps of its direction.
    let normal = facet
        + (place.across - facet * place.across.dot(facet)) * slope.x
        + (place.down - facet * place.down.dot(facet)) * slope.y;
    GlazingWater { normal: normal / normal.dot(normal).sqrt(), bend: seen / sphere }
}

/// A pane as its gloss is seen with water on it: from the side of the rain the drop's.
pub(crate) fn glazing_surface(dry: &Surface, water: &GlazingWater) -> Surface {
    if water.bend <= 0.0 || dry.facet.dot(water.normal) <= 0.0 {
        return *dry;
    }
    Surface { normal: water.normal, bend: water.bend, ..*dry }
}

/// Factor of the light that a drop lets through, which mirrors more or less of it (`gloss`) than the pane does: no light is lost or made.
pub(crate) fn glazing_open(surface: &Surface, gloss: Vec3, along: Vec3, open: Vec3) -> Vec3 {
    let sharp = surface.roughness < PATH_SHARP;
    let cosine = surface.facet.dot(along).abs();
    let dry = scatter_gloss(surface.normal_reflectance, surface.roughness, cosine, sharp);
    (Vec3::ONE - (gloss - dry * surface.occlusion) / open.max(Vec3::splat(0.05))).max(Vec3::ZERO)
}

/// Direction beyond a pane of a ray that has met water of a normal on a facet that both are toward the rain. What is reflected within
/// goes back to where it came from.
#[must_use]
pub fn glazing_through(along: Vec3, normal: Vec3, facet: Vec3) -> Vec3 {
    let (mut first, second) = if along.dot(facet) < 0.0 { (normal, facet) } else { (-facet, -normal) };
    // A slope that a ray from aside does not meet.
    if along.dot(first) > -0.02 {
        first -= along * (along.dot(first) + 0.02);
        first /= first.dot(first).sqrt();
    }
    let (within, _) = optics_refract(along.to_array(), first.to_array(), 1.0 / PUDDLE_WATER_INDEX);
    let (out, squared) = optics_refract(within, second.to_array(), PUDDLE_WATER_INDEX);
    if squared <= 0.0 {
        return optics_reflect(along.to_array(), first.to_array()).into();
    }
    out.into()
}

impl SceneData {
    /// Reads the rain.
    fn glazing_load(&self) -> RenderGlazing {
        let first = self.glazing as usize;
        let [before, kept, since, rate] = self.table[first].map(f32::from_bits);
        RenderGlazing { before, kept, since, rate, count: self.table[first + 1][0] }
    }

    /// Reads a pane.
    fn glazing_pane(&self, index: u32) -> GlazingPane {
        let first = (self.glazing + 2 + index * GLAZING_ROWS) as usize;
        let [material, height, largest, seed] = self.table[first];
        let numbers = |k: usize| Vec4::from(self.table[first + k].map(f32::from_bits));
        let (center, across, outward) = (numbers(1), numbers(2), numbers(3));
        GlazingPane {
            material,
            height: f32::from_bits(height),
            largest: f32::from_bits(largest),
            seed,
            center: center.truncate(),
            half_width: center.w,
            across: across.truncate(),
            half_height: across.w,
            outward: outward.truncate(),
            half_thickness: outward.w,
        }
    }
}

impl SceneView<'_> {
    /// Water on a surface of a material, seen along a direction: its normal is toward the rain.
    pub(crate) fn glazing_find(
        &self,
        surface: &Surface,
        material: u32,
        footprint: f32,
        wet: &RenderWet,
    ) -> GlazingWater {
        let (frame, data) = (self.frame, self.data);
        let rain = data.glazing_load();
        // Toward the side that the rain comes from.
        let facet = if surface.facet.dot(wet.towards) > 0.0 { surface.facet } else { -surface.facet };
        let none = GlazingWater { normal: facet, bend: 0.0 };
        let flux = facet.dot(wet.towards) / wet.towards.y.max(0.05);
        if flux < GLAZING_MIN_FLUX {
            return none;
        }
        let clear = surface.transmission > 0.0;
        let held = |pane: &GlazingPane| glazing_holds(pane, material, surface.position, clear);
        let Some(pane) = (0..rain.count).map(|index| data.glazing_pane(index)).find(held) else {
            return none;
        };
        let place = glazing_place(&rain, &pane, surface.position, wet.shift, facet, flux);
        let found = glazing_drop(&place, &pane);
        if found.radius <= 0.0 {
            return none;
        }
        let start = surface.position + facet * frame.nearest;
        let along = wet_arrival(wet.towards, surface.position + wet.shift);
        if data.surface_blocker(start, along, frame.nearest, BVH_FAR).is_some() {
            return none;
        }
        glazing_water(&place, &found, facet, footprint)
    }
}

#[cfg(test)]
mod tests;
