//! Pictures in which rays of few pixels look for the light of sky and surfaces, for all of them: the light is the same.

use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_trace::SceneWetness;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::material::MaterialLook;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::WetnessAt;
use glam::{Affine3A, Vec3};

const SIZE: [u32; 2] = [96, 64];

const SPACINGS: [u32; 3] = [1, 2, 4];

fn look(albedo: f32, roughness: f32) -> MaterialLook {
    MaterialLook { base_color: [albedo, albedo, albedo, 1.0], roughness, ..MaterialLook::default() }
}

/// A square by its middle and half its edges; its front is toward their cross product.
fn square(builder: &mut SceneBuilder, material: u32, middle: Vec3, across: Vec3, along: Vec3) {
    let positions = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| (middle + across * x + along * y).to_array());
    let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

/// The mean over frames of other rays.
fn mean_picture(scene: &SceneData, view: &Viewpoint, spacing: u32, frames: u64) -> Vec<Vec3> {
    let mut sum = vec![Vec3::ZERO; (SIZE[0] * SIZE[1]) as usize];
    for seed in 0..frames {
        let frame = RenderFrame::new(scene, view, SIZE, 1, 1, seed).expect("a frame");
        let picture = SceneView { data: scene, frame: &frame.with_ray_spacing(spacing) }.picture();
        for (sum, [r, g, b, _]) in sum.iter_mut().zip(picture) {
            *sum += Vec3::new(r, g, b) / frames as f32;
        }
    }
    sum
}

/// Mean of what a part of the picture shows, over its green.
fn part(picture: &[Vec3], columns: std::ops::Range<u32>, rows: std::ops::Range<u32>) -> f32 {
    let count = (columns.len() * rows.len()) as f32;
    let sum: f32 =
        rows.flat_map(|y| columns.clone().map(move |x| picture[(y * SIZE[0] + x) as usize].y)).sum();
    sum / count
}

/// Open ground under an even sky gives back its albedo's part of it, whichever pixels have rays.
#[test]
fn open_ground_under_an_even_sky_is_the_same() {
    let mut builder = SceneBuilder::new();
    let material = builder.add_material(MaterialLook { ior: 1.0, ..look(0.5, 1.0) });
    square(&mut builder, material, Vec3::ZERO, Vec3::Z * 1000.0, Vec3::X * 1000.0);
    let scene = builder.build(&SkyLight::uniform([1.0; 3]));
    let view = Viewpoint { eye: Vec3::Y * 2.0, forward: Vec3::new(0.0, -1.0, -0.5), up: Vec3::Y, fov_y: 0.7 };
    for spacing in SPACINGS {
        for pixel in mean_picture(&scene, &view, spacing, 1) {
            assert!((pixel.y - 0.5).abs() < 0.01, "{spacing}: {pixel}");
        }
    }
}

/// A yard with walls, posts thinner than a few pixels, a lamp with a size, and gloss: parts of it have the same light in the mean.
#[test]
fn a_yard_has_the_same_light() {
    let mut builder = SceneBuilder::new();
    let [ground, wall, post] =
        [look(0.4, 0.35), look(0.7, 0.9), look(0.3, 0.6)].map(|look| builder.add_material(look));
    square(&mut builder, ground, Vec3::ZERO, Vec3::Z * 6.0, Vec3::X * 6.0);
    square(&mut builder, wall, Vec3::new(0.0, 2.0, -4.0), Vec3::X * 6.0, Vec3::Y * 2.0);
    square(&mut builder, wall, Vec3::new(-3.0, 2.0, 0.0), Vec3::NEG_Z * 6.0, Vec3::Y * 2.0);
    for k in 0..24 {
        let middle = Vec3::new(-0.5 + 0.1 * k as f32, 0.8, -2.0);
        square(&mut builder, post, middle, Vec3::X * 0.02, Vec3::Y * 0.8);
    }
    builder.add_light(LightSource::Point {
        radius: 0.2,
        position: Vec3::new(1.0, 3.0, -1.0),
        intensity: Vec3::splat(2.0),
        range: 0.0,
    });
    let mut scene = builder.build(&SkyLight::uniform([0.3; 3]));
    let view = Viewpoint {
        eye: Vec3::new(1.0, 1.5, 4.0),
        forward: Vec3::new(-0.1, -0.1, -1.0),
        up: Vec3::Y,
        fov_y: 0.7,
    };
    for is_wet in [false, true] {
        let at = WetnessAt { before: 1.0, kept: 1.0, since: 0.0 };
        scene
            .set_wetness(is_wet.then_some(SceneWetness { at, towards: Vec3::Y, shift: Vec3::ZERO }).as_ref());
        let [all, four, sixteen] = SPACINGS.map(|spacing| mean_picture(&scene, &view, spacing, 24));
        // All of it, the ground, the wall; the posts, which may have no such pixel, and have the light of what is beside them. The film
        // of wet ground finds its light in few of the rays: wider means of few of them tend to the dark.
        let wet = if is_wet { 2.0 } else { 1.0 };
        let places =
            [(0..96, 0..64, 1.0), (20..90, 50..64, wet), (30..90, 2..20, 1.0), (40..80, 26..44, 2.0)];
        for (columns, rows, allowed) in places {
            let light = |picture: &[Vec3]| part(picture, columns.clone(), rows.clone());
            let [four, sixteen] = [&four, &sixteen].map(|picture| light(picture) / light(&all) - 1.0);
            let is_same = four.abs() < 0.015 * allowed && sixteen.abs() < 0.03 * allowed;
            assert!(is_same, "{is_wet} {columns:?} {rows:?}: {four} {sixteen}");
        }
    }
}
