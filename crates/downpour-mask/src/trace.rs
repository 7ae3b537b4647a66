//! A ray through a drop of revolution: two interfaces, exactly.
//!
//! All lengths are in units of the drop's volume-equivalent radius a. The frame is that of the view: x right, y
//! up, z toward the viewer, the drop's origin at 0; a ray of the viewer runs along -z. `up` is the drop's axis
//! in that frame, so the angle of a point p from the downward axis has the cosine x = -p.up / |p|, and the surface
//! is |p| = rho(x) (`downpour_drop::shape`).
//!
//! The gauge of a point is g(p) = |p| / rho(x): below 1 inside, 1 on the surface. Along a line, G = g^2 is close to
//! a parabola (for an ellipsoid it is one), so the surface is found by Newton steps on the parabola with the value
//! and slope of G and the curvature of the reference spheroid. Unlike a step on the tangent, that converges at
//! grazing incidence too. With
//!
//! > q = rho' / rho (derivative by x),   grad G = 2 / rho^2 (p (1 + q x) + |p| q up)
//!
//! the outward normal is the direction of grad G; nothing is singular at the poles.
//!
//! Light is traced backwards, from the viewer; transmittance is the same in both directions. Twin of
//! `shaders/wgsl/mask/trace.wgsl`.
//!
//! Light reflected inside without being totally reflected is followed to its next exit: seen from above, a drop before
//! dark ground has a fourth of its light from this path. Light reflected a second time is not followed (it is the
//! remainder 1 - transmittance - reflectance - internal transmittance: 0.7 % of all light through a sphere).
//!
//! Limits: orthographic rays (a drop is much smaller than its distance); geometrical optics.

use downpour_drop::optics::{optics_fresnel_polarized, optics_reflect, optics_refract};
use downpour_drop::shape::drop_shape_radius_slope;
use downpour_math::real::Real;
use downpour_math::vector::{add_scaled, cross, dot, normalize, scale, select};
use downpour_shaders::mask::{MASK_TINY, MASK_TRACE_REFLECTIONS};

/// A drop of revolution as the tracer needs it.
#[derive(Clone, Copy, Debug)]
pub struct TracedDrop {
    /// Shape coefficients, from `c_0` to `c_10`.
    pub coefficients: [f64; 11],
    /// The drop's axis in the frame of the view, of length 1.
    pub up: [f64; 3],
    /// Refractive index of water relative to air.
    pub index: f64,
    /// 1 / A^2, with A the spheroid's half width across the axis.
    pub inverse_wide: f64,
    /// 1 / B^2, with B its half height along the axis.
    pub inverse_tall: f64,
    /// Newton steps to a point of the surface: `MASK_TRACE_STEPS` is enough for f32.
    pub steps: u32,
}

/// A point of the surface: gauge and gradient.
#[derive(Clone, Copy, Debug)]
pub struct Surface<R> {
    /// G - 1: the gauge squared, less 1.
    pub excess: R,
    /// Half of grad G.
    pub half_gradient: [R; 3],
}

/// Exit of light from the inside of a drop.
#[derive(Clone, Copy, Debug)]
pub struct Exit<R> {
    /// Point of the surface.
    pub point: [R; 3],
    /// Outward normal there.
    pub normal: [R; 3],
    /// Direction of the light inside, of length 1.
    pub inside: [R; 3],
    /// Direction of the light outside; the direction inside if no light leaves.
    pub outside: [R; 3],
    /// Number of total reflections before the exit; `MASK_TRACE_REFLECTIONS` + 1 if the light does not leave.
    pub reflections: R,
    /// 1 if the light does not leave, else 0.
    pub lost: R,
}

/// Paths of a ray after the drop.
#[derive(Clone, Copy, Debug)]
pub struct TransmittedRay<R> {
    /// Direction of the light that is seen through the drop (from the drop to the scene), of length 1.
    pub direction: [R; 3],
    /// Fraction of unpolarized light transmitted by both interfaces; 0 if the light is lost inside.
    pub transmittance: R,
    /// Direction of the light that is seen by reflection on the outside, of length 1.
    pub reflected: [R; 3],
    /// Fraction of unpolarized light reflected on the outside.
    pub reflectance: R,
    /// Direction of the light that is seen after one reflection inside that was not total, of length 1.
    pub internal: [R; 3],
    /// Fraction of unpolarized light on that path; 0 if the light is lost inside.
    pub internal_transmittance: R,
    /// Number of total reflections before `direction` (0 for a sphere, always); `MASK_TRACE_REFLECTIONS` + 1 if the light
    /// does not leave.
    pub reflections: R,
}

/// The gauge squared and its gradient at `point`.
#[inline(always)]
#[must_use]
pub fn mask_trace_surface<R: Real>(drop: &TracedDrop, point: [R; 3]) -> Surface<R> {
    let one = point[0].constant(1.0);
    let up = drop.up.map(|c| one.constant(c));
    let square = dot(point, point).at_least(one.constant(f64::from(MASK_TINY)));
    let length = square.sqrt();
    let x = -dot(point, up) / length;
    let [radius, slope] = drop_shape_radius_slope(&drop.coefficients, x);
    let inverse = one / radius;
    let q = slope * inverse;
    let scale_all = inverse * inverse;
    let along = one + q * x;
    let lift = length * q;
    Surface {
        excess: square * scale_all - one,
        half_gradient: scale(add_scaled(scale(point, along), up, lift), scale_all),
    }
}

/// d . M . d for the matrix M of the reference spheroid: half the second derivative of its gauge squared along
/// `direction`.
#[inline(always)]
#[must_use]
pub fn mask_trace_curvature<R: Real>(drop: &TracedDrop, direction: [R; 3]) -> R {
    mask_trace_spheroid(drop, direction, direction)
}

/// a . M . b for the matrix M of the reference spheroid.
#[inline(always)]
#[must_use]
pub fn mask_trace_spheroid<R: Real>(drop: &TracedDrop, a: [R; 3], b: [R; 3]) -> R {
    let up = drop.up.map(|c| a[0].constant(c));
    let wide = a[0].constant(drop.inverse_wide);
    let tall = a[0].constant(drop.inverse_tall);
    let along = dot(a, up) * dot(b, up);
    (dot(a, b) - along) * wide + along * tall
}

/// Step along a line on which G - 1 = `excess`, dG/dt = 2 `slope`, d2G/dt2 = 2 `curvature`, to the root
/// before (`side` = -1) or behind (`side` = 1) the minimum; to the minimum if there is no root.
#[inline(always)]
#[must_use]
pub fn mask_trace_step<R: Real>(excess: R, slope: R, curvature: R, side: R) -> R {
    let zero = excess.constant(0.0);
    let discriminant = slope * slope - curvature * excess;
    let toward = side * slope;
    let root = discriminant.at_least(zero).sqrt();
    // The form that does not cancel depends on the sign of the slope.
    let cancels = toward.less(zero);
    let sum = R::select(cancels, root - toward, root + toward);
    let safe = sum.at_least(excess.constant(f64::from(MASK_TINY)));
    let to_root = R::select(cancels, side * sum / curvature, -side * excess / safe);
    R::select(discriminant.less(zero), -slope / curvature, to_root)
}

/// Point where the line from `origin` along `direction` meets the surface before (`side` = -1) or behind
/// (`side` = 1) its nearest approach; the nearest approach if it misses.
#[inline(always)]
#[must_use]
pub fn mask_trace_meet<R: Real>(drop: &TracedDrop, origin: [R; 3], direction: [R; 3], side: R) -> [R; 3] {
    let curvature = mask_trace_curvature(drop, direction);
    let excess = mask_trace_spheroid(drop, origin, origin) - side.constant(1.0);
    let slope = mask_trace_spheroid(drop, origin, direction);
    let mut point = add_scaled(origin, direction, mask_trace_step(excess, slope, curvature, side));
    for _ in 0..drop.steps {
        let surface = mask_trace_surface(drop, point);
        let slope = dot(surface.half_gradient, direction);
        point = add_scaled(point, direction, mask_trace_step(surface.excess, slope, curvature, side));
    }
    point
}

/// The outward normal at `point`.
#[inline(always)]
#[must_use]
pub fn mask_trace_normal<R: Real>(drop: &TracedDrop, point: [R; 3]) -> [R; 3] {
    normalize(mask_trace_surface(drop, point).half_gradient)
}

/// cos 2 psi, with psi the angle between the planes of incidence of two interfaces: `from` and `to` are the
/// normals of the two, `direction` the ray between them. 1 if a plane is not defined.
#[inline(always)]
#[must_use]
pub fn mask_trace_plane_turn<R: Real>(direction: [R; 3], from: [R; 3], to: [R; 3]) -> R {
    let one = direction[0].constant(1.0);
    let (a, b) = (cross(direction, from), cross(direction, to));
    let both = dot(a, a) * dot(b, b);
    let tiny = one.constant(f64::from(MASK_TINY));
    let along = dot(a, b);
    let turn = one.constant(2.0) * along * along / both.at_least(tiny) - one;
    R::select(both.less(tiny), one, turn)
}

/// Exit of light that starts at a point of the surface, along `inside`, after total reflections.
#[inline(always)]
#[must_use]
pub fn mask_trace_exit<R: Real>(drop: &TracedDrop, start: [R; 3], inside: [R; 3]) -> Exit<R> {
    let zero = start[0].constant(0.0);
    let one = start[0].constant(1.0);
    let index = start[0].constant(drop.index);
    let mut inside = inside;
    let mut point = mask_trace_meet(drop, start, inside, one);
    let mut normal = mask_trace_normal(drop, point);
    let (mut outside, mut cos2) = optics_refract(inside, scale(normal, -one), index);
    let mut reflections = zero;
    let mut total = cos2.less(zero);
    for _ in 0..MASK_TRACE_REFLECTIONS {
        if !zero.any(total) {
            break;
        }
        let next_inside = optics_reflect(inside, normal);
        let next_point = mask_trace_meet(drop, point, next_inside, one);
        let next_normal = mask_trace_normal(drop, next_point);
        let (next_outside, next_cos2) = optics_refract(next_inside, scale(next_normal, -one), index);
        inside = select(total, next_inside, inside);
        point = select(total, next_point, point);
        normal = select(total, next_normal, normal);
        outside = select(total, next_outside, outside);
        cos2 = R::select(total, next_cos2, cos2);
        reflections = R::select(total, reflections + one, reflections);
        total = cos2.less(zero);
    }
    Exit {
        point,
        normal,
        inside,
        outside: select(total, inside, outside),
        reflections: R::select(total, reflections + one, reflections),
        lost: R::select(total, one, zero),
    }
}

/// Reflected fractions of the power at an exit, across and within the plane of incidence.
#[inline(always)]
#[must_use]
pub fn mask_trace_reflectance<R: Real>(exit: &Exit<R>, index: R) -> [R; 2] {
    let zero = index.constant(0.0);
    optics_fresnel_polarized(dot(exit.inside, exit.normal).at_least(zero), index.constant(1.0) / index)
}

/// The viewer's ray through the point (x, y) of the image plane, through the drop.
///
/// The ray should pass through the drop; one that misses is treated as grazing.
#[inline(always)]
#[must_use]
pub fn mask_trace_through<R: Real>(drop: &TracedDrop, x: R, y: R) -> TransmittedRay<R> {
    let zero = x.constant(0.0);
    let one = x.constant(1.0);
    let half = x.constant(0.5);
    let index = x.constant(drop.index);
    let incident = [zero, zero, -one];
    let entry = mask_trace_meet(drop, [x, y, zero], incident, -one);
    let entry_normal = mask_trace_normal(drop, entry);
    let [entry_s, entry_p] = optics_fresnel_polarized(entry_normal[2].at_least(zero), index);
    let reflectance = (entry_s + entry_p) * half;
    let reflected = optics_reflect(incident, entry_normal);
    let (mut inside, _) = optics_refract(incident, entry_normal, one / index);
    inside = normalize(inside);

    // Polarization is followed from interface to interface: `polarized` is half the difference between the power polarized
    // across and that within the plane of incidence. A total reflection changes it by a phase-dependent amount; from there on
    // light counts as unpolarized.
    let exit = mask_trace_exit(drop, entry, inside);
    let turn = mask_trace_plane_turn(inside, entry_normal, exit.normal);
    let polarized = R::select(zero.less(exit.reflections), zero, (entry_p - entry_s) * half * turn);
    let [exit_s, exit_p] = mask_trace_reflectance(&exit, index);
    let entered = one - reflectance;
    let exit_mean = one - (exit_s + exit_p) * half;
    let through = entered * exit_mean + polarized * (exit_p - exit_s) * half;

    let back = optics_reflect(exit.inside, exit.normal);
    let second = mask_trace_exit(drop, exit.point, back);
    let kept = entered - through;
    let kept_polarized = (entered * (exit_s - exit_p) + polarized * (exit_s + exit_p)) * half;
    let second_turn = mask_trace_plane_turn(back, exit.normal, second.normal);
    let second_polarized = R::select(zero.less(second.reflections), zero, kept_polarized * second_turn);
    let [second_s, second_p] = mask_trace_reflectance(&second, index);
    let second_mean = one - (second_s + second_p) * half;
    let internal = kept * second_mean + second_polarized * (second_p - second_s) * half;
    let lost = zero.less(exit.lost);
    TransmittedRay {
        direction: normalize(exit.outside),
        transmittance: R::select(lost, zero, through),
        reflected: normalize(reflected),
        reflectance,
        internal: normalize(second.outside),
        internal_transmittance: R::select(one.either(lost, zero.less(second.lost)), zero, internal),
        reflections: exit.reflections,
    }
}
