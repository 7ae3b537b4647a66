//! Silhouette of a drop in a pixel: coverage and sample point.
//!
//! On the viewer's ray through a pixel the gauge g has a minimum; the drop is hit where that is below 1. At the
//! minimum the gradient of g lies in the image plane, so (g - 1) / |grad g| is the distance to the outline, and
//! the pixel is cut by a half plane at that distance. Its covered area is exact for a straight edge; the curvature
//! of the outline within a pixel is neglected: it adds 1 / (12 R^2) to the area of a disk of R
//! pixels.
//!
//! A pixel on the outline is traced at the middle of its covered part, not at its center: the ray then hits the
//! drop, and the direction is that of the covered part. Pixels just outside get the direction at the outline, so
//! that texture filters have a value to interpolate. No ray is traced nearer to the outline than a tenth of a pixel:
//! there the direction changes faster than f32 resolves.
//!
//! Lengths are in units of the equivalent radius, as in [`trace`](crate::trace). Twin of
//! `shaders/wgsl/mask/silhouette.wgsl`.

use downpour_math::real::Real;
use downpour_shaders::mask::{
    MASK_BLEED, MASK_EDGE_DEPTH, MASK_SILHOUETTE_INSIDE, MASK_SILHOUETTE_OUTSIDE, MASK_SILHOUETTE_STEPS,
    MASK_TINY,
};

use crate::trace::{TracedDrop, mask_trace_curvature, mask_trace_spheroid, mask_trace_surface};

/// Coverage and sample point of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct PixelCut<R> {
    /// Covered fraction of the pixel, in [0, 1].
    pub coverage: R,
    /// Sample point: the pixel's center, or the middle of its covered part.
    pub sample: [R; 2],
    /// 1 if the pixel is traced: the drop is in the pixel or within the bleed.
    pub traced: R,
}

/// The gauge squared of the reference spheroid at its minimum on the viewer's ray through (x, y).
#[inline(always)]
#[must_use]
pub fn mask_silhouette_estimate<R: Real>(drop: &TracedDrop, x: R, y: R) -> R {
    let zero = x.constant(0.0);
    let toward = [zero, zero, x.constant(1.0)];
    let point = [x, y, zero];
    let slope = mask_trace_spheroid(drop, point, toward);
    mask_trace_spheroid(drop, point, point) - slope * slope / mask_trace_curvature(drop, toward)
}

/// Distance from (x, y) to the outline, positive outside, and the unit vector away from it.
#[inline(always)]
#[must_use]
pub fn mask_silhouette_distance<R: Real>(drop: &TracedDrop, x: R, y: R) -> [R; 3] {
    let zero = x.constant(0.0);
    let one = x.constant(1.0);
    let toward = [zero, zero, one];
    let curvature = mask_trace_curvature(drop, toward);
    let mut z = -mask_trace_spheroid(drop, [x, y, zero], toward) / curvature;
    for _ in 0..MASK_SILHOUETTE_STEPS {
        z = z - mask_trace_surface(drop, [x, y, z]).half_gradient[2] / curvature;
    }
    let surface = mask_trace_surface(drop, [x, y, z]);
    let [gx, gy, _] = surface.half_gradient;
    let across = (gx * gx + gy * gy).at_least(one.constant(f64::from(MASK_TINY))).sqrt();
    // g - 1 = (G - 1) / (g + 1) does not cancel, and grad g = (grad G / 2) / g.
    let gauge = (surface.excess + one).at_least(zero).sqrt();
    let distance = surface.excess / (gauge + one) * gauge / across;
    [distance, gx / across, gy / across]
}

/// Fraction of a unit square on the inner side of a line at distance `distance` from the square's center (positive
/// if the center is outside), with the line's unit normal (nx, ny).
#[inline(always)]
#[must_use]
pub fn mask_silhouette_area<R: Real>(distance: R, nx: R, ny: R) -> R {
    let zero = distance.constant(0.0);
    let one = distance.constant(1.0);
    let half = distance.constant(0.5);
    let long = nx.abs().at_least(ny.abs());
    let short = nx.abs().at_most(ny.abs());
    let depth = ((long + short) * half - distance.abs()).at_least(zero);
    let corner = depth * depth / (long * short).at_least(one.constant(f64::from(MASK_TINY))) * half;
    let band = (depth - short * half) / long;
    let smaller = R::select(depth.less(short), corner, band).at_most(half);
    R::select(zero.less(distance), smaller, one - smaller)
}

/// Coverage and sample point of the pixel of width `pixel` centered at (x, y).
#[inline(always)]
#[must_use]
pub fn mask_silhouette_cut<R: Real>(drop: &TracedDrop, pixel: R, x: R, y: R) -> PixelCut<R> {
    let zero = x.constant(0.0);
    let one = x.constant(1.0);
    let half = x.constant(0.5);
    let estimate = mask_silhouette_estimate(drop, x, y);
    // A large pixel reaches further: the margin of the two thresholds grows with it.
    let reach = one.constant(f64::from(MASK_BLEED) + 1.0) * pixel;
    let inner = one.constant(f64::from(MASK_SILHOUETTE_INSIDE)) - reach;
    let outer = one.constant(f64::from(MASK_SILHOUETTE_OUTSIDE)) + reach * one.constant(4.0);
    let is_inside = estimate.less(inner);
    let is_near = estimate.less(outer);
    let undecided = R::select(is_inside, zero, R::select(is_near, one, zero));
    if !one.any(zero.less(undecided)) {
        let covered = R::select(is_inside, one, zero);
        return PixelCut { coverage: covered, sample: [x, y], traced: covered };
    }
    let [distance, nx, ny] = mask_silhouette_distance(drop, x, y);
    let pixels = distance / pixel;
    let edge = mask_silhouette_area(pixels, nx, ny);
    let coverage = R::select(is_inside, one, R::select(is_near, edge, zero));
    let extent = (nx.abs() + ny.abs()) * half;
    let least = pixels + one.constant(f64::from(MASK_EDGE_DEPTH));
    let inward = ((extent + pixels) * half).at_most(extent).at_least(least).at_least(zero) * pixel;
    let sample = [R::select(is_inside, x, x - nx * inward), R::select(is_inside, y, y - ny * inward)];
    let bleeds = one.both(is_near, pixels.less(one.constant(f64::from(MASK_BLEED))));
    let traced = R::select(one.either(is_inside, bleeds), one, zero);
    PixelCut { coverage, sample, traced }
}
