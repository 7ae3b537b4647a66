//! Golden images: small masks as the CPU twin traces them, kept as OpenEXR in half floats.
//!
//! `DOWNPOUR_BLESS=1` writes them and then fails: a new picture counts once a person has looked at it. On a
//! difference, what was made is written beside the report of the parity tests.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::PathBuf;

use downpour_drop::DropShape;
use downpour_mask::file::exr::{Precision, read_exr, write_exr};
use downpour_mask::{Mask, MaskOptions, View, trace_drop};
use downpour_tests::report;

/// Name, diameter in meters, elevation of the view in degrees.
const MASKS: [(&str, f64, f64); 6] = [
    ("mask_0.5mm_side", 0.5e-3, 0.0),
    ("mask_2mm_side", 2.0e-3, 0.0),
    ("mask_5mm_side", 5.0e-3, 0.0),
    ("mask_9mm_side", 9.0e-3, 0.0),
    ("mask_4mm_30deg_above", 4.0e-3, 30.0),
    ("mask_6mm_from_below", 6.0e-3, -90.0),
];
/// Most bytes of one image, and of all.
const LIMITS: (u64, u64) = (64 << 10, 8 << 20);

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("goldens/masks")
}

fn make(diameter: f64, degrees: f64) -> Mask {
    let view = View::from_elevation(f64::to_radians(degrees)).unwrap();
    let options = MaskOptions { size: 64, view, ..MaskOptions::default() };
    trace_drop(&DropShape::new(diameter).unwrap(), &options).unwrap()
}

#[test]
fn masks_are_what_they_were() {
    let bless = std::env::var("DOWNPOUR_BLESS").is_ok_and(|v| v == "1");
    let mut wrong = Vec::new();
    for (name, diameter, degrees) in MASKS {
        let bytes = write_exr(&make(diameter, degrees), Precision::Half).unwrap();
        let path = folder().join(format!("{name}.exr"));
        if bless {
            std::fs::create_dir_all(folder()).unwrap();
            std::fs::write(&path, &bytes).unwrap();
            wrong.push(format!("{name} was written: look at it"));
            continue;
        }
        let kept = std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let (kept, made) = (read_exr(&kept).unwrap(), read_exr(&bytes).unwrap());
        if kept.texels != made.texels {
            let differ = kept.texels.iter().zip(&made.texels).filter(|(a, b)| a != b).count();
            std::fs::create_dir_all(report::folder()).unwrap();
            let out = report::folder().join(format!("{name}.made.exr"));
            std::fs::write(&out, &bytes).unwrap();
            wrong.push(format!("{name}: {differ} texels differ; made: {}", out.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn goldens_are_small_and_all_used() {
    let mut total = 0;
    for entry in std::fs::read_dir(folder()).unwrap() {
        let entry = entry.unwrap();
        let size = entry.metadata().unwrap().len();
        assert!(size <= LIMITS.0, "{} has {size} bytes", entry.path().display());
        total += size;
        let name = entry.file_name().to_string_lossy().replace(".exr", "");
        assert!(MASKS.iter().any(|(n, ..)| *n == name), "{name} belongs to no test");
    }
    assert!(total <= LIMITS.1, "{total} bytes in all");
}

/// The comparison can fail: a drop a hundredth of a millimeter larger is another picture.
#[test]
fn another_drop_is_another_picture() {
    let half = |d: f64| read_exr(&write_exr(&make(d, 0.0), Precision::Half).unwrap()).unwrap().texels;
    assert_ne!(half(2.0e-3), half(2.01e-3));
}
