//! Lamps with a size and surfaces that shine: their light against closed forms, counted once.

use std::f64::consts::PI;

use downpour_math::ops::f64 as exact;
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::material::MaterialLook;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, DVec3, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// A material of one diffuse albedo and one emission.
fn matte(albedo: f32, emission: f32) -> MaterialLook {
    MaterialLook {
        base_color: [albedo, albedo, albedo, 1.0],
        emission: [emission; 3],
        roughness: 1.0,
        ior: 1.0,
        ..MaterialLook::default()
    }
}

/// A rectangle by its middle and half its edges, cut into `cuts` by `cuts` parts.
fn rectangle(builder: &mut SceneBuilder, material: u32, middle: Vec3, half: [Vec3; 2], cuts: u32) {
    let edge = cuts + 1;
    let at = |k: u32| k as f32 / cuts as f32 * 2.0 - 1.0;
    let positions: Vec<[f32; 3]> = (0..edge * edge)
        .map(|i| (middle + half[0] * at(i % edge) + half[1] * at(i / edge)).to_array())
        .collect();
    let indices: Vec<u32> = (0..cuts * cuts)
        .flat_map(|i| {
            let a = i / cuts * edge + i % cuts;
            [a, a + 1, a + edge + 1, a, a + edge + 1, a + edge]
        })
        .collect();
    let part = MeshPart::plain(&positions, &indices, material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

/// Luminance of pixels of the floor around a point, seen from above it.
fn floor_at(
    scene: &SceneData,
    x: f32,
    eye: f32,
    size: u32,
    grid: u32,
    seed: u64,
) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let view = Viewpoint { eye: Vec3::new(x, eye, 0.0), forward: Vec3::NEG_Y, up: Vec3::Z, fov_y: 0.1 };
    let frame = RenderFrame::new(scene, &view, [size, size], grid, 1, seed)?;
    let picture = SceneView { data: scene, frame: &frame }.picture();
    Ok(picture.iter().map(|pixel| f64::from(pixel[1])).collect())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Lambert's formula: irradiance over pi and radiance at a point with a normal from a polygon above its horizon.
fn lambert(point: DVec3, normal: DVec3, polygon: &[DVec3]) -> f64 {
    let sum: f64 = (0..polygon.len())
        .map(|k| {
            let (a, b) =
                ((polygon[k] - point).normalize(), (polygon[(k + 1) % polygon.len()] - point).normalize());
            let angle = exact::acos(a.dot(b).clamp(-1.0, 1.0));
            angle * a.cross(b).normalize().dot(normal)
        })
        .sum();
    (sum / (2.0 * PI)).abs()
}

/// A sign over a floor lights it as Lambert's formula says, in one piece or in many, near and far.
#[test]
fn a_surface_that_shines_lights_as_its_solid_angle() -> Outcome {
    for cuts in [1, 5, 70] {
        let mut builder = SceneBuilder::new();
        let floor = builder.add_material(matte(0.5, 0.0));
        let sign = builder.add_material(matte(0.0, 30.0));
        rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
        // 2 m wide and 1 m high, its lower edge 0.5 m above the floor, facing +X.
        rectangle(&mut builder, sign, Vec3::new(-1.0, 1.0, 0.0), [Vec3::Z, Vec3::Y * 0.5], cuts);
        let scene = builder.build(&SkyLight::uniform([0.0; 3]));
        let corners = [(-1.0, 0.5), (1.0, 0.5), (1.0, 1.5), (-1.0, 1.5)].map(|(z, y)| DVec3::new(-1.0, y, z));
        for x in [-0.5f32, 1.0, 5.0] {
            let expected = 0.5 * 30.0 * lambert(DVec3::new(f64::from(x), 0.0, 0.0), DVec3::Y, &corners);
            let found = mean(&floor_at(&scene, x, 0.4, 48, 2, 7)?);
            assert!((found / expected - 1.0).abs() < 0.03, "{cuts} cuts, {x} m: {found}, {expected}");
        }
    }
    Ok(())
}

/// Something in a room whose walls shine with 1 shows its albedo.
#[test]
fn in_a_room_that_shines_a_thing_shows_its_albedo() -> Outcome {
    let mut builder = SceneBuilder::new();
    let wall = builder.add_material(matte(0.0, 1.0));
    let table = builder.add_material(matte(0.6, 0.0));
    for axis in 0..3 {
        let along = |k: usize| Vec3::AXES[(axis + k) % 3];
        for side in [-1.0, 1.0] {
            rectangle(&mut builder, wall, along(0) * side * 3.0, [along(1) * 3.0, along(2) * 3.0], 4);
        }
    }
    rectangle(&mut builder, table, Vec3::ZERO, [Vec3::Z * 0.5, Vec3::X * 0.5], 1);
    let scene = builder.build(&SkyLight::uniform([9.0; 3]));
    // The mean over noises, which all windows of a picture share.
    let mut found = 0.0;
    for seed in 0..16 {
        found += mean(&floor_at(&scene, 0.0, 2.0, 72, 1, seed)?) / 16.0;
    }
    println!("{found:.4} of 0.6");
    assert!((found / 0.6 - 1.0).abs() < 0.01, "{found}");
    Ok(())
}

/// A floor under a lamp in a globe of glass that shines.
fn globe(lamp: bool, glass: bool, radius: f32) -> SceneData {
    let mut builder = SceneBuilder::new();
    let floor = builder.add_material(matte(0.5, 0.0));
    let shade = builder.add_material(matte(0.0, 500.0));
    rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
    let middle = Vec3::new(0.0, 3.0, 0.0);
    if glass {
        for axis in 0..3 {
            let along = |k: usize| Vec3::AXES[(axis + k) % 3] * 0.15;
            for side in [-1.0, 1.0] {
                rectangle(&mut builder, shade, middle + along(0) * side, [along(1), along(2)], 1);
            }
        }
    }
    if lamp {
        builder.add_light(LightSource::Point {
            position: middle,
            radius,
            intensity: Vec3::splat(45.0),
            range: 0.0,
        });
    }
    builder.build(&SkyLight::uniform([0.0; 3]))
}

/// The glass of a lamp is the lamp: its light is counted once, and it does not stand in its own light. Without a lamp the glass is
/// one.
#[test]
fn a_lamp_and_its_glass_are_one_light() -> Outcome {
    let of = |scene: &SceneData| floor_at(scene, 1.0, 1.0, 16, 1, 7).map(|values| mean(&values));
    let bare = of(&globe(true, false, 0.0))?;
    let both = of(&globe(true, true, 0.0))?;
    assert!((both / bare - 1.0).abs() < 0.02, "{both}, {bare}");
    let glass = of(&globe(false, true, 0.0))?;
    // A box of 0.3 m shines about as its outline: 0.09 m^2 from the side, 0.127 from its edges.
    let (low, high) = (0.09 * 500.0 / 45.0 * bare, 0.156 * 500.0 / 45.0 * bare);
    assert!(glass > 0.95 * low && glass < high, "{glass}, {bare}");
    // Its radius is that of the sphere which is as bright: I = pi r^2 L.
    let radius = globe(true, true, 0.0).light_load(0).radius;
    assert!((f64::from(radius) - (45.0 / (PI * 500.0)).sqrt()).abs() < 1.0e-4, "{radius}");
    assert_eq!(globe(true, true, 0.4).light_load(0).radius, 0.4);
    Ok(())
}

/// The edge of a shadow is as wide as the lamp is large, times the ratio of the distances.
#[test]
fn a_shadow_is_as_soft_as_its_lamp_is_large() -> Outcome {
    for radius in [0.05f32, 0.2] {
        let mut builder = SceneBuilder::new();
        let floor = builder.add_material(matte(0.5, 0.0));
        let board = builder.add_material(matte(0.0, 0.0));
        rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
        // Its edge is at x = 0, 1 m above the floor, under a lamp 3 m above it.
        rectangle(&mut builder, board, Vec3::new(-5.0, 1.0, 0.0), [Vec3::Z * 5.0, Vec3::X * 5.0], 1);
        builder.add_light(LightSource::Point {
            position: Vec3::Y * 3.0,
            radius,
            intensity: Vec3::splat(45.0),
            range: 0.0,
        });
        let scene = builder.build(&SkyLight::uniform([0.0; 3]));
        let half = f64::from(radius) * 1.0 / 2.0;
        // A disk behind an edge: the fraction that is seen at a place, in half widths from the middle.
        let fraction = |x: f64| {
            let s = x.clamp(-1.0, 1.0);
            0.5 + (s * (1.0 - s * s).sqrt() + exact::asin(s)) / PI
        };
        for place in [-1.3, -0.6, 0.0, 0.6, 1.3] {
            let x = place * half;
            // From beside, under the board.
            let view = Viewpoint {
                eye: Vec3::new(x as f32, 0.5, -0.8),
                forward: Vec3::new(0.0, -0.5, 0.8),
                up: Vec3::Y,
                fov_y: 0.002 * radius,
            };
            let frame = RenderFrame::new(&scene, &view, [24, 24], 1, 1, 7)?;
            let picture = SceneView { data: &scene, frame: &frame }.picture();
            let found = picture.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / picture.len() as f64;
            let lit = 0.5 / PI * 45.0 / 9.0;
            assert!(
                (found / lit - fraction(place)).abs() < 0.04,
                "radius {radius}, {place} half widths: {}, {}",
                found / lit,
                fraction(place)
            );
        }
    }
    Ok(())
}

/// What a rough gloss shows of a lamp has a shadow as soft, without the noise of the places of the lamp that each pixel asks.
#[test]
fn the_sheen_of_a_lamp_has_its_soft_shadow_without_noise() -> Outcome {
    let radius = 0.2f32;
    for (metallic, roughness) in [(1.0, 0.4), (0.0, 0.4), (0.0, 0.8)] {
        let scene = |shadow: bool| {
            let mut builder = SceneBuilder::new();
            let look = MaterialLook {
                base_color: if metallic > 0.0 { [1.0; 4] } else { [0.02, 0.02, 0.02, 1.0] },
                metallic,
                roughness,
                ..MaterialLook::default()
            };
            let floor = builder.add_material(look);
            let board = builder.add_material(matte(0.0, 0.0));
            rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
            if shadow {
                rectangle(&mut builder, board, Vec3::new(-5.0, 1.0, 0.0), [Vec3::Z * 5.0, Vec3::X * 5.0], 1);
            }
            let position = Vec3::new(0.0, 3.0, 0.0);
            builder.add_light(LightSource::Point {
                position,
                radius,
                intensity: Vec3::splat(45.0),
                range: 0.0,
            });
            builder.build(&SkyLight::uniform([0.0; 3]))
        };
        let half = f64::from(radius) * 1.0 / 2.0;
        for (place, part) in [(-0.6, 0.142_4), (0.0, 0.5), (0.6, 0.857_6)] {
            let shown = |scene: &SceneData| -> Result<Vec<f64>, Box<dyn std::error::Error>> {
                let view = Viewpoint {
                    eye: Vec3::new((place * half) as f32, 0.5, -0.8),
                    forward: Vec3::new(0.0, -0.5, 0.8),
                    up: Vec3::Y,
                    fov_y: 0.002 * radius,
                };
                let frame = RenderFrame::new(scene, &view, [24, 24], 1, 1, 7)?;
                let picture = SceneView { data: scene, frame: &frame }.picture();
                Ok(picture.iter().map(|pixel| f64::from(pixel[1])).collect())
            };
            let (found, lit) = (shown(&scene(true))?, mean(&shown(&scene(false))?));
            let seen = mean(&found) / lit;
            assert!((seen - part).abs() < 0.05, "{metallic} {roughness} {place}: {seen}, {part}");
            let noise = (found.iter().map(|one| (one / lit - seen) * (one / lit - seen)).sum::<f64>()
                / found.len() as f64)
                .sqrt();
            // One place alone is seen or not: the root of part times 1 - part.
            let alone = (part * (1.0 - part)).sqrt();
            assert!(noise < 0.35 * alone, "{metallic} {roughness} {place}: {noise} of {alone}");
        }
    }
    Ok(())
}

/// Radiance of black ground, rough and of index 1.5, in light of an irradiance from a direction: D G F / 4 over the cosine of the view,
/// by Walter et al. 2007 and Heitz 2014.
fn ggx(roughness: f64, view: DVec3, light: DVec3, irradiance: f64) -> f64 {
    let a2 = exact::pow(roughness, 4.0);
    let half = (view + light).normalize();
    let d = a2 / (PI * exact::pow(half.y * half.y * (a2 - 1.0) + 1.0, 2.0));
    let lambda = |cosine: f64| 0.5 * ((1.0 + a2 * (1.0 / (cosine * cosine) - 1.0)).sqrt() - 1.0);
    let g = 1.0 / (1.0 + lambda(view.y) + lambda(light.y));
    let f = 0.04 + 0.96 * exact::pow(1.0 - view.dot(half), 5.0);
    irradiance * d * g * f / (4.0 * view.y)
}

/// What a gloss shows of the sun and of a lamp it shows once, however rough it is and however large they are.
#[test]
fn a_gloss_shows_a_lamp_once() -> Outcome {
    let towards = DVec3::new(-0.3, 0.8, 0.5).normalize();
    for roughness in [0.4f32, 0.55, 0.65, 0.8, 1.0] {
        let look = MaterialLook { base_color: [0.0, 0.0, 0.0, 1.0], roughness, ..MaterialLook::default() };
        let mut builder = SceneBuilder::new();
        let floor = builder.add_material(look);
        rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
        let build = || builder.clone().build(&SkyLight::uniform([0.0; 3]));
        let eye = DVec3::new(1.0, 1.6, 2.0);
        let view = Viewpoint { eye: eye.as_vec3(), forward: -eye.as_vec3(), up: Vec3::Y, fov_y: 0.02 };
        for (name, radius, place) in [("sun", 0.0, None), ("sun", 0.03, None), ("lamp", 0.2, Some(5.0))] {
            let mut scene = build();
            let irradiance = 3.0;
            scene.set_lights(&[match place {
                None => LightSource::Directional {
                    direction: -towards.as_vec3(),
                    irradiance: Vec3::splat(irradiance as f32),
                },
                Some(distance) => LightSource::Point {
                    radius,
                    position: (towards * distance).as_vec3(),
                    intensity: Vec3::splat((irradiance * distance * distance) as f32),
                    range: 0.0,
                },
            }]);
            if place.is_none() && radius > 0.0 {
                scene.set_light_radius(0, radius);
            }
            for sky_rays in [0, 4] {
                let frame = RenderFrame::new(&scene, &view, [24, 24], 1, sky_rays, 5)?;
                let picture = SceneView { data: &scene, frame: &frame }.picture();
                let found = mean(&picture.iter().map(|pixel| f64::from(pixel[1])).collect::<Vec<f64>>());
                let wanted = ggx(f64::from(roughness), eye.normalize(), towards, irradiance);
                println!(
                    "{name} {radius}, roughness {roughness}, {sky_rays} rays: {found:.5} of {wanted:.5}"
                );
                assert!((found / wanted - 1.0).abs() < 0.03, "{name} {radius} {roughness} {sky_rays}");
            }
        }
    }
    Ok(())
}

/// A rough gloss shows a panel as the sum over all of its places says, drawn as a light or met by rays.
#[test]
fn a_gloss_shows_a_panel_once() -> Outcome {
    let (middle, half, radiance) = (DVec3::new(-0.6, 1.5, -1.0), 0.5, 10.0);
    let eye = DVec3::new(0.8, 1.6, 1.8);
    let steps = 200u32;
    let place = |k: u32| (f64::from(k) + 0.5) / f64::from(steps) * 2.0 * half - half;
    for roughness in [0.45f32, 0.58, 0.6, 0.8, 1.0] {
        let mut builder = SceneBuilder::new();
        let look = MaterialLook { base_color: [0.0, 0.0, 0.0, 1.0], roughness, ..MaterialLook::default() };
        let floor = builder.add_material(look);
        rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
        let panel = builder.add_material(matte(0.0, radiance as f32));
        let edges = [Vec3::X * half as f32, Vec3::Z * half as f32];
        rectangle(&mut builder, panel, middle.as_vec3(), edges, 3);
        let scene = builder.build(&SkyLight::uniform([0.0; 3]));
        let forward = -eye.as_vec3();
        let view = Viewpoint { eye: eye.as_vec3(), forward, up: Vec3::Y, fov_y: 0.02 };
        let frame = RenderFrame::new(&scene, &view, [32, 32], 1, 16, 5)?;
        let picture = SceneView { data: &scene, frame: &frame }.picture();
        let found = mean(&picture.iter().map(|pixel| f64::from(pixel[1])).collect::<Vec<f64>>());
        let area = exact::pow(2.0 * half / f64::from(steps), 2.0);
        let part = |i: u32| {
            let at = middle + DVec3::new(place(i % steps), 0.0, place(i / steps));
            let towards = at.normalize();
            let solid = area * towards.y / at.length_squared();
            ggx(f64::from(roughness), eye.normalize(), towards, radiance * solid)
        };
        let wanted: f64 = (0..steps * steps).map(part).sum();
        println!("roughness {roughness}: {found:.5} of {wanted:.5}");
        assert!((found / wanted - 1.0).abs() < 0.05, "{roughness}: {found}, {wanted}");
    }
    Ok(())
}

/// The same of the sun, by the angle of its disk.
#[test]
fn a_shadow_is_as_soft_as_the_sun_is_large() -> Outcome {
    for radius in [0.01f32, 0.08] {
        let mut builder = SceneBuilder::new();
        let floor = builder.add_material(matte(0.5, 0.0));
        let board = builder.add_material(matte(0.0, 0.0));
        rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
        rectangle(&mut builder, board, Vec3::new(-5.0, 1.0, 0.0), [Vec3::Z * 5.0, Vec3::X * 5.0], 1);
        builder.add_light(LightSource::Directional { direction: Vec3::NEG_Y, irradiance: Vec3::splat(10.0) });
        let mut scene = builder.build(&SkyLight::uniform([0.0; 3]));
        scene.set_light_radius(0, radius);
        for (place, part) in [(-1.3, 0.0), (0.0, 0.5), (0.5, 0.804_5), (1.3, 1.0)] {
            let x = place * radius;
            let view = Viewpoint {
                eye: Vec3::new(x, 0.5, -0.8),
                forward: Vec3::new(0.0, -0.5, 0.8),
                up: Vec3::Y,
                fov_y: 0.02 * radius,
            };
            let frame = RenderFrame::new(&scene, &view, [24, 24], 1, 1, 7)?;
            let picture = SceneView { data: &scene, frame: &frame }.picture();
            let found = picture.iter().map(|pixel| pixel[1]).sum::<f32>() / picture.len() as f32;
            let lit = 0.5 / std::f32::consts::PI * 10.0;
            assert!((found / lit - part).abs() < 0.04, "{radius}, {place}: {}, {part}", found / lit);
        }
    }
    Ok(())
}

/// The image of a lamp in polished floor is as bright as the lamp and no brighter.
#[test]
fn the_image_of_a_lamp_is_as_bright_as_the_lamp() -> Outcome {
    let radius = 0.15;
    let mut builder = SceneBuilder::new();
    let floor =
        builder.add_material(MaterialLook { roughness: 0.0, metallic: 1.0, ..MaterialLook::default() });
    rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
    let intensity = 45.0;
    builder.add_light(LightSource::Point {
        position: Vec3::new(0.0, 2.0, 2.0),
        radius,
        intensity: Vec3::splat(intensity),
        range: 0.0,
    });
    let scene = builder.build(&SkyLight::uniform([0.0; 3]));
    let view = Viewpoint {
        eye: Vec3::new(0.0, 2.0, -2.0),
        forward: Vec3::new(0.0, -2.0, 2.0),
        up: Vec3::Y,
        fov_y: 0.01,
    };
    let frame = RenderFrame::new(&scene, &view, [8, 8], 1, 1, 7)?;
    let picture = SceneView { data: &scene, frame: &frame }.picture();
    let lamp = intensity / (std::f32::consts::PI * radius * radius);
    for pixel in picture {
        assert!((pixel[1] / lamp - 1.0).abs() < 0.15, "{pixel:?}, {lamp}");
    }
    Ok(())
}

/// The disk of the sun stands in the sky, with the radiance that its illuminance asks for.
#[test]
fn the_sun_stands_in_the_sky() -> Outcome {
    let mut builder = SceneBuilder::new();
    let toward = Vec3::new(0.6, 0.8, 0.0);
    builder.add_light(LightSource::Directional { direction: -toward, irradiance: Vec3::splat(1000.0) });
    let mut scene = builder.build(&SkyLight::uniform([1.0; 3]));
    let radius = 0.01f32;
    scene.set_light_radius(0, radius);
    let view = Viewpoint { eye: Vec3::ZERO, forward: toward, up: Vec3::Z, fov_y: 0.04 };
    let frame = RenderFrame::new(&scene, &view, [64, 64], 2, 1, 7)?;
    let picture = SceneView { data: &scene, frame: &frame }.picture();
    // Irradiance of all that is seen but the sky: radiance times solid angle.
    let pixel = (0.04f64 / 64.0) * (0.04 / 64.0);
    let sum: f64 = picture.iter().map(|p| (f64::from(p[1]) - 1.0) * pixel).sum();
    assert!((sum / 1000.0 - 1.0).abs() < 0.02, "{sum}");
    Ok(())
}

/// A hundred thousand triangles that shine are built, and light as one of their size does.
#[test]
fn many_surfaces_that_shine() -> Outcome {
    let of = |cuts: u32| -> Result<f64, Box<dyn std::error::Error>> {
        let mut builder = SceneBuilder::new();
        let floor = builder.add_material(matte(0.5, 0.0));
        let ceiling = builder.add_material(matte(0.0, 2.0));
        rectangle(&mut builder, floor, Vec3::ZERO, [Vec3::Z * 20.0, Vec3::X * 20.0], 1);
        rectangle(&mut builder, ceiling, Vec3::Y * 3.0, [Vec3::X * 4.0, Vec3::Z * 4.0], cuts);
        let scene = builder.build(&SkyLight::uniform([0.0; 3]));
        Ok(mean(&floor_at(&scene, 0.0, 2.0, 24, 2, 7)?))
    };
    let (one, many) = (of(1)?, of(224)?);
    assert!((many / one - 1.0).abs() < 0.04, "{one}, {many}");
    Ok(())
}
