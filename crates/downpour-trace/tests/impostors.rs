//! Reflections on wet surfaces by impostors, in the form of Tatarchuk & Isidoro 2006.

#![expect(clippy::cast_precision_loss, reason = "rows and columns of small pictures")]

use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_trace::SceneWetness;
use downpour_trace::billboards::Impostors;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::impostor::draw::impostor_draw_cover;
use downpour_trace::impostor::{impostor_attenuation, list};
use downpour_trace::material::MaterialLook;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::WetnessAt;
use glam::{Affine3A, Vec2, Vec3};
use std::sync::Arc;

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

const SIZE: [u32; 2] = [160, 120];

/// Height of the ground.
const GROUND_M: f32 = 2.0;

const LAMP: Vec3 = Vec3::new(1.0, GROUND_M + 3.0, -8.0);

const RED: Vec3 = Vec3::new(8.0, 2.0, 1.0);

fn view() -> Viewpoint {
    let eye = Vec3::new(0.0, GROUND_M + 1.5, 4.0);
    Viewpoint { eye, forward: Vec3::new(0.0, -0.15, -1.0), up: Vec3::Y, fov_y: 0.9 }
}

/// A rectangle by its middle and half its edges.
fn rectangle(builder: &mut SceneBuilder, look: MaterialLook, middle: Vec3, across: Vec3, along: Vec3) {
    let material = builder.add_material(look);
    let positions = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| (middle + across * x + along * y).to_array());
    let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

/// Rough ground under a dark sky.
fn street() -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    let look = MaterialLook {
        base_color: [0.1, 0.1, 0.1, 1.0],
        roughness: 0.9,
        porosity: Some(0.9),
        ..MaterialLook::default()
    };
    rectangle(&mut builder, look, Vec3::Y * GROUND_M, Vec3::Z * 60.0, Vec3::X * 60.0);
    builder
}

fn lamp(builder: &mut SceneBuilder) {
    builder.add_light(LightSource::Point { position: LAMP, radius: 0.15, intensity: RED, range: 0.0 });
}

/// The scene, wet, with billboards.
fn wet(builder: SceneBuilder, edge: f32) -> Outcome<SceneData> {
    let mut scene = builder.build(&SkyLight::uniform([1.0e-3; 3]));
    let at = WetnessAt { before: 30.0, kept: 1.0, since: 0.0 };
    scene.set_wetness(Some(&SceneWetness { at, towards: Vec3::Y, shift: Vec3::ZERO }));
    scene.impostors = Some(list::find(&scene, &view(), edge, None)?);
    Ok(scene)
}

fn picture(scene: &SceneData) -> Outcome<Vec<[f32; 4]>> {
    let frame = RenderFrame::new(scene, &view(), SIZE, 1, 1, 5)?;
    Ok(SceneView { data: scene, frame: &frame }.picture())
}

/// Rows and columns by the light of a picture that another one does not have, from the top left.
fn middle_of(with: &[[f32; 4]], without: &[[f32; 4]]) -> Vec2 {
    let mut sum = Vec2::ZERO;
    let mut all = 0.0;
    for (k, (a, b)) in with.iter().zip(without).enumerate() {
        let weight = (a[0] - b[0]).max(0.0);
        let (x, y) = (k as u32 % SIZE[0], k as u32 / SIZE[0]);
        sum += Vec2::new(x as f32 + 0.5, y as f32 + 0.5) * weight;
        all += weight;
    }
    sum / all
}

#[test]
fn a_lamp_is_mirrored_below_itself_and_stretched_toward_the_viewer() -> Outcome {
    let mut lit = street();
    lamp(&mut lit);
    let lit = wet(lit, 0.0)?;
    let impostors = lit.impostors.as_ref().ok_or("no billboards")?;
    assert_eq!(impostors.billboards.len(), 1);
    let mirrored = Vec3::new(LAMP.x, 2.0 * GROUND_M - LAMP.y, LAMP.z);
    assert!(impostors.billboards[0].center.distance(mirrored) < 1.0e-4);
    // The same light without its billboard.
    let mut bare = Impostors::clone(impostors);
    bare.billboards.clear();
    let bare = SceneData { impostors: Some(Arc::new(bare)), ..lit.clone() };
    let (with, without) = (picture(&lit)?, picture(&bare)?);
    let found = middle_of(&with, &without);
    let camera = view().camera(SIZE, 0)?;
    let place = camera.camera_project(mirrored - view().eye);
    assert!((found.x - place.x).abs() < 2.0, "{found} {place}");
    // A tail that fades over 0.12 rad has its middle at a third of it.
    let tail = 0.12 / camera.pixel_angle;
    let below = (found.y - place.y) / tail;
    assert!((0.2..0.5).contains(&below), "{below}");
    Ok(())
}

#[test]
fn colors_are_more_saturated_and_as_bright() -> Outcome {
    let mut lit = street();
    lamp(&mut lit);
    let lit = wet(lit, 0.0)?;
    let light = lit.impostors.as_ref().ok_or("no billboards")?.billboards[0].radiance;
    let luminance = |c: Vec3| downpour_math::color::color_luminance(c.to_array());
    // Intensity over the area of the lamp's disk, seen from the ground with nothing between.
    let own = RED / (std::f32::consts::PI * 0.15 * 0.15);
    assert!((luminance(light) / luminance(own) - 1.0).abs() < 1.0e-3, "{light} {own}");
    assert!(light.x / light.y > 1.2 * own.x / own.y, "{light}");
    Ok(())
}

#[test]
fn what_the_ground_does_not_see_is_not_mirrored() -> Outcome {
    let mut hidden = street();
    lamp(&mut hidden);
    // A wall before the lamp, which stands on the ground, and ends below the eye's own ray to the lamp.
    let wall = MaterialLook {
        flags: downpour_shaders::render::scene::SCENE_DOUBLE_SIDED,
        ..MaterialLook::default()
    };
    rectangle(&mut hidden, wall, Vec3::new(1.0, GROUND_M + 1.45, -7.0), Vec3::X * 3.0, Vec3::Y * 1.45);
    let hidden = wet(hidden, 0.0)?;
    assert!(hidden.impostors.is_some_and(|found| found.billboards.is_empty()));
    Ok(())
}

#[test]
fn triangles_that_shine_and_touch_are_one_billboard() -> Outcome {
    let mut signs = street();
    let shining = |red: f32| MaterialLook { emission: [red, 1.0, 1.0], ..MaterialLook::default() };
    let (across, up) = (Vec3::X * 0.8, Vec3::Y * 0.4);
    rectangle(&mut signs, shining(5.0), Vec3::new(-2.0, GROUND_M + 2.0, -6.0), across, up);
    rectangle(&mut signs, shining(3.0), Vec3::new(2.0, GROUND_M + 2.0, -6.0), across, up);
    let signs = wet(signs, 0.0)?;
    let found = signs.impostors.as_ref().ok_or("no billboards")?;
    assert_eq!(found.billboards.len(), 2);
    for billboard in &found.billboards {
        assert!((billboard.half.y - 0.4).abs() < 1.0e-4, "{billboard:?}");
        assert!((billboard.center.y - (GROUND_M - 2.0)).abs() < 1.0e-4, "{billboard:?}");
    }
    // Found again for the same scene and eye, and anew for another.
    let again = list::find(&signs, &view(), 0.0, Some(found))?;
    assert!(Arc::ptr_eq(&again, found));
    let moved = Viewpoint { eye: view().eye + Vec3::X, ..view() };
    assert!(!Arc::ptr_eq(&list::find(&signs, &moved, 0.0, Some(found))?, found));
    Ok(())
}

#[test]
fn a_stretched_billboard_gives_as_much_as_it_would_without() {
    for half in [Vec2::new(3.0, 2.0), Vec2::new(0.2, 0.1), Vec2::new(0.01, 6.0)] {
        for stretch in [24.0, 60.0] {
            let rows = (-40i8..=80).flat_map(|y| (-10i8..=10).map(move |x| [x, y].map(f32::from)));
            let sum: f32 =
                rows.map(|at| impostor_draw_cover(Vec2::from(at) + Vec2::new(0.3, 0.1), half, stretch)).sum();
            let area = 4.0 * half.x * half.y;
            assert!((sum / area - 1.0).abs() < 0.12, "{half} {stretch}: {}", sum / area);
        }
    }
}

#[test]
fn reflections_are_less_toward_edges_as_the_paper_says() -> Outcome {
    // ka = saturate(1 - f^2), f = (1 - n.v) f0.
    for (cosine, edge, factor) in [(1.0, 9.0, 1.0), (0.5, 1.0, 0.75), (0.0, 1.0, 0.0), (0.2, 3.0, 0.0)] {
        assert!((impostor_attenuation(cosine, edge) - factor).abs() < 1.0e-6, "{cosine} {edge}");
    }
    let light = |edge: f32| -> Outcome<f32> {
        let mut lit = street();
        lamp(&mut lit);
        Ok(picture(&wet(lit, edge)?)?.iter().map(|pixel| pixel[0]).sum())
    };
    let (all, less, none) = (light(0.0)?, light(1.0)?, light(10.0)?);
    assert!(all > 1.1 * less && less > none, "{all} {less} {none}");
    Ok(())
}

#[test]
fn what_is_dry_is_as_it_is_without_billboards() -> Outcome {
    let mut dry = street();
    lamp(&mut dry);
    let dry = dry.build(&SkyLight::uniform([0.2; 3]));
    let mut with = dry.clone();
    with.impostors = Some(list::find(&dry, &view(), 0.5, None)?);
    assert_eq!(picture(&dry)?, picture(&with)?);
    Ok(())
}

#[test]
fn an_eye_that_looks_straight_down_has_impostors() -> Outcome {
    let mut lit = street();
    lamp(&mut lit);
    let lit = lit.build(&SkyLight::uniform([0.2; 3]));
    let down = Viewpoint { forward: Vec3::NEG_Y, up: Vec3::NEG_Z, ..view() };
    let found = list::find(&lit, &down, 0.5, None)?;
    assert_eq!(found.billboards.len(), 1);
    assert!(found.environment.iter().all(|light| light.is_finite() && light.min_element() >= 0.0));
    Ok(())
}
