//! Frames of the street for a live display, against frames with all their layers: `frame` traces the scene for each, `kept` draws
//! rain before a plate that stays, `display` reads no more than pixels of that, `drag` changes the rain rate before each. `windy` is the day
//! with a tornado and turbulence, in which rain goes step by step; there `drag` changes the tornado. `walk` displays a camera that walks down the
//! street, with rays of all pixels that look for light, and of one in 4 and in 16.
//!
//! At 1920x1080 on hardware, at 240x135 on a software driver.

use std::path::{Path, PathBuf};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use downpour::gpu::{AdapterChoice, Gpu};
use downpour::scene::Budget;
use downpour::weather::Roots;
use downpour::wind::{Turbulence, Wind, WindPrimitive, WindTornado};
use downpour::{Device, Renderer, RendererOptions, Source};
use glam::Vec3;

/// Frames over which light goes on before a camera that walks.
const RUNNING_FRAMES: u32 = 16;

/// Frames of rays that refine a plate.
const KEPT_FRAMES: u32 = 4;

/// A tornado of a circulation, m^2/s, in the street, and turbulence.
fn tornado(circulation: f32) -> Wind {
    let tornado = WindPrimitive::Tornado(WindTornado {
        circulation,
        discharge: 40.0,
        base: Vec3::new(0.5, 0.0, -16.0),
        axis: Vec3::Y,
        height: 20.0,
        core_radius: 2.0,
    });
    let turbulence = Turbulence { speed: 2.0, length: 8.0, seed: 4 };
    Wind::new(vec![tornado.into()], None, Some(turbulence)).expect("a wind")
}

/// A file of the street; where the program was carried without the sources, from the project's folder.
fn street(weather: &str) -> PathBuf {
    let file = format!("assets/scenes/street/{weather}.toml");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(&file);
    if path.exists() { path } else { file.into() }
}

fn source(weather: &str) -> Source {
    Source::read(&street(weather), &[], &mut Budget::default()).expect("a weather")
}

/// A renderer of the street before a camera that walks through it.
fn walking(gpu: &Gpu, weather: &str, size: [u32; 2], ray_spacing: u32) -> Renderer {
    let Source { mut weather, loaded, .. } = source(weather);
    weather.size = size;
    weather.camera.path = source("walk").weather.camera.path;
    let options = RendererOptions {
        samples: 1,
        kept_frames: KEPT_FRAMES,
        running_frames: RUNNING_FRAMES,
        ray_spacing,
        ..RendererOptions::default()
    };
    Renderer::new(weather, loaded, options, Device::gpu(gpu.clone(), false)).expect("a renderer")
}

fn live(c: &mut Criterion) {
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("a GPU or its software driver");
    let size = if gpu.adapter().is_software() { [240, 135] } else { [1920, 1080] };
    for name in ["day", "night", "windy"] {
        let weather = if name == "windy" { "day" } else { name };
        let renderer = |kept_frames| {
            let mut source = source(weather);
            source.weather.size = size;
            if name == "windy" {
                source.weather.wind = tornado(60.0);
            }
            let options = RendererOptions { samples: 1, kept_frames, ..RendererOptions::default() };
            let device = Device::gpu(gpu.clone(), false);
            Renderer::new(source.weather, source.loaded, options, device).expect("a renderer")
        };
        let mut group = c.benchmark_group(format!("live {name}"));
        group.sample_size(10);
        let mut time_s = 0.0;
        let mut next_s = || {
            time_s += 1.0 / 60.0;
            time_s
        };
        let mut traced = renderer(0);
        traced.frame(0.0).expect("a frame");
        group.bench_function("frame", |b| b.iter(|| traced.frame(next_s()).expect("a frame")));
        drop(traced);
        let mut kept = renderer(KEPT_FRAMES);
        for _ in 0..KEPT_FRAMES {
            kept.frame(0.0).expect("a frame");
        }
        group.bench_function("kept", |b| b.iter(|| kept.frame(next_s()).expect("a frame")));
        group.bench_function("display", |b| b.iter(|| kept.display(next_s()).expect("a frame")));
        let shown = kept.display(next_s()).expect("a frame");
        println!(
            "live {name}: {} of {} drops, begun in {:.2} ms, whole {:.2} ms, {:?}",
            shown.drops_drawn, shown.drops_simulated, shown.begin_ms, shown.frame_ms, shown.passes
        );
        let files = Roots::open(&street(weather), &[]).expect("a folder");
        let (mut weather, mut is_more) = (kept.weather().clone(), false);
        if name != "windy" {
            for spacing in [1, 2, 4] {
                let mut walk = walking(&gpu, name, size, spacing);
                walk.display(0.0).expect("a frame");
                let mut time_s = 0.0;
                let mut next = || {
                    time_s += 1.0 / 60.0;
                    walk.display(time_s).expect("a frame")
                };
                group.bench_function(BenchmarkId::new("walk", spacing), |b| b.iter(&mut next));
                let shown = next();
                println!(
                    "live {name} walk {spacing}: begun in {:.2} ms, whole {:.2} ms, {:?}",
                    shown.begin_ms, shown.frame_ms, shown.passes
                );
            }
        }
        group.bench_function(BenchmarkId::from_parameter("drag"), |b| {
            b.iter(|| {
                is_more = !is_more;
                if name == "windy" {
                    weather.wind = tornado(if is_more { 61.0 } else { 60.0 });
                } else {
                    weather.rain.rate_mm_h = if is_more { 61.0 } else { 60.0 };
                }
                kept.set_weather(weather.clone(), &files).expect("a weather");
                kept.display(next_s()).expect("a frame")
            });
        });
        group.finish();
    }
}

criterion_group!(benches, live);
criterion_main!(benches);
