//! `downpour specimen` on the CPU: pictures, and what is refused.

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

/// The drop shows the sky upside down; beside it the map is seen as it is.
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
        (&["--diameter", "2", "-o", "nowhere/d.exr"], 5, "nowhere"),
    ] {
        specimen(arguments).failed(code, &[words]).left(&["sky.exr"]);
    }
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
