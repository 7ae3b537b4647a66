//! The lightning of a weather file: every key, rejected values, light over exposures, and the limit.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;
use downpour_math::ops::f64 as ops;
use downpour_weather::{Lightning, Weather};
use exit_code::ExitCode as _;
use std::fmt::Write as _;

fn lightning(text: &str) -> Lightning {
    Weather::parse("w.toml", text).unwrap().lightning
}

#[track_caller]
fn says(text: &str, code: u8, words: &str) {
    let error = Weather::parse("w.toml", text).unwrap_err();
    assert_eq!(error.exit_code(), code, "{error}");
    assert!(error.to_string().contains(words), "{error}\n  has not: {words}");
}

const HAND: &str = "[[flash]]\ntime_s = 1.0\nazimuth_deg = 90\nelevation_deg = 60\nilluminance_lux = 500\nrise_ms = 0\n\
                    decay_ms = 20\ncolor = [1, 0.5, 0.25]\nclouds = 0.1\nstrokes = [[0, 1], [50, 0.5], [110, 0.25]]\n";

/// The mean of 500 exp(-t / 20 ms) over the first 10 ms is 500 * 2 (1 - exp(-0.5)).
#[test]
fn a_flash_by_hand_has_the_light_of_its_keys() {
    let found = lightning(HAND);
    let flash = &found.flashes()[0];
    assert!((flash.towards[1] - 0.75f64.sqrt()).abs() < 1.0e-12 && (flash.towards[2] - 0.5).abs() < 1.0e-12);
    assert_eq!((flash.color, flash.clouds, flash.strokes.len()), ([1.0, 0.5, 0.25], 0.1, 3));
    let parts = found.exposure(1.0, 1.01, false);
    assert_eq!((parts.len(), parts[0].lights.len()), (1, 1));
    let expected = 1000.0 * (1.0 - ops::exp(-0.5));
    assert!((parts[0].lights[0].illuminance_lux / expected - 1.0).abs() < 1.0e-9);
    // Before it there is none, nor when it is long over.
    assert!(found.exposure(0.9, 1.0, false).is_empty() && found.exposure(2.0, 2.1, false).is_empty());
    // All of its light: (1 + 0.5 + 0.25) 500 lux in 20 ms each.
    let whole: f64 =
        found.exposure(0.5, 1.5, false).iter().flat_map(|part| &part.lights).map(|l| l.illuminance_lux).sum();
    assert!((whole / 17.5 - 1.0).abs() < 1.0e-3, "{whole}");
    // A shutter that takes no time has the light of the moment.
    let still = found.exposure(1.02, 1.02, false);
    assert!((still[0].lights[0].illuminance_lux - 500.0 * ops::exp(-1.0)).abs() < 1.0e-9);
    assert_eq!(still[0].lit_s, [1.02, 1.02]);
}

/// A stroke in the middle of the shutter, shorter than it, shines in a part of it: from its begin, twice its decay long.
#[test]
fn a_short_flash_lights_a_part_of_an_exposure() {
    let text = "[[flash]]\ntime_s = 0.01\nazimuth_deg = 0\nrise_ms = 0\ndecay_ms = 1";
    let parts = lightning(text).exposure(0.0, 0.04, false);
    let [begin, end] = parts[0].lit_s;
    assert_eq!((parts.len(), begin), (1, 0.01));
    assert!((end - begin - 2.0e-3).abs() < 1.0e-5, "{}", end - begin);
    // Three strokes within a long exposure are three parts; a shutter that closes early ends the first.
    let three = lightning(HAND);
    assert_eq!(three.exposure(0.9, 1.4, false).len(), 3);
    let early = three.exposure(0.999, 1.002, false);
    assert!(early[0].lit_s[1] <= 1.002 && early[0].lit_s[1] > 1.0018, "{:?}", early[0].lit_s);
    // In an eye early light has faded: that of the middle has the weight 1.
    let eye = lightning(text).exposure(-0.01, 0.03, true)[0].lights[0].illuminance_lux;
    let camera = lightning(text).exposure(-0.01, 0.03, false)[0].lights[0].illuminance_lux;
    assert!((eye / camera - 1.05).abs() < 1.0e-3, "{}", eye / camera);
}

/// Frame k alone has the light of frame k of a clip, in whatever order frames are asked for, and frames share all of the light.
#[test]
fn light_does_not_depend_on_the_order_of_times() {
    for limit in [true, false] {
        let text = format!("[lightning]\nper_minute = 200\nseed = 3\nlimit = {limit}\n{HAND}");
        let all = lightning(&text);
        let frame = |k: u32| (f64::from(k) - 0.5) / 24.0;
        let forth: Vec<_> = (0..3000).map(|k| all.exposure(frame(k), frame(k + 1), false)).collect();
        let again = lightning(&text);
        for k in (0..3000).rev() {
            assert_eq!(again.exposure(frame(k), frame(k + 1), false), forth[k as usize], "{k}");
        }
        assert!(forth.iter().any(|parts| !parts.is_empty()) && forth.iter().any(Vec::is_empty));
    }
}

/// At most three strokes in any second, across every border of what is limited at a time; without the limit there are more.
#[test]
fn the_limit_holds_in_any_second() {
    let worst = |lightning: &Lightning, from_s: f64, to_s: f64| {
        let times: Vec<f64> = lightning.pulses(from_s, to_s).iter().map(|pulse| pulse.begin_s).collect();
        assert!(times.is_sorted());
        times.iter().map(|t| times.iter().filter(|other| (0.0..1.0).contains(&(**other - t))).count()).max()
    };
    for (seed, per_minute) in [(1, 600), (2, 600), (3, 60), (4, 12)] {
        let text = format!("[lightning]\nper_minute = {per_minute}\nseed = {seed}\n");
        for by_hand in ["", HAND] {
            let hand = by_hand.replace("time_s = 1.0", "time_s = 59.95");
            let limited = lightning(&format!("{text}{hand}"));
            assert_eq!(worst(&limited, -130.0, 610.0), Some(3), "{seed}");
            // The light is the same in parts.
            let mut parts = limited.pulses(-130.0, 60.3);
            parts.extend(limited.pulses(60.3, 610.0));
            for pulse in limited.pulses(-130.0, 610.0) {
                assert!(parts.contains(&pulse));
            }
        }
        let free = lightning(&text.replace("seed", "limit = false\nseed"));
        assert!(worst(&free, -130.0, 610.0) > Some(3), "a control");
        assert!(free.pulses(0.0, 600.0).len() > lightning(&text).pulses(0.0, 600.0).len());
    }
    let mut many = String::new();
    for k in 0..60 {
        writeln!(many, "[[flash]]\ntime_s = {}\nazimuth_deg = 0", f64::from(k) * 0.1).unwrap();
    }
    let limited = lightning(&many);
    assert_eq!((worst(&limited, 0.0, 10.0), limited.left_out()), (Some(3), 42));
    assert_eq!(lightning(&format!("[lightning]\nlimit = false\n{many}")).left_out(), 0);
}

#[test]
fn none_is_none() {
    for text in ["", "[lightning]\nper_minute = 0", "[lightning]\nlimit = false"] {
        assert!(lightning(text).is_none() && lightning(text).exposure(-1.0e6, 1.0e6, false).is_empty());
    }
    let off = format!("[lightning]\nenabled = false\nper_minute = 10\n{HAND}");
    assert!(lightning(&off).is_none());
    assert!(lightning(&off.replace("false", "true")).storm().is_some());
}

#[test]
fn values_out_of_range_and_keys_out_of_order_are_refused() {
    says(
        "[lightning]\nper_minute = 60000000",
        2,
        "lightning.per_minute: 60000000; allowed: 0 to 600 flashes per minute",
    );
    says("[lightning]\nper_minute = -1", 2, "0 to 600 flashes per minute");
    says("[lightning]\nper_minute = nan", 2, "0 to 600 flashes per minute");
    says("[lightning]\nseed = 5", 2, "lightning.seed: without per_minute");
    says("[lightning]\nper_minute = 1\ndistance_m = [500, 300]", 2, "lightning.distance_m: 500 to 300");
    says("[lightning]\nper_minute = 1\nazimuth_deg = [90, 0]", 2, "the lower number first");
    says("[lightning]\nper_minute = 1\ndistance_m = 500", 2, "lightning.distance_m");
    says("[lightning]\nflashes = 5", 2, "unknown key \"flashes\"");
    says("[[flash]]\nazimuth_deg = 0", 2, "no time_s");
    says("[[flash]]\ntime_s = 0", 2, "no azimuth_deg");
    let flash = "[[flash]]\ntime_s = 4\nazimuth_deg = 0\n";
    says(
        &format!("{flash}{}", flash.replace('4', "3")),
        2,
        "flash[1].time_s: a flash at 3 s, after one at 4 s",
    );
    says(&format!("{flash}illuminance_lux = -1"), 2, "0 to 1e9 lux");
    says(&format!("{flash}elevation_deg = 100"), 2, "-90 to 90 degrees");
    says(&format!("{flash}rise_ms = 10"), 2, "flash[0].rise_ms: a rise of 10 ms and a decay of 10 ms");
    says(&format!("{flash}decay_ms = 0.1"), 2, "flash[0].decay_ms: a rise of 0.1 ms and a decay of 0.1 ms");
    says(&format!("{flash}clouds = 11"), 2, "0 to 10");
    says(&format!("{flash}strokes = []"), 2, "flash[0].strokes: no strokes");
    says(&format!("{flash}strokes = [[0]]"), 2, "flash[0].strokes");
    says(&format!("{flash}strokes = [[0, 2]]"), 2, "a factor of 2; allowed: 0 to 1");
    says(
        &format!("{flash}strokes = [[0, 1], [90, 1], [40, 1]]"),
        2,
        "flash[0].strokes[2]: a stroke at 40 ms, after one at 90 ms; allowed: times that rise by a millisecond at least",
    );
    let strokes: Vec<String> = (0..33).map(|k| format!("[{k}, 1]")).collect();
    says(&format!("{flash}strokes = [{}]", strokes.join(", ")), 3, "33 strokes");
    says(&flash.repeat(1025), 3, "1025 times [[flash]]");
    says(&flash.repeat(1000), 3, "more than 64 strokes in the second from 4 s on");
}
