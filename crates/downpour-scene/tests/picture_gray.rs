//! Gray pictures of 16 bits.

mod exit_code;
use downpour_scene::Budget;
use downpour_scene::picture::decode_gray16;
use exit_code::ExitCode as _;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb};
use std::io::Cursor;

fn png(image: &DynamicImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).expect("a PNG");
    bytes.into_inner()
}

#[test]
fn all_sixteen_bits_are_read() {
    let image = ImageBuffer::from_fn(5, 3, |x, y| Luma([1000 * x as u16 + y as u16]));
    let gray = decode_gray16("a.png", &png(&image.clone().into()), &mut Budget::default()).expect("gray");
    assert_eq!((gray.width, gray.height), (5, 3));
    assert_eq!(gray.values, image.into_raw());
    let eight = ImageBuffer::from_fn(2, 1, |x, _| Luma([if x == 0 { 255u8 } else { 1 }]));
    let gray = decode_gray16("a.png", &png(&eight.into()), &mut Budget::default()).expect("gray");
    assert_eq!(gray.values, [65535, 257]);
}

#[test]
fn what_is_not_gray_is_refused() {
    let color: DynamicImage = ImageBuffer::from_pixel(2, 2, Rgb([1u8, 2, 3])).into();
    let error = decode_gray16("c.png", &png(&color), &mut Budget::default()).expect_err("color");
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("c.png") && error.to_string().contains("one channel"), "{error}");
    let image: DynamicImage = ImageBuffer::from_pixel(64, 64, Luma([7u16])).into();
    let bytes = png(&image);
    for length in [0, 7, 30, bytes.len() / 2, bytes.len() - 13] {
        decode_gray16("cut.png", &bytes[..length], &mut Budget::default()).expect_err("cut");
    }
    let mut small = Budget { bytes: 1000, ..Budget::default() };
    let error = decode_gray16("large.png", &bytes, &mut small).expect_err("over the budget");
    assert_eq!(error.exit_code(), 3);
    decode_gray16("a.jpg", &bytes, &mut Budget::default()).expect_err("another kind than the name says");
}
