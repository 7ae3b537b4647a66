//! `drop/optics.wgsl` against `downpour_drop::optics`.

use downpour_drop::optics::{
    optics_fresnel, optics_fresnel_polarized, optics_fresnel_schlick, optics_fresnel_tatarchuk,
    optics_reflect, optics_refract,
};
use downpour_math::ops;
use downpour_math::rng::rng_unit;
use downpour_math::vector::{dot, normalize, scale};
use downpour_shaders::drop::optics::OPTICS;

use crate::Domain::{Made, OneOf, Or, Uniform, Unit3};
use crate::words::IntoWords as _;
use crate::{FunctionCase, Tol};

fn unit3(a: u32, b: u32) -> [f32; 3] {
    let z = 2.0 * rng_unit(a) - 1.0;
    let phi = std::f32::consts::TAU * rng_unit(b);
    let r = (1.0 - z * z).max(0.0).sqrt();
    normalize([r * ops::cos(phi), r * ops::sin(phi), z])
}

/// A ray, a normal against it, and a ratio of indices for which the transmitted ray is not within a
/// thousandth of grazing, where its direction follows every rounding.
fn refraction(random: [u32; 4]) -> Vec<u32> {
    let incident = unit3(random[0], random[1]);
    let mut normal = unit3(random[2], random[3]);
    if dot(incident, normal) > 0.0 {
        normal = scale(normal, -1.0);
    }
    let cosine = dot(incident, normal);
    let mut eta = 0.7 + 0.7 * rng_unit(random[0] ^ random[3]);
    if (1.0 - eta * eta * (1.0 - cosine * cosine)).abs() < 1.0e-3 {
        eta = 0.75;
    }
    incident.into_iter().chain(normal).chain([eta]).map(f32::to_bits).collect()
}

/// A cosine and an index, not within a thousandth of total reflection.
fn interface(random: [u32; 4]) -> Vec<u32> {
    let index =
        if random[2] & 1 == 0 { 0.65 + 0.3 * rng_unit(random[0]) } else { 1.05 + 1.45 * rng_unit(random[0]) };
    let mut cosine = rng_unit(random[1]);
    if (index * index - (1.0 - cosine * cosine)).abs() < 1.0e-3 {
        cosine = 0.9;
    }
    vec![cosine.to_bits(), index.to_bits()]
}

const FRESNEL: Tol = Tol::absolute(2.0e-5, "a square root, away from its zero, and two divisions (2.5 ulp)");
const FORMULA: Tol = Tol::absolute(1.0e-6, "a polynomial of numbers up to 1 and a division (2.5 ulp)");

pub(super) fn functions() -> Vec<FunctionCase> {
    let case = |function, domains: &[_], tol, cpu| FunctionCase::new(function, &OPTICS, domains, tol, cpu);
    let (cosine, index) = (Uniform(0.0, 1.0), Uniform(1.0, 2.5));
    vec![
        case(
            "optics_refract",
            &[Made(refraction)],
            Tol::absolute(2.0e-5, "a square root of a number above 1e-3, and sums of unit vectors"),
            |a| optics_refract(a.f32s(), a.f32s(), a.f32()).words(),
        ),
        case(
            "optics_reflect",
            &[Unit3, Unit3],
            Tol::absolute(1.0e-6, "a dot product and a sum of unit vectors"),
            |a| optics_reflect(a.f32s(), a.f32s()).words(),
        ),
        case("optics_fresnel_polarized", &[Made(interface)], FRESNEL, |a| {
            optics_fresnel_polarized(a.f32(), a.f32()).words()
        }),
        // A ray along a boundary that is none: the square is 0, and nothing is reflected.
        case(
            "optics_fresnel_polarized",
            &[Or(&Uniform(0.0, 1.0), &[0.0]), OneOf(&[1.0, 1.5])],
            FRESNEL,
            |a| optics_fresnel_polarized(a.f32(), a.f32()).words(),
        ),
        case("optics_fresnel", &[Made(interface)], FRESNEL, |a| optics_fresnel(a.f32(), a.f32()).words()),
        case("optics_fresnel_schlick", &[cosine, index], FORMULA, |a| {
            optics_fresnel_schlick(a.f32(), a.f32()).words()
        }),
        case("optics_fresnel_tatarchuk", &[cosine], FORMULA, |a| optics_fresnel_tatarchuk(a.f32()).words()),
    ]
}
