//! Operations on three-vectors of any [`Real`], shared by algorithms for `f32`, `f64` and lanes. Code that only
//! uses `f32` uses glam.

use crate::real::Real;

/// Dot product, summed from x to z.
#[inline(always)]
#[must_use]
pub fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cross product.
#[inline(always)]
#[must_use]
pub fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a + b`.
#[inline(always)]
#[must_use]
pub fn add<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
#[inline(always)]
#[must_use]
pub fn sub<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a s`.
#[inline(always)]
#[must_use]
pub fn scale<R: Real>(a: [R; 3], s: R) -> [R; 3] {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// `a + b s`.
#[inline(always)]
#[must_use]
pub fn add_scaled<R: Real>(a: [R; 3], b: [R; 3], s: R) -> [R; 3] {
    [a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s]
}

/// `a` divided by its length.
#[inline(always)]
#[must_use]
pub fn normalize<R: Real>(a: [R; 3]) -> [R; 3] {
    let length = dot(a, a).sqrt();
    scale(a, length.constant(1.0) / length)
}

/// `yes` where the mask is true, `no` elsewhere.
#[inline(always)]
#[must_use]
pub fn select<R: Real>(mask: R::Mask, yes: [R; 3], no: [R; 3]) -> [R; 3] {
    [R::select(mask, yes[0], no[0]), R::select(mask, yes[1], no[1]), R::select(mask, yes[2], no[2])]
}
