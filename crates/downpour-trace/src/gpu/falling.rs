//! Drops of a picture on a GPU: those of a list, or those that the device finds in a rain.

use downpour_gpu::{BufferSource, Dispatch, Gpu, GpuError, Readback, ReadbackPool, wgpu};
use downpour_render::gpu::LightingOnGpu;
use downpour_sim::field::{EyeDrop, FallingDrop, RainField};
use downpour_sim::gpu::{
    DropListOnGpu, FieldOnGpu, FieldPass, FieldPipeline, FieldSearch, GpuSimulation, HolesOnGpu,
    ObstaclesOnGpu, StepListPass, StepPicture,
};
use glam::DVec3;
use rayon::prelude::*;

use super::GpuPictureError;
use crate::data::SceneData;

/// Drops of a picture.
#[derive(Debug)]
pub enum PictureDrops<'a> {
    /// These, relative to the scene's origin.
    Listed(&'a [FallingDrop]),
    /// Those of a rain in closed form, which the device finds.
    Field(FieldDrops<'a>),
    /// Those of a rain that the device has stepped, which it lists.
    Stepped(&'a GpuSimulation, StepPicture<'a>),
}

/// Drops of a picture, ready to be found or listed by the device.
#[derive(Debug)]
pub(super) enum FallingPass<'a> {
    Field(Box<FieldPass<'a>>),
    Stepped(StepListPass<'a>),
}

impl FallingPass<'_> {
    pub(super) fn list(&self) -> &DropListOnGpu {
        match self {
            Self::Field(pass) => pass.list(),
            Self::Stepped(pass) => pass.list(),
        }
    }

    /// The dispatches in stages, one after another, with another that also walks through the scene beside the longest.
    pub(super) fn stages_beside<'a>(&'a self, other: Dispatch<'a>) -> Vec<Vec<Dispatch<'a>>> {
        match self {
            Self::Field(pass) => pass.stages_beside(other).into(),
            Self::Stepped(pass) => pass.stages_beside(other).into(),
        }
    }
}

/// A rain in closed form before a picture.
#[derive(Debug)]
pub struct FieldDrops<'a> {
    /// The rain.
    pub field: &'a RainField,
    /// The same on the device ([`PictureRenderer::upload_field`](super::PictureRenderer::upload_field)).
    pub on_gpu: &'a mut FieldOnGpu,
    /// The part of it that the picture shows, in the world.
    pub search: FieldSearch<'a>,
    /// Origin of the scene in the world, m.
    pub origin: DVec3,
}

/// Drops that the device has found for a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundDrops {
    /// The drops that nothing has stopped, in the order of their ids, with their place in [`FieldSearch::known`] if they were known.
    pub drops: Vec<(EyeDrop, Option<u32>)>,
    /// Number of drops that were looked at.
    pub simulated: u64,
}

/// Found drops on their way from the device.
#[derive(Debug)]
pub(super) struct FoundReadback {
    read: Readback,
    /// True if the list itself is not read.
    is_counted: bool,
    places: u32,
    known: u32,
    room: u32,
}

impl FieldDrops<'_> {
    /// Makes ready to find the drops.
    pub(super) fn prepare<'a>(
        &mut self,
        pipeline: &'a FieldPipeline,
        buffers: &impl BufferSource,
        scene: &SceneData,
        lighting: &LightingOnGpu,
    ) -> Result<FieldPass<'a>, GpuPictureError> {
        let [_, nodes, triangles, corners, table, texels] = &lighting.buffers;
        let obstacles = ObstaclesOnGpu {
            nodes,
            triangles,
            holes: Some(HolesOnGpu { corners, table, texels }),
            bounds: scene.bounding_box(),
            origin: self.origin,
        };
        Ok(pipeline.prepare(buffers, (self.field, self.on_gpu), &obstacles, &self.search)?)
    }
}

impl FoundReadback {
    /// Begins to read what a pass has found, or no more than how many drops it has looked at.
    pub(super) fn begin(
        gpu: &Gpu,
        pool: &ReadbackPool,
        list: &DropListOnGpu,
        is_counted: bool,
    ) -> Result<Self, GpuError> {
        let buffers: [&wgpu::Buffer; 2] = [list.counts(), list.drops()];
        let read = pool.begin(gpu, if is_counted { &buffers[..1] } else { &buffers })?;
        Ok(Self { read, is_counted, places: list.places(), known: list.known(), room: list.room() })
    }

    /// Waits for the number of drops that were looked at.
    pub(super) fn simulated(mut self) -> Result<u64, GpuPictureError> {
        self.counts()
    }

    fn counts(&mut self) -> Result<u64, GpuPictureError> {
        self.read.wait()?;
        let counts = self.read.take::<u32>(0)?;
        let [found, simulated, left_out] = [0, 1, 2].map(|k| counts.get(k).copied().unwrap_or_default());
        if found > self.room || left_out > 0 {
            let found = found.max(self.room).saturating_add(left_out);
            return Err(GpuPictureError::NoRoom { found, room: self.room });
        }
        Ok(simulated.into())
    }

    /// Waits for the drops; `distances` of all places become those of the drops that are left.
    pub(super) fn finish(mut self, distances: &mut Vec<f32>) -> Result<FoundDrops, GpuPictureError> {
        let simulated = self.counts()?;
        let drops = if self.is_counted { Vec::new() } else { self.read.take::<EyeDrop>(1)? };
        let mut places: Vec<u32> = (0..self.places.min(drops.len() as u32))
            .filter(|&place| drops[place as usize].diameter > 0.0)
            .collect();
        // The device lists them in any order.
        let key = |&place: &u32| {
            let EyeDrop { id, id_low, diameter, offset, .. } = drops[place as usize];
            // Droplets that rebounded in one step from drops that entered in one step and are alike have one id.
            (id ^ id_low, id_low, diameter.to_bits(), offset.map(f32::to_bits), place)
        };
        places.par_sort_unstable_by_key(key);
        *distances = places.iter().filter_map(|&place| distances.get(place as usize).copied()).collect();
        let known = |place: u32| (place < self.known).then_some(place);
        let drops = places.iter().map(|&place| (drops[place as usize], known(place))).collect();
        Ok(FoundDrops { drops, simulated })
    }
}
