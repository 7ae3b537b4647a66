//! The streak atlas of `shaders/wgsl/mask` against `downpour_atlas`.

use downpour_atlas::gpu::{AtlasQuery, GpuAtlas};
use downpour_atlas::lookup::{
    atlas_cell, atlas_clamp, atlas_corner, atlas_draw, atlas_light, atlas_map, atlas_position, atlas_rise,
    atlas_weights,
};
use downpour_atlas::{
    StreakAtlas, StreakOptions, StreakOrigin, StreakOscillation, StreakParticle, StreakPick, StreakSet,
    light_directions,
};
use downpour_gpu::{Gpu, GpuError};
use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::atlas::{ATLAS, ATLAS_GRID, ATLAS_QUERY_KERNEL, ATLAS_RISES};

use crate::Domain::{AnyWord, Below, Made, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

/// A light, a view and an axis along it, or one whose part across the view is as small as the limit.
fn along_the_view([a, b, c, d]: [u32; 4]) -> Vec<u32> {
    let unit = |z: f32, turn: u32| {
        let (r, phi) = ((1.0 - z * z).max(0.0).sqrt(), std::f32::consts::TAU * rng_unit(turn));
        [r * ops::cos(phi), r * ops::sin(phi), z]
    };
    let light = unit(2.0 * rng_unit(a) - 1.0, b);
    let [z, x, y] = unit(if d & 3 == 0 { 0.5 } else { 2.0 * rng_unit(c) - 1.0 }, d);
    let (view, axis) = match d & 12 {
        // The square of the part across is ATLAS_TINY, fused or not.
        0 => ([0.0, 0.0, 1.0], [9.782_369e-5, 2.074_914e-5, 1.0]),
        4 => ([y, x, z], [-y, -x, -z]),
        _ => ([y, x, z], [y, x, z]),
    };
    [light, view, axis].concat().into_iter().map(f32::to_bits).collect()
}

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let (low, high, middle) = (Uniform(-1.0, -0.6), Uniform(0.6, 1.0), Uniform(-0.4, 0.4));
    let point = Uniform(-1.2, 1.2);
    let (start, inverse) = (Uniform(-1.0, 1.0), Uniform(0.0, 4.0));
    let gaps = [[start; 8].as_slice(), &[inverse; 8], &[start]].concat();
    vec![
        FunctionCase::new(
            "atlas_light",
            &ATLAS,
            &[Unit3, Unit3, Unit3],
            Tol::absolute(
                2.0e-5,
                "the part of the axis across the view is a difference, a hundredth at times",
            ),
            |a| atlas_light(a.f32s(), a.f32s(), a.f32s()).words(),
        ),
        FunctionCase::new(
            "atlas_light",
            &ATLAS,
            &[Made(along_the_view)],
            Tol::absolute(2.0e-6, "products and sums of unit vectors, and a root (2.5 ulp)"),
            |a| atlas_light(a.f32s(), a.f32s(), a.f32s()).words(),
        ),
        FunctionCase::new(
            "atlas_map",
            &ATLAS,
            &[Unit3],
            Tol::relative(1.0e-6, 1.0e-6, "a division (2.5 ulp) and a product"),
            |a| atlas_map(a.f32s()).words(),
        ),
        FunctionCase::new(
            "atlas_position",
            &ATLAS,
            &gaps,
            Tol::absolute(4.0e-6, "eight products up to 8 that are cut to 0 to 1, and their sum"),
            |a| atlas_position(a.f32s(), a.f32s(), a.f32s(), a.f32s(), a.f32()).words(),
        ),
        FunctionCase::new(
            "atlas_rise",
            &ATLAS,
            &[Uniform(-1.0, 1.0)],
            Tol::absolute(1.0e-5, "a division (2.5 ulp) of numbers up to 1, times 24"),
            |a| atlas_rise(a.f32()).words(),
        ),
        FunctionCase::new(
            "atlas_cell",
            &ATLAS,
            &[point, point],
            Tol::absolute(1.0e-5, "a product and a sum, times 40; at a border the next cell with 0 for 1")
                .with_outliers(1.0e-4),
            |a| atlas_cell(a.f32s()).words(),
        ),
        FunctionCase::new(
            "atlas_corner",
            &ATLAS,
            &[Uniform(0.0, 1.0), Uniform(0.0, 1.0), Below(4)],
            Tol::relative(1.0e-6, 1.0e-6, "a product of two differences"),
            |a| atlas_corner(a.f32(), a.f32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "atlas_weights",
            &ATLAS,
            &[low, low, high, low, middle, high, point, point],
            Tol::relative(
                1.0e-5,
                4.0e-6,
                "differences of products up to 8 and divisions (2.5 ulp) by 1 to 4",
            ),
            |a| atlas_weights(a.f32s(), a.f32s(), a.f32s(), a.f32s()).words(),
        ),
        FunctionCase::new(
            "atlas_clamp",
            &ATLAS,
            &[Uniform(-0.5, 0.4), Uniform(0.2, 1.0), Uniform(-0.2, 1.0)],
            Tol::relative(1.0e-6, 1.0e-6, "a sum, a division (2.5 ulp) and a product"),
            |a| atlas_clamp(a.f32s()).words(),
        ),
        FunctionCase::new(
            "atlas_draw",
            &ATLAS,
            &[AnyWord, AnyWord, AnyWord, Below(2), Made(|r| vec![1 + r[0] % 1500])],
            Tol::exact("integers, and one product that rounds alike"),
            |a| atlas_draw(a.u32s(), a.u32(), a.u32(), a.u32()).words(),
        ),
    ]
}

/// Amounts of a set that go up and down from node to node, 0.5 to 1.5.
fn amounts(diameter: u32, oscillation: u32) -> Vec<half::f16> {
    let node = |k: u32| half::f16::from_f32(0.5 + rng_unit(rng_draw([diameter, oscillation], k, 1, 0)[0]));
    (0..ATLAS_RISES * ATLAS_GRID * ATLAS_GRID).map(node).collect()
}

/// An atlas of nine diameters, with noise in its texels.
fn atlas(pick: StreakPick, with_amounts: bool) -> StreakAtlas {
    let options = StreakOptions { columns: 8, rows: 6, ..StreakOptions::default() };
    let elevations = [-0.9, -0.3, 0.1, 0.5, 1.0];
    let mut directions = vec![light_directions(); elevations.len()];
    if !with_amounts {
        // As those of the Columbia database, elevations have their own directions.
        directions[2].reverse();
    }
    let set = |diameter: u32, oscillation: u32| {
        let texels = (0..elevations.len() * directions[0].len() * 48).map(|k| {
            let [word, ..] = rng_draw([diameter, oscillation], k as u32, 0, 0);
            // Half floats of 0 to 1, none of them too small for a driver.
            half::f16::from_f32(rng_unit(word).max(0.01))
        });
        StreakSet {
            origin: StreakOrigin::Traced,
            diameter: f64::from(diameter) * 5.0e-4,
            oscillation: StreakOscillation::NONE,
            options,
            elevations: elevations.to_vec(),
            directions: directions.clone(),
            texels: texels.collect(),
            amounts: if with_amounts { amounts(diameter, oscillation) } else { Vec::new() },
        }
    };
    let sets =
        (1..=9).flat_map(|diameter| (0..2).map(move |k| (diameter, k))).map(|(d, k)| set(d, k)).collect();
    StreakAtlas::from_sets(sets).expect("an atlas").with_pick(pick).with_seed(77)
}

fn query(k: u32) -> AtlasQuery {
    let units = |which: u32| rng_draw([5, 6], k, which, 0).map(rng_unit);
    let direction = |which: u32| {
        let [a, b, ..] = units(which);
        let (z, phi) = (2.0 * a - 1.0, std::f32::consts::TAU * b);
        let r = (1.0 - z * z).max(0.0).sqrt();
        [r * ops::cos(phi), r * ops::sin(phi), z]
    };
    let [size, across, turns, _] = units(3);
    AtlasQuery {
        light: direction(0),
        diameter: 5.0e-3 * size,
        view: direction(1),
        id: k,
        axis: direction(2),
        across: 3.2 * across - 1.6,
        turns: 8.0 * turns - 4.0,
        unused: [0; 3],
    }
}

fn query_case(gpu: &Gpu, pick: StreakPick, with_amounts: bool) -> Result<Run, GpuError> {
    let atlas = atlas(pick, with_amounts);
    let queries: Vec<AtlasQuery> = (0..8192).map(query).collect();
    let made = GpuAtlas::new(gpu, &atlas)?.query(gpu, &queries)?;
    let told = queries.iter().map(|q| {
        let drop = StreakParticle { diameter: q.diameter, axis: q.axis, id: q.id };
        atlas.radiance(&atlas.slot(&drop, q.light, q.view), q.across, q.turns).to_bits()
    });
    Ok(Run {
        arguments: queries
            .iter()
            .map(|q| (((q.light, q.diameter), (q.view, q.id)), ((q.axis, q.across), q.turns)).words())
            .collect(),
        cpu: Cpu(told.collect()),
        gpu: FromGpu(made.iter().map(|v| v.to_bits()).collect()),
        kinds: vec![WordKind::Float],
    })
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    let case = |name, run| KernelCase {
        name,
        kernel: &ATLAS_QUERY_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: Tol::absolute(4.0e-4, "noise of 0 to 3 at points known to 4e-5 of a cell's size")
            .with_outliers(1.0e-3),
        run,
    };
    vec![
        case("main_atlas_query: by angle", |gpu| query_case(gpu, StreakPick::ByAngle, true)),
        case("main_atlas_query: by angle, directions that differ", |gpu| {
            query_case(gpu, StreakPick::ByAngle, false)
        }),
        case("main_atlas_query: at random", |gpu| query_case(gpu, StreakPick::Random, true)),
    ]
}
