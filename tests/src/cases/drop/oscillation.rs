//! `drop/oscillation.wgsl` against `downpour_drop::oscillation`.

use downpour_drop::oscillation::{
    Amplitudes, DropOscillation, DropOscillationTime, Fluids, FrequencyLaw, Oscillation,
    drop_oscillation_angular_frequency, drop_oscillation_azimuth, drop_oscillation_damping_time,
    drop_oscillation_displacement, drop_oscillation_frequency, drop_oscillation_inverse_cube_root,
    drop_oscillation_legendre_20, drop_oscillation_legendre_31, drop_oscillation_outline,
    drop_oscillation_phase, drop_oscillation_radius, drop_oscillation_sine, drop_oscillation_state,
    drop_oscillation_state_rousseau_2008, drop_oscillation_turns, drop_oscillation_volume,
};
use downpour_math::ops;
use downpour_shaders::drop::oscillation::OSCILLATION;

use crate::Domain::{AnyWord, Below, LogUniform, Made, Uniform};
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, Tol};

/// The oscillation of a drop of 0.5 to 8 mm, damped or not.
fn oscillation(random: [u32; 4]) -> Vec<u32> {
    let unit = |word: u32| f64::from(word) / 4_294_967_296.0;
    let amplitudes = Amplitudes::new(0.3 * unit(random[1]), 0.3 * unit(random[1].wrapping_mul(77)));
    let diameter = 0.5e-3 * ops::f64::pow(16.0, unit(random[0]));
    let made = Oscillation::new(
        diameter,
        amplitudes.expect("amplitudes up to 0.3"),
        &Fluids::AT_20_C,
        FrequencyLaw::Rayleigh1879,
    );
    let made = made.expect("a diameter up to 8 mm").with_phases([unit(random[2]), unit(random[3])]);
    let gpu = if random[0] & 1 == 0 { made.gpu() } else { made.damped().gpu() };
    let numbers = [gpu.amplitude, gpu.damping, gpu.phase].concat();
    numbers.into_iter().map(f32::to_bits).chain(gpu.frequency).collect()
}

fn taken(args: &mut Args<'_>) -> DropOscillation {
    DropOscillation {
        amplitude: args.f32s(),
        damping: args.f32s(),
        phase: args.f32s(),
        frequency: args.u32s(),
    }
}

fn time(args: &mut Args<'_>) -> DropOscillationTime {
    DropOscillationTime { ticks: args.u32(), offset: args.f32() }
}

const WORDS: Tol = Tol::exact("integers, and their exact conversion");
const POLYNOMIAL: Tol =
    Tol::absolute(1.0e-6, "a short polynomial of numbers up to 1; a GPU may fuse its products");
const CONTROL: Tol = Tol::relative(2.0e-6, 1.0e-12, "products, a division and a square root (2.5 ulp each)");

pub(super) fn functions() -> Vec<FunctionCase> {
    let case =
        |function, domains: &[_], tol, cpu| FunctionCase::new(function, &OSCILLATION, domains, tol, cpu);
    let x = Uniform(-1.0, 1.0);
    let inner = Uniform(-0.999, 0.999);
    let displaced = Uniform(-0.3, 0.3);
    let scale = Uniform(0.9, 1.0);
    let radius = LogUniform(2.5e-5, 4.5e-3);
    let root =
        Tol::absolute(2.0e-3, "the root of 1 - x^2 at the poles, where a fused product leaves 1e-8 of 0");
    vec![
        case("drop_oscillation_legendre_20", &[x], POLYNOMIAL, |a| {
            drop_oscillation_legendre_20(a.f32()).words()
        }),
        case("drop_oscillation_legendre_31", &[x], root, |a| drop_oscillation_legendre_31(a.f32()).words()),
        case(
            "drop_oscillation_angular_frequency",
            &[Below(20), radius, Uniform(0.06, 0.08), Uniform(990.0, 1001.0)],
            CONTROL,
            |a| drop_oscillation_angular_frequency(a.u32(), a.f32(), a.f32(), a.f32()).words(),
        ),
        case(
            "drop_oscillation_damping_time",
            &[Made(|r| vec![2 + r[0] % 18]), radius, Uniform(0.8e-6, 1.8e-6)],
            CONTROL,
            |a| drop_oscillation_damping_time(a.u32(), a.f32(), a.f32()).words(),
        ),
        case("drop_oscillation_frequency", &[LogUniform(10.0, 1.0e6)], WORDS, |a| {
            drop_oscillation_frequency(a.f32()).words()
        }),
        case("drop_oscillation_phase", &[AnyWord; 3], WORDS, |a| {
            drop_oscillation_phase(a.u32s(), a.u32()).words()
        }),
        case("drop_oscillation_azimuth", &[AnyWord; 3], WORDS, |a| {
            drop_oscillation_azimuth(a.u32s(), a.u32()).words()
        }),
        case(
            "drop_oscillation_turns",
            &[AnyWord, Uniform(0.0, 1.0), AnyWord, Uniform(0.0, 0.02)],
            Tol::relative(
                5.0e-7,
                1.0e-7,
                "an exact number of ticks, then two sums; a GPU may fuse a product",
            ),
            |a| drop_oscillation_turns(a.u32(), a.f32(), time(a)).words(),
        ),
        case(
            "drop_oscillation_sine",
            &[Uniform(-2.0, 3.0)],
            Tol::absolute(5.0e-4, "WGSL promises 2^-11 for the sine in [-pi, pi]"),
            |a| drop_oscillation_sine(a.f32()).words(),
        ),
        // So many turns that an f32 holds no angle to the tolerance if they are not taken off first.
        case(
            "drop_oscillation_sine",
            &[Uniform(-60_000.0, 60_000.0)],
            Tol::absolute(5.0e-4, "WGSL promises 2^-11 for the sine in [-pi, pi]"),
            |a| drop_oscillation_sine(a.f32()).words(),
        ),
        case(
            "drop_oscillation_displacement",
            &[Made(oscillation), AnyWord, Uniform(0.0, 0.02), Uniform(-0.1, 1.0)],
            Tol::absolute(2.0e-4, "the sine above (2^-11) times an amplitude up to 0.3"),
            |a| drop_oscillation_displacement(taken(a), time(a), a.f32()).words(),
        ),
        case("drop_oscillation_volume", &[displaced, displaced], POLYNOMIAL, |a| {
            drop_oscillation_volume(a.f32s()).words()
        }),
        case(
            "drop_oscillation_inverse_cube_root",
            &[Uniform(1.0, 1.4)],
            Tol::absolute(1.0e-6, "five Newton steps of numbers near 1"),
            |a| drop_oscillation_inverse_cube_root(a.f32()).words(),
        ),
        // Beyond its range the steps do not settle: what one of them does wrong stays in the result.
        case(
            "drop_oscillation_inverse_cube_root",
            &[Uniform(1.4, 3.9)],
            Tol::relative(2.0e-6, 1.0e-6, "five Newton steps of factors up to 4/3, sums a GPU may fuse"),
            |a| drop_oscillation_inverse_cube_root(a.f32()).words(),
        ),
        case("drop_oscillation_state", &[displaced, displaced], POLYNOMIAL, |a| {
            drop_oscillation_state(a.f32s()).words()
        }),
        case(
            "drop_oscillation_state_rousseau_2008",
            &[displaced, displaced],
            Tol::exact("the arguments and a 1"),
            |a| drop_oscillation_state_rousseau_2008(a.f32s()).words(),
        ),
        case("drop_oscillation_radius", &[displaced, displaced, scale, inner, x], POLYNOMIAL, |a| {
            drop_oscillation_radius(a.f32s(), a.f32(), a.f32()).words()
        }),
        case("drop_oscillation_outline", &[displaced, displaced, scale, x], POLYNOMIAL, |a| {
            drop_oscillation_outline(a.f32s(), a.f32()).words()
        }),
    ]
}
