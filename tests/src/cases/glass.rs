//! `shaders/wgsl/lattice/glass*` against `downpour_lattice::glass`.

use std::sync::Arc;

use downpour_gpu::{Gpu, GpuError};
use downpour_lattice::glass::blade::{
    GlassBlade, glass_blade_ahead, glass_blade_moved, glass_blade_push, glass_blade_side, glass_blade_sweeps,
};
use downpour_lattice::glass::frame::{
    GlassFrame, glass_frame_cell, glass_frame_holds, glass_frame_index, glass_frame_landing,
};
use downpour_lattice::glass::height::{glass_height_cap, glass_height_squared, glass_height_stretch};
use downpour_lattice::glass::motion::{
    glass_motion_choose, glass_motion_length, glass_motion_merged, glass_motion_octant, glass_motion_offset,
    glass_motion_pack, glass_motion_root, glass_motion_slide, glass_motion_turn, glass_motion_unit,
    glass_motion_unpack, glass_motion_weight, glass_motion_wetness,
};
use downpour_lattice::glass::normal::glass_normal_unit;
use downpour_lattice::glass::ridge::{
    glass_ridge_ahead, glass_ridge_center, glass_ridge_flow, glass_ridge_is, glass_ridge_key,
};
use downpour_lattice::glass::size::{
    GlassSizeRow, glass_size_class, glass_size_floor, glass_size_fraction, glass_size_key, glass_size_mix,
    glass_size_row,
};
use downpour_lattice::glass::{
    Glass, GlassAir, GlassOptions, GlassRain, GlassWiper, GlassWiperMotion, GlassWornBand,
};
use downpour_lattice::gpu::glass::{GpuGlass, GpuGlassError};
use downpour_math::rng::rng_draw;
use downpour_shaders::Kernel;
use downpour_shaders::lattice::glass as shaders;
use glam::{IVec2, UVec2, UVec3};

use crate::Domain::{AnyWord, Below, Made};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::kept::kept;
use crate::signature::WordKind;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

const INTEGERS: Tol = Tol::exact("integers are exact");

/// A component between -`limit` and `limit`.
fn within(word: u32, limit: i32) -> u32 {
    ((word % (2 * limit as u32 + 1)) as i32 - limit) as u32
}

/// The words of a velocity of at most a cell in a tick in each direction; every eighth is small.
fn velocity(random: [u32; 4]) -> Vec<u32> {
    let limit = if random[2] & 7 == 0 { 3 } else { 11_585 };
    vec![within(random[0], limit), within(random[1], limit)]
}

/// The words of what drives a drop.
fn drive(random: [u32; 4]) -> Vec<u32> {
    vec![within(random[0], 16_383), within(random[1], 16_383)]
}

/// The words of a cell up to 4096 cells from the corner.
fn cell(random: [u32; 4]) -> Vec<u32> {
    vec![random[0] % 4096, random[1] % 4096]
}

/// A mass of any size.
fn mass(random: [u32; 4]) -> Vec<u32> {
    vec![1 + ((random[0] % shaders::GLASS_MAX_MASS) >> (random[1] % 18))]
}

fn ivec2(args: &mut Args<'_>) -> IVec2 {
    IVec2::from(args.u32s::<2>().map(|w| w as i32))
}

fn words(v: IVec2) -> Vec<u32> {
    v.to_array().map(|c| c as u32).to_vec()
}

/// The words of a row, each below 2^20.
fn row_words(random: [u32; 4]) -> Vec<u32> {
    let more = rng_draw([random[0], random[1]], random[2], random[3], 1);
    let words: Vec<u32> = random.into_iter().chain(more).map(|w| w >> 12).collect();
    words
}

fn row(args: &mut Args<'_>) -> GlassSizeRow {
    let [radius, hold, slow, air, sphere, loss, ridge, ahead] = args.u32s();
    GlassSizeRow { radius, hold, slow, air, sphere, loss, ridge, ahead }
}

/// The words of a blade that turns somewhere about the pane.
fn blade_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = rng_draw([random[0], random[1]], random[2], random[3], 2);
    let angle = f64::from(random[0]) * 1.0e-9;
    let turned = angle + (f64::from(random[1]) / f64::from(u32::MAX) - 0.5) * 0.1;
    let points = |angle: f64| {
        use downpour_math::ops::f64 as ops;
        [ops::cos(angle), ops::sin(angle)].map(|c| (16384.0 * c).round() as i32 as u32)
    };
    let turn = (random[2] % 3) as i32 - 1;
    let mut words = [points(angle), points(turned)].concat();
    words.extend([within(a, 8000), within(b, 8000), c % 4000, 4000 + d % 4000]);
    words.extend([turn as u32, random[3] % 257, a % 400_000, 0]);
    words
}

fn blade(args: &mut Args<'_>) -> GlassBlade {
    let before = ivec2(args).to_array();
    let after = ivec2(args).to_array();
    let pivot = ivec2(args).to_array();
    let reach = ivec2(args).to_array();
    let [turn, leaves, film, unused] = args.u32s();
    GlassBlade { before, after, pivot, reach, turn: turn as i32, leaves, film, unused }
}

/// The words of a blade that begins or ends its tick along +x, and of a cell on that line or beside it.
fn beside_blade(random: [u32; 4]) -> Vec<u32> {
    let [which, x, y, away] = rng_draw([random[0], random[1]], random[2], random[3], 3);
    let mut words = blade_words(random);
    let (straight, other) = if which & 1 == 0 { (0, 2) } else { (2, 0) };
    words[straight..straight + 2].copy_from_slice(&[16_384, 0]);
    words[other..other + 2].copy_from_slice(&[16_376, within(away, 512)]);
    // Odd, so that centers of cells are on the line.
    words[5] = 2 * (y % 2000) + 1;
    words.extend([x % 4096, y % 2000 + (which >> 1) % 3]);
    words
}

/// The words of a frame of 8 to 4103 cells along each edge; limits of the rain that fall.
fn frame_words(random: [u32; 4]) -> Vec<u32> {
    let mut words = vec![8 + random[0] % 4096, 8 + random[1] % 4096];
    words.extend([0; 22]);
    words.extend((0..8).map(|k| random[2] >> (3 * k)));
    words
}

/// The words of a frame, and a word of chance that often is one of its limits.
fn landing(random: [u32; 4]) -> Vec<u32> {
    let mut words = frame_words(random);
    let limit = words[24 + (random[0] % 8) as usize];
    words.push(if random[1] & 1 == 0 { random[3] } else { limit });
    words
}

fn frame(args: &mut Args<'_>) -> GlassFrame {
    let words: [u32; 32] = args.u32s();
    let (mut frame, [.., a, b, c, d, e, f, g, h]) = (GlassFrame::default(), words);
    frame.size = [words[0], words[1]];
    (frame.rain_few, frame.rain_many) = ([a, b, c, d], [e, f, g, h]);
    frame
}

/// A cell on or near a pane.
fn near(random: [u32; 4]) -> Vec<u32> {
    vec![within(random[0], 4200), within(random[1], 4200)]
}

fn sizes() -> Vec<FunctionCase> {
    let m = &shaders::SIZE;
    let (mass, row_of) = (Made(mass), Made(row_words));
    vec![
        FunctionCase::new("glass_size_class", m, &[mass], INTEGERS, |a| glass_size_class(a.u32()).words()),
        FunctionCase::new("glass_size_floor", m, &[Below(130)], INTEGERS, |a| {
            glass_size_floor(a.u32()).words()
        }),
        FunctionCase::new("glass_size_fraction", m, &[mass], INTEGERS, |a| {
            glass_size_fraction(a.u32()).words()
        }),
        FunctionCase::new("glass_size_key", m, &[mass, Below(1 << 24)], INTEGERS, |a| {
            glass_size_key(a.u32(), a.u32()).words()
        }),
        FunctionCase::new(
            "glass_size_mix",
            m,
            &[Below(1 << 22), Below(1 << 22), Below(257)],
            INTEGERS,
            |a| glass_size_mix(a.u32(), a.u32(), a.u32()).words(),
        ),
        FunctionCase::new("glass_size_row", m, &[row_of, row_of, Below(257)], INTEGERS, |a| {
            let r = glass_size_row(row(a), row(a), a.u32());
            vec![r.radius, r.hold, r.slow, r.air, r.sphere, r.loss, r.ridge, r.ahead]
        }),
    ]
}

fn motions() -> Vec<FunctionCase> {
    let m = &shaders::MOTION;
    let (v, octant) = (Made(velocity), Below(16));
    vec![
        FunctionCase::new("glass_motion_root", m, &[Below(1 << 31)], INTEGERS, |a| {
            glass_motion_root(a.u32()).words()
        }),
        FunctionCase::new("glass_motion_length", m, &[v], INTEGERS, |a| {
            glass_motion_length(ivec2(a)).words()
        }),
        FunctionCase::new("glass_motion_pack", m, &[v], INTEGERS, |a| glass_motion_pack(ivec2(a)).words()),
        FunctionCase::new("glass_motion_unpack", m, &[AnyWord], INTEGERS, |a| {
            words(glass_motion_unpack(a.u32()))
        }),
        FunctionCase::new("glass_motion_octant", m, &[v], INTEGERS, |a| {
            glass_motion_octant(ivec2(a)).words()
        }),
        FunctionCase::new("glass_motion_offset", m, &[octant], INTEGERS, |a| {
            words(glass_motion_offset(a.u32()))
        }),
        FunctionCase::new("glass_motion_unit", m, &[octant], INTEGERS, |a| {
            vec![glass_motion_unit(a.u32()) as u32]
        }),
        FunctionCase::new(
            "glass_motion_slide",
            m,
            &[v, Made(drive), Below(12_000), Below(16_385)],
            INTEGERS,
            |a| words(glass_motion_slide(ivec2(a), ivec2(a), a.u32(), a.u32())),
        ),
        // Faster than a number of 16 bits holds, with little friction and much viscosity.
        FunctionCase::new(
            "glass_motion_slide",
            m,
            &[Made(|r| vec![within(r[0], 25_000), within(r[1], 25_000)]), Made(drive), Below(3), Below(8192)],
            INTEGERS,
            |a| words(glass_motion_slide(ivec2(a), ivec2(a), a.u32(), a.u32())),
        ),
        FunctionCase::new(
            "glass_motion_weight",
            m,
            &[v, octant, Below(256), Below(511), Below(65), Below(65)],
            INTEGERS,
            |a| glass_motion_weight(ivec2(a), a.u32(), a.u32(), a.u32(), UVec2::from(a.u32s())).words(),
        ),
        FunctionCase::new(
            "glass_motion_choose",
            m,
            &[Below(3000), Below(3000), Below(16_385), AnyWord],
            INTEGERS,
            |a| glass_motion_choose(UVec3::from(a.u32s()), a.u32()).words(),
        ),
        // So few that all may be 0, or their sum 1.
        FunctionCase::new(
            "glass_motion_choose",
            m,
            &[Below(2), Below(2), Below(2), AnyWord],
            INTEGERS,
            |a| glass_motion_choose(UVec3::from(a.u32s()), a.u32()).words(),
        ),
        FunctionCase::new("glass_motion_turn", m, &[v, octant], INTEGERS, |a| {
            words(glass_motion_turn(ivec2(a), a.u32()))
        }),
        FunctionCase::new("glass_motion_merged", m, &[v, Below(128), Made(mass)], INTEGERS, |a| {
            words(glass_motion_merged(ivec2(a), a.u32(), a.u32()))
        }),
        FunctionCase::new(
            "glass_motion_wetness",
            m,
            &[Below(1 << 20), Below(1 << 20), Made(|r| vec![1 + r[0] % 16_000])],
            INTEGERS,
            |a| glass_motion_wetness(a.u32(), a.u32(), a.u32()).words(),
        ),
    ]
}

fn positions() -> Vec<FunctionCase> {
    let (blade_of, frame_of, at) = (Made(blade_words), Made(frame_words), Made(near));
    vec![
        FunctionCase::new("glass_blade_side", &shaders::BLADE, &[Made(drive), Made(drive)], INTEGERS, |a| {
            vec![glass_blade_side(ivec2(a), ivec2(a)) as u32]
        }),
        FunctionCase::new("glass_blade_sweeps", &shaders::BLADE, &[blade_of, Made(cell)], INTEGERS, |a| {
            glass_blade_sweeps(&blade(a), ivec2(a)).words()
        }),
        FunctionCase::new("glass_blade_sweeps", &shaders::BLADE, &[Made(beside_blade)], INTEGERS, |a| {
            glass_blade_sweeps(&blade(a), ivec2(a)).words()
        }),
        FunctionCase::new(
            "glass_blade_push",
            &shaders::BLADE,
            &[blade_of, Made(cell), Made(|r| vec![within(r[0], 4)])],
            INTEGERS,
            |a| words(glass_blade_push(&blade(a), ivec2(a), a.u32() as i32)),
        ),
        FunctionCase::new("glass_blade_ahead", &shaders::BLADE, &[blade_of], INTEGERS, |a| {
            words(glass_blade_ahead(&blade(a)))
        }),
        FunctionCase::new("glass_blade_moved", &shaders::BLADE, &[blade_of, Made(cell)], INTEGERS, |a| {
            vec![glass_blade_moved(&blade(a), ivec2(a)) as u32]
        }),
        FunctionCase::new("glass_frame_index", &shaders::FRAME, &[frame_of, Made(cell)], INTEGERS, |a| {
            glass_frame_index(&frame(a), ivec2(a)).words()
        }),
        FunctionCase::new("glass_frame_cell", &shaders::FRAME, &[frame_of, Below(1 << 24)], INTEGERS, |a| {
            words(glass_frame_cell(&frame(a), a.u32()))
        }),
        FunctionCase::new("glass_frame_holds", &shaders::FRAME, &[frame_of, at], INTEGERS, |a| {
            glass_frame_holds(&frame(a), ivec2(a)).words()
        }),
        FunctionCase::new("glass_frame_landing", &shaders::FRAME, &[Made(landing)], INTEGERS, |a| {
            glass_frame_landing(&frame(a), a.u32()).words()
        }),
    ]
}

/// A direction of length 16384.
fn direction(random: [u32; 4]) -> Vec<u32> {
    use downpour_math::ops::f64 as ops;
    let angle = f64::from(random[0]) * 1.0e-9;
    [ops::cos(angle), ops::sin(angle)].map(|c| (16384.0 * c).round() as i32 as u32).to_vec()
}

fn ridges() -> Vec<FunctionCase> {
    let m = &shaders::RIDGE;
    let ahead = Made(direction);
    // Progress of drops of either sign, and the words of ridges.
    let progress = Made(|r| {
        let small = within(r[0], 40_000);
        vec![if r[1] & 1 == 0 { small } else { shaders::GLASS_RIDGE | (r[0] & 65_535) }]
    });
    let down = Made(|r| vec![within(r[0], 16_384)]);
    vec![
        FunctionCase::new("glass_ridge_is", m, &[progress], INTEGERS, |a| glass_ridge_is(a.u32()).words()),
        FunctionCase::new("glass_ridge_center", m, &[Made(cell), ahead, Below(16_384)], INTEGERS, |a| {
            words(glass_ridge_center(ivec2(a), ivec2(a), a.u32()))
        }),
        FunctionCase::new("glass_ridge_flow", m, &[Made(mass), down, Below(8192)], INTEGERS, |a| {
            glass_ridge_flow(a.u32(), a.u32() as i32, a.u32()).words()
        }),
        // As much water as counts, and so little drain that the limit of the fall does not hide it.
        FunctionCase::new(
            "glass_ridge_flow",
            m,
            &[Made(|r| vec![65_000 + r[0] % 2000]), down, Below(3)],
            INTEGERS,
            |a| glass_ridge_flow(a.u32(), a.u32() as i32, a.u32()).words(),
        ),
        FunctionCase::new("glass_ridge_key", m, &[ahead], INTEGERS, |a| glass_ridge_key(ivec2(a)).words()),
        FunctionCase::new("glass_ridge_ahead", m, &[AnyWord], INTEGERS, |a| {
            words(glass_ridge_ahead(a.u32()))
        }),
    ]
}

fn heights() -> Vec<FunctionCase> {
    let m = &shaders::HEIGHT;
    vec![
        FunctionCase::new("glass_height_stretch", m, &[Below(20_000)], INTEGERS, |a| {
            glass_height_stretch(a.u32()).words()
        }),
        FunctionCase::new(
            "glass_height_squared",
            m,
            &[Made(|r| vec![within(r[0], 97), within(r[1], 97)]), Made(velocity)],
            INTEGERS,
            |a| glass_height_squared(ivec2(a), ivec2(a)).words(),
        ),
        FunctionCase::new(
            "glass_height_cap",
            m,
            &[Made(|r| vec![r[0] % 8193, 8192 + r[1] % 36_000]), Below(1 << 26)],
            INTEGERS,
            |a| glass_height_cap(a.u32(), a.u32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "glass_normal_unit",
            &shaders::NORMAL,
            &[Made(|r| vec![within(r[0], 20_000), within(r[1], 20_000)])],
            Tol::relative(1.0e-6, 1.0e-7, "a square root and a division (2.5 ulp each)"),
            |a| glass_normal_unit(ivec2(a)).to_array().words(),
        ),
    ]
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    [sizes(), motions(), positions(), ridges(), heights()].into_iter().flatten().collect()
}

/// A small windshield with everything: rain, air, drying, obstacles, a wiper with a worn band.
fn everything() -> GlassOptions {
    let size = [72, 50];
    let wiper = GlassWiper {
        pivot_m: [0.02, 0.032],
        inner_m: 0.004,
        outer_m: 0.025,
        motion: GlassWiperMotion::Sweep { from_rad: 0.1, to_rad: 2.9, period_s: 1.5 },
        film_m: 1.0e-6,
        worn: vec![GlassWornBand { from_m: 0.012, to_m: 0.015, leaves: 0.5 }],
    };
    GlassOptions {
        size,
        tilt_rad: 0.9,
        rain: GlassRain { rate_mm_h: 200.0, towards_m_s: 15.0, ..GlassRain::default() },
        air: GlassAir { speed_m_s: 17.0, direction_rad: 1.2, ..GlassAir::default() },
        obstacles: Some((0..size[0] * size[1]).map(|i| i % 72 > 50 && i % 72 < 56 && i / 72 > 30).collect()),
        evaporation_mm_h: 20.0,
        wipers: vec![wiper],
        seed: 0x1234_5678_9abc,
        ..GlassOptions::default()
    }
}

/// A window down which drops run.
fn window() -> GlassOptions {
    GlassOptions {
        size: [64, 96],
        rain: GlassRain { rate_mm_h: 300.0, towards_m_s: 12.0, ..GlassRain::default() },
        seed: 5,
        ..GlassOptions::default()
    }
}

/// A strip so narrow that what draws a drop aside is often off the pane.
fn strip() -> GlassOptions {
    GlassOptions {
        size: [12, 500],
        tilt_rad: 1.5,
        rain: GlassRain { rate_mm_h: 500.0, towards_m_s: 20.0, ..GlassRain::default() },
        seed: 11,
        ..GlassOptions::default()
    }
}

fn told(error: GpuGlassError) -> GpuError {
    match error {
        GpuGlassError::Gpu(error) => error,
        other => GpuError::Refused { what: "a pane".to_owned(), reason: other.to_string() },
    }
}

/// Mass, motion and heights of each cell after some seconds with a few large drops poured at the start.
fn cells(gpu: &Gpu, options: &GlassOptions) -> Result<(Arc<Glass>, GpuGlass), GpuError> {
    let [width, height] = options.size;
    let poured = [(10, 5), (30, 8), (40, 20)].map(|(x, y): (u32, u32)| (x % width, y % height));
    let steps = [0.3, 0.01, 0.69, 1.0];
    let cpu = kept(&format!("{options:?}"), || {
        let mut cpu = Glass::new(options).expect("a pane");
        poured.iter().for_each(|&(x, y)| cpu.pour(x, y, 25.0e-9).expect("a free cell"));
        steps.iter().for_each(|&dt| cpu.step(dt).expect("a step"));
        cpu
    });
    let mut twin = GpuGlass::new(gpu, options).map_err(told)?;
    for (x, y) in poured {
        twin.pour(x, y, 25.0e-9).map_err(told)?;
    }
    for dt in steps {
        twin.step(dt).map_err(told)?;
    }
    Ok((cpu, twin))
}

fn arguments(options: &GlassOptions) -> Vec<Vec<u32>> {
    (0..options.size[0] * options.size[1]).map(|i| vec![i % options.size[0], i / options.size[0]]).collect()
}

/// The lattice: mass, velocity, progress, and the totals in each result so that all are compared.
fn lattice_case(gpu: &Gpu, options: &GlassOptions) -> Result<Run, GpuError> {
    let (cpu, twin) = cells(gpu, options)?;
    let totals = |t: downpour_lattice::glass::GlassTotals| -> Vec<u32> {
        [t.landed, t.poured, t.stored, t.over_edge, t.evaporated, t.wiped, t.spilled, t.saturated]
            .into_iter()
            .flat_map(|n| [n as u32, (n >> 32) as u32])
            .collect()
    };
    let words = |mass: &[u32], motion: &[[u32; 2]], totals: &[u32]| -> Vec<u32> {
        let total = |i: usize| totals[i % totals.len()];
        mass.iter().zip(motion).enumerate().flat_map(|(i, (&m, &[v, p]))| [m, v, p, total(i)]).collect()
    };
    Ok(Run {
        arguments: arguments(options),
        cpu: Cpu(words(cpu.mass(), cpu.motion(), &totals(cpu.totals()))),
        gpu: FromGpu(words(&twin.mass()?, &twin.motion()?, &totals(twin.totals()?))),
        kinds: vec![WordKind::Integer; 4],
    })
}

fn height_case(gpu: &Gpu) -> Result<Run, GpuError> {
    let (cpu, twin) = cells(gpu, &window())?;
    Ok(Run {
        arguments: arguments(&window()),
        cpu: Cpu(cpu.height_units()),
        gpu: FromGpu(gpu.read(&twin.height_buffer()?)?),
        kinds: vec![WordKind::Integer],
    })
}

fn normal_case(gpu: &Gpu) -> Result<Run, GpuError> {
    let (cpu, twin) = cells(gpu, &everything())?;
    let words = |normals: &[glam::Vec3]| normals.iter().flat_map(|n| n.to_array().words()).collect();
    Ok(Run {
        arguments: arguments(&everything()),
        cpu: Cpu(words(&cpu.normals())),
        gpu: FromGpu(words(&twin.normals()?)),
        kinds: vec![WordKind::Float; 3],
    })
}

/// The kernels of a step: what one of them does is in the state that is compared after all.
const LATTICE: &[&Kernel] = &[
    &shaders::CLAIM_KERNEL,
    &shaders::DECIDE_KERNEL,
    &shaders::TRANSFER_KERNEL,
    &shaders::SETTLE_KERNEL,
    &shaders::NEXT_KERNEL,
];

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case =
        |name, kernel, run| KernelCase { with: LATTICE, ..KernelCase::new(name, kernel, INTEGERS, run) };
    let all: fn(&Gpu) -> Result<Run, GpuError> = |gpu| lattice_case(gpu, &everything());
    let runs: fn(&Gpu) -> Result<Run, GpuError> = |gpu| lattice_case(gpu, &window());
    vec![
        case("main_glass_claim: a window", &shaders::CLAIM_KERNEL, runs),
        case("main_glass_decide: a windshield with everything", &shaders::DECIDE_KERNEL, all),
        case(
            "main_glass_transfer: a windshield with everything, other seed",
            &shaders::TRANSFER_KERNEL,
            |gpu| lattice_case(gpu, &GlassOptions { seed: 77, ..everything() }),
        ),
        case("main_glass_settle: a level pane that floods", &shaders::SETTLE_KERNEL, |gpu| {
            let rain = GlassRain { rate_mm_h: 500.0, towards_m_s: 0.0, ..GlassRain::default() };
            let pane = GlassOptions { tilt_rad: 0.0, cell_m: 5.0e-3, rain, ..window() };
            lattice_case(gpu, &pane)
        }),
        case("main_glass_decide: a strip, whose drops run along its sides", &shaders::DECIDE_KERNEL, |gpu| {
            lattice_case(gpu, &strip())
        }),
        case("main_glass_next: another window", &shaders::NEXT_KERNEL, |gpu| {
            lattice_case(gpu, &GlassOptions { seed: 6, ..window() })
        }),
        case("main_glass_height: a window", &shaders::HEIGHT_KERNEL, height_case),
        case("main_glass_smooth: a window", &shaders::SMOOTH_KERNEL, height_case),
        KernelCase {
            name: "main_glass_normal: a windshield",
            kernel: &shaders::NORMAL_KERNEL,
            with: &[],
            overrides: &[],
            text: None,
            tol: Tol::absolute(1.0e-6, "a square root and a division (2.5 ulp each) of numbers up to 1"),
            run: normal_case,
        },
    ]
}
