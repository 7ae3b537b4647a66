//! `shaders/wgsl/render/glazing.wgsl` against `downpour_trace::glazing`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_pcg4d, rng_unit};
use downpour_shaders::render::glazing::GLAZING;
use downpour_shaders::render::scene::{SCENE_NONE, TRACE_KERNEL};
use downpour_trace::SceneWetness;
use downpour_trace::glazing::{
    GlazingDrop, GlazingLane, GlazingPane, GlazingPlace, GlazingWater, RenderGlazing, glazing_age,
    glazing_cap, glazing_down, glazing_drop, glazing_facing, glazing_higher, glazing_holds, glazing_lane,
    glazing_place, glazing_run, glazing_runner, glazing_still, glazing_through, glazing_track,
    glazing_wander, glazing_water, pane_rows,
};
use downpour_weather::WetnessAt;
use glam::{Vec2, Vec3};

use super::scene::{Parts, PictureRays, picture_by, scene};
use crate::Domain::{AnyWord, Below, Fixed, Made, OneOf, Or, Uniform, Unit3};
use crate::function::Run;
use crate::words::{Args, IntoWords as _};
use crate::{Domain, FunctionCase, KernelCase, Tol};

fn vec3(args: &mut Args<'_>) -> Vec3 {
    Vec3::from(args.f32s())
}

fn vec2(args: &mut Args<'_>) -> Vec2 {
    Vec2::from(args.f32s())
}

/// A place on a pane: at, across, down, met, since, rate, kept.
const PLACE: [Domain; 8] = [
    Uniform(-0.4, 0.4),
    Uniform(0.0, 2.0),
    Unit3,
    Unit3,
    Uniform(0.0, 0.4),
    Uniform(0.0, 0.1),
    Uniform(0.002, 0.01),
    Uniform(0.2, 1.0),
];

/// A pane of few materials, as large as [`PLACE`] is far.
const PANE: [Domain; 10] = [
    Below(3),
    Uniform(1.0, 3.0),
    Uniform(0.001, 0.004),
    AnyWord,
    Uniform(-0.2, 0.2),
    Uniform(-0.2, 0.2),
    Uniform(-0.2, 0.2),
    OneOf(&[0.0, 0.005, 0.5, 1.0]),
    Unit3,
    Uniform(0.1, 1.0),
];

/// The beginning of [`PANE`] with heads of runs of centimeters, so that places are under them.
const HUGE: [Domain; 3] = [Below(3), Uniform(1.0, 3.0), Uniform(0.004, 0.05)];

const PANE_END: [Domain; 2] = [Unit3, Uniform(0.05, 0.5)];

fn domains(parts: &[&[Domain]]) -> Vec<Domain> {
    parts.concat()
}

fn place(a: &mut Args<'_>) -> GlazingPlace {
    GlazingPlace {
        at: vec2(a),
        across: vec3(a),
        down: vec3(a),
        met: a.f32(),
        since: a.f32(),
        rate: a.f32(),
        kept: a.f32(),
    }
}

fn pane(a: &mut Args<'_>) -> GlazingPane {
    GlazingPane {
        material: a.u32(),
        height: a.f32(),
        largest: a.f32(),
        seed: a.u32(),
        center: vec3(a),
        half_width: a.f32(),
        across: vec3(a),
        half_height: a.f32(),
        outward: vec3(a),
        half_thickness: a.f32(),
    }
}

fn drop(a: &mut Args<'_>) -> GlazingDrop {
    GlazingDrop { offset: vec2(a), radius: a.f32(), stretch: a.f32() }
}

fn of_drop(drop: GlazingDrop) -> Vec<u32> {
    [drop.offset.x, drop.offset.y, drop.radius, drop.stretch].words()
}

const DROP: Tol = Tol::absolute(
    5.0e-5,
    "a number of runs of up to 300 (0.5 ulp each in 4 steps), times the way of a run; a drop's edge may fall on either side",
)
.with_outliers(4.0e-3);

fn runner(a: &mut Args<'_>) -> Vec<u32> {
    let place = place(a);
    of_drop(glazing_runner(&place, &pane(a)))
}

fn through(a: &mut Args<'_>) -> Vec<u32> {
    let (along, normal) = (vec3(a), vec3(a));
    glazing_through(along, normal, vec3(a)).to_array().words()
}

/// A ray, a normal, and a facet that is not far from it.
fn tilted(random: [u32; 4]) -> Vec<u32> {
    let other = rng_pcg4d(random);
    let more = rng_pcg4d(other);
    let unit = |words: [u32; 3]| {
        let v = Vec3::from_array(words.map(|word| 2.0 * rng_unit(word) - 1.0));
        v.try_normalize().unwrap_or(Vec3::Y)
    };
    let facet = unit([random[0], random[1], random[2]]);
    let aside = unit([other[0], other[1], other[2]]);
    let normal = (facet + aside * (0.85 * rng_unit(random[3]))).normalize();
    let along = unit([more[0], more[1], more[2]]);
    [along, normal, facet].iter().flat_map(|v| v.to_array().map(f32::to_bits)).collect()
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let fraction = Uniform(0.0, 1.0);
    let near = Uniform(-0.004, 0.004);
    let radius = Uniform(0.0, 0.004);
    let exact = Tol::exact("integers, and products with powers of 2");
    let of_place = [&PLACE[..], &PANE[..], &PANE_END[..]];
    let all = domains(&of_place);
    let with_at = domains(&[&PLACE, &[Uniform(-0.4, 0.4), Uniform(0.0, 2.0)], &PANE, &PANE_END]);
    vec![
        FunctionCase::new(
            "glazing_holds",
            &GLAZING,
            &domains(&[&PANE, &PANE_END, &[Below(3), fraction, fraction, fraction, Below(2)]]),
            Tol::exact("a position at an edge may be on either side").with_outliers(1.0e-3),
            |a| glazing_holds(&pane(a), a.u32(), vec3(a), a.u32() != 0).words(),
        ),
        FunctionCase::new(
            "glazing_facing",
            &GLAZING,
            &[Unit3],
            Tol::absolute(1.0e-6, "a root and quotients (2.5 ulp); a step may fall on either side")
                .with_outliers(1.0e-3),
            |a| glazing_facing(vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "glazing_down",
            &GLAZING,
            &[Unit3],
            Tol::absolute(2.0e-5, "a difference of unit vectors over its length, which is 0.1 at least")
                .with_outliers(1.0e-3),
            |a| glazing_down(vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "glazing_wander",
            &GLAZING,
            &[Uniform(-60.0, 60.0), AnyWord, AnyWord, AnyWord],
            Tol::absolute(1.0e-5, "products of numbers below 2 of a place in a cell (60 ulp)"),
            |a| glazing_wander(a.f32(), a.u32() as i32, a.u32() as i32, a.u32()).words(),
        ),
        FunctionCase::new(
            "glazing_track",
            &GLAZING,
            &[Uniform(0.0, 3.0), AnyWord, AnyWord, AnyWord],
            Tol::absolute(1.0e-6, "such a number times 12 mm, of a quotient (2.5 ulp) of up to 60"),
            |a| glazing_track(a.f32(), a.u32() as i32, a.u32() as i32, a.u32()).words(),
        ),
        FunctionCase::new(
            "glazing_run",
            &GLAZING,
            &[AnyWord, AnyWord, AnyWord],
            Tol::relative(1.0e-6, 1.0e-7, "integers, and a product"),
            |a| glazing_run(a.u32() as i32, a.u32() as i32, a.u32()).to_array().words(),
        ),
        FunctionCase::new(
            "glazing_lane",
            &GLAZING,
            &with_at,
            Tol::relative(1.0e-5, 2.0e-4, "a number of runs of up to 300, whose parts cancel")
                .with_outliers(1.0e-3),
            |a| {
                let place = place(a);
                let at = vec2(a);
                let GlazingLane { lane, runs, period, height } = glazing_lane(&place, at, &pane(a));
                vec![lane as u32, runs.to_bits(), period.to_bits(), height.to_bits()]
            },
        ),
        FunctionCase::new(
            "glazing_age",
            &GLAZING,
            &with_at,
            Tol::absolute(2.0e-6, "the parts of a run (2e-4 of it) times 4e-3 mm; a track's edge is sharp")
                .with_outliers(4.0e-3),
            |a| {
                let place = place(a);
                let at = vec2(a);
                glazing_age(&place, at, &pane(a)).words()
            },
        ),
        FunctionCase::new(
            "glazing_cap",
            &GLAZING,
            &[near, near, radius],
            Tol::absolute(1.0e-5, "a root of a difference of squares of up to 6 mm").with_outliers(2.0e-3),
            |a| glazing_cap(vec2(a), a.f32()).words(),
        ),
        FunctionCase::new(
            "glazing_higher",
            &GLAZING,
            &[near, near, radius, fraction, near, near, radius, fraction],
            exact.with_outliers(1.0e-3),
            |a| {
                let first = drop(a);
                of_drop(glazing_higher(first, drop(a)))
            },
        ),
        FunctionCase::new(
            "glazing_still",
            &GLAZING,
            &domains(&[
                &PLACE,
                &PANE,
                &PANE_END,
                &[Below(3), OneOf(&[0.0022, 0.00484, 0.010_648]), Fixed(0.8), Fixed(0.6)],
            ]),
            DROP,
            |a| {
                let place = place(a);
                let pane = pane(a);
                let (level, cell) = (a.u32(), a.f32());
                of_drop(glazing_still(&place, &pane, level, cell, vec2(a)))
            },
        ),
        FunctionCase::new("glazing_runner", &GLAZING, &all, DROP, runner),
        FunctionCase::new(
            "glazing_runner",
            &GLAZING,
            &domains(&[&PLACE, &HUGE, &PANE[3..], &PANE_END]),
            Tol::absolute(
                2.0e-4,
                "runs as above, of heads that are larger: a place is under several, of which the higher counts",
            )
            .with_outliers(4.0e-3),
            runner,
        ),
        FunctionCase::new(
            "glazing_place",
            &GLAZING,
            &domains(&[
                &[Uniform(0.0, 3.0), fraction, fraction, Uniform(0.0, 0.01), Below(3)],
                &PANE,
                &PANE_END,
                &[fraction, fraction, fraction, Uniform(0.0, 9.0), Uniform(0.0, 9.0), Uniform(0.0, 9.0)],
                &[Unit3, fraction],
            ]),
            Tol::absolute(2.0e-4, "products of positions of up to 10 m; storeys and steps have sharp edges")
                .with_outliers(2.0e-3),
            |a| {
                let rain = RenderGlazing {
                    before: a.f32(),
                    kept: a.f32(),
                    since: a.f32(),
                    rate: a.f32(),
                    count: a.u32(),
                };
                let pane = pane(a);
                let (position, shift, facet) = (vec3(a), vec3(a), vec3(a));
                let place = glazing_place(&rain, &pane, position, shift, facet, a.f32());
                let mut words = place.at.to_array().words();
                words.extend(place.across.to_array().words());
                words.extend(place.down.to_array().words());
                words.extend([place.met, place.since, place.rate, place.kept].words());
                words
            },
        ),
        FunctionCase::new("glazing_drop", &GLAZING, &all, DROP, |a| {
            let place = place(a);
            of_drop(glazing_drop(&place, &pane(a)))
        }),
        FunctionCase::new(
            "glazing_water",
            &GLAZING,
            &domains(&[
                &PLACE,
                &[Uniform(-0.001, 0.001), Uniform(-0.001, 0.001), Or(&Uniform(0.001_5, 0.004), &[0.0]), Uniform(1.0, 2.4)],
                &[Unit3, Uniform(0.0, 0.02)],
            ]),
            Tol::relative(1.0e-4, 1.0e-4, "a sum of unit vectors, which may cancel, over its length")
                .with_outliers(1.0e-3),
            |a| {
                let place = place(a);
                let found = drop(a);
                let facet = vec3(a);
                let GlazingWater { normal, bend } = glazing_water(&place, &found, facet, a.f32());
                [normal.x, normal.y, normal.z, bend].words()
            },
        ),
        FunctionCase::new(
            "glazing_through",
            &GLAZING,
            &[Unit3, Unit3, Unit3],
            Tol::absolute(2.0e-3, "roots of differences near total reflection, whose edge is sharp")
                .with_outliers(4.0e-3),
            through,
        ),
        // As drops are: tilted by up to 60 degrees from the pane.
        FunctionCase::new(
            "glazing_through",
            &GLAZING,
            &[Made(tilted)],
            Tol::absolute(1.0e-3, "roots of differences near total reflection, whose edge is sharp")
                .with_outliers(4.0e-3),
            through,
        ),
    ]
}

const OVERRIDES: &[(&str, f64)] = &Parts { wet_panes: 1.0, wet: 1.0, ..Parts::NONE }.overrides();

const PICTURE: Tol = Tol::relative(
    3.0e-3,
    3.0e-3,
    "sums over rays; a ray at an edge, also of a drop, the sky's atan2 (4096 ulp), and the rain's edge may fall on either side",
)
.with_outliers(1.0e-2);

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case =
        |name, run| KernelCase { overrides: OVERRIDES, ..KernelCase::new(name, &TRACE_KERNEL, PICTURE, run) };
    vec![
        case("main_trace: rain on panes of any material", |gpu| {
            case_of(gpu, SCENE_NONE, 0.0, Vec3::new(1.5, 0.9, 2.6))
        }),
        case("main_trace: rain on a part of what is not clear", |gpu| {
            case_of(gpu, 1, 0.7, Vec3::new(-1.6, 0.9, 1.2))
        }),
    ]
}

/// A scene of the other cases with rain on what lets light through, or on a material within a rectangle.
fn case_of(gpu: &Gpu, material: u32, half_width: f32, eye: Vec3) -> Result<Run, GpuError> {
    let mut scene = scene();
    let towards = Vec3::new(0.35, 1.0, 0.5).normalize();
    let at = WetnessAt { before: 0.8, kept: 0.7, since: 0.3 };
    scene.set_wetness(Some(&SceneWetness { at, towards, shift: Vec3::new(3.0, 0.0, 5.0) }));
    let rain = RenderGlazing { before: 0.2, kept: 0.7, since: 0.3, rate: 0.01, count: 1 };
    // Heads of runs that are larger than any, so that pixels show them.
    let pane = GlazingPane {
        material,
        height: 0.9,
        largest: 0.2,
        seed: 5,
        center: Vec3::new(-1.5, 0.2, 0.0),
        half_width,
        across: Vec3::X,
        half_height: 0.6,
        outward: Vec3::Z,
        half_thickness: 0.6,
    };
    scene.set_glazing(&pane_rows(&rain, &[pane]));
    picture_by(PictureRays { sky_rays: 2, ..PictureRays::default() }, gpu, &scene, eye)
}
