//! Ripples that a device holds, as rows of the scene's table on the device.
//!
//! The table on the device is longer than that of the host: behind the host's rows is room for all levels of the ripples, which kernels
//! write before the first ray of a frame. The row that says where they are is level water in the host's table.

use downpour_gpu::{BufferSource, GpuError, wgpu};
use downpour_lattice::gpu::puddle::{PuddleSlopes, PuddleSlopesPass};

/// Ripples that a device holds, at a step.
#[derive(Clone, Debug)]
pub struct RipplesOnGpu {
    /// Slopes of the lattice.
    pub slopes: PuddleSlopes,
    /// Number of the step, counted from time 0.
    pub step: i64,
    /// Number of levels.
    pub levels: u32,
    /// Edge of a cell, m.
    pub cell_m: f32,
    /// Bytes that were written to the device for the steps since the frame before.
    pub bytes_uploaded: u64,
}

impl PartialEq for RipplesOnGpu {
    /// True for the same step of the same lattice.
    fn eq(&self, other: &Self) -> bool {
        self.step == other.step && self.slopes.state() == other.slopes.state()
    }
}

impl RipplesOnGpu {
    /// Number of rows of all levels.
    pub(super) fn row_count(&self) -> u32 {
        self.slopes.texel_count()
    }

    /// Row of the table that says that the levels begin at row `first`.
    pub(super) fn head(&self, first: u32) -> [u32; 4] {
        [self.slopes.size()[0], self.levels, first, self.cell_m.to_bits()]
    }

    /// Prepares the kernels that write all levels into a table from row `first` on.
    pub(super) fn prepare(
        &self,
        buffers: &impl BufferSource,
        table: &wgpu::Buffer,
        first: u32,
    ) -> Result<PuddleSlopesPass<'_>, GpuError> {
        self.slopes.prepare(buffers, table, first)
    }
}
