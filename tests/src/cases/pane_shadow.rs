//! `shaders/wgsl/render/pane_shadow.wgsl` against `downpour_render::glass`: the light of lamps through a wet pane.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_pcg4d, rng_unit};
use downpour_render::glass::{GlassPictureDrop, PaneShade, PaneShadows};
use downpour_shaders::render::scene::TRACE_KERNEL;
use glam::Vec3;

use super::scene::{Parts, picture, scene};
use crate::function::Run;
use crate::{KernelCase, Tol};

/// A level pane over the floor of the scene of the other cases, with drops as large as hands.
fn case(gpu: &Gpu, form: PaneShadows, gathers_m: f32, height: f32) -> Result<Run, GpuError> {
    let drop = |k: u32| {
        let [x, y, size, _] = rng_pcg4d([k, 7, 8, 9]).map(rng_unit);
        let radius = 0.05 + 0.1 * size;
        GlassPictureDrop {
            center: [6.0 * x, 6.0 * y],
            radius,
            sphere: 1.1 * radius,
            along: [0.6, 0.8],
            behind: 0.7,
            droop: [0.0, 1.0],
            lobes: [0.1, -0.1, 0.05, 0.0],
            ..Default::default()
        }
    };
    let drops: Vec<GlassPictureDrop> = (0..120).map(drop).collect();
    let shade = PaneShade::new([6.0, 6.0], &drops, form, gathers_m, 1.333);
    let mut scene = scene();
    scene.set_pane(&shade, [Vec3::new(-3.0, height, -3.0), Vec3::X, Vec3::Z, Vec3::Y]);
    picture(gpu, &scene, Vec3::new(0.6, 0.9, 2.6), 1)
}

const OVERRIDES: &[(&str, f64)] = &Parts { pane: 1.0, ..Parts::NONE }.overrides();

const PICTURE: Tol = Tol::relative(
    4.0e-3,
    4.0e-3,
    "log2 chooses the level, directions go through sine and cosine, and light that is gathered changes eightfold within a texel",
)
.with_outliers(6.0e-3);

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case =
        |name, run| KernelCase { overrides: OVERRIDES, ..KernelCase::new(name, &TRACE_KERNEL, PICTURE, run) };
    vec![
        case("main_trace: a pane of lenses, near its focus", case_near),
        case("main_trace: a pane of lenses, far beyond it", case_far),
        case("main_trace: a pane of Tatarchuk and Isidoro", case_paper),
    ]
}

fn case_near(gpu: &Gpu) -> Result<Run, GpuError> {
    case(gpu, PaneShadows::Lens, 0.08, 0.1)
}

fn case_far(gpu: &Gpu) -> Result<Run, GpuError> {
    case(gpu, PaneShadows::Lens, 0.0, 2.5)
}

fn case_paper(gpu: &Gpu) -> Result<Run, GpuError> {
    case(gpu, PaneShadows::Tatarchuk2006, 0.1, 0.6)
}
