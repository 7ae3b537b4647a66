//! Loss of a device, noticed at once and without the callback that belongs to the device's owner.

use std::sync::{Arc, OnceLock};

use crate::{Gpu, GpuError};

/// Bytes of the buffer of a probe: the least that can be mapped.
const BYTES: u64 = 4;

/// Probe that tells whether a device is lost.
///
/// wgpu reports nothing of a lost device but to its callback, which a caller's device keeps for its owner. A lost device refuses a
/// mapping before the call returns, though, so that one which is called off at once tells the loss without any wait. A browser
/// answers later; there the callback alone tells.
#[derive(Debug)]
pub struct LossProbe {
    buffer: wgpu::Buffer,
}

impl LossProbe {
    /// Creates the probe of a device, and checks it.
    ///
    /// # Errors
    /// As [`LossProbe::check`], or [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let buffer = gpu.create_buffer("the probe of a device", "loss probe", BYTES, usage)?;
        let probe = Self { buffer };
        probe.check(gpu)?;
        Ok(probe)
    }

    /// Checks the device of the probe, which is that of `gpu`, without waiting.
    ///
    /// # Errors
    /// [`GpuError::Lost`], or [`GpuError::Refused`] for an error that no scope caught.
    pub fn check(&self, gpu: &Gpu) -> Result<(), GpuError> {
        let answer = Arc::new(OnceLock::new());
        let told = Arc::clone(&answer);
        let mut is_lost = false;
        // The scope keeps what a lost device says of a destroyed buffer from the owner's error handler.
        let probed = gpu.create("the probe of a device", 0, |_| {
            self.buffer.map_async(wgpu::MapMode::Read, .., move |result| {
                let _ = told.set(result.is_ok());
            });
            is_lost = answer.get() == Some(&false);
            if !is_lost {
                self.buffer.unmap();
            }
        });
        if is_lost {
            return Err(GpuError::Lost { reason: "it refuses all work".to_owned() });
        }
        probed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_destroyed_device_is_lost_at_once() {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let gpu = Gpu::on_device(device, queue);
        let probe = LossProbe::new(&gpu).unwrap();
        for _ in 0..3 {
            probe.check(&gpu).unwrap();
            gpu.queue().submit([]);
        }
        gpu.device().destroy();
        for _ in 0..2 {
            assert!(matches!(probe.check(&gpu), Err(GpuError::Lost { .. })));
        }
        assert!(matches!(LossProbe::new(&gpu), Err(GpuError::Lost { .. })));
    }
}
