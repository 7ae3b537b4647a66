//! Largest mean errors of the kernel-level cases, as measured: `tests/mean_errors.txt`.
//!
//! A kernel's tolerance has to bear its worst pixel, such as one where a ray meets the edge of a drop on one side alone. Nearly all
//! pixels are a thousand times closer, and a formula that is one percent wrong everywhere would hide below such a tolerance. So the mean
//! error is limited as well: to [`ROOM`] times the worst that any adapter has shown, and at least to [`LEAST`].

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::{KernelCase, cases};

/// Room above the worst mean error measured, for adapters that nobody has measured.
pub const ROOM: f64 = 6.0;

/// No case has a smaller limit, as a fraction of its tolerance.
pub const LEAST: f64 = 1.0e-3;

const TEXT: &str = include_str!("../mean_errors.txt");

/// The worst mean errors measured, by the names of cases.
#[must_use]
pub fn measured() -> BTreeMap<&'static str, f64> {
    let line =
        |line: &'static str| line.split_once(' ').and_then(|(mean, case)| Some((case, mean.parse().ok()?)));
    TEXT.lines().filter(|text| !text.starts_with('#')).filter_map(line).collect()
}

/// The case with its limit, if it has been measured.
#[must_use]
pub fn bounded(mut case: KernelCase) -> KernelCase {
    if let Some(mean) = measured().get(case.name) {
        case.tol.mean = (mean * ROOM).clamp(LEAST, 1.0);
    }
    case
}

/// The file.
#[must_use]
pub fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("mean_errors.txt")
}

/// Text of the file with what the reports of a folder add: the worst of all for each case.
///
/// # Errors
/// If the folder or a report in it cannot be read.
pub fn with_reports(folder: &Path) -> std::io::Result<String> {
    let mut means: BTreeMap<String, f64> =
        measured().into_iter().map(|(case, mean)| (case.to_owned(), mean)).collect();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_none_or(|extension| extension != "csv") {
            continue;
        }
        for (case, mean) in std::fs::read_to_string(path)?.lines().filter_map(mean_of) {
            let worst = means.entry(case.to_owned()).or_default();
            *worst = worst.max(mean);
        }
    }
    let mut text = String::from(HEAD);
    for case in cases::kernels() {
        if let Some(mean) = means.get(case.name) {
            // Writing to a String does not fail.
            let _ = writeln!(text, "{mean:.1e} {}", case.name);
        }
    }
    Ok(text)
}

const HEAD: &str = "\
# Worst mean error of each kernel-level case that an adapter has shown, as a fraction of its tolerance, and the case's name.
# `cargo xtask mean-errors` adds what the reports in target/parity say. To measure a case anew, remove its line.
";

/// The case of a report's line, and its mean error.
fn mean_of(line: &str) -> Option<(&str, f64)> {
    let (case, rest) = line.strip_prefix('"')?.split_once("\",")?;
    Some((case, rest.split(',').nth(2)?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_a_report_is_read() {
        let line = "\"main_a: from above, in the sun\",100,2,1.5e-2,1e0,2e0,7,1e-3,0e0,0,0.01,\"a reason\"";
        assert_eq!(mean_of(line), Some(("main_a: from above, in the sun", 1.5e-2)));
        assert_eq!(mean_of("case,words,outside,mean"), None);
    }

    #[test]
    fn every_line_is_of_a_case() {
        let names: Vec<_> = cases::kernels().iter().map(|case| case.name).collect();
        for case in measured().keys() {
            assert!(names.contains(case), "mean_errors.txt: no case \"{case}\"");
        }
    }
}
