//! The weather file: every key, and rows T1 to T13 of the reliability plan.

#[path = "../../downpour-scene/tests/effort/mod.rs"]
mod effort;
#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;

use downpour_drop::distribution::DropSizeLaw;
use downpour_drop::fall_speed::FallSpeedModel;
use downpour_scene::{Budget, SceneError};
use downpour_weather::{
    Camera, CameraPose, Glow, GlowFilter, Lamp, Look, Observer, Rain, RainBounce, RainCylinder, RainDrag,
    RainDropLight, RainVolume, Repeat, Sky, SkySource, SunSource, ToneCurve, ToneEdges, Weather,
};
use effort::measured;
use exit_code::ExitCode as _;
use glam::{DQuat, DVec3};
use std::fmt::Write as _;
use std::time::Duration;

fn parse(text: &str) -> Result<Weather, SceneError> {
    Weather::parse("w.toml", text)
}

/// Rejected with exit code 2 and this whole message, but for the name of the file.
#[track_caller]
fn says(text: &str, message: &str) {
    let error = parse(text).expect_err(text);
    assert_eq!(error.exit_code(), 2, "{error}");
    assert_eq!(error.to_string(), format!("w.toml: {message}"), "{text}");
}

/// Rejected with this code and this text.
#[track_caller]
fn refused(text: &str, code: u8, words: &str) {
    let (result, took) = measured(|| parse(text));
    let error = result.expect_err(words);
    assert!(took < Duration::from_secs(5), "{took:?}");
    assert_eq!(error.exit_code(), code, "{error}");
    let said = error.to_string();
    assert!(said.contains(words) && said.len() < 600 && !said.contains('\n'), "{said}\n  has not: {words}");
}

const ALL: &str = r#"
# Every key of the table, none at its default.
[rain]
rate_mm_h = 25.5
distribution = "gamma"
gamma_shape = 2
median_diameter_mm = 1.5
seed = 18446744073709551615
temperature_c = -5
pressure_hpa = 900
volume = "box"
box_m = 80
max_drops = 1073741824
drag = "rousseau-2008"
bounce = { fraction = 1, restitution = 0.5, grip = 0, size = 0.05, max_time_s = 2 }
drop_light = "im-sung-2022"

[sky]
file = "skies/park 100%.hdr"
yaw_deg = 90
exposure_ev = 3
intensity = 0.5

[sun]
azimuth_deg = 90
elevation_deg = 30
illuminance_lux = 5e4
color = [1, 0.5, 0]
diameter_deg = 1.0

[camera]
position_m = [1e7, 1.7, -5]
yaw_deg = 90
pitch_deg = 30
fov_deg = 60
near_m = 0.1
far_m = 500
exposure_ev = -2
tone = "khronos-neutral"
edges = "linear"
shutter_s = 0.01

[glow]
glare = 0.1
width = 2
filter = "kawase"
diffraction = false

[spray]
enabled = true

[look]
visibility = 3
spray = 4
streak_length = 0.5

[[model]]
file = "models/street.glb"
translation_m = [1, 2, 3]
rotation_deg = [0, 90, 0]
scale = [1, 2, 3]
repeat = { count = [2, 1, 3], step_m = [4, 0, 5] }
animation = "Swing"

[[model]]
file = "lamp.gltf"
scale = 2

[[light]]
point = { position_m = [0, 3, 0], color = [1, 0.9, 0.8], intensity_cd = 800, range_m = 20 }

[[light]]
[light.spot]
position_m = [0, 5, 0]
direction = [0, -2, 0]
color = [0, 1, 0]
intensity_cd = 50
inner_deg = 10
outer_deg = 45
range_m = 9.5

[[light]]
directional = { direction = [0, 0, 8], color = [0, 0, 1], illuminance_lux = 2 }

[[flash]]
time_s = 2.5
azimuth_deg = 0
elevation_deg = 90
illuminance_lux = 1000
color = [0.5, 0.5, 1]
rise_ms = 1
decay_ms = 25
strokes = [[0, 0.5], [40, 0.25]]
clouds = 2

[lightning]
enabled = true
limit = false
per_minute = 12
seed = 18446744073709551615
distance_m = [200, 300]
azimuth_deg = [-180, 0]
brightness = 3
clouds = 1
color = [1, 1, 0]

[output]
size = [1, 16384]
"#;

#[test]
fn every_key_arrives_in_si() {
    let weather = parse(ALL).unwrap();
    assert_eq!(weather.name, "w.toml");
    let rain = weather.rain;
    assert_eq!((rain.rate_mm_h, rain.seed, rain.box_m), (25.5, u64::MAX, Some(80.0)));
    assert_eq!((rain.volume, rain.max_drops, rain.drag), (RainVolume::Box, 1 << 30, RainDrag::Rousseau2008));
    let bounce = RainBounce { fraction: 1.0, restitution: 0.5, grip: 0.0, size: 0.05, max_time_s: 2.0 };
    assert_eq!(rain.bounce, bounce);
    assert_eq!(rain.drop_light, RainDropLight::ImSung2022);
    assert_eq!((rain.air.temperature_c(), rain.air.pressure_pa()), (-5.0, 90_000.0));
    assert_eq!(rain.law, DropSizeLaw::GammaByMedian { mu: 2.0, median_volume_diameter_m: 1.5e-3 });
    let SkySource::File { file, yaw } = &weather.sky.source else { panic!("{:?}", weather.sky) };
    assert_eq!((file.as_str(), *yaw), ("skies/park 100%.hdr", std::f64::consts::FRAC_PI_2));
    assert_eq!(weather.sky.scale, 4.0);
    let SunSource::Directional { towards, illuminance_lux, color, angular_radius } = weather.sun else {
        panic!("{:?}", weather.sun)
    };
    let expected = DVec3::new(0.0, 0.5, 0.75f64.sqrt());
    assert!(DVec3::from_array(towards).distance(expected) < 1e-15, "{towards:?}");
    assert_eq!((illuminance_lux, color), (5e4, [1.0, 0.5, 0.0]));
    assert_eq!(angular_radius, 0.5f64.to_radians());
    let camera = weather.camera;
    let CameraPose { position, forward } = camera.path.clone().unwrap().at(0.0);
    assert_eq!(position, DVec3::new(1e7, 1.7, -5.0));
    assert!(forward.distance(DVec3::new(-(0.75f64.sqrt()), 0.5, 0.0)) < 1e-15, "{forward}");
    assert_eq!((camera.fov, camera.near, camera.far), (Some(60f64.to_radians()), Some(0.1), Some(500.0)));
    assert_eq!((camera.exposure_ev, camera.shutter), (-2.0, 0.01));
    let [street, lamp] = weather.models.as_slice() else { panic!("{:?}", weather.models) };
    assert_eq!((street.file.as_str(), street.animation.as_deref()), ("models/street.glb", Some("Swing")));
    assert_eq!(street.repeat, Repeat { count: [2, 1, 3], step: DVec3::new(4.0, 0.0, 5.0) });
    let copies: Vec<DVec3> =
        street.transforms().map(|t| t.transform_point3(DVec3::new(1.0, 1.0, 0.0))).collect();
    // (1, 1, 0) scaled to (1, 2, 0), turned to (0, 2, -1), moved to (1, 4, 2); then along x first.
    assert_eq!(copies.len(), 6);
    assert!(copies[0].distance(DVec3::new(1.0, 4.0, 2.0)) < 1e-15, "{copies:?}");
    assert!(copies[1].distance(DVec3::new(5.0, 4.0, 2.0)) < 1e-15, "{copies:?}");
    assert!(copies[2].distance(DVec3::new(1.0, 4.0, 7.0)) < 1e-15, "{copies:?}");
    assert_eq!(
        (lamp.scale, lamp.rotation, lamp.repeat),
        (DVec3::splat(2.0), DQuat::IDENTITY, Repeat::default())
    );
    let (inner, outer) = (10f64.to_radians(), 45f64.to_radians());
    assert_eq!(
        weather.lights,
        [
            Lamp::Point {
                position: DVec3::new(0.0, 3.0, 0.0),
                radius: None,
                color: DVec3::new(1.0, 0.9, 0.8),
                intensity_cd: 800.0,
                range: Some(20.0)
            },
            Lamp::Spot {
                position: DVec3::new(0.0, 5.0, 0.0),
                radius: None,
                direction: DVec3::NEG_Y,
                color: DVec3::Y,
                intensity_cd: 50.0,
                inner,
                outer,
                range: Some(9.5)
            },
            Lamp::Directional { direction: DVec3::Z, color: DVec3::Z, illuminance_lux: 2.0 },
        ]
    );
    assert_eq!(weather.size, [1, 16_384]);
}

/// Defaults of the table of keys; the table has every key of the reader.
#[test]
fn an_empty_file_is_the_default() {
    let default = Weather { name: "w.toml".into(), ..Weather::default() };
    for text in ["", "\u{feff}", "# rain\r\n\r\n", "[rain]\n[sky]\n[camera]\n[output]", "\u{feff}[rain]\r\n"]
    {
        assert_eq!(parse(text).unwrap(), default, "{text:?}");
    }
    assert_eq!(Rain::default().rate_mm_h, 10.0);
    assert_eq!(Rain::default().law, DropSizeLaw::MarshallPalmer1948);
    assert_eq!(Sky::default().source, SkySource::Overcast([0.9, 0.95, 1.0]));
    assert_eq!((Camera::default().path, Camera::default().shutter), (None, 1.0 / 60.0));
    assert_eq!(Camera::default().observer, Observer::Camera);
    assert_eq!((Camera::default().tone, Camera::default().edges), (ToneCurve::Hue, ToneEdges::ToneAware));
    let kawase = Glow { glare: 0.1, width: 2.0, filter: GlowFilter::Kawase, has_diffraction: false };
    assert_eq!((default.glow.glare, parse(ALL).unwrap().glow), (0.01, kawase));
    let look = Look { visibility: 3.0, streak_length: 0.5, spray: 4.0 };
    assert_eq!((default.look, parse(ALL).unwrap().look), (Look::PHYSICAL, look));
    assert_eq!(parse(ALL).unwrap().drop_exposure_s(0.0), 0.005);
    let all = parse(ALL).unwrap().camera;
    assert_eq!((all.tone, all.edges), (ToneCurve::KhronosNeutral, ToneEdges::Linear));
    let eye = |more: &str| parse(&format!("[camera]\nobserver = 'eye'\n{more}")).unwrap().camera;
    assert_eq!((eye("").observer, eye("").shutter), (Observer::Eye, 0.075));
    assert_eq!(eye("persistence_s = 0.09").shutter, 0.09);
    assert_eq!((default.size, default.sun), ([1280, 720], SunSource::None));
    let lights = parse(
        "light = [{ point = { position_m = [0, 0, 0] } }, { directional = { direction = [0, 0, 9] } }]",
    );
    let lights = lights.unwrap().lights;
    let Lamp::Point { color, intensity_cd, range, .. } = lights[0] else { panic!("{lights:?}") };
    assert_eq!((color, intensity_cd, range), (DVec3::ONE, 100.0, None));
    let Lamp::Directional { illuminance_lux, .. } = lights[1] else { panic!("{lights:?}") };
    assert_eq!(illuminance_lux, 1000.0);
    let table = include_str!("../src/KEYS.md");
    for line in ALL.lines().filter(|line| line.contains('=') && !line.starts_with(['#', 'p', 'd'])) {
        let key = line.split('=').next().unwrap().trim();
        assert!(table.contains(&format!("`{key}`")), "{key} is not in the table");
    }
}

#[test]
fn every_key_of_lightning_arrives_in_si() {
    let lightning = parse(ALL).unwrap().lightning;
    assert!(!lightning.is_limited());
    let flash = &lightning.flashes()[0];
    assert_eq!((flash.time_s, flash.rise_s, flash.clouds, flash.color), (2.5, 0.001, 2.0, [0.5, 0.5, 1.0]));
    assert_eq!(flash.towards[1], 1.0);
    let strokes: Vec<_> = flash.strokes.iter().map(|s| (s.after_s, s.illuminance_lux, s.decay_s)).collect();
    assert_eq!(strokes, [(0.0, 500.0, 0.025), (0.04, 250.0, 0.025)]);
    let storm = lightning.storm().unwrap();
    assert_eq!((storm.per_minute, storm.seed, storm.distance_m), (12.0, u64::MAX, [200.0, 300.0]));
    assert_eq!((storm.azimuth, storm.brightness), ([-std::f64::consts::PI, 0.0], 3.0));
    assert_eq!((storm.clouds, storm.color), (1.0, [1.0, 1.0, 0.0]));
    assert!(parse("").unwrap().lightning.is_limited());
}

#[test]
fn all_laws_of_drop_sizes_have_their_name() {
    let law = |name: &str| parse(&format!("[rain]\ndistribution = \"{name}\"")).unwrap().rain.law;
    for name in [
        "marshall-palmer",
        "best",
        "gamma",
        "feingold-levin",
        "joss-drizzle",
        "joss-widespread",
        "joss-thunderstorm",
    ] {
        assert_eq!(law(name).name(), name);
    }
    assert_eq!(law("lognormal"), DropSizeLaw::FeingoldLevin1986);
    // Without a median, that of Marshall & Palmer: 3.67 / (4.1 R^-0.21) mm, but for the ends of the sizes.
    let DropSizeLaw::GammaByMedian { mu, median_volume_diameter_m } = law("gamma") else { panic!() };
    assert_eq!(mu, 3.0);
    assert!(
        (median_volume_diameter_m * 1e3 / (3.67 / (4.1 * downpour_math::ops::f64::pow(10.0, -0.21))) - 1.0)
            .abs()
            < 0.02
    );
    assert!(parse("[rain]\ndistribution = \"gamma\"\nrate_mm_h = 0").is_ok());
    says(
        "[rain]\ndistribution = \"best\"\ngamma_shape = 2",
        "line 3, column 1: rain.gamma_shape: a parameter of the gamma law, with best; allowed: distribution = \"gamma\"",
    );
    says(
        "[rain]\ndistribution = \"bets\"",
        "line 2, column 16: rain.distribution: unknown word \"bets\", perhaps best; allowed: marshall-palmer, best, \
         gamma, feingold-levin, lognormal, joss-drizzle, joss-widespread, joss-thunderstorm",
    );
}

/// Drops with a count have the rate of their water: count, volume, sphere and fall speed.
#[test]
fn counted_drops_of_one_size_have_a_rate() {
    let rain = |text: &str| parse(&format!("[rain]\n{text}")).map(|weather| weather.rain);
    let found =
        rain("drops = { count = 20000, diameter_mm = 2 }\nfall_speed = \"gunn-kinzer-1949\"\nbox_m = 8");
    let found = found.unwrap();
    assert_eq!(found.volume, RainVolume::Box);
    // Gunn & Kinzer 1949: 6.49 m/s at 2 mm.
    let expected = 20_000.0 / 512.0 * std::f64::consts::FRAC_PI_6 * 8.0e-9 * 6.49 * 3.6e6;
    assert!((found.rate_mm_h / expected - 1.0).abs() < 1.0e-3, "{} mm/h, {expected}", found.rate_mm_h);
    let sizes = found.sizes().unwrap();
    assert!((sizes.number_density() * 512.0 - 20_000.0).abs() < 1.0);
    assert!((sizes.median_volume_diameter() - 2.0e-3).abs() < 1.0e-6);
    let faster =
        rain("drops = { count = 20000, diameter_mm = 2 }\nfall_speed = \"rousseau-2006\"\nbox_m = 8");
    assert_eq!(faster.unwrap().fall_speed, FallSpeedModel::Rousseau2006);
    let refused = |text: &str, words: &[&str]| {
        let error = rain(text).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let drops = "drops = { count = 20000, diameter_mm = 2 }";
    refused(&format!("{drops}\nrate_mm_h = 3"), &["rain.rate_mm_h", "rain.drops"]);
    refused(&format!("{drops}\ndistribution = \"best\""), &["rain.distribution", "rain.drops"]);
    refused(&format!("{drops}\nvolume = \"view\""), &["rain.drops", "tariq-2007"]);
    refused(&format!("{drops}\nmax_drops = 10000"), &["rain.drops.count", "20000", "10000"]);
    refused("drops = { count = 2, diameter_mm = 8 }", &["diameter_mm", "0.2 to 7.5 mm"]);
    refused("drops = { count = 2000000, diameter_mm = 7 }\nbox_m = 5", &["mm/h", "0.001 to 500"]);
    refused("drops = { count = 1, diameter_mm = 0.2 }\nbox_m = 1000", &["mm/h", "0.001 to 500"]);
}

#[test]
fn t1_t2_rates_are_finite_and_in_range() {
    for (value, shown) in [
        ("nan", "NaN"),
        ("inf", "inf"),
        ("-inf", "-inf"),
        ("1e39", "1e39"),
        ("-1", "-1"),
        ("500.1", "500.1"),
        ("1e-46", "1e-46"),
        ("501", "501"),
        ("9223372036854775807", "9.223372036854776e18"),
    ] {
        says(
            &format!("\n[rain]\nrate_mm_h = {value}"),
            &format!("line 3, column 13: rain.rate_mm_h: {shown}; allowed: 0, or 0.001 to 500 mm/h"),
        );
    }
    for (value, rate) in
        [("0", 0.0), ("-0.0", 0.0), ("500", 500.0), ("1e-3", 1e-3), ("1_0.5", 10.5), ("0x10", 16.0)]
    {
        let rain = parse(&format!("[rain]\nrate_mm_h = {value}")).unwrap().rain;
        assert_eq!(rain.rate_mm_h.to_bits(), f64::to_bits(rate));
    }
    refused("[rain]\nrate_mm_h = 1e400", 2, "line 2");
    refused("[rain]\nrate_mm_h = 99999999999999999999999999", 2, "rain.rate_mm_h");
    says(
        "[rain]\nrate_mm_h = \"10\"",
        "line 2, column 13: rain.rate_mm_h: invalid type: string \"10\"; allowed: a number, 0, or 0.001 to 500 mm/h, or keys [[time in s, value], ...]",
    );
    refused("rain = 5", 2, "line 1, column 8: rain: invalid type: integer `5`");
    refused("[rain]\nrate_mm_h = [1]", 2, "a key, [time in s, value]");
    refused("[rain]\nrate_mm_h = 2020-01-01", 2, "line 2");
}

#[test]
fn t6_sizes() {
    for size in ["[0, 0]", "[16385, 1]", "[100000, 100000]", "[-1, 5]", "[1.5, 2]", "[1]", "[1, 2, 3]", "5"] {
        refused(&format!("[output]\nsize = {size}"), 2, "output.size");
    }
    says("[output]\nsize = [7, 16385]", "line 2, column 12: output.size[1]: 16385; allowed: 1 to 16384");
    says("[output]\nsize = [7]", "line 2, column 8: output.size: 1 numbers; allowed: 2 numbers");
    assert_eq!(parse("[output]\nsize = [1, 1]").unwrap().size, [1, 1]);
}

#[test]
fn t7_cameras_that_see_nothing() {
    let camera = |keys: &str| format!("[camera]\n{keys}");
    refused(
        &camera("position_m = [1.1e7, 0, 0]"),
        2,
        "camera.position_m[0]: 11000000; allowed: -1e7 to 1e7 m",
    );
    refused(&camera("position_m = [nan, 0, 0]"), 2, "camera.position_m[0]: NaN");
    refused(&camera("fov_deg = 0"), 2, "1 to 170 degrees");
    refused(&camera("fov_deg = 180"), 2, "1 to 170 degrees");
    says(
        &camera("near_m = 5\nfar_m = 5"),
        "line 2, column 1: camera.near_m: 5 m to 5 m; allowed: near_m below far_m",
    );
    refused(&camera("near_m = 3000"), 2, "3000 m to 2000 m");
    refused(&camera("far_m = 0.01"), 2, "camera.far_m: 0.05 m to 0.01 m");
    let up = "is where the eye is, or straight above or below it";
    refused(&camera("position_m = [1, 2, 3]\nlook_at_m = [1, 50, 3]"), 2, up);
    refused(&camera("position_m = [1, 2, 3]\nlook_at_m = [1, 2, 3]"), 2, up);
    refused(&camera("position_m = [1, 2, 3]\npitch_deg = 90"), 2, "-89.9 to 89.9 degrees");
    refused(&camera("look_at_m = [1, 2, 3]"), 2, "camera.look_at_m: without position_m");
    refused(&camera("yaw_deg = 3"), 2, "camera.yaw_deg: without position_m");
    refused(
        &camera("position_m = [0, 0, 0]\nlook_at_m = [1, 0, 0]\nyaw_deg = 3"),
        2,
        "camera.yaw_deg: beside look_at_m",
    );
    let far = parse(&camera("position_m = [1e7, 0, 0]\nlook_at_m = [1e7, 0, 1]")).unwrap();
    assert_eq!(far.camera.path.clone().unwrap().at(0.0).forward, DVec3::Z);
    let ahead = parse(&camera("position_m = [0, 0, 0]")).unwrap();
    assert_eq!(ahead.camera.path.clone().unwrap().at(0.0).forward, DVec3::NEG_Z);
}

#[test]
fn t8_more_than_enough() {
    let lamp = "{point={position_m=[0,0,0]}},";
    refused(
        &format!("light = [{}]", lamp.repeat(1025)),
        3,
        "light: 1025 times [[light]]; allowed: at most 1024",
    );
    refused(&format!("light = [{}]", lamp.repeat(20_000)), 3, "at most 1024");
    refused(&format!("model = [{}]", "{file='a.glb'},".repeat(4097)), 3, "at most 4096");
    let copies = |count: &str| {
        format!("[[model]]\nfile = 'a.glb'\nrepeat = {{ count = {count}, step_m = [1, 1, 1] }}")
    };
    refused(
        &copies("[41, 40, 40]"),
        3,
        "line 3, column 12: model[0].repeat.count: 65600 copies; allowed: at most 65536",
    );
    refused(&copies("[65536, 65536, 65536]"), 3, "281474976710656 copies");
    refused(&copies("[65537, 1, 1]"), 2, "1 to 65536");
    refused(&copies("[0, 1, 1]"), 2, "1 to 65536");
    assert!(parse(&copies("[65536, 1, 1]")).is_ok());
}

#[test]
fn t9_nesting_ends() {
    let nested = |deep: usize| format!("a = {}{}", "[".repeat(deep), "]".repeat(deep));
    refused(&nested(31), 2, "unknown key \"a\"");
    refused(&nested(33), 2, "nested 33 deep; allowed: at most 32 deep");
    refused(&nested(200_000), 2, "line 1, column");
    refused(&format!("{}a = 1", "a.".repeat(100_000)), 2, "recursion limit");
    refused(&format!("a{} = 1", ".a".repeat(40)), 2, "nested");
    refused(&format!("[a{}]", ".a".repeat(200_000)), 2, "recursion limit");
    refused(&"{a=".repeat(200_000), 2, "line 1");
}

#[test]
fn volumes_of_rain() {
    let cylinder = "[rain]\nvolume = \"creus-patow-2013\"\ncylinder = { radius_m = 3 }";
    assert_eq!(
        parse(cylinder).unwrap().rain.cylinder,
        RainCylinder { base_m: None, radius_m: 3.0, height_m: 12.0 }
    );
    refused("[rain]\nbox_m = 20", 2, "allowed: volume = \"box\" or \"tariq-2007\"");
    refused("[rain]\nvolume = \"view\"\ncylinder = {}", 2, "allowed: volume = \"creus-patow-2013\"");
    refused("[rain]\nvolume = \"sphere\"", 2, "closed-form");
    refused("[rain]\ndrop_light = \"glitter\"", 2, "im-sung-2022");
    refused("[rain]\nmax_drops = 0", 2, "allowed: 1 to 1073741824");
    refused("[rain]\nmax_drops = 10000000000", 2, "allowed: 1 to 1073741824");
    refused("[rain]\nbounce = { fraction = 1.5 }", 2, "allowed: 0 to 1");
    refused("[rain]\nbounce = { max_time_s = nan }", 2, "allowed: 0.01 to 10 s");
}

#[test]
fn t11_keys_are_known_and_stand_once() {
    says(
        "[rain]\n  rate = 5",
        "line 2, column 3: rain.rate: unknown key \"rate\", perhaps rate_mm_h; allowed: rate_mm_h, rate_height_m, distribution, \
         gamma_shape, median_diameter_mm, seed, temperature_c, pressure_hpa, fall_speed, drop_shape, \
         mask_model, refraction, drops, volume, box_m, cylinder, max_drops, drag, bounce, drop_light, extinction, \
         unresolved, layers",
    );
    says(
        "[rian]\nrate_mm_h = 5",
        "line 1, column 2: rian: unknown key \"rian\", perhaps rain; allowed: preset, rain, layers, sky, sun, camera, model, material, light, \
         flash, lightning, wind, gusts, turbulence, wind_field, streaks, glass, fog, glow, look, puddle, ripples, wetness, pane, splashes, spray, drips, drip, output",
    );
    refused("[camera]\nfov_rad = 1", 2, "unknown key \"fov_rad\", perhaps fov_deg;");
    refused("[camera]\nshutter_s = 1.5", 2, "0 to 1 s");
    refused("[camera]\nshutter_s = -0.01", 2, "0 to 1 s");
    refused("[camera]\nobserver = \"fly\"", 2, "camera.observer");
    refused("[camera]\nobserver = \"eye\"\npersistence_s = 0.05", 2, "0.06 to 0.09 s");
    refused("[camera]\nobserver = \"eye\"\npersistence_s = 0.1", 2, "0.06 to 0.09 s");
    refused("[camera]\npersistence_s = 0.075", 2, "camera.persistence_s: with a camera");
    refused(
        "[camera]\nobserver = \"camera\"\npersistence_s = 0.075",
        2,
        "camera.persistence_s: with a camera",
    );
    refused(
        "[camera]\nobserver = \"eye\"\nshutter_s = 0.075",
        2,
        "camera.shutter_s: with observer = \"eye\"",
    );
    refused("[glow]\nglare = 1.5", 2, "glow.glare");
    refused("[glow]\nglare = -0.1", 2, "0 to 1");
    refused("[glow]\nwidth = 0", 2, "0.1 to 10");
    refused("[glow]\nfilter = \"box\"", 2, "glow.filter");
    refused("[glow]\nbloom = 1", 2, "glow.bloom");
    refused("[ripples]\nspeed_m_s = 0.3", 2, "ripples.speed_m_s");
    refused("[ripples]\nwaves = \"membrane\"\nspeed_m_s = 3", 2, "0.05 to 2 m/s");
    refused("[layers]\nmilk = 0.2", 2, "layers.milk");
    refused("[rain]\nlayers = \"tatarchuk-2006\"\n[layers]\nparallax = 1", 2, "1.1 to 50");
    refused("[rain]\nlayers = \"tatarchuk-2006\"\nvolume = \"view\"", 2, "rain.volume");
    refused("[rain]\nlayers = \"tatarchuk-2006\"\nunresolved = \"streaks\"", 2, "rain.unresolved");
    refused("[rain]\nlayers = \"tatarchuk\"", 2, "rain.layers");
    refused("[look]\nvisibility = -1", 2, "0 to 20");
    refused("[look]\nvisibility = nan", 2, "look.visibility");
    refused("[look]\nstreak_length = 21", 2, "look.streak_length");
    refused("[look]\nstreak_length = [[1, 1], [0, 2]]", 2, "look.streak_length");
    refused("[look]\nstreaks_length = 2", 2, "perhaps streak_length");
    refused("[camera]\ntone = \"channel\"", 2, "camera.tone");
    refused("[camera]\nedges = \"sharp\"", 2, "camera.edges");
    refused("[camera]\naperture_mm = nan", 2, "camera.aperture_mm");
    refused("[camera]\nfocus_m = 0", 2, "0.01 to 1e7 m");
    refused("[streaks]\nsamples = 0", 2, "streaks.samples");
    refused("[streaks]\nsamples = 1000000", 2, "1 to 4096");
    refused("[streaks]\nsamples = \"tabel\"", 2, "\"table\", or 1 to 4096");
    refused("[streaks]\noscillation = [0.1, 0.5]", 2, "0 to 0.3");
    refused("[streaks]\ncolor = \"blue\"", 2, "streaks.color");
    refused("[streaks]\ncolor = \"atlas_random\"", 2, "atlas-random");
    refused("[camera]\nshutter_ms = 1", 2, "perhaps shutter_s;");
    refused("[rain]\ntemperature_k = 280", 2, "perhaps temperature_c;");
    refused("[rain]\nxyzzy = 280", 2, "unknown key \"xyzzy\"; allowed: rate_mm_h");
    refused("gale = 3", 2, "line 1, column 1: gale: unknown key \"gale\"");
    refused(
        "[[light]]\npiont = { position_m = [0, 0, 0] }",
        2,
        "unknown word \"piont\", perhaps point; allowed: point, spot",
    );
    refused(
        "[[light]]\npoint = { position_m = [0, 0, 0], reach_m = 1 }",
        2,
        "light[0].point.reach_m: unknown key",
    );
    refused("[rain]\nseed = 1\nseed = 2", 2, "line 3, column 1: duplicate key");
    refused("[rain]\n[rain]", 2, "line 2");
    refused("[rain]\nseed = -1", 2, "line 2, column 8: rain.seed: invalid value: integer `-1`");
    refused("[rain]\nseed = 18446744073709551616", 2, "line 2, column 8: rain.seed");
    refused("[rain]\nseed = 1.5", 2, "rain.seed: invalid type: floating point `1.5`");
    assert_eq!(parse("[rain]\nseed = 18446744073709551615").unwrap().rain.seed, u64::MAX);
    let long = format!("[rain]\n{} = 1", "k".repeat(70_000));
    refused(&long, 2, "unknown key \"kkk");
    refused("[rain]\n\"a\\u001b[2J\" = 1", 2, "\\u{1b}[2J");
    refused("[[model]]\nscale = 1", 2, "line 1, column 1: model[0]: no file; allowed: file is needed");
}

#[test]
fn skies_and_suns_that_contradict_themselves() {
    refused("[sky]\nfile = 'a.hdr'\ncolor = [1, 1, 1]", 2, "sky.color: beside file; allowed: one of");
    refused("[sky]\nzenith_color = [1, 1, 1]\ncolor = [1, 1, 1]", 2, "sky.zenith_color: beside color");
    refused("[sky]\ncolor = [1, 1, 1]\nyaw_deg = 5", 2, "sky.yaw_deg: a turn of no map");
    refused("[sky]\ncolor = [1, 1]", 2, "sky.color: 2 numbers; allowed: 3 numbers");
    refused("[sky]\ncolor = [1, -1, 1]", 2, "line 2, column 13: sky.color[1]: -1; allowed: 0 to 1e9");
    refused("[sun]", 2, "sun: nothing");
    refused("[sun]\nfrom_sky = true", 2, "sun.from_sky: true without a map");
    refused(
        "[sky]\nfile = 'a.hdr'\n[sun]\nfrom_sky = true\nazimuth_deg = 3",
        2,
        "sun.azimuth_deg: beside from_sky",
    );
    refused("[sun]\nazimuth_deg = 3", 2, "sun: no elevation_deg");
    refused("[sun]\nazimuth_deg = 3\nelevation_deg = 91", 2, "-90 to 90 degrees");
    let sun = |text: &str| parse(text).unwrap().sun;
    assert_eq!(sun("[sky]\nfile = 'a.hdr'"), SunSource::FromSkyIfAny);
    assert_eq!(sun("[sky]\nfile = 'a.hdr'\n[sun]\nfrom_sky = false"), SunSource::None);
    assert_eq!(sun("[sun]\nfrom_sky = false"), SunSource::None);
    assert!(matches!(sun("[sun]\nazimuth_deg = 0\nelevation_deg = 90"), SunSource::Directional { .. }));
    let uniform = parse("[sky]\ncolor = [1, 2, 3]\nexposure_ev = -1").unwrap().sky;
    assert_eq!((uniform.source, uniform.scale), (SkySource::Uniform([1.0, 2.0, 3.0]), 0.5));
}

#[test]
fn lamps_that_do_not_shine() {
    let spot = |keys: &str| format!("[[light]]\nspot = {{ position_m = [0, 0, 0], {keys} }}");
    refused(&spot("direction = [0, 0, 0]"), 2, "light[0].spot.direction: no length; allowed: three numbers");
    refused(&spot("inner_deg = 3"), 2, "no direction; allowed: direction is needed");
    refused(&spot("direction = [0, 1, 0], inner_deg = 40, outer_deg = 40"), 2, "40 degrees within 40");
    refused(&spot("direction = [0, 1, 0], inner_deg = 40"), 2, "inner_deg: 40 degrees within 30");
    refused(&spot("direction = [0, 1, 0], radius_m = 101"), 2, "radius_m: 101; allowed: 0 to 100 m");
    for radius in ["0", "100"] {
        let text = spot(&format!("direction = [0, 1, 0], radius_m = {radius}"));
        let Lamp::Spot { radius: found, .. } = parse(&text).unwrap().lights[0] else { panic!("{text}") };
        assert_eq!(found, radius.parse().ok());
    }
    refused(&spot("direction = [0, 1, 0], outer_deg = 0"), 2, "outer_deg: 0 degrees within 0");
    refused(&spot("direction = [0, 1, 0], outer_deg = 90"), 2, "0 to 89.9 degrees");
    let narrow = parse(&spot("direction = [0, 1, 0], outer_deg = 3")).unwrap();
    let Lamp::Spot { inner, outer, .. } = narrow.lights[0] else { panic!() };
    assert!((inner - 2f64.to_radians()).abs() < 1e-15 && outer == 3f64.to_radians());
    refused("[[light]]", 2, "light[0]");
    refused("[[light]]\npoint = { position_m = [0,0,0] }\nspot = { position_m = [0,0,0] }", 2, "light[0]");
}

#[test]
fn t12_texts_that_are_none() {
    refused("[rain]\nrate_mm_h = 5\0", 2, "line 2");
    refused("[rain\n", 2, "line 1, column 6");
    refused("rate = ", 2, "line 1");
    refused("\u{feff}[rain]\r\nrate = 5\r\n", 2, "line 2, column 1: rain.rate");
    refused("# \u{e4}\u{f6}\n[\"\u{e4}\"]", 2, "line 2, column 2: \u{e4}: unknown key");
    refused(&"#".repeat((4 << 20) + 1), 3, "a text of 4194305 bytes; allowed: at most 4194304 bytes");
    let mut many = String::new();
    let mut i = 0;
    while many.len() < (4 << 20) - 20 {
        writeln!(many, "k{i}=0").unwrap();
        i += 1;
    }
    refused(&many, 2, "line 1, column 1: k0: unknown key");
    // Few long keys with many values under them.
    refused(&format!("{} = [{}]", "k".repeat(2 << 20), "0,".repeat(1_000_000)), 2, "unknown key \"kkk");
    assert!(parse(&"#".repeat(4 << 20)).is_ok());
}

#[test]
fn t12_files_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let read = |path: &std::path::Path| {
        Weather::read(path, &mut Budget::default()).map_err(|e| (e.exit_code(), e.to_string()))
    };
    let path = folder.path().join("w.toml");
    std::fs::write(&path, b"\xef\xbb\xbf[rain]\r\nrate_mm_h = 3\r\n").unwrap();
    assert_eq!(read(&path).unwrap().rain.rate_mm_h, 3.0);
    std::fs::write(&path, b"[rain]\n# \xff").unwrap();
    let (code, words) = read(&path).unwrap_err();
    assert!(code == 2 && words.contains("byte 9 is not UTF-8; allowed: text in UTF-8"), "{words}");
    std::fs::File::create(&path).unwrap().set_len(1 << 30).unwrap();
    let (code, words) = read(&path).unwrap_err();
    assert!(code == 3 && words.contains("a file of 1073741824 bytes; allowed: at most 4194304"), "{words}");
    assert_eq!(read(&folder.path().join("none.toml")).unwrap_err().0, 5);
    assert_eq!(read(folder.path()).unwrap_err().0, 2);
    #[cfg(unix)]
    {
        assert_eq!(read("/dev/zero".as_ref()).unwrap_err().0, 2);
        let fifo = folder.path().join("fifo");
        let mode = rustix::fs::Mode::RUSR;
        rustix::fs::mknodat(rustix::fs::CWD, &fifo, rustix::fs::FileType::Fifo, mode, 0).unwrap();
        assert_eq!(read(&fifo).unwrap_err().0, 2);
    }
}

#[test]
fn t13_paths_stay_beneath() {
    let file = |path: &str| format!("[sky]\nfile = '{path}'");
    for (path, why) in [
        ("../a.hdr", "leaves"),
        ("/etc/passwd", "is absolute"),
        ("a/../../b", "leaves"),
        ("C:\\a.hdr", "has a scheme or a drive"),
        ("a\\b.hdr", "is absolute or holds a backslash"),
        ("file:///a.hdr", "has a scheme"),
        ("https://example.com/a.hdr", "has a scheme"),
        ("data:;base64,AAAA", "data instead of a file"),
        ("{frame:99999d}", "has a scheme"),
        ("", "names no file"),
        ("a/", "names no file"),
    ] {
        refused(&file(path), 2, why);
        refused(&format!("[[model]]\nfile = '{path}'"), 2, "line 2, column 1: model[0].file");
    }
    says(
        &file("../a.hdr"),
        "line 2, column 1: sky.file: \"../a.hdr\" leaves the scene folder; allowed: only relative paths inside the \
         folder of the weather file or an asset root",
    );
    refused(&file(&"a".repeat(70_000)), 2, "a path of 70000 bytes");
    refused("[sky]\nfile = \"a\\u0000.hdr\"", 2, "holds a zero byte");
    // A percent sign is literal: nothing is decoded.
    let SkySource::File { file, .. } = parse(&file("%2e%2e/a.hdr")).unwrap().sky.source else { panic!() };
    assert_eq!(file.as_str(), "%2e%2e/a.hdr");
}

/// Any one byte of a good file may be wrong.
#[test]
fn a_wrong_byte_is_refused_or_read() {
    let mut noise = 1u32;
    let mut read = 0;
    for at in 0..ALL.len() {
        let mut bytes = ALL.as_bytes().to_vec();
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        bytes[at] = (noise >> 24) as u8 & 0x7f;
        let Ok(text) = String::from_utf8(bytes) else { continue };
        match parse(&text) {
            Ok(_) => read += 1,
            Err(error) => {
                let words = error.to_string();
                assert!(matches!(error.exit_code(), 2 | 3) && words.starts_with("w.toml: line "), "{words}");
            }
        }
    }
    assert!(read > ALL.len() / 100, "{read}");
}

/// A distance in focus needs a lens that blurs.
#[test]
fn a_focus_without_an_aperture_is_refused() {
    let told = "line 2, column 1: camera.focus_m: a distance in focus of a lens in which all is in focus; allowed: with aperture_mm";
    refused("[camera]\nfocus_m = 3", 2, told);
    refused("[camera]\nfocus_m = [[0, 1], [2, 3]]", 2, told);
    let camera = parse("[camera]\nfocus_m = 3\naperture_mm = 20").unwrap().camera;
    assert_eq!((camera.focus, camera.aperture), (Some(3.0), 0.02));
    // Who writes 0 knows that all is in focus.
    assert_eq!(parse("[camera]\nfocus_m = 3\naperture_mm = 0").unwrap().camera.aperture, 0.0);
}

/// The light of lamps is of an atlas or of another form.
#[test]
fn an_atlas_beside_another_light_of_drops_is_refused() {
    for color in ["atlas", "atlas-random"] {
        for light in ["rousseau-2006", "im-sung-2022", "none"] {
            refused(
                &format!("[rain]\ndrop_light = \"{light}\"\n[streaks]\ncolor = \"{color}\""),
                2,
                "line 4, column 1: streaks.color: the light of lamps from an atlas, beside another rain.drop_light; allowed: ",
            );
        }
        assert!(parse(&format!("[rain]\ndrop_light = \"traced\"\n[streaks]\ncolor = \"{color}\"")).is_ok());
    }
    assert!(parse("[rain]\ndrop_light = \"none\"\n[streaks]\ncolor = \"white\"").is_ok());
}
