//! Poisson numbers from the counter-based generator.

use downpour_math::ops::f64 as ops;
use downpour_math::rng::rng_draw;

/// Maximum mean of a single draw: `exp(-mean)` keeps its digits.
const MAX_MEAN: f64 = 16.0;

/// Draws a Poisson number of the given mean for a key and a step of time. A larger mean gives no smaller number for the same key:
/// heavier rain adds drops and moves none.
///
/// Means above [`MAX_MEAN`] are the sum of independent portions.
pub(crate) fn poisson_at(mean: f64, seed: [u32; 2], step: u32, dimension: u32) -> u32 {
    let mut rest = mean;
    let mut count = 0;
    let mut portion = 0;
    while rest > 0.0 {
        let [high, low, ..] = rng_draw(seed, portion, step, dimension);
        let unit = (f64::from(high) * 4_294_967_296.0 + f64::from(low) + 0.5) / 18_446_744_073_709_551_616.0;
        count += quantile(rest.min(MAX_MEAN), unit);
        rest -= MAX_MEAN;
        portion += 1;
    }
    count
}

/// The Poisson number whose cumulative probability first reaches `unit`.
fn quantile(mean: f64, unit: f64) -> u32 {
    let mut probability = ops::exp(-mean);
    let mut cumulative = probability;
    let mut count = 0;
    // More than 16 + 12 standard deviations: beyond, f64 has no probability left.
    while cumulative < unit && count < 128 {
        count += 1;
        probability *= mean / f64::from(count);
        cumulative += probability;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_variance_are_the_laws() {
        for mean in [0.02, 0.7, 5.0, 16.0, 40.0] {
            let n = 20_000;
            let (mut sum, mut square) = (0.0, 0.0);
            for k in 0..n {
                let x = f64::from(poisson_at(mean, [k, 9], 0, 3));
                sum += x;
                square += x * x;
            }
            let n = f64::from(n);
            let (average, variance) = (sum / n, square / n - (sum / n) * (sum / n));
            let spread = (mean / n).sqrt();
            assert!((average - mean).abs() < 4.0 * spread, "{mean}: {average}");
            // Var of the sample variance of a Poisson number: (mean + 2 mean^2) / n.
            let spread = ((mean + 2.0 * mean * mean) / n).sqrt();
            assert!((variance - mean).abs() < 4.0 * spread, "{mean}: {variance}");
        }
    }

    #[test]
    fn a_heavier_rain_adds_drops() {
        for key in 0..1000 {
            let counts = [0.5, 3.0, 15.0, 17.0, 60.0].map(|mean| poisson_at(mean, [key, 1], 0, 0));
            assert!(counts.is_sorted(), "{counts:?}");
        }
    }
}
