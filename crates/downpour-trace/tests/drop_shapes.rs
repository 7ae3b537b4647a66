//! Drops with printed shapes and drops that are models, from the weather file to the picture.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use downpour_drop::DropShape;
use downpour_drop::mesh::DropMesh;
use downpour_math::ops::f64 as ops;
use downpour_render::camera::Viewpoint;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::{DropMasks, RainOptions, RefractionForm};
use downpour_scene::Budget;
use downpour_sim::field::{DropKind, FallingDrop};
use downpour_trace::builder::SceneBuilder;
use downpour_trace::data::SceneData;
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::{RainRefraction, Weather, load};
use glam::{DVec3, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Pixels along an edge of the pictures.
const SIZE: usize = 160;

/// Distance of the drop from the eye, m, and half the field of view, rad.
const DISTANCE: f64 = 0.5;
const HALF: f64 = 0.0125;

/// Pixels per meter at the drop.
fn scale() -> f64 {
    SIZE as f64 / (2.0 * ops::tan(HALF) * DISTANCE)
}

/// A file of triangles.
fn model(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> BTreeMap<String, Vec<u8>> {
    let (of_positions, of_triangles) = (12 * positions.len(), 12 * triangles.len());
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
            "buffers": [{{"byteLength": {}, "uri": "drop.bin"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": {of_positions}}},
                            {{"buffer": 0, "byteOffset": {of_positions}, "byteLength": {of_triangles}}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": {}, "type": "VEC3"}},
                          {{"bufferView": 1, "componentType": 5125, "count": {}, "type": "SCALAR"}}]}}"#,
        of_positions + of_triangles,
        positions.len(),
        3 * triangles.len(),
    );
    let positions = positions.iter().flatten().flat_map(|x| x.to_le_bytes());
    let binary = positions.chain(triangles.iter().flatten().flat_map(|i| i.to_le_bytes())).collect();
    [("drop.gltf".to_owned(), json.into_bytes()), ("drop.bin".to_owned(), binary)].into()
}

/// A box of 2 x 1 x 1 m.
fn brick() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let corner = |i: usize| [2.0 * (i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32];
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]];
    ((0..8).map(corner).collect(), faces.iter().flat_map(halves).collect())
}

const MODEL: &str = "[rain]\nmask_model = 'drop.gltf'\n[streaks]\nsamples = 8";

/// The masks of a weather.
fn masks(text: &str, files: &BTreeMap<String, Vec<u8>>) -> Result<DropMasks, Box<dyn std::error::Error>> {
    let weather = Weather::parse("w.toml", text)?;
    let loaded = load(&weather, files, &mut Budget::default())?;
    Ok(DropMasks::of_weather(&weather, &loaded)?)
}

fn sky(radiance: impl Fn(f32) -> [f32; 3]) -> SceneData {
    // Rows of equal angle, from the zenith.
    let sine = |row: usize| f64::from((row as f32 + 0.5) / 256.0) * PI;
    let map: Vec<[f32; 3]> = (0..512 * 256).map(|i| radiance(ops::cos(sine(i / 512)) as f32)).collect();
    SceneBuilder::new().build(&SkyLight::new(512, 256, &map))
}

/// A drop at rest, level with the eye.
fn picture(
    masks: &DropMasks,
    scene: &SceneData,
    diameter: f32,
) -> Result<Picture, Box<dyn std::error::Error>> {
    let eye = Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 2.0 * HALF as f32 };
    let drop = FallingDrop {
        position: DVec3::new(0.0, 0.0, -DISTANCE),
        velocity: [0.0; 3],
        diameter,
        id: 1,
        kind: DropKind::Falling,
        present_s: FallingDrop::ALWAYS,
        normal: FallingDrop::LEVEL,
    };
    let size = [SIZE as u32; 2];
    let options = PictureOptions {
        size,
        grid: 1,
        sky_rays: 0,
        seed: 0,
        rain: RainOptions::default(),
        ..PictureOptions::default()
    };
    Ok(render_picture(scene, &eye, &[drop], masks, &options)?)
}

/// Covered fraction of each row, in pixels.
fn widths(picture: &Picture) -> Vec<f64> {
    let covered = |row: &[[f32; 4]]| row.iter().map(|pixel| f64::from(1.0 - pixel[3])).sum();
    picture.rain.chunks(SIZE).map(covered).collect()
}

/// Half the width, in radii, of the outline `1 + sum c_n cos(n theta)` at a height, theta from the downward axis.
fn outline(printed: &[f64; 11], height: f64) -> f64 {
    let radius = |theta: f64| {
        1.0 + (0u32..).zip(printed).map(|(n, c)| c * 1.0e-4 * ops::cos(f64::from(n) * theta)).sum::<f64>()
    };
    let (mut widest, steps) = (0.0f64, 20_000);
    for k in 0..steps {
        let [near, far] = [k, k + 1].map(|k| {
            let theta = PI * f64::from(k) / f64::from(steps);
            [radius(theta) * ops::sin(theta), -radius(theta) * ops::cos(theta)]
        });
        if (near[1] - height) * (far[1] - height) <= 0.0 {
            widest = widest.max(near[0]);
        }
    }
    widest
}

/// Rousseau 2006, table 1, R = 3 mm, and Chuang & Beard 1990, d = 4 mm and 9 mm: row by row of the picture.
#[test]
fn a_printed_row_gives_the_printed_outline() -> Outcome {
    let of_3mm = [-843.0, -472.0, -2040.0, -240.0, 299.0, 168.0, -21.0, -73.0, -20.0, 25.0, 24.0];
    let of_4mm = [-481.0, -359.0, -1263.0, -244.0, 91.0, 99.0, 15.0, -25.0, -16.0, 2.0, 10.0];
    let scene = sky(|_| [1.0; 3]);
    // Root mean square of the differences of widths, over the drop's diameter.
    let off = |text: &str, diameter: f64, printed: &[f64; 11]| -> Result<f64, Box<dyn std::error::Error>> {
        let seen = widths(&picture(&masks(text, &BTreeMap::new())?, &scene, diameter as f32)?);
        let radius = 0.5 * diameter * scale();
        let squares = seen.iter().enumerate().map(|(row, width)| {
            let height = (0.5 * SIZE as f64 - (row as f64 + 0.5)) / radius;
            let off = width / (2.0 * radius) - outline(printed, height);
            off * off
        });
        Ok((squares.sum::<f64>() / SIZE as f64).sqrt())
    };
    let rousseau = "[rain]\ndrop_shape = 'rousseau-2006'";
    for text in ["", rousseau] {
        let off = off(text, 6.0e-3, &of_3mm)?;
        assert!(off < 0.01, "{text}: {off}");
    }
    // Between its rows the paper's table is another one.
    let (of_table, of_paper) = (off("", 4.0e-3, &of_4mm)?, off(rousseau, 4.0e-3, &of_4mm)?);
    assert!(of_table < 0.01 && of_paper > 1.2 * of_table, "{of_table} {of_paper}");
    // A sphere is far from both.
    let sphere = off("", 6.0e-3, &[0.0; 11])?;
    assert!(sphere > 0.05, "{sphere}");
    Ok(())
}

/// The masks of the paper's rows are those of the whole table; in the last row stands the misprint.
#[test]
fn the_tables_differ_between_the_papers_rows() -> Outcome {
    let tables =
        [masks("", &BTreeMap::new())?, masks("[rain]\ndrop_shape = 'rousseau-2006'", &BTreeMap::new())?];
    // Masks stand half a millimeter apart, from 0.5 to 9 mm.
    let each = tables[0].words.len() / 18;
    let differing: Vec<usize> = (1..=18)
        .filter(|k| tables[0].words[(k - 1) * each..k * each] != tables[1].words[(k - 1) * each..k * each])
        .collect();
    let rows_mm = [0.5, 1.0, 2.0, 6.0];
    let expected: Vec<usize> = (1..=18).filter(|&k| !rows_mm.contains(&(0.5 * k as f64))).collect();
    assert_eq!(differing, expected);
    Ok(())
}

/// A drop that is a sphere's mesh is round at any size, and shows what a sphere shows: at the fraction b of its radius above its
/// middle, light from 2 (asin b - asin(b / n)) below.
#[test]
fn the_model_of_a_sphere_shows_what_a_sphere_shows() -> Outcome {
    let sphere = DropMesh::latitude_longitude(&DropShape::sphere(2.0e-3)?, 64, 128)?;
    let masks = masks(MODEL, &model(sphere.positions(), sphere.triangles()))?;
    let scene = sky(|up| [1.0, 0.5 + 0.5 * up, 0.0]);
    for diameter in [0.4e-3, 2.0e-3, 6.0e-3] {
        let seen = widths(&picture(&masks, &scene, diameter)?);
        let radius = 0.5 * f64::from(diameter) * scale();
        let area = seen.iter().sum::<f64>() / (PI * radius * radius);
        assert!((area - 1.0).abs() < 0.01, "{diameter}: {area}");
    }
    let shown = picture(&masks, &scene, 6.0e-3)?;
    let radius = 0.5 * 6.0e-3 * scale();
    for row in [48, 56, 66, 75, 85, 94, 104, 110] {
        let fraction = (0.5 * SIZE as f64 - (row as f64 + 0.5)) / radius;
        let down = 2.0 * (ops::asin(fraction) - ops::asin(fraction / 1.3334));
        let [red, green, ..] = shown.rain[row * SIZE + SIZE / 2].map(f64::from);
        let (found, expected) = (green / red, 0.5 - 0.5 * ops::sin(down));
        // 2 % to 5 % are reflected.
        assert!((found - expected).abs() < 0.04, "{fraction}: {found}, not {expected}");
    }
    Ok(())
}

/// A brick twice as wide as tall, at the drop's volume.
#[test]
fn a_model_has_its_own_outline_and_the_drops_volume() -> Outcome {
    let (positions, triangles) = brick();
    let masks = masks(MODEL, &model(&positions, &triangles))?;
    let scene = sky(|_| [1.0; 3]);
    for diameter in [0.6e-3, 5.0e-3] {
        let seen = widths(&picture(&masks, &scene, diameter)?);
        let edge = ops::cbrt(PI / 12.0) * f64::from(diameter) * scale();
        let area = seen.iter().sum::<f64>() / (2.0 * edge * edge);
        let wide = seen.iter().copied().fold(0.0, f64::max) / (2.0 * edge);
        assert!((area - 1.0).abs() < 0.04 && (wide - 1.0).abs() < 0.06, "{diameter}: {area} {wide}");
    }
    Ok(())
}

#[test]
fn a_model_that_is_open_is_refused_with_file_and_key() {
    let (positions, mut triangles) = brick();
    triangles.pop();
    let message = masks(MODEL, &model(&positions, &triangles)).map(|_| ()).unwrap_err().to_string();
    for part in ["w.toml: rain.mask_model: drop.gltf: ", "it is open", "; allowed: a closed surface"] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

/// Rousseau 2006, 4.2.2: 512 x 512.
#[test]
fn the_papers_refraction_has_the_papers_capture() {
    let form = RefractionForm::from(RainRefraction::Rousseau2006);
    assert_eq!((form, form.capture_size()), (RefractionForm::Rousseau2006, 512));
    assert_eq!(RefractionForm::from(RainRefraction::Direction), RainOptions::default().form);
}
