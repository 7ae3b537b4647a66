//! `drop/distribution.wgsl` against `downpour_drop::distribution`.

use downpour_drop::distribution::{
    distribution_lerp, distribution_probability, distribution_sample_exponential, distribution_table_position,
};
use downpour_shaders::drop::distribution::DISTRIBUTION;

use crate::Domain::{AnyWord, Uniform};
use crate::words::IntoWords as _;
use crate::{FunctionCase, Tol};

pub(super) fn functions() -> Vec<FunctionCase> {
    let case =
        |function, domains: &[_], tol, cpu| FunctionCase::new(function, &DISTRIBUTION, domains, tol, cpu);
    vec![
        case(
            "distribution_table_position",
            &[AnyWord],
            Tol::exact("integers, and their exact conversion"),
            |a| {
                let position = distribution_table_position(a.u32());
                (position.index, position.fraction).words()
            },
        ),
        case("distribution_probability", &[AnyWord], Tol::exact("an integer scaled by powers of two"), |a| {
            distribution_probability(a.u32()).words()
        }),
        case(
            "distribution_lerp",
            &[Uniform(0.0, 8.0e-3), Uniform(0.0, 8.0e-3), Uniform(0.0, 1.0)],
            Tol::absolute(2.0e-9, "a product and a sum of diameters up to 8e-3, which a GPU may fuse"),
            |a| distribution_lerp(a.f32(), a.f32(), a.f32()).words(),
        ),
        case(
            "distribution_sample_exponential",
            &[AnyWord, Uniform(1.0e3, 7.0e3), Uniform(1.0e-4, 1.0e-3), Uniform(4.0e-3, 8.0e-3)],
            Tol::relative(1.0e-5, 1.0e-9, "an exp and a ln of numbers up to 56 (3 + 2|x| ulp)"),
            |a| distribution_sample_exponential(a.u32(), a.f32(), a.f32(), a.f32()).words(),
        ),
    ]
}
