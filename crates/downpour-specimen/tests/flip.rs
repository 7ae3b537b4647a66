//! The picture of a streak by the table beside the exact one, as an eye sees the two: FLIP (Andersson et al. 2020).

use std::path::Path;

use downpour_drop::DropShape;
use downpour_drop::oscillation::Amplitudes;
use downpour_math::ops::f64 as ops;
use downpour_scene::Budget;
use downpour_scene::sky::{SkyMap, read_sky};
use downpour_specimen::{Image, Sky, SpecimenOptions, render_specimen, render_specimen_table};

/// Largest difference of a channel of a pixel outside of the streak, as a part of the sky's.
const SKY: f32 = 1.0e-3;

fn street(name: &str) -> SkyMap {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/skies").join(name);
    read_sky(&path, &mut Budget::default()).expect("a map of the assets")
}

/// Pixels in which the picture is not the sky behind the drop.
fn streak(image: &Image, bare: &Image) -> Vec<bool> {
    let differs = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).any(|k| (a[k] - b[k]).abs() > SKY * b[k]);
    image.pixels.iter().zip(&bare.pixels).map(differs).collect()
}

/// The picture in 8 bits, with the curve of sRGB and an exposure.
fn encoded(image: &Image, exposure: f64) -> Vec<u8> {
    let curve = |value: f32| {
        let value = (f64::from(value) * exposure).clamp(0.0, 1.0);
        let curved =
            if value < 0.003_130_8 { 12.92 * value } else { 1.055 * ops::pow(value, 1.0 / 2.4) - 0.055 };
        (255.0 * curved).round() as u8
    };
    image.pixels.as_flattened().iter().map(|&value| curve(value)).collect()
}

/// Mean FLIP within the streak, at 67 pixels for a degree, with the exposure that puts the logarithmic mean of the exact streak at 0.18.
fn mean_flip(exact: &Image, found: &Image, within: &[bool]) -> f64 {
    let light =
        |pixel: &[f32; 3]| f64::from(0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]).max(1.0e-6);
    let count = within.iter().filter(|&&inside| inside).count() as f64;
    let logs =
        exact.pixels.iter().zip(within).filter(|(_, inside)| **inside).map(|(p, _)| ops::log2(light(p)));
    let exposure = 0.18 / ops::pow(2.0, logs.sum::<f64>() / count);
    let [exact, found] = [exact, found]
        .map(|image| nv_flip::FlipImageRgb8::with_data(image.width, image.height, &encoded(image, exposure)));
    let errors = nv_flip::flip(exact, found, nv_flip::DEFAULT_PIXELS_PER_DEGREE).to_vec();
    errors.iter().zip(within).filter(|(_, inside)| **inside).map(|(&e, _)| f64::from(e)).sum::<f64>() / count
}

/// Before the maps of streets by night and by day, level and from above. The exact streak has 2304 rays a pixel before lamps by night, where
/// 192 have a noise of 0.03 of their own, and 1024 by day. The control is the table's streak upside down.
#[test]
fn a_table_streak_looks_like_the_exact_one() {
    let maps = ["street_night.hdr", "street_day.hdr"].map(street);
    let [night, day] = [0, 1];
    for (diameter_mm, map, pitch, exposure_s, oscillation) in [
        (4.0, night, 0.0, 2.0e-3, Amplitudes::NONE),
        (4.0, night, 0.0, 2.0e-3, Amplitudes::GARG_NAYAR_OBLATE),
        (4.0, day, 0.0, 2.0e-3, Amplitudes::NONE),
        (2.0, day, 0.8, 1.0e-3, Amplitudes::NONE),
    ] {
        let sky = Sky::new(maps[map].width, maps[map].height, &maps[map].radiance).expect("a sky");
        let shape = DropShape::new(diameter_mm * 1.0e-3).expect("a diameter");
        let options = SpecimenOptions {
            size: [40, 120],
            samples: if map == night { 6 } else { 4 },
            instants: 64,
            pitch,
            yaw: 0.9,
            exposure_s,
            oscillation,
            phase: [0.2, 0.7],
            ..SpecimenOptions::default()
        };
        let exact = render_specimen(&shape, &options, sky).expect("a picture");
        let table = render_specimen_table(&shape, &options, sky).expect("a picture");
        let fov = Some(options.fov(&shape).expect("a field of view"));
        let bare = SpecimenOptions { exposure_s: 0.0, fov, oscillation: Amplitudes::NONE, ..options };
        let speck = DropShape::new(1.0e-6).expect("a speck");
        let within = streak(&exact, &render_specimen(&speck, &bare, sky).expect("a picture"));
        let mut turned = table.clone();
        turned.pixels.reverse();
        let [found, control] = [&table, &turned].map(|image| mean_flip(&exact, image, &within));
        println!(
            "{diameter_mm} mm, pitch {pitch}, {exposure_s} s, {:?}: FLIP {found:.4}, upside down {control:.4}",
            oscillation.pair()
        );
        assert!(found <= 0.03 && control > 0.06, "{diameter_mm} mm, pitch {pitch}: {found}, {control}");
    }
}
