//! Recording of commands: encoders and compute passes.

use std::sync::{Mutex, MutexGuard, PoisonError};

use downpour_gpu::wgpu;
use wgpu::custom::{
    CommandBufferInterface, CommandEncoderInterface, ComputePassInterface, DispatchBindGroup, DispatchBuffer,
    DispatchCommandBuffer, DispatchComputePass, DispatchComputePipeline, DispatchQuerySet,
    DispatchRenderPass, DispatchTexture, DispatchTextureView,
};
use wgpu::wgt;

use super::handles::{RelayBindings, RelayBuffer, RelayPipeline, RelayQueries};
use super::{NOT_HANDED_ON, Relay};

pub(super) fn buffer(of: &DispatchBuffer) -> &wgpu::Buffer {
    &of.as_custom::<RelayBuffer>().expect("a buffer of this relay").0
}

fn queries(of: &DispatchQuerySet) -> &wgpu::QuerySet {
    &of.as_custom::<RelayQueries>().expect("queries of this relay").0
}

#[derive(Debug)]
pub(super) struct RelayCommands(pub(super) Mutex<Option<wgpu::CommandBuffer>>);

impl CommandBufferInterface for RelayCommands {}

#[derive(Debug)]
pub(super) struct RelayEncoder {
    pub(super) relay: Relay,
    pub(super) inner: Mutex<Option<wgpu::CommandEncoder>>,
}

impl RelayEncoder {
    fn with<T>(&self, record: impl FnOnce(&mut wgpu::CommandEncoder) -> T) -> T {
        let mut inner: MutexGuard<'_, _> = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
        record(inner.as_mut().expect("an encoder that is not finished"))
    }
}

impl CommandEncoderInterface for RelayEncoder {
    fn copy_buffer_to_buffer(
        &self,
        source: &DispatchBuffer,
        source_offset: wgpu::BufferAddress,
        destination: &DispatchBuffer,
        destination_offset: wgpu::BufferAddress,
        copy_size: Option<wgpu::BufferAddress>,
    ) {
        let (from, to) = (buffer(source), buffer(destination));
        self.with(|e| e.copy_buffer_to_buffer(from, source_offset, to, destination_offset, copy_size));
    }

    fn copy_buffer_to_texture(
        &self,
        _: wgpu::TexelCopyBufferInfo<'_>,
        _: wgpu::TexelCopyTextureInfo<'_>,
        _: wgpu::Extent3d,
    ) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn copy_texture_to_buffer(
        &self,
        _: wgpu::TexelCopyTextureInfo<'_>,
        _: wgpu::TexelCopyBufferInfo<'_>,
        _: wgpu::Extent3d,
    ) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn copy_texture_to_texture(
        &self,
        _: wgpu::TexelCopyTextureInfo<'_>,
        _: wgpu::TexelCopyTextureInfo<'_>,
        _: wgpu::Extent3d,
    ) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn begin_compute_pass(&self, desc: &wgpu::ComputePassDescriptor<'_>) -> DispatchComputePass {
        // Times of a pass are of no use behind a relay.
        let desc = wgpu::ComputePassDescriptor { label: desc.label, timestamp_writes: None };
        let inner = self.with(|e| e.begin_compute_pass(&desc).forget_lifetime());
        DispatchComputePass::custom(RelayPass { relay: self.relay.clone(), inner, name: None })
    }

    fn begin_render_pass(&self, _: &wgpu::RenderPassDescriptor<'_>) -> DispatchRenderPass {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn finish(&mut self) -> DispatchCommandBuffer {
        let inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner).take();
        let commands = inner.expect("an encoder that is not finished").finish();
        DispatchCommandBuffer::custom(RelayCommands(Mutex::new(Some(commands))))
    }

    fn clear_texture(&self, _: &DispatchTexture, _: &wgpu::ImageSubresourceRange) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn clear_buffer(
        &self,
        of: &DispatchBuffer,
        offset: wgpu::BufferAddress,
        size: Option<wgpu::BufferAddress>,
    ) {
        self.with(|e| e.clear_buffer(buffer(of), offset, size));
    }

    fn insert_debug_marker(&self, _: &str) {}

    fn push_debug_group(&self, _: &str) {}

    fn pop_debug_group(&self) {}

    fn write_timestamp(&self, query_set: &DispatchQuerySet, query_index: u32) {
        self.with(|e| e.write_timestamp(queries(query_set), query_index));
    }

    fn resolve_query_set(
        &self,
        query_set: &DispatchQuerySet,
        first_query: u32,
        query_count: u32,
        destination: &DispatchBuffer,
        destination_offset: wgpu::BufferAddress,
    ) {
        let range = first_query..first_query + query_count;
        let to = buffer(destination);
        self.with(|e| e.resolve_query_set(queries(query_set), range, to, destination_offset));
    }

    fn mark_acceleration_structures_built<'a>(
        &self,
        _: &mut dyn Iterator<Item = &'a wgpu::Blas>,
        _: &mut dyn Iterator<Item = &'a wgpu::Tlas>,
    ) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn build_acceleration_structures<'a>(
        &self,
        _: &mut dyn Iterator<Item = &'a wgpu::BlasBuildEntry<'a>>,
        _: &mut dyn Iterator<Item = &'a wgpu::Tlas>,
    ) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn transition_resources<'a>(
        &mut self,
        _: &mut dyn Iterator<Item = wgt::BufferTransition<&'a DispatchBuffer>>,
        _: &mut dyn Iterator<Item = wgt::TextureTransition<&'a DispatchTexture>>,
    ) {
        unreachable!("{NOT_HANDED_ON}")
    }
}

#[derive(Debug)]
struct RelayPass {
    relay: Relay,
    inner: wgpu::ComputePass<'static>,
    /// The kernel that the next dispatch runs.
    name: Option<super::Dispatched>,
}

impl ComputePassInterface for RelayPass {
    fn set_pipeline(&mut self, pipeline: &DispatchComputePipeline) {
        let pipeline = pipeline.as_custom::<RelayPipeline>().expect("a pipeline of this relay");
        self.name = Some(pipeline.name.clone());
        self.inner.set_pipeline(&pipeline.made.pipeline);
        if let Some(choice) = &pipeline.made.choice {
            self.inner.set_bind_group(1, choice, &[]);
        }
    }

    fn set_bind_group(&mut self, index: u32, group: Option<&DispatchBindGroup>, offsets: &[u32]) {
        let group = group.map(|g| &g.as_custom::<RelayBindings>().expect("bindings of this relay").0);
        self.inner.set_bind_group(index, group, offsets);
    }

    fn set_immediates(&mut self, offset: u32, data: &[u8]) {
        self.inner.set_immediates(offset, data);
    }

    fn insert_debug_marker(&mut self, _: &str) {}

    fn push_debug_group(&mut self, _: &str) {}

    fn pop_debug_group(&mut self) {}

    fn write_timestamp(&mut self, query_set: &DispatchQuerySet, query_index: u32) {
        self.inner.write_timestamp(queries(query_set), query_index);
    }

    fn begin_pipeline_statistics_query(&mut self, _: &DispatchQuerySet, _: u32) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn end_pipeline_statistics_query(&mut self) {
        unreachable!("{NOT_HANDED_ON}")
    }

    fn dispatch_workgroups(&mut self, x: u32, y: u32, z: u32) {
        if let Some(name) = &self.name {
            self.relay.note(name);
        }
        self.inner.dispatch_workgroups(x, y, z);
    }

    fn dispatch_workgroups_indirect(&mut self, of: &DispatchBuffer, offset: wgpu::BufferAddress) {
        if let Some(name) = &self.name {
            self.relay.note(name);
        }
        self.inner.dispatch_workgroups_indirect(buffer(of), offset);
    }

    fn transition_resources<'a>(
        &mut self,
        _: &mut dyn Iterator<Item = wgt::BufferTransition<&'a DispatchBuffer>>,
        _: &mut dyn Iterator<Item = wgt::TextureTransition<&'a DispatchTextureView>>,
    ) {
        unreachable!("{NOT_HANDED_ON}")
    }
}

impl Drop for RelayPass {
    fn drop(&mut self) {}
}
