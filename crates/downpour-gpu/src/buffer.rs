//! Buffers, checked against the limits of the device before they are created.

use bytemuck::Pod;

use crate::{Gpu, GpuError};

impl Gpu {
    /// Bytes of the largest storage buffer that the device binds as a whole.
    #[must_use]
    pub fn max_storage_bytes(&self) -> u64 {
        let limits = self.device().limits();
        limits.max_buffer_size.min(limits.max_storage_buffer_binding_size)
    }

    /// Creates a storage buffer with the contents `data`, and with both copy usages.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`], [`GpuError::OutOfMemory`] or [`GpuError::Lost`].
    pub fn storage_buffer<T: Pod>(&self, label: &str, data: &[T]) -> Result<wgpu::Buffer, GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let buffer = self.empty_buffer(label, bytes.len() as u64, wgpu::BufferUsages::STORAGE)?;
        self.write(&buffer, bytes);
        Ok(buffer)
    }

    /// Creates a uniform buffer with the contents `value`.
    ///
    /// # Errors
    /// As [`Gpu::storage_buffer`].
    pub fn uniform_buffer<T: Pod>(&self, label: &str, value: &T) -> Result<wgpu::Buffer, GpuError> {
        let bytes = bytemuck::bytes_of(value);
        let buffer = self.empty_buffer(label, bytes.len() as u64, wgpu::BufferUsages::UNIFORM)?;
        self.write(&buffer, bytes);
        Ok(buffer)
    }

    /// Creates a buffer of `bytes` bytes (at least 4, rounded up to a multiple of 4) with `usage` and both copy usages.
    ///
    /// # Errors
    /// As [`Gpu::storage_buffer`].
    pub fn empty_buffer(
        &self,
        label: &str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let size = bytes.max(4).next_multiple_of(4);
        let limits = self.device().limits();
        let mut allowed = vec![("max_buffer_size", limits.max_buffer_size)];
        if usage.contains(wgpu::BufferUsages::STORAGE) {
            allowed.push(("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size));
        }
        if usage.contains(wgpu::BufferUsages::UNIFORM) {
            allowed.push(("max_uniform_buffer_binding_size", limits.max_uniform_buffer_binding_size));
        }
        for (limit_name, allowed) in allowed {
            if size > allowed {
                return Err(GpuError::OverLimit {
                    what: format!("the size in bytes of buffer \"{label}\""),
                    found: size,
                    limit_name,
                    allowed,
                });
            }
        }
        let usage = usage | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        self.create_buffer(&format!("buffer \"{label}\""), label, size, usage)
    }

    /// Writes `bytes` at the start of `buffer`, padded with zeros to a multiple of 4.
    pub(crate) fn write(&self, buffer: &wgpu::Buffer, bytes: &[u8]) {
        self.write_at(buffer, 0, bytes);
    }

    /// The same from byte `offset` on, a multiple of 4.
    pub(crate) fn write_at(&self, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
        let whole = bytes.len() / 4 * 4;
        if whole > 0 {
            self.queue().write_buffer(buffer, offset, &bytes[..whole]);
        }
        if whole < bytes.len() {
            let mut last = [0; 4];
            last[..bytes.len() - whole].copy_from_slice(&bytes[whole..]);
            self.queue().write_buffer(buffer, offset + whole as u64, &last);
        }
    }
}
