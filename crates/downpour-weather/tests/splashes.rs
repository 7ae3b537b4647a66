//! `[splashes]` of the weather file.

use downpour_weather::{Splashes, Spray, Weather};

fn parsed(text: &str) -> Splashes {
    Weather::parse("rain.toml", text).expect("a weather").splashes
}

fn spray(text: &str) -> Spray {
    Weather::parse("rain.toml", text).expect("a weather").spray
}

fn says(text: &str, expected: &str) {
    let message = Weather::parse("rain.toml", text).expect_err(text).to_string();
    assert!(message.contains(expected), "{text}: {message}");
}

#[test]
fn drops_splash_unless_told_otherwise() {
    let default = parsed("");
    assert!(default.is_enabled);
    assert_eq!((default.size, default.film_m), (1.0, 0.5e-3));
    assert!(!parsed("[splashes]\nenabled = false").is_enabled);
    let given = parsed("[splashes]\nsize = 2\nfilm_mm = 0.25");
    assert_eq!((given.size, given.film_m), (2.0, 0.25e-3));
}

#[test]
fn there_is_spray_where_it_is_asked_for() {
    assert_eq!(spray(""), Spray { is_enabled: false, height_m: 0.05, droplet_m: 0.3e-3 });
    assert_eq!(spray("[spray]\nenabled = false"), Spray::default());
    let given = spray("[spray]\nenabled = true\nheight_m = 0.1\ndroplet_mm = 0.5");
    assert_eq!(given, Spray { is_enabled: true, height_m: 0.1, droplet_m: 0.5e-3 });
    says("[spray]\nheight_m = 0.1", "spray.height_m");
    says("[spray]\nenabled = false\ndroplet_mm = 0.2", "spray.droplet_mm");
    says("[spray]\nenabled = true\nheight_m = 2", "0.005 to 1 m");
    says("[spray]\nenabled = true\ndroplet_mm = nan", "spray.droplet_mm");
    says("[spray]\nenabled = true\nheigth_m = 0.1", "perhaps height_m");
    says("[look]\nspray = 21", "look.spray");
    says("[look]\nspray = 2", "look.spray: of spray that is not enabled");
    says("[spray]\nenabled = true\n[look]\nspray = 21", "0 to 20");
}

#[test]
fn bad_splashes_are_refused() {
    says("[splashes]\nsize = 0", "splashes.size: 0; allowed: 0.1 to 10");
    says("[splashes]\nsize = 11", "0.1 to 10");
    says("[splashes]\nfilm_mm = 0.01", "0.05 to 10 mm");
    says("[splashes]\nfilm_mm = nan", "splashes.film_mm");
    says("[splashes]\nsizes = 1", "unknown key \"sizes\", perhaps size");
    says("[splashes]\nenabled = false\nsize = 2", "splashes.size: beside enabled = false");
    says("[splashes]\nenabled = 1", "splashes.enabled");
}

/// Any rain has splashes: in closed form, and step by step.
#[test]
fn splashes_of_any_rain_have_a_size() {
    let stepped =
        ["[rain]\nvolume = 'view'", "[rain]\ndrag = 'rousseau-2008'", "[turbulence]\nspeed_m_s = 1"];
    let wind = "[[wind]]\nuniform = { speed_m_s = 3, towards_deg = 40 }\n[gusts]\nintensity = 0.2";
    for rain in stepped.into_iter().chain(["[rain]\nvolume = 'closed-form'", "[rain]\nrate_mm_h = 9", wind]) {
        assert_eq!(parsed(&format!("{rain}\n[splashes]\nsize = 2")).size, 2.0, "{rain}");
        assert!(!parsed(&format!("{rain}\n[splashes]\nenabled = false")).is_enabled);
        assert!(parsed(rain).is_enabled);
    }
}
