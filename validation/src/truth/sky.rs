//! A sky map that shows every error of direction: a checkerboard whose colors encode positions.

/// Texels of the map.
const SIZE: [u32; 2] = [512, 256];
/// Number of checks around the horizon, and from top to bottom: 15 degrees each.
const CHECKS: [u32; 2] = [24, 12];
/// Colors of the four quarters around the horizon.
const QUARTERS: [[f32; 3]; 4] = [[1.0, 0.35, 0.25], [0.3, 0.9, 0.3], [0.3, 0.45, 1.0], [0.95, 0.85, 0.3]];
/// Brightness of the top and the bottom.
const TOP: f32 = 2.0;
const BOTTOM: f32 = 0.2;
/// Brightness of the dark checkerboard against the light ones.
const DARK: f32 = 0.3;

/// The sky behind lamps.
const DUSK: [f32; 3] = [0.125, 0.125, 0.1875];

/// The map as a Radiance HDR file. All quarters, and all heights, look different.
pub(super) fn checkerboard() -> Vec<u8> {
    let [width, height] = SIZE;
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for row in 0..height {
        let down = (row as f32 + 0.5) / height as f32;
        for column in 0..width {
            let quarter = QUARTERS[(column * 4 / width) as usize % QUARTERS.len()];
            let field = column * CHECKS[0] / width + row * CHECKS[1] / height;
            let light = (TOP + (BOTTOM - TOP) * down) * if field.is_multiple_of(2) { 1.0 } else { DARK };
            bytes.extend(rgbe(quarter.map(|c| c * light)));
        }
    }
    bytes
}

/// An even, dim sky as a Radiance HDR file.
pub(super) fn dusk() -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
    for _ in 0..8 {
        bytes.extend(rgbe(DUSK));
    }
    bytes
}

/// A color with a common exponent: c = byte / 256 * 2^(exponent - 128) (Ward, "Radiance File Formats").
pub(super) fn rgbe(color: [f32; 3]) -> [u8; 4] {
    let most = color.into_iter().fold(f32::MIN_POSITIVE, f32::max);
    // 2^exponent is the least power of two above `most`.
    let exponent = (most.to_bits() >> 23) as i32 - 126;
    let scale = f32::from_bits(((127 + 8 - exponent).clamp(1, 254) as u32) << 23);
    let [r, g, b] = color.map(|c| (c * scale) as u8);
    [r, g, b, (exponent + 128).clamp(0, 255) as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_color_comes_back() {
        for color in [[1.0, 0.5, 0.25], [1.999, 0.0, 0.1], [0.06, 0.07, 0.003], [11.8, 300.0, 2.0]] {
            let [r, g, b, e] = rgbe(color);
            let unit = f32::from_bits((u32::from(e) - 9) << 23);
            for (byte, value) in [r, g, b].into_iter().zip(color) {
                let back = f32::from(byte) * unit;
                assert!((0.0..unit).contains(&(value - back)), "{color:?}: {back}");
            }
            assert!(r.max(g).max(b) >= 128, "{color:?} wastes digits");
        }
    }

    #[test]
    fn dusk_is_even() {
        let bytes = dusk();
        assert!(bytes[bytes.len() - 32..].chunks(4).all(|texel| texel == rgbe(DUSK)));
    }

    #[test]
    fn the_file_is_whole() {
        let bytes = checkerboard();
        let texels = (SIZE[0] * SIZE[1] * 4) as usize;
        assert!(bytes[..bytes.len() - texels].ends_with(b"\n\n-Y 256 +X 512\n"));
        // Two bytes of 2 at the start of a row would mark it as compressed.
        let rows = bytes[bytes.len() - texels..].chunks(SIZE[0] as usize * 4);
        assert!(rows.into_iter().all(|row| row[..2] != [2, 2]));
    }
}
