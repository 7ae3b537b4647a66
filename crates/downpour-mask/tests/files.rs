//! Masks as files: round trip, and rejection of damaged files.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour_drop::DropShape;
use downpour_mask::file::exr::{Precision, read_exr, write_exr};
use downpour_mask::file::ktx2::{read_ktx2, write_ktx2};
use downpour_mask::file::png::write_png;
use downpour_mask::{Mask, MaskError, MaskOptions, View, trace_drop};
use downpour_math::rng::rng_draw;

fn mask(d: f64, size: u32, degrees: f64) -> Mask {
    let view = View::from_elevation(degrees.to_radians()).unwrap();
    let options = MaskOptions { size, view, ..MaskOptions::default() };
    trace_drop(&DropShape::new(d).unwrap(), &options).unwrap()
}

#[test]
fn exr_float_is_the_mask_itself() {
    let before = mask(5.0e-3, 48, 20.0);
    let after = read_exr(&write_exr(&before, Precision::Float).unwrap()).unwrap();
    assert_eq!(before.texels, after.texels);
    assert_eq!(before.size, after.size);
    assert!((before.diameter - after.diameter).abs() < 1.0e-15);
    assert!((before.half_extent - after.half_extent).abs() < 1.0e-12);
    assert!((before.view.elevation() - after.view.elevation()).abs() < 1.0e-12);
}

#[test]
fn exr_half_keeps_three_digits() {
    let before = mask(2.0e-3, 32, 0.0);
    let after = read_exr(&write_exr(&before, Precision::Half).unwrap()).unwrap();
    for (a, b) in before.texels.iter().zip(&after.texels) {
        for (x, y) in a.direction.iter().zip(b.direction) {
            assert!((x - y).abs() <= 2.5e-4, "{x} {y}");
        }
        assert_eq!(a.reflections, b.reflections);
    }
}

#[test]
fn ktx2_is_read_again_and_by_the_ktx2_crate() {
    let before = [mask(1.0e-3, 32, 0.0), mask(2.0e-3, 32, 0.0), mask(6.0e-3, 32, 0.0)];
    let bytes = write_ktx2(&before).unwrap();
    let after = read_ktx2(&bytes).unwrap();
    assert_eq!(after.len(), 3);
    for (a, b) in before.iter().zip(&after) {
        assert!((a.diameter - b.diameter).abs() < 1.0e-15);
        for (p, q) in a.texels.iter().zip(&b.texels) {
            assert!((p.direction[0] - q.direction[0]).abs() <= 2.5e-4);
            assert!((p.transmittance - q.transmittance).abs() <= 2.5e-4);
            assert!((p.reflected[2] - q.reflected[2]).abs() <= 2.5e-4);
            assert!((p.internal[1] - q.internal[1]).abs() <= 2.5e-4);
            assert!((p.internal_transmittance - q.internal_transmittance).abs() <= 2.5e-4);
        }
    }
    let reader = ktx2::Reader::new(&bytes[..]).unwrap();
    assert_eq!(reader.header().layer_count, 9);
    assert_eq!(reader.header().format, Some(ktx2::Format::R16G16B16A16_SFLOAT));
    assert_eq!(reader.transfer_function(), Some(ktx2::TransferFunction::Linear));
    let keys: Vec<_> = reader.key_value_data().map(|(k, _)| k.to_owned()).collect();
    assert_eq!(keys, ["DownpourMask", "KTXorientation", "KTXwriter"]);
}

#[test]
fn the_same_masks_are_the_same_bytes() {
    let masks = [mask(1.0e-3, 24, 0.0), mask(2.0e-3, 24, 0.0)];
    for _ in 0..3 {
        assert_eq!(write_ktx2(&masks).unwrap(), write_ktx2(&masks).unwrap());
        for precision in [Precision::Float, Precision::Half] {
            assert_eq!(write_exr(&masks[0], precision).unwrap(), write_exr(&masks[0], precision).unwrap());
        }
        assert_eq!(write_png(&masks[0]).unwrap(), write_png(&masks[0]).unwrap());
    }
}

#[test]
fn png_shows_the_middle_as_straight_through() {
    let bytes = write_png(&mask(2.0e-3, 33, 0.0)).unwrap();
    let picture = image::load_from_memory(&bytes).unwrap().into_rgba8();
    let [r, g, b, a] = picture.get_pixel(16, 16).0;
    assert!(r.abs_diff(128) <= 1 && g.abs_diff(128) <= 12 && b > 250 && a == 255, "{r} {g} {b} {a}");
    assert_eq!(picture.get_pixel(0, 0).0[3], 0, "the corner is outside");
}

#[test]
fn masks_that_do_not_belong_together_are_no_array() {
    let (a, b, c) = (mask(1.0e-3, 24, 0.0), mask(1.0e-3, 25, 0.0), mask(1.0e-3, 24, 10.0));
    assert!(write_ktx2(&[]).is_err());
    assert!(write_ktx2(&[a.clone(), b]).is_err());
    assert!(write_ktx2(&[a.clone(), c]).is_err());
    assert!(write_ktx2(&vec![a; 86]).is_err());
}

/// Cut, flipped and random bytes give an error or a mask, never a panic; sizes from a header are checked first.
#[test]
fn damaged_files_are_refused() {
    let exr = write_exr(&mask(2.0e-3, 16, 0.0), Precision::Half).unwrap();
    let ktx2 = write_ktx2(&[mask(2.0e-3, 16, 0.0)]).unwrap();
    for length in 0..exr.len() {
        assert!(read_exr(&exr[..length]).is_err(), "OpenEXR cut at {length}");
    }
    for length in 0..ktx2.len() {
        assert!(read_ktx2(&ktx2[..length]).is_err(), "KTX2 cut at {length}");
    }
    let mut survived = 0;
    for i in 0..4000 {
        let [a, b, c, d] = rng_draw([9, 9], i, 0, 0);
        for (bytes, is_exr) in [(&exr, true), (&ktx2, false)] {
            let mut damaged = bytes.clone();
            // Mostly the header, where the sizes are.
            let reach = if d & 1 == 0 { damaged.len() } else { 480.min(damaged.len()) };
            damaged[a as usize % reach] = b as u8;
            if d & 2 == 0 {
                damaged[c as usize % reach] ^= 1 << (d >> 29);
            }
            survived +=
                u32::from(if is_exr { read_exr(&damaged).is_ok() } else { read_ktx2(&damaged).is_ok() });
        }
    }
    assert!(survived > 50, "only {survived} damaged files were read: the test is blind behind the header");
}

#[test]
fn hostile_headers_cost_nothing() {
    let mut bytes = write_ktx2(&[mask(2.0e-3, 16, 0.0)]).unwrap();
    // Sizes of 2^32 - 1.
    for at in [20, 24, 32, 36, 40] {
        let mut hostile = bytes.clone();
        hostile[at..at + 4].fill(0xff);
        let error = read_ktx2(&hostile).unwrap_err();
        assert!(matches!(error, MaskError::Size { .. } | MaskError::File { .. }), "{error}");
    }
    // An uncompressed length of 2^63.
    bytes[80 + 16..80 + 24].copy_from_slice(&(1u64 << 63).to_le_bytes());
    assert!(read_ktx2(&bytes).unwrap_err().to_string().contains("uncompressed length"));
    assert!(read_exr(b"not a picture at all").unwrap_err().to_string().starts_with("header"));
    assert!(read_ktx2(b"").is_err());
}
