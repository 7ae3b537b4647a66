//! Sixty seconds of heavy rain on a window and on the windshield of a car, as pictures.
//!
//! `cargo run --release -p downpour-lattice --example glass -- [FOLDER] [PHOTO.png] [SECONDS]`
//!
//! At 1, 10, 30 and 60 s it writes the pane as it refracts the photo (a synthetic street by night by default), the
//! heights and the normals, and prints the water balance. No renderer, no GPU.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use downpour_lattice::glass::{
    Glass, GlassAir, GlassOptions, GlassRain, GlassWiper, GlassWiperMotion, GlassWornBand,
};
use downpour_math::rng::{rng_draw, rng_unit};
use image::{Rgb, RgbImage, imageops};

const SIZE: [u32; 2] = [1024, 683];
const CELL_M: f64 = 0.6e-3;

/// A window in a wind that drives rain at it with 3 m/s.
fn window() -> GlassOptions {
    let rain = GlassRain { rate_mm_h: 25.0, towards_m_s: 3.0, ..GlassRain::default() };
    GlassOptions { size: SIZE, cell_m: CELL_M, rain, seed: 1, ..GlassOptions::default() }
}

/// A windshield at 15 m/s with one wiper, whose blade has one worn band.
fn windshield() -> GlassOptions {
    let [width, height] = SIZE.map(|n| f64::from(n) * CELL_M);
    let wiper = GlassWiper {
        pivot_m: [0.5 * width, height + 0.02],
        inner_m: 0.08,
        outer_m: 0.39,
        motion: GlassWiperMotion::Sweep {
            from_rad: 8f64.to_radians(),
            to_rad: 172f64.to_radians(),
            period_s: 3.1,
        },
        film_m: 0.5e-6,
        worn: vec![GlassWornBand { from_m: 0.24, to_m: 0.25, leaves: 0.6 }],
    };
    GlassOptions {
        tilt_rad: 30f64.to_radians(),
        rain: GlassRain { rate_mm_h: 25.0, towards_m_s: 15.0, ..GlassRain::default() },
        air: GlassAir { speed_m_s: 15.0, ..GlassAir::default() },
        wipers: vec![wiper],
        speed_limit_m_s: 0.4,
        ..window()
    }
}

/// Lamps over a dark street.
fn made_up() -> RgbImage {
    let [width, height] = SIZE;
    let mut street = RgbImage::from_fn(width, height, |_, y| {
        let t = y as f32 / height as f32;
        Rgb([30.0 + 40.0 * t, 36.0 + 34.0 * t, 55.0 + 20.0 * t].map(|c| c as u8))
    });
    for lamp in 0..60 {
        let [x, y, r, c] = rng_draw([7, 0], lamp, 0, 0).map(rng_unit);
        let (x, y, r) = (x * width as f32, (0.2 + 0.6 * y) * height as f32, 3.0 + 9.0 * r);
        let color = if c < 0.6 { [255, 205, 130] } else { [235, 70, 50] };
        for j in (y - r) as u32..(y + r) as u32 {
            for i in (x - r).max(0.0) as u32..((x + r) as u32).min(width) {
                let (dx, dy) = (i as f32 - x, j as f32 - y);
                if dx * dx + dy * dy < r * r {
                    street.put_pixel(i, j.min(height - 1), Rgb(color));
                }
            }
        }
    }
    street
}

/// View through the pane: sharp and upside down in the drops, out of focus between them.
fn look(glass: &Glass, photo: &RgbImage, blurred: &RgbImage) -> RgbImage {
    let [width, height] = glass.options().size;
    let (normals, heights) = (glass.normals(), glass.heights());
    RgbImage::from_fn(width, height, |x, y| {
        let i = (y * width + x) as usize;
        let (normal, deep) = (normals[i], heights[i]);
        if deep < 2.0e-6 {
            return *blurred.get_pixel(x, y);
        }
        // A straight ray leaves a surface of slope s deflected by about 0.33 s; the background is far behind the pane.
        let slope = normal.truncate() / normal.z.max(0.2);
        let reach = 0.7 * height as f32;
        let at = |p: u32, s: f32, n: u32| ((p as f32 - reach * s).clamp(0.0, n as f32 - 1.0)) as u32;
        let Rgb(seen) = *photo.get_pixel(at(x, slope.x, width), at(y, slope.y, height));
        let Rgb(behind) = *blurred.get_pixel(x, y);
        // Steep rims reflect the dark interior.
        let through = 1.0 - 3.6 * (1.0 - normal.z) * (1.0 - normal.z);
        let cover = (deep / 25.0e-6).min(1.0);
        Rgb(std::array::from_fn(|c| {
            let drop = f32::from(seen[c]) * through.max(0.25);
            (drop * cover + f32::from(behind[c]) * (1.0 - cover)) as u8
        }))
    })
}

fn write(
    glass: &Glass,
    folder: &Path,
    name: &str,
    photo: &RgbImage,
    blurred: &RgbImage,
) -> image::ImageResult<()> {
    let [width, height] = glass.options().size;
    look(glass, photo, blurred).save(folder.join(format!("{name}_look.png")))?;
    let heights = glass.heights();
    let deep = RgbImage::from_fn(width, height, |x, y| {
        Rgb([(heights[(y * width + x) as usize] / 1.2e-3 * 255.0).min(255.0) as u8; 3])
    });
    deep.save(folder.join(format!("{name}_height.png")))?;
    let normals = glass.normals();
    let normals = RgbImage::from_fn(width, height, |x, y| {
        Rgb(((normals[(y * width + x) as usize] * 0.5 + 0.5) * 255.0).to_array().map(|c| c as u8))
    });
    normals.save(folder.join(format!("{name}_normal.png")))
}

fn run(
    name: &str,
    options: &GlassOptions,
    folder: &Path,
    photo: &RgbImage,
    end: u32,
) -> Result<(), Box<dyn Error>> {
    let blurred = imageops::fast_blur(photo, 6.0);
    let mut glass = Glass::new(options)?;
    println!("{name}: ticks of {:.2} ms", 1.0e3 * glass.tick_s());
    let start = Instant::now();
    for second in 1..=end {
        for _ in 0..10 {
            glass.step(0.1)?;
        }
        if [1, 10, 30, 60].contains(&second) || second == end {
            write(&glass, folder, &format!("{name}_{second:02}s"), photo, &blurred)?;
            let totals = glass.totals();
            let beads = glass.mass().iter().filter(|&&m| m != 0).count();
            let runs = glass.velocities().iter().filter(|v| v[0].abs() + v[1].abs() > 0.01).count();
            println!(
                "{second:3} s: {beads} drops, {runs} run; ml landed {:.1}, stored {:.1}, over the edge {:.1}, wiped \
                 {:.1}, spilled {:.1}, lost {}; {:.0} ticks/s",
                totals.landed as f64 * 1.0e-6,
                totals.stored as f64 * 1.0e-6,
                totals.over_edge as f64 * 1.0e-6,
                totals.wiped as f64 * 1.0e-6,
                totals.spilled as f64 * 1.0e-6,
                totals.lost(),
                glass.ticks() as f64 / start.elapsed().as_secs_f64(),
            );
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| "target/glass".to_owned()));
    std::fs::create_dir_all(&folder)?;
    let photo = match arguments.next() {
        Some(path) => image::open(path)?.to_rgb8(),
        None => made_up(),
    };
    let photo = imageops::resize(&photo, SIZE[0], SIZE[1], imageops::FilterType::Triangle);
    let end = arguments.next().map_or(Ok(60), |s| s.parse())?;
    run("window", &window(), &folder, &photo, end)?;
    run("windshield", &windshield(), &folder, &photo, end)
}
