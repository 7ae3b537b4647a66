//! `shaders/wgsl/render/temporal.wgsl` against `downpour_trace::temporal`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::rng_unit;
use downpour_render::camera::{Camera, Viewpoint};
use downpour_shaders::render::scene::{TEMPORAL, TEMPORAL_KERNEL};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::gpu::{LightOnGpu, TemporalPipeline};
use downpour_trace::scene::SceneView;
use downpour_trace::temporal::{FrameLight, LightWindow, PixelLight, TemporalFrame, temporal_pixel};
use glam::{DVec3, Vec3};

use super::scene::shining_scene;
use crate::domain::Domain::{Made, Uniform};
use crate::function::Run;
use crate::kept::{digest, kept};
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

/// No multiple of a workgroup.
pub(super) const SIZE: [u32; 2] = [93, 62];

/// A frame of an eye that walks and turns past a scene.
pub(super) fn frame_of(scene: &SceneData, number: u32) -> RenderFrame {
    let way = number as f32;
    let eye = Vec3::new(0.6 + 0.1 * way, 1.4, 3.0 - 0.15 * way);
    let view =
        Viewpoint { eye, forward: Vec3::new(0.3 * way, 0.1 - 0.1 * way, 0.0) - eye, up: Vec3::Y, fov_y: 0.9 };
    RenderFrame::new(scene, &view, SIZE, 1, 1, u64::from(number)).expect("a frame")
}

/// The light of a frame, with positions relative to another origin.
pub(super) fn light_of(scene: &SceneData, number: u32, origin: Vec3) -> FrameLight<PixelLight> {
    let frame = frame_of(scene, number);
    let key = format!("light of frame {number} {}", digest(scene));
    let found = kept(&key, || SceneView { data: scene, frame: &frame }.picture_and_light().1);
    let mut held = (*found).clone();
    for pixel in &mut held.ambient {
        for slot in [&mut pixel.base, &mut pixel.mirror] {
            slot.position = (Vec3::from(slot.position) - origin).to_array();
        }
    }
    let camera = Camera { eye: frame.camera.eye - origin, ..frame.camera };
    FrameLight { time_s: f64::from(number), origin: origin.as_dvec3(), camera, held }
}

/// Brings the light of a frame to a device.
pub(super) fn upload(gpu: &Gpu, light: &PixelLight) -> Result<LightOnGpu, GpuError> {
    let means: Vec<[[f32; 4]; 2]> = light.means.iter().map(|slots| slots.map(|m| m.to_array())).collect();
    Ok(LightOnGpu {
        ambient: gpu.storage_buffer("light", &light.ambient)?,
        means: gpu.storage_buffer("means", &means)?,
    })
}

/// A camera that looks somewhere, as words.
fn camera_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let forward = Vec3::new(a - 0.5, b - 0.5, -0.4 - c);
    let view = Viewpoint { eye: Vec3::new(0.3, 0.2, 0.1), forward, up: Vec3::Y, fov_y: 0.3 + d };
    bytemuck::cast::<Camera, [u32; 16]>(view.camera(SIZE, 0).expect("a camera")).to_vec()
}

/// Light of three frames in the fourth.
fn temporal_run(gpu: &Gpu) -> Result<Run, GpuError> {
    let scene = shining_scene();
    // The origin has moved since the first two frames.
    let origins = [Vec3::new(4.0, 0.0, -8.0), Vec3::new(4.0, 0.0, -8.0), Vec3::ZERO, Vec3::ZERO];
    let lights: Vec<_> = (0..).zip(origins).map(|(k, origin)| light_of(&scene, k, origin)).collect();
    let mut before_s = [None; 7];
    before_s[..3].copy_from_slice(&[Some(2.0), Some(1.0), Some(0.0)]);
    let window = LightWindow { time_s: 3.0, origin: DVec3::ZERO, before_s };
    let frame = frame_of(&scene, 3);
    let before: Vec<(TemporalFrame, &PixelLight)> = (0..3)
        .map(|turn| {
            let light = &lights[2 - turn as usize];
            (TemporalFrame::new(&window, light, turn, 3), &light.held)
        })
        .collect();
    let own = &lights[3].held;
    let cpu = SceneView { data: &scene, frame: &frame }.temporal(own, &before);
    // Most pixels find their surface in those frames.
    let changed = cpu.iter().filter(|change| **change != Vec3::ZERO).count();
    assert!(2 * changed > cpu.len(), "{changed} pixels of {}", cpu.len());
    let uploaded: Vec<LightOnGpu> =
        before.iter().map(|(_, light)| upload(gpu, light)).collect::<Result<_, _>>()?;
    let pairs: Vec<_> = before.iter().zip(&uploaded).map(|((at, _), light)| (*at, light)).collect();
    let picture = gpu.storage_buffer("picture", &vec![[0.0_f32; 4]; (SIZE[0] * SIZE[1]) as usize])?;
    let pipeline = TemporalPipeline::new(gpu)?;
    let pass = pipeline.prepare(gpu, &frame, &upload(gpu, own)?, &pairs, &picture)?;
    for dispatch in pass.dispatches() {
        gpu.submit(&[dispatch])?;
    }
    let of_gpu: Vec<[f32; 4]> = gpu.read(&picture)?;
    let cpu: Vec<[f32; 4]> = cpu.iter().map(|change| change.extend(0.0).to_array()).collect();
    Ok(Run::of_pixels(SIZE[0], &cpu, &of_gpu))
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    vec![KernelCase {
        name: "main_temporal: three frames before, of an eye that walks",
        kernel: &TEMPORAL_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: Tol::relative(
            1.0e-3,
            1.0e-5,
            "differences of means; a position at the edge of a pixel may fall on either side",
        )
        .with_outliers(1.0e-3),
        run: temporal_run,
    }]
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    vec![FunctionCase::new(
        "temporal_pixel",
        &TEMPORAL,
        &[Made(camera_words), Uniform(-3.0, 3.0), Uniform(-2.0, 2.0), Uniform(-9.0, 1.0)],
        Tol::exact("whole pixels").with_outliers(5.0e-4),
        |a| {
            let camera = bytemuck::cast::<[f32; 16], Camera>(a.f32s());
            temporal_pixel(&camera, Vec3::from(a.f32s())).words()
        },
    )]
}
