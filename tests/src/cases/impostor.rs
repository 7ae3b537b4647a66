//! `shaders/wgsl/render/impostor*.wgsl` against `downpour_trace::impostor`.

use downpour_gpu::{Gpu, GpuError};
use downpour_render::camera::Viewpoint;
use downpour_shaders::Kernel;
use downpour_shaders::render::impostor::{
    IMPOSTOR, IMPOSTOR_BLUR_KERNEL, IMPOSTOR_DRAW, IMPOSTOR_DRAW_KERNEL,
};
use downpour_shaders::render::scene::TRACE_KERNEL;
use downpour_trace::SceneWetness;
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::gpu::ImpostorPipeline;
use downpour_trace::impostor::draw::{impostor_draw_cover, impostor_draw_overlap};
use downpour_trace::impostor::{impostor_attenuation, impostor_unpack, list};
use downpour_trace::scene::SceneView;
use downpour_weather::WetnessAt;
use glam::{Vec2, Vec3};

use super::puddle_water::laid;
use super::scene::{Parts, PictureRays, picture_by, shining_scene};
use crate::Domain::{self, Fixed, OneOf, Or, Uniform};
use crate::function::Run;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let offset = Uniform(-20.0, 20.0);
    let half = Or(&Uniform(0.0, 12.0), &[0.001]);
    vec![
        FunctionCase::new(
            "impostor_attenuation",
            &IMPOSTOR,
            &[Uniform(0.0, 1.0), Uniform(0.0, 3.0)],
            Tol::absolute(4.0e-6, "1 - x of numbers up to 9"),
            |a| impostor_attenuation(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "impostor_draw_overlap",
            &IMPOSTOR_DRAW,
            &[offset, half],
            Tol::exact("sums, and the smaller of numbers"),
            |a| impostor_draw_overlap(a.f32(), a.f32()).words(),
        ),
        cover(&[offset, offset, half, half, Uniform(1.0, 40.0)]),
        // About the lower edge, where the tail begins.
        cover(&[Uniform(-2.0, 2.0), OneOf(&[0.5, 1.0, 1.005, 1.5]), half, Fixed(1.0), Uniform(1.0, 40.0)]),
    ]
}

fn cover(domains: &[Domain]) -> FunctionCase {
    FunctionCase::new(
        "impostor_draw_cover",
        &IMPOSTOR_DRAW,
        domains,
        Tol::absolute(2.0e-6, "products and quotients (2.5 ulp) of numbers up to 1"),
        |a| impostor_draw_cover(Vec2::from(a.f32s()), Vec2::from(a.f32s()), a.f32()).words(),
    )
}

/// A wet scene with impostors.
const WET: &[(&str, f64)] = &Parts { impostors: 1.0, shines: 1.0, wet: 1.0, ..Parts::NONE }.overrides();

/// The same with puddles.
const PUDDLES: &[(&str, f64)] =
    &Parts { impostors: 1.0, shines: 1.0, wet: 1.0, puddles: 1.0, ..Parts::NONE }.overrides();

const PICTURE: Tol = Tol::relative(
    3.0e-3,
    3.0e-3,
    "sums over rays; a ray at an edge, and the rain's edge, may fall on either side",
)
.with_outliers(6.0e-3);

const BUFFER: Tol = Tol::relative(
    2.0e-3,
    2.0e-3,
    "halves (5e-4), rounded anew in each pass; the place of a billboard's edge is known to 1e-3 of a texel",
);

const BLUR: &[&Kernel] = &[&IMPOSTOR_BLUR_KERNEL];

const DRAW: &[&Kernel] = &[&IMPOSTOR_DRAW_KERNEL];

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let buffer =
        |name, kernel, with| KernelCase { with, ..KernelCase::new(name, kernel, BUFFER, case_buffer) };
    let traced =
        |name, overrides, run| KernelCase { overrides, ..KernelCase::new(name, &TRACE_KERNEL, PICTURE, run) };
    vec![
        buffer("main_impostor_draw: a wet scene", &IMPOSTOR_DRAW_KERNEL, BLUR),
        buffer("main_impostor_blur: a wet scene", &IMPOSTOR_BLUR_KERNEL, DRAW),
        traced("main_trace: wet surfaces that mirror billboards", WET, case_wet),
        traced("main_trace: puddles that mirror billboards", PUDDLES, case_puddles),
    ]
}

const EYE: Vec3 = Vec3::new(0.6, 0.7, 3.2);

fn viewpoint() -> Viewpoint {
    Viewpoint { eye: EYE, forward: -EYE, up: Vec3::Y, fov_y: 0.9 }
}

/// A wet scene, in which things shine, with its billboards.
fn scene() -> SceneData {
    let mut scene = shining_scene();
    let at = WetnessAt { before: 6.0, kept: 1.0, since: 0.0 };
    scene.set_wetness(Some(&SceneWetness { at, towards: Vec3::Y, shift: Vec3::ZERO }));
    with_billboards(scene)
}

fn with_billboards(mut scene: SceneData) -> SceneData {
    let found = list::find(&scene, &viewpoint(), 0.7, None).expect("an eye");
    // The board, the glass of the spot, and two lamps, one of which shines elsewhere.
    assert!(found.billboards.len() >= 2, "{:?}", found.billboards);
    scene.impostors = Some(found);
    scene
}

fn case_wet(gpu: &Gpu) -> Result<Run, GpuError> {
    picture_by(PictureRays::default(), gpu, &scene(), EYE)
}

fn case_puddles(gpu: &Gpu) -> Result<Run, GpuError> {
    let mut scene = scene();
    laid(&mut scene);
    picture_by(PictureRays::default(), gpu, &scene, EYE)
}

/// The buffer after all passes.
fn case_buffer(gpu: &Gpu) -> Result<Run, GpuError> {
    let scene = scene();
    let size = [803_u32, 481];
    let frame = RenderFrame::new(&scene, &viewpoint(), size, 1, 1, 3).expect("a frame");
    let colors = |picture: &[[u32; 2]]| -> Vec<[f32; 3]> {
        picture.iter().map(|&texel| impostor_unpack(texel).to_array()).collect()
    };
    let cpu = SceneView { data: &scene, frame: &frame }.mirrored_picture();
    let pipeline = ImpostorPipeline::default();
    let pass = pipeline.prepare(gpu, gpu, &scene, &frame)?.expect("billboards");
    assert!(pass.dispatches().len() > 3, "the blur has several passes");
    for dispatch in pass.dispatches() {
        gpu.submit(&[dispatch])?;
    }
    let of_gpu: Vec<[u32; 2]> = gpu.read(pass.drawn())?;
    Ok(Run::of_pixels(size[0].div_ceil(2), &colors(&cpu), &colors(&of_gpu)))
}
