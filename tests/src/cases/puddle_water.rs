//! `shaders/wgsl/render/puddle_water.wgsl` against `downpour_trace::scene::water`.

use std::sync::Arc;

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_gpu::{Gpu, GpuError};
use downpour_math::ops;
use downpour_math::packing::packing_pack_half;
use downpour_math::rng::{rng_pcg4d, rng_unit};
use downpour_render::light::LightSource;
use downpour_shaders::render::puddle_flow::PUDDLE_FLOW;
use downpour_shaders::render::puddle_rings::PUDDLE_RINGS;
use downpour_shaders::render::puddle_wake::PUDDLE_WAKE;
use downpour_shaders::render::puddle_water::PUDDLE_WATER;
use downpour_shaders::render::scene::TRACE_KERNEL;
use downpour_sim::field::RainField;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::material::MaterialLook;
use downpour_trace::puddle::{
    FlowMap, Ground, PuddleLook, PuddleMap, PuddleRows, RainOnWater, RingRows, Rings, WakeRows, slope_levels,
};
use downpour_trace::scene::puddle_flow::{puddle_flow_moves, puddle_flow_phase, puddle_flow_place};
use downpour_trace::scene::puddle_rings::puddle_rings_shown;
use downpour_trace::scene::puddle_wake::puddle_wake_shown;
use downpour_trace::scene::water::{
    puddle_water_above, puddle_water_albedo, puddle_water_beneath, puddle_water_entry, puddle_water_mirrored,
    puddle_water_normal, puddle_water_reflectance, puddle_water_refracted,
};
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, DVec3, Vec2, Vec3};

use super::scene::{Parts, picture, scene};
use crate::Domain::{Below, Uniform, Unit3};
use crate::function::Run;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

fn vec3(args: &mut Args<'_>) -> Vec3 {
    Vec3::from(args.f32s())
}

const DIRECTION: Tol = Tol::relative(
    1.0e-4,
    2.0e-5,
    "roots and quotients (2.5 ulp each); components near 0 are differences of numbers up to 1",
);

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let slope = Uniform(-0.5, 0.5);
    let fraction = Uniform(0.0, 1.0);
    vec![
        FunctionCase::new(
            "puddle_water_normal",
            &PUDDLE_WATER,
            &[slope, slope, Uniform(0.0, 0.1), fraction, fraction],
            Tol::absolute(2.0e-3, "sine and cosine (2^-11 within pi, and unspecified reduction beyond)")
                .with_outliers(1.0e-3),
            |a| puddle_water_normal(vec3(a), a.f32(), a.f32()).to_array().words(),
        ),
        FunctionCase::new(
            "puddle_rings_shown",
            &PUDDLE_RINGS,
            &[Uniform(-6.0, 6.0), Uniform(-6.0, 6.0), Uniform(3.0, 9.0), Uniform(0.0, 0.02)],
            Tol::absolute(1.0e-5, "a root and two quotients (2.5 ulp each), times the slope of a cubic"),
            |a| puddle_rings_shown(Vec2::from(a.f32s()), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_wake_shown",
            &PUDDLE_WAKE,
            &[Uniform(0.0, 8.0)],
            Tol::absolute(1.0e-5, "a quotient (2.5 ulp), times the slope of a cubic"),
            |a| puddle_wake_shown(a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_flow_moves",
            &PUDDLE_FLOW,
            &[Uniform(0.0, 0.06)],
            Tol::absolute(1.0e-5, "a quotient (2.5 ulp), times the slope of a cubic"),
            |a| puddle_flow_moves(a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_flow_phase",
            &PUDDLE_FLOW,
            &[fraction, Below(2)],
            Tol::absolute(1.0e-6, "sums of numbers below 2, and a product"),
            |a| puddle_flow_phase(a.f32(), a.u32()).to_array().words(),
        ),
        FunctionCase::new(
            "puddle_flow_place",
            &PUDDLE_FLOW,
            &[fraction, Below(1 << 20), Below(2)],
            Tol::relative(1.0e-6, 1.0e-6, "products of whole numbers below 67 with constants"),
            |a| puddle_flow_place(a.f32(), a.u32(), a.u32()).to_array().words(),
        ),
        FunctionCase::new("puddle_water_mirrored", &PUDDLE_WATER, &[Unit3, Unit3], DIRECTION, |a| {
            puddle_water_mirrored(vec3(a), vec3(a)).to_array().words()
        }),
        FunctionCase::new("puddle_water_refracted", &PUDDLE_WATER, &[Unit3, Unit3], DIRECTION, |a| {
            puddle_water_refracted(vec3(a), vec3(a)).to_array().words()
        }),
        FunctionCase::new("puddle_water_beneath", &PUDDLE_WATER, &[Unit3], DIRECTION, |a| {
            puddle_water_beneath(vec3(a)).to_array().words()
        }),
        FunctionCase::new("puddle_water_entry", &PUDDLE_WATER, &[Unit3, fraction], DIRECTION, |a| {
            puddle_water_entry(vec3(a), a.f32()).to_array().words()
        }),
        FunctionCase::new(
            "puddle_water_above",
            &PUDDLE_WATER,
            &[Unit3],
            Tol::absolute(2.0e-3, "the root of a difference, which cancels at total reflection"),
            |a| puddle_water_above(vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "puddle_water_albedo",
            &PUDDLE_WATER,
            &[fraction, fraction, fraction],
            DIRECTION,
            |a| puddle_water_albedo(vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "puddle_water_reflectance",
            &PUDDLE_WATER,
            &[fraction, fraction, fraction],
            Tol::relative(2.0e-3, 1.0e-5, "a difference of refractive indices, and 1 - root(0.98), cancel"),
            |a| puddle_water_reflectance(vec3(a)).to_array().words(),
        ),
    ]
}

/// Two puddles on the floor of the scene of the other cases: one beneath the surface that the rays meet, one on it.
fn maps() -> [(PuddleMap, PuddleLook); 2] {
    let ground =
        Ground { middle: Vec3::new(-1.4, -0.5, 0.3), size: Vec2::new(2.6, 3.0), turn: 0.4, reach: 0.3 };
    let size = [24, 28];
    let cell = |i: usize| {
        let (x, y) = ((i % size[0]) as f32, (i / size[0]) as f32);
        let depth = 0.06 * ops::sin(0.4 * x) * ops::cos(0.35 * y);
        [-0.02, depth.max(0.0) + 0.01, depth, rng_unit(rng_pcg4d([i as u32, 0, 0, 9])[0])]
    };
    let sunk = PuddleMap { ground, size, cells: (0..size[0] * size[1]).map(cell).collect(), flow: None };
    let flat = PuddleMap {
        ground: Ground { middle: Vec3::new(1.6, -0.497, 0.4), turn: -0.2, ..ground },
        cells: sunk.cells.iter().map(|&[_, _, depth, open]| [0.0, 0.0, depth + 0.01, open]).collect(),
        ..sunk.clone()
    };
    let look = PuddleLook { influence: 1.4, angle: 0.7, scale: 0.8, ..PuddleLook::default() };
    [(sunk, PuddleLook::default()), (flat, look)]
}

/// A bank so steep that water barely lies on it, with a thin film along the whole of it.
fn bank() -> (SceneData, PuddleMap) {
    // The facet's normal rises by 0.706: 0.7 is where water no longer lies.
    let (upward, half) = (0.706f32, 0.5f32);
    let steep = (1.0 - upward * upward).sqrt() / upward;
    let corner = |x: f32, z: f32| [x * half, x * half * steep, z * half];
    let positions = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let mut builder = SceneBuilder::new();
    let material = builder.add_material(MaterialLook { roughness: 0.7, ..MaterialLook::default() });
    let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
    builder.add_light(LightSource::Directional {
        direction: Vec3::new(0.4, -0.8, -0.45).normalize(),
        irradiance: Vec3::new(3.0, 2.8, 2.5),
    });
    let size = [32, 4];
    let along = |i: usize| (((i % size[0]) as f32 + 0.5) / size[0] as f32 * 2.0 - 1.0) * half;
    let cells = (0..size[0] * size[1]).map(|i| [steep * along(i), 0.0, 0.02, 1.0]).collect();
    let ground = Ground { middle: Vec3::ZERO, size: Vec2::splat(2.0 * half), turn: 0.0, reach: 2.0 };
    let sky = SkyLight::new(2, 1, &[[0.4, 0.6, 1.2], [0.7, 0.6, 0.2]]);
    (builder.build(&sky), PuddleMap { ground, size, cells, flow: None })
}

/// A pool in the rain, seen from so near that the rings of single drops are large.
fn case_rings(gpu: &Gpu) -> Result<Run, GpuError> {
    let positions = [[-0.6, 0.0, -0.6], [-0.6, 0.0, 0.6], [0.6, 0.0, 0.6], [0.6, 0.0, -0.6]];
    let mut builder = SceneBuilder::new();
    let material = builder.add_material(MaterialLook { roughness: 0.7, ..MaterialLook::default() });
    let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
    let sky = SkyLight::new(2, 1, &[[0.4, 0.6, 1.2], [0.7, 0.6, 0.2]]);
    let ground = Ground { middle: Vec3::ZERO, size: Vec2::splat(1.0), turn: 0.3, reach: 0.3 };
    let cells = (0..16).map(|i| [0.0, 0.01, 0.01, if i == 5 { 0.4 } else { 1.0 }]).collect();
    let puddles = [(PuddleMap { ground, size: [4, 4], cells, flow: None }, PuddleLook::default())];
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 60.0).expect("a rain");
    let field = Arc::new(RainField::new(&rain, 3).expect("a rain"));
    let eye = Vec3::new(0.05, 0.19, 0.14);
    let on_water = RainOnWater { field: &field, sizes: None, time_s: 2.3, eye: eye.as_dvec3(), dripped: &[] };
    let rings = Rings::new(&rain).and_then(|mut rings| rings.find(&on_water, &puddles, DVec3::ZERO));
    let rings = rings.expect("rings");
    water_with(gpu, builder.build(&sky), &puddles, eye, 1, (Some(&rings), &[]))
}

/// The puddles from near and far, with waves of what moved through both.
fn case_wakes(gpu: &Gpu) -> Result<Run, GpuError> {
    let wake = |puddle: usize, size: [usize; 2], cell_m: f32| {
        let slope = |i: usize| {
            let [x, y] = [i % size[0], i / size[0]].map(|at| at as f32 * cell_m);
            let [a, b] = [0.2 * ops::sin(9.0 * x + 4.0 * y), 0.15 * ops::cos(7.0 * y - 5.0 * x)];
            [a, b, 0.8 * (a * a + b * b) + 0.002, 0.0]
        };
        WakeRows { puddle, size, cell_m, slopes: (0..size[0] * size[1]).map(slope).collect() }
    };
    let wakes = [wake(0, [64, 70], 0.05), wake(1, [30, 34], 0.09)];
    water_with(gpu, scene(), &maps(), Vec3::new(-0.4, 1.2, 2.6), 1, (None, &wakes))
}

/// Water that runs, faster in the middle than at the shores, and is not level.
fn case_flow(gpu: &Gpu) -> Result<Run, GpuError> {
    let runs = |(map, look): (PuddleMap, PuddleLook)| {
        let [columns, rows] = map.size;
        let words = |i: usize| {
            let [u, v] = [(i % columns) as f32 / columns as f32, (i / columns) as f32 / rows as f32];
            let speed = 0.7 * (1.0 - 2.0 * (u - 0.5).abs());
            [[speed * v, 0.3 * speed], [0.05 * u - 0.02, 0.04 * v]].map(packing_pack_half)
        };
        let row = |k: usize| {
            let ([a, b], [c, d]) = (words(2 * k), words(2 * k + 1));
            [a, b, c, d]
        };
        (PuddleMap { flow: Some(FlowMap((0..columns * rows / 2).map(row).collect())), ..map }, look)
    };
    let mut scene = scene();
    lay_at(&mut scene, &maps().map(runs), (None, &[]), 77.3);
    picture(gpu, &scene, Vec3::new(-0.4, 1.2, 2.6), 1)
}

fn case(gpu: &Gpu, eye: Vec3, sky_rays: u32) -> Result<Run, GpuError> {
    water(gpu, scene(), &maps(), eye, sky_rays)
}

fn case_bank(gpu: &Gpu) -> Result<Run, GpuError> {
    let (scene, map) = bank();
    water(gpu, scene, &[(map, PuddleLook::default())], Vec3::new(-0.9, 0.9, 0.5), 0)
}

/// A picture of a scene with puddles.
fn water(
    gpu: &Gpu,
    scene: SceneData,
    puddles: &[(PuddleMap, PuddleLook)],
    eye: Vec3,
    sky_rays: u32,
) -> Result<Run, GpuError> {
    water_with(gpu, scene, puddles, eye, sky_rays, (None, &[]))
}

/// The same, with rings of single drops and wakes.
fn water_with(
    gpu: &Gpu,
    mut scene: SceneData,
    puddles: &[(PuddleMap, PuddleLook)],
    eye: Vec3,
    sky_rays: u32,
    moved: (Option<&RingRows>, &[WakeRows]),
) -> Result<Run, GpuError> {
    lay(&mut scene, puddles, moved);
    picture(gpu, &scene, eye, sky_rays)
}

/// Lays the puddles of the cases on the ground of the scene of the other cases.
pub(super) fn laid(scene: &mut SceneData) {
    lay(scene, &maps(), (None, &[]));
}

/// Lays puddles with ripples on a scene.
fn lay(scene: &mut SceneData, puddles: &[(PuddleMap, PuddleLook)], moved: (Option<&RingRows>, &[WakeRows])) {
    lay_at(scene, puddles, moved, 0.0);
}

/// The same at a time, s.
fn lay_at(
    scene: &mut SceneData,
    puddles: &[(PuddleMap, PuddleLook)],
    (rings, wakes): (Option<&RingRows>, &[WakeRows]),
    time_s: f64,
) {
    let finest = (0..128 * 128u32).map(|i| {
        let [a, b, ..] = rng_pcg4d([i, 4, 5, 6]).map(|word| rng_unit(word) - 0.5);
        let [x, y] = [(i % 128) as f32, (i / 128) as f32];
        let slopes = [0.2 * ops::sin(0.5 * x + 0.2 * y) + 0.1 * a, 0.2 * ops::cos(0.6 * y) + 0.1 * b];
        [slopes[0], slopes[1], slopes[0] * slopes[0] + slopes[1] * slopes[1], 0.0]
    });
    scene.set_puddles(&PuddleRows {
        puddles,
        shape: (128, 7, 0.01),
        slopes: &slope_levels(finest.collect(), 128),
        shift: Vec3::ZERO,
        rings,
        wakes,
        time_s,
    });
}

const OVERRIDES: &[(&str, f64)] = &Parts { puddles: 1.0, ..Parts::NONE }.overrides();

const WATER: Tol = Tol::relative(
    4.0e-3,
    4.0e-3,
    "sums over rays whose directions go through log2, sine and cosine; a ray at an edge, and a level of the ripples, may fall on either side",
)
.with_outliers(6.0e-3);

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case =
        |name, run| KernelCase { overrides: OVERRIDES, ..KernelCase::new(name, &TRACE_KERNEL, WATER, run) };
    vec![
        case("main_trace: puddles from near", case_near),
        case("main_trace: puddles from afar", case_far),
        case("main_trace: water on a bank", case_bank),
        case("main_trace: rings of drops on a pool", case_rings),
        case("main_trace: wakes in puddles", case_wakes),
        case("main_trace: running water", case_flow),
    ]
}

fn case_near(gpu: &Gpu) -> Result<Run, GpuError> {
    case(gpu, Vec3::new(0.6, 1.0, 2.6), 2)
}

fn case_far(gpu: &Gpu) -> Result<Run, GpuError> {
    case(gpu, Vec3::new(-3.0, 3.0, 9.0), 0)
}
