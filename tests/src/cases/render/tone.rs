//! `shaders/wgsl/render/tone.wgsl` against `downpour_render::tone`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::gpu::{TonePipeline, TonedLayers};
use downpour_render::picture::compose_pixel;
use downpour_render::tone::{
    Tone, ToneCurve, ToneEdges, ToneLayers, tone_color, tone_compressed, tone_edge, tone_edge_weight,
    tone_hue, tone_lifted, tone_linear, tone_neutral, tone_oklab, tone_pack, tone_picture, tone_rise,
    tone_srgb, tone_sum, tone_whiteness, tone_with_hue, tone_within,
};
use downpour_shaders::render::tone::{TONE, TONE_EDGE_BRIGHT, TONE_EDGE_WHITE, TONE_KERNEL, TONE_START};
use glam::Vec3;

use crate::compare::{Cpu, Gpu as FromGpu};
use crate::domain::Domain::{Below, LogUniform, Made, Uniform};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

const SIZE: [u32; 2] = [45, 27];

/// Layers of a picture: plate, rain, glow.
type Layers = [Vec<[f32; 4]>; 3];

fn random(seed: u32) -> impl Iterator<Item = [f32; 4]> {
    (0..SIZE[0] * SIZE[1]).map(move |i| rng_draw([seed, 77], i, 0, 0).map(rng_unit))
}

/// Pixels over seven decades through rain.
fn noise() -> Layers {
    let bright = |[r, g, b, t]: [f32; 4]| {
        let scale = ops::exp2(24.0 * t - 12.0);
        [r * scale, g * scale, b * scale, 100.0 * t]
    };
    let glow = random(3).map(|row| row.map(|part| part - 0.3));
    [random(1).map(bright).collect(), random(2).collect(), glow.collect()]
}

/// Disks and bars of 2 to 1000 times white before a dim ground with texture, with smooth coverages at their edges, in the glow that
/// they give.
fn lights() -> Layers {
    let lights = [
        ([8.3, 7.1], 4.2, 1000.0),
        ([24.0, 9.5], 6.1, 3.0),
        ([38.2, 6.0], 0.6, 300.0),
        ([12.0, 20.4], 3.0, 12.0),
    ];
    let size = SIZE.map(|count| count as f32);
    let at = |i: u32| [(i % SIZE[0]) as f32, (i / SIZE[0]) as f32];
    let near = |[x, y]: [f32; 2], [u, v]: [f32; 2]| ops::hypot(x - u, y - v);
    let pixels = 0..SIZE[0] * SIZE[1];
    let plate = pixels.clone().zip(random(4)).map(|(i, [r, g, b, t])| {
        let [x, y] = at(i);
        let mut seen = [0.2 + 0.1 * r, 0.15 + 0.2 * g, 0.1 + 0.1 * b];
        for (center, radius, radiance) in lights {
            let covered = (radius + 0.5 - near([x, y], center)).clamp(0.0, 1.0);
            let color = [radiance, 0.8 * radiance, 0.5 * radiance];
            seen = std::array::from_fn(|k| seen[k] + covered * (color[k] - seen[k]));
        }
        let bar = (y - 0.35 * x - 0.4 * size[1]).abs();
        let covered = (1.5 - bar).clamp(0.0, 1.0) * (x / size[0]);
        let [red, green, blue] = seen;
        [red + covered * 40.0, green + covered * 4.0, blue + covered * 2.0, 10.0 * t]
    });
    let rain = random(5).map(|[r, g, b, t]| [0.05 * r, 0.05 * g, 0.05 * b, 1.0 - 0.1 * t]);
    let glow = pixels.map(|i| {
        let given = lights.map(|(center, radius, radiance)| {
            let distance = near(at(i), center);
            let taken = 0.01 * radiance * (radius + 0.5 - distance).clamp(0.0, 1.0);
            0.02 * radiance / (1.0 + distance * distance) - taken
        });
        let sum = given.iter().sum::<f32>();
        [sum, 0.8 * sum, 0.5 * sum, 0.0]
    });
    [plate.collect(), rain.collect(), glow.collect()]
}

/// A picture of layers, with glow or without. Words are values of 0 to 255.
fn tone_run(gpu: &Gpu, [plate, rain, glow]: Layers, tone: &Tone, glows: bool) -> Result<Run, GpuError> {
    let composed = plate.iter().zip(&rain).zip(&glow).map(|((&plate, &rain), &glow)| {
        let seen = Vec3::from_slice(&compose_pixel(plate, rain));
        if glows { seen + Vec3::from_slice(&glow) } else { seen }
    });
    let radiance: Vec<[f32; 3]> = composed.map(|seen| seen.to_array()).collect();
    let layers = ToneLayers { size: SIZE, radiance: &radiance, glow: if glows { &glow } else { &[] } };
    let value = |value: u8| f32::from(value).to_bits();
    let cpu =
        tone_picture(&layers, tone).into_iter().flat_map(|[r, g, b]| [r, g, b, 255].map(value)).collect();
    let [plate, rain, glow] = [&plate, &rain, &glow].map(|pixels| gpu.storage_buffer("pixels", pixels));
    let (plate, rain, glow) = (plate?, rain?, glow?);
    let layers = TonedLayers { size: SIZE, plate: &plate, rain: &rain, glow: glows.then_some(&glow) };
    let pipeline = TonePipeline::new(gpu)?;
    let pass = pipeline.prepare(gpu, layers, tone)?;
    gpu.submit(&[pass.dispatch()])?;
    let made = gpu.read::<u32>(pass.target())?;
    Ok(Run {
        arguments: (0..SIZE[0] * SIZE[1])
            .map(|i| [i % SIZE[0], i / SIZE[0]].map(|c| (c as f32).to_bits()).to_vec())
            .collect(),
        cpu: Cpu(cpu),
        gpu: FromGpu(made.into_iter().flat_map(|packed| packed.to_le_bytes().map(value)).collect()),
        kinds: vec![WordKind::Float; 4],
    })
}

const fn tone(curve: ToneCurve, edges: ToneEdges) -> Tone {
    Tone { exposure: 0.7, curve, edges }
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
        case("main_tone: hues kept, glow", |gpu| {
            tone_run(gpu, noise(), &tone(ToneCurve::Hue, ToneEdges::Linear), true)
        }),
        case("main_tone: the neutral curve", |gpu| {
            tone_run(gpu, noise(), &tone(ToneCurve::KhronosNeutral, ToneEdges::Linear), false)
        }),
        case("main_tone: edges of noise", |gpu| {
            tone_run(gpu, noise(), &tone(ToneCurve::KhronosNeutral, ToneEdges::ToneAware), false)
        }),
        case("main_tone: edges of lights, glow", |gpu| {
            tone_run(gpu, lights(), &tone(ToneCurve::Hue, ToneEdges::ToneAware), true)
        }),
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
            "tone_color",
            &TONE,
            &[LogUniform(1.0e-3, 1.0e4), LogUniform(1.0e-3, 1.0e4), LogUniform(1.0e-3, 1.0e4), Below(2)],
            Tol::absolute(3.0e-4, "the colors above"),
            |a| tone_color(a.f32s::<3>().into(), a.u32()).to_array().words(),
        ),
        FunctionCase::new(
            "tone_pack",
            &TONE,
            &[Uniform(-0.1, 1.1); 3],
            Tol::exact("integers, but where a power ends beside a half").with_outliers(5.0e-3),
            |a| tone_pack(a.f32s::<3>().into()).words(),
        ),
        FunctionCase::new(
            "tone_rise",
            &TONE,
            &[Uniform(0.0, 1.0), Uniform(2.0, 5.0), Uniform(-1.0, 6.0)],
            Tol::absolute(2.0e-6, "a quotient (2.5 ulp) and products of numbers up to 3"),
            |a| tone_rise(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "tone_sum",
            &TONE,
            &[Uniform(0.0, 10.0); 3],
            Tol::relative(2.0e-7, 1.0e-6, "two sums of numbers up to 20"),
            |a| tone_sum(a.f32s::<3>().into()).words(),
        ),
        // Edges of whites that are filtered in part, of dim texture and of small coverages.
        FunctionCase::new(
            "tone_edge_weight",
            &TONE,
            &[
                LogUniform(0.02, 4.0),
                LogUniform(0.02, 4.0),
                LogUniform(0.02, 4.0),
                Uniform(0.0, 0.5),
                Uniform(0.0, 0.5),
                Uniform(0.0, 0.5),
                Uniform(0.0, 0.1),
                Uniform(0.0, 0.1),
                Uniform(0.0, 0.1),
                Uniform(0.5 * TONE_EDGE_WHITE, 1.5 * TONE_EDGE_BRIGHT),
                Uniform(0.5 * TONE_EDGE_WHITE, 1.5 * TONE_EDGE_BRIGHT),
                Uniform(0.5 * TONE_EDGE_WHITE, 1.5 * TONE_EDGE_BRIGHT),
                LogUniform(1.0e-3, 1.0),
            ],
            Tol::absolute(1.0e-5, "smooth rises of quotients of differences, and their products"),
            |a| {
                let [color, dark, behind, bright] = std::array::from_fn(|_| Vec3::from(a.f32s::<3>()));
                tone_edge_weight(color, dark, behind, bright, a.f32()).words()
            },
        ),
        FunctionCase::new(
            "tone_edge",
            &TONE,
            &[
                Uniform(0.0, 1.0),
                Uniform(0.0, 1.0),
                Uniform(0.0, 1.0),
                LogUniform(0.1, 100.0),
                LogUniform(0.1, 100.0),
                LogUniform(0.1, 100.0),
                LogUniform(0.005, 2.0),
                LogUniform(0.005, 2.0),
                LogUniform(0.005, 2.0),
                LogUniform(0.01, 0.5),
                LogUniform(0.01, 0.5),
                LogUniform(0.01, 0.5),
                LogUniform(0.5, 1000.0),
                LogUniform(0.5, 1000.0),
                LogUniform(0.5, 1000.0),
                LogUniform(0.5, 1000.0),
                LogUniform(0.5, 1000.0),
                LogUniform(0.5, 1000.0),
                Below(2),
            ],
            Tol::absolute(
                1.5e-3,
                "the fourth power of a difference of the colors above, times that difference",
            ),
            |a| {
                let [toned, color, dark, behind, bright, beyond] =
                    std::array::from_fn(|_| Vec3::from(a.f32s::<3>()));
                tone_edge(toned, color, dark, behind, bright, beyond, a.u32()).to_array().words()
            },
        ),
    ]
}
