//! `downpour lattice`: invariants, pictures, and invalid input.

use crate::child::Downpour;

fn lattice(arguments: &[&str]) -> Downpour {
    Downpour::new(&[&["lattice"], arguments].concat())
}

#[test]
fn water_on_glass_is_counted_to_the_nanoliter() {
    let arguments = [
        "glass", "--size", "96x64", "--rate", "300", "--speed", "12", "--steps", "4000", "--check", "mass",
        "--json",
    ];
    let run = |more: &[&str]| lattice(&[&arguments, more].concat()).run().succeeded();
    let ended = run(&["--show", "mass", "-o", "m.png"]).left(&["m.png"]);
    let json = ended.json();
    let number = |key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{key} of {json}"));
    assert_eq!((number("steps"), number("lost_nl")), (4000.0, 0.0));
    assert_eq!(json["sound"].as_str(), Some("yes"));
    let went = number("over_edge_nl") + number("evaporated_nl") + number("wiped_nl") + number("spilled_nl");
    assert!(number("landed_nl") > 0.0 && number("landed_nl") == number("stored_nl") + went, "{json}");
    let bytes = ended.file("m.png");
    assert!(bytes.starts_with(b"\x89PNG") && bytes[16..24] == [0, 0, 0, 96, 0, 0, 0, 64]);
    assert_eq!(run(&["--show", "mass", "-o", "m.png"]).file("m.png"), bytes, "the same bytes again");
    assert_ne!(run(&["--show", "mass", "-o", "m.png", "--seed", "3"]).file("m.png"), bytes);
}

#[test]
fn ripples_keep_what_they_should() {
    for (check, key, most) in [("energy", "energy_drift", 1.0e-4), ("mass", "volume_share", 1.0e-4)] {
        let ended = lattice(&["puddle", "--size", "64x64", "--steps", "300", "--check", check, "--json"])
            .run()
            .succeeded();
        let json = ended.json();
        assert!(json[key].as_f64().is_some_and(|found| found <= most), "{json}");
        assert!(json["highest_mm"].as_f64().unwrap() > 0.0, "{json}");
    }
    let rest = lattice(&["puddle", "--size", "64x64", "--steps", "300", "--check", "rest", "--json"]).run();
    assert_eq!(rest.succeeded().json()["highest_mm"].as_f64(), Some(0.0));
    let rain =
        ["puddle", "--size", "64x80", "--rate", "50", "--steps", "200", "--show", "normal", "-o", "n.exr"];
    let ended = lattice(&rain).run().succeeded().left(&["n.exr"]);
    assert!(
        ended.stdout.contains("drops") && ended.stderr.contains("wrote n.exr: 64 x 80"),
        "{}",
        ended.stderr
    );
}

/// Damping leaves almost no ripples, and rounding a small drift of the volume.
#[test]
fn the_volume_is_compared_with_what_was_moved_at_first() {
    let arguments =
        ["puddle", "--size", "64x64", "--depth", "0.5", "--steps", "4000", "--check", "mass", "--json"];
    let json = lattice(&arguments).run().succeeded().json();
    assert!(json["highest_mm"].as_f64().is_some_and(|highest| highest < 1.0e-4), "{json}");
}

#[test]
fn a_clip_has_a_picture_every_few_steps() {
    let puddle = ["puddle", "--size", "64x64", "--rate", "100", "--steps", "25"];
    let ended = lattice(&[&puddle[..], &["--every", "10", "-o", "%02d.png"]].concat()).run().succeeded();
    let ended = ended.left(&["00.png", "01.png", "02.png"]);
    assert!(ended.stderr.contains("wrote %02d.png: 64 x 64, 3 pictures"), "{}", ended.stderr);
    assert_ne!(ended.file("01.png"), ended.file("02.png"));

    let glass = ["glass", "--size", "64x64", "--rate", "300", "--speed", "12", "--steps", "1200"];
    let clip = lattice(&[&glass[..], &["--every", "600", "-o", "%d.exr"]].concat()).run().succeeded();
    let clip = clip.left(&["0.exr", "1.exr", "2.exr"]);
    let alone = lattice(&[&glass[..], &["-o", "a.exr"]].concat()).run().succeeded();
    assert_eq!(clip.file("2.exr"), alone.file("a.exr"), "a picture changes nothing of what comes");
    assert_ne!(clip.file("1.exr"), clip.file("2.exr"));
}

#[test]
fn what_is_no_lattice_is_refused() {
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        lattice(arguments).run().failed(code, words).with_one_line().left(&[]);
    };
    refused(&["glass", "--size", "4x64"], 2, &["columns of the pane is 4 cells", "8 to 4096"]);
    refused(&["glass", "--cell", "0.2"], 2, &["edge of a cell is 0.2 mm", "0.25 to 5"]);
    refused(&["glass", "--tilt", "91"], 2, &["--tilt", "0 to 90 degrees"]);
    refused(&["glass", "--steps", "0"], 2, &["--steps", "from 1"]);
    refused(&["glass", "--rate", "nan"], 2, &["--rate", "not finite"]);
    refused(&["glass", "-o", "a.jpg"], 2, &["a.jpg", ".png or .exr"]);
    refused(&["glass", "--check", "energy"], 2, &["energy", "mass"]);
    refused(&["puddle", "--size", "64x63"], 2, &["size of the lattice", "64 to 4096"]);
    refused(&["puddle", "--check", "energy", "--rate", "5"], 2, &["--check with --rate", "without them"]);
    refused(&["puddle", "--depth", "0"], 2, &["--depth", "0.1 to 1000000 mm"]);
    refused(&["glass", "--adapter", "x"], 2, &["--adapter names a GPU", "--backend gpu or auto"]);
    refused(&["puddle", "--adapter", "x"], 2, &["--adapter names a GPU", "--backend gpu or auto"]);
    refused(&["glass", "--every", "5"], 2, &["--output"]);
    refused(&["glass", "--every", "0", "-o", "%d.png"], 2, &["--every", "from 1"]);
    refused(&["glass", "--every", "5", "-o", "a.png"], 2, &["a.png", "%04d"]);
    refused(
        &["glass", "--steps", "5000000", "--every", "5", "-o", "%d.png"],
        2,
        &["1000001", "at most 1000000"],
    );
    lattice(&["glass", "--size", "8x8", "--steps", "9", "--every", "3", "-o", "%d.png"])
        .with_file("2.png", "mine")
        .run()
        .failed(5, &["2.png"])
        .left(&["2.png"]);
    lattice(&["glass", "--size", "8x8", "--steps", "1", "-o", "a.png"])
        .with_file("a.png", "mine")
        .run()
        .failed(5, &["a.png"])
        .left(&["a.png"]);
}
