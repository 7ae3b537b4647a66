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
    /// Source of the numbers: the WGSL accuracy table, a condition number, a measured bound.
    pub why: &'static str,
}

impl Tol {
    /// Bit for bit.
    #[must_use]
    pub const fn exact(why: &'static str) -> Self {
        Self { abs: 0.0, rel: 0.0, ulp: 0, outliers: 0.0, why }
    }

    /// So many units in the last place.
    #[must_use]
    pub const fn ulp(ulp: u32, why: &'static str) -> Self {
        Self { abs: 0.0, rel: 0.0, ulp, outliers: 0.0, why }
    }

    /// Relative, with an absolute floor.
    #[must_use]
    pub const fn relative(rel: f64, abs: f64, why: &'static str) -> Self {
        Self { abs, rel, ulp: 0, outliers: 0.0, why }
    }

    /// Absolute.
    #[must_use]
    pub const fn absolute(abs: f64, why: &'static str) -> Self {
        Self { abs, rel: 0.0, ulp: 0, outliers: 0.0, why }
    }

    /// The same with a fraction of numbers that may be outside.
    #[must_use]
    pub const fn with_outliers(mut self, fraction: f64) -> Self {
        self.outliers = fraction;
        self
    }
}
