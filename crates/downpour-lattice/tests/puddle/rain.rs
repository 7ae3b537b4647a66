//! Drawn impacts have the statistics of the rain: number, water, positions.

use std::f64::consts::PI;

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_lattice::puddle::{Impact, PuddleRain};

fn rain(rate_mm_h: f64) -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h).expect("a rain")
}

#[test]
fn number_and_water_are_those_of_the_rate() {
    for rate in [2.5, 25.0, 100.0] {
        let law = rain(rate);
        let drawn = PuddleRain::new(&law, 3);
        let (extent, dt, steps) = ([0.5f32, 0.4], 1.0 / 60.0, 1200u64);
        let (mut count, mut square, mut water, mut water_square) = (0.0, 0.0, 0.0, 0.0);
        for step in 0..steps {
            let impacts = drawn.impacts(extent, step, dt).expect("impacts");
            let n = impacts.len() as f64;
            count += n;
            square += n * n;
            for impact in impacts {
                let d = f64::from(impact.diameter_m);
                let volume = PI / 6.0 * d * d * d;
                water += volume;
                water_square += volume * volume;
                assert!(
                    (0.0..0.5).contains(&impact.position_m[0]) && (0.0..0.4).contains(&impact.position_m[1])
                );
                assert!(impact.speed_m_s > 0.0 && impact.speed_m_s < 10.0);
            }
        }
        let time = steps as f64 * f64::from(dt);
        let expected = law.impact_rate() * 0.2 * time;
        // Poisson: the variance of the number is the number; 4 sigma.
        assert!(
            (count - expected).abs() < 4.0 * expected.sqrt(),
            "{rate} mm/h: {count} drops, law {expected}"
        );
        let mean = count / steps as f64;
        let spread = square / steps as f64 - mean * mean;
        assert!((spread / mean - 1.0).abs() < 4.0 * (2.0 / steps as f64).sqrt() + 0.05, "{spread} of {mean}");
        // Water in m: rate times time, within 4 sigma of a compound Poisson sum.
        let expected = rate * 1.0e-3 / 3600.0 * time * 0.2;
        assert!(
            (water - expected).abs() < 4.0 * water_square.sqrt(),
            "{rate} mm/h: {water} m^3, law {expected}"
        );
        assert!(water_square.sqrt() < 0.05 * expected, "too few drops to tell");
    }
}

/// Without drops that bring a hundredth of the energy, the others are those that they were, and less than half of all.
#[test]
fn most_drops_bring_next_to_no_energy() {
    let law = rain(100.0);
    let all = PuddleRain::new(&law, 3);
    let told = all.clone().without_weakest(&law, 0.01);
    let energy = |impacts: &[Impact]| -> f64 {
        let of = |i: &Impact| [i.diameter_m, i.speed_m_s].map(f64::from);
        impacts.iter().map(of).map(|[d, v]| d * d * d * v * v).sum()
    };
    let (mut count, mut sum) = ([0; 2], [0.0; 2]);
    for step in 0..4 {
        let [before, after] = [&all, &told].map(|rain| rain.impacts([4.0, 4.0], step, 0.1).expect("impacts"));
        let mut rest = before.iter();
        assert!(after.iter().all(|impact| rest.any(|other| other == impact)), "the same drops");
        for (k, impacts) in [&before, &after].into_iter().enumerate() {
            count[k] += impacts.len();
            sum[k] += energy(impacts);
        }
    }
    let left_out = 1.0 - sum[1] / sum[0];
    assert!((0.005..0.015).contains(&left_out), "{left_out} of the energy");
    assert!(count[1] * 2 < count[0], "{count:?} drops");
    assert_eq!(told.rate(), all.rate());
}

#[test]
fn sizes_are_those_of_the_flux() {
    let law = rain(25.0);
    let drawn = PuddleRain::new(&law, 11);
    let impacts = drawn.impacts([20.0, 20.0], 5, 0.2).expect("impacts");
    // Halves by number, at the median of N v.
    let large = law.restricted_to(1.0e-3, 8.0e-3).expect("large drops").impact_rate() / law.impact_rate();
    let fraction = impacts.iter().filter(|i| i.diameter_m > 1.0e-3).count() as f64 / impacts.len() as f64;
    let sigma = (large * (1.0 - large) / impacts.len() as f64).sqrt();
    assert!(impacts.len() > 10_000);
    assert!((fraction - large).abs() < 4.0 * sigma, "{fraction}, law {large}");
}

/// Positions and steps are uniform: chi-square over 16 x 16 fields.
#[test]
fn places_are_even_and_steps_differ() {
    let drawn = PuddleRain::new(&rain(25.0), 1);
    let mut bins = [0.0f64; 256];
    let mut n = 0.0;
    for step in 0..20 {
        for impact in drawn.impacts([4.0, 4.0], step, 0.5).expect("impacts") {
            let [x, y] = impact.position_m.map(|v| ((v * 4.0) as usize).min(15));
            bins[y * 16 + x] += 1.0;
            n += 1.0;
        }
    }
    let expected = n / 256.0;
    let chi2: f64 = bins.iter().map(|b| (b - expected) * (b - expected) / expected).sum();
    // 255 degrees of freedom: above 340 once in 3000 draws.
    assert!(expected > 100.0 && chi2 < 340.0, "{chi2}");
    let at = |step| drawn.impacts([1.0, 1.0], step, 0.1).expect("impacts");
    assert_eq!(at(7), at(7));
    assert_ne!(at(7), at(8));
    assert_ne!(at(7), at(7 + (1 << 32)));
}

#[test]
fn dry_weather_and_bad_numbers() {
    assert!(PuddleRain::new(&rain(0.0), 1).impacts([1.0, 1.0], 0, 1.0).expect("dry").is_empty());
    let drawn = PuddleRain::new(&rain(25.0), 1);
    for (extent, dt) in [
        ([f32::NAN, 1.0], 0.1),
        ([1.0, -1.0], 0.1),
        ([1.0, 1.0], f32::NAN),
        ([1.0, 1.0], -0.1),
        ([1.0e5, 1.0e5], 10.0),
    ] {
        drawn.impacts(extent, 0, dt).expect_err("impacts");
    }
}
