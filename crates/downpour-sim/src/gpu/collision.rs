//! Collision map on a GPU.

use downpour_gpu::{ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::sim::collision::COLLISION_MAP_KERNEL;

use crate::collision::{CollisionFrame, CollisionMap, CollisionTexel};

/// A collision map on the device: [`CollisionMapOnGpu::frame`] and [`CollisionMapOnGpu::texels`] are bindings 8 and 9 of kernels
/// that use `downpour_shaders::sim::collision::COLLISION`.
#[derive(Clone, Debug)]
pub struct CollisionMapOnGpu {
    size: [u32; 2],
    frame: wgpu::Buffer,
    texels: wgpu::Buffer,
}

impl CollisionMapOnGpu {
    /// Creates the buffers of a map with so many texels across and along.
    fn empty(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let bytes = u64::from(size[0]) * u64::from(size[1]) * size_of::<CollisionTexel>() as u64;
        let frame_bytes = size_of::<CollisionFrame>() as u64;
        Ok(Self {
            size,
            frame: gpu.empty_buffer("collision frame", frame_bytes, wgpu::BufferUsages::UNIFORM)?,
            texels: gpu.empty_buffer("collision texels", bytes, wgpu::BufferUsages::STORAGE)?,
        })
    }

    /// Uploads a map that was made on the CPU.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the texels, 32 bytes each, do not fit into a binding; errors of the GPU.
    pub fn upload(gpu: &Gpu, map: &CollisionMap) -> Result<Self, GpuError> {
        let made = Self::empty(gpu, map.frame().size)?;
        made.set(gpu, map)?;
        Ok(made)
    }

    /// Writes another map of the same number of texels, before the next submission.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the map has another number of texels.
    pub fn set(&self, gpu: &Gpu, map: &CollisionMap) -> Result<(), GpuError> {
        self.set_frame(gpu, map.frame())?;
        gpu.queue().write_buffer(&self.texels, 0, bytemuck::cast_slice(map.texels()));
        Ok(())
    }

    /// Writes the position of the map, before the next submission.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the map has another number of texels.
    pub fn set_frame(&self, gpu: &Gpu, frame: &CollisionFrame) -> Result<(), GpuError> {
        if frame.size != self.size {
            let ([found_x, found_y], [x, y]) = (frame.size, self.size);
            return Err(GpuError::Refused {
                what: "the frame of a collision map".to_owned(),
                reason: format!("it is of {found_x} x {found_y} texels, the map of {x} x {y}"),
            });
        }
        gpu.queue().write_buffer(&self.frame, 0, bytemuck::bytes_of(frame));
        Ok(())
    }

    /// Texels across and along.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Uniform buffer: binding 8.
    #[must_use]
    pub fn frame(&self) -> &wgpu::Buffer {
        &self.frame
    }

    /// Texel buffer: binding 9.
    #[must_use]
    pub fn texels(&self) -> &wgpu::Buffer {
        &self.texels
    }

    /// Waits, and reads the texels back.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<CollisionTexel>, GpuError> {
        gpu.read(&self.texels)
    }
}

/// A collision map that the device makes. Its buffers are created once for a size, and filled for each frame from an
/// existing hierarchy of triangles.
#[derive(Clone, Debug)]
pub struct GpuCollisionMap {
    kernel: ComputeKernel,
    map: CollisionMapOnGpu,
}

impl GpuCollisionMap {
    /// Creates the pipeline, and the buffers of a map with so many texels across and along.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the texels, 32 bytes each, do not fit into a binding; errors of the GPU.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let kernel = ComputeKernel::new(gpu, &COLLISION_MAP_KERNEL, &[])?;
        Ok(Self { kernel, map: CollisionMapOnGpu::empty(gpu, size)? })
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &CollisionMapOnGpu {
        &self.map
    }

    /// Makes the map of a frame. `nodes` and `triangles` hold those of a `downpour_bvh::Bvh`, of the scene that
    /// `frame` was made for. Does not wait.
    ///
    /// # Errors
    /// As [`CollisionMapOnGpu::set_frame`] and [`GpuCollisionMap::bind`].
    pub fn update(
        &self,
        gpu: &Gpu,
        frame: &CollisionFrame,
        nodes: &wgpu::Buffer,
        triangles: &wgpu::Buffer,
    ) -> Result<(), GpuError> {
        self.map.set_frame(gpu, frame)?;
        let bindings = self.bind(gpu, nodes, triangles)?;
        gpu.submit(&[self.dispatch(&bindings)])
    }

    /// Bindings of the kernel. They are valid as long as the buffers of the hierarchy are the same.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn bind(
        &self,
        gpu: &Gpu,
        nodes: &wgpu::Buffer,
        triangles: &wgpu::Buffer,
    ) -> Result<wgpu::BindGroup, GpuError> {
        self.kernel.bind(gpu, &[&self.map.frame, nodes, triangles, &self.map.texels])
    }

    /// Dispatch that makes the map, as a part of a longer list of work.
    #[must_use]
    pub fn dispatch<'a>(&'a self, bindings: &'a wgpu::BindGroup) -> Dispatch<'a> {
        let [x, y] = self.map.size.map(|n| n.div_ceil(8));
        self.kernel.dispatch(bindings, [x, y, 1])
    }
}
