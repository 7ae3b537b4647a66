//! Scalar functions with the same bits on every machine.
//!
//! `f32::sin` and similar methods call the platform's library, which differs between systems and versions.
//! The functions here call the `libm` crate, whose code is the same everywhere. Square root, rounding and the
//! four basic operations are exactly specified by IEEE 754 and need no counterpart. `clippy.toml` forbids the
//! platform's functions in the whole workspace.
//!
//! This module has the functions on `f32`; [`mod@f64`] has those on `f64`.

macro_rules! forward {
    ($ty:ty: $( $(#[$doc:meta])* $name:ident($($arg:ident),+) = $libm:ident; )*) => {
        $(
            $(#[$doc])*
            #[inline]
            #[must_use]
            pub fn $name($($arg: $ty),+) -> $ty {
                libm::$libm($($arg),+)
            }
        )*
    };
}

forward! { f32:
    /// Sine of an angle in radians.
    sin(x) = sinf;
    /// Cosine of an angle in radians.
    cos(x) = cosf;
    /// Tangent of an angle in radians.
    tan(x) = tanf;
    /// Inverse sine, in [-pi/2, pi/2]; NaN outside [-1, 1].
    asin(x) = asinf;
    /// Inverse cosine, in [0, pi]; NaN outside [-1, 1].
    acos(x) = acosf;
    /// Inverse tangent, in (-pi/2, pi/2).
    atan(x) = atanf;
    /// Angle of the point (x, y), in [-pi, pi].
    atan2(y, x) = atan2f;
    /// e to the power x.
    exp(x) = expf;
    /// 2 to the power x.
    exp2(x) = exp2f;
    /// Natural logarithm.
    ln(x) = logf;
    /// Logarithm to base 2.
    log2(x) = log2f;
    /// Logarithm to base 10.
    log10(x) = log10f;
    /// x to the power y.
    pow(x, y) = powf;
    /// Cube root.
    cbrt(x) = cbrtf;
    /// Hyperbolic tangent.
    tanh(x) = tanhf;
    /// Length of (x, y) without overflow.
    hypot(x, y) = hypotf;
}

/// True where `x` is neither infinite nor NaN, tested by its bits. Twin of `ops_is_finite` in WGSL, where
/// `x != x` does not detect NaN.
#[inline]
#[must_use]
pub fn ops_is_finite(x: f32) -> bool {
    (x.to_bits() & 0x7f80_0000) != 0x7f80_0000
}

/// The same functions on `f64`, for reference computations.
pub mod f64 {
    forward! { f64:
        /// Sine of an angle in radians.
        sin(x) = sin;
        /// Cosine of an angle in radians.
        cos(x) = cos;
        /// Tangent of an angle in radians.
        tan(x) = tan;
        /// Inverse sine, in [-pi/2, pi/2]; NaN outside [-1, 1].
        asin(x) = asin;
        /// Inverse cosine, in [0, pi]; NaN outside [-1, 1].
        acos(x) = acos;
        /// Inverse tangent, in (-pi/2, pi/2).
        atan(x) = atan;
        /// Angle of the point (x, y), in [-pi, pi].
        atan2(y, x) = atan2;
        /// e to the power x.
        exp(x) = exp;
        /// e to the power x, less 1, exact near 0.
        exp_m1(x) = expm1;
        /// Natural logarithm.
        ln(x) = log;
        /// Natural logarithm of 1 + x, exact near 0.
        ln_1p(x) = log1p;
        /// Logarithm to base 2.
        log2(x) = log2;
        /// Logarithm to base 10.
        log10(x) = log10;
        /// x to the power y.
        pow(x, y) = pow;
        /// Cube root.
        cbrt(x) = cbrt;
        /// Hyperbolic tangent.
        tanh(x) = tanh;
        /// Length of (x, y) without overflow.
        hypot(x, y) = hypot;
        /// The gamma function.
        gamma(x) = tgamma;
        /// Natural logarithm of the gamma function.
        ln_gamma(x) = lgamma;
        /// The error function.
        erf(x) = erf;
        /// The Bessel function of the first kind of order 0.
        bessel_j0(x) = j0;
        /// The Bessel function of the first kind of order 1.
        bessel_j1(x) = j1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finite_is_told_by_bits() {
        for x in [0.0, -0.0, 1.0, f32::MIN_POSITIVE, 1.0e-45, f32::MAX, f32::MIN] {
            assert!(ops_is_finite(x), "{x}");
        }
        for x in [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::from_bits(0x7f80_0001)] {
            assert!(!ops_is_finite(x), "{x}");
        }
    }

    #[test]
    fn functions_keep_their_bits() {
        // Recorded from libm 0.2: an update of the library that changes a bit fails here.
        let bits = [
            sin(1.0f32).to_bits(),
            exp(1.0f32).to_bits(),
            ln(3.0f32).to_bits(),
            pow(2.5f32, 0.3f32).to_bits(),
        ];
        assert_eq!(bits, [0x3f57_6aa4, 0x402d_f854, 0x3f8c_9f54, 0x3fa8_7f36], "{bits:08x?}");
    }
}
