//! `downpour mask` on the CPU: the three formats, read back.

use downpour::drop::DropShape;
use downpour::drop::mesh::DropMesh;
use downpour::mask::file::{exr, ktx2};
use downpour::mask::{Mask, MaskOptions, View, trace_drop};

use crate::child::{Downpour, downpour};
use crate::gltf_file::gltf;

fn expected(diameter: f64, size: u32, degrees: f64, refractive_index: f64) -> Mask {
    let view = View::from_elevation(degrees.to_radians()).unwrap();
    trace_drop(&DropShape::new(diameter).unwrap(), &MaskOptions { size, view, refractive_index }).unwrap()
}

/// Covered area in squares of the equivalent radius.
fn area(mask: &Mask) -> f64 {
    mask.texels.iter().map(|t| f64::from(t.coverage)).sum::<f64>() * mask.texel_width() * mask.texel_width()
}

fn worst(a: &Mask, b: &Mask) -> f32 {
    let differences = a.texels.iter().zip(&b.texels).flat_map(|(a, b)| {
        let d =
            |k: usize| (a.direction[k] - b.direction[k]).abs().max((a.reflected[k] - b.reflected[k]).abs());
        [d(0), d(1), d(2), (a.coverage - b.coverage).abs(), (a.transmittance - b.transmittance).abs()]
    });
    differences.fold(0.0, f32::max)
}

#[test]
fn an_exr_holds_the_mask_to_the_last_bit() {
    let ended = downpour(&[
        "mask",
        "--diameter",
        "3",
        "--size",
        "96",
        "--elevation",
        "-25",
        "--backend",
        "cpu",
        "-o",
        "m.exr",
    ]);
    let ended = ended.succeeded().left(&["m.exr"]);
    assert_eq!(ended.stdout, "");
    assert_eq!(ended.stderr, "downpour: wrote m.exr: a mask of 96 x 96\n");
    let mask = exr::read_exr(&ended.file("m.exr")).unwrap();
    assert_eq!(mask.texels, expected(3.0e-3, 96, -25.0, 1.333).texels);
    assert_eq!((mask.size, mask.refractive_index), (96, 1.333));
    assert!(
        (mask.diameter - 3.0e-3).abs() < 1.0e-15
            && (mask.view.elevation().to_degrees() + 25.0).abs() < 1.0e-9
    );
}

#[test]
fn the_default_is_512_texels_and_quiet_is_quiet() {
    let ended = downpour(&["mask", "--diameter", "1", "--backend=cpu", "-q", "-o", "M.EXR"]).succeeded();
    assert_eq!((ended.stdout.as_str(), ended.stderr.as_str()), ("", ""));
    assert_eq!(exr::read_exr(&ended.file("M.EXR")).unwrap().size, 512);
}

#[test]
fn half_precision_keeps_directions_to_1_in_2000() {
    let arguments = ["mask", "--diameter", "2", "--size", "64", "--backend", "cpu"];
    let full = downpour(&[&arguments[..], &["-o", "m.exr"]].concat()).succeeded();
    let half = downpour(&[&arguments[..], &["--half", "-o", "m.exr"]].concat()).succeeded();
    assert!(half.file("m.exr").len() < full.file("m.exr").len());
    let difference = worst(&exr::read_exr(&half.file("m.exr")).unwrap(), &expected(2.0e-3, 64, 0.0, 1.333));
    assert!(difference > 0.0 && difference < 1.0 / 2000.0, "{difference}");
}

#[test]
fn a_ktx2_holds_an_array_over_diameters() {
    for diameters in [&["--diameter", "1,2.5,6"][..], &["--diameter", "1", "--diameter", "2.5,6"]] {
        let more = ["--size", "32", "--backend", "cpu", "-o", "m.ktx2"];
        let ended = downpour(&[&["mask"], diameters, &more].concat()).succeeded().left(&["m.ktx2"]);
        let masks = ktx2::read_ktx2(&ended.file("m.ktx2")).unwrap();
        assert_eq!(masks.len(), 3);
        for (mask, diameter) in masks.iter().zip([1.0e-3, 2.5e-3, 6.0e-3]) {
            assert!((mask.diameter - diameter).abs() < 1.0e-15);
            let difference = worst(mask, &expected(diameter, 32, 0.0, 1.333));
            assert!(difference < 1.0 / 2000.0, "{diameter}: {difference}");
        }
    }
}

#[test]
fn a_png_is_a_picture_of_the_mask() {
    let ended =
        downpour(&["mask", "--diameter", "2", "--size", "80", "--backend", "cpu", "-o", "m.png"]).succeeded();
    let bytes = ended.file("m.png");
    assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!(bytes[16..24], [0, 0, 0, 80, 0, 0, 0, 80]);
    let expected = downpour::mask::file::png::write_png(&expected(2.0e-3, 80, 0.0, 1.333)).unwrap();
    assert_eq!(bytes, expected);
}

/// IAPWS R9-97: blue light is refracted more, and warm water refracts less.
#[test]
fn the_index_follows_the_light_and_the_water() {
    let index = |more: &[&str]| {
        let arguments = ["mask", "--diameter", "2", "--size", "16", "--backend", "cpu", "-o", "m.exr"];
        let ended = downpour(&[&arguments[..], more].concat()).succeeded();
        exr::read_exr(&ended.file("m.exr")).unwrap().refractive_index
    };
    assert!((index(&["--wavelength", "589.3"]) - 1.33298).abs() < 1.0e-5);
    let (red, blue) = (index(&["--wavelength", "611"]), index(&["--wavelength", "464"]));
    assert!(blue - red > 0.004, "{red} {blue}");
    assert!(index(&["--wavelength", "611", "--temperature", "0"]) > red);
    assert!((index(&["--refractive-index", "1.5"]) - 1.5).abs() < 1.0e-12);
}

/// A drop of 3 mm as a mesh, in a file, is the drop of 3 mm.
#[test]
fn a_model_of_a_drop_has_the_mask_of_the_drop() {
    let mesh = DropMesh::latitude_longitude(&DropShape::new(3.0e-3).unwrap(), 64, 128).unwrap();
    let ended =
        Downpour::new(&["mask", "--model", "drop.gltf", "--size", "128", "--backend", "cpu", "-o", "m.exr"])
            .with_file("drop.gltf", gltf(mesh.positions(), mesh.triangles()))
            .run()
            .succeeded()
            .left(&["drop.gltf", "m.exr"]);
    let (model, drop) = (exr::read_exr(&ended.file("m.exr")).unwrap(), expected(3.0e-3, 128, 0.0, 1.333));
    assert!((model.diameter / 3.0e-3 - 1.0).abs() < 2.0e-3, "{}", model.diameter);
    assert!((area(&model) / area(&drop) - 1.0).abs() < 2.0e-3, "{} {}", area(&model), area(&drop));
    let (a, b) = (model.texel(90, 40), drop.texel(90, 40));
    let difference = (0..3).map(|k| (a.direction[k] - b.direction[k]).abs()).fold(0.0, f32::max);
    assert!(difference < 0.02, "{a:?} {b:?}");
}

#[test]
fn numbers_out_of_range_are_refused_and_nothing_is_written() {
    for (more, code, words) in [
        (&["--diameter", "12"][..], 2, &["'12'", "0.001 to 9 mm"][..]),
        (&["--diameter", "nan"], 2, &["'nan'", "not finite"]),
        (&["--diameter", "1,2,1e39"], 2, &["'1e39'", "0.001 to 9 mm"]),
        (&["--diameter", "1,,2"], 2, &["''", "0.001 to 9 mm"]),
        (&["--diameter", "2", "--size", "0"], 2, &["'0'", "4 to 4096"]),
        (&["--diameter", "2", "--size", "3"], 2, &["'3'", "4 to 4096"]),
        (&["--diameter", "2", "--size", "-8"], 2, &["'-8'", "4 to 4096"]),
        (&["--diameter", "2", "--size", "64.5"], 2, &["'64.5'", "4 to 4096"]),
        (&["--diameter", "2", "--size", "4097"], 3, &["4097", "4 to 4096"]),
        (&["--diameter", "2", "--size", "1000000"], 3, &["1000000", "4 to 4096"]),
        (&["--diameter", "2", "--size", "99999999999999999999"], 3, &["4 to 4096"]),
        (&["--diameter", "2", "--elevation", "91"], 2, &["'91'", "-90 to 90 degrees"]),
        (&["--diameter", "2", "--elevation", "inf"], 2, &["'inf'", "-90 to 90 degrees"]),
        (&["--diameter", "2", "--refractive-index", "1"], 2, &["'1'", "above 1, up to 4"]),
        (&["--diameter", "2", "--refractive-index", "nan"], 2, &["above 1, up to 4"]),
        (&["--diameter", "2", "--wavelength", "10"], 2, &["'10'", "200 to 1100 nm"]),
        (
            &["--diameter", "2", "--wavelength", "600", "--refractive-index", "1.3"],
            2,
            &["cannot be used with"],
        ),
        (&["--diameter", "2", "--temperature", "10"], 2, &["--wavelength"]),
        (&["--diameter", "2", "--model", "x.glb"], 2, &["cannot be used with"]),
        (&[], 2, &["--diameter", "--model"]),
        (&["--diameter", "2", "--backend", "opengl"], 2, &["'opengl'", "auto, gpu, cpu"]),
        (&["--diameter", "2", "--backend", "cpu", "--adapter", "x"], 2, &["--adapter", "--backend"]),
        (&["--diameter", "1,2"], 2, &["2 diameters for m.exr", ".ktx2"]),
    ] {
        downpour(&[&["mask", "-o", "m.exr"], more].concat()).failed(code, words).with_one_line().left(&[]);
    }
    let many = vec!["2"; 129].join(",");
    downpour(&["mask", "--diameter", &many, "--size", "8", "-o", "m.ktx2"])
        .failed(2, &["129 diameters", "1 to 128"])
        .with_one_line();
    downpour(&["mask", "--diameter", "1,2,3", "--size", "4096", "-o", "m.ktx2"])
        .failed(3, &["3 masks of 4096 x 4096", "allowed: 2 masks"])
        .with_one_line();
    downpour(&["mask", "--diameter", "1,2", "-o", "m.png"]).failed(2, &["one diameter"]).with_one_line();
    downpour(&["mask", "--diameter", "1", "--half", "-o", "m.png"])
        .failed(2, &["--half", ".exr"])
        .with_one_line();
}

/// An injected failure is one of a GPU.
#[test]
fn the_cpu_does_not_lose_a_device() {
    let arguments = ["mask", "--diameter", "2", "--size", "16", "--backend", "cpu", "-o", "m.exr"];
    Downpour::new(&arguments).env("DOWNPOUR_INJECT", "lost@1").run().succeeded().left(&["m.exr"]);
}

/// The memory of a machine is a limit too; an allocation that fails would be a signal.
#[cfg(target_os = "linux")]
#[test]
fn too_little_memory_is_over_a_limit() {
    Downpour::limited(
        &["-v 1000000"],
        &["mask", "--diameter", "2", "--size", "4096", "--backend", "cpu", "-o", "m.exr"],
    )
    .run()
    .failed(3, &["MiB of memory", "smaller --size"])
    .left(&[]);
}
