//! Cross-sections and impact parameters by scattering angle.

use std::f64::consts::{PI, TAU};

use downpour_math::ops::f64 as ops;

use super::bins::Bins;
use super::ray;
use crate::DropError;
use crate::error::in_rounded_range;
use crate::optics::rainbow;

/// Number of separate light paths: orders 0 and 1, and orders 2 and 3 each inside and outside the rainbow ray.
pub const SCATTERING_PATHS: usize = 6;

/// Intervals of the sweep per interval of the table: the mean over one is then exact to four digits.
const FINE: usize = 16;

/// Steps of the sweep over the angle of incidence, for each path.
const STEPS: u32 = 8192;

/// One light path through a sphere. Orders 2 and 3 have two that lead to the same angle near their rainbow.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatteringPath {
    /// Order: 0 to 3.
    pub order: u32,
    /// Range of impact parameters, radii.
    pub impacts: [f64; 2],
    /// Means of (dsigma/dOmega) / (pi a^2) over equal intervals of the scattering angle, 1/sr.
    pub phase: Vec<f64>,
    /// Mean exit position in these intervals, as [`ScatteredRay::exit_position`](super::ScatteredRay); in intervals
    /// without light, that of the nearest interval with light.
    pub exit_position: Vec<f64>,
}

/// Scattering by a sphere, for equal intervals of the scattering angle from 0 (forward) to pi (backward).
///
/// ```
/// use downpour_drop::optics::{SUN_DIAMETER, SphereScattering, WATER_INDEX};
/// let drop = SphereScattering::new(WATER_INDEX, 256, SUN_DIAMETER)?;
/// let (behind, beside) = (drop.phase(20.0f64.to_radians()), drop.phase(90.0f64.to_radians()));
/// assert!(behind / beside > 100.0);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SphereScattering {
    paths: [ScatteringPath; SCATTERING_PATHS],
}

impl SphereScattering {
    /// Sweeps the light paths. `intervals` of the angle, 16 to 4096; the light comes from a disk of `diameter` radians
    /// (0 for a point, up to 0.2), seen from the sphere.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if a number is outside its range; the index is 1.2 to 1.4.
    pub fn new(index: f64, intervals: usize, diameter: f64) -> Result<Self, DropError> {
        // Above the root of 2 light of order 2 returns along the axis: a glory, which this table cannot hold.
        let n = in_rounded_range("refractive index", index, "", &(1.2..=1.4), 1.0, "1.2 to 1.4")?;
        let quantity = "intervals of the scattering angle";
        in_rounded_range(quantity, intervals as f64, "", &(16.0..=4096.0), 1.0, "16 to 4096")?;
        let disk = in_rounded_range(
            "diameter of the light",
            diameter,
            "radians",
            &(0.0..=0.2),
            1.0,
            "0 to 0.2 radians",
        )?;
        let bows = [1, 2].map(|reflections| rainbow(n, reflections).map(|bow| bow.incidence));
        let ([first, second], whole) = ([bows[0].clone()?, bows[1].clone()?], 0.5 * PI);
        let ways = [
            (0, [0.0, whole]),
            (1, [0.0, whole]),
            (2, [0.0, first]),
            (2, [first, whole]),
            (3, [0.0, second]),
            (3, [second, whole]),
        ];
        let paths =
            ways.map(|(order, incidences)| ScatteringPath::swept(n, order, incidences, intervals, disk));
        Ok(Self { paths })
    }

    /// Light paths: order 0, order 1, order 2 inside and outside the rainbow ray, order 3 likewise.
    #[must_use]
    pub fn paths(&self) -> &[ScatteringPath; SCATTERING_PATHS] {
        &self.paths
    }

    /// Number of intervals of the angle.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.paths[0].phase.len()
    }

    /// (dsigma/dOmega) / (pi a^2) of all orders together at a scattering angle in radians, 1/sr: linear between the middles
    /// of the intervals.
    #[must_use]
    pub fn phase(&self, angle: f64) -> f64 {
        self.paths.iter().map(|path| between(&path.phase, angle)).sum()
    }

    /// Fraction of the light that the table holds for an order.
    #[must_use]
    pub fn fraction(&self, order: u32) -> f64 {
        let count = self.intervals();
        let of = |path: &ScatteringPath| -> f64 {
            path.phase.iter().enumerate().map(|(k, phase)| phase * ring(k, count)).sum()
        };
        self.paths.iter().filter(|path| path.order == order).map(of).sum()
    }
}

impl ScatteringPath {
    fn swept(index: f64, order: u32, incidences: [f64; 2], intervals: usize, disk: f64) -> Self {
        let mut bins = Bins::new(intervals * FINE);
        let step = (incidences[1] - incidences[0]) / f64::from(STEPS);
        let at = |k: f64| ray(incidences[0] + step * k, index, order);
        for k in 0..STEPS {
            let k = f64::from(k);
            let (start, middle, end) = (at(k), at(k + 0.5), at(k + 1.0));
            // Part of the disk's area between the two impact parameters.
            let area = end.exit_position * end.exit_position - start.exit_position * start.exit_position;
            bins.add_between([start.angle, end.angle], middle.fraction * area, middle.exit_position);
        }
        let merged = bins.of_disk(disk).merged(FINE);
        let phase = merged.iter().enumerate().map(|(k, bin)| bin[0] / ring(k, intervals)).collect();
        Self { order, impacts: incidences.map(ops::sin), phase, exit_position: positions(&merged) }
    }
}

/// Solid angle of an interval, sr.
fn ring(k: usize, count: usize) -> f64 {
    let at = |k: usize| ops::cos(PI * k as f64 / count as f64);
    TAU * (at(k) - at(k + 1))
}

/// Mean positions; an empty interval takes that of the nearest interval with light, the lower of two.
fn positions(merged: &[[f64; 2]]) -> Vec<f64> {
    let full: Vec<(usize, f64)> = merged
        .iter()
        .enumerate()
        .filter(|(_, bin)| bin[0] > 0.0)
        .map(|(k, bin)| (k, bin[1] / bin[0]))
        .collect();
    let nearest = |k: usize| {
        full.iter().min_by_key(|(of, _)| of.abs_diff(k)).map_or(0.0, |&(_, exit_position)| exit_position)
    };
    (0..merged.len()).map(nearest).collect()
}

/// Interpolates a table of intervals at an angle.
fn between(values: &[f64], angle: f64) -> f64 {
    let last = values.len().saturating_sub(1);
    let position = (angle / PI * values.len() as f64 - 0.5).clamp(0.0, last as f64);
    let (low, part) = (position as usize, position - position.floor());
    let at = |k: usize| values.get(k.min(last)).copied().unwrap_or(0.0);
    at(low) + (at(low + 1) - at(low)) * part
}
