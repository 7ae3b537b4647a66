//! `downpour drop` against published values.

use crate::child::downpour;

/// The keys that scripts depend on.
const CONTRACT: [&str; 13] = [
    "diameter_mm",
    "terminal_speed_m_s",
    "axis_ratio",
    "volume_mm3",
    "centroid_mm",
    "f2_hz",
    "f3_hz",
    "tau2_s",
    "tau3_s",
    "field_of_view_deg",
    "refractive_index",
    "relaxation_vertical_s",
    "relaxation_horizontal_s",
];

fn number(arguments: &[&str], key: &str) -> f64 {
    let json = downpour(&[&["drop", "--json"], arguments].concat()).succeeded().json();
    json[key].as_f64().unwrap_or_else(|| panic!("{key} of {json}"))
}

/// 2 mm at 20 C and 1013.25 hPa: Beard 1976, Chuang & Beard 1990, Rayleigh 1879, Lamb, IAPWS R9-97.
#[test]
fn a_drop_of_2_mm_has_the_published_properties() {
    let json = downpour(&["drop", "--diameter", "2", "--json"]).succeeded().json();
    for (key, value, tolerance) in [
        ("diameter_mm", 2.0, 0.0),
        ("terminal_speed_m_s", 6.506, 0.0005),
        ("axis_ratio", 0.926, 0.0005),
        ("volume_mm3", 4.18879, 0.00001),
        ("centroid_mm", 0.0050, 0.00005),
        ("f2_hz", 121.5, 0.05),
        ("f3_hz", 121.515 * (30.0f64 / 8.0).sqrt(), 0.05),
        ("tau2_s", 0.199, 0.0005),
        ("tau3_s", 0.199_328 * 5.0 / 14.0, 0.0001),
        ("field_of_view_deg", 165.57, 0.005),
        ("refractive_index", 1.333, 0.00005),
        ("relaxation_vertical_s", 0.33, 0.005),
        ("relaxation_horizontal_s", 0.66, 0.005),
    ] {
        let found = json[key].as_f64().unwrap_or_else(|| panic!("{key} of {json}"));
        assert!((found - value).abs() <= tolerance, "{key}: {found}, published {value}");
    }
}

/// Gunn & Kinzer 1949, table 2; Chuang & Beard 1990, table 1.
#[test]
fn other_drops_have_the_published_speed_and_shape() {
    for (diameter, speed) in [("1", 4.03), ("3", 8.06), ("5", 9.09)] {
        let found = number(&["--diameter", diameter], "terminal_speed_m_s");
        assert!((found / speed - 1.0).abs() < 0.015, "{diameter} mm: {found} m/s, measured {speed}");
        let table =
            number(&["--diameter", diameter, "--fall-speed", "gunn-kinzer-1949"], "terminal_speed_m_s");
        assert!((table - speed).abs() < 1.0e-9, "{diameter} mm: {table}");
    }
    assert!((number(&["--diameter", "5"], "axis_ratio") - 0.700).abs() < 0.0005);
}

#[test]
fn thin_air_is_fallen_through_faster() {
    let low = number(&["--diameter", "2"], "terminal_speed_m_s");
    let high = number(&["--diameter", "2", "--temperature", "-2", "--pressure", "700"], "terminal_speed_m_s");
    assert!(high > 1.1 * low && high < 1.25 * low, "{low} {high}");
}

#[test]
fn every_number_is_finite_from_the_smallest_drop_to_the_largest() {
    for diameter in ["0.001", "0.05", "0.999", "9"] {
        for air in [["--temperature=-12", "--pressure=300"], ["--temperature=40", "--pressure=1100"]] {
            let ended = downpour(&["drop", "--json", "--diameter", diameter, air[0], air[1]]).succeeded();
            let json = ended.json();
            for key in CONTRACT {
                let value = json[key].as_f64().unwrap_or_else(|| panic!("{key} of {json}"));
                assert!(value.is_finite() && (value > 0.0 || key == "centroid_mm"), "{key}: {value}");
            }
            assert!(!ended.stdout.contains("-0.0,"), "{}", ended.stdout);
        }
    }
}

/// A fit that gives small drops no speed: no drag coefficient, and no infinity in JSON.
#[test]
fn what_has_no_value_is_null() {
    let json =
        downpour(&["drop", "--json", "--diameter", "0.05", "--fall-speed", "atlas-1973"]).succeeded().json();
    assert_eq!(json["terminal_speed_m_s"].as_f64(), Some(0.0));
    assert!(json["drag_coefficient"].is_null(), "{json}");
}

#[test]
fn people_read_units_in_columns() {
    let text = downpour(&["drop", "--diameter", "2"]).succeeded().stdout;
    for line in [
        "diameter                              2 mm",
        "terminal speed                    6.506 m/s",
        "height over width                 0.926",
        "volume                            4.189 mm^3",
        "field of view of the sphere       165.6 degrees",
    ] {
        assert!(text.lines().any(|found| found == line), "no \"{line}\" in\n{text}");
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    let allowed = "allowed: 0.001 to 9 mm";
    for diameter in ["NaN", "inf", "-inf", "1e39", "1e400", "1e-46", "-1", "0", "-0", "12", "9.01", "0.0009"]
    {
        let quoted = format!("'{diameter}'");
        downpour(&["drop", "--diameter", diameter])
            .failed(2, &["--diameter", &quoted, allowed])
            .with_one_line();
    }
    for (argument, value, allowed) in [
        ("--temperature", "-12.1", "-12 to 40 C"),
        ("--temperature", "nan", "-12 to 40 C"),
        ("--temperature", "41", "-12 to 40 C"),
        ("--pressure", "0", "300 to 1100 hPa"),
        ("--pressure", "1e39", "300 to 1100 hPa"),
        ("--pressure", "101325", "300 to 1100 hPa"),
        ("--diameter", "2 mm", "0.001 to 9 mm"),
        ("--diameter", "", "0.001 to 9 mm"),
        ("--fall-speed", "beard", "beard-1976"),
    ] {
        let arguments = match argument {
            "--diameter" => vec!["drop", argument, value],
            _ => vec!["drop", "--diameter", "2", argument, value],
        };
        downpour(&arguments).failed(2, &[argument, value, allowed]).with_one_line();
    }
    downpour(&["drop"]).failed(2, &["--diameter"]).with_one_line();
}
