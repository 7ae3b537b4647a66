//! Light of lamps and sun on drops: its amount, its direction, its colors, its shadows.

use std::f32::consts::PI;

use downpour_drop::optics::{SCATTERING_ORDERS, scattered_fraction};
use downpour_math::ops;
use downpour_render::RenderError;
use downpour_render::camera::{Camera, Viewpoint};
use downpour_render::light::LightSource;
use downpour_render::rain::glint::{
    drop_glint_image, drop_glint_pack, drop_glint_pixel, drop_glint_right, drop_glint_side, drop_glint_unpack,
};
use downpour_render::rain::light::{DropLightForm, DropLightOptions, DropLightTable, DropLights};
use downpour_render::rain::{EnvironmentFrame, RainOptions};
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::capture::trace_environment;
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, Vec2, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const RADIUS: f32 = 1.0e-3;

fn scene(lights: &[LightSource], wall: Option<Vec3>) -> SceneData {
    let mut builder = SceneBuilder::new();
    for &light in lights {
        builder.add_light(light);
    }
    if let Some(at) = wall {
        // A square of 1 m that stands across z.
        let positions = [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]];
        let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], 0);
        builder.add_mesh(&part, &Affine3A::from_translation(at));
    }
    builder.build(&SkyLight::new(16, 8, &[[0.0; 3]; 16 * 8]))
}

fn frame(scene: &SceneData, eye: Vec3) -> Result<RenderFrame, RenderError> {
    let forward = if eye == Vec3::ZERO { Vec3::NEG_Z } else { -eye };
    RenderFrame::new(scene, &Viewpoint { eye, forward, up: Vec3::Y, fov_y: 0.9 }, [64, 64], 1, 0, 0)
}

/// The mean radiance of a drop in the origin.
fn mean(
    lights: &[LightSource],
    eye: Vec3,
    form: DropLightForm,
    table: &DropLightTable,
) -> Result<Vec3, RenderError> {
    let scene = scene(lights, None);
    let frame = frame(&scene, eye)?;
    let view = SceneView { data: &scene, frame: &frame };
    let lights = DropLights::new(&view, frame.camera.eye, table, DropLightOptions { form, glints: 0 })?;
    let light = lights.light(&[[0.0, 0.0, 0.0, RADIUS]]);
    assert_eq!((light.len(), light[0][3]), (1, 0.0));
    Ok(Vec3::new(light[0][0], light[0][1], light[0][2]))
}

fn lamp(position: Vec3, intensity: Vec3) -> LightSource {
    LightSource::Point { radius: 0.0, position, intensity, range: 0.0 }
}

/// A direction at an angle in degrees from another, in a plane that does not lie along any axis.
fn turned(from: Vec3, degrees: f32) -> Vec3 {
    let aside = from.cross(Vec3::new(0.3, 0.5, -0.8)).normalize();
    from * ops::cos(degrees.to_radians()) + aside * ops::sin(degrees.to_radians())
}

/// The light of a drop, summed over all eyes around it, is what it takes out of the light, but for orders above 3.
#[test]
fn no_light_is_lost_or_made() -> Outcome {
    let indices = [1.3315, 1.3345, 1.3385];
    let table = DropLightTable::new(indices, 0.009)?;
    let direction = Vec3::new(0.3, -0.8, 0.2).normalize();
    let irradiance = Vec3::new(2.0, 1.0, 0.5);
    let scene = scene(&[LightSource::Directional { direction, irradiance }], None);
    let start = frame(&scene, Vec3::ONE)?;
    let steps = 3000u16;
    let mut sum = Vec3::ZERO;
    for k in 0..steps {
        let angle = PI * (f32::from(k) + 0.5) / f32::from(steps);
        let eye = turned(direction, angle.to_degrees()) * 3.0;
        let frame = RenderFrame { camera: Camera { eye, ..start.camera }, ..start };
        let light = DropLights::new(
            &SceneView { data: &scene, frame: &frame },
            frame.camera.eye,
            &table,
            DropLightOptions::default(),
        )?
        .light(&[[0.0, 0.0, 0.0, RADIUS]])[0];
        let ring = 2.0 * PI * ops::sin(angle) * PI / f32::from(steps);
        // Radiance times the disk's area, over all directions, over the power on the disk.
        sum += Vec3::new(light[0], light[1], light[2]) * ring / irradiance;
    }
    for (found, index) in sum.to_array().into_iter().zip(indices) {
        let expected =
            (0..SCATTERING_ORDERS).map(|p| scattered_fraction(index, p)).sum::<Result<f64, _>>()?;
        assert!((f64::from(found) / expected - 1.0).abs() < 2.0e-3, "{found} for {expected}");
    }
    Ok(())
}

/// Rain shows before a lamp and hides beside it: why it is seen in headlights that come, and under street lamps.
#[test]
fn drops_shine_before_a_lamp_and_not_beside_it() -> Outcome {
    let table = DropLightTable::water()?;
    let eye = Vec3::new(0.0, 0.0, 4.0);
    let onward = -eye / 4.0;
    let of = |degrees: f32| {
        let light = lamp(turned(onward, degrees) * 5.0, Vec3::splat(100.0));
        mean(&[light], eye, DropLightForm::Traced, &table)
    };
    let (behind, beside, at_back) = (of(20.0)?.y, of(90.0)?.y, of(180.0)?.y);
    let ratio = behind / beside;
    assert!((200.0..400.0).contains(&ratio), "{ratio}");
    // Onward, through the middle n^2 / (4 (n - 1)^2) (1 - R)^2 / pi, and 1 / (4 pi) mirrored at the rim, of 4 lux.
    let onward_phase = of(0.0)?.y / 4.0;
    let (n, kept): (f32, f32) = (1.3345, 0.96);
    let law = n * n / (4.0 * (n - 1.0) * (n - 1.0)) * kept / PI + 0.25 / PI;
    assert!((onward_phase / law - 1.0).abs() < 0.02, "{onward_phase} for {law}");
    assert!(at_back > beside && at_back < 0.1 * behind, "{at_back}, {beside}, {behind}");
    Ok(())
}

#[test]
fn the_bow_is_red_outside() -> Outcome {
    let table = DropLightTable::water()?;
    let eye = Vec3::new(0.0, 0.0, 4.0);
    let of = |radius: f32| {
        let sun =
            LightSource::Directional { direction: turned(Vec3::Z, 180.0 - radius), irradiance: Vec3::ONE };
        mean(&[sun], eye, DropLightForm::Traced, &table)
    };
    let (outside, inside, dark) = (of(42.4)?, of(40.9)?, of(46.0)?);
    assert!(outside.x > 1.3 * outside.z, "{outside}");
    assert!(inside.z > 1.3 * inside.x, "{inside}");
    assert!(dark.max_element() < 0.2 * outside.x, "{dark} beside {outside}");
    Ok(())
}

/// The outside mirrors where the normal halves the angle between lamp and eye; a lens shows what is behind upside down.
#[test]
fn glints_stand_where_they_belong_and_sum_to_the_mean() -> Outcome {
    let table = DropLightTable::water()?;
    let eye = Vec3::new(0.4, -0.3, 2.0);
    let towards = -eye.normalize();
    let right = drop_glint_right(towards);
    let up = right.cross(towards);
    for direction in [Vec3::new(0.2, 0.9, 0.3), Vec3::new(-0.7, 0.1, -0.6), Vec3::new(0.1, -0.2, -1.0)] {
        let light = direction.normalize();
        let scene = scene(&[lamp(light * 4.0, Vec3::new(3.0, 2.0, 1.0))], None);
        let frame = frame(&scene, eye)?;
        let options = DropLightOptions { glints: 8, ..DropLightOptions::default() };
        let view = SceneView { data: &scene, frame: &frame };
        let lights = DropLights::new(&view, frame.camera.eye, &table, options)?;
        let drop = [0.0, 0.0, 0.0, RADIUS];
        let all = lights.glints(drop);
        let rows = lights.light(&[drop]);
        assert_eq!(rows.len(), 9);
        let mean = Vec3::new(rows[0][0], rows[0][1], rows[0][2]);
        let sum: Vec3 = all.iter().map(|glint| glint.radiance).sum();
        assert!((sum / mean - 1.0).abs().max_element() < 1e-5, "{sum} for {mean}");
        let kept: Vec3 = rows[1..].iter().map(|row| Vec3::new(row[0], row[1], row[2])).sum();
        assert!((kept / mean - 1.0).abs().max_element() < 1e-5, "{kept} for {mean}");
        for glint in &all {
            let row = rows[1..].iter().find(|row| row[0] == glint.radiance.x).ok_or("a glint is not kept")?;
            assert!((drop_glint_unpack(row[3]) - glint.position).abs().max_element() < 1.0e-3);
            assert!((drop_glint_image(row[3]) / glint.image - 1.0).abs() < 0.05, "{}", glint.image);
        }
        let normal = (light - towards).normalize();
        let mirror = all.iter().find(|glint| glint.order == 0).ok_or("no mirror")?;
        let expected = Vec2::new(normal.dot(right), normal.dot(up));
        assert!(mirror.position.distance(expected) < 0.01, "{} for {expected}", mirror.position);
        let side = drop_glint_side(light, right, up);
        if let Some(lens) = all.iter().find(|glint| glint.order == 1) {
            assert!(lens.position.dot(side) < -0.1, "{}", lens.position);
        } else {
            assert!(light.dot(towards) < 0.2, "no light through the drop");
        }
    }
    Ok(())
}

#[test]
fn glints_are_packed_and_pixels_share_them() {
    for position in [Vec2::ZERO, Vec2::new(1.0, -1.0), Vec2::new(-0.123, 0.987), Vec2::new(-1.0, 1.0)] {
        for image in [0.0, 0.002, 0.03, 0.5, 1.0] {
            let word = drop_glint_pack(position, image);
            assert!(word.is_normal() && word > 0.0, "{word}");
            assert!((drop_glint_unpack(word) - position).abs().max_element() <= 1.001 / 1022.0, "{position}");
            let found = drop_glint_image(word);
            assert!((found - image).abs() <= 1.0e-6 + image.sqrt() / 500.0, "{found} for {image}");
        }
    }
    // A bump anywhere, of any reach, is all there, and in the middle.
    for (middle, reach) in [([0.3, 0.8], 1.0), ([0.5, 0.5], 2.7), ([0.01, 0.99], 6.4)] {
        let (mut sum, mut mean) = (0.0, Vec2::ZERO);
        for k in 0..20 * 20i32 {
            let corner = Vec2::new((k % 20 - 10) as f32, (k / 20 - 10) as f32);
            let part = drop_glint_pixel(Vec2::from(middle) - corner, reach);
            (sum, mean) = (sum + part, mean + part * (corner + 0.5));
        }
        assert!((sum - 1.0).abs() < 1.0e-5 && mean.distance(middle.into()) < 0.1, "{sum}, {mean}");
    }
}

/// A ball shows a lamp outside half as large as a mirror would that is flat: the normal turns by half of the angle. In the middle, what
/// comes through is twice as large as the lamp: n / (2 (n - 1)), the focal length of a ball in radii.
#[test]
fn glints_are_as_large_as_the_images_of_their_lamps() -> Outcome {
    let table = DropLightTable::new([1.333; 3], 0.009)?;
    let eye = Vec3::new(0.0, 0.0, 4.0);
    for (degrees, order, factor) in [(100.0, 0, 0.5), (60.0, 0, 0.5), (150.0, 0, 0.5), (3.0, 1, 2.0015)] {
        // A sphere of 0.1 m at 2 m, and one at infinity.
        let direction = turned(-Vec3::Z, degrees);
        let sphere = |radius| LightSource::Point {
            position: direction * 2.0,
            radius,
            intensity: Vec3::ONE,
            range: 0.0,
        };
        for (radius, spread) in [(0.1, 0.05), (0.0, 0.00465)] {
            let scene = scene(&[sphere(radius)], None);
            let frame = frame(&scene, eye)?;
            let view = SceneView { data: &scene, frame: &frame };
            let lights = DropLights::new(&view, frame.camera.eye, &table, DropLightOptions::default())?;
            let all = lights.glints([0.0, 0.0, 0.0, RADIUS]);
            let glint = all.iter().find(|glint| glint.order == order).ok_or("no such glint")?;
            let expected = factor * spread;
            assert!((glint.image / expected - 1.0).abs() < 0.05, "{degrees}: {}, {expected}", glint.image);
        }
    }
    Ok(())
}

#[test]
fn what_stands_between_hides_a_lamp() -> Outcome {
    let table = DropLightTable::water()?;
    let light = lamp(Vec3::new(0.0, 0.0, -2.0), Vec3::ONE);
    for (wall, lit) in [(Vec3::new(0.0, 0.0, -1.0), false), (Vec3::new(0.0, 0.0, -3.0), true)] {
        for form in [DropLightForm::Traced, DropLightForm::Rousseau2006] {
            let scene = scene(&[light], Some(wall));
            let frame = frame(&scene, Vec3::new(1.0, 0.5, 3.0))?;
            let options = DropLightOptions { form, glints: 0 };
            let found = DropLights::new(
                &SceneView { data: &scene, frame: &frame },
                frame.camera.eye,
                &table,
                options,
            )?
            .light(&[[0.0, 0.0, 0.0, RADIUS]]);
            assert_eq!(found[0][0] > 0.0, lit, "{form:?}: {found:?}");
        }
    }
    Ok(())
}

#[test]
fn lamps_add_up_and_none_is_none() -> Outcome {
    let table = DropLightTable::water()?;
    let eye = Vec3::new(0.0, 1.0, 3.0);
    let lights: Vec<LightSource> = (0..9u8)
        .map(|k| {
            let angle = f32::from(k) * 0.37;
            let at = Vec3::new(ops::cos(angle), 0.6 * ops::sin(3.0 * angle), ops::sin(angle)) * 4.0;
            lamp(at, Vec3::new(1.0, f32::from(k % 3), 0.5))
        })
        .collect();
    for form in [DropLightForm::Traced, DropLightForm::Rousseau2006] {
        let mut sum = Vec3::ZERO;
        for &light in &lights {
            sum += mean(&[light], eye, form, &table)?;
        }
        let found = mean(&lights, eye, form, &table)?;
        assert!((found / sum - 1.0).abs().max_element() < 1e-5, "{form:?}: {found} for {sum}");
    }
    assert_eq!(mean(&lights, eye, DropLightForm::None, &table)?, Vec3::ZERO);
    assert_eq!(mean(&[], eye, DropLightForm::Traced, &table)?, Vec3::ZERO);
    Ok(())
}

/// Lamp behind the eye: `A_1 A_2` is the square of the cosine, 1/2 over the disk; `A_3` has nothing. Lamp behind the drop:
/// `A_2` has nothing, `A_3` is cos (1 - cos) where the normal is level.
#[test]
fn rousseau_2006_is_as_printed() -> Outcome {
    let table = DropLightTable::water()?;
    let eye = Vec3::new(0.0, 0.0, 3.0);
    let of =
        |position: Vec3| mean(&[lamp(position, Vec3::splat(4.0))], eye, DropLightForm::Rousseau2006, &table);
    let white = 4.0 / (4.0 * PI);
    let front = of(Vec3::new(0.0, 0.0, 2.0))? / white;
    assert!((front - 0.5).abs().max_element() < 1e-4, "{front}");
    let behind = of(Vec3::new(0.0, 0.0, -2.0))?.x / white;
    // The mean over the disk of c^2 (1 - c) / sqrt(x^2 + c^2), by a fine sum.
    let (mut sum, mut count) = (0.0, 0.0);
    for k in 0..400 * 400 {
        let [x, y] = [k % 400, k / 400].map(|k| (k as f32 + 0.5) / 200.0 - 1.0);
        let square = 1.0 - x * x - y * y;
        if square > 0.0 {
            let c = square.sqrt();
            sum += square * (1.0 - c) / (x * x + square).sqrt();
            count += 1.0;
        }
    }
    let expected = sum / count;
    // 32 points stand for the disk.
    assert!((behind / expected - 1.0).abs() < 0.05, "{behind} for {expected}");
    Ok(())
}

#[test]
fn im_sung_2022_lights_a_cone() -> Outcome {
    let table = DropLightTable::water()?;
    let eye = Vec3::new(0.0, 0.0, 3.0);
    // A street lamp; a drop in the origin is `aside` of its axis and `below` it.
    let of = |aside: f32, below: f32, range: f32| {
        let spot = LightSource::Spot {
            radius: 0.0,
            position: Vec3::new(-aside, below, 0.0),
            direction: Vec3::NEG_Y,
            intensity: Vec3::new(8.0, 4.0, 2.0),
            range,
            inner: 0.3,
            outer: 0.5,
        };
        mean(&[spot], eye, DropLightForm::ImSung2022, &table)
    };
    let (inner, outer) = (2.0 * ops::tan(0.3), 2.0 * ops::tan(0.5));
    for aside in [0.0, 0.5 * inner, 0.99 * inner] {
        let expected = Vec3::new(8.0, 4.0, 2.0) / (PI * (4.0 + aside * aside));
        let found = of(aside, 2.0, 0.0)?;
        assert!((found / expected - 1.0).abs().max_element() < 1e-3, "{aside}: {found} for {expected}");
    }
    let (near, middle) = (of(inner, 2.0, 0.0)?.x, of(0.5 * (inner + outer), 2.0, 0.0)?.x);
    let full = 8.0 / (PI * (4.0 + 0.25 * (inner + outer) * (inner + outer)));
    assert!((middle / full - 0.5).abs() < 2e-3 && near > middle, "{middle}, {full}");
    for (aside, below, range) in [(1.01 * outer, 2.0, 0.0), (0.0, -2.0, 0.0), (0.0, 2.0, 1.9)] {
        assert_eq!(of(aside, below, range)?, Vec3::ZERO, "{aside}, {below}, {range}");
    }
    let others = [
        lamp(Vec3::Y, Vec3::ONE),
        LightSource::Directional { direction: Vec3::NEG_Y, irradiance: Vec3::ONE },
    ];
    assert_eq!(mean(&others, eye, DropLightForm::ImSung2022, &table)?, Vec3::ZERO);
    Ok(())
}

#[test]
fn light_that_is_none_is_refused() -> Outcome {
    let table = DropLightTable::water()?;
    for (wrong, said) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (-1.0, "-1"), (1.0e31, "1")] {
        let lights = [lamp(Vec3::Y, Vec3::ONE), lamp(Vec3::Y, Vec3::new(0.5, wrong, 0.5))];
        let scene = scene(&lights, None);
        let frame = frame(&scene, Vec3::Z)?;
        let error = DropLights::new(
            &SceneView { data: &scene, frame: &frame },
            frame.camera.eye,
            &table,
            DropLightOptions::default(),
        )
        .unwrap_err();
        let words = error.to_string();
        assert!(words.starts_with(&format!("light 1 has a color of {said}")), "{words}");
        assert!(words.ends_with("allowed: finite numbers from 0 to 1e30"), "{words}");
    }
    let scene = scene(&[], None);
    let frame = frame(&scene, Vec3::Z)?;
    let options = DropLightOptions { glints: 17, ..DropLightOptions::default() };
    let error =
        DropLights::new(&SceneView { data: &scene, frame: &frame }, frame.camera.eye, &table, options)
            .unwrap_err();
    assert_eq!(error.to_string(), "number of glints of a drop is 17; allowed: 0 to 16");
    Ok(())
}

/// Drops that are lit by the sun on their own must not show it once more from the capture.
#[test]
fn the_capture_can_do_without_the_sun() -> Outcome {
    let sun =
        LightSource::Directional { direction: Vec3::new(0.2, -1.0, 0.1).normalize(), irradiance: Vec3::ONE };
    let scene = scene(&[sun], None);
    let with = frame(&scene, Vec3::Z)?;
    let brightest = |frame: &RenderFrame| {
        let options = RainOptions { capture_size: 16, ..RainOptions::default() };
        let environment = EnvironmentFrame::new(&frame.camera, &options);
        let capture = trace_environment(&scene, frame, &environment);
        capture.texels.iter().fold(0.0f32, |most, texel| most.max(texel[0]))
    };
    assert!(brightest(&with) > 1.0);
    assert_eq!(brightest(&RenderFrame { suns_out: 1, ..with }), 0.0);
    Ok(())
}
