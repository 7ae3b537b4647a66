//! Drops that move while the shutter is open: how much light they take out, where, and what they show instead.

use std::sync::OnceLock;

use downpour_drop::oscillation::Amplitudes;
use downpour_render::camera::Viewpoint;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::{
    DropMasks, Exposure, EyeMotion, RainOptions, RefractionForm, StreakColor, StreakSamples, TemporalResponse,
};
use downpour_sim::field::{DropKind, FallingDrop};
use downpour_trace::builder::SceneBuilder;
use downpour_trace::data::SceneData;
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use glam::{DVec3, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const SIZE: [u32; 2] = [160, 120];

/// Traced once for all tests.
static MASKS: OnceLock<DropMasks> = OnceLock::new();

fn viewpoint() -> Viewpoint {
    Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.2 }
}

/// Pixels per unit of slope of a picture so many pixels high.
fn scale(height: u32) -> f64 {
    f64::from(height) / (2.0 * downpour_math::ops::f64::tan(0.1))
}

fn drop_at(position: DVec3, diameter: f32, velocity: [f32; 3]) -> FallingDrop {
    let present_s = FallingDrop::ALWAYS;
    FallingDrop {
        position,
        velocity,
        diameter,
        id: 1,
        kind: DropKind::Falling,
        present_s,
        normal: FallingDrop::LEVEL,
    }
}

fn picture(
    scene: &SceneData,
    size: [u32; 2],
    drops: &[FallingDrop],
    exposure: Exposure,
) -> Result<Picture, Box<dyn std::error::Error>> {
    picture_from(scene, &viewpoint(), size, drops, exposure)
}

fn picture_from(
    scene: &SceneData,
    eye: &Viewpoint,
    size: [u32; 2],
    drops: &[FallingDrop],
    exposure: Exposure,
) -> Result<Picture, Box<dyn std::error::Error>> {
    let form = RefractionForm::Direction;
    let rain = RainOptions { form, capture_size: 128, exposure, ..RainOptions::default() };
    let options = PictureOptions { size, grid: 1, sky_rays: 0, seed: 0, rain, ..PictureOptions::default() };
    let masks = MASKS.get_or_init(|| DropMasks::trace(1.333).expect("masks"));
    Ok(render_picture(scene, eye, drops, masks, &options)?)
}

fn sky(radiance: impl Fn(f32, f32) -> [f32; 3]) -> SceneData {
    let map: Vec<[f32; 3]> =
        (0..128 * 64).map(|i| radiance((i % 128) as f32 / 128.0, 1.0 - (i / 128) as f32 / 31.5)).collect();
    SceneBuilder::new().build(&SkyLight::new(128, 64, &map))
}

/// A street at dusk, as skies go: bright above, dark below, with windows.
fn varied() -> SceneData {
    sky(|turn, height| {
        let window = if (turn * 40.0).fract() < 0.3 && height.abs() < 0.3 { 4.0 } else { 0.3 };
        if height > 0.3 { [1.0, 1.2, 1.5] } else { [window, window * 0.9, window * 0.6] }
    })
}

fn covered(picture: &Picture) -> f64 {
    picture.rain.iter().map(|pixel| f64::from(1.0 - pixel[3])).sum()
}

/// Covered pixels, and the weighted middle of them.
fn middle(picture: &Picture) -> [f64; 2] {
    let (mut area, mut position) = (0.0, [0.0; 2]);
    for (i, pixel) in picture.rain.iter().enumerate() {
        let fraction = f64::from(1.0 - pixel[3]);
        area += fraction;
        position[0] += fraction * ((i % picture.size[0] as usize) as f64 + 0.5);
        position[1] += fraction * ((i / picture.size[0] as usize) as f64 + 0.5);
    }
    position.map(|p| p / area)
}

/// A drop takes out its area, however long the exposure and wherever it goes, in the picture: by the table, by a loop, and
/// below a pixel.
#[test]
fn a_streak_takes_out_what_its_drop_does() -> Outcome {
    let scene = sky(|_, _| [1.0; 3]);
    let diameter = 0.4e-3f32;
    for pixels in [20.0, 6.0, 2.5, 1.2, 0.5] {
        let distance = f64::from(diameter) * scale(SIZE[1]) / pixels;
        let expected = std::f64::consts::FRAC_PI_4 * pixels * pixels;
        for samples in [StreakSamples::Table, StreakSamples::Loop(16)] {
            // Pixels during the exposure, across and up.
            for (way, tolerance) in
                [([0.0, -50.0], 0.03), ([28.0, -40.0], 0.03), ([31.7, 3.1], 0.03), ([0.0, -9.0], 0.05)]
            {
                let velocity = way.map(|w| (w / scale(SIZE[1]) * distance * 100.0) as f32);
                let drop =
                    drop_at(DVec3::new(0.0, 0.0, -distance), diameter, [velocity[0], velocity[1], 0.0]);
                let exposure = Exposure { shutter_s: 0.01, samples, ..Exposure::default() };
                let shown = picture(&scene, SIZE, &[drop], exposure)?;
                let found = covered(&shown);
                assert!(
                    (found / expected - 1.0).abs() < tolerance,
                    "{pixels} pixels, {samples:?}, {way:?}: {found}, not {expected}"
                );
                let position = middle(&shown);
                assert!((position[0] - 80.0).abs() < 0.3 && (position[1] - 60.0).abs() < 0.3, "{position:?}");
            }
        }
    }
    Ok(())
}

/// Rows of a streak that fades, by the law of a disk of diameter `d` pixels that goes down `way` pixels at one speed while what it
/// leaves behind fades away in that time: a row that the whole disk passes loses `(pi d^2 / 4) / way` by `2 s`, `s` the part of the
/// way that lies above it. All rows together lose the disk's area, and their middle is at two thirds of the way.
#[test]
fn an_eye_sees_a_streak_fade() -> Outcome {
    let scene = sky(|_, _| [1.0; 3]);
    let (diameter, way) = (0.4e-3f32, 60.0);
    for pixels in [10.0, 6.0, 2.5, 1.2, 0.5] {
        let distance = f64::from(diameter) * scale(SIZE[1]) / pixels;
        let area = std::f64::consts::FRAC_PI_4 * pixels * pixels;
        for samples in [StreakSamples::Table, StreakSamples::Loop(16)] {
            let speed = (way / scale(SIZE[1]) * distance / 0.075) as f32;
            let drop = drop_at(DVec3::new(0.0, 0.0, -distance), diameter, [0.0, -speed, 0.0]);
            let exposure = Exposure {
                shutter_s: 0.075,
                response: TemporalResponse::Fading,
                samples,
                ..Exposure::default()
            };
            let shown = picture(&scene, SIZE, &[drop], exposure)?;
            let begin = 0.5 * (f64::from(SIZE[1]) - way);
            let margin = 0.5 * pixels + 1.5;
            for (row, line) in shown.rain.chunks(SIZE[0] as usize).enumerate() {
                let found: f64 = line.iter().map(|pixel| f64::from(1.0 - pixel[3])).sum();
                let below = row as f64 + 0.5 - begin;
                if below > margin && below < way - margin {
                    let expected = 2.0 * below / way * area / way;
                    let full = area / way;
                    assert!(
                        (found - expected).abs() < 0.05 * full,
                        "{pixels} pixels, {samples:?}, row {row}: {found}, not {expected}"
                    );
                } else if below < -margin || below > way + margin {
                    assert!(found < 1.0e-6, "row {row}: {found}");
                }
            }
            let (found, middle) = (covered(&shown), middle(&shown));
            assert!((found / area - 1.0).abs() < 0.03, "{pixels} pixels, {samples:?}: {found}, not {area}");
            let expected = begin + way * 2.0 / 3.0;
            assert!((middle[1] - expected).abs() < 0.3, "{pixels}: {middle:?}, not at {expected}");
        }
    }
    Ok(())
}

/// The image of a drop before a varied environment in an eye is the mean of short exposures one after the other, each with
/// the weight of its age: also where the drop comes nearer, and as long as it takes to pass a ray.
#[test]
fn an_eye_sees_moments_by_their_age() -> Outcome {
    const PARTS: u32 = 24;
    const PERSISTENCE_S: f64 = 0.075;
    let scene = varied();
    for (velocity, samples, tolerance) in [
        ([0.0, -0.7, 0.0], StreakSamples::Loop(64), 0.03),
        ([0.2, -0.5, 1.5], StreakSamples::Loop(64), 0.05),
        ([0.0, -0.7, 0.0], StreakSamples::Table, 0.06),
    ] {
        let drop = drop_at(DVec3::new(0.0, 0.0, -0.3), 2.0e-3, velocity);
        let exposure = Exposure { shutter_s: PERSISTENCE_S, samples, ..Exposure::default() };
        let eye = Exposure { response: TemporalResponse::Fading, ..exposure };
        let found = picture(&scene, SIZE, &[drop], eye)?;
        let mut expected = picture(&scene, SIZE, &[], exposure)?;
        let mut layer = vec![[0.0f32; 4]; found.rain.len()];
        for part in 0..PARTS {
            let middle = (f64::from(part) + 0.5) / f64::from(PARTS);
            let time = (middle - 0.5) * PERSISTENCE_S;
            let mut moved = drop;
            moved.position += DVec3::from(velocity.map(f64::from)) * time;
            let short = Exposure { shutter_s: PERSISTENCE_S / f64::from(PARTS), ..exposure };
            let shown = picture(&scene, SIZE, &[moved], short)?;
            // Ages fall evenly over the persistence; the youngest weighs the most.
            let weight = (2.0 * middle / f64::from(PARTS)) as f32;
            for (sum, pixel) in layer.iter_mut().zip(&shown.rain) {
                let cover = 1.0 - pixel[3];
                for (sum, value) in sum.iter_mut().zip([pixel[0], pixel[1], pixel[2], cover]) {
                    *sum += weight * value;
                }
            }
        }
        expected.rain = layer.iter().map(|&[r, g, b, cover]| [r, g, b, 1.0 - cover]).collect();
        let apart = error(&found, &expected);
        let even = error(&picture(&scene, SIZE, &[drop], exposure)?, &expected);
        println!("{velocity:?}, {samples:?}: {apart}, of a shutter {even}");
        assert!(apart < tolerance, "{velocity:?}, {samples:?}: {apart}");
        assert!(even > 0.3, "a shutter is {even} apart");
        let ratio = covered(&found) / covered(&expected);
        assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    }
    Ok(())
}

/// Half a millimeter to 6 mm, near and far, straight and slanted, with their oscillation.
fn many() -> Vec<FallingDrop> {
    (0..40)
        .map(|k| {
            let k = f64::from(k);
            let position =
                DVec3::new(0.11 * (k * 0.618).fract() - 0.055, 0.09 * (k * 0.755).fract() - 0.045, -1.0);
            let mut drop =
                drop_at(position * (0.15 + 0.03 * k), (0.3 + 0.14 * k as f32) * 1.0e-3, [0.4, -6.0, 0.3]);
            drop.id = k as u64;
            drop
        })
        .collect()
}

/// Transmission and reflection are all there is: in a uniform environment streaks cannot be seen.
#[test]
fn in_uniform_surroundings_streaks_vanish() -> Outcome {
    let scene = sky(|_, _| [0.25, 0.5, 2.0]);
    for samples in [StreakSamples::Table, StreakSamples::Loop(5)] {
        for shutter_s in [1.0 / 2000.0, 1.0 / 60.0] {
            let oscillation = Amplitudes::GARG_NAYAR_OBLATE;
            for response in [TemporalResponse::Shutter, TemporalResponse::Fading] {
                let exposure = Exposure { shutter_s, response, samples, oscillation, ..Exposure::default() };
                let shown = picture(&scene, SIZE, &many(), exposure)?;
                assert!(covered(&shown) > 100.0, "{}", covered(&shown));
                for pixel in shown.radiance() {
                    for (found, expected) in pixel.iter().zip([0.25, 0.5, 2.0]) {
                        assert!(
                            (found / expected - 1.0).abs() < 1.0e-3,
                            "{response:?}, {samples:?}: {pixel:?}"
                        );
                    }
                }
            }
        }
    }
    Ok(())
}

/// Root mean square of the difference of two rains, over that of the second.
fn error(found: &Picture, expected: &Picture) -> f64 {
    let (mut squares, mut all) = (0.0, 0.0);
    for (a, b) in found.rain.iter().zip(&expected.rain).flat_map(|(a, b)| (0..3).map(move |k| (a[k], b[k]))) {
        squares += f64::from(a - b) * f64::from(a - b);
        all += f64::from(b * b);
    }
    (squares / all).sqrt()
}

/// A loop of 512 samples shows what the masks have, between their sizes and elevations; the table traces each drop. Both have the
/// same light, and look alike. (`specimen_table.rs` holds the table to the exact streak.)
#[test]
fn the_table_has_the_light_of_a_loop() -> Outcome {
    let scene = varied();
    for shutter_s in [1.0 / 500.0, 1.0 / 60.0] {
        let with = |samples| {
            let exposure = Exposure { shutter_s, samples, ..Exposure::default() };
            picture(&scene, SIZE, &many(), exposure)
        };
        let truth = with(StreakSamples::Loop(512))?;
        let table = with(StreakSamples::Table)?;
        let [apart, five] = [&table, &with(StreakSamples::Loop(5))?].map(|found| error(found, &truth));
        let light = |shown: &Picture| shown.rain.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>();
        let ratio = light(&table) / light(&truth);
        println!("{shutter_s}: {apart}, with 5 samples {five}; light {ratio}");
        assert!((ratio - 1.0).abs() < 0.03 && apart < 0.15, "{apart}, {ratio}");
        assert!(five < 0.05, "{five}");
    }
    Ok(())
}

/// The same drops on pictures of 120, 270 and 540 lines take out the same fraction, and show the same light.
#[test]
fn the_light_is_that_of_any_resolution() -> Outcome {
    let scene = varied();
    let exposure = Exposure { shutter_s: 1.0 / 250.0, ..Exposure::default() };
    let mean = |height: u32| -> Result<[f64; 2], Box<dyn std::error::Error>> {
        let size = [height * 4 / 3, height];
        let drops: Vec<FallingDrop> = many().into_iter().filter(|drop| drop.position.z < -0.5).collect();
        let shown = picture(&scene, size, &drops, exposure)?;
        let count = shown.rain.len() as f64;
        let light: f64 = shown.rain.iter().map(|p| f64::from(p[0] + p[1] + p[2])).sum();
        Ok([covered(&shown) / count, light / count])
    };
    let [coarse, middle, fine] = [mean(120)?, mean(270)?, mean(540)?];
    for k in 0..2 {
        for found in [coarse[k], middle[k]] {
            assert!((found / fine[k] - 1.0).abs() < 0.02, "{coarse:?}, {middle:?}, {fine:?}");
        }
    }
    Ok(())
}

/// Seen from below, streaks lead to where the drops come from: the zenith.
#[test]
fn streaks_of_a_view_upwards_meet_above() -> Outcome {
    let scene = sky(|_, _| [1.0; 3]);
    let eye = Viewpoint { eye: Vec3::ZERO, forward: Vec3::Y, up: Vec3::Z, fov_y: 0.8 };
    let drops: Vec<FallingDrop> = [[0.4, 1.0], [-0.5, 0.2], [0.1, -0.6]]
        .iter()
        .map(|[x, z]| drop_at(DVec3::new(0.3 * x, 1.0, 0.3 * z), 4.0e-3, [0.0, -6.0, 0.0]))
        .collect();
    let exposure = Exposure { shutter_s: 1.0 / 30.0, ..Exposure::default() };
    for drop in &drops {
        let shown = picture_from(&scene, &eye, SIZE, &[*drop], exposure)?;
        assert!(covered(&shown) > 0.2);
        // Second moments about the middle of the picture: a line through it has none across.
        let [mut xx, mut xy, mut yy] = [0.0f64; 3];
        for (i, pixel) in shown.rain.iter().enumerate() {
            let x = (i % 160) as f64 + 0.5 - 80.0;
            let y = (i / 160) as f64 + 0.5 - 60.0;
            let fraction = f64::from(1.0 - pixel[3]);
            (xx, xy, yy) = (xx + fraction * x * x, xy + fraction * x * y, yy + fraction * y * y);
        }
        let narrow = 0.5 * (xx + yy - ((xx - yy) * (xx - yy) + 4.0 * xy * xy).sqrt());
        let along = xx + yy - narrow;
        assert!(narrow < 2.0e-3 * along, "{narrow} across, {along} along");
    }
    Ok(())
}

/// A camera that falls with the drops sees them still; one that turns sees level streaks.
#[test]
fn streaks_are_relative_to_the_eye() -> Outcome {
    let scene = varied();
    let drop = drop_at(DVec3::new(0.0, 0.0, -0.5), 3.0e-3, [0.0, -6.0, 0.0]);
    let still = picture(&scene, SIZE, &[drop], Exposure::default())?;
    let with = |velocity, turning| Exposure {
        shutter_s: 1.0 / 200.0,
        eye: EyeMotion { velocity, turning },
        ..Exposure::default()
    };
    let falling = picture(&scene, SIZE, &[drop], with(Vec3::new(0.0, -6.0, 0.0), Vec3::ZERO))?;
    assert_eq!(still.rain, falling.rain);
    // 0.1 rad to the left: the drop goes to the right.
    let drop = drop_at(DVec3::new(0.0, 0.0, -0.5), 3.0e-3, [0.0, 0.0, 0.0]);
    let turning = picture(&scene, SIZE, &[drop], with(Vec3::ZERO, Vec3::new(0.0, 12.0, 0.0)))?;
    let touched: Vec<usize> = (0..turning.rain.len()).filter(|&i| turning.rain[i][3] < 0.999).collect();
    let columns = |i: &usize| i % 160;
    let rows = |i: &usize| i / 160;
    let width =
        touched.iter().map(columns).max().unwrap_or(0) - touched.iter().map(columns).min().unwrap_or(0);
    let height = touched.iter().map(rows).max().unwrap_or(0) - touched.iter().map(rows).min().unwrap_or(0);
    // 0.06 rad at 598 pixels a unit, and a drop of 3.6 pixels.
    assert!((30..46).contains(&width) && height < 8, "{width} x {height}");
    Ok(())
}

/// The outline swings by the mode's amplitude, at its frequency, left and right against each other.
#[test]
fn the_outline_oscillates() -> Outcome {
    let scene = sky(|_, _| [1.0; 3]);
    // 24 pixels across: 2 mm at 50 mm.
    let mut drop = drop_at(DVec3::new(0.0, 0.0, -0.05), 2.0e-3, [0.0, -1.0, 0.0]);
    drop.id = 3;
    let width = |oscillation| -> Result<Vec<f64>, Box<dyn std::error::Error>> {
        let exposure = Exposure { shutter_s: 1.0 / 100.0, oscillation, time_s: 3.0, ..Exposure::default() };
        let shown = picture(&scene, SIZE, &[drop], exposure)?;
        let touched = |x: &usize, y: usize| shown.rain[y * 160 + x][3] < 0.995;
        Ok((0..120).map(|y| (0..160).filter(|x| touched(x, y)).count() as f64).collect())
    };
    let [calm, swinging] = [width(Amplitudes::NONE)?, width(Amplitudes::GARG_NAYAR_OBLATE)?];
    let spread = |widths: &[f64]| {
        let inner = &widths[30..90];
        inner.iter().copied().fold(0.0, f64::max) - inner.iter().copied().fold(f64::INFINITY, f64::min)
    };
    assert!(spread(&calm) <= 2.0, "{calm:?}");
    assert!(spread(&swinging) > 3.0, "{swinging:?}");
    Ok(())
}

/// Static streaks have one color, and take out as much.
#[test]
fn white_streaks_have_one_color() -> Outcome {
    let scene = varied();
    let with = |color| Exposure { shutter_s: 1.0 / 250.0, color, ..Exposure::default() };
    let refracted = picture(&scene, SIZE, &many(), with(StreakColor::Refracted))?;
    let white = picture(&scene, SIZE, &many(), with(StreakColor::White))?;
    assert!((covered(&refracted) / covered(&white) - 1.0).abs() < 1.0e-6);
    let ratio = |p: &[f32; 4]| p[2] / p[0];
    let touched: Vec<&[f32; 4]> = white.rain.iter().filter(|p| p[3] < 0.99).collect();
    assert!(touched.len() > 100);
    for pixel in &touched {
        assert!((ratio(pixel) / ratio(touched[0]) - 1.0).abs() < 1.0e-3);
    }
    Ok(())
}

/// Out of focus a drop's light is spread, and none of it is lost.
#[test]
fn what_is_out_of_focus_is_spread() -> Outcome {
    let scene = sky(|_, _| [1.0; 3]);
    for shutter_s in [0.0, 1.0 / 250.0] {
        let drop = drop_at(DVec3::new(0.0, 0.0, -0.5), 2.0e-3, [0.0, -6.0, 0.0]);
        let with = |aperture_m| Exposure { shutter_s, aperture_m, focus_m: 5.0, ..Exposure::default() };
        let [sharp, soft] =
            [picture(&scene, SIZE, &[drop], with(0.0))?, picture(&scene, SIZE, &[drop], with(0.005))?];
        assert!((covered(&soft) / covered(&sharp) - 1.0).abs() < 0.03);
        let most = |p: &Picture| p.rain.iter().map(|pixel| 1.0 - pixel[3]).fold(0.0, f32::max);
        assert!(most(&soft) < 0.5 * most(&sharp), "{} and {}", most(&soft), most(&sharp));
    }
    Ok(())
}
