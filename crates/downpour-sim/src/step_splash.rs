//! Crowns of the splashes of stepped rain: those of impacts that the last steps have kept. Twin of
//! `shaders/wgsl/sim/step_splash.wgsl`.

use bytemuck::{Pod, Zeroable};
use downpour_shaders::sim::field::{FIELD_ALWAYS, FIELD_BOUNCED};
use downpour_shaders::sim::step::{STEP_EVENT_DROP, STEP_SPANS};
use glam::{Vec3, Vec4, Vec4Swizzles as _};

use crate::falling::EyeDrop;
use crate::step::StepEvent;
use crate::step_list::step_list_id;

/// Uniforms of the crowns of a picture, in the layout of `StepSplashFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepSplashFrame {
    /// Of each span of time: its origin relative to the eye, m, and the time from its beginning to the picture, s.
    pub spans: [[f32; 4]; STEP_SPANS as usize],
    /// Index of the first impact of the first span.
    pub first: u32,
    /// Room for the impacts of each span.
    pub room: u32,
    /// Padding of the WGSL layout.
    pub unused_1: u32,
    /// Padding of the WGSL layout.
    pub unused_2: u32,
}

/// The drop of an impact that was kept in a span, up to its end. `span` is as in [`StepSplashFrame::spans`].
#[must_use]
pub fn step_splash_drop(event: &StepEvent, span: [f32; 4]) -> EyeDrop {
    let span = Vec4::from(span);
    let velocity = Vec3::from(event.velocity);
    let met = event.time - span.w;
    let [high, low] = step_list_id(event.last, event.drop & STEP_EVENT_DROP);
    EyeDrop {
        offset: (Vec3::from(event.position) + span.xyz() - velocity * met).to_array(),
        diameter: event.diameter,
        velocity: event.velocity,
        id: high ^ low,
        present: [-FIELD_ALWAYS, met],
        speed: FIELD_BOUNCED,
        id_low: low,
    }
}
