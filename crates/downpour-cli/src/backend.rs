//! Compute backend: a GPU, a software driver of a GPU, or the CPU.

use clap::{Args, ValueEnum};

use crate::failure::Failure;

/// Allowed compute backends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    /// A GPU, else the CPU; a software driver only if `--adapter` names it.
    Auto,
    /// A GPU or its software driver.
    Gpu,
    /// The CPU.
    Cpu,
}

/// Arguments of the backend.
#[derive(Debug, Args)]
pub(crate) struct BackendArguments {
    /// Compute backend.
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) backend: Backend,
    /// Part of the name of the GPU to take, as `downpour adapters` lists them.
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

impl BackendArguments {
    /// Checks that the arguments are consistent.
    ///
    /// # Errors
    /// Exit code 2 for an adapter of the CPU.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        if self.backend == Backend::Cpu && self.adapter.is_some() {
            let message = "--adapter names a GPU; allowed: with --backend gpu or auto";
            return Err(Failure::new(crate::failure::INPUT, message));
        }
        Ok(())
    }
}

impl BackendArguments {
    /// Opens the device that draws frames, and prints its name.
    ///
    /// # Errors
    /// Exit code 4 if a GPU was requested and there is none.
    #[cfg(not(feature = "gpu"))]
    pub(crate) fn device(&self, say: impl Fn(&str)) -> Result<downpour::Device, Failure> {
        compute(self, say, || Ok(downpour::Device::cpu()))
    }
}

/// Failure of a renderer.
#[cfg(not(feature = "gpu"))]
pub(crate) fn renderer_failure(error: downpour::RendererError, _: &crate::interrupt::Interrupt) -> Failure {
    error.into()
}

/// There is no GPU in this build.
#[cfg(not(feature = "gpu"))]
pub(crate) fn no_support() -> Failure {
    let message =
        "this build of downpour has no GPU support; build it with the feature `gpu`, or use --backend cpu";
    Failure::new(crate::exit_code::GPU, message)
}

/// Computes on the CPU: the only backend of this build.
///
/// # Errors
/// Exit code 4 if a GPU was requested, or the error of the work.
#[cfg(not(feature = "gpu"))]
pub(crate) fn compute<T>(
    arguments: &BackendArguments,
    say: impl Fn(&str),
    on_cpu: impl FnOnce() -> Result<T, Failure>,
) -> Result<T, Failure> {
    match arguments.backend {
        Backend::Gpu => return Err(no_support()),
        Backend::Auto => say("backend: cpu (this build has no GPU support)"),
        Backend::Cpu => {}
    }
    on_cpu()
}

#[cfg(feature = "gpu")]
pub(crate) use gpu::{FromGpu, compute, renderer_failure};

#[cfg(feature = "gpu")]
mod gpu {
    use std::time::Duration;

    use downpour::gpu::{AdapterChoice, Gpu, GpuError, GpuOptions};
    use downpour::mask::gpu::GpuMaskError;
    use downpour::specimen::gpu::GpuSpecimenError;

    use super::{Backend, BackendArguments};
    use crate::exit_code::ExitCode as _;
    use crate::failure::{Failure, INPUT};
    use crate::interrupt::Interrupt;
    use crate::stream;

    /// Variable for tests of failing GPUs: `lost@K` destroys the device after K submissions, `hang` waits forever.
    const INJECT: &str = "DOWNPOUR_INJECT";

    /// An error that may come from a GPU.
    pub(crate) trait FromGpu: std::fmt::Display {
        /// Error of the GPU, if it comes from there.
        fn gpu(&self) -> Option<&GpuError>;
    }

    impl FromGpu for GpuMaskError {
        fn gpu(&self) -> Option<&GpuError> {
            if let Self::Gpu(error) = self { Some(error) } else { None }
        }
    }

    impl FromGpu for GpuSpecimenError {
        fn gpu(&self) -> Option<&GpuError> {
            if let Self::Gpu(error) = self { Some(error) } else { None }
        }
    }

    /// Computes on the requested backend, and prints its name. `auto` uses the CPU if there is no device but a software driver
    /// that nobody has named, or if the work is too large for it.
    ///
    /// # Errors
    /// Exit code 2 for a bad [`INJECT`], 4 if there is no such adapter or the device failed, or the error of the work. A
    /// lost device never falls back.
    pub(crate) fn compute<T, E: FromGpu>(
        arguments: &BackendArguments,
        interrupt: &Interrupt,
        say: impl Fn(&str),
        on_gpu: impl FnOnce(&Gpu) -> Result<T, E>,
        on_cpu: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<T, Failure>
    where
        Failure: From<E>,
    {
        let Some(gpu) = opened(arguments, &say)? else { return on_cpu() };
        let error = match on_gpu(&gpu) {
            Ok(made) => return Ok(made),
            Err(error) => error,
        };
        if let Some(error) = error.gpu() {
            leave_if_hung(error, interrupt);
        }
        // Too much for this device is not too much for the CPU.
        let too_much = matches!(error.gpu(), Some(GpuError::OverLimit { .. } | GpuError::OutOfMemory { .. }));
        if arguments.backend != Backend::Auto || !too_much {
            return Err(error.into());
        }
        say(&format!("backend: cpu ({error})"));
        on_cpu()
    }

    impl BackendArguments {
        /// Opens the device that draws frames, and prints its name.
        ///
        /// # Errors
        /// Exit code 2 for a bad [`INJECT`], 4 if there is no such adapter, or no GPU if one was requested.
        pub(crate) fn device(&self, say: impl Fn(&str)) -> Result<downpour::Device, Failure> {
            let fall_back = self.backend == Backend::Auto;
            Ok(match opened(self, say)? {
                Some(gpu) => downpour::Device::gpu(gpu, fall_back),
                None => downpour::Device::cpu(),
            })
        }
    }

    /// Failure of a renderer.
    pub(crate) fn renderer_failure(error: downpour::RendererError, interrupt: &Interrupt) -> Failure {
        if let Some(error) = error.gpu() {
            leave_if_hung(error, interrupt);
        }
        error.into()
    }

    /// Ends the process for a GPU that hangs: dropping its device would wait for it.
    fn leave_if_hung(error: &GpuError, interrupt: &Interrupt) {
        if let GpuError::Hung { .. } = error {
            stream::message(&format!("error: {error}"));
            interrupt.leave(error.exit_code());
        }
    }

    /// Opens the requested GPU, and prints the backend. `None`: the CPU.
    fn opened(arguments: &BackendArguments, say: impl Fn(&str)) -> Result<Option<Gpu>, Failure> {
        if arguments.backend == Backend::Cpu {
            return Ok(None);
        }
        match device(arguments)? {
            // The CPU traces a scene in less than half of its time.
            Ok(gpu) if is_auto(arguments) && gpu.adapter().is_software() => {
                let name = &gpu.adapter().name;
                say(&format!("backend: cpu (there is no GPU but {name}, a software driver: --backend gpu)"));
                Ok(None)
            }
            Ok(gpu) => {
                let adapter = gpu.adapter();
                say(&format!("backend: gpu, {} ({}, {})", adapter.name, adapter.kind, adapter.backend));
                Ok(Some(gpu))
            }
            Err(error) if arguments.backend == Backend::Auto => {
                say(&format!("backend: cpu ({error})"));
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// True if no device was asked for.
    fn is_auto(arguments: &BackendArguments) -> bool {
        arguments.backend == Backend::Auto && arguments.adapter.is_none()
    }

    /// Opens the requested device. `Ok(Err(reason))`: there is none.
    fn device(arguments: &BackendArguments) -> Result<Result<Gpu, GpuError>, Failure> {
        let adapter = match &arguments.adapter {
            Some(name) => AdapterChoice::Named(name.clone()),
            None => AdapterChoice::Auto,
        };
        let options = inject(GpuOptions { adapter, ..GpuOptions::default() })?;
        match Gpu::open_with(&options) {
            Ok(gpu) if gpu.adapter().is_software() && options.timeout == GpuOptions::default().timeout => {
                Ok(Ok(gpu.with_timeout(downpour::Device::SOFTWARE_TIMEOUT)))
            }
            Ok(gpu) => Ok(Ok(gpu)),
            Err(error @ (GpuError::NoAdapter { .. } | GpuError::NoDevice { .. })) => Ok(Err(error)),
            Err(error) => Err(error.into()),
        }
    }

    fn inject(options: GpuOptions) -> Result<GpuOptions, Failure> {
        let Some(text) = std::env::var_os(INJECT).filter(|text| !text.is_empty()) else { return Ok(options) };
        let text = text.to_string_lossy();
        if text == "hang" {
            return Ok(GpuOptions { timeout: Duration::ZERO, ..options });
        }
        match text.strip_prefix("lost@").map(str::parse) {
            Some(Ok(count)) if count > 0 => Ok(GpuOptions { lose_after_submissions: Some(count), ..options }),
            _ => {
                let message = format!("{INJECT} is \"{text}\"; allowed: lost@K with K from 1, or hang");
                Err(Failure::new(INPUT, message))
            }
        }
    }
}
