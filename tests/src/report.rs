//! Report of a run: the worst error of each case, and the details of each failure.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use crate::compare::Comparison;
use crate::function::Run;
use crate::tolerance::Tol;

/// Collects a line per case.
#[derive(Debug, Default)]
pub struct Report {
    lines: Mutex<Vec<String>>,
}

/// Folder of the reports: `DOWNPOUR_REPORT_DIR`, else `target/parity` of the workspace.
#[must_use]
pub fn folder() -> PathBuf {
    std::env::var_os("DOWNPOUR_REPORT_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../target/parity"), PathBuf::from)
}

impl Report {
    /// Notes the outcome of a case.
    pub fn note(&self, case: &str, comparison: &Comparison, tol: &Tol) {
        let c = comparison;
        let line = format!(
            "\"{case}\",{},{},{:e},{:e},{:e},{},{:e},{:e},{},{},\"{}\"",
            c.compared,
            c.outside,
            c.mean,
            c.worst_abs,
            c.worst_rel,
            c.worst_ulp,
            tol.abs,
            tol.rel,
            tol.ulp,
            tol.outliers,
            tol.why
        );
        self.lines.lock().unwrap_or_else(PoisonError::into_inner).push(line);
    }

    /// Writes the table of one adapter and gives its path; nothing if no case ran.
    ///
    /// # Errors
    /// If the folder cannot be made or written.
    pub fn write(&self, adapter: &str) -> std::io::Result<Option<PathBuf>> {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if lines.is_empty() {
            return Ok(None);
        }
        lines.sort();
        let folder = folder();
        std::fs::create_dir_all(&folder)?;
        let path = folder.join(format!("{}.csv", slug(adapter)));
        let head = "case,words,outside,mean,worst_abs,worst_rel,worst_ulp,tol_abs,tol_rel,tol_ulp,tol_outliers,why\n";
        std::fs::write(&path, format!("{head}{}\n", lines.join("\n")))?;
        Ok(Some(path))
    }
}

/// Writes both sides of a failed case, with the inputs, and gives the path.
///
/// # Errors
/// If the folder cannot be made or written.
pub fn write_failure(case: &str, run: &Run) -> std::io::Result<PathBuf> {
    let folder = folder().join("failed");
    std::fs::create_dir_all(&folder)?;
    let path = folder.join(format!("{}.csv", slug(case)));
    let mut text = String::from("word,cpu,gpu,cpu_bits,gpu_bits,input\n");
    for (at, (&c, &g)) in run.cpu.0.iter().zip(&run.gpu.0).enumerate().filter(|(_, (c, g))| c != g).take(2000)
    {
        let (a, b) = (f32::from_bits(c), f32::from_bits(g));
        let _ = writeln!(text, "{at},{a:e},{b:e},{c:#010x},{g:#010x},\"{}\"", run.describe_call(at));
    }
    std::fs::write(&path, text)?;
    Ok(path)
}

/// A file name from a name.
fn slug(name: &str) -> String {
    let text: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
    text.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}
