//! Pixels in linear light, and letters of 5 x 7 dots.

use downpour_math::color::linear_to_srgb;
use downpour_math::ops;

/// Columns of a letter with the gap behind it.
const ADVANCE: usize = 6;

/// Rows from the top, the leftmost dot in bit 4.
const LETTERS: &[(char, [u8; 7])] = &[
    ('0', [0b01110, 0b10001, 0b10011, 0b10101, 0b11001, 0b10001, 0b01110]),
    ('1', [0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110]),
    ('2', [0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111]),
    ('3', [0b11110, 0b00001, 0b00001, 0b01110, 0b00001, 0b00001, 0b11110]),
    ('4', [0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010]),
    ('5', [0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110]),
    ('6', [0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110]),
    ('7', [0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000]),
    ('8', [0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110]),
    ('9', [0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100]),
    ('.', [0, 0, 0, 0, 0, 0b01100, 0b01100]),
    ('-', [0, 0, 0, 0b11111, 0, 0, 0]),
    ('=', [0, 0, 0b11111, 0, 0b11111, 0, 0]),
    ('/', [0b00001, 0b00010, 0b00010, 0b00100, 0b01000, 0b01000, 0b10000]),
    ('e', [0, 0, 0b01110, 0b10001, 0b11111, 0b10000, 0b01110]),
    ('m', [0, 0, 0b11010, 0b10101, 0b10101, 0b10101, 0b10101]),
    ('s', [0, 0, 0b01111, 0b10000, 0b01110, 0b00001, 0b11110]),
    ('x', [0, 0, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001]),
    ('y', [0, 0, 0b10001, 0b10001, 0b01111, 0b00001, 0b01110]),
    ('z', [0, 0, 0b11111, 0b00010, 0b00100, 0b01000, 0b11111]),
];

/// A picture that is being drawn.
pub(super) struct Canvas {
    columns: usize,
    light: Vec<[f32; 3]>,
}

impl Canvas {
    pub(super) fn new([columns, rows]: [u32; 2]) -> Self {
        Self { columns: columns as usize, light: vec![[0.01; 3]; columns as usize * rows as usize] }
    }

    fn pixel(&mut self, column: usize, row: usize) -> Option<&mut [f32; 3]> {
        if column < self.columns { self.light.get_mut(row * self.columns + column) } else { None }
    }

    /// Sets the color of a pixel. Positions outside the picture are ignored.
    pub(super) fn set(&mut self, column: usize, row: usize, color: [f32; 3]) {
        if let Some(pixel) = self.pixel(column, row) {
            *pixel = color;
        }
    }

    pub(super) fn blend(&mut self, column: usize, row: usize, color: [f32; 3], fraction: f32) {
        if let Some(pixel) = self.pixel(column, row) {
            for (old, new) in pixel.iter_mut().zip(color) {
                *old += (new - *old) * fraction;
            }
        }
    }

    /// Writes text; what has no letter is left blank.
    pub(super) fn text(&mut self, left: usize, top: usize, dot: usize, text: &str) {
        for (index, c) in text.chars().enumerate() {
            let Some((_, rows)) = LETTERS.iter().find(|(letter, _)| *letter == c) else { continue };
            for (y, bits) in rows.iter().enumerate() {
                for x in (0..5).filter(|x| bits & (16 >> x) != 0) {
                    let (column, row) = (left + (index * ADVANCE + x) * dot, top + y * dot);
                    for inner in 0..dot * dot {
                        self.set(column + inner % dot, row + inner / dot, [0.85; 3]);
                    }
                }
            }
        }
    }

    /// As sRGB.
    pub(super) fn pixels(&self) -> Vec<[u8; 3]> {
        self.light.iter().map(|color| color.map(encoded)).collect()
    }
}

/// IEC 61966-2-1.
fn encoded(light: f32) -> u8 {
    let light = light.clamp(0.0, 1.0);
    (linear_to_srgb(light) * 255.0 + 0.5) as u8
}

/// Columns of a text, in dots.
pub(super) fn width(text: &str) -> usize {
    text.chars().count() * ADVANCE
}

/// A number with three digits or so.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(0.01..1.0e5).contains(&size) {
        return format!("{value:.1e}");
    }
    let decimals = if size >= 100.0 {
        0
    } else if size >= 10.0 {
        1
    } else {
        2
    };
    let text = format!("{value:.decimals$}");
    if !text.contains('.') {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a number.
pub(super) fn round_down(value: f64) -> f64 {
    let power = ops::f64::pow(10.0, ops::f64::log10(value).floor());
    [5.0, 2.0].into_iter().map(|n| n * power).find(|n| *n <= value).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (5.0, "5"),
            (0.25, "0.25"),
            (12.34, "12.3"),
            (-3.456, "-3.46"),
            (250.4, "250"),
            (100.0, "100"),
            (1.0e6, "1.0e6"),
            (1.0e-6, "1.0e-6"),
        ] {
            assert_eq!(number(value), text);
            assert!(text.chars().all(|c| LETTERS.iter().any(|(letter, _)| *letter == c)), "{text}");
        }
        for (value, down) in [(25.0, 20.0), (99.0, 50.0), (1.5, 1.0), (0.07, 0.05), (5.0, 5.0)] {
            assert!((round_down(value) / down - 1.0).abs() < 1.0e-9, "{value}");
        }
    }
}
