//! Lamps and the sun as a drop on a pane shows them: bright spots. Twin of `shaders/wgsl/render/glass_picture_light.wgsl`.
//!
//! Tatarchuk & Isidoro 2006, section 5, draw a quasi-caustic highlight in drops above a mass that an artist says. Here it is
//! the image of the source in the lens that a drop is: as bright as its irradiance says, spread over what a pixel sees, so that
//! the light in the picture does not depend on resolution. Sources are points or disks that no picture of the scene shows.

use std::f32::consts::PI;

use downpour_shaders::render::glass::{
    GLASS_PICTURE_FAR, GLASS_PICTURE_LIGHT_PEAK, GLASS_PICTURE_LIGHT_WIDTH,
};
use glam::Vec3;

use crate::plate::Lighting;

/// A lamp or the sun before a pane. The same layout as `GlassPictureLight` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassPictureLight {
    /// Position relative to the eye, m; a sun is far away.
    pub position: [f32; 3],
    /// Angular radius, radians.
    pub radius: f32,
    /// Irradiance at the eye of a surface that faces it.
    pub color: [f32; 3],
    /// Distance from the eye, m.
    pub distance: f32,
}

/// Fraction of a source's light per solid angle, at a squared distance in direction from its middle: a paraboloid whose
/// integral is 1.
#[must_use]
pub fn glass_picture_light_lobe(away: f32, radius: f32) -> f32 {
    let squared = radius * radius;
    (1.0 - away / squared).max(0.0) * GLASS_PICTURE_LIGHT_PEAK / squared
}

/// Radiance of a source in a direction from a position of the pane (m from the eye), for a footprint in radians.
#[must_use]
pub fn glass_picture_light_seen(
    light: &GlassPictureLight,
    from_eye: Vec3,
    direction: Vec3,
    footprint: f32,
) -> Vec3 {
    let way = Vec3::from(light.position) - from_eye;
    let squared = way.dot(way).max(1.0e-6);
    let away = direction - way / squared.sqrt();
    let width = footprint * GLASS_PICTURE_LIGHT_WIDTH;
    let radius = (light.radius * light.radius + width * width).sqrt();
    let nearer = light.distance * light.distance / squared;
    Vec3::from(light.color) * (nearer * glass_picture_light_lobe(away.dot(away), radius))
}

/// The lamps and the sun that the eye sees, with one ray for what stands between.
pub(super) fn sources(lighting: &dyn Lighting, eye: Vec3) -> Vec<GlassPictureLight> {
    let source = |k: u32| {
        let light = lighting.light(k).light_sample(eye, 0.0);
        let lit = light.irradiance * PI;
        let color = lit * lighting.visibility(eye, light.direction, light.distance);
        let distance = light.distance.min(GLASS_PICTURE_FAR);
        let position = light.direction * distance;
        (color.max_element() > 0.0).then(|| GlassPictureLight {
            position: position.into(),
            radius: light.spread,
            color: color.into(),
            distance,
        })
    };
    (0..lighting.light_count()).filter_map(source).collect()
}
