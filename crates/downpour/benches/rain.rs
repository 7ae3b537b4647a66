//! Rain over the frames of an application, 100 mm/h at 1920x1080: the CPU's part of a frame, what the same search for drops takes
//! on the CPU, and the device's search, binning and all of a frame.

use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use downpour::gpu::{AdapterChoice, Gpu, GpuOptions, LimitSet, wgpu};
use downpour::rain::{PlateTextures, Rain, RainSettings, RainView};
use downpour::render::camera::{EyeMotion, Viewpoint};
use downpour::render::light::LightSource;
use glam::Vec3;

const SIZE: [u32; 2] = [1920, 1080];

/// A frame of gray, 20 m away.
struct Host {
    gpu: Gpu,
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
}

impl Host {
    fn new(size: [u32; 2]) -> Self {
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
        host.clear();
        host
    }

    fn clear(&self) {
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
                    load: wgpu::LoadOp::Clear(0.1 / 20.0),
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
        let textures = PlateTextures { lights: &lights, ..PlateTextures::new(&self.color, &self.depth, 0.1) };
        rain.render(&mut encoder, &view(frame), &textures).expect("a frame");
        encoder
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
    let host = Host::new(SIZE);
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
            let encoder = host.record(&mut rain, frame);
            host.gpu.queue().submit([encoder.finish()]);
            host.gpu.wait().expect("a device");
        });
    });
    group.finish();
}

criterion_group!(benches, rain);
criterion_main!(benches);
