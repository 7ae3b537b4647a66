//! Angle of the first octant from its tangent. Twin of `shaders/wgsl/common/octant.wgsl`.

use downpour_shaders::common::OCTANT_TURN;

use crate::real::Real;

/// Angle whose tangent is `t`, in turns; `t` is in [0, 1].
///
/// ```
/// use downpour_math::octant::octant_turns;
/// assert_eq!((octant_turns(0.0f32), octant_turns(1.0f32)), (0.0, 0.125));
/// ```
#[inline(always)]
#[must_use]
pub fn octant_turns<R: Real>(t: R) -> R {
    let s = t * t;
    let mut sum = t.constant(f64::from(OCTANT_TURN[8]));
    for n in (0..8).rev() {
        sum = sum * s + t.constant(f64::from(OCTANT_TURN[n]));
    }
    sum * t
}
