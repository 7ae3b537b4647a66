//! A ray through a drop that oscillates: a surface that is not one of revolution, and need not be convex.
//!
//! The surface is that of [`downpour_mask::wobble`]. All roots are found:
//!
//! A line is sampled in equal parts; in a part at whose ends the slope of G changes sign, its extremum is located, so that no bulge or
//! hollow wider than a part is missed. The crossing is refined by the steps of `mask_trace_step`, and by bisection
//! if these leave the bracket.
//!
//! Limits: light that has left the drop does not meet it again.
//!
//! Generic over [`Real`]; with `f32` the twin of `shaders/wgsl/render/specimen_wobble.wgsl`.

use downpour_drop::shape::COEFFICIENTS;
use downpour_mask::trace::{Surface, mask_trace_step};
use downpour_mask::wobble::mask_wobble_surface;
use downpour_math::real::Real;
use downpour_math::vector::{add_scaled, dot, normalize};
use downpour_shaders::render::specimen::{
    SPECIMEN_WOBBLE_FLAT, SPECIMEN_WOBBLE_PART, SPECIMEN_WOBBLE_PARTS, SPECIMEN_WOBBLE_SLACK,
    SPECIMEN_WOBBLE_STEPS, SPECIMEN_WOBBLE_TURNS,
};

use super::trace::{SpecimenLight, SpecimenRay, specimen_split_inside, specimen_split_outside};

/// A drop at one instant.
#[derive(Clone, Copy, Debug)]
pub struct SpecimenWobble<R> {
    /// Shape coefficients, from `c_0` to `c_10`.
    pub coefficients: [f64; COEFFICIENTS],
    /// s2, s3, and the factor that conserves the volume.
    pub state: [R; 3],
    /// Refractive index of water relative to air.
    pub index: f64,
    /// 1 / A^2, with A the half width across the axis of a spheroid that holds the drop.
    pub inverse_wide: f64,
    /// 1 / B^2, with B its half height along the axis.
    pub inverse_tall: f64,
}

/// G - 1 and half of grad G at a point.
#[inline]
#[must_use]
pub fn specimen_wobble_surface<R: Real>(drop: &SpecimenWobble<R>, point: [R; 3]) -> Surface<R> {
    mask_wobble_surface(&drop.coefficients, drop.state, point)
}

/// G - 1 and half of dG/ds at the parameter `s` of a line.
#[inline]
#[must_use]
pub fn specimen_wobble_along<R: Real>(
    drop: &SpecimenWobble<R>,
    origin: [R; 3],
    direction: [R; 3],
    s: R,
) -> [R; 2] {
    let surface = specimen_wobble_surface(drop, add_scaled(origin, direction, s));
    [surface.excess, dot(surface.half_gradient, direction)]
}

/// Parameters at which a line enters and leaves the bounding spheroid; the second is below the first if it misses.
#[inline]
#[must_use]
pub fn specimen_wobble_span<R: Real<Mask = bool>>(
    drop: &SpecimenWobble<R>,
    origin: [R; 3],
    direction: [R; 3],
) -> [R; 2] {
    let one = origin[0].constant(1.0);
    let (wide, tall) = (one.constant(drop.inverse_wide), one.constant(drop.inverse_tall));
    let across = |a: [R; 3]| [a[0] * wide, a[1] * tall, a[2] * wide];
    let curvature = dot(across(direction), direction);
    let slope = dot(across(origin), direction);
    let excess = dot(across(origin), origin) - one;
    let discriminant = slope * slope - curvature * excess;
    if discriminant.less(one.constant(0.0)) {
        return [one, -one];
    }
    let root = discriminant.sqrt();
    [(-slope - root) / curvature, (root - slope) / curvature]
}

/// First parameter between `start` and `end` at which a line enters the drop (`side` = -1) or leaves it (`side` = 1);
/// `None` if there is none. At `start` it is on the other side, or on the surface.
#[inline]
#[must_use]
pub fn specimen_wobble_cross<R: Real<Mask = bool>>(
    drop: &SpecimenWobble<R>,
    origin: [R; 3],
    direction: [R; 3],
    start: R,
    end: R,
    side: R,
) -> Option<R> {
    let zero = side.constant(0.0);
    let at = |s: R| specimen_wobble_along(drop, origin, direction, s);
    let beyond = |value: R| zero.less(side * value);
    let part = (end - start) * side.constant(f64::from(SPECIMEN_WOBBLE_PART));
    let (mut a, mut b) = (start, start);
    let mut at_a = at(start);
    let mut at_b = at_a;
    let mut found = false;
    for k in 1..=SPECIMEN_WOBBLE_PARTS {
        b = start + part * side.constant(f64::from(k));
        at_b = at(b);
        found = beyond(at_b[0]);
        if !found && beyond(at_a[1]) && (side * at_b[1]).less(zero) {
            // G turns toward the other side: its extremum by the rule of the false position.
            let (mut low, mut high) = ([a, at_a[1]], [b, at_b[1]]);
            for _ in 0..SPECIMEN_WOBBLE_TURNS {
                let middle = low[0] + (high[0] - low[0]) * (low[1] / (low[1] - high[1]));
                let at_middle = at(middle);
                if beyond(at_middle[0]) {
                    (found, b, at_b) = (true, middle, at_middle);
                    break;
                }
                if beyond(at_middle[1]) {
                    low = [middle, at_middle[1]];
                } else {
                    high = [middle, at_middle[1]];
                }
            }
        }
        if found {
            break;
        }
        (a, at_a) = (b, at_b);
    }
    if !found {
        return None;
    }
    let flat = side.constant(f64::from(SPECIMEN_WOBBLE_FLAT));
    let slack = side.constant(f64::from(SPECIMEN_WOBBLE_SLACK));
    let curvature = ((at_b[1] - at_a[1]) / (b - a)).at_least(flat);
    // From the outer end, where a step to the root on the correct side is never ambiguous.
    let (mut s, mut at_s) = if zero.less(side) { (b, at_b) } else { (a, at_a) };
    for _ in 0..SPECIMEN_WOBBLE_STEPS {
        let next = s + mask_trace_step(at_s[0], at_s[1], curvature, side);
        let strays = next.less(a - slack) | (b + slack).less(next);
        s = if strays { side.constant(0.5) * (a + b) } else { next.at_least(a).at_most(b) };
        at_s = at(s);
        if beyond(at_s[0]) {
            b = s;
        } else {
            a = s;
        }
    }
    let last = s + mask_trace_step(at_s[0], at_s[1], curvature, side);
    Some(last.at_least(a).at_most(b))
}

/// Parameter at which a ray of the camera meets the drop; `None` if it misses.
#[inline]
#[must_use]
pub fn specimen_wobble_meet<R: Real<Mask = bool>>(
    drop: &SpecimenWobble<R>,
    ray: &SpecimenRay<R>,
) -> Option<R> {
    let [near, far] = specimen_wobble_span(drop, ray.foot, ray.direction);
    let start = near.at_least(-ray.reach);
    if !start.less(far) {
        return None;
    }
    specimen_wobble_cross(drop, ray.foot, ray.direction, start, far, -far.constant(1.0))
}

/// First interface, at the parameter `s` of the ray.
#[inline]
#[must_use]
pub fn specimen_wobble_enter<R: Real>(
    drop: &SpecimenWobble<R>,
    ray: &SpecimenRay<R>,
    s: R,
) -> SpecimenLight<R> {
    let point = add_scaled(ray.foot, ray.direction, s);
    let normal = normalize(specimen_wobble_surface(drop, point).half_gradient);
    specimen_split_outside(point, normal, ray.direction, s.constant(drop.index))
}

/// Next interface from inside.
#[inline]
#[must_use]
pub fn specimen_wobble_bounce<R: Real<Mask = bool>>(
    drop: &SpecimenWobble<R>,
    light: &SpecimenLight<R>,
    least: R,
) -> SpecimenLight<R> {
    let zero = least.constant(0.0);
    let [_, end] = specimen_wobble_span(drop, light.point, light.inside);
    let cross = specimen_wobble_cross(drop, light.point, light.inside, zero, end, least.constant(1.0));
    let point = add_scaled(light.point, light.inside, cross.unwrap_or(end));
    let normal = normalize(specimen_wobble_surface(drop, point).half_gradient);
    specimen_split_inside(light, point, normal, least.constant(drop.index), least)
}
