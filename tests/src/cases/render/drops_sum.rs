//! The functions of `shaders/wgsl/render/{drops,drops_sum}.wgsl` that need no picture, against `downpour_render::rain`.

use downpour_render::rain::ScreenDrop;
use downpour_render::rain::drops::{drops_sums_distance, drops_sums_shown, drops_tile};
use downpour_render::rain::drops_sum::{
    drops_sum_across, drops_sum_depth, drops_sum_is_plumb, drops_sum_lines, drops_sum_pack, drops_sum_scale,
    drops_sum_share, drops_sum_width,
};
use downpour_render::rain::streak::{streak_is_summed, streak_pixels};
use downpour_shaders::render::rain::{DROPS, DROPS_SUM, STREAK};
use glam::Vec4;

use super::tiles::{DROP_WORDS, drop_words, pair};
use crate::Domain::{Below, Made, OneOf, Uniform};
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, Tol};

/// Bits of a number that is not below 0, of any size.
fn bits(random: [u32; 4]) -> Vec<u32> {
    vec![[random[0] % 0x7f00_0000, 0, random[0] & 0x7f80_0000 & 0x7eff_ffff][random[1] as usize % 3]]
}

/// What streaks show together: colors of any size, a coverage, a distance, and that of the scene.
fn shown(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random;
    let color = |word: u32| 0x3000_0000 + word % 0x2000_0000;
    let part = |word: u32| (word as f32 / 4_294_967_296.0).to_bits();
    vec![color(a), color(b), if d % 8 == 0 { 0 } else { color(c) }, part(d), color(a ^ d), color(b ^ d)]
}

fn drop(a: &mut Args<'_>) -> ScreenDrop {
    bytemuck::cast(a.u32s::<DROP_WORDS>())
}

/// The same as a pixel has it.
fn shown_words(random: [u32; 4]) -> Vec<u32> {
    let [red, green, blue, cover, distance, scene] =
        <[u32; 6]>::try_from(shown(random)).expect("six words").map(f32::from_bits);
    drops_sum_pack(Vec4::new(red, green, blue, cover), distance, scene).to_vec()
}

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let exact = Tol::exact("sums, products and quotients without rounding");
    let series = Tol::relative(2.0e-5, 0.0, "a series of four terms, or a logarithm of at least 0.1");
    let count = || Made(|random| vec![1 + random[0] % 320]);
    vec![
        FunctionCase::new(
            "streak_pixels",
            &STREAK,
            &[OneOf(&[-9.0, -1.0, -0.25, 0.0, 0.5, 7.0, 90.75, 91.0, 300.0]), Uniform(-3.0, 200.0), count()],
            exact,
            |a| pair(streak_pixels(a.f32(), a.f32(), a.u32())),
        ),
        FunctionCase::new("streak_is_summed", &STREAK, &[Made(drop_words)], exact, |a| {
            streak_is_summed(&drop(a)).words()
        }),
        FunctionCase::new("drops_sum_depth", &DROPS_SUM, &[Uniform(0.0, 1.0)], series, |a| {
            drops_sum_depth(a.f32()).words()
        }),
        FunctionCase::new("drops_sum_depth", &DROPS_SUM, &[Uniform(0.0, 0.12)], series, |a| {
            drops_sum_depth(a.f32()).words()
        }),
        FunctionCase::new("drops_sum_share", &DROPS_SUM, &[Uniform(0.0, 7.0)], series, |a| {
            drops_sum_share(a.f32()).words()
        }),
        FunctionCase::new("drops_sum_share", &DROPS_SUM, &[Uniform(0.0, 0.12)], series, |a| {
            drops_sum_share(a.f32()).words()
        }),
        FunctionCase::new("drops_sum_scale", &DROPS_SUM, &[Made(bits)], exact, |a| {
            drops_sum_scale(a.u32()).words()
        }),
        FunctionCase::new(
            "drops_sum_across",
            &DROPS_SUM,
            &[Made(drop_words), Below(2), Below(230), count()],
            exact,
            |a| pair(drops_sum_across(&drop(a), a.u32() == 1, a.u32(), a.u32())),
        ),
        FunctionCase::new(
            "drops_sum_lines",
            &DROPS_SUM,
            &[Made(drop_words), Below(2), count()],
            exact,
            |a| pair(drops_sum_lines(&drop(a), a.u32() == 1, a.u32())),
        ),
        FunctionCase::new("drops_sum_width", &DROPS_SUM, &[Made(drop_words), Below(2)], exact, |a| {
            drops_sum_width(&drop(a), a.u32() == 1).words()
        }),
        FunctionCase::new("drops_sum_is_plumb", &DROPS_SUM, &[Made(drop_words)], exact, |a| {
            drops_sum_is_plumb(&drop(a)).words()
        }),
        FunctionCase::new("drops_sum_pack", &DROPS_SUM, &[Made(shown)], exact, |a| {
            drops_sum_pack(Vec4::from_array(a.f32s()), a.f32(), a.f32()).words()
        }),
        FunctionCase::new(
            "drops_sums_shown",
            &DROPS,
            &[Made(shown_words)],
            Tol::relative(4.0e-7, 0.0, "bits of three numbers, and a quotient (2.5 ulp)"),
            |a| drops_sums_shown(a.u32s()).to_array().words(),
        ),
        FunctionCase::new("drops_sums_distance", &DROPS, &[Made(shown_words)], exact, |a| {
            drops_sums_distance(a.u32s()).words()
        }),
        FunctionCase::new(
            "drops_tile",
            &DROPS,
            &[Below(300), Below(200), Made(|r| vec![8 << (r[0] % 5)]), Made(|r| vec![1 + r[0] % 3000])],
            exact,
            |a| drops_tile(a.u32s(), a.u32(), a.u32()).words(),
        ),
    ]
}
