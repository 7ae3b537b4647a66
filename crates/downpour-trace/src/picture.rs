//! The picture of a scene in the rain: the plate by rays, and the rain before it.
//!
//! [`render_picture`] makes it on the CPU, [`gpu::PictureRenderer`](crate::gpu::PictureRenderer) on a GPU: the same
//! passes over the same buffers.

use std::ops::Range;

use downpour_render::RenderError;
use downpour_render::camera::Viewpoint;
use downpour_render::glow::Glow;
use downpour_render::picture::{Picture, PictureOptions, rain_layer, timed};
use downpour_render::plate::Plate;
use downpour_render::rain::light::DropLightForm;
use downpour_render::rain::{DropMasks, EnvironmentFrame, EnvironmentMap, Rain};
use downpour_render::refine::refine_pixel;
use downpour_sim::field::FallingDrop;
use rayon::prelude::*;

use crate::capture::trace_environment_rows;
use crate::data::{RenderFrame, SceneData};
use crate::kept::{KeptPlate, PlateUse};
use crate::kept_environment::KeptEnvironment;
use crate::running_light::{PixelRunning, RunningFrame, RunningLight, no_frame_before};
use crate::scene::SceneView;
use crate::temporal::{LightHistory, LightWindow, PixelLight};
use crate::trace::add_light;

/// The frame of a picture.
///
/// # Errors
/// As [`RenderFrame::new`].
pub fn picture_frame(
    scene: &SceneData,
    viewpoint: &Viewpoint,
    options: &PictureOptions,
) -> Result<RenderFrame, RenderError> {
    let frame =
        RenderFrame::new(scene, viewpoint, options.size, options.grid, options.sky_rays, options.seed)?;
    // What is worked out drop by drop is not in the environment too.
    let traced = matches!(options.rain.light.form, DropLightForm::Traced | DropLightForm::Atlas);
    Ok(RenderFrame { suns_out: u32::from(traced), ..frame }.with_ray_spacing(options.ray_spacing))
}

/// Parts of a scene that stay on the CPU from picture to picture.
#[derive(Clone, Debug, Default)]
pub struct KeptScene {
    /// Radiance and distance of each pixel.
    pub plate: Option<KeptPlate<Vec<[f32; 4]>>>,
    /// Environment map of the eye.
    pub environment: Option<KeptEnvironment<EnvironmentMap>>,
    /// Light of the last frames of a clip.
    pub light: LightHistory<PixelLight>,
    /// Running mean of light that the last picture has left.
    pub running: Option<RunningLight<PixelRunning>>,
}

/// Renders a picture on the CPU. The bits do not depend on the number of threads.
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
    render_picture_on(&mut KeptScene::default(), PlateUse::default(), scene, viewpoint, drops, masks, options)
}

/// Finds the light of sky and surfaces in a frame of a clip for the frames after it, without a picture.
///
/// # Errors
/// As [`render_picture`].
pub fn find_light(
    kept: &mut KeptScene,
    window: &LightWindow,
    scene: &SceneData,
    viewpoint: &Viewpoint,
    options: &PictureOptions,
) -> Result<(), RenderError> {
    let frame = picture_frame(scene, viewpoint, options)?;
    let (_, held) = SceneView { data: scene, frame: &frame }.picture_and_light();
    kept.light.add(window, frame.camera, held);
    Ok(())
}

/// The same over what the last pictures have left, as far as it shows the same: [`KeptPlate`], [`KeptEnvironment`], [`LightHistory`]. The
/// plate is refined by a frame of rays for each picture, up to a number of frames.
///
/// # Errors
/// As [`render_picture`].
pub fn render_picture_on(
    kept: &mut KeptScene,
    of: PlateUse,
    scene: &SceneData,
    viewpoint: &Viewpoint,
    drops: &[FallingDrop],
    masks: &DropMasks,
    options: &PictureOptions,
) -> Result<Picture, RenderError> {
    let frame = picture_frame(scene, viewpoint, options)?;
    let camera = frame.camera;
    let mut passes = Vec::new();
    let view = SceneView { data: scene, frame: &frame };
    let eye = viewpoint.eye.as_dvec3();
    let rain = timed(&mut passes, "binning", || Rain::new(&camera, eye, drops, masks, &options.rain));
    // Pictures that keep none leave that of others alone.
    let mut own = (None, None);
    let (kept_map, kept_plate) = match of.kept_frames {
        0 => (&mut own.0, &mut own.1),
        _ => (&mut kept.environment, &mut kept.plate),
    };
    let map = kept_map.take().and_then(|mut map| map.follow(scene, &frame, &rain.environment).then_some(map));
    let map = kept_map.insert(map.unwrap_or_else(|| {
        let held = EnvironmentMap { texels: Vec::new() };
        KeptEnvironment::new(scene, &frame, &rain.environment, held)
    }));
    let rows = map.next(camera.eye);
    if !rows.is_empty() {
        timed(&mut passes, "capture", || trace_rows(&mut map.held, scene, &frame, &rain.environment, rows));
    }
    let plate = kept_plate.take().filter(|plate| plate.shows(scene, &frame));
    let plate = kept_plate.insert(plate.unwrap_or_else(|| KeptPlate::new(scene, &frame, Vec::new())));
    let mut next = plate.next(&frame, of.kept_frames);
    let running = RunningLight::follow(&mut kept.running, of.running(), scene, next.as_mut());
    if let Some((refined, count)) = next {
        let view = SceneView { data: scene, frame: &refined };
        let (mut next, light) = timed(&mut passes, "scene", || view.picture_and_light());
        if let Some(window) = of.window() {
            timed(&mut passes, "temporal filter", || {
                average_light(&view, &mut next, &window, light, &mut kept.light);
            });
        } else if let Some(running) = &running {
            timed(&mut passes, "temporal filter", || {
                go_on(&view, &mut next, running, light, &mut kept.running);
            });
        }
        if count == 1 {
            plate.held = next;
        } else {
            let pixels = plate.held.iter_mut().zip(next);
            pixels.for_each(|(mean, next)| *mean = refine_pixel(*mean, next, count));
        }
    }
    let (clean, environment) = (&plate.held, &map.held);
    let plate = Plate { camera: &camera, pixels: clean, environment, lighting: &view };
    let layer = rain_layer(&plate, &rain, masks, &mut passes)?;
    let mut picture = Picture::new(&rain, clean.clone(), layer, environment.texels.clone(), passes);
    if options.glow != Glow::default() {
        let start = std::time::Instant::now();
        picture.add_glow(&options.glow, &camera);
        picture.passes.push(("glow", start.elapsed().as_secs_f64() * 1.0e3));
    }
    Ok(picture)
}

/// Averages the light of a picture with that of the frames of a clip before it, and keeps its own for those after it.
fn average_light(
    view: &SceneView<'_>,
    picture: &mut [[f32; 4]],
    window: &LightWindow,
    light: PixelLight,
    history: &mut LightHistory<PixelLight>,
) {
    let before = history.before(window);
    if !before.is_empty() {
        let change = view.temporal(&light, &before);
        picture.par_iter_mut().zip(change).for_each(|(pixel, change)| add_light(pixel, change));
    }
    history.add(window, view.frame.camera, light);
}

/// Makes the light of a picture the running mean of that of the frames before it and its own, and keeps it for those after it.
fn go_on(
    view: &SceneView<'_>,
    picture: &mut [[f32; 4]],
    of: &RunningFrame,
    light: PixelLight,
    running: &mut Option<RunningLight<PixelRunning>>,
) {
    let before = running.take();
    let (means, change) = match &before {
        Some(before) => view.running_light(&light, &before.held, &before.before(of)),
        None => view.running_light(&light, &PixelRunning::default(), &no_frame_before(view.frame)),
    };
    picture.par_iter_mut().zip(change).for_each(|(pixel, change)| add_light(pixel, change));
    let held = PixelRunning { ambient: light.ambient, means };
    *running = Some(RunningLight::after(before.as_ref(), of, view.data, view.frame, held));
}

/// Traces rows of an environment map, and makes its coarser levels of them and of those that are there.
fn trace_rows(
    map: &mut EnvironmentMap,
    scene: &SceneData,
    frame: &RenderFrame,
    environment: &EnvironmentFrame,
    rows: Vec<Range<u32>>,
) {
    let size = environment.size as usize;
    let mut finest = std::mem::take(&mut map.texels);
    finest.resize(size * size, [0.0; 4]);
    for rows in rows {
        let place = rows.start as usize * size..rows.end as usize * size;
        finest[place].copy_from_slice(&trace_environment_rows(scene, frame, environment, rows));
    }
    *map = EnvironmentMap::new(environment, finest);
}
