//! Timing of GPU work.
//!
//! Timestamps enclose a whole pass that repeats its dispatches: single dispatches are shorter than the barriers
//! between them. Timestamps of software drivers are meaningless; measure those by wall clock.

use std::time::{Duration, Instant};

use crate::{Dispatch, Gpu, GpuError};

/// Time of one repetition of some dispatches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTime {
    /// Time by the device's clock, if it has one.
    pub device: Option<Duration>,
    /// Time by the host's clock from submission until the device is idle, including the submission.
    pub wall: Duration,
}

impl Gpu {
    /// Runs the dispatches `repeats` times in one pass and returns the mean time of one repetition.
    ///
    /// # Errors
    /// As [`Gpu::submit`] and [`Gpu::wait`].
    pub fn time(&self, dispatches: &[Dispatch<'_>], repeats: u32) -> Result<PassTime, GpuError> {
        for dispatch in dispatches {
            dispatch.check(&self.device().limits())?;
        }
        let repeats = repeats.max(1);
        let queries = if self.adapter().timestamps {
            let set = self.create("timestamp queries", 16, |device| {
                device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("pass time"),
                    ty: wgpu::QueryType::Timestamp,
                    count: 2,
                })
            })?;
            let usage = wgpu::BufferUsages::QUERY_RESOLVE;
            Some((set, self.empty_buffer("timestamps", 16, usage)?))
        } else {
            None
        };
        let commands = self.create("a timed command buffer", 0, |device| {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some("timed"),
                    timestamp_writes: queries.as_ref().map(|(set, _)| wgpu::ComputePassTimestampWrites {
                        query_set: set,
                        beginning_of_pass_write_index: Some(0),
                        end_of_pass_write_index: Some(1),
                    }),
                });
                for _ in 0..repeats {
                    for dispatch in dispatches {
                        dispatch.encode_in(&mut pass);
                    }
                }
            }
            if let Some((set, buffer)) = &queries {
                encoder.resolve_query_set(set, 0..2, buffer, 0);
            }
            encoder.finish()
        })?;
        self.wait()?;
        let start = Instant::now();
        self.submit_commands([commands]);
        self.wait()?;
        let wall = start.elapsed() / repeats;
        let device = match &queries {
            Some((_, buffer)) => {
                let ticks = self.read::<u64>(buffer)?;
                let period = f64::from(self.queue().get_timestamp_period());
                let nanoseconds = ticks[1].saturating_sub(ticks[0]) as f64 * period / f64::from(repeats);
                Some(Duration::from_nanos(nanoseconds as u64))
            }
            None => None,
        };
        Ok(PassTime { device, wall })
    }
}
