//! Light of a lamp on one drop, summed over the picture: for any size of the drop on it, at rest and as a streak.

use std::sync::OnceLock;

use downpour_drop::air::Air;
use downpour_drop::optics::{SUN_DIAMETER, SphereScattering, rgb_indices};
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::{DropMasks, Exposure, RainOptions, StreakSamples};
use downpour_sim::field::{DropKind, FallingDrop};
use downpour_trace::builder::SceneBuilder;
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use glam::{DVec3, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const SIZE: [u32; 2] = [72, 72];
const DIAMETER: f32 = 0.4e-3;
const HALF_FOV: f64 = 0.05;
const BINS: usize = 256;

static MASKS: OnceLock<DropMasks> = OnceLock::new();

/// Pixels per unit of slope.
fn scale() -> f64 {
    f64::from(SIZE[1]) / (2.0 * downpour_math::ops::f64::tan(HALF_FOV))
}

/// Direction at an angle of degrees from the view, -Z, toward an azimuth.
fn turned(degrees: f64, azimuth: f64) -> Vec3 {
    let (angle, azimuth) = (degrees.to_radians(), azimuth.to_radians());
    let (sin, cos) = (downpour_math::ops::f64::sin(angle), downpour_math::ops::f64::cos(angle));
    let (s, c) = (downpour_math::ops::f64::sin(azimuth), downpour_math::ops::f64::cos(azimuth));
    DVec3::new(sin * c, sin * s, -cos).as_vec3()
}

/// A drop so many pixels across in parallel light from a direction, before a black sky.
fn picture(
    pixels: f64,
    light: Vec3,
    way: [f64; 2],
    samples: StreakSamples,
) -> Result<Picture, Box<dyn std::error::Error>> {
    let mut builder = SceneBuilder::new();
    builder.add_light(LightSource::Directional { direction: -light, irradiance: Vec3::ONE });
    let scene = builder.build(&SkyLight::new(16, 8, &[[0.0; 3]; 16 * 8]));
    let distance = f64::from(DIAMETER) * scale() / pixels;
    let [x, y] = way.map(|w| (w / scale() * distance * 100.0) as f32);
    let drop = FallingDrop {
        position: DVec3::new(0.3 / scale() * distance, 0.2 / scale() * distance, -distance),
        velocity: [x, y, 0.0],
        diameter: DIAMETER,
        id: 1,
        kind: DropKind::Falling,
        present_s: FallingDrop::ALWAYS,
        normal: FallingDrop::LEVEL,
    };
    let shutter_s = if way == [0.0; 2] { 0.0 } else { 0.01 };
    let exposure = Exposure { shutter_s, samples, ..Exposure::default() };
    let rain = RainOptions { capture_size: 16, exposure, ..RainOptions::default() };
    let options =
        PictureOptions { size: SIZE, grid: 1, sky_rays: 0, seed: 0, rain, ..PictureOptions::default() };
    let eye = Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 2.0 * HALF_FOV as f32 };
    let masks = MASKS.get_or_init(|| DropMasks::trace(1.333).expect("masks"));
    Ok(render_picture(&scene, &eye, &[drop], masks, &options)?)
}

/// Green light of a picture, over all pixels.
fn sum(picture: &Picture) -> f64 {
    picture.rain.iter().map(|pixel| f64::from(pixel[1])).sum()
}

/// A ball of radius a that an irradiance of 1 meets sends pi a^2 phase per steradian toward the eye. A drop `pixels` across covers
/// pi / 4 pixels^2 pixels: their radiances sum to that area times the phase.
fn expected(sphere: &SphereScattering, degrees: f64, pixels: f64) -> f64 {
    let at = (degrees / 180.0 * BINS as f64 - 0.5).clamp(0.0, BINS as f64 - 1.0);
    let (low, part) = (at as usize, at.fract());
    let phase = |bin: usize| sphere.paths().iter().map(|path| path.phase[bin.min(BINS - 1)]).sum::<f64>();
    let phase = phase(low) * (1.0 - part) + phase(low + 1) * part;
    std::f64::consts::FRAC_PI_4 * pixels * pixels * phase
}

fn green() -> Result<SphereScattering, Box<dyn std::error::Error>> {
    Ok(SphereScattering::new(rgb_indices(&Air::standard())?[1], BINS, SUN_DIAMETER)?)
}

/// From a third of a pixel to 20 pixels, by lamps from everywhere.
#[test]
fn all_pixels_have_the_light_of_a_drop() -> Outcome {
    let sphere = green()?;
    let mut worst = 0.0f64;
    for (k, pixels) in [0.3, 1.05, 1.4, 1.9, 2.6, 4.2, 8.0, 20.0].into_iter().enumerate() {
        for degrees in [3.0, 45.0, 75.0, 100.0, 140.0, 178.0] {
            let light = turned(degrees, 70.0 * k as f64 + degrees);
            let ways: &[[f64; 2]] = &[[0.0; 2], [16.0, -20.0]];
            for &way in ways {
                let found = sum(&picture(pixels, light, way, StreakSamples::Loop(8))?);
                let ratio = found / expected(&sphere, degrees, pixels);
                worst = worst.max((ratio - 1.0).abs());
                println!("{pixels} pixels, {degrees} degrees, {way:?}: {ratio:.4}");
            }
        }
    }
    println!("worst {worst:.4}");
    assert!(worst < 0.01, "{worst}");
    Ok(())
}
