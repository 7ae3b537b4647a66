//! One algorithm for `f32`, `f64` and many `f32` lanes at once.
//!
//! A function that is generic over [`Real`] is written once, without branches that depend on values. With `f32` it
//! is the twin of a WGSL function, with `f64` its reference, and with [`Lanes`] the fast CPU path. All operations
//! are exactly specified by IEEE 754 and none is contracted, so each lane has the same bits as the scalar `f32`,
//! for any vector width.

use std::ops::{Add, Div, Mul, Neg, Sub};

pub use pulp::Simd;

/// A real number, or a vector of real numbers with lane-wise operations.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Result of a comparison, per lane.
    type Mask: Copy;

    /// Constant of the same type and width as `self`, rounded to the precision of the type.
    #[must_use]
    fn constant(self, value: f64) -> Self;
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// `self < other`.
    fn less(self, other: Self) -> Self::Mask;
    /// True where both are true.
    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// True where at least one is true.
    fn either(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// True if any lane is true.
    fn any(self, mask: Self::Mask) -> bool;
    /// `yes` where the mask is true, `no` elsewhere.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The larger of the two; `other` where the comparison is false, as for NaN.
    #[inline(always)]
    #[must_use]
    fn at_least(self, other: Self) -> Self {
        Self::select(other.less(self), self, other)
    }

    /// The smaller of the two; `other` where the comparison is false, as for NaN.
    #[inline(always)]
    #[must_use]
    fn at_most(self, other: Self) -> Self {
        Self::select(self.less(other), self, other)
    }
}

macro_rules! scalar {
    ($ty:ty) => {
        impl Real for $ty {
            type Mask = bool;
            #[inline(always)]
            fn constant(self, value: f64) -> Self {
                value as $ty
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$ty>::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$ty>::abs(self)
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn both(self, a: bool, b: bool) -> bool {
                a & b
            }
            #[inline(always)]
            fn either(self, a: bool, b: bool) -> bool {
                a | b
            }
            #[inline(always)]
            fn any(self, mask: bool) -> bool {
                mask
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
        }
    };
}

scalar!(f32);
scalar!(f64);

/// SIMD vector of `f32`, as wide as the instruction set `S` allows.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    value: S::f32s,
}

impl<S: Simd> Lanes<S> {
    /// Number of lanes.
    pub const COUNT: usize = S::F32_LANES;

    /// Vector with all lanes equal to `value`.
    #[inline(always)]
    pub fn splat(simd: S, value: f32) -> Self {
        Self { simd, value: simd.splat_f32s(value) }
    }

    /// Loads the first [`COUNT`](Self::COUNT) numbers of `slice`; missing ones are zero.
    #[inline(always)]
    pub fn load(simd: S, slice: &[f32]) -> Self {
        // Partial loads are slow.
        match S::as_simd_f32s(slice).0.first() {
            Some(&value) => Self { simd, value },
            None => Self { simd, value: simd.partial_load_f32s(slice) },
        }
    }

    /// The complete vectors at the start of a slice, for loops without a bounds test per vector; see [`of`](Self::of).
    #[inline(always)]
    #[must_use]
    pub fn vectors(slice: &[f32]) -> &[S::f32s] {
        S::as_simd_f32s(slice).0
    }

    /// Mutable version of [`vectors`](Self::vectors), written by [`put`](Self::put).
    #[inline(always)]
    #[must_use]
    pub fn vectors_mut(slice: &mut [f32]) -> &mut [S::f32s] {
        S::as_mut_simd_f32s(slice).0
    }

    /// Loads one element of [`vectors`](Self::vectors).
    #[inline(always)]
    pub fn of(simd: S, vector: &S::f32s) -> Self {
        Self { simd, value: *vector }
    }

    /// Writes all lanes to one element of [`vectors_mut`](Self::vectors_mut).
    #[inline(always)]
    pub fn put(self, vector: &mut S::f32s) {
        *vector = self.value;
    }

    /// Writes the lanes to `slice`, as many as fit.
    #[inline(always)]
    pub fn store(self, slice: &mut [f32]) {
        match S::as_mut_simd_f32s(slice).0.first_mut() {
            Some(vector) => *vector = self.value,
            None => self.simd.partial_store_f32s(slice, self.value),
        }
    }
}

macro_rules! lane_operator {
    ($trait:ident, $method:ident, $simd:ident) => {
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { simd: self.simd, value: self.simd.$simd(self.value, other.value) }
            }
        }
    };
}

lane_operator!(Add, add, add_f32s);
lane_operator!(Sub, sub, sub_f32s);
lane_operator!(Mul, mul, mul_f32s);
lane_operator!(Div, div, div_f32s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { simd: self.simd, value: self.simd.neg_f32s(self.value) }
    }
}

impl<S: Simd> Real for Lanes<S> {
    type Mask = LaneMask<S>;
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::splat(self.simd, value as f32)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { simd: self.simd, value: self.simd.sqrt_f32s(self.value) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self { simd: self.simd, value: self.simd.abs_f32s(self.value) }
    }
    #[inline(always)]
    fn less(self, other: Self) -> LaneMask<S> {
        LaneMask { simd: self.simd, mask: self.simd.less_than_f32s(self.value, other.value) }
    }
    #[inline(always)]
    fn both(self, a: LaneMask<S>, b: LaneMask<S>) -> LaneMask<S> {
        LaneMask { simd: a.simd, mask: a.simd.and_m32s(a.mask, b.mask) }
    }
    #[inline(always)]
    fn either(self, a: LaneMask<S>, b: LaneMask<S>) -> LaneMask<S> {
        LaneMask { simd: a.simd, mask: a.simd.or_m32s(a.mask, b.mask) }
    }
    #[inline(always)]
    fn any(self, mask: LaneMask<S>) -> bool {
        mask.simd.first_true_m32s(mask.mask) < S::F32_LANES
    }
    #[inline(always)]
    fn select(mask: LaneMask<S>, yes: Self, no: Self) -> Self {
        Self { simd: yes.simd, value: mask.simd.select_f32s(mask.mask, yes.value, no.value) }
    }
}

/// Result of a comparison of [`Lanes`].
#[derive(Clone, Copy)]
pub struct LaneMask<S: Simd> {
    simd: S,
    mask: S::m32s,
}

/// Runs `work` with the widest vectors that the machine supports.
///
/// ```
/// use downpour_math::real::{Lanes, Real, WithLanes, with_widest_lanes};
/// struct Roots<'a>(&'a mut [f32]);
/// impl WithLanes for Roots<'_> {
///     type Output = ();
///     #[inline(always)]
///     fn run<S: downpour_math::real::Simd>(self, simd: S) {
///         for chunk in self.0.chunks_mut(Lanes::<S>::COUNT) {
///             Lanes::load(simd, chunk).sqrt().store(chunk);
///         }
///     }
/// }
/// let mut numbers = [1.0, 4.0, 9.0];
/// with_widest_lanes(Roots(&mut numbers));
/// assert_eq!(numbers, [1.0, 2.0, 3.0]);
/// ```
#[inline]
pub fn with_widest_lanes<W: WithLanes>(work: W) -> W::Output {
    struct Run<W>(W);
    impl<W: WithLanes> pulp::WithSimd for Run<W> {
        type Output = W::Output;
        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> W::Output {
            self.0.run(simd)
        }
    }
    pulp::Arch::new().dispatch(Run(work))
}

/// Work that is written for any vector width. `run` and all functions that it calls should be `#[inline(always)]`:
/// only then are they compiled for the detected instruction set.
pub trait WithLanes {
    /// Result of the work.
    type Output;
    /// Does the work with the vectors of `simd`.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mix of all operations.
    #[inline(always)]
    fn formula<R: Real>(x: R, y: R) -> R {
        let a = (x * x + y.abs() / (x.constant(3.0) + x)).sqrt() - y;
        let smaller = x.both(x.less(y), a.less(x.constant(2.0)));
        R::select(smaller, a.at_least(-x), (a * y).at_most(x.constant(0.7)))
    }

    struct All<'a>(&'a [f32], &'a [f32], &'a mut [f32]);

    impl WithLanes for All<'_> {
        type Output = ();
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) {
            let n = Lanes::<S>::COUNT;
            for ((x, y), out) in self.0.chunks(n).zip(self.1.chunks(n)).zip(self.2.chunks_mut(n)) {
                formula(Lanes::load(simd, x), Lanes::load(simd, y)).store(out);
            }
        }
    }

    #[test]
    fn lanes_have_the_bits_of_the_scalar() {
        let n = 1003;
        let x: Vec<f32> = (0..n).map(|i| i as f32 * 0.01).collect();
        let y: Vec<f32> = (0..n).map(|i| (i * 37 % 101) as f32 * 0.1 - 5.0).collect();
        let mut out = vec![f32::NAN; x.len()];
        with_widest_lanes(All(&x, &y, &mut out));
        for i in 0..x.len() {
            assert_eq!(out[i].to_bits(), formula(x[i], y[i]).to_bits(), "{} {}", x[i], y[i]);
            assert!((f64::from(out[i]) - formula(f64::from(x[i]), f64::from(y[i]))).abs() < 2.0e-5);
        }
    }
}
