//! Readback from the device, which detects loss, hangs and late errors.

use std::sync::mpsc;
use std::time::Duration;

use bytemuck::Pod;

use crate::context::one_line;

use crate::{Gpu, GpuError};

/// Time that a callback may stay with another thread after the device is done.
const CALLBACK: Duration = Duration::from_secs(5);

impl Gpu {
    /// Waits for all submitted work and reads the whole of `buffer`. Bytes after the last complete `T` are ignored.
    ///
    /// Fails on a device that was lost, or that reported an error since it was created.
    ///
    /// # Errors
    /// [`GpuError::Lost`], [`GpuError::Hung`], [`GpuError::OutOfMemory`] or [`GpuError::Refused`].
    pub fn read<T: Pod>(&self, buffer: &wgpu::Buffer) -> Result<Vec<T>, GpuError> {
        let size = buffer.size();
        let staging = self.create("a readback buffer", size, |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })?;
        let commands = self.create("a readback", size, |device| {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, size);
            encoder.finish()
        })?;
        self.submit_commands(commands);
        self.read_mapped(&staging)
    }

    /// Maps a staging buffer, waits, and copies its contents.
    pub(crate) fn read_mapped<T: Pod>(&self, staging: &wgpu::Buffer) -> Result<Vec<T>, GpuError> {
        let (sender, receiver) = mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only if the wait below has failed.
            let _ = sender.send(result);
        });
        self.wait()?;
        // Another thread that waits on the same device may have received the callback and not yet called it.
        // On a caller's device loss is detected here: its lost-device callback belongs to the caller.
        if !matches!(receiver.recv_timeout(CALLBACK), Ok(Ok(()))) {
            self.check()?;
            return Err(GpuError::Lost { reason: "a readback failed".to_owned() });
        }
        let view = staging.get_mapped_range(..).map_err(|error| GpuError::Refused {
            what: "a readback".to_owned(),
            reason: one_line(&error.to_string()),
        })?;
        let whole = view.len() / size_of::<T>().max(1) * size_of::<T>();
        let values = bytemuck::pod_collect_to_vec(&view[..whole]);
        drop(view);
        staging.unmap();
        Ok(values)
    }
}
