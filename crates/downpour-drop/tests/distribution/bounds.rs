//! Dry weather, the lightest rain, and rejected numbers.

use approx::assert_relative_eq;
use downpour_drop::DropError;
use downpour_drop::distribution::{
    DistributionOptions, DropSizeDistribution, DropSizeLaw, ExtinctionLaw, SampledBy,
};
use downpour_drop::fall_speed::FallSpeedModel;
use downpour_math::OutOfRange;

use DropSizeLaw::{Best1950, FeingoldLevin1986, MarshallPalmer1948};

use crate::{LAWS, with_speeds};

#[test]
fn dry_weather_is_dry() {
    for law in LAWS {
        for rain in [
            DropSizeDistribution::new(law, 0.0).unwrap(),
            DropSizeDistribution::published(law, 0.0, &DistributionOptions::default()).unwrap(),
        ] {
            let quantities = [
                rain.rate_mm_h(),
                rain.scale(),
                rain.concentration(1e-3),
                rain.number_density(),
                rain.liquid_water(),
                rain.integrated_rate_mm_h(),
                rain.impact_rate(),
                rain.extinction(),
                rain.reflectivity(),
                rain.mean_diameter(),
                rain.effective_diameter(),
                rain.mass_weighted_diameter(),
                rain.median_volume_diameter(),
            ];
            assert_eq!(quantities, [0.0; 13], "{law:?}");
            assert_eq!(rain.visibility(), f64::INFINITY);
        }
        let table = DropSizeDistribution::new(law, 0.0).unwrap().sample_table(SampledBy::Number);
        assert!(table.nodes().iter().all(|d| d.is_finite()));
    }
}

/// A rate close to zero is carried too, by fewer drops of the same distribution.
#[test]
fn the_lightest_rain_is_carried() {
    for law in LAWS {
        for rate in [5e-324, f64::MIN_POSITIVE, 1e-30, 1e-6, 0.05] {
            let rain = DropSizeDistribution::new(law, rate).unwrap();
            // The smallest f64 is rounded away.
            assert_relative_eq!(rain.integrated_rate_mm_h(), rate, max_relative = 1e-9, epsilon = 1e-300);
            let tenth = DropSizeDistribution::new(law, 0.1).unwrap();
            if rate > 1e-300 {
                assert_relative_eq!(rain.median_volume_diameter(), tenth.median_volume_diameter());
            }
        }
    }
}

#[test]
fn numbers_outside_are_errors() {
    for law in LAWS {
        for rate in [-0.1, 501.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -f64::MIN_POSITIVE] {
            assert!(
                matches!(DropSizeDistribution::new(law, rate), Err(DropError::OutOfRange(OutOfRange { .. }))),
                "{rate}"
            );
        }
    }
    for rate in [-0.1, 501.0, f64::NAN] {
        assert!(ExtinctionLaw::Weber2015.extinction(rate).is_err());
    }
    let message = DropSizeDistribution::new(Best1950, 501.0).unwrap_err().to_string();
    assert_eq!(message, "rain rate is 501 mm/h; allowed: 0 to 500 mm/h");
    for (smallest, largest) in [
        (1e-3, 1e-3),
        (2e-3, 1e-3),
        (-1e-4, 8e-3),
        (1e-4, 9.1e-3),
        (f64::NAN, 8e-3),
        (1e-4, f64::NAN),
        (1e-9, 8e-3),
    ] {
        let options = DistributionOptions {
            min_diameter_m: smallest,
            max_diameter_m: largest,
            ..DistributionOptions::default()
        };
        assert!(DropSizeDistribution::with_options(MarshallPalmer1948, 1.0, &options).is_err());
        let rain = DropSizeDistribution::new(MarshallPalmer1948, 1.0).unwrap();
        assert!(rain.restricted_to(smallest, largest).is_err());
    }
    // A range from 0 is allowed only for laws with a finite number of drops.
    let from_nothing = with_speeds(0.0, FallSpeedModel::default());
    assert!(DropSizeDistribution::with_options(FeingoldLevin1986, 1.0, &from_nothing).is_ok());
    assert!(DropSizeDistribution::with_options(Best1950, 1.0, &from_nothing).is_err());
    for (mu, median, intercept) in [
        (-3.1, 1e-3, 1e3),
        (8.1, 1e-3, 1e3),
        (f64::NAN, 1e-3, 1e3),
        (1.0, 0.0, 0.0),
        (1.0, 6e-3, 1e11),
        (1.0, f64::NAN, -1.0),
    ] {
        let by_median = DropSizeLaw::GammaByMedian { mu, median_volume_diameter_m: median };
        let by_intercept = DropSizeLaw::GammaByIntercept { mu, intercept_m3_mm: intercept };
        assert!(DropSizeDistribution::new(by_median, 1.0).is_err());
        assert!(DropSizeDistribution::new(by_intercept, 1.0).is_err());
    }
}

/// Extreme parameters of the gamma law carry their rate.
#[test]
fn every_gamma_law_that_is_accepted_carries_its_rate() {
    for mu in [-3.0, -1.0, 0.0, 8.0] {
        for rate in [0.1, 10.0, 500.0] {
            for median_volume_diameter_m in [0.2e-3, 5e-3] {
                let law = DropSizeLaw::GammaByMedian { mu, median_volume_diameter_m };
                let rain = DropSizeDistribution::new(law, rate).unwrap();
                assert_relative_eq!(rain.integrated_rate_mm_h(), rate, max_relative = 1e-9);
                assert!(rain.number_density().is_finite());
            }
            for intercept_m3_mm in [1e-2, 1e3, 1e10] {
                let law = DropSizeLaw::GammaByIntercept { mu, intercept_m3_mm };
                // Drops too small to be rain are rejected.
                let Ok(rain) = DropSizeDistribution::new(law, rate) else {
                    assert!(intercept_m3_mm > 1e3 || mu < 0.0, "{law:?} at {rate} mm/h");
                    continue;
                };
                assert_relative_eq!(rain.integrated_rate_mm_h(), rate, max_relative = 1e-9);
                if rate == 10.0 {
                    let table = rain.sample_table(SampledBy::Flux);
                    assert!(table.nodes().iter().all(|d| (1e-4..=8e-3).contains(d)));
                }
            }
        }
    }
}
