//! Streaks on a picture of 1280x720: summed up along their paths by compute, as Downpour does, and blended as rectangles by
//! the device's rasterizer. Both have all streaks in one color, so that what is compared is how they come onto the picture. The lines printed
//! tell how much each covers, in drops' areas.

use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use downpour::gpu::{AdapterChoice, Dispatch, Gpu, wgpu};
use downpour::mask::MaskOptions;
use downpour::math::ops;
use downpour::math::rng::{rng_draw, rng_unit};
use downpour::render::camera::Viewpoint;
use downpour::render::gpu::RainPipeline;
use downpour::render::rain::{DropMasks, Exposure, Rain, RainOptions, StreakColor};
use downpour::sim::field::{DropKind, FallingDrop};
use downpour::trace::builder::SceneBuilder;
use downpour::trace::data::RenderFrame;
use downpour::trace::gpu::ScenePipeline;
use downpour::trace::scene::SceneView;
use downpour::trace::sky_light::SkyLight;
use glam::{DVec3, Vec3};

const SIZE: [u32; 2] = [1280, 720];

/// Numbers of streaks with their widths and lengths, pixels: those of the design's table, and wide ones.
const STREAKS: [(u32, [f32; 2]); 4] =
    [(1_000_000, [1.0, 10.0]), (1_000_000, [1.0, 3.0]), (200_000, [2.0, 20.0]), (20_000, [8.0, 80.0])];

/// On a software driver so many times fewer.
const FEWER: u32 = 20;

/// Distance of all streaks, m, and the speed at which they fall, m/s.
const DISTANCE: f32 = 4.0;
const SPEED: f32 = 8.0;

/// Repeats within a measured submission, so that what a submission itself costs does not count.
const REPEATS: u32 = 4;

/// Raster rectangles of streaks: one instance each.
const RASTER: &str = "
struct Streak { middle: vec2f, half_size: vec2f }
@group(0) @binding(0) var<storage, read> streaks: array<Streak>;
struct Corner { @builtin(position) position: vec4f, @location(0) @interpolate(flat) index: u32 }
@vertex fn vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) index: u32) -> Corner {
    let streak = streaks[index];
    // Half a pixel beyond, for what covers a pixel in part.
    let sign = vec2f(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    let at = streak.middle + sign * (streak.half_size + 0.5);
    let clip = at / vec2f(1280.0, 720.0) * 2.0 - 1.0;
    return Corner(vec4f(clip.x, -clip.y, 0.0, 1.0), index);
}
@fragment fn fragment(corner: Corner) -> @location(0) vec4f {
    let streak = streaks[corner.index];
    let near = max(corner.position.xy - 0.5, streak.middle - streak.half_size);
    let far = min(corner.position.xy + 0.5, streak.middle + streak.half_size);
    let covered = max(far - near, vec2f(0.0));
    // The drop's area over that of its streak.
    let part = 0.7853982 * streak.half_size.x / streak.half_size.y;
    return vec4f(covered.x * covered.y * part);
}
";

/// Streaks to be drawn.
struct Streaks {
    drops: Vec<FallingDrop>,
    /// Middles and half sizes, pixels.
    rectangles: Vec<[f32; 4]>,
    shutter_s: f64,
    /// Area of a drop, pixels.
    area: f32,
}

fn viewpoint() -> Viewpoint {
    Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.8 }
}

/// Streaks anywhere on the picture.
fn streaks(count: u32, [width, length]: [f32; 2]) -> Streaks {
    let pixel = 2.0 * ops::tan(0.5 * viewpoint().fov_y) / SIZE[1] as f32 * DISTANCE;
    let diameter = width * pixel;
    // From the middle of the drop at the beginning to that at the end.
    let way = (length - width).max(0.0) * pixel;
    let (mut drops, mut rectangles) = (Vec::new(), Vec::new());
    for k in 0..count {
        let [a, b, c, d] = rng_draw([4, 4], k, 0, 0);
        let at = [rng_unit(a) * SIZE[0] as f32, rng_unit(b) * SIZE[1] as f32];
        rectangles.push([at[0], at[1], 0.5 * width, 0.5 * length]);
        let [x, y] =
            [at[0] - 0.5 * SIZE[0] as f32, 0.5 * SIZE[1] as f32 - at[1]].map(|n| f64::from(n * pixel));
        drops.push(FallingDrop {
            position: DVec3::new(x, y, f64::from(-DISTANCE)),
            velocity: [0.0, -SPEED, 0.0],
            diameter,
            id: u64::from(c) << 32 | u64::from(d),
            kind: DropKind::Falling,
            present_s: FallingDrop::ALWAYS,
            normal: FallingDrop::LEVEL,
        });
    }
    let shutter_s = f64::from(way / SPEED);
    Streaks { drops, rectangles, shutter_s, area: std::f32::consts::FRAC_PI_4 * width * width }
}

/// The rasterizer with its target.
struct Raster {
    pipeline: wgpu::RenderPipeline,
    target: wgpu::Texture,
}

impl Raster {
    fn new(gpu: &Gpu) -> Self {
        let device = gpu.device();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(RASTER.into()),
        });
        // What is behind shows through the rest, as behind Downpour's drops.
        let over = wgpu::BlendComponent::OVER;
        let format = wgpu::TextureFormat::Rgba16Float;
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("streaks as rectangles"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format,
                    blend: Some(wgpu::BlendState { color: over, alpha: over }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        let target = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        Self { pipeline, target }
    }

    fn bound(&self, gpu: &Gpu, streaks: &Streaks) -> wgpu::BindGroup {
        let buffer = gpu.storage_buffer("rectangles", &streaks.rectangles).expect("a buffer");
        gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        })
    }

    /// Draws all streaks some times, each time on an empty picture, and waits.
    fn draw(&self, gpu: &Gpu, bound: &wgpu::BindGroup, count: u32, repeats: u32) -> Duration {
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let view = self.target.create_view(&wgpu::TextureViewDescriptor::default());
        for _ in 0..repeats {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, bound, &[]);
            pass.draw(0..4, 0..count);
        }
        let begin = Instant::now();
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("a device");
        begin.elapsed()
    }

    /// What the picture holds, drops' areas.
    fn covered(&self, gpu: &Gpu, area: f32) -> f64 {
        let bytes = u64::from(SIZE[0] * SIZE[1] * 8);
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let buffer = gpu.empty_buffer("picture", bytes, usage).expect("a buffer");
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(SIZE[0] * 8),
                    rows_per_image: None,
                },
            },
            self.target.size(),
        );
        gpu.queue().submit([encoder.finish()]);
        let halves: Vec<u16> = gpu.read(&buffer).expect("a picture");
        let alpha = halves.as_chunks::<4>().0.iter().map(|texel| f64::from(half_to_f32(texel[3])));
        alpha.sum::<f64>() / f64::from(area)
    }
}

/// A number of 16 bits that is not below 0.
fn half_to_f32(bits: u16) -> f32 {
    let [exponent, mantissa] = [u32::from(bits >> 10 & 31), u32::from(bits & 1023)];
    if exponent == 0 {
        return mantissa as f32 / 16_777_216.0;
    }
    f32::from_bits((exponent + 112) << 23 | mantissa << 13)
}

fn compared(c: &mut Criterion) {
    let gpu = Gpu::open(&AdapterChoice::Auto).expect("a GPU or its software driver");
    let software = gpu.adapter().is_software();
    println!("adapter: {}", gpu.adapter().name);
    let masks = DropMasks::trace(MaskOptions::default().refractive_index).expect("masks");
    let data = SceneBuilder::new().build(&SkyLight::uniform([0.5; 3]));
    let (scenes, rains) =
        (ScenePipeline::new(&gpu).expect("a pipeline"), RainPipeline::new(&gpu).expect("a pipeline"));
    let frame = RenderFrame::new(&data, &viewpoint(), SIZE, 1, 0, 0).expect("a frame");
    let (scene, uploaded) = (scenes.upload(&data).expect("a scene"), rains.upload(&masks).expect("masks"));
    let drawn = scenes.prepare(&gpu, &scene, &frame).expect("a picture");
    gpu.submit(&drawn.dispatches()).expect("a picture");
    let raster = Raster::new(&gpu);
    let mut group = c.benchmark_group("streaks on a picture");
    group.sample_size(10);
    for (count, size) in STREAKS {
        let count = if software { count / FEWER } else { count };
        let name = format!("{count} of {} x {} px", size[0], size[1]);
        let streaks = streaks(count, size);
        group.throughput(Throughput::Elements(u64::from(count)));
        let exposure =
            Exposure { shutter_s: streaks.shutter_s, color: StreakColor::White, ..Exposure::default() };
        let options = RainOptions { exposure, ..RainOptions::default() };
        let rain = Rain::new(&frame.camera, DVec3::ZERO, &streaks.drops, &masks, &options);
        let view = SceneView { data: &data, frame: &frame };
        let lights =
            [rain.lights(&view, &masks).expect("lamps"), rain.streak_lights(&view, &masks).expect("lamps")];
        let plate = scenes.plate(&gpu, &scene, &frame, &rains, &rain).expect("a plate");
        let pass =
            rains.prepare(&gpu, &plate.of(drawn.picture()), &uploaded, &rain, &lights).expect("a pass");
        let mut dispatches: Vec<Dispatch<'_>> = vec![pass.open_air()];
        dispatches.extend(pass.binning().concat());
        // The layer holds what is not drawn, which is nothing, until the drops are over it.
        dispatches.extend(pass.medium());
        dispatches.extend(pass.drops());
        gpu.submit(&plate.dispatches(&pass)).expect("surroundings");
        group.bench_function(BenchmarkId::new("sums by compute", &name), |b| {
            b.iter_custom(|iterations| {
                let once = |_| gpu.time(&dispatches, REPEATS).expect("a time").wall;
                (0..iterations).map(once).sum()
            });
        });
        let covered =
            pass.layer().expect("a layer").iter().map(|texel| f64::from(1.0 - texel[3])).sum::<f64>();
        let bound = raster.bound(&gpu, &streaks);
        group.bench_function(BenchmarkId::new("rectangles by the rasterizer", &name), |b| {
            b.iter_custom(|iterations| {
                let once = |_| raster.draw(&gpu, &bound, count, REPEATS) / REPEATS;
                (0..iterations).map(once).sum()
            });
        });
        let by_raster = raster.covered(&gpu, streaks.area);
        println!("{name}: {:.0} and {by_raster:.0} drops' areas", covered / f64::from(streaks.area));
    }
    group.finish();
}

criterion_group!(benches, compared);
criterion_main!(benches);
