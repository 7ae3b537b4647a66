//! The harness that compares each WGSL function and kernel with its CPU twin.
//!
//! - [`function`]: a function-level case needs a name, domains for its arguments, the CPU twin and a tolerance;
//!   the shader around it is written from the signature that naga reads;
//! - [`kernel`]: a kernel-level case runs a whole kernel and its CPU counterpart;
//! - [`mod@compare`]: the one comparer. The two sides have different types, so that a result cannot be compared
//!   with itself; outputs are poisoned before a run; untouched slots and NaN fail;
//! - [`control`]: every case is followed by runs that have to fail: flipped bits, other inputs; [`broken`] has
//!   shaders with wrong constants and formulas, which have to fail too;
//! - [`cases`]: the registry, which the coverage test holds against all functions of all shaders.

pub mod adapter;
pub mod broken;
pub mod cases;
pub mod compare;
pub mod control;
pub mod domain;
pub mod function;
pub mod kept;
pub mod kernel;
pub mod mean_errors;
pub mod mutants;
pub mod reach;
pub mod relay;
pub mod report;
pub mod signature;
pub mod sources;
pub mod tolerance;
pub mod words;

pub use compare::{Comparison, Cpu, Gpu as FromGpu, compare};
pub use domain::Domain;
pub use function::FunctionCase;
pub use kernel::KernelCase;
pub use tolerance::Tol;
