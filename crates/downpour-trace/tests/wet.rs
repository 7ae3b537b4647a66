//! Surfaces that rain has made wet: energy, darkness, roofs, and what the film mirrors.

use std::collections::BTreeMap;

use downpour_math::ops::f64 as exact;
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_scene::Budget;
use downpour_trace::SceneWetness;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::material::MaterialLook;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::{Weather, WetnessAt};
use glam::{Affine3A, DVec3, Vec3};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// Wet through and through, by rain that falls straight down.
const SOAKED: SceneWetness = SceneWetness {
    at: WetnessAt { before: 30.0, kept: 1.0, since: 0.0 },
    towards: Vec3::Y,
    shift: Vec3::ZERO,
};

fn look(albedo: f32, roughness: f32, porosity: f32) -> MaterialLook {
    MaterialLook {
        base_color: [albedo, albedo, albedo, 1.0],
        roughness,
        porosity: Some(porosity),
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

fn ground(look: MaterialLook) -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    let material = builder.add_material(look);
    square(&mut builder, material, Vec3::ZERO, Vec3::Z * 60.0, Vec3::X * 60.0);
    builder
}

/// A picture from an eye toward a point.
fn picture(
    scene: &SceneData,
    eye: Vec3,
    at: Vec3,
    fov_y: f32,
    size: [u32; 2],
    sky_rays: u32,
) -> Outcome<Vec<[f32; 4]>> {
    let up = if (at - eye).normalize().y.abs() > 0.99 { Vec3::X } else { Vec3::Y };
    let view = Viewpoint { eye, forward: at - eye, up, fov_y };
    let frame = RenderFrame::new(scene, &view, size, 1, sky_rays, 5)?;
    Ok(SceneView { data: scene, frame: &frame }.picture())
}

fn mean(picture: &[[f32; 4]]) -> f64 {
    picture.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / picture.len() as f64
}

/// Position of an eye that sees a ground at an angle from the normal.
fn seen_at(degrees: f64) -> Vec3 {
    let angle = degrees.to_radians();
    Vec3::new(exact::sin(angle) as f32, exact::cos(angle) as f32, 0.0) * 3.0
}

/// White ground under an even sky gives back all light, at any angle, wet or half wet, smooth or porous.
#[test]
fn a_wet_white_ground_is_white() -> Outcome {
    for porosity in [0.0, 1.0] {
        let mut scene = ground(look(1.0, 0.85, porosity)).build(&SkyLight::uniform([1.0; 3]));
        for wetness in [SOAKED, SceneWetness { at: WetnessAt { before: 1.2, ..SOAKED.at }, ..SOAKED }] {
            scene.set_wetness(Some(&wetness));
            for degrees in [5.0, 30.0, 50.0, 65.0, 75.0, 82.0] {
                let found = mean(&picture(&scene, seen_at(degrees), Vec3::ZERO, 0.05, [24, 24], 24)?);
                // What is not covered by the film keeps the law of dry surfaces, which gives back a little more or less.
                let allowed = if wetness == SOAKED { 5.0e-3 } else { 3.0e-2 };
                assert!((found - 1.0).abs() < allowed, "{porosity} {wetness:?} {degrees}: {found}");
            }
        }
    }
    Ok(())
}

/// Fraction of diffuse light that an interface of index n reflects from outside: Fresnel's equations over the hemisphere.
fn outside(n: f64) -> f64 {
    let steps = 200_000u32;
    let sum: f64 = (0..steps)
        .map(|k| {
            let cosine = (f64::from(k) + 0.5) / f64::from(steps);
            let inner = (1.0 - (1.0 - cosine * cosine) / (n * n)).sqrt();
            let across = (cosine - n * inner) / (cosine + n * inner);
            let along = (n * cosine - inner) / (n * cosine + inner);
            (across * across + along * along) * cosine
        })
        .sum();
    sum / f64::from(steps)
}

/// Luminances of a wet surface of albedo `dry` under an even sky of 1, seen along its normal: porous through and through, and of paint.
///
/// J. Lekner and M. Dorf 1988: a surface that absorbs `a` of the light each time, under water of index n: of the light that goes in,
/// `p = 1 - (1 - R) / n^2` is thrown back to it each time. It absorbs `(1 - R) a / (1 - p (1 - a))` of what falls on it, and the
/// rest goes back, of which R has never been inside. The same light under an even sky, seen from above with the reflection at
/// normal incidence `r` in the place of R on the way out.
///
/// Paint is not darker: what it has lost to the inside of its own surface it has lost when dry, too.
fn lekner_and_dorf(dry: f64) -> [f64; 2] {
    let n = 1.333f64;
    let back = outside(n);
    let inside = 1.0 - (1.0 - back) / (n * n);
    let absorbed = (1.0 - back) * (1.0 - dry) / (1.0 - inside * dry);
    // All that comes out of the water, over all directions; and toward an eye above it, where it reflects less.
    let diffuse = 1.0 - back - absorbed;
    let of = |a: f64, b: f64| ((a - b) / (a + b)) * ((a - b) / (a + b));
    // Gloss: of air and water, and of water and the base, whose index is 1.5; and the tops of the grains, of 15 % of the
    // surface, which stand out of the film.
    let both = of(n, 1.0) + (1.0 - of(n, 1.0)) * (1.0 - of(n, 1.0)) * of(1.5, n);
    let gloss = 0.85 * both + 0.15 * of(1.5, 1.0);
    [diffuse / (1.0 - back) * (1.0 - gloss) + gloss, dry * (1.0 - both) + both]
}

#[test]
fn porous_ground_is_as_dark_as_lekner_and_dorf_say() -> Outcome {
    for dry in [0.05, 0.12, 0.2, 0.4, 0.7] {
        for (porosity, expected) in [1.0, 0.0].into_iter().zip(lekner_and_dorf(dry)) {
            let mut scene = ground(look(dry as f32, 0.85, porosity)).build(&SkyLight::uniform([1.0; 3]));
            scene.set_wetness(Some(&SOAKED));
            let found = mean(&picture(&scene, Vec3::Y * 3.0, Vec3::ZERO, 0.05, [24, 24], 24)?);
            assert!((found / expected - 1.0).abs() < 0.03, "{porosity}, {dry}: {found}, {expected}");
        }
    }
    Ok(())
}

/// A wall that faces +X, of albedo 0.4, whose file gives it a porosity of 0.5.
fn wall_files() -> BTreeMap<String, Vec<u8>> {
    let json = r#"{
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0}]}],
        "materials": [{
            "name": "wall", "extras": {"porosity": 0.5},
            "pbrMetallicRoughness": {"baseColorFactor": [0.4, 0.4, 0.4, 1], "metallicFactor": 0, "roughnessFactor": 0.85}
        }],
        "buffers": [{"byteLength": 144, "uri": "wall.bin"}],
        "bufferViews": [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 72}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [0, -60, -60], "max": [0, 60, 60]},
            {"bufferView": 1, "componentType": 5126, "count": 6, "type": "VEC3"}
        ]
    }"#;
    let [a, b, c, d] =
        [(-60.0, 60.0), (-60.0, -60.0), (60.0, -60.0), (60.0, 60.0f32)].map(|(y, z)| [0.0, y, z]);
    let numbers = [[a, b, c, a, c, d], [[1.0, 0.0, 0.0]; 6]];
    let binary = numbers.as_flattened().as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    [("wall.gltf", json.as_bytes().to_vec()), ("wall.bin", binary)]
        .map(|(name, it)| (name.to_owned(), it))
        .into()
}

/// Luminance of that wall in a weather file whose wind drives the rain toward it, after `seconds`; the wall's own entry has `keys`.
fn wall_of_a_file(keys: &str, porosity: Option<f64>, seconds: f64) -> Outcome<f64> {
    let material =
        porosity.map_or_else(String::new, |p| format!("[[material]]\nname = \"wall\"\nporosity = {p}\n"));
    let text = format!(
        "[sky]\ncolor = [1, 1, 1]\n[wetness]\nwetness = 1\n[[wind]]\nuniform = {{ speed_m_s = 10, towards_deg = 180 }}\n\
         [camera]\nposition_m = [3, 0, 0]\nlook_at_m = [0, 0, 0]\nfov_deg = 3\n[output]\nsize = [24, 24]\n\
         [[model]]\nfile = \"wall.gltf\"\n{keys}\n{material}"
    );
    let weather = Weather::parse("wall.toml", &text)?;
    let loaded = downpour_weather::load(&weather, &wall_files(), &mut Budget::default())?;
    let first = FrameScene::new(&weather, &loaded, 0.0)?;
    let scene = if loaded.is_animated() { first.moved(&weather, &loaded, seconds)? } else { first };
    let frame = RenderFrame::new(&scene.data, &scene.viewpoint, scene.size, 1, 24, 5)?;
    Ok(mean(&SceneView { data: &scene.data, frame: &frame }.picture()))
}

/// `[[material]]` in a weather file replaces the porosity of a model: a porous wall is as dark as the law says, and one of paint keeps its
/// albedo under the film. So it is for a wall that moves.
#[test]
fn a_wall_is_as_porous_as_its_weather_file_says() -> Outcome {
    let [porous, paint] = lekner_and_dorf(0.4);
    // It slides along itself.
    let moves = "translation_m = [[0, [0, 0, 0]], [2, [0, 1, 3]]]";
    for keys in ["", moves] {
        let own = wall_of_a_file(keys, None, 1.0)?;
        for (porosity, expected) in [(1.0, porous), (0.0, paint)] {
            let found = wall_of_a_file(keys, Some(porosity), 1.0)?;
            assert!((found / expected - 1.0).abs() < 0.03, "{keys} {porosity}: {found}, {expected}");
            assert!((found - own).abs() > 0.1 * own, "{keys} {porosity}: {found}, as by its file: {own}");
        }
        // To give what the file gives changes nothing.
        assert_eq!(wall_of_a_file(keys, Some(0.5), 1.0)?, own);
    }
    Ok(())
}

/// A ground under a lamp straight above: light goes in at 1 - r and comes out at 1 - r, thrown back in between.
#[test]
fn lamps_light_what_is_under_the_film() -> Outcome {
    let n = 1.333f64;
    let normal = ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
    let back = outside(n);
    let inside = 1.0 - (1.0 - back) / (n * n);
    let mut builder = ground(look(0.3, 0.85, 1.0));
    builder.add_light(LightSource::Directional { direction: Vec3::NEG_Y, irradiance: Vec3::splat(10.0) });
    let mut scene = builder.build(&SkyLight::uniform([0.0; 3]));
    scene.set_wetness(Some(&SOAKED));
    // From 45 degrees: away from the lamp's own image.
    let found = mean(&picture(&scene, seen_at(45.0), Vec3::ZERO, 0.05, [16, 16], 0)?);
    let cosine = exact::cos(45.0f64.to_radians());
    let inner = (1.0 - (1.0 - cosine * cosine) / (n * n)).sqrt();
    let across = (cosine - n * inner) / (cosine + n * inner);
    let along = (n * cosine - inner) / (n * cosine + inner);
    let out = 1.0 - 0.5 * (across * across + along * along);
    let expected = 10.0 / std::f64::consts::PI * (1.0 - normal) * out / (n * n) * 0.3 / (1.0 - inside * 0.3);
    assert!((found / expected - 1.0).abs() < 0.03, "{found}, {expected}");
    Ok(())
}

/// Under a roof 3 m high it is exactly as dry as without rain, but for 10 cm along its edge; in the open it is wet.
#[test]
fn nothing_is_wet_under_a_roof() -> Outcome {
    let build = || {
        let mut builder = ground(look(0.4, 0.85, 1.0));
        let roof = builder.add_material(look(0.0, 1.0, 0.0));
        square(&mut builder, roof, Vec3::new(-10.0, 3.0, 0.0), Vec3::Z * 40.0, Vec3::X * 10.0);
        builder.build(&SkyLight::uniform([1.0; 3]))
    };
    let dry = build();
    let mut wet = build();
    wet.set_wetness(Some(&SOAKED));
    let mut edge = [f32::MAX, f32::MIN];
    // Columns of 5 mm across the roof's edge, at x = 0, seen from beneath it; without rays, so that the light is the same all over.
    for k in -100..100i16 {
        let x = f32::from(k) * 5.0e-3;
        let [before, after] = [&dry, &wet].map(|scene| {
            let at = Vec3::new(x, 0.0, 0.1);
            picture(scene, at + Vec3::Y * 1.5, at, 0.002, [1, 24], 0)
        });
        let changed = before?.iter().zip(after?).filter(|(a, b)| **a != *b).count();
        if changed > 0 {
            edge[0] = edge[0].min(x);
        }
        if changed < 24 {
            edge[1] = edge[1].max(x);
        }
        if x <= -0.05 {
            assert_eq!(changed, 0, "wet {x} m under the roof");
        }
        if x >= 0.05 {
            assert_eq!(changed, 24, "dry {x} m outside of the roof");
        }
    }
    assert!(edge[1] - edge[0] < 0.1 && edge[0] < edge[1], "{edge:?}");
    Ok(())
}

/// Hills of a million triangles: darker in the rain, and under a roof exactly as dry as before.
#[test]
fn a_model_of_a_million_triangles_is_wet_where_it_rains() -> Outcome {
    let count = 709;
    let place = |i: usize| {
        let [x, z] = [i % count, i / count].map(|at| at as f64 * 0.05 - 17.7);
        [x as f32, (0.2 * exact::sin(x) * exact::cos(0.7 * z)) as f32, z as f32]
    };
    let positions: Vec<[f32; 3]> = (0..count * count).map(place).collect();
    let cell = |i: usize| {
        let at = (i / (count - 1) * count + i % (count - 1)) as u32;
        let below = at + count as u32;
        [at, below, at + 1, at + 1, below, below + 1]
    };
    let indices: Vec<u32> = (0..(count - 1) * (count - 1)).flat_map(cell).collect();
    assert!(indices.len() > 3_000_000);
    let mut builder = SceneBuilder::new();
    let material = builder.add_material(look(0.3, 0.85, 1.0));
    builder.add_mesh(&MeshPart::plain(&positions, &indices, material), &Affine3A::IDENTITY);
    square(&mut builder, material, Vec3::new(8.0, 3.0, 0.0), Vec3::Z * 4.0, Vec3::X * 4.0);
    let mut scene = builder.build(&SkyLight::uniform([1.0; 3]));
    let seen = |scene: &SceneData, x: f32| {
        let at = Vec3::new(x, 0.0, 0.3);
        picture(scene, at + Vec3::Y * 1.8, at, 0.5, [16, 16], 0).map(|picture| mean(&picture))
    };
    let [open, roofed] = [seen(&scene, -8.0)?, seen(&scene, 8.0)?];
    scene.set_wetness(Some(&SOAKED));
    let [wet, below] = [seen(&scene, -8.0)?, seen(&scene, 8.0)?];
    assert!(wet < 0.8 * open && below == roofed, "{open} and {wet}, {roofed} and {below}");
    Ok(())
}

/// A wall meets the rain that the wind brings, and none without wind; rain from behind leaves it dry.
#[test]
fn walls_are_wet_toward_the_wind() -> Outcome {
    let mut builder = SceneBuilder::new();
    let wall = builder.add_material(look(0.4, 0.85, 1.0));
    // It faces +X.
    square(&mut builder, wall, Vec3::ZERO, Vec3::Y * 5.0, Vec3::Z * 5.0);
    let mut scene = builder.build(&SkyLight::uniform([1.0; 3]));
    let seen = |scene: &SceneData| -> Outcome<f64> {
        Ok(mean(&picture(scene, Vec3::X * 3.0, Vec3::ZERO, 0.05, [8, 8], 0)?))
    };
    let dry = seen(&scene)?;
    let at = WetnessAt { before: 0.5, kept: 1.0, since: 0.0 };
    let mut last = dry;
    for (wind, changes) in [(-0.5, false), (0.0, false), (0.2, true), (0.6, true)] {
        let towards = Vec3::new(wind, 1.0, 0.0).normalize();
        scene.set_wetness(Some(&SceneWetness { at, towards, shift: Vec3::ZERO }));
        let found = seen(&scene)?;
        assert_eq!(found < last, changes, "{wind}: {found}, {last}");
        if !changes {
            assert_eq!(found, dry, "{wind}");
        }
        last = found;
    }
    Ok(())
}

/// A scene without wetness, and one that was wet and is dry again, are the same to the bit.
#[test]
fn a_dry_scene_is_the_same_to_the_bit() -> Outcome {
    let mut builder = ground(look(0.4, 0.85, 1.0));
    builder.add_light(LightSource::Point {
        radius: 0.0,
        position: Vec3::Y * 2.0,
        intensity: Vec3::ONE,
        range: 0.0,
    });
    let mut scene = builder.build(&SkyLight::uniform([1.0; 3]));
    let table = scene.table.clone();
    let shot = |scene: &SceneData| picture(scene, Vec3::new(1.0, 1.5, 2.0), Vec3::ZERO, 0.8, [24, 16], 1);
    let dry = shot(&scene)?;
    scene.set_wetness(Some(&SOAKED));
    let wet = shot(&scene)?;
    assert_ne!(dry, wet);
    // In place, for another time.
    let rows = scene.table.len();
    let half = SceneWetness { at: WetnessAt { before: 0.3, ..SOAKED.at }, ..SOAKED };
    scene.set_wetness(Some(&half));
    assert_eq!(scene.table.len(), rows);
    assert_ne!(shot(&scene)?, wet);
    scene.set_wetness(Some(&SOAKED));
    assert_eq!(shot(&scene)?, wet);
    scene.set_wetness(None);
    assert_eq!(scene.table, table);
    assert_eq!(shot(&scene)?, dry);
    // Wet with nothing that has fallen: as dry.
    scene.set_wetness(Some(&SceneWetness { at: WetnessAt { before: 0.0, ..SOAKED.at }, ..SOAKED }));
    assert_eq!(shot(&scene)?, dry);
    Ok(())
}

/// A red sign 2 m over wet ground has its image 2 m beneath it, stretched toward the viewer, in its color; on dry ground there is none.
#[test]
fn a_red_sign_has_its_image_in_wet_ground() -> Outcome {
    let mut builder = ground(look(0.05, 0.85, 1.0));
    let sign = builder.add_material(MaterialLook { emission: [40.0, 4.0, 2.0], ..look(0.0, 1.0, 0.0) });
    // It faces the eye, which is at +Z.
    square(&mut builder, sign, Vec3::new(0.0, 2.0, 0.0), Vec3::X * 0.4, Vec3::Y * 0.2);
    let mut scene = builder.build(&SkyLight::uniform([0.02; 3]));
    let (eye, size) = (Vec3::new(0.0, 1.5, 12.0), [48, 96]);
    // Down over the ground between the eye and the sign.
    let shot = |scene: &SceneData| picture(scene, eye, Vec3::new(0.0, 0.0, 6.0), 0.4, size, 2);
    let column = |picture: &[[f32; 4]], channel: usize| -> Vec<f64> {
        let width = size[0] as usize;
        let of_row = |row: &[[f32; 4]]| row.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>();
        picture.chunks(width).map(of_row).collect()
    };
    let dry = shot(&scene)?;
    scene.set_wetness(Some(&SOAKED));
    let wet = shot(&scene)?;
    let [red, green, blue] = [0, 1, 2].map(|channel| {
        let wet = column(&wet, channel);
        // The sky has no part in the image.
        let least = wet.iter().copied().fold(f64::MAX, f64::min);
        wet.into_iter().map(|light| light - least).collect::<Vec<_>>()
    });
    let sum = |light: &[f64]| light.iter().sum::<f64>();
    assert!(sum(&red) > 6.0 * sum(&green) && sum(&green) > 1.2 * sum(&blue), "hue");
    // Light that microfacets mirror toward the eye, row by row, by the law of GGX in double precision.
    let expected: Vec<f64> = (0..size[1]).map(|row| film_image(below(f64::from(row), size[1]))).collect();
    let peak = |light: &[f64]| {
        let most = light.iter().copied().fold(0.0, f64::max);
        let half: Vec<usize> = (0..light.len()).filter(|&k| light[k] > 0.5 * most).collect();
        let middle = half.iter().sum::<usize>() as f64 / half.len() as f64;
        (below(middle, size[1]), half.len() as f64 * 0.4 / f64::from(size[1]))
    };
    let ((at, long), (expected_at, expected_long)) = (peak(&red), peak(&expected));
    assert!((at - expected_at).abs() < 0.02, "{at}, {expected_at}");
    assert!((long / expected_long - 1.0).abs() < 0.15, "{long}, {expected_long}");
    // The mirror image of the sign is 2 m under the ground, 12 m away, and 0.4 m high: the film's is longer, toward the horizon and the eye.
    let mirrored = exact::atan2(1.5 + 2.0, 12.0);
    assert!((at - mirrored).abs() < 0.06 && long > 2.0 * 0.4 / 12.0, "{at}, {mirrored}, {long}");
    assert!(sum(&column(&dry, 0)) < 0.7 * sum(&column(&wet, 0)), "the dry ground shows it as well");
    Ok(())
}

/// Angle below the horizon of a row of a picture of `rows` rows, 0.4 rad high, from 1.5 m over a ground whose middle is 6 m away.
fn below(row: f64, rows: u32) -> f64 {
    let up = exact::tan(0.2) * (1.0 - 2.0 * (row + 0.5) / f64::from(rows));
    exact::atan2(1.5, 6.0) - exact::atan2(up, 1.0)
}

/// Light of the sign of the test above in a film whose relief is not resolved, along the middle of the picture.
fn film_image(below: f64) -> f64 {
    // Alpha: 0.05, and three octaves of slopes of 0.04 times a mean square of 0.883 (of two components of value noise).
    let a2 = 0.05f64 * 0.05 + 3.0 * 0.04 * 0.04 * 0.883;
    let away = 1.5 / exact::tan(below);
    let view = DVec3::new(0.0, exact::sin(below), exact::cos(below));
    let (mut sum, steps) = (0.0, 40);
    for i in 0..steps {
        for j in 0..steps {
            let part = |k: i32| (f64::from(k) + 0.5) / f64::from(steps) * 2.0 - 1.0;
            let to = DVec3::new(0.4 * part(i), 2.0 + 0.2 * part(j), away - 12.0);
            let square = to.length_squared();
            let light = to.normalize();
            let half = (view + light).normalize();
            let narrow = half.y * half.y * (a2 - 1.0) + 1.0;
            let d = a2 / (std::f64::consts::PI * narrow * narrow);
            let smith = |c: f64, other: f64| other * (c * c * (1.0 - a2) + a2).sqrt();
            let visibility = 0.5 / (smith(view.y, light.y) + smith(light.y, view.y));
            let cosine = view.dot(half);
            let inner = (1.0 - (1.0 - cosine * cosine) / (1.333 * 1.333)).sqrt();
            let across = (cosine - 1.333 * inner) / (cosine + 1.333 * inner);
            let along = (1.333 * cosine - inner) / (1.333 * cosine + inner);
            let fresnel = 0.5 * (across * across + along * along);
            // The sign faces +Z.
            sum += fresnel * d * visibility * light.y * (-light.z).max(0.0) / square;
        }
    }
    sum
}
