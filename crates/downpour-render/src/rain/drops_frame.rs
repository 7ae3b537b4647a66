//! The picture as the drops' kernels know it. Twin of `shaders/wgsl/render/drops_frame.wgsl`.

use super::environment::EnvironmentFrame;
use super::exposure::{MAX_STREAK_SAMPLES, StreakSamples};
use super::light::DropLightForm;
use super::{DropMasks, RainOptions};
use crate::camera::Camera;

/// Samples of a streak for which the table has no entry: too short, or across the others.
const STREAK_SPARE: u32 = 16;

/// Uniforms of the drops' shader. The same layout as `DropsFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct DropsFrame {
    /// Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    pub unread: u32,
    /// Drops of the list.
    pub count: u32,
    /// Classes, from the first, whose means are made before a drop asks for them.
    pub made_classes: u32,
    /// Multiple of the light that a drop takes out and gives.
    pub visibility: f32,
    /// The camera.
    pub camera: Camera,
    /// Right axis of the capture in the papers' form: its whole width at distance 1.
    pub capture_right: [f32; 3],
    /// Texels along an edge of the capture.
    pub capture_size: u32,
    /// See `capture_right`.
    pub capture_up: [f32; 3],
    /// Index of the coarsest level of the capture.
    pub capture_last: u32,
    /// View direction of the capture.
    pub capture_forward: [f32; 3],
    /// Angle of a texel of the capture.
    pub capture_texel: f32,
    /// Form of refraction.
    pub form: u32,
    /// Texels along an edge of a mask.
    pub mask_size: u32,
    /// Number under which means of classes stay from picture to picture; 0: each picture finds its own.
    pub known: u32,
    /// Terms of the formula of Rousseau 2006 for the light of lamps.
    pub light_terms: u32,
    /// Samples along the chord of a streak that is averaged by a loop.
    pub streak_samples: u32,
    /// The color of streaks.
    pub streak_color: u32,
    /// Rows of light of each drop besides its mean: glints, or streaks of the atlas.
    pub glints: u32,
    /// First word of the atlas behind the masks; 0: no atlas.
    pub atlas: u32,
}

/// Data that the drops' kernels read besides the drops.
#[derive(Clone, Copy)]
pub(crate) struct DropsView<'a> {
    pub(crate) frame: &'a DropsFrame,
    pub(crate) masks: &'a [u32],
    pub(crate) capture: &'a [[f32; 4]],
}

impl DropsFrame {
    pub(crate) fn new(
        camera: &Camera,
        environment: &EnvironmentFrame,
        masks: &DropMasks,
        options: &RainOptions,
    ) -> Self {
        let streak_samples = match options.exposure.samples {
            StreakSamples::Table => STREAK_SPARE,
            StreakSamples::Loop(samples) => samples.clamp(1, MAX_STREAK_SAMPLES),
        };
        Self {
            camera: *camera,
            capture_right: environment.right.into(),
            capture_size: environment.size,
            capture_up: environment.up.into(),
            capture_last: environment.size.ilog2(),
            capture_forward: environment.forward.into(),
            capture_texel: environment.texel_angle,
            form: environment.form as u32,
            mask_size: masks.size,
            known: 0,
            light_terms: options.light.form.terms(),
            streak_samples,
            streak_color: options.exposure.color as u32,
            glints: options.light.glints,
            atlas: if options.light.form == DropLightForm::Atlas { masks.atlas } else { 0 },
            visibility: options.visibility as f32,
            made_classes: 0,
            count: 0,
            unread: 0,
        }
    }
}
