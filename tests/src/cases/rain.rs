//! `shaders/wgsl/render/{capture,reduce,drops}.wgsl` against `downpour_render::rain`.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_gpu::{ComputeKernel, Gpu, GpuError};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::camera::Viewpoint;
use downpour_render::gpu::{RainPipeline, ScenePipeline};
use downpour_render::rain::drops::drops_right;
use downpour_render::rain::{
    DropMasks, Rain, RainOptions, ReduceLevel, RefractionForm, Veil, reduce_levels, reduce_texel,
};
use downpour_render::scene::SceneView;
use downpour_shaders::render::rain::{DROPS, DROPS_KERNEL, REDUCE_KERNEL};
use downpour_shaders::render::scene::TRACE_KERNEL;
use downpour_sim::field::{DropKind, FallingDrop};
use glam::{DVec3, Vec3};

use super::scene::scene;
use crate::Domain::Unit3;
use crate::compare::{Cpu, Gpu as FromGpu, POISON};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

const SIZE: [u32; 2] = [96, 64];

/// Drops of all sizes before, between and behind what stands in the scene: some over hundreds of pixels, some below one.
fn drops(eye: Vec3, forward: Vec3) -> Vec<FallingDrop> {
    let forward = forward.normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    (0..400)
        .map(|k| {
            let [a, b, c, d] = rng_draw([3, 4], k, 0, 0).map(rng_unit);
            let depth = 0.02 + 5.0 * c * c * c;
            let place = forward + right * (1.5 * a - 0.75) + up * (1.1 * b - 0.55);
            FallingDrop {
                position: (eye + place * depth).as_dvec3(),
                velocity: [0.0, -5.0, 0.0],
                diameter: 0.3e-3 + 7.7e-3 * d * d,
                id: u64::from(k),
                kind: DropKind::Falling,
            }
        })
        .collect()
}

fn words(texels: &[[f32; 4]]) -> Vec<u32> {
    texels.iter().flatten().map(|v| v.to_bits()).collect()
}

fn run(width: u32, cpu: &[[f32; 4]], gpu: &[[f32; 4]]) -> Run {
    Run {
        arguments: (0..cpu.len() as u32)
            .map(|i| vec![((i % width) as f32).to_bits(), ((i / width) as f32).to_bits()])
            .collect(),
        cpu: Cpu(words(cpu)),
        gpu: FromGpu(words(gpu)),
        kinds: vec![WordKind::Float; 4],
    }
}

/// A veil that is thick within a few metres.
fn veil() -> Veil {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 500.0).expect("a rain");
    Veil::new(&rain, |diameter| 400.0 * diameter).expect("a veil")
}

/// What is compared of a picture.
#[derive(Clone, Copy)]
enum Part {
    Capture,
    Drops,
}

fn rain_case(gpu: &Gpu, eye: Vec3, forward: Vec3, form: RefractionForm, part: Part) -> Result<Run, GpuError> {
    let scene = scene();
    let view = Viewpoint { eye, forward, up: Vec3::Y, fov_y: 0.9 };
    let frame = view.frame(&scene, SIZE, 1, 1, 7).expect("a frame");
    let masks = DropMasks::trace(1.333).expect("masks");
    let options = RainOptions { form, capture_size: 64, capture_grid: 2, veil: veil() };
    let rain = Rain::new(&frame, DVec3::from(eye), &drops(eye, forward), &masks, &options);
    assert!(rain.list.len() > 100, "{} drops", rain.list.len());
    let clean = SceneView { data: &scene, frame: &frame }.picture();
    let capture = rain.capture.trace(&scene);
    let (scenes, rains) = (ScenePipeline::new(gpu)?, RainPipeline::new(gpu)?);
    let uploaded = scenes.upload(&scene)?;
    let clean_buffer = gpu.storage_buffer("clean", &clean)?;
    let pass = rains.prepare(&scenes, &uploaded, &rains.upload(&masks)?, &clean_buffer, &rain)?;
    gpu.submit(&pass.capture())?;
    match part {
        Part::Capture => {
            // The finest level: the others are the kernel of the reduction.
            let finest = 64 * 64;
            Ok(run(64, &capture.texels[..finest], &pass.surroundings()?[..finest]))
        }
        Part::Drops => {
            gpu.submit(&[pass.drops()])?;
            Ok(run(SIZE[0], &rain.layer(&clean, &masks, &capture), &pass.layer()?))
        }
    }
}

/// All levels below 64 x 64 random texels.
fn reduce_case(gpu: &Gpu) -> Result<Run, GpuError> {
    let size = 64;
    let mut texels: Vec<[f32; 4]> =
        (0..size * size).map(|i| rng_draw([1, 2], i, 0, 0).map(|w| 100.0 * rng_unit(w))).collect();
    let finest = texels.len();
    let levels = reduce_levels(size);
    let all = levels.iter().map(|l| (l.size * l.size) as usize).sum::<usize>() + finest;
    let mut poisoned = texels.clone();
    poisoned.resize(all, [f32::from_bits(POISON); 4]);
    let buffer = gpu.storage_buffer("levels", &poisoned)?;
    let kernel = ComputeKernel::new(gpu, &REDUCE_KERNEL, &[])?;
    let bind = |level: &ReduceLevel| kernel.bind(gpu, &[&gpu.uniform_buffer("level", level)?, &buffer]);
    for level in &levels {
        let bindings = bind(level)?;
        let groups = level.size.div_ceil(8);
        gpu.submit(&[kernel.dispatch(&bindings, [groups, groups, 1])])?;
        for i in 0..level.size * level.size {
            let texel = reduce_texel(&texels, level, i % level.size, i / level.size);
            texels.push(texel);
        }
    }
    let made = gpu.read::<[f32; 4]>(&buffer)?;
    Ok(run(size, &texels[finest..], &made[finest..]))
}

const CAPTURED: Tol = Tol::relative(
    2.0e-3,
    2.0e-3,
    "sums over rays; a ray at an edge, and the sky's atan2 (4096 ulp), may fall on either side",
)
.with_outliers(2.0e-3);

const DRAWN: Tol = Tol::relative(
    5.0e-3,
    2.0e-3,
    "the capture above; directions of a mask's rim turn by the width of the picture in a texel",
)
.with_outliers(1.0e-2);

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    vec![FunctionCase::new(
        "drops_right",
        &DROPS,
        &[Unit3],
        Tol::relative(1.0e-6, 1.0e-7, "a square root and a division (2.5 ulp)"),
        |a| drops_right(Vec3::from(a.f32s())).to_array().words(),
    )]
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let drops = |name, run| KernelCase {
        name,
        kernel: &DROPS_KERNEL,
        covers: &[
            "drops_unit",
            "drops_mask_texel",
            "drops_add",
            "drops_mask_layer",
            "drops_mask",
            "drops_capture_texel",
            "drops_capture_level",
            "drops_capture_at",
            "drops_shifted",
            "drops_ray",
            "drops_sample",
            "drops_spread",
            "drops_pixel",
            "drops_over",
            "drops_veil",
            "drops_veiled",
        ],
        tol: DRAWN,
        run,
    };
    vec![
        KernelCase {
            name: "main_trace: a capture with a sun and lamps",
            kernel: &TRACE_KERNEL,
            covers: &["capture_direction", "capture_suns"],
            tol: CAPTURED,
            run: |gpu| {
                let (eye, forward) = (Vec3::new(0.6, 1.4, 3.0), Vec3::new(-0.2, -0.4, -1.0));
                rain_case(gpu, eye, forward, RefractionForm::Direction, Part::Capture)
            },
        },
        KernelCase {
            name: "main_reduce: all levels of 64 x 64",
            kernel: &REDUCE_KERNEL,
            covers: &["reduce_texel"],
            tol: Tol::relative(1.0e-6, 0.0, "the mean of four: three sums, each rounded once"),
            run: reduce_case,
        },
        drops("main_drops: level", |gpu| {
            let (eye, forward) = (Vec3::new(0.6, 0.4, 3.0), Vec3::new(-0.1, 0.0, -1.0));
            rain_case(gpu, eye, forward, RefractionForm::Direction, Part::Drops)
        }),
        drops("main_drops: from above", |gpu| {
            let (eye, forward) = (Vec3::new(0.1, 3.0, 0.4), Vec3::new(0.05, -1.0, -0.1));
            rain_case(gpu, eye, forward, RefractionForm::Direction, Part::Drops)
        }),
        drops("main_drops: Rousseau 2006", |gpu| {
            let (eye, forward) = (Vec3::new(0.6, 1.4, 3.0), Vec3::new(-0.2, -0.4, -1.0));
            rain_case(gpu, eye, forward, RefractionForm::Rousseau2006, Part::Drops)
        }),
    ]
}
