//! Kernels that run one after the other on buffers that they share.

use downpour_shaders::Kernel;

use crate::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError};

/// Kernels that run one after the other on buffers that they share.
#[derive(Clone, Debug)]
pub struct KernelSequence {
    /// Each kernel with the numbers of its bindings.
    steps: Vec<(ComputeKernel, &'static [u32])>,
}

/// A sequence with its buffers and its numbers of workgroups.
#[derive(Debug)]
pub struct SequencePass<'a> {
    sequence: &'a KernelSequence,
    bound: Vec<(wgpu::BindGroup, [u32; 3])>,
}

impl KernelSequence {
    /// Creates the pipelines of kernels, each with the numbers of its bindings.
    ///
    /// # Errors
    /// As [`ComputeKernel::new`].
    pub fn new(gpu: &Gpu, steps: &[(&Kernel, &'static [u32])]) -> Result<Self, GpuError> {
        let step = |&(kernel, bindings): &(&Kernel, _)| Ok((ComputeKernel::new(gpu, kernel, &[])?, bindings));
        Ok(Self { steps: steps.iter().map(step).collect::<Result<_, GpuError>>()? })
    }

    /// Binds buffers: the k-th is binding k of each kernel that has it. `groups`: workgroups of each kernel.
    ///
    /// # Errors
    /// As [`ComputeKernel::bind`].
    pub fn bind(
        &self,
        source: &impl BufferSource,
        buffers: &[&wgpu::Buffer],
        groups: &[[u32; 3]],
    ) -> Result<SequencePass<'_>, GpuError> {
        let bind = |((kernel, bindings), &groups): (&(ComputeKernel, &[u32]), &[u32; 3])| {
            let bound = bindings.iter().map(|&k| (k, buffers[k as usize]));
            Ok((kernel.bind_at(source, bound)?, groups))
        };
        let bound = self.steps.iter().zip(groups).map(bind).collect::<Result<_, GpuError>>()?;
        Ok(SequencePass { sequence: self, bound })
    }
}

impl SequencePass<'_> {
    /// The dispatches, in this order.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        let steps = self.sequence.steps.iter().zip(&self.bound);
        steps.map(|((kernel, _), (bound, groups))| kernel.dispatch(bound, *groups)).collect()
    }
}
