//! Puddles before they are looked at: where water stands, what it mirrors, what it lets through, and its ripples.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::optics::optics_fresnel;
use downpour_render::camera::Viewpoint;
use downpour_scene::scene::Scene;
use downpour_scene::sky::SkyMap;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::material::MaterialLook;
use downpour_trace::puddle::relief::Relief;
use downpour_trace::puddle::{Ground, PuddleLook, PuddleMap, PuddleRows, Ripples};
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::{Loaded, Weather};
use downpour_wind::Keyed;
use glam::{Affine3A, Vec2, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// A sheet of ground, `n` squares each way, from -2 to 2 m, at a height by position.
fn sheet(builder: &mut SceneBuilder, material: u32, n: usize, height: impl Fn(Vec2) -> f32) {
    let position = |i: usize| {
        let at = |k: usize| 4.0 * k as f32 / n as f32 - 2.0;
        let (x, z) = (at(i % (n + 1)), at(i / (n + 1)));
        [x, height(Vec2::new(x, z)), z]
    };
    let positions: Vec<[f32; 3]> = (0..(n + 1) * (n + 1)).map(position).collect();
    let corner = |x: usize, z: usize| (z * (n + 1) + x) as u32;
    let indices: Vec<u32> = (0..n * n)
        .flat_map(|i| {
            let (x, z) = (i % n, i / n);
            let [a, b, c, d] = [corner(x, z), corner(x + 1, z), corner(x + 1, z + 1), corner(x, z + 1)];
            [a, c, b, a, d, c]
        })
        .collect();
    let part = MeshPart::plain(&positions, &indices, material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

fn ground(albedo: f32, n: usize, height: impl Fn(Vec2) -> f32) -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    let look =
        MaterialLook { base_color: [albedo, albedo, albedo, 1.0], roughness: 1.0, ..MaterialLook::default() };
    let material = builder.add_material(look);
    sheet(&mut builder, material, n, height);
    builder
}

fn flat(albedo: f32) -> SceneData {
    ground(albedo, 1, |_| 0.0).build(&SkyLight::new(1, 1, &[[1.0; 3]]))
}

const SQUARE: Ground = Ground { middle: Vec3::ZERO, size: Vec2::splat(3.0), turn: 0.0, reach: 0.5 };

/// Painted water of one depth in a scene, still.
fn flood(scene: &mut SceneData, depth: f32, look: PuddleLook) {
    let map = PuddleMap::painted(scene, &SQUARE, [4, 4], &[depth; 16]);
    scene.set_puddles(&PuddleRows {
        puddles: &[(map, look)],
        shape: (0, 0, 1.0),
        slopes: &[],
        shift: Vec3::ZERO,
        rings: None,
        wakes: &[],
        time_s: 0.0,
    });
}

/// Mean radiance of a small picture of the middle of the ground, from an angle over the horizon.
fn seen(scene: &SceneData, angle_deg: f32) -> Result<f32, Box<dyn std::error::Error>> {
    let angle = angle_deg.to_radians();
    let eye = Vec3::new(0.0, downpour_math::ops::sin(angle), downpour_math::ops::cos(angle)) * 3.0;
    let view = Viewpoint { eye, forward: -eye, up: Vec3::new(0.0, 1.0, -1.0e-3), fov_y: 0.01 };
    let frame = RenderFrame::new(scene, &view, [4, 4], 1, 16, 1)?;
    let picture = SceneView { data: scene, frame: &frame }.picture();
    Ok(picture.iter().map(|pixel| pixel[1]).sum::<f32>() / 16.0)
}

/// White ground under an even sky is as bright as the sky; water on it takes nothing away.
#[test]
fn clear_water_on_white_ground_is_not_seen() -> Outcome {
    let clear = PuddleLook { extinction: 0.0, ..PuddleLook::default() };
    for angle in [15.0, 40.0, 89.0] {
        let mut scene = flat(1.0);
        let dry = seen(&scene, angle)?;
        flood(&mut scene, 0.02, clear);
        let wet = seen(&scene, angle)?;
        // The ground's own gloss is a fit that keeps a few parts in a hundred to itself at grazing angles, and under water, where
        // it is a tenth, a few in a thousand.
        assert!((wet - 1.0).abs() < 6.0e-3, "{angle}: dry {dry}, wet {wet}");
    }
    Ok(())
}

/// Ground of albedo 0.2 under water: (1 - `F_d`) / n^2 of it, times what is thrown back, and Fresnel's fraction of the sky.
#[test]
fn dark_ground_is_darker_under_water_and_mirrors_by_fresnel() -> Outcome {
    for angle in [12.0f32, 30.0, 89.0] {
        let mut scene = flat(0.2);
        flood(&mut scene, 0.01, PuddleLook { extinction: 0.0, ..PuddleLook::default() });
        let mirrored = optics_fresnel(downpour_math::ops::sin(angle.to_radians()), 1.333);
        let beneath = 0.2 * 0.933_594 / 1.776_889 / (1.0 - 0.2 * 0.474_591);
        let expected = mirrored + (1.0 - mirrored) * beneath;
        let found = seen(&scene, angle)?;
        assert!((found / expected - 1.0).abs() < 0.02, "{angle}: {found}, {expected}");
    }
    Ok(())
}

/// Light goes through 1/cos of the depth to the eye and 1.2 depths down; what is lost is the water's own color.
#[test]
fn deep_murky_water_has_its_own_color() -> Outcome {
    let look = PuddleLook { extinction: 10.0, scattering_albedo: Vec3::splat(0.3), ..PuddleLook::default() };
    let beneath = |albedo: f32| albedo * 0.525_409 / (1.0 - albedo * 0.474_591);
    for depth in [0.001f32, 0.05, 5.0] {
        let mut scene = flat(0.8);
        flood(&mut scene, depth, look);
        let clear = downpour_math::ops::exp(-10.0 * depth * 2.2);
        let expected = 0.020_37 + (1.0 - 0.020_37) * beneath(0.8 * clear + 0.3 * (1.0 - clear));
        let found = seen(&scene, 89.9)?;
        assert!((found / expected - 1.0).abs() < 0.02, "{depth}: {found}, {expected}");
    }
    Ok(())
}

/// A dish whose depth falls as the square of the distance: 0.04 m over a radius of 1 m, within higher ground.
#[test]
fn a_dish_of_the_model_fills_to_its_rim() -> Outcome {
    let dish = |position: Vec2| 0.04 * (position.length_squared() - 1.0).clamp(-1.0, 0.2);
    let scene = ground(0.5, 80, dish).build(&SkyLight::new(1, 1, &[[1.0; 3]]));
    let level_ground = Relief { rms_m: 0.0, seed: 0 };
    // The ground keeps rising to 0.008 m over the dish's nominal rim.
    let (rim, radius) = (0.048f32, 1.2f32.sqrt());
    for fraction in [1.0f32, 0.5] {
        let map = PuddleMap::found(&scene, &SQUARE, [150, 150], &level_ground, [fraction, 1.0, 0.001]);
        let deep = rim * fraction;
        let wet_radius = radius * fraction.sqrt();
        let area = std::f32::consts::PI * wet_radius * wet_radius;
        // A paraboloid has half of the volume of the cylinder around it.
        let volume = 0.5 * area * deep;
        assert!((map.deepest_m() / deep - 1.0).abs() < 0.03, "{fraction}: {}", map.deepest_m());
        assert!((map.area_m2() / area - 1.0).abs() < 0.03, "{fraction}: {} {area}", map.area_m2());
        assert!((map.volume_m3() / volume - 1.0).abs() < 0.05, "{fraction}: {} {volume}", map.volume_m3());
    }
    Ok(())
}

/// Rays into a model's hollow end on the surface of its water: level, and nearer than the ground.
#[test]
fn rays_end_on_the_surface_of_the_water_in_a_hollow() -> Outcome {
    let dish = |position: Vec2| 0.1 * (position.length_squared() - 1.0).clamp(-1.0, 0.0);
    let mut scene = ground(0.5, 60, dish).build(&SkyLight::new(1, 1, &[[1.0; 3]]));
    let map =
        PuddleMap::found(&scene, &SQUARE, [120, 120], &Relief { rms_m: 0.0, seed: 0 }, [0.8, 1.0, 0.001]);
    scene.set_puddles(&PuddleRows {
        puddles: &[(map, PuddleLook::default())],
        shape: (0, 0, 1.0),
        slopes: &[],
        shift: Vec3::ZERO,
        rings: None,
        wakes: &[],
        time_s: 0.0,
    });
    let eye = Vec3::new(0.3, 1.0, 1.5);
    let view = Viewpoint { eye, forward: -eye, up: Vec3::Y, fov_y: 0.2 };
    let frame = RenderFrame::new(&scene, &view, [16, 16], 1, 0, 1)?;
    let view = SceneView { data: &scene, frame: &frame };
    for (i, pixel) in view.picture().iter().enumerate() {
        let direction = view.frame.camera.camera_direction((i % 16) as f32 + 0.5, (i / 16) as f32 + 0.5);
        let height = eye.y + direction.y * pixel[3];
        assert!((height + 0.02).abs() < 1.0e-3, "{i}: {height}");
    }
    Ok(())
}

/// Under a roof no rain falls; its puddle lies still.
#[test]
fn no_rain_arrives_under_a_roof() {
    let mut builder = ground(0.5, 1, |_| 0.0);
    let roof = builder.add_material(MaterialLook::default());
    sheet(&mut builder, roof, 1, |_| 2.0);
    let roofed = builder.build(&SkyLight::new(1, 1, &[[1.0; 3]]));
    let open = flat(0.5);
    let arrives = |scene: &SceneData| PuddleMap::painted(scene, &SQUARE, [4, 4], &[0.01; 16]).cells[5][3];
    assert_eq!((arrives(&open), arrives(&roofed)), (1.0, 0.0));
}

/// A second set of puddles takes the place of the first.
#[test]
fn water_is_laid_anew() {
    let mut scene = flat(0.5);
    let dry = scene.table.len();
    flood(&mut scene, 0.01, PuddleLook::default());
    let once = (scene.table.len(), scene.puddles, scene.puddle_count);
    flood(&mut scene, 0.02, PuddleLook::default());
    assert_eq!((scene.table.len(), scene.puddles, scene.puddle_count), once);
    scene.set_puddles(&PuddleRows {
        puddles: &[],
        shape: (0, 0, 1.0),
        slopes: &[],
        shift: Vec3::ZERO,
        rings: None,
        wakes: &[],
        time_s: 0.0,
    });
    assert_eq!((scene.table.len(), scene.puddle_count), (dry, 0));
}

/// Ripples of a rain that ends: as those of the rain until it does, and then calm; those of a time do not depend on the frames before.
#[test]
fn ripples_follow_a_rate_that_changes() -> Outcome {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 40.0)?;
    let rates = Keyed::new(vec![(0.0, 0.0), (1.0, 40.0), (5.0, 40.0), (5.001, 0.0)])?;
    let at = |times: &[f64]| -> Result<Vec<[f32; 4]>, Box<dyn std::error::Error>> {
        let mut ripples = Ripples::changing(&rain, &rates, 3, times[0])?;
        times.iter().try_for_each(|&time| ripples.advance(time))?;
        Ok(ripples.slopes())
    };
    let mut steady = Ripples::new(Some(&rain), 3, 4.5)?;
    steady.advance(4.5)?;
    // After 2.5 s a ripple has gone.
    assert!(at(&[4.5])? == steady.slopes());
    assert!(at(&[4.0, 4.2, 4.5])? == at(&[4.0, 4.5])?);
    let power = |slopes: &[[f32; 4]]| slopes.last().map_or(0.0, |mean| mean[2]);
    let (wet, dry) = (at(&[4.5])?, at(&[9.0])?);
    assert!(power(&wet) > 1.0e-4 && power(&dry) < 1.0e-2 * power(&wet), "{} {}", power(&wet), power(&dry));
    assert!(power(&at(&[-1.0])?) == 0.0);
    Ok(())
}

/// Ripples at one time do not depend on the times before, and are of the size that gauges of ring waves have found.
#[test]
fn ripples_are_the_same_for_any_division_of_the_time() -> Outcome {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0)?;
    let mut at_once = Ripples::new(Some(&rain), 3, 10.0)?;
    at_once.advance(10.0)?;
    let mut by_frames = Ripples::new(Some(&rain), 3, 10.0)?;
    for k in 0..10 {
        by_frames.advance(9.9 + 0.01 * f64::from(k))?;
    }
    by_frames.advance(10.0)?;
    let slopes = at_once.slopes();
    assert_eq!(slopes, by_frames.slopes());
    let finest = &slopes[..512 * 512];
    let mean_square = finest.iter().map(|slope| f64::from(slope[2])).sum::<f64>() / finest.len() as f64;
    assert!((0.02..0.25).contains(&mean_square.sqrt()), "{}", mean_square.sqrt());
    // Levels keep the mean of the square; the last has four texels.
    let last = &slopes[slopes.len() - 4..];
    let kept = last.iter().map(|slope| f64::from(slope[2])).sum::<f64>() / 4.0;
    assert!((kept / mean_square - 1.0).abs() < 1.0e-3, "{kept} {mean_square}");
    Ok(())
}

/// From the weather file to the scene: the water of a flat street with the usual unevenness.
#[test]
fn a_weathers_puddles_lie_on_its_stage() -> Outcome {
    let text = "[rain]\nrate_mm_h = 10\n[camera]\nposition_m = [0, 1.5, 0]\n[[puddle]]\nposition_m = [0, 0, -3]\n\
                size_m = [4, 6]\ncell_mm = 50";
    let weather = Weather::parse("w.toml", text)?;
    let loaded = Loaded {
        scene: Scene::default(),
        animations: Vec::new(),
        moving: Vec::new(),
        sky: SkyMap::uniform([1.0; 3]),
        sun: None,
        unscaled: None,
        masks: Vec::new(),
        drop_model: None,
        warnings: Vec::new(),
    };
    let mut frame_scene = downpour_trace::frame_scene::FrameScene::new(&weather, &loaded, 0.0)?;
    // Nothing but air is there: no ground, no water.
    let ground =
        downpour_trace::wet_ground::WetGround::new(&weather, &loaded, &frame_scene, 0.0)?.ok_or("puddles")?;
    ground.lay(&mut frame_scene);
    assert_eq!(frame_scene.data.puddle_count, 1);
    assert!(ground.maps().all(|map| map.area_m2() == 0.0));
    let street = flat(0.3);
    let spot = Ground { size: Vec2::new(4.0, 4.0), ..SQUARE };
    let map =
        PuddleMap::found(&street, &spot, [100, 100], &Relief { rms_m: 2.2e-3, seed: 1 }, [1.0, 0.1, 1.5e-3]);
    let fraction = map.area_m2() / 16.0;
    assert!((0.02..0.6).contains(&fraction), "{fraction}");
    assert!(map.deepest_m() < 0.02, "{}", map.deepest_m());
    Ok(())
}
