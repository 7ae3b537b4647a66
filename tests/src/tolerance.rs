//! Largest difference allowed between two results, and the reason for it.

/// A tolerance. There is no default: each case says what it allows, and `why`.
///
/// A pair of numbers passes if it is within any one of `abs`, `rel` or `ulp`. Integers and booleans have to be
/// equal whatever the tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Tol {
    /// Largest absolute difference.
    pub abs: f64,
    /// Largest difference relative to the CPU's value.
    pub rel: f64,
    /// Largest distance in units in the last place.
    pub ulp: u32,
    /// Fraction of all numbers that may be outside (0 for almost every case).
    pub outliers: f64,
    /// Largest mean of the errors, each as a fraction of what is allowed and at most 1: where single numbers may be far apart,
    /// most of them still have to be close. 1: no limit.
    pub mean: f64,
    /// Source of the numbers: the WGSL accuracy table, a condition number, a measured bound.
    pub why: &'static str,
}

impl Tol {
    /// Bit for bit.
    #[must_use]
    pub const fn exact(why: &'static str) -> Self {
        Self { abs: 0.0, rel: 0.0, ulp: 0, outliers: 0.0, mean: 1.0, why }
    }

    /// So many units in the last place.
    #[must_use]
    pub const fn ulp(ulp: u32, why: &'static str) -> Self {
        Self { abs: 0.0, rel: 0.0, ulp, outliers: 0.0, mean: 1.0, why }
    }

    /// Relative, with an absolute floor.
    #[must_use]
    pub const fn relative(rel: f64, abs: f64, why: &'static str) -> Self {
        Self { abs, rel, ulp: 0, outliers: 0.0, mean: 1.0, why }
    }

    /// Absolute.
    #[must_use]
    pub const fn absolute(abs: f64, why: &'static str) -> Self {
        Self { abs, rel: 0.0, ulp: 0, outliers: 0.0, mean: 1.0, why }
    }

    /// The same with a fraction of numbers that may be outside.
    #[must_use]
    pub const fn with_outliers(mut self, fraction: f64) -> Self {
        self.outliers = fraction;
        self
    }

    /// Error of a number as a fraction of what is allowed, from its differences; 1 where it is outside.
    #[must_use]
    pub fn used(&self, difference: f64, relative: f64, ulp: u32) -> f64 {
        let part = |error: f64, allowed: f64| if error <= 0.0 { 0.0 } else { error / allowed };
        let parts =
            [part(difference, self.abs), part(relative, self.rel), part(f64::from(ulp), f64::from(self.ulp))];
        parts.into_iter().fold(1.0, f64::min)
    }
}
