//! One algorithm for `f32`, `f64` and many `f32` lanes at once.
//!
//! A function that is generic over [`Real`] is written once, without branches that depend on values, and is
//! used three times: with `f32` it is the twin of a WGSL function, with `f64` the reference above it, and with
//! [`Lanes`] the fast CPU path. All operations are exactly specified by IEEE 754 and none is contracted, so the
//! lanes have the same bits as the scalar `f32`, for any width of the machine's vectors.

use std::ops::{Add, Div, Mul, Neg, Sub};

pub use pulp::Simd;

/// A real number, or a vector of them on which each operation works lane by lane.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The result of a comparison, lane by lane.
    type Mask: Copy;

    /// A constant, of the kind and width of `self`. It is rounded to the precision of the kind.
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
    /// Whether both are true.
    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether at least one is true.
    fn either(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether any lane is true.
    fn any(self, mask: Self::Mask) -> bool;
    /// `yes` where the mask is true, `no` elsewhere.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The larger of the two; `other` where the comparison does not hold.
    #[inline(always)]
    #[must_use]
    fn at_least(self, other: Self) -> Self {
        Self::select(other.less(self), self, other)
    }

    /// The smaller of the two; `other` where the comparison does not hold.
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

/// A machine vector of `f32`: as many lanes as the instruction set `S` has.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    value: S::f32s,
}

impl<S: Simd> Lanes<S> {
    /// How many numbers a vector holds.
    pub const COUNT: usize = S::F32_LANES;

    /// The vector whose lanes are all `value`.
    #[inline(always)]
    pub fn splat(simd: S, value: f32) -> Self {
        Self { simd, value: simd.splat_f32s(value) }
    }

    /// The first [`COUNT`](Self::COUNT) numbers of `slice`; zero where it ends earlier.
    #[inline(always)]
    pub fn load(simd: S, slice: &[f32]) -> Self {
        // Loads of parts of vectors are slow.
        match S::as_simd_f32s(slice).0.first() {
            Some(&value) => Self { simd, value },
            None => Self { simd, value: simd.partial_load_f32s(slice) },
        }
    }

    /// The whole vectors at the beginning of a slice, for loops without a test for each: [`of`](Self::of) reads one.
    #[inline(always)]
    #[must_use]
    pub fn vectors(slice: &[f32]) -> &[S::f32s] {
        S::as_simd_f32s(slice).0
    }

    /// As [`vectors`](Self::vectors), to be written by [`put`](Self::put).
    #[inline(always)]
    #[must_use]
    pub fn vectors_mut(slice: &mut [f32]) -> &mut [S::f32s] {
        S::as_mut_simd_f32s(slice).0
    }

    /// A vector of [`vectors`](Self::vectors).
    #[inline(always)]
    pub fn of(simd: S, vector: &S::f32s) -> Self {
        Self { simd, value: *vector }
    }

    /// Writes all lanes to a vector of [`vectors_mut`](Self::vectors_mut).
    #[inline(always)]
    pub fn put(self, vector: &mut S::f32s) {
        *vector = self.value;
    }

    /// Writes the lanes to `slice`, as many as it has room for.
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

/// The result of comparing [`Lanes`].
#[derive(Clone, Copy)]
pub struct LaneMask<S: Simd> {
    simd: S,
    mask: S::m32s,
}

/// Runs `work` with the widest vectors that this machine has.
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

/// Work that is written for any vector width. `run` and all that it calls should be `#[inline(always)]`: only
/// then are they compiled for the instruction set that was found.
pub trait WithLanes {
    /// What the work gives back.
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
