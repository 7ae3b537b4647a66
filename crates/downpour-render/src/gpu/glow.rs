//! Glow on a GPU: what [`Picture::add_glow`](crate::picture::Picture::add_glow) makes on the CPU.

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::glow::{
    GLOW_ADD_KERNEL, GLOW_COARSE_KERNEL, GLOW_COARSE_STEPS, GLOW_DOWN_KERNEL, GLOW_KAWASE_KERNEL,
    GLOW_TAKE_KERNEL, GLOW_UP_KERNEL,
};

use crate::camera::Camera;
use crate::glow::{Glow, GlowCoarse, GlowLevel, GlowPlan, GlowStep};

/// Texels of a level that is coarse: few enough for one workgroup.
const COARSE_TEXELS: u32 = 2048;

/// Pipelines of glow: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct GlowPipeline {
    take: ComputeKernel,
    down: ComputeKernel,
    up: ComputeKernel,
    coarse: ComputeKernel,
    kawase: ComputeKernel,
    add: ComputeKernel,
}

/// The glow of a picture, ready to be made.
#[derive(Debug)]
pub struct GlowPass<'a> {
    steps: Vec<(&'a ComputeKernel, wgpu::BindGroup, [u32; 3])>,
    target: wgpu::Buffer,
}

impl GlowPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self {
            take: kernel(&GLOW_TAKE_KERNEL)?,
            down: kernel(&GLOW_DOWN_KERNEL)?,
            up: kernel(&GLOW_UP_KERNEL)?,
            coarse: kernel(&GLOW_COARSE_KERNEL)?,
            kawase: kernel(&GLOW_KAWASE_KERNEL)?,
            add: kernel(&GLOW_ADD_KERNEL)?,
        })
    }

    fn kernel(&self, step: GlowStep) -> &ComputeKernel {
        match step {
            GlowStep::Take => &self.take,
            GlowStep::Down => &self.down,
            GlowStep::Up => &self.up,
            GlowStep::Kawase => &self.kawase,
            GlowStep::Add => &self.add,
        }
    }

    /// Makes ready to make the glow of a plate (radiance and distance of each pixel) behind rain (radiance and transmittance); `None` if nothing
    /// glows.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the picture is larger than the device takes, or what else the GPU says.
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        glow: &Glow,
        camera: &Camera,
        plate: &wgpu::Buffer,
        rain: &wgpu::Buffer,
    ) -> Result<Option<GlowPass<'_>>, GpuError> {
        let size = camera.size();
        let plan = GlowPlan::new(glow, size, camera.pixel_angle);
        if plan.steps.is_empty() {
            return Ok(None);
        }
        let texels =
            buffers.buffer("levels of the glow", 16 * plan.texels as u64, wgpu::BufferUsages::STORAGE)?;
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let target = buffers.buffer("glow", 16 * pixels, wgpu::BufferUsages::STORAGE)?;
        let is_coarse = |(step, level): &(GlowStep, GlowLevel)| {
            matches!(step, GlowStep::Down | GlowStep::Up)
                && level.size.iter().product::<u32>() <= COARSE_TEXELS
        };
        let runs = plan.steps.chunk_by(|a, b| is_coarse(a) && is_coarse(b));
        let one = |(step, level): &(GlowStep, GlowLevel)| {
            let uniform = buffers.uniform("level of the glow", level)?;
            let both = [(0, &uniform), (1, &texels)];
            let kernel = self.kernel(*step);
            let bound = match step {
                GlowStep::Take => {
                    kernel.bind_at(buffers, both.into_iter().chain([(2, plate), (3, rain), (4, &target)]))?
                }
                GlowStep::Add => kernel.bind_at(buffers, both.into_iter().chain([(4, &target)]))?,
                _ => kernel.bind_at(buffers, both)?,
            };
            let [columns, rows] = if *step == GlowStep::Down { level.coarse } else { level.size };
            Ok::<_, GpuError>((kernel, bound, [columns.div_ceil(8), rows.div_ceil(8), 1]))
        };
        let mut steps = Vec::new();
        for run in runs {
            if !is_coarse(&run[0]) {
                steps.push(one(&run[0])?);
                continue;
            }
            for run in run.chunks(GLOW_COARSE_STEPS as usize) {
                let uniform = buffers.uniform("coarse levels of the glow", &coarse(run))?;
                let bound = self.coarse.bind_at(buffers, [(1, &texels), (5, &uniform)])?;
                steps.push((&self.coarse, bound, [1; 3]));
            }
        }
        Ok(Some(GlowPass { steps, target }))
    }
}

/// Uniforms of some steps between coarse levels.
fn coarse(steps: &[(GlowStep, GlowLevel)]) -> GlowCoarse {
    let mut all = GlowCoarse { count: steps.len() as u32, ..GlowCoarse::default() };
    for (to, (step, level)) in all.levels.iter_mut().zip(steps) {
        *to = GlowLevel { offset: u32::from(*step == GlowStep::Up), ..*level };
    }
    all
}

impl GlowPass<'_> {
    /// The dispatches, in this order.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        self.steps.iter().map(|(kernel, bound, groups)| kernel.dispatch(bound, *groups)).collect()
    }

    /// Radiance that glow adds to each pixel, in four numbers.
    #[must_use]
    pub fn target(&self) -> &wgpu::Buffer {
        &self.target
    }
}
