//! Values of a weather file over time.

use downpour_math::ops::f64 as ops;
use downpour_scene::SceneError;
use downpour_weather::{Lamp, PuddleFill, PuddleShape, SkySource, SunSource, Weather};
use glam::DVec3;

fn parse(text: &str) -> Result<Weather, SceneError> {
    Weather::parse("w.toml", text)
}

/// Every key that may have keyframes, over ten seconds.
const KEYED: &str = "
[rain]
rate_mm_h = [[0, 10], [10, 30]]
rate_height_m = 40
[sky]
color = [[0, [1, 0, 0]], [10, [0, 0, 1]]]
intensity = [[0, 2], [10, 4]]
exposure_ev = [[0, 0], [10, 2]]
[sun]
azimuth_deg = [[0, 0], [10, 90]]
elevation_deg = [[0, 0], [10, 60]]
illuminance_lux = [[0, 100], [10, 300]]
color = [[0, [1, 1, 1]], [10, [1, 0.5, 0]]]
[camera]
position_m = [0, 1, 0]
yaw_deg = [[0, 0], [10, 180]]
pitch_deg = [[0, 0], [10, 30]]
fov_deg = [[0, 20], [10, 60]]
exposure_ev = [[0, 1], [10, 3]]
aperture_mm = 20
focus_m = [[0, 1], [10, 3]]
[[model]]
file = 'car.glb'
translation_m = [[0, [0, 0, -40]], [10, [2, 0, 40]]]
rotation_deg = [[0, [0, 0, 0]], [10, [0, 90, 0]]]
repeat = { count = [2, 1, 1], step_m = [5, 0, 0] }
[[light]]
point = { position_m = [[0, [0, 1, 0]], [10, [4, 1, 0]]], color = [[0, [1, 1, 1]], [10, [0, 0, 0]]], intensity_cd = [[0, 10], [10, 30]] }
[[light]]
spot = { position_m = [0, 5, 0], direction = [[0, [0, -1, 0]], [10, [2, 0, 0]]] }
[[light]]
directional = { direction = [0, -2, 0], illuminance_lux = [[0, 8], [10, 0]] }
[[puddle]]
position_m = [0, 0, 0]
size_m = [1, 1]
fill = [[0, 0], [10, 1]]
ripple_influence = [[0, 1], [10, 3]]
[splashes]
size = [[0, 1], [10, 2]]
[glow]
glare = [[0, 0], [10, 0.5]]
width = [[0, 1], [10, 3]]
[fog]
visibility_m = [[0, 1000], [10, 200]]
[lightning]
per_minute = 10
brightness = [[0, 1], [10, 5]]
";

/// Halfway all values are in the middle; before and after the keys they are those of the ends.
#[test]
fn every_key_moves_linearly() {
    let weather = parse(KEYED).unwrap();
    assert!(!weather.keys.is_empty());
    let now = weather.at(5.0);
    assert_eq!((now.rain.rate_mm_h, now.rain.rate_height_m), (20.0, 40.0));
    assert_eq!((weather.rain.rate_mm_h, weather.heaviest_rain().rate_mm_h), (10.0, 30.0));
    assert_eq!(now.sky.source, SkySource::Uniform([0.5, 0.0, 0.5]));
    // 3 times one stop.
    assert_eq!(now.sky.scale, 6.0);
    let SunSource::Directional { towards, illuminance_lux, color, .. } = now.sun else {
        panic!("{:?}", now.sun)
    };
    let (level, up) = (0.75f64.sqrt() * 0.5f64.sqrt(), 0.5);
    assert!(DVec3::from(towards).distance(DVec3::new(level, up, level)) < 1e-12, "{towards:?}");
    assert_eq!((illuminance_lux, color), (200.0, [1.0, 0.75, 0.5]));
    let camera = &now.camera;
    assert_eq!((camera.exposure_ev, camera.focus), (2.0, Some(2.0)));
    assert!((camera.fov.unwrap().to_degrees() - 40.0).abs() < 1e-12);
    let forward = camera.path.as_ref().unwrap().at(5.0).forward;
    let expected = DVec3::new(-(ops::cos(15f64.to_radians())), ops::sin(15f64.to_radians()), 0.0);
    assert!(forward.distance(expected) < 1e-12, "{forward}");
    assert!(!camera.path.as_ref().unwrap().is_still());
    let ahead: Vec<DVec3> = now.models[0].transforms().map(|t| t.transform_point3(DVec3::Z)).collect();
    let half = 0.5f64.sqrt();
    for (found, x) in ahead.iter().zip([1.0, 6.0]) {
        assert!(found.distance(DVec3::new(x + half, 0.0, half)) < 1e-12, "{found}");
    }
    assert_eq!(weather.models[0].translation, DVec3::new(0.0, 0.0, -40.0));
    let Lamp::Point { position, color, intensity_cd, .. } = now.lights[0] else { panic!("{:?}", now.lights) };
    assert_eq!((position, color, intensity_cd), (DVec3::new(2.0, 1.0, 0.0), DVec3::splat(0.5), 20.0));
    let Lamp::Spot { direction, intensity_cd, .. } = now.lights[1] else { panic!("{:?}", now.lights) };
    assert!(direction.distance(DVec3::new(0.5f64.sqrt(), -(0.5f64.sqrt()), 0.0)) < 1e-12, "{direction}");
    assert_eq!(intensity_cd, 100.0);
    let Lamp::Directional { direction, illuminance_lux, .. } = now.lights[2] else {
        panic!("{:?}", now.lights)
    };
    assert_eq!((direction, illuminance_lux), (DVec3::NEG_Y, 4.0));
    let PuddleShape::Found { fill, .. } = now.puddles[0].shape else { panic!("{:?}", now.puddles) };
    assert_eq!(fill, PuddleFill::Part(0.5));
    assert_eq!((now.puddles[0].ripple_influence, weather.ripple_influence_at(0, 20.0)), (2.0, Some(3.0)));
    assert_eq!((now.splashes.size, weather.splashes.size), (1.5, 1.0));
    assert_eq!((now.glow.glare, now.glow.width, weather.glow_at(99.0).width), (0.25, 2.0, 3.0));
    // Visibility is linear between its keys: Koschmieder's law at 600 m.
    assert!((now.fog.unwrap().extinction_per_m - 3.912 / 600.0).abs() < 1e-12, "{:?}", now.fog);
    assert_eq!(now.lightning.storm().unwrap().brightness, 3.0);
    // Two stops more than at the first key.
    assert_eq!([-1.0, 0.0, 10.0, 99.0].map(|time| weather.exposure_factor(time)), [1.0, 1.0, 4.0, 4.0]);
    assert_eq!(weather.at(-9.0).sky.scale, 2.0);
    assert_eq!(weather.at(99.0).sky.scale, 16.0);
}

/// A rate that is set is that of all times.
#[test]
fn a_rate_that_is_set_has_no_keys() {
    let mut weather = parse("[rain]\nrate_mm_h = [[0, 5], [10, 50]]").unwrap();
    weather.set_rate(7.0);
    assert_eq!((weather.rain_at(10.0).rate_mm_h, weather.heaviest_rain().rate_mm_h), (7.0, 7.0));
    assert!(weather.keys.is_empty());
}

/// A weather without keys is itself at all times.
#[test]
fn a_weather_without_keys_does_not_change() {
    let weather = parse("[sky]\nintensity = 3\n[[light]]\ndirectional = { direction = [1, 2, 3] }").unwrap();
    assert!(weather.keys.is_empty());
    assert!(std::ptr::eq(&raw const weather, &raw const *weather.at(7.0)));
    assert_eq!(weather.exposure_factor(7.0), 1.0);
}

/// Single keys are constant values.
#[test]
fn a_single_key_is_a_constant() {
    let one = parse("[sky]\nintensity = [[5, 3]]\n[camera]\nfov_deg = [[0, 30]]").unwrap();
    assert!(one.keys.is_empty());
    assert_eq!((one.sky.scale, one.camera.fov), (3.0, Some(30f64.to_radians())));
}

/// Errors name line and key, and say what is allowed.
#[test]
fn bad_keys_are_refused() {
    let many: String = (0..5000).map(|k| format!("[{k},1],")).collect();
    for (text, key, allowed) in [
        ("[sky]\nintensity = [[0, 1], [0, 2]]".to_owned(), "line 2", "sky.intensity[1]"),
        ("[sky]\nintensity = [[5, 1], [0, 2]]".into(), "a key at 0 s, after one at 5 s", "times that rise"),
        ("[sky]\nintensity = [[nan, 1]]".into(), "sky.intensity", "-1e6 to 1e6 s"),
        ("[sky]\nintensity = [[0, nan]]".into(), "sky.intensity", "0 to 1e9"),
        ("[sky]\nintensity = []".into(), "no keys", "[[time, value], ...]"),
        ("[sky]\ncolor = [[0, [1, 1]]]".into(), "sky.color", "3 numbers"),
        (
            "[camera]\nposition_m = [0, 0, 0]\npitch_deg = [[0, 0], [1, 90]]".into(),
            "camera.pitch_deg",
            "-89.9 to 89.9",
        ),
        ("[camera]\nfov_deg = [[0, 20], [1, 180]]".into(), "camera.fov_deg", "1 to 170"),
        ("[sun]\nazimuth_deg = 0\nelevation_deg = [[0, 91]]".into(), "sun.elevation_deg", "-90 to 90"),
        (
            "[[light]]\npoint = { position_m = [0, 1, 0], intensity_cd = [[0, -1]] }".into(),
            "light[0].point.intensity_cd",
            "0 to 1e9 cd",
        ),
        (
            "[[light]]\nspot = { position_m = [0, 1, 0], direction = [[0, [0, 1, 0]], [1, [0, -1, 0]]] }"
                .into(),
            "turned about",
            "a key between",
        ),
        (
            "[[light]]\nspot = { position_m = [0, 1, 0], direction = [[0, [0, 1, 0]], [1, [0, 0, 0]]] }"
                .into(),
            "no length",
            "not all 0",
        ),
        (
            "[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [1, 1]\nfill = [[0, 2]]".into(),
            "puddle[0].fill",
            "0 to 1",
        ),
        ("[rain]\nrate_mm_h = [[0, 0], [10, 600]]".into(), "rain.rate_mm_h", "500 mm/h"),
        ("[rain]\nrate_height_m = 3".into(), "rain.rate_height_m", "with keys of rain.rate_mm_h"),
        (
            "[rain]\nrate_height_m = 2e5\nrate_mm_h = [[0, 0], [10, 50]]".into(),
            "rain.rate_height_m",
            "-1e4 to 1e5 m",
        ),
        (
            "[rain]\nrate_mm_h = [[0, 0], [10, 50]]\nvolume = \"box\"".into(),
            "line 2, column 1: rain.rate_mm_h: keys of a rain that goes step by step",
            "closed-form",
        ),
        (
            "[rain]\nrate_mm_h = [[0, 0], [10, 50]]\n[drips]\nenabled = true".into(),
            "drips.enabled",
            "a rate without keys",
        ),
        (
            "[rain]\nrate_mm_h = [[0, 3], [10, 5]]\ndrops = { count = 5, diameter_mm = 1 }".into(),
            "rain.rate_mm_h",
            "one or the other",
        ),
        (
            "[wetness]\nrained_s = [[0, 1], [2, 3]]".into(),
            "wetness.rained_s: an array: this key has no keyframes",
            "0 to 1e6 s",
        ),
        (format!("[sky]\nintensity = [{many}]"), "5000 keys", "at most 4096"),
    ] {
        let error = parse(&text).unwrap_err().to_string();
        assert!(error.contains(key) && error.contains(allowed), "{error}");
    }
}

/// A million keys are refused in little time: the file is too long.
#[test]
fn a_million_keys_are_refused() {
    let keys: String = (0..1_000_000).map(|k| format!("[{k},1],")).collect();
    let error = parse(&format!("[sky]\nintensity = [{keys}]")).unwrap_err();
    assert!(matches!(error, SceneError::OverLimit(_)), "{error}");
}
