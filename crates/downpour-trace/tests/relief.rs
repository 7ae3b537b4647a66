//! Relief of maps of normals: what a pixel does not resolve of it makes its gloss rougher, so that a surface is as bright from near as from
//! far.

use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_shaders::bvh::BVH_FAR;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::material::{MaterialLook, TextureUse};
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use downpour_trace::surface::{surface_roughness, surface_turn};
use glam::{Affine3A, Vec2, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Texels of an edge of the map, and meters over which it repeats.
const EDGE: u32 = 128;
const METERS: f32 = 0.25;

/// Normals of slopes, as a file has them.
fn normals(slopes: &[Vec2]) -> Vec<[u8; 4]> {
    let byte = |v: f32| ((0.5 * v + 0.5) * 255.0).round() as u8;
    let texel = |slope: &Vec2| {
        let normal = slope.extend(1.0).normalize();
        [byte(normal.x), byte(normal.y), byte(normal.z), 255]
    };
    slopes.iter().map(texel).collect()
}

/// A level ground of 8 m with a relief, seen from above (+Y): +x of the map is +X, +y is -Z.
fn ground(slopes: &[Vec2], scale: f32, roughness: f32, lights: &[LightSource]) -> SceneData {
    let mut builder = SceneBuilder::new();
    let map = builder.texture(EDGE, EDGE, &normals(slopes), TextureUse::Normals);
    let map = builder.add_slot(map);
    let material = builder.add_material(MaterialLook {
        base_color: [0.0, 0.0, 0.0, 1.0],
        roughness,
        normal_scale: scale,
        maps: [None, None, Some(map), None, None, None, None, None],
        ..MaterialLook::default()
    });
    let positions =
        [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, z)| [x * 4.0, 0.0, z * 4.0f32]);
    let uvs = positions.map(|[x, _, z]| [x / METERS, -z / METERS]);
    let part = MeshPart {
        uvs: [Some(&uvs), None],
        tangents: Some(&[[1.0, 0.0, 0.0, 1.0]; 4]),
        ..MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material)
    };
    builder.add_mesh(&part, &Affine3A::IDENTITY);
    for light in lights {
        builder.add_light(*light);
    }
    builder.build(&SkyLight::uniform([0.0; 3]))
}

/// Slopes of a relief of waves that run in all directions, of a root mean square along each axis.
fn waves(deviation: f32) -> Vec<Vec2> {
    let count = 24u16;
    let wave = |k: u16| {
        let [x, y, phase, _] = rng_draw([3, 8], u32::from(k), 0, 0).map(rng_unit);
        // Whole numbers of waves, 4 to 16 of them.
        let turn = std::f32::consts::TAU;
        let (angle, number) = (turn * x, 4.0 + 12.0 * y);
        (Vec2::new(ops::cos(angle), ops::sin(angle)) * number).round().extend(turn * phase)
    };
    let waves: Vec<_> = (0..count).map(wave).collect();
    let amplitude = deviation * (4.0 / f32::from(count)).sqrt();
    let slope = |i: u32| {
        let at = Vec2::new((i % EDGE) as f32, (i / EDGE) as f32) / EDGE as f32;
        let of = |wave: &Vec3| {
            let along = wave.truncate();
            along / along.length() * ops::cos(along.dot(at) * std::f32::consts::TAU + wave.z)
        };
        waves.iter().map(of).sum::<Vec2>() * amplitude
    };
    (0..EDGE * EDGE).map(slope).collect()
}

/// A board of two slopes in turn has the mean of both, and the square of what is between them as its variance; one texel of it has its own
/// slope, and none.
#[test]
fn a_footprint_holds_the_variance_of_the_slopes() -> Outcome {
    let steep = Vec2::new(0.5, -0.25);
    let other = Vec2::new(-0.1, 0.35);
    let board: Vec<Vec2> = (0..EDGE * EDGE)
        .map(|i| if (i % EDGE + i / EDGE).is_multiple_of(2) { steep } else { other })
        .collect();
    for scale in [1.0, 0.5] {
        let scene = ground(&board, scale, 0.3, &[]);
        // The middle of a texel of the first slope.
        let texel = METERS / EDGE as f32;
        let at = Vec3::new(texel * 2.5, 1.0, -texel * 4.5);
        let hit = scene.surface_hit(at, -Vec3::Y, 1.0e-3, BVH_FAR).ok_or("no ground")?;
        let near = scene.surface_at(&hit, at, -Vec3::Y, 0.02 * texel, 8.0);
        let slope = |normal: Vec3| Vec2::new(normal.x, -normal.z) / normal.y;
        assert!((slope(near.normal) - steep * scale).length() < 0.02, "{:?}", near.normal);
        assert!(near.variance < 1.0e-3 && (near.roughness - 0.3).abs() < 0.01, "{near:?}");
        let far = scene.surface_at(&hit, at, -Vec3::Y, 40.0 * texel, 8.0);
        assert!((slope(far.normal) - (steep + other) * 0.5 * scale).length() < 0.02, "{:?}", far.normal);
        let half = (steep - other) * 0.5 * scale;
        let expected = half.dot(half);
        assert!((far.variance / expected - 1.0).abs() < 0.05, "{} of {expected}", far.variance);
        // 0.3^2 squared, and the variance, are the square of its alpha.
        let alpha = far.roughness * far.roughness;
        assert!((alpha * alpha - 0.0081 - far.variance).abs() < 1.0e-4, "{far:?}");
    }
    assert!((surface_roughness(0.0, 0.0625) - 0.5).abs() < 1.0e-6);
    assert!((surface_roughness(0.9, 2.0) - 1.0).abs() < f32::EPSILON);
    Ok(())
}

/// Flat stones with steep joints, a tenth of them, reflect far away as stones do: their lobe is that of most of the surface, not of the
/// variance of its slopes.
#[test]
fn flat_stones_with_steep_joints_have_a_narrow_lobe() -> Outcome {
    let stones: Vec<Vec2> = (0..EDGE * EDGE)
        .map(|i| {
            if i.is_multiple_of(10) {
                Vec2::new(if i.is_multiple_of(20) { 1.5 } else { -1.5 }, 0.0)
            } else {
                Vec2::ZERO
            }
        })
        .collect();
    let scene = ground(&stones, 1.0, 0.2, &[]);
    let hit = scene.surface_hit(Vec3::Y, -Vec3::Y, 1.0e-3, BVH_FAR).ok_or("no ground")?;
    let far = scene.surface_at(&hit, Vec3::Y, -Vec3::Y, 0.1, 8.0);
    assert!(far.variance < 1.0e-3 && (far.roughness - 0.2).abs() < 0.02, "{far:?}");
    Ok(())
}

/// A ball's pixel has the normals of a box of it: across, the angle that it spans; along, as much more as it is seen at an angle.
#[test]
fn a_bent_surface_turns_within_a_pixel() {
    // 10 degrees across 1 m, a pixel of 6 cm: slopes from -0.6 to 0.6 degrees are a variance of 0.6^2 / 3 degrees^2 along each axis.
    let across = (0.6f32.to_radians() * 0.6f32.to_radians()) / 3.0;
    let bend = 20.0f32.to_radians();
    assert!((surface_turn(bend, 0.06, 1.0) / (2.0 * across) - 1.0).abs() < 1.0e-3);
    assert!((surface_turn(bend, 0.06, -0.5) / (5.0 * across) - 1.0).abs() < 1.0e-3);
}

/// Means over the pixels of a picture of fewer pixels.
fn shrunk(picture: &[f64], edge: usize, fewer: usize) -> Vec<f64> {
    let each = edge / fewer;
    let pixel = |k: usize| {
        let of = |i: usize| picture[(k / fewer * each + i / each) * edge + k % fewer * each + i % each];
        (0..each * each).map(of).sum::<f64>() / (each * each) as f64
    };
    (0..fewer * fewer).map(pixel).collect()
}

/// A glossy ground of waves under a lamp looks in a picture of few pixels as one of many does from far away: in the mean, and pixel by pixel
/// but for what the waves under a pixel have of their own. From above and at a grazing angle. A ground of the same gloss without waves,
/// which the mean normals of those pixels are, is far from it.
#[test]
fn a_relief_looks_from_far_as_from_near() -> Outcome {
    let lamp = LightSource::Point {
        position: Vec3::new(0.0, 1.5, -1.5),
        radius: 0.0,
        intensity: Vec3::splat(10.0),
        range: 0.0,
    };
    let seen = |slopes: &[Vec2], eye: Vec3, edge: u32| -> Result<Vec<f64>, Box<dyn std::error::Error>> {
        let scene = ground(slopes, 1.0, 0.3, &[lamp]);
        let view = Viewpoint { eye, forward: -eye, up: Vec3::Y, fov_y: 0.6 };
        let frame = RenderFrame::new(&scene, &view, [edge; 2], 1, 0, 5)?;
        let picture = SceneView { data: &scene, frame: &frame }.picture();
        Ok(picture.iter().map(|pixel| f64::from(pixel[1])).collect())
    };
    let mean = |picture: &[f64]| picture.iter().sum::<f64>() / picture.len() as f64;
    let (flat, rough) = (vec![Vec2::ZERO; (EDGE * EDGE) as usize], waves(0.15));
    for eye in [Vec3::new(0.0, 1.5, 1.5), Vec3::new(0.0, 0.6, 2.2)] {
        let fine = seen(&rough, eye, 512)?;
        for edge in [64, 16, 8] {
            let wanted = shrunk(&fine, 512, edge);
            let error = |picture: &[f64]| {
                let squares = picture.iter().zip(&wanted).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
                (squares / picture.len() as f64).sqrt() / mean(&wanted)
            };
            let coarse = seen(&rough, eye, edge as u32)?;
            let (bias, error, control) =
                (mean(&coarse) / mean(&wanted) - 1.0, error(&coarse), error(&seen(&flat, eye, edge as u32)?));
            println!("{eye}, {edge} pixels: {bias:+.3}, {error:.3} (flat {control:.3})");
            assert!(bias.abs() < 0.1, "{eye}, {edge} pixels: {bias}");
            assert!(error < 0.4 * control, "{eye}, {edge} pixels: {error} of {control}");
        }
    }
    Ok(())
}
