//! OpenEXR: what is read, and rows E1 to E16 of the reliability plan.

mod effort;
mod exit_code;
mod picture_files;

use downpour_scene::picture::{Picture, Pixels, decode};
use downpour_scene::{Budget, SceneError, WarningKind};
use effort::measured;
use exit_code::ExitCode as _;
use exr::prelude::*;
use picture_files::{ExrFile, exr_attribute, zlib};
use std::io::Cursor;
use std::time::Duration;

type Read = std::result::Result<Picture, SceneError>;

fn read(bytes: &[u8]) -> Read {
    decode("a.exr", bytes, &mut Budget::default())
}

/// Refused at once, with this code and these words.
#[track_caller]
fn refused(bytes: &[u8], code: u8, words: &str) {
    let (result, took) = measured(|| read(bytes).map(|p| (p.width, p.height)));
    let error = result.expect_err(words);
    assert!(took < Duration::from_millis(200), "{took:?}");
    assert_eq!(error.exit_code(), code, "{error}");
    let said = error.to_string();
    assert!(said.starts_with("a.exr: ") && said.contains(words), "{said}\n  has not: {words}");
}

fn with(change: impl FnOnce(&mut ExrFile)) -> Vec<u8> {
    let mut file = ExrFile::default();
    change(&mut file);
    file.bytes()
}

/// A tiled file without its pixels.
fn tiled(side: i32, tile: [u32; 2], mode: u8) -> Vec<u8> {
    with(|file| {
        file.version |= 0x200;
        file.data = [0, 0, side - 1, side - 1];
        file.display = file.data;
        let value = [&tile[0].to_le_bytes()[..], &tile[1].to_le_bytes(), &[mode]].concat();
        file.more = exr_attribute("tiles", "tiledesc", &value);
    })
}

/// The gradient that the tests of schemes write.
fn gradient(x: usize, y: usize) -> (f32, f32, f32, f32) {
    (x as f32 * 0.25, y as f32 * 0.5 - 3.0, 1000.0 + x as f32, 0.5)
}

fn written(encoding: Encoding) -> Vec<u8> {
    let channels = SpecificChannels::rgba(|at: Vec2<usize>| gradient(at.0, at.1));
    let layer = Layer::new((37, 53), LayerAttributes::named(""), encoding, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).expect("memory");
    bytes.into_inner()
}

#[test]
fn pixels_stand_in_rows_from_the_top() {
    let mut budget = Budget::default();
    let picture = decode("a.exr", &ExrFile::default().bytes(), &mut budget).unwrap();
    let pixels = vec![[2.0, 0.0, 1.0, 1.0], [0.0, 0.5, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]];
    assert_eq!(picture.pixels, Pixels::RgbaF32(pixels));
    assert_eq!((picture.width, picture.height, picture.warnings.as_slice()), (2, 2, &[][..]));
    assert_eq!(budget.pixels, Budget::default().pixels - 4);
    assert_eq!(budget.bytes, Budget::default().bytes - 64);
}

#[test]
fn all_safe_schemes_are_read() {
    let tiles = Blocks::Tiles(Vec2(16, 16));
    for (compression, blocks, exact) in [
        (Compression::Uncompressed, Blocks::ScanLines, true),
        (Compression::RLE, Blocks::ScanLines, true),
        (Compression::ZIP1, Blocks::ScanLines, true),
        (Compression::ZIP16, Blocks::ScanLines, true),
        (Compression::ZIP16, tiles, true),
        (Compression::PIZ, Blocks::ScanLines, true),
        (Compression::PIZ, tiles, true),
        (Compression::PXR24, Blocks::ScanLines, false),
    ] {
        let bytes = written(Encoding { compression, blocks, line_order: LineOrder::Increasing });
        let picture = read(&bytes).unwrap();
        assert_eq!((picture.width, picture.height), (37, 53));
        let Pixels::RgbaF32(pixels) = picture.pixels else { panic!("{compression:?}") };
        for (i, pixel) in pixels.iter().enumerate() {
            let (r, g, b, a) = gradient(i % 37, i / 37);
            for (is, was) in pixel.iter().zip([r, g, b, a]) {
                let close = if exact { *is == was } else { (is - was).abs() <= was.abs() * 1e-4 };
                assert!(close, "{compression:?} {i}: {is} {was}");
            }
        }
        // E16: cut in the middle, at many locations.
        for end in (0..bytes.len() - 1).step_by(61) {
            assert_eq!(read(&bytes[..end]).unwrap_err().exit_code(), 2, "{compression:?} cut at {end}");
        }
        // E9, E13: one wrong byte anywhere is refused or read, and never worse.
        let mut noise = 1u32;
        for at in (4..bytes.len()).step_by(if bytes.len() > 4000 { 199 } else { 5 }) {
            let mut bytes = bytes.clone();
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            bytes[at] ^= (noise >> 24) as u8 | 1;
            let _ = read(&bytes);
        }
    }
}

#[test]
fn gray_is_read_and_chroma_is_not() {
    let only = |names: &[&'static str]| {
        let names = names.to_vec();
        with(|file| file.channels = names.into_iter().map(|name| (name, 1, 1)).collect())
    };
    let gray = with(|file| {
        file.channels = vec![("Y", 2, 1)];
        file.data = [0, 0, 0, 1];
        file.display = file.data;
        let row = |y: u32, value: f32| [y.to_le_bytes(), 4u32.to_le_bytes(), value.to_le_bytes()].concat();
        file.body = [row(0, 0.25), vec![0; 8], row(1, 7.0)].concat();
    });
    let gray = read(&gray).unwrap();
    assert_eq!(gray.pixels, Pixels::RgbaF32(vec![[0.25, 0.25, 0.25, 1.0], [7.0, 7.0, 7.0, 1.0]]));
    refused(&only(&["BY", "RY", "Y"]), 2, "BY, RY, Y");
    refused(&only(&["Z"]), 2, "the channels \"Z\"; allowed: R, G and B, or Y");
    refused(&only(&[]), 2, "channels");
}

#[test]
fn e1_e2_dwa_is_refused_by_its_header() {
    for (scheme, name) in [(8, "DWAA"), (9, "DWAB"), (10, "HTJ2K"), (77, "an unknown scheme (77)")] {
        refused(&with(|file| file.compression = scheme), 2, name);
    }
}

#[test]
fn e3_b44_is_refused_by_its_header() {
    refused(&with(|file| file.compression = 6), 2, "B44 (6) is not supported; allowed: none, RLE, ZIPS");
    refused(&with(|file| file.compression = 7), 2, "save the file again");
}

#[test]
fn e4_e5_sizes_are_limited_before_memory_is_taken() {
    let huge = [0, 0, 99_999, 99_999];
    refused(&with(|file| (file.data, file.display) = (huge, huge)), 3, "100000 x 100000 pixels");
    refused(&tiled(16_384, [1, 1], 1), 3, "");
    refused(&tiled(6000, [1, 1], 1), 3, "");
    refused(&tiled(1500, [1, 1], 1), 3, "blocks; allowed: at most 1048576");
    refused(
        &with(|file| (file.data, file.display) = ([0, 0, 8191, 8191], [0, 0, 8191, 8191])),
        3,
        "to decode",
    );
    let many = with(|file| (file.data, file.display) = ([0, 0, 0, 49_999], [0, 0, 0, 49_999]));
    refused(&many, 2, "after the header, for 50000 blocks");
}

#[test]
fn e6_e7_windows_that_cannot_be() {
    refused(&with(|file| file.data = [0, 0, -12, 3]), 2, "dataWindow: from (0, 0) to (-12, 3)");
    refused(&with(|file| file.data = [5, 5, 4, 4]), 2, "dataWindow");
    refused(&with(|file| file.display = [5, 5, 4, 4]), 2, "displayWindow");
    let far = i32::MAX;
    refused(&with(|file| file.data = [far - 1, far - 1, far, far]), 2, "within 1073741823 of 0");
    refused(&with(|file| file.data = [i32::MIN, i32::MIN, far, far]), 2, "within 1073741823 of 0");
    refused(&with(|file| file.data = [1 - (1 << 30), 0, (1 << 30) - 1, 1]), 3, "2147483647 x 2 pixels");
    // A window elsewhere is read, and said.
    let mut aside = ExrFile { data: [10, -5, 11, -4], display: [0, 0, 99, 49], ..ExrFile::default() };
    aside.body[0..4].copy_from_slice(&(-5i32).to_le_bytes());
    aside.body[20..24].copy_from_slice(&(-4i32).to_le_bytes());
    let picture = read(&aside.bytes()).unwrap();
    assert_eq!((picture.width, picture.height), (2, 2));
    assert_eq!(picture.warnings[0].kind, WarningKind::Irregular);
    assert!(picture.warnings[0].what.contains("2 x 2 pixels from (10, -5)"));
}

/// E8: 64 MiB packed in a picture of 4 x 4. E9: noise in every scheme.
#[test]
fn e8_e9_blocks_that_inflate_or_are_noise() {
    let bomb = zlib(&vec![0; 64 << 20]);
    let noise: Vec<u8> = (0..4000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    for compression in 1..=5 {
        for data in [&bomb, &noise] {
            let file = with(|file| {
                file.compression = compression;
                file.data = [0, 0, 3, 3];
                file.display = file.data;
                let block = [&0u32.to_le_bytes()[..], &(data.len() as u32).to_le_bytes(), data].concat();
                // Of as many tables as the scheme has blocks, two stand in the file already.
                file.body = if compression <= 2 { [vec![0; 16], block].concat() } else { block };
            });
            refused(&file, 2, "");
        }
    }
}

#[test]
fn e10_tiles_that_cannot_be() {
    refused(&tiled(64, [0, 0], 0), 2, "tiles: 0 x 0");
    refused(&tiled(64, [1 << 31, 1 << 31], 0), 2, "tiles: 2147483648");
    refused(&tiled(64, [16, 16], 3), 2, "level mode 3");
    refused(&tiled(64, [16, 16], 0x20), 2, "rounding 2");
    refused(&with(|file| file.version |= 0x200), 2, "no tiles");
}

#[test]
fn e11_e12_channels_that_cannot_be() {
    for sampling in [0, 2, -1, i32::MIN] {
        refused(&with(|file| file.channels[0].2 = sampling), 2, "subsampled by");
    }
    refused(&with(|file| file.channels.reverse()), 2, "out of order");
    refused(&with(|file| file.channels.push(("R", 1, 1))), 2, "\"R\" out of order");
    refused(&with(|file| file.channels[1].1 = 7), 2, "channels[1]: pixel type 7");
    let names: Vec<String> = (0..10_000).map(|i| format!("c{i:05}")).collect();
    let many = with(|file| {
        let leak = |name: &String| &*Box::leak(name.clone().into_boxed_str());
        file.channels = names.iter().map(|name| (leak(name), 1, 1)).collect();
    });
    refused(&many, 2, "at most 64");
}

#[test]
fn e13_attributes_of_any_length() {
    let head = ExrFile::default().header();
    for length in [i32::MAX, i32::MIN, -1, 1 << 20] {
        let mut file = head[..head.len() - 1].to_vec();
        file.extend(b"comment\0string\0");
        file.extend(length.to_le_bytes());
        refused(&file, 2, &format!("\"comment\" of {length} bytes"));
    }
    let twice = with(|file| file.more = exr_attribute("compression", "compression", &[0]));
    refused(&twice, 2, "compression: occurs twice");
    refused(&with(|file| file.more = exr_attribute("tiles", "string", b"x")), 2, "the type \"string\"");
    refused(
        &with(|file| file.more = exr_attribute("chunkCount", "int", &9i32.to_le_bytes())),
        2,
        "chunkCount: 9",
    );
    let long = "n".repeat(300);
    refused(&with(|file| file.more = exr_attribute(&long, "int", &[0; 4])), 2, "1 to 255 bytes");
    let many = with(|file| {
        file.more = (0..1100).flat_map(|i| exr_attribute(&format!("a{i}"), "int", &[0; 4])).collect();
    });
    refused(&many, 2, "at most 1024");
    let preview = [[0xff; 4], [0xff; 4]].concat();
    let file = with(|file| file.more = exr_attribute("preview", "preview", &preview));
    if let Err(error) = read(&file) {
        assert_eq!(error.exit_code(), 2, "{error}");
    }
}

#[test]
fn e14_an_aspect_that_is_no_number_is_1() {
    for aspect in [f32::NAN, f32::INFINITY, 0.0, -1.0] {
        let picture = read(&with(|file| file.aspect = aspect)).unwrap();
        assert!(picture.warnings[0].to_string().contains("pixelAspectRatio: "), "{:?}", picture.warnings);
        assert!(picture.strict().is_ok());
    }
}

#[test]
fn e15_pixels_that_are_not_finite_are_black() {
    let file = with(|file| {
        // Infinity in blue of the first pixel, NaN in red of the last.
        file.body[8..10].copy_from_slice(&0x7c00u16.to_le_bytes());
        file.body[38..40].copy_from_slice(&0x7e01u16.to_le_bytes());
    });
    let picture = read(&file).unwrap();
    let black = [0.0, 0.0, 0.0, 1.0];
    assert_eq!(picture.pixels, Pixels::RgbaF32(vec![black, [0.0, 0.5, 0.0, 1.0], black, black]));
    assert_eq!(picture.warnings[0].to_string(), "pixels: 2 pixels that are not finite, taken as 0");
    let error = picture.strict().unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().starts_with("a.exr: pixels: 2 pixels"), "{error}");
}

#[test]
fn e16_deep_data_and_parts_are_named() {
    refused(&with(|file| file.version |= 0x800), 2, "version: deep data");
    refused(&with(|file| file.version |= 0x1000), 2, "version: several parts");
    refused(&with(|file| file.version |= 0x1800), 2, "version: deep data");
    refused(&with(|file| file.version |= 1 << 20), 2, "unknown flags 0x100000");
    refused(&with(|file| file.version = 3), 2, "version 3");
    refused(
        &with(|file| file.more = exr_attribute("type", "string", b"deepscanline")),
        2,
        "\"deepscanline\"",
    );
    let whole = ExrFile::default().bytes();
    for end in 0..whole.len() {
        assert_eq!(read(&whole[..end]).unwrap_err().exit_code(), 2, "cut at {end}");
    }
}
