//! Function-level cases: one WGSL function against its twin, over many arguments.

use downpour_gpu::{ComputeKernel, Gpu, GpuError};
use downpour_shaders::{Module, compose};

use crate::compare::{self, Comparison, Cpu, POISON, compare};
use crate::domain::Domain;
use crate::signature::{Signature, WordKind, parse};
use crate::tolerance::Tol;
use crate::words::Args;

/// Number of calls that a case makes by default.
pub const CALLS: u32 = 8192;

/// A WGSL function, where its arguments come from, and its twin.
#[derive(Clone, Debug)]
pub struct FunctionCase {
    /// Name of the function in WGSL (and in Rust).
    pub function: &'static str,
    /// The module that holds it.
    pub module: &'static Module,
    /// The domains of the arguments, in order.
    pub domains: Vec<Domain>,
    /// The twin: reads the arguments, gives the words of the result.
    pub cpu: fn(&mut Args<'_>) -> Vec<u32>,
    /// Largest difference allowed between the two.
    pub tol: Tol,
    /// Number of calls.
    pub calls: u32,
}

/// The words of both sides, and how the words of the result are to be compared.
#[derive(Debug)]
pub struct Run {
    /// The arguments of each call.
    pub arguments: Vec<Vec<u32>>,
    /// Words of the twin.
    pub cpu: Cpu,
    /// Words of the shader.
    pub gpu: compare::Gpu,
    /// The kinds of the words of one result.
    pub kinds: Vec<WordKind>,
}

impl Run {
    /// Two pictures of some columns, rows from the top; the arguments are column and row.
    #[must_use]
    pub fn of_pixels<const N: usize>(width: u32, cpu: &[[f32; N]], gpu: &[[f32; N]]) -> Self {
        let words = |pixels: &[[f32; N]]| pixels.iter().flatten().map(|v| v.to_bits()).collect();
        Self {
            arguments: (0..cpu.len() as u32)
                .map(|i| [i % width, i / width].map(|c| (c as f32).to_bits()).to_vec())
                .collect(),
            cpu: Cpu(words(cpu)),
            gpu: compare::Gpu(words(gpu)),
            kinds: vec![WordKind::Float; N],
        }
    }
}

/// The arguments of all calls, and the twin's words.
#[derive(Clone, Debug)]
pub struct Twin {
    /// The arguments of each call.
    pub arguments: Vec<Vec<u32>>,
    /// Words of the twin, one result after the other.
    pub words: Cpu,
}

impl FunctionCase {
    /// A case with the default number of calls.
    #[must_use]
    pub fn new(
        function: &'static str,
        module: &'static Module,
        domains: &[Domain],
        tol: Tol,
        cpu: fn(&mut Args<'_>) -> Vec<u32>,
    ) -> Self {
        Self { function, module, domains: domains.to_vec(), cpu, tol, calls: CALLS }
    }

    /// The shader that calls the function once per invocation.
    ///
    /// # Panics
    /// If the function cannot be called from words (pointers), or the domains do not fit its arguments.
    #[must_use]
    pub fn shader(&self, source: &str, words: usize) -> (String, Vec<WordKind>) {
        let signature = Signature::of(&parse(source), self.function)
            .unwrap_or_else(|| panic!("{} takes or gives something else than values", self.function));
        assert_eq!(
            signature.argument_words, words,
            "{}: the domains give {words} words, the arguments take {}",
            self.function, signature.argument_words
        );
        let (call, store, outputs) = (&signature.call, &signature.store, signature.result.len());
        let calls = self.calls;
        let text = format!(
            "{source}
@group(0) @binding(0) var<storage, read> parity_in: array<u32>;
@group(0) @binding(1) var<storage, read_write> parity_out: array<u32>;

@compute @workgroup_size(64)
fn main_parity(@builtin(global_invocation_id) parity_id: vec3u) {{
    if parity_id.x >= {calls}u {{ return; }}
    let base_in = parity_id.x * {words}u;
    let base_out = parity_id.x * {outputs}u;
    let r = {call};
{store}}}
"
        );
        (text, signature.result)
    }

    /// The arguments of all calls, and what the twin makes of them.
    ///
    /// # Panics
    /// If the twin reads less than all words.
    #[must_use]
    pub fn twin(&self) -> Twin {
        let arguments = Domain::arguments(&self.domains, self.calls);
        let mut words = Vec::new();
        for call in &arguments {
            let mut args = Args::new(call);
            words.extend((self.cpu)(&mut args));
            assert!(args.is_empty(), "{}: the twin did not read all words", self.function);
        }
        Twin { arguments, words: Cpu(words) }
    }

    /// Runs both sides. `source` is the text to test: [`compose`] of the module, or a broken one as a control.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    ///
    /// # Panics
    /// As [`FunctionCase::shader`] and [`FunctionCase::twin`].
    pub fn run_source(&self, gpu: &Gpu, source: &str) -> Result<Run, GpuError> {
        let twin = self.twin();
        let (text, kinds) = self.shader(source, twin.arguments[0].len());
        self.run_shader(gpu, &text, kinds, twin)
    }

    /// Runs the GPU's side beside what the twin made. `text` and `kinds` are those of [`FunctionCase::shader`].
    ///
    /// # Errors
    /// Returns the error of the GPU.
    ///
    /// # Panics
    /// If the twin gave another number of words.
    pub fn run_shader(
        &self,
        gpu: &Gpu,
        text: &str,
        kinds: Vec<WordKind>,
        twin: Twin,
    ) -> Result<Run, GpuError> {
        let Twin { arguments, words: cpu } = twin;
        assert_eq!(cpu.0.len(), arguments.len() * kinds.len(), "{}: words of the result", self.function);
        let kernel = ComputeKernel::from_source(gpu, "main_parity", text, &[])?;
        let input = gpu.storage_buffer("parity in", &arguments.concat())?;
        let output = gpu.storage_buffer("parity out", &vec![POISON; cpu.0.len()])?;
        let bindings = kernel.bind(gpu, &[&input, &output])?;
        gpu.submit(&[kernel.dispatch(&bindings, [self.calls.div_ceil(64), 1, 1])])?;
        let words = gpu.read::<u32>(&output)?;
        Ok(Run { arguments, cpu, gpu: compare::Gpu(words), kinds })
    }

    /// Runs both sides of the shader as it is.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn run(&self, gpu: &Gpu) -> Result<Run, GpuError> {
        self.run_source(gpu, &compose(&[self.module]))
    }
}

impl Run {
    /// Compares the two sides.
    #[must_use]
    pub fn compare(&self, tol: &Tol) -> Comparison {
        compare(&self.cpu, &self.gpu, &self.kinds, tol)
    }

    /// The arguments of the call that made a word of the result, as numbers and as words.
    #[must_use]
    pub fn describe_call(&self, word: usize) -> String {
        let words = &self.arguments[word / self.kinds.len()];
        let numbers: Vec<f32> = words.iter().map(|&w| f32::from_bits(w)).collect();
        format!("{numbers:?} = {words:#x?}").replace('\n', "")
    }
}
