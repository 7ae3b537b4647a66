//! Rays that look for the light that a surface shows: drawn for its diffuse base and for its gloss. Twin of
//! `shaders/wgsl/render/scatter.wgsl`.
//!
//! A ray's direction is drawn from the hemisphere, weighted by the cosine, or from the mirror images that the microfacets
//! show ([`brdf`](crate::brdf)); which of the two is left to chance. Light from that direction counts for both, as much as
//! the mean over all rays needs (a mixture's density). A ray is as wide as the part of all rays that it is, so that what
//! it finds is a mean over that width.

use downpour_math::ops;
use downpour_math::packing::packing_sign;
use downpour_shaders::render::brdf::BRDF_GRAZING;
use downpour_shaders::render::scatter::{
    SCATTER_DISK, SCATTER_MAX_WIDTH, SCATTER_MIN_ALPHA, SCATTER_MIN_DIVISOR,
};
use glam::Vec3;

use crate::brdf::{
    brdf_distribution, brdf_environment, brdf_fresnel, brdf_visibility, brdf_visible_density,
    brdf_visible_normal,
};
use crate::data::SceneData;
use crate::surface::Surface;

/// A ray that looks for light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScatterRay {
    /// Direction, of length 1.
    pub(crate) along: Vec3,
    /// Width at distance 1.
    pub(crate) width: f32,
    /// Weight of its light for the diffuse base, per albedo.
    pub(crate) diffuse: Vec3,
    /// Roughness of the surface that it has left; 1 for rays of the diffuse base.
    pub(crate) roughness: f32,
    /// Weight of its light for the gloss, per [`scatter_gloss`] or what else the gloss is multiplied with.
    pub(crate) mirror: Vec3,
}

impl ScatterRay {
    /// A ray all of whose light counts.
    pub(crate) const ALL: Self =
        Self { along: Vec3::ZERO, width: 0.0, diffuse: Vec3::ONE, roughness: 0.0, mirror: Vec3::ONE };
}

/// A unit vector across a normal.
#[must_use]
pub fn scatter_tangent(normal: Vec3) -> Vec3 {
    // T. Duff et al., JCGT 6(1), 2017.
    let side = packing_sign(normal.z);
    let p = -1.0 / (side + normal.z);
    Vec3::new(1.0 + side * normal.x * normal.x * p, side * (normal.x * normal.y * p), -side * normal.x)
}

/// A direction over the hemisphere around a normal, cosine-weighted, for two numbers in [0, 1).
#[must_use]
pub fn scatter_hemisphere(normal: Vec3, a: f32, b: f32) -> Vec3 {
    let radius = a.sqrt();
    let angle = std::f32::consts::TAU * b;
    let height = (1.0 - a).max(0.0).sqrt();
    let tangent = scatter_tangent(normal);
    let other = normal.cross(tangent);
    tangent * (radius * ops::cos(angle)) + other * (radius * ops::sin(angle)) + normal * height
}

/// A direction, thrown back by the facet if it goes into it: at the rim of a round thing, interpolated normals send it there.
#[must_use]
pub fn scatter_above(facet: Vec3, along: Vec3) -> Vec3 {
    along - facet * (2.0 * facet.dot(along).min(0.0))
}

/// Alpha of the lobe of a roughness.
#[must_use]
pub fn scatter_alpha(roughness: f32) -> f32 {
    (roughness * roughness).max(SCATTER_MIN_ALPHA)
}

/// Fraction of a uniform environment that the gloss of a surface shows. `sharp`: of a mirror.
#[must_use]
pub fn scatter_gloss(normal_reflectance: Vec3, roughness: f32, cosine: f32, sharp: bool) -> Vec3 {
    if sharp {
        return brdf_fresnel(normal_reflectance, 0.0, cosine);
    }
    brdf_environment(normal_reflectance, roughness, cosine)
}

/// A ray of a surface: of its gloss where `a` is below `chance`, else of its diffuse base. `view` points to the viewer,
/// `gloss` is what the weight of the gloss is divided by, `fraction` the part of all rays that this is.
///
/// Under a film, light goes in and comes out as [`wet`](crate::wet) says.
pub(crate) fn scatter_draw(
    data: &SceneData,
    surface: &Surface,
    view: Vec3,
    gloss: Vec3,
    chance: f32,
    [a, b]: [f32; 2],
    fraction: f32,
) -> ScatterRay {
    let normal = surface.normal;
    let alpha = scatter_alpha(surface.roughness);
    let cosine_view = normal.dot(view).max(BRDF_GRAZING);
    let mut along = normal;
    let mut roughness = 1.0;
    if a < chance {
        let tangent = scatter_tangent(normal);
        let other = normal.cross(tangent);
        let local = Vec3::new(view.dot(tangent), view.dot(other), cosine_view);
        let half = brdf_visible_normal(local, alpha, a / chance, b);
        let half = tangent * half.x + other * half.y + normal * half.z;
        along = half * (2.0 * view.dot(half)) - view;
        roughness = surface.roughness;
    } else {
        along = scatter_hemisphere(along, (a - chance) / (1.0 - chance), b);
    }
    // What goes into the surface is lost; only what goes into the facet alone is thrown back.
    let above = normal.dot(along) > 0.0;
    along = scatter_above(surface.facet, along);
    let none = ScatterRay { along, width: 0.0, diffuse: Vec3::ZERO, roughness, mirror: Vec3::ZERO };
    let cosine = normal.dot(along);
    if !above || cosine <= 0.0 {
        return none;
    }
    let sum = view + along;
    let half = sum / sum.dot(sum).sqrt().max(SCATTER_MIN_DIVISOR);
    let cosine_half = normal.dot(half).clamp(0.0, 1.0);
    let fresnel = brdf_fresnel(surface.normal_reflectance, surface.film, view.dot(half));
    // All densities times pi.
    let glossy = brdf_visible_density(alpha, cosine_half, cosine_view);
    let density = (glossy * chance + cosine * (1.0 - chance)).max(SCATTER_MIN_DIVISOR);
    let mut ray = none;
    ray.width = (SCATTER_DISK * fraction / density).sqrt().min(SCATTER_MAX_WIDTH);
    if chance < 1.0 {
        ray.diffuse = (Vec3::ONE - fresnel) * (cosine / density);
        if surface.film > 0.0 {
            let under = data.wet_out(surface, cosine_view) * data.wet_in(surface, cosine);
            ray.diffuse += (under - Vec3::ONE + fresnel) * (surface.film * cosine / density);
        }
    }
    if chance > 0.0 {
        let lobe =
            brdf_distribution(alpha, cosine_half) * brdf_visibility(alpha, cosine_view, cosine) * cosine;
        ray.mirror = fresnel * (lobe / density) / gloss.max(Vec3::splat(SCATTER_MIN_DIVISOR));
    }
    ray
}

/// The ray of a mirror, as wide as the lobe of its roughness.
pub(crate) fn scatter_mirror(surface: &Surface, view: Vec3) -> ScatterRay {
    let cosine = surface.normal.dot(view).max(0.0);
    let along = surface.normal * (2.0 * surface.normal.dot(view)) - view;
    let density = brdf_visible_density(scatter_alpha(surface.roughness), 1.0, cosine.max(BRDF_GRAZING));
    ScatterRay {
        along: scatter_above(surface.facet, along),
        width: (SCATTER_DISK / density.max(SCATTER_MIN_DIVISOR)).sqrt().min(SCATTER_MAX_WIDTH),
        diffuse: Vec3::ZERO,
        roughness: surface.roughness,
        mirror: Vec3::ONE,
    }
}

/// The part of rays that are drawn for the gloss of a surface, by what both parts of it show.
#[must_use]
pub fn scatter_chance(body: Vec3, gloss: Vec3) -> f32 {
    let (body, gloss) = (body.max_element(), gloss.max_element());
    if body <= 0.0 {
        return 1.0;
    }
    gloss / (body + gloss)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builder::SceneBuilder;
    use crate::sky_light::SkyLight;
    use downpour_math::ops::f64 as exact;
    use glam::DVec3;

    fn surface(diffuse: f32, normal_reflectance: f32, roughness: f32) -> Surface {
        Surface {
            position: Vec3::ZERO,
            alpha: 1.0,
            normal: Vec3::Y,
            roughness,
            facet: Vec3::Y,
            occlusion: 1.0,
            diffuse: Vec3::splat(diffuse),
            flags: 0,
            normal_reflectance: Vec3::splat(normal_reflectance),
            transmission: 0.0,
            emission: Vec3::ZERO,
            bend: 0.0,
            porosity: 0.0,
            film: 0.0,
            variance: 0.0,
            diffuse_transmission: Vec3::ZERO,
        }
    }

    /// glTF 2.0, appendix B, in double precision: diffuse and glossy part of the light of a uniform sky that one side
    /// of the sky (x > 0) gives, seen at a cosine along x.
    fn quadrature(diffuse: f64, f0: f64, roughness: f64, cosine: f64) -> [f64; 2] {
        let a2 = (roughness * roughness) * (roughness * roughness);
        let view = DVec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0);
        let (n, mut sums) = (700u32, [0.0; 2]);
        for i in 0..n {
            // The light's height, finer toward the horizon.
            let u = (f64::from(i) + 0.5) / f64::from(n);
            let polar = std::f64::consts::FRAC_PI_2 * u;
            let (height, flat) = (exact::cos(polar), exact::sin(polar));
            for j in 0..n {
                let turn = std::f64::consts::PI * ((f64::from(j) + 0.5) / f64::from(n) - 0.5);
                let light = DVec3::new(flat * exact::cos(turn), height, flat * exact::sin(turn));
                let half = (view + light).normalize();
                let rest = 1.0 - view.dot(half);
                let fresnel = f0 + (1.0 - f0) * (rest * rest * rest * rest * rest);
                let narrow = half.y * half.y * (a2 - 1.0) + 1.0;
                let d = a2 / (std::f64::consts::PI * narrow * narrow);
                let smith = |c: f64, other: f64| other * (c * c * (1.0 - a2) + a2).sqrt();
                let visibility = 0.5 / (smith(cosine, height) + smith(height, cosine));
                let angle = flat * std::f64::consts::FRAC_PI_2 * std::f64::consts::PI / f64::from(n * n);
                sums[0] += (1.0 - fresnel) * diffuse / std::f64::consts::PI * height * angle;
                sums[1] += fresnel * d * visibility * height * angle;
            }
        }
        sums
    }

    /// However rays are shared out, both parts get the light that they reflect.
    #[test]
    fn rays_bring_the_light_of_the_reflection_law() {
        for (diffuse, f0, roughness, cosine) in [
            (0.8f32, 0.04f32, 1.0f32, 0.7f32),
            (0.5, 0.04, 0.5, 0.3),
            (0.0, 0.9, 0.4, 0.6),
            (0.3, 0.5, 0.7, 0.15),
        ] {
            let surface = surface(diffuse, f0, roughness);
            let data = SceneBuilder::new().build(&SkyLight::new(1, 1, &[[1.0; 3]]));
            let view = Vec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0);
            let expected =
                quadrature(diffuse.into(), f0.into(), roughness.into(), cosine.into()).map(|v| v as f32);
            for chance in [0.2, 0.7] {
                let (n, mut sums) = (400u16, [0.0; 2]);
                for i in 0..n {
                    for j in 0..n {
                        let (a, b) =
                            ((f32::from(i) + 0.5) / f32::from(n), (f32::from(j) + 0.5) / f32::from(n));
                        let ray = scatter_draw(&data, &surface, view, Vec3::ONE, chance, [a, b], 1.0);
                        if ray.along.x > 0.0 {
                            sums[0] += diffuse * ray.diffuse.x;
                            sums[1] += ray.mirror.x;
                        }
                    }
                }
                for (sum, expected) in sums.into_iter().zip(expected) {
                    let found = sum / (f32::from(n) * f32::from(n));
                    let off = (found - expected).abs();
                    assert!(
                        off < 2.0e-3 + 0.01 * expected,
                        "{diffuse} {f0} {roughness} {cosine}, {chance}: {found}, {expected}"
                    );
                }
            }
        }
    }
}
