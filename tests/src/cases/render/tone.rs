//! `shaders/wgsl/render/tone.wgsl` against `downpour_render::tone`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::gpu::{TonePipeline, TonedLayers};
use downpour_render::picture::compose_pixel;
use downpour_render::tone::{
    ToneCurve, tone_compressed, tone_hue, tone_lifted, tone_linear, tone_neutral, tone_number, tone_oklab,
    tone_pixel, tone_srgb, tone_whiteness, tone_with_hue, tone_within,
};
use downpour_shaders::render::tone::{TONE, TONE_KERNEL, TONE_START};
use glam::Vec3;

use crate::compare::{Cpu, Gpu as FromGpu};
use crate::domain::Domain::{Below, LogUniform, Made, Uniform};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

const SIZE: [u32; 2] = [45, 27];

/// Pixels over seven decades through rain, with glow or without. Words are values of 0 to 255.
fn tone_run(gpu: &Gpu, curve: ToneCurve, glows: bool) -> Result<Run, GpuError> {
    let random = |seed: u32| (0..SIZE[0] * SIZE[1]).map(move |i| rng_draw([seed, 77], i, 0, 0).map(rng_unit));
    let bright = |[r, g, b, t]: [f32; 4]| {
        let scale = ops::exp2(24.0 * t - 12.0);
        [r * scale, g * scale, b * scale, 100.0 * t]
    };
    let plate: Vec<[f32; 4]> = random(1).map(bright).collect();
    let rain: Vec<[f32; 4]> = random(2).collect();
    let glow: Vec<[f32; 4]> = random(3).map(|row| row.map(|part| part - 0.3)).collect();
    let exposure = 0.7;
    let toned = plate.iter().zip(&rain).zip(&glow).map(|((&plate, &rain), &glow)| {
        let seen = Vec3::from_slice(&compose_pixel(plate, rain));
        let seen = if glows { seen + Vec3::from_slice(&glow) } else { seen };
        tone_pixel(seen, exposure, tone_number(curve))
    });
    let values = |packed: u32| (0..4).map(move |k| f32::from((packed >> (8 * k)) as u8).to_bits());
    let cpu = toned.flat_map(values).collect();
    let [plate, rain, glow] = [&plate, &rain, &glow].map(|pixels| gpu.storage_buffer("pixels", pixels));
    let (plate, rain, glow) = (plate?, rain?, glow?);
    let layers = TonedLayers { size: SIZE, plate: &plate, rain: &rain, glow: glows.then_some(&glow) };
    let pipeline = TonePipeline::new(gpu)?;
    let pass = pipeline.prepare(gpu, layers, exposure, curve)?;
    gpu.submit(&[pass.dispatch()])?;
    let made = gpu.read::<u32>(pass.target())?;
    Ok(Run {
        arguments: (0..SIZE[0] * SIZE[1])
            .map(|i| [i % SIZE[0], i / SIZE[0]].map(|c| (c as f32).to_bits()).to_vec())
            .collect(),
        cpu: Cpu(cpu),
        gpu: FromGpu(made.into_iter().flat_map(values).collect()),
        kinds: vec![WordKind::Float; 4],
    })
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case = |name, run| KernelCase {
        name,
        kernel: &TONE_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: Tol::absolute(1.0, "values of 0 to 255, which may be rounded to either side"),
        run,
    };
    vec![
        case("main_tone: hues kept, glow", |gpu| tone_run(gpu, ToneCurve::Hue, true)),
        case("main_tone: the neutral curve", |gpu| tone_run(gpu, ToneCurve::KhronosNeutral, false)),
    ]
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let rounded = |what| Tol::relative(4.0e-6, 4.0e-6, what);
    let power = |what| Tol::relative(3.0e-5, 3.0e-5, what);
    vec![
        FunctionCase::new(
            "tone_lifted",
            &TONE,
            &[Uniform(0.0, 0.2); 3],
            Tol::absolute(1.0e-7, "a product and a difference of numbers below 1"),
            |a| tone_lifted(a.f32s::<3>().into()).to_array().words(),
        ),
        FunctionCase::new(
            "tone_compressed",
            &TONE,
            &[LogUniform(TONE_START, 1.0e4)],
            rounded("a quotient (2.5 ulp) and its difference from 1"),
            |a| tone_compressed(a.f32()).words(),
        ),
        FunctionCase::new(
            "tone_neutral",
            &TONE,
            &[LogUniform(1.0e-3, 1.0e3); 3],
            rounded("quotients (2.5 ulp) and products of numbers up to 1"),
            |a| tone_neutral(a.f32s::<3>().into()).to_array().words(),
        ),
        FunctionCase::new(
            "tone_oklab",
            &TONE,
            &[LogUniform(1.0e-3, 10.0); 3],
            power("a cube root as a power (exp2 and log2), and sums with both signs of numbers up to 5"),
            |a| tone_oklab(a.f32s::<3>().into()).to_array().words(),
        ),
        FunctionCase::new(
            "tone_linear",
            &TONE,
            &[Uniform(0.0, 1.0), Uniform(-0.3, 0.3), Uniform(-0.3, 0.3)],
            power("sums with both signs of cubes up to 5"),
            |a| tone_linear(a.f32s::<3>().into()).to_array().words(),
        ),
        FunctionCase::new(
            "tone_within",
            &TONE,
            &[Uniform(-0.5, 2.0); 3],
            rounded("a quotient (2.5 ulp) of differences and products up to 2"),
            |a| tone_within(a.f32s::<3>().into()).to_array().words(),
        ),
        FunctionCase::new(
            "tone_whiteness",
            &TONE,
            &[LogUniform(TONE_START, 1.0e12)],
            Tol::absolute(1.0e-5, "log2 (3 ulp, and 2^-21 near 1), to the third power"),
            |a| tone_whiteness(a.f32()).words(),
        ),
        FunctionCase::new(
            "tone_with_hue",
            &TONE,
            &[Uniform(0.02, 1.0); 6],
            Tol::absolute(
                3.0e-4,
                "the colors above; near gray the direction of the hue hangs on a difference",
            ),
            |a| tone_with_hue(a.f32s::<3>().into(), a.f32s::<3>().into()).to_array().words(),
        ),
        FunctionCase::new(
            "tone_hue",
            &TONE,
            &[LogUniform(1.0e-3, 1.0e4); 3],
            Tol::absolute(3.0e-4, "the colors above"),
            |a| tone_hue(a.f32s::<3>().into()).to_array().words(),
        ),
        // Grays.
        FunctionCase::new(
            "tone_hue",
            &TONE,
            &[Made(|r| {
                vec![(r[0] % 4000 * (r[1] % 16)) as f32 * 1.0e-3; 3].into_iter().map(f32::to_bits).collect()
            })],
            Tol::absolute(1.0e-6, "the neutral curve"),
            |a| tone_hue(a.f32s::<3>().into()).to_array().words(),
        ),
        FunctionCase::new(
            "tone_srgb",
            &TONE,
            &[Uniform(-0.1, 1.1)],
            Tol::exact("integers, but where a power ends beside a half").with_outliers(2.0e-3),
            |a| u32::from(tone_srgb(a.f32())).words(),
        ),
        // The straight part of the curve.
        FunctionCase::new(
            "tone_srgb",
            &TONE,
            &[Uniform(0.0, 0.005)],
            Tol::exact("integers, but where a product ends beside a half").with_outliers(2.0e-3),
            |a| u32::from(tone_srgb(a.f32())).words(),
        ),
        FunctionCase::new(
            "tone_pixel",
            &TONE,
            &[Uniform(0.0, 2.0), Uniform(0.0, 2.0), Uniform(0.0, 2.0), LogUniform(0.1, 10.0), Below(2)],
            Tol::exact("integers, but where a power ends beside a half").with_outliers(5.0e-3),
            |a| tone_pixel(a.f32s::<3>().into(), a.f32(), a.u32()).words(),
        ),
    ]
}
