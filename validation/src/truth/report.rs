//! Results of all cases, in a table, and the cases above the aim.

use std::collections::BTreeMap;

use super::cases::Case;
use super::mitsuba::Mitsuba;
use super::options::Options;

/// Mean FLIP within the silhouette.
const MAX_FLIP: f64 = 0.03;
/// Relative error of the mean luminance within the silhouette.
const MAX_LUMINANCE: f64 = 0.02;
/// Mean relative difference outside: there, both see the map itself. A map that is turned or mirrored is far above.
const MAX_SKY: f64 = 0.03;
/// Tolerance between Mitsuba's two integrators: this, plus a number of standard errors of the noisy one.
const MAX_PATH: f64 = 0.002;
const STANDARD_ERRORS: f64 = 5.0;
/// Checks of a case.
const CHECKS: usize = 5;

/// Result of the comparison of one case.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    flip: f64,
    luminance: f64,
    sky: f64,
    path_flip: f64,
    path: f64,
    path_error: f64,
    mirrored: f64,
    exposure: f64,
}

impl Outcome {
    /// Takes the values by their names.
    pub(super) fn read(values: &BTreeMap<String, f64>) -> Result<Self, String> {
        let value = |name: &str| {
            values.get(name).copied().ok_or_else(|| format!("the comparison did not say \"{name}\""))
        };
        Ok(Self {
            flip: value("flip")?,
            luminance: value("luminance")?,
            sky: value("sky")?,
            path_flip: value("path_flip")?,
            path: value("path")?,
            path_error: value("path_error")?,
            mirrored: value("mirrored")?,
            exposure: value("exposure")?,
        })
    }

    /// Values above the aim, as text. A NaN is one.
    fn misses(&self) -> Vec<String> {
        let apart = MAX_PATH + STANDARD_ERRORS * self.path_error;
        let mut words = Vec::new();
        let mut check = |what: &str, found: f64, most: f64| {
            if found.is_nan() || found.abs() > most {
                words.push(format!("{what} {found:.4}, allowed {most:.4}"));
            }
        };
        check("mean FLIP", self.flip, MAX_FLIP);
        check("luminance", self.luminance, MAX_LUMINANCE);
        check("sky beside the drop", self.sky, MAX_SKY);
        check("Mitsuba's integrators differ by", self.path, apart);
        if self.mirrored.is_nan() || self.mirrored <= MAX_FLIP {
            words.push(format!("mirrored, mean FLIP is only {:.4}: this case cannot fail", self.mirrored));
        }
        words
    }
}

/// All cases so far.
#[derive(Debug)]
pub(super) struct Report {
    head: String,
    rows: Vec<String>,
    misses: Vec<String>,
    worst: [f64; 2],
}

impl Report {
    pub(super) fn new(options: &Options, mitsuba: &Mitsuba) -> Self {
        let samples = match mitsuba.branch_samples(options) {
            Some(samples) => format!("{samples} samples per pixel, all branches followed"),
            None => "no integrator that follows all branches".to_owned(),
        };
        let triangles = 20u64 << (2 * options.subdivisions);
        let head = format!(
            "`downpour specimen --backend cpu` against Mitsuba 3 (`{}`): {size} x {size} pixels, a mesh of {triangles} \
             triangles, {samples}; `path` is Mitsuba's own path tracer with {} \
             samples. Within the silhouette: mean FLIP (aim {MAX_FLIP}) and relative error of the mean luminance (aim \
             {} %). Outside: mean relative difference of the sky.",
            mitsuba.variant(),
            mitsuba.path_samples(options),
            100.0 * MAX_LUMINANCE,
            size = options.size,
        );
        Self { head, rows: Vec::new(), misses: Vec::new(), worst: [0.0; 2] }
    }

    /// Adds a case, and prints it in a line.
    pub(super) fn add(&mut self, case: &Case<'_>, outcome: Outcome) -> String {
        let (name, percent) = (case.name(), |value: f64| 100.0 * value);
        self.rows.push(format!(
            "| {} | {} | {} | {:.4} | {:+.3} % | {:.3} % | {:.4} | {:+.3} ± {:.3} % | {:.2} | {:.4} |",
            case.map.name,
            case.diameter_mm,
            case.view.name,
            outcome.flip,
            percent(outcome.luminance),
            percent(outcome.sky),
            outcome.path_flip,
            percent(outcome.path),
            percent(outcome.path_error),
            outcome.mirrored,
            outcome.exposure,
        ));
        let misses = outcome.misses();
        self.misses.extend(misses.iter().map(|words| format!("{name}: {words}")));
        for (worst, value) in self.worst.iter_mut().zip([outcome.flip, outcome.luminance.abs()]) {
            *worst = worst.max(value);
        }
        let verdict = if misses.is_empty() { "within the aim" } else { "ABOVE the aim" };
        format!("{name}: FLIP {:.4}, luminance {:+.3} %, {verdict}", outcome.flip, percent(outcome.luminance))
    }

    /// Values above the aim, a line each.
    pub(super) fn misses(&self) -> &[String] {
        &self.misses
    }

    /// The table.
    pub(super) fn markdown(&self) -> String {
        let [flip, luminance] = self.worst;
        format!(
            "# Specimen and Mitsuba\n\n{}\n\n\
             | map | d, mm | view | mean FLIP | luminance | sky outside | FLIP to `path` | `path` to all branches | FLIP mirrored | exposure |\n\
             |---|---|---|---|---|---|---|---|---|---|\n{}\n\n\
             Worst: mean FLIP {flip:.4}, luminance {:.3} %; {} of {} checks above the aim.\n",
            self.head,
            self.rows.join("\n"),
            100.0 * luminance,
            self.misses.len(),
            CHECKS * self.rows.len(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn good() -> Outcome {
        Outcome {
            flip: 0.01,
            luminance: -0.001,
            sky: 0.001,
            path_flip: 0.01,
            path: 0.0,
            path_error: 0.001,
            mirrored: 0.3,
            exposure: 1.0,
        }
    }

    #[test]
    fn each_aim_can_be_missed() {
        assert!(good().misses().is_empty());
        for (bad, words) in [
            (Outcome { flip: 0.031, ..good() }, "mean FLIP 0.0310"),
            (Outcome { luminance: -0.021, ..good() }, "luminance -0.0210"),
            (Outcome { sky: 0.5, ..good() }, "sky beside the drop"),
            (Outcome { path: 0.008, ..good() }, "Mitsuba's integrators"),
            (Outcome { mirrored: 0.03, ..good() }, "mirrored, mean FLIP is only 0.0300"),
            (Outcome { flip: f64::NAN, ..good() }, "mean FLIP NaN"),
        ] {
            let misses = bad.misses();
            assert!(misses.len() == 1 && misses[0].starts_with(words), "{misses:?}");
        }
    }

    #[test]
    fn a_value_that_is_missing_is_named() {
        let error = Outcome::read(&BTreeMap::from([("flip".to_owned(), 0.0)])).expect_err("incomplete");
        assert_eq!(error, "the comparison did not say \"luminance\"");
    }
}
