//! A host application's frame for tests of rain in it: a gray sky above, a wall some meters away below.

#![allow(dead_code, reason = "each test binary uses its part of this module")]

use downpour::gpu::{Gpu, wgpu};
use downpour::math::packing::packing_unpack_half;
use downpour::rain::{
    DepthRange, HostSky, PlateTextures, Rain, RainError, RainSettings, RainStats, RainView,
};
use downpour::render::camera::{EyeMotion, Viewpoint};
use downpour::render::light::LightSource;
use glam::Vec3;

/// Distance of the near plane, m.
pub(crate) const NEAR_M: f32 = 0.1;

/// Colors of sky and wall.
pub(crate) const SKY: f64 = 0.5;
pub(crate) const WALL: f64 = 0.0625;

/// Textures of a host.
pub(crate) struct Host {
    pub(crate) gpu: Gpu,
    pub(crate) color: wgpu::Texture,
    pub(crate) depth: wgpu::Texture,
    /// Colors of sky and wall.
    pub(crate) colors: [[f64; 3]; 2],
    /// Convention of the depth texture.
    pub(crate) range: DepthRange,
}

impl Host {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], format: wgpu::TextureFormat) -> Self {
        let texture = |format, usage| {
            gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        Self {
            gpu: gpu.clone(),
            color: texture(format, wgpu::TextureUsages::COPY_SRC),
            depth: texture(wgpu::TextureFormat::Depth32Float, wgpu::TextureUsages::empty()),
            colors: [[SKY; 3], [WALL; 3]],
            range: DepthRange::reversed(NEAR_M),
        }
    }

    /// Views of color and depth.
    pub(crate) fn views(&self) -> [wgpu::TextureView; 2] {
        [&self.color, &self.depth].map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()))
    }

    pub(crate) fn encoder(&self) -> wgpu::CommandEncoder {
        self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Value of the depth texture at a distance along the view direction, m: what a projection matrix gives.
    fn depth_value(&self, distance_m: f32) -> f32 {
        let DepthRange { near_m, far_m, is_reversed } = self.range;
        let [near, far, distance] = [near_m, far_m, distance_m].map(f64::from);
        let standard = if far.is_finite() {
            far / (far - near) * (1.0 - near / distance)
        } else {
            1.0 - near / distance
        };
        (if is_reversed { 1.0 - standard } else { standard }) as f32
    }

    /// Draws the frame without rain: the wall `wall_m` away (infinite for none), from half the height downwards.
    pub(crate) fn draw(&self, encoder: &mut wgpu::CommandEncoder, wall_m: f32) {
        let [[sky_r, sky_g, sky_b], [wall_r, wall_g, wall_b]] = self.colors;
        let source = format!(
            "@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
                return vec4f(f32((i & 1u) << 2u) - 1.0, 1.0 - f32((i & 2u) << 1u), 0.0, 1.0);
            }}
            @fragment fn wall() -> @location(0) vec4f {{ return vec4f({wall_r:?}, {wall_g:?}, {wall_b:?}, 1.0); }}"
        );
        let device = self.gpu.device();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(self.color.format().into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let [color, depth] = self.views();
        let clear = if self.range.is_reversed { 0.0 } else { 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: sky_r, g: sky_g, b: sky_b, a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(clear),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        if wall_m.is_finite() {
            let [width, height] = [self.color.width(), self.color.height()];
            let value = self.depth_value(wall_m);
            pass.set_pipeline(&pipeline);
            pass.set_viewport(0.0, 0.0, width as f32, height as f32, value, value);
            pass.set_scissor_rect(0, height / 2, width, height - height / 2);
            pass.draw(0..3, 0..1);
        }
    }

    /// The color texture, rows from the top, as linear numbers; `Rgba16Float` only.
    pub(crate) fn read(&self) -> Vec<[f32; 4]> {
        let (width, height) = (self.color.width(), self.color.height());
        let row = (width * 8).next_multiple_of(256);
        let buffer = self
            .gpu
            .empty_buffer("picture", u64::from(row) * u64::from(height), wgpu::BufferUsages::empty())
            .expect("it is possible");
        let mut encoder = self.encoder();
        encoder.copy_texture_to_buffer(
            self.color.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: Some(height),
                },
            },
            self.color.size(),
        );
        self.gpu.queue().submit([encoder.finish()]);
        let words: Vec<u16> = self.gpu.read(&buffer).expect("it is possible");
        words
            .chunks(row as usize / 2)
            .flat_map(|line| line[..width as usize * 4].chunks(4))
            .map(|pixel| {
                let [[r, g], [b, a]] =
                    [0, 2].map(|k| packing_unpack_half(u32::from(pixel[k]) | u32::from(pixel[k + 1]) << 16));
                [r, g, b, a]
            })
            .collect()
    }

    /// A frame with rain.
    pub(crate) fn rain(
        &self,
        rain: &mut Rain,
        view: &RainView,
        wall_m: f32,
        lights: &[LightSource],
    ) -> Result<Vec<[f32; 4]>, RainError> {
        self.rain_under(rain, view, wall_m, lights, None)
    }

    /// A frame with rain under a sky map.
    pub(crate) fn rain_under(
        &self,
        rain: &mut Rain,
        view: &RainView,
        wall_m: f32,
        lights: &[LightSource],
        sky: Option<HostSky<'_>>,
    ) -> Result<Vec<[f32; 4]>, RainError> {
        self.submit(rain, view, wall_m, lights, sky)?;
        Ok(self.read())
    }

    /// Submits a frame with rain, without waiting for it.
    pub(crate) fn submit(
        &self,
        rain: &mut Rain,
        view: &RainView,
        wall_m: f32,
        lights: &[LightSource],
        sky: Option<HostSky<'_>>,
    ) -> Result<RainStats, RainError> {
        let mut encoder = self.encoder();
        self.draw(&mut encoder, wall_m);
        let [color, depth] = self.views();
        let depth_range = self.range;
        let textures =
            PlateTextures { lights, sky, depth_range, ..PlateTextures::new(&color, &depth, NEAR_M) };
        let stats = rain.render(&mut encoder, view, &textures)?;
        self.gpu.queue().submit([encoder.finish()]);
        Ok(stats)
    }
}

pub(crate) fn view() -> RainView {
    RainView {
        camera: Viewpoint { eye: Vec3::new(0.5, 1.6, -2.0), forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.8 },
        motion: EyeMotion::default(),
        time_s: 3.0,
        shutter_s: 1.0 / 60.0,
    }
}

pub(crate) fn settings() -> RainSettings {
    RainSettings { rate_mm_h: 500.0, seed: 5, max_drops: 3000, ..RainSettings::default() }
}

pub(crate) fn mean(pixels: &[[f32; 4]]) -> f32 {
    pixels.iter().map(|p| p[0] + p[1] + p[2]).sum::<f32>() / (3 * pixels.len()) as f32
}

/// Level ground that reaches far.
pub(crate) fn ground() -> [[[f32; 3]; 3]; 2] {
    let [a, b, c, d] = [[-40.0, 0.0, -40.0], [-40.0, 0.0, 40.0], [40.0, 0.0, 40.0], [40.0, 0.0, -40.0]];
    [[a, b, c], [a, c, d]]
}
