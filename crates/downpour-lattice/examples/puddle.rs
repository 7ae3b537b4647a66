//! A puddle in the rain, without a renderer and without a GPU: heights, normals, and the reflected sky.
//!
//! ```sh
//! cargo run --release -p downpour-lattice --example puddle -- 25 OUTPUT_FOLDER
//! ```
//! writes `puddle_height.png`, `puddle_normal.png` and `puddle_sky.png`: 1 m x 1 m of 5 mm deep water after 2 s in rain
//! of 25 mm/h.

use std::error::Error;
use std::path::PathBuf;

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_lattice::puddle::{Puddle, PuddleBorder, PuddleOptions, PuddleRain};
use image::{GrayImage, Luma, Rgb, RgbImage};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let rate_mm_h: f64 = arguments.next().map_or(Ok(25.0), |text| text.parse())?;
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));
    std::fs::create_dir_all(&folder)?;

    let size = [768, 768];
    let cell_m = 1.0 / 768.0;
    let options = PuddleOptions { size, cell_m, border: PuddleBorder::Open, ..PuddleOptions::default() };
    let mut puddle = Puddle::new(&options)?;
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h)?;
    let rain = PuddleRain::new(&rain, 1);
    let dt_s = 1.0 / 60.0;
    let (mut drops, mut parts) = (0, 0);
    for step in 0..120 {
        let impacts = rain.impacts(puddle.extent_m(), step, dt_s)?;
        drops += impacts.len();
        puddle.seed(&impacts)?;
        parts = puddle.step(dt_s)?;
    }

    let heights = puddle.heights();
    let rms = (heights.iter().map(|&h| f64::from(h * h)).sum::<f64>() / heights.len() as f64).sqrt();
    let gray = |h: f32| (127.5 + 40.0 * f64::from(h) / rms.max(1.0e-9)).clamp(0.0, 255.0) as u8;
    GrayImage::from_fn(size[0], size[1], |x, y| Luma([gray(heights[(y * size[0] + x) as usize])]))
        .save(folder.join("puddle_height.png"))?;

    let normals = puddle.normals();
    let normal = |x: u32, y: u32| normals[(y * size[0] + x) as usize];
    RgbImage::from_fn(size[0], size[1], |x, y| {
        // The usual colors of a normal map, with the slopes multiplied by four.
        let [nx, ny, nz] = normal(x, y);
        let length = (16.0 * (nx * nx + nz * nz) + ny * ny).sqrt();
        Rgb([4.0 * nx, -4.0 * nz, ny].map(|c| (127.5 + 127.5 * c / length) as u8))
    })
    .save(folder.join("puddle_normal.png"))?;

    // Seen from 35 degrees above the ground toward -z, under a sky that is dark above and bright at the horizon.
    let seen = |x, y| {
        let [nx, ny, nz] = normal(x, y);
        let view = [0.0f32, 0.5736, 0.8192];
        let along = nx * view[0] + ny * view[1] + nz * view[2];
        let up = 2.0 * along * ny - view[1];
        let fresnel = 0.0204 + 0.9796 * (1.0 - along).clamp(0.0, 1.0).powi_5();
        let sky = 0.15 + 0.85 * (1.0 - up.clamp(0.0, 1.0)).powi_5();
        (fresnel * sky * 5.0).sqrt().min(1.0)
    };
    GrayImage::from_fn(size[0], size[1], |x, y| Luma([(255.0 * seen(x, y)) as u8]))
        .save(folder.join("puddle_sky.png"))?;

    println!(
        "{drops} drops in 2 s, {parts} steps of {} passes per 1/60 s; ripples of {:.3} mm rms; pictures in {}",
        puddle.degree(),
        1.0e3 * rms,
        folder.display()
    );
    Ok(())
}

/// Fifth power as products.
trait Fifth {
    fn powi_5(self) -> Self;
}

impl Fifth for f32 {
    fn powi_5(self) -> Self {
        self * self * self * self * self
    }
}
