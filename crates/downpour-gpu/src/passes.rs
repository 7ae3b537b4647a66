//! Passes of a frame, submitted one after the other, with the time of each.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::context::Timestamps;
use crate::{BufferSource, Dispatch, Gpu, GpuError};

/// Label of the buffers of ticks: a pool that is to keep them is given them back when they have been read.
pub const TICKS: &str = "times of passes";

/// Submissions after which the host waits, so that what hangs is found: far more than a frame of usual size has.
const WAIT_EVERY: usize = 256;

/// Passes of a frame, with the time of each by the device's clock. On a device without one, and on software drivers, whose clock says
/// nothing and which queue without end, the host waits for each submission and measures by its own clock.
#[derive(Debug)]
pub struct FramePasses {
    gpu: Gpu,
    clock: Option<Clock>,
    times: Vec<(&'static str, PassEnd)>,
    /// Passes that are not submitted yet: each command buffer and each submission costs the host as much as some passes.
    recorded: Option<wgpu::CommandEncoder>,
    /// True if the parts of a pass are submitted together.
    is_short: bool,
}

/// Timestamps of a device's frames, which one frame after the other uses.
#[derive(Debug, Default)]
pub struct FrameQueries(Mutex<Option<wgpu::QuerySet>>);

/// Timestamps of passes: begin and end of the n-th are the queries 2 n and 2 n + 1.
#[derive(Debug)]
struct Clock {
    queries: wgpu::QuerySet,
    ticks: wgpu::Buffer,
    most: u32,
    /// Passes that have timestamps.
    used: u32,
}

/// Time of a pass.
#[derive(Clone, Copy, Debug)]
enum PassEnd {
    /// By the host's clock, ms.
    Host(f64),
    /// By the n-th pair of timestamps.
    Device(u32),
}

/// Times of passes that the device may not have ended yet.
#[derive(Debug)]
pub struct FrameTimes {
    times: Vec<(&'static str, PassEnd)>,
    /// Nanoseconds of a tick.
    period: f64,
}

impl FramePasses {
    /// Creates room for the timestamps of `most` passes; further ones are waited for.
    ///
    /// # Errors
    /// As [`Gpu::create`].
    pub fn new(gpu: &Gpu, most: u32) -> Result<Self, GpuError> {
        Self::after(&FrameQueries::default(), gpu, most)
    }

    /// The same with the queries of the frame before, of as many passes, and a buffer of ticks from `buffers`, whose label is [`TICKS`].
    ///
    /// # Errors
    /// As [`Gpu::create`].
    pub fn after(queries: &FrameQueries, buffers: &impl BufferSource, most: u32) -> Result<Self, GpuError> {
        let gpu = buffers.gpu();
        let adapter = gpu.adapter();
        let clock = if adapter.timestamps && !adapter.is_software() {
            let mut kept = queries.0.lock().unwrap_or_else(PoisonError::into_inner);
            let queries = match &*kept {
                Some(queries) => queries.clone(),
                None => kept.insert(query_set(gpu, most)?).clone(),
            };
            let ticks = buffers.buffer(TICKS, u64::from(16 * most), wgpu::BufferUsages::QUERY_RESOLVE)?;
            Some(Clock { queries, ticks, most, used: 0 })
        } else {
            None
        };
        Ok(Self { gpu: gpu.clone(), clock, times: Vec::new(), recorded: None, is_short: false })
    }

    /// Sets whether the whole frame takes the device less time than a driver allows one submission: then what would be submitted by
    /// itself goes with the rest.
    #[must_use]
    pub fn with_short(self, is_short: bool) -> Self {
        Self { is_short, ..self }
    }

    /// Submits the passes so far: the device works on them while the host records the next ones.
    ///
    /// # Errors
    /// As [`Gpu::submit`].
    pub fn flush(&mut self) -> Result<(), GpuError> {
        submit(&self.gpu, &mut self.recorded)
    }

    /// Notes the time of other work, ms.
    fn note(&mut self, name: &'static str, ms: f64) {
        self.times.push((name, PassEnd::Host(ms)));
    }

    /// Runs work of the host and notes its time.
    pub fn host<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let begin = Instant::now();
        let made = work();
        self.note(name, begin.elapsed().as_secs_f64() * 1.0e3);
        made
    }

    /// Runs a pass. On a device with a clock it is submitted with the next ones, at the latest by [`FramePasses::end`].
    ///
    /// # Errors
    /// As [`Gpu::submit`] and [`Gpu::wait`].
    pub fn run(&mut self, name: &'static str, dispatches: &[Dispatch<'_>]) -> Result<(), GpuError> {
        self.run_parts(name, &[&[dispatches]], false)
    }

    /// Runs a pass in stages: the dispatches of a stage do not wait for one another, where they write different buffers, but for
    /// all of the stage before. (Between two dispatches of one stage that write the same buffer the later one waits for all before it.)
    ///
    /// # Errors
    /// As [`FramePasses::run`].
    pub fn run_stages(&mut self, name: &'static str, stages: &[Vec<Dispatch<'_>>]) -> Result<(), GpuError> {
        let stages: Vec<&[Dispatch<'_>]> = stages.iter().map(Vec::as_slice).collect();
        self.run_parts(name, &[&stages], false)
    }

    /// Submits a pass, each dispatch by itself unless the frame is short: drivers reset a device that is busy with one submission for too
    /// long.
    ///
    /// # Errors
    /// As [`FramePasses::run`].
    pub fn run_each(&mut self, name: &'static str, dispatches: &[Dispatch<'_>]) -> Result<(), GpuError> {
        self.run_batches(name, &dispatches.iter().map(|one| vec![*one]).collect::<Vec<_>>())
    }

    /// Submits a pass, each batch of dispatches by itself. Those of a batch do not wait for one another, where they write different
    /// buffers.
    ///
    /// # Errors
    /// As [`FramePasses::run`].
    pub fn run_batches(&mut self, name: &'static str, batches: &[Vec<Dispatch<'_>>]) -> Result<(), GpuError> {
        let stages: Vec<[&[Dispatch<'_>]; 1]> = batches.iter().map(|batch| [batch.as_slice()]).collect();
        let parts: Vec<&[&[Dispatch<'_>]]> = stages.iter().map(<[_; 1]>::as_slice).collect();
        self.run_parts(name, &parts, true)
    }

    /// Runs parts of a pass, each in stages, and submits each of them at once if it stands `apart`.
    fn run_parts(
        &mut self,
        name: &'static str,
        parts: &[&[&[Dispatch<'_>]]],
        apart: bool,
    ) -> Result<(), GpuError> {
        let Some(clock) = self.clock.as_mut().filter(|clock| clock.used < clock.most && !parts.is_empty())
        else {
            submit(&self.gpu, &mut self.recorded)?;
            let begin = Instant::now();
            for part in parts {
                self.gpu.submit_commands([self.gpu.record_stages(part, None)?]);
                self.gpu.wait()?;
            }
            self.note(name, begin.elapsed().as_secs_f64() * 1.0e3);
            return Ok(());
        };
        let used = clock.used;
        clock.used += 1;
        for (k, part) in parts.iter().enumerate() {
            let (is_first, is_last) = (k == 0, k + 1 == parts.len());
            let timestamps = Timestamps {
                queries: &clock.queries,
                begin: is_first.then_some(2 * used),
                end: is_last.then_some(2 * used + 1),
            };
            let encoder = encoder(&self.gpu, &mut self.recorded)?;
            self.gpu.record_in(encoder, part, Some(timestamps))?;
            if apart && !self.is_short {
                submit(&self.gpu, &mut self.recorded)?;
            }
            if k % WAIT_EVERY == WAIT_EVERY - 1 {
                self.gpu.wait()?;
            }
        }
        self.times.push((name, PassEnd::Device(used)));
        Ok(())
    }

    /// Ends the passes. The buffer, of a device with a clock, holds its ticks for [`FrameTimes::read`] as soon as the device is done.
    ///
    /// # Errors
    /// As [`Gpu::create`].
    pub fn end(mut self) -> Result<(FrameTimes, Option<wgpu::Buffer>), GpuError> {
        let mut ticks = None;
        if let Some(clock) = self.clock.take().filter(|clock| clock.used > 0) {
            let encoder = encoder(&self.gpu, &mut self.recorded)?;
            encoder.resolve_query_set(&clock.queries, 0..2 * clock.used, &clock.ticks, 0);
            ticks = Some(clock.ticks);
        }
        submit(&self.gpu, &mut self.recorded)?;
        let period = self.gpu.queue().get_timestamp_period().into();
        Ok((FrameTimes { times: self.times, period }, ticks))
    }
}

/// The encoder of what is recorded, begun if there is none.
fn encoder<'a>(
    gpu: &Gpu,
    recorded: &'a mut Option<wgpu::CommandEncoder>,
) -> Result<&'a mut wgpu::CommandEncoder, GpuError> {
    match recorded {
        Some(encoder) => Ok(encoder),
        none => Ok(none.insert(gpu.encoder()?)),
    }
}

/// Submits what is recorded.
fn submit(gpu: &Gpu, recorded: &mut Option<wgpu::CommandEncoder>) -> Result<(), GpuError> {
    if let Some(encoder) = recorded.take() {
        gpu.submit_commands([gpu.finish(encoder)?]);
    }
    Ok(())
}

/// Room for the timestamps of `most` passes.
fn query_set(gpu: &Gpu, most: u32) -> Result<wgpu::QuerySet, GpuError> {
    gpu.create("timestamp queries", u64::from(16 * most), |device| {
        device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("times of passes"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * most,
        })
    })
}

impl FrameTimes {
    /// Names of the passes in order, with the time of each, ms; `ticks` are those that the device has counted.
    #[must_use]
    pub fn read(&self, ticks: &[u64]) -> Vec<(&'static str, f64)> {
        let ms = |end: PassEnd| match end {
            PassEnd::Host(ms) => ms,
            PassEnd::Device(n) => {
                let [begin, end] = [0, 1].map(|k| ticks.get(2 * n as usize + k).copied().unwrap_or_default());
                end.saturating_sub(begin) as f64 * self.period * 1.0e-6
            }
        };
        self.times.iter().map(|&(name, end)| (name, ms(end))).collect()
    }
}
