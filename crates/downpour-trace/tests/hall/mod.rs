//! A hall that is lit through a hole in its roof, as frames show it.

use downpour_render::camera::Viewpoint;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::material::MaterialLook;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, Vec3};

/// Columns and rows of its pictures.
pub(crate) const SIZE: [u32; 2] = [72, 48];

/// A square by its middle and half its edges; its front is toward their cross product.
fn square(builder: &mut SceneBuilder, material: u32, middle: Vec3, across: Vec3, along: Vec3) {
    let positions = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| (middle + across * x + along * y).to_array());
    let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

/// A hall whose only light comes through a hole in its roof, under a sky of a radiance; a board stands in it at a place.
pub(crate) fn hall(sky: f32, board: f32) -> SceneData {
    let mut builder = SceneBuilder::new();
    let look = |albedo: f32| MaterialLook {
        base_color: [albedo, albedo, albedo, 1.0],
        roughness: 1.0,
        ..MaterialLook::default()
    };
    let walls = builder.add_material(look(0.6));
    let dark = builder.add_material(look(0.1));
    square(&mut builder, walls, Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0);
    square(&mut builder, walls, Vec3::new(0.0, 1.5, -4.0), Vec3::X * 4.0, Vec3::Y * 1.5);
    square(&mut builder, walls, Vec3::new(-4.0, 1.5, 0.0), Vec3::NEG_Z * 4.0, Vec3::Y * 1.5);
    square(&mut builder, walls, Vec3::new(4.0, 1.5, 0.0), Vec3::Z * 4.0, Vec3::Y * 1.5);
    square(&mut builder, walls, Vec3::new(0.0, 1.5, 4.0), Vec3::NEG_X * 4.0, Vec3::Y * 1.5);
    // The roof leaves a strip open.
    square(&mut builder, walls, Vec3::new(-1.0, 3.0, 0.0), Vec3::X * 3.0, Vec3::Z * 4.0);
    square(&mut builder, dark, Vec3::new(board, 0.8, -1.0), Vec3::X * 0.4, Vec3::Y * 0.8);
    builder.build(&SkyLight::uniform([sky; 3]))
}

pub(crate) fn eye(step: f32) -> Viewpoint {
    let eye = Vec3::new(-1.0 + step, 1.4, 3.2);
    Viewpoint { eye, forward: Vec3::new(0.1, -0.2, -1.0), up: Vec3::Y, fov_y: 0.9 }
}

pub(crate) fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

pub(crate) fn mean_picture(pictures: &[Vec<f32>]) -> Vec<f32> {
    let of = |k: usize| pictures.iter().map(|picture| picture[k]).sum::<f32>() / pictures.len() as f32;
    (0..pictures[0].len()).map(of).collect()
}

/// Root of the mean square of the differences of two pictures, over their mean.
pub(crate) fn apart(a: &[f32], b: &[f32]) -> f32 {
    let squares: Vec<f32> = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).collect();
    mean(&squares).sqrt() / mean(a)
}
