//! The streak of a specimen as the renderer of rain draws it: through masks, by its streak radiance table.
//!
//! Compared with [`render_specimen`](super::render_specimen), which traces every ray, it shows the error of the table: the same drop,
//! camera, exposure, oscillation and phases before the same map, drawn by [`rain`](downpour_render::rain) with the options of a picture
//! of a scene. Uncovered pixels show the map itself, sampled as there.
//!
//! A lamp at infinity is parallel light for the renderer, excluded from the environment capture: the profile of the streak looks up its
//! disk. A disk has to be small for that ([`MAX_TABLE_LAMP_DEG`]).
//!
//! Source: P. Rousseau et al., "GPU rainfall", 2008, section 2.2.3, for the oscillation of the outline; the table is
//! described in `shaders/wgsl/render/streak_lookup.wgsl`.

use downpour_math::OutOfRange;
use std::f32::consts::PI;

use downpour_drop::DropShape;
use downpour_drop::oscillation::{Amplitudes, drop_oscillation_phase};
use downpour_math::rng::seed_words;
use downpour_math::vector::{add, scale};
use downpour_scene::sky::{SUN_THRESHOLD, SkyMap};
use downpour_shaders::render::scene::{SCENE_FAR, SCENE_SKY_LEVELS};
use downpour_sim::field::{DropKind, FallingDrop};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::motion::fall_speed;
use super::options::SpecimenOptions;
use super::render::{View, empty, views};
use super::sky::{Sky, specimen_sky_light};
use super::trace::specimen_ray;
use super::{Image, SpecimenError, SpecimenLamp};
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::picture::{PictureOptions, through_rain};
use downpour_render::rain::drop_glint_right;
use downpour_render::rain::light::DropLights;
use downpour_render::rain::{DIAMETER_STEP, DIAMETERS};
use downpour_render::rain::{
    DropMasks, EnvironmentMap, Exposure, Rain, RainOptions, ScreenDrop, StreakSamples,
};
use downpour_trace::builder::SceneBuilder;
use downpour_trace::capture::trace_environment;
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::picture::picture_frame;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;

/// Maximum angular radius, in degrees, of a lamp that may count as parallel light.
pub const MAX_TABLE_LAMP_DEG: f64 = 5.0;

/// Minimum distance from the eye, meters, above a diameter: nearer drops at mid-exposure do not move in a picture of rain.
const MIN_DISTANCE_M: f64 = 0.02;

/// Seed and id of the drop: the phases and the azimuth that follow from them are replaced.
const SEED: u64 = 0;
const ID: u32 = 0;

/// A streak that is ready to be drawn, for one refractive index.
pub(crate) struct TableStreak {
    /// A scene of a sky and lamps as parallel light.
    pub(crate) scene: SceneData,
    /// The frame of the picture.
    pub(crate) frame: RenderFrame,
    pub(crate) masks: DropMasks,
    pub(crate) rain: Rain,
    /// The map without the drop, and the distance of the sky.
    pub(crate) clean: Vec<[f32; 4]>,
    channels: [bool; 3],
}

/// Renders the streak of a drop in front of a sky as the renderer of rain does.
///
/// [`SpecimenOptions::instants`] is not used.
///
/// ```
/// use downpour_drop::DropShape;
/// use downpour_specimen::{Sky, SpecimenOptions, render_specimen_table};
/// let radiance = vec![[0.25, 0.5, 1.0]; 32];
/// let options = SpecimenOptions { size: [16, 48], exposure_s: 2.0e-3, ..SpecimenOptions::default() };
/// let image = render_specimen_table(&DropShape::new(2.0e-3)?, &options, Sky::new(8, 4, &radiance)?)?;
/// // In front of a uniform sky, a streak is invisible.
/// assert!(image.pixels.iter().all(|p| (p[2] - 1.0).abs() < 2e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`SpecimenOptions::check`] and [`check_specimen_table`]; [`SpecimenError::Render`] for a field of view below
/// 0.006 degrees.
pub fn render_specimen_table(
    shape: &DropShape,
    options: &SpecimenOptions,
    sky: Sky<'_>,
) -> Result<Image, SpecimenError> {
    let mut image = empty(options);
    for streak in table_streaks(shape, options, sky)? {
        let TableStreak { masks, rain, clean, .. } = &streak;
        let (environment, view) = (streak.environment(), streak.view());
        let lamps = streak.streak_lights(&view)?.light(&rain.streak_rows());
        let table = rain.streak_table(masks, &environment, &lamps);
        let light = streak.lights(&view)?.light(&rain.rows);
        streak.show(&rain.layer(clean, masks, &environment, &table, &light, &[]), &mut image);
    }
    Ok(image)
}

/// Checks that the renderer of rain has a table for such a drop: a diameter of the masks (0.5 to 9 mm), an exposure above 0, a
/// camera at a distance at which rain is drawn, lamps of at most [`MAX_TABLE_LAMP_DEG`].
///
/// # Errors
/// [`SpecimenError::OutOfRange`], naming the quantity.
pub fn check_specimen_table(
    shape: &DropShape,
    options: &SpecimenOptions,
    lamps: &[SpecimenLamp],
) -> Result<(), SpecimenError> {
    let wrong = |quantity, found: f64, unit, allowed: String| {
        Err(SpecimenError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() }))
    };
    let diameter = 2.0 * shape.equivalent_radius();
    let [least, most] = [DIAMETER_STEP, f64::from(DIAMETERS) * DIAMETER_STEP];
    if !(least * (1.0 - 1.0e-9)..=most * (1.0 + 1.0e-9)).contains(&diameter) {
        let allowed =
            format!("{} to {}, as the masks have it", least * 1.0e3, (most * 1.0e6).round() / 1.0e3);
        return wrong("diameter of a streak by the table", diameter * 1.0e3, "mm", allowed);
    }
    if options.exposure_s <= 0.0 {
        return wrong("exposure of a streak by the table", options.exposure_s, "s", "above 0".to_owned());
    }
    let nearest = diameter + MIN_DISTANCE_M;
    if options.distance_m < nearest {
        let allowed = format!("from {nearest:.6} (nearer drops are not drawn as streaks)");
        return wrong("camera distance of a streak by the table", options.distance_m, "m", allowed);
    }
    let largest = MAX_TABLE_LAMP_DEG.to_radians() * (1.0 + 1.0e-9);
    match lamps.iter().map(SpecimenLamp::radius).find(|&radius| radius > largest) {
        Some(radius) => {
            let allowed =
                format!("0.01 to {MAX_TABLE_LAMP_DEG}, since the renderer takes it for parallel light");
            wrong(
                "angular radius of a lamp on a streak by the table",
                radius.to_degrees(),
                "degrees",
                allowed,
            )
        }
        None => Ok(()),
    }
}

/// Streaks of a picture: one for all colors, or one for each if their indices differ.
pub(crate) fn table_streaks(
    shape: &DropShape,
    options: &SpecimenOptions,
    sky: Sky<'_>,
) -> Result<Vec<TableStreak>, SpecimenError> {
    options.check(shape)?;
    check_specimen_table(shape, options, sky.lamps())?;
    views(shape, options)?.iter().map(|view| TableStreak::new(shape, options, view, sky)).collect()
}

impl TableStreak {
    fn new(
        shape: &DropShape,
        options: &SpecimenOptions,
        view: &View,
        sky: Sky<'_>,
    ) -> Result<Self, SpecimenError> {
        let masks = DropMasks::trace(view.drop.index)?;
        let scene = scene(sky);
        let camera = &view.camera;
        let eye = DVec3::from(camera.back) * options.distance_m;
        let viewpoint = Viewpoint {
            eye: eye.as_vec3(),
            forward: -DVec3::from(camera.back).as_vec3(),
            up: DVec3::from(camera.up).as_vec3(),
            fov_y: options.fov(shape)? as f32,
        };
        let exposure = Exposure {
            shutter_s: options.exposure_s,
            samples: StreakSamples::Table,
            oscillation: options.oscillation,
            seed: SEED,
            ..Exposure::default()
        };
        let of_rain = RainOptions { exposure, ..RainOptions::default() };
        let of_picture = PictureOptions {
            size: options.size,
            grid: 1,
            sky_rays: 0,
            seed: 0,
            rain: of_rain,
            ..PictureOptions::default()
        };
        let frame = picture_frame(&scene, &viewpoint, &of_picture)?;
        let drop = FallingDrop {
            position: DVec3::ZERO,
            velocity: [0.0, -fall_speed(shape)? as f32, 0.0],
            diameter: 2.0 * shape.equivalent_radius() as f32,
            id: ID.into(),
            kind: DropKind::Falling,
            present_s: FallingDrop::ALWAYS,
            normal: FallingDrop::LEVEL,
        };
        let mut rain = Rain::new(&frame.camera, eye, &[drop], &masks, &of_rain);
        for drop in &mut rain.list {
            set_phases(drop, options);
        }
        for path in &mut rain.profiles.paths {
            // Toward +X.
            path.lobe = [1.0, 0.0];
        }
        Ok(Self { scene, frame, masks, rain, clean: background(view, sky), channels: view.channels })
    }

    /// The lamps on the drop.
    pub(crate) fn lights<'a>(&'a self, view: &'a SceneView<'_>) -> Result<DropLights<'a>, SpecimenError> {
        Ok(self.rain.lights(view, &self.masks)?)
    }

    /// The lamps on its profile.
    pub(crate) fn streak_lights<'a>(
        &'a self,
        view: &'a SceneView<'_>,
    ) -> Result<DropLights<'a>, SpecimenError> {
        Ok(self.rain.streak_lights(view, &self.masks)?)
    }

    /// Sky and lamps in the form for rain.
    pub(crate) fn view(&self) -> SceneView<'_> {
        SceneView { data: &self.scene, frame: &self.frame }
    }

    /// The sky around the eye.
    fn environment(&self) -> EnvironmentMap {
        trace_environment(&self.scene, &self.frame, &self.rain.environment)
    }

    /// Writes the colors of this streak into a picture. `layer` is the rain over the background.
    pub(crate) fn show(&self, layer: &[[f32; 4]], image: &mut Image) {
        for (pixel, seen) in image.pixels.iter_mut().zip(through_rain(&self.clean, layer)) {
            for c in (0..3).filter(|&c| self.channels[c]) {
                pixel[c] = seen[c];
            }
        }
    }
}

/// A scene of a sky only. As for a weather, the sun of the map is extracted and becomes parallel light.
fn scene(sky: Sky<'_>) -> SceneData {
    let mut map = SkyMap {
        width: sky.width(),
        height: sky.height(),
        radiance: sky.radiance().to_vec(),
        warnings: Vec::new(),
    };
    let sun = map.extract_sun(SUN_THRESHOLD);
    // No surface uses the levels of rough reflection, nor the irradiance.
    let light = SkyLight {
        texels: map.radiance.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect(),
        levels: [[map.width, map.height, 0, 0]; SCENE_SKY_LEVELS as usize],
        irradiance: [[0.0; 4]; 9],
    };
    let of_lamps = sky.lamps().iter().map(|lamp| {
        let irradiance = Vec3::from(lamp.radiance) * (PI * lamp.sine_squared() as f32);
        (DVec3::from(lamp.direction).as_vec3(), irradiance, lamp.radius() as f32)
    });
    let of_sun = sun.map(|sun| (sun.direction.into(), sun.irradiance_rgb.into(), sun.angular_radius));
    let lights: Vec<(Vec3, Vec3, f32)> = of_lamps.chain(of_sun).collect();
    let mut builder = SceneBuilder::new();
    for &(towards, irradiance, _) in &lights {
        builder.add_light(LightSource::Directional { direction: -towards, irradiance });
    }
    let mut scene = builder.build(&light);
    for (k, &(_, _, radius)) in (0u32..).zip(&lights) {
        scene.set_light_radius(k, radius);
    }
    scene
}

/// The map and its lamps, each pixel the mean of its samples, and the distance of the sky.
fn background(view: &View, sky: Sky<'_>) -> Vec<[f32; 4]> {
    let samples = view.samples;
    let mean = 1.0 / (samples * samples) as f32;
    let pixel = |column: u32, row: u32| {
        let light = (0..samples * samples).fold([0.0; 3], |sum, k| {
            let line = row * samples + k / samples;
            let x = view.sample_position(column * samples + k % samples, line);
            let y = view.line_height(line);
            add(sum, specimen_sky_light(sky, specimen_ray(&view.camera, x, y).direction))
        });
        let [r, g, b] = scale(light, mean);
        [r, g, b, SCENE_FAR]
    };
    let [width, height] = view.size;
    (0..height)
        .into_par_iter()
        .flat_map_iter(|row| (0..width).map(move |column| pixel(column, row)))
        .collect()
}

/// Sets the phases of the specimen, and the lobe of the mode (3,1) toward +X.
fn set_phases(drop: &mut ScreenDrop, options: &SpecimenOptions) {
    if options.oscillation == Amplitudes::NONE {
        return;
    }
    let drawn = drop_oscillation_phase(seed_words(SEED), ID);
    let [_, _, begin @ ..] = &mut drop.mode_phase;
    for ((begin, asked), drawn) in begin.iter_mut().zip(options.phase).zip(drawn) {
        let late = asked.rem_euclid(1.0) - f64::from(drawn);
        *begin = (f64::from(*begin) + late).rem_euclid(1.0) as f32;
    }
    let [_, a31] = options.oscillation.pair();
    drop.mode_phase[1] = a31 as f32 * drop_glint_right(drop.towards.into()).x;
}
