//! Integrals of the laws, against published values, closed forms and an independent rule.

use approx::assert_relative_eq;
use downpour_drop::air::Air;
use downpour_drop::distribution::{DistributionOptions, DropSizeDistribution, DropSizeLaw, ExtinctionLaw};
use downpour_drop::fall_speed::{FallSpeedModel, TerminalSpeed};
use downpour_math::ops::f64 as ops;

use DropSizeLaw::{
    Best1950, FeingoldLevin1986, Joss1968Drizzle, Joss1968Thunderstorm, Joss1968Widespread,
    MarshallPalmer1948,
};

use crate::{LAWS, simpson, with_speeds};

/// The main property: the drops carry the requested rate.
#[test]
fn every_law_carries_the_rate_that_was_asked() {
    let mut worst = 0.0f64;
    for law in LAWS {
        for rate in [0.1, 0.5, 1.0, 5.0, 10.0, 25.0, 100.0, 500.0] {
            let rain = DropSizeDistribution::new(law, rate).unwrap();
            let speed = TerminalSpeed::new(FallSpeedModel::Beard1976, &Air::standard());
            let volume = simpson(8000, 0.1e-3, 8e-3, |d| {
                let v = speed.at(d).unwrap();
                std::f64::consts::PI / 6.0 * d * d * d * v * rain.concentration(d)
            });
            let found = volume * 3.6e6;
            assert_relative_eq!(found, rate, max_relative = 1e-6);
            assert_relative_eq!(rain.integrated_rate_mm_h(), rate, max_relative = 1e-12);
            worst = worst.max((found / rate - 1.0).abs());
        }
    }
    println!("worst rate: {worst:e}");
}

#[test]
fn every_fall_speed_and_air_carries_the_rate() {
    for fall_speed in FallSpeedModel::ALL {
        for (t, p) in [(20.0, 101_325.0), (0.0, 70_000.0)] {
            let air = Air::new(t, p).unwrap();
            let options = DistributionOptions { fall_speed, air, ..DistributionOptions::default() };
            let rain = DropSizeDistribution::with_options(MarshallPalmer1948, 10.0, &options).unwrap();
            let speed = TerminalSpeed::new(fall_speed, &air);
            let volume =
                simpson(8000, 0.1e-3, 8e-3, |d| d * d * d * speed.at(d).unwrap() * rain.concentration(d));
            assert_relative_eq!(volume * std::f64::consts::PI / 6.0 * 3.6e6, 10.0, max_relative = 2e-6);
        }
    }
}

/// Law, R, and with Gunn & Kinzer's speeds up to 8 mm: the rate, drops per m^3, g of water per m^3, extinction per km.
#[rustfmt::skip]
const CHECKS: [(DropSizeLaw, [f64; 5]); 42] = [
    (MarshallPalmer1948, [1.0, 1.1833, 1943.2, 0.08894, 0.3647]),
    (MarshallPalmer1948, [2.0, 2.3743, 2249.0, 0.15921, 0.5643]),
    (MarshallPalmer1948, [5.0, 5.8986, 2727.8, 0.34375, 1.0052]),
    (MarshallPalmer1948, [10.0, 11.6443, 3156.5, 0.61532, 1.5556]),
    (MarshallPalmer1948, [25.0, 28.2786, 3828.0, 1.32847, 2.7707]),
    (MarshallPalmer1948, [50.0, 54.7864, 4429.0, 2.37735, 4.2876]),
    (MarshallPalmer1948, [100.0, 105.0816, 5124.2, 4.25023, 6.6334]),
    (Best1950, [1.0, 1.019, 1775.9, 0.067, 0.2475]),
    (Best1950, [2.0, 2.0588, 2256.5, 0.12043, 0.3787]),
    (Best1950, [5.0, 5.1488, 3088.2, 0.26146, 0.6648]),
    (Best1950, [10.0, 10.1886, 3908.5, 0.46998, 1.0175]),
    (Best1950, [25.0, 24.7055, 5325.5, 1.02029, 1.786]),
    (Best1950, [50.0, 47.6081, 6720.8, 1.83322, 2.7332]),
    (Best1950, [100.0, 90.2505, 8473.5, 3.28162, 4.1783]),
    (FeingoldLevin1986, [1.0, 0.9144, 172.0, 0.05974, 0.1808]),
    (FeingoldLevin1986, [2.0, 1.9341, 200.3, 0.11217, 0.2896]),
    (FeingoldLevin1986, [5.0, 5.1287, 245.1, 0.25772, 0.5396]),
    (FeingoldLevin1986, [10.0, 10.5915, 285.4, 0.48263, 0.8632]),
    (FeingoldLevin1986, [25.0, 27.0391, 349.2, 1.09981, 1.6024]),
    (FeingoldLevin1986, [50.0, 53.6835, 406.7, 2.03177, 2.5481]),
    (FeingoldLevin1986, [100.0, 103.4119, 473.7, 3.69141, 4.0222]),
    (Joss1968Drizzle, [1.0, 0.8946, 5233.2, 0.08928, 0.5089]),
    (Joss1968Drizzle, [2.0, 1.8227, 6057.9, 0.15982, 0.7876]),
    (Joss1968Drizzle, [5.0, 4.6223, 7349.6, 0.34507, 1.4028]),
    (Joss1968Drizzle, [10.0, 9.2713, 8505.9, 0.61769, 2.1709]),
    (Joss1968Drizzle, [25.0, 23.0207, 10317.0, 1.33365, 3.8668]),
    (Joss1968Drizzle, [50.0, 45.4253, 11938.3, 2.38729, 5.9841]),
    (Joss1968Drizzle, [100.0, 88.9538, 13813.5, 4.27325, 9.2607]),
    (Joss1968Widespread, [1.0, 1.0354, 1700.3, 0.07782, 0.3191]),
    (Joss1968Widespread, [2.0, 2.0775, 1967.8, 0.13931, 0.4938]),
    (Joss1968Widespread, [5.0, 5.1613, 2386.9, 0.30078, 0.8795]),
    (Joss1968Widespread, [10.0, 10.1887, 2762.0, 0.53841, 1.3611]),
    (Joss1968Widespread, [25.0, 24.7438, 3349.5, 1.16241, 2.4243]),
    (Joss1968Widespread, [50.0, 47.9381, 3875.4, 2.08018, 3.7516]),
    (Joss1968Widespread, [100.0, 91.9464, 4483.7, 3.71896, 5.8042]),
    (Joss1968Thunderstorm, [1.0, 0.9152, 465.3, 0.0543, 0.1629]),
    (Joss1968Thunderstorm, [2.0, 1.8089, 538.4, 0.0972, 0.2521]),
    (Joss1968Thunderstorm, [5.0, 4.4012, 652.9, 0.20985, 0.449]),
    (Joss1968Thunderstorm, [10.0, 8.5404, 755.4, 0.37556, 0.6949]),
    (Joss1968Thunderstorm, [25.0, 20.2041, 916.0, 0.8095, 1.2372]),
    (Joss1968Thunderstorm, [50.0, 38.1794, 1059.8, 1.4419, 1.9121]),
    (Joss1968Thunderstorm, [100.0, 70.8647, 1225.9, 2.54841, 2.9475]),
];

#[test]
fn published_laws_have_their_tabulated_integrals() {
    for (law, [rate, carried, number, water, extinction]) in CHECKS {
        let rain =
            DropSizeDistribution::published(law, rate, &with_speeds(1e-3, FallSpeedModel::GunnKinzer1949))
                .unwrap();
        // Best's unbounded number of drops is counted from 0.05 mm.
        let counted = if law == Best1950 { rain.restricted_to(0.05e-3, 8e-3).unwrap() } else { rain.clone() };
        let grams = rain.liquid_water() * 1e3 * 1000.0 / Air::standard().water_density();
        for (found, expected, digit) in [
            (rain.integrated_rate_mm_h(), carried, 5e-5),
            (counted.number_density(), number, 0.05),
            (grams, water, 5e-6),
            (rain.extinction() * 1e3, extinction, 5e-5),
        ] {
            let bound = digit + 2e-5 * expected;
            assert!((found - expected).abs() < bound, "{law:?} at {rate} mm/h: {found} for {expected}");
        }
    }
}

/// Marshall & Palmer at 10 mm/h, full distribution as published: the closed forms.
#[test]
fn marshall_and_palmer_at_ten() {
    let options =
        DistributionOptions { max_diameter_m: 9e-3, ..with_speeds(0.0, FallSpeedModel::GunnKinzer1949) };
    let rain = DropSizeDistribution::published(MarshallPalmer1948, 10.0, &options).unwrap();
    let slope = rain.exponential_slope().unwrap() * 1e-3;
    assert!((slope - 2.528).abs() < 5e-4, "{slope}");
    assert_relative_eq!(rain.number_density(), 8000.0 / slope, max_relative = 1e-9);
    assert!((rain.number_density() - 3165.0).abs() < 1.0);
    assert_relative_eq!(rain.median_volume_diameter() * 1e3, 3.672 / slope, max_relative = 1e-4);
    assert!((rain.median_volume_diameter() * 1e3 - 1.45).abs() < 0.005);
    let water = std::f64::consts::PI * 8000.0 * 1e-6 / ops::pow(slope, 4.0);
    assert_relative_eq!(rain.liquid_water(), water * 0.998_204, max_relative = 1e-5);
    assert!((rain.liquid_water() * 1e3 - 0.615).abs() < 0.002);
    assert!((rain.impact_rate() - 4774.0).abs() < 1.0, "{}", rain.impact_rate());
    // Mean diameters and reflectivity of an exponential law: (k + 1)! / (k! Lambda); N0 6! / Lambda^7.
    assert_relative_eq!(rain.mean_diameter() * 1e3, 1.0 / slope, max_relative = 1e-7);
    assert_relative_eq!(rain.effective_diameter() * 1e3, 3.0 / slope, max_relative = 1e-6);
    assert_relative_eq!(rain.mass_weighted_diameter() * 1e3, 4.0 / slope, max_relative = 1e-5);
    assert_relative_eq!(
        rain.reflectivity() * 1e18,
        8000.0 * 720.0 / ops::pow(slope, 7.0),
        max_relative = 1e-4
    );
    assert_relative_eq!(rain.moment(6.0), rain.reflectivity(), max_relative = 1e-12);
    let sigma = ExtinctionLaw::MarshallPalmerGeometric.extinction(10.0).unwrap();
    assert_relative_eq!(rain.extinction(), sigma, max_relative = 1e-6);
}

/// Lambda D0 = 3.67 + mu, and the other form of the law agrees with it.
#[test]
fn gamma_has_its_median_volume_diameter() {
    for mu in [0.0, 1.0, 2.0, 3.0, 5.0] {
        let law = DropSizeLaw::GammaByMedian { mu, median_volume_diameter_m: 1.0e-3 };
        let options = with_speeds(0.0, FallSpeedModel::AtlasUlbrich1977);
        let rain = DropSizeDistribution::published(law, 10.0, &options).unwrap();
        assert_relative_eq!(rain.median_volume_diameter(), 1.0e-3, max_relative = 7e-4);
        // With the speeds of its closed form, the law carries its rate.
        assert_relative_eq!(rain.integrated_rate_mm_h(), 10.0, max_relative = 1e-4);
        let n0 = rain.concentration(1e-3) * 1e-3 * ops::exp(3.67 + mu);
        let other = DropSizeLaw::GammaByIntercept { mu, intercept_m3_mm: n0 };
        let other = DropSizeDistribution::published(other, 10.0, &options).unwrap();
        for d in [0.2e-3, 1e-3, 3e-3] {
            assert_relative_eq!(other.concentration(d), rain.concentration(d), max_relative = 1e-9);
        }
    }
    // mu = 0 and N0 = 8000 is Marshall & Palmer's form.
    let exponential = DropSizeLaw::GammaByIntercept { mu: 0.0, intercept_m3_mm: 8000.0 };
    let rain = DropSizeDistribution::new(exponential, 10.0).unwrap();
    let slope = rain.exponential_slope().unwrap() * 1e-3;
    assert!((slope - 2.528).abs() < 0.15, "{slope}");
}

/// The documented losses of the default diameters.
#[test]
fn cuts_are_as_small_as_said() {
    let all = |law: DropSizeLaw, rate: f64, smallest_mm: f64| {
        let options = DistributionOptions {
            max_diameter_m: 9e-3,
            ..with_speeds(smallest_mm, FallSpeedModel::default())
        };
        DropSizeDistribution::published(law, rate, &options).unwrap()
    };
    let kept = |rain: &DropSizeDistribution| rain.restricted_to(0.1e-3, 9e-3).unwrap();
    let rain = all(MarshallPalmer1948, 10.0, 0.0);
    let small = kept(&rain);
    assert_relative_eq!(1.0 - small.number_density() / rain.number_density(), 0.223, epsilon = 5e-4);
    assert!(1.0 - small.liquid_water() / rain.liquid_water() < 2e-4);
    assert!(1.0 - small.integrated_rate() / rain.integrated_rate() < 5.5e-6);
    let light = all(Best1950, 0.1, 1e-3);
    assert!(1.0 - kept(&light).integrated_rate() / light.integrated_rate() < 6.5e-4);
    // Above 8 mm: against the unbounded law, with the speed held.
    for (law, rate, fraction) in [
        (MarshallPalmer1948, 100.0, 0.0021),
        (Best1950, 100.0, 0.0055),
        (MarshallPalmer1948, 500.0, 0.0268),
        (Best1950, 500.0, 0.1067),
    ] {
        let rain = all(law, rate, 0.1);
        let beyond = simpson(4000, 9e-3, 25e-3, |d| {
            let n = published_concentration(law, rate, d);
            std::f64::consts::PI / 6.0 * d * d * d * 9.115 * n
        });
        let total = rain.integrated_rate() + beyond;
        let cut = 1.0 - rain.restricted_to(0.1e-3, 8e-3).unwrap().integrated_rate() / total;
        assert!((cut - fraction).abs() < 5e-4, "{law:?} {rate}: {cut}");
    }
}

fn published_concentration(law: DropSizeLaw, rate: f64, d: f64) -> f64 {
    let mm = d * 1e3;
    1e3 * if law == Best1950 {
        let (a, w) = (1.3 * ops::pow(rate, 0.232), 67.0 * ops::pow(rate, 0.846));
        let x = ops::pow(mm / a, 2.25);
        w * 2.25 / mm * x * ops::exp(-x) * 6.0 / (std::f64::consts::PI * mm * mm * mm)
    } else {
        8000.0 * ops::exp(-4.1 * ops::pow(rate, -0.21) * mm)
    }
}

/// Parts add up to the whole.
#[test]
fn a_rain_is_the_sum_of_its_parts() {
    let rain = DropSizeDistribution::new(FeingoldLevin1986, 30.0).unwrap();
    let edges = [0.1e-3, 0.3333e-3, 1.07e-3, 2.2e-3, 8e-3];
    let parts: Vec<_> = edges.windows(2).map(|e| rain.restricted_to(e[0], e[1]).unwrap()).collect();
    for quantity in [
        DropSizeDistribution::number_density,
        DropSizeDistribution::integrated_rate,
        DropSizeDistribution::extinction,
        DropSizeDistribution::impact_rate,
    ] {
        assert_relative_eq!(parts.iter().map(quantity).sum::<f64>(), quantity(&rain), max_relative = 1e-10);
    }
    assert!(rain.restricted_to(0.05e-3, 1e-3).is_err());
}

/// Half of the water on either side.
#[test]
fn the_median_volume_diameter_halves_the_water() {
    for law in LAWS {
        let rain = DropSizeDistribution::new(law, 20.0).unwrap();
        let below = rain.restricted_to(0.1e-3, rain.median_volume_diameter()).unwrap();
        assert_relative_eq!(below.liquid_water() / rain.liquid_water(), 0.5, max_relative = 1e-10);
    }
}
