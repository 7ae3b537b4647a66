//! `drop/fall_speed.wgsl` against `downpour_drop::fall_speed`.

use downpour_drop::air::Air;
use downpour_drop::fall_speed::{
    FallSpeedAir, fall_speed_atlas_1973, fall_speed_atlas_ulbrich_1977, fall_speed_beard_1976,
    fall_speed_beard_flattened, fall_speed_beard_sphere, fall_speed_brandes_2002,
    fall_speed_gunn_kinzer_1949, fall_speed_lhermitte_1988, fall_speed_relaxation, fall_speed_rousseau_2006,
    fall_speed_terminal, fall_speed_van_dijk_2002,
};
use downpour_math::rng::rng_unit;
use downpour_shaders::drop::fall_speed::FALL_SPEED;

use crate::Domain::{Below, LogUniform, Made, Or, Uniform};
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, Tol};

/// Air of -20 to 40 C and 300 to 1100 hPa.
fn air_words(random: [u32; 4]) -> Vec<u32> {
    let temperature = -20.0 + 60.0 * f64::from(rng_unit(random[0]));
    let pressure = 30_000.0 + 80_000.0 * f64::from(rng_unit(random[1]));
    let air = Air::new(temperature, pressure).expect("air of the accepted range");
    bytemuck::cast::<FallSpeedAir, [u32; 8]>(FallSpeedAir::new(&air)).to_vec()
}

fn air(args: &mut Args<'_>) -> FallSpeedAir {
    bytemuck::cast(args.u32s::<8>())
}

const BEARD: Tol = Tol::relative(2.0e-5, 1.0e-6, "exp and ln of numbers up to 12 (3 + 2|x| ulp)");
const TABLE: Tol = Tol::relative(2.0e-6, 1.0e-15, "one interpolation; a GPU may fuse its products");
const FIT: Tol =
    Tol::absolute(1.0e-5, "an exp or a polynomial of terms up to 40, whose sum is a speed up to 10");

pub(super) fn functions() -> Vec<FunctionCase> {
    let case =
        |function, domains: &[_], tol, cpu| FunctionCase::new(function, &FALL_SPEED, domains, tol, cpu);
    let (d, air_made) = (LogUniform(5.0e-6, 9.0e-3), Made(air_words));
    // None, and the first nodes of the tables.
    let at_nodes = Or(&LogUniform(5.0e-6, 9.0e-3), &[0.0, 1.0e-8, 7.8e-5, 2.0e-4]);
    // The ends of the first two regimes.
    let at_regimes = Or(&LogUniform(5.0e-6, 9.0e-3), &[1.9e-5, 1.07e-3]);
    vec![
        case("fall_speed_beard_1976", &[at_regimes, air_made], BEARD, |a| {
            fall_speed_beard_1976(a.f32(), air(a)).words()
        }),
        case("fall_speed_beard_sphere", &[Uniform(0.019, 1.07), air_made], BEARD, |a| {
            fall_speed_beard_sphere(a.f32(), air(a)).words()
        }),
        case("fall_speed_beard_flattened", &[Uniform(1.07, 7.0), air_made], BEARD, |a| {
            fall_speed_beard_flattened(a.f32(), air(a)).words()
        }),
        case("fall_speed_gunn_kinzer_1949", &[at_nodes, air_made], TABLE, |a| {
            fall_speed_gunn_kinzer_1949(a.f32(), air(a)).words()
        }),
        case("fall_speed_rousseau_2006", &[at_nodes, air_made], TABLE, |a| {
            fall_speed_rousseau_2006(a.f32(), air(a)).words()
        }),
        case("fall_speed_atlas_1973", &[d, air_made], FIT, |a| {
            fall_speed_atlas_1973(a.f32(), air(a)).words()
        }),
        case("fall_speed_lhermitte_1988", &[d, air_made], FIT, |a| {
            fall_speed_lhermitte_1988(a.f32(), air(a)).words()
        }),
        case(
            "fall_speed_atlas_ulbrich_1977",
            &[d, air_made],
            Tol::relative(1.0e-5, 1.0e-7, "a power: exp2(y log2(x))"),
            |a| fall_speed_atlas_ulbrich_1977(a.f32(), air(a)).words(),
        ),
        case("fall_speed_brandes_2002", &[d, air_made], FIT, |a| {
            fall_speed_brandes_2002(a.f32(), air(a)).words()
        }),
        case("fall_speed_van_dijk_2002", &[d, air_made], FIT, |a| {
            fall_speed_van_dijk_2002(a.f32(), air(a)).words()
        }),
        case(
            "fall_speed_terminal",
            &[Below(9), d, air_made],
            Tol::relative(2.0e-5, 1.0e-5, "the widest of the models above"),
            |a| fall_speed_terminal(a.u32(), a.f32(), air(a)).words(),
        ),
        case(
            "fall_speed_relaxation",
            &[Uniform(0.0, 20.0)],
            Tol::relative(5.0e-7, 0.0, "a division (2.5 ulp)"),
            |a| fall_speed_relaxation(a.f32()).words(),
        ),
    ]
}
