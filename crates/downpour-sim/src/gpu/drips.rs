//! Drops of points that drip on a GPU: those that [`Drips::visible`] lists on the CPU.

use std::sync::Arc;

use downpour_gpu::{BufferSource, ComputeKernel, Gpu, GpuError, wgpu, workgroups_for};
use downpour_shaders::sim::drip::{DRIP_FIND_KERNEL, DRIP_LANES, DRIP_SPLASH_KERNEL};

use super::DropListOnGpu;
use super::list::BoundKernel;
use crate::SimError;
use crate::drips::Drips;
use crate::drips::table::{DripQuery, DripTable};
use crate::field::check_time;
use crate::field::frame::FieldFrame;
use crate::impacts::SplashOptions;
use crate::impacts::splash_frame::SplashFrame;
use crate::view::View;

/// The pipelines of points that drip.
#[derive(Clone, Debug)]
pub struct DripPipeline {
    gpu: Gpu,
    find: ComputeKernel,
    splash: ComputeKernel,
}

/// Points that drip, on the device.
#[derive(Clone, Debug)]
pub struct DripsOnGpu {
    of: Arc<Drips>,
    table: Arc<DripTable>,
    find: ComputeKernel,
    splash: ComputeKernel,
    rows: wgpu::Buffer,
}

/// A search for the drops of points in a picture.
#[derive(Clone, Copy, Debug)]
pub struct DripSearch<'a> {
    /// The points.
    pub drips: &'a DripsOnGpu,
    /// The picture, in the world; where more than `max_drops` might be seen, the nearest are.
    pub view: &'a View,
    /// Least diameter of a drop, pixels.
    pub least_pixels: f64,
    /// Time of the picture, s.
    pub time_s: f64,
    /// Splashes of the drops, which are searched for as well.
    pub splashes: Option<&'a SplashOptions>,
}

impl DripPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self { gpu: gpu.clone(), find: kernel(&DRIP_FIND_KERNEL)?, splash: kernel(&DRIP_SPLASH_KERNEL)? })
    }

    /// Brings points to the device; `None` if none drips or they are not for a device ([`Drips::fits_device`]).
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] for more points than a buffer may hold, or what else the GPU says.
    pub fn upload(&self, drips: &Arc<Drips>) -> Result<Option<DripsOnGpu>, GpuError> {
        let Some(table) = drips.table().filter(|table| !table.rows().is_empty()) else { return Ok(None) };
        let rows = BufferSource::storage(&self.gpu, "points that drip", table.rows())?;
        Ok(Some(DripsOnGpu {
            of: Arc::clone(drips),
            table: Arc::clone(table),
            find: self.find.clone(),
            splash: self.splash.clone(),
            rows,
        }))
    }
}

impl DripsOnGpu {
    /// The points.
    #[must_use]
    pub fn drips(&self) -> &Arc<Drips> {
        &self.of
    }
}

impl<'a> DripSearch<'a> {
    /// The question for the drops of the picture.
    ///
    /// # Errors
    /// As [`Drips::visible`] and [`Drips::splashes`].
    pub(super) fn query(&self) -> Result<DripQuery, SimError> {
        self.view.check()?;
        check_time(self.time_s)?;
        self.splashes.map_or(Ok(()), |splashes| splashes.check(self.view, self.time_s))?;
        Ok(self.drips.table.query(self.view, self.least_pixels, self.time_s, self.splashes))
    }

    /// Makes ready to add the drops and their crowns to a list that has room for them, but for those on the eye's side of a pane.
    pub(super) fn prepare(
        &self,
        buffers: &impl BufferSource,
        query: &DripQuery,
        list: &DropListOnGpu,
        pane: Option<[f32; 4]>,
    ) -> Result<Vec<BoundKernel<'a>>, GpuError> {
        let of_picture = FieldFrame {
            per_diameter: (1.0 / self.view.least_angle(self.least_pixels)) as f32,
            first: list.known(),
            room: list.room(),
            pane: pane.unwrap_or_default(),
            ..FieldFrame::of_view(self.view, self.time_s)
        };
        let of_picture = buffers.uniform("field frame of drips", &of_picture)?;
        let frame = buffers.uniform("drip frame", &query.frame)?;
        let DripsOnGpu { find, splash, rows, .. } = self.drips;
        let bound = [(0, &of_picture), (5, list.drops()), (6, list.counts()), (9, &frame), (10, rows)];
        let groups = workgroups_for(query.frame.points.saturating_mul(DRIP_LANES));
        let mut kernels = vec![(find, find.bind_at(buffers, bound)?, groups)];
        if query.has_crowns {
            let of_splashes = SplashFrame {
                first: list.known(),
                room: list.room(),
                pane: pane.unwrap_or_default(),
                ..SplashFrame::of_picture(self.splashes, self.view)
            };
            let of_splashes = buffers.uniform("splash frame of drips", &of_splashes)?;
            let bound = [(0, &of_splashes), (5, list.drops()), (6, list.counts()), (9, &frame), (10, rows)];
            kernels.push((splash, splash.bind_at(buffers, bound)?, workgroups_for(query.frame.points)));
        }
        Ok(kernels)
    }
}
