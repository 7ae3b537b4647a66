//! The wetness of a weather file: every key, rejected values, and the law over time.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;
use downpour_math::ops::f64 as ops;
use downpour_weather::Weather;
use exit_code::ExitCode as _;

fn level(text: &str, time_s: f64) -> f64 {
    let weather = Weather::parse("w.toml", text).unwrap();
    weather.wetness_at(time_s).map_or(0.0, |at| at.level())
}

#[track_caller]
fn says(text: &str, words: &str) {
    let error = Weather::parse("w.toml", text).unwrap_err();
    assert_eq!(error.exit_code(), 2, "{error}");
    assert!(error.to_string().contains(words), "{error}\n  has not: {words}");
}

/// A rain of 10 mm/h has left 1.667 mm after ten minutes: 5.56 storages.
#[test]
fn a_steady_rain_has_wetted_the_street() {
    assert!((level("", 0.0) - (1.0 - ops::exp(-5.555_555_6))).abs() < 1.0e-6);
    assert!((level("[rain]\nrate_mm_h = 1", 0.0) - (1.0 - ops::exp(-0.555_555_56))).abs() < 1.0e-6);
    assert_eq!(level("[rain]\nrate_mm_h = 0", 0.0), 0.0);
    assert_eq!(level("[wetness]\nenabled = false", 100.0), 0.0);
    assert!((level("[wetness]\nwetness = 0.7", 100.0) - 0.7).abs() < 1.0e-9);
    assert!(level("[wetness]\nwetness = 1", 0.0) > 0.9999);
    assert_eq!(level("[wetness]\nwetness = 0", 50.0), 0.0);
}

/// 12 mm/h on a dry street with a storage of 0.6 mm: 0.2 mm in a minute, a third of the storage.
#[test]
fn rain_wets_a_dry_street_and_it_dries() {
    let text = "[rain]\nrate_mm_h = 12\n[wetness]\nrained_s = 0\nstorage_mm = 0.6";
    assert_eq!(level(text, 0.0), 0.0);
    assert_eq!(level(text, -5.0), 0.0);
    for minutes in 1..=10 {
        let expected = 1.0 - ops::exp(-f64::from(minutes) / 3.0);
        assert!((level(text, 60.0 * f64::from(minutes)) - expected).abs() < 1.0e-9);
    }
    let after = "[rain]\nrate_mm_h = 0\n[wetness]\nrained_mm = 3\ndried_s = 500\ndrying_s = 1000";
    for (time_s, left) in [(0.0, 0.606_530_66f64), (500.0, 0.367_879_44)] {
        assert!((level(after, time_s) - left).abs() < 1.0e-4, "{time_s}");
    }
    // Rain on what is half dry.
    let again = "[rain]\nrate_mm_h = 36\n[wetness]\nrained_mm = 100\ndried_s = 693.147\ndrying_s = 1000\nstorage_mm = 1";
    assert!((level(again, 100.0) - (1.0 - 0.5 * ops::exp(-1.0))).abs() < 1.0e-5);
}

/// 36 mm/h for 100 s are 1 mm, a storage; then 693 s halve it, and so on: a level surface has the wetness of the steps by hand.
#[test]
fn rain_that_comes_and_goes_wets_and_dries() {
    let text = "[rain]\nrate_mm_h = [[0, 36], [100, 36], [100.001, 0], [793.147, 0], [793.148, 36], [893.148, 36], [893.149, 0]]
        [wetness]\nrained_mm = 0\ndrying_s = 1000\nstorage_mm = 1";
    let e = ops::exp(-1.0);
    let half = 0.5 * (1.0 - e);
    let again = 1.0 - (1.0 - half) * e;
    let times = [(0.0, 0.0), (100.0, 1.0 - e), (793.147, half), (893.148, again), (1586.3, 0.5 * again)];
    for (time_s, expected) in times {
        assert!((level(text, time_s) - expected).abs() < 1.0e-4, "{time_s} s: {}", level(text, time_s));
    }
    // A rate that rises steadily from 0 brings half as much.
    let rising = "[rain]\nrate_mm_h = [[0, 0], [100, 36]]\n[wetness]\nstorage_mm = 1";
    assert!((level(rising, 100.0) - (1.0 - ops::exp(-0.5))).abs() < 1.0e-9);
}

#[test]
fn values_out_of_range_and_contradictions_are_refused() {
    says("[wetness]\nwetness = 1.5", "wetness.wetness: 1.5; allowed: 0 to 1");
    says("[wetness]\nwetness = \"wet\"", "wetness.wetness");
    says("[wetness]\nrained = 5", "unknown key \"rained\", perhaps rained_");
    says("[wetness]\nrained_s = -1", "0 to 1e6 s");
    says("[wetness]\nrained_mm = 1001", "0 to 1000 mm");
    says("[wetness]\nstorage_mm = 0", "0.01 to 10 mm");
    says("[wetness]\ndrying_s = 0", "1 to 1e7 s");
    says("[wetness]\ndried_s = nan", "0 to 1e6 s");
    says("[wetness]\nenabled = 1", "wetness.enabled");
    says("[wetness]\nrained_s = 5\nrained_mm = 1", "wetness.rained_s: beside rained_mm");
    says("[wetness]\nwetness = 0.5\nstorage_mm = 1", "wetness.storage_mm: beside a wetness that is fixed");
    says("[wetness]\nenabled = false\nwetness = 0.5", "wetness.wetness: beside enabled = false");
    says("[wetness]\nenabled = false\nreflections = \"rays\"", "wetness.reflections: beside enabled = false");
    says("[wetness]\nreflections = \"impostors\"", "wetness.reflections");
    says("[wetness]\nreflections = \"tatarchuk-2006\"\nreflection_edge = 11", "0 to 10");
    says("[wetness]\nreflection_edge = 1", "wetness.reflection_edge: beside reflections by rays");
    says("[rain]\nrate_mm_h = 0\n[wetness]\nrained_s = 60", "wetness.rained_s: a time of a rain of 0 mm/h");
}

#[test]
fn reflections_are_by_rays_or_by_name() {
    use downpour_weather::WetReflections::{Rays, Tatarchuk2006};

    let of = |text: &str| Weather::parse("w.toml", text).unwrap().wetness.reflections;
    assert_eq!(of("[wetness]"), Rays);
    assert_eq!(of("[wetness]\nreflections = \"rays\""), Rays);
    let named = "[wetness]\nreflections = \"tatarchuk-2006\"";
    assert_eq!(of(named), Tatarchuk2006 { edge: 0.5 });
    assert_eq!(of(&format!("{named}\nreflection_edge = 2")), Tatarchuk2006 { edge: 2.0 });
}
