//! The puddles of a weather file: every key, and rejected values.

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;
use downpour_scene::Budget;
use downpour_weather::{PuddleFill, PuddleRings, PuddleShape, Roots, Weather, load};
use exit_code::ExitCode as _;

const ALL: &str = r#"
[[puddle]]
position_m = [1, 0.2, -3]
size_m = [4, 2]
turn_deg = 30
reach_m = 0.5
depth_mm = 40
fill = 0.7
min_depth_mm = 2
relief_mm = 3
seed = 8
cell_mm = 20
ripple_scale = 1.5
ripple_deg = 90
ripple_influence = 0.5
rings = "lattice"
attenuation_length_m = 0.1
color = [0.2, 0.15, 0.1]
"#;

fn says(text: &str, code: u8, message: &str) {
    let error = Weather::parse("w.toml", text).expect_err(text);
    assert_eq!((error.exit_code(), error.to_string()), (code, format!("w.toml: {message}")));
}

#[test]
fn every_key_arrives() {
    let weather = Weather::parse("w.toml", ALL).unwrap();
    let [puddle] = &weather.puddles[..] else { panic!("{} puddles", weather.puddles.len()) };
    assert_eq!((puddle.middle, puddle.size, puddle.reach), ([1.0, 0.2, -3.0], [4.0, 2.0], 0.5));
    assert!((puddle.turn.to_degrees() - 30.0).abs() < 1.0e-9);
    assert!((puddle.ripple_turn.to_degrees() - 90.0).abs() < 1.0e-9);
    assert_eq!((puddle.ripple_scale, puddle.ripple_influence, puddle.attenuation_length), (1.5, 0.5, 0.1));
    assert_eq!(puddle.rings, PuddleRings::Lattice);
    assert_eq!((puddle.depth, puddle.color), (0.04, [0.2, 0.15, 0.1]));
    let found = PuddleShape::Found {
        fill: PuddleFill::Part(0.7),
        min_depth: 0.002,
        relief: 0.003,
        seed: 8,
        cells: [200, 100],
    };
    assert_eq!(puddle.shape, found);
}

#[test]
fn rain_fills_by_default() {
    let with = |line: &str| {
        let text = format!("[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [4, 2]\n{line}\n");
        let weather = Weather::parse("w.toml", &text).unwrap();
        let PuddleShape::Found { fill, .. } = weather.puddles[0].shape else { panic!("{text}") };
        fill
    };
    assert_eq!(with(""), PuddleFill::Rain { seepage: 0.0, running: true });
    let PuddleFill::Rain { seepage, running } = with("fill = \"rain\"\nseepage_mm_h = 3.6\nrunning = false")
    else {
        panic!("not by rain")
    };
    assert!((seepage - 1.0e-6).abs() < 1.0e-15 && !running);
    assert_eq!((with("fill = 0"), with("fill = 1")), (PuddleFill::Part(0.0), PuddleFill::Part(1.0)));
}

/// Water that runs off: what fell but what the ground stores, then what dries, then the rain since.
#[test]
fn what_runs_off_is_what_the_ground_does_not_store() {
    let text =
        "[rain]\nrate_mm_h = 36\n[wetness]\nrained_mm = 5\nstorage_mm = 0.5\ndried_s = 1000\ndrying_s = 5000";
    let weather = Weather::parse("w.toml", text).unwrap();
    let [before, lost, since] = weather.runoff(0.0, 500.0).unwrap();
    // 5 mm less 0.5; a fifth of 0.5 mm dries; 36 mm/h for 500 s is 5 mm, of which the ground stores what has dried.
    let stored = 0.5e-3 * (1.0 - downpour_math::ops::f64::exp(-0.2));
    for (found, expected) in [(before, 4.5e-3), (lost, 0.1e-3), (since, 5.0e-3 - stored)] {
        assert!((found - expected).abs() < 1.0e-9, "{found}, {expected}");
    }
    let keyed = "[rain]\nrate_mm_h = [[0, 36], [1000, 36], [1000.001, 0]]\n[wetness]\nrained_mm = 0\nstorage_mm = 0.5";
    let weather = Weather::parse("w.toml", keyed).unwrap();
    // 10 mm in 1000 s less 0.5 mm, less 1 mm/h that seeps away; then it dries and seeps on for an hour: 1 mm and 3600 s of drying.
    let [before, lost, since] = weather.runoff(1.0e-3 / 3600.0, 4600.0).unwrap();
    let (dry, fell) = (0.5e-3 / weather.wetness.drying_s * 3600.0, 10.0e-3 - 0.5e-3 - 1.0e-3 / 3.6);
    for (found, expected) in [(before, fell), (lost, 1.0e-3 + dry), (since, 0.0)] {
        assert!((found - expected).abs() < 1.0e-7, "{found}, {expected}");
    }
    let fixed = Weather::parse("w.toml", "[wetness]\nwetness = 0.5").unwrap();
    assert_eq!(fixed.runoff(0.0, 0.0), None);
}

/// The runoff of a place is the mean of the last five minutes: that of the rain, less what the ground stores and what seeps away.
#[test]
fn runoff_is_the_rain_of_five_minutes() {
    let rate = |text: &str, seepage_mm_h: f64, time_s: f64| {
        let weather = Weather::parse("w.toml", text).unwrap();
        weather.runoff_rate(seepage_mm_h * 1.0e-3 / 3600.0, time_s) * 3.6e6
    };
    let is = |found: f64, wanted: f64| assert!((found - wanted).abs() < 1.0e-3, "{found} {wanted} mm/h");
    // Ten minutes of it have fallen before time 0.
    let steady = "[rain]\nrate_mm_h = 36";
    for time in [0.0, 10.0, 4000.0] {
        is(rate(steady, 0.0, time), 36.0);
        is(rate(steady, 6.0, time), 30.0);
        is(rate(steady, 50.0, time), 0.0);
    }
    // It begins at time 0, and the ground stores the first 0.5 mm.
    let begins = "[rain]\nrate_mm_h = 36\n[wetness]\nrained_mm = 0\nstorage_mm = 0.5";
    is(rate(begins, 0.0, 40.0), 0.0);
    is(rate(begins, 0.0, 150.0), (1.5 - 0.5) * 12.0);
    is(rate(begins, 0.0, 200.0), (2.0 - 0.5) * 12.0);
    is(rate(begins, 0.0, 1000.0), 36.0);
    // It ends at 600 s, and five minutes later nothing runs.
    let ends = "[rain]\nrate_mm_h = [[0, 36], [600, 36], [600.001, 0]]";
    is(rate(ends, 0.0, 600.0), 36.0);
    is(rate(ends, 0.0, 700.0), 24.0);
    is(rate(ends, 0.0, 901.0), 0.0);
    // It has ended a hundred seconds before time 0, and one began then that rises to 36 mm/h in 200 s.
    let again = "[rain]\nrate_mm_h = [[0, 18], [100, 36]]\n[wetness]\ndried_s = 100";
    is(rate(again, 0.0, 0.0), 18.0 * 200.0 / 300.0);
    is(rate(again, 0.0, 100.0), (18.0 * 100.0 + 27.0 * 100.0) / 300.0);
    assert_eq!(rate("[rain]\nrate_mm_h = 36\n[wetness]\nwetness = 0.5", 0.0, 9.0), 0.0);
}

#[test]
fn what_cannot_be_is_refused() {
    let with = |line: &str| format!("[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [4, 2]\n{line}\n");
    says(&with("fill = 1.5"), 2, "line 4, column 8: puddle[0].fill: 1.5; allowed: \"rain\", or 0 to 1");
    says(
        &with("fill = 0.5\nseepage_mm_h = 2"),
        2,
        "line 5, column 1: puddle[0].seepage_mm_h: beside a fill that is given; allowed: fill = \"rain\"",
    );
    says(
        &with("fill = [[0, 0], [1, 1]]\nrunning = true"),
        2,
        "line 5, column 1: puddle[0].running: beside a fill that is given; allowed: fill = \"rain\"",
    );
    says(
        &with("mask = \"m.png\"\nrunning = true"),
        2,
        "line 5, column 1: puddle[0].running: beside mask; allowed: either a mask, or a puddle that is found",
    );
    says(
        &with("mask = \"m.png\"\nrelief_mm = 2"),
        2,
        "line 5, column 1: puddle[0].relief_mm: beside mask; allowed: either a mask, or a puddle that is found",
    );
    says(
        &with("cell_mm = 2\nsize_m = [50, 2]").replacen("size_m = [4, 2]\n", "", 1),
        2,
        "line 3, column 1: puddle[0].cell_mm: 25000 x 1000 cells; allowed: at most 2048 along each edge: a larger cell_mm, or \
         more puddles",
    );
    says(
        &with("mask = \"../m.png\""),
        2,
        "line 4, column 1: puddle[0].mask: \"../m.png\" leaves the scene folder; allowed: only relative paths inside the \
         folder of the weather file or an asset root",
    );
    for line in ["depth_mm = nan", "ripple_scale = 0", "attenuation_length_m = 0", "size = 3"] {
        assert_eq!(Weather::parse("w.toml", &with(line)).expect_err(line).exit_code(), 2, "{line}");
    }
    let many = "[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [4, 2]\n".repeat(17);
    assert_eq!(Weather::parse("w.toml", &many).expect_err("17 puddles").exit_code(), 3);
    let large = "[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [20, 20]\ncell_mm = 10\n".repeat(2);
    assert_eq!(Weather::parse("w.toml", &large).expect_err("8 million cells").exit_code(), 3);
}

#[test]
fn a_mask_is_read_and_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("w.toml");
    let text = "[[puddle]]\nposition_m = [0, 0, 0]\nsize_m = [4, 2]\nmask = \"mask.png\"\n";
    std::fs::write(&path, text).unwrap();
    let read = || {
        let weather = Weather::read(&path, &mut Budget::default())?;
        let roots = Roots::open(&path, &[])?;
        load(&weather, &roots, &mut Budget::default())
    };
    let error = read().expect_err("no mask");
    assert_eq!(error.exit_code(), 5);
    assert!(error.to_string().starts_with("mask.png: "), "{error}");
    let save = |width, height| {
        image::GrayImage::from_fn(width, height, |x, _| image::Luma([(x % 256) as u8]))
            .save(folder.path().join("mask.png"))
            .unwrap();
    };
    save(8, 4);
    let loaded = read().expect("a mask");
    assert_eq!(loaded.masks[0].as_ref().map(|mask| (mask.width, mask.height)), Some((8, 4)));
    save(2049, 2);
    assert_eq!(read().expect_err("too wide").exit_code(), 3);
    std::fs::write(folder.path().join("mask.png"), "no picture").unwrap();
    assert_eq!(read().expect_err("no picture").exit_code(), 2);
}
