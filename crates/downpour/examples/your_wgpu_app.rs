//! Rain in a wgpu application: a window of winit, a little street with a raster pass of its own, and rain over it.
//!
//! What rain adds to the application stands between the lines "Rain". Everything else is an application as one has it.
//!
//! ```sh
//! cargo run --release -p downpour --features wgpu --example your_wgpu_app
//! cargo run --release -p downpour --features wgpu --example your_wgpu_app -- --frames 3 --save FOLDER
//! ```

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use downpour::gpu::wgpu;
use downpour::rain::{PlateTextures, Rain, RainSettings, RainView};
use downpour::render::LightSource;
use downpour::render::camera::{EyeMotion, Viewpoint};
use glam::{Mat4, Vec3, camera::rh};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const NEAR_M: f32 = 0.1;
const FOV_Y: f32 = 0.9;

fn main() -> Result<()> {
    let (mut frames, mut folder, mut size) = (None, None, [960, 540]);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{argument} takes a value"))?;
        match argument.as_str() {
            "--frames" => frames = Some(value.parse::<u32>()?),
            "--save" => folder = Some(PathBuf::from(value)),
            "--size" => {
                let (width, height) = value.split_once('x').ok_or("--size takes WIDTHxHEIGHT")?;
                size = [width.parse()?, height.parse()?];
            }
            _ => return Err(format!("{argument}; allowed: --frames N, --save FOLDER, --size WxH").into()),
        }
    }
    match (frames, folder) {
        (None, None) => Ok(EventLoop::new()?.run_app(&mut Windowed { frames: None, shown: None })?),
        (frames, Some(folder)) => save(frames.unwrap_or(1), size, &folder),
        (frames, None) => Ok(EventLoop::new()?.run_app(&mut Windowed { frames, shown: None })?),
    }
}

/// A box of the street: its corners, what it is, and its color.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Block {
    low: [f32; 3],
    /// 0 wall with windows, 1 ground, 2 lamp, 3 plain.
    kind: f32,
    high: [f32; 3],
    shade: f32,
}

/// The application: its device, its street, and its rain.
struct App {
    device: wgpu::Device,
    queue: wgpu::Queue,
    street: wgpu::RenderPipeline,
    bindings: wgpu::BindGroup,
    camera: wgpu::Buffer,
    blocks: Vec<Block>,
    present: wgpu::RenderPipeline,
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    // ---- Rain: 2 lines
    rain: Rain,
    lamps: Vec<LightSource>,
    // ----
}

impl App {
    fn new(
        device: wgpu::Device,
        queue: wgpu::Queue,
        target: wgpu::TextureFormat,
        size: [u32; 2],
    ) -> Result<Self> {
        let blocks = blocks();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("street"),
            source: wgpu::ShaderSource::Wgsl(include_str!("your_wgpu_app.wgsl").into()),
        });
        let pipeline = |vertex, fragment, format, depth: bool| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(vertex),
                layout: None,
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(vertex),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: depth.then(|| wgpu::DepthStencilState {
                    format: DEPTH,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(fragment),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(wgpu::TextureFormat::into(format))],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let street = pipeline("street_vertex", "street_fragment", COLOR, true);
        let present = pipeline("present_vertex", "present_fragment", target, false);
        let buffer = |bytes: &[u8], usage| {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: bytes.len() as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            queue.write_buffer(&buffer, 0, bytes);
            buffer
        };
        let camera = buffer(&[0; 96], wgpu::BufferUsages::UNIFORM);
        let list = buffer(bytemuck::cast_slice(&blocks), wgpu::BufferUsages::STORAGE);
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &street.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: camera.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: list.as_entire_binding() },
            ],
        });
        // ---- Rain: 10 lines
        let settings = RainSettings { rate_mm_h: 50.0, seed: 7, ..RainSettings::default() };
        let mut rain = Rain::new(&device, &queue, settings)?;
        rain.set_obstacles(&triangles(&blocks))?;
        let is_lamp = |block: &&Block| block.kind == 2.0;
        let lamps = blocks.iter().filter(is_lamp).map(|block| LightSource::Point {
            radius: 0.0,
            position: (Vec3::from(block.low) + Vec3::from(block.high)) * 0.5,
            intensity: Vec3::new(36.0, 25.0, 14.0),
            range: 0.0,
        });
        let lamps = lamps.collect();
        // ----
        let [color, depth] = textures(&device, size);
        Ok(Self { device, queue, street, bindings, camera, blocks, present, color, depth, rain, lamps })
    }

    fn resize(&mut self, size: [u32; 2]) {
        [self.color, self.depth] = textures(&self.device, size.map(|edge| edge.max(1)));
    }

    /// Draws the frame of a time to a target.
    fn draw(&mut self, target: &wgpu::TextureView, time_s: f64) -> Result<()> {
        let size = self.color.texture().size();
        let eye = Vec3::new(0.6, 1.65, 9.0 - 0.4 * time_s as f32);
        let forward = Vec3::new(-0.06, 0.05, -1.0).normalize();
        let aspect = size.width as f32 / size.height as f32;
        let projection = rh::proj::directx::perspective_infinite_reverse(FOV_Y, aspect, NEAR_M);
        let camera: Mat4 = projection * rh::view::look_to_mat4(eye, forward, Vec3::Y);
        let mut words = camera.to_cols_array().to_vec();
        words.extend([eye.x, eye.y, eye.z, 0.0, size.width as f32, size.height as f32, 0.0, 0.0]);
        self.queue.write_buffer(&self.camera, 0, bytemuck::cast_slice(&words));
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let sky = wgpu::Color { r: 0.020, g: 0.026, b: 0.040, a: 1.0 };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(attachment(&self.color, sky))],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.depth,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(0.0),
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&self.street);
            pass.set_bind_group(0, &self.bindings, &[]);
            pass.draw(0..36, 0..self.blocks.len() as u32);
        }
        // ---- Rain: 8 lines
        let view = RainView {
            camera: Viewpoint { eye, forward, up: Vec3::Y, fov_y: FOV_Y },
            motion: EyeMotion { velocity: Vec3::new(0.0, 0.0, -0.4), turning: Vec3::ZERO },
            time_s,
            shutter_s: 1.0 / 60.0,
        };
        let frame = PlateTextures::new(&self.color, &self.depth, NEAR_M);
        self.rain.render(&mut encoder, &view, &PlateTextures { lights: &self.lamps, ..frame })?;
        // ----
        let bindings = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.present.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 2,
                resource: wgpu::BindingResource::TextureView(&self.color),
            }],
        });
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(attachment(target, wgpu::Color::BLACK))],
                ..Default::default()
            });
            pass.set_pipeline(&self.present);
            pass.set_bind_group(0, &bindings, &[]);
            pass.draw(0..3, 0..1);
        }
        self.queue.submit([encoder.finish()]);
        Ok(())
    }
}

fn attachment(view: &wgpu::TextureView, clear: wgpu::Color) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

/// Color and depth textures that the rain can read.
fn textures(device: &wgpu::Device, [width, height]: [u32; 2]) -> [wgpu::TextureView; 2] {
    [COLOR, DEPTH]
        .map(|format| texture(device, [width, height], format, wgpu::TextureUsages::TEXTURE_BINDING))
}

fn texture(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Two rows of houses along a street, with lamps and a shelter.
fn blocks() -> Vec<Block> {
    let block = |low, high, kind, shade| Block { low, kind, high, shade };
    let mut all = vec![block([-40.0, -0.2, -90.0], [40.0, 0.0, 30.0], 1.0, 0.10)];
    for side in [-1.0f32, 1.0] {
        all.push(block(
            [(4.2 * side).min(7.0 * side), 0.0, -90.0],
            [(4.2 * side).max(7.0 * side), 0.12, 30.0],
            1.0,
            0.16,
        ));
        for k in 0..9 {
            let (z, wide) = (20.0 - 11.0 * k as f32, 10.2);
            let height = 9.0 + 3.5 * ((k * 7 + if side > 0.0 { 3 } else { 0 }) % 4) as f32;
            let (near, far) = (6.9 * side, 16.0 * side);
            all.push(block(
                [near.min(far), 0.0, z - wide],
                [near.max(far), height, z],
                0.0,
                0.18 + 0.05 * ((k * 5) % 3) as f32,
            ));
        }
        for k in 0..5 {
            let (x, z) = (4.6 * side, 3.0 - 13.0 * k as f32 - if side > 0.0 { 6.0 } else { 0.0 });
            all.push(block([x - 0.05, 0.0, z - 0.05], [x + 0.05, 4.2, z + 0.05], 3.0, 0.05));
            all.push(block([x - 0.16, 4.2, z - 0.16], [x + 0.16, 4.55, z + 0.16], 2.0, 1.0));
        }
    }
    // A shelter: it does not rain under its roof.
    all.push(block([-6.6, 2.5, -3.0], [-3.6, 2.6, 1.6], 3.0, 0.12));
    for z in [-2.9, 1.5] {
        all.push(block([-3.75, 0.0, z - 0.05], [-3.65, 2.5, z + 0.05], 3.0, 0.08));
    }
    // A parked car.
    all.push(block([2.0, 0.35, -7.2], [3.7, 0.85, -3.0], 3.0, 0.20));
    all.push(block([2.15, 0.85, -6.4], [3.55, 1.42, -4.2], 3.0, 0.09));
    all
}

/// The triangles of the boxes that rain does not pass.
fn triangles(blocks: &[Block]) -> Vec<[[f32; 3]; 3]> {
    const FACES: [[usize; 4]; 6] =
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let of_block = |block: &Block| {
        let corner = |k: usize| {
            std::array::from_fn(|axis| if k >> axis & 1 == 1 { block.high[axis] } else { block.low[axis] })
        };
        FACES.map(|[a, b, c, d]| [[a, b, c].map(corner), [a, c, d].map(corner)])
    };
    blocks.iter().filter(|block| block.kind != 2.0).flat_map(of_block).flatten().collect()
}

/// Draws frames without a window, and saves them.
fn save(frames: u32, size: [u32; 2], folder: &std::path::Path) -> Result<()> {
    let instance = wgpu::Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
    let format = wgpu::TextureFormat::Rgba8UnormSrgb;
    let mut app = App::new(device.clone(), queue.clone(), format, size)?;
    let target = texture(&device, size, format, wgpu::TextureUsages::COPY_SRC);
    let row = (size[0] * 4).next_multiple_of(256);
    std::fs::create_dir_all(folder)?;
    for frame in 0..frames {
        let begin = Instant::now();
        app.draw(&target, f64::from(frame) / 30.0)?;
        let recorded_ms = begin.elapsed().as_secs_f64() * 1.0e3;
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row) * u64::from(size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: Some(size[1]),
        };
        let copied = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(target.texture().as_image_copy(), copied, target.texture().size());
        queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        device.poll(wgpu::PollType::wait_indefinitely())?;
        let bytes = buffer.get_mapped_range(..)?;
        let picture = image::RgbaImage::from_fn(size[0], size[1], |x, y| {
            let at = (y * row + x * 4) as usize;
            image::Rgba(std::array::from_fn(|k| bytes[at + k]))
        });
        let path = folder.join(format!("{frame:04}.png"));
        picture.save(&path)?;
        let all_ms = begin.elapsed().as_secs_f64() * 1.0e3;
        println!("{}: recorded in {recorded_ms:.0} ms, done in {all_ms:.0} ms", path.display());
    }
    Ok(())
}

/// The application in a window.
struct Windowed {
    /// Frames after which it ends.
    frames: Option<u32>,
    shown: Option<Shown>,
}

struct Shown {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    format: wgpu::TextureFormat,
    app: App,
    begin: Instant,
    drawn: u32,
}

impl Shown {
    fn open(events: &ActiveEventLoop) -> Result<Self> {
        let attributes = Window::default_attributes().with_title("Rain in your application");
        let window = Arc::new(events.create_window(attributes)?);
        let instance = wgpu::Instance::default();
        let surface = instance.create_surface(Arc::clone(&window))?;
        let options =
            wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        let formats = surface.get_capabilities(&adapter).formats;
        let format = formats.iter().copied().find(wgpu::TextureFormat::is_srgb).or(formats.first().copied());
        let format = format.ok_or("the surface has no format")?;
        let size = window.inner_size();
        let app = App::new(device, queue, format, [size.width.max(1), size.height.max(1)])?;
        let mut shown = Self { window, surface, format, app, begin: Instant::now(), drawn: 0 };
        shown.resize();
        Ok(shown)
    }

    fn resize(&mut self) {
        let size = self.window.inner_size();
        let configuration = wgpu::SurfaceConfiguration {
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            format: self.format,
            width: size.width.max(1),
            height: size.height.max(1),
            present_mode: wgpu::PresentMode::AutoVsync,
            desired_maximum_frame_latency: 2,
            alpha_mode: wgpu::CompositeAlphaMode::Auto,
            color_space: Default::default(),
            view_formats: Vec::new(),
        };
        self.surface.configure(&self.app.device, &configuration);
        self.app.resize([size.width, size.height]);
    }

    fn draw(&mut self) -> Result<()> {
        let frame = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(frame) | wgpu::CurrentSurfaceTexture::Suboptimal(frame) => {
                frame
            }
            _ => {
                self.resize();
                self.window.request_redraw();
                return Ok(());
            }
        };
        let target = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.app.draw(&target, self.begin.elapsed().as_secs_f64())?;
        self.app.queue.present(frame);
        self.drawn += 1;
        self.window.request_redraw();
        Ok(())
    }
}

impl ApplicationHandler for Windowed {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Shown::open(events) {
            Ok(shown) => self.shown = Some(shown),
            Err(error) => {
                eprintln!("no window: {error}");
                events.exit();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else { return };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(_) => shown.resize(),
            WindowEvent::RedrawRequested => {
                if let Err(error) = shown.draw() {
                    eprintln!("{error}");
                    events.exit();
                }
                if self.frames.is_some_and(|frames| shown.drawn >= frames) {
                    events.exit();
                }
            }
            _ => {}
        }
    }
}
