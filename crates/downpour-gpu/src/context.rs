//! Device, queue and the state of their health.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use crate::adapter::{self, AdapterChoice, AdapterDescription};
use crate::{Dispatch, GpuError};

/// Options of a device that Downpour creates.
#[derive(Clone, Debug)]
pub struct GpuOptions {
    /// Adapter to open.
    pub adapter: AdapterChoice,
    /// Limits to request.
    pub limits: LimitSet,
    /// Time after which an unfinished submission counts as hung.
    pub timeout: Duration,
    /// Destroys the device after this many submissions, as a driver reset would. For tests of device loss.
    pub lose_after_submissions: Option<u64>,
}

impl Default for GpuOptions {
    fn default() -> Self {
        Self {
            adapter: AdapterChoice::Auto,
            limits: LimitSet::Adapter,
            timeout: Duration::from_secs(30),
            lose_after_submissions: None,
        }
    }
}

/// Limits that a new device gets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LimitSet {
    /// All limits of the adapter.
    #[default]
    Adapter,
    /// WebGPU's default limits, as a browser gives them.
    WebGpuDefault,
    /// The same, but for so many storage buffers per shader.
    WebGpuWithBuffers(u32),
}

/// A device and its queue, with typed errors.
///
/// Cloning is cheap and gives another handle to the same device.
#[derive(Clone, Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: Arc<AdapterDescription>,
    health: Arc<Health>,
    /// Buffers that were created through any of the handles.
    buffers_made: Arc<AtomicU64>,
    timeout: Duration,
}

/// Reports of the callbacks of a device that Downpour created. Empty on a caller's device, where loss is detected
/// by the failure of the next readback.
#[derive(Debug, Default)]
struct Health {
    lost: Mutex<Option<String>>,
    uncaptured: Mutex<Option<String>>,
    submissions: AtomicU64,
    lose_after: Option<u64>,
}

impl Health {
    fn note(slot: &Mutex<Option<String>>, text: String) {
        slot.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
    }

    fn read(slot: &Mutex<Option<String>>) -> Option<String> {
        slot.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Timestamps of a submission.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timestamps<'a> {
    pub(crate) queries: &'a wgpu::QuerySet,
    /// Query that its first pass writes when it begins.
    pub(crate) begin: Option<u32>,
    /// Query that its last pass writes when it ends.
    pub(crate) end: Option<u32>,
}

impl<'a> Timestamps<'a> {
    /// Those of one of the passes.
    fn of_pass(self, is_first: bool, is_last: bool) -> Option<wgpu::ComputePassTimestampWrites<'a>> {
        let writes = wgpu::ComputePassTimestampWrites {
            query_set: self.queries,
            beginning_of_pass_write_index: self.begin.filter(|_| is_first),
            end_of_pass_write_index: self.end.filter(|_| is_last),
        };
        let has_some =
            writes.beginning_of_pass_write_index.is_some() || writes.end_of_pass_write_index.is_some();
        has_some.then_some(writes)
    }
}

impl Gpu {
    /// Opens a device on the chosen adapter, with the adapter's limits.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`], [`GpuError::AdapterNotFound`] or [`GpuError::NoDevice`].
    pub fn open(choice: &AdapterChoice) -> Result<Self, GpuError> {
        Self::open_with(&GpuOptions { adapter: choice.clone(), ..GpuOptions::default() })
    }

    /// Opens a device with options.
    ///
    /// # Errors
    /// As [`Gpu::open`].
    pub fn open_with(options: &GpuOptions) -> Result<Self, GpuError> {
        let adapter = adapter::choose(&options.adapter)?;
        let wanted = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::FLOAT32_FILTERABLE;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("downpour"),
            required_features: adapter.features() & wanted,
            required_limits: match options.limits {
                LimitSet::Adapter => adapter.limits(),
                LimitSet::WebGpuDefault => wgpu::Limits::default(),
                LimitSet::WebGpuWithBuffers(count) => {
                    wgpu::Limits { max_storage_buffers_per_shader_stage: count, ..wgpu::Limits::default() }
                }
            },
            ..Default::default()
        }))
        .map_err(|error| GpuError::NoDevice {
            adapter: adapter.get_info().name,
            reason: one_line(&error.to_string()),
        })?;
        let health = Arc::new(Health { lose_after: options.lose_after_submissions, ..Health::default() });
        let (on_lost, on_error) = (Arc::clone(&health), Arc::clone(&health));
        device.set_device_lost_callback(move |reason, message| {
            let text = if message.is_empty() { format!("{reason:?}") } else { one_line(&message) };
            Health::note(&on_lost.lost, text);
        });
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            Health::note(&on_error.uncaptured, one_line(&error.to_string()));
        }));
        Ok(Self::assemble(device, queue, health, options.timeout))
    }

    /// Sets the time after which a wait counts as hung.
    #[must_use]
    pub fn with_timeout(self, timeout: Duration) -> Self {
        Self { timeout, ..self }
    }

    /// Creates a context on a caller's device and queue. The caller's lost-device callback and error handler stay.
    #[must_use]
    pub fn on_device(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        Self::assemble(device, queue, Arc::default(), GpuOptions::default().timeout)
    }

    fn assemble(device: wgpu::Device, queue: wgpu::Queue, health: Arc<Health>, timeout: Duration) -> Self {
        let adapter = AdapterDescription::new(&device.adapter_info(), device.features(), &device.limits());
        let buffers_made = Arc::default();
        Self { device, queue, adapter: Arc::new(adapter), health, buffers_made, timeout }
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The queue.
    #[must_use]
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Adapter of the device; features and limits are those of the device.
    #[must_use]
    pub fn adapter(&self) -> &AdapterDescription {
        &self.adapter
    }

    /// Number of buffers that were created on the device through this handle and its clones.
    #[must_use]
    pub fn buffers_made(&self) -> u64 {
        self.buffers_made.load(Ordering::Relaxed)
    }

    /// Creates a buffer on the device, and counts it.
    ///
    /// # Errors
    /// As [`Gpu::create`], of which it is the only way to a buffer.
    pub(crate) fn create_buffer(
        &self,
        what: &str,
        label: &str,
        size: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let of = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        let made = self.create(what, size, |device| device.create_buffer(&of))?;
        self.buffers_made.fetch_add(1, Ordering::Relaxed);
        Ok(made)
    }

    /// Creates an object on the device, and turns errors that wgpu reports into a [`GpuError`].
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`] (with `bytes` as the required size) or [`GpuError::Refused`], both naming `what`;
    /// [`GpuError::Lost`] if the device is known to be lost.
    pub fn create<T>(
        &self,
        what: &str,
        bytes: u64,
        make: impl FnOnce(&wgpu::Device) -> T,
    ) -> Result<T, GpuError> {
        self.check()?;
        // Error scopes are a stack per thread, popped innermost first. Each is always popped: a scope that is
        // dropped would swallow a caller's errors.
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let made = make(&self.device);
        let internal = pollster::block_on(internal.pop());
        let validation = pollster::block_on(validation.pop());
        let memory = pollster::block_on(memory.pop());
        if memory.is_some() {
            return Err(GpuError::OutOfMemory { what: what.to_owned(), need_bytes: bytes });
        }
        if let Some(error) = validation.or(internal) {
            self.check()?;
            return Err(GpuError::Refused { what: what.to_owned(), reason: one_line(&error.to_string()) });
        }
        Ok(made)
    }

    /// Submits the dispatches in order as one command buffer, without waiting.
    ///
    /// # Errors
    /// As [`Gpu::create`]; [`GpuError::OverLimit`] if a dispatch has more workgroups than the device allows.
    pub fn submit(&self, dispatches: &[Dispatch<'_>]) -> Result<(), GpuError> {
        self.submit_commands([self.record_stages(&[dispatches], None)?]);
        Ok(())
    }

    /// Records stages of dispatches in order as one command buffer, a compute pass for each stage, which may write timestamps at
    /// the beginning of the first and the end of the last.
    pub(crate) fn record_stages(
        &self,
        stages: &[&[Dispatch<'_>]],
        timestamps: Option<Timestamps<'_>>,
    ) -> Result<wgpu::CommandBuffer, GpuError> {
        let mut encoder = self.encoder()?;
        self.record_in(&mut encoder, stages, timestamps)?;
        self.finish(encoder)
    }

    /// An encoder of commands.
    pub(crate) fn encoder(&self) -> Result<wgpu::CommandEncoder, GpuError> {
        self.create("a command encoder", 0, |device| {
            device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
        })
    }

    /// Ends an encoder, which says now what was wrong with its commands.
    pub(crate) fn finish(&self, encoder: wgpu::CommandEncoder) -> Result<wgpu::CommandBuffer, GpuError> {
        self.create("a command buffer", 0, |_| encoder.finish())
    }

    /// Records stages of dispatches as [`Gpu::record_stages`] does.
    pub(crate) fn record_in(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        stages: &[&[Dispatch<'_>]],
        timestamps: Option<Timestamps<'_>>,
    ) -> Result<(), GpuError> {
        let limits = self.device.limits();
        for dispatch in stages.iter().copied().flatten() {
            dispatch.check(&limits)?;
        }
        // A pass may say at once what is wrong with it.
        self.create("a pass", 0, |_| {
            for (k, dispatches) in stages.iter().enumerate() {
                let timestamp_writes =
                    timestamps.and_then(|timestamps| timestamps.of_pass(k == 0, k + 1 == stages.len()));
                let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
                let mut pass = encoder.begin_compute_pass(&descriptor);
                for dispatch in *dispatches {
                    dispatch.encode_in(&mut pass);
                }
            }
        })
    }

    /// Submits recorded commands in one submission, and destroys the device if the options ask for it.
    pub(crate) fn submit_commands(
        &self,
        commands: impl IntoIterator<Item = wgpu::CommandBuffer>,
    ) -> wgpu::SubmissionIndex {
        let submitted = self.queue.submit(commands);
        let done = self.health.submissions.fetch_add(1, Ordering::Relaxed) + 1;
        if self.health.lose_after == Some(done) {
            self.device.destroy();
        }
        submitted
    }

    /// Waits until all submitted work is done.
    ///
    /// # Errors
    /// [`GpuError::Hung`] after the timeout, [`GpuError::Lost`], or the error of an earlier call.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.wait_until(None)
    }

    /// Waits until a submission is done; `None` is the last one.
    pub(crate) fn wait_until(&self, submission: Option<&wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        let poll =
            wgpu::PollType::Wait { submission_index: submission.cloned(), timeout: Some(self.timeout) };
        match self.device.poll(poll) {
            Ok(_) => self.check(),
            Err(wgpu::PollError::Timeout) => Err(GpuError::Hung { waited: self.timeout }),
            // A lost device takes no submission; what it has lost is known after the ones before.
            Err(_) if submission.is_some() => {
                self.wait()?;
                Err(GpuError::Lost { reason: "a submission failed".to_owned() })
            }
            Err(error) => {
                Err(GpuError::Refused { what: "waiting".to_owned(), reason: one_line(&error.to_string()) })
            }
        }
    }

    /// Checks the known health of the device, without waiting.
    ///
    /// # Errors
    /// [`GpuError::Lost`], or [`GpuError::Refused`] for an error that no scope caught.
    pub fn check(&self) -> Result<(), GpuError> {
        if let Some(reason) = Health::read(&self.health.lost) {
            return Err(GpuError::Lost { reason });
        }
        match Health::read(&self.health.uncaptured) {
            Some(reason) => Err(GpuError::Refused { what: "an earlier call".to_owned(), reason }),
            None => Ok(()),
        }
    }
}

/// Joins the lines of one of wgpu's multi-line messages.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
