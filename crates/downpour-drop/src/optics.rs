//! Optics of a drop: refractive index of water, refraction and reflection at its surface.
//!
//! Laws: reflection and Snell's law in vectors; Fresnel's equations for a dielectric (Born & Wolf, Principles of
//! Optics, 1.5.2), exact, for both polarizations; by name, the approximations of Schlick 1994 and of Tatarchuk &
//! Isidoro 2006. Unit vectors; the normal faces against the incident ray; eta = n(from) / n(to);
//! index = n(to) / n(from); cosines in [0, 1]. Absorption within a drop is negligible: the
//! absorption index of water is below 3.4e-8 in visible light, which removes 0.4 % of red light along 6 mm.
//!
//! - [`water_index`], [`air_index`], [`water_index_in_air`], [`rgb_indices`]: refractive indices;
//! - [`critical_angle`], [`brewster_angle`], [`maximal_deviation`], [`field_of_view`], [`deviation`], [`rainbow`],
//!   [`diffuse_reflectance`]: results for a sphere;
//! - [`SphereScattering`], [`scattered_ray`], [`scattered_fraction`]: light scattered by a sphere, order by order;
//! - functions whose names begin with `optics_` are the twins of `shaders/wgsl/drop/optics.wgsl`. They are generic:
//!   with `f32` they have the bits of the twin, with `f64` they are the reference, with lanes the fast path.

mod angles;
mod index;
mod scattering;

use downpour_math::real::Real;
use downpour_shaders::drop::optics as shared;

pub use angles::{
    Rainbow, brewster_angle, critical_angle, deviation, diffuse_reflectance, field_of_view,
    maximal_deviation, rainbow,
};
pub use index::{
    RGB_WAVELENGTHS_M, WATER_INDEX, air_index, rgb_indices, water_index, water_index_iapws_1997,
    water_index_in_air,
};
pub use scattering::{
    SCATTERING_ORDERS, SCATTERING_PATHS, SUN_DIAMETER, ScatteredRay, ScatteringPath, SphereScattering,
    scattered_fraction, scattered_ray,
};

/// Direction of the refracted ray, and the square of the cosine of its angle to the normal.
///
/// `incident` and `normal` are unit vectors, the normal faces against the ray; `eta` = n(from) / n(to). A negative
/// square is total reflection: the direction is then meaningless.
///
/// ```
/// use downpour_drop::optics::optics_refract;
/// // Straight down into water: the ray continues straight.
/// let (down, squared) = optics_refract([0.0f32, -1.0, 0.0], [0.0, 1.0, 0.0], 1.0 / 1.333);
/// assert_eq!(down, [0.0, -1.0, 0.0]);
/// assert_eq!(squared, 1.0);
/// ```
#[inline(always)]
#[must_use]
pub fn optics_refract<R: Real>(incident: [R; 3], normal: [R; 3], eta: R) -> ([R; 3], R) {
    let one = eta.constant(1.0);
    let cosine = -(incident[0] * normal[0] + incident[1] * normal[1] + incident[2] * normal[2]);
    let squared = one - eta * eta * (one - cosine * cosine);
    let along = eta * cosine - squared.at_least(eta.constant(0.0)).sqrt();
    let direction = [
        eta * incident[0] + along * normal[0],
        eta * incident[1] + along * normal[1],
        eta * incident[2] + along * normal[2],
    ];
    (direction, squared)
}

/// Direction of the reflected ray. `incident` and `normal` are unit vectors.
///
/// ```
/// use downpour_drop::optics::optics_reflect;
/// assert_eq!(optics_reflect([0.6f64, -0.8, 0.0], [0.0, 1.0, 0.0]), [0.6, 0.8, 0.0]);
/// ```
#[inline(always)]
#[must_use]
pub fn optics_reflect<R: Real>(incident: [R; 3], normal: [R; 3]) -> [R; 3] {
    let cosine = -(incident[0] * normal[0] + incident[1] * normal[1] + incident[2] * normal[2]);
    let along = cosine + cosine;
    [incident[0] + along * normal[0], incident[1] + along * normal[1], incident[2] + along * normal[2]]
}

/// Fraction of the power that is reflected: across (s) and within (p) the plane of incidence. 1 in total reflection.
///
/// `cosine` is that of the angle of incidence (negative counts as 0), `index` = n(to) / n(from).
///
/// ```
/// use downpour_drop::optics::optics_fresnel_polarized;
/// // At Brewster's angle no light is reflected within the plane.
/// let brewster = downpour_math::ops::f64::cos(downpour_math::ops::f64::atan(1.333));
/// let [s, p] = optics_fresnel_polarized(brewster, 1.333);
/// assert!((s - 0.0783).abs() < 1e-4 && p < 1e-20);
/// ```
#[inline(always)]
#[must_use]
pub fn optics_fresnel_polarized<R: Real>(cosine: R, index: R) -> [R; 2] {
    let zero = index.constant(0.0);
    let one = index.constant(1.0);
    let smallest = index.constant(f64::from(shared::OPTICS_MIN));
    let c = cosine.at_least(zero);
    // index^2 - sin^2, without the loss of digits of 1 - cos^2.
    let squared = (index - one) * (index + one) + c * c;
    let g = squared.at_least(zero).sqrt();
    let s = (c - g) / (c + g).at_least(smallest);
    let nc = index * index * c;
    let p = (nc - g) / (nc + g).at_least(smallest);
    let total = squared.less(zero);
    [R::select(total, one, s * s), R::select(total, one, p * p)]
}

/// Fraction of unpolarized light that is reflected. Arguments as for [`optics_fresnel_polarized`].
///
/// ```
/// let r = downpour_drop::optics::optics_fresnel(1.0f64, 1.333);
/// assert!((r - 0.02037).abs() < 1e-5);
/// ```
#[inline(always)]
#[must_use]
pub fn optics_fresnel<R: Real>(cosine: R, index: R) -> R {
    let [s, p] = optics_fresnel_polarized(cosine, index);
    index.constant(0.5) * (s + p)
}

/// Approximation of C. Schlick, Computer Graphics Forum 13, 233 (1994), from the side of the smaller index: it
/// has no total reflection. For water it is 23 % low at 50 degrees and 14 % high at 80.
///
/// ```
/// let r = downpour_drop::optics::optics_fresnel_schlick(0.5f64, 1.333);
/// assert!((r - 0.05098).abs() < 1e-5);
/// ```
#[inline(always)]
#[must_use]
pub fn optics_fresnel_schlick<R: Real>(cosine: R, index: R) -> R {
    let one = index.constant(1.0);
    let root = (index - one) / (index + one);
    let base = root * root;
    let x = one - cosine;
    let x2 = x * x;
    base + (one - base) * (x2 * x2 * x)
}

/// Form of N. Tatarchuk, J. Isidoro, "Artist-Directable Real-Time Rain Rendering in City Environments" (2006),
/// 3.1: 0.95 (1 - cos)^4 + 0.05. 2.5 times the reflectance of water at normal incidence: an artistic choice.
///
/// ```
/// assert_eq!(downpour_drop::optics::optics_fresnel_tatarchuk(1.0f32), 0.05);
/// ```
#[inline(always)]
#[must_use]
pub fn optics_fresnel_tatarchuk<R: Real>(cosine: R) -> R {
    let x = cosine.constant(1.0) - cosine;
    let x2 = x * x;
    let rise = cosine.constant(f64::from(shared::OPTICS_TATARCHUK_RISE));
    rise * (x2 * x2) + cosine.constant(f64::from(shared::OPTICS_TATARCHUK_BASE))
}
