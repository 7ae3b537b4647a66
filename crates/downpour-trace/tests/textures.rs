//! Textures under the camera's pixels: what a pixel shows is the mean of what it sees, from any angle and by any coordinates.
#![expect(clippy::unwrap_used, reason = "a failed step is a failed test")]

use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::scene::TEXTURE_TAPS;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::material::{MaterialLook, TextureUse};
use downpour_trace::sky_light::SkyLight;
use glam::{Affine2, Affine3A, Mat2, Vec2, Vec3};

/// Texels of an edge of the texture, and meters over which it repeats.
const EDGE: u32 = 256;
const METERS: f32 = 4.0;

/// Width of a pixel's cone at 1 m.
const CONE: f32 = 1.0e-3;

/// Height of the eye, m.
const EYE: f32 = 10.0;

/// A ground of black and white texels. Its coordinates are those of the world, moved by `coordinates`, which the slot's transform
/// takes back; in the second set of coordinates if `second`.
fn ground(texels: &[f32], coordinates: Affine2, second: bool) -> SceneData {
    let mut builder = SceneBuilder::new();
    let bytes: Vec<[u8; 4]> = texels.iter().map(|&v| [(v * 255.0) as u8, 0, 0, 255]).collect();
    let mut slot = builder.texture(EDGE, EDGE, &bytes, TextureUse::Data);
    let back = coordinates.inverse();
    slot.matrix =
        [back.matrix2.x_axis.x, back.matrix2.y_axis.x, back.matrix2.x_axis.y, back.matrix2.y_axis.y];
    slot.offset = back.translation.to_array();
    slot.uv_set = second.into();
    let map = builder.add_slot(slot);
    let maps = [Some(map), None, None, None, None, None, None, None];
    let material = builder.add_material(MaterialLook { maps, ..MaterialLook::default() });
    let corners = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let positions = corners.map(|(x, z)| [x * 256.0, 0.0, z * 256.0]);
    let uvs = positions.map(|[x, _, z]| coordinates.transform_point2(Vec2::new(x, z) / METERS).to_array());
    let nothing = [[0.25f32, 0.5]; 4];
    let uvs = if second { [Some(&nothing[..]), Some(&uvs[..])] } else { [Some(&uvs[..]), None] };
    let part = MeshPart { uvs, ..MeshPart::plain(&positions, &[0, 2, 1, 0, 3, 2], material) };
    builder.add_mesh(&part, &Affine3A::IDENTITY);
    builder.build(&SkyLight::uniform([1.0; 3]))
}

/// Direction of a ray that goes down by an angle, turned about the vertical.
fn ray(down: f32, turn: f32) -> Vec3 {
    let (down, turn) = (down.to_radians(), turn.to_radians());
    let level = ops::cos(down);
    Vec3::new(level * ops::sin(turn), -ops::sin(down), -level * ops::cos(turn))
}

/// Red of the ground that a pixel sees, with `taps` samples.
fn seen(scene: &SceneData, eye: Vec3, direction: Vec3, taps: f32) -> f32 {
    let hit = scene.surface_hit(eye, direction, 1.0e-3, BVH_FAR).unwrap();
    scene.surface_at(&hit, eye, direction, CONE, taps).diffuse.x
}

/// The mean of the squares over what a pixel sees, by 32 x 32 rays through it.
fn mean(eye: Vec3, direction: Vec3) -> f32 {
    let right = direction.cross(Vec3::Y).normalize();
    let up = right.cross(direction);
    let mut sum = 0.0;
    for k in 0..1024u16 {
        let [x, y] = [k % 32, k / 32].map(|i| (f32::from(i) + 0.5) / 32.0 - 0.5);
        let towards = direction + (right * x + up * y) * CONE;
        let at = eye - towards * (eye.y / towards.y);
        sum += square(at.x / METERS, at.z / METERS);
    }
    sum / 1024.0
}

/// Squares along an edge of the texture: no whole number of texels, as nothing is in a texture of the world.
const SQUARES: u32 = 53;

/// A square, black or white by chance, at coordinates of which the texture takes 0 to 1.
fn square(u: f32, v: f32) -> f32 {
    let [x, y] = [u, v].map(|at| ((at - at.floor()) * SQUARES as f32) as u32);
    rng_unit(rng_draw([7, 7], x, y, 0)[0]).round()
}

/// The texels of the squares: means over 8 x 8 places.
fn random_texels() -> Vec<f32> {
    let texel = |i: u32| {
        let places = (0..64u32).map(|k| {
            let [x, y] = [i % EDGE, i / EDGE].map(|at| at as f32);
            let [dx, dy] = [k % 8, k / 8].map(|at| (at as f32 + 0.5) / 8.0);
            square((x + dx) / EDGE as f32, (y + dy) / EDGE as f32)
        });
        places.sum::<f32>() / 64.0
    };
    (0..EDGE * EDGE).map(texel).collect()
}

/// Root of the mean squared error of pixels, and the standard deviation of their means.
fn errors(scene: &SceneData, down: f32, taps: f32) -> (f32, f32) {
    let (mut squares, mut sum, mut square_sum) = (0.0, 0.0, 0.0);
    let count = 400u16;
    for k in 0..count {
        let eye = Vec3::new(f32::from(k) * 0.13, EYE, f32::from(k % 17) * 0.29);
        let direction = ray(down, f32::from(k % 90) * 4.0);
        let expected = mean(eye, direction);
        let error = seen(scene, eye, direction, taps) - expected;
        squares += error * error;
        sum += expected;
        square_sum += expected * expected;
    }
    let count = f32::from(count);
    ((squares / count).sqrt(), (square_sum / count - (sum / count) * (sum / count)).sqrt())
}

#[test]
fn a_pixel_shows_the_mean_of_what_it_sees() {
    let texels = random_texels();
    let scene = ground(&texels, Affine2::IDENTITY, false);
    for (down, most) in [(60.0, 0.2), (30.0, 0.1), (15.0, 0.08), (8.0, 0.15)] {
        let (error, contrast) = errors(&scene, down, TEXTURE_TAPS);
        let (alone, _) = errors(&scene, down, 1.0);
        println!("{down}: {error} of {contrast}, with one sample {alone}");
        assert!(error < most * contrast, "{down}: {error} of {contrast}");
        assert!(error < 1.02 * alone, "{down}: {error} against {alone}");
    }
}

#[test]
fn coordinates_may_be_turned_and_of_either_set() {
    let texels = random_texels();
    let plain = ground(&texels, Affine2::IDENTITY, false);
    let turned = Affine2 {
        matrix2: Mat2::from_angle(0.7) * Mat2::from_diagonal(Vec2::new(3.0, -0.5)),
        translation: Vec2::new(0.3, 0.8),
    };
    for second in [false, true] {
        let scene = ground(&texels, turned, second);
        for k in 0..60u16 {
            let eye = Vec3::new(f32::from(k) * 0.13, EYE, 0.2);
            let direction = ray(5.0 + f32::from(k), f32::from(k) * 6.0);
            let [a, b] = [&plain, &scene].map(|scene| seen(scene, eye, direction, TEXTURE_TAPS));
            assert!((a - b).abs() < 2.0e-3, "{k}: {a} against {b}");
        }
    }
}

#[test]
fn stripes_along_the_view_stay_at_grazing_angles() {
    // 0.25 m wide: 16 texels.
    let stripes: Vec<f32> = (0..EDGE * EDGE).map(|i| (i % EDGE / 16 % 2) as f32).collect();
    let scene = ground(&stripes, Affine2::IDENTITY, false);
    let contrast = |down: f32, turn: f32, taps: f32| {
        let values = (0..200u16).map(|k| {
            let eye = Vec3::new(f32::from(k) * 0.0371, 1.5, f32::from(k) * 0.0371);
            seen(&scene, eye, ray(down, turn), taps)
        });
        let (low, high) = values.fold((1.0f32, 0.0f32), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    };
    // 28 m away a pixel is 3 cm wide and 0.5 m long.
    assert!(contrast(3.0, 0.0, TEXTURE_TAPS) > 0.95, "{}", contrast(3.0, 0.0, TEXTURE_TAPS));
    // With one sample they begin to go there, and are gone where more of them still show them.
    assert!(contrast(3.0, 0.0, 1.0) < 0.7, "{}", contrast(3.0, 0.0, 1.0));
    assert!(contrast(2.0, 0.0, TEXTURE_TAPS) > 0.8, "{}", contrast(2.0, 0.0, TEXTURE_TAPS));
    assert!(contrast(2.0, 0.0, 1.0) < 0.2, "{}", contrast(2.0, 0.0, 1.0));
    // Across the view they are shorter than the pixel.
    assert!(contrast(3.0, 90.0, TEXTURE_TAPS) < 0.35, "{}", contrast(3.0, 90.0, TEXTURE_TAPS));
}
