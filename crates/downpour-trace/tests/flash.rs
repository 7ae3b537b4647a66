//! A scene in the light of lightning alone: shadows, and what else may not shine.

use downpour_math::ops::f64 as exact;
use downpour_render::camera::Viewpoint;
use downpour_scene::scene::{Light, LightKind, Local, Material, Mesh, Node, Primitive, Scene};
use downpour_scene::sky::{SkyMap, Sun};
use downpour_trace::data::RenderFrame;
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::scene::SceneView;
use downpour_weather::{FlashLight, Loaded, Weather};
use glam::{Affine3A, Vec2, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// A square by its middle and half its edges, of a material.
fn square(material: usize, middle: Vec3, across: Vec3, along: Vec3) -> Primitive {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let positions: Vec<Vec3> = corners.iter().map(|(x, y)| middle + across * *x + along * *y).collect();
    Primitive {
        normals: vec![across.cross(along).normalize(); 4],
        uvs: [vec![Vec2::ZERO; 4], Vec::new()],
        indices: vec![0, 1, 2, 0, 2, 3],
        bounds: downpour_scene::scene::Bounds { min: Vec3::splat(-50.0), max: Vec3::splat(50.0) },
        material,
        positions,
        ..Primitive::default()
    }
}

/// Poles of 2 cm and 3 m on a square of ground, 24 m wide; a lamp, a sun and a sky that shine, and ground that glows.
fn scene(poles: &[Vec3]) -> Loaded {
    let white = Material {
        base_color: glam::Vec4::new(0.5, 0.5, 0.5, 1.0),
        emissive: Vec3::splat(7.0),
        metallic: 0.0,
        ..Material::default()
    };
    let pole = Material { emissive: Vec3::splat(3.0), ..white.clone() };
    let mut primitives = vec![square(0, Vec3::ZERO, Vec3::X * 12.0, Vec3::NEG_Z * 12.0)];
    for foot in poles {
        for across in [Vec3::X, Vec3::Z] {
            primitives.push(square(1, *foot + Vec3::Y * 1.5, across * 0.01, Vec3::Y * 1.5));
        }
    }
    let meshes = vec![Mesh { primitives, ..Mesh::default() }];
    let lamp = Light {
        name: String::new(),
        color: Vec3::ONE,
        intensity: 900.0,
        range: None,
        radius: None,
        kind: LightKind::Point,
    };
    let at = Local::Matrix(Affine3A::from_translation(Vec3::new(1.0, 4.0, 0.0)));
    let nodes = vec![
        Node { mesh: Some(0), ..Node::default() },
        Node { light: Some(0), local: at, ..Node::default() },
    ];
    Loaded {
        scene: Scene {
            materials: vec![white, pole],
            meshes,
            nodes,
            lights: vec![lamp],
            roots: vec![0, 1],
            ..Scene::default()
        },
        animations: Vec::new(),
        moving: Vec::new(),
        sky: SkyMap::uniform([5.0; 3]),
        sun: Some(Sun { direction: [0.0, 1.0, 0.0], irradiance_rgb: [50.0; 3], angular_radius: 0.005 }),
        unscaled: None,
        masks: Vec::new(),
        drop_model: None,
        warnings: Vec::new(),
    }
}

/// The ground from straight above, 12 m by 12 m about a point, in the light of one flash.
fn from_above(
    poles: &[Vec3],
    flash: &FlashLight,
    middle: Vec3,
) -> Result<Vec<f32>, Box<dyn std::error::Error>> {
    let mut weather = Weather::default();
    weather.wetness.is_enabled = false;
    let frame_scene = FrameScene::new(&weather, &scene(poles), 0.0)?.in_flash(&weather, 0.0, &[*flash]);
    // A narrow view from far away is all but parallel.
    let fov_y = 2.0 * downpour_math::ops::atan(6.0 / 600.0);
    let view = Viewpoint { eye: middle + Vec3::Y * 600.0, forward: Vec3::NEG_Y, up: Vec3::NEG_Z, fov_y };
    let frame = RenderFrame::new(&frame_scene.data, &view, [EDGE, EDGE], 2, 1, 3)?;
    let picture = SceneView { data: &frame_scene.data, frame: &frame }.picture();
    Ok(picture.iter().map(|pixel| pixel[1]).collect())
}

const EDGE: u32 = 600;

/// Direction of the shadow of a pole in a picture, in radians: the axis of what is darker than half.
fn shadow_angle(picture: &[f32]) -> f64 {
    let lit = picture.iter().copied().fold(0.0f32, f32::max);
    let mut sums = [0.0f64; 6];
    for (k, value) in (0..EDGE * EDGE).zip(picture) {
        let weight = f64::from((1.0 - value / lit).max(0.0));
        let (x, y) = (f64::from(k % EDGE) - 300.0, f64::from(k / EDGE) - 300.0);
        if weight > 0.05 {
            for (sum, part) in sums.iter_mut().zip([1.0, x, y, x * x, x * y, y * y]) {
                *sum += weight * part;
            }
        }
    }
    let [n, x, y, xx, xy, yy] = sums;
    let (xx, xy, yy) = (xx / n - x * x / (n * n), xy / n - x * y / (n * n), yy / n - y * y / (n * n));
    0.5 * exact::atan2(2.0 * xy, xx - yy)
}

fn flash(azimuth_deg: f64, elevation_deg: f64) -> FlashLight {
    let (azimuth, elevation) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
    let flat = exact::cos(elevation);
    let towards = [flat * exact::cos(azimuth), exact::sin(elevation), flat * exact::sin(azimuth)];
    FlashLight { towards, color: [1.0; 3], illuminance_lux: 400.0, clouds: 0.0 }
}

/// Shadows of poles all over the ground are parallel to each other and point away from the flash, within 0.1 degree.
#[test]
fn shadows_of_poles_are_parallel() -> Outcome {
    for azimuth in [25.0f64, 115.0] {
        let light = flash(azimuth, 40.0);
        for foot in [Vec3::ZERO, Vec3::new(5.0, 0.0, 4.0), Vec3::new(-6.0, 0.0, -5.0)] {
            let found = shadow_angle(&from_above(&[foot], &light, foot)?).to_degrees();
            // Columns go along +X, rows along +Z.
            let apart = (found - azimuth + 270.0).rem_euclid(180.0) - 90.0;
            assert!(apart.abs() < 0.1, "{azimuth}: {found} at {foot}");
        }
    }
    Ok(())
}

/// Nothing else shines: open ground has the flash's light, and a shadow none; a level surface has E sin(elevation) albedo / pi.
#[test]
fn nothing_shines_but_the_flash() -> Outcome {
    let picture = from_above(&[], &flash(25.0, 40.0), Vec3::ZERO)?;
    let mut sorted = picture.clone();
    sorted.sort_by(f32::total_cmp);
    let middle = f64::from(sorted[sorted.len() / 2]);
    // Diffuse alone; the gloss of a rough dielectric adds some hundredths.
    let expected = 400.0 * exact::sin(40.0f64.to_radians()) * 0.5 / std::f64::consts::PI;
    assert!((0.95..1.15).contains(&(middle / expected)), "{middle} {expected}");
    let double = from_above(&[], &FlashLight { illuminance_lux: 800.0, ..flash(25.0, 40.0) }, Vec3::ZERO)?;
    assert!(double.iter().zip(&picture).all(|(two, one)| (two - 2.0 * one).abs() <= 1.0e-5 * one));
    let dark = from_above(&[], &FlashLight { illuminance_lux: 0.0, ..flash(25.0, 40.0) }, Vec3::ZERO)?;
    assert!(dark.iter().all(|value| *value == 0.0));
    Ok(())
}
