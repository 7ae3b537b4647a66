//! The drips of a weather file: every key, and rejected values.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;
use downpour_weather::{DripPoint, Drips, Weather};
use exit_code::ExitCode as _;
use glam::DVec3;

#[track_caller]
fn says(text: &str, words: &str) {
    let error = Weather::parse("w.toml", text).unwrap_err();
    assert_eq!(error.exit_code(), 2, "{error}");
    assert!(error.to_string().contains(words), "{error}\n  has not: {words}");
}

#[test]
fn every_key_is_read() {
    let text = "[drips]\nenabled = false\n[[drip]]\nposition_m = [1, 2, -3]\nper_second = 0.5\n\
                [[drip]]\nposition_m = [0, 4, 0]\nper_second = 40\ndiameter_mm = 2.5";
    let drips = Weather::parse("w.toml", text).unwrap().drips;
    let first = DripPoint { position: DVec3::new(1.0, 2.0, -3.0), per_s: 0.5, diameter_m: None };
    let second = DripPoint { position: DVec3::Y * 4.0, per_s: 40.0, diameter_m: Some(2.5e-3) };
    assert_eq!(drips, Drips { is_enabled: false, points: vec![first, second] });
    assert_eq!(Weather::parse("w.toml", "").unwrap().drips, Drips { is_enabled: false, points: Vec::new() });
}

#[test]
fn values_out_of_range_are_refused() {
    says("[drips]\nenable = true", "unknown key \"enable\", perhaps enabled");
    says("[drips]\nenabled = 1", "drips.enabled");
    says("[drip]\nper_second = 1", "drip");
    says("[[drip]]\nper_second = 1", "position_m");
    says("[[drip]]\nposition_m = [0, 1, 0]", "per_second");
    says("[[drip]]\nposition_m = [0, 1]\nper_second = 1", "3 numbers");
    says("[[drip]]\nposition_m = [0, inf, 0]\nper_second = 1", "-1e7 to 1e7 m");
    says("[[drip]]\nposition_m = [0, 1, 0]\nper_second = 0", "0.001 to 1000 drops per second");
    says("[[drip]]\nposition_m = [0, 1, 0]\nper_second = nan", "0.001 to 1000");
    says("[[drip]]\nposition_m = [0, 1, 0]\nper_second = 1\ndiameter_mm = 9", "0.5 to 6.4 mm");
    says("[[drip]]\nposition_m = [0, 1, 0]\nper_second = 1\nsize = 9", "unknown key \"size\"");
    let many = "[[drip]]\nposition_m = [0, 1, 0]\nper_second = 1\n".repeat(4097);
    let error = Weather::parse("w.toml", &many).unwrap_err();
    assert_eq!(error.exit_code(), 3, "{error}");
    assert!(error.to_string().contains("4097 times [[drip]]; allowed: at most 4096"), "{error}");
}
