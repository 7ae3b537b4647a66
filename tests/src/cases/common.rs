//! `shaders/wgsl/common` against `downpour-math`.

use downpour_math::{ops, packing, rng};
use downpour_shaders::common;

use crate::Domain::{AnyWord, Made, Uniform};
use crate::words::IntoWords as _;
use crate::{FunctionCase, Tol};

const INTEGERS: Tol = Tol::exact("integers are exact");
const SCALED: Tol = Tol::exact("an integer below 2^24 converts, and a power of two multiplies, exactly");

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let words4 = [AnyWord; 4];
    vec![
        FunctionCase::new(
            "ops_is_finite",
            &common::OPS,
            &[Made(|r| {
                // Every exponent, both signs, mantissas with and without bits.
                vec![
                    (r[0] << 31) | ((r[1] & 0xff) << 23) | if r[2] & 1 == 0 { 0 } else { r[3] & 0x007f_ffff },
                ]
            })],
            INTEGERS,
            |a| ops::ops_is_finite(a.f32()).words(),
        ),
        FunctionCase::new("rng_pcg4d_stir", &common::RNG, &words4, INTEGERS, |a| {
            rng::rng_pcg4d_stir(a.u32s()).words()
        }),
        FunctionCase::new("rng_pcg4d", &common::RNG, &words4, INTEGERS, |a| rng::rng_pcg4d(a.u32s()).words()),
        FunctionCase::new("rng_draw", &common::RNG, &[AnyWord; 5], INTEGERS, |a| {
            rng::rng_draw(a.u32s(), a.u32(), a.u32(), a.u32()).words()
        }),
        FunctionCase::new("rng_unit", &common::RNG, &[AnyWord], SCALED, |a| rng::rng_unit(a.u32()).words()),
        FunctionCase::new("rng_unit_positive", &common::RNG, &[AnyWord], SCALED, |a| {
            rng::rng_unit_positive(a.u32()).words()
        }),
        FunctionCase::new(
            "packing_sign",
            &common::PACKING,
            &[Uniform(-2.0, 2.0)],
            Tol::exact("a comparison"),
            |a| packing::packing_sign(a.f32()).words(),
        ),
        FunctionCase::new(
            "packing_octahedral_encode",
            &common::PACKING,
            &[Uniform(-1.0, 1.0), Uniform(-1.0, 1.0), Uniform(-1.0, 1.0)],
            Tol::relative(1.0e-6, 5.0e-7, "a division (2.5 ulp), sums and products of numbers up to 1"),
            |a| packing::packing_octahedral_encode(a.f32s()).words(),
        ),
        FunctionCase::new(
            "packing_octahedral_decode",
            &common::PACKING,
            &[Uniform(-1.0, 1.0), Uniform(-1.0, 1.0)],
            Tol::relative(
                2.0e-6,
                1.0e-6,
                "an inverse square root (2 ulp + division 2.5 ulp) of a sum that is at least 1/3",
            ),
            |a| packing::packing_octahedral_decode(a.f32s()).words(),
        ),
    ]
}
