//! Drops in the pixels of a picture on a GPU: streaks that are summed up, then all others, nearest first.

use downpour_gpu::{
    BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, KernelSequence, SequencePass, wgpu, workgroups,
    workgroups_for,
};
use downpour_shaders::Kernel;
use downpour_shaders::render::rain::{
    DROPS_KERNEL, DROPS_SUM_CLEAR_KERNEL, DROPS_SUM_FINISH_KERNEL, DROPS_SUM_LOOKED, DROPS_SUM_SCALE_KERNEL,
    DROPS_SUM_SHARED, DROPS_SUM_THIN_KERNEL, DROPS_SUM_WIDE_KERNEL, DROPS_TILE, DROPS_UNLISTED_KERNEL,
};

/// Kernels in the order in which they run, with their bindings.
const KERNELS: [(&Kernel, &[u32]); 6] = [
    (&DROPS_SUM_CLEAR_KERNEL, &[11, 12, 13, 14]),
    (&DROPS_SUM_SCALE_KERNEL, &[0, 1, 3, 8, 11]),
    (&DROPS_SUM_THIN_KERNEL, &[0, 1, 2, 3, 7, 8, 10, 11, 12]),
    (&DROPS_SUM_WIDE_KERNEL, &[0, 1, 2, 3, 7, 8, 10, 11, 12]),
    (&DROPS_SUM_FINISH_KERNEL, &[0, 10, 11, 12]),
    (&DROPS_UNLISTED_KERNEL, &[0, 1, 5, 6, 7, 9, 13, 14]),
];

/// The pipelines of drops in pixels.
#[derive(Clone, Debug)]
pub(super) struct DropsPipeline {
    gpu: Gpu,
    sums: KernelSequence,
    drops: ComputeKernel,
}

/// What drops are drawn from.
pub(super) struct DropsOf<'a> {
    /// Uniforms of the drops.
    pub(super) frame: &'a wgpu::Buffer,
    /// The environment map.
    pub(super) texels: &'a wgpu::Buffer,
    pub(super) masks: &'a wgpu::Buffer,
    pub(super) list: &'a wgpu::Buffer,
    /// Lists of the tiles.
    pub(super) tiles: &'a wgpu::Buffer,
    /// The scene: radiance and distance.
    pub(super) clean: &'a wgpu::Buffer,
    /// At first the medium, then the rain.
    pub(super) layer: &'a wgpu::Buffer,
    /// The streak radiance table.
    pub(super) table: &'a wgpu::Buffer,
    /// Light of lamps on the drops.
    pub(super) light: &'a wgpu::Buffer,
    /// Uniforms of the medium.
    pub(super) medium: &'a wgpu::Buffer,
}

/// The drops of a picture, ready to be drawn.
#[derive(Debug)]
pub(super) struct DropsPass<'a> {
    pipeline: &'a DropsPipeline,
    sums: SequencePass<'a>,
    summed: wgpu::Buffer,
    drops: wgpu::BindGroup,
    groups: wgpu::Buffer,
}

impl DropsPipeline {
    /// Makes the pipelines.
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let drops = ComputeKernel::new(gpu, &DROPS_KERNEL, &[])?;
        Ok(Self { gpu: gpu.clone(), sums: KernelSequence::new(gpu, &KERNELS)?, drops })
    }

    /// Makes ready to draw a list of `count` drops on a picture.
    pub(super) fn prepare(
        &self,
        buffers: &impl BufferSource,
        size: [u32; 2],
        count: u32,
        of: &DropsOf<'_>,
    ) -> Result<DropsPass<'_>, GpuError> {
        let pixels = size[0] * size[1];
        let storage = wgpu::BufferUsages::STORAGE;
        // The scale comes behind the sums.
        let summed = buffers.buffer("sums of streaks", u64::from(pixels) * 16 + 4, storage)?;
        let large = buffers.buffer("large sums of streaks", u64::from(pixels) * 16, storage)?;
        let DropsOf { frame, texels, masks, list, tiles, clean, layer, table, light, medium } = *of;
        let found = buffers.buffer("workgroups of drops", 16, storage | wgpu::BufferUsages::INDIRECT)?;
        let all = [
            frame, texels, masks, list, tiles, &summed, layer, table, light, medium, clean, &summed, &large,
            tiles, &found,
        ];
        let shared = count.saturating_mul(DROPS_SUM_SHARED);
        let [words, drops, shared, pixels] = [4 * pixels + 1, count, shared, pixels].map(workgroups_for);
        let looked = workgroups(count.div_ceil(DROPS_SUM_LOOKED).max(1));
        let blocks = [size[0].div_ceil(DROPS_TILE), size[1].div_ceil(DROPS_TILE), 1];
        let groups = [words, drops, shared, looked, pixels, blocks];
        Ok(DropsPass {
            pipeline: self,
            sums: self.sums.bind(buffers, &all, &groups)?,
            drops: self.drops.bind(buffers, &all[..10])?,
            summed,
            groups: found,
        })
    }
}

impl DropsPass<'_> {
    /// The dispatches, in this order.
    pub(super) fn dispatches(&self) -> Vec<Dispatch<'_>> {
        let mut dispatches = self.sums.dispatches();
        dispatches.push(self.pipeline.drops.dispatch_indirect(&self.drops, &self.groups, 0));
        dispatches
    }

    /// Reads what streaks show that were summed up, as [`Rain::sums`](crate::rain::Rain::sums) has it.
    pub(super) fn summed(&self) -> Result<Vec<[u32; 4]>, GpuError> {
        let words: Vec<u32> = self.pipeline.gpu.read(&self.summed)?;
        Ok(words.as_chunks().0.to_vec())
    }
}
