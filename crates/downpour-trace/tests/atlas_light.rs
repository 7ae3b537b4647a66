//! Light of lamps on streaks out of an atlas: its amount, and where along a streak it is.

use std::f32::consts::{PI, TAU};
use std::path::Path;

use downpour_atlas::{StreakAtlas, StreakPick};
use downpour_drop::oscillation::Amplitudes;
use downpour_math::rng::rng_draw;
use downpour_render::RenderError;
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::light::{DropLightForm, DropLightOptions, DropLights};
use downpour_render::rain::{DropMasks, Exposure, RainOptions, StreakSamples};
use downpour_sim::field::{DropKind, FallingDrop};
use downpour_trace::builder::SceneBuilder;
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::picture::render_picture;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use glam::{DVec3, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const SIZE: [u32; 2] = [60, 160];
const FALL: f32 = 6.5;
const SHUTTER_S: f64 = 1.0 / 60.0;

fn atlas() -> StreakAtlas {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/streaks");
    StreakAtlas::load(&folder).expect("the project's atlas")
}

fn scene(lights: &[LightSource]) -> SceneData {
    let mut builder = SceneBuilder::new();
    for &light in lights {
        builder.add_light(light);
    }
    builder.build(&SkyLight::new(16, 8, &[[0.0; 3]; 16 * 8]))
}

fn shining(towards: Vec3) -> LightSource {
    LightSource::Directional { direction: -towards, irradiance: Vec3::ONE }
}

fn viewpoint() -> Viewpoint {
    Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.2 }
}

/// Streaks by their profiles, the light of whose drops swings; by a loop the light of lamps is that of a sphere.
const SPHERE: StreakSamples = StreakSamples::Loop(16);

/// One drop in the middle of the picture, `away` meters before the eye.
fn drawn(
    masks: &DropMasks,
    scene: &SceneData,
    away: f64,
    light: DropLightOptions,
    samples: StreakSamples,
) -> Result<Picture, Box<dyn std::error::Error>> {
    let drop = FallingDrop {
        position: DVec3::new(0.0, 0.0, -away),
        velocity: [0.0, -FALL, 0.0],
        diameter: 2.0e-3,
        id: 5,
        kind: DropKind::Falling,
        present_s: FallingDrop::ALWAYS,
        normal: FallingDrop::LEVEL,
    };
    let exposure = Exposure {
        shutter_s: SHUTTER_S,
        samples,
        oscillation: Amplitudes::GARG_NAYAR_OBLATE,
        ..Exposure::default()
    };
    let rain = RainOptions { capture_size: 16, exposure, light, ..RainOptions::default() };
    let options =
        PictureOptions { size: SIZE, grid: 1, sky_rays: 0, seed: 0, rain, ..PictureOptions::default() };
    Ok(render_picture(scene, &viewpoint(), &[drop], masks, &options)?)
}

/// Each row's light.
fn rows(picture: &Picture) -> Vec<f32> {
    let of_row = |row: &[[f32; 4]]| row.iter().map(|pixel| pixel[0]).sum();
    picture.rain.chunks(SIZE[0] as usize).map(of_row).collect()
}

fn mean(masks: &DropMasks, scene: &SceneData, id: f32, light: DropLightOptions) -> Result<f32, RenderError> {
    let frame = RenderFrame::new(scene, &viewpoint(), [64, 64], 1, 0, 0)?;
    let mut rows = vec![[0.0, 0.0, -0.3, 1.0e-3]];
    if light.form == DropLightForm::Atlas {
        rows.push([0.0, 1.0, 0.0, id]);
    }
    Ok(DropLights::new(&SceneView { data: scene, frame: &frame }, frame.camera.eye, &masks.light, light)?
        .light(&rows)[0][0])
}

/// Lamps all around a drop light it as an even sky does: together its disk is as bright as the sky, since nothing is lost.
#[test]
fn lamps_all_round_make_an_even_sky() -> Outcome {
    let masks = DropMasks::trace(1.333)?.with_atlas(&atlas());
    let count = 1000;
    let lamps: Vec<LightSource> = (0..count)
        .map(|k| {
            // Evenly over the sphere: by height, and by golden steps around it.
            let height = 1.0 - 2.0 * (k as f32 + 0.5) / count as f32;
            let turn = TAU * (k as f32 * 0.618_034).fract();
            let level = (1.0 - height * height).sqrt();
            let (sine, cosine) = (downpour_math::ops::sin(turn), downpour_math::ops::cos(turn));
            shining(Vec3::new(level * cosine, height, level * sine))
        })
        .collect();
    let whole = mean(&masks, &scene(&lamps), 5.0, DropLightOptions::ATLAS)? * 4.0 * PI / count as f32;
    assert!((whole - 1.0).abs() < 0.06, "{whole}");
    Ok(())
}

/// A picture holds as much light as the drop's mean says, whether the streak has a width or not.
#[test]
fn a_streak_of_an_atlas_has_the_light_of_its_mean() -> Outcome {
    let traced = DropLightOptions::default();
    for pick in [StreakPick::ByAngle, StreakPick::Random] {
        let masks = DropMasks::trace(1.333)?.with_atlas(&atlas().with_pick(pick));
        let scene = scene(&[shining(Vec3::new(0.5, 0.3, -0.8).normalize())]);
        for away in [0.7, 6.0] {
            let light = |options, samples| -> Result<f32, Box<dyn std::error::Error>> {
                Ok(rows(&drawn(&masks, &scene, away, options, samples)?).iter().sum())
            };
            // The sky is black: lamps are all the light that there is.
            let whole = light(DropLightOptions::ATLAS, StreakSamples::Table)? / light(traced, SPHERE)?;
            let wanted =
                mean(&masks, &scene, 5.0, DropLightOptions::ATLAS)? / mean(&masks, &scene, 5.0, traced)?;
            assert!((whole / wanted - 1.0).abs() < 0.1, "{pick:?}, {away} m: {whole} for {wanted}");
        }
    }
    Ok(())
}

/// The drop swings while it falls: along its streak the light comes and goes, near and far, where that of a sphere is even.
#[test]
fn light_comes_and_goes_along_a_streak() -> Outcome {
    let masks = DropMasks::trace(1.333)?.with_atlas(&atlas());
    let scene = scene(&[shining(Vec3::new(0.5, 0.3, -0.8).normalize())]);
    for away in [0.7, 2.5] {
        let spread = |options, samples| -> Result<f32, Box<dyn std::error::Error>> {
            let rows = rows(&drawn(&masks, &scene, away, options, samples)?);
            let lit: Vec<f32> = rows.into_iter().filter(|&row| row > 0.0).collect();
            // Without both ends, which are lit in part.
            let inner = lit.get(3..lit.len() - 3).unwrap_or_default();
            let middle = inner.iter().sum::<f32>() / inner.len() as f32;
            let square = inner.iter().map(|row| (row - middle) * (row - middle)).sum::<f32>();
            Ok((square / inner.len() as f32).sqrt() / middle)
        };
        let atlas = spread(DropLightOptions::ATLAS, StreakSamples::Table)?;
        let sphere = spread(DropLightOptions::default(), SPHERE)?;
        assert!(atlas > 0.1 && atlas > 2.0 * sphere, "{away} m: {atlas} and {sphere}");
    }
    Ok(())
}

/// By chance, drops have other streaks than their angles say, and each keeps its own.
#[test]
fn chance_gives_each_drop_a_streak_of_its_own() -> Outcome {
    let masks = DropMasks::trace(1.333)?.with_atlas(&atlas().with_pick(StreakPick::Random).with_seed(3));
    let scene = scene(&[shining(Vec3::new(0.5, 0.3, -0.8).normalize())]);
    let of_drop = |id: u32| mean(&masks, &scene, id as f32, DropLightOptions::ATLAS);
    let mut found = Vec::new();
    for k in 0..50 {
        let id = rng_draw([1, 2], k, 0, 0)[0] >> 8;
        let light = of_drop(id)?;
        assert_eq!(light.to_bits(), of_drop(id)?.to_bits());
        found.push(light.to_bits());
    }
    found.sort_unstable();
    found.dedup();
    assert!(found.len() > 40, "{} of 50", found.len());
    Ok(())
}

#[test]
fn an_atlas_that_is_not_there_is_an_error() -> Outcome {
    let masks = DropMasks::trace(1.333)?;
    let error = mean(&masks, &scene(&[]), 0.0, DropLightOptions::ATLAS).unwrap_err();
    assert!(error.to_string().contains("number of streak atlases is 0"), "{error}");
    Ok(())
}
