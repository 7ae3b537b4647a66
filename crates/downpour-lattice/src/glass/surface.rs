//! Surface of the glass: affinity, friction and obstacles of each cell, packed into a word.

use downpour_math::in_range;
use downpour_math::rng::{rng_draw, rng_unit, seed_words};
use downpour_shaders::lattice::glass::GLASS_OBSTACLE;

use super::error::GlassError;
use super::options::{GlassOptions, GlassTexture};

/// Smooth noise in -1 to 1: three octaves of values at the corners of squares.
fn noise(seed: [u32; 2], texture: u32, x: f64, y: f64) -> f64 {
    let corner = |octave: u32, i: f64, j: f64| {
        let [word, ..] = rng_draw(seed, i as u32, j as u32, 0x0067_6c61 + 8 * texture + octave);
        2.0 * f64::from(rng_unit(word)) - 1.0
    };
    let ease = |t: f64| t * t * (3.0 - 2.0 * t);
    let mut sum = 0.0;
    for (octave, weight) in [(0, 0.5), (1, 0.3), (2, 0.2)] {
        let scale = f64::from(1u32 << octave);
        let (u, v) = (x * scale, y * scale);
        let (i, j) = (u.floor(), v.floor());
        let (s, t) = (ease(u - i), ease(v - j));
        let low = corner(octave, i, j) * (1.0 - s) + corner(octave, i + 1.0, j) * s;
        let high = corner(octave, i, j + 1.0) * (1.0 - s) + corner(octave, i + 1.0, j + 1.0) * s;
        // Sums of values cluster around 0; the factor restores most of the range.
        sum += 1.6 * weight * (low * (1.0 - t) + high * t);
    }
    sum.clamp(-1.0, 1.0)
}

/// A byte per cell: `middle` + `spread` * noise, or `unit` * given value.
struct Bytes {
    quantity: &'static str,
    number: u32,
    middle: f64,
    spread: f64,
    unit: f64,
    largest: f32,
    allowed: &'static str,
}

impl Bytes {
    fn of(&self, options: &GlassOptions, texture: &GlassTexture) -> Result<Vec<u8>, GlassError> {
        let (quantity, seed) = (self.quantity, seed_words(options.seed));
        match texture {
            GlassTexture::Even => Ok(vec![self.middle as u8; options.cells()]),
            GlassTexture::Noise { spot_m, amplitude } => {
                in_range("width of spots", *spot_m, "mm", &(1.0e-4..=1.0), 1.0e3, "0.1 to 1000")?;
                in_range("amplitude of noise", *amplitude, "", &(0.0..=1.0), 1.0, "0 to 1")?;
                let scale = options.cell_m / spot_m;
                let [width, height] = options.size;
                let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
                Ok(cells
                    .map(|(x, y)| {
                        let n = noise(seed, self.number, f64::from(x) * scale, f64::from(y) * scale);
                        (self.middle + self.spread * amplitude * n).round().clamp(0.0, 255.0) as u8
                    })
                    .collect())
            }
            GlassTexture::Given(values) => {
                if values.len() != options.cells() {
                    return Err(GlassError::CellCount {
                        quantity,
                        found: values.len(),
                        allowed: options.cells(),
                    });
                }
                let byte = |(index, &value): (usize, &f32)| {
                    if (0.0..=self.largest).contains(&value) {
                        Ok((self.unit * f64::from(value)).round().clamp(0.0, 255.0) as u8)
                    } else {
                        let (found, allowed) = (value.into(), self.allowed);
                        Err(GlassError::CellValue { quantity, index, found, allowed })
                    }
                };
                values.iter().enumerate().map(byte).collect()
            }
        }
    }
}

/// Packed surface words of all cells.
pub(crate) fn surface(options: &GlassOptions) -> Result<Vec<u32>, GlassError> {
    let affinity = Bytes {
        quantity: "affinity",
        number: 0,
        middle: 128.0,
        spread: 127.0,
        unit: 255.0,
        largest: 1.0,
        allowed: "0 to 1",
    };
    let friction = Bytes {
        quantity: "friction",
        number: 1,
        middle: 128.0,
        spread: 127.0,
        unit: 128.0,
        largest: 1.99,
        allowed: "0 to 1.99",
    };
    let affinity = affinity.of(options, &options.affinity)?;
    let friction = friction.of(options, &options.friction)?;
    let mut words: Vec<u32> =
        affinity.iter().zip(&friction).map(|(&a, &f)| u32::from(a) | (u32::from(f) << 8)).collect();
    if let Some(obstacles) = &options.obstacles {
        if obstacles.len() != words.len() {
            let (found, allowed) = (obstacles.len(), words.len());
            return Err(GlassError::CellCount { quantity: "mask of obstacles", found, allowed });
        }
        for (word, _) in words.iter_mut().zip(obstacles).filter(|&(_, &blocked)| blocked) {
            *word |= GLASS_OBSTACLE;
        }
    }
    Ok(words)
}
