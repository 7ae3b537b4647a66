//! `downpour wind`: pictures of winds, and their statistics.

use crate::child::Downpour;

const VORTEX: &str = "[[wind]]\nvortex = { strength_m2_s = 60, core_m = 3, core = 'lamb-oseen' }\n";

fn wind(weather: &str, arguments: &[&str]) -> Downpour {
    let first = ["wind", "w.toml", "-o", "w.png", "--size", "96x80"];
    Downpour::new(&[&first, arguments].concat()).with_file("w.toml", weather)
}

#[test]
fn a_vortex_is_measured_and_drawn() {
    let form = ["--form", "primitives"];
    let arguments = ["--slice", "xz=2", "--json", "--box", "-10,-10,-10,10,10,10"];
    let run = || wind(VORTEX, &[&arguments[..], &form].concat()).run();
    let ended = run().succeeded().left(&["w.png", "w.toml"]);
    let json = ended.json();
    let number = |key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{key} of {json}"));
    assert_eq!((number("primitives"), number("waves"), number("time_s")), (1.0, 0.0, 0.0));
    // Lamb and Oseen's peak.
    let peak = 0.63817 * 60.0 / (std::f64::consts::TAU * 3.0);
    assert!((number("speed_max_m_s") / peak - 1.0).abs() < 1.0e-3, "{json}");
    assert!(number("speed_min_m_s") < 0.3 && number("speed_mean_m_s") > 0.5 * peak, "{json}");
    assert!(number("divergence_rms_s") < 1.0e-3, "{json}");
    assert!(ended.stderr.contains("wrote w.png: 96 x 80, 0."), "{}", ended.stderr);
    let bytes = ended.file("w.png");
    assert!(bytes.starts_with(b"\x89PNG") && bytes[16..24] == [0, 0, 0, 96, 0, 0, 0, 80]);
    assert_eq!(run().succeeded().file("w.png"), bytes, "the same bytes again");
}

#[test]
fn time_and_place_matter() {
    let keyed = "[[wind]]\nuniform = { speed_m_s = [[0, 2], [10, 12]], towards_deg = 0 }\n";
    let speed = |time: &str| {
        let ended = wind(keyed, &["--slice", "yz=0", "--time", time, "--json", "-q"])
            .run()
            .succeeded()
            .without_a_word();
        ended.json()["speed_mean_m_s"].as_f64().unwrap()
    };
    assert!((speed("0") - 2.0).abs() < 1.0e-5 && (speed("5") - 7.0).abs() < 1.0e-5);
    // A source has divergence at its center, and none far away.
    let source = "[[wind]]\nsource = { strength_m3_s = 100, core_m = 2 }\n";
    let divergence = |offset: &str| {
        let arguments = ["--slice", offset, "--json", "--box", "-5,-5,-5,5,5,5", "--form", "primitives"];
        let run = wind(source, &arguments).run().succeeded();
        run.json()["divergence_rms_s"].as_f64().unwrap()
    };
    assert!(divergence("xy=0") > 0.3 && divergence("xy=80") < 1.0e-4);
    let eddies = wind("[turbulence]\n", &["--slice", "xy=0", "--json", "--form", "primitives"])
        .run()
        .succeeded()
        .json();
    assert!(
        eddies["waves"].as_u64().unwrap() > 10 && eddies["divergence_rms_s"].as_f64().unwrap() < 1.0e-2,
        "{eddies}"
    );
}

/// The rain feels the wind in cells: finer details are blurred, with a warning.
#[test]
fn what_is_drawn_is_what_the_rain_feels() {
    let narrow = "[[wind]]\nvortex = { strength_m2_s = 60, core_m = 0.5, core = 'lamb-oseen' }\n";
    let peak = |weather: &str, form: &str| {
        let arguments = ["--slice", "xz=2", "--json", "--box", "-4,-4,-4,4,4,4", "--form", form];
        let ended = wind(weather, &arguments).run().succeeded();
        let blurred = ended.stderr.contains("warning: w.toml: [[wind]] 0: a core of 0.5 m is below a cell");
        (ended.json()["speed_max_m_s"].as_f64().unwrap(), blurred)
    };
    // Lamb and Oseen's peak is 12 m/s at 0.56 m; the middles of the cells are 0.78 m from the axis along x and z.
    let (exact, said) = peak(narrow, "primitives");
    assert!((exact / 12.19 - 1.0).abs() < 0.01 && said, "{exact}");
    let (felt, said) = peak(narrow, "cells");
    assert!((felt / 8.4 - 1.0).abs() < 0.1 && said, "{felt}");
    let fine = format!("{narrow}[wind_field]\nbox_m = [12, 12, 12]\n");
    let (felt, said) = peak(&fine, "cells");
    assert!((felt / 12.19 - 1.0).abs() < 0.04 && !said, "{felt}");
}

#[test]
fn what_has_no_wind_is_refused() {
    let refused = |weather: &str, arguments: &[&str], code: i32, words: &[&str]| {
        wind(weather, arguments).run().failed(code, words).with_one_line().left(&["w.toml"]);
    };
    refused("[rain]\n", &["--slice", "xy=0"], 2, &["w.toml: still air", "[[wind]]"]);
    refused(VORTEX, &[], 2, &["--slice"]);
    for bad in ["xy", "xy=", "zx=1", "xy=nan", "xy=1e7"] {
        refused(VORTEX, &["--slice", bad], 2, &["xy=Z, xz=Y or yz=X"]);
    }
    for bad in ["1,2,3", "a,b,c,d,e,f", "1,2,3,4,5,6,7"] {
        refused(VORTEX, &["--slice", "xy=0", "--box", bad], 2, &["six numbers"]);
    }
    refused(VORTEX, &["--slice", "xy=0", "--box", "0,0,0,1,0,1"], 2, &["edge of the box is 0 m"]);
    refused(VORTEX, &["--slice", "xy=0", "--box", "0,0,0,1,nan,1"], 2, &["edge of the box is NaN m"]);
    refused("[[wind]]\nvortex = { core_m = 0 }", &["--slice", "xy=0"], 2, &["line 2", "core_m: 0; allowed"]);
    let size =
        |size: &str| Downpour::new(&["wind", "w.toml", "-o", "w.png", "--slice", "xy=0", "--size", size]);
    size("4097x64").with_file("w.toml", VORTEX).run().failed(3, &["64 to 4096"]).with_one_line();
    size("63x64").with_file("w.toml", VORTEX).run().failed(2, &["64 to 4096"]).with_one_line();
    let other = |input: &str, output: &str| Downpour::new(&["wind", input, "-o", output, "--slice", "xy=0"]);
    other("a.glb", "w.png").run().failed(2, &["a model has no wind"]).with_one_line();
    other("w.toml", "w.exr").run().failed(2, &["allowed: .png"]).with_one_line();
    other("none.toml", "w.png").run().failed(5, &["none.toml"]).with_one_line();
    wind(VORTEX, &["--slice", "xy=0"]).with_file("w.png", "mine").run().failed(5, &["w.png exists"]);
}
