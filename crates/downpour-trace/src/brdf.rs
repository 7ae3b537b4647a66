//! Reflection at a surface: GGX microfacets over a diffuse base, metallic-roughness.
//!
//! Sources: B. Walter et al., "Microfacet models for refraction through rough surfaces", EGSR 2007 (GGX); E. Heitz,
//! JCGT 3(2), 2014 (height-correlated Smith); C. Schlick 1994; glTF 2.0 appendix B; Fresnel's own law for
//! water ([`optics`](downpour_drop::optics)). The environment term is the fit of B. Karis, "Physically based shading on
//! mobile", 2014.
//!
//! Reflected rays are drawn by the normals that the viewer sees (E. Heitz, JCGT 7(4), 2018).
//!
//! Symbols: alpha = roughness^2; all cosines in [0, 1]. Twin of `shaders/wgsl/render/brdf.wgsl`.

use downpour_drop::optics::optics_fresnel;
use downpour_math::ops;
use downpour_shaders::render::brdf::{BRDF_GRAZING, BRDF_MIN_DIVISOR, BRDF_MIN_REFLECTANCE};
use downpour_shaders::render::puddle_water::{PUDDLE_WATER_INDEX, PUDDLE_WATER_NORMAL};
use glam::Vec3;

/// Normal distribution times pi: D(h) pi, at a cosine to the normal.
#[must_use]
pub fn brdf_distribution(alpha: f32, cosine_half: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = (cosine_half * a2 - cosine_half) * cosine_half + 1.0;
    a2 / (d * d)
}

/// Height-correlated Smith visibility: G over 4 times both cosines.
#[must_use]
pub fn brdf_visibility(alpha: f32, cosine_view: f32, cosine_light: f32) -> f32 {
    let a2 = alpha * alpha;
    let view = cosine_light * ((cosine_view - a2 * cosine_view) * cosine_view + a2).sqrt();
    let light = cosine_view * ((cosine_light - a2 * cosine_light) * cosine_light + a2).sqrt();
    0.5 / (view + light).max(BRDF_MIN_DIVISOR)
}

/// Rise of a reflectance from that at normal incidence (0) to that at grazing incidence (1), of a surface of which a film of
/// water covers the fraction `film`: Fresnel's for water; where there is no film, Schlick's, whose index is not known.
///
/// Schlick's is 14 % above Fresnel's for water at 12 degrees over the surface, and 12 % below it at 36.
#[must_use]
pub fn brdf_rise(film: f32, cosine: f32) -> f32 {
    let c = cosine.clamp(0.0, 1.0);
    let rest = 1.0 - c;
    let square = rest * rest;
    let fifth = square * square * rest;
    if film <= 0.0 {
        return fifth;
    }
    let of_water =
        (optics_fresnel(c, PUDDLE_WATER_INDEX) - PUDDLE_WATER_NORMAL) / (1.0 - PUDDLE_WATER_NORMAL);
    fifth + (of_water - fifth) * film
}

/// Reflectance at grazing incidence: all light, but for what reflects nothing at normal incidence, which has no gloss.
#[must_use]
pub fn brdf_grazing(normal_reflectance: Vec3) -> Vec3 {
    (normal_reflectance / BRDF_MIN_REFLECTANCE).min(Vec3::ONE)
}

/// Reflectance at a cosine, for that at normal incidence. `film`: fraction that a film of water covers.
#[must_use]
pub fn brdf_fresnel(normal_reflectance: Vec3, film: f32, cosine: f32) -> Vec3 {
    normal_reflectance + (brdf_grazing(normal_reflectance) - normal_reflectance) * brdf_rise(film, cosine)
}

/// Radiance toward the viewer for light of irradiance pi from one direction, cosine at the surface included.
#[must_use]
pub fn brdf_direct(
    diffuse: Vec3,
    normal_reflectance: Vec3,
    film: f32,
    alpha: f32,
    normal: Vec3,
    view: Vec3,
    light: Vec3,
) -> Vec3 {
    let cosine_light = normal.dot(light);
    if cosine_light <= 0.0 {
        return Vec3::ZERO;
    }
    let cosine_view = normal.dot(view).max(BRDF_GRAZING);
    let sum = view + light;
    let halfway = sum / sum.dot(sum).sqrt().max(BRDF_MIN_DIVISOR);
    let cosine_half = normal.dot(halfway).clamp(0.0, 1.0);
    let fresnel = brdf_fresnel(normal_reflectance, film, view.dot(halfway));
    let specular = brdf_distribution(alpha, cosine_half) * brdf_visibility(alpha, cosine_view, cosine_light);
    ((Vec3::ONE - fresnel) * diffuse + fresnel * specular) * cosine_light
}

/// Smith's masking: fraction of the microfacets facing a direction that is visible from it.
#[must_use]
pub fn brdf_masking(alpha: f32, cosine: f32) -> f32 {
    let a2 = alpha * alpha;
    2.0 * cosine / (cosine + ((cosine - a2 * cosine) * cosine + a2).sqrt()).max(BRDF_MIN_DIVISOR)
}

/// Normal of a microfacet, drawn from those that a viewer sees. `view` points to the viewer, in axes whose third is the
/// surface's normal; `a` and `b` are uniform in [0, 1).
#[must_use]
pub fn brdf_visible_normal(view: Vec3, alpha: f32, a: f32, b: f32) -> Vec3 {
    // Stretched, so that the surface is one of roughness 1.
    let stretched = Vec3::new(alpha * view.x, alpha * view.y, view.z);
    let v = stretched / stretched.dot(stretched).sqrt().max(BRDF_MIN_DIVISOR);
    let flat = v.x * v.x + v.y * v.y;
    let level = if flat > 0.0 { Vec3::new(-v.y, v.x, 0.0) / flat.sqrt() } else { Vec3::X };
    let rising = v.cross(level);
    // A point of the disk that the hemisphere of normals shows: half of it is foreshortened.
    let radius = a.sqrt();
    let angle = std::f32::consts::TAU * b;
    let x = radius * ops::cos(angle);
    let fraction = 0.5 * (1.0 + v.z);
    let y = (1.0 - fraction) * (1.0 - x * x).max(0.0).sqrt() + fraction * (radius * ops::sin(angle));
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let normal = level * x + rising * y + v * z;
    let back = Vec3::new(alpha * normal.x, alpha * normal.y, normal.z.max(0.0));
    back / back.dot(back).sqrt().max(BRDF_MIN_DIVISOR)
}

/// Density, per solid angle, of reflections drawn with [`brdf_visible_normal`], times pi.
#[must_use]
pub fn brdf_visible_density(alpha: f32, cosine_half: f32, cosine_view: f32) -> f32 {
    brdf_distribution(alpha, cosine_half) * brdf_masking(alpha, cosine_view) * 0.25
        / cosine_view.max(BRDF_MIN_DIVISOR)
}

/// Fraction of a uniform environment that microfacets reflect.
#[must_use]
pub fn brdf_environment(normal_reflectance: Vec3, roughness: f32, cosine_view: f32) -> Vec3 {
    let r =
        [-roughness + 1.0, roughness * -0.0275 + 0.0425, roughness * -0.572 + 1.04, roughness * 0.022 - 0.04];
    let lift = (r[0] * r[0]).min(ops::exp2(-9.28 * cosine_view)) * r[0] + r[1];
    let scale = -1.04 * lift + r[2];
    let bias = 1.04 * lift + r[3];
    // The fit goes below 0 where almost nothing is reflected.
    (normal_reflectance * scale + brdf_grazing(normal_reflectance) * bias).max(Vec3::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_math::ops::f64 as exact;

    /// The projected area of the microfacets is that of the surface: the integral of D cos over the hemisphere is 1.
    #[test]
    fn microfacets_cover_the_surface() {
        let rule = downpour_math::quadrature::GaussLegendre::new(64);
        for roughness in [0.2f32, 0.5, 1.0] {
            let alpha = roughness * roughness;
            // D pi = brdf_distribution, and the azimuth gives 2 pi.
            let sum = rule.integrate_panels(0.0, std::f64::consts::FRAC_PI_2, 64, |theta| {
                let cosine = exact::cos(theta);
                2.0 * f64::from(brdf_distribution(alpha, cosine as f32)) * cosine * exact::sin(theta)
            });
            assert!((sum - 1.0).abs() < 2.0e-3, "roughness {roughness}: {sum}");
        }
    }

    /// No more light leaves than arrives: a white metal under a uniform sky reflects at most 1.
    #[test]
    fn reflection_is_at_most_all() {
        for roughness in [0.1f32, 0.4, 0.7, 1.0] {
            for cosine in [0.05f32, 0.3, 0.7, 1.0] {
                let view = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
                let (n, mut sum) = (96, 0.0);
                for i in 0..n {
                    for j in 0..n {
                        // Uniform in cos^2: cosine-weighted directions.
                        let (u, v) = ((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32);
                        let (r, phi) = (u.sqrt(), std::f32::consts::TAU * v);
                        let light = Vec3::new(r * ops::cos(phi), r * ops::sin(phi), (1.0 - u).sqrt());
                        let radiance = brdf_direct(
                            Vec3::ZERO,
                            Vec3::ONE,
                            0.0,
                            (roughness * roughness).max(0.05),
                            Vec3::Z,
                            view,
                            light,
                        );
                        sum += radiance.x / light.z;
                    }
                }
                let reflected = sum / (n * n) as f32;
                assert!(reflected < 1.03, "roughness {roughness}, cosine {cosine}: {reflected}");
            }
        }
    }

    /// Degrees, and the reflectance of water of index 1.333 by Fresnel's law (Born & Wolf 1.5.2) and by Schlick's.
    const REFLECTANCES: [[f32; 3]; 6] = [
        [0.0, 0.020373, 0.02037],
        [40.0, 0.024502, 0.021057],
        [53.12, 0.039129, 0.030384],
        [65.0, 0.08712, 0.08323],
        [80.0, 0.347917, 0.397844],
        [89.0, 0.896276, 0.917448],
    ];

    #[test]
    fn a_film_reflects_as_water_does() {
        for [degrees, water, schlick] in REFLECTANCES {
            let cosine = ops::cos(degrees.to_radians());
            let of = |film| brdf_fresnel(Vec3::splat(PUDDLE_WATER_NORMAL), film, cosine).x;
            assert!((of(1.0) - water).abs() < 5.0e-6, "{degrees}: {} of {water}", of(1.0));
            assert!((of(0.0) - schlick).abs() < 5.0e-6, "{degrees}: {} of {schlick}", of(0.0));
            assert!((of(0.5) - 0.5 * (water + schlick)).abs() < 5.0e-6, "{degrees}");
        }
    }

    #[test]
    fn what_has_no_gloss_has_none_at_grazing_incidence() {
        for film in [0.0, 1.0] {
            for cosine in [0.0, 0.1, 1.0] {
                assert_eq!(brdf_fresnel(Vec3::ZERO, film, cosine), Vec3::ZERO);
            }
        }
        assert_eq!(brdf_environment(Vec3::ZERO, 0.2, 0.05), Vec3::ZERO);
        assert_eq!(brdf_fresnel(Vec3::splat(0.04), 0.0, 0.0), Vec3::ONE);
    }

    #[test]
    fn environment_fit_is_the_mirror_at_no_roughness() {
        let fraction = brdf_environment(Vec3::splat(0.04), 0.0, 1.0);
        assert!((fraction.x - 0.04).abs() < 0.01, "{fraction}");
        assert!(brdf_environment(Vec3::ONE, 0.5, 0.5).x <= 1.01);
    }
}
