//! The plate: a picture without rain, with what is needed to rain on it.
//!
//! A plate can come from anywhere: `downpour-trace` makes one of a scene by rays. Rain asks it for three things:
//!
//! 1. the picture: radiance and distance of each pixel ([`Plate::pixels`]);
//! 2. the environment: radiance from every direction around the eye ([`EnvironmentMap`]), which drops refract and reflect;
//! 3. the lamps, and what stands in their light ([`Lighting`]), for drops are lit where they are.

use std::fmt::Debug;

use glam::Vec3;

use crate::camera::Camera;
use crate::light::Light;
use crate::rain::EnvironmentMap;
use crate::spacing::RaySpacing;

/// Lamps, and what hides them and keeps the rain off.
pub trait Lighting: Debug + Sync {
    /// Number of lights.
    fn light_count(&self) -> u32;

    /// Light `index`, below [`Lighting::light_count`].
    fn light(&self, index: u32) -> Light;

    /// Fraction of light, by color, that passes from a point along a unit direction over a distance in meters.
    fn visibility(&self, point: Vec3, direction: Vec3, distance: f32) -> Vec3;

    /// True if anything is in the way from a point along a unit direction.
    fn is_covered(&self, point: Vec3, direction: Vec3) -> bool;

    /// Distance in meters of the first surface from a point along a unit direction: what lets light through is one, a hole is not.
    fn first_surface(&self, point: Vec3, direction: Vec3) -> Option<f32>;

    /// True if there are no obstacles at all.
    fn is_open(&self) -> bool;

    /// Pixels whose rays look for the light of lamps on unresolved rain, for those around them: all, unless a plate is drawn with fewer.
    fn ray_spacing(&self) -> RaySpacing {
        RaySpacing::ALL
    }
}

/// A picture without rain, with all that is needed to add rain.
#[derive(Clone, Copy, Debug)]
pub struct Plate<'a> {
    /// Camera of the picture.
    pub camera: &'a Camera,
    /// Linear radiance, and distance of the nearest surface in each pixel (1e30 for the sky), rows from the top.
    pub pixels: &'a [[f32; 4]],
    /// Radiance from every direction around the eye.
    pub environment: &'a EnvironmentMap,
    /// Lamps and obstacles.
    pub lighting: &'a dyn Lighting,
}
