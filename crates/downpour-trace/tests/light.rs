//! The light of pictures: of the sky by its map, of what mirrors show, of rooms, of lamps under water, and its noise.

use downpour_drop::optics::optics_fresnel;
use downpour_math::ops::f64 as exact;
use downpour_math::rng::{rng_draw, rng_pcg4d, rng_unit};
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::picture::noise_seed;
use downpour_render::tone::{Tone, ToneLayers, tone_picture};
use downpour_shaders::render::scene::SCENE_UNLIT;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::material::MaterialLook;
use downpour_trace::puddle::{Ground, PuddleLook, PuddleMap, PuddleRows, slope_levels};
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::{ToneCurve, ToneEdges};
use glam::{Affine3A, DVec3, Vec2, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// A material of one diffuse albedo and nothing else.
fn diffuse(albedo: f32) -> MaterialLook {
    MaterialLook {
        base_color: [albedo, albedo, albedo, 1.0],
        roughness: 1.0,
        ior: 1.0,
        ..MaterialLook::default()
    }
}

/// A square by its middle and half its edges; its front is toward their cross product.
fn square(builder: &mut SceneBuilder, material: u32, middle: Vec3, across: Vec3, along: Vec3) {
    let positions = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| (middle + across * x + along * y).to_array());
    let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

/// A picture from an eye toward a point.
fn picture(
    scene: &SceneData,
    eye: Vec3,
    at: Vec3,
    fov_y: f32,
    size: [u32; 2],
    seed: u64,
) -> Result<Vec<[f32; 4]>, Box<dyn std::error::Error>> {
    let up = if (at - eye).normalize().y.abs() > 0.99 { Vec3::X } else { Vec3::Y };
    let view = Viewpoint { eye, forward: at - eye, up, fov_y };
    let frame = RenderFrame::new(scene, &view, size, 1, 1, seed)?;
    Ok(SceneView { data: scene, frame: &frame }.picture())
}

fn mean(picture: &[[f32; 4]]) -> f64 {
    picture.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / picture.len() as f64
}

/// glTF's unlit materials show their base color, whatever lights them.
#[test]
fn an_unlit_wall_of_one_is_one() -> Outcome {
    for (color, metallic) in [(1.0f32, 0.0f32), (0.25, 0.0), (1.0, 1.0)] {
        let mut builder = SceneBuilder::new();
        let look = MaterialLook {
            flags: SCENE_UNLIT,
            base_color: [color, color, color, 1.0],
            metallic,
            ..MaterialLook::default()
        };
        let wall = builder.add_material(look);
        square(&mut builder, wall, Vec3::ZERO, Vec3::X * 5.0, Vec3::Y * 5.0);
        builder.add_light(LightSource::Point {
            radius: 0.0,
            position: Vec3::Z,
            intensity: Vec3::splat(9.0),
            range: 0.0,
        });
        let scene = builder.build(&SkyLight::uniform([3.0; 3]));
        for pixel in picture(&scene, Vec3::new(0.4, 0.7, 3.0), Vec3::ZERO, 0.5, [8, 8], 1)? {
            for found in &pixel[..3] {
                assert!((found - color).abs() < 1.0e-6, "{color}, {metallic}: {pixel:?}");
            }
        }
    }
    Ok(())
}

/// A sky with a sun of some degrees at 12 degrees over the horizon along +X.
fn low_sun(width: u32, height: u32) -> Vec<[f32; 3]> {
    (0..width * height)
        .map(|i| {
            let direction = texel(i, width, height).0;
            let cosine = direction.dot(DVec3::new(0.978_148, 0.207_912, 0.0));
            let background = 0.3 + 0.2 * direction.y;
            [(background + if cosine > 0.9962 { 60.0 } else { 0.0 }) as f32; 3]
        })
        .collect()
}

/// The direction of a texel of an equirectangular map, and its solid angle.
fn texel(i: u32, width: u32, height: u32) -> (DVec3, f64) {
    use std::f64::consts::{PI, TAU};
    let (x, y) = (f64::from(i % width), f64::from(i / width));
    let around = TAU * ((x + 0.5) / f64::from(width) - 0.5);
    let polar = |row: f64| PI * row / f64::from(height);
    let (flat, up) = (exact::sin(polar(y + 0.5)), exact::cos(polar(y + 0.5)));
    let angle = TAU / f64::from(width) * (exact::cos(polar(y)) - exact::cos(polar(y + 1.0)));
    (DVec3::new(flat * exact::cos(around), up, flat * exact::sin(around)), angle)
}

/// Faces of every side have the light that the sky's map sends them, toward a low sun and away from it.
#[test]
fn faces_have_the_light_of_the_sky_before_them() -> Outcome {
    let (width, height) = (128, 64);
    let map = low_sun(width, height);
    let light = SkyLight::new(width, height, &map);
    for normal in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.64, -0.48)] {
        let expected: f64 = (0..width * height)
            .map(|i| {
                let (direction, angle) = texel(i, width, height);
                let cosine = direction.dot(normal.as_dvec3()).max(0.0);
                f64::from(map[i as usize][1]) * cosine * angle
            })
            .sum::<f64>()
            * 0.5
            / std::f64::consts::PI;
        let mut builder = SceneBuilder::new();
        let face = builder.add_material(diffuse(0.5));
        let across = normal.any_orthonormal_vector();
        square(&mut builder, face, Vec3::ZERO, across * 4.0, normal.cross(across) * 4.0);
        let scene = builder.build(&light);
        // All windows of a picture share 49 directions, of which few meet the sun: the mean over noises.
        let mut found = 0.0;
        for seed in 0..64 {
            found +=
                mean(&picture(&scene, normal * 2.0 + across * 0.3, Vec3::ZERO, 0.8, [32, 32], seed)?) / 64.0;
        }
        println!("{normal}: {found:.4} of {expected:.4}");
        assert!((found / expected - 1.0).abs() < 0.03, "{normal}: {found}, {expected}");
    }
    Ok(())
}

/// A smooth metal floor shows the wall behind it and the sky over the wall, each where geometry says.
#[test]
fn metal_mirrors_what_stands_there() -> Outcome {
    let mut builder = SceneBuilder::new();
    let metal =
        MaterialLook { base_color: [1.0; 4], metallic: 1.0, roughness: 0.0, ..MaterialLook::default() };
    let floor = builder.add_material(metal);
    let unlit =
        MaterialLook { flags: SCENE_UNLIT, base_color: [0.7, 0.7, 0.7, 1.0], ..MaterialLook::default() };
    let wall = builder.add_material(unlit);
    square(&mut builder, floor, Vec3::ZERO, Vec3::Z * 5.0, Vec3::X * 5.0);
    // 1 m high, at z = -2.
    square(&mut builder, wall, Vec3::new(0.0, 0.5, -2.0), Vec3::X * 50.0, Vec3::Y * 0.5);
    let scene = builder.build(&SkyLight::uniform([0.2; 3]));
    let (eye, at, size) = (Vec3::new(0.0, 1.0, 2.0), Vec3::new(0.0, 0.0, -0.5), [24, 24]);
    let view = Viewpoint { eye, forward: at - eye, up: Vec3::Y, fov_y: 0.7 };
    let frame = RenderFrame::new(&scene, &view, size, 1, 1, 5)?;
    let view = SceneView { data: &scene, frame: &frame };
    let (mut of_wall, mut of_sky) = (0, 0);
    for (i, pixel) in view.picture().iter().enumerate() {
        let along = view.frame.camera.camera_direction((i % 24) as f32 + 0.5, (i / 24) as f32 + 0.5);
        if along.y > -0.02 {
            continue;
        }
        let hit = eye + along * (-eye.y / along.y);
        let height = along.y / along.z * (hit.z + 2.0);
        if hit.z < -1.9 || (height - 1.0).abs() < 0.1 {
            continue;
        }
        let expected = if height < 1.0 { 0.7 } else { 0.2 };
        assert!((pixel[1] / expected - 1.0).abs() < 0.02, "{i}, {height}: {pixel:?}");
        *(if height < 1.0 { &mut of_wall } else { &mut of_sky }) += 1;
    }
    assert!(of_wall > 50 && of_sky > 50, "{of_wall}, {of_sky}");
    Ok(())
}

/// In a closed room whose walls shine with 1 and throw back half of what they get, all is 1 / (1 - 0.5).
#[test]
fn a_closed_room_has_the_light_of_all_its_reflections() -> Outcome {
    for albedo in [0.3f32, 0.5, 0.7] {
        let mut builder = SceneBuilder::new();
        let wall = builder.add_material(MaterialLook { emission: [1.0; 3], ..diffuse(albedo) });
        for axis in 0..3 {
            let along = |k: usize| Vec3::AXES[(axis + k) % 3];
            for side in [-1.0, 1.0] {
                square(&mut builder, wall, along(0) * side * 2.0, along(1) * 2.0, along(2) * -side * 2.0);
            }
        }
        let scene = builder.build(&SkyLight::uniform([5.0; 3]));
        let eye = Vec3::new(1.0, 0.5, 1.2);
        let found = mean(&picture(&scene, eye, Vec3::new(-1.0, -0.6, -1.0), 1.0, [32, 24], 2)?);
        let expected = 1.0 / (1.0 - f64::from(albedo));
        assert!((found / expected - 1.0).abs() < 0.05, "{albedo}: {found}, {expected}");
    }
    Ok(())
}

/// Ground of one look from -2 to 2 m, with painted water of one depth on 3 m of it.
fn puddle(look: MaterialLook, depth: f32, sky: f32, lamp: LightSource) -> SceneData {
    let mut builder = SceneBuilder::new();
    let ground = builder.add_material(look);
    square(&mut builder, ground, Vec3::ZERO, Vec3::Z * 2.0, Vec3::X * 2.0);
    builder.add_light(lamp);
    let mut scene = builder.build(&SkyLight::uniform([sky; 3]));
    let ground = Ground { middle: Vec3::ZERO, size: Vec2::splat(3.0), turn: 0.0, reach: 0.5 };
    let map = PuddleMap::painted(&scene, &ground, [4, 4], &[depth; 16]);
    let water = PuddleLook { extinction: 0.0, ..PuddleLook::default() };
    scene.set_puddles(&PuddleRows {
        puddles: &[(map, water)],
        shape: (0, 0, 1.0),
        slopes: &[],
        shift: Vec3::ZERO,
        rings: None,
        wakes: &[],
        time_s: 0.0,
    });
    scene
}

/// Position where light from a lamp that is mirrored by level ground under level water comes out to an eye: along z, by
/// bisection of Snell's law.
fn mirrored_at(eye: [f64; 2], lamp: [f64; 2], depth: f64) -> f64 {
    let reach = |sine: f64| {
        let tangent = |s: f64| s / (1.0 - s * s).sqrt();
        [
            (eye[1] - depth) * tangent(sine),
            (lamp[1] - depth) * tangent(sine),
            2.0 * depth * tangent(sine / 1.333),
        ]
    };
    let (mut low, mut high) = (0.0, 1.0 - 1.0e-9);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if reach(middle).iter().sum::<f64>() < eye[0] - lamp[0] { low = middle } else { high = middle }
    }
    eye[0] - reach(low)[0]
}

/// A lamp over smooth ground under water is seen mirrored once, where the refracted light goes, and nowhere else.
#[test]
fn a_lamp_has_one_mirror_image_in_a_puddle() -> Outcome {
    let metal = MaterialLook {
        base_color: [0.9, 0.9, 0.9, 1.0],
        metallic: 1.0,
        roughness: 0.12,
        ..MaterialLook::default()
    };
    let (eye, position, depth) = (Vec3::new(0.0, 1.0, 2.0), Vec3::new(0.0, 1.2, -2.0), 0.04);
    let lamp = LightSource::Point { radius: 0.0, position, intensity: Vec3::splat(10.0), range: 0.0 };
    let scene = puddle(metal, depth, 0.0, lamp);
    let view = Viewpoint { eye, forward: -eye, up: Vec3::Y, fov_y: 1.1 };
    let frame = RenderFrame::new(&scene, &view, [48, 96], 1, 1, 5)?;
    let view = SceneView { data: &scene, frame: &frame };
    let (mut sum, mut weighted, mut far) = (0.0, 0.0, 0.0);
    for (i, pixel) in view.picture().iter().enumerate() {
        let along = view.frame.camera.camera_direction((i % 48) as f32 + 0.5, (i / 48) as f32 + 0.5);
        let position = eye + along * ((depth - eye.y) / along.y);
        if along.y > -0.1 || position.abs().max_element() > 1.45 {
            continue;
        }
        let (light, z) = (f64::from(pixel[1]), f64::from(position.z));
        sum += light;
        weighted += light * z;
        far += if Vec2::new(position.x, position.z).length() > 0.7 { light } else { 0.0 };
    }
    let expected = mirrored_at([2.0, 1.0], [-2.0, 1.2], f64::from(depth));
    assert!((weighted / sum - expected).abs() < 0.12, "{}, {expected}", weighted / sum);
    assert!(sum > 0.0 && far < 0.05 * sum, "{far} of {sum} is elsewhere");
    Ok(())
}

/// The sun on diffuse ground under water: what Fresnel lets in, spread over all directions, thrown back and forth beneath the
/// surface, and what Fresnel lets out over n squared.
#[test]
fn the_sun_lights_ground_under_water_by_fresnels_equations() -> Outcome {
    for angle in [20.0f32, 50.0] {
        let (height, flat) = (f64::from(angle).to_radians(), 0.0f64);
        let (up, aside) = (exact::sin(height) as f32, exact::cos(height + flat) as f32);
        let direction = Vec3::new(-aside, -up, 0.0);
        let sun = LightSource::Directional { direction, irradiance: Vec3::splat(5.0) };
        let scene = puddle(diffuse(0.3), 0.02, 0.0, sun);
        let found = mean(&picture(&scene, Vec3::new(0.0, 3.0, 0.02), Vec3::ZERO, 0.01, [4, 4], 1)?);
        let enters = f64::from(1.0 - optics_fresnel(up, 1.333));
        let leaves = 1.0 - 0.020_37;
        let expected = leaves * enters * 0.3 / (1.776_889 * (1.0 - 0.3 * 0.474_591)) * 5.0 * f64::from(up)
            / std::f64::consts::PI;
        assert!((found / expected - 1.0).abs() < 0.02, "{angle}: {found}, {expected}");
    }
    Ok(())
}

/// Correlation of two rows of numbers, -1 to 1.
fn correlation(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let [ab, aa, bb] = pairs.fold([0.0; 3], |[ab, aa, bb], (a, b)| [ab + a * b, aa + a * a, bb + b * b]);
    ab / (aa * bb).sqrt()
}

/// The noise of rippled water has no pattern of the filter's size, and each frame has different noise.
#[test]
fn noise_of_water_has_no_pattern_and_changes_with_time() -> Outcome {
    let sky: Vec<[f32; 3]> = (0..64 * 32)
        .map(|i| [if rng_unit(rng_pcg4d([i / 4, 1, 2, 3])[0]) < 0.3 { 4.0 } else { 0.2 }; 3])
        .collect();
    let mut builder = SceneBuilder::new();
    let ground = builder.add_material(diffuse(0.05));
    square(&mut builder, ground, Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0);
    let mut scene = builder.build(&SkyLight::new(64, 32, &sky));
    let ground = Ground { middle: Vec3::ZERO, size: Vec2::splat(7.0), turn: 0.0, reach: 0.5 };
    let map = PuddleMap::painted(&scene, &ground, [4, 4], &[0.03; 16]);
    let finest = (0..128 * 128u32).map(|i| {
        let [a, b, ..] = rng_pcg4d([i, 4, 5, 6]).map(|word| 0.3 * (rng_unit(word) - 0.5));
        [a, b, a * a + b * b, 0.0]
    });
    scene.set_puddles(&PuddleRows {
        puddles: &[(map, PuddleLook::default())],
        shape: (128, 7, 0.002),
        slopes: &slope_levels(finest.collect(), 128),
        shift: Vec3::ZERO,
        rings: None,
        wakes: &[],
        time_s: 0.0,
    });
    let (width, height) = (72usize, 56usize);
    let of_time = |k: u32| -> Result<Vec<f64>, Box<dyn std::error::Error>> {
        let seed = noise_seed(9, f64::from(k) / 24.0);
        let found = picture(
            &scene,
            Vec3::new(0.0, 1.4, 2.6),
            Vec3::new(0.0, 0.0, 0.4),
            0.6,
            [width as u32, height as u32],
            seed,
        )?;
        Ok(found.iter().map(|pixel| f64::from(pixel[1])).collect())
    };
    let pictures = (0..12).map(of_time).collect::<Result<Vec<_>, _>>()?;
    // Each of both frames less the mean of five others that the other frame is not compared with.
    let noise_of = |k: usize| -> Vec<f64> {
        let others = &pictures[2 + 5 * k..7 + 5 * k];
        (0..width * height).map(|i| pictures[k][i] - others.iter().map(|p| p[i]).sum::<f64>() / 5.0).collect()
    };
    let noises = [noise_of(0), noise_of(1)];
    let pixels = || (0..height - 8).flat_map(|y| (0..width - 8).map(move |x| (x, y)));
    let in_time = correlation(pixels().map(|(x, y)| (noises[0][y * width + x], noises[1][y * width + x])));
    println!("between frames: {in_time:.3}");
    assert!(in_time.abs() < 0.06, "frames share noise: {in_time}");
    // By how much noise is more alike 7 pixels away than 6 and 8 pixels away: a pattern of the filter's size.
    let pattern = |noise: &dyn Fn(usize, usize) -> f64| {
        let lag =
            |dx: usize, dy: usize| correlation(pixels().map(|(x, y)| (noise(x, y), noise(x + dx, y + dy))));
        [[lag(6, 0), lag(7, 0), lag(8, 0)], [lag(0, 6), lag(0, 7), lag(0, 8)]]
            .map(|[before, at, after]| at - 0.5 * (before + after))
    };
    let found = pattern(&|x, y| noises[0][y * width + x]);
    let repeated = pattern(&|x, y| noises[0][y % 7 * width + x % 7]);
    println!("across and down: {found:.3?}, of a noise that repeats {repeated:.3?}");
    assert!(found.iter().all(|more| more.abs() < 0.06), "{found:?}");
    assert!(repeated.iter().all(|more| *more > 0.2), "control: {repeated:?}");
    assert_eq!(noise_seed(9, 0.5), noise_seed(9, 0.5));
    assert_ne!(noise_seed(9, 0.5), noise_seed(8, 0.5));
    Ok(())
}

/// A metal ball under a sky of two tones shows each where its mirror direction is in it.
#[test]
fn a_metal_ball_mirrors_a_sky_of_two_tones() -> Outcome {
    let (width, height) = (256u32, 128u32);
    let tones = [1.5f32, 0.3];
    let tone = |direction: DVec3| tones[usize::from(direction.x + 0.4 * direction.y < 0.0)];
    let sky: Vec<[f32; 3]> = (0..width * height).map(|i| [tone(texel(i, width, height).0); 3]).collect();
    let mut builder = SceneBuilder::new();
    let metal =
        MaterialLook { base_color: [1.0; 4], metallic: 1.0, roughness: 0.0, ..MaterialLook::default() };
    let metal = builder.add_material(metal);
    let (columns, rows) = (192u32, 96u32);
    let corner = |i: u32, j: u32| {
        let around = std::f64::consts::TAU * f64::from(i) / f64::from(columns);
        let polar = std::f64::consts::PI * f64::from(j) / f64::from(rows);
        let flat = exact::sin(polar);
        DVec3::new(flat * exact::cos(around), exact::cos(polar), flat * exact::sin(around))
            .as_vec3()
            .to_array()
    };
    let positions: Vec<[f32; 3]> =
        (0..=rows).flat_map(|j| (0..=columns).map(move |i| corner(i, j))).collect();
    let at = |i: u32, j: u32| j * (columns + 1) + i;
    let indices: Vec<u32> = (0..rows)
        .flat_map(|j| (0..columns).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)]
        })
        .collect();
    builder.add_mesh(&MeshPart::plain(&positions, &indices, metal), &Affine3A::IDENTITY);
    let scene = builder.build(&SkyLight::new(width, height, &sky));
    let (eye, size) = (Vec3::new(0.5, 0.8, 4.0), [64, 64]);
    let view = Viewpoint { eye, forward: -eye, up: Vec3::Y, fov_y: 0.4 };
    let frame = RenderFrame::new(&scene, &view, size, 1, 1, 5)?;
    let view = SceneView { data: &scene, frame: &frame };
    let (mut counts, mut sums) = ([0; 2], [0.0; 2]);
    for (i, pixel) in view.picture().iter().enumerate() {
        let along =
            view.frame.camera.camera_direction((i % 64) as f32 + 0.5, (i / 64) as f32 + 0.5).as_dvec3();
        let (eye, along) = (eye.as_dvec3(), along.normalize());
        // Where the ray meets the ball of radius 1.
        let middle = -eye.dot(along);
        let inside = middle * middle - eye.length_squared() + 1.0;
        if inside < 0.2 {
            continue;
        }
        let normal = eye + along * (middle - inside.sqrt());
        let mirrored = along - normal * (2.0 * along.dot(normal));
        // The facets turn the mirror direction by up to 2 degrees.
        if (mirrored.x + 0.4 * mirrored.y).abs() < 0.12 {
            continue;
        }
        let expected = tone(mirrored);
        let which = usize::from(expected < 1.0);
        (counts[which], sums[which]) = (counts[which] + 1, sums[which] + f64::from(pixel[1] / expected));
        assert!((pixel[1] / expected - 1.0).abs() < 0.04, "{i}, {mirrored}: {pixel:?}, {expected}");
    }
    println!("{counts:?} pixels of both tones, {sums:?} times as bright in sum");
    assert!(counts.iter().all(|count| *count > 300), "{counts:?}");
    Ok(())
}

/// Form factor from a place on the floor to an upright rectangle that stands on it `c` away: from the place's foot to `b` aside
/// and `a` high (J. Howell, "A catalog of radiation heat transfer configuration factors", B-4).
fn form_factor(a: f64, b: f64, c: f64) -> f64 {
    let slant = (a * a + c * c).sqrt();
    (exact::atan2(b, c) - c / slant * exact::atan2(b, slant)) / std::f64::consts::TAU
}

/// A shed 4 m wide, 6 m deep and 3 m high under an even sky of 2; the door in the wall at z = 3 is 1 m wide and 2 m high.
fn shed(walls: f32, floor: f32) -> SceneData {
    let mut builder = SceneBuilder::new();
    let (walls, floor) = (builder.add_material(diffuse(walls)), builder.add_material(diffuse(floor)));
    square(&mut builder, floor, Vec3::ZERO, Vec3::Z * 3.0, Vec3::X * 2.0);
    square(&mut builder, walls, Vec3::Y * 3.0, Vec3::X * 2.0, Vec3::Z * 3.0);
    square(&mut builder, walls, Vec3::new(0.0, 1.5, -3.0), Vec3::X * 2.0, Vec3::Y * 1.5);
    for side in [-1.0, 1.0] {
        square(&mut builder, walls, Vec3::new(2.0 * side, 1.5, 0.0), Vec3::Z * 3.0, Vec3::Y * 1.5);
        square(&mut builder, walls, Vec3::new(1.25 * side, 1.5, 3.0), Vec3::X * 0.75, Vec3::Y * 1.5);
    }
    square(&mut builder, walls, Vec3::new(0.0, 2.5, 3.0), Vec3::X * 0.5, Vec3::Y * 0.5);
    builder.build(&SkyLight::uniform([2.0; 3]))
}

/// Radiance of a place on the floor of a shed, over pictures of `seeds` noises: 49 directions that all windows of a picture share meet the
/// door more or less often.
fn floor_of(scene: &SceneData, at: Vec3, seeds: u64) -> Result<f64, Box<dyn std::error::Error>> {
    let of_seed = |seed| Ok(mean(&picture(scene, at + Vec3::Y * 2.0, at, 0.08, [96, 96], seed)?));
    let means = (0..seeds).map(of_seed).collect::<Result<Vec<f64>, Box<dyn std::error::Error>>>()?;
    Ok(means.iter().sum::<f64>() / means.len() as f64)
}

/// The floor of a shed with black walls has the light of the sky that comes in through the door, at every distance.
#[test]
fn a_shed_is_lit_through_its_door() -> Outcome {
    let scene = shed(0.0, 0.5);
    for z in [2.0f32, 1.0, -1.0] {
        let found = floor_of(&scene, Vec3::new(0.0, 0.0, z), 41)?;
        let expected = 0.5 * 2.0 * 2.0 * form_factor(2.0, 0.5, 3.0 - f64::from(z));
        println!("{} m from the door: {found:.4} of {expected:.4}", 3.0 - z);
        assert!((found / expected - 1.0).abs() < 0.04, "{z}: {found}, not {expected}");
    }
    Ok(())
}

/// Radiance of a place on the floor of that shed where all surfaces have one albedo: paths from wall to wall of a box, without an end
/// but the door.
fn in_a_box(albedo: f64, z: f64, paths: u32) -> f64 {
    let (low, high) = (DVec3::new(-2.0, 0.0, -3.0), DVec3::new(2.0, 3.0, 3.0));
    let path = |path: u32| {
        let (mut at, mut normal, mut part) = (DVec3::new(0.0, 0.0, z), DVec3::Y, albedo);
        for bounce in 0.. {
            let [a, b, ..] = rng_draw([77, 5], path, bounce, 0).map(|word| f64::from(rng_unit(word)));
            // By the cosine law: a point on a sphere beside the surface.
            let (height, angle) = (2.0 * a - 1.0, std::f64::consts::TAU * b);
            let across = (1.0 - height * height).sqrt();
            let sphere = DVec3::new(across * exact::cos(angle), height, across * exact::sin(angle));
            let along = (normal + sphere).normalize();
            let to = |axis: usize| {
                let wall = if along[axis] > 0.0 { high[axis] } else { low[axis] };
                (wall - at[axis]) / along[axis]
            };
            let axis = (0..3)
                .filter(|&k| along[k].abs() > 1.0e-9 && to(k) > 1.0e-9)
                .min_by(|&a, &b| to(a).total_cmp(&to(b)));
            let Some(axis) = axis else { return 0.0 };
            at += along * to(axis);
            if axis == 2 && along.z > 0.0 && at.x.abs() < 0.5 && at.y < 2.0 {
                return 2.0 * part;
            }
            normal = DVec3::ZERO;
            normal[axis] = -along[axis].signum();
            part *= albedo;
            if part < 1.0e-4 {
                break;
            }
        }
        0.0
    };
    (0..paths).map(path).sum::<f64>() / f64::from(paths)
}

/// The depths of a white shed are as dark as light makes them that has gone from wall to wall many times.
#[test]
fn a_white_shed_is_dark_in_its_depths() -> Outcome {
    let scene = shed(0.8, 0.8);
    for z in [1.0f32, -2.0] {
        let found = floor_of(&scene, Vec3::new(0.0, 0.0, z), 41)?;
        let expected = in_a_box(0.8, f64::from(z), 200_000);
        // What is left is the light of longer paths than are followed.
        println!("{} m from the door: {found:.4} of {expected:.4}", 3.0 - z);
        assert!((found / expected - 1.0).abs() < 0.06, "{z}: {found}, not {expected}");
    }
    Ok(())
}

/// The mirror image of a red lamp in a puddle keeps its hue in a picture to look at, and is no white spot, up to three stops over.
#[test]
fn a_red_lamps_mirror_image_stays_red() -> Outcome {
    let lamp = LightSource::Point {
        position: Vec3::new(0.0, 0.8, -1.0),
        radius: 0.1,
        intensity: Vec3::new(4.0, 0.25, 0.12),
        range: 0.0,
    };
    let scene = puddle(diffuse(0.02), 0.03, 0.001, lamp);
    let pixels = picture(&scene, Vec3::new(0.0, 0.8, 1.6), Vec3::new(0.0, 0.0, 0.2), 0.5, [96, 96], 3)?;
    let brightest = pixels.iter().max_by(|a, b| a[0].total_cmp(&b[0])).ok_or("no pixel")?;
    let [r, g, b, _] = *brightest;
    assert!(r > 5.0 * g && g > b, "the image is red: {brightest:?}");
    for (stops, factor) in [1.0, 2.0, 4.0, 8.0].into_iter().enumerate() {
        let exposure = factor / r;
        let layers = ToneLayers { size: [1, 1], radiance: &[[r, g, b]], glow: &[] };
        let tone = Tone { exposure, curve: ToneCurve::Hue, edges: ToneEdges::ToneAware };
        let shown = tone_picture(&layers, &tone)[0].map(f64::from);
        println!("{stops} stops over: {shown:?}");
        let [red, green, blue] = shown;
        // Red with little orange, as the light is.
        assert!(red > 200.0 && green < 0.8 * red && green >= blue, "{stops} stops over: {shown:?}");
    }
    Ok(())
}

/// What a pane lets through it does not scatter: clear glass is dark under a lamp, glass that lets half through half as bright as paint, with
/// soft shadows and with hard ones, whatever the pixels.
#[test]
fn clear_glass_scatters_no_light_of_a_lamp() -> Outcome {
    let seen = |transmission: f32, radius: f32, edge: u32| {
        let mut builder = SceneBuilder::new();
        let glass = builder.add_material(MaterialLook { transmission, ..diffuse(0.8) });
        square(&mut builder, glass, Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0);
        let position = Vec3::new(2.0, 2.0, 1.5);
        builder.add_light(LightSource::Point { radius, position, intensity: Vec3::splat(10.0), range: 0.0 });
        let scene = builder.build(&SkyLight::uniform([0.0; 3]));
        picture(&scene, Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO, 0.7, [edge; 2], 1).map(|pixels| mean(&pixels))
    };
    for radius in [0.0, 0.1] {
        for edge in [8, 96] {
            let [opaque, half, clear] =
                [seen(0.0, radius, edge)?, seen(0.5, radius, edge)?, seen(1.0, radius, edge)?];
            println!("radius {radius}, {edge} pixels: {opaque:.4}, {half:.4}, {clear:.2e}");
            assert!(opaque > 0.1 && (half / opaque - 0.5).abs() < 0.01 && clear < 0.01 * opaque);
        }
    }
    Ok(())
}

/// A floor under an even sky shows what it reflects of it, whatever its index, its roughness and the noise: no ray counts more than
/// the lobe can give.
#[test]
fn a_floor_under_an_even_sky_is_even_with_any_noise() -> Outcome {
    for (ior, roughness) in [(1.0f32, 1.0f32), (1.0, 0.6), (1.05, 1.0), (1.2, 0.9)] {
        let mut builder = SceneBuilder::new();
        let floor = builder.add_material(MaterialLook { ior, roughness, ..diffuse(0.5) });
        square(&mut builder, floor, Vec3::ZERO, Vec3::Z * 3.0, Vec3::X * 2.0);
        let scene = builder.build(&SkyLight::uniform([2.0; 3]));
        for seed in 0..40 {
            let pixels =
                picture(&scene, Vec3::new(0.0, 2.0, 0.5), Vec3::new(0.0, 0.0, 0.5), 0.08, [96, 96], seed)?;
            let brightest = pixels.iter().map(|pixel| pixel[1]).fold(0.0, f32::max);
            let found = mean(&pixels);
            // Half of 2, and no more than a few thousandths of gloss.
            assert!((found - 1.0).abs() < 0.01, "index {ior}, roughness {roughness}, seed {seed}: {found}");
            assert!(
                brightest < 1.1,
                "index {ior}, roughness {roughness}, seed {seed}: a spot of {brightest}"
            );
        }
    }
    Ok(())
}
