//! A ray through an oscillating drop, for images of many drops: its first three exits.
//!
//! The surface is r = rho(x) f(x, h) scale with f = 1 + s2 P20(x) + 3/2 s3 (1 - 5 x^2) h: the shape at rest times the factor of
//! `downpour_drop::oscillation`. p is a point, x = -p.y / |p| and h = p.x / |p|; lengths are in units of the
//! volume-equivalent radius, the drop's origin is at 0, its axis is +Y, the lobe of the mode (3,1) is toward +X. The gauge
//! squared is G = |p|^2 / r^2; with `q = rho' / rho + f_x / f` and `k = f_h / f`,
//!
//! > 1/2 grad G = (p (1 + q x + k h) + |p| (q up - k right)) / r^2,
//!
//! whose direction is the outward normal. The surface is found by the steps of [`mask_trace_step`] from the spheroid that the mode
//! (2,0) makes of the drop, as in [`trace`](crate::trace).
//!
//! Light is split at each interface into transmitted and reflected light, unpolarized each time, as in an RGB path tracer. What is
//! left after the third exit leaves elsewhere: of a ray at the rim more than half of what has come so far. It is in no fraction.
//!
//! Limits: a ray meets a drop once on entry and once on exit (with amplitudes of 0.2 and 0.1 it hardly has a
//! hollow); geometrical optics; light that has not left after `MASK_WOBBLE_BOUNCES` interfaces is not followed.
//!
//! Generic over [`Real`]; with `f32` the twin of `shaders/wgsl/mask/wobble.wgsl`.

use downpour_drop::optics::{optics_fresnel, optics_reflect, optics_refract};
use downpour_drop::oscillation::drop_oscillation_legendre_20;
use downpour_drop::shape::{COEFFICIENTS, drop_shape_radius_slope};
use downpour_math::real::Real;
use downpour_math::vector::{add_scaled, dot, normalize, scale, select};
use downpour_shaders::mask::{
    MASK_TINY, MASK_WOBBLE_BOUNCES, MASK_WOBBLE_EXITS, MASK_WOBBLE_NEAREST_STEPS, MASK_WOBBLE_STEPS,
};

use crate::trace::{Surface, mask_trace_step};

/// A drop at one instant.
#[derive(Clone, Copy, Debug)]
pub struct WobbleDrop<R> {
    /// Shape coefficients, from `c_0` to `c_10`.
    pub coefficients: [f64; COEFFICIENTS],
    /// s2, s3, and the factor that conserves the volume.
    pub state: [R; 3],
    /// Refractive index of water relative to air.
    pub index: f64,
    /// 1 / A^2, with A the half width across the axis of the spheroid where the search begins.
    pub inverse_wide: R,
    /// 1 / B^2, with B its half height along the axis.
    pub inverse_tall: R,
}

/// Exits of the light of one ray: reflected outside, and the first three exits from inside.
#[derive(Clone, Copy, Debug)]
pub struct WobbleLight<R> {
    /// Directions, of length 1; 0 for a missing exit.
    pub exits: [[R; 3]; 4],
    /// Fractions of the light; what they leave of 1 is not followed.
    pub fractions: [R; 4],
    /// Number of interfaces up to the exit (from 1), by which the paths of neighboring rays are compared; 0 for a missing exit.
    pub interfaces: [R; 4],
}

/// G - 1 and half of grad G at a point of a drop with these coefficients and this state.
#[inline(always)]
#[must_use]
pub fn mask_wobble_surface<R: Real>(
    coefficients: &[f64; COEFFICIENTS],
    state: [R; 3],
    point: [R; 3],
) -> Surface<R> {
    let one = point[0].constant(1.0);
    let c = |value: f64| one.constant(value);
    let square = dot(point, point).at_least(c(f64::from(MASK_TINY)));
    let length = square.sqrt();
    let inverse_length = one / length;
    let x = -(point[1] * inverse_length);
    let h = point[0] * inverse_length;
    let [s2, s3, size] = state;
    let [rho, slope] = drop_shape_radius_slope(coefficients, x);
    let lobe = c(1.5) * s3 * (one - c(5.0) * x * x);
    let factor = one + s2 * drop_oscillation_legendre_20(x) + lobe * h;
    let by_x = c(3.0) * s2 * x - c(15.0) * s3 * x * h;
    let inverse_factor = one / factor;
    let q = slope / rho + by_x * inverse_factor;
    let k = lobe * inverse_factor;
    let inverse = one / (rho * factor * size);
    let scale_all = inverse * inverse;
    let along = one + q * x + k * h;
    let [px, py, pz] = scale(point, along);
    let gradient = [px - length * k, py + length * q, pz];
    Surface { excess: square * scale_all - one, half_gradient: scale(gradient, scale_all) }
}

/// a . M . b for the matrix M of the spheroid.
#[inline(always)]
#[must_use]
pub fn mask_wobble_spheroid<R: Real>(drop: &WobbleDrop<R>, a: [R; 3], b: [R; 3]) -> R {
    (a[0] * b[0] + a[2] * b[2]) * drop.inverse_wide + a[1] * b[1] * drop.inverse_tall
}

/// Point where the line from `origin` along `direction` meets the surface before (`side` = -1) or behind (`side` = 1) its
/// nearest approach; the nearest approach if it misses.
#[inline(always)]
#[must_use]
pub fn mask_wobble_meet<R: Real>(drop: &WobbleDrop<R>, origin: [R; 3], direction: [R; 3], side: R) -> [R; 3] {
    let curvature = mask_wobble_spheroid(drop, direction, direction);
    let excess = mask_wobble_spheroid(drop, origin, origin) - side.constant(1.0);
    let slope = mask_wobble_spheroid(drop, origin, direction);
    let mut point = add_scaled(origin, direction, mask_trace_step(excess, slope, curvature, side));
    for _ in 0..MASK_WOBBLE_STEPS {
        let surface = mask_wobble_surface(&drop.coefficients, drop.state, point);
        let slope = dot(surface.half_gradient, direction);
        point = add_scaled(point, direction, mask_trace_step(surface.excess, slope, curvature, side));
    }
    point
}

/// Position of the nearest approach along a line, from an initial guess.
#[inline(always)]
#[must_use]
pub fn mask_wobble_nearest<R: Real>(drop: &WobbleDrop<R>, origin: [R; 3], direction: [R; 3], guess: R) -> R {
    let curvature = mask_wobble_spheroid(drop, direction, direction);
    let mut along = guess;
    for _ in 0..MASK_WOBBLE_NEAREST_STEPS {
        let surface =
            mask_wobble_surface(&drop.coefficients, drop.state, add_scaled(origin, direction, along));
        along = along - dot(surface.half_gradient, direction) / curvature;
    }
    along
}

/// Exits of the light of a ray. The ray should meet the drop; one that misses is treated as grazing.
#[inline(always)]
#[must_use]
pub fn mask_wobble_light<R: Real>(drop: &WobbleDrop<R>, origin: [R; 3], direction: [R; 3]) -> WobbleLight<R> {
    let zero = origin[0].constant(0.0);
    let one = origin[0].constant(1.0);
    let index = one.constant(drop.index);
    let normal_at =
        |point| normalize(mask_wobble_surface(&drop.coefficients, drop.state, point).half_gradient);
    let mut point = mask_wobble_meet(drop, origin, direction, -one);
    let normal = normal_at(point);
    let reflectance = optics_fresnel(-dot(direction, normal), index);
    let mut light = WobbleLight {
        exits: [optics_reflect(direction, normal), [zero; 3], [zero; 3], [zero; 3]],
        fractions: [reflectance, zero, zero, zero],
        interfaces: [one, zero, zero, zero],
    };
    let (entering, _) = optics_refract(direction, normal, one / index);
    let mut inside = normalize(entering);
    let mut rest = one - reflectance;
    let mut found = zero;
    for bounce in 0..MASK_WOBBLE_BOUNCES {
        let goes_on = found.less(one.constant(f64::from(MASK_WOBBLE_EXITS)));
        if !one.any(goes_on) {
            break;
        }
        point = mask_wobble_meet(drop, point, inside, one);
        let normal = normal_at(point);
        let kept = optics_fresnel(dot(inside, normal), one / index);
        let (outside, _) = optics_refract(inside, scale(normal, -one), index);
        let outside = normalize(outside);
        let leaves = one.both(goes_on, kept.less(one));
        let next = R::select(leaves, found + one, found);
        for exit in 1..=MASK_WOBBLE_EXITS as usize {
            // Equal numbers: neither is less than the other.
            let number = one.constant(exit as f64);
            let is_this = one.both(leaves, number.less(next + one.constant(0.5)));
            let is_this = one.both(is_this, next.less(number + one.constant(0.5)));
            light.exits[exit] = select(is_this, outside, light.exits[exit]);
            light.fractions[exit] = R::select(is_this, rest * (one - kept), light.fractions[exit]);
            let passed = one.constant(f64::from(bounce + 2));
            light.interfaces[exit] = R::select(is_this, passed, light.interfaces[exit]);
        }
        rest = R::select(goes_on, rest * kept, rest);
        inside = optics_reflect(inside, normal);
        found = next;
    }
    light
}
