//! Rain over the frames of an application, 100 mm/h at 1920x1080: the CPU's part of a frame, what the same search for drops takes
//! on the CPU, and the device's search, binning and all of a frame. `rain before a wall`, 25 mm/h at 1280x720: the drops before a wall that is 10 m
//! away, and those before one at 100 m, which are 1000 times as many.

use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use downpour::drop::distribution::DropSizeDistribution;
use downpour::gpu::{AdapterChoice, Gpu, GpuOptions, LimitSet, wgpu};
use downpour::math::ops;
use downpour::rain::{PlateTextures, Rain, RainSettings, RainView};
use downpour::render::camera::{EyeMotion, Viewpoint};
use downpour::render::light::LightSource;
use glam::Vec3;

const SIZE: [u32; 2] = [1920, 1080];

/// Distance of the near plane of the host's depth, m.
const NEAR_M: f32 = 0.1;

/// A gray wall across the view.
struct Host {
    gpu: Gpu,
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
}

impl Host {
    fn new(size: [u32; 2], wall_m: f32) -> Self {
        let options = GpuOptions {
            adapter: AdapterChoice::Auto,
            limits: LimitSet::WebGpuDefault,
            ..GpuOptions::default()
        };
        let gpu = Gpu::open_with(&options).expect("a GPU or its software driver");
        let view = |format| {
            let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let (color, depth) =
            (view(wgpu::TextureFormat::Rgba16Float), view(wgpu::TextureFormat::Depth32Float));
        let host = Self { gpu, color, depth };
        host.clear(wall_m);
        host
    }

    fn clear(&self, wall_m: f32) {
        let mut encoder = self.gpu.device().create_command_encoder(&Default::default());
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.1, g: 0.1, b: 0.1, a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(NEAR_M / wall_m),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        self.gpu.queue().submit([encoder.finish()]);
    }

    fn record(&self, rain: &mut Rain, frame: u32) -> wgpu::CommandEncoder {
        let mut encoder = self.gpu.device().create_command_encoder(&Default::default());
        let lights = [LightSource::Point {
            radius: 0.0,
            position: Vec3::new(0.0, 6.0, -8.0),
            intensity: Vec3::splat(400.0),
            range: 0.0,
        }];
        let textures =
            PlateTextures { lights: &lights, ..PlateTextures::new(&self.color, &self.depth, NEAR_M) };
        rain.render(&mut encoder, &view(frame), &textures).expect("a frame");
        encoder
    }

    /// Draws a frame, and waits until the device is idle.
    fn draw(&self, rain: &mut Rain, frame: u32) {
        let encoder = self.record(rain, frame);
        self.gpu.queue().submit([encoder.finish()]);
        self.gpu.wait().expect("a device");
    }
}

fn view(frame: u32) -> RainView {
    RainView {
        camera: Viewpoint { eye: Vec3::new(0.0, 1.7, 0.0), forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.87 },
        motion: EyeMotion::default(),
        time_s: 3.0 + f64::from(frame) / 60.0,
        shutter_s: 1.0 / 60.0,
    }
}

fn settings() -> RainSettings {
    RainSettings { rate_mm_h: 100.0, max_drops: 2_000_000, ..RainSettings::default() }
}

fn rain(c: &mut Criterion) {
    let host = Host::new(SIZE, 20.0);
    let mut rain = Rain::new(host.gpu.device(), host.gpu.queue(), settings()).expect("rain");
    let drops = rain.drops(&view(0), SIZE).expect("drops");
    let [listed, tried] = [drops.drops.len() as u64, drops.simulated];
    println!("{listed} drops of {tried} looked at, on {}", host.gpu.adapter().name);
    let mut group = c.benchmark_group("rain over a frame");
    group.sample_size(10);
    let mut frame = 0;
    group.bench_function("recorded by the CPU", |b| {
        b.iter_custom(|iterations| {
            let mut sum = Duration::ZERO;
            for _ in 0..iterations {
                frame += 1;
                let begin = Instant::now();
                let encoder = host.record(&mut rain, frame);
                sum += begin.elapsed();
                drop(encoder);
                // What was written has to leave the queue.
                host.gpu.queue().submit([]);
            }
            sum
        });
    });
    group.bench_function("drops found by the CPU", |b| {
        b.iter(|| {
            frame += 1;
            rain.drops(&view(frame), SIZE).expect("drops").drops.len()
        });
    });
    group.bench_function("drawn by the device", |b| {
        b.iter(|| {
            frame += 1;
            host.draw(&mut rain, frame);
        });
    });
    group.finish();
}

/// Few drops and a thousand times as many, by the distance of what stands behind them.
fn walls(c: &mut Criterion) {
    let size = [1280, 720];
    let settings =
        RainSettings { rate_mm_h: 25.0, max_drops: 2_000_000, far_m: 100.0, ..RainSettings::default() };
    let density =
        DropSizeDistribution::new(settings.sizes, settings.rate_mm_h).expect("a rain").number_density();
    let mut group = c.benchmark_group("rain before a wall");
    group.sample_size(20);
    for wall_m in [10.0f32, 100.0] {
        let host = Host::new(size, wall_m);
        let mut rain = Rain::new(host.gpu.device(), host.gpu.queue(), settings.clone()).expect("rain");
        let camera = view(0).camera;
        let half_height = ops::f64::tan(f64::from(camera.fov_y) * 0.5) * f64::from(wall_m);
        let base = 4.0 * half_height * half_height * f64::from(size[0]) / f64::from(size[1]);
        println!("{:.2e} drops before a wall at {wall_m} m", density * base * f64::from(wall_m) / 3.0);
        let mut frame = 0;
        group.bench_function(BenchmarkId::from_parameter(wall_m), |b| {
            b.iter(|| {
                frame += 1;
                host.draw(&mut rain, frame);
            });
        });
    }
    group.finish();
}

criterion_group!(benches, rain, walls);
criterion_main!(benches);
