//! Plates of host applications on the device: what [`crate::host`] makes on the CPU, and rain over a color texture.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::PoisonError;

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_math::pyramid::{PyramidRounding, pyramid_levels};
use downpour_shaders::common::PYRAMID_KERNEL;
use downpour_shaders::compose;
use downpour_shaders::render::host::{HOST_BLEND, HOST_ENVIRONMENT_KERNEL, HOST_PLATE_KERNEL};

use crate::host::{HostBlendFrame, HostEnvironmentFrame, HostPlateFrame};

/// Pipelines of the plates of host applications: made once, used for any number of pictures.
#[derive(Debug)]
pub struct HostPipeline {
    gpu: Gpu,
    plate: ComputeKernel,
    pyramid: ComputeKernel,
    environment: ComputeKernel,
    blend: wgpu::ShaderModule,
    /// By the format of the color texture.
    blends: Mutex<HashMap<wgpu::TextureFormat, wgpu::RenderPipeline>>,
    /// Bound where there is no sky map.
    no_sky: wgpu::TextureView,
}

/// Textures of a host application.
#[derive(Clone, Copy, Debug)]
pub struct HostTextures<'a> {
    /// Color, linear when it is read.
    pub color: &'a wgpu::TextureView,
    /// Depth, not multisampled.
    pub depth: &'a wgpu::TextureView,
    /// A sky map: equirectangular, +Y up, u = 0.5 + atan2(z, x) / 2 pi.
    pub sky: Option<&'a wgpu::TextureView>,
}

/// A plate of a host application, ready to be made.
#[derive(Debug)]
pub struct HostPass<'a> {
    pipeline: &'a HostPipeline,
    plate: (wgpu::BindGroup, [u32; 3]),
    levels: Vec<(wgpu::BindGroup, [u32; 3])>,
    environment: (wgpu::BindGroup, u32),
    pixels: wgpu::Buffer,
}

impl HostPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        let blend = gpu.create("shaders of rain over a color texture", 0, |device| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("rain over a color texture"),
                source: wgpu::ShaderSource::Wgsl(compose(&[&HOST_BLEND]).into()),
            })
        })?;
        let no_sky = gpu.create("no sky map", 8, |device| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("no sky map"),
                size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba16Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        })?;
        Ok(Self {
            gpu: gpu.clone(),
            plate: kernel(&HOST_PLATE_KERNEL)?,
            pyramid: kernel(&PYRAMID_KERNEL)?,
            environment: kernel(&HOST_ENVIRONMENT_KERNEL)?,
            blend,
            blends: Mutex::default(),
            no_sky,
        })
    }

    /// Makes ready to make a plate and an environment map, the finest level of `map`.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the picture is larger than the device takes, or what else the GPU says.
    pub fn prepare<'a>(
        &'a self,
        buffers: &impl BufferSource,
        textures: &HostTextures<'_>,
        plate: &HostPlateFrame,
        environment: &HostEnvironmentFrame,
        map: &wgpu::Buffer,
    ) -> Result<HostPass<'a>, GpuError> {
        let gpu = &self.gpu;
        let size = plate.camera.size();
        let levels = pyramid_levels(size, PyramidRounding::Up);
        let texels = levels.last().map_or(u64::from(size[0]) * u64::from(size[1]), |last| {
            u64::from(last.target_texel) + u64::from(last.size[0]) * u64::from(last.size[1])
        });
        let pixels = buffers.buffer("plate of the host", texels * 16, wgpu::BufferUsages::STORAGE)?;
        let groups = |[columns, rows]: [u32; 2]| [columns.div_ceil(8), rows.div_ceil(8), 1];
        let view = wgpu::BindingResource::TextureView;
        let frame = buffers.uniform("frame of the host's plate", plate)?;
        let bound = self.plate.bind_resources(
            gpu,
            [
                (0, frame.as_entire_binding()),
                (1, view(textures.color)),
                (2, view(textures.depth)),
                (3, pixels.as_entire_binding()),
            ],
        )?;
        let mut coarser = Vec::new();
        for level in &levels {
            let uniform = buffers.uniform("level of the host's plate", level)?;
            coarser.push((self.pyramid.bind(buffers, &[&uniform, &pixels])?, groups(level.size)));
        }
        let frame = buffers.uniform("frame of the host's environment", environment)?;
        let seen = self.environment.bind_resources(
            gpu,
            [
                (0, frame.as_entire_binding()),
                (1, pixels.as_entire_binding()),
                (2, view(textures.sky.unwrap_or(&self.no_sky))),
                (3, map.as_entire_binding()),
            ],
        )?;
        Ok(HostPass {
            pipeline: self,
            plate: (bound, groups(size)),
            levels: coarser,
            environment: (seen, environment.size.div_ceil(8)),
            pixels,
        })
    }

    /// The pipeline that blends rain into color textures of a format.
    ///
    /// # Errors
    /// [`GpuError::Refused`] for a format that cannot be blended into.
    pub fn blend(&self, format: wgpu::TextureFormat) -> Result<wgpu::RenderPipeline, GpuError> {
        let mut blends = self.blends.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = blends.get(&format) {
            return Ok(known.clone());
        }
        let keep = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::Zero,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let over = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::SrcAlpha,
            operation: wgpu::BlendOperation::Add,
        };
        let made = self.gpu.create("the pipeline of rain over a color texture", 0, |device| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("rain over a color texture"),
                layout: None,
                vertex: wgpu::VertexState {
                    module: &self.blend,
                    entry_point: Some("main_host_blend_vertex"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &self.blend,
                    entry_point: Some("main_host_blend_fragment"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format,
                        blend: Some(wgpu::BlendState { color: over, alpha: keep }),
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
        })?;
        blends.insert(format, made.clone());
        Ok(made)
    }

    /// Records the blending of `rain` (radiance and transmittance of each pixel) into a color texture.
    ///
    /// # Errors
    /// As [`HostPipeline::blend`].
    pub fn encode_blend(
        &self,
        buffers: &impl BufferSource,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        rain: &wgpu::Buffer,
        frame: &HostBlendFrame,
    ) -> Result<(), GpuError> {
        let pipeline = self.blend(target.texture().format())?;
        let frame = buffers.uniform("frame of the blending", frame)?;
        let bindings = self.gpu.create("bindings of rain over a color texture", 0, |device| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("rain over a color texture"),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: frame.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: rain.as_entire_binding() },
                ],
            })
        })?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("rain over a color texture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}

impl HostPass<'_> {
    /// The plate on the device: radiance and distance of each pixel, rows from the top, all levels.
    #[must_use]
    pub fn pixels(&self) -> &wgpu::Buffer {
        &self.pixels
    }

    /// Dispatches that make the plate, its levels and the environment map, in this order.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        let pipeline = self.pipeline;
        let (plate, groups) = &self.plate;
        let (environment, edge) = &self.environment;
        let mut all = vec![pipeline.plate.dispatch(plate, *groups)];
        all.extend(self.levels.iter().map(|(level, groups)| pipeline.pyramid.dispatch(level, *groups)));
        all.push(pipeline.environment.dispatch(environment, [*edge, *edge, 1]));
        all
    }
}
