//! `shaders/wgsl/render/refine.wgsl` against `downpour_render::refine`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::gpu::RefinePipeline;
use downpour_render::refine::refine_pixel;
use downpour_shaders::render::refine::{REFINE, REFINE_KERNEL};

use crate::domain::Domain::{Below, Uniform};
use crate::function::Run;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

const SIZE: [u32; 2] = [29, 19];

/// The mean of five pictures of random pixels.
fn refine_run(gpu: &Gpu) -> Result<Run, GpuError> {
    let pixels = SIZE[0] * SIZE[1];
    let picture = |count: u32| (0..pixels).map(move |i| rng_draw([count, 91], i, 0, 0).map(rng_unit));
    let mut mean = vec![[0.0; 4]; pixels as usize];
    let on_gpu = gpu.storage_buffer("mean", &vec![[f32::NAN; 4]; pixels as usize])?;
    let pipeline = RefinePipeline::new(gpu)?;
    for count in 1..=5 {
        let next: Vec<[f32; 4]> = picture(count).collect();
        let uploaded = gpu.storage_buffer("next", &next)?;
        gpu.submit(&[pipeline.prepare(gpu, SIZE, count, &uploaded, &on_gpu)?.dispatch()])?;
        for (mean, next) in mean.iter_mut().zip(next) {
            *mean = refine_pixel(*mean, next, count);
        }
    }
    Ok(Run::of_pixels(SIZE[0], &mean, &gpu.read(&on_gpu)?))
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    vec![KernelCase {
        name: "main_refine: five pictures",
        kernel: &REFINE_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: Tol::absolute(1.0e-6, "five sums of numbers up to 1, with quotients (2.5 ulp)"),
        run: refine_run,
    }]
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let arguments = [Uniform(0.0, 9.0); 8].into_iter().chain([Below(60)]).collect::<Vec<_>>();
    vec![FunctionCase::new(
        "refine_pixel",
        &REFINE,
        &arguments,
        Tol::relative(3.0e-6, 3.0e-7, "a quotient (2.5 ulp) and a sum, which may be fused"),
        |a| refine_pixel(a.f32s(), a.f32s(), a.u32()).words(),
    )]
}
