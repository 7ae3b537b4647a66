//! The wind of a weather file: every key, keys over time, and rejected values.

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;
use downpour_scene::SceneError;
use downpour_weather::{Weather, WindBox};
use downpour_wind::{Gusts, Turbulence, Wind, WindCore, WindForm, WindPrimitive, WindUniform};
use exit_code::ExitCode as _;
use glam::{DVec3, Vec3};

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
    let error = parse(text).expect_err(words);
    assert_eq!(error.exit_code(), code, "{error}");
    let said = error.to_string();
    assert!(said.contains(words) && said.len() < 600 && !said.contains('\n'), "{said}\n  has not: {words}");
}

const ALL: &str = r#"
[[wind]]
uniform = { speed_m_s = [[0, 3], [10, 12]], towards_deg = 90 }
[[wind]]
uniform = { speed_m_s = 2, direction = [0, 3, 0] }
[[wind]]
source = { strength_m3_s = 20, center_m = [1, 2, 3], core_m = 2.5 }
[[wind]]
sink = { strength_m2_s = 7, axis = [2, 0, 0], core = "lamb-oseen" }
[[wind]]
[wind.vortex]
strength_m2_s = [[-1, 40], [1, -40]]
center_m = [[0, [-20, 0, 0]], [30.5, [20, 0, 10]]]
core_m = [[0, 1], [10, 2]]
core = "rankine"
[[wind]]
tornado = { base_m = [5, 0, -5], height_m = 60, circulation_m2_s = 400, discharge_m3_s = 2e3, core_m = 4, axis = [0, 1, 0] }
[gusts]
intensity = 0.15
length_m = 50
seed = 18446744073709551615
[turbulence]
speed_m_s = 0.5
length_m = 12
seed = 3
[wind_field]
size = [32, 16, 48]
box_m = [64, 40, 96]
center_m = [0, 20, 0]
"#;

#[test]
fn every_key_arrives() {
    let weather = parse(ALL).unwrap();
    let wind = &weather.wind;
    assert_eq!(wind.gusts(), Some(&Gusts { intensity: 0.15, length: 50.0, seed: u64::MAX }));
    assert_eq!(wind.turbulence(), Some(&Turbulence { speed: 0.5, length: 12.0, seed: 3 }));
    let at = wind.at(5.0);
    let [
        WindPrimitive::Uniform(first),
        WindPrimitive::Uniform(second),
        WindPrimitive::Source(source),
        WindPrimitive::Sink(sink),
        WindPrimitive::Vortex(vortex),
        WindPrimitive::Tornado(tornado),
        WindPrimitive::Uniform(_),
    ] = at[..]
    else {
        panic!("{at:?}")
    };
    assert!((first.speed - 7.5).abs() < 1e-6 && first.direction.distance(Vec3::Z) < 1e-6, "{first:?}");
    assert_eq!(second, WindUniform { speed: 2.0, direction: Vec3::Y });
    assert_eq!((source.form, source.strength, source.core_radius), (WindForm::Point, 20.0, 2.5));
    assert_eq!(
        (source.center, source.axis, source.core),
        (Vec3::new(1.0, 2.0, 3.0), Vec3::Y, WindCore::Rosenhead)
    );
    assert_eq!((sink.form, sink.strength, sink.axis), (WindForm::Line, 7.0, Vec3::X));
    assert_eq!((sink.core, sink.core_radius, sink.center), (WindCore::LambOseen, 5.0, Vec3::ZERO));
    assert_eq!((vortex.strength, vortex.core_radius, vortex.core), (-40.0, 1.5, WindCore::Rankine));
    let fraction = 5.0 / 30.5;
    assert!(vortex.center.distance(Vec3::new(-20.0 + 40.0 * fraction, 0.0, 10.0 * fraction)) < 1e-5);
    assert_eq!((tornado.circulation, tornado.discharge, tornado.height), (400.0, 2000.0, 60.0));
    assert_eq!((tornado.base, tornado.core_radius), (Vec3::new(5.0, 0.0, -5.0), 4.0));
    let grid = weather.wind_box.grid(DVec3::splat(1e9)).unwrap();
    assert_eq!((grid.size(), grid.low()), ([32, 16, 48], Vec3::new(-32.0, 0.0, -48.0)));
    let table = include_str!("../src/KEYS.md");
    for word in ALL.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| word.contains('_')) {
        assert!(table.contains(&format!("`{word}`")) || table.contains(&format!("`[{word}]`")), "{word}");
    }
}

#[test]
fn defaults_are_those_of_the_table() {
    let weather = parse("").unwrap();
    assert_eq!((&weather.wind, weather.wind_box), (&Wind::default(), WindBox::default()));
    assert!(weather.wind.is_still());
    let grid = weather.wind_box.grid(DVec3::new(0.0, 1.7, 5.0)).unwrap();
    assert_eq!((grid.size(), grid.cell()), ([64; 3], Vec3::splat(100.0 / 64.0)));
    assert!((grid.low() - Vec3::new(-50.0, -48.3, -45.0)).length() < 1e-4);
    assert!(weather.wind_box.grid(DVec3::splat(5e6)).is_err());
    let weather =
        parse("[[wind]]\nuniform = { speed_m_s = 1, towards_deg = 0 }\n[gusts]\n[turbulence]").unwrap();
    assert_eq!(weather.wind.gusts(), Some(&Gusts { intensity: 0.2, length: 100.0, seed: 0 }));
    assert_eq!(weather.wind.turbulence(), Some(&Turbulence { speed: 1.0, length: 20.0, seed: 0 }));
    let text = "[[wind]]\ntornado = { circulation_m2_s = 9, height_m = 30 }";
    let [WindPrimitive::Tornado(tornado)] = parse(text).unwrap().wind.at(0.0)[..] else { panic!() };
    assert_eq!((tornado.discharge, tornado.core_radius, tornado.axis), (0.0, 5.0, Vec3::Y));
}

/// A wind that turns by an angle keeps its speed; full turns are turns.
#[test]
fn winds_turn_by_the_angle() {
    let weather =
        parse("[[wind]]\nuniform = { speed_m_s = 10, towards_deg = [[0, -90], [40, 270]] }").unwrap();
    let air = weather.wind.uniform().unwrap();
    for k in 0..=400 {
        let (time, angle) = (f64::from(k) * 0.1, f64::from(k) * 0.9 - 90.0);
        let wanted = DVec3::new(angle.to_radians().cos_(), 0.0, angle.to_radians().sin_()) * 10.0;
        let found = air.velocity(time);
        assert!(found.distance(wanted) < 0.02, "{time}: {found}, not {wanted}");
    }
    // Two keys in a microsecond are a jump, and no more keys.
    assert!(parse("[[wind]]\nuniform = { speed_m_s = 1, towards_deg = [[0, 0], [0.000001, 180]] }").is_ok());
    // Vectors go straight: through calm, if about.
    let weather =
        parse("[[wind]]\nuniform = { speed_m_s = 10, direction = [[0, [1, 0, 0]], [2, [-1, 0, 0]]] }")
            .unwrap();
    assert!(weather.wind.uniform().unwrap().velocity(1.0).length() < 1e-12);
}

trait Turn {
    fn cos_(self) -> f64;
    fn sin_(self) -> f64;
}

impl Turn for f64 {
    fn cos_(self) -> f64 {
        downpour_math::ops::f64::cos(self)
    }
    fn sin_(self) -> f64 {
        downpour_math::ops::f64::sin(self)
    }
}

#[test]
fn numbers_out_of_range_are_named() {
    says(
        "[[wind]]\nuniform = { speed_m_s = 201, towards_deg = 0 }",
        "line 2, column 25: wind[0].uniform.speed_m_s: 201; allowed: 0 to 200 m/s",
    );
    says(
        "[[wind]]\nuniform = { speed_m_s = [[0, 3], [10, 201]], towards_deg = 0 }",
        "line 2, column 39: wind[0].uniform.speed_m_s[1][1]: 201; allowed: 0 to 200 m/s",
    );
    says(
        "[[wind]]\nvortex = { strength_m2_s = 1, core_m = 0 }",
        "line 2, column 40: wind[0].vortex.core_m: 0; allowed: 0.01 to 1e4 m",
    );
    says(
        "[[wind]]\nvortex = { strength_m2_s = 1, center_m = [[0, [0, nan, 0]]] }",
        "line 2, column 51: wind[0].vortex.center_m[0][1][1]: NaN; allowed: -1e6 to 1e6 m",
    );
    let vortex = |keys: &str| format!("[[wind]]\nvortex = {{ strength_m2_s = 1, {keys} }}");
    refused(&vortex("core_m = nan"), 2, "wind[0].vortex.core_m: NaN");
    refused(&vortex("core_m = [[0, 1], [1, inf]]"), 2, "wind[0].vortex.core_m[1][1]: inf");
    refused(
        &vortex("axis = [0, 0, 0]"),
        2,
        "wind[0].vortex.axis: no length; allowed: three numbers, not all 0",
    );
    refused(&vortex("axis = [[0, [0, 1, 0]], [3, [0, 0, 0]]]"), 2, "wind[0].vortex.axis: no length");
    refused(
        &vortex("axis = [[0, [0, 1, 0]], [3, [0, -2, 0]]]"),
        2,
        "wind[0].vortex.axis: turned about up to the key at 3 s",
    );
    refused(&vortex("core = \"rankin\""), 2, "unknown word \"rankin\", perhaps rankine");
    let odd = "[[wind]]\nsource = { strength_m3_s = 1, core = \"rankine\" }";
    refused(odd, 2, "wind[0].source.core: rankine with strength_m3_s; allowed: rosenhead, or strength_m2_s");
    refused(
        "[[wind]]\nsink = { strength_m2_s = -1 }",
        2,
        "wind[0].sink.strength_m2_s: -1; allowed: 0 to 1e6",
    );
    let low = "[[wind]]\ntornado = { circulation_m2_s = 1, core_m = 5, height_m = [[0, 20], [9, 9]] }";
    refused(low, 2, "wind[0].tornado.height_m: height 9 m; allowed: 2 core radii to 1e5");
    refused(
        "[[wind]]\nuniform = { speed_m_s = 1, direction = [0, 0, 0] }",
        2,
        "uniform.direction: no length",
    );
    refused("[gusts]\nintensity = 1.1", 2, "gusts.intensity: 1.1; allowed: 0 to 1");
    refused("[turbulence]\nspeed_m_s = 51", 2, "turbulence.speed_m_s: 51; allowed: 0 to 50 m/s");
    refused("[turbulence]\nlength_m = 0", 2, "turbulence.length_m: 0; allowed: 0.1 to 1e4 m");
    refused("[turbulence]\nseed = -1", 2, "turbulence.seed");
    refused("[wind_field]\nsize = [64, 64, 4097]", 2, "wind_field.size[2]: 4097; allowed: 1 to 4096");
    refused(
        "[wind_field]\nsize = [4096, 4096, 1]",
        3,
        "wind_field.size: 16777216 cells; allowed: at most 8388608",
    );
    refused("[wind_field]\nbox_m = [0, 1, 1]", 2, "wind_field.box_m[0]: 0; allowed: 0.01 to 1e6 m");
    refused("[gusts]", 2, "gusts: without a uniform wind");
}

#[test]
fn keys_over_time_are_checked() {
    let speed = |keys: &str| format!("[[wind]]\nuniform = {{ speed_m_s = {keys}, towards_deg = 0 }}");
    let name = "wind[0].uniform.speed_m_s";
    refused(&speed("[]"), 2, &format!("{name}: no keys; allowed: a number, or [[time, value], ...]"));
    refused(
        &speed("[[0, 1], [5, 1], [5, 2]]"),
        2,
        &format!("{name}[2]: a key at 5 s, after one at 5 s; allowed: times that rise"),
    );
    refused(&speed("[[1, 1], [0, 1]]"), 2, &format!("line 2, column 34: {name}[1]: a key at 0 s"));
    refused(&speed("[[nan, 1]]"), 2, &format!("{name}[0][0]: NaN; allowed: -1e6 to 1e6 s"));
    refused(&speed("[[2e6, 1]]"), 2, &format!("{name}[0][0]: 2000000"));
    refused(&speed("[[0]]"), 2, &format!("{name}[0]: a key without a value"));
    refused(&speed("[[]]"), 2, &format!("{name}[0]: an empty key"));
    refused(&speed("[[0, 1, 2]]"), 2, &format!("{name}[0]: a key of more than two"));
    refused(
        &speed("[1, 2]"),
        2,
        &format!("{name}[0]: invalid type: integer `1`; allowed: a key, [time in s, value]"),
    );
    refused(
        &speed("\"5\""),
        2,
        &format!("{name}: invalid type: string \"5\"; allowed: a number, 0 to 200 m/s, or keys"),
    );
    let many: String = (0..4097).map(|k| format!("[{k},1],")).collect();
    refused(&speed(&format!("[{many}]")), 3, &format!("{name}: 4097 keys; allowed: at most 4096"));
    let twirl: String = (0..100).map(|k| format!("[{k},{}],", if k % 2 == 0 { 360 } else { -360 })).collect();
    let twirl = format!("[[wind]]\nuniform = {{ speed_m_s = 1, towards_deg = [{twirl}] }}");
    refused(&twirl, 3, "wind[0].uniform.towards_deg: 14257 keys, one for each 5 degrees of a turn");
    let parts: String = (0..2)
        .map(|part| {
            let keys: String = (0..3000).map(|k| format!("[{k}.{part},1],")).collect();
            speed(&format!("[{keys}]")) + "\n"
        })
        .collect();
    refused(&parts, 3, "wind: 6000 different times of keys in all uniform winds; allowed: at most 4096");
    let center = |keys: &str| format!("[[wind]]\nvortex = {{ strength_m2_s = 1, center_m = {keys} }}");
    let name = "wind[0].vortex.center_m";
    refused(&center("[1, 2]"), 2, &format!("{name}: 2 numbers; allowed: 3 numbers, or keys"));
    refused(&center("[1, 2, 3, 4]"), 2, &format!("{name}: 4 numbers"));
    refused(&center("[1, 2, [0, [1, 2, 3]]]"), 2, &format!("{name}: numbers among keys"));
    refused(
        &center("[[0, 5]]"),
        2,
        &format!("{name}[0][1]: invalid type: integer `5`; allowed: an array of 3 numbers"),
    );
    refused(&center("[[0, [1, 2]]]"), 2, &format!("{name}[0][1]: 2 numbers"));
    refused(&center("7"), 2, &format!("{name}: invalid type: integer `7`; allowed: three numbers"));
    assert!(parse(&center("[[0, [1, 2, 3]]]")).is_ok() && parse(&center("[1, 2.5, 3]")).is_ok());
}

#[test]
fn keys_are_known_and_stand_once() {
    let uniform = |keys: &str| format!("[[wind]]\nuniform = {{ {keys} }}");
    refused(
        &uniform("speed_m_s = 1"),
        2,
        "wind[0].uniform: no towards_deg; allowed: towards_deg or direction is needed",
    );
    refused(
        &uniform("speed_m_s = 1, towards_deg = 0, direction = [1, 0, 0]"),
        2,
        "wind[0].uniform.direction: beside towards_deg; allowed: one of the two",
    );
    refused(&uniform("towards_deg = 0"), 2, "wind[0].uniform: no speed_m_s; allowed: speed_m_s is needed");
    refused(&uniform("speed_km_h = 1, towards_deg = 0"), 2, "unknown key \"speed_km_h\", perhaps speed_m_s");
    refused(
        "[[wind]]\nvortex = { core_m = 1 }",
        2,
        "wind[0].vortex: no strength; allowed: strength_m2_s of a line",
    );
    refused(
        "[[wind]]\nvortex = { strength_m2_s = 1, strength_m3_s = 1 }",
        2,
        "wind[0].vortex.strength_m3_s: beside strength_m2_s",
    );
    refused(
        "[[wind]]\nvortx = { }",
        2,
        "unknown word \"vortx\", perhaps vortex; allowed: uniform, source, sink",
    );
    refused("[[wind]]", 2, "wind[0]");
    refused("[wind]\nuniform = 1", 2, "wind");
    refused("[[wind]]\ntornado = { circulation_m2_s = 1 }", 2, "no height_m; allowed: height_m is needed");
    refused("[wind_field]\nbox = 1", 2, "unknown key \"box\", perhaps box_m");
    let part = "{uniform={speed_m_s=1,towards_deg=0}},";
    refused(
        &format!("wind = [{}]", part.repeat(1025)),
        3,
        "wind: 1025 times [[wind]]; allowed: at most 1024",
    );
    assert!(parse(&format!("wind = [{}]", part.repeat(1024))).is_ok());
}

/// Any one byte of a good file may be wrong.
#[test]
fn a_wrong_byte_is_refused_or_read() {
    let (mut noise, mut read) = (1u32, 0);
    for at in 0..ALL.len() {
        let mut bytes = ALL.as_bytes().to_vec();
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        bytes[at] = (noise >> 24) as u8 & 0x7f;
        let Ok(text) = String::from_utf8(bytes) else { continue };
        match parse(&text) {
            Ok(weather) => {
                read += 1;
                assert!(weather.wind.at(3.0).iter().all(|primitive| primitive.check().is_ok()));
            }
            Err(error) => {
                let words = error.to_string();
                assert!(matches!(error.exit_code(), 2 | 3) && words.starts_with("w.toml: line "), "{words}");
            }
        }
    }
    assert!(read > ALL.len() / 100, "{read}");
}

/// A grid of a wind that is the same everywhere does nothing: who gives one is told so.
#[test]
fn a_grid_of_a_uniform_wind_is_refused() {
    let uniform = "[[wind]]\nuniform = { speed_m_s = 3, towards_deg = 40 }\n[gusts]\nintensity = 0.2\n";
    for key in ["size = [8, 8, 8]", "box_m = [9, 9, 9]", "center_m = [0, 1, 0]"] {
        let name = key.split(' ').next().unwrap();
        refused(
            &format!("{uniform}[wind_field]\n{key}"),
            2,
            &format!(
                "w.toml: line 6, column 1: wind_field.{name}: a grid for a wind that is the same everywhere; allowed: with [turbulence]"
            ),
        );
        refused(&format!("[wind_field]\n{key}"), 2, &format!("wind_field.{name}: a grid for a wind"));
        let vortex = "[[wind]]\nvortex = { strength_m2_s = 9, center_m = [0, 0, 0] }\n";
        for wind in [vortex, "[turbulence]\nspeed_m_s = 1\n"] {
            assert!(parse(&format!("{wind}[wind_field]\n{key}")).is_ok(), "{wind}");
        }
    }
    assert!(parse(&format!("{uniform}[wind_field]")).is_ok(), "an empty table asks for nothing");
}
