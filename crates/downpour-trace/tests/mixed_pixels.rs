//! Edges between surfaces in different light: a pixel shows each as far as it is in the pixel, in its own light.
#![expect(clippy::unwrap_used, reason = "a failed step is a failed test")]

use downpour_render::camera::Viewpoint;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::material::MaterialLook;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, Vec3};

const SIZE: [u32; 2] = [64, 48];

/// Pixels of the fine picture along an edge of one of the coarse.
const FINER: u32 = 8;

fn square(builder: &mut SceneBuilder, material: u32, middle: Vec3, across: Vec3, along: Vec3) {
    let positions = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| (middle + across * x + along * y).to_array());
    let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

/// Slanted bars in the open air, half a pixel and two pixels wide, before the dark inside of a shed: all of one material.
fn shed() -> SceneData {
    let mut builder = SceneBuilder::new();
    let paint = MaterialLook {
        base_color: [0.6, 0.6, 0.6, 1.0],
        roughness: 1.0,
        ior: 1.0,
        ..MaterialLook::default()
    };
    let paint = builder.add_material(paint);
    let deep = Vec3::NEG_Z * 6.0;
    square(&mut builder, paint, deep, Vec3::X * 4.0, Vec3::Y * 3.0);
    for side in [-1.0, 1.0] {
        square(&mut builder, paint, deep * 0.5 + Vec3::X * (4.0 * side), Vec3::Z * 3.0, Vec3::Y * 3.0);
        square(&mut builder, paint, deep * 0.5 + Vec3::Y * (3.0 * side), Vec3::X * 4.0, Vec3::Z * 3.0);
    }
    let (sine, cosine) = (0.3, 0.954);
    for k in 0..8u8 {
        let middle = Vec3::new(f32::from(k) * 0.5 - 1.75, 0.0, 0.5);
        let half = if k % 2 == 0 { 0.02 } else { 0.08 };
        square(
            &mut builder,
            paint,
            middle,
            Vec3::new(cosine, sine, 0.0) * half,
            Vec3::new(-sine, cosine, 0.0),
        );
    }
    builder.build(&SkyLight::uniform([1.0; 3]))
}

/// Green of the mean of pictures with other rays.
fn picture(scene: &SceneData, size: [u32; 2], grid: u32, seeds: u64) -> Vec<f32> {
    let view = Viewpoint { eye: Vec3::new(0.3, 0.2, 6.0), forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.7 };
    let mut sum = vec![0.0; (size[0] * size[1]) as usize];
    for seed in 0..seeds {
        let frame = RenderFrame::new(scene, &view, size, grid, 1, seed).unwrap();
        for (sum, pixel) in sum.iter_mut().zip(SceneView { data: scene, frame: &frame }.picture()) {
            *sum += pixel[1] / seeds as f32;
        }
    }
    sum
}

#[test]
fn each_surface_of_a_pixel_has_its_own_light() {
    let scene = shed();
    let fine = picture(&scene, SIZE.map(|n| n * FINER), 1, 3);
    let mean = |x: u32, y: u32| {
        let row = |k: u32| (y * FINER + k / FINER) * SIZE[0] * FINER + x * FINER + k % FINER;
        (0..FINER * FINER).map(|k| fine[row(k) as usize]).sum::<f32>() / (FINER * FINER) as f32
    };
    for (grid, most) in [(2, 0.09), (4, 0.05)] {
        let coarse = picture(&scene, SIZE, grid, 8);
        // Where the bars are.
        let (mut squares, mut sums, mut spread) = (0.0, [0.0; 2], 0.0);
        for (x, y) in (16..30).flat_map(|y| (14..50).map(move |x| (x, y))) {
            let (expected, found) = (mean(x, y), coarse[(y * SIZE[0] + x) as usize]);
            squares += (found - expected) * (found - expected);
            spread += expected * expected;
            sums[0] += expected;
            sums[1] += found;
        }
        let error = (squares / spread).sqrt();
        println!("{grid}: error {error}, mean {}", sums[1] / sums[0]);
        assert!(error < most, "{grid}: {error}");
        assert!((sums[1] / sums[0] - 1.0).abs() < 0.03, "{grid}: {sums:?}");
    }
}
