//! `shaders/wgsl/render/running_light.wgsl` against `downpour_trace::running_light`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::rng_unit;
use downpour_shaders::render::scene::{RUNNING_LIGHT, RUNNING_LIGHT_KERNEL};
use downpour_trace::data::RenderFrame;
use downpour_trace::gpu::{RunningLightPipeline, RunningOnGpu};
use downpour_trace::running_light::{
    PixelRunning, RunningFrame, RunningLight, RunningMean, no_frame_before, running_light_kept,
    running_light_next, running_light_steady,
};
use downpour_trace::scene::SceneView;
use downpour_trace::temporal::TemporalFrame;
use glam::{Vec3, Vec4};

use super::scene::shining_scene;
use super::temporal::{SIZE, frame_of, light_of, upload};
use crate::domain::Domain::{LogUniform, Made};
use crate::function::Run;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

fn mean_of(a: &mut Args<'_>) -> RunningMean {
    RunningMean {
        color: Vec3::from(a.f32s()),
        weight: a.f32(),
        recent: Vec3::from(a.f32s()),
        variance: a.f32(),
    }
}

fn numbers(mean: &RunningMean) -> [[f32; 4]; 2] {
    [mean.color.extend(mean.weight), mean.recent.extend(mean.variance)].map(|v| v.to_array())
}

/// Running means of up to 15 frames, or of none.
fn mean_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let weight = if random[0].is_multiple_of(5) { 0.0 } else { 15.0 * d };
    let color = Vec3::new(0.2 + a, 0.2 + b, 0.2 + c);
    let mean = RunningMean { color, weight, recent: color * (0.6 + 0.6 * d), variance: 0.04 * b * c };
    numbers(&mean).as_flattened().iter().map(|x| x.to_bits()).collect()
}

/// A color near 1 with a variance.
fn color_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    [0.3 + a, 0.3 + b, 0.3 + c, 0.05 * d].map(f32::to_bits).to_vec()
}

/// Three frames on the CPU, and the fourth on both.
fn running_run(gpu: &Gpu) -> Result<Run, GpuError> {
    let scene = shining_scene();
    // The origin has moved since the first three frames.
    let origin = |number| if number < 3 { Vec3::new(4.0, 0.0, -8.0) } else { Vec3::ZERO };
    let mut before: Option<RunningLight<PixelRunning>> = None;
    for number in 0..4 {
        let light = light_of(&scene, number, origin(number));
        let of = RunningFrame { time_s: light.time_s, origin: light.origin, frames: 9 };
        let frame = frame_of(&scene, number);
        let in_frame = RenderFrame { camera: light.camera, ..frame };
        let own = &light.held;
        let view = SceneView { data: &scene, frame: &in_frame };
        let empty = PixelRunning::default();
        let (at, last) = match &before {
            // A gloss is averaged over fewer frames, and over those within its lobe.
            Some(before) => (TemporalFrame { max_gloss: 5.0, ..before.before(&of) }, &before.held),
            None => (no_frame_before(&in_frame), &empty),
        };
        let (means, change) = view.running_light(own, last, &at);
        if number == 3 {
            let uploaded = RunningOnGpu {
                ambient: gpu.storage_buffer("light before", &last.ambient)?,
                means: gpu.storage_buffer("running means", &last.means)?,
            };
            let picture = gpu.storage_buffer("picture", &vec![[0.0_f32; 4]; change.len()])?;
            let pipeline = RunningLightPipeline::new(gpu)?;
            let of_frame = upload(gpu, own)?;
            let pass = pipeline.prepare(gpu, &in_frame, &of_frame, Some((at, &uploaded)), &picture)?;
            gpu.submit(&[pass.dispatch()])?;
            let mut of_gpu: Vec<[f32; 4]> = gpu.read(&picture)?;
            of_gpu.extend(gpu.read::<[f32; 4]>(pass.means())?);
            let mut of_cpu: Vec<[f32; 4]> = change.iter().map(|c| c.extend(0.0).to_array()).collect();
            of_cpu.extend(means.iter().flatten().flat_map(numbers));
            // Most pixels find their surface in the frame before.
            let gone_on = means.iter().filter(|slots| slots[0].weight > 1.5).count();
            assert!(3 * gone_on > means.len(), "{gone_on} pixels of {}", means.len());
            return Ok(Run::of_pixels(SIZE[0], &of_cpu, &of_gpu));
        }
        let longer = |mean: RunningMean| RunningMean { weight: 3.0 * mean.weight, ..mean };
        let means = means.into_iter().map(|slots| slots.map(longer)).collect();
        let held = PixelRunning { ambient: own.ambient.clone(), means };
        before = Some(RunningLight::after(before.as_ref(), &of, &scene, &in_frame, held));
    }
    unreachable!("the last frame returns")
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    vec![KernelCase {
        name: "main_running_light: three frames before, of an eye that walks",
        kernel: &RUNNING_LIGHT_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: Tol::relative(
            1.0e-3,
            1.0e-4,
            "differences of means; a neighbor at the edge of what is the same surface may count or not",
        )
        .with_outliers(1.0e-3),
        run: running_run,
    }]
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    vec![
        FunctionCase::new(
            "running_light_steady",
            &RUNNING_LIGHT,
            &[LogUniform(1.0e-5, 0.3), LogUniform(0.05, 1.0)],
            Tol::relative(1.0e-6, 1.0e-6, "products and a root"),
            |a| running_light_steady(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "running_light_kept",
            &RUNNING_LIGHT,
            &[Made(color_words), Made(color_words)],
            Tol::absolute(1.0e-4, "a square of a difference over a sum"),
            |a| running_light_kept(Vec4::from(a.f32s::<4>()), Vec4::from(a.f32s::<4>())).words(),
        ),
        FunctionCase::new(
            "running_light_next",
            &RUNNING_LIGHT,
            &[Made(mean_words), Made(color_words)],
            Tol::relative(1.0e-4, 1.0e-4, "means, and a square of a difference over a sum"),
            |a| {
                let before = mean_of(a);
                let after = running_light_next(&before, Vec4::from(a.f32s::<4>()));
                numbers(&after).as_flattened().iter().map(|x| x.to_bits()).collect()
            },
        ),
    ]
}
