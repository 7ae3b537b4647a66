//! Handles that a relayed device makes: buffers, textures, bindings, pipelines. Each holds its counterpart on the other device.

use std::ops::Range;
use std::pin::Pin;

use downpour_gpu::wgpu;
use wgpu::custom::{
    BindGroupInterface, BindGroupLayoutInterface, BufferInterface, BufferMapCallback,
    BufferMappedRangeInterface, ComputePipelineInterface, DispatchBindGroupLayout, DispatchBufferMappedRange,
    DispatchTextureView, QuerySetInterface, ShaderCompilationInfoFuture, ShaderModuleInterface,
    TextureInterface, TextureViewInterface,
};

use super::{Dispatched, Made};

#[derive(Debug)]
pub(super) struct RelayBuffer(pub(super) wgpu::Buffer);

impl BufferInterface for RelayBuffer {
    fn map_async(&self, mode: wgpu::MapMode, range: Range<wgpu::BufferAddress>, callback: BufferMapCallback) {
        self.0.map_async(mode, range, callback);
    }

    fn get_mapped_range(
        &self,
        range: Range<wgpu::BufferAddress>,
    ) -> Result<DispatchBufferMappedRange, wgpu::MapRangeError> {
        let view = self.0.get_mapped_range(range)?;
        Ok(DispatchBufferMappedRange::custom(RelayRange(view)))
    }

    fn unmap(&self) {
        self.0.unmap();
    }

    fn destroy(&self) {
        self.0.destroy();
    }
}

/// Bytes of a buffer that is mapped to be read.
#[derive(Debug)]
pub(super) struct RelayRange(wgpu::BufferView);

#[expect(unsafe_code, reason = "wgpu declares these methods so; ours do nothing of the kind")]
impl BufferMappedRangeInterface for RelayRange {
    fn len(&self) -> usize {
        self.0.len()
    }

    unsafe fn read_slice(&self) -> &[u8] {
        &self.0
    }

    unsafe fn write_slice(&mut self) -> wgpu::WriteOnly<'_, [u8]> {
        unreachable!("a relay maps buffers to read them")
    }
}

#[derive(Debug)]
pub(super) struct RelayTexture(pub(super) wgpu::Texture);

impl TextureInterface for RelayTexture {
    fn create_view(&self, desc: &wgpu::TextureViewDescriptor<'_>) -> DispatchTextureView {
        DispatchTextureView::custom(RelayView(self.0.create_view(desc)))
    }

    fn destroy(&self) {
        self.0.destroy();
    }
}

#[derive(Debug)]
pub(super) struct RelayView(pub(super) wgpu::TextureView);

impl TextureViewInterface for RelayView {}

#[derive(Debug)]
pub(super) struct RelayLayout(pub(super) wgpu::BindGroupLayout);

impl BindGroupLayoutInterface for RelayLayout {}

#[derive(Debug)]
pub(super) struct RelayBindings(pub(super) wgpu::BindGroup);

impl BindGroupInterface for RelayBindings {}

#[derive(Debug)]
pub(super) struct RelayQueries(pub(super) wgpu::QuerySet);

impl QuerySetInterface for RelayQueries {
    fn destroy(&self) {}
}

/// Text: the other device sees it when a pipeline is made of it.
#[derive(Debug)]
pub(super) struct RelayModule(pub(super) String);

impl ShaderModuleInterface for RelayModule {
    fn get_compilation_info(&self) -> Pin<Box<dyn ShaderCompilationInfoFuture>> {
        unreachable!("a relay has compiled nothing yet")
    }
}

#[derive(Debug)]
pub(super) struct RelayPipeline {
    pub(super) made: Made,
    pub(super) name: Dispatched,
}

impl ComputePipelineInterface for RelayPipeline {
    fn get_bind_group_layout(&self, index: u32) -> DispatchBindGroupLayout {
        DispatchBindGroupLayout::custom(RelayLayout(self.made.pipeline.get_bind_group_layout(index)))
    }
}
