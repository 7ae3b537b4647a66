//! The list of a picture's drops on a device.

use downpour_gpu::{BufferSource, ComputeKernel, Gpu, GpuError, wgpu};

use crate::field::EyeDrop;

/// Lists that differ by less than so many drops have buffers of one size.
const LIST_STEP: u32 = 1 << 14;

/// A kernel with its bindings and its workgroups.
pub(super) type BoundKernel<'a> = (&'a ComputeKernel, wgpu::BindGroup, [u32; 3]);

/// Drops of a picture on a device: those that were known, and then those that kernels find.
#[derive(Clone, Debug)]
pub struct DropListOnGpu {
    drops: wgpu::Buffer,
    found: wgpu::Buffer,
    known: u32,
    room: u32,
}

impl DropListOnGpu {
    /// Label of the buffers of drops.
    pub const DROPS_LABEL: &str = "falling drops";

    /// Label of the buffers of numbers of drops.
    pub const COUNTS_LABEL: &str = "number of drops";

    /// Bytes of the numbers of [`DropListOnGpu::counts`].
    pub const COUNTS_BYTES: u64 = 12;

    /// A list that begins with known drops and has room for others.
    pub(super) fn new(buffers: &impl BufferSource, known: &[EyeDrop], room: u32) -> Result<Self, GpuError> {
        let places = known.len() as u32 + room;
        let drops = list_buffer(buffers, Self::DROPS_LABEL, places, 0)?;
        buffers.write(&drops, bytemuck::cast_slice(known));
        let found = buffers.buffer(Self::COUNTS_LABEL, Self::COUNTS_BYTES, wgpu::BufferUsages::STORAGE)?;
        Ok(Self { drops, found, known: known.len() as u32, room })
    }

    /// The drops ([`EyeDrop`]): those that were known, and then the others in any order, with empty places between them.
    #[must_use]
    pub fn drops(&self) -> &wgpu::Buffer {
        &self.drops
    }

    /// Places of the list.
    #[must_use]
    pub fn places(&self) -> u32 {
        self.known + self.room
    }

    /// Drops that were known.
    #[must_use]
    pub fn known(&self) -> u32 {
        self.known
    }

    /// Room for drops that are found.
    #[must_use]
    pub fn room(&self) -> u32 {
        self.room
    }

    /// Three numbers on the device: drops that were found before obstacles stopped some of them, of which those beyond the room are
    /// lost; drops that were looked at; of stepped rain, drops that had no room among its drops, and impacts that had none among those
    /// that are kept for splashes.
    #[must_use]
    pub fn counts(&self) -> &wgpu::Buffer {
        &self.found
    }

    /// Waits for the drops, and for how many were found before obstacles stopped some of them and how many were looked at.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn read(&self, gpu: &Gpu) -> Result<(Vec<EyeDrop>, [u32; 2]), GpuError> {
        let mut drops = gpu.read::<EyeDrop>(&self.drops)?;
        drops.truncate(self.places() as usize);
        drops.retain(|drop| drop.diameter > 0.0);
        let found = gpu.read::<u32>(&self.found)?;
        Ok((drops, [found[0], found[1]]))
    }
}

/// A buffer with so many places for drops, behind other contents of some bytes.
pub(super) fn list_buffer(
    buffers: &impl BufferSource,
    label: &'static str,
    places: u32,
    behind: u64,
) -> Result<wgpu::Buffer, GpuError> {
    let places = u64::from(places.next_multiple_of(LIST_STEP));
    buffers.buffer(label, behind + places * size_of::<EyeDrop>() as u64, wgpu::BufferUsages::STORAGE)
}
