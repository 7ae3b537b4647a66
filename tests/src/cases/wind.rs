//! `shaders/wgsl/wind` against `downpour-wind`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::Kernel;
use downpour_shaders::wind::{
    FIELD, FIELD_KERNEL, FIELD_SPREAD_CLEAR_KERNEL, FIELD_SPREAD_KERNEL, PRIMITIVE, TURBULENCE,
};
use downpour_wind::field::{
    WindFieldGrid, WindFieldPosition, wind_field_center, wind_field_corner, wind_field_index,
    wind_field_locate, wind_field_mix,
};
use downpour_wind::gpu::{GpuWindError, GpuWindField};
use downpour_wind::primitive::{
    wind_primitive_across, wind_primitive_core, wind_primitive_lamb_oseen, wind_primitive_line,
    wind_primitive_point, wind_primitive_rankine, wind_primitive_rise, wind_primitive_updraft,
    wind_primitive_velocity,
};
use downpour_wind::turbulence::{wind_turbulence_velocity, wind_turbulence_wave};
use downpour_wind::{
    Turbulence, WindCore, WindField, WindForm, WindGrid, WindMask, WindMatrix, WindPrimitive,
    WindSingularity, WindTornado, WindTurbulenceMode, WindUniform,
};
use glam::{DVec3, UVec3, Vec3};

use crate::Domain::{Below, Fixed, LogUniform, Made, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu, POISON};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

fn vec3(args: &mut Args<'_>) -> Vec3 {
    Vec3::from(args.f32s())
}

/// The words of a `mat3x3f`: a primitive of any type within 8 m, 1 to 3 m in the core.
fn matrix_words(random: [u32; 4]) -> Vec<u32> {
    let more =
        |dimension: u32| rng_draw([random[0], random[1]], random[2], random[3], dimension).map(rng_unit);
    let ([a, b, c, d], [x, y, z, _]) = (more(0), more(1));
    // Lines with the two other cores come after the eight.
    // 8 is none of them.
    let kind = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 17, 18, 19][random[0] as usize % 15] as f32;
    let axis = Vec3::new(x - 0.5, y - 0.5, z + 0.01).normalize();
    // The up of an updraft is as long as the updraft.
    let up = if kind > 6.5 && kind < 7.5 { axis * (6.0 + 10.0 * a) } else { axis };
    let strength = 80.0 * b - 40.0;
    let center = [8.0 * c - 4.0, 8.0 * d - 4.0, 8.0 * a - 4.0];
    [[kind, strength, 1.0 + 2.0 * c], center, up.to_array()].words()
}

fn matrix(args: &mut Args<'_>) -> WindMatrix {
    WindMatrix { rows: [args.f32s(), args.f32s(), args.f32s()] }
}

/// The words of a `WindFieldGrid` of 1 to 64 cells along each edge, about the origin.
fn grid_words(random: [u32; 4]) -> Vec<u32> {
    let size = [0, 1, 2].map(|k| 1 + random[k] % 64);
    let [x, y, z, _] = rng_draw([random[3], 1], random[0], 0, 0).map(|w| 20.0 + 80.0 * rng_unit(w));
    let edge = Vec3::new(x, y, z);
    let grid = WindGrid::new(edge * -0.5, edge * 0.5, size).expect("a grid");
    let grid = WindFieldGrid::new(&grid, 3, 5);
    let mut words = grid.cell.words();
    words.push(grid.modes);
    words.extend(grid.low.words());
    words.push(grid.primitives);
    words.extend(grid.per_cell.words());
    words.extend(grid.size);
    words
}

fn grid(args: &mut Args<'_>) -> WindFieldGrid {
    let (cell, modes, low, primitives) = (args.f32s(), args.u32(), args.f32s(), args.u32());
    let (per_cell, size) = (args.f32s(), args.u32s());
    WindFieldGrid { cell, modes, low, primitives, per_cell, padding_2: 0, size, padding_3: 0 }
}

const QUOTIENT: Tol = Tol::relative(
    2.0e-6,
    0.0,
    "products, sums of positive numbers, a square root and divisions (2.5 ulp each)",
);

const EXPONENTIAL: Tol = Tol::relative(
    6.0e-6,
    0.0,
    "1 - exp(-x) for x above 0.25, where exp is promised to 4 ulp of up to 0.78, and divisions",
);

/// The type of a line with any core.
fn line_words(random: [u32; 4]) -> Vec<u32> {
    vec![random[0] % 4 + 8 * (random[1] % 3)]
}

/// The words of a `WindTurbulenceMode`: waves of 1 to 20 m, up to 5 m/s.
fn mode_words(random: [u32; 4]) -> Vec<u32> {
    let [x, y, z, phase] = random.map(rng_unit);
    let [a, b, c, length] = rng_draw([random[0], random[1]], random[2], random[3], 0).map(rng_unit);
    let wave = Vec3::new(x - 0.5, y - 0.5, z + 0.01).normalize() / (1.0 + 19.0 * length);
    let mut words = wave.to_array().words();
    words.push(phase.to_bits());
    words.extend([a, b, c].map(|v| 10.0 * v - 5.0).words());
    words
}

fn mode(args: &mut Args<'_>) -> WindTurbulenceMode {
    WindTurbulenceMode { wave: args.f32s(), phase: args.f32(), amplitude: args.f32s(), padding: 0 }
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let near = Uniform(-20.0, 20.0);
    let squared = LogUniform(1.0e-2, 1.0e3);
    let (strength, core) = (Uniform(-50.0, 50.0), Uniform(1.0, 3.0));
    let value = Uniform(-10.0, 10.0);
    let fraction = Uniform(0.0, 1.0);
    let cell = [Below(64); 3];
    let mut mix = vec![value; 24];
    mix.extend([fraction; 3]);
    vec![
        FunctionCase::new(
            "wind_primitive_across",
            &PRIMITIVE,
            &[near, near, near, Unit3],
            Tol::absolute(2.0e-5, "differences of numbers up to 35; a GPU may fuse the products"),
            |a| wind_primitive_across(vec3(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new("wind_primitive_line", &PRIMITIVE, &[strength, squared, core], QUOTIENT, |a| {
            wind_primitive_line(a.f32(), a.f32(), a.f32()).words()
        }),
        FunctionCase::new(
            "wind_primitive_rankine",
            &PRIMITIVE,
            &[strength, squared, core],
            QUOTIENT,
            |a| wind_primitive_rankine(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "wind_primitive_lamb_oseen",
            &PRIMITIVE,
            &[strength, squared, core],
            EXPONENTIAL,
            |a| wind_primitive_lamb_oseen(a.f32(), a.f32(), a.f32()).words(),
        ),
        // Where the series is longest, of a core whose square is 1.
        FunctionCase::new(
            "wind_primitive_lamb_oseen",
            &PRIMITIVE,
            &[Fixed(1.0), Uniform(0.2, 0.2499), Fixed(1.0)],
            Tol::relative(6.0e-7, 0.0, "sums of products that a GPU may fuse, of numbers below 1"),
            |a| wind_primitive_lamb_oseen(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "wind_primitive_core",
            &PRIMITIVE,
            &[Made(line_words), strength, squared, core],
            EXPONENTIAL,
            |a| wind_primitive_core(a.u32(), a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new("wind_primitive_point", &PRIMITIVE, &[strength, squared, core], QUOTIENT, |a| {
            wind_primitive_point(a.f32(), a.f32(), a.f32()).words()
        }),
        FunctionCase::new("wind_primitive_rise", &PRIMITIVE, &[LogUniform(0.5, 500.0), near], QUOTIENT, |a| {
            wind_primitive_rise(a.f32(), a.f32()).words()
        }),
        FunctionCase::new(
            "wind_primitive_updraft",
            &PRIMITIVE,
            &[strength, squared, near, Uniform(6.0, 16.0), core],
            Tol::relative(4.0e-6, 1.0e-5, "the difference of two rises, each up to 16 m/s and known to 5e-7 of it"),
            |a| wind_primitive_updraft(a.f32(), a.f32(), a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "wind_primitive_velocity",
            &PRIMITIVE,
            &[Made(matrix_words), Uniform(-8.0, 8.0), Uniform(-8.0, 8.0), Uniform(-8.0, 8.0)],
            Tol::relative(
                4.0e-6,
                5.0e-6,
                "divisions and a square root (2.5 ulp each); f32 differs from f64 by up to 1e-6 m/s off the axis",
            ),
            |a| wind_primitive_velocity(&matrix(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "wind_turbulence_wave",
            &TURBULENCE,
            &[Uniform(-100.0, 100.0)],
            Tol::absolute(1.0e-6, "a polynomial of six terms up to pi / 2; a GPU may fuse its products"),
            |a| wind_turbulence_wave(a.f32()).words(),
        ),
        FunctionCase::new(
            "wind_turbulence_velocity",
            &TURBULENCE,
            &[Made(mode_words), near, near, near],
            Tol::absolute(2.0e-4, "up to 35 turns, known to 4e-6 of a turn, times 5 m/s; a GPU may fuse the products"),
            |a| wind_turbulence_velocity(&mode(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "wind_field_center",
            &FIELD,
            &[Made(grid_words), cell[0], cell[1], cell[2]],
            Tol::relative(1.0e-6, 2.0e-5, "a product of up to 6400 m, then a sum; a GPU may fuse them"),
            |a| wind_field_center(&grid(a), UVec3::from(a.u32s())).to_array().words(),
        ),
        FunctionCase::new(
            "wind_field_index",
            &FIELD,
            &[Made(grid_words), cell[0], cell[1], cell[2]],
            Tol::exact("integers are exact"),
            |a| wind_field_index(&grid(a), UVec3::from(a.u32s())).words(),
        ),
        FunctionCase::new(
            "wind_field_locate",
            &FIELD,
            &[Made(grid_words), Uniform(-60.0, 60.0), Uniform(-60.0, 60.0), Uniform(-60.0, 60.0)],
            Tol::absolute(
                3.0e-5,
                "a position of up to 64 cells, 4e-6 each operation; close to a center it may be in the next cell",
            )
            .with_outliers(2.0e-4),
            |a| {
                let position = wind_field_locate(&grid(a), vec3(a));
                ((position.cell.to_array(), position.next.to_array()), position.fraction.to_array()).words()
            },
        ),
        FunctionCase::new(
            "wind_field_corner",
            &FIELD,
            &[cell[0], cell[1], cell[2], cell[0], cell[1], cell[2], fraction, fraction, fraction, Below(8)],
            Tol::exact("a choice between integers"),
            |a| {
                let (cell, next) = (UVec3::from(a.u32s()), UVec3::from(a.u32s()));
                let position = WindFieldPosition { cell, next, fraction: vec3(a) };
                wind_field_corner(&position, a.u32()).to_array().words()
            },
        ),
        FunctionCase::new(
            "wind_field_mix",
            &FIELD,
            &mix,
            Tol::absolute(2.0e-5, "seven differences, products and sums of numbers up to 20; a GPU may fuse them"),
            |a| {
                let corners = std::array::from_fn(|_| vec3(a));
                wind_field_mix(&corners, vec3(a)).to_array().words()
            },
        ),
    ]
}

/// Every primitive in every form, with slanted axes.
fn primitives() -> Vec<WindPrimitive> {
    let mut all = vec![
        WindPrimitive::Uniform(WindUniform { speed: 4.0, direction: Vec3::new(1.0, 0.1, -0.4) }),
        WindPrimitive::Tornado(WindTornado {
            circulation: -60.0,
            discharge: 150.0,
            base: Vec3::new(-3.0, -8.0, 2.0),
            axis: Vec3::new(0.1, 1.0, 0.2),
            height: 14.0,
            core_radius: 2.5,
        }),
    ];
    for (form, x) in [(WindForm::Line, 5.0), (WindForm::Point, -4.0)] {
        let at = WindSingularity {
            form,
            strength: 50.0,
            center: Vec3::new(x, 1.0, -2.0),
            axis: Vec3::new(-0.3, 1.0, 0.5),
            core_radius: 2.0,
            core: WindCore::Rosenhead,
        };
        all.push(WindPrimitive::Source(at));
        all.push(WindPrimitive::Sink(WindSingularity { center: Vec3::new(-x, 3.0, 4.0), ..at }));
        all.push(WindPrimitive::Vortex(WindSingularity { center: Vec3::new(x, -2.0, 6.0), ..at }));
    }
    for (core, z) in [(WindCore::Rankine, -6.0), (WindCore::LambOseen, 6.0)] {
        all.push(WindPrimitive::Vortex(WindSingularity {
            form: WindForm::Line,
            strength: -30.0,
            center: Vec3::new(0.0, 0.0, z),
            axis: Vec3::new(1.0, 0.2, 0.1),
            core_radius: 3.0,
            core,
        }));
    }
    all
}

/// A whole field with a ball in it, by way of the field that keeps its buffers.
fn field_case(gpu: &Gpu, size: [u32; 3], cut_off: f32, eddies: f64) -> Result<Run, GpuError> {
    let grid = WindGrid::new(Vec3::splat(-10.0), Vec3::new(10.0, 12.0, 9.0), size).expect("a grid");
    let mask = WindMask::from_fn(&grid, |at| (at - Vec3::new(2.0, 0.0, 1.0)).length() < 4.0);
    let mask = mask.with_cut_off(&grid, cut_off).expect("a cut-off");
    let turbulence = Turbulence { speed: eddies, length: 6.0, seed: 4 };
    let modes = if eddies > 0.0 { turbulence.modes(&grid, DVec3::new(7.0, 0.0, 1.0e4)) } else { Vec::new() };
    let field = WindField::with_turbulence(&grid, &primitives(), &modes, &mask).expect("a field");
    let made = GpuWindField::new(gpu, &grid, field.matrices().len(), modes.len())
        .and_then(|on_gpu| {
            // Nothing of an earlier wind may stay.
            let poison = vec![[f32::from_bits(POISON); 4]; grid.cells()];
            gpu.queue().write_buffer(on_gpu.cells(), 0, bytemuck::cast_slice(&poison));
            on_gpu.set_mask(&mask)?;
            on_gpu.update(&primitives(), &modes)?;
            Ok(gpu.read::<[f32; 4]>(on_gpu.cells())?)
        })
        .map_err(|error| match error {
            GpuWindError::Gpu(error) => error,
            other => panic!("{other}"),
        })?;
    let words = |cells: &[[f32; 4]]| cells.iter().flatten().map(|v| v.to_bits()).collect();
    Ok(Run {
        arguments: (0..grid.cells())
            .map(|i| grid.coordinates(i).map(|c| (c as f32).to_bits()).to_vec())
            .collect(),
        cpu: Cpu(words(field.cells())),
        gpu: FromGpu(words(&made)),
        kinds: vec![WordKind::Float; 4],
    })
}

/// Wind about positions in a whole field: what lies within 6 m, within all of it, and beyond its edge.
fn spread_case(gpu: &Gpu) -> Result<Run, GpuError> {
    let grid = WindGrid::new(Vec3::splat(-10.0), Vec3::new(10.0, 12.0, 9.0), [20, 17, 11]).expect("a grid");
    let origin = DVec3::new(3.0, -1.0, 2.0);
    let mask = WindMask::from_fn(&grid, |at| (at - Vec3::new(2.0, 0.0, 1.0)).length() < 4.0);
    let field = WindField::new(&grid, &primitives(), &mask).expect("a field").relative_to(origin);
    let places: Vec<(Vec3, f32)> = vec![
        // Beside the ball, within it, and beyond an edge.
        (Vec3::new(-9.3, 3.37, -6.21), 6.0),
        (Vec3::new(-8.17, 5.9, -5.3), 0.3),
        (Vec3::new(1.2, 5.3, 4.4), 100.0),
        (Vec3::new(-4.2, 0.6, -3.1), 2.0),
        (Vec3::new(30.0, 2.0, 3.0), 4.0),
    ];
    let words = |wind: Vec3, [slope, most]: [f32; 2]| [wind.x, wind.y, wind.z, slope, most].map(f32::to_bits);
    let cpu = places.iter().flat_map(|&(at, reach)| words(field.sample(at), field.spread(at, reach)));
    let made = || {
        let on_gpu = GpuWindField::new(gpu, &grid, field.matrices().len(), 0)?;
        on_gpu.set_mask(&mask)?;
        on_gpu.update(&primitives(), &[])?;
        let about = |&(at, reach): &(Vec3, f32)| on_gpu.about(origin, at, reach).map_err(GpuWindError::from);
        places.iter().map(about).collect::<Result<Vec<_>, GpuWindError>>()
    };
    let found = made().map_err(|error| match error {
        GpuWindError::Gpu(error) => error,
        other => panic!("{other}"),
    })?;
    Ok(Run {
        arguments: places.iter().map(|(at, reach)| at.extend(*reach).to_array().words()).collect(),
        cpu: Cpu(cpu.collect()),
        gpu: FromGpu(found.iter().flat_map(|about| words(about.wind, about.spread)).collect()),
        kinds: vec![WordKind::Float; 5],
    })
}

/// The kernel that begins a search for the spread.
const SPREAD_CLEARED: &[&Kernel] = &[&FIELD_SPREAD_CLEAR_KERNEL];

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let field = |name, run| KernelCase {
        name,
        kernel: &FIELD_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: Tol::relative(
            1.0e-5,
            2.0e-5,
            "a sum of 13 velocities up to 7 m/s, each known to 1e-6 of it, at positions known to 1e-6 m",
        ),
        run,
    };
    vec![
        field("main_wind_field: every primitive round a ball", |gpu| field_case(gpu, [20, 17, 11], 0.0, 0.0)),
        field("main_wind_field: a wide cut-off", |gpu| field_case(gpu, [16, 8, 33], 3.0, 0.0)),
        KernelCase {
            tol: Tol::relative(
                1.0e-5,
                1.0e-4,
                "as without turbulence, and up to 48 waves of 2 m/s at angles known to 1e-5",
            ),
            ..field("main_wind_field: turbulence too", |gpu| field_case(gpu, [32, 32, 32], 1.0, 2.0))
        },
        KernelCase {
            with: SPREAD_CLEARED,
            ..KernelCase::new(
                "main_wind_field_spread: about some places",
                &FIELD_SPREAD_KERNEL,
                Tol::relative(
                    3.0e-5,
                    6.0e-5,
                    "differences of winds that are known to 2e-5 m/s, some over 0.85 m",
                ),
                spread_case,
            )
        },
    ]
}
