//! `shaders/wgsl/render/{capture,reduce,drops}.wgsl` against `downpour_render::rain`.

pub(super) mod spray;

use downpour_atlas::StreakPick;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::oscillation::Amplitudes;
use downpour_gpu::{ComputeKernel, Gpu, GpuError};
use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::camera::Viewpoint;
use downpour_render::gpu::{AddedLightPipeline, RainPipeline, TonedLayers};
use downpour_render::light::LightSource;
use downpour_render::picture::{compose_lit, compose_pixel};
use downpour_render::rain::drops::{drops_sums_distance, drops_sums_shown};
use downpour_render::rain::layers::{layers_fresnel, layers_refracted};
use downpour_render::rain::light::{DropLightForm, DropLightOptions};
use downpour_render::rain::medium::MediumGrain;
use downpour_render::rain::medium::fog::medium_fog_depth;
use downpour_render::rain::medium::spread::{medium_spread_alike, medium_spread_side};
use downpour_render::rain::medium::streaks::{medium_streaks_column, medium_streaks_poisson};
use downpour_render::rain::streak::streak_weight;
use downpour_render::rain::streak_cell::{
    streak_cell_index, streak_cell_position, streak_cell_slope, streak_cell_weight,
};
use downpour_render::rain::streak_span::{StreakSpan, streak_span, streak_span_time};
use downpour_render::rain::{
    DropMasks, EnvironmentMap, Exposure, EyeMotion, MediumOptions, PanePlane, Rain, RainMedium, RainOptions,
    RefractionForm, ScreenDrop, StreakColor, StreakProfiles, StreakSamples, TemporalResponse,
};
use downpour_shaders::Kernel;
use downpour_shaders::render::layers::{LAYERS, LAYERS_KERNEL};
use downpour_shaders::render::medium::{
    MEDIUM, MEDIUM_FILTER_KERNEL, MEDIUM_LIGHT_KERNEL, MEDIUM_OPEN_KERNEL, MEDIUM_SMOOTH_KERNEL,
    MEDIUM_SMOOTH_PARTS_KERNEL, MEDIUM_SPREAD, MEDIUM_STREAKS,
};
use downpour_shaders::render::rain::{
    COMPOSE, COMPOSE_KERNEL, COMPOSE_LIT_KERNEL, DROPS_KERNEL, DROPS_SUM_CLEAR_KERNEL,
    DROPS_SUM_FINISH_KERNEL, DROPS_SUM_SCALE_KERNEL, DROPS_SUM_THIN_KERNEL, DROPS_SUM_WIDE_KERNEL,
    DROPS_UNLISTED_KERNEL, STREAK, STREAK_CELL, STREAK_LIGHT_KERNEL, STREAK_RAYS, STREAK_RAYS_KERNEL,
    STREAK_SPAN, STREAK_TABLE_KERNEL,
};
use downpour_shaders::render::scene::{TRACE_KERNEL, TRACE_SEEN_KERNEL};
use downpour_sim::field::{DropKind, FallingDrop};
use downpour_sim::resolved::{Region, Resolved};
use downpour_trace::capture::trace_environment;
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::gpu::{SampleDispatches, ScenePipeline};
use downpour_trace::scene::SceneView;
use downpour_weather::{Fog, RainLayers};
use glam::{DVec3, Vec2, Vec3, Vec4};

use super::drop_light::{atlas, lamps};
use super::scene::{DULL, lit_scene, scene};
use crate::Domain::{Made, Uniform};
use crate::compare::POISON;
use crate::function::Run;
use crate::kept::kept;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

const SIZE: [u32; 2] = [96, 64];

/// Crowns of splashes at all stages, over tens of pixels, some half behind what stands in the scene.
fn splashes(eye: Vec3, forward: Vec3) -> Vec<FallingDrop> {
    let crown = |(k, drop): (u32, FallingDrop)| {
        let stage = 0.05 * (k % 20) as f32 + 0.01;
        FallingDrop {
            velocity: [0.0; 3],
            diameter: 0.01 + 8.0 * drop.diameter,
            kind: DropKind::Splash,
            present_s: [-0.04 * stage, 0.04 * (1.0 - stage)],
            ..drop
        }
    };
    (0..).zip(drops(eye, forward)).filter(|(k, _)| k % 5 == 0).map(crown).collect()
}

/// Drops of all sizes before, between and behind what stands in the scene: some over hundreds of pixels, some below one.
fn drops(eye: Vec3, forward: Vec3) -> Vec<FallingDrop> {
    let forward = forward.normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    (0..400)
        .map(|k| {
            let [a, b, c, d] = rng_draw([3, 4], k, 0, 0).map(rng_unit);
            let depth = 0.02 + 5.0 * c * c * c;
            let position = forward + right * (1.5 * a - 0.75) + up * (1.1 * b - 0.55);
            FallingDrop {
                position: (eye + position * depth).as_dvec3(),
                velocity: [0.0, -5.0, 0.0],
                diameter: 0.3e-3 + 7.7e-3 * d * d,
                id: u64::from(k),
                kind: DropKind::Falling,
                present_s: FallingDrop::ALWAYS,
                normal: FallingDrop::LEVEL,
            }
        })
        .collect()
}

/// Every other drop moved to what stands behind it in the picture, or half into it, and made as large as a few pixels.
fn onto(clean: &[[f32; 4]], frame: &RenderFrame, eye: Vec3, drops: &mut [FallingDrop]) {
    for (k, drop) in (0u8..).zip(drops.iter_mut().step_by(2)) {
        let direction = (drop.position.as_vec3() - eye).normalize();
        let at = frame.camera.camera_project(direction).max(Vec2::ZERO).as_uvec2();
        let pixel = at.y.min(SIZE[1] - 1) * SIZE[0] + at.x.min(SIZE[0] - 1);
        let distance = clean[pixel as usize][3];
        if distance < 50.0 {
            // Some pixels wide.
            drop.diameter = 0.08 * distance;
            let out = drop.diameter * (0.3 * f32::from(k % 7) - 0.9);
            drop.position = (eye + direction * (distance - out)).as_dvec3();
        }
    }
}

/// The region in which drops are drawn.
#[derive(Clone, Copy, Debug)]
enum Drawn {
    /// A box around the eye.
    Box,
    /// A sphere around the eye.
    Sphere,
    /// A cylinder beside the eye.
    Cylinder,
}

/// Lamps of a scene.
#[derive(Clone, Copy, Debug)]
enum Lit {
    /// A sun and two lamps.
    Few,
    /// Many of all kinds.
    Many,
    /// Several suns.
    Suns,
}

/// Where an eye is, and what is around it.
#[derive(Clone, Copy, Debug)]
struct Placement {
    eye: Vec3,
    forward: Vec3,
    drawn: Drawn,
    lit: Lit,
    has_pane: bool,
    has_fog: bool,
    /// Distance in pixels between those whose rays look for light.
    spacing: u32,
}

impl Placement {
    /// Behind a pane, in a box of drawn drops, in clear air before few lamps.
    const fn new(eye: Vec3, forward: Vec3) -> Self {
        Self { eye, forward, drawn: Drawn::Box, lit: Lit::Few, has_pane: true, has_fog: false, spacing: 1 }
    }

    /// What stands there.
    fn scene(&self) -> SceneData {
        match self.lit {
            Lit::Few => scene(),
            Lit::Many => lit_scene(&lamps(24)),
            Lit::Suns => {
                let is_sun = |lamp: &LightSource| matches!(lamp, LightSource::Directional { .. });
                lit_scene(&lamps(20).into_iter().filter(is_sun).collect::<Vec<_>>())
            }
        }
    }

    /// Unresolved rain of 500 mm/h, thick within some tens of meters: all drops outside the region, small ones everywhere.
    fn medium(&self, masks: &DropMasks) -> RainMedium {
        let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 500.0).expect("a rain");
        let eye = self.eye.as_dvec3();
        let region = match self.drawn {
            Drawn::Box => Region::Box { center: eye + DVec3::new(0.5, 0.2, -1.0), size: DVec3::splat(7.0) },
            Drawn::Sphere => Region::Sphere { center: eye + DVec3::new(0.3, 0.0, -0.5), radius: 2.5 },
            Drawn::Cylinder => {
                Region::Cylinder { base: DVec3::new(-0.5, -0.4, -0.3), radius: 1.5, height: 1.7 }
            }
        };
        let resolved = Resolved {
            near: 0.05,
            far: 50.0,
            pixel_angle: 0.0025,
            least_pixels: 1.0,
            min_diameter: 0.4e-3,
            region,
        };
        let pane = self.has_pane.then_some(PanePlane { outward: Vec3::new(0.0, 0.28, -0.96), distance: 0.7 });
        let velocity = Vec3::new(1.0, -4.0, 0.5);
        let grain = if matches!(self.drawn, Drawn::Box) { MediumGrain::Streaks } else { MediumGrain::Even };
        let options = MediumOptions { velocity, pane, grain, ..MediumOptions::default() };
        let made = RainMedium::new(&rain, &resolved, masks, &options).expect("a medium");
        let fog =
            Fog { extinction_per_m: 0.05, height_m: Some(2.0), base_m: 0.0, asymmetry: 0.8, albedo: 0.9 };
        made.with_fog(self.has_fog.then_some(&fog), 0.0)
    }
}

/// Part of a picture that is compared.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Capture,
    /// The capture, each sample of a texel in a dispatch of its own.
    CaptureBySamples,
    Means,
    /// The means of the first half of the classes, and of those that a drop has: every other one.
    MadeMeans,
    Chords,
    Profiles,
    Open,
    Medium,
    Seen,
    Filter,
    /// Streaks that are summed up.
    Sums,
    Drops,
    Layers,
}

/// An exposure of some seconds, out of focus by a little, with drops that swing.
fn exposure(shutter_s: f64, samples: StreakSamples) -> Exposure {
    Exposure {
        shutter_s,
        samples,
        time_s: 2.5,
        eye: EyeMotion { velocity: Vec3::new(0.3, 0.0, -1.0), turning: Vec3::new(0.0, 0.4, 0.0) },
        oscillation: Amplitudes::GARG_NAYAR_OBLATE,
        aperture_m: 2.0e-3,
        focus_m: 3.0,
        ..Exposure::default()
    }
}

/// Means of classes of drops, during a 60th of a second.
fn means_case(gpu: &Gpu, part: Part) -> Result<Run, GpuError> {
    let exposure = exposure(1.0 / 60.0, StreakSamples::Table);
    rain_case(gpu, LEVEL, RefractionForm::Direction, exposure, part)
}

fn rain_case(
    gpu: &Gpu,
    placement: Placement,
    form: RefractionForm,
    exposure: Exposure,
    part: Part,
) -> Result<Run, GpuError> {
    let options = RainOptions { form, exposure, ..RainOptions::default() };
    masks_case(gpu, placement, options, &DropMasks::trace(1.333).expect("masks"), part)
}

/// Layers of a texture before drops.
fn layers_case(gpu: &Gpu, placement: Placement, form: RefractionForm) -> Result<Run, GpuError> {
    let layers = Some(RainLayers { parallax: 6.0, milk: 0.2 });
    let options = RainOptions {
        form,
        layers,
        exposure: exposure(0.02, StreakSamples::Table),
        ..RainOptions::default()
    };
    masks_case(gpu, placement, options, &DropMasks::trace(1.333).expect("masks"), Part::Layers)
}

/// Streaks with the light of an atlas.
fn atlas_case(gpu: &Gpu, placement: Placement, shutter_s: f64, pick: StreakPick) -> Result<Run, GpuError> {
    let masks = DropMasks::trace(1.333).expect("masks").with_atlas(&atlas(pick));
    let exposure = Exposure { aperture_m: 0.0, ..exposure(shutter_s, StreakSamples::Table) };
    let options = RainOptions { exposure, light: DropLightOptions::ATLAS, ..RainOptions::default() };
    masks_case(gpu, placement, options, &masks, Part::Drops)
}

/// The entries of the streak radiance table that a part is about.
fn entries(profiles: &StreakProfiles, part: Part) -> Vec<usize> {
    let rays = (STREAK_RAYS * STREAK_RAYS) as usize;
    if matches!(part, Part::Means | Part::MadeMeans) {
        let wanted = |k: &usize| part == Part::MadeMeans || profiles.classes[k / rays].rows > 0;
        return (0..profiles.classes.len() * rays).filter(wanted).collect();
    }
    let mut all = Vec::new();
    let ends = profiles.paths.iter().skip(1).map(|path| path.first_entry).chain([profiles.entries]);
    for (path, end) in profiles.paths.iter().zip(ends) {
        let [first, end] = [path.first_entry, end].map(|k| k as usize);
        let light = first + 1 + (path.rows * path.columns) as usize;
        all.extend(if matches!(part, Part::Chords) { first..light } else { light..end });
    }
    all
}

/// All that the CPU works out before it is known what is compared.
struct Prepared {
    scene: SceneData,
    frame: RenderFrame,
    rain: Rain,
    capture: EnvironmentMap,
    clean: Vec<[f32; 4]>,
}

impl Prepared {
    fn new(placement: Placement, options: RainOptions, masks: &DropMasks) -> Self {
        let Placement { eye, forward, .. } = placement;
        let scene = placement.scene();
        let view = Viewpoint { eye, forward, up: Vec3::Y, fov_y: 0.9 };
        let frame = RenderFrame::new(&scene, &view, SIZE, 1, 1, 7).expect("a frame");
        let frame = frame.with_ray_spacing(placement.spacing);
        let medium = placement.medium(masks);
        let options = RainOptions { capture_size: 64, capture_grid: 2, medium, ..options };
        let clean = SceneView { data: &scene, frame: &frame }.picture();
        let mut shown = drops(eye, forward);
        if masks.has_splashes() {
            let mut crowns = splashes(eye, forward);
            onto(&clean, &frame, eye, &mut crowns);
            shown.extend(crowns);
        }
        let rain = Rain::new(&frame.camera, DVec3::from(eye), &shown, masks, &options);
        assert!(rain.list.len() > 100, "{} drops", rain.list.len());
        let capture = trace_environment(&scene, &frame, &rain.environment);
        Self { scene, frame, rain, capture, clean }
    }
}

fn masks_case(
    gpu: &Gpu,
    placement: Placement,
    options: RainOptions,
    masks: &DropMasks,
    part: Part,
) -> Result<Run, GpuError> {
    // Masks with an atlas have their own exposures.
    let key = format!("{placement:?} {options:?} {}", masks.has_splashes());
    let prepared = kept(&key, || Prepared::new(placement, options, masks));
    let Prepared { scene, frame, rain, capture, clean } = &*prepared;
    let made = (part == Part::MadeMeans).then(|| {
        let mut made = rain.clone();
        let classes = &mut made.profiles.classes;
        made.frame.made_classes = classes.len() as u32 / 2;
        for class in classes.iter_mut().step_by(2) {
            class.rows = 0;
        }
        made
    });
    let rain = made.as_ref().unwrap_or(rain);
    let view = SceneView { data: scene, frame };
    let both = [rain.lights(&view, masks).expect("lamps"), rain.streak_lights(&view, masks).expect("lamps")];
    let samples =
        if part == Part::CaptureBySamples { SampleDispatches::Apart } else { SampleDispatches::Together };
    let (scenes, rains) = (ScenePipeline::with_samples(gpu, samples)?, RainPipeline::new(gpu)?);
    let uploaded = scenes.upload(scene)?;
    let clean_buffer = gpu.storage_buffer("clean", clean)?;
    let lights = &both[0];
    let plate = scenes.plate(gpu, &uploaded, frame, &rains, rain)?;
    let pass = rains.prepare(gpu, &plate.of(&clean_buffer), &rains.upload(masks)?, rain, &both)?;
    let table = || {
        kept(&format!("{key} table {}", rain.frame.made_classes), || {
            rain.streak_table(masks, capture, &both[1].light(&rain.streak_rows()))
        })
    };
    let found = || kept(&format!("{key} found"), || rain.medium_light(lights).found(clean));
    gpu.submit(&plate.dispatches(&pass))?;
    gpu.submit(&[pass.open_air()])?;
    gpu.submit(&pass.binning().concat())?;
    match part {
        Part::Capture | Part::CaptureBySamples => {
            // The finest level: the others are the kernel of the reduction.
            let finest = 64 * 64;
            Ok(Run::of_pixels(64, &capture.texels[..finest], &pass.environment_texels()?[..finest]))
        }
        Part::Means | Part::MadeMeans | Part::Chords | Part::Profiles => {
            gpu.submit(&pass.lamps())?;
            gpu.submit(&pass.streaks())?;
            let wanted = entries(&rain.profiles, part);
            let of_part = |table: &[[f32; 4]]| wanted.iter().map(|&k| table[k]).collect::<Vec<_>>();
            Ok(Run::of_pixels(STREAK_RAYS, &of_part(&table().entries), &of_part(&pass.streak_table()?)))
        }
        Part::Sums => {
            gpu.submit(&[pass.lamps(), pass.streaks(), pass.drops()].concat())?;
            let light = lights.light(&rain.rows);
            let sums = rain.sums(clean, masks, capture, &table(), &light);
            // Of streaks that hardly show the distance is that of a few units.
            let numbers = |sums: &[[u32; 4]]| -> Vec<[f32; 6]> {
                let one = |&words: &[u32; 4]| {
                    let [r, g, b, cover] = drops_sums_shown(words).to_array();
                    let scene = f32::from_bits(words[0]);
                    [r, g, b, cover, if cover > 1.0e-3 { drops_sums_distance(words) } else { 0.0 }, scene]
                };
                sums.iter().map(one).collect()
            };
            assert!(numbers(&sums).iter().filter(|of| of[3] > 1.0e-3).count() > 200);
            Ok(Run::of_pixels(SIZE[0], &numbers(&sums), &numbers(&pass.sums()?)))
        }
        Part::Drops => {
            let drawn = [pass.lamps(), pass.streaks(), pass.medium(), pass.drops()];
            gpu.submit(&drawn.concat())?;
            let layer = kept(&format!("{key} layer"), || {
                let medium = rain.medium_light(lights).layer(clean);
                rain.layer(clean, masks, capture, &table(), &lights.light(&rain.rows), &medium)
            });
            Ok(Run::of_pixels(SIZE[0], &layer, &pass.layer()?))
        }
        Part::Layers => {
            let drawn = [pass.lamps(), pass.streaks(), pass.medium(), pass.drops()];
            gpu.submit(&drawn.concat())?;
            // Before the same rain.
            let mut layer = pass.layer()?;
            gpu.submit(&[pass.layers().expect("layers")])?;
            let layers = rain.layers.expect("layers").lit(rain.frame.camera.eye, &view);
            layers.before(&rain.frame, clean, capture, &mut layer);
            Ok(Run::of_pixels(SIZE[0], &layer, &pass.layer()?))
        }
        Part::Open => {
            let cells = found().len() - 2 * clean.len();
            Ok(Run::of_pixels(16, &found()[..cells], &pass.medium_found()?[..cells]))
        }
        Part::Medium => {
            gpu.submit(&pass.medium())?;
            let pixels = found().len() - 2 * clean.len();
            let whole = |found: &[[f32; 4]]| found[pixels..].iter().step_by(2).copied().collect::<Vec<_>>();
            Ok(Run::of_pixels(SIZE[0], &whole(&found()), &whole(&pass.medium_found()?)))
        }
        Part::Seen => {
            gpu.submit(&pass.medium())?;
            let pixels = found().len() - 2 * clean.len();
            // Which part of a ray chance draws may differ, what comes of it may not.
            let blocks = |found: &[[f32; 4]]| block_means(found[pixels..].iter().skip(1).step_by(2));
            Ok(Run::of_pixels(SIZE[0] / 16, &blocks(&found()), &blocks(&pass.medium_found()?)))
        }
        Part::Filter => {
            gpu.submit(&pass.medium())?;
            let numbers = |layer: &[[f32; 4]]| -> Vec<[f32; 4]> {
                // The last number is two halves: the mean distance, and the depth, which the case of what was found holds.
                let distance = |halves: f32| half::f16::from_bits(halves.to_bits() as u16).to_f32();
                layer.iter().map(|&[r, g, b, halves]| [r, g, b, distance(halves)]).collect()
            };
            // From the same findings.
            let medium = rain.medium_light(lights).filtered(clean, &pass.medium_found()?);
            Ok(Run::of_pixels(SIZE[0], &numbers(&medium), &numbers(&pass.layer()?)))
        }
    }
}

/// Means over blocks of 16 by 16 pixels.
fn block_means<'a>(pixels: impl Iterator<Item = &'a [f32; 4]>) -> Vec<[f32; 4]> {
    let [across, down] = SIZE.map(|edge| edge as usize / 16);
    let mut means = vec![[0.0; 4]; across * down];
    for (i, pixel) in pixels.enumerate() {
        let block = (i / SIZE[0] as usize / 16) * across + i % SIZE[0] as usize / 16;
        for (mean, value) in means[block].iter_mut().zip(pixel) {
            *mean += value / 256.0;
        }
    }
    means
}

/// A random plate through random rain.
fn compose_case(gpu: &Gpu) -> Result<Run, GpuError> {
    let [width, height] = [29, 19];
    let random = |seed| {
        let pixel = move |i| rng_draw([seed, 7], i, 0, 0).map(rng_unit);
        (0..width * height).map(pixel).collect::<Vec<_>>()
    };
    let (plate, rain) = (random(1), random(2));
    let composed: Vec<_> =
        plate.iter().zip(&rain).map(|(&plate, &rain)| compose_pixel(plate, rain)).collect();
    let poisoned = vec![[f32::from_bits(POISON); 4]; plate.len()];
    let buffers = [&plate, &rain, &poisoned].map(|pixels| gpu.storage_buffer("pixels", pixels));
    let [plate, rain, target] = buffers;
    let (plate, rain, target) = (plate?, rain?, target?);
    let size = gpu.uniform_buffer("size", &[width, height, 0, 0])?;
    let kernel = ComputeKernel::new(gpu, &COMPOSE_KERNEL, &[])?;
    let bindings = kernel.bind(gpu, &[&size, &plate, &rain, &target])?;
    gpu.submit(&[kernel.dispatch(&bindings, [width.div_ceil(8), height.div_ceil(8), 1])])?;
    Ok(Run::of_pixels(width, &composed, &gpu.read(&target)?))
}

/// Other light added to a picture, with glow or without.
fn compose_lit_case(gpu: &Gpu, glows: bool) -> Result<Run, GpuError> {
    let [width, height] = [29, 19];
    let random = |seed| {
        let pixel = move |i| rng_draw([seed, 7], i, 0, 0).map(rng_unit);
        (0..width * height).map(pixel).collect::<Vec<_>>()
    };
    let [rain, plate, other, glow] = [1, 2, 3, 4].map(random);
    let of_glow = |glow: [f32; 4]| if glows { [glow[0], glow[1], glow[2]] } else { [0.0; 3] };
    let expected: Vec<_> =
        (0..rain.len()).map(|k| compose_lit(rain[k], plate[k], other[k], of_glow(glow[k]))).collect();
    let [rain, plate, other, glow] =
        [&rain, &plate, &other, &glow].map(|pixels| gpu.storage_buffer("pixels", pixels));
    let (rain, plate, other, glow) = (rain?, plate?, other?, glow?);
    let light =
        TonedLayers { size: [width, height], plate: &plate, rain: &other, glow: glows.then_some(&glow) };
    let pipeline = AddedLightPipeline::new(gpu)?;
    let pass = pipeline.prepare(gpu, light, &rain)?;
    gpu.submit(&[pass.dispatch()])?;
    Ok(Run::of_pixels(width, &expected, &gpu.read(&rain)?))
}

const CAPTURED: Tol = Tol::relative(
    2.0e-3,
    2.0e-3,
    "sums over rays; a ray at an edge, and the sky's atan2 (4096 ulp), may fall on either side",
)
.with_outliers(2.0e-3);

const DRAWN: Tol = Tol::relative(
    5.0e-3,
    2.0e-3,
    "the capture above; directions of a mask's rim turn by the width of the picture in a texel",
)
.with_outliers(1.0e-2);

const LAYERED: Tol =
    Tol::relative(5.0e-3, 1.0e-3, "the capture above; a pixel at the edge of a cell may fall on either side")
        .with_outliers(1.0e-2);

const SCATTERED: Tol = Tol::relative(
    3.0e-3,
    1.0e-4,
    "differences of a table between angles (atan2, 4096 ulp); a ray at an edge may fall on either side",
)
.with_outliers(1.0e-2);

const SEEN: Tol = Tol::relative(
    2.0e-2,
    1.0e-4,
    "the light above; the part of a ray that chance draws may be its neighbor, of which means are taken",
)
.with_outliers(1.0e-2);

const FILTERED: Tol = Tol::relative(1.0e-4, 1.0e-6, "two sums of 49 numbers, and a division (2.5 ulp)");

const TABLED: Tol = Tol::relative(5.0e-3, 4.0e-3, "the capture above; directions in which rays leave a drop")
    .with_outliers(1.0e-2);

const OUTLINED: Tol = Tol::relative(
    1.0e-3,
    1.0e-3,
    "sines (2^-11) of angles and of phases; steps to an outline, which find it; a corner of an outline may be on either side of a chord",
)
.with_outliers(1.0e-4);

const PROFILED: Tol = Tol::relative(
    1.0e-2,
    5.0e-3,
    "the outlines and the capture above; a point of a patch at the edge of a lamp's disk may fall on either side",
)
.with_outliers(2.0e-2);

const LEVEL: Placement = Placement::new(Vec3::new(0.6, 0.4, 3.0), Vec3::new(-0.1, 0.0, -1.0));
const SLANTED: Placement = Placement::new(Vec3::new(0.6, 1.4, 3.0), Vec3::new(-0.2, -0.4, -1.0));
const ABOVE: Placement =
    Placement { has_fog: true, ..Placement::new(Vec3::new(0.1, 3.0, 0.4), Vec3::new(0.05, -1.0, -0.1)) };
const INSIDE: Placement = Placement {
    drawn: Drawn::Sphere,
    lit: Lit::Many,
    has_pane: false,
    has_fog: true,
    ..Placement::new(Vec3::new(-1.4, 0.9, 2.6), Vec3::new(0.5, -0.25, -1.0))
};
const BESIDE: Placement = Placement {
    drawn: Drawn::Cylinder,
    lit: Lit::Many,
    has_pane: false,
    ..Placement::new(Vec3::new(2.4, 1.5, 2.4), Vec3::new(-1.0, -0.4, -1.0))
};
const UNDER_SUNS: Placement =
    Placement { lit: Lit::Suns, ..Placement::new(Vec3::new(0.4, 2.5, 3.5), Vec3::new(-0.1, -0.4, -1.0)) };

/// A number of cells, from 1 to 24.
fn cells(random: [u32; 4]) -> Vec<u32> {
    vec![1 + random[0] % 24]
}

/// A cell, and the number of cells, from 12 to 96.
fn cell(random: [u32; 4]) -> Vec<u32> {
    let count = 12 + random[0] % 85;
    vec![random[1] % count, count]
}

/// The first or the last cell, and the number of cells, from 3 to 96.
fn end_cell(random: [u32; 4]) -> Vec<u32> {
    let count = 3 + random[0] % 94;
    vec![if random[1] & 1 == 0 { 0 } else { count - 1 }, count]
}

/// Weights of the light at the beginning and at the end of a way, 0 to 2.
fn weights(random: [u32; 4]) -> Vec<u32> {
    random[..2].iter().map(|&word| (2.0 * rng_unit(word)).to_bits()).collect()
}

/// Words of a drop.
const DROP: usize = size_of::<ScreenDrop>() / 4;

/// A drop that moves by some of its radii, nearer, away or neither.
fn moving(random: [u32; 4]) -> Vec<u32> {
    let unit = |word: u32| rng_unit(word.wrapping_mul(0x9e37_79b9));
    let slope = 0.03 * unit(random[0]) + 1.0e-4;
    let moves = slope * (0.1 + 20.0 * unit(random[1]) * unit(random[1]));
    let turn = 6.0 * unit(random[2]);
    let drop = ScreenDrop {
        slope,
        half_extent: 1.0 + 0.3 * unit(random[2] ^ random[0]),
        along: [moves * ops::cos(turn), moves * ops::sin(turn)],
        depth_ratio: 0.5 + 1.5 * unit(random[3]),
        ..ScreenDrop::default()
    };
    bytemuck::cast_slice(bytemuck::bytes_of(&drop)).to_vec()
}

fn span_words(span: &StreakSpan) -> Vec<u32> {
    let StreakSpan { before, after, first, last, parallel, funnel } = *span;
    [before, after, first, last, parallel, funnel].words()
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    vec![
        FunctionCase::new(
            "compose_pixel",
            &COMPOSE,
            &[Uniform(0.0, 4.0); 8],
            Tol::relative(2.0e-7, 0.0, "a product and a sum of positive numbers, which may be fused"),
            |a| compose_pixel(a.f32s(), a.f32s()).words(),
        ),
        FunctionCase::new(
            "compose_lit",
            &COMPOSE,
            &[Uniform(0.0, 4.0); 15],
            Tol::relative(3.0e-7, 0.0, "a product and three sums of positive numbers, which may be fused"),
            |a| compose_lit(a.f32s(), a.f32s(), a.f32s(), a.f32s()).words(),
        ),
        FunctionCase::new(
            "medium_fog_depth",
            &MEDIUM,
            &[
                Uniform(0.0, 0.1),
                Uniform(0.0, 2.0),
                Uniform(-5.0, 30.0),
                Uniform(0.0, 1.0),
                Uniform(-1.0, 1.0),
                Uniform(0.0, 500.0),
            ],
            Tol::relative(1.0e-4, 1.0e-6, "exponentials, and their difference from 1 from 0.02 on (5e-5)"),
            |a| medium_fog_depth(Vec4::from_array(a.f32s()), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "medium_streaks_poisson",
            &MEDIUM_STREAKS,
            &[Uniform(0.01, 30.0), Uniform(0.0, 0.9999999)],
            Tol::relative(1.0e-5, 1.0e-6, "a sum of up to 48 terms of an exponential decides on a number")
                .with_outliers(2.0e-3),
            |a| medium_streaks_poisson(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "medium_spread_side",
            &MEDIUM_SPREAD,
            &[Made(|r| {
                let [size, spacing] = [1 + r[0] % 40, 1 + r[1] % 4];
                vec![r[2] % size, size, spacing, r[3] % spacing, r[0] >> 31]
            })],
            Tol::exact("whole numbers"),
            |a| medium_spread_side(a.u32(), a.u32(), a.u32(), a.u32(), a.u32() > 0).words(),
        ),
        FunctionCase::new(
            "layers_fresnel",
            &LAYERS,
            &[Uniform(-0.5, 1.5)],
            Tol::relative(1.0e-6, 1.0e-7, "products of a few numbers, which may be fused"),
            |a| layers_fresnel(a.f32()).words(),
        ),
        FunctionCase::new(
            "layers_refracted",
            &LAYERS,
            &[Uniform(-1.0, 1.0); 6],
            Tol::relative(2.0e-6, 1.0e-5, "a root of a difference from 1"),
            |a| layers_refracted(Vec3::from_array(a.f32s()), Vec3::from_array(a.f32s())).to_array().words(),
        ),
        FunctionCase::new(
            "medium_spread_alike",
            &MEDIUM_SPREAD,
            &[Uniform(0.1, 100.0), Uniform(0.1, 100.0)],
            Tol::relative(1.0e-5, 1.0e-6, "a quotient, taken from 1"),
            |a| medium_spread_alike(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "medium_streaks_column",
            &MEDIUM_STREAKS,
            &[Uniform(-1.0, 1.0), Uniform(-1.0, 1.0), Uniform(1.0e-4, 1.0e-2)],
            Tol::exact("quotients and a logarithm that decide on a column").with_outliers(2.0e-3),
            |a| medium_streaks_column(Vec2::from_array(a.f32s()), a.f32()).words(),
        ),
        // Almost level rays about the height 0, where the series serves.
        FunctionCase::new(
            "medium_fog_depth",
            &MEDIUM,
            &[
                Uniform(0.0, 0.1),
                Uniform(0.0, 0.5),
                Uniform(-0.02, 0.02),
                Uniform(0.0, 1.0),
                Uniform(-0.001, 0.001),
                Uniform(0.0, 20.0),
            ],
            Tol::relative(
                3.0e-6,
                1.0e-9,
                "a quotient of a difference, and sums of products of what is near 1",
            ),
            |a| medium_fog_depth(Vec4::from_array(a.f32s()), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "streak_weight",
            &STREAK,
            &[Made(weights), Uniform(-0.5, 1.5)],
            Tol::absolute(1.0e-6, "a sum of products of numbers up to 2"),
            |a| streak_weight(a.f32s(), a.f32()).words(),
        ),
        FunctionCase::new(
            "streak_span",
            &STREAK_SPAN,
            &[Made(moving)],
            Tol::relative(
                1.0e-5,
                1.0e-6,
                "quotients and products of a few numbers, and a difference from 1 of at least 3e-7 of it",
            )
            .with_outliers(1.0e-2),
            |a| span_words(&streak_span(&bytemuck::cast(a.u32s::<DROP>()))),
        ),
        FunctionCase::new(
            "streak_span_time",
            &STREAK_SPAN,
            &[Uniform(0.0, 1.0); 7],
            Tol::absolute(5.0e-7, "a sum of products of numbers up to 1"),
            |a| {
                let [before, after, first, last, parallel, funnel] = a.f32s();
                let span = StreakSpan { before, after, first, last, parallel, funnel };
                streak_span_time(&span, a.f32()).words()
            },
        ),
        FunctionCase::new(
            "streak_cell_position",
            &STREAK_CELL,
            &[Uniform(0.0, 24.0), Made(cells)],
            Tol::absolute(6.0e-4, "sine (2^-11) of numbers up to pi / 2"),
            |a| streak_cell_position(a.f32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "streak_cell_index",
            &STREAK_CELL,
            &[Uniform(-1.5, 1.5), Made(cells)],
            Tol::absolute(1.2e-2, "arc sine (4096 ulp) of numbers up to 1, times up to 24 / pi"),
            |a| streak_cell_index(a.f32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "streak_cell_slope",
            &STREAK_CELL,
            &[Uniform(0.0, 24.0), Made(cells)],
            Tol::absolute(6.0e-4, "cosine (2^-11) of numbers up to pi / 2"),
            |a| streak_cell_slope(a.f32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "streak_cell_weight",
            &STREAK_CELL,
            &[Made(cell)],
            Tol::absolute(1.2e-3, "the square of a cosine (2^-11)"),
            |a| streak_cell_weight(a.u32(), a.u32()).words(),
        ),
        // The first and the last, which need no cosine.
        FunctionCase::new(
            "streak_cell_weight",
            &STREAK_CELL,
            &[Made(end_cell)],
            Tol::relative(1.0e-6, 0.0, "a quotient (2.5 ulp), and products that a GPU may fuse"),
            |a| streak_cell_weight(a.u32(), a.u32()).words(),
        ),
        // So few that they are as wide as the angle whose square is their weight.
        FunctionCase::new(
            "streak_cell_weight",
            &STREAK_CELL,
            &[Made(|r| [[1, 3], [1, 4], [2, 5]][r[0] as usize % 3].to_vec())],
            Tol::absolute(8.0e-4, "the square of a cosine (2^-11), times 0.8 at most"),
            |a| streak_cell_weight(a.u32(), a.u32()).words(),
        ),
    ]
}

/// What runs before the drops of lists.
const SUMS: &[&Kernel] = &[
    &DROPS_SUM_CLEAR_KERNEL,
    &DROPS_SUM_SCALE_KERNEL,
    &DROPS_SUM_THIN_KERNEL,
    &DROPS_SUM_WIDE_KERNEL,
    &DROPS_SUM_FINISH_KERNEL,
    &DROPS_UNLISTED_KERNEL,
];

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let drops = |name, run| KernelCase {
        name,
        kernel: &DROPS_KERNEL,
        with: SUMS,
        overrides: &[],
        text: None,
        tol: DRAWN,
        run,
    };
    let means =
        |name, run| KernelCase { kernel: &STREAK_TABLE_KERNEL, with: &[], tol: TABLED, ..drops(name, run) };
    let medium = |name, kernel, run| KernelCase {
        name,
        kernel,
        with: &[],
        overrides: &[],
        text: None,
        tol: SCATTERED,
        run,
    };
    let capture = |name, run| KernelCase {
        name,
        kernel: &TRACE_KERNEL,
        with: &[],
        overrides: DULL,
        text: None,
        tol: CAPTURED,
        run,
    };
    let filter = |name, run| KernelCase { tol: FILTERED, ..medium(name, &MEDIUM_FILTER_KERNEL, run) };
    let smooth = |name, kernel, run| KernelCase { tol: FILTERED, ..medium(name, kernel, run) };
    let profiles = |name, run| KernelCase {
        name,
        kernel: &STREAK_LIGHT_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: PROFILED,
        run,
    };
    vec![
        capture("main_trace: a capture with a sun and lamps", |gpu| {
            rain_case(gpu, SLANTED, RefractionForm::Direction, Exposure::default(), Part::Capture)
        }),
        capture("main_trace: a capture with many suns", |gpu| {
            rain_case(gpu, UNDER_SUNS, RefractionForm::Direction, Exposure::default(), Part::Capture)
        }),
        KernelCase {
            kernel: &TRACE_SEEN_KERNEL,
            overrides: &[],
            ..capture("main_trace_seen: a capture with a sun and lamps", |gpu| {
                let part = Part::CaptureBySamples;
                rain_case(gpu, SLANTED, RefractionForm::Direction, Exposure::default(), part)
            })
        },
        KernelCase {
            name: "main_compose: a plate through rain",
            kernel: &COMPOSE_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: Tol::relative(2.0e-7, 0.0, "a product and a sum of positive numbers, which may be fused"),
            run: compose_case,
        },
        KernelCase::new(
            "main_compose_lit: with glow",
            &COMPOSE_LIT_KERNEL,
            Tol::relative(3.0e-7, 0.0, "a product and three sums of positive numbers, which may be fused"),
            |gpu| compose_lit_case(gpu, true),
        ),
        KernelCase::new(
            "main_compose_lit: without",
            &COMPOSE_LIT_KERNEL,
            Tol::relative(3.0e-7, 0.0, "a product and two sums of positive numbers, which may be fused"),
            |gpu| compose_lit_case(gpu, false),
        ),
        medium("main_medium_open: a grid", &MEDIUM_OPEN_KERNEL, |gpu| {
            rain_case(gpu, LEVEL, RefractionForm::Direction, Exposure::default(), Part::Open)
        }),
        medium("main_medium_light: lamps and sun", &MEDIUM_LIGHT_KERNEL, |gpu| {
            rain_case(gpu, LEVEL, RefractionForm::Direction, Exposure::default(), Part::Medium)
        }),
        medium("main_medium_light: from above", &MEDIUM_LIGHT_KERNEL, |gpu| {
            rain_case(gpu, ABOVE, RefractionForm::Direction, Exposure::default(), Part::Medium)
        }),
        medium("main_medium_open: within a sphere", &MEDIUM_OPEN_KERNEL, |gpu| {
            rain_case(gpu, INSIDE, RefractionForm::Direction, Exposure::default(), Part::Open)
        }),
        medium("main_medium_light: within a sphere, many lamps in fog", &MEDIUM_LIGHT_KERNEL, |gpu| {
            rain_case(gpu, INSIDE, RefractionForm::Direction, Exposure::default(), Part::Medium)
        }),
        medium("main_medium_light: beside a cylinder, many lamps", &MEDIUM_LIGHT_KERNEL, |gpu| {
            rain_case(gpu, BESIDE, RefractionForm::Direction, Exposure::default(), Part::Medium)
        }),
        medium("main_medium_light: the spots of Im and Sung", &MEDIUM_LIGHT_KERNEL, |gpu| {
            let light = DropLightOptions { form: DropLightForm::ImSung2022, glints: 0 };
            let options = RainOptions { light, ..RainOptions::default() };
            masks_case(gpu, BESIDE, options, &DropMasks::trace(1.333).expect("masks"), Part::Medium)
        }),
        medium("main_medium_light: many lamps in fog, one pixel in 9 looks", &MEDIUM_LIGHT_KERNEL, |gpu| {
            let placement = Placement { spacing: 3, ..INSIDE };
            rain_case(gpu, placement, RefractionForm::Direction, Exposure::default(), Part::Medium)
        }),
        smooth("main_medium_smooth: many lamps in fog, one pixel in 9 looks", &MEDIUM_SMOOTH_KERNEL, |gpu| {
            let placement = Placement { spacing: 3, ..INSIDE };
            rain_case(gpu, placement, RefractionForm::Direction, Exposure::default(), Part::Filter)
        }),
        filter("main_medium_filter: lamps and sun, one pixel in 16 looks", |gpu| {
            let placement = Placement { spacing: 4, ..LEVEL };
            rain_case(gpu, placement, RefractionForm::Direction, Exposure::default(), Part::Filter)
        }),
        smooth("main_medium_smooth_parts: many lamps in fog", &MEDIUM_SMOOTH_PARTS_KERNEL, |gpu| {
            rain_case(gpu, INSIDE, RefractionForm::Direction, Exposure::default(), Part::Filter)
        }),
        filter("main_medium_filter: many lamps", |gpu| {
            rain_case(gpu, BESIDE, RefractionForm::Direction, Exposure::default(), Part::Filter)
        }),
        KernelCase {
            tol: SEEN,
            ..medium("main_medium_light: shadows", &MEDIUM_LIGHT_KERNEL, |gpu| {
                rain_case(gpu, LEVEL, RefractionForm::Direction, Exposure::default(), Part::Seen)
            })
        },
        filter("main_medium_filter: lamps and sun", |gpu| {
            rain_case(gpu, LEVEL, RefractionForm::Direction, Exposure::default(), Part::Filter)
        }),
        drops("main_drops: level", |gpu| {
            rain_case(gpu, LEVEL, RefractionForm::Direction, Exposure::default(), Part::Drops)
        }),
        drops("main_drops: from above", |gpu| {
            rain_case(gpu, ABOVE, RefractionForm::Direction, Exposure::default(), Part::Drops)
        }),
        drops("main_drops: splashes", |gpu| {
            let masks = DropMasks::trace(1.333).and_then(|masks| masks.with_splashes(1.333)).expect("masks");
            masks_case(gpu, LEVEL, RainOptions::default(), &masks, Part::Drops)
        }),
        drops("main_drops: Rousseau 2006", |gpu| {
            rain_case(gpu, SLANTED, RefractionForm::Rousseau2006, Exposure::default(), Part::Drops)
        }),
        drops("main_drops: light of Rousseau 2006", |gpu| {
            let light = DropLightOptions { form: DropLightForm::Rousseau2006, glints: 8 };
            let options = RainOptions { light, ..RainOptions::default() };
            masks_case(gpu, LEVEL, options, &DropMasks::trace(1.333).expect("masks"), Part::Drops)
        }),
        drops("main_drops: light of Rousseau 2006, internal reflection", |gpu| {
            let light = DropLightOptions { form: DropLightForm::Rousseau2006Internal, glints: 8 };
            let options = RainOptions { light, ..RainOptions::default() };
            masks_case(gpu, LEVEL, options, &DropMasks::trace(1.333).expect("masks"), Part::Drops)
        }),
        means("main_streak_table: all classes", |gpu| means_case(gpu, Part::Means)),
        means("main_streak_table: classes that no drop has", |gpu| means_case(gpu, Part::MadeMeans)),
        KernelCase {
            name: "main_streak_rays: outlines and chords",
            kernel: &STREAK_RAYS_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: OUTLINED,
            run: |gpu| {
                let exposure = exposure(1.0 / 60.0, StreakSamples::Table);
                rain_case(gpu, LEVEL, RefractionForm::Direction, exposure, Part::Chords)
            },
        },
        profiles("main_streak_light: profiles", |gpu| {
            let exposure = exposure(1.0 / 60.0, StreakSamples::Table);
            rain_case(gpu, LEVEL, RefractionForm::Direction, exposure, Part::Profiles)
        }),
        profiles("main_streak_light: profiles, Rousseau 2006", |gpu| {
            let exposure = exposure(1.0 / 250.0, StreakSamples::Table);
            let light = DropLightOptions { form: DropLightForm::Rousseau2006, glints: 8 };
            let form = RefractionForm::Rousseau2006;
            let options = RainOptions { form, exposure, light, ..RainOptions::default() };
            let masks = DropMasks::trace(1.333).expect("masks");
            masks_case(gpu, ABOVE, options, &masks, Part::Profiles)
        }),
        drops("main_drops: streaks by the table", |gpu| {
            let exposure = exposure(1.0 / 60.0, StreakSamples::Table);
            rain_case(gpu, LEVEL, RefractionForm::Direction, exposure, Part::Drops)
        }),
        KernelCase {
            name: "main_drops_sum_finish: streaks by the table",
            kernel: &DROPS_SUM_FINISH_KERNEL,
            with: &SUMS[..4],
            overrides: &[],
            text: None,
            tol: DRAWN,
            run: |gpu| {
                let exposure = exposure(1.0 / 60.0, StreakSamples::Table);
                rain_case(gpu, LEVEL, RefractionForm::Direction, exposure, Part::Sums)
            },
        },
        drops("main_drops: streaks that are more visible", |gpu| {
            let exposure = Exposure { streak_length: 0.5, ..exposure(1.0 / 60.0, StreakSamples::Table) };
            let options = RainOptions { exposure, visibility: 3.0, ..RainOptions::default() };
            masks_case(gpu, LEVEL, options, &DropMasks::trace(1.333).expect("masks"), Part::Drops)
        }),
        KernelCase {
            name: "main_layers: lamps",
            kernel: &LAYERS_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: LAYERED,
            run: |gpu| layers_case(gpu, LEVEL, RefractionForm::Direction),
        },
        KernelCase {
            name: "main_layers: Rousseau 2006",
            kernel: &LAYERS_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: LAYERED,
            run: |gpu| layers_case(gpu, SLANTED, RefractionForm::Rousseau2006),
        },
        drops("main_drops: streaks that fade, by the table", |gpu| {
            let response = TemporalResponse::Fading;
            let exposure = Exposure { response, ..exposure(0.075, StreakSamples::Table) };
            rain_case(gpu, LEVEL, RefractionForm::Direction, exposure, Part::Drops)
        }),
        drops("main_drops: short streaks that fade, by a loop", |gpu| {
            let response = TemporalResponse::Fading;
            let exposure = Exposure { response, ..exposure(1.0 / 1000.0, StreakSamples::Loop(5)) };
            rain_case(gpu, ABOVE, RefractionForm::Direction, exposure, Part::Drops)
        }),
        drops("main_drops: short streaks by a loop", |gpu| {
            let exposure = exposure(1.0 / 1000.0, StreakSamples::Loop(5));
            rain_case(gpu, ABOVE, RefractionForm::Direction, exposure, Part::Drops)
        }),
        drops("main_drops: streaks of an atlas by angle", |gpu| {
            atlas_case(gpu, LEVEL, 1.0 / 60.0, StreakPick::ByAngle)
        }),
        drops("main_drops: streaks of an atlas by chance", |gpu| {
            atlas_case(gpu, ABOVE, 1.0 / 120.0, StreakPick::Random)
        }),
        drops("main_drops: white streaks", |gpu| {
            let white = Exposure { color: StreakColor::White, ..exposure(1.0 / 250.0, StreakSamples::Table) };
            rain_case(gpu, LEVEL, RefractionForm::Direction, white, Part::Drops)
        }),
    ]
}
