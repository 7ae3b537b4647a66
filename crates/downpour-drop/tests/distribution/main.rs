//! Drop size distributions: integrals, bounds and samples.

mod bounds;
mod extinction;
mod integrals;
mod sampling;

use downpour_drop::distribution::{DistributionOptions, DropSizeLaw};
use downpour_drop::fall_speed::FallSpeedModel;

const LAWS: [DropSizeLaw; 9] = [
    DropSizeLaw::MarshallPalmer1948,
    DropSizeLaw::Best1950,
    DropSizeLaw::GammaByMedian { mu: 3.0, median_volume_diameter_m: 1.5e-3 },
    DropSizeLaw::GammaByMedian { mu: -1.5, median_volume_diameter_m: 1.0e-3 },
    DropSizeLaw::GammaByIntercept { mu: 2.0, intercept_m3_mm: 2.0e4 },
    DropSizeLaw::FeingoldLevin1986,
    DropSizeLaw::Joss1968Drizzle,
    DropSizeLaw::Joss1968Widespread,
    DropSizeLaw::Joss1968Thunderstorm,
];

fn with_speeds(smallest_mm: f64, fall_speed: FallSpeedModel) -> DistributionOptions {
    DistributionOptions { min_diameter_m: smallest_mm * 1e-3, fall_speed, ..DistributionOptions::default() }
}

/// Simpson's rule over n intervals, independent of the library's integrals.
fn simpson(n: u32, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let h = (b - a) / f64::from(n);
    let inner: f64 = (1..n).map(|i| f64::from(2 + 2 * (i % 2)) * f(a + h * f64::from(i))).sum();
    (f(a) + f(b) + inner) * h / 3.0
}
