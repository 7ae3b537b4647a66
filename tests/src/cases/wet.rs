//! `shaders/wgsl/render/wet.wgsl` against `downpour_trace::wet`.

use downpour_gpu::{Gpu, GpuError};
use downpour_shaders::render::scene::{SURFACE, TRACE_KERNEL};
use downpour_shaders::render::wet::WET;
use downpour_trace::SceneWetness;
use downpour_trace::data::SceneData;
use downpour_trace::surface::surface_porosity;
use downpour_trace::wet::{wet_arrival, wet_corner, wet_fraction, wet_noise, wet_reflectance, wet_relief};
use downpour_weather::WetnessAt;
use glam::Vec3;

use super::scene::{Parts, PictureRays, picture_by, scene, shining_scene};
use crate::Domain::{AnyWord, Below, Or, Uniform, Unit3};
use crate::function::Run;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

fn vec3(args: &mut Args<'_>) -> Vec3 {
    Vec3::from(args.f32s())
}

fn relief(a: &mut Args<'_>) -> Vec<u32> {
    let relief = wet_relief(vec3(a), a.f32());
    let [x, y, z] = relief.slope.to_array();
    [x, y, z, relief.height, relief.variance].words()
}

const NOISE: Tol =
    Tol::absolute(2.0e-4, "a sum of 8 products of numbers up to 2; a cell's edge is continuous")
        .with_outliers(1.0e-3);

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let fraction = Uniform(0.0, 1.0);
    let place = Uniform(-40.0, 40.0);
    vec![
        FunctionCase::new(
            "wet_fraction",
            &WET,
            &[Uniform(0.0, 12.0), fraction, Uniform(0.0, 4.0), Uniform(0.0, 4.0)],
            Tol::absolute(2.0e-5, "exponentials (3 + 2|x| ulp) of numbers up to 48, below 1"),
            |a| wet_fraction(a.f32(), a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "wet_corner",
            &WET,
            &[AnyWord, AnyWord, AnyWord, AnyWord],
            Tol::exact("integers, and a product with a power of 2"),
            |a| {
                let cell = a.u32s::<3>().map(|word| word as i32);
                wet_corner(cell, a.u32()).words()
            },
        ),
        FunctionCase::new("wet_noise", &WET, &[place, place, place, Below(9)], NOISE, |a| {
            wet_noise(vec3(a), a.u32()).to_array().words()
        }),
        FunctionCase::new(
            "wet_relief",
            &WET,
            &[fraction, fraction, fraction, Uniform(0.0, 0.05)],
            Tol::absolute(
                1.0e-3,
                "noise at a position over a cell of 3 mm, whose quotient (2.5 ulp) is up to 333",
            )
            .with_outliers(1.0e-3),
            relief,
        ),
        // Only the largest cells show, whose noise is known better.
        FunctionCase::new(
            "wet_relief",
            &WET,
            &[fraction, fraction, fraction, Uniform(0.01, 0.05)],
            Tol::absolute(3.0e-5, "noise at a position over a cell of 31 mm, times 0.6 at most")
                .with_outliers(1.0e-3),
            relief,
        ),
        FunctionCase::new(
            "wet_arrival",
            &WET,
            &[Unit3, fraction, fraction, fraction],
            Tol::absolute(2.0e-5, "the noise above, times 0.016").with_outliers(1.0e-3),
            |a| wet_arrival(vec3(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "wet_reflectance",
            &WET,
            &[fraction, fraction, fraction],
            Tol::relative(2.0e-3, 1.0e-5, "a difference of refractive indices, and 1 - root(0.98), cancel"),
            |a| wet_reflectance(vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "surface_porosity",
            &SURFACE,
            &[Or(&Uniform(-1.0, 1.5), &[0.0]), Below(4), fraction, fraction],
            Tol::absolute(1.0e-6, "products of numbers up to 3"),
            |a| surface_porosity(a.f32(), a.u32(), a.f32(), a.f32()).words(),
        ),
    ]
}

const PICTURE: Tol = Tol::relative(
    3.0e-3,
    3.0e-3,
    "sums over rays; a ray at an edge, the sky's atan2 (4096 ulp), and the rain's edge may fall on either side",
)
.with_outliers(6.0e-3);

/// A wet scene of which nothing shines.
const DULL: &[(&str, f64)] = &Parts { wet: 1.0, ..Parts::NONE }.overrides();

/// A wet scene of which something does.
const SHINING: &[(&str, f64)] = &Parts { wet: 1.0, shines: 1.0, ..Parts::NONE }.overrides();

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case =
        |name, overrides, run| KernelCase { overrides, ..KernelCase::new(name, &TRACE_KERNEL, PICTURE, run) };
    vec![
        case("main_trace: wet surfaces from near", DULL, case_near),
        case("main_trace: wet surfaces under the sky alone", DULL, case_far),
        case("main_trace: wet surfaces among what shines", SHINING, |gpu| case_shining(gpu, 1)),
        case("main_trace: wet surfaces whose light rays of one pixel in 4 look for", SHINING, |gpu| {
            case_shining(gpu, 2)
        }),
    ]
}

/// A scene of the other cases in a rain that comes aslant.
fn case(gpu: &Gpu, scene: SceneData, eye: Vec3, rays: PictureRays, at: WetnessAt) -> Result<Run, GpuError> {
    let mut scene = scene;
    let towards = Vec3::new(0.35, 1.0, 0.5).normalize();
    scene.set_wetness(Some(&SceneWetness { at, towards, shift: Vec3::new(3.0, 0.0, 5.0) }));
    picture_by(rays, gpu, &scene, eye)
}

fn case_near(gpu: &Gpu) -> Result<Run, GpuError> {
    let rays = PictureRays { sky_rays: 2, ..PictureRays::default() };
    case(gpu, scene(), Vec3::new(0.6, 1.0, 2.6), rays, WetnessAt { before: 0.8, kept: 0.7, since: 0.3 })
}

fn case_far(gpu: &Gpu) -> Result<Run, GpuError> {
    let rays = PictureRays { sky_rays: 0, ..PictureRays::default() };
    case(gpu, scene(), Vec3::new(-3.0, 3.0, 6.0), rays, WetnessAt { before: 6.0, kept: 1.0, since: 0.0 })
}

fn case_shining(gpu: &Gpu, spacing: u32) -> Result<Run, GpuError> {
    let at = WetnessAt { before: 2.0, kept: 0.9, since: 0.3 };
    let rays = PictureRays { spacing, ..PictureRays::default() };
    case(gpu, shining_scene(), Vec3::new(1.0, 1.2, 2.8), rays, at)
}
