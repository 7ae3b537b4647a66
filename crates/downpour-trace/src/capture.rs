//! The environment of the eye, traced by rays. Twin of `shaders/wgsl/render/capture.wgsl`.

use std::ops::Range;

use downpour_math::packing::{packing_octahedral_decode, packing_octahedral_encode};
use downpour_render::camera::Camera;
use downpour_render::rain::{EnvironmentFrame, EnvironmentMap, RefractionForm};
use downpour_shaders::render::scene::{
    CAPTURE_AREA_OVER_PI, CAPTURE_SKY, SCENE_FAR, SCENE_OCTAHEDRAL, SCENE_PERSPECTIVE,
};
use glam::Vec3;
use rayon::prelude::*;

use crate::data::{RenderFrame, SceneData};
use crate::scene::SceneView;

/// Rays to the sky of a sample of the environment for each of the picture's, and the most of them.
const SKY_RAYS: u32 = 4;
const MAX_SKY_RAYS: u32 = 64;

/// Texels over which a drop's lookups take means, at least.
const LOOKUP_TEXELS: f32 = 8.0;

/// The frame of the rays of an environment map, for a frame of the picture.
#[must_use]
pub fn environment_frame(picture: &RenderFrame, environment: &EnvironmentFrame) -> RenderFrame {
    let projection = match environment.form {
        RefractionForm::Direction => SCENE_OCTAHEDRAL,
        RefractionForm::Rousseau2006 => SCENE_PERSPECTIVE,
    };
    let sky_rays = (picture.sky_rays * SKY_RAYS).min(MAX_SKY_RAYS);
    RenderFrame {
        camera: Camera {
            width: environment.size,
            height: environment.size,
            right: environment.right,
            up: environment.up,
            forward: environment.forward,
            pixel_angle: environment.texel_angle,
            ..picture.camera
        },
        grid: environment.grid,
        // No filter takes means over neighbors here, but the drops' lookups do.
        sky_rays,
        ray_fraction: 1.0 / (LOOKUP_TEXELS * sky_rays.max(1) as f32),
        first_row: 0,
        projection,
        // No filter here, either.
        ray_spacing: 1,
        ray_column: 0,
        ray_row: 0,
        impostors: 0,
        ..*picture
    }
}

/// Traces the environment of a picture's eye on the CPU.
#[must_use]
pub fn trace_environment(
    data: &SceneData,
    picture: &RenderFrame,
    environment: &EnvironmentFrame,
) -> EnvironmentMap {
    let texels = trace_environment_rows(data, picture, environment, 0..environment.size);
    EnvironmentMap::new(environment, texels)
}

/// Traces rows of the finest level of the environment of a picture's eye on the CPU.
pub(crate) fn trace_environment_rows(
    data: &SceneData,
    picture: &RenderFrame,
    environment: &EnvironmentFrame,
    rows: Range<u32>,
) -> Vec<[f32; 4]> {
    let frame = environment_frame(picture, environment);
    let view = &SceneView { data, frame: &frame };
    let size = frame.camera.width;
    rows.into_par_iter()
        .flat_map_iter(|y| (0..size).map(move |x| view.trace_pixel(x, y).0.to_array()))
        .collect()
}

/// The direction of a position of the map, in texels from the top left.
pub(crate) fn capture_direction(frame: &RenderFrame, x: f32, y: f32) -> Vec3 {
    let scale = 2.0 / frame.camera.width as f32;
    packing_octahedral_decode([x * scale - 1.0, y * scale - 1.0]).into()
}

/// The mean of the sky over a texel of the map that shows nothing else: a sun of a sky map is narrower than a texel.
pub(crate) fn capture_sky(view: &SceneView<'_>, x: u32, y: u32) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for k in 0..CAPTURE_SKY * CAPTURE_SKY {
        let dx = ((k % CAPTURE_SKY) as f32 + 0.5) / CAPTURE_SKY as f32;
        let dy = ((k / CAPTURE_SKY) as f32 + 0.5) / CAPTURE_SKY as f32;
        sum += view.data.sky_level(0, capture_direction(view.frame, x as f32 + dx, y as f32 + dy));
    }
    sum / (CAPTURE_SKY * CAPTURE_SKY) as f32
}

/// The light of parallel sources in a texel.
pub(crate) fn capture_suns(view: &SceneView<'_>, x: u32, y: u32) -> Vec3 {
    let frame = view.frame;
    let size = frame.camera.width as f32;
    if frame.projection != SCENE_OCTAHEDRAL || frame.suns_out > 0 {
        return Vec3::ZERO;
    }
    let eye = frame.camera.eye;
    let mut sum = Vec3::ZERO;
    for k in 0..frame.light_count {
        let light = view.data.light_load(k);
        if !light.is_parallel() {
            continue;
        }
        let light = light.light_sample(eye, 0.0);
        let square = packing_octahedral_encode(light.direction.to_array());
        let position = square.map(|s| ((s * 0.5 + 0.5) * size).clamp(0.0, size - 1.0));
        if position[0] as u32 != x || position[1] as u32 != y {
            continue;
        }
        // A square of the plane |x| + |y| + |z| = 1, seen from its middle.
        let norm = light.direction.abs().element_sum();
        let texel_over_pi = CAPTURE_AREA_OVER_PI / (size * size) * norm * norm * norm;
        let visible = view.scene_visibility(eye, light.direction, SCENE_FAR);
        sum += light.irradiance * visible / texel_over_pi;
    }
    sum
}
