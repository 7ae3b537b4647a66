//! Light of lamps on drops in the form of Rousseau 2006: each pixel by its normal.

use std::f32::consts::PI;

use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::picture::PictureOptions;
use downpour_render::rain::light::{DropLightForm, DropLightOptions};
use downpour_render::rain::{DropMasks, Exposure, RainOptions, StreakSamples};
use downpour_sim::field::{DropKind, FallingDrop};
use downpour_trace::builder::SceneBuilder;
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use glam::{DVec3, Vec2, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Pixels along the drop's radius, which is below the least of the masks': a sphere.
const ACROSS: f32 = 20.0;
const SIZE: [u32; 2] = [64, 96];
const AWAY: f32 = 0.05;
const RADIUS: f32 = 0.25e-3;

/// A drop that falls before a black sky, lit from `from` with an irradiance of pi; red.
fn drawn(
    form: DropLightForm,
    from: Vec3,
    speed: f32,
    shutter_s: f64,
    samples: StreakSamples,
) -> Result<Vec<f32>, Box<dyn std::error::Error>> {
    let mut builder = SceneBuilder::new();
    // A lamp far away: a sun would be in the capture, too.
    let (position, intensity) = (from * 1.0e3, Vec3::splat(PI * 1.0e6));
    builder.add_light(LightSource::Point { radius: 0.0, position, intensity, range: 0.0 });
    let scene = builder.build(&SkyLight::new(16, 8, &[[0.0; 3]; 16 * 8]));
    let drop = FallingDrop {
        position: DVec3::new(0.0, 0.0, -f64::from(AWAY)),
        velocity: [0.0, -speed, 0.0],
        diameter: 2.0 * RADIUS,
        id: 5,
        kind: DropKind::Falling,
        present_s: FallingDrop::ALWAYS,
        normal: FallingDrop::LEVEL,
    };
    let exposure = Exposure { shutter_s, samples, ..Exposure::default() };
    let light = DropLightOptions { form, glints: 8 };
    let rain = RainOptions { capture_size: 16, exposure, light, ..RainOptions::default() };
    let half = 0.5 * SIZE[1] as f32 * RADIUS / (ACROSS * AWAY);
    let view = Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 2.0 * half };
    let options =
        PictureOptions { size: SIZE, grid: 1, sky_rays: 0, seed: 0, rain, ..PictureOptions::default() };
    let picture = render_picture(&scene, &view, &[drop], &DropMasks::trace(1.333)?, &options)?;
    Ok(picture.rain.iter().map(|pixel| pixel[0]).collect())
}

/// Rousseau 2006, section 6, as printed, at a position of a sphere's disk: (V . N) (A2 + A3), seen along -z.
fn printed(position: Vec2, from: Vec3) -> f32 {
    printed_terms(position, from).into_iter().sum()
}

/// Its terms: (V . N) A2, and (V . N) A3.
fn printed_terms(position: Vec2, from: Vec3) -> [f32; 2] {
    let normal = position.extend((1.0 - position.length_squared()).max(0.0).sqrt());
    let level = |v: Vec3| Vec2::new(v.x, v.z).normalize_or_zero();
    let outside = from.dot(normal).max(0.0);
    let within = (-level(from).dot(level(normal)) * (1.0 + from.dot(normal))).max(0.0);
    [normal.z * outside, normal.z * within]
}

/// The position of a pixel's middle on the disk, radii.
fn on_disk(column: u32, row: u32) -> Vec2 {
    let middle = Vec2::new(SIZE[0] as f32, SIZE[1] as f32) * 0.5;
    (Vec2::new(column as f32 + 0.5, row as f32 + 0.5) - middle) * Vec2::new(1.0, -1.0) / ACROSS
}

const LAMPS: [Vec3; 3] = [Vec3::new(0.8, 0.6, 0.0), Vec3::new(-0.6, 0.0, -0.8), Vec3::new(0.48, 0.6, 0.64)];

#[test]
fn each_pixel_of_a_still_drop_is_shaded_by_its_normal() -> Outcome {
    for from in LAMPS {
        let found = drawn(DropLightForm::Rousseau2006, from, 0.0, 0.0, StreakSamples::Table)?;
        let (mut worst, mut light, mut wanted_light) = (0.0f32, 0.0, 0.0);
        for (i, found) in (0..).zip(found) {
            let position = on_disk(i % SIZE[0], i / SIZE[0]);
            // Without the rim, where a pixel is in part beside the drop.
            if position.length() < 0.9 {
                let wanted = printed(position, from);
                worst = worst.max((found - wanted).abs());
                (light, wanted_light) = (light + found, wanted_light + wanted);
            }
        }
        println!("{from}: worst {worst}, {light} for {wanted_light}");
        assert!(
            worst < 0.08 && (light / wanted_light - 1.0).abs() < 0.02,
            "{from}: {worst}, {light}, {wanted_light}"
        );
    }
    Ok(())
}

/// Figure 11 of the paper shows them one by one.
#[test]
fn each_term_alone_is_the_papers() -> Outcome {
    let forms = [DropLightForm::Rousseau2006External, DropLightForm::Rousseau2006Internal];
    let mut brightest = [0.0f32; 2];
    for from in LAMPS {
        for (term, form) in forms.into_iter().enumerate() {
            let found = drawn(form, from, 0.0, 0.0, StreakSamples::Table)?;
            let (mut worst, mut most) = (0.0f32, 0.0f32);
            for (i, found) in (0..).zip(found) {
                let position = on_disk(i % SIZE[0], i / SIZE[0]);
                if position.length() < 0.9 {
                    let wanted = printed_terms(position, from)[term];
                    worst = worst.max((found - wanted).abs());
                    most = most.max(wanted);
                }
            }
            println!("{from}, {form:?}: worst {worst} of {most}");
            assert!(worst < 0.02, "{from}, {form:?}: {worst}");
            brightest[term] = brightest[term].max(most);
        }
    }
    assert!(brightest.iter().all(|most| *most > 0.3), "{brightest:?}");
    Ok(())
}

/// The streak of a drop that falls has along each column the mean over the chord there, by its profile and by a loop.
#[test]
fn a_streak_is_shaded_along_its_chords() -> Outcome {
    // It falls by 4 radii while the shutter is open, the middle of the picture in the middle: there each position of a chord
    // passes once.
    let (speed, shutter_s) = (2.0f32, f64::from(4.0 * RADIUS / 2.0));
    for from in LAMPS {
        for samples in [StreakSamples::Table, StreakSamples::Loop(32)] {
            let found = drawn(DropLightForm::Rousseau2006, from, speed, shutter_s, samples)?;
            let (mut squares, mut all, mut light, mut wanted_light) = (0.0, 0.0, 0.0, 0.0);
            for column in 0..SIZE[0] {
                let across = on_disk(column, 0).x;
                let half = (1.0 - across * across).max(0.0).sqrt();
                // Of the exposure the chord takes 2 half / 4.
                let mean = (0..400).map(|k| {
                    let up = half * ((k as f32 + 0.5) / 200.0 - 1.0);
                    printed(Vec2::new(across, up), from) / 400.0
                });
                let wanted = if half > 0.0 { mean.sum::<f32>() * half * 0.5 } else { 0.0 };
                let found = found[(SIZE[1] / 2 * SIZE[0] + column) as usize];
                squares += (found - wanted) * (found - wanted);
                all += wanted * wanted;
                (light, wanted_light) = (light + found, wanted_light + wanted);
            }
            let apart = (squares / all).sqrt();
            println!("{from}, {samples:?}: {apart}, {light} for {wanted_light}");
            assert!(apart < 0.1 && (light / wanted_light - 1.0).abs() < 0.05, "{from}, {samples:?}: {apart}");
        }
    }
    Ok(())
}
