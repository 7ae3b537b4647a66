//! The puddles of a weather, from picture to picture.

use downpour_scene::picture::{Picture, Pixels};
use downpour_weather::{Loaded, Puddle, PuddleShape, Weather};
use glam::{DVec3, Vec2, Vec3};

use crate::puddle::{Ground, PuddleError, PuddleLook, PuddleMap, PuddleRows, Relief, Ripples};
use crate::stage::Stage;

/// Mixed into the rain's seed, so that drops on water are not the drops in the air.
const SEED: u64 = 0x7075_6464_6c65_0001;

/// Puddles of a weather on the ground of its scene.
#[derive(Debug)]
pub struct WetGround {
    puddles: Vec<(PuddleMap, PuddleLook)>,
    /// Origin of the maps' positions.
    origin: DVec3,
    ripples: Ripples,
}

impl WetGround {
    /// The puddles of a weather, if it has any, on the ground of a stage; `first_s` is the time of the first picture. What
    /// moves afterwards leaves them where they are.
    ///
    /// # Errors
    /// [`PuddleError`] if the rain or the lattice of its ripples is invalid.
    pub fn new(
        weather: &Weather,
        loaded: &Loaded,
        stage: &Stage,
        first_s: f64,
    ) -> Result<Option<Self>, PuddleError> {
        if weather.puddles.is_empty() {
            return Ok(None);
        }
        let rain = &weather.rain;
        let law = (rain.rate_mm_h > 0.0).then(|| rain.sizes());
        let ripples = Ripples::new(law.transpose()?.as_ref(), rain.seed ^ SEED, first_s)?;
        let masks = loaded.masks.iter().map(Option::as_ref).chain(std::iter::repeat(None));
        let puddles =
            weather.puddles.iter().zip(masks).map(|(puddle, mask)| (map(puddle, mask, stage), look(puddle)));
        Ok(Some(Self { puddles: puddles.collect(), origin: stage.origin, ripples }))
    }

    /// Steps the rain to a time in seconds; times must not decrease.
    ///
    /// # Errors
    /// As [`WetGround::new`].
    pub fn advance(&mut self, time_s: f64) -> Result<(), PuddleError> {
        self.ripples.advance(time_s)
    }

    /// Sets the puddles of a stage to the present state of the water.
    pub fn lay(&self, stage: &mut Stage) {
        stage.data.set_puddles(&PuddleRows {
            puddles: &self.puddles,
            shape: self.ripples.shape(),
            slopes: &self.ripples.slopes(),
            shift: (self.origin - stage.origin).as_vec3(),
        });
    }

    /// Maps of the water of each puddle.
    pub fn maps(&self) -> impl Iterator<Item = &PuddleMap> {
        self.puddles.iter().map(|(map, _)| map)
    }
}

/// Map of the water of a puddle.
fn map(puddle: &Puddle, mask: Option<&Picture>, stage: &Stage) -> PuddleMap {
    let ground = Ground {
        middle: (DVec3::from(puddle.middle) - stage.origin).as_vec3(),
        size: Vec2::from(puddle.size.map(|edge| edge as f32)),
        turn: puddle.turn as f32,
        reach: puddle.reach as f32,
    };
    match (&puddle.shape, mask) {
        (&PuddleShape::Found { fill, min_depth: least, relief, seed, cells }, _) => {
            let relief = Relief { rms_m: relief as f32, seed };
            let numbers = [fill, puddle.depth, least].map(|number| number as f32);
            PuddleMap::found(&stage.data, &ground, cells.map(|n| n as usize), &relief, numbers)
        }
        (PuddleShape::Painted(_), Some(mask)) => {
            let size = [mask.width as usize, mask.height as usize];
            PuddleMap::painted(&stage.data, &ground, size, &depths(mask, puddle.depth as f32))
        }
        // A mask that was not loaded: nothing is painted.
        (PuddleShape::Painted(_), None) => PuddleMap::painted(&stage.data, &ground, [2, 2], &[0.0; 4]),
    }
}

/// Depths from the red of a picture, linear: 1 is `deepest`.
fn depths(mask: &Picture, deepest: f32) -> Vec<f32> {
    match &mask.pixels {
        Pixels::Rgba8(pixels) => pixels.iter().map(|p| f32::from(p[0]) / 255.0 * deepest).collect(),
        Pixels::RgbaF32(pixels) => pixels.iter().map(|p| p[0].clamp(0.0, 1.0) * deepest).collect(),
    }
}

fn look(puddle: &Puddle) -> PuddleLook {
    PuddleLook {
        scale: puddle.ripple_scale as f32,
        angle: puddle.ripple_turn as f32,
        influence: puddle.ripple_influence as f32,
        scattering_albedo: Vec3::from(puddle.color.map(|part| part as f32)),
        extinction: (1.0 / puddle.attenuation_length) as f32,
        ..PuddleLook::default()
    }
}
