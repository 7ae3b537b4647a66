//! Surfaces that transmit light diffusely, as leaves do: glTF's `KHR_materials_diffuse_transmission`. Twin of
//! `shaders/wgsl/render/translucent.wgsl`.
//!
//! Such a surface scatters a part of the light that falls on its back evenly to the viewer's side: radiance is that part times the
//! irradiance behind, over pi. It is one diffuse base with two sides:
//!
//! - what the camera sees has the lamps of both sides, each on its own, and its rays look for the light of sky and surfaces on either, by
//!   what each side gives back; means over neighboring pixels are taken of both together, with the sum of the two albedos as their factor;
//! - what a ray meets has the light of one side, drawn for both.
//!
//! Which side of a leaf a lamp lights, its normal for shading says, which may be that of a whole crown.
//!
//! Limits: the gloss of the other side is not seen through it, and its shadow is that of an opaque surface: what passes is scattered.

use glam::Vec3;

use crate::data::SceneData;
use crate::surface::Surface;

/// Fraction of the light on a surface that leaves it toward the viewer: of that on the viewer's side and of that from behind together.
#[must_use]
pub fn translucent_albedo(surface: &Surface) -> Vec3 {
    surface.diffuse + surface.diffuse_transmission
}

/// Part of that fraction that light from behind has.
#[must_use]
pub fn translucent_part(surface: &Surface) -> Vec3 {
    surface.diffuse_transmission / translucent_albedo(surface).max(Vec3::splat(1.0e-9))
}

/// True if light from behind leaves a surface.
#[must_use]
pub fn translucent_is(surface: &Surface) -> bool {
    surface.diffuse_transmission.cmpgt(Vec3::ZERO).any()
}

/// Part of the rays that look for the light behind.
#[must_use]
pub fn translucent_chance(surface: &Surface) -> f32 {
    let behind = surface.diffuse_transmission.max_element();
    behind / (behind + surface.diffuse.max_element()).max(1.0e-9)
}

/// The surface as the light behind it meets it: matte, and with its other side to the light. Its viewer is where the ray goes.
#[must_use]
pub fn translucent_behind(surface: &Surface) -> Surface {
    Surface {
        normal: -surface.normal,
        facet: -surface.facet,
        diffuse: surface.diffuse_transmission,
        diffuse_transmission: Vec3::ZERO,
        normal_reflectance: Vec3::ZERO,
        roughness: 1.0,
        film: 0.0,
        ..*surface
    }
}

/// The normal of the triangle on the side of the surface that light from a direction meets; the viewer's if no light passes.
#[must_use]
pub fn translucent_facet(surface: &Surface, direction: Vec3) -> Vec3 {
    let is_behind = translucent_is(surface) && surface.facet.dot(direction) < 0.0;
    if is_behind { -surface.facet } else { surface.facet }
}

/// One side drawn for both by a number in [0, 1), and as much brighter; flat, so that no light is on neither.
#[must_use]
pub fn translucent_drawn(surface: &Surface, number: f32) -> Surface {
    let chance = translucent_chance(surface);
    if number < chance {
        let behind = translucent_behind(surface);
        return Surface { diffuse: behind.diffuse / chance, normal: behind.facet, ..behind };
    }
    Surface {
        diffuse: surface.diffuse / (1.0 - chance),
        diffuse_transmission: Vec3::ZERO,
        normal: surface.facet,
        ..*surface
    }
}

impl SceneData {
    /// Light of the open sky on the diffuse base, over pi.
    #[must_use]
    pub fn translucent_sky(&self, surface: &Surface) -> Vec3 {
        let light = self.sky_irradiance(surface.normal);
        if !translucent_is(surface) {
            return light;
        }
        light + (self.sky_irradiance(-surface.normal) - light) * translucent_part(surface)
    }
}
