//! A whole picture in layers: a plate, and the rain before it.

use std::time::Instant;

use downpour_math::rng::rng_draw;
use rayon::prelude::*;

use crate::RenderError;
use crate::camera::Camera;
use crate::glow::{Glow, GlowPlan};
use crate::plate::Plate;
use crate::rain::list::nearest_first;
use crate::rain::{DropMasks, Rain, RainOptions};

/// Dimension of the random numbers of a picture's seed.
const SEED_DIMENSION: u32 = 4120;

/// The seed of the rays of a picture of a time in seconds: each has a noise of its own, and a picture by itself has that of
/// the clip's frame of its time.
#[must_use]
pub fn noise_seed(seed: u64, time_s: f64) -> u64 {
    let time = time_s.to_bits();
    let [low, high, ..] =
        rng_draw([seed as u32, (seed >> 32) as u32], time as u32, (time >> 32) as u32, SEED_DIMENSION);
    u64::from(low) | u64::from(high) << 32
}

/// Options of a picture: size, samples and appearance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureOptions {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Samples along an edge of a pixel, 1 to 16.
    pub grid: u32,
    /// Rays to the sky per sample; 0: nothing hides the sky.
    pub sky_rays: u32,
    /// Distance in pixels between those whose rays look for the light of sky and surfaces, and of lamps on unresolved rain, which
    /// the pixels between take from them: 1 to 4; 1: all do.
    pub ray_spacing: u32,
    /// Seed of the rays: [`noise_seed`] for the frames of a clip.
    pub seed: u64,
    /// Options of the drawing of drops.
    pub rain: RainOptions,
    /// Light that goes beside its image.
    pub glow: Glow,
}

impl Default for PictureOptions {
    /// 1280 x 720 pixels of 2 x 2 samples with a ray to the sky each.
    fn default() -> Self {
        Self {
            size: [1280, 720],
            grid: 2,
            sky_rays: 1,
            ray_spacing: 1,
            seed: 0,
            rain: RainOptions::default(),
            glow: Glow::default(),
        }
    }
}

/// A picture in layers, rows from the top. Radiance is linear, in the unit of the sky.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns and rows.
    pub size: [u32; 2],
    /// The scene without rain: radiance, and the distance of what stands nearest (1e30 for the sky).
    pub clean: Vec<[f32; 4]>,
    /// The rain: radiance, and the transmittance of the scene behind it.
    pub rain: Vec<[f32; 4]>,
    /// Drops whose outline touches the picture.
    pub drops_on_screen: usize,
    /// Those of them that the scene does not hide altogether: their places among the drops that were given, nearest
    /// first.
    pub drawn: Vec<u32>,
    /// Environment map around the eye, all levels of an octahedral map.
    pub environment: Vec<[f32; 4]>,
    /// The scene through the rain and through a pane of glass, if there is one.
    pub through_glass: Option<Vec<[f32; 3]>>,
    /// Radiance that glow adds to each pixel, below 0 where it takes more than it brings; empty if nothing glows.
    pub glow: Vec<[f32; 4]>,
    /// The passes in their order, with the milliseconds that each took.
    pub passes: Vec<(&'static str, f64)>,
    /// Use of the device that drew it; `None` on the CPU.
    pub device: Option<DeviceUse>,
}

/// Use of a device for one picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DeviceUse {
    /// Bytes that were written to it.
    pub bytes_uploaded: u64,
    /// Buffers that were created.
    pub buffers_made: u64,
}

impl Picture {
    /// Puts the layers together.
    #[must_use]
    pub fn new(
        rain: &Rain,
        clean: Vec<[f32; 4]>,
        layer: Vec<[f32; 4]>,
        environment: Vec<[f32; 4]>,
        passes: Vec<(&'static str, f64)>,
    ) -> Self {
        Self {
            size: rain.frame.camera.size(),
            drops_on_screen: rain.list.len(),
            drawn: rain.drawn(&clean),
            clean,
            rain: layer,
            environment,
            through_glass: None,
            glow: Vec::new(),
            passes,
            device: None,
        }
    }

    /// The picture with the drops that a device has seen: for each that was given its distance, m; 0 where the scene hides all of it,
    /// below 0 where it is not on the picture.
    #[must_use]
    pub fn with_seen(self, distances: &[f32]) -> Self {
        Self {
            drops_on_screen: distances.iter().filter(|at| **at >= 0.0).count(),
            drawn: nearest_first(distances),
            ..self
        }
    }

    /// Adds a picture of the same scene in other light, which has drops of its own: radiance adds up, and what is transmitted stays
    /// that of this picture. So the rain may be below 0 where drops of the other picture hide its light.
    pub fn add_light(&mut self, other: &Self) {
        let pixels = self.clean.iter_mut().zip(&mut self.rain).zip(other.clean.iter().zip(&other.rain));
        for ((clean, rain), (light, drops)) in pixels {
            for k in 0..3 {
                rain[k] += drops[k] + light[k] * (drops[3] - rain[3]);
                clean[k] += light[k];
            }
        }
        if let (Some(seen), Some(light)) = (&mut self.through_glass, &other.through_glass) {
            for (seen, light) in seen.iter_mut().zip(light) {
                *seen = std::array::from_fn(|k| seen[k] + light[k]);
            }
        }
        for (glow, light) in self.glow.iter_mut().zip(&other.glow) {
            *glow = std::array::from_fn(|k| glow[k] + light[k]);
        }
    }

    /// Makes the glow of what is seen, through the pane of glass if there is one.
    pub fn add_glow(&mut self, glow: &Glow, camera: &Camera) {
        let plan = GlowPlan::new(glow, self.size, camera.pixel_angle);
        if plan.steps.is_empty() {
            return;
        }
        let made = match &self.through_glass {
            None => plan.glow(&self.clean, &self.rain),
            Some(seen) => {
                let behind = seen.iter().zip(&self.clean).map(|(&[r, g, b], plate)| [r, g, b, plate[3]]);
                plan.glow(&behind.collect::<Vec<_>>(), &vec![[0.0, 0.0, 0.0, 1.0]; seen.len()])
            }
        };
        self.glow = made;
    }

    /// The scene through the rain with its distances: what stands behind a pane of glass.
    #[must_use]
    pub fn behind_glass(&self) -> Vec<[f32; 4]> {
        self.clean.iter().zip(&self.rain).map(|(&clean, &rain)| compose_pixel(clean, rain)).collect()
    }

    /// The scene through the rain, and through the pane of glass if there is one, with its glow.
    #[must_use]
    pub fn radiance(&self) -> Vec<[f32; 3]> {
        let mut seen: Vec<[f32; 3]> = if let Some(seen) = &self.through_glass {
            seen.clone()
        } else {
            let behind = self.clean.par_iter().zip(&self.rain).with_min_len(4096);
            behind.map(|(&clean, &rain)| without_distance(compose_pixel(clean, rain))).collect()
        };
        seen.par_iter_mut().zip(&self.glow).with_min_len(4096).for_each(|(seen, glow)| {
            *seen = std::array::from_fn(|k| seen[k] + glow[k]);
        });
        seen
    }
}

fn without_distance([r, g, b, _]: [f32; 4]) -> [f32; 3] {
    [r, g, b]
}

/// Radiance of a scene through the rain before it, pixel by pixel: `clean * transmittance + rain`.
pub fn through_rain<'a>(
    clean: &'a [[f32; 4]],
    rain: &'a [[f32; 4]],
) -> impl Iterator<Item = [f32; 3]> + use<'a> {
    clean.iter().zip(rain).map(|(&clean, &rain)| without_distance(compose_pixel(clean, rain)))
}

/// A pixel of a plate (radiance and distance) through the rain (radiance and transmittance): the radiance that is seen, and the
/// plate's distance. Twin of the function of this name in `shaders/wgsl/render/compose.wgsl`.
#[must_use]
pub fn compose_pixel(plate: [f32; 4], rain: [f32; 4]) -> [f32; 4] {
    let [r, g, b] = std::array::from_fn(|k| plate[k] * rain[3] + rain[k]);
    [r, g, b, plate[3]]
}

/// The rain of a picture (radiance and transmittance) with all that is seen of another picture of the same scene in other light: its plate
/// through its own rain, and its glow. Twin of the function of this name in `shaders/wgsl/render/compose.wgsl`.
#[must_use]
pub fn compose_lit(rain: [f32; 4], plate: [f32; 4], other: [f32; 4], glow: [f32; 3]) -> [f32; 4] {
    let seen = compose_pixel(plate, other);
    let [r, g, b] = std::array::from_fn(|k| rain[k] + seen[k] + glow[k]);
    [r, g, b, rain[3]]
}

/// Runs a pass and notes its time.
pub fn timed<T>(passes: &mut Vec<(&'static str, f64)>, name: &'static str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let made = work();
    passes.push((name, start.elapsed().as_secs_f64() * 1.0e3));
    made
}

/// Rain before a plate on the CPU: the same bits for any number of threads. `rain` is made for the plate's camera. Returns the
/// rain's radiance with the transmittance of the scene behind it.
///
/// # Errors
/// [`RenderError`] if a lamp of the plate has no light, or the options cannot be met.
pub fn rain_layer(
    plate: &Plate<'_>,
    rain: &Rain,
    masks: &DropMasks,
    passes: &mut Vec<(&'static str, f64)>,
) -> Result<Vec<[f32; 4]>, RenderError> {
    let Plate { camera, pixels, environment, lighting } = *plate;
    debug_assert_eq!(rain.frame.camera, *camera, "rain is made for the camera of the plate");
    let of_streaks = rain.streak_lights(lighting, masks)?;
    let table = timed(passes, "streaks", || {
        rain.streak_table(masks, environment, &of_streaks.light(&rain.streak_rows()))
    });
    let lights = rain.lights(lighting, masks)?;
    let light = timed(passes, "lamps", || lights.light(&rain.rows));
    let medium = timed(passes, "unresolved", || rain.medium_light(&lights).layer(pixels));
    let mut layer =
        timed(passes, "drops", || rain.layer(pixels, masks, environment, &table, &light, &medium));
    if let Some(frame) = &rain.spray {
        timed(passes, "spray", || rain.add_spray(frame, &lights, (pixels, environment, &table), &mut layer));
    }
    if let Some(layers) = rain.layers {
        let layers = layers.lit(camera.eye, lighting);
        timed(passes, "layers", || layers.before(&rain.frame, pixels, environment, &mut layer));
    }
    Ok(layer)
}
