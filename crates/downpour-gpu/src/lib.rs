//! A thin, checked layer over wgpu.
//!
//! wgpu alone reports little: after a device is lost, calls return quietly; a validation error without a handler
//! panics; a buffer above a limit is refused after the fact. All functions here return a [`GpuError`] instead, and
//! results of a lost device are never returned.
//!
//! - [`Gpu`]: a context on a new device ([`Gpu::open`]) or on a caller's ([`Gpu::on_device`], which
//!   never replaces the caller's handlers);
//! - [`adapters`](adapter::adapters): the available GPUs and their capabilities;
//! - [`ComputeKernel`], [`Dispatch`]: pipelines from `downpour-shaders`, checked against the device's limits;
//! - [`BufferPool`]: buffers that stay from frame to frame;
//! - [`Gpu::read`]: readback, which detects loss, hangs and late errors;
//! - [`ReadbackRing`]: small readbacks that nothing waits for; [`LossProbe`]: loss of a caller's device, at once;
//! - [`timing`]: time of whole passes, by timestamps where the device has them.
//!
//! ```no_run
//! use downpour_gpu::{AdapterChoice, Gpu};
//! let gpu = Gpu::open(&AdapterChoice::Auto)?;
//! println!("running on {}", gpu.adapter().name);
//! let buffer = gpu.storage_buffer("numbers", &[1.0f32, 2.0, 3.0])?;
//! assert_eq!(gpu.read::<f32>(&buffer)?, [1.0, 2.0, 3.0]);
//! # Ok::<(), downpour_gpu::GpuError>(())
//! ```

pub mod adapter;
mod buffer;
mod changed;
mod context;
mod drivers;
mod error;
mod kernel;
mod loss_probe;
mod made_once;
mod passes;
mod pool;
mod readback;
mod readback_ring;
mod sequence;
pub mod timing;
mod workgroups;

pub use adapter::{AdapterChoice, AdapterDescription};
pub use changed::changed_ranges;
pub use context::{Gpu, GpuOptions, LimitSet};
pub use error::GpuError;
pub use kernel::{ComputeKernel, Dispatch};
pub use loss_probe::LossProbe;
pub use made_once::made_once;
pub use passes::{FramePasses, FrameQueries, FrameTimes, TICKS};
pub use pool::{BufferPool, BufferSource};
pub use readback::{Readback, ReadbackPool};
pub use readback_ring::ReadbackRing;
pub use sequence::{KernelSequence, SequencePass};
pub use wgpu;
pub use workgroups::{invocation_index, workgroups, workgroups_for};

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
