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
use downpour_render::rain::{DropMasks, Rain};
use downpour_sim::field::FallingDrop;

use crate::capture::trace_environment;
use crate::data::{RenderFrame, SceneData};
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
    let frame = picture_frame(scene, viewpoint, options)?;
    let camera = frame.camera;
    let mut passes = Vec::new();
    let view = SceneView { data: scene, frame: &frame };
    let clean = timed(&mut passes, "scene", || view.picture());
    let eye = viewpoint.eye.as_dvec3();
    let rain = timed(&mut passes, "binning", || Rain::new(&camera, eye, drops, masks, &options.rain));
    let environment = timed(&mut passes, "capture", || trace_environment(scene, &frame, &rain.environment));
    let plate = Plate { camera: &camera, pixels: &clean, environment: &environment, lighting: &view };
    let layer = rain_layer(&plate, &rain, masks, &mut passes)?;
    let mut picture = Picture::new(&rain, clean, layer, environment.texels, passes);
    if options.glow != Glow::default() {
        let start = std::time::Instant::now();
        picture.add_glow(&options.glow, &camera);
        picture.passes.push(("glow", start.elapsed().as_secs_f64() * 1.0e3));
    }
    Ok(picture)
}
