//! Drops before a scene: their size, their light, their position.

use downpour_drop::DropShape;
use downpour_render::camera::Viewpoint;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::{DropMasks, RainOptions, RefractionForm};
use downpour_sim::field::{DropKind, FallingDrop};
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, DVec3, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const SIZE: [u32; 2] = [160, 120];

fn viewpoint() -> Viewpoint {
    Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.2 }
}

/// Pixels per unit of slope.
fn scale() -> f64 {
    f64::from(SIZE[1]) / (2.0 * downpour_math::ops::f64::tan(0.1))
}

fn drop_at(position: DVec3, diameter: f32) -> FallingDrop {
    let (velocity, present_s) = ([0.0, -4.0, 0.0], FallingDrop::ALWAYS);
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
    drops: &[FallingDrop],
    form: RefractionForm,
) -> Result<Picture, Box<dyn std::error::Error>> {
    let rain = RainOptions { form, capture_size: 128, capture_grid: 1, ..RainOptions::default() };
    let options =
        PictureOptions { size: SIZE, grid: 1, sky_rays: 0, seed: 0, rain, ..PictureOptions::default() };
    Ok(render_picture(scene, &viewpoint(), drops, &DropMasks::trace(1.333)?, &options)?)
}

fn sky(radiance: impl Fn(f32) -> [f32; 3]) -> SceneData {
    let map: Vec<[f32; 3]> = (0..64 * 32).map(|i| radiance(1.0 - (i / 64) as f32 / 15.5)).collect();
    SceneBuilder::new().build(&SkyLight::new(64, 32, &map))
}

/// Covered pixels, and the weighted middle of them.
fn covered(picture: &Picture) -> (f64, [f64; 2]) {
    let (mut area, mut position) = (0.0, [0.0; 2]);
    for (i, pixel) in picture.rain.iter().enumerate() {
        let fraction = f64::from(1.0 - pixel[3]);
        area += fraction;
        position[0] += fraction * ((i % SIZE[0] as usize) as f64 + 0.5);
        position[1] += fraction * ((i / SIZE[0] as usize) as f64 + 0.5);
    }
    (area, position.map(|p| p / area))
}

/// From 60 pixels across down to a tenth of one, wherever it falls: area pi a^2 over distance squared.
#[test]
fn a_sphere_covers_its_area_at_any_distance() -> Outcome {
    let scene = sky(|_| [1.0; 3]);
    let diameter = 0.4e-3f32;
    for pixels in [60.0, 20.0, 9.0, 3.0, 1.7, 1.1, 0.9, 0.5, 0.1] {
        let distance = f64::from(diameter) * scale() / pixels;
        for shift in [[0.0, 0.0], [0.3, 0.6], [0.5, 0.1]] {
            let offset = DVec3::new(shift[0] / scale(), shift[1] / scale(), -1.0) * distance;
            let (area, position) =
                covered(&picture(&scene, &[drop_at(offset, diameter)], RefractionForm::Direction)?);
            let expected = std::f64::consts::FRAC_PI_4 * pixels * pixels;
            assert!(
                (area / expected - 1.0).abs() < 0.05,
                "{pixels} pixels, {shift:?}: {area}, not {expected}"
            );
            let middle = [80.0 + shift[0], 60.0 - shift[1]];
            for k in 0..2 {
                assert!((position[k] - middle[k]).abs() < 0.06, "{pixels} pixels, {shift:?}: {position:?}");
            }
        }
    }
    Ok(())
}

/// A large drop is flattened: as wide and as tall as its shape says.
#[test]
fn a_large_drop_is_flat() -> Outcome {
    let scene = sky(|_| [1.0; 3]);
    let drop = drop_at(DVec3::new(0.0, 0.0, -0.1), 6.0e-3);
    let shown = picture(&scene, &[drop], RefractionForm::Direction)?;
    let inside = |i: usize| shown.rain[i][3] < 0.5;
    let width = (0..SIZE[0] as usize)
        .filter(|&x| (0..SIZE[1] as usize).any(|y| inside(y * SIZE[0] as usize + x)))
        .count();
    let height = (0..SIZE[1] as usize)
        .filter(|&y| (0..SIZE[0] as usize).any(|x| inside(y * SIZE[0] as usize + x)))
        .count();
    let shape = DropShape::new(6.0e-3)?;
    let pixels = |length: f64| length / 0.1 * scale();
    let wide = pixels(2.0 * shape.max_half_width());
    let tall = pixels(shape.extent_up() + shape.extent_down());
    assert!(tall < 0.75 * wide, "{wide} x {tall}");
    // A pixel counts from half covered, and a line across the middle of the drop may be one more.
    assert!(
        (width as f64 - wide).abs() < 1.6 && (height as f64 - tall).abs() < 1.6,
        "{width} x {height}, not {wide} x {tall}"
    );
    Ok(())
}

/// Light that comes through and light that is reflected add up to what is there: before uniform
/// surroundings drops cannot be seen.
#[test]
fn in_uniform_surroundings_drops_vanish() -> Outcome {
    let scene = sky(|_| [0.25, 0.5, 2.0]);
    let drops: Vec<FallingDrop> = (0..40)
        .map(|k| {
            let k = f64::from(k);
            let position =
                DVec3::new(0.11 * (k * 0.618).fract() - 0.055, 0.09 * (k * 0.755).fract() - 0.045, -1.0);
            drop_at(position * (0.05 + 0.02 * k), (0.3 + 0.14 * k as f32) * 1.0e-3)
        })
        .collect();
    let shown = picture(&scene, &drops, RefractionForm::Direction)?;
    let area = covered(&shown).0;
    assert!(area > 300.0, "{area}");
    for pixel in shown.radiance() {
        for (found, expected) in pixel.iter().zip([0.25, 0.5, 2.0]) {
            assert!((found / expected - 1.0).abs() < 1.0e-3, "{pixel:?}");
        }
    }
    Ok(())
}

/// So do crowns of splashes, at any stage and size.
#[test]
fn in_uniform_surroundings_splashes_vanish() -> Outcome {
    let scene = sky(|_| [0.25, 0.5, 2.0]);
    let crown = |k: u32| {
        let x = f64::from(k);
        let position =
            DVec3::new(0.11 * (x * 0.618).fract() - 0.055, 0.09 * (x * 0.755).fract() - 0.045, -1.0);
        let stage = 0.04 * k as f32 / 25.0;
        FallingDrop {
            position: position * (0.4 + 0.02 * x),
            velocity: [0.0; 3],
            diameter: 0.004 + 0.0003 * k as f32,
            id: u64::from(k),
            kind: DropKind::Splash,
            present_s: [-stage, 0.04 - stage],
            // On level ground, on slopes and on walls.
            normal: match k % 3 {
                0 => FallingDrop::LEVEL,
                1 => [0.6, 0.8, 0.0],
                _ => [0.28, 0.0, 0.96],
            },
        }
    };
    let crowns: Vec<FallingDrop> = (0..25).map(crown).collect();
    let rain = RainOptions { capture_size: 128, capture_grid: 1, ..RainOptions::default() };
    let options =
        PictureOptions { size: SIZE, grid: 1, sky_rays: 0, seed: 0, rain, ..PictureOptions::default() };
    let masks = DropMasks::trace(1.333)?.with_splashes(1.333)?;
    let shown = render_picture(&scene, &viewpoint(), &crowns, &masks, &options)?;
    let area = covered(&shown).0;
    assert!(area > 150.0, "{area}");
    for pixel in shown.radiance() {
        for (found, expected) in pixel.iter().zip([0.25, 0.5, 2.0]) {
            assert!((found / expected - 1.0).abs() < 1.0e-3, "{pixel:?}");
        }
    }
    Ok(())
}

/// A crown on a wall before an eye that lies on its side is the crown on level ground: they are seen from above in the same way.
#[test]
fn a_crown_on_a_wall_is_turned() -> Outcome {
    let scene = sky(|height| [1.0 + height; 3]);
    let (level, above) = (0.8, 0.6);
    let masks = DropMasks::trace(1.333)?.with_splashes(1.333)?;
    let shown = |normal: [f32; 3], up: Vec3| -> Result<Vec<f32>, Box<dyn std::error::Error>> {
        let crown = FallingDrop {
            position: DVec3::new(0.0, 0.0, -0.4),
            velocity: [0.0; 3],
            diameter: 0.03,
            id: 5,
            kind: DropKind::Splash,
            present_s: [-0.01, 0.03],
            normal,
        };
        let rain = RainOptions { capture_size: 128, capture_grid: 1, ..RainOptions::default() };
        let options =
            PictureOptions { size: SIZE, grid: 1, sky_rays: 0, seed: 0, rain, ..PictureOptions::default() };
        let picture = render_picture(&scene, &Viewpoint { up, ..viewpoint() }, &[crown], &masks, &options)?;
        Ok(picture.rain.iter().map(|pixel| 1.0 - pixel[3]).collect())
    };
    let ground = shown([0.0, level, above], Vec3::Y)?;
    let wall = shown([level, 0.0, above], Vec3::X)?;
    let slope = shown([0.48, 0.64, above], Vec3::new(0.6, 0.8, 0.0))?;
    assert!(ground.iter().sum::<f32>() > 500.0);
    let away = |other: &[f32]| {
        let differences: f32 = ground.iter().zip(other).map(|(a, b)| (a - b).abs()).sum();
        differences / ground.iter().sum::<f32>()
    };
    // The normal is kept to a thousandth.
    assert!(away(&wall) < 0.02 && away(&slope) < 0.02, "{} {}", away(&wall), away(&slope));
    assert!(away(&shown([0.0, level, above], Vec3::X)?) > 0.2);
    Ok(())
}

/// A bright sky over a dark ground: a drop shows the sky below and the ground above, in both forms.
#[test]
fn the_image_in_a_drop_is_upside_down() -> Outcome {
    let scene = sky(|height| if height > 0.0 { [1.0; 3] } else { [0.02; 3] });
    for form in [RefractionForm::Direction, RefractionForm::Rousseau2006] {
        let drop = drop_at(DVec3::new(0.0, 0.0, -0.02), 0.8e-3);
        let shown = picture(&scene, &[drop], form)?;
        let at = |row: usize| shown.rain[row * SIZE[0] as usize + 80][0];
        assert!(at(60 - 8) < 0.3 && at(60 + 8) > 0.7, "{form:?}: {} above, {} below", at(52), at(68));
    }
    Ok(())
}

/// A wall hides what is behind it and nothing that is before it.
#[test]
fn the_scene_hides_drops_behind_it() -> Outcome {
    let mut builder = SceneBuilder::new();
    let corners = [[-5.0, -5.0, -2.0], [5.0, -5.0, -2.0], [0.0, 9.0, -2.0]];
    let indices = [0, 1, 2];
    let wall = MeshPart::plain(&corners, &indices, 0);
    builder.add_mesh(&wall, &Affine3A::IDENTITY);
    let scene = builder.build(&SkyLight::uniform([1.0; 3]));
    let near = drop_at(DVec3::new(0.01, 0.0, -1.9), 1.0e-3);
    let far = drop_at(DVec3::new(-0.01, 0.0, -2.1), 1.0e-3);
    let shown = picture(&scene, &[far, near], RefractionForm::Direction)?;
    assert_eq!(shown.drawn, [1]);
    assert_eq!(shown.drops_on_screen, 2);
    let expected = std::f64::consts::FRAC_PI_4 * (1.0e-3 * scale() / 1.9) * (1.0e-3 * scale() / 1.9);
    let (area, position) = covered(&shown);
    assert!((area / expected - 1.0).abs() < 0.05 && position[0] > 80.0, "{area} at {position:?}");
    Ok(())
}

/// The same bits whatever the order of the drops in the list.
#[test]
fn the_order_of_drops_does_not_matter() -> Outcome {
    let scene = sky(|height| [height.max(0.0), 0.3, 0.1]);
    let mut drops: Vec<FallingDrop> = (0..60)
        .map(|k| {
            let k = f64::from(k);
            drop_at(DVec3::new(0.02 * (k * 0.618).fract() - 0.01, 0.001, -0.2 - 0.01 * k), 2.0e-3)
        })
        .collect();
    let first = picture(&scene, &drops, RefractionForm::Direction)?;
    drops.reverse();
    assert_eq!(picture(&scene, &drops, RefractionForm::Direction)?.rain, first.rain);
    Ok(())
}
