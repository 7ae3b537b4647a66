//! Small readbacks that arrive some frames later, and that nothing waits for.

use std::sync::{Arc, OnceLock};

use crate::{Gpu, GpuError};

/// Ring of small buffers through which numbers of the last frames come to the host.
///
/// [`ReadbackRing::record`] copies the beginning of a buffer in the encoder of a frame, and [`ReadbackRing::take`] gives what has arrived
/// since. Neither waits for the device nor polls it: wgpu maps a copy when a later submission finds that its frame is done. While all copies are
/// on their way, frames go without one.
#[derive(Debug)]
pub struct ReadbackRing<Tag> {
    bytes: u64,
    slots: Vec<Slot<Tag>>,
}

#[derive(Debug)]
struct Slot<Tag> {
    buffer: wgpu::Buffer,
    on_its_way: Option<OnItsWay<Tag>>,
}

/// A copy that was recorded.
#[derive(Debug)]
struct OnItsWay<Tag> {
    tag: Tag,
    /// True when the copy is mapped, false when it cannot be. The callback has the other handle: when it is gone and has set nothing, the
    /// encoder was never submitted.
    mapped: Arc<OnceLock<bool>>,
}

impl<Tag> ReadbackRing<Tag> {
    /// Creates a ring of `slots` copies of `bytes` bytes each, a multiple of 4.
    ///
    /// # Errors
    /// As [`Gpu::create`].
    pub fn new(gpu: &Gpu, bytes: u64, slots: usize) -> Result<Self, GpuError> {
        let slot = |_| {
            let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            let buffer = gpu.create_buffer("a small readback", "small readback", bytes, usage)?;
            Ok(Slot { buffer, on_its_way: None })
        };
        Ok(Self { bytes, slots: (0..slots).map(slot).collect::<Result<_, GpuError>>()? })
    }

    /// Records a copy of the beginning of `from`, which begins its way when `encoder` is submitted. Returns false, and records nothing,
    /// if all copies are on their way.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, from: &wgpu::Buffer, tag: Tag) -> bool {
        let Some(slot) = self.slots.iter_mut().find(|slot| slot.on_its_way.is_none()) else { return false };
        encoder.copy_buffer_to_buffer(from, 0, &slot.buffer, 0, self.bytes);
        let mapped = Arc::new(OnceLock::new());
        let told = Arc::clone(&mapped);
        encoder.map_buffer_on_submit(&slot.buffer, wgpu::MapMode::Read, .., move |result| {
            let _ = told.set(result.is_ok());
        });
        slot.on_its_way = Some(OnItsWay { tag, mapped });
        true
    }

    /// Hands over all copies that have arrived, in any order, with their tags.
    ///
    /// # Errors
    /// [`GpuError::Lost`] if the device could not map one.
    pub fn take(&mut self, gpu: &Gpu, mut arrived: impl FnMut(Tag, &[u8])) -> Result<(), GpuError> {
        let mut is_lost = false;
        for Slot { buffer, on_its_way } in &mut self.slots {
            // While the callback has its handle, the copy is on its way.
            let Some(mapped) = on_its_way.as_mut().and_then(|way| Arc::get_mut(&mut way.mapped)) else {
                continue;
            };
            let mapped = mapped.take();
            let Some(OnItsWay { tag, .. }) = on_its_way.take() else { continue };
            let Some(is_mapped) = mapped else { continue };
            is_lost |= !is_mapped;
            gpu.create("a small readback", 0, |_| {
                if is_mapped {
                    match buffer.get_mapped_range(..) {
                        Ok(view) => arrived(tag, &view),
                        Err(_) => is_lost = true,
                    }
                }
                buffer.unmap();
            })
            .or_else(|error| if is_lost { Ok(()) } else { Err(error) })?;
        }
        if is_lost {
            return Err(GpuError::Lost { reason: "a readback failed".to_owned() });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_arrive_after_later_submissions_and_a_full_ring_takes_none() {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let gpu = Gpu::on_device(device, queue);
        let from = gpu.empty_buffer("numbers", 12, wgpu::BufferUsages::STORAGE).unwrap();
        let mut ring = ReadbackRing::new(&gpu, 12, 2).unwrap();
        let record = |ring: &mut ReadbackRing<u32>, tag| {
            let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            (ring.record(&mut encoder, &from, tag), encoder)
        };
        let taken = |ring: &mut ReadbackRing<u32>| {
            let mut tags = Vec::new();
            ring.take(&gpu, |tag, bytes| {
                assert_eq!(bytes.len(), 12);
                tags.push(tag);
            })
            .unwrap();
            tags.sort_unstable();
            tags
        };
        let (first, second) = (record(&mut ring, 1), record(&mut ring, 2));
        assert!(first.0 && second.0 && !record(&mut ring, 3).0, "two have room");
        assert!(taken(&mut ring).is_empty(), "nothing is submitted");
        // A frame that is never submitted leaves its room to others.
        drop(second);
        assert!(taken(&mut ring).is_empty());
        let fourth = record(&mut ring, 4);
        assert!(fourth.0);
        gpu.queue().submit([first.1.finish(), fourth.1.finish()]);
        // The next submission finds that the one before is done.
        gpu.queue().submit([]);
        assert_eq!(taken(&mut ring), [1, 4]);
        assert!(record(&mut ring, 5).0 && taken(&mut ring).is_empty());
    }
}
