//! `downpour rain`: it carries the requested rate.

use crate::child::downpour;

const DISTRIBUTIONS: [&str; 8] = [
    "marshall-palmer",
    "best",
    "gamma",
    "feingold-levin",
    "lognormal",
    "joss-drizzle",
    "joss-widespread",
    "joss-thunderstorm",
];

/// The numbers that scripts depend on, besides the rate and the visibility.
const CONTRACT: [&str; 6] = [
    "number_m3",
    "liquid_water_g_m3",
    "median_volume_diameter_mm",
    "integrated_rate_mm_h",
    "extinction_km",
    "impacts_m2_s",
];

/// Marshall & Palmer at 10 mm/h: slope 4.1 R^-0.21 = 2.53 per mm, so D0 = 3.67 / slope = 1.45 mm; 8000 / slope = 3160
/// drops as published, of which 78 % are above 0.1 mm, times 0.86 to carry the rate; extinction near 0.365 R^0.63 times
/// 0.86 = 1.34 per km.
#[test]
fn ten_millimeters_an_hour_are_what_marshall_and_palmer_measured() {
    let json = downpour(&["rain", "--rate", "10", "--json"]).succeeded().json();
    assert_eq!(json["distribution"], "marshall-palmer");
    for (key, value, tolerance) in [
        ("rate_mm_h", 10.0, 0.0),
        ("integrated_rate_mm_h", 10.0, 1.0e-8),
        ("median_volume_diameter_mm", 1.45, 0.01),
        ("number_m3", 2115.0, 25.0),
        ("extinction_km", 1.336, 0.01),
        ("visibility_km", 3.912 / 1.336, 0.02),
    ] {
        let found = json[key].as_f64().unwrap_or_else(|| panic!("{key} of {json}"));
        assert!((found - value).abs() <= tolerance, "{key}: {found}, not {value}");
    }
}

#[test]
fn every_distribution_carries_its_rate() {
    for name in DISTRIBUTIONS {
        for rate in ["0.001", "0.1", "1", "25", "500"] {
            let arguments = ["rain", "--json", "--rate", rate, "--distribution", name];
            let json = downpour(&arguments).succeeded().json();
            let asked: f64 = rate.parse().unwrap();
            let carried = json["integrated_rate_mm_h"].as_f64().unwrap();
            assert!((carried / asked - 1.0).abs() < 1.0e-8, "{name} at {rate}: {carried}");
            for key in CONTRACT.iter().chain(&["visibility_km"]) {
                assert!(
                    json[key].as_f64().is_some_and(|value| value > 0.0),
                    "{name} at {rate}: {key} of {json}"
                );
            }
        }
    }
}

/// As printed, Marshall & Palmer's drops carry 16 % more than their rate.
#[test]
fn a_published_law_is_left_as_it_was_printed() {
    let json = downpour(&["rain", "--json", "--rate", "10", "--published"]).succeeded().json();
    let carried = json["integrated_rate_mm_h"].as_f64().unwrap();
    assert!((carried - 11.6).abs() < 0.1, "{carried}");
}

#[test]
fn a_dry_sky_is_clear() {
    for zero in ["0", "-0", "0e5"] {
        let ended = downpour(&["rain", "--rate", zero, "--json"]).succeeded();
        let json = ended.json();
        for key in CONTRACT.iter().chain(&["rate_mm_h"]) {
            assert_eq!(json[key].as_f64(), Some(0.0), "{key}");
        }
        assert!(json["visibility_km"].is_null());
        assert!(!ended.stdout.contains("-0"), "{}", ended.stdout);
        assert!(
            downpour(&["rain", "--rate", zero])
                .succeeded()
                .stdout
                .contains("visibility                       unlimited")
        );
    }
}

#[test]
fn the_gamma_law_takes_its_parameters() {
    let gamma = |more: &[&str]| {
        let json = downpour(&[&["rain", "--json", "--rate", "10", "--distribution", "gamma"], more].concat());
        json.succeeded().json()["median_volume_diameter_mm"].as_f64().unwrap()
    };
    // Truncation below 0.1 and above 8 mm shifts the median by less than 2 %.
    assert!((gamma(&["--median-diameter", "1.2"]) / 1.2 - 1.0).abs() < 0.02);
    assert!(gamma(&["--gamma-shape", "0", "--intercept", "8000"]) > 1.3);
    let exponential = gamma(&["--gamma-shape=0"]);
    assert!((exponential / 1.45 - 1.0).abs() < 0.02, "{exponential}");
}

#[test]
fn rates_and_parameters_out_of_range_are_refused() {
    for rate in ["-1", "500.1", "1e39", "nan", "inf", "-inf", "1e-46", "ten", ""] {
        let quoted = format!("'{rate}'");
        downpour(&["rain", "--rate", rate])
            .failed(2, &["--rate", &quoted, "allowed: 0 to 500 mm/h"])
            .with_one_line();
    }
    for (more, words) in [
        (&["--distribution", "uniform"][..], &["uniform", "marshall-palmer", "best", "gamma"][..]),
        (&["--median-diameter", "1"], &["--median-diameter", "--distribution gamma"]),
        (&["--distribution", "gamma", "--median-diameter", "6"], &["'6'", "0.2 to 5 mm"]),
        (&["--distribution", "gamma", "--gamma-shape", "-4"], &["'-4'", "-3 to 8"]),
        (&["--distribution", "gamma", "--intercept", "0"], &["'0'", "0.01 to 1e10"]),
        (
            &["--distribution", "gamma", "--intercept", "1", "--median-diameter", "1"],
            &["cannot be used with"],
        ),
        // The slope that follows is too steep for any rain.
        (
            &["--distribution", "gamma", "--intercept", "1e10", "--gamma-shape", "0"],
            &["slope", "at most 100 per mm"],
        ),
        (&["--temperature", "-20.1"], &["'-20.1'", "-20 to 40 C"]),
        (&["--temperature", "60"], &["'60'", "-20 to 40 C"]),
    ] {
        downpour(&[&["rain", "--rate", "0.1"], more].concat()).failed(2, words).with_one_line();
    }
}
