//! Frames as a video: AV1 by rav1e, in 8 bits with half the color resolution, as all players support it.
//!
//! The pixels of a frame are sRGB, as those of a PNG. They become luma and color difference by the matrix of BT.709 in the
//! limited range (16 to 235); stream and file declare it: primaries 1, transfer function 13 (sRGB), matrix 1 of
//! ITU-T H.273. A color sample is level with every other luma sample and between two rows.
//!
//! The bytes depend on the pixels alone, not on the number of threads.

use rav1e::prelude::{
    ChromaSamplePosition, ChromaSampling, ColorDescription, ColorPrimaries, Config, Context, EncoderConfig,
    EncoderStatus, FrameType, MatrixCoefficients, PixelRange, Rational, SceneDetectionSpeed,
    TransferCharacteristics,
};

use super::mp4::{self, Sample, Track};
use crate::failure::{Failure, INPUT, OTHER};

/// Quantizer, 0 to 255; chosen by eye so that drops keep their edges.
const QUANTIZER: usize = 64;

/// Speed preset of the encoder, 0 to 10: rain is noise to it, and more search finds little.
const SPEED: u8 = 10;

/// Seconds between two key frames.
const KEY_SECONDS: f64 = 2.0;

/// A picture of more pixels is coded in tiles, at the same time. Their number may not depend on the machine.
const PIXELS_OF_TILES: usize = 640 * 360;
const TILES: usize = 4;

/// Type of an OBU that only separates pictures.
const TEMPORAL_DELIMITER: u8 = 2;

/// Frames per second are integer multiples of 1 / this.
const RATE_PARTS: f64 = 1000.0;

/// Checks that a video can have this size.
///
/// # Errors
/// Exit code 2 for an odd edge, or one below 16 pixels.
pub(super) fn check_size([width, height]: [u32; 2]) -> Result<(), Failure> {
    if [width, height].iter().all(|edge| *edge >= 16 && edge % 2 == 0) {
        return Ok(());
    }
    let allowed = "even numbers from 16 (one color sample stands for 2 x 2 pixels)";
    Err(Failure::new(INPUT, format!("{width} x {height} pixels for .mp4; allowed: {allowed}")))
}

/// Encodes a video. `frame` returns the pixels of each picture, rows from the top; one at a time.
///
/// # Errors
/// Errors of `frame`, or exit code 1 if the encoder fails.
pub(super) fn encode(
    size: [u32; 2],
    fps: f64,
    count: u32,
    mut frame: impl FnMut(u32) -> Result<Vec<[u8; 4]>, Failure>,
) -> Result<Vec<u8>, Failure> {
    let (timescale, step) = ((fps * RATE_PARTS).round() as u32, RATE_PARTS as u32);
    let [width, height] = size.map(|edge| edge as usize);
    let mut options = EncoderConfig::with_speed_preset(SPEED);
    options.width = width;
    options.height = height;
    options.time_base = Rational::new(step.into(), timescale.into());
    options.chroma_sampling = ChromaSampling::Cs420;
    options.chroma_sample_position = ChromaSamplePosition::Vertical;
    options.pixel_range = PixelRange::Limited;
    options.color_description = Some(ColorDescription {
        color_primaries: ColorPrimaries::BT709,
        transfer_characteristics: TransferCharacteristics::SRGB,
        matrix_coefficients: MatrixCoefficients::BT709,
    });
    // Pictures are returned in display order.
    options.low_latency = true;
    options.quantizer = QUANTIZER;
    options.tiles = if width * height > PIXELS_OF_TILES { TILES } else { 1 };
    let interval = (fps * KEY_SECONDS).round().clamp(1.0, 240.0) as u64;
    options.set_key_frame_interval(interval, interval);
    options.speed_settings.scene_detection_mode = SceneDetectionSpeed::None;
    let mut context: Context<u8> =
        Config::new().with_encoder_config(options).new_context().map_err(|error| failed(&error))?;
    let mut samples = Vec::new();
    for number in 0..count {
        let planes = planes(size, &frame(number)?);
        let mut picture = context.new_frame();
        let strides = [width, width / 2, width / 2];
        for ((plane, bytes), stride) in picture.planes.iter_mut().zip(&planes).zip(strides) {
            plane.copy_from_raw_u8(bytes, stride, 1);
        }
        context.send_frame(picture).map_err(|error| failed(&error))?;
        receive(&mut context, &mut samples)?;
    }
    context.flush();
    receive(&mut context, &mut samples)?;
    if samples.len() != count as usize {
        return Err(failed(&format!("{} of {count} pictures came out", samples.len())));
    }
    let mut configuration = context.container_sequence_header();
    // The encoder leaves the position of the color samples undefined there: level with luma samples, between rows.
    if let Some(byte) = configuration.get_mut(2) {
        *byte = (*byte & !3) | ChromaSamplePosition::Vertical as u8;
    }
    let edge = |edge: u32| u16::try_from(edge).unwrap_or(u16::MAX);
    let track = Track {
        size: size.map(edge),
        timescale,
        step,
        configuration: &configuration,
        color: ([1, 13, 1], false),
    };
    Ok(mp4::write(&track, &samples))
}

/// Takes all pictures that the encoder has ready.
fn receive(context: &mut Context<u8>, samples: &mut Vec<Sample>) -> Result<(), Failure> {
    loop {
        match context.receive_packet() {
            Ok(packet) => samples.push(Sample {
                data: without_delimiters(&packet.data)
                    .ok_or_else(|| failed(&"a stream that cannot be read"))?,
                key: packet.frame_type == FrameType::KEY,
            }),
            Err(EncoderStatus::Encoded) => {}
            Err(EncoderStatus::NeedMoreData | EncoderStatus::LimitReached) => return Ok(()),
            Err(error) => return Err(failed(&error)),
        }
    }
}

/// The OBUs of a picture without temporal delimiters, which a file may not have.
fn without_delimiters(mut data: &[u8]) -> Option<Vec<u8>> {
    let mut kept = Vec::new();
    while let Some(&header) = data.first() {
        let extended = usize::from(header >> 2 & 1);
        // Without a size an OBU extends to the end.
        let (size, at) = if header >> 1 & 1 == 1 { leb128(data, 1 + extended)? } else { (data.len() - 1, 1) };
        let (obu, rest) = data.split_at_checked(at.checked_add(size)?)?;
        if header >> 3 & 15 != TEMPORAL_DELIMITER {
            kept.extend(obu);
        }
        data = rest;
    }
    Some(kept)
}

/// A number of seven bits per byte, the lowest first, and its end.
fn leb128(data: &[u8], mut at: usize) -> Option<(usize, usize)> {
    let mut value = 0;
    for index in 0..8 {
        let byte = *data.get(at)?;
        at += 1;
        value |= usize::from(byte & 0x7f).checked_shl(7 * index)?;
        if byte & 0x80 == 0 {
            return Some((value, at));
        }
    }
    None
}

/// The parts of luma in red, green and blue (BT.709), in 1/65536 of the range of 219 steps.
const LUMA: [i32; 3] = [11966, 40254, 4064];

/// Luma and the two color differences, each as rows.
fn planes([width, height]: [u32; 2], pixels: &[[u8; 4]]) -> [Vec<u8>; 3] {
    let (width, rows) = (width as usize, height as usize / 2);
    let luma = pixels.iter().map(|&[r, g, b, _]| {
        let sum = LUMA[0] * i32::from(r) + LUMA[1] * i32::from(g) + LUMA[2] * i32::from(b);
        byte(16 + ((sum + 0x8000) >> 16))
    });
    let mut planes = [luma.collect(), Vec::new(), Vec::new()];
    for row in 0..rows {
        for column in (0..width).step_by(2) {
            // Weights 1, 2, 1 along two rows.
            let mut sum = [0i32; 3];
            for (step, weight) in [(0usize, 1i32), (1, 2), (2, 1)] {
                let x = (column + step).saturating_sub(1).min(width - 1);
                for y in [2 * row, 2 * row + 1] {
                    let pixel = pixels.get(y * width + x).copied().unwrap_or_default();
                    for (sum, part) in sum.iter_mut().zip(pixel) {
                        *sum += weight * i32::from(part);
                    }
                }
            }
            let [r, g, b] = sum.map(|part| part as f32 / 8.0);
            let gray = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            let part = |difference: f32, most: f32| {
                (128.0 + difference / most * (224.0 / 255.0 * 0.5)).round().clamp(16.0, 240.0) as u8
            };
            planes[1].push(part(b - gray, 0.9278));
            planes[2].push(part(r - gray, 0.7874));
        }
    }
    planes
}

fn byte(value: i32) -> u8 {
    u8::try_from(value).unwrap_or(if value < 0 { 0 } else { u8::MAX })
}

fn failed(error: &dyn std::fmt::Display) -> Failure {
    Failure::new(OTHER, format!("the video encoder: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The colors of the standard: 75 % bars in 8 bits of limited range, as ITU-R BT.709 tabulates them.
    #[test]
    fn colors_are_those_of_the_standard() {
        for (pixel, [y, cb, cr]) in [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([191, 191, 191], [180, 128, 128]),
            ([191, 191, 0], [168, 44, 136]),
            ([0, 191, 191], [145, 147, 44]),
            ([0, 191, 0], [133, 63, 52]),
            ([191, 0, 191], [63, 193, 204]),
            ([191, 0, 0], [51, 109, 212]),
            ([0, 0, 191], [28, 212, 120]),
        ] {
            let [r, g, b] = pixel;
            let planes = planes([2, 2], &[[r, g, b, 255]; 4]);
            assert_eq!(planes, [vec![y; 4], vec![cb], vec![cr]], "{pixel:?}");
        }
    }

    #[test]
    fn delimiters_are_taken_out() {
        assert_eq!(without_delimiters(&[0x12, 0, 0x0a, 2, 7, 8]), Some(vec![0x0a, 2, 7, 8]));
        assert_eq!(without_delimiters(&[0x30, 1, 2]), Some(vec![0x30, 1, 2]));
        assert_eq!(without_delimiters(&[0x0a, 9, 1]), None);
        assert_eq!(without_delimiters(&[0x0a, 0x80]), None);
        assert_eq!(leb128(&[0x80, 0x01], 0), Some((128, 2)));
    }

    #[test]
    fn sizes_are_even() {
        assert!(check_size([16, 16]).is_ok() && check_size([320, 180]).is_ok());
        for size in [[33, 24], [32, 25], [14, 32], [32, 1]] {
            assert_eq!(check_size(size).map_err(|failure| failure.code), Err(INPUT), "{size:?}");
        }
    }
}
