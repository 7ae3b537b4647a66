//! Compute pipelines and their dispatches.

use downpour_shaders::Kernel;

use crate::{BufferSource, Gpu, GpuError};

/// A compute pipeline whose buffers are bindings of group 0.
#[derive(Clone, Debug)]
pub struct ComputeKernel {
    pipeline: wgpu::ComputePipeline,
    label: String,
}

impl ComputeKernel {
    /// Creates the pipeline of a kernel of `downpour-shaders`, with values for its `override` constants.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the workgroup is too large for the device; as [`Gpu::create`] otherwise.
    pub fn new(gpu: &Gpu, kernel: &Kernel, overrides: &[(&str, f64)]) -> Result<Self, GpuError> {
        let [x, y, z] = kernel.workgroup.map(u64::from);
        let allowed = u64::from(gpu.device().limits().max_compute_invocations_per_workgroup);
        if x * y * z > allowed {
            return Err(GpuError::OverLimit {
                what: format!("the workgroup of kernel \"{}\"", kernel.entry),
                found: x * y * z,
                limit_name: "max_compute_invocations_per_workgroup",
                allowed,
            });
        }
        Self::from_source(gpu, kernel.entry, &kernel.source(), overrides)
    }

    /// Creates the pipeline of an entry point of any WGSL text.
    ///
    /// # Errors
    /// [`GpuError::Refused`] with the compiler's message if the text is not valid; as [`Gpu::create`] otherwise.
    pub fn from_source(
        gpu: &Gpu,
        entry: &str,
        source: &str,
        overrides: &[(&str, f64)],
    ) -> Result<Self, GpuError> {
        let pipeline = gpu.create(&format!("kernel \"{entry}\""), 0, |device| {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(entry),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: None,
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: overrides,
                    ..Default::default()
                },
                cache: None,
            })
        })?;
        Ok(Self { pipeline, label: entry.to_owned() })
    }

    /// Binds the buffers to bindings 0, 1, 2, ... of group 0. A [`BufferPool`](crate::BufferPool) keeps what it has bound for the next frame.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if number, usage or size of the buffers are not what the kernel declares.
    pub fn bind(
        &self,
        source: &impl BufferSource,
        buffers: &[&wgpu::Buffer],
    ) -> Result<wgpu::BindGroup, GpuError> {
        self.bind_at(source, (0..).zip(buffers.iter().copied()))
    }

    /// Binds buffers to bindings of group 0 by number.
    ///
    /// # Errors
    /// As [`ComputeKernel::bind`].
    pub fn bind_at<'a>(
        &self,
        source: &impl BufferSource,
        buffers: impl IntoIterator<Item = (u32, &'a wgpu::Buffer)>,
    ) -> Result<wgpu::BindGroup, GpuError> {
        source.bound(self, &buffers.into_iter().collect::<Vec<_>>())
    }

    /// The same, anew.
    pub(crate) fn bind_anew(
        &self,
        gpu: &Gpu,
        buffers: &[(u32, &wgpu::Buffer)],
    ) -> Result<wgpu::BindGroup, GpuError> {
        let resources = buffers.iter().map(|&(binding, buffer)| (binding, buffer.as_entire_binding()));
        self.bind_resources(gpu, resources)
    }

    /// The pipeline, by which bindings are known.
    pub(crate) fn pipeline(&self) -> &wgpu::ComputePipeline {
        &self.pipeline
    }

    /// Binds buffers and textures to bindings of group 0 by number.
    ///
    /// # Errors
    /// As [`ComputeKernel::bind`].
    pub fn bind_resources<'a>(
        &self,
        gpu: &Gpu,
        resources: impl IntoIterator<Item = (u32, wgpu::BindingResource<'a>)>,
    ) -> Result<wgpu::BindGroup, GpuError> {
        let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
        let entries: Vec<wgpu::BindGroupEntry<'_>> = resources.into_iter().map(entry).collect();
        gpu.create(&format!("bindings of \"{}\"", self.label), 0, |device| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&self.label),
                layout: &self.pipeline.get_bind_group_layout(0),
                entries: &entries,
            })
        })
    }

    /// Creates a dispatch of `groups` workgroups.
    #[must_use]
    pub fn dispatch<'a>(&'a self, bindings: &'a wgpu::BindGroup, groups: [u32; 3]) -> Dispatch<'a> {
        Dispatch { kernel: self, bindings, groups: Groups::Given(groups) }
    }

    /// Creates a dispatch of as many workgroups as three words of a buffer say when it runs, from a byte on. A number beyond the
    /// limits of the device runs none.
    #[must_use]
    pub fn dispatch_indirect<'a>(
        &'a self,
        bindings: &'a wgpu::BindGroup,
        groups: &'a wgpu::Buffer,
        offset: u64,
    ) -> Dispatch<'a> {
        Dispatch { kernel: self, bindings, groups: Groups::Found { groups, offset } }
    }
}

/// Number of workgroups.
#[derive(Clone, Copy, Debug)]
enum Groups<'a> {
    Given([u32; 3]),
    Found { groups: &'a wgpu::Buffer, offset: u64 },
}

/// A kernel with its bindings and its number of workgroups.
#[derive(Clone, Copy, Debug)]
pub struct Dispatch<'a> {
    kernel: &'a ComputeKernel,
    bindings: &'a wgpu::BindGroup,
    groups: Groups<'a>,
}

impl Dispatch<'_> {
    pub(crate) fn check(&self, limits: &wgpu::Limits) -> Result<(), GpuError> {
        let allowed = u64::from(limits.max_compute_workgroups_per_dimension);
        let Groups::Given(groups) = self.groups else { return Ok(()) };
        match groups.iter().map(|&n| u64::from(n)).find(|&n| n > allowed) {
            Some(found) => Err(GpuError::OverLimit {
                what: format!("the number of workgroups of kernel \"{}\"", self.kernel.label),
                found,
                limit_name: "max_compute_workgroups_per_dimension",
                allowed,
            }),
            None => Ok(()),
        }
    }

    /// Records it in a caller's pass.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if it has more workgroups than the device of `gpu` allows.
    pub fn encode(&self, gpu: &Gpu, pass: &mut wgpu::ComputePass<'_>) -> Result<(), GpuError> {
        self.check(&gpu.device().limits())?;
        self.encode_in(pass);
        Ok(())
    }

    pub(crate) fn encode_in(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.kernel.pipeline);
        pass.set_bind_group(0, self.bindings, &[]);
        match self.groups {
            Groups::Given([x, y, z]) => pass.dispatch_workgroups(x, y, z),
            Groups::Found { groups, offset } => pass.dispatch_workgroups_indirect(groups, offset),
        }
    }
}
