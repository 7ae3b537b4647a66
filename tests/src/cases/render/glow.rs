//! `shaders/wgsl/render/glow.wgsl` against `downpour_render::glow`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::camera::Viewpoint;
use downpour_render::glow::{Glow, GlowDiffraction};
use downpour_render::gpu::GlowPipeline;
use downpour_render::picture::Picture;
use downpour_shaders::Kernel;
use downpour_shaders::render::glow::{
    GLOW_ADD_KERNEL, GLOW_COARSE_KERNEL, GLOW_DOWN_KERNEL, GLOW_KAWASE_KERNEL, GLOW_TAKE_KERNEL,
    GLOW_UP_KERNEL,
};
use downpour_weather::GlowFilter;
use glam::Vec3;

use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::signature::WordKind;
use crate::{KernelCase, Tol};

/// Odd sizes, among them those whose halves are odd; the second has levels that are not coarse.
const SIZES: [[u32; 2]; 2] = [[45, 27], [150, 91]];

/// The glow of random pixels: radiance over five decades, some of the sky.
fn glow_run(gpu: &Gpu, size: [u32; 2], glow: &Glow) -> Result<Run, GpuError> {
    let viewpoint = Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.8 };
    let camera = viewpoint.camera(size, 0).expect("a camera");
    let random = |seed: u32| {
        (0..size[0] * size[1]).map(move |i| rng_draw([seed, 31], i, 0, 0).map(rng_unit)).enumerate()
    };
    let plate: Vec<[f32; 4]> = random(1)
        .map(|(i, [r, g, b, at])| {
            let bright = if i % 37 == 0 { 100.0 } else { 1.0 };
            [r * bright, g * bright, b * bright, if i % 5 == 0 { 1.0e30 } else { 200.0 * at }]
        })
        .collect();
    let rain: Vec<[f32; 4]> = random(2).map(|(_, row)| row).collect();
    let mut picture = Picture {
        size,
        clean: plate,
        rain,
        drops_on_screen: 0,
        drawn: Vec::new(),
        environment: Vec::new(),
        through_glass: None,
        glow: Vec::new(),
        passes: Vec::new(),
        device: None,
    };
    picture.add_glow(glow, &camera);
    let plate = gpu.storage_buffer("plate", &picture.clean)?;
    let rain = gpu.storage_buffer("rain", &picture.rain)?;
    let pipeline = GlowPipeline::new(gpu)?;
    let pass = pipeline.prepare(gpu, glow, &camera, &plate, &rain)?.expect("a glow");
    gpu.submit(&pass.dispatches())?;
    let made = gpu.read::<[f32; 4]>(pass.target())?;
    let words =
        |texels: &[[f32; 4]]| texels.iter().flat_map(|&[r, g, b, _]| [r, g, b].map(f32::to_bits)).collect();
    Ok(Run {
        arguments: (0..picture.glow.len() as u32)
            .map(|i| [i % size[0], i / size[0]].map(|c| (c as f32).to_bits()).to_vec())
            .collect(),
        cpu: Cpu(words(&picture.glow)),
        gpu: FromGpu(words(&made)),
        kinds: vec![WordKind::Float; 3],
    })
}

const GLARE: Glow = Glow { glare: 0.3, width: 3.0, filter: GlowFilter::Pyramid, diffraction: None };
/// Drops that spread light over a tenth of the picture.
const DROPS: GlowDiffraction = GlowDiffraction { extinction: 0.01, angle: 0.03 };

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let tol = Tol::relative(
        2.0e-5,
        2.0e-5,
        "a difference of sums of products over nine levels, of numbers up to 100",
    );
    let case = |name, kernel: &'static Kernel, run| KernelCase {
        name,
        kernel,
        with: &[],
        overrides: &[],
        text: None,
        tol,
        run,
    };
    vec![
        case("main_glow_take: drops, then glare", &GLOW_TAKE_KERNEL, |gpu| {
            glow_run(gpu, SIZES[0], &Glow { diffraction: Some(DROPS), ..GLARE })
        }),
        case("main_glow_down: glare", &GLOW_DOWN_KERNEL, |gpu| glow_run(gpu, SIZES[1], &GLARE)),
        case("main_glow_up: narrow glare", &GLOW_UP_KERNEL, |gpu| {
            glow_run(gpu, SIZES[1], &Glow { width: 0.4, ..GLARE })
        }),
        case("main_glow_coarse: glare", &GLOW_COARSE_KERNEL, |gpu| glow_run(gpu, SIZES[0], &GLARE)),
        case("main_glow_kawase: five passes", &GLOW_KAWASE_KERNEL, |gpu| {
            glow_run(gpu, SIZES[0], &Glow { filter: GlowFilter::Kawase, width: 20.0, ..GLARE })
        }),
        case("main_glow_add: drops, then Kawase's passes", &GLOW_ADD_KERNEL, |gpu| {
            glow_run(
                gpu,
                SIZES[0],
                &Glow { filter: GlowFilter::Kawase, width: 9.0, diffraction: Some(DROPS), ..GLARE },
            )
        }),
    ]
}
