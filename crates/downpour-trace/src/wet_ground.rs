//! The puddles of a weather, from picture to picture.

use std::sync::Arc;

use downpour_drop::distribution::DropSizeDistribution;
use downpour_lattice::puddle::PuddleForm;
use downpour_scene::picture::{Picture, Pixels};
use downpour_sim::field::RainField;
use downpour_sim::impacts::Impact;
use downpour_weather::{Loaded, Puddle, PuddleFill, PuddleRings, PuddleShape, Waves, Weather};
use glam::{DVec3, Vec2, Vec3};

use crate::frame_scene::FrameScene;
use crate::puddle::{
    FillLimits, Filling, Ground, PuddleError, PuddleGround, PuddleLook, PuddleMap, PuddleRows, RainOnWater,
    Region, Relief, RingRows, Rings, Ripples, Wakes, moving_triangles,
};

/// Mixed into the rain's seed, so that drops on water are not the drops in the air.
const SEED: u64 = 0x7075_6464_6c65_0001;

/// Depth of rain by which the water of a picture may be behind, m: maps are not made anew for each picture.
const STEP_M: f64 = 2.0e-5;

/// Step of the runoff of water that runs, m/s: 0.1 mm/h.
const RUNOFF_STEP: f64 = 1.0e-4 / 3600.0;

/// A puddle that the rain fills, or keys do.
#[derive(Debug)]
struct Filled {
    /// Index of the puddle.
    index: usize,
    ground: PuddleGround,
    limits: FillLimits,
    /// What fills it.
    fill: PuddleFill,
    /// The present state.
    state: WaterState,
    /// Present levels of the hollows.
    levels: Vec<Option<f32>>,
}

/// What the water of a puddle is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WaterState {
    /// Water in its hollows.
    filling: Filling,
    /// Runoff of the water that runs, m/s.
    runoff: f32,
}

impl WaterState {
    /// That of a puddle at a time.
    fn at(weather: &Weather, index: usize, fill: PuddleFill, time_s: f64) -> Self {
        match fill {
            PuddleFill::Part(_) => Self { filling: given(weather, index, time_s), runoff: 0.0 },
            PuddleFill::Rain { seepage, running } => {
                let runoff = if running { weather.runoff_rate(seepage, time_s) } else { 0.0 };
                let runoff = ((runoff / RUNOFF_STEP).round() * RUNOFF_STEP) as f32;
                Self { filling: filling(weather, seepage, time_s), runoff }
            }
        }
    }

    /// The map of this water on its ground, with hollows filled to some levels.
    fn map(&self, ground: &PuddleGround, levels: &[Option<f32>], limits: &FillLimits) -> PuddleMap {
        ground.with_levels(levels, ground.running(levels, self.runoff, limits).as_ref())
    }
}

/// Puddles of a weather on the ground of its scene.
#[derive(Debug)]
pub struct WetGround {
    weather: Weather,
    puddles: Vec<(PuddleMap, PuddleLook)>,
    filled: Vec<Filled>,
    /// Origin of the maps' positions.
    origin: DVec3,
    /// Present time, s.
    time_s: f64,
    ripples: Ripples,
    /// Sizes of the drops at the largest rate; `None` without rain.
    law: Option<DropSizeDistribution>,
    /// Made for the first rain in closed form.
    rings: Option<Rings>,
    /// Rings of the present picture.
    shown: Option<RingRows>,
    /// Of a scene that moves: its waves, and for each node whether it moves.
    wakes: Option<(Wakes, Vec<bool>)>,
}

/// Puddles on which drops make rings.
#[derive(Clone, Copy, Debug)]
pub struct RingedWater<'a> {
    puddles: &'a [(PuddleMap, PuddleLook)],
    origin: DVec3,
}

impl RingedWater<'_> {
    /// True if what has landed on the ground at a position in the world, m, is in the water of one.
    #[must_use]
    pub fn holds(&self, position: DVec3) -> bool {
        let at = (position - self.origin).as_vec3();
        self.puddles.iter().any(|(map, look)| look.has_rings() && map.is_in_water(at))
    }
}

impl WetGround {
    /// The puddles of a weather, if it has any, on the ground of a frame; `first_s` is the time of the first picture. What
    /// moves afterwards leaves them where they are.
    ///
    /// # Errors
    /// [`PuddleError`] if the rain or the lattice of its ripples is invalid.
    pub fn new(
        weather: &Weather,
        loaded: &Loaded,
        frame_scene: &FrameScene,
        first_s: f64,
    ) -> Result<Option<Self>, PuddleError> {
        if weather.puddles.is_empty() {
            return Ok(None);
        }
        let rain = weather.heaviest_rain();
        let law = (rain.rate_mm_h > 0.0).then(|| rain.sizes()).transpose()?;
        let seed = rain.seed ^ SEED;
        let ripples = match (&law, weather.keys.rate()) {
            (Some(law), Some(rates)) => Ripples::changing(law, rates, seed, first_s)?,
            _ => Ripples::new(law.as_ref(), seed, first_s)?,
        };
        let form = match weather.waves {
            Waves::Water => PuddleForm::GravityCapillary,
            Waves::Membrane(speed) => PuddleForm::Membrane { speed_m_s: speed as f32 },
        };
        let ripples = if weather.waves == Waves::Water { ripples } else { ripples.with_form(form)? };
        let masks = loaded.masks.iter().map(Option::as_ref).chain(std::iter::repeat(None));
        let (mut puddles, mut filled) = (Vec::new(), Vec::new());
        // What moves is no ground.
        let standing = frame_scene.standing();
        for (index, (puddle, mask)) in weather.puddles.iter().zip(masks).enumerate() {
            let ground = ground(puddle, frame_scene);
            let map = match (&puddle.shape, mask) {
                (&PuddleShape::Found { fill, min_depth, relief, seed, cells }, _) => {
                    let relief = Relief { rms_m: relief as f32, seed };
                    let ground = PuddleGround::new(&standing, &ground, cells.map(|n| n as usize), &relief);
                    let limits = FillLimits { deepest: puddle.depth as f32, least: min_depth as f32 };
                    let state = WaterState::at(weather, index, fill, first_s);
                    let levels = ground.levels(&state.filling, &limits);
                    let map = state.map(&ground, &levels, &limits);
                    if matches!(fill, PuddleFill::Rain { .. }) || weather.keys.has_fill(index) {
                        filled.push(Filled { index, ground, limits, fill, state, levels });
                    }
                    map
                }
                (PuddleShape::Painted(_), Some(mask)) => {
                    let size = [mask.width as usize, mask.height as usize];
                    PuddleMap::painted(&standing, &ground, size, &depths(mask, puddle.depth as f32))
                }
                // A mask that was not loaded: nothing is painted.
                (PuddleShape::Painted(_), None) => PuddleMap::painted(&standing, &ground, [2, 2], &[0.0; 4]),
            };
            puddles.push((map, look(puddle, weather.waves)));
        }
        let wakes = loaded.is_animated().then(|| (Wakes::new(form), loaded.moving_nodes()));
        let (weather, origin) = (weather.clone(), frame_scene.origin);
        let (rings, shown, time_s) = (None, None, first_s);
        Ok(Some(Self { weather, puddles, filled, origin, time_s, ripples, law, rings, shown, wakes }))
    }

    /// Steps the rain, and what moves through the water, to a time in seconds; times must not decrease. `loaded` has the scene of
    /// [`WetGround::new`].
    ///
    /// # Errors
    /// As [`WetGround::new`].
    pub fn advance(&mut self, loaded: &Loaded, time_s: f64) -> Result<(), PuddleError> {
        for (index, (_, look)) in self.puddles.iter_mut().enumerate() {
            if let Some(influence) = self.weather.ripple_influence_at(index, time_s) {
                look.influence = influence as f32;
            }
        }
        for puddle in &mut self.filled {
            let now = WaterState::at(&self.weather, puddle.index, puddle.fill, time_s);
            if now == puddle.state {
                continue;
            }
            let levels = puddle.ground.levels(&now.filling, &puddle.limits);
            // Full hollows stay as they are.
            if levels != puddle.levels || now.runoff != puddle.state.runoff {
                self.puddles[puddle.index].0 = now.map(&puddle.ground, &levels, &puddle.limits);
                puddle.levels = levels;
            }
            puddle.state = now;
        }
        self.time_s = time_s;
        if let Some((wakes, moves)) = &mut self.wakes {
            let (weather, origin) = (&self.weather, self.origin);
            let moving = |time_s: f64, region: &Region| {
                moving_triangles(&loaded.scene, &loaded.pose(weather, time_s), origin, moves, region)
            };
            wakes.advance(time_s, &self.puddles, moving)?;
        }
        self.ripples.advance(time_s)
    }

    /// The puddles on which drops make rings; `None` if there are none.
    #[must_use]
    pub fn ringed(&self) -> Option<RingedWater<'_>> {
        let has_rings = self.law.is_some() && self.puddles.iter().any(|(_, look)| look.has_rings());
        has_rings.then_some(RingedWater { puddles: &self.puddles, origin: self.origin })
    }

    /// Finds the rings of single drops of a rain in closed form, and of drops that have dripped ([`Rings::asked`]), for a picture of a scene at
    /// a time in seconds.
    ///
    /// # Errors
    /// As [`WetGround::new`]; [`PuddleError::Sim`] for an eye or a time out of range.
    pub fn find_rings(
        &mut self,
        field: &Arc<RainField>,
        dripped: &[Impact],
        frame_scene: &FrameScene,
        time_s: f64,
    ) -> Result<(), PuddleError> {
        self.shown = None;
        let Some(heaviest) = self.law.as_ref().filter(|_| self.ringed().is_some()) else { return Ok(()) };
        let rings = match self.rings.take() {
            Some(rings) => rings,
            None => Rings::new(heaviest)?,
        };
        let rings = self.rings.insert(rings);
        let changes = self.weather.keys.rate().is_some();
        let sizes = changes.then(|| self.weather.rain_at(time_s).sizes()).transpose()?;
        let eye = frame_scene.origin + frame_scene.viewpoint.eye.as_dvec3();
        let rain = RainOnWater { field, sizes: sizes.as_ref(), time_s, eye, dripped };
        self.shown = Some(rings.find(&rain, &self.puddles, self.origin)?);
        Ok(())
    }

    /// Holds and steps the ripples on a device from now on, beginning with level water: to be called before the first
    /// [`WetGround::advance`]. After an error they stay where they are.
    ///
    /// # Errors
    /// [`PuddleError::Gpu`]: what the device says.
    #[cfg(feature = "wgpu")]
    pub fn move_to_device(
        &mut self,
        kernels: &downpour_lattice::gpu::puddle::PuddleKernels,
    ) -> Result<(), PuddleError> {
        self.ripples.move_to_device(kernels)
    }

    /// True if a device holds the ripples: then the CPU sees level water in frames.
    #[must_use]
    pub fn is_on_device(&self) -> bool {
        self.ripples.is_on_device()
    }

    /// Sets the puddles of a frame to the present state of the water. Ripples on a device are those that the device has when it draws the
    /// frame, which has to be before the next [`WetGround::advance`].
    pub fn lay(&self, frame_scene: &mut FrameScene) {
        frame_scene.data.set_puddles(&PuddleRows {
            puddles: &self.puddles,
            shape: self.ripples.shape(),
            slopes: &self.ripples.slopes(),
            shift: (self.origin - frame_scene.origin).as_vec3(),
            rings: self.shown.as_ref(),
            wakes: &self.wakes.as_ref().map_or_else(Vec::new, |(wakes, _)| wakes.rows(&self.puddles)),
            time_s: self.time_s,
        });
        #[cfg(feature = "wgpu")]
        {
            frame_scene.data.ripples = self.ripples.on_device();
        }
    }

    /// Maps of the water of each puddle.
    pub fn maps(&self) -> impl Iterator<Item = &PuddleMap> {
        self.puddles.iter().map(|(map, _)| map)
    }
}

/// The rectangle of a puddle.
fn ground(puddle: &Puddle, frame_scene: &FrameScene) -> Ground {
    Ground {
        middle: (DVec3::from(puddle.middle) - frame_scene.origin).as_vec3(),
        size: Vec2::from(puddle.size.map(|edge| edge as f32)),
        turn: puddle.turn as f32,
        reach: puddle.reach as f32,
    }
}

/// The water of a puddle whose fill is given, at a time.
fn given(weather: &Weather, index: usize, time_s: f64) -> Filling {
    let now = weather.at(time_s);
    match now.puddles.get(index).map(|puddle| &puddle.shape) {
        Some(&PuddleShape::Found { fill: PuddleFill::Part(part), .. }) => Filling::Fraction(part as f32),
        _ => Filling::Fraction(1.0),
    }
}

/// The water that the rain of a weather has brought to hollows at a time: a function of time alone, in steps. Hollows under surfaces
/// whose wetness is given, or that rain does not wet, are full.
fn filling(weather: &Weather, seepage: f64, time_s: f64) -> Filling {
    let Some([before, lost, since]) = weather.runoff(seepage, time_s) else {
        return Filling::Fraction(1.0);
    };
    let stepped = |depth: f64| ((depth / STEP_M).floor() * STEP_M) as f32;
    Filling::Rain { before_m: before as f32, lost_m: stepped(lost), since_m: stepped(since) }
}

/// Depths from the red of a picture, linear: 1 is `deepest`.
fn depths(mask: &Picture, deepest: f32) -> Vec<f32> {
    match &mask.pixels {
        Pixels::Rgba8(pixels) => pixels.iter().map(|p| f32::from(p[0]) / 255.0 * deepest).collect(),
        Pixels::RgbaF32(pixels) => pixels.iter().map(|p| p[0].clamp(0.0, 1.0) * deepest).collect(),
    }
}

fn look(puddle: &Puddle, waves: Waves) -> PuddleLook {
    PuddleLook {
        scale: puddle.ripple_scale as f32,
        angle: puddle.ripple_turn as f32,
        influence: puddle.ripple_influence as f32,
        scattering_albedo: Vec3::from(puddle.color.map(|part| part as f32)),
        extinction: (1.0 / puddle.attenuation_length) as f32,
        // The rings of single drops are those of waves on water.
        rings: puddle.rings == PuddleRings::Drops && waves == Waves::Water,
        ..PuddleLook::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, time_s: f64) -> [f32; 3] {
        let weather = Weather::parse("w.toml", text).expect("a weather");
        match filling(&weather, 0.0, time_s) {
            Filling::Rain { before_m, lost_m, since_m } => [before_m, lost_m, since_m],
            Filling::Fraction(part) => panic!("filled to {part}"),
        }
    }

    /// 30 mm/h bring 5 mm in ten minutes, of which 0.3 mm stay where they fall, and 0.5 mm in each minute from then on.
    #[test]
    fn puddles_fill_with_the_rain_and_dry_after_it() {
        let rain = "[rain]\nrate_mm_h = 30";
        let mut last = 0.0;
        for minute in 0..60u8 {
            let [before, lost, since] = at(rain, 60.0 * f64::from(minute));
            assert!((before - 4.7e-3).abs() < 1.0e-6 && lost == 0.0 && since >= last);
            assert!((since - 0.5e-3 * f32::from(minute)).abs() < 2.1e-5, "{minute}: {since}");
            last = since;
        }
        let dry = "[rain]\nrate_mm_h = 0\n[wetness]\nrained_mm = 5";
        let [before, lost, since] = at(dry, 3600.0);
        // 0.3 mm in 9400 s.
        assert!((before - 4.7e-3).abs() < 1.0e-6 && since == 0.0);
        assert!((lost - 0.115e-3).abs() < 2.1e-5, "{lost}");
    }

    #[test]
    fn a_keyed_fill_is_that_of_the_time() {
        let text = "[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [1, 1]\nfill = [[0, 0], [8, 1]]";
        let weather = Weather::parse("w.toml", text).expect("a weather");
        let found = [-1.0, 0.0, 2.0, 9.0].map(|time| given(&weather, 0, time));
        assert_eq!(found, [0.0, 0.0, 0.25, 1.0].map(Filling::Fraction));
    }

    #[test]
    fn where_wetness_is_given_hollows_are_full() {
        for text in ["[wetness]\nwetness = 0.5", "[wetness]\nenabled = false"] {
            let weather = Weather::parse("w.toml", text).expect("a weather");
            assert_eq!(filling(&weather, 0.0, 9.0), Filling::Fraction(1.0), "{text}");
        }
    }
}
