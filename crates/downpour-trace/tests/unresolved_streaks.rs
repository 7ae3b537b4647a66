//! Streaks of unresolved drops: the variance of a picture is that of all drops drawn one by one, and its mean that of the even medium.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_render::camera::Viewpoint;
use downpour_render::picture::PictureOptions;
use downpour_render::rain::{DropMasks, Exposure, MediumGrain, MediumOptions, RainMedium, RainOptions};
use downpour_sim::field::RainField;
use downpour_sim::view::View;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::material::MaterialLook;
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, Vec3};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// Half the picture at distance 1, and its distance to the wall, m.
const HALF: f64 = 0.36;
const DISTANCE: f32 = 6.0;

/// Lines of a picture of which most drops are unresolved.
const LINES: u32 = 32;

/// Lines of the picture with all drops, for each of those.
const FINER: u32 = 4;

const SHUTTER_S: f64 = 1.0 / 60.0;

fn wall() -> SceneData {
    let mut builder = SceneBuilder::new();
    let black =
        builder.add_material(MaterialLook { base_color: [0.0, 0.0, 0.0, 1.0], ..MaterialLook::default() });
    let corners =
        [[-99.0, -99.0], [99.0, -99.0], [99.0, 99.0], [-99.0, 99.0]].map(|[x, y]| [x, y, -DISTANCE]);
    builder.add_mesh(&MeshPart::plain(&corners, &[0, 1, 2, 0, 2, 3], black), &Affine3A::IDENTITY);
    builder.build(&SkyLight::uniform([1.0; 3]))
}

fn masks() -> &'static DropMasks {
    static MASKS: std::sync::OnceLock<DropMasks> = std::sync::OnceLock::new();
    MASKS.get_or_init(|| DropMasks::trace(1.333).expect("masks"))
}

/// Extinction by the rain in each pixel, of pictures whose drops from some size on the picture on are drawn one by one.
fn taken(lines: u32, least_pixels: f64, grain: MediumGrain, time_s: f64) -> Outcome<Vec<f64>> {
    let law = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 40.0)?;
    let pixel_angle = 2.0 * HALF / f64::from(lines);
    let seen = View {
        half_width: HALF,
        half_height: HALF,
        pixel_angle,
        least_pixels,
        shutter_s: SHUTTER_S,
        max_drops: 1 << 22,
        ..View::default()
    };
    let visible = RainField::new(&law, 3)?.visible(&seen, time_s)?;
    let options = MediumOptions { grain, ..MediumOptions::default() };
    let medium = RainMedium::new(&law, &visible.resolved, masks(), &options)?;
    let exposure = Exposure { shutter_s: SHUTTER_S, time_s, seed: 3, ..Exposure::default() };
    let rain = RainOptions { medium, capture_size: 64, exposure, ..RainOptions::default() };
    let options =
        PictureOptions { size: [lines, lines], grid: 1, sky_rays: 0, rain, ..PictureOptions::default() };
    let view = Viewpoint {
        eye: Vec3::ZERO,
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 2.0 * downpour_math::ops::f64::atan(HALF) as f32,
    };
    let picture = render_picture(&wall(), &view, &visible.drops, masks(), &options)?;
    Ok(picture.rain.iter().map(|pixel| f64::from(1.0 - pixel[3])).collect())
}

/// Mean and variance over pixels, and the covariance of neighbors above each other and beside each other.
fn moments(pixels: &[f64]) -> [f64; 4] {
    let side = LINES as usize;
    let mean = pixels.iter().sum::<f64>() / pixels.len() as f64;
    let with = |step: usize| {
        let pairs = (0..side * side - step).filter(|k| step != 1 || k % side != side - 1);
        let products: Vec<f64> = pairs.map(|k| (pixels[k] - mean) * (pixels[k + step] - mean)).collect();
        products.iter().sum::<f64>() / products.len() as f64
    };
    [mean, with(0), with(side), with(1)]
}

fn mean_of(of: impl Fn(f64) -> Outcome<[f64; 4]>) -> Outcome<[f64; 4]> {
    let mut sum = [0.0; 4];
    let times = 4;
    for time in 0..times {
        let found = of(1.0 + 0.37 * f64::from(time))?;
        (0..4).for_each(|k| sum[k] += found[k] / f64::from(times));
    }
    Ok(sum)
}

/// The picture with all drops, in coarse pixels.
fn truth(time_s: f64) -> Outcome<[f64; 4]> {
    let fine = taken(LINES * FINER, 1.0e-3, MediumGrain::Even, time_s)?;
    let mut coarse = vec![0.0; (LINES * LINES) as usize];
    for (k, taken) in fine.iter().enumerate() {
        let (x, y) = (k as u32 % (LINES * FINER) / FINER, k as u32 / (LINES * FINER) / FINER);
        coarse[(y * LINES + x) as usize] += taken / f64::from(FINER * FINER);
    }
    Ok(moments(&coarse))
}

#[test]
fn streaks_have_the_mean_and_the_variance_of_all_drops() -> Outcome {
    let truth = mean_of(truth)?;
    let even = mean_of(|time_s| Ok(moments(&taken(LINES, 0.4, MediumGrain::Even, time_s)?)))?;
    let streaks = mean_of(|time_s| Ok(moments(&taken(LINES, 0.4, MediumGrain::Streaks, time_s)?)))?;
    assert!((streaks[0] / truth[0] - 1.0).abs() < 0.03 && (streaks[0] / even[0] - 1.0).abs() < 0.02);
    // Without them most of the variance is missing.
    assert!(even[1] < 0.5 * truth[1]);
    assert!((streaks[1] / truth[1] - 1.0).abs() < 0.2);
    // They fall: along their way pixels are alike, across it they are not.
    let [along, across] = [2, 3].map(|k| streaks[k] / streaks[1] - truth[k] / truth[1]);
    assert!(along.abs() < 0.1 && across.abs() < 0.12, "{along} {across}");
    Ok(())
}
