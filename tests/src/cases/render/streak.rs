//! `shaders/wgsl/render/specimen_wobble.wgsl` and `specimen_streak.wgsl` against `downpour_specimen`.

use downpour_drop::DropShape;
use downpour_drop::oscillation::{Amplitudes, DropOscillation};
use downpour_math::rng::rng_unit;
use downpour_shaders::render::specimen;
use downpour_specimen::gpu::StreakUniform;
use downpour_specimen::streak::{
    SpecimenPassage, specimen_streak_offset, specimen_streak_passage, specimen_streak_shift,
    specimen_streak_state,
};
use downpour_specimen::trace::SpecimenRay;
use downpour_specimen::wobble::{
    SpecimenWobble, specimen_wobble_along, specimen_wobble_bounce, specimen_wobble_cross,
    specimen_wobble_enter, specimen_wobble_meet, specimen_wobble_span, specimen_wobble_surface,
};
use downpour_specimen::{SpecimenMotion, SpecimenOptions};

use super::specimen::{lamps, light, light_words, lit_picture, picture, ray, ray_of};
use crate::Domain::{AnyWord, Below, Fixed, Made, OneOf, Uniform};
use crate::words::{Args, IntoWords};
use crate::{FunctionCase, KernelCase, Tol};

/// A drop of 0.5 to 6 mm in an exposure of 0.001 to 0.02 s.
fn motion_of(random: u32) -> SpecimenMotion {
    let unit = |shift: u32| f64::from(rng_unit(random.rotate_left(shift)));
    let shape = DropShape::new(0.5e-3 + 5.5e-3 * unit(0)).expect("a diameter of the table");
    let options = SpecimenOptions {
        distance_m: 1.0,
        exposure_s: 1.0e-3 + 0.019 * unit(3),
        instants: 1 + random % 9,
        oscillation: Amplitudes::new(0.2 * unit(7), 0.12 * unit(11)).expect("small amplitudes"),
        phase: [unit(17), unit(23)],
        ..SpecimenOptions::default()
    };
    options.motion(&shape).expect("a motion").expect("not at rest")
}

/// As `SpecimenStreak`.
fn streak_words(random: u32) -> Vec<u32> {
    let uniform = StreakUniform::new(&motion_of(random), 0, 1);
    bytemuck::cast_slice(bytemuck::bytes_of(&uniform)).to_vec()
}

/// The word of `SpecimenStreak` that says how wide the spheroid around the drop is.
const INVERSE_WIDE: usize = 13;
/// The word of `SpecimenStreak` that says how far the drop moves during the exposure.
const FARTHEST: usize = 16;

/// The numbers of a motion as a shader has them.
struct Taken {
    oscillation: DropOscillation,
    volume: [f64; 5],
    motion: SpecimenMotion,
}

fn streak(args: &mut Args<'_>) -> Taken {
    let oscillation = DropOscillation {
        amplitude: args.f32s(),
        damping: args.f32s(),
        phase: args.f32s(),
        frequency: args.u32s(),
    };
    let volume = args.f32s::<5>().map(f64::from);
    let [inverse_wide, inverse_tall, speed, farthest] = args.f32s().map(f64::from);
    let [instants, _first, _count] = args.u32s();
    let any = motion_of(0);
    Taken {
        oscillation,
        volume,
        motion: SpecimenMotion { speed, farthest, instants, inverse_wide, inverse_tall, ..any },
    }
}

/// As `SpecimenWobble`: a drop at some instant of its exposure.
fn wobble_words(random: u32) -> Vec<u32> {
    let motion = motion_of(random);
    let state = motion.drop.at(f64::from(rng_unit(random.wrapping_mul(77))), 0.0).state();
    let coefficients = motion.drop.shape().coefficients();
    let numbers =
        [&coefficients[..], &[0.0], &state, &[1.333, motion.inverse_wide, motion.inverse_tall]].concat();
    numbers.into_iter().map(|n| (n as f32).to_bits()).collect()
}

fn wobble(args: &mut Args<'_>) -> SpecimenWobble<f32> {
    let coefficients = args.f32s::<12>();
    let state = args.f32s();
    let [index, inverse_wide, inverse_tall] = args.f32s().map(f64::from);
    SpecimenWobble {
        coefficients: std::array::from_fn(|n| f64::from(coefficients[n])),
        state,
        index,
        inverse_wide,
        inverse_tall,
    }
}

fn wobble_and_ray(random: [u32; 4], farthest: f32) -> Vec<u32> {
    let ray = ray_of(random, farthest);
    [wobble_words(random[2] ^ random[1]), ray_words(&ray)].concat()
}

fn ray_words(ray: &SpecimenRay<f32>) -> Vec<u32> {
    ((ray.foot, ray.reach), ray.direction).words()
}

/// A drop, and a line: its origin and direction.
fn wobble_and_line(random: [u32; 4]) -> Vec<u32> {
    let ray = ray_of(random, 1.0);
    [wobble_words(random[2] ^ random[1]), (ray.foot, ray.direction).words()].concat()
}

/// A drop, a line through it, and the part of it that the search for the entry is given.
fn wobble_and_part(random: [u32; 4]) -> Vec<u32> {
    let words = wobble_words(random[2] ^ random[1]);
    let ray = ray_of(random, 0.6);
    let [near, far] = specimen_wobble_span(&wobble(&mut Args::new(&words)), ray.foot, ray.direction);
    [words, ((ray.foot, ray.direction), (near, far)).words()].concat()
}

/// A drop, a line through it, and an interval several times as long as the drop.
fn wobble_and_long(random: [u32; 4]) -> Vec<u32> {
    let ray = ray_of(random, 0.9);
    let [a, b] = [9, 21].map(|k| 2.0 + 6.0 * rng_unit(random[0].rotate_left(k) ^ random[3]));
    [wobble_words(random[2] ^ random[1]), ((ray.foot, ray.direction), (-a, b)).words()].concat()
}

/// The same for a shape that oscillates too strongly for a drop.
fn hollow_and_long(random: [u32; 4]) -> Vec<u32> {
    let mut words = wobble_and_long(random);
    let [a, b, c] = [3, 11, 27].map(|k| rng_unit(random[1].rotate_left(k) ^ random[3]));
    words[12..15].copy_from_slice(&[0.8 * a - 0.4, 0.4 * b - 0.2, 0.9].map(f32::to_bits));
    let interval = words.len() - 2;
    words[interval..].copy_from_slice(&[-1.5 - c, 1.5 + a].map(f32::to_bits));
    words
}

/// A drop, a line from a point inside it, and how far it is followed.
fn wobble_from_inside(random: [u32; 4]) -> Vec<u32> {
    let ray = ray_of(random, INSIDE - 0.1);
    let [a, b] = [9, 21].map(|k| rng_unit(random[0].rotate_left(k) ^ random[3]));
    [wobble_words(random[2] ^ random[1]), ((ray.foot, ray.direction), (0.2 * a - 0.1, 2.0 + 6.0 * b)).words()]
        .concat()
}

fn cross(a: &mut Args<'_>) -> Vec<u32> {
    let (drop, origin, direction) = (wobble(a), a.f32s(), a.f32s());
    let [start, end, side] = a.f32s();
    let s = specimen_wobble_cross(&drop, origin, direction, start, end, side);
    s.map_or([end, 0.0], |s| [s, 1.0]).words()
}

/// Closer to the origin than any point of the surface: 0.42 radii, in a drop of 6 mm that is pressed flat.
const INSIDE: f32 = 0.35;

/// A drop, a ray that meets it, and where.
fn wobble_and_position(random: [u32; 4]) -> Vec<u32> {
    let words = wobble_words(random[2] ^ random[1]);
    let ray = ray_of(random, INSIDE);
    let s = specimen_wobble_meet(&wobble(&mut Args::new(&words)), &ray).expect("a ray through the drop");
    [words, (((ray.foot, ray.reach), ray.direction), s).words()].concat()
}

fn wobble_and_light(random: [u32; 4]) -> Vec<u32> {
    let words = wobble_words(random[2] ^ random[1]);
    let (drop, ray) = (wobble(&mut Args::new(&words)), ray_of(random, INSIDE));
    let s = specimen_wobble_meet(&drop, &ray).expect("a ray through the drop");
    [words, light_words(&specimen_wobble_enter(&drop, &ray, s))].concat()
}

/// A motion and a ray whose foot is up to eight radii away: most meet the path, few do so at all times.
fn streak_and_ray(random: [u32; 4]) -> Vec<u32> {
    [streak_words(random[2] ^ random[1]), ray_words(&ray_of(random, 8.0))].concat()
}

/// A drop that hardly moves during the exposure or not at all, and a ray close to it, or a level one at the rim of its spheroid.
fn still_and_ray(random: [u32; 4]) -> Vec<u32> {
    let mut words = streak_words(random[2] ^ random[1]);
    words[FARTHEST] = if random[0] & 1 == 0 { 0 } else { 0.005f32.to_bits() };
    let mut ray = ray_of(random, 1.5);
    if random[0] & 6 == 0 {
        let [x, z] = [ray.direction[0], ray.direction[2]];
        let level = 1.0 / (x * x + z * z).sqrt();
        let wide = f32::from_bits(words[INVERSE_WIDE]);
        let aside = level * ((1.0 - 0.02 * rng_unit(random[1])) / wide).sqrt();
        ray.foot = [-z * aside, 0.02 * rng_unit(random[3]) - 0.01, x * aside];
        ray.direction = [x * level, 0.0, z * level];
    }
    [words, ray_words(&ray)].concat()
}

/// As `SpecimenStreak`, with damping and with larger factors of the volume than a drop has.
fn damped_words(random: [u32; 4]) -> Vec<u32> {
    let mut words = streak_words(random[0]);
    words[2..4].copy_from_slice(&[30.0f32, 20.0].map(f32::to_bits));
    words[8..13].copy_from_slice(&[0.5f32, 1.0, 4.0, 1.5, 2.0].map(f32::to_bits));
    words
}

fn passage_words(passage: &SpecimenPassage<f32>) -> Vec<u32> {
    let passage = *passage;
    ((((passage.foot, passage.middle), passage.first), passage.last), passage.cover).words()
}

fn ray_passage_fall(random: [u32; 4]) -> Vec<u32> {
    let ray = ray_of(random, 8.0);
    let passage = specimen_streak_passage(&motion_of(random[2]), &ray);
    let u = passage.middle + 2.0 * rng_unit(random[0]) - 1.0;
    [ray_words(&ray), passage_words(&passage), u.words()].concat()
}

const SURFACE: Tol = Tol::relative(
    1.0e-5,
    4.0e-6,
    "two recurrences of eleven terms, and divisions (2.5 ulp) by numbers near 1",
);
const MEETS: Tol = Tol::absolute(
    2.0e-5,
    "a point of the surface, known to 1e-6; a ray that grazes the drop may fall on either side of it",
)
.with_outliers(2.0e-3);
const MEETS_LONG: Tol =
    Tol::absolute(6.0e-6, "the same; so few rays graze that more would be a fault").with_outliers(2.0e-4);
const NEXT: Tol = Tol::absolute(
    1.0e-4,
    "the same for the next interface; refraction multiplies the errors close to the critical angle",
)
.with_outliers(2.0e-3);
const PASSAGE: Tol = Tol::relative(
    2.0e-4,
    2.0e-4,
    "quotients by the squared sine of the angle to the vertical, as small as 1e-4 here; close to the rim of the spheroid the \
     root of a difference",
)
.with_outliers(5.0e-3);

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let wobbles = &specimen::SPECIMEN_WOBBLE;
    let streaks = &specimen::SPECIMEN_STREAK;
    vec![
        FunctionCase::new(
            "specimen_wobble_surface",
            wobbles,
            &[Made(|r| {
                let ray = ray_of(r, 1.2);
                [wobble_words(r[2] ^ r[1]), ray.foot.words()].concat()
            })],
            SURFACE,
            |a| {
                let surface = specimen_wobble_surface(&wobble(a), a.f32s());
                (surface.half_gradient, surface.excess).words()
            },
        ),
        FunctionCase::new(
            "specimen_wobble_along",
            wobbles,
            &[Made(wobble_and_line), Uniform(-1.5, 1.5)],
            SURFACE,
            |a| {
                let (drop, origin, direction) = (wobble(a), a.f32s(), a.f32s());
                specimen_wobble_along(&drop, origin, direction, a.f32()).words()
            },
        ),
        FunctionCase::new(
            "specimen_wobble_span",
            wobbles,
            &[Made(wobble_and_line)],
            Tol::absolute(2.0e-5, "the root of a difference of products"),
            |a| specimen_wobble_span(&wobble(a), a.f32s(), a.f32s()).words(),
        ),
        FunctionCase::new(
            "specimen_wobble_cross",
            wobbles,
            &[Made(wobble_and_part), Fixed(-1.0)],
            MEETS,
            cross,
        ),
        // Intervals several times as long as the drop: it may be within a part of them, and is found by where G turns.
        FunctionCase::new(
            "specimen_wobble_cross",
            wobbles,
            &[Made(wobble_and_long), Fixed(-1.0)],
            MEETS_LONG,
            cross,
        ),
        // Shapes with hollows, which no drop has: a line meets some of them twice.
        FunctionCase::new(
            "specimen_wobble_cross",
            wobbles,
            &[Made(hollow_and_long), Fixed(-1.0)],
            MEETS_LONG,
            cross,
        ),
        // From inside the drop to far outside.
        FunctionCase::new(
            "specimen_wobble_cross",
            wobbles,
            &[Made(wobble_from_inside), Fixed(1.0)],
            MEETS_LONG,
            cross,
        ),
        FunctionCase::new("specimen_wobble_meet", wobbles, &[Made(|r| wobble_and_ray(r, 1.3))], MEETS, |a| {
            let (drop, ray) = (wobble(a), ray(a));
            let Some(s) = specimen_wobble_meet(&drop, &ray) else {
                // What the shader gives with a miss: the end of the line, if it meets the spheroid.
                let [near, far] = specimen_wobble_span(&drop, ray.foot, ray.direction);
                return [if near.max(-ray.reach) < far { far } else { 0.0 }, 0.0].words();
            };
            [s, 1.0].words()
        }),
        FunctionCase::new("specimen_wobble_enter", wobbles, &[Made(wobble_and_position)], MEETS, |a| {
            let (drop, ray) = (wobble(a), ray(a));
            light_words(&specimen_wobble_enter(&drop, &ray, a.f32()))
        }),
        FunctionCase::new(
            "specimen_wobble_bounce",
            wobbles,
            &[Made(wobble_and_light), OneOf(&[1.0e-4, 2.0])],
            NEXT,
            |a| light_words(&specimen_wobble_bounce(&wobble(a), &light(a), a.f32())),
        ),
        FunctionCase::new("specimen_streak_passage", streaks, &[Made(streak_and_ray)], PASSAGE, |a| {
            passage_words(&specimen_streak_passage(&streak(a).motion, &ray(a)))
        }),
        // A drop at rest: the ray meets it all the time or never.
        FunctionCase::new("specimen_streak_passage", streaks, &[Made(still_and_ray)], PASSAGE, |a| {
            passage_words(&specimen_streak_passage(&streak(a).motion, &ray(a)))
        }),
        FunctionCase::new(
            "specimen_streak_shift",
            streaks,
            &[Made(ray_passage_fall)],
            Tol::relative(4.0e-6, 4.0e-6, "sums of a few products"),
            |a| {
                let ray = ray(a);
                let foot = a.f32s();
                let [middle, first, last, cover] = a.f32s();
                let passage = SpecimenPassage { foot, middle, first, last, cover };
                ray_words(&specimen_streak_shift(&ray, &passage, a.f32()))
            },
        ),
        FunctionCase::new(
            "specimen_streak_state",
            streaks,
            &[Made(|r| streak_words(r[0])), Uniform(-0.01, 0.01)],
            Tol::absolute(2.0e-4, "WGSL's sine is within 2^-11 of an amplitude of 0.3"),
            |a| {
                let taken = streak(a);
                specimen_streak_state(taken.oscillation, taken.volume, a.f32()).words()
            },
        ),
        FunctionCase::new(
            "specimen_streak_state",
            streaks,
            &[Made(damped_words), Uniform(-0.01, 0.01)],
            Tol::absolute(2.0e-4, "WGSL's sine is within 2^-11 of an amplitude of 0.3"),
            |a| {
                let taken = streak(a);
                specimen_streak_state(taken.oscillation, taken.volume, a.f32()).words()
            },
        ),
        FunctionCase::new(
            "specimen_streak_offset",
            streaks,
            &[AnyWord, Below(256)],
            Tol::exact("integers, and their exact conversion"),
            |a| specimen_streak_offset(a.u32(), a.u32()).words(),
        ),
    ]
}

fn options(exposure_s: f64, pitch: f64) -> SpecimenOptions {
    SpecimenOptions {
        size: [24, 60],
        samples: 2,
        pitch,
        yaw: 0.4,
        exposure_s,
        instants: 5,
        oscillation: Amplitudes::GARG_NAYAR_OBLATE,
        phase: [0.2, 0.3],
        ..SpecimenOptions::default()
    }
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    let tol = Tol::absolute(
        1.0e-3,
        "as a drop at rest, with the sine of WGSL in its shape; where the drop is nearly hollow, light may take another way",
    )
    .with_outliers(2.0e-2);
    let case = |name, run| KernelCase {
        name,
        kernel: &specimen::SPECIMEN_STREAK_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol,
        run,
    };
    vec![
        case("main_specimen_streak: 3 mm in 1/500 s", |gpu| picture(gpu, 3.0e-3, &options(0.002, 0.0))),
        case("main_specimen_streak: 2 mm in 1/250 s from above, with dispersion", |gpu| {
            let refractive_index = [1.3312, 1.3345, 1.3392];
            picture(gpu, 2.0e-3, &SpecimenOptions { refractive_index, ..options(0.004, 0.5) })
        }),
        case("main_specimen_streak: 3 mm before lamps", |gpu| {
            lit_picture(gpu, 3.0e-3, &options(0.001, 0.1), &lamps())
        }),
        case("main_specimen_streak: 4 mm, an instant", |gpu| picture(gpu, 4.0e-3, &options(0.0, -0.3))),
    ]
}
