//! `[[puddle]]` through `check` and `render`.

use std::path::Path;

use crate::child::Downpour;
use crate::clip::content;
use crate::scene_files::{NO_SPLASHES, model, weather};

/// The storm on uneven ground, with a painted puddle; `key` is one of the other.
fn flooded_with(key: &str, arguments: &[&str]) -> Downpour {
    let puddles = format!(
        "[[puddle]]\nposition_m = [0, 0, 2]\nsize_m = [4, 3]\nrelief_mm = 5\ncell_mm = 40\n{key}\n\
         [[puddle]]\nposition_m = [0, 0, -2]\nsize_m = [2, 1]\nmask = 'mask.png'\n"
    );
    let mut mask = std::io::Cursor::new(Vec::new());
    let white = image::GrayImage::from_pixel(4, 2, image::Luma([255]));
    white.write_to(&mut mask, image::ImageFormat::Png).unwrap();
    Downpour::new(arguments)
        .with_file("storm.toml", weather(&format!("{NO_SPLASHES}{puddles}")))
        .with_file("floor.gltf", model())
        .with_file("mask.png", mask.into_inner())
}

fn flooded(arguments: &[&str]) -> Downpour {
    flooded_with("", arguments)
}

#[test]
fn check_tells_of_the_water() {
    let check = ["check", "storm.toml", "--json"];
    let listed = flooded_with("running = false", &check).run().succeeded().json();
    let number = |key: &str| listed[key].as_f64().unwrap();
    assert_eq!(number("puddles"), 2.0);
    // 2 m^2 are painted, 12 mm deep; of the other 12 m^2 some are hollows.
    assert!((2.2..12.0).contains(&number("puddle_area_m2")), "{listed}");
    assert!(number("puddle_volume_l") > 24.0 && number("puddle_deepest_mm") >= 12.0, "{listed}");
    // 400 mm/h run off level ground as a sheet of water.
    let running = flooded(&check).run().succeeded().json();
    let area = running["puddle_area_m2"].as_f64().unwrap();
    assert!(area > number("puddle_area_m2") + 1.0 && area <= 14.0, "{running}");
}

/// Water changes the picture, ripples continue from frame to frame, and a resumed clip is the same.
#[test]
fn a_clip_of_puddles_goes_on_where_it_stopped() {
    let run = |folder: &Path, frames: &str| {
        let output = folder.join("%d.png");
        let small = ["--size", "32x18", "--backend", "cpu", "--samples", "1", "--fps", "8", "-q"];
        let arguments = ["render", "storm.toml", "--frames", frames, "-o", output.to_str().unwrap()];
        flooded(&[&arguments[..], &small[..]].concat()).run().succeeded();
        content(folder)
    };
    let (parts, whole) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    run(parts.path(), "0..1");
    let parts = run(parts.path(), "0..3");
    let whole = run(whole.path(), "0..3");
    assert!(parts == whole, "other files");
    assert!(whole[1].1 != whole[2].1, "ripples stand still");
}
