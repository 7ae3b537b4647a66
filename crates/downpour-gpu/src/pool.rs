//! Buffers that stay from frame to frame.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use bytemuck::Pod;

use crate::{ComputeKernel, Gpu, GpuError, changed_ranges};

/// Least size of a kept storage buffer, bytes: lists of few drops change the most from frame to frame.
const MIN_BYTES: u64 = 256 << 10;

/// Buffers below this size, bytes, get as much room again as they need; larger ones a quarter.
const SMALL: u64 = 4 << 20;

/// Frames after which bindings that no frame has asked for are forgotten, with their hold on buffers.
const BINDINGS_LAST: u64 = 8;

/// Bytes of a buffer whose change is looked for together, whole words.
const CHANGED: usize = 64;

/// Bytes that have not changed between two that have, from which on those are written one by one: a write costs more than these.
const MIN_GAP: usize = 256;

/// A kernel's pipeline with the buffers of its bindings.
type BoundTo = (wgpu::ComputePipeline, Vec<(u32, wgpu::Buffer)>);

/// Buffers of a label that are kept after they were given back.
const MAX_RETURNED: usize = 4;

/// Maker of buffers: a [`Gpu`], which creates each anew, or a [`BufferPool`], which keeps them for the next frame.
pub trait BufferSource {
    /// Returns a buffer of `bytes` bytes or more with `usage` and both copy usages. Its contents are not defined.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`], [`GpuError::OutOfMemory`] or [`GpuError::Lost`].
    fn buffer(
        &self,
        label: &'static str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError>;

    /// Device and queue of the buffers.
    fn gpu(&self) -> &Gpu;

    /// Binds buffers to a kernel's bindings of group 0 by number.
    ///
    /// # Errors
    /// As [`ComputeKernel::bind`].
    fn bound(
        &self,
        kernel: &ComputeKernel,
        buffers: &[(u32, &wgpu::Buffer)],
    ) -> Result<wgpu::BindGroup, GpuError> {
        kernel.bind_anew(self.gpu(), buffers)
    }

    /// Writes the beginning of a buffer, before whatever is submitted next.
    fn write(&self, buffer: &wgpu::Buffer, bytes: &[u8]) {
        self.write_at(buffer, 0, bytes);
    }

    /// Writes part of a buffer from byte `offset` on, a multiple of 4, before whatever is submitted next.
    fn write_at(&self, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
        self.gpu().write_at(buffer, offset, bytes);
    }

    /// Counts bytes that other work has written for this frame.
    fn note_written(&self, _bytes: u64) {}

    /// Returns a storage buffer that begins with `data`; it has room for one element at least, as a binding needs it.
    ///
    /// # Errors
    /// As [`BufferSource::buffer`].
    fn storage<T: Pod>(&self, label: &'static str, data: &[T]) -> Result<wgpu::Buffer, GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let buffer =
            self.buffer(label, bytes.len().max(size_of::<T>()) as u64, wgpu::BufferUsages::STORAGE)?;
        self.write(&buffer, bytes);
        Ok(buffer)
    }

    /// Returns a storage buffer as [`BufferSource::storage`] does, which nobody else writes: neither kernels nor the host. It may be one
    /// that has these contents already.
    ///
    /// # Errors
    /// As [`BufferSource::buffer`].
    fn constants<T: Pod>(&self, label: &'static str, data: &[T]) -> Result<wgpu::Buffer, GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        self.filled(label, bytes, size_of::<T>() as u64, wgpu::BufferUsages::STORAGE)
    }

    /// Returns a buffer that begins with `bytes` and has room for `least`, which nobody else writes.
    ///
    /// # Errors
    /// As [`BufferSource::buffer`].
    fn filled(
        &self,
        label: &'static str,
        bytes: &[u8],
        least: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let buffer = self.buffer(label, least.max(bytes.len() as u64), usage)?;
        self.write(&buffer, bytes);
        Ok(buffer)
    }

    /// Returns a uniform buffer with the contents `value`, which nobody else writes.
    ///
    /// # Errors
    /// As [`BufferSource::buffer`].
    fn uniform<T: Pod>(&self, label: &'static str, value: &T) -> Result<wgpu::Buffer, GpuError> {
        self.filled(label, bytemuck::bytes_of(value), 0, wgpu::BufferUsages::UNIFORM)
    }
}

impl BufferSource for Gpu {
    fn buffer(
        &self,
        label: &'static str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        self.empty_buffer(label, bytes, usage)
    }

    fn gpu(&self) -> &Gpu {
        self
    }
}

/// Buffers of a frame and what they are bound to, kept for the next one.
///
/// The n-th buffer of a label in a frame is the n-th of that label in the frame before, if that one is large enough; else it is
/// created anew, with room to grow. So a loop of like frames creates no buffer after the first. All writes go through the
/// queue: they come before whatever is submitted next, so that each frame has to be submitted before the next one begins.
#[derive(Debug)]
pub struct BufferPool {
    gpu: Gpu,
    /// Labels whose buffers are kept only when they are given back.
    given_away: Vec<&'static str>,
    /// The same of buffers of which a beginning is used.
    given_away_with_room: Vec<&'static str>,
    kept: Mutex<Kept>,
}

#[derive(Debug, Default)]
struct Kept {
    buffers: HashMap<&'static str, Vec<wgpu::Buffer>>,
    /// Buffers of each label that the current frame has.
    used: HashMap<&'static str, usize>,
    /// Buffers that were given back.
    returned: HashMap<&'static str, Vec<wgpu::Buffer>>,
    /// Contents of buffers that nobody has written since.
    contents: HashMap<wgpu::Buffer, Vec<u8>>,
    /// A binding, with the last frame that asked for it.
    bindings: HashMap<BoundTo, (wgpu::BindGroup, u64)>,
    /// Number of the current frame.
    frame: u64,
    /// Buffers that were created.
    made: u64,
    /// Bytes that were written in the current frame.
    written: u64,
}

impl BufferPool {
    /// Creates a pool without buffers.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let (given_away, given_away_with_room) = (Vec::new(), Vec::new());
        Self { gpu: gpu.clone(), given_away, given_away_with_room, kept: Mutex::default() }
    }

    /// Sets labels whose buffers are needed longer than for the frame: they are used again only after [`BufferPool::give_back`].
    #[must_use]
    pub fn with_given_away(mut self, labels: &[&'static str]) -> Self {
        self.given_away.extend(labels);
        self
    }

    /// The same of lists, whose lengths change from frame to frame: buffers have more room than was asked for.
    #[must_use]
    pub fn with_lists_given_away(mut self, labels: &[&'static str]) -> Self {
        self.given_away_with_room.extend(labels);
        self
    }

    /// Gives back a buffer of a label of [`BufferPool::with_given_away`] or [`BufferPool::with_lists_given_away`]: all work that uses it has been submitted.
    pub fn give_back(&self, label: &'static str, buffer: wgpu::Buffer) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let returned = kept.returned.entry(label).or_default();
        if returned.len() < MAX_RETURNED {
            returned.push(buffer);
        }
    }

    /// Begins a frame: all buffers may be used again.
    pub fn begin_frame(&self) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.used.clear();
        kept.written = 0;
        kept.frame += 1;
        let oldest = kept.frame.saturating_sub(BINDINGS_LAST);
        kept.bindings.retain(|_, (_, last)| *last >= oldest);
    }

    /// Number of bytes that were written in the current frame.
    #[must_use]
    pub fn written(&self) -> u64 {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).written
    }

    /// Number of buffers that were created so far.
    #[must_use]
    pub fn made(&self) -> u64 {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).made
    }

    /// The last buffer of a label in the current frame, if it is known to hold `bytes` and nothing else.
    fn last_with(&self, label: &'static str, bytes: &[u8]) -> Option<wgpu::Buffer> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let nth = kept.used.get(label)?.checked_sub(1)?;
        let last = kept.buffers.get(label)?.get(nth)?;
        kept.contents.get(last).filter(|known| *known == bytes).map(|_| last.clone())
    }

    /// Size of a new buffer: with room to grow, as far as the device allows.
    fn roomy(&self, bytes: u64, usage: wgpu::BufferUsages) -> u64 {
        if usage.contains(wgpu::BufferUsages::UNIFORM) {
            return bytes;
        }
        let room = if bytes < SMALL { bytes } else { bytes / 4 };
        let wanted = (bytes + room).max(MIN_BYTES).next_multiple_of(256);
        if wanted <= self.gpu.max_storage_bytes() { wanted } else { bytes }
    }
}

impl BufferSource for BufferPool {
    fn buffer(
        &self,
        label: &'static str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let has_room = self.given_away_with_room.contains(&label);
        if has_room || self.given_away.contains(&label) {
            let size = bytes.max(4).next_multiple_of(4);
            let (wanted, most) = if has_room {
                let wanted = self.roomy(size, usage);
                (wanted, 2 * wanted)
            } else {
                (size, size)
            };
            let returned = kept.returned.entry(label).or_default();
            // Those of another size are of pictures of another size: of no use any more.
            returned.retain(|known| (size..=most).contains(&known.size()) && known.usage().contains(usage));
            if let Some(known) = returned.pop() {
                return Ok(known);
            }
            kept.made += 1;
            return self.gpu.empty_buffer(label, wanted, usage);
        }
        let nth = kept.used.get(label).copied().unwrap_or_default();
        let known = kept.buffers.get(label).and_then(|buffers| buffers.get(nth));
        let buffer = match known.filter(|known| known.size() >= bytes && known.usage().contains(usage)) {
            Some(known) => known.clone(),
            None => {
                let made = self.gpu.empty_buffer(label, self.roomy(bytes, usage), usage)?;
                let buffers = kept.buffers.entry(label).or_default();
                let smaller = match buffers.get_mut(nth) {
                    Some(place) => Some(std::mem::replace(place, made.clone())),
                    None => {
                        buffers.push(made.clone());
                        None
                    }
                };
                if let Some(smaller) = smaller {
                    kept.contents.remove(&smaller);
                }
                kept.made += 1;
                made
            }
        };
        kept.used.insert(label, nth + 1);
        Ok(buffer)
    }

    /// Writes only what is not there already from the frame before. The buffer may be the last one of the label in this frame.
    fn filled(
        &self,
        label: &'static str,
        bytes: &[u8],
        least: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let is_fit = |same: &wgpu::Buffer| same.size() >= least && same.usage().contains(usage);
        if let Some(same) = self.last_with(label, bytes).filter(is_fit) {
            return Ok(same);
        }
        let buffer = self.buffer(label, least.max(bytes.len() as u64), usage)?;
        let changes = {
            let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
            let known = kept.contents.entry(buffer.clone()).or_default();
            let changes = changed_ranges(known, bytes, CHANGED, MIN_GAP);
            for range in &changes {
                known.resize(known.len().max(range.end), 0);
                known[range.clone()].copy_from_slice(&bytes[range.clone()]);
            }
            changes
        };
        for range in changes {
            self.note_written(range.len() as u64);
            self.gpu.write_at(&buffer, range.start as u64, &bytes[range]);
        }
        Ok(buffer)
    }

    fn bound(
        &self,
        kernel: &ComputeKernel,
        buffers: &[(u32, &wgpu::Buffer)],
    ) -> Result<wgpu::BindGroup, GpuError> {
        let all = buffers.iter().map(|&(binding, buffer)| (binding, buffer.clone())).collect();
        let to = (kernel.pipeline().clone(), all);
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let frame = kept.frame;
        if let Some((known, last)) = kept.bindings.get_mut(&to) {
            *last = frame;
            return Ok(known.clone());
        }
        let made = kernel.bind_anew(&self.gpu, buffers)?;
        kept.bindings.insert(to, (made.clone(), frame));
        Ok(made)
    }

    fn write_at(&self, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
        self.note_written(bytes.len() as u64);
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).contents.remove(buffer);
        self.gpu.write_at(buffer, offset, bytes);
    }

    fn note_written(&self, bytes: u64) {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).written += bytes;
    }

    fn gpu(&self) -> &Gpu {
        &self.gpu
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// wgpu's noop device.
    fn noop() -> Gpu {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        Gpu::on_device(device, queue)
    }

    #[test]
    fn buffers_that_are_given_away_are_used_again_when_they_come_back() {
        let pool = BufferPool::new(&noop()).with_given_away(&["picture"]);
        let storage = wgpu::BufferUsages::STORAGE;
        let picture = |bytes| {
            pool.begin_frame();
            pool.buffer("picture", bytes, storage).unwrap()
        };
        let (first, second) = (picture(64), picture(64));
        assert_ne!(first, second);
        assert_eq!(pool.made(), 2);
        pool.give_back("picture", first.clone());
        assert_eq!(picture(64), first);
        assert_eq!(pool.made(), 2);
        pool.give_back("picture", second);
        assert_eq!(picture(128).size(), 128);
        assert_eq!(pool.made(), 3);
        assert_ne!(picture(64), first);
    }

    #[test]
    fn lists_that_are_given_away_have_room() {
        let pool = BufferPool::new(&noop()).with_lists_given_away(&["distances"]);
        let list = |bytes| {
            pool.begin_frame();
            pool.buffer("distances", bytes, wgpu::BufferUsages::STORAGE).unwrap()
        };
        let first = list(1_100_000);
        assert!(first.size() > 1_200_000);
        // A little longer and shorter, and of another order.
        for (bytes, is_kept) in [(1_200_000, true), (1_100_000, true), (200_000, false)] {
            pool.give_back("distances", first.clone());
            assert_eq!(list(bytes) == first, is_kept, "{bytes}");
        }
    }

    #[test]
    fn what_is_there_is_not_written_again() {
        let pool = BufferPool::new(&noop());
        let frame = |classes: &[u32], dt: f32| {
            pool.begin_frame();
            let buffer = pool.constants("classes", classes).unwrap();
            pool.uniform("frame", &dt).unwrap();
            (buffer, pool.written())
        };
        let (first, written) = frame(&[1, 2, 3], 0.5);
        assert_eq!(written, 16);
        assert_eq!(frame(&[1, 2, 3], 0.5), (first.clone(), 0));
        assert_eq!(frame(&[1, 2], 0.25), (first.clone(), 4));
        assert_eq!(frame(&[1, 2, 4], 0.25), (first.clone(), 12));
        // What others have written is written over.
        pool.write_at(&first, 4, &[0; 4]);
        assert_eq!(frame(&[1, 2, 4], 0.25), (first.clone(), 12));
        // A larger buffer has nothing of the smaller one.
        let (larger, written) = frame(&[7; 100_000], 0.25);
        assert!(larger != first && written == 400_000);
    }

    #[test]
    fn the_same_contents_are_one_buffer() {
        let pool = BufferPool::new(&noop());
        for frame in 0..2u32 {
            pool.begin_frame();
            let all = [1u32, 1, 2, 1].map(|value| pool.uniform("frame", &[value; 4]).unwrap());
            assert!(all[0] == all[1] && all[1] != all[2] && all[2] != all[3] && all[0] != all[3]);
            assert_eq!((pool.made(), pool.written()), (3, if frame == 0 { 48 } else { 0 }));
        }
        // What kernels write is nobody else's.
        assert_ne!(pool.storage("list", &[1u32]).unwrap(), pool.storage("list", &[1u32]).unwrap());
    }

    #[test]
    fn only_what_has_changed_is_written() {
        let pool = BufferPool::new(&noop());
        let mut table = vec![0u32; 1000];
        let written = |table: &[u32]| {
            pool.begin_frame();
            pool.constants("table", table).unwrap();
            pool.written()
        };
        assert_eq!(written(&table), 4000);
        table[500] = 1;
        assert_eq!(written(&table), 64);
        // Far apart; close together, as one; the end, which is not whole.
        table[20] = 1;
        table[900] = 2;
        assert_eq!(written(&table), 2 * 64);
        table[600] = 1;
        table[630] = 1;
        assert_eq!(written(&table), 3 * 64);
        table[999] = 1;
        assert_eq!(written(&table), 32);
        // What was behind a shorter one is still there.
        assert_eq!(written(&table[..100]), 0);
        assert_eq!(written(&table), 0);
    }

    #[test]
    fn like_frames_make_no_buffers() {
        let pool = BufferPool::new(&noop());
        let frame = |drops: usize| {
            pool.begin_frame();
            let a = pool.storage("drops", &vec![0u32; drops]).unwrap();
            let b = pool.storage("drops", &[1u32]).unwrap();
            let c = pool.uniform("frame", &[0u32; 4]).unwrap();
            assert_ne!(a, b);
            assert!(a.size() >= 4 * drops as u64 && c.size() == 16);
        };
        frame(1000);
        assert_eq!(pool.made(), 3);
        for drops in [1000, 900, 60_000, 0] {
            frame(drops);
        }
        assert_eq!(pool.made(), 3);
        frame(600_000);
        assert_eq!(pool.made(), 4);
        frame(1_000_000);
        assert_eq!(pool.made(), 4);
    }
}
