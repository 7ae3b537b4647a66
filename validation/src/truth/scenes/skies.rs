//! Skies as Radiance HDR files: a low sun in a clear sky, an overcast one, an even one, and night.

use crate::truth::sky::rgbe;
use downpour_math::ops::f64 as ops;

/// Name of the sky of wet scenes.
pub(super) const EVEN: &str = "dim-even";

const SIZE: [u32; 2] = [1024, 512];
/// Elevation and azimuth of the low sun, degrees, and of the higher one.
const LOW: [f64; 2] = [9.0, 60.0];
const HIGH: [f64; 2] = [42.0, 200.0];
/// Radius of the sun's disk, degrees: a few pixels.
const DISK: f64 = 0.7;

/// Names, files and factors.
pub(super) fn all() -> [(&'static str, Vec<u8>, f64); 5] {
    [
        ("low-sun", map(|d| clear(d, LOW, 900.0, [1.0, 0.62, 0.3])), 1.0),
        ("clear", map(|d| clear(d, HIGH, 6000.0, [1.0, 0.95, 0.85])), 1.0),
        ("overcast", map(overcast), 1.0),
        // Gray: see the signs of the models.
        (EVEN, map(|_| [0.05; 3]), 1.0),
        ("night", map(|d| clear(d, LOW, 0.0, [1.0; 3]).map(|c| 0.02 * c)), 1.0),
    ]
}

fn map(radiance: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<u8> {
    let [width, height] = SIZE;
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for row in 0..height {
        let elevation = (0.5 - (f64::from(row) + 0.5) / f64::from(height)) * std::f64::consts::PI;
        for column in 0..width {
            let azimuth = ((f64::from(column) + 0.5) / f64::from(width) - 0.5) * std::f64::consts::TAU;
            let flat = ops::cos(elevation);
            let direction = [flat * ops::cos(azimuth), ops::sin(elevation), flat * ops::sin(azimuth)];
            bytes.extend(rgbe(radiance(direction).map(|c| c as f32)));
        }
    }
    bytes
}

/// Blue above, brighter at the horizon, bright around the sun; dark ground below.
fn clear([x, y, z]: [f64; 3], [elevation, azimuth]: [f64; 2], disk: f64, tint: [f64; 3]) -> [f64; 3] {
    let (elevation, azimuth) = (elevation.to_radians(), azimuth.to_radians());
    let flat = ops::cos(elevation);
    let sun = [flat * ops::cos(azimuth), ops::sin(elevation), flat * ops::sin(azimuth)];
    let cosine = (x * sun[0] + y * sun[1] + z * sun[2]).clamp(-1.0, 1.0);
    let angle = ops::acos(cosine).to_degrees();
    if y < 0.0 {
        return [0.12, 0.11, 0.1];
    }
    let horizon = ops::exp(-6.0 * y);
    let glow = 9.0 * ops::exp(-angle / 7.0) + 0.8 * ops::exp(-angle / 40.0);
    let inside = if angle < DISK { disk } else { 0.0 };
    let blue = [0.22, 0.38, 0.75];
    std::array::from_fn(|k| blue[k] + horizon * 0.5 * (0.4 + tint[k]) + (glow + inside) * tint[k])
}

/// Moon & Spencer 1942 above ground that reflects a fifth.
fn overcast([_, y, _]: [f64; 3]) -> [f64; 3] {
    let light = if y < 0.0 { 0.2 * 7.0 / 9.0 } else { (1.0 + 2.0 * y) / 3.0 };
    [0.95 * light, 0.98 * light, 1.05 * light]
}
