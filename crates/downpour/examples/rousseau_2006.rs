//! Tables 4 and 5 of Rousseau 2006 again: the time of a frame of 1024 x 768 pixels with 1000 and 10 000 drops.
//!
//! `cargo run --release -p downpour --features wgpu --example rousseau_2006 -- WEATHER.toml`
//!
//! Drops stand uniformly in the picture's pyramid up to 10 m from the eye, as many as are asked, all of one radius; times
//! are of the device, without the transfer of the picture. The scene is drawn by rays, which the papers' is not, so it
//! is told apart from what the rain adds: the capture of the surroundings, and the drops.

use downpour::trace::data::RenderFrame;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

use downpour::gpu::{AdapterChoice, Dispatch, Gpu};
use downpour::mask::MaskOptions;
use downpour::math::rng::{rng_draw, rng_unit};
use downpour::render::gpu::RainPipeline;
use downpour::render::rain::{DropMasks, Rain, RainOptions};
use downpour::scene::Budget;
use downpour::sim::field::{DropKind, FallingDrop};
use downpour::trace::frame_scene::FrameScene;
use downpour::trace::gpu::ScenePipeline;
use downpour::trace::scene::SceneView;
use downpour::weather::{Roots, Weather, load};

/// Meters.
const FARTHEST: f32 = 10.0;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).ok_or("which weather file?")?;
    let path = Path::new(&path);
    let mut budget = Budget::default();
    let weather = Weather::read(path, &mut budget)?;
    let loaded = load(&weather, &Roots::open(path, &[])?, &mut budget)?;
    let frame_scene = FrameScene::new(&weather, &loaded, 0.0)?;

    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    println!("adapter: {}", gpu.adapter().name);
    let start = Instant::now();
    let masks = DropMasks::trace(MaskOptions::default().refractive_index)?;
    println!("masks: {:.1} ms", ms(start.elapsed()));
    let start = Instant::now();
    let (scenes, rains) = (ScenePipeline::new(&gpu)?, RainPipeline::new(&gpu)?);
    println!("pipelines: {:.1} ms", ms(start.elapsed()));

    let frame = RenderFrame::new(&frame_scene.data, &frame_scene.viewpoint, [1024, 768], 1, 1, 0)?;
    let (scene, uploaded) = (scenes.upload(&frame_scene.data)?, rains.upload(&masks)?);
    let drawn = scenes.prepare(&gpu, &scene, &frame)?;
    println!(
        "scene by rays, 1024 x 768, one sample, one ray to the sky: {:.3} ms",
        time(&gpu, &drawn.dispatches())?
    );
    println!("| drops | R mm | on screen | binning (CPU) ms | capture ms | drops ms | rain, frames/s |");
    println!("|---|---|---|---|---|---|---|");
    for count in [0, 1000, 10_000] {
        for radius in [1.0e-3, 3.0e-3, 4.0e-3] {
            let drops: Vec<FallingDrop> = (0..count).map(|k| drop(&frame_scene, k, 2.0 * radius)).collect();
            let start = Instant::now();
            let eye = frame_scene.viewpoint.eye.as_dvec3();
            let rain = Rain::new(&frame.camera, eye, &drops, &masks, &RainOptions::default());
            let binning = ms(start.elapsed());
            let view = SceneView { data: &frame_scene.data, frame: &frame };
            let lights = [rain.lights(&view, &masks)?, rain.streak_lights(&view, &masks)?];
            let plate = scenes.plate(&gpu, &scene, &frame, &rains, &rain)?;
            let pass = rains.prepare(&gpu, &plate.of(drawn.picture()), &uploaded, &rain, &lights)?;
            let capture = time(&gpu, &plate.dispatches(&pass))?;
            let shown = time(&gpu, &[vec![pass.open_air()], pass.binning().concat(), pass.drops()].concat())?;
            let rate = 1.0e3 / (capture + shown);
            let on_screen = rain.list.len();
            println!(
                "| {count} | {} | {on_screen} | {binning:.2} | {capture:.3} | {shown:.3} | {rate:.0} |",
                radius * 1.0e3
            );
        }
    }
    Ok(())
}

/// Milliseconds of the device; of the clock where a software driver gives no time.
fn time(gpu: &Gpu, dispatches: &[Dispatch<'_>]) -> Result<f64, Box<dyn Error>> {
    if gpu.adapter().is_software() {
        return Ok(ms(gpu.time(dispatches, 1)?.wall));
    }
    gpu.time(dispatches, 1)?;
    let time = gpu.time(dispatches, 100)?;
    Ok(ms(time.device.unwrap_or(time.wall)))
}

fn ms(time: std::time::Duration) -> f64 {
    time.as_secs_f64() * 1.0e3
}

/// A drop somewhere in the picture, uniform in space.
fn drop(frame_scene: &FrameScene, index: u32, diameter: f32) -> FallingDrop {
    let [a, b, c, _] = rng_draw([2006, 0], index, 0, 0).map(rng_unit);
    let view = &frame_scene.viewpoint;
    let forward = view.forward.normalize();
    let right = forward.cross(view.up).normalize();
    let up = right.cross(forward);
    let half = downpour::math::ops::tan(0.5 * view.fov_y);
    let across = right * ((2.0 * a - 1.0) * half * 4.0 / 3.0) + up * ((2.0 * b - 1.0) * half);
    // Uniform in a pyramid: the cube of the depth is uniform.
    let depth = 0.1 + (FARTHEST - 0.1) * downpour::math::ops::pow(c, 1.0 / 3.0);
    FallingDrop {
        position: (view.eye + (forward + across) * depth).as_dvec3(),
        velocity: [0.0; 3],
        diameter,
        id: u64::from(index),
        kind: DropKind::Falling,
        present_s: FallingDrop::ALWAYS,
        normal: FallingDrop::LEVEL,
    }
}
