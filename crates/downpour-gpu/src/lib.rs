//! A thin, checked layer over wgpu.
//!
//! wgpu reports little by itself: after a device is lost, calls return quietly; a validation error without a
//! handler panics; a buffer above a limit is refused after the fact. Everything here returns a [`GpuError`]
//! instead, and nothing that was computed on a lost device is ever handed out.
//!
//! - [`Gpu`]: a context on a device of its own ([`Gpu::open`]) or on a caller's ([`Gpu::on_device`], which
//!   never replaces the caller's handlers);
//! - [`adapters`](adapter::adapters): what GPUs there are, and what each can do;
//! - [`ComputeKernel`], [`Dispatch`]: pipelines from `downpour-shaders`, checked against the device's limits;
//! - [`Gpu::read`]: readback, which is where loss, hangs and late errors are seen;
//! - [`timing`]: time of whole passes, by timestamp where the device has them.
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
mod context;
mod drivers;
mod error;
mod kernel;
mod readback;
pub mod timing;

pub use adapter::{AdapterChoice, AdapterDescription};
pub use context::{Gpu, GpuOptions, LimitSet};
pub use error::GpuError;
pub use kernel::{ComputeKernel, Dispatch};
pub use wgpu;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
