//! `shaders/wgsl/common` against `downpour-math`.

use downpour_gpu::{ComputeKernel, Gpu, GpuError, invocation_index};
use downpour_math::pyramid::{PyramidLevel, PyramidRounding, pyramid_append, pyramid_levels};
use downpour_math::{color, equirect, octant, ops, packing, rng};
use downpour_shaders::common;

use crate::Domain::{AnyWord, Made, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu, POISON};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

const INTEGERS: Tol = Tol::exact("integers are exact");
const SCALED: Tol = Tol::exact("an integer below 2^24 converts, and a power of two multiplies, exactly");

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let words4 = [AnyWord; 4];
    vec![
        FunctionCase::new(
            "ops_is_finite",
            &common::OPS,
            &[Made(|r| {
                // Every exponent, both signs, mantissas with and without bits.
                vec![
                    (r[0] << 31) | ((r[1] & 0xff) << 23) | if r[2] & 1 == 0 { 0 } else { r[3] & 0x007f_ffff },
                ]
            })],
            INTEGERS,
            |a| ops::ops_is_finite(a.f32()).words(),
        ),
        FunctionCase::new("invocation_index", &common::INVOCATION, &[AnyWord; 6], INTEGERS, |a| {
            invocation_index(a.u32s(), a.u32s()).words()
        }),
        FunctionCase::new("rng_pcg4d_stir", &common::RNG, &words4, INTEGERS, |a| {
            rng::rng_pcg4d_stir(a.u32s()).words()
        }),
        FunctionCase::new("rng_pcg4d", &common::RNG, &words4, INTEGERS, |a| rng::rng_pcg4d(a.u32s()).words()),
        FunctionCase::new("rng_draw", &common::RNG, &[AnyWord; 5], INTEGERS, |a| {
            rng::rng_draw(a.u32s(), a.u32(), a.u32(), a.u32()).words()
        }),
        FunctionCase::new("rng_unit", &common::RNG, &[AnyWord], SCALED, |a| rng::rng_unit(a.u32()).words()),
        FunctionCase::new("rng_unit_positive", &common::RNG, &[AnyWord], SCALED, |a| {
            rng::rng_unit_positive(a.u32()).words()
        }),
        FunctionCase::new(
            "packing_sign",
            &common::PACKING,
            &[Uniform(-2.0, 2.0)],
            Tol::exact("a comparison"),
            |a| packing::packing_sign(a.f32()).words(),
        ),
        FunctionCase::new(
            "packing_octahedral_encode",
            &common::PACKING,
            &[Uniform(-1.0, 1.0), Uniform(-1.0, 1.0), Uniform(-1.0, 1.0)],
            Tol::relative(1.0e-6, 5.0e-7, "a division (2.5 ulp), sums and products of numbers up to 1"),
            |a| packing::packing_octahedral_encode(a.f32s()).words(),
        ),
        FunctionCase::new(
            "packing_octahedral_decode",
            &common::PACKING,
            &[Uniform(-1.0, 1.0), Uniform(-1.0, 1.0)],
            Tol::relative(
                2.0e-6,
                1.0e-6,
                "an inverse square root (2 ulp + division 2.5 ulp) of a sum that is at least 1/3",
            ),
            |a| packing::packing_octahedral_decode(a.f32s()).words(),
        ),
        FunctionCase::new(
            "packing_octahedral_texel",
            &common::PACKING,
            // The texel itself is checked over the whole map and up to a map beyond each edge.
            &[Made(|r| vec![1 + r[0] % 64, (r[1] % 192).wrapping_sub(64), (r[2] % 192).wrapping_sub(64)])],
            INTEGERS,
            |a| packing::packing_octahedral_texel(a.u32(), a.u32() as i32, a.u32() as i32).words(),
        ),
        FunctionCase::new(
            "color_luminance",
            &common::COLOR,
            &[Uniform(0.0, 4.0), Uniform(0.0, 4.0), Uniform(0.0, 4.0)],
            Tol::relative(1.0e-6, 0.0, "a sum of products that a GPU may fuse"),
            |a| color::color_luminance(a.f32s()).words(),
        ),
        FunctionCase::new(
            "octant_turns",
            &common::OCTANT,
            &[Uniform(0.0, 1.0)],
            Tol::absolute(5.0e-8, "a polynomial up to 1/8 that a GPU may fuse"),
            |a| octant::octant_turns(a.f32()).words(),
        ),
        FunctionCase::new(
            "equirect_coordinates",
            &common::EQUIRECT,
            &[Unit3],
            Tol::absolute(2.0e-4, "atan2 (4096 ulp) of angles up to pi, over 2 pi"),
            |a| equirect::equirect_coordinates(a.f32s()).words(),
        ),
    ]
}

/// All levels below random texels.
fn pyramid_case(gpu: &Gpu, size: [u32; 2], rounding: PyramidRounding) -> Result<Run, GpuError> {
    let mut texels: Vec<[f32; 4]> = (0..size[0] * size[1])
        .map(|i| rng::rng_draw([1, 2], i, 0, 0).map(|w| 100.0 * rng::rng_unit(w)))
        .collect();
    let finest = texels.len();
    let levels = pyramid_levels(size, rounding);
    let mut poisoned = texels.clone();
    for level in &levels {
        pyramid_append(&mut texels, level);
    }
    poisoned.resize(texels.len(), [f32::from_bits(POISON); 4]);
    let buffer = gpu.storage_buffer("levels", &poisoned)?;
    let kernel = ComputeKernel::new(gpu, &common::PYRAMID_KERNEL, &[])?;
    let bind = |level: &PyramidLevel| kernel.bind(gpu, &[&gpu.uniform_buffer("level", level)?, &buffer]);
    for level in &levels {
        let [columns, rows] = level.size;
        gpu.submit(&[kernel.dispatch(&bind(level)?, [columns.div_ceil(8), rows.div_ceil(8), 1])])?;
    }
    let made = gpu.read::<[f32; 4]>(&buffer)?;
    let words = |texels: &[[f32; 4]]| texels.iter().flatten().map(|v| v.to_bits()).collect();
    Ok(Run {
        arguments: (finest..texels.len()).map(|i| vec![(i as f32).to_bits()]).collect(),
        cpu: Cpu(words(&texels[finest..])),
        gpu: FromGpu(words(&made[finest..])),
        kinds: vec![WordKind::Float; 4],
    })
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    let case = |name, run| {
        let tol = Tol::relative(1.0e-6, 0.0, "the mean of four: three sums, each rounded once");
        KernelCase { name, kernel: &common::PYRAMID_KERNEL, with: &[], overrides: &[], text: None, tol, run }
    };
    vec![
        case("main_pyramid: 64 x 64", |gpu| pyramid_case(gpu, [64, 64], PyramidRounding::Down)),
        case("main_pyramid: 61 x 7, rounded up", |gpu| pyramid_case(gpu, [61, 7], PyramidRounding::Up)),
        case("main_pyramid: 5 x 38, rounded down", |gpu| pyramid_case(gpu, [5, 38], PyramidRounding::Down)),
    ]
}
