//! Kernel-level cases: a whole kernel against its CPU counterpart.

use std::collections::BTreeSet;

use downpour_gpu::{Gpu, GpuError};
use downpour_shaders::Kernel;

use crate::function::Run;
use crate::reach;
use crate::relay::Dispatched;
use crate::signature::parse;
use crate::tolerance::Tol;

/// A kernel on some input, and what the CPU makes of the same.
pub struct KernelCase {
    /// Name of the case; the kernel's entry point and what is special about the input.
    pub name: &'static str,
    /// The kernel.
    pub kernel: &'static Kernel,
    /// Other kernels that run before or after it and whose work is compared as well.
    pub with: &'static [&'static Kernel],
    /// The values of the kernel's `override` constants, where they are not those of its text.
    pub overrides: &'static [(&'static str, f64)],
    /// Text with an entry point `main_parity`, where the case asks the kernel's functions with that instead.
    pub text: Option<fn() -> String>,
    /// Largest difference allowed between the two.
    pub tol: Tol,
    /// Runs both sides. `arguments` of the run describe each element of the output.
    pub run: fn(&Gpu) -> Result<Run, GpuError>,
}

/// The entry point of a case's own text.
pub const OWN_ENTRY: &str = "main_parity";

impl KernelCase {
    /// A case of a kernel with the constants of its text.
    #[must_use]
    pub const fn new(
        name: &'static str,
        kernel: &'static Kernel,
        tol: Tol,
        run: fn(&Gpu) -> Result<Run, GpuError>,
    ) -> Self {
        Self { name, kernel, with: &[], overrides: &[], text: None, tol, run }
    }

    /// The entry point that the case dispatches.
    #[must_use]
    pub fn entry(&self) -> &'static str {
        if self.text.is_some() { OWN_ENTRY } else { self.kernel.entry }
    }

    /// The functions that the case's kernels call with these constants, and their entry points: what it covers.
    #[must_use]
    pub fn reaches(&self) -> BTreeSet<String> {
        let source = self.text.map_or_else(|| self.kernel.source(), |text| text());
        let mut found = reach::from_entry(&parse(&source), self.entry(), self.overrides);
        for kernel in self.with {
            found.extend(reach::from_entry(&parse(&kernel.source()), kernel.entry, &[]));
        }
        found
    }

    /// True if all this is among what was dispatched: the entry point with these values of its constants, and the others.
    #[must_use]
    pub fn is_among(&self, dispatched: &BTreeSet<Dispatched>) -> bool {
        let has = |constants: &[(String, u64)], (name, value): &(&str, f64)| {
            constants.iter().any(|(other, bits)| other == name && *bits == value.to_bits())
        };
        let own = dispatched.iter().any(|(entry, constants)| {
            entry == self.entry() && self.overrides.iter().all(|o| has(constants, o))
        });
        own && self.with.iter().all(|kernel| dispatched.iter().any(|(entry, _)| entry == kernel.entry))
    }
}
