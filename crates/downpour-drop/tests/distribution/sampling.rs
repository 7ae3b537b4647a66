//! Samples follow their distribution: chi-square for every sampler.

use approx::assert_relative_eq;
use downpour_drop::air::Air;
use downpour_drop::distribution::{
    DropSizeDistribution, DropSizeLaw, SampleTable, SampledBy, distribution_sample_exponential,
};
use downpour_drop::fall_speed::{FallSpeedModel, TerminalSpeed};
use downpour_math::ops::f64 as ops;
use downpour_math::rng::rng_draw;

use crate::{LAWS, simpson};

const MIN: f64 = 0.1e-3;
const MAX: f64 = 8e-3;

/// Number of chi-square tests of this file; the chance of a false alarm of any of them is 1 %.
const TESTS: f64 = 20.0;

/// Probability that chance alone gives `chi2` or more (Wilson & Hilferty 1931).
fn chance(chi2: f64, degrees: f64) -> f64 {
    let spread = (2.0 / (9.0 * degrees)).sqrt();
    let z = (ops::cbrt(chi2 / degrees) - (1.0 - spread * spread)) / spread;
    0.5 * (1.0 - ops::erf(z / std::f64::consts::SQRT_2))
}

/// Density from which drops are drawn, computed from the law's concentration and the speed.
fn density(rain: &DropSizeDistribution, by: SampledBy) -> impl Fn(f64) -> f64 {
    let speed = TerminalSpeed::new(FallSpeedModel::Beard1976, &Air::standard());
    move |d: f64| {
        // The ends of a Simpson interval may be outside by a rounding error.
        let d = d.clamp(MIN, MAX);
        rain.concentration(d) * if by == SampledBy::Flux { speed.at(d).expect("a drop") } else { 1.0 }
    }
}

/// Probability that drops of `density` give the samples of `draw`, over at least 100 bins with 5 expected or more.
fn chi_square(seed: u32, n: u32, density: impl Fn(f64) -> f64, draw: impl Fn(u32) -> f32) -> f64 {
    // 600 bins, even in the logarithm, so that frequent and rare sizes have bins.
    let bins = 600usize;
    let growth = ops::ln(MAX / MIN) / bins as f64;
    let edge = |i: usize| MIN * ops::exp(growth * i as f64);
    let mass: Vec<f64> = (0..bins).map(|i| simpson(8, edge(i), edge(i + 1), &density)).collect();
    let total: f64 = mass.iter().sum();
    let mut found = vec![0u32; bins];
    for i in 0..n / 4 {
        for word in rng_draw([seed, 0x0d57], i, 0, 0) {
            let d = f64::from(draw(word));
            assert!((MIN * (1.0 - 1e-6)..=MAX * (1.0 + 1e-6)).contains(&d), "{d}");
            found[((ops::ln(d / MIN) / growth) as usize).min(bins - 1)] += 1;
        }
    }
    // Neighboring bins are merged until 5 are expected.
    let (mut chi2, mut joined, mut expected, mut seen) = (0.0, 0, 0.0, 0);
    let mut rest = f64::from(n);
    for (m, count) in mass.iter().zip(&found) {
        expected += f64::from(n) * m / total;
        seen += count;
        if expected >= 5.0 && rest - expected >= 5.0 {
            chi2 += (f64::from(seen) - expected) * (f64::from(seen) - expected) / expected;
            rest -= expected;
            (joined, expected, seen) = (joined + 1, 0.0, 0);
        }
    }
    chi2 += (f64::from(seen) - expected) * (f64::from(seen) - expected) / expected;
    assert!(joined >= 100, "{joined} bins");
    chance(chi2, f64::from(joined))
}

/// Significance of one test by Sidak, so that all of them together have 1 %.
fn significance() -> f64 {
    1.0 - ops::pow(0.99, 1.0 / TESTS)
}

#[test]
fn tables_draw_what_they_are_made_from() {
    let mut least: f64 = 1.0;
    for (seed, law) in (0..).zip(LAWS) {
        let rain = DropSizeDistribution::new(law, 20.0).unwrap();
        for by in [SampledBy::Number, SampledBy::Flux] {
            let table = rain.sample_table(by);
            let n = if law == DropSizeLaw::default() { 1_000_000 } else { 200_000 };
            let p = chi_square(seed * 2 + by as u32, n, density(&rain, by), |word| table.sample(word));
            assert!(p > significance(), "{law:?} by {by:?}: {p}");
            least = least.min(p);
        }
    }
    println!("least chance: {least}");
}

#[test]
fn the_exponential_form_draws_its_law() {
    for (seed, rate) in [(101, 1.0), (102, 100.0)] {
        let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate).unwrap();
        let slope = rain.exponential_slope().unwrap() as f32;
        let draw = |word| distribution_sample_exponential(word, slope, MIN as f32, MAX as f32);
        let p = chi_square(seed, 1_000_000, density(&rain, SampledBy::Number), draw);
        assert!(p > significance(), "{rate} mm/h: {p}");
    }
}

/// The test detects the difference between drops in a volume and drops through a plane, and a slope 5 % off.
#[test]
fn the_chi_square_finds_what_is_wrong() {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 20.0).unwrap();
    let table = rain.sample_table(SampledBy::Number);
    assert!(chi_square(201, 200_000, density(&rain, SampledBy::Flux), |word| table.sample(word)) < 1e-6);
    let other = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0).unwrap();
    assert!(chi_square(201, 200_000, density(&other, SampledBy::Number), |word| table.sample(word)) < 1e-6);
}

/// Down to single words on both sides: the fraction of drops beyond the diameter of a word is the fraction of words
/// beyond.
#[test]
fn the_rarest_drops_are_drawn_as_rarely_as_they_are() {
    for (law, by) in LAWS.into_iter().zip([SampledBy::Number, SampledBy::Flux].into_iter().cycle()) {
        let rain = DropSizeDistribution::new(law, 20.0).unwrap();
        let table = rain.sample_table(by);
        let density = density(&rain, by);
        // In the logarithm of the diameter, as some laws are steep for small drops; not across the step of the speed.
        let part =
            |a: f64, b: f64| simpson(400, ops::ln(a), ops::ln(b), |x| ops::exp(x) * density(ops::exp(x)));
        let between = |a: f64, b: f64| {
            let step = 1.07e-3;
            if a < step && step < b { part(a, step) + part(step, b) } else { part(a, b) }
        };
        let total = between(MIN, MAX);
        for words in [0u32, 1, 5, 100, 3000, 1_000_000, 77_777_777, 1_999_999_999] {
            let expected = (f64::from(words) + 0.5) / 4_294_967_296.0 * total;
            let (small, large) = (f64::from(table.sample(words)), f64::from(table.sample(!words)));
            for (found, d) in [(between(MIN, small), small), (between(large, MAX), large)] {
                // f32 has a relative error of 6e-8 in the diameter.
                let rounding = 2e-7 * d * density(d);
                assert_relative_eq!(found, expected, max_relative = 2e-4, epsilon = rounding);
            }
        }
    }
}

#[test]
fn a_larger_word_is_a_larger_drop() {
    let rain = DropSizeDistribution::new(DropSizeLaw::Best1950, 50.0).unwrap();
    let table = rain.sample_table(SampledBy::Flux);
    assert_eq!(table.nodes().len(), SampleTable::NODES);
    let slope = 2500.0;
    let (mut before, mut before_exponential) = (0.0, 0.0);
    for word in (0..u32::MAX - 9973).step_by(9973).chain(u32::MAX - 9973..=u32::MAX) {
        let d = table.sample(word);
        assert!(d >= before, "{word}: {d} after {before}");
        before = d;
        let d = distribution_sample_exponential(word, slope, 0.1e-3, 8e-3);
        assert!(d >= before_exponential, "{word}: {d} after {before_exponential}");
        before_exponential = d;
    }
    assert!(before > 5e-3 && before_exponential > 7e-3, "{before} {before_exponential}");
}

/// The table of an exponential law agrees with its closed form.
#[test]
fn the_table_and_the_closed_form_agree() {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 10.0).unwrap();
    let (table, slope) = (rain.sample_table(SampledBy::Number), rain.exponential_slope().unwrap() as f32);
    for i in 0..100_000u32 {
        let word = i.wrapping_mul(0x9e37_79b9);
        let exact = distribution_sample_exponential(word, slope, MIN as f32, MAX as f32);
        assert_relative_eq!(table.sample(word), exact, max_relative = 6e-5);
    }
}

/// Drops drawn from those that cross a plane carry the rate, if each represents its fraction of the impacts.
#[test]
fn what_falls_through_a_plane_carries_the_rate() {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 10.0).unwrap();
    let table = rain.sample_table(SampledBy::Flux);
    let n = 400_000;
    let volume: f64 = (0..n / 4)
        .flat_map(|i| rng_draw([11, 0], i, 0, 0))
        .map(|word| {
            let d = f64::from(table.sample(word));
            std::f64::consts::PI / 6.0 * d * d * d
        })
        .sum();
    let rate = volume / f64::from(n) * rain.impact_rate() * 3.6e6;
    assert_relative_eq!(rate, 10.0, max_relative = 0.02);
}

/// A restricted range is drawn as that range of the whole.
#[test]
fn a_part_is_drawn_within_its_bounds() {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 10.0).unwrap();
    let table = rain.restricted_to(1e-3, 2e-3).unwrap().sample_table(SampledBy::Number);
    assert!(table.nodes().iter().all(|d| (0.999_999e-3..=2.000_001e-3).contains(d)));
    assert_eq!(table.by(), SampledBy::Number);
}
