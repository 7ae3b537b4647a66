//! The atlas on a GPU.

use bytemuck::{Pod, Zeroable};
use downpour_gpu::{ComputeKernel, Gpu, GpuError, wgpu};
use downpour_shaders::atlas;

use crate::StreakAtlas;

/// A point of a particle's streak: the WGSL struct of the same name, 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AtlasQuery {
    /// From the drop to its light, a unit vector.
    pub light: [f32; 3],
    /// Equivalent diameter in meters.
    pub diameter: f32,
    /// From the drop to its viewer, a unit vector.
    pub view: [f32; 3],
    /// Of the particle.
    pub id: u32,
    /// The drop's axis upwards, a unit vector.
    pub axis: [f32; 3],
    /// Equivalent radii to the right of the middle.
    pub across: f32,
    /// Turns of the mode (2,0) along.
    pub turns: f32,
    /// Not used.
    pub unused: [u32; 3],
}

/// The buffers of an atlas, in the order of the bindings of `atlas/data.wgsl`.
#[derive(Clone, Debug)]
pub struct GpuAtlas {
    /// [`AtlasFrame`](crate::lookup::AtlasFrame), a uniform.
    pub frame: wgpu::Buffer,
    /// [`AtlasTriangle`](crate::lookup::AtlasTriangle)s.
    pub triangles: wgpu::Buffer,
    /// Patterns, two half floats per word.
    pub texels: wgpu::Buffer,
    /// Amounts.
    pub amounts: wgpu::Buffer,
}

impl GpuAtlas {
    /// Hands an atlas over.
    ///
    /// # Errors
    /// [`GpuError`] of the device.
    pub fn new(gpu: &Gpu, atlas: &StreakAtlas) -> Result<Self, GpuError> {
        let data = atlas.data();
        Ok(Self {
            frame: gpu.uniform_buffer("atlas frame", data.frame)?,
            triangles: gpu.storage_buffer("atlas triangles", data.triangles)?,
            texels: gpu.storage_buffer("atlas texels", data.texels)?,
            amounts: gpu.storage_buffer("atlas amounts", data.amounts)?,
        })
    }

    /// Radiances of points of streaks, as [`StreakAtlas::slot`] and [`StreakAtlas::radiance`] return them.
    ///
    /// # Errors
    /// [`GpuError`] of the device.
    pub fn query(&self, gpu: &Gpu, queries: &[AtlasQuery]) -> Result<Vec<f32>, GpuError> {
        let kernel = ComputeKernel::new(gpu, &atlas::ATLAS_QUERY_KERNEL, &[])?;
        let asked = gpu.storage_buffer("atlas queries", queries)?;
        let answers = gpu.storage_buffer("atlas radiances", &vec![f32::NAN; queries.len()])?;
        let Self { frame, triangles, texels, amounts } = self;
        let bindings = kernel.bind(gpu, &[frame, triangles, texels, amounts, &asked, &answers])?;
        gpu.submit(&[kernel.dispatch(&bindings, [(queries.len() as u32).div_ceil(64), 1, 1])])?;
        gpu.read(&answers)
    }
}
