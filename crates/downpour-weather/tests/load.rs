//! A weather with all its files: one scene, one sky, one sun.

#[path = "../../downpour-scene/tests/exit_code/mod.rs"]
mod exit_code;
#[path = "../../downpour-scene/tests/picture_files/mod.rs"]
mod picture_files;

use downpour_scene::scene::{LightKind, Play};
use downpour_scene::{Budget, SceneError};
use downpour_weather::{Roots, Weather, load};
use exit_code::ExitCode as _;
use glam::Vec3;
use picture_files::hdr;
use std::collections::BTreeMap;
use std::fs;

/// An animated triangle: one mesh, two nodes, an animation; its buffer is a file beside it.
fn swing() -> (Vec<u8>, Vec<u8>) {
    let json = r#"{
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [1]}],
        "nodes": [{"mesh": 0, "name": "leaf"}, {"children": [0], "name": "stem"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "animations": [
            {"name": "Rest", "channels": [], "samplers": []},
            {"name": "Swing", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
             "samplers": [{"input": 1, "output": 2}]}
        ],
        "buffers": [{"byteLength": 68, "uri": "swing.bin"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                        {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}
        ]
    }"#;
    let numbers = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 8.0f32];
    (json.as_bytes().to_vec(), numbers.iter().flat_map(|n| n.to_le_bytes()).collect())
}

/// A sky of 64 x 32 pixels of radiance 0.5 with a sun of 4 pixels toward +X, 45 degrees up.
fn sunny() -> Vec<u8> {
    let pixel = |x: usize, y: usize| {
        if (31..33).contains(&x) && (7..9).contains(&y) { [128, 128, 128, 142] } else { [128, 128, 128, 128] }
    };
    let pixels: Vec<u8> = (0..32).flat_map(|y| (0..64).flat_map(move |x| pixel(x, y))).collect();
    hdr("", 64, 32, &pixels)
}

fn files() -> BTreeMap<String, Vec<u8>> {
    let (json, binary) = swing();
    [("models/swing.gltf", json), ("models/swing.bin", binary), ("sky.hdr", sunny())]
        .map(|(name, bytes)| (name.to_owned(), bytes))
        .into()
}

#[test]
fn models_are_copied_with_their_movements() {
    let weather = Weather::parse(
        "w.toml",
        "[[model]]\nfile = 'models/swing.gltf'\nanimation = 'Swing'\ntranslation_m = [0, 0, 100]\n\
         repeat = { count = [3, 1, 2], step_m = [10, 0, 20] }\n\
         [[model]]\nfile = 'models/swing.gltf'\n\
         [[light]]\nspot = { position_m = [1, 2, 3], direction = [0, -1, 0] }\n\
         [[light]]\ndirectional = { direction = [1, 0, 0], illuminance_lux = 7 }",
    )
    .unwrap();
    let mut budget = Budget::default();
    let loaded = load(&weather, &files(), &mut budget).unwrap();
    assert_eq!(loaded.animations, [Some(1), Some(2)]);
    let scene = &loaded.scene;
    // Meshes are shared by the copies; a file is read once.
    assert_eq!((scene.meshes.len(), scene.animations.len(), scene.lights.len()), (1, 4, 2));
    assert_eq!(scene.nodes.len(), 6 * 3 + 3 + 2);
    assert!(budget.nodes < Budget::default().nodes && budget.bytes < Budget::default().bytes);
    let pose = scene.pose(loaded.animations[0], 0.999_999);
    assert_eq!(pose.instances.len(), 7);
    let found: Vec<Vec3> = pose.instances.iter().map(|one| one.world.translation.into()).collect();
    let mut expected = Vec::new();
    for z in 0..2 {
        for x in 0..3 {
            expected.push(Vec3::new(10.0 * x as f32, 0.0, 108.0 + 20.0 * z as f32));
        }
    }
    expected.push(Vec3::ZERO);
    for (found, expected) in found.iter().zip(&expected) {
        assert!(found.distance(*expected) < 1e-3, "{found} {expected}");
    }
    let [spot, sun] = pose.lights.as_slice() else { panic!("{:?}", pose.lights) };
    assert!(spot.position.distance(Vec3::new(1.0, 2.0, 3.0)) < 1e-6);
    assert!(spot.direction.distance(Vec3::NEG_Y) < 1e-6 && sun.direction.distance(Vec3::X) < 1e-6);
    assert!(matches!(scene.lights[0].kind, LightKind::Spot { .. }) && scene.lights[1].intensity == 7.0);
    let unknown =
        Weather::parse("w.toml", "[[model]]\nfile = 'models/swing.gltf'\nanimation = 'Jump'").unwrap();
    let error = load(&unknown, &files(), &mut budget).unwrap_err();
    assert_eq!(
        error.to_string(),
        "models/swing.gltf: animations: no animation \"Jump\"; allowed: \"Rest, Swing\""
    );
}

/// A model whose place has keys is there with all its copies, its animation plays in it at its speed, and other entries of the same
/// file stay where they are.
#[test]
fn a_model_moves_by_its_keys() {
    let text = "[[model]]\nfile = 'models/swing.gltf'\nanimation = 'Swing'\nanimation_speed = 0.5\n\
                translation_m = [[0, [0, 0, 0]], [4, [40, 0, 0]]]\nrotation_deg = [[0, [0, 0, 0]], [2, [0, 90, 0]]]\n\
                repeat = { count = [1, 1, 2], step_m = [0, 0, 100] }\n\
                [[model]]\nfile = 'models/swing.gltf'\nanimation = 'Rest'\ntranslation_m = [0, 7, 0]";
    let weather = Weather::parse("w.toml", text).unwrap();
    let loaded = load(&weather, &files(), &mut Budget::default()).unwrap();
    assert!(loaded.is_animated());
    let places = |time_s: f64| -> Vec<Vec3> {
        loaded.pose(&weather, time_s).instances.iter().map(|one| one.world.translation.into()).collect()
    };
    // The swing is at z = 8 after one second of its own, here after two, when the model has turned that to x.
    let swung = 1.999_999;
    let cases = [
        (-1.0, [Vec3::ZERO, Vec3::new(0.0, 0.0, 100.0)]),
        (swung, [Vec3::new(28.0, 0.0, 0.0), Vec3::new(28.0, 0.0, 100.0)]),
        (9.0, [Vec3::new(40.0, 0.0, 0.0), Vec3::new(40.0, 0.0, 100.0)]),
    ];
    for (time_s, expected) in cases {
        let found = places(time_s);
        let along = if time_s == swung { 1e-3 } else { 8.0 };
        for (found, expected) in found.iter().zip(expected) {
            assert!(found.distance(expected) < along, "{time_s} s: {found} {expected}");
        }
        assert_eq!(found[2], Vec3::new(0.0, 7.0, 0.0));
    }
    // Keys alone move a model, too; and other keys are another scene.
    let still = |keys: &str| {
        let text =
            format!("[[model]]\nfile = 'models/swing.gltf'\nanimation_speed = 0\ntranslation_m = {keys}");
        Weather::parse("w.toml", &text).unwrap()
    };
    let (first, second) =
        (still("[[0, [0, 0, 0]], [1, [1, 0, 0]]]"), still("[[0, [0, 0, 0]], [1, [2, 0, 0]]]"));
    assert_eq!(first.models, second.models);
    let loaded = load(&first, &files(), &mut Budget::default()).unwrap();
    assert_eq!(loaded.pose(&first, 0.5).instances[0].world.translation.x, 0.5);
    let (again, reloaded) = loaded.reload(&first, &second, &files(), &mut Budget::default()).unwrap();
    assert!(reloaded.models);
    assert_eq!(again.pose(&second, 0.5).instances[0].world.translation.x, 1.0);
}

/// Two entries of the same file move independently.
#[test]
fn entries_of_the_same_file_share_its_meshes_and_not_its_movements() {
    let entry = |animation: &str, x: u32, count: u32| {
        format!(
            "[[model]]\nfile = 'models/swing.gltf'\nanimation = '{animation}'\ntranslation_m = [{x}, 0, 0]\n\
             repeat = {{ count = [{count}, 1, 1], step_m = [1, 0, 0] }}\n"
        )
    };
    let text = entry("Swing", 0, 2) + &entry("Rest", 100, 2) + &entry("Swing", 200, 3);
    let weather = Weather::parse("w.toml", &text).unwrap();
    let mut budget = Budget::default();
    let loaded = load(&weather, &files(), &mut budget).unwrap();
    let scene = &loaded.scene;
    assert_eq!((scene.meshes.len(), scene.animations.len()), (1, 6));
    assert_eq!(scene.nodes.len(), 7 * 3);
    assert_eq!(loaded.animations, [Some(1), Some(2), Some(5)]);
    let channels: Vec<usize> = scene.animations.iter().map(|one| one.channels.len()).collect();
    assert_eq!(channels, [0, 2, 0, 2, 0, 3]);
    let plays: Vec<Play> =
        loaded.animations.iter().flatten().map(|&animation| Play { animation, time_s: 0.999_999 }).collect();
    let pose = scene.pose_of(&plays);
    let found: Vec<Vec3> = pose.instances.iter().map(|one| one.world.translation.into()).collect();
    let expected = [0.0, 1.0, 100.0, 101.0, 200.0, 201.0, 202.0]
        .map(|x: f32| Vec3::new(x, 0.0, if (100.0..200.0).contains(&x) { 0.0 } else { 8.0 }));
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.distance(expected) < 1e-3, "{found} {expected}");
    }
    assert_eq!(found.len(), expected.len());
    // Many entries of a file cost what their nodes cost.
    let mut small = Budget { vertices: 10, ..Budget::default() };
    let many: String = (0..1000).map(|x| entry("Rest", x, 1)).collect();
    assert!(load(&Weather::parse("w.toml", &many).unwrap(), &files(), &mut small).is_ok());
    let mut few = Budget { nodes: 500, ..Budget::default() };
    let error = load(&Weather::parse("w.toml", &many).unwrap(), &files(), &mut few).unwrap_err();
    assert_eq!(error.exit_code(), 3, "{error}");
}

#[test]
fn the_sun_is_taken_out_turned_and_scaled() {
    let text = |more: &str| format!("[sky]\nfile = 'sky.hdr'\nyaw_deg = 90\nexposure_ev = 1\n{more}");
    let read = |text: &str| {
        load(&Weather::parse("w.toml", text).unwrap(), &files(), &mut Budget::default()).unwrap()
    };
    let loaded = read(&text(""));
    let sun = loaded.sun.unwrap();
    // A quarter turn takes +X to -Z.
    let half = 0.5f32.sqrt();
    assert!(Vec3::from_array(sun.direction).distance(Vec3::new(0.0, half, -half)) < 0.01, "{sun:?}");
    let omega = 4.0 * std::f32::consts::TAU / 64.0 * std::f32::consts::PI / 32.0 * half;
    assert!((sun.irradiance_rgb[0] / (2.0 * 8192.0 * omega) - 1.0).abs() < 0.01, "{sun:?}");
    assert!(loaded.sky.radiance.iter().all(|pixel| *pixel == [1.0; 3]));
    // Left in the map, it is unchanged but for the rotation.
    let left = read(&text("[sun]\nfrom_sky = false"));
    assert_eq!(left.sun, None);
    assert!(left.sky.radiance([0.0, half, -half])[0] > 10_000.0);
    // A sun with a direction is not scaled.
    let own = read("[sun]\nazimuth_deg = 90\nelevation_deg = 0\nilluminance_lux = 10\ncolor = [1, 0.5, 0]");
    let sun = own.sun.unwrap();
    assert!(Vec3::from_array(sun.direction).distance(Vec3::Z) < 1e-6);
    assert_eq!(sun.irradiance_rgb, [10.0, 5.0, 0.0]);
    assert_eq!(own.sky.width, 1);
    let plain = read("[sky]\ncolor = [1, 2, 3]\nintensity = 2");
    assert_eq!((plain.sky.radiance, plain.sun), (vec![[2.0, 4.0, 6.0]], None));
}

#[test]
fn copies_are_within_the_budget() {
    let weather = Weather::parse(
        "w.toml",
        "[[model]]\nfile = 'models/swing.gltf'\nrepeat = { count = [65536, 1, 1], step_m = [1, 0, 0] }",
    )
    .unwrap();
    let mut budget = Budget { nodes: 1000, ..Budget::default() };
    let error = load(&weather, &files(), &mut budget).unwrap_err();
    assert_eq!(error.exit_code(), 3, "{error}");
    assert!(error.to_string().starts_with("models/swing.gltf: nodes: "), "{error}");
    assert_eq!(budget.nodes, 1000, "what is refused is not taken");
    let mut budget = Budget { bytes: 1 << 20, ..Budget::default() };
    assert_eq!(load(&weather, &files(), &mut budget).unwrap_err().exit_code(), 3);
}

#[test]
fn files_are_found_beneath_the_folder_and_the_roots_only() {
    let (scene, assets) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let path = scene.path().join("w.toml");
    fs::write(&path, "[sky]\nfile = 'sky.hdr'\n[[model]]\nfile = 'models/swing.gltf'").unwrap();
    let read = |roots: &[&std::path::Path]| -> Result<usize, SceneError> {
        let mut budget = Budget::default();
        let weather = Weather::read(&path, &mut budget)?;
        load(&weather, &Roots::open(&path, roots)?, &mut budget).map(|loaded| loaded.scene.meshes.len())
    };
    let missing = read(&[]).unwrap_err();
    assert!(missing.exit_code() == 5 && missing.to_string().starts_with("sky.hdr: "), "{missing}");
    fs::write(scene.path().join("sky.hdr"), sunny()).unwrap();
    let missing = read(&[assets.path()]).unwrap_err();
    assert!(missing.exit_code() == 5 && missing.to_string().starts_with("models/swing.gltf: "), "{missing}");
    fs::create_dir(assets.path().join("models")).unwrap();
    let (json, binary) = swing();
    fs::write(assets.path().join("models/swing.gltf"), json).unwrap();
    fs::write(assets.path().join("models/swing.bin"), binary).unwrap();
    assert_eq!(read(&[assets.path()]).unwrap(), 1);
    assert_eq!(read(&[]).unwrap_err().exit_code(), 5);
    #[cfg(unix)]
    {
        // A link out of the folder is not followed, though the asset root would have had the file.
        std::os::unix::fs::symlink(assets.path().join("models"), scene.path().join("models")).unwrap();
        let error = read(&[assets.path()]).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("leaves the scene folder"), "{error}");
    }
}
