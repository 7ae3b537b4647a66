//! Drops of a picture on a GPU: those of a list, or those that the device finds in a rain.

use std::ops::Range;

use downpour_gpu::{BufferSource, Dispatch, Readback, wgpu};
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

/// The list of a picture's drops on the device, which is read with the picture.
#[derive(Debug)]
pub(super) struct FoundList {
    counts: wgpu::Buffer,
    /// `None` if they are only counted.
    drops: Option<wgpu::Buffer>,
    places: u32,
    known: u32,
    room: u32,
}

impl<'a> FieldDrops<'a> {
    /// Makes ready to find the drops.
    pub(super) fn prepare(
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

impl FoundList {
    /// The list of a pass. `is_counted`: no more is asked than how many drops were looked at.
    pub(super) fn new(list: &DropListOnGpu, is_counted: bool) -> Self {
        let drops = (!is_counted).then(|| list.drops().clone());
        let counts = list.counts().clone();
        Self { counts, drops, places: list.places(), known: list.known(), room: list.room() }
    }

    /// From now on no more is asked than how many drops were looked at.
    pub(super) fn count_only(&mut self) {
        self.drops = None;
    }

    /// How many there are.
    pub(super) fn counts(&self) -> &wgpu::Buffer {
        &self.counts
    }

    /// Parts of buffers that are read of it.
    pub(super) fn parts(&self) -> impl Iterator<Item = (&wgpu::Buffer, Range<u64>)> {
        let places = u64::from(self.places.max(1)) * size_of::<EyeDrop>() as u64;
        let drops = self.drops.iter().map(move |drops| (drops, 0..places));
        std::iter::once((&self.counts, 0..DropListOnGpu::COUNTS_BYTES)).chain(drops)
    }

    /// The number of drops that were looked at, from the readback whose part `first` is its first.
    pub(super) fn simulated(&self, read: &mut Readback, first: usize) -> Result<u64, GpuPictureError> {
        let counts = read.take::<u32>(first)?;
        let [found, simulated, left_out] = [0, 1, 2].map(|k| counts.get(k).copied().unwrap_or_default());
        if found > self.room || left_out > 0 {
            let found = found.max(self.room).saturating_add(left_out);
            return Err(GpuPictureError::NoRoom { found, room: self.room });
        }
        Ok(simulated.into())
    }

    /// The drops, from the readback whose part `first` is its first; `distances` of all places become those of the drops that are left.
    pub(super) fn finish(
        self,
        read: &mut Readback,
        first: usize,
        distances: &mut Vec<f32>,
    ) -> Result<FoundDrops, GpuPictureError> {
        let simulated = self.simulated(read, first)?;
        let drops = if self.drops.is_some() { read.take::<EyeDrop>(first + 1)? } else { Vec::new() };
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
