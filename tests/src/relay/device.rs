//! The device and the queue that hand on.

use std::cell::RefCell;
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};

use downpour_gpu::wgpu;
use wgpu::custom::{
    BoxDeviceLostCallback, BoxSubmittedWorkDoneCallback, DeviceInterface, DispatchBindGroup,
    DispatchBindGroupLayout, DispatchBlas, DispatchBuffer, DispatchCommandBuffer, DispatchCommandEncoder,
    DispatchComputePipeline, DispatchExternalTexture, DispatchPipelineCache, DispatchPipelineLayout,
    DispatchQuerySet, DispatchQueueWriteBuffer, DispatchRenderBundleEncoder, DispatchRenderPipeline,
    DispatchSampler, DispatchShaderModule, DispatchSurfaceOutputDetail, DispatchTexture, DispatchTlas,
    PopErrorScopeFuture, QueueInterface,
};

use super::handles::{
    RelayBindings, RelayBuffer, RelayLayout, RelayModule, RelayPipeline, RelayQueries, RelayTexture,
    RelayView,
};
use super::pass::{RelayCommands, RelayEncoder, buffer};
use super::{Key, NOT_HANDED_ON, Relay};

thread_local! {
    // Scopes of errors belong to their thread, as wgpu's guards do.
    static SCOPES: RefCell<Vec<wgpu::ErrorScopeGuard>> = const { RefCell::new(Vec::new()) };
}

#[derive(Debug)]
pub(super) struct RelayDevice {
    pub(super) relay: Relay,
    pub(super) inner: wgpu::Device,
}

#[expect(unsafe_code, reason = "wgpu declares some methods so; none of them is ever called here")]
impl DeviceInterface for RelayDevice {
    fn features(&self) -> wgpu::Features {
        self.inner.features()
    }

    fn limits(&self) -> wgpu::Limits {
        self.inner.limits()
    }

    fn adapter_info(&self) -> wgpu::AdapterInfo {
        self.inner.adapter_info()
    }

    fn create_shader_module(
        &self,
        desc: wgpu::ShaderModuleDescriptor<'_>,
        _: wgpu::ShaderRuntimeChecks,
    ) -> DispatchShaderModule {
        let wgpu::ShaderSource::Wgsl(text) = desc.source else { unreachable!("{NOT_HANDED_ON}") };
        DispatchShaderModule::custom(RelayModule(text.into_owned()))
    }

    unsafe fn create_shader_module_passthrough(
        &self,
        _: &wgpu::ShaderModuleDescriptorPassthrough<'_>,
    ) -> DispatchShaderModule {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_bind_group_layout(&self, _: &wgpu::BindGroupLayoutDescriptor<'_>) -> DispatchBindGroupLayout {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_bind_group(&self, desc: &wgpu::BindGroupDescriptor<'_>) -> DispatchBindGroup {
        let layout = &desc.layout.as_custom::<RelayLayout>().expect("a layout of this relay").0;
        let mut entries = Vec::with_capacity(desc.entries.len());
        for entry in desc.entries {
            let resource = match &entry.resource {
                wgpu::BindingResource::Buffer(bound) => {
                    let buffer = &bound.buffer.as_custom::<RelayBuffer>().expect("a buffer of this relay").0;
                    let bound = wgpu::BufferBinding { buffer, offset: bound.offset, size: bound.size };
                    wgpu::BindingResource::Buffer(bound)
                }
                wgpu::BindingResource::TextureView(view) => {
                    let view = &view.as_custom::<RelayView>().expect("a texture of this relay").0;
                    wgpu::BindingResource::TextureView(view)
                }
                _ => unreachable!("{NOT_HANDED_ON}"),
            };
            entries.push(wgpu::BindGroupEntry { binding: entry.binding, resource });
        }
        let desc = wgpu::BindGroupDescriptor { label: desc.label, layout, entries: &entries };
        DispatchBindGroup::custom(RelayBindings(self.inner.create_bind_group(&desc)))
    }

    fn create_pipeline_layout(&self, _: &wgpu::PipelineLayoutDescriptor<'_>) -> DispatchPipelineLayout {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_render_pipeline(&self, _: &wgpu::RenderPipelineDescriptor<'_>) -> DispatchRenderPipeline {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_mesh_pipeline(&self, _: &wgpu::MeshPipelineDescriptor<'_>) -> DispatchRenderPipeline {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_compute_pipeline(&self, desc: &wgpu::ComputePipelineDescriptor<'_>) -> DispatchComputePipeline {
        let module = desc.module.as_custom::<RelayModule>().expect("a shader of this relay");
        let entry = desc.entry_point.expect("an entry point by name").to_owned();
        let constants = desc.compilation_options.constants.iter();
        let mut constants: Vec<(String, u64)> =
            constants.map(|(name, value)| ((*name).to_owned(), value.to_bits())).collect();
        constants.sort();
        let key = Key { source: module.0.clone(), entry: entry.clone(), constants: constants.clone() };
        let made = self.relay.pipeline(&self.inner, key);
        DispatchComputePipeline::custom(RelayPipeline { made, name: (entry, constants) })
    }

    unsafe fn create_pipeline_cache(&self, _: &wgpu::PipelineCacheDescriptor<'_>) -> DispatchPipelineCache {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_buffer(&self, desc: &wgpu::BufferDescriptor<'_>) -> DispatchBuffer {
        DispatchBuffer::custom(RelayBuffer(self.inner.create_buffer(desc)))
    }

    fn create_texture(&self, desc: &wgpu::TextureDescriptor<'_>) -> DispatchTexture {
        DispatchTexture::custom(RelayTexture(self.inner.create_texture(desc)))
    }

    fn create_external_texture(
        &self,
        _: &wgpu::ExternalTextureDescriptor<'_>,
        _: &[&wgpu::TextureView],
    ) -> DispatchExternalTexture {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_blas(
        &self,
        _: &wgpu::CreateBlasDescriptor<'_>,
        _: wgpu::BlasGeometrySizeDescriptors,
    ) -> (Option<u64>, DispatchBlas) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_tlas(&self, _: &wgpu::CreateTlasDescriptor<'_>) -> DispatchTlas {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_sampler(&self, _: &wgpu::SamplerDescriptor<'_>) -> DispatchSampler {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn create_query_set(&self, desc: &wgpu::QuerySetDescriptor<'_>) -> DispatchQuerySet {
        DispatchQuerySet::custom(RelayQueries(self.inner.create_query_set(desc)))
    }

    fn create_command_encoder(&self, desc: &wgpu::CommandEncoderDescriptor<'_>) -> DispatchCommandEncoder {
        let inner = Mutex::new(Some(self.inner.create_command_encoder(desc)));
        DispatchCommandEncoder::custom(RelayEncoder { relay: self.relay.clone(), inner })
    }

    fn create_render_bundle_encoder(
        &self,
        _: &wgpu::RenderBundleEncoderDescriptor<'_>,
    ) -> DispatchRenderBundleEncoder {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn set_device_lost_callback(&self, callback: BoxDeviceLostCallback) {
        // Called at most once, but the other device takes what could be called again.
        let callback = Mutex::new(Some(callback));
        self.inner.set_device_lost_callback(move |reason, text| {
            if let Some(callback) = callback.lock().unwrap_or_else(PoisonError::into_inner).take() {
                callback(reason, text);
            }
        });
    }

    fn on_uncaptured_error(&self, handler: Arc<dyn wgpu::UncapturedErrorHandler>) {
        self.inner.on_uncaptured_error(handler);
    }

    fn push_error_scope(&self, filter: wgpu::ErrorFilter) -> u32 {
        let guard = self.inner.push_error_scope(filter);
        SCOPES.with_borrow_mut(|scopes| {
            scopes.push(guard);
            scopes.len() as u32 - 1
        })
    }

    fn pop_error_scope(&self, _: u32) -> Pin<Box<dyn PopErrorScopeFuture>> {
        let guard = SCOPES.with_borrow_mut(Vec::pop).expect("a scope that was pushed");
        Box::pin(guard.pop())
    }

    unsafe fn start_graphics_debugger_capture(&self) {
        unreachable!("{NOT_HANDED_ON}")
    }

    unsafe fn stop_graphics_debugger_capture(&self) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn poll(&self, poll: wgpu::wgt::PollType<u64>) -> Result<wgpu::PollStatus, wgpu::PollError> {
        self.inner.poll(match poll {
            wgpu::wgt::PollType::Poll => wgpu::PollType::Poll,
            // Whatever is waited for, everything that was submitted is.
            wgpu::wgt::PollType::Wait { timeout, .. } => {
                wgpu::PollType::Wait { submission_index: None, timeout }
            }
        })
    }

    fn get_internal_counters(&self) -> wgpu::InternalCounters {
        self.inner.get_internal_counters()
    }

    fn generate_allocator_report(&self) -> Option<wgpu::AllocatorReport> {
        self.inner.generate_allocator_report()
    }

    fn destroy(&self) {
        self.inner.destroy();
    }
}

#[derive(Debug)]
pub(super) struct RelayQueue {
    pub(super) inner: wgpu::Queue,
}

impl QueueInterface for RelayQueue {
    fn write_buffer(&self, of: &DispatchBuffer, offset: wgpu::BufferAddress, data: &[u8]) {
        self.inner.write_buffer(buffer(of), offset, data);
    }

    fn create_staging_buffer(&self, _: wgpu::BufferSize) -> Option<DispatchQueueWriteBuffer> {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn validate_write_buffer(
        &self,
        _: &DispatchBuffer,
        _: wgpu::BufferAddress,
        _: wgpu::BufferSize,
    ) -> Option<()> {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn write_staging_buffer(&self, _: &DispatchBuffer, _: wgpu::BufferAddress, _: &DispatchQueueWriteBuffer) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn write_texture(
        &self,
        to: wgpu::TexelCopyTextureInfo<'_>,
        data: &[u8],
        layout: wgpu::TexelCopyBufferLayout,
        size: wgpu::Extent3d,
    ) {
        let texture = &to.texture.as_custom::<RelayTexture>().expect("a texture of this relay").0;
        let to = wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: to.mip_level,
            origin: to.origin,
            aspect: to.aspect,
        };
        self.inner.write_texture(to, data, layout, size);
    }

    fn submit(&self, commands: &mut dyn Iterator<Item = DispatchCommandBuffer>) -> u64 {
        let taken: Vec<wgpu::CommandBuffer> = commands
            .filter_map(|one| {
                let of = one.as_custom::<RelayCommands>().expect("commands of this relay");
                of.0.lock().unwrap_or_else(PoisonError::into_inner).take()
            })
            .collect();
        self.inner.submit(taken);
        0
    }

    fn get_timestamp_period(&self) -> f32 {
        self.inner.get_timestamp_period()
    }

    fn on_submitted_work_done(&self, callback: BoxSubmittedWorkDoneCallback) {
        self.inner.on_submitted_work_done(callback);
    }

    fn compact_blas(&self, _: &DispatchBlas) -> (Option<u64>, DispatchBlas) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn present(&self, _: &DispatchSurfaceOutputDetail) {
        unreachable!("{NOT_HANDED_ON}")
    }
}
