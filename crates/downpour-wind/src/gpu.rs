//! Wind field on a GPU: the cells in a buffer that other kernels read.

use downpour_gpu::{ComputeKernel, Gpu, GpuError, wgpu};
use downpour_shaders::wind::{FIELD_KERNEL, FIELD_SPREAD_CLEAR_KERNEL, FIELD_SPREAD_KERNEL};
use glam::{DVec3, Vec3, Vec4};

use crate::design::WindPrimitive;
use crate::error::WindError;
use crate::field::{WindFieldGrid, wind_field_locate};
use crate::field_spread::{WindFieldSpreadFrame, wind_field_spread_bounds};
use crate::grid::WindGrid;
use crate::mask::WindMask;
use crate::matrix::WindMatrix;
use crate::turbulence::WindTurbulenceMode;

/// Error of a wind field on a GPU.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuWindError {
    /// The wind is not valid.
    #[error(transparent)]
    Wind(#[from] WindError),
    /// There are more matrices or modes than the capacity.
    #[error("{found} {what}; allowed: up to {allowed}, the capacity of the field")]
    Capacity {
        /// Matrices, or modes of turbulence.
        what: &'static str,
        /// Number found.
        found: usize,
        /// Capacity.
        allowed: usize,
    },
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Wind over a grid, filled by the kernel `main_wind_field`: [`WindField`](crate::WindField) on a GPU.
#[derive(Debug)]
pub struct GpuWindField {
    gpu: Gpu,
    kernel: ComputeKernel,
    grid: WindGrid,
    matrices: usize,
    modes: usize,
    uniform: wgpu::Buffer,
    matrix_buffer: wgpu::Buffer,
    openness: wgpu::Buffer,
    mode_buffer: wgpu::Buffer,
    cells: wgpu::Buffer,
    bindings: wgpu::BindGroup,
    spread: SpreadOnGpu,
}

/// The kernels that say how much the wind differs about a position, and their bindings.
#[derive(Debug)]
struct SpreadOnGpu {
    clear: (ComputeKernel, wgpu::BindGroup),
    find: (ComputeKernel, wgpu::BindGroup),
    frame: wgpu::Buffer,
    found: wgpu::Buffer,
}

impl SpreadOnGpu {
    fn new(gpu: &Gpu, cells: &wgpu::Buffer) -> Result<Self, GpuError> {
        let bytes = size_of::<WindFieldSpreadFrame>() as u64;
        let frame = gpu.empty_buffer("spread of wind", bytes, wgpu::BufferUsages::UNIFORM)?;
        let found = gpu.storage_buffer("found spread of wind", &[0u32; 8])?;
        let made = |kernel| {
            let kernel = ComputeKernel::new(gpu, kernel, &[])?;
            let bindings = kernel.bind_at(gpu, [(3, cells), (5, &frame), (6, &found)])?;
            Ok::<_, GpuError>((kernel, bindings))
        };
        let (clear, find) = (made(&FIELD_SPREAD_CLEAR_KERNEL)?, made(&FIELD_SPREAD_KERNEL)?);
        Ok(Self { clear, find, frame, found })
    }
}

/// Wind about a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindAbout {
    /// Wind at the position, m/s.
    pub wind: Vec3,
    /// Bounds as those of [`WindField::spread`](crate::WindField::spread): 1/s and m/s.
    pub spread: [f32; 2],
}

impl GpuWindField {
    /// Creates a field without wind, with a capacity of matrices (four for a tornado, one for each other primitive) and
    /// turbulence modes.
    ///
    /// # Errors
    /// Errors of the GPU; [`GpuError::OverLimit`] if a buffer is larger than the device allows.
    pub fn new(gpu: &Gpu, grid: &WindGrid, matrices: usize, modes: usize) -> Result<Self, GpuWindError> {
        let kernel = ComputeKernel::new(gpu, &FIELD_KERNEL, &[])?;
        // A buffer of the shader has at least one element.
        let (matrices, modes) = (matrices.max(1), modes.max(1));
        let storage = |label: &str, count: usize, size: usize| {
            let bytes = (count as u64).saturating_mul(size as u64);
            gpu.empty_buffer(label, bytes, wgpu::BufferUsages::STORAGE)
        };
        let uniform = gpu.uniform_buffer("wind grid", &WindFieldGrid::new(grid, 0, 0))?;
        let matrix_buffer = storage("wind primitives", matrices, size_of::<[[f32; 4]; 3]>())?;
        let openness = gpu.storage_buffer("wind openness", WindMask::open(grid).openness())?;
        let cells = storage("wind cells", grid.cells(), size_of::<[f32; 4]>())?;
        let mode_buffer = storage("wind turbulence", modes, size_of::<WindTurbulenceMode>())?;
        let bindings = kernel.bind(gpu, &[&uniform, &matrix_buffer, &openness, &cells, &mode_buffer])?;
        Ok(Self {
            spread: SpreadOnGpu::new(gpu, &cells)?,
            gpu: gpu.clone(),
            kernel,
            grid: *grid,
            matrices,
            modes,
            uniform,
            matrix_buffer,
            openness,
            mode_buffer,
            cells,
            bindings,
        })
    }

    /// Sets the objects; [`update`](Self::update) uses them from then on.
    ///
    /// # Errors
    /// [`WindError::MaskSize`] if the mask does not match the grid.
    pub fn set_mask(&self, mask: &WindMask) -> Result<(), GpuWindError> {
        mask.check(&self.grid)?;
        self.gpu.queue().write_buffer(&self.openness, 0, bytemuck::cast_slice(mask.openness()));
        Ok(())
    }

    /// True if the field has room for the cells of a grid and for so many matrices and turbulence modes.
    #[must_use]
    pub fn has_room(&self, grid: &WindGrid, matrices: usize, modes: usize) -> bool {
        grid.size() == self.grid.size() && matrices <= self.matrices && modes <= self.modes
    }

    /// Moves the box; [`update`](Self::update) fills it from then on.
    ///
    /// # Errors
    /// [`WindError::MaskSize`] if the grid has another number of cells.
    pub fn set_grid(&mut self, grid: &WindGrid) -> Result<(), GpuWindError> {
        if grid.size() != self.grid.size() {
            return Err(WindError::MaskSize { found: grid.cells(), allowed: self.grid.cells() }.into());
        }
        self.grid = *grid;
        Ok(())
    }

    /// Fills the cells: submits the kernel without waiting.
    ///
    /// # Errors
    /// As [`WindMatrix::encode`]; [`GpuWindError::Capacity`]; errors of the GPU.
    pub fn update(
        &self,
        primitives: &[WindPrimitive],
        modes: &[WindTurbulenceMode],
    ) -> Result<(), GpuWindError> {
        self.prepare(primitives, modes)?;
        Ok(self.gpu.submit(&[self.kernel.dispatch(&self.bindings, self.groups())])?)
    }

    /// Time of the device to fill the cells, without transfers.
    ///
    /// # Errors
    /// As [`GpuWindField::update`].
    pub fn time(
        &self,
        primitives: &[WindPrimitive],
        modes: &[WindTurbulenceMode],
        repeats: u32,
    ) -> Result<downpour_gpu::timing::PassTime, GpuWindError> {
        self.prepare(primitives, modes)?;
        Ok(self.gpu.time(&[self.kernel.dispatch(&self.bindings, self.groups())], repeats)?)
    }

    /// Grid for positions relative to `origin`, m, as [`WindField::relative_to`](crate::WindField::relative_to) has it.
    #[must_use]
    pub fn grid_relative_to(&self, origin: DVec3) -> WindFieldGrid {
        let low = (self.grid.low().as_dvec3() - origin).as_vec3().to_array();
        WindFieldGrid { low, ..WindFieldGrid::new(&self.grid, 0, 0) }
    }

    /// The wind at a position relative to `origin`, m, and how much it differs within `reach` meters. Waits for the device.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn about(&self, origin: DVec3, at: Vec3, reach: f32) -> Result<WindAbout, GpuError> {
        let grid = self.grid_relative_to(origin);
        let frame = WindFieldSpreadFrame { grid, at: at.to_array(), reach };
        let SpreadOnGpu { clear, find, frame: uniform, found } = &self.spread;
        self.gpu.queue().write_buffer(uniform, 0, bytemuck::bytes_of(&frame));
        let [low, high] = [-reach, reach].map(|way| wind_field_locate(&grid, at + Vec3::splat(way)));
        let cells = (high.next - low.cell + 1).to_array();
        let find = find.0.dispatch(&find.1, cells.map(|n| n.div_ceil(4)));
        self.gpu.submit(&[clear.0.dispatch(&clear.1, [1; 3]), find])?;
        let found = self.gpu.read::<f32>(found)?;
        let of = |first: usize| found.get(first..first + 4).map_or(Vec4::ZERO, Vec4::from_slice);
        Ok(WindAbout { wind: of(4).truncate(), spread: wind_field_spread_bounds(of(0)) })
    }

    /// Velocity, m/s, and openness of each cell as `vec4f`, in the order of the grid.
    #[must_use]
    pub fn cells(&self) -> &wgpu::Buffer {
        &self.cells
    }

    /// Uniform `WindFieldGrid` with which a kernel looks up the cells.
    #[must_use]
    pub fn uniform(&self) -> &wgpu::Buffer {
        &self.uniform
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &WindGrid {
        &self.grid
    }

    fn groups(&self) -> [u32; 3] {
        self.grid.size().map(|n| n.div_ceil(4))
    }

    fn prepare(
        &self,
        primitives: &[WindPrimitive],
        modes: &[WindTurbulenceMode],
    ) -> Result<(), GpuWindError> {
        let matrices = WindMatrix::encode(primitives)?;
        for (what, found, allowed) in [
            ("matrices of primitives", matrices.len(), self.matrices),
            ("waves of turbulence", modes.len(), self.modes),
        ] {
            if found > allowed {
                return Err(GpuWindError::Capacity { what, found, allowed });
            }
        }
        let uniform = WindFieldGrid::new(&self.grid, matrices.len() as u32, modes.len() as u32);
        let matrices: Vec<[[f32; 4]; 3]> = matrices.iter().map(WindMatrix::padded).collect();
        let queue = self.gpu.queue();
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        queue.write_buffer(&self.matrix_buffer, 0, bytemuck::cast_slice(&matrices));
        queue.write_buffer(&self.mode_buffer, 0, bytemuck::cast_slice(modes));
        Ok(())
    }
}
