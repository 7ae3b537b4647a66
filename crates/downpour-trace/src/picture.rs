//! The picture of a scene in the rain: the plate by rays, and the rain before it.
//!
//! [`render_picture`] makes it on the CPU, [`gpu::PictureRenderer`](crate::gpu::PictureRenderer) on a GPU: the same
//! passes over the same buffers.

use downpour_render::RenderError;
use downpour_render::camera::Viewpoint;
use downpour_render::glow::Glow;
use downpour_render::picture::{Picture, PictureOptions, rain_layer, timed};
use downpour_render::plate::Plate;
use downpour_render::rain::light::DropLightForm;
use downpour_render::rain::{DropMasks, EnvironmentMap, Rain};
use downpour_render::refine::refine_pixel;
use downpour_sim::field::FallingDrop;

use crate::capture::trace_environment;
use crate::data::{RenderFrame, SceneData};
use crate::kept::KeptPlate;
use crate::scene::SceneView;

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
    Ok(RenderFrame { suns_out: u32::from(traced), ..frame })
}

/// Picture of a scene without rain, and what is around its eye, traced on the CPU.
#[derive(Clone, Debug)]
pub struct TracedPlate {
    /// Radiance and distance of each pixel.
    pub clean: Vec<[f32; 4]>,
    /// Environment map of the eye.
    pub environment: EnvironmentMap,
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
    render_picture_on(&mut None, 1, scene, viewpoint, drops, masks, options)
}

/// The same over the plate of the last picture, if it shows the same: [`KeptPlate`]. It is refined by a frame of rays for each picture, up to
/// `max_frames`.
///
/// # Errors
/// As [`render_picture`].
pub fn render_picture_on(
    kept: &mut Option<KeptPlate<TracedPlate>>,
    max_frames: u32,
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
    let plate = kept.take().filter(|plate| plate.shows(scene, &frame, &rain.environment));
    let plate = kept.insert(plate.unwrap_or_else(|| {
        let environment =
            timed(&mut passes, "capture", || trace_environment(scene, &frame, &rain.environment));
        let held = TracedPlate { clean: Vec::new(), environment };
        KeptPlate::new(scene, &frame, &rain.environment, held)
    }));
    if let Some((refined, count)) = plate.next(&frame, max_frames) {
        let next = timed(&mut passes, "scene", || SceneView { data: scene, frame: &refined }.picture());
        if count == 1 {
            plate.held.clean = next;
        } else {
            let pixels = plate.held.clean.iter_mut().zip(next);
            pixels.for_each(|(mean, next)| *mean = refine_pixel(*mean, next, count));
        }
    }
    let TracedPlate { clean, environment } = &plate.held;
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
