//! Small pictures that ask for much: under 1 MiB, none takes more than 5 s of CPU time or 1 GiB.
//!
//! Alone in its binary, so that the peak of the process's memory is that of these files.

mod effort;
mod exit_code;
mod picture_files;

use downpour_scene::picture::decode;
use downpour_scene::{Budget, SceneError};
use effort::measured;
use exit_code::ExitCode as _;
use picture_files::{ExrFile, hdr, png, png_chunk, zlib};
use std::fs;
use std::time::Duration;

const MAX_TIME: Duration = Duration::from_secs(5);
const MAX_MEMORY_KIB: u64 = 1 << 20;

/// The peak of this process's memory in KiB, where the system tells it.
fn peak_kib() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[test]
fn small_pictures_stay_small() {
    // A flat 8-bit color picture of 8192 x 8192 is at the edge of what a small file may be.
    let flat = zlib(&vec![0; 8192 * (8192 * 3 + 1)]);
    let mut padded = png(8192, 8192, 8, 2, &flat);
    let end = padded.split_off(padded.len() - 12);
    let padding = (1 << 20) - padded.len() - 100;
    padded.extend(png_chunk(b"teSt", &vec![0; padding]));
    padded.extend(end);
    let squared = |side: i32| {
        let window = [0, 0, side - 1, side - 1];
        let file = ExrFile { data: window, display: window, ..ExrFile::default() };
        let mut bytes = file.bytes();
        bytes.resize(1_000_000, 0);
        bytes
    };
    let mut jpeg = Vec::new();
    let tiny = image::DynamicImage::ImageRgb8(image::RgbImage::new(16, 16));
    tiny.write_to(&mut std::io::Cursor::new(&mut jpeg), image::ImageFormat::Jpeg).unwrap();
    // The frame header says another size than the scan has.
    let frame = jpeg.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    let sized = |side: u16| {
        let mut bytes = jpeg.clone();
        bytes[frame + 5..frame + 7].copy_from_slice(&side.to_be_bytes());
        bytes[frame + 7..frame + 9].copy_from_slice(&side.to_be_bytes());
        bytes
    };
    let cases: [(&str, Vec<u8>, &[u8]); 9] = [
        ("flat.png", padded, &[0]),
        ("cut.png", png(8192, 8192, 8, 2, &flat[..flat.len() / 2]), &[2]),
        ("large.png", png(16_384, 16_384, 8, 0, &flat), &[3]),
        ("deep.png", png(8192, 8192, 16, 6, &flat), &[3]),
        ("rows.hdr", hdr("", 5000, 5000, &[2; 900_000]), &[2]),
        ("large.exr", squared(7000), &[2, 3]),
        ("larger.exr", squared(8000), &[2, 3]),
        ("frame.jpg", sized(6000), &[0, 2]),
        ("frames.jpg", sized(65_535), &[3]),
    ];
    for (name, bytes, codes) in cases {
        assert!(bytes.len() <= 1 << 20, "{name}: {} bytes", bytes.len());
        let (result, took) = measured(|| decode(name, &bytes, &mut Budget::default()));
        let found = result.as_ref().map_or_else(SceneError::exit_code, |_| 0);
        let said = result.map_or_else(|error| error.to_string(), |p| format!("{} x {}", p.width, p.height));
        println!("{took:?} {:?} KiB at most, {name}: {said}", peak_kib());
        assert!(codes.contains(&found), "{name}: {found} {said}");
        assert!(took < MAX_TIME, "{name}: {took:?}");
    }
    if let Some(peak) = peak_kib() {
        assert!(peak < MAX_MEMORY_KIB, "{peak} KiB");
    }
}
