//! `shaders/wgsl/lattice/puddle*.wgsl` against `downpour_lattice::puddle`.

use downpour_gpu::{Gpu, GpuError};
use downpour_lattice::gpu::puddle::{GpuPuddle, GpuPuddleError};
use downpour_lattice::puddle::lattice::{
    PuddleQuad, puddle_border, puddle_corner, puddle_keep, puddle_laplacian, puddle_linked, puddle_recur,
    puddle_settle, puddle_state_float, puddle_state_half, puddle_state_pack, puddle_state_unpack,
};
use downpour_lattice::puddle::{
    Impact, Puddle, PuddleBorder, PuddleForm, PuddleOptions, PuddleSeed, PuddleStorage, Wake,
    puddle_normal_lean, puddle_normal_slopes, puddle_normal_texel, puddle_seed_height, puddle_seed_shape,
    slope_levels,
};
use downpour_math::pyramid::pyramid_append;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::Kernel;
use downpour_shaders::common::PYRAMID_KERNEL;
use downpour_shaders::lattice::puddle::{
    DIRECT_KERNEL, NORMAL_KERNEL, PUDDLE, PUDDLE_MIN, PUDDLE_NORMAL, PUDDLE_SEED, PUDDLE_STATE, PUDDLE_STEP,
    SEED_KERNEL, SLOPES_KERNEL, STEP_KERNEL,
};

use crate::Domain::{AnyWord, Below, Fixed, Made, OneOf, Uniform};
use crate::compare::{Cpu, Gpu as FromGpu, POISON};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::{Args, IntoWords as _};
use crate::{Domain, FunctionCase, KernelCase, Tol};

/// One of the eight links.
fn link_words(random: [u32; 4]) -> Vec<u32> {
    vec![1 << (random[0] % 8)]
}

/// Weights of the membrane or of real water.
fn weight_words(random: [u32; 4]) -> Vec<u32> {
    let weights: [f32; 3] = if random[0].is_multiple_of(2) { [4.0, 1.0, 0.0] } else { [20.0, 4.0, 1.0] };
    weights.words()
}

/// A seed in the first square: a crater or a bump.
fn seed_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let per_length = 0.05 + 0.5 * c;
    let position = [20.0 + 20.0 * a, 20.0 + 20.0 * b];
    let mut words = position.words();
    let is_bump = !random[0].is_multiple_of(2);
    let reach = if is_bump { -6.0 } else { 6.0 } / per_length;
    words.extend([per_length, 2.0 * d - 1.0, 0.01 * a, reach].words());
    words
}

fn seed(args: &mut Args<'_>) -> PuddleSeed {
    let center = args.f32s();
    let [per_length, amplitude, lift, reach] = args.f32s();
    PuddleSeed { center, per_length, amplitude, lift, reach }
}

fn quad(args: &mut Args<'_>) -> PuddleQuad {
    args.f32s()
}

fn row(args: &mut Args<'_>) -> [PuddleQuad; 3] {
    std::array::from_fn(|_| quad(args))
}

const SUM: Tol = Tol::absolute(4.0e-6, "sums and products of numbers up to 40; a GPU may fuse them");

/// Numbers of each kind; one of the NaNs has its last bit set.
const FINITE_OR_NOT: [f32; 5] = [1.0, f32::NAN, f32::from_bits(0x7fc0_0001), f32::INFINITY, f32::MAX];

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let value = Uniform(-1.0, 1.0);
    let quads = |n: usize| -> Vec<Domain> { vec![value; 4 * n] };
    let with = |n: usize, more: &[Domain]| -> Vec<Domain> { [quads(n), more.to_vec()].concat() };
    let (fraction, cells) = (Uniform(0.0, 1.0), Uniform(0.0, 40.0));
    let at_reach = [20.5, 20.5, 0.1, 1.0, 0.5].map(Fixed);
    vec![
        FunctionCase::new(
            "puddle_linked",
            &PUDDLE,
            &with(2, &[AnyWord, Made(link_words)]),
            Tol::exact("a choice between values computes nothing"),
            |a| {
                let (own, other, links, link) = (quad(a), quad(a), a.u32(), a.u32());
                let cell = |i: usize| puddle_linked(own[i], other[i], links >> (8 * i), link);
                [cell(0), cell(1), cell(2), cell(3)].words()
            },
        ),
        FunctionCase::new(
            "puddle_corner",
            &PUDDLE,
            &with(4, &[AnyWord, Made(link_words), Made(link_words), Made(link_words)]),
            Tol::exact("a choice between values computes nothing"),
            |p| {
                let (own, a, b, diagonal) = (quad(p), quad(p), quad(p), quad(p));
                let (links, bits) = (p.u32(), p.u32s());
                let cell =
                    |i: usize| puddle_corner(own[i], [a[i], b[i]], diagonal[i], links >> (8 * i), bits);
                [cell(0), cell(1), cell(2), cell(3)].words()
            },
        ),
        FunctionCase::new(
            "puddle_laplacian",
            &PUDDLE,
            &with(9, &[AnyWord, Made(weight_words)]),
            Tol::absolute(1.0e-5, "sums of numbers up to 40, which cancel; a GPU may fuse the products"),
            |a| puddle_laplacian(row(a), row(a), row(a), a.u32(), a.f32s()).words(),
        ),
        FunctionCase::new("puddle_recur", &PUDDLE, &quads(4), SUM, |a| {
            let (wave, sum, now, before) = (quad(a), quad(a), quad(a), quad(a));
            let cell = |i: usize| puddle_recur(wave[i], sum[i], now[i], before[i]);
            [cell(0), cell(1), cell(2), cell(3)].words()
        }),
        FunctionCase::new(
            "puddle_border",
            &PUDDLE,
            &[Below(4096), Below(4096)],
            Tol::exact("integers and a half"),
            |a| puddle_border(a.u32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "puddle_keep",
            &PUDDLE,
            &[cells, fraction, cells, Uniform(0.0, 2.0)],
            Tol::relative(2.0e-6, 0.0, "divisions, 2.5 ulp each"),
            |a| puddle_keep(a.f32(), a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_settle",
            &PUDDLE,
            &[OneOf(&[
                0.0,
                -0.0,
                1.0,
                -3.5e-3,
                1.0e-19,
                -1.0e-19,
                PUDDLE_MIN,
                9.0e-21,
                -9.0e-21,
                f32::MAX,
                f32::INFINITY,
                f32::NEG_INFINITY,
                f32::NAN,
            ])],
            Tol::exact("a choice between values computes nothing"),
            |a| puddle_settle(a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_is_finite",
            &PUDDLE,
            &[OneOf(&FINITE_OR_NOT); 4],
            Tol::exact("bits are compared, nothing is computed"),
            |a| quad(a).map(downpour_math::ops::ops_is_finite).words(),
        ),
        FunctionCase::new(
            "puddle_state_half",
            &PUDDLE_STATE,
            &[Made(|random| {
                // Of every size that a half has, and some that it has not.
                let scale = f32::from_bits((100 + random[1] % 46) << 23);
                vec![(scale * (2.0 * rng_unit(random[0]) - 1.0)).to_bits()]
            })],
            Tol::exact("rounding is done with integers"),
            |a| puddle_state_half(a.f32()).words(),
        ),
        // Numbers halfway between two halves, and their neighbors on either side.
        FunctionCase::new(
            "puddle_state_half",
            &PUDDLE_STATE,
            &[Made(|random| {
                let half = (113 + random[1] % 29) << 23 | (random[0] % 1024) << 13 | random[3] & 0x8000_0000;
                vec![half + 0xfff + random[2] % 3]
            })],
            Tol::exact("rounding is done with integers"),
            |a| puddle_state_half(a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_state_float",
            &PUDDLE_STATE,
            &[Made(|random| vec![(random[0] % 0x7c00) | (random[1] & 0x8000)])],
            Tol::exact("16 bits widen exactly"),
            |a| puddle_state_float(a.u32()).words(),
        ),
        FunctionCase::new(
            "puddle_state_pack",
            &PUDDLE_STATE,
            &[Uniform(-1.0, 1.0), Uniform(-1.0, 1.0)],
            Tol::exact("rounding is done with integers"),
            |a| puddle_state_pack(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_state_unpack",
            &PUDDLE_STATE,
            &[Made(|random| vec![puddle_state_pack(rng_unit(random[0]) - 0.5, rng_unit(random[1]) - 0.5)])],
            Tol::exact("16 bits widen exactly, and the scale is a power of two"),
            |a| puddle_state_unpack(a.u32()).words(),
        ),
        FunctionCase::new(
            "puddle_step_shift",
            &PUDDLE_STEP,
            &quads(2)[..6],
            Tol::exact("nothing is computed"),
            |a| {
                let (before, q, after) = (a.f32(), quad(a), a.f32());
                [[before, q[0], q[1], q[2]], q, [q[1], q[2], q[3], after]].words()
            },
        ),
        FunctionCase::new(
            "puddle_step_settle",
            &PUDDLE_STEP,
            &[OneOf(&[0.0, 2.0, 1.0e-19, -9.0e-21, f32::NEG_INFINITY, f32::NAN]); 4],
            Tol::exact("a choice between values computes nothing"),
            |a| quad(a).map(puddle_settle).words(),
        ),
        FunctionCase::new(
            "puddle_seed_shape",
            &PUDDLE_SEED,
            &[Below(2), Uniform(0.0, 6.0)],
            Tol::absolute(
                1.0e-5,
                "exp of -6 to 0, and the sine of up to 12 rad, known to 2^-11 at worst beyond pi",
            ),
            |a| puddle_seed_shape(a.u32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_seed_height",
            &PUDDLE_SEED,
            &[Made(seed_words), Uniform(0.0, 64.0), Uniform(0.0, 64.0)],
            Tol::absolute(2.0e-5, "as the shape, of a distance known to 1e-5 lengths").with_outliers(1.0e-4),
            |a| puddle_seed_height(&seed(a), a.f32s()).words(),
        ),
        // Cells whose distance from the center is the reach of the seed, exactly.
        FunctionCase::new(
            "puddle_seed_height",
            &PUDDLE_SEED,
            &[
                at_reach.as_slice(),
                &[
                    OneOf(&[10.0, -10.0]),
                    OneOf(&[10.0, 12.0, 14.0, 20.0, 26.0, 30.0]),
                    OneOf(&[20.0, 26.0, 28.0]),
                ],
            ]
            .concat(),
            Tol::absolute(2.0e-5, "as the shape, of a distance known to 1e-5 lengths"),
            |a| puddle_seed_height(&seed(a), a.f32s()).words(),
        ),
        FunctionCase::new(
            "puddle_normal_slopes",
            &PUDDLE_NORMAL,
            &with(9, &[AnyWord, Uniform(0.1, 10.0)]),
            Tol::absolute(2.0e-5, "sums of up to 8, times up to 10"),
            |a| puddle_normal_slopes(row(a), row(a), row(a), a.u32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "puddle_normal_lean",
            &PUDDLE_NORMAL,
            &[Uniform(-3.0, 3.0), Uniform(-3.0, 3.0)],
            Tol::absolute(1.0e-6, "a square root and a division (2.5 ulp each)"),
            |a| puddle_normal_lean(a.f32s()).words(),
        ),
        FunctionCase::new(
            "puddle_normal_texel",
            &PUDDLE_NORMAL,
            &[Uniform(-3.0, 3.0), Uniform(-3.0, 3.0)],
            Tol::relative(
                4.0e-5,
                1.0e-7,
                "what is left of 1 is 0.05 at least, known to 2e-7; its root divides, and the square doubles it",
            ),
            |a| puddle_normal_texel(a.f32s()).words(),
        ),
        // A surface that stands, whose slope is limited.
        FunctionCase::new(
            "puddle_normal_texel",
            &PUDDLE_NORMAL,
            &[OneOf(&[0.0, 3.0e4, -3.0e4, 1.0e5]), Fixed(4.0e5)],
            Tol::relative(2.0e-6, 1.0e-7, "a root, and a division by 0.001"),
            |a| puddle_normal_texel(a.f32s()).words(),
        ),
    ]
}

fn told(error: GpuPuddleError) -> GpuError {
    match error {
        GpuPuddleError::Gpu(error) => error,
        other => GpuError::Refused { what: "a puddle".to_owned(), reason: other.to_string() },
    }
}

/// Two puddles among islands with the same rough water.
fn pair(gpu: &Gpu, options: &PuddleOptions) -> Result<(Puddle, GpuPuddle), GpuError> {
    let [nx, ny] = options.size;
    let random = |i: u32, dimension| rng_unit(rng_draw([8, 9], i, 0, dimension)[0]);
    let land: Vec<bool> = (0..nx * ny).map(|i| random(i / 3, 0) < 0.03).collect();
    let mut cpu = Puddle::with_land(options, &land).expect("a puddle");
    let mut on_gpu = GpuPuddle::with_land(gpu, options, &land).map_err(told)?;
    // Smooth enough that a step is short beside the waves: every number is of order 1e-3.
    let heights: Vec<f32> = (0..nx * ny)
        .map(|i| 1.0e-3 * (random(i / 4, 1) + random(i % nx, 2) + random(i / nx, 3) - 1.5))
        .collect();
    let velocities: Vec<f32> = (0..nx * ny).map(|i| 0.02 * (random(i, 4) - 0.5)).collect();
    cpu.set_state(&heights, &velocities).expect("as many as cells");
    on_gpu.set_state(&heights, &velocities).map_err(told)?;
    Ok((cpu, on_gpu))
}

fn run_of(nx: u32, cpu: &[Vec<f32>], gpu: &[Vec<f32>]) -> Run {
    let words = |columns: &[Vec<f32>]| -> Vec<u32> {
        (0..columns[0].len()).flat_map(|i| columns.iter().map(move |c| c[i].to_bits())).collect()
    };
    let cell = |i: u32| [i % nx, i / nx].map(|c| (c as f32).to_bits()).to_vec();
    Run {
        arguments: (0..cpu[0].len() as u32).map(cell).collect(),
        cpu: Cpu(words(cpu)),
        gpu: FromGpu(words(gpu)),
        kinds: vec![WordKind::Float; cpu.len()],
    }
}

/// Some steps, compared as heights and velocities. Velocities are scaled to the size of heights.
fn steps(gpu: &Gpu, options: &PuddleOptions, dt_s: f32, count: u32) -> Result<Run, GpuError> {
    let (mut cpu, mut on_gpu) = pair(gpu, options)?;
    for _ in 0..count {
        let parts = cpu.step(dt_s).expect("a step");
        assert_eq!(on_gpu.step(dt_s).map_err(told)?, parts);
    }
    assert_eq!(on_gpu.reset_cells().map_err(told)?, cpu.reset_cells());
    let slow = |v: Vec<f32>| v.into_iter().map(|v| 0.01 * v).collect::<Vec<f32>>();
    let [heights, velocities] = on_gpu.state().map_err(told)?;
    let cpu = [cpu.heights(), slow(cpu.velocities())];
    Ok(run_of(options.size[0], &cpu, &[heights, slow(velocities)]))
}

/// A step of water with cells so high that their neighbors overflow, which are reset and counted.
fn spoiled(gpu: &Gpu, options: &PuddleOptions) -> Result<Run, GpuError> {
    let (mut cpu, mut on_gpu) = pair(gpu, options)?;
    let (mut heights, velocities) = (cpu.heights(), cpu.velocities());
    let [nx, ny] = options.size;
    for k in 0..7 {
        heights[(nx * (ny * (2 * k + 1) / 14) + nx * (k + 1) / 8) as usize] = 3.0e38;
    }
    cpu.set_state(&heights, &velocities).expect("as many as cells");
    on_gpu.set_state(&heights, &velocities).map_err(told)?;
    let parts = cpu.step(0.002).expect("a step");
    assert_eq!(on_gpu.step(0.002).map_err(told)?, parts);
    let [on_cpu, there] = [cpu.reset_cells(), on_gpu.reset_cells().map_err(told)?];
    assert!(on_cpu > 10, "{on_cpu} cells");
    let counted = |heights: Vec<f32>, count: u64| [heights, vec![count as f32; 1]].concat();
    let [made, _] = on_gpu.state().map_err(told)?;
    Ok(run_of(nx, &[counted(cpu.heights(), on_cpu)], &[counted(made, there)]))
}

fn seeds(gpu: &Gpu) -> Result<Run, GpuError> {
    // Squares of 64 cells: three across, and three down, of which one is cut.
    let options = PuddleOptions { size: [192, 131], ..PuddleOptions::default() };
    let (mut cpu, mut on_gpu) = pair(gpu, &options)?;
    let impacts: Vec<Impact> = (0..40)
        .map(|i| {
            let [x, y, z, _] = rng_draw([1, 1], i, 0, 0).map(rng_unit);
            Impact {
                position_m: [0.32 * x - 0.01, 0.28 * y - 0.01],
                speed_m_s: 2.0 + 6.0 * z,
                diameter_m: 0.5e-3 + 3.0e-3 * z,
            }
        })
        .collect();
    let wake = Wake { from_m: [0.1, 0.1], to_m: [0.12, 0.13], radius_m: 0.03, draft_m: 2.0e-3 };
    cpu.seed(&impacts).expect("drops");
    cpu.displace(&wake).expect("a wake");
    on_gpu.seed(&impacts).map_err(told)?;
    on_gpu.displace(&wake).map_err(told)?;
    Ok(run_of(192, &[cpu.heights()], &[on_gpu.heights().map_err(told)?]))
}

fn normals(gpu: &Gpu) -> Result<Run, GpuError> {
    let options = PuddleOptions { size: [150, 131], ..PuddleOptions::default() };
    let (cpu, on_gpu) = pair(gpu, &options)?;
    let columns =
        |normals: Vec<[f32; 3]>| [0, 1, 2].map(|k| normals.iter().map(|n| n[k]).collect::<Vec<f32>>());
    Ok(run_of(150, &columns(cpu.normals()), &columns(on_gpu.normals().map_err(told)?)))
}

/// Slopes in levels, behind five texels of something else.
fn slopes(gpu: &Gpu, options: &PuddleOptions) -> Result<Run, GpuError> {
    const FIRST: usize = 5;
    let (cpu, on_gpu) = pair(gpu, options)?;
    let mut texels = cpu.slopes();
    for level in slope_levels(options.size) {
        pyramid_append(&mut texels, &level);
    }
    let slopes = on_gpu.slopes();
    assert_eq!(slopes.texel_count() as usize, texels.len());
    let poison = vec![[f32::from_bits(POISON); 4]; FIRST + texels.len() + 1];
    let buffer = gpu.storage_buffer("texels", &poison)?;
    gpu.submit(&slopes.prepare(gpu, &buffer, FIRST as u32)?.dispatches())?;
    let made = gpu.read::<[f32; 4]>(&buffer)?;
    let words = |texels: &[[f32; 4]]| -> Vec<u32> { texels.iter().flatten().map(|v| v.to_bits()).collect() };
    let beside = [&made[..FIRST], &made[FIRST + texels.len()..]].concat();
    assert!(words(&beside).iter().all(|&word| word == POISON), "texels of something else are written");
    Ok(Run {
        arguments: (0..texels.len()).map(|i| vec![(i as f32).to_bits()]).collect(),
        cpu: Cpu(words(&texels)),
        gpu: FromGpu(words(&made[FIRST..FIRST + texels.len()])),
        kinds: vec![WordKind::Float; 4],
    })
}

static PYRAMID: &[&Kernel] = &[&PYRAMID_KERNEL];

const SLOPES: Tol = Tol::relative(
    1.0e-4,
    2.0e-5,
    "slopes of up to 1.5 from heights of 1e-3 m over 2 mm, each known to 1e-7, by way of a normal; means of them",
);

const STEPS: Tol = Tol::absolute(
    6.0e-9,
    "heights of 1e-3 m and velocities of 0.1 m/s over 100, some dozens of passes: each rounds to 1e-7 of them, and a GPU may fuse products",
);

const OVERFLOWS: Tol = Tol::relative(1.0e-5, 6.0e-9, "as the steps above; some heights are of 1e38 m");

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let step = |name, tol, run| KernelCase {
        name,
        kernel: &STEP_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol,
        run,
    };
    vec![
        step("main_puddle_step: real water, several sweeps", STEPS, |gpu| {
            let options =
                PuddleOptions { size: [203, 131], border: PuddleBorder::Open, ..PuddleOptions::default() };
            steps(gpu, &options, 0.03, 1)
        }),
        step(
            "main_puddle_step: the membrane in sixteen bits, eight steps per dispatch",
            Tol::absolute(2.0e-6, "as the step in sixteen bits"),
            |gpu| {
                let (form, storage) = (PuddleForm::Membrane { speed_m_s: 0.3 }, PuddleStorage::Half);
                let options = PuddleOptions {
                    size: [256, 64],
                    form,
                    storage,
                    cell_m: 0.01,
                    ..PuddleOptions::default()
                };
                steps(gpu, &options, 0.2, 1)
            },
        ),
        KernelCase {
            name: "main_lattice_puddle_step_direct: the membrane among islands, with an open border",
            kernel: &DIRECT_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: STEPS,
            run: |gpu| {
                let (form, border) = (PuddleForm::Membrane { speed_m_s: 0.3 }, PuddleBorder::Open);
                let options = PuddleOptions {
                    size: [203, 101],
                    form,
                    border,
                    cell_m: 0.01,
                    ..PuddleOptions::default()
                };
                steps(gpu, &options, 0.2, 1)
            },
        },
        KernelCase {
            name: "main_lattice_puddle_step_direct: water of degree 1, whose diagonal neighbors have a weight",
            kernel: &DIRECT_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: STEPS,
            run: |gpu| {
                let options = PuddleOptions { size: [97, 131], degree: Some(1), ..PuddleOptions::default() };
                steps(gpu, &options, 0.03, 1)
            },
        },
        step("main_puddle_step: cells that overflow", OVERFLOWS, |gpu| {
            spoiled(gpu, &PuddleOptions { size: [97, 101], steps_per_sweep: 1, ..PuddleOptions::default() })
        }),
        KernelCase {
            name: "main_lattice_puddle_step_direct: cells that overflow",
            kernel: &DIRECT_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: OVERFLOWS,
            run: |gpu| {
                spoiled(gpu, &PuddleOptions { size: [97, 131], degree: Some(1), ..PuddleOptions::default() })
            },
        },
        step("main_puddle_step: one step of twelve passes", STEPS, |gpu| {
            let options = PuddleOptions {
                size: [97, 101],
                depth_m: 0.5,
                degree: Some(12),
                steps_per_sweep: 1,
                ..PuddleOptions::default()
            };
            steps(gpu, &options, 0.001, 1)
        }),
        step(
            "main_puddle_step: sixteen bits",
            Tol::absolute(
                2.0e-6,
                "a half has 2^-11 of 2e-3 m: results that differ by rounding fall to either side",
            ),
            |gpu| {
                let storage = PuddleStorage::Half;
                let options = PuddleOptions { size: [130, 70], storage, ..PuddleOptions::default() };
                steps(gpu, &options, 0.004, 1)
            },
        ),
        KernelCase {
            name: "main_puddle_step: sixteen bits are packed as on the CPU",
            kernel: &STEP_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: Tol::absolute(2.0e-6, "as the step in sixteen bits; the velocity's half in its position"),
            run: |gpu| {
                let storage = PuddleStorage::Half;
                let options = PuddleOptions { size: [65, 66], storage, ..PuddleOptions::default() };
                steps(gpu, &options, 0.002, 1)
            },
        },
        KernelCase {
            name: "main_puddle_seed: drops and an object among islands",
            kernel: &SEED_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: Tol::absolute(5.0e-8, "forty craters of up to 2.5 mm, each known to 2e-5 of it"),
            run: seeds,
        },
        KernelCase {
            name: "main_puddle_normal: rough water among islands",
            kernel: &NORMAL_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: Tol::absolute(6.0e-5, "components in 16 bits, 1.6e-5 each; the third is what is left of 1"),
            run: normals,
        },
        KernelCase {
            name: "main_puddle_normal_slopes: rough water among islands, in levels",
            kernel: &SLOPES_KERNEL,
            with: PYRAMID,
            overrides: &[],
            text: None,
            tol: SLOPES,
            run: |gpu| slopes(gpu, &PuddleOptions { size: [150, 131], ..PuddleOptions::default() }),
        },
        KernelCase {
            name: "main_puddle_normal_slopes: a square in sixteen bits, in levels",
            kernel: &SLOPES_KERNEL,
            with: PYRAMID,
            overrides: &[],
            text: None,
            tol: SLOPES,
            run: |gpu| {
                let storage = PuddleStorage::Half;
                slopes(gpu, &PuddleOptions { size: [128, 128], storage, ..PuddleOptions::default() })
            },
        },
    ]
}
