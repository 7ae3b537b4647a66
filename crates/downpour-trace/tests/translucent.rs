//! Leaves: light that leaves a surface on its other side, against closed forms.

use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_shaders::render::scene::SCENE_DOUBLE_SIDED;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::material::MaterialLook;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, DVec3, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Reflects `1 - part` of `base`, transmits `part` of `through`; matte.
fn leaf(base: [f32; 3], part: f32, through: [f32; 3]) -> MaterialLook {
    let [r, g, b] = base;
    MaterialLook {
        base_color: [r, g, b, 1.0],
        diffuse_transmission: part,
        diffuse_transmission_color: through,
        flags: SCENE_DOUBLE_SIDED,
        roughness: 1.0,
        ior: 1.0,
        ..MaterialLook::default()
    }
}

/// A level square with edges of 20 m at a height.
fn level(builder: &mut SceneBuilder, look: MaterialLook, height: f32) {
    let material = builder.add_material(look);
    let positions =
        [[-10.0, height, -10.0], [-10.0, height, 10.0], [10.0, height, 10.0], [10.0, height, -10.0]];
    let part = MeshPart::plain(&positions, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

/// Mean of a small picture in the direction of the middle from an eye.
fn seen(scene: &SceneData, eye: Vec3, rays: u32) -> Result<DVec3, Box<dyn std::error::Error>> {
    let view = Viewpoint { eye, forward: -eye, up: Vec3::X, fov_y: 0.1 };
    let frame = RenderFrame::new(scene, &view, [24, 24], 2, rays, 5)?;
    let picture = SceneView { data: scene, frame: &frame }.picture();
    let sum: DVec3 =
        picture.iter().map(|&[r, g, b, _]| DVec3::new(f64::from(r), f64::from(g), f64::from(b))).sum();
    Ok(sum / picture.len() as f64)
}

/// Fraction of light that enters a medium of index 1 by Schlick's formula, at a cosine between view and half-way vector.
fn entering(cosine: f64) -> f64 {
    let rest = 1.0 - cosine;
    let square = rest * rest;
    1.0 - square * square * rest
}

/// The sun above a level leaf, seen from below: transmitted irradiance over pi; from above: reflected. Colors stay apart.
#[test]
fn the_sun_shines_through_a_leaf() -> Outcome {
    let (base, part, through) = ([0.2, 0.5, 0.1], 0.6f32, [0.3, 0.8, 0.05]);
    let mut builder = SceneBuilder::new();
    level(&mut builder, leaf(base, part, through), 0.0);
    let direction = Vec3::new(0.6, -0.8, 0.0);
    builder.add_light(LightSource::Directional { direction, irradiance: Vec3::splat(40.0) });
    let scene = builder.build(&SkyLight::uniform([0.0; 3]));
    let level_irradiance = 40.0 * 0.8 / std::f64::consts::PI;
    for (height, color, part) in [(-3.0, through, part), (3.0, base, 1.0 - part)] {
        let shown = seen(&scene, Vec3::new(0.0, height, 0.0), 1)?;
        // The viewer is along the normal, or along the normal behind, and the sun at a cosine of 0.8 to it: half of that angle.
        let factor = level_irradiance * f64::from(part) * entering((0.9f64).sqrt());
        let expected = DVec3::from(color.map(f64::from)) * factor;
        let error = ((shown - expected) / expected).abs().max_element();
        assert!(error < 2.0e-3, "from {height} m: {shown} and not {expected}");
    }
    Ok(())
}

/// White and half of it transmitted: in an even sky such a leaf is as bright as the sky, alone or among others.
#[test]
fn a_white_leaf_is_lost_in_an_even_sky() -> Outcome {
    for rays in [1, 4] {
        for (layers, allowed) in [(1, 5.0e-4), (3, 1.0e-2)] {
            let mut builder = SceneBuilder::new();
            for k in 0..layers {
                level(&mut builder, leaf([1.0; 3], 0.5, [1.0; 3]), k as f32 * 4.0);
            }
            let scene = builder.build(&SkyLight::uniform([2.0; 3]));
            let shown = seen(&scene, Vec3::new(0.0, -3.0, 0.0), rays)?;
            let error = (shown / 2.0 - 1.0).abs().max_element();
            assert!(error < allowed, "{rays} rays, {layers} layers: {shown}");
        }
    }
    Ok(())
}

/// Sky above and black ground: from below the leaf shows what it transmits, from above what it reflects.
#[test]
fn each_side_has_its_own_sky() -> Outcome {
    let sky: Vec<[f32; 3]> = (0..64 * 32).map(|i| if i / 64 < 16 { [3.0; 3] } else { [0.0; 3] }).collect();
    let mut builder = SceneBuilder::new();
    level(&mut builder, leaf([0.5; 3], 0.6, [0.9; 3]), 0.0);
    let scene = builder.build(&SkyLight::new(64, 32, &sky));
    for (height, albedo) in [(-3.0, 0.54), (3.0, 0.2)] {
        let shown = seen(&scene, Vec3::new(0.0, height, 0.0), 4)?;
        let expected = 3.0 * albedo;
        assert!((shown.y / expected - 1.0).abs() < 0.05, "from {height} m: {shown} and not {expected}");
    }
    Ok(())
}

/// A leaf under a lit leaf gets what that transmits: of an even sky above, T of the light, and what both throw back and forth.
#[test]
fn leaves_light_each_other() -> Outcome {
    let sky: Vec<[f32; 3]> = (0..64 * 32).map(|i| if i / 64 < 16 { [3.0; 3] } else { [0.0; 3] }).collect();
    let mut builder = SceneBuilder::new();
    for height in [0.0, 0.05] {
        level(&mut builder, leaf([0.8; 3], 0.5, [0.8; 3]), height);
    }
    let scene = builder.build(&SkyLight::new(64, 32, &sky));
    let shown = seen(&scene, Vec3::new(0.0, -3.0, 0.0), 8)?;
    // Two layers of R = T = 0.4: T squared over 1 - R squared.
    let expected = 3.0 * 0.16 / (1.0 - 0.16);
    assert!((shown.y / expected - 1.0).abs() < 0.08, "{shown} and not {expected}");
    Ok(())
}
