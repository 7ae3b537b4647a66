//! What is round the eye, as drops show it. Twin of `shaders/wgsl/render/capture.wgsl`.
//!
//! By default an octahedral map: all directions, at nearly the same fineness everywhere. The papers' form is a
//! perspective picture 165 degrees wide.

use downpour_math::packing::{packing_octahedral_decode, packing_octahedral_encode};
use downpour_shaders::render::scene::{
    CAPTURE_AREA_OVER_PI, CAPTURE_SKY, SCENE_FAR, SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_ROWS,
    SCENE_OCTAHEDRAL, SCENE_PERSPECTIVE,
};
use glam::Vec3;
use rayon::prelude::*;

use super::{RainOptions, RefractionForm, reduce};
use crate::data::RenderFrame;
use crate::scene::SceneView;

/// Tangent of half of 165 degrees: what a drop of water refracts (Rousseau 2006 has 150 in one place: a rounding).
const WIDE: f32 = 7.595_754;

/// Rays to the sky of a capture's sample for each of the picture's, and the most of them.
const SKY_RAYS: u32 = 4;
const MOST_SKY_RAYS: u32 = 64;

/// Texels over which a drop's lookups take means, at least.
const LOOKUP_TEXELS: f32 = 8.0;

/// How the surroundings are captured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaptureFrame {
    /// The frame of the rays: `width` texels along both edges.
    pub frame: RenderFrame,
    /// Whether the map is octahedral, or a picture.
    pub form: RefractionForm,
}

/// The surroundings: radiance, finest level first, each level half the one before.
#[derive(Clone, Debug, PartialEq)]
pub struct Capture {
    /// Texels of all levels.
    pub texels: Vec<[f32; 4]>,
}

impl CaptureFrame {
    /// The capture that belongs to a frame of the picture.
    #[must_use]
    pub fn new(picture: &RenderFrame, options: &RainOptions) -> Self {
        let size = options.capture_size.clamp(16, 2048).next_power_of_two();
        let unit = |v: [f32; 3]| Vec3::from(v).normalize_or_zero();
        let wide = |v: [f32; 3]| (unit(v) * WIDE).to_array();
        let (projection, pixel_angle) = match options.form {
            // A texel of the sphere.
            RefractionForm::Direction => {
                (SCENE_OCTAHEDRAL, (4.0 * std::f32::consts::PI).sqrt() / size as f32)
            }
            // In the middle of the picture, where it is coarsest.
            RefractionForm::Rousseau2006 => (SCENE_PERSPECTIVE, 2.0 * WIDE / size as f32),
        };
        let sky_rays = (picture.sky_rays * SKY_RAYS).min(MOST_SKY_RAYS);
        let frame = RenderFrame {
            width: size,
            height: size,
            right: wide(picture.right),
            up: wide(picture.up),
            forward: unit(picture.forward).into(),
            pixel_angle,
            grid: options.capture_grid.clamp(1, 16),
            // No filter takes means over neighbours here, but the drops' lookups do.
            sky_rays,
            ray_share: 1.0 / (LOOKUP_TEXELS * sky_rays.max(1) as f32),
            first_row: 0,
            projection,
            ..*picture
        };
        Self { frame, form: options.form }
    }

    /// Traces the surroundings on the CPU.
    #[must_use]
    pub fn trace(&self, data: &crate::data::SceneData) -> Capture {
        let view = SceneView { data, frame: &self.frame };
        let size = self.frame.width;
        let view = &view;
        let mut texels: Vec<[f32; 4]> = (0..size)
            .into_par_iter()
            .flat_map_iter(|y| (0..size).map(move |x| view.trace_pixel(x, y).0.to_array()))
            .collect();
        reduce::reduce(&mut texels, size);
        Capture { texels }
    }
}

/// The direction of a place of the map, in texels from the top left.
pub(crate) fn capture_direction(frame: &RenderFrame, x: f32, y: f32) -> Vec3 {
    let scale = 2.0 / frame.width as f32;
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
    let size = frame.width as f32;
    if frame.projection != SCENE_OCTAHEDRAL || frame.suns_out > 0 {
        return Vec3::ZERO;
    }
    let eye = Vec3::from(frame.eye);
    let mut sum = Vec3::ZERO;
    for k in 0..frame.light_count {
        let row = (frame.lights + k * SCENE_LIGHT_ROWS) as usize;
        if view.data.table[row][3] != SCENE_LIGHT_DIRECTIONAL {
            continue;
        }
        let light = view.scene_light(k, eye, 0.0);
        let square = packing_octahedral_encode(light.direction.to_array());
        let place = square.map(|s| ((s * 0.5 + 0.5) * size).clamp(0.0, size - 1.0));
        if place[0] as u32 != x || place[1] as u32 != y {
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
