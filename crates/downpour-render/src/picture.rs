//! A whole picture: the scene, and the rain before it.
//!
//! [`render_picture`] makes it on the CPU, [`gpu::PictureRenderer`](crate::gpu::PictureRenderer) on a GPU: the same
//! passes over the same buffers.

use std::time::Instant;

use downpour_math::rng::rng_draw;
use downpour_sim::field::FallingDrop;

use crate::RenderError;
use crate::camera::Viewpoint;
use crate::data::{RenderFrame, SceneData};
use crate::rain::light::DropLightForm;
use crate::rain::{DropMasks, Rain, RainOptions};
use crate::scene::SceneView;

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

/// What a picture costs and how it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureOptions {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Samples along an edge of a pixel, 1 to 16.
    pub grid: u32,
    /// Rays to the sky per sample; 0: nothing hides the sky.
    pub sky_rays: u32,
    /// Seed of the rays: [`noise_seed`] for the frames of a clip.
    pub seed: u64,
    /// How drops are drawn.
    pub rain: RainOptions,
}

impl Default for PictureOptions {
    /// 1280 x 720 pixels of 2 x 2 samples with a ray to the sky each.
    fn default() -> Self {
        Self { size: [1280, 720], grid: 2, sky_rays: 1, seed: 0, rain: RainOptions::default() }
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
    /// What is round the eye, all levels of an octahedral map.
    pub surroundings: Vec<[f32; 4]>,
    /// The scene through the rain and through a pane of glass, if there is one.
    pub through_glass: Option<Vec<[f32; 3]>>,
    /// The passes in their order, with the milliseconds that each took.
    pub passes: Vec<(&'static str, f64)>,
}

impl Picture {
    /// Puts the layers together.
    pub(crate) fn new(
        rain: &Rain,
        clean: Vec<[f32; 4]>,
        layer: Vec<[f32; 4]>,
        surroundings: Vec<[f32; 4]>,
        passes: Vec<(&'static str, f64)>,
    ) -> Self {
        Self {
            size: [rain.frame.width, rain.frame.height],
            drops_on_screen: rain.list.len(),
            drawn: rain.drawn(&clean),
            clean,
            rain: layer,
            surroundings,
            through_glass: None,
            passes,
        }
    }

    /// The scene through the rain with its distances: what stands behind a pane of glass.
    #[must_use]
    pub fn behind_glass(&self) -> Vec<[f32; 4]> {
        let distances = self.clean.iter().map(|pixel| pixel[3]);
        through_rain(&self.clean, &self.rain).zip(distances).map(|([r, g, b], d)| [r, g, b, d]).collect()
    }

    /// The scene through the rain, and through the pane of glass if there is one.
    #[must_use]
    pub fn radiance(&self) -> Vec<[f32; 3]> {
        if let Some(seen) = &self.through_glass {
            return seen.clone();
        }
        through_rain(&self.clean, &self.rain).collect()
    }
}

/// Radiance of a scene through the rain before it, pixel by pixel: `clean * transmittance + rain`.
pub(crate) fn through_rain<'a>(
    clean: &'a [[f32; 4]],
    rain: &'a [[f32; 4]],
) -> impl Iterator<Item = [f32; 3]> + use<'a> {
    clean.iter().zip(rain).map(|(clean, rain)| std::array::from_fn(|k| clean[k] * rain[3] + rain[k]))
}

/// Runs a pass and notes its time.
pub(crate) fn timed<T>(
    passes: &mut Vec<(&'static str, f64)>,
    name: &'static str,
    work: impl FnOnce() -> T,
) -> T {
    let start = Instant::now();
    let made = work();
    passes.push((name, start.elapsed().as_secs_f64() * 1.0e3));
    made
}

/// The frame of a picture.
pub(crate) fn framed(
    scene: &SceneData,
    viewpoint: &Viewpoint,
    options: &PictureOptions,
) -> Result<RenderFrame, RenderError> {
    let frame = viewpoint.frame(scene, options.size, options.grid, options.sky_rays, options.seed)?;
    // What is worked out drop by drop is not in the capture too.
    let traced = matches!(options.rain.light.form, DropLightForm::Traced | DropLightForm::Atlas);
    let suns_out = u32::from(traced);
    Ok(RenderFrame { suns_out, ..frame })
}

/// Makes a picture on the CPU: the same bits for any number of threads.
///
/// # Errors
/// [`RenderError`] if the options cannot be met.
pub fn render_picture(
    scene: &SceneData,
    viewpoint: &Viewpoint,
    drops: &[FallingDrop],
    masks: &DropMasks,
    options: &PictureOptions,
) -> Result<Picture, RenderError> {
    let frame = framed(scene, viewpoint, options)?;
    let mut passes = Vec::new();
    let view = SceneView { data: scene, frame: &frame };
    let clean = timed(&mut passes, "scene", || view.picture());
    let eye = viewpoint.eye.as_dvec3();
    let rain = timed(&mut passes, "binning", || Rain::new(&frame, eye, drops, masks, &options.rain));
    let capture = timed(&mut passes, "capture", || rain.capture.trace(scene));
    let of_streaks = rain.streak_lights(scene, masks)?;
    let table = timed(&mut passes, "streaks", || {
        rain.streak_table(masks, &capture, &of_streaks.light(&rain.streak_rows()))
    });
    let lights = rain.lights(scene, masks)?;
    let light = timed(&mut passes, "lamps", || lights.light(&rain.rows));
    let medium = timed(&mut passes, "unresolved", || rain.medium_light(&lights).layer(&clean));
    let layer = timed(&mut passes, "drops", || rain.layer(&clean, masks, &capture, &table, &light, &medium));
    Ok(Picture::new(&rain, clean, layer, capture.texels, passes))
}
