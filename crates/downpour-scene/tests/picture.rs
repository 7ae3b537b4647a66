//! PNG, JPEG and Radiance HDR: supported contents, and rows P1 to P7 of the reliability plan.

mod effort;
mod exit_code;
mod picture_files;

use downpour_scene::picture::{Picture, Pixels, decode};
use downpour_scene::{Budget, SceneError, WarningKind};
use effort::measured;
use exit_code::ExitCode as _;
use image::{DynamicImage, ImageFormat};
use picture_files::{hdr, png, png_chunk, zlib};
use std::io::Cursor;
use std::time::Duration;

/// An image as the bytes of a file.
fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("memory");
    bytes.into_inner()
}

fn read(name: &str, bytes: &[u8]) -> Result<Picture, SceneError> {
    decode(name, bytes, &mut Budget::default())
}

/// Rejected within a second of CPU time, with this code and this text.
#[track_caller]
fn refused(name: &str, bytes: &[u8], code: u8, words: &str) {
    let (result, took) = measured(|| read(name, bytes).map(|p| (p.width, p.height)));
    let error = result.expect_err(name);
    assert!(took < Duration::from_secs(1), "{took:?}");
    assert_eq!(error.exit_code(), code, "{error}");
    let said = error.to_string();
    assert!(said.starts_with(name) && said.contains(words), "{said}\n  has not: {words}");
}

#[test]
fn png_of_all_kinds_is_four_times_8_bits() {
    let gray = DynamicImage::ImageLuma8(image::GrayImage::from_raw(2, 1, vec![7, 200]).unwrap());
    let rgb = DynamicImage::ImageRgb8(image::RgbImage::from_raw(2, 1, vec![1, 2, 3, 4, 5, 6]).unwrap());
    let rgba = DynamicImage::ImageRgba8(image::RgbaImage::from_raw(1, 2, (1..=8).collect()).unwrap());
    // 16 bits are rounded: 256 * 257 / 65535 is 1.004 of 255.
    let deep = vec![0u16, 128, 129, 0xffff, 0x8000, 257];
    let deep = DynamicImage::ImageRgb16(image::ImageBuffer::from_raw(2, 1, deep).unwrap());
    for (image, size, pixels) in [
        (gray, (2, 1), vec![[7, 7, 7, 255], [200, 200, 200, 255]]),
        (rgb, (2, 1), vec![[1, 2, 3, 255], [4, 5, 6, 255]]),
        (rgba, (1, 2), vec![[1, 2, 3, 4], [5, 6, 7, 8]]),
        (deep, (2, 1), vec![[0, 0, 1, 255], [255, 128, 1, 255]]),
    ] {
        let mut budget = Budget::default();
        let picture = decode("a.png", &encoded(&image, ImageFormat::Png), &mut budget).unwrap();
        assert_eq!((picture.width, picture.height), size);
        assert_eq!(picture.pixels, Pixels::Rgba8(pixels));
        assert_eq!(picture.warnings, []);
        assert_eq!(budget.pixels, Budget::default().pixels - 2);
        assert_eq!(budget.bytes, Budget::default().bytes - 8);
    }
}

#[test]
fn jpeg_keeps_a_plain_color() {
    let image = DynamicImage::ImageRgb8(image::RgbImage::from_pixel(32, 16, image::Rgb([40, 120, 200])));
    let bytes = encoded(&image, ImageFormat::Jpeg);
    let picture = read("a.JPG", &bytes).unwrap();
    let Pixels::Rgba8(pixels) = &picture.pixels else { panic!("{picture:?}") };
    assert_eq!((picture.width, picture.height, pixels.len()), (32, 16, 512));
    for pixel in pixels {
        for (is, was) in pixel.iter().zip([40, 120, 200, 255]) {
            assert!(is.abs_diff(was) <= 4, "{pixel:?}");
        }
    }
    refused("cut.jpg", &bytes[..bytes.len() - 2], 2, "cut short");
    refused("head.jpg", &bytes[..40], 2, "cannot be decoded");
    // No ending, no promise.
    assert!(read("scene.glb: images[3]", &bytes).is_ok());
}

#[test]
fn radiance_is_divided_by_its_exposures() {
    let pixel = b"\x80\x40\x20\x82";
    let plain = read("a.hdr", &hdr("", 1, 1, pixel)).unwrap();
    assert_eq!(plain.pixels, Pixels::RgbaF32(vec![[2.0, 1.0, 0.5, 1.0]]));
    let exposed = read("a.hdr", &hdr("EXPOSURE=4\nEXPOSURE= 0.5\n", 1, 1, pixel)).unwrap();
    assert_eq!(exposed.pixels, Pixels::RgbaF32(vec![[1.0, 0.5, 0.25, 1.0]]));
    let other = [&b"#?RGBE"[..], &hdr("", 1, 1, pixel)[b"#?RADIANCE".len()..]].concat();
    assert_eq!(read("a.hdr", &other).unwrap().pixels, plain.pixels);
    let corrected = read("a.hdr", &hdr("COLORCORR=1 2 3\n", 1, 1, pixel)).unwrap();
    assert_eq!(corrected.warnings[0].kind, WarningKind::Ignored);
    for value in ["0", "-1", "nan", "inf", "1e400", "x"] {
        refused("a.hdr", &hdr(&format!("EXPOSURE={value}\n"), 1, 1, pixel), 2, "above 0");
    }
    refused("a.hdr", &hdr("EXPOSURE=1e300\nEXPOSURE=1e300\n", 1, 1, pixel), 2, "EXPOSURE");
    // The brightest pixel, divided by a tiny exposure, is not finite: black, counted, an error when strict.
    let bright = read("a.hdr", &hdr("EXPOSURE=1e-30\n", 1, 1, b"\xff\xff\xff\xff")).unwrap();
    assert_eq!(bright.pixels, Pixels::RgbaF32(vec![[0.0, 0.0, 0.0, 1.0]]));
    assert!(bright.warnings[0].what.starts_with("1 pixels that are not finite"));
    assert_eq!(bright.strict().unwrap_err().exit_code(), 2);
    refused("a.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n0000", 2, "32-bit_rle_xyze");
    refused("a.hdr", b"#?RADIANCE\n\n+Y 1 +X 1\n0000", 2, "Orientation +Y +X");
    refused("a.hdr", &hdr("", 2, 2, pixel), 2, "cannot be decoded");
}

/// P1: 400 million pixels in a small file. The budget limits it, and a small file stays small for any size.
#[test]
fn p1_png_of_20000_squared() {
    refused("p1.png", &png(20_000, 20_000, 8, 6, &zlib(&[0; 1000])), 3, "20000 x 20000 pixels");
    refused("p1.png", &png(16_384, 16_384, 8, 6, &zlib(&[0; 1000])), 3, "1024 MiB to decode");
    let small = Budget { pixels: 99, ..Budget::default() };
    let image = DynamicImage::ImageRgb8(image::RgbImage::new(10, 10));
    let bytes = encoded(&image, ImageFormat::Png);
    let mut budget = small;
    assert_eq!(decode("a.png", &bytes, &mut budget).unwrap_err().exit_code(), 3);
    assert_eq!(budget, small, "what is refused is not taken");
    budget = Budget { bytes: 500, ..Budget::default() };
    assert_eq!(decode("a.png", &bytes, &mut budget).unwrap_err().exit_code(), 3);
}

#[test]
fn p2_png_sizes_that_cannot_be() {
    let data = zlib(&[0; 100]);
    refused("p2.png", &png(0, 5, 8, 2, &data), 2, "cannot be decoded");
    refused("p2.png", &png(5, 0, 8, 2, &data), 2, "cannot be decoded");
    refused("p2.png", &png(i32::MAX as u32, i32::MAX as u32, 8, 2, &data), 3, "at most 65535 pixels");
    refused("p2.png", &png(1, 100_000_000, 8, 2, &data), 3, "at most 65535 pixels");
    refused("p2.png", &png(u32::MAX, 1, 8, 2, &data), 3, "");
    refused("p2.jpg", b"\xff\xd8\xff\xc0\x00\x11\x08\x00\x00\x00\x00\x03", 2, "cannot be decoded");
}

#[test]
fn p3_png_that_is_damaged() {
    let rows: Vec<u8> = (0..16u8).flat_map(|row| [0, row, 2, 3, 4, 5, 6]).collect();
    let whole = png(2, 16, 8, 2, &zlib(&rows));
    assert!(read("a.png", &whole).is_ok());
    for end in [8, 20, 40, 50, whole.len() - 30] {
        refused("cut.png", &whole[..end], 2, "");
    }
    refused("garbage.png", &png(2, 16, 8, 2, &[0x55; 64]), 2, "cannot be decoded");
    refused("few.png", &png(2, 16, 8, 2, &zlib(&rows[..60])), 2, "cannot be decoded");
    let mut crc = whole.clone();
    crc[30] ^= 1;
    refused("crc.png", &crc, 2, "cannot be decoded");
    let mut noise = 1u32;
    for at in 8..whole.len() {
        let mut bytes = whole.clone();
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        bytes[at] ^= (noise >> 24) as u8 | 1;
        let _ = read("mutated.png", &bytes);
    }
}

/// P4, P5: text and color profiles that inflate to much are not inflated, or not kept.
#[test]
fn p4_p5_side_chunks_are_left_alone() {
    let bomb = zlib(&vec![0; 64 << 20]);
    let text = [b"Comment\0\0".as_slice(), &bomb].concat();
    let international = [b"XML:com.adobe.xmp\0\x01\0\0\0".as_slice(), &bomb].concat();
    let mut chunks = Vec::new();
    for _ in 0..8 {
        chunks.extend(png_chunk(b"zTXt", &text));
        chunks.extend(png_chunk(b"iTXt", &international));
    }
    let plain = png(1, 1, 8, 2, &zlib(&[0, 9, 8, 7]));
    let (head, rest) = plain.split_at(33);
    let profile = png_chunk(b"iCCP", &[b"p\0\0".as_slice(), &bomb].concat());
    let (picture, took) = measured(|| {
        let picture = read("p4.png", &[head, &chunks, rest].concat()).unwrap();
        let _ = read("p4.png", &[head, &profile, rest].concat());
        picture
    });
    assert_eq!(picture.pixels, Pixels::Rgba8(vec![[9, 8, 7, 255]]));
    assert!(took < Duration::from_secs(4), "{took:?}");
}

#[test]
fn p6_radiance_of_a_million_squared() {
    let pixel = b"\x80\x40\x20\x82";
    refused("p6.hdr", &hdr("", 20_000, 20_000, pixel), 3, "20000 x 20000 pixels");
    refused("p6.hdr", &hdr("", 1_000_000, 1_000_000, pixel), 3, "asks for too much");
    refused("p6.hdr", &hdr("", 7000, 7000, pixel), 3, "to decode");
    refused("p6.hdr", &hdr("", 0, 1, pixel), 2, "");
    refused("p6.hdr", b"#?RADIANCE\n\n-Y 99999999999999999999 +X 1\n", 2, "");
}

#[test]
fn p7_what_is_no_picture_is_named() {
    let png = encoded(&DynamicImage::ImageRgb8(image::RgbImage::new(1, 1)), ImageFormat::Png);
    refused("a.png", b"", 2, "an empty file; allowed: a PNG, JPEG");
    refused("a.png", b"Dear all,", 2, "a file that begins with \"Dear all\"");
    refused("a.png", b"\0\x01\xff", 2, "bytes 00 01 ff");
    refused("a.png", b"GIF89a", 2, "a GIF image");
    refused("a.tif", b"RIFF....WEBP", 2, "a RIFF file");
    refused("a.jpg", &png, 2, "a PNG image with the ending \".jpg\"; allowed: .png");
    refused("a.EXR", &png, 2, "a PNG image with the ending \".EXR\"");
    refused("a.tga", &png, 2, "rename or convert");
    // An extension of no picture format does not restrict the kind.
    for name in ["a.png", "a", "a.bin", "folder.jpg/a.Png"] {
        assert!(read(name, &png).is_ok(), "{name}");
    }
}
