//! Mask tracer on a GPU. Texels come from the same formulas as on the CPU; parity tests compare the two.

use downpour_drop::shape::{DropShape, DropShapeCoefficients};
use downpour_gpu::{ComputeKernel, Gpu, GpuError, wgpu};
use downpour_shaders::mask;

use crate::closed_mesh::ClosedMesh;
use crate::model::TracedModel;
use crate::{Mask, MaskError, MaskOptions, MaskTexel};

/// Error of tracing a mask on a GPU.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuMaskError {
    /// The mask options are not valid.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Uniform of the drop kernel. The same layout as `MaskTracedDrop` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct DropUniform {
    /// Texels along an edge.
    pub size: u32,
    /// Width of a texel.
    pub pixel: f32,
    /// 1 / A^2 of the reference spheroid.
    pub inverse_wide: f32,
    /// 1 / B^2 of the reference spheroid.
    pub inverse_tall: f32,
    /// Shape coefficients.
    pub shape: DropShapeCoefficients,
    /// Axis of the drop in the frame of the view.
    pub up: [f32; 3],
    /// Refractive index.
    pub index: f32,
}

/// Uniform of the model kernel. The same layout as `MaskModelParameters` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ModelUniform {
    /// Start of the rays along z, in front of the model.
    pub front: f32,
    /// Refractive index.
    pub index: f32,
    /// Width of a texel.
    pub pixel: f32,
    /// Texels along an edge.
    pub size: u32,
    /// First row of the dispatch.
    pub first_row: u32,
}

/// Pipelines of the tracer: created once, used for any number of masks.
#[derive(Clone, Debug)]
pub struct GpuTracer {
    gpu: Gpu,
    drop: ComputeKernel,
    model: ComputeKernel,
}

/// Rows of a model's mask per dispatch: short enough that the driver's watchdog does not reset the device.
const MODEL_ROWS: u32 = 128;

impl GpuTracer {
    /// Creates the pipelines.
    ///
    /// # Errors
    /// [`GpuError`] of the device.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            gpu: gpu.clone(),
            drop: ComputeKernel::new(gpu, &mask::DROP_KERNEL, &[])?,
            model: ComputeKernel::new(gpu, &mask::MODEL_KERNEL, &[])?,
        })
    }

    /// Traces the mask of a drop, as [`trace_drop`](crate::trace_drop) does on the CPU.
    ///
    /// # Errors
    /// [`GpuMaskError::Mask`] if an option is out of range, else the error of the device.
    pub fn trace_drop(&self, shape: &DropShape, options: &MaskOptions) -> Result<Mask, GpuMaskError> {
        let (mut mask, texels, bindings) = self.bind_drop(shape, options)?;
        let groups = options.size.div_ceil(8);
        self.gpu.submit(&[self.drop.dispatch(&bindings, [groups, groups, 1])])?;
        mask.texels = self.gpu.read(&texels)?;
        Ok(mask)
    }

    /// Measures the time of the device for the mask of a drop, without transfers.
    ///
    /// # Errors
    /// As [`GpuTracer::trace_drop`].
    pub fn time_drop(
        &self,
        shape: &DropShape,
        options: &MaskOptions,
        repeats: u32,
    ) -> Result<downpour_gpu::timing::PassTime, GpuMaskError> {
        let (_, _, bindings) = self.bind_drop(shape, options)?;
        let groups = options.size.div_ceil(8);
        Ok(self.gpu.time(&[self.drop.dispatch(&bindings, [groups, groups, 1])], repeats)?)
    }

    /// Traces the mask of a drop model, as [`trace_model`](crate::trace_model) does on the CPU.
    ///
    /// # Errors
    /// As [`GpuTracer::trace_drop`].
    pub fn trace_model(
        &self,
        mesh: &ClosedMesh,
        options: &MaskOptions,
        diameter: Option<f64>,
    ) -> Result<Mask, GpuMaskError> {
        let model = TracedModel::new(mesh, options)?;
        let mut mask = crate::model::empty(mesh, options, diameter, &model);
        let texels = self.texel_buffer(options)?;
        let nodes = self.gpu.storage_buffer("bvh nodes", &model.bvh.nodes)?;
        let triangles = self.gpu.storage_buffer("bvh triangles", &model.bvh.triangles)?;
        let normals: Vec<[f32; 4]> =
            model.normals.iter().flatten().map(|&[x, y, z]| [x, y, z, 0.0]).collect();
        let normals = self.gpu.storage_buffer("normals", &normals)?;
        for first_row in (0..options.size).step_by(MODEL_ROWS as usize) {
            let uniform = ModelUniform {
                front: model.front,
                index: model.index,
                pixel: mask.texel_width() as f32,
                size: options.size,
                first_row,
            };
            let uniform = self.gpu.uniform_buffer("mask model", &uniform)?;
            let bindings = self.model.bind(&self.gpu, &[&uniform, &nodes, &triangles, &normals, &texels])?;
            let groups = [options.size.div_ceil(8), MODEL_ROWS.min(options.size - first_row).div_ceil(8), 1];
            self.gpu.submit(&[self.model.dispatch(&bindings, groups)])?;
        }
        mask.texels = self.gpu.read(&texels)?;
        Ok(mask)
    }

    /// Empty mask of a drop, buffer of its texels, and bindings of the kernel.
    fn bind_drop(
        &self,
        shape: &DropShape,
        options: &MaskOptions,
    ) -> Result<(Mask, wgpu::Buffer, wgpu::BindGroup), GpuMaskError> {
        let (traced, mask) = crate::drop::prepare(shape, options)?;
        let texels = self.texel_buffer(options)?;
        let uniform = DropUniform {
            shape: shape.gpu_coefficients(),
            up: traced.up.map(|c| c as f32),
            index: traced.index as f32,
            inverse_wide: traced.inverse_wide as f32,
            inverse_tall: traced.inverse_tall as f32,
            pixel: mask.texel_width() as f32,
            size: options.size,
        };
        let uniform = self.gpu.uniform_buffer("mask drop", &uniform)?;
        let bindings = self.drop.bind(&self.gpu, &[&uniform, &texels])?;
        Ok((mask, texels, bindings))
    }

    fn texel_buffer(&self, options: &MaskOptions) -> Result<wgpu::Buffer, GpuMaskError> {
        options.check()?;
        let texels = u64::from(options.size) * u64::from(options.size);
        let bytes = texels * size_of::<MaskTexel>() as u64;
        Ok(self.gpu.empty_buffer("mask texels", bytes, wgpu::BufferUsages::STORAGE)?)
    }
}
