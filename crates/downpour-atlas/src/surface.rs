//! Intersection of a line with an oscillating drop.
//!
//! The surface is |p| = R(p / |p|), with R of `downpour_drop::oscillation`. As in [`downpour_mask::trace`], the gauge squared
//! G = |p|^2 / R^2 is close to a parabola along a line, and its root is found by Newton steps on that parabola. G is
//! homogeneous of degree 2, so p . grad G = 2 G, and grad G = 2 G N / (p . N) follows from the normal N. Where the
//! steps do not settle (a dent next to a grazing ray), the line is searched in steps and then halved.

use downpour_drop::mesh::DropSurface;
use downpour_drop::oscillation::DropInstant;
use downpour_math::vector::{add_scaled, dot, scale};

use downpour_mask::trace::mask_trace_step;

/// The most Newton steps.
const STEPS: u32 = 16;
/// Tolerance of G - 1.
const CLOSE: f64 = 1.0e-9;
/// Distance from its start at which a ray is next tested, in radii: it must not meet its starting point.
const MIN_DISTANCE: f64 = 1.0e-6;
/// Number of steps of the search, and its length in radii: longer than any drop.
const SEARCH: u32 = 64;
const MAX_DISTANCE: f64 = 3.2;

/// A drop at one instant, in units of its equivalent radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface<'a> {
    pub(crate) instant: &'a DropInstant,
    pub(crate) inverse_radius: f64,
}

/// A point of the surface and the outward normal there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    pub(crate) point: [f64; 3],
    pub(crate) normal: [f64; 3],
}

struct Gauge {
    excess: f64,
    slope: f64,
    curvature: f64,
    normal: [f64; 3],
}

impl Surface<'_> {
    fn gauge(&self, point: [f64; 3], direction: [f64; 3]) -> Gauge {
        let square = dot(point, point).max(1.0e-12);
        let outward = scale(point, 1.0 / square.sqrt());
        let radius = self.instant.radius_along(outward) * self.inverse_radius;
        let normal = self.instant.normal_along(outward);
        let curvature = 1.0 / (radius * radius);
        let value = square * curvature;
        Gauge {
            excess: value - 1.0,
            slope: value * dot(normal, direction) / dot(point, normal),
            curvature,
            normal,
        }
    }

    fn excess(&self, point: [f64; 3]) -> f64 {
        let length = dot(point, point).max(1.0e-12).sqrt();
        length / (self.instant.radius_along(scale(point, 1.0 / length)) * self.inverse_radius) - 1.0
    }

    /// Newton steps from `start` to the root before (`side` = -1) or behind (1) the minimum: its distance.
    fn settle(&self, origin: [f64; 3], direction: [f64; 3], start: f64, side: f64) -> Option<(f64, Meeting)> {
        let mut distance = start;
        for _ in 0..STEPS {
            let point = add_scaled(origin, direction, distance);
            let gauge = self.gauge(point, direction);
            if gauge.excess.abs() < CLOSE {
                return Some((distance, Meeting { point, normal: gauge.normal }));
            }
            distance += mask_trace_step(gauge.excess, gauge.slope, gauge.curvature, side);
        }
        None
    }

    /// Entry of a ray from outside; `origin` is the point of the ray nearest to the drop's origin.
    pub(crate) fn enter(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<Meeting> {
        let start = mask_trace_step(dot(origin, origin) - 1.0, dot(origin, direction), 1.0, -1.0);
        self.settle(origin, direction, start, -1.0)
            .map(|(_, meeting)| meeting)
            .filter(|meeting| dot(meeting.normal, direction) < 0.0)
    }

    /// Next intersection of a ray that enters the drop at `origin`.
    pub(crate) fn leave(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<Meeting> {
        let start = mask_trace_step(dot(origin, origin) - 1.0, dot(origin, direction), 1.0, 1.0);
        let found = self.settle(origin, direction, start, 1.0);
        let usable = |&(distance, meeting): &(f64, Meeting)| {
            distance > MIN_DISTANCE && dot(meeting.normal, direction) > 0.0
        };
        match found.filter(usable) {
            Some((_, meeting)) => Some(meeting),
            None => self.search(origin, direction),
        }
    }

    fn search(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<Meeting> {
        let at = |k: u32| MAX_DISTANCE * f64::from(k) / f64::from(SEARCH);
        let outside = |distance: f64| self.excess(add_scaled(origin, direction, distance)) > 0.0;
        // From the first inside point on, the first outside one.
        let first = (1..SEARCH).find(|&k| !outside(at(k)))?;
        let next = (first + 1..=SEARCH).find(|&k| outside(at(k)))?;
        let (mut low, mut high) = (at(next - 1), at(next));
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if outside(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        let point = add_scaled(origin, direction, low);
        let normal = self.gauge(point, direction).normal;
        (dot(normal, direction) > 0.0).then_some(Meeting { point, normal })
    }
}
