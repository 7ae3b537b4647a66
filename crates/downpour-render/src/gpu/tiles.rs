//! Lists of drops for the tiles of a picture on a GPU: what [`TileLists`](crate::rain::tiles::TileLists) makes on the CPU.

use downpour_gpu::{
    BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, KernelSequence, SequencePass, wgpu, workgroups,
    workgroups_for,
};
use downpour_shaders::Kernel;
use downpour_shaders::render::rain::{
    TILES_CLEAR_KERNEL, TILES_COUNT_KERNEL, TILES_HEAD, TILES_MEASURE_KERNEL, TILES_PLACE_KERNEL,
    TILES_SCAN_KERNEL, TILES_SEEN_KERNEL, TILES_SORT_KERNEL,
};

use crate::rain::tiles::TilesFrame;

/// Kernels in the order in which they run, with their bindings.
const KERNELS: [(&Kernel, &[u32]); 6] = [
    (&TILES_CLEAR_KERNEL, &[2]),
    (&TILES_MEASURE_KERNEL, &[0, 1, 2]),
    (&TILES_COUNT_KERNEL, &[0, 1, 2]),
    (&TILES_SCAN_KERNEL, &[0, 2, 3]),
    (&TILES_PLACE_KERNEL, &[0, 1, 2, 3]),
    (&TILES_SORT_KERNEL, &[0, 1, 3]),
];

/// Room for distances of drops is a multiple of this.
const SEEN_STEP: u32 = 1 << 14;

/// The pipelines of the lists.
#[derive(Clone, Debug)]
pub struct TilesPipeline {
    gpu: Gpu,
    lists: KernelSequence,
    seen: ComputeKernel,
}

/// The lists of a picture, ready to be made.
#[derive(Debug)]
pub struct TilesPass<'a> {
    pipeline: &'a TilesPipeline,
    passes: SequencePass<'a>,
    of_seen: (wgpu::BindGroup, [u32; 3]),
    seen: wgpu::Buffer,
    count: u32,
    lists: wgpu::Buffer,
}

impl TilesPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            gpu: gpu.clone(),
            lists: KernelSequence::new(gpu, &KERNELS)?,
            seen: ComputeKernel::new(gpu, &TILES_SEEN_KERNEL, &[])?,
        })
    }

    /// Makes ready to list drops ([`ScreenDrop`](crate::rain::ScreenDrop)) that are on the device, before a plate (radiance and distance).
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the lists are larger than the device allows, or what else the GPU says.
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        drops: &wgpu::Buffer,
        plate: &wgpu::Buffer,
        frame: &TilesFrame,
    ) -> Result<TilesPass<'_>, GpuError> {
        let storage = wgpu::BufferUsages::STORAGE;
        let tiles = frame.tiles();
        let counts = buffers.buffer("drops of tiles", u64::from(TILES_HEAD + tiles) * 4, storage)?;
        // Behind the lists the drops' kernels note the tiles in which there are drops, and their number.
        let words = 3 + 2 * u64::from(tiles) + u64::from(frame.room);
        let lists = buffers.buffer("tiles of drops", words * 4, storage)?;
        let uniform = buffers.uniform("tiles frame", frame)?;
        let all = [&uniform, drops, &counts, &lists];
        let by_drop = workgroups_for(frame.count);
        let clear = workgroups_for((counts.size() / 4) as u32);
        let passes =
            self.lists.bind(buffers, &all, &[clear, by_drop, by_drop, [1; 3], by_drop, workgroups(tiles)])?;
        // In steps, so that frames of about as many drops have buffers of one size.
        let seen = u64::from(frame.count.max(1).next_multiple_of(SEEN_STEP));
        let seen = buffers.buffer("distances of drops", seen * 4, storage)?;
        let of_seen = self.seen.bind_at(buffers, [(0, &uniform), (1, drops), (4, plate), (5, &seen)])?;
        Ok(TilesPass { pipeline: self, passes, of_seen: (of_seen, by_drop), seen, count: frame.count, lists })
    }
}

impl TilesPass<'_> {
    /// The dispatches, in this order.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        self.passes.dispatches()
    }

    /// Finds for each drop its distance, m; 0 where the plate hides all of it, below 0 where it is not on the picture.
    #[must_use]
    pub fn seen(&self) -> Dispatch<'_> {
        self.pipeline.seen.dispatch(&self.of_seen.0, self.of_seen.1)
    }

    /// These distances on the device, with room behind them, and their number.
    #[must_use]
    pub fn distances(&self) -> (&wgpu::Buffer, u32) {
        (&self.seen, self.count)
    }

    /// The lists on the device ([`TileLists::words`](crate::rain::tiles::TileLists::words)).
    #[must_use]
    pub fn lists(&self) -> &wgpu::Buffer {
        &self.lists
    }

    /// Reads the lists.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn read(&self) -> Result<Vec<u32>, GpuError> {
        self.pipeline.gpu.read(&self.lists)
    }
}
