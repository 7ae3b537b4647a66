//! Readback from the device, which detects loss, hangs and late errors.

use std::ops::Range;
use std::sync::mpsc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use bytemuck::Pod;

use crate::context::one_line;

use crate::{Gpu, GpuError};

/// Time that a callback may stay with another thread after the device is done.
const CALLBACK: Duration = Duration::from_secs(5);

/// Bytes below which a buffer is that of a list, rather than of a picture.
const SMALL: u64 = 4 << 20;

/// Buffers that are kept: those of some frames.
const MAX_FREE: usize = 32;

/// Buffers through which a host reads, kept for the next time.
#[derive(Clone, Debug, Default)]
pub struct ReadbackPool {
    free: Arc<Mutex<Vec<wgpu::Buffer>>>,
}

/// Buffers on their way to the host.
#[derive(Debug)]
pub struct Readback {
    gpu: Gpu,
    pool: ReadbackPool,
    staging: Vec<Option<Staging>>,
    submission: wgpu::SubmissionIndex,
}

/// Copy of a buffer that the host can map.
#[derive(Debug)]
struct Staging {
    buffer: wgpu::Buffer,
    bytes: u64,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl ReadbackPool {
    /// Begins to read the whole of some buffers as they are after the work that was submitted so far. Does not wait: later work may
    /// write them.
    ///
    /// # Errors
    /// As [`Gpu::create`].
    pub fn begin(&self, gpu: &Gpu, buffers: &[&wgpu::Buffer]) -> Result<Readback, GpuError> {
        let whole: Vec<_> = buffers.iter().map(|buffer| (*buffer, 0..buffer.size())).collect();
        self.begin_parts(gpu, &whole)
    }

    /// The same of parts of buffers: ranges of bytes, multiples of 4, none of them empty.
    ///
    /// # Errors
    /// As [`Gpu::create`].
    pub fn begin_parts(
        &self,
        gpu: &Gpu,
        parts: &[(&wgpu::Buffer, Range<u64>)],
    ) -> Result<Readback, GpuError> {
        let bytes = |part: &Range<u64>| part.end - part.start;
        let staging = parts.iter().map(|(_, part)| self.staging(gpu, bytes(part)));
        let staging: Vec<wgpu::Buffer> = staging.collect::<Result<_, _>>()?;
        let commands = gpu.create("a readback", 0, |device| {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            for ((buffer, part), staging) in parts.iter().zip(&staging) {
                encoder.copy_buffer_to_buffer(buffer, part.start, staging, 0, bytes(part));
            }
            encoder.finish()
        })?;
        let submission = gpu.submit_commands([commands]);
        let mapped = |(buffer, bytes): (wgpu::Buffer, u64)| {
            let (sender, mapped) = mpsc::channel();
            buffer.map_async(wgpu::MapMode::Read, ..bytes, move |result| {
                // The receiver is gone only if nobody reads.
                let _ = sender.send(result);
            });
            Some(Staging { buffer, bytes, mapped })
        };
        let sizes = parts.iter().map(|(_, part)| bytes(part));
        let staging = staging.into_iter().zip(sizes).map(mapped).collect();
        Ok(Readback { gpu: gpu.clone(), pool: self.clone(), staging, submission })
    }

    /// A buffer of a size: one that is free and not twice as large, or a new one; that of a list has room to grow.
    fn staging(&self, gpu: &Gpu, bytes: u64) -> Result<wgpu::Buffer, GpuError> {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let fits = |buffer: &wgpu::Buffer| (bytes..=2 * bytes.max(1 << 12)).contains(&buffer.size());
        if let Some(place) = free.iter().position(fits) {
            return Ok(free.swap_remove(place));
        }
        drop(free);
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let room = if bytes < SMALL { bytes / 4 } else { 0 };
        gpu.create_buffer("a readback buffer", "readback", (bytes + room).next_multiple_of(4), usage)
    }
}

impl Readback {
    /// Waits until the copies are there.
    ///
    /// # Errors
    /// [`GpuError::Lost`], [`GpuError::Hung`], [`GpuError::OutOfMemory`] or [`GpuError::Refused`].
    pub fn wait(&self) -> Result<(), GpuError> {
        self.gpu.wait_until(Some(&self.submission))
    }

    /// Contents of the n-th buffer. Bytes after the last complete `T` are ignored. Each is taken once.
    ///
    /// # Errors
    /// As [`Readback::wait`]; [`GpuError::Refused`] if there is none, or if it was taken.
    pub fn take<T: Pod>(&mut self, n: usize) -> Result<Vec<T>, GpuError> {
        self.wait()?;
        let refused = |reason: String| GpuError::Refused { what: "a readback".to_owned(), reason };
        let staging = self.staging.get_mut(n).and_then(Option::take);
        let staging = staging.ok_or_else(|| refused(format!("buffer {n} is not there, or was taken")))?;
        // Another thread that waits on the same device may have received the callback and not yet called it.
        // On a caller's device loss is detected here: its lost-device callback belongs to the caller.
        if !matches!(staging.mapped.recv_timeout(CALLBACK), Ok(Ok(()))) {
            self.gpu.check()?;
            return Err(GpuError::Lost { reason: "a readback failed".to_owned() });
        }
        let view = staging.buffer.get_mapped_range(..staging.bytes);
        let view = view.map_err(|error| refused(one_line(&error.to_string())))?;
        let whole = view.len() / size_of::<T>().max(1) * size_of::<T>();
        let values = bytemuck::pod_collect_to_vec(&view[..whole]);
        drop(view);
        staging.buffer.unmap();
        let mut free = self.pool.free.lock().unwrap_or_else(PoisonError::into_inner);
        if free.len() >= MAX_FREE {
            free.remove(0);
        }
        free.push(staging.buffer);
        Ok(values)
    }
}

impl Gpu {
    /// Waits for all submitted work and reads the whole of `buffer`. Bytes after the last complete `T` are ignored.
    ///
    /// Fails on a device that was lost, or that reported an error since it was created.
    ///
    /// # Errors
    /// [`GpuError::Lost`], [`GpuError::Hung`], [`GpuError::OutOfMemory`] or [`GpuError::Refused`].
    pub fn read<T: Pod>(&self, buffer: &wgpu::Buffer) -> Result<Vec<T>, GpuError> {
        ReadbackPool::default().begin(self, &[buffer])?.take(0)
    }

    /// Waits as [`Gpu::read`] does and reads some of the `T` that `buffer` holds, of which there are as many.
    ///
    /// # Errors
    /// As [`Gpu::read`].
    pub fn read_part<T: Pod>(&self, buffer: &wgpu::Buffer, part: Range<u64>) -> Result<Vec<T>, GpuError> {
        let bytes = part.start * size_of::<T>() as u64..part.end * size_of::<T>() as u64;
        ReadbackPool::default().begin_parts(self, &[(buffer, bytes)])?.take(0)
    }
}
