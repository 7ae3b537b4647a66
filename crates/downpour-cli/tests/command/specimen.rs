//! `downpour specimen` on the CPU: pictures, and invalid input.

use downpour::render::file::write_exr;
use downpour::scene::Budget;
use downpour::scene::picture::{Pixels, decode};

use crate::child::{Downpour, Ended};

/// A sky that is bright above and dark below.
fn sky() -> Vec<u8> {
    let pixels: Vec<[f32; 3]> =
        (0..64 * 32).map(|i| if i / 64 < 16 { [2.0, 3.0, 4.0] } else { [0.1; 3] }).collect();
    write_exr(64, 32, &pixels).unwrap()
}

fn specimen(arguments: &[&str]) -> Ended {
    let fixed = ["specimen", "--environment", "sky.exr", "--backend", "cpu"];
    Downpour::new(&[&fixed[..], arguments].concat()).with_file("sky.exr", sky()).run()
}

fn pixels(ended: &Ended) -> (u32, u32, Vec<[f32; 4]>) {
    let picture = decode("d.exr", &ended.file("d.exr"), &mut Budget::default()).unwrap();
    match picture.pixels {
        Pixels::RgbaF32(pixels) => (picture.width, picture.height, pixels),
        Pixels::Rgba8(_) => panic!("an OpenEXR file of bytes"),
    }
}

/// The drop shows the sky upside down; beside it the map is visible as it is.
#[test]
fn the_sky_is_upside_down_in_the_drop() {
    let ended = specimen(&["--diameter", "2", "--size", "90x60", "-o", "d.exr"]).succeeded();
    let (width, height, pixels) = pixels(&ended);
    assert_eq!((width, height), (90, 60));
    let at = |x: u32, y: u32| pixels[(y * width + x) as usize];
    assert!(at(45, 20)[2] < 1.0, "above the middle of the drop: {:?}", at(45, 20));
    assert!(at(45, 42)[2] > 3.0, "below the middle of the drop: {:?}", at(45, 42));
    assert!(at(1, 1)[2] > at(1, 58)[2], "the background is upright");
}

#[test]
fn a_picture_of_one_pixel_is_one() {
    let ended = specimen(&["--diameter", "2", "--size", "1x1", "-q", "-o", "d.exr"]).succeeded();
    assert_eq!(pixels(&ended).2.len(), 1);
    assert_eq!((ended.stdout.as_str(), ended.stderr.as_str()), ("", ""));
    let png = specimen(&["--diameter", "2", "--size", "8x8", "-o", "d.png"]).succeeded();
    assert!(png.file("d.png").starts_with(b"\x89PNG"));
}

/// With an exposure and an oscillation of 0, the picture is that of the drop at rest.
#[test]
fn a_streak_of_no_exposure_is_the_drop_at_rest() {
    let picture = |more: &[&str]| {
        let arguments = ["--diameter", "3", "--size", "24x24", "-o", "d.exr"];
        specimen(&[&arguments[..], more].concat()).succeeded().file("d.exr")
    };
    let still = picture(&[]);
    assert!(still == picture(&["--exposure", "0", "--oscillation", "none", "--samples", "4"]));
    assert!(still != picture(&["--samples", "5"]), "samples of a drop at rest");
    assert!(still == picture(&["--oscillation", "0,0", "--phase", "0.3,0.1"]));
    assert!(
        still != picture(&["--oscillation", "0.2,0.1", "--phase", "0.25,0.25"]),
        "a drop that is drawn out"
    );
}

/// In 1/500 s a drop of 2 mm falls 13 mm: six and a half diameters.
#[test]
fn a_streak_is_as_long_as_the_fall() {
    let arguments = ["--diameter", "2", "--exposure", "0.002", "--samples", "4", "--size", "33x99"];
    let ended = specimen(&[&arguments[..], &["-o", "d.exr"]].concat()).succeeded();
    let (width, height, pixels) = pixels(&ended);
    let bare: Vec<f32> = (0..height).map(|y| pixels[(y * width) as usize][2]).collect();
    let rows: Vec<u32> = (0..height)
        .filter(|&y| (pixels[(y * width + 16) as usize][2] - bare[y as usize]).abs() > 1.0e-3)
        .collect();
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    // 80 % of 99 rows, and the sky behind is nearly the same all over the picture.
    assert!((9..=13).contains(&first) && (85..=90).contains(&last), "{first} {last}");
}

#[test]
fn bad_arguments_are_refused() {
    for (arguments, code, words) in [
        (&["--diameter", "12", "-o", "d.exr"][..], 2, "0.001 to 9 mm"),
        (&["--diameter", "2", "--size", "0x0", "-o", "d.exr"], 2, "WxH"),
        (&["--diameter", "2", "--size", "16385x1", "-o", "d.exr"], 3, "16384"),
        (&["--diameter", "2", "--distance", "nan", "-o", "d.exr"], 2, "not finite"),
        (&["--diameter", "2", "--distance", "1e39", "-o", "d.exr"], 2, "out of range"),
        (&["--diameter", "9", "--distance", "0.001", "-o", "d.exr"], 2, "outside the drop"),
        (&["--diameter", "2", "--fov", "180", "-o", "d.exr"], 2, "170 degrees"),
        (&["--diameter", "2", "--pitch", "91", "-o", "d.exr"], 2, "-90 to 90"),
        (&["--diameter", "2", "-o", "d.jpg"], 2, ".exr or .png"),
        (&["--diameter", "2", "--exposure", "-0.01", "-o", "d.exr"], 2, "0 to 1 s"),
        (&["--diameter", "2", "--exposure", "NaN", "-o", "d.exr"], 2, "not finite"),
        (&["--diameter", "2", "--exposure", "1.01", "-o", "d.exr"], 2, "0 to 1 s"),
        (&["--diameter", "2", "--exposure", "1/60", "-o", "d.exr"], 2, "not a number"),
        (&["--diameter", "2", "--samples", "0", "-o", "d.exr"], 2, "1 to 4096"),
        (&["--diameter", "2", "--samples", "-4", "-o", "d.exr"], 2, "1 to 4096"),
        (
            &["--diameter", "2", "--samples", "many", "-o", "d.exr"],
            2,
            "allowed: a whole number from 1 to 4096 (of a drop at rest: to 16), or table",
        ),
        (&["--diameter", "2", "--samples", "4097", "-o", "d.exr"], 3, "1 to 16"),
        (&["--diameter", "2", "--samples", "1000000", "--exposure", "0.01", "-o", "d.exr"], 3, "4096"),
        (&["--diameter", "2", "--samples", "99999999999", "-o", "d.exr"], 3, "1 to 16"),
        (&["--diameter", "2", "--oscillation", "0.1", "-o", "d.exr"], 2, "0 to 0.3"),
        (&["--diameter", "2", "--oscillation", "0.1,0.4", "-o", "d.exr"], 2, "0 to 0.3"),
        (&["--diameter", "2", "--oscillation", "nan,0", "-o", "d.exr"], 2, "not finite"),
        (&["--diameter", "0.04", "--oscillation", "0.1,0.1", "-o", "d.exr"], 2, "0.05 to 9"),
        (&["--diameter", "2", "--phase", "0,inf", "-o", "d.exr"], 2, "not finite"),
        (&["--diameter", "2", "--exposure", "1", "--pitch", "90", "-o", "d.exr"], 2, "path of the drop"),
        (&["--diameter", "2", "--light", "1,2,3", "-o", "d.exr"], 2, "YAW,PITCH,RADIUS,L"),
        (&["--diameter", "2", "--light", "1,2,3,4,5", "-o", "d.exr"], 2, "YAW,PITCH,RADIUS,L"),
        (&["--diameter", "2", "--light", "nan,0,1,1", "-o", "d.exr"], 2, "not finite"),
        (&["--diameter", "2", "--light", "0,91,1,1", "-o", "d.exr"], 2, "PITCH -90 to 90"),
        (&["--diameter", "2", "--light", "0,0,0,1", "-o", "d.exr"], 2, "RADIUS 0.01 to 90"),
        (&["--diameter", "2", "--light", "0,0,1,-1", "-o", "d.exr"], 2, "radiance 0 to 1e9"),
        (&["--diameter", "2", "--light", "0,0,1,1,NaN,1", "-o", "d.exr"], 2, "not finite"),
        (&["--diameter", "2", "-o", "nowhere/d.exr"], 5, "nowhere"),
    ] {
        specimen(arguments).failed(code, &[words]).left(&["sky.exr"]);
    }
}

/// The table's picture is another than the exact one, and shows the same: as much light, in the same pixels.
#[test]
fn a_streak_by_the_table_is_beside_the_exact_one() {
    let picture = |diameter, exposure, samples| {
        let arguments = ["--exposure", exposure, "--samples", samples, "--fov", "10", "--size", "33x99"];
        pixels(&specimen(&[&["--diameter", diameter, "-o", "d.exr"][..], &arguments].concat()).succeeded()).2
    };
    let (exact, table) = (picture("2", "0.002", "8"), picture("2", "0.002", "table"));
    let (faint, other) = (picture("2", "0.5", "1"), picture("3", "0.002", "table"));
    let streak: Vec<usize> = (0..exact.len()).filter(|&k| (exact[k][2] - faint[k][2]).abs() > 0.02).collect();
    assert!(streak.len() > 200, "{}", streak.len());
    let apart = |a: &[[f32; 4]]| -> f64 {
        let squares =
            streak.iter().map(|&k| f64::from(a[k][2] - exact[k][2]) * f64::from(a[k][2] - exact[k][2]));
        (squares.sum::<f64>() / streak.len() as f64).sqrt()
    };
    assert!(exact != table);
    let (found, of_other) = (apart(&table), apart(&other));
    assert!(found < 0.05 && of_other > 3.0 * found, "{found}, and of another drop {of_other}");
}

#[test]
fn what_has_no_table_is_refused() {
    let with_light = ["--light", "180,0,6,5"];
    for (more, words) in [
        (&["--diameter", "2"][..], &["--samples table", "--exposure 0", "above 0"][..]),
        (
            &["--diameter", "0.3", "--exposure", "0.01"],
            &["--samples table", "diameter", "0.3 mm", "0.5 to 9"],
        ),
        (
            &["--diameter", "2", "--exposure", "0.01", "--distance", "0.01"],
            &["--samples table", "camera distance", "0.01 m", "from 0.022"],
        ),
        (&["--diameter", "2", "--exposure", "0.01", "--fov", "0.001"], &["field of view", "above 0.006"]),
        (
            &[&["--diameter", "2", "--exposure", "0.01"], &with_light[..]].concat(),
            &["--samples table", "radius of a lamp", "6.0", "0.01 to 5"],
        ),
    ] {
        let arguments = [&["--samples", "table", "-o", "d.exr"], more].concat();
        specimen(&arguments).failed(2, words).with_one_line().left(&["sky.exr"]);
    }
}

#[test]
fn more_lamps_than_there_is_room_for_are_refused() {
    let lamps = ["--light", "180,0,1,5"].repeat(9);
    let arguments = [&["--diameter", "2", "-o", "d.exr"][..], &lamps].concat();
    specimen(&arguments).failed(3, &["number of lamps is 9; allowed: 0 to 8"]).left(&["sky.exr"]);
}

/// A red lamp from the side is mirrored by the drop on that side, and by none of the other's.
#[test]
fn a_lamp_glints_on_its_side() {
    let arguments = ["--diameter", "2", "--size", "60x60", "--light", "90,0,10,500,0,0", "-o", "d.exr"];
    let (width, _, pixels) = pixels(&specimen(&arguments).succeeded());
    let reddest = (0..pixels.len()).max_by(|&a, &b| pixels[a][0].total_cmp(&pixels[b][0])).unwrap();
    let (x, y) = (reddest % width as usize, reddest / width as usize);
    assert!(pixels[reddest][0] > 1.0 + pixels[reddest][2] && x > 35 && (25..35).contains(&y), "{x} {y}");
}

#[test]
fn bad_sky_maps_are_refused() {
    for (bytes, code) in [(&b""[..], 2), (b"no picture at all", 2), (&sky()[..200], 2)] {
        let arguments = ["specimen", "--diameter", "2", "--environment", "bad.exr", "-o", "d.exr"];
        Downpour::new(&arguments)
            .with_file("bad.exr", bytes)
            .run()
            .failed(code, &["bad.exr"])
            .left(&["bad.exr"]);
    }
    let arguments = ["specimen", "--diameter", "2", "--environment", "none.hdr", "-o", "d.exr"];
    Downpour::new(&arguments).run().failed(5, &["none.hdr"]).left(&[]);
}
