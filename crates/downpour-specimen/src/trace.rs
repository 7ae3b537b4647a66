//! A camera ray through the drop, with all its reflections and refractions.
//!
//! Surface and normals are those of `downpour_mask::trace`; lengths are in units of the equivalent radius, the frame is
//! the world's. A ray starts at its foot, the point nearest to the drop's origin: with q the slopes of the ray across
//! the camera's axis and D the camera's distance, the foot is D / (1 + q^2) (q^2 back + q), which loses no digits
//! however far the camera is.
//!
//! At each interface, light splits into one part that leaves and one that stays inside. The fractions telescope: the light
//! that leaves is the difference of the light before and the light that stays, so that all fractions sum to 1 but for rounding. A
//! total reflection transmits nothing.
//!
//! Generic over [`Real`]; with `f32` the twin of `shaders/wgsl/render/specimen.wgsl`.

use downpour_drop::DropShape;
use downpour_drop::optics::{optics_fresnel, optics_reflect, optics_refract};
use downpour_mask::trace::{
    TracedDrop, mask_trace_curvature, mask_trace_meet, mask_trace_normal, mask_trace_spheroid,
    mask_trace_surface,
};
use downpour_math::real::Real;
use downpour_math::vector::{add, add_scaled, dot, normalize, scale, select, sub};
use downpour_shaders::mask::{MASK_SILHOUETTE_INSIDE, MASK_SILHOUETTE_OUTSIDE, MASK_TRACE_STEPS};
use downpour_shaders::render::specimen::{
    SPECIMEN_ALL, SPECIMEN_MIN_FRACTION, SPECIMEN_NEAREST_STEPS, SPECIMEN_REFLECTIONS,
};

use super::sky::{Sky, specimen_sky_light};

/// A drop with its axis along +Y, as the tracer needs it. `index` is the refractive index of water against air.
#[must_use]
pub fn upright_drop(shape: &DropShape, index: f64) -> TracedDrop {
    let radius = shape.equivalent_radius();
    let wide = shape.max_half_width() / radius;
    let tall = 0.5 * (shape.extent_up() + shape.extent_down()) / radius;
    TracedDrop {
        coefficients: shape.coefficients(),
        up: [0.0, 1.0, 0.0],
        index,
        inverse_wide: 1.0 / (wide * wide),
        inverse_tall: 1.0 / (tall * tall),
        steps: MASK_TRACE_STEPS,
    }
}

/// The camera as the tracer needs it.
#[derive(Clone, Copy, Debug)]
pub struct SpecimenCamera {
    /// Unit vector to the right.
    pub right: [f64; 3],
    /// Unit vector upwards in the picture.
    pub up: [f64; 3],
    /// Unit vector from the drop to the camera.
    pub back: [f64; 3],
    /// Slope of a ray (the tangent of its angle to the axis) per sample.
    pub step: f64,
    /// Distance from the drop's origin, in equivalent radii.
    pub distance: f64,
}

/// A ray of the camera.
#[derive(Clone, Copy, Debug)]
pub struct SpecimenRay<R> {
    /// The point nearest to the drop's origin.
    pub foot: [R; 3],
    /// Distance of the camera behind it.
    pub reach: R,
    /// Direction, of length 1.
    pub direction: [R; 3],
}

/// Light on its path: the light that left at the last interface, and the light that is still inside.
#[derive(Clone, Copy, Debug)]
pub struct SpecimenLight<R> {
    /// Point of the last interface.
    pub point: [R; 3],
    /// Fraction of the light that left there.
    pub fraction: R,
    /// Direction of the light that left.
    pub exit: [R; 3],
    /// Fraction of the light that is still inside.
    pub rest: R,
    /// Its direction, of length 1.
    pub inside: [R; 3],
}

/// Takes the light that leaves, in order.
pub trait Receiver<R> {
    /// Receives light of the fraction `fraction` (0 if no light leaves) that leaves along `direction`.
    fn receive(&mut self, direction: [R; 3], fraction: R);
}

/// The ray through the point (x, y) of the picture, in samples from its middle, y upwards.
#[inline(always)]
#[must_use]
pub fn specimen_ray<R: Real>(camera: &SpecimenCamera, x: R, y: R) -> SpecimenRay<R> {
    let one = x.constant(1.0);
    let of = |v: [f64; 3]| v.map(|c| one.constant(c));
    let (right, up, back) = (of(camera.right), of(camera.up), of(camera.back));
    let (step, distance) = (x.constant(camera.step), x.constant(camera.distance));
    let (qx, qy) = (x * step, y * step);
    let across = add(scale(right, qx), scale(up, qy));
    let square = qx * qx + qy * qy;
    let inverse = one / (one + square);
    let root = inverse.sqrt();
    let foot = scale(add(scale(back, square), across), distance * inverse);
    SpecimenRay { foot, reach: distance * root, direction: scale(sub(across, back), root) }
}

/// True if the ray meets the drop: the gauge at the nearest point is below 1, and that point is before the camera.
#[inline(always)]
#[must_use]
pub fn specimen_hits<R: Real>(drop: &TracedDrop, ray: &SpecimenRay<R>) -> R::Mask {
    let zero = ray.reach.constant(0.0);
    let one = ray.reach.constant(1.0);
    let curvature = mask_trace_curvature(drop, ray.direction);
    let slope = mask_trace_spheroid(drop, ray.foot, ray.direction);
    let first = -slope / curvature;
    let estimate = mask_trace_spheroid(drop, ray.foot, ray.foot) + slope * first;
    let inside = estimate.less(one.constant(f64::from(MASK_SILHOUETTE_INSIDE)));
    let near = estimate.less(one.constant(f64::from(MASK_SILHOUETTE_OUTSIDE)));
    let undecided = R::select(inside, zero, R::select(near, one, zero));
    let mut along = first;
    let mut excess = one;
    if one.any(zero.less(undecided)) {
        for _ in 0..SPECIMEN_NEAREST_STEPS {
            let surface = mask_trace_surface(drop, add_scaled(ray.foot, ray.direction, along));
            along = along - dot(surface.half_gradient, ray.direction) / curvature;
        }
        excess = mask_trace_surface(drop, add_scaled(ray.foot, ray.direction, along)).excess;
    }
    let decided = one.either(inside, one.both(near, excess.less(zero)));
    one.both(decided, (-ray.reach).less(R::select(inside, first, along)))
}

/// Light that meets a drop at a point with a normal: light reflected outside leaves, the remainder enters.
#[inline(always)]
#[must_use]
pub fn specimen_split_outside<R: Real>(
    point: [R; 3],
    normal: [R; 3],
    direction: [R; 3],
    index: R,
) -> SpecimenLight<R> {
    let one = index.constant(1.0);
    let reflectance = optics_fresnel(-dot(direction, normal), index);
    let (inside, _) = optics_refract(direction, normal, one / index);
    SpecimenLight {
        point,
        fraction: reflectance,
        exit: optics_reflect(direction, normal),
        rest: one - reflectance,
        inside: normalize(inside),
    }
}

/// Light that meets the surface from inside at a point with a normal. If less than `least` would stay inside, all leaves: in the
/// direction of the last exit, if nothing is transmitted here.
#[inline(always)]
#[must_use]
pub fn specimen_split_inside<R: Real>(
    light: &SpecimenLight<R>,
    point: [R; 3],
    normal: [R; 3],
    index: R,
    least: R,
) -> SpecimenLight<R> {
    let zero = least.constant(0.0);
    let one = least.constant(1.0);
    let reflectance = optics_fresnel(dot(light.inside, normal), one / index);
    let (through, _) = optics_refract(light.inside, scale(normal, -one), index);
    let passes = reflectance.less(one);
    let kept = light.rest * reflectance;
    let rest = R::select(kept.less(least), zero, kept);
    SpecimenLight {
        point,
        fraction: light.rest - rest,
        exit: select(passes, through, light.exit),
        rest,
        inside: optics_reflect(light.inside, normal),
    }
}

/// First interface.
#[inline(always)]
#[must_use]
pub fn specimen_enter<R: Real>(drop: &TracedDrop, ray: &SpecimenRay<R>) -> SpecimenLight<R> {
    let one = ray.reach.constant(1.0);
    let point = mask_trace_meet(drop, ray.foot, ray.direction, -one);
    specimen_split_outside(point, mask_trace_normal(drop, point), ray.direction, one.constant(drop.index))
}

/// Next interface from inside.
#[inline(always)]
#[must_use]
pub fn specimen_bounce<R: Real>(drop: &TracedDrop, light: &SpecimenLight<R>, least: R) -> SpecimenLight<R> {
    let point = mask_trace_meet(drop, light.point, light.inside, least.constant(1.0));
    specimen_split_inside(light, point, mask_trace_normal(drop, point), least.constant(drop.index), least)
}

/// Everything that leaves the drop, or passes it by, on the ray through the point (x, y) of the picture, in samples from
/// its middle, y upwards.
#[inline(always)]
pub fn specimen_light<R: Real>(
    drop: &TracedDrop,
    camera: &SpecimenCamera,
    [x, y]: [R; 2],
    receiver: &mut impl Receiver<R>,
) {
    let zero = x.constant(0.0);
    let one = x.constant(1.0);
    let ray = specimen_ray(camera, x, y);
    let hits = specimen_hits(drop, &ray);
    let inside = R::select(hits, one, zero);
    let outside = one - inside;
    if one.any(zero.less(outside)) {
        receiver.receive(ray.direction, outside);
    }
    if !one.any(zero.less(inside)) {
        return;
    }
    let mut light = specimen_enter(drop, &ray);
    light.rest = R::select(hits, light.rest, zero);
    receiver.receive(light.exit, R::select(hits, light.fraction, zero));
    for k in 0..=SPECIMEN_REFLECTIONS {
        if !one.any(zero.less(light.rest)) {
            break;
        }
        let least = if k == SPECIMEN_REFLECTIONS { SPECIMEN_ALL } else { SPECIMEN_MIN_FRACTION };
        light = specimen_bounce(drop, &light, one.constant(f64::from(least)));
        receiver.receive(light.exit, light.fraction);
    }
}

/// Sums the sky's radiance, one ray at a time.
struct Sum<'a> {
    sky: Sky<'a>,
    radiance: [f32; 3],
}

impl Receiver<f32> for Sum<'_> {
    #[inline(always)]
    fn receive(&mut self, direction: [f32; 3], fraction: f32) {
        if fraction > 0.0 {
            self.radiance = add_scaled(self.radiance, specimen_sky_light(self.sky, direction), fraction);
        }
    }
}

/// The radiance of the sample (x, y), in samples from the middle of the picture, y upwards.
#[must_use]
pub fn specimen_radiance(
    drop: &TracedDrop,
    camera: &SpecimenCamera,
    sky: Sky<'_>,
    x: f32,
    y: f32,
) -> [f32; 3] {
    let mut sum = Sum { sky, radiance: [0.0; 3] };
    specimen_light(drop, camera, [x, y], &mut sum);
    sum.radiance
}
