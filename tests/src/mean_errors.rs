//! Largest mean errors of the kernel-level cases, and how many words may be outside, as measured: `tests/mean_errors.txt`.
//!
//! A kernel's tolerance has to bear its worst pixel, such as one where a ray meets the edge of a drop on one side alone. Nearly all
//! pixels are a thousand times closer, and a formula that is one percent wrong everywhere would hide below such a tolerance. So the mean
//! error is limited as well: to [`ROOM`] times the worst that any adapter has shown, and at least to [`MIN_MEAN`]. So is the fraction of words
//! outside, where a case allows any.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::{KernelCase, cases};

/// Room above the worst that was measured, for adapters that nobody has measured.
pub const ROOM: f64 = 6.0;

/// No case has a smaller limit, as a fraction of its tolerance.
pub const MIN_MEAN: f64 = 1.0e-3;

const TEXT: &str = include_str!("../mean_errors.txt");

/// What adapters have shown of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// The worst mean error, as a fraction of the tolerance.
    pub mean: f64,
    /// The largest fraction of words outside the tolerance, with two words more: none of so many says little of the next run.
    pub outside: f64,
}

/// The worst that was measured, by the names of cases.
#[must_use]
pub fn measured() -> BTreeMap<&'static str, Measured> {
    let line = |line: &'static str| {
        let mut parts = line.splitn(3, ' ');
        let [mean, outside] = [parts.next()?.parse().ok()?, parts.next()?.parse().ok()?];
        Some((parts.next()?, Measured { mean, outside }))
    };
    TEXT.lines().filter(|text| !text.starts_with('#')).filter_map(line).collect()
}

/// Gives cases their limits, as far as they have been measured.
pub fn limit(cases: &mut [KernelCase]) {
    let measured = measured();
    for case in cases {
        if let Some(worst) = measured.get(case.name) {
            case.tol.mean = (worst.mean * ROOM).clamp(MIN_MEAN, 1.0);
            case.tol.outliers = case.tol.outliers.min(worst.outside * ROOM);
        }
    }
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
    let mut all: BTreeMap<String, Measured> =
        measured().into_iter().map(|(case, worst)| (case.to_owned(), worst)).collect();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_none_or(|extension| extension != "csv") {
            continue;
        }
        for (case, found) in std::fs::read_to_string(path)?.lines().filter_map(found_in) {
            let worst = all.entry(case.to_owned()).or_default();
            *worst = Measured { mean: worst.mean.max(found.mean), outside: worst.outside.max(found.outside) };
        }
    }
    let mut text = String::from(HEAD);
    for case in cases::kernels() {
        if let Some(Measured { mean, outside }) = all.get(case.name) {
            // Writing to a String does not fail.
            let _ = writeln!(text, "{mean:.1e} {outside:.1e} {}", case.name);
        }
    }
    Ok(text)
}

const HEAD: &str = "\
# Worst mean error of each kernel-level case that an adapter has shown, as a fraction of its tolerance; largest fraction of words outside
# the tolerance, with two words more; the case's name.
# `cargo xtask mean-errors` adds what the reports in target/parity say. To measure a case anew, remove its line.
";

/// The case of a report's line, and what was found.
fn found_in(line: &str) -> Option<(&str, Measured)> {
    let (case, rest) = line.strip_prefix('"')?.split_once("\",")?;
    let mut numbers = rest.split(',').map_while(|number| number.parse::<f64>().ok());
    let [words, outside, mean] = [numbers.next()?, numbers.next()?, numbers.next()?];
    Some((case, Measured { mean, outside: (outside + 2.0) / words }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_a_report_is_read() {
        let line = "\"main_a: from above, in the sun\",100,2,1.5e-2,1e0,2e0,7,1e-3,0e0,0,0.01,\"a reason\"";
        let found = Measured { mean: 1.5e-2, outside: 0.04 };
        assert_eq!(found_in(line), Some(("main_a: from above, in the sun", found)));
        assert_eq!(found_in("case,words,outside,mean"), None);
    }

    #[test]
    fn every_line_is_of_a_case() {
        let names: Vec<_> = cases::kernels().iter().map(|case| case.name).collect();
        for case in measured().keys() {
            assert!(names.contains(case), "mean_errors.txt: no case \"{case}\"");
        }
    }
}
