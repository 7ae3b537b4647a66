//! Integrals and primitives shared by the tests.
#![allow(dead_code, reason = "each test takes what it needs")]

use std::f64::consts::{PI, TAU};

use downpour_math::ops::f64::{cos, sin};
use downpour_wind::primitive::velocity;
use downpour_wind::{WindCore, WindForm, WindMatrix, WindPrimitive, WindSingularity, WindTornado};
use glam::{DVec3, Vec3};

pub(crate) const STRENGTH: f32 = 40.0;
pub(crate) const CORE: f32 = 0.5;
pub(crate) const CENTER: Vec3 = Vec3::new(1.0, -2.0, 3.0);

/// A singularity with an oblique axis, so that all components are tested.
pub(crate) fn singularity(form: WindForm) -> WindSingularity {
    WindSingularity {
        form,
        strength: STRENGTH,
        center: CENTER,
        axis: Vec3::new(1.0, 2.0, -0.5),
        core_radius: CORE,
        core: WindCore::Rosenhead,
    }
}

pub(crate) fn tornado() -> WindTornado {
    WindTornado {
        circulation: 60.0,
        discharge: 500.0,
        base: CENTER,
        axis: Vec3::new(0.2, 2.0, -0.3),
        height: 12.0,
        core_radius: 1.5,
    }
}

/// Wind of primitives without a grid.
pub(crate) fn wind(primitives: &[WindPrimitive]) -> impl Fn(DVec3) -> DVec3 + use<> {
    let matrices = WindMatrix::encode(primitives).expect("primitives in range");
    move |at: DVec3| velocity(&matrices, at.as_vec3()).as_dvec3()
}

/// Three perpendicular unit vectors, the third along `axis`, right-handed.
pub(crate) fn frame(axis: Vec3) -> [DVec3; 3] {
    let axis = axis.as_dvec3().normalize();
    let side = axis.any_orthonormal_vector();
    [side, axis.cross(side), axis]
}

/// Flow out of a sphere, m^3/s.
pub(crate) fn flux_sphere(field: &impl Fn(DVec3) -> DVec3, center: DVec3, radius: f64) -> f64 {
    let (rows, columns) = (160, 160);
    let area = 4.0 * PI * radius * radius / f64::from(rows * columns);
    let mut sum = 0.0;
    for i in 0..rows {
        let z = (f64::from(i) + 0.5) / f64::from(rows) * 2.0 - 1.0;
        let r = (1.0 - z * z).sqrt();
        for k in 0..columns {
            let phi = TAU * (f64::from(k) + 0.5) / f64::from(columns);
            let normal = DVec3::new(r * cos(phi), r * sin(phi), z);
            sum += field(center + normal * radius).dot(normal);
        }
    }
    sum * area
}

/// Flow out of a cylinder without its ends, per length, m^2/s.
pub(crate) fn flux_cylinder(field: &impl Fn(DVec3) -> DVec3, center: DVec3, axis: Vec3, radius: f64) -> f64 {
    ring(center, axis, radius).map(|(at, outward, _)| field(at).dot(outward)).sum::<f64>()
        * (TAU * radius / RING)
}

/// Circulation along a ring, m^2/s.
pub(crate) fn circulation(field: &impl Fn(DVec3) -> DVec3, center: DVec3, axis: Vec3, radius: f64) -> f64 {
    ring(center, axis, radius).map(|(at, _, around)| field(at).dot(around)).sum::<f64>()
        * (TAU * radius / RING)
}

const RING: f64 = 512.0;

/// Position, outward and forward direction of points on a ring.
fn ring(center: DVec3, axis: Vec3, radius: f64) -> impl Iterator<Item = (DVec3, DVec3, DVec3)> {
    let [u, v, _] = frame(axis);
    (0..RING as u32).map(move |k| {
        let phi = TAU * f64::from(k) / RING;
        let outward = u * cos(phi) + v * sin(phi);
        let around = v * cos(phi) - u * sin(phi);
        (center + outward * radius, outward, around)
    })
}

/// Asserts that `found` is `wanted` to the fraction `tolerance` of `scale`.
pub(crate) fn close(found: f64, wanted: f64, scale: f64, tolerance: f64, what: &str) {
    assert!((found - wanted).abs() <= tolerance * scale.abs(), "{what}: {found}, not {wanted}");
}
