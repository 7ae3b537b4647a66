//! Two numbers in a word, as WGSL's `pack2x16float` and `unpack2x16float` have them.

use half::f16;

/// Unpacks both 16-bit floats of a word.
#[must_use]
pub fn unpack(word: u32) -> [f32; 2] {
    [f16::from_bits(word as u16).to_f32(), f16::from_bits((word >> 16) as u16).to_f32()]
}

/// Packs two numbers as 16-bit floats, rounded to the nearest.
#[must_use]
pub fn pack(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|x| u32::from(f16::from_f32(x).to_bits()));
    low | high << 16
}
