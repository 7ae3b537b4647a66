//! Sample models: their contents as known.

use crate::document::check_scene;
use crate::folder;
use downpour_scene::gltf::{read_scene, read_triangles};
use downpour_scene::scene::{AlphaMode, Interpolation, Lens, LightKind, Scene, skin_primitive};
use downpour_scene::{Budget, WarningKind};
use glam::{Vec2, Vec3};

fn model(name: &str) -> Scene {
    let path = folder("gltf").join(name);
    let scene = read_scene(&path, &mut Budget::default()).unwrap_or_else(|error| panic!("{error}"));
    check_scene(&scene);
    // The reader of triangles agrees on all positions, unless skins bend them.
    if scene.skins.is_empty() {
        let mine = scene.triangles(&scene.pose(None, 0.0));
        let other = read_triangles(&path, &mut Budget::default()).expect("read before");
        assert_eq!(mine.indices.len(), other.indices.len(), "{name}");
        if let (Some((low, high)), Some((l, h))) = (mine.bounds(), other.bounds()) {
            let near = |a: [f32; 3], b: [f32; 3]| Vec3::from(a).distance(b.into()) < 1e-5;
            assert!(near(low, l) && near(high, h), "{name}");
        }
    }
    scene
}

/// Meshes, nodes, materials, textures, animations, lights, cameras, triangles.
fn counts(scene: &Scene) -> [usize; 8] {
    [
        scene.meshes.len(),
        scene.nodes.len(),
        scene.materials.len(),
        scene.textures.len(),
        scene.animations.len(),
        scene.lights.len(),
        scene.cameras.len(),
        scene.triangle_count(),
    ]
}

pub(crate) fn models_are_read_whole() {
    let expected = [
        ("AlphaBlendModeTest/AlphaBlendModeTest.glb", [9, 9, 6, 4, 0, 0, 0, 61]),
        ("CesiumMilkTruck/CesiumMilkTruck.glb", [2, 6, 4, 1, 1, 0, 0, 2856]),
        ("EmissiveStrengthTest/EmissiveStrengthTest.glb", [6, 6, 6, 1, 0, 0, 0, 90]),
        ("GlassBrokenWindow/GlassBrokenWindow.glb", [3, 3, 3, 5, 0, 0, 0, 987]),
        ("InterpolationTest/InterpolationTest.glb", [10, 12, 10, 1, 9, 0, 0, 110]),
        ("LightsPunctualLamp/LightsPunctualLamp.gltf", [3, 8, 3, 7, 0, 5, 0, 6000]),
        ("MeshPrimitiveModes/MeshPrimitiveModes.gltf", [7, 7, 1, 0, 0, 0, 0, 16]),
        ("RecursiveSkeletons/RecursiveSkeletons.glb", [1, 924, 1, 0, 1, 0, 0, 76]),
        ("ToyCar/ToyCar.gltf", [3, 11, 3, 7, 0, 0, 8, 108_936]),
        ("camp/camp.gltf", [1, 4, 12, 0, 0, 0, 1, 6285]),
        ("kaykit_city/car_sedan.gltf", [5, 5, 1, 1, 0, 0, 0, 1222]),
        ("kenney_city/road-intersection.glb", [1, 1, 1, 1, 0, 0, 0, 154]),
        ("playcanvas/Lights.glb", [1, 11, 1, 0, 0, 4, 1, 12]),
    ];
    for (name, expected) in expected {
        {
            let scene = model(name);
            assert_eq!(counts(&scene), expected, "{name}");
            assert!(
                scene.warnings.iter().all(|warning| !warning.kind.is_loss()),
                "{name}: {:?}",
                scene.warnings
            );
        }
    }
}

pub(crate) fn the_toy_car_has_glass_and_eyes() {
    let scene = model("ToyCar/ToyCar.gltf");
    let [car, fabric, glass] = &scene.materials[..] else { panic!("three materials") };
    assert_eq!((glass.transmission, glass.roughness, glass.ior), (1.0, 0.0, 1.5));
    assert_eq!(fabric.normal_texture.expect("a map").at(Vec2::ONE), Vec2::splat(3.0));
    assert!(car.emissive == Vec3::ONE && car.emissive_texture.is_some());
    // Occlusion, roughness and metalness are one picture with one encoding.
    assert_eq!(
        car.occlusion_texture.map(|used| used.texture),
        car.metallic_roughness_texture.map(|used| used.texture)
    );
    let ignored = scene.warnings.iter().filter(|warning| warning.kind == WarningKind::Ignored);
    assert_eq!(ignored.map(|warning| warning.what.contains("is not read")).collect::<Vec<_>>(), [true, true]);
    let pose = scene.pose(None, 0.0);
    assert_eq!(pose.cameras.len(), 8);
    assert!(pose.cameras[0].eye.distance(Vec3::new(-0.016_900_64, 0.025_359_93, 0.030_231_995)) < 1e-7);
    assert_eq!(
        scene.cameras[0].lens,
        Lens::Perspective { yfov: 0.9, aspect: None, near: 0.001, far: Some(2.0) }
    );
    // The camera looks at the car, which is at the origin.
    assert!(pose.cameras[0].forward.dot(-pose.cameras[0].eye.normalize()) > 0.8);
}

pub(crate) fn lamps_stand_where_the_file_says() {
    {
        let scene = model("LightsPunctualLamp/LightsPunctualLamp.gltf");
        let candela: Vec<f32> = scene.lights.iter().map(|light| light.intensity).collect();
        assert_eq!(candela, [15.0, 1.5, 80.0, 80.0, 180.0]);
        let pose = scene.pose(None, 0.0);
        assert!(
            pose.lights[0].position.distance(Vec3::new(0.046_223_555, 0.907_797_34, 0.006_696_629)) < 1e-7
        );
        assert_eq!(scene.materials[1].alpha_mode, AlphaMode::Blend);
        assert!(scene.meshes.iter().flat_map(|mesh| &mesh.primitives).all(|part| !part.tangents.is_empty()));
    }
    {
        let scene = model("playcanvas/Lights.glb");
        let pose = scene.pose(None, 0.0);
        assert_eq!(
            scene.lights[1].kind,
            LightKind::Spot { inner: 0.333_794_23, outer: std::f32::consts::FRAC_PI_8 }
        );
        assert_eq!(scene.lights[3].kind, LightKind::Directional);
        // The spots are not rotated: a quarter about -X turns -Z to -Y.
        assert!(pose.lights[1].direction.distance(Vec3::NEG_Y) < 1e-6, "{:?}", pose.lights[1]);
        assert!(pose.lights[2].position.distance(Vec3::new(0.0, 6.156_267_6, 0.0)) < 1e-6);
        assert!(pose.cameras[0].eye.distance(Vec3::new(7.358_891_5, 4.958_309, 6.925_791)) < 1e-6);
    }
}

pub(crate) fn strengths_and_cutoffs() {
    {
        let scene = model("EmissiveStrengthTest/EmissiveStrengthTest.glb");
        for (material, strength) in [(0, 4.0), (2, 2.0), (3, 1.0), (4, 8.0), (5, 16.0)] {
            let expected = Vec3::new(0.1, 0.5, 0.9) * strength;
            assert!(scene.materials[material].emissive.distance(expected) < 1e-5, "{material}");
        }
    }
    {
        let scene = model("AlphaBlendModeTest/AlphaBlendModeTest.glb");
        let modes: Vec<AlphaMode> = scene.materials.iter().map(|material| material.alpha_mode).collect();
        let mask = |cutoff| AlphaMode::Mask { cutoff };
        assert_eq!(
            modes,
            [AlphaMode::Opaque, AlphaMode::Blend, mask(0.25), mask(0.75), mask(0.5), AlphaMode::Opaque]
        );
    }
    {
        let scene = model("GlassBrokenWindow/GlassBrokenWindow.glb");
        assert_eq!(
            (scene.materials[1].transmission, scene.materials[1].alpha_mode),
            (1.0, AlphaMode::Mask { cutoff: 0.5 })
        );
    }
}

/// Nine cubes, each animated differently: at each key the key's value, between them the formula's.
pub(crate) fn cubes_move_in_nine_ways() {
    let scene = model("InterpolationTest/InterpolationTest.glb");
    let mut kinds = Vec::new();
    for (index, animation) in scene.animations.iter().enumerate() {
        let [channel] = &animation.channels[..] else { panic!("one channel") };
        let track = &channel.track;
        kinds.push(track.interpolation);
        let key = |nth: usize| {
            let (step, middle) =
                if track.interpolation == Interpolation::CubicSpline { (3, 1) } else { (1, 0) };
            let start = (nth * step + middle) * track.width;
            track.values[start..start + track.width].to_vec()
        };
        let mut value = Vec::new();
        for (nth, &time) in track.times.iter().enumerate() {
            track.sample(time, &mut value);
            let sign = if track.turns && value.iter().zip(key(nth)).any(|(a, b)| a * f64::from(b) < -1e-6) {
                -1.0
            } else {
                1.0
            };
            for (a, b) in value.iter().zip(key(nth)) {
                assert!((a - sign * f64::from(b)).abs() < 1e-6, "{} key {nth}", animation.name);
            }
        }
        let time = (track.times[1] + track.times[2]) / 2.0;
        track.sample(time, &mut value);
        let (a, b) = (key(1), key(2));
        match (track.interpolation, track.turns) {
            (Interpolation::Step, _) => {
                assert!(value.iter().zip(&a).all(|(v, a)| (v - f64::from(*a)).abs() < 1e-6));
            }
            (Interpolation::Linear, false) => {
                let middle = a.iter().zip(&b).map(|(a, b)| f64::from(a + b) / 2.0);
                assert!(value.iter().zip(middle).all(|(v, m)| (v - m).abs() < 1e-6), "{}", animation.name);
            }
            (Interpolation::Linear, true) => {
                // The middle of an arc is the normalized sum of its ends.
                let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| f64::from(a + b)).collect();
                let length = sum.iter().map(|part| part * part).sum::<f64>().sqrt();
                let dot: f64 = value.iter().zip(&sum).map(|(v, s)| v * s / length).sum();
                assert!((dot.abs() - 1.0).abs() < 1e-6, "{}: {dot}", animation.name);
            }
            (Interpolation::CubicSpline, _) => assert!(value.iter().all(|part| part.is_finite())),
        }
        // Only one node moves.
        let (rest, moved) = (scene.pose(None, 0.0), scene.pose(Some(index), time));
        let turned = (0..scene.nodes.len()).filter(|&node| rest.world(node) != moved.world(node));
        assert!(turned.clone().all(|node| node == channel.node), "{}", animation.name);
    }
    for kind in [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline] {
        assert_eq!(kinds.iter().filter(|&&found| found == kind).count(), 3);
    }
}

/// The wheels of the truck turn about their axles: the axle stays, the rim moves.
pub(crate) fn wheels_turn() {
    let scene = model("CesiumMilkTruck/CesiumMilkTruck.glb");
    let length = scene.animations[0].length_s();
    let (start, quarter) = (scene.pose(Some(0), 0.0), scene.pose(Some(0), length * 0.25));
    for node in [0, 2] {
        let (a, b) = (start.world_f64(node).expect("a node"), quarter.world_f64(node).expect("a node"));
        assert!((a.translation - b.translation).length() < 1e-9);
        assert!(!a.matrix3.abs_diff_eq(b.matrix3, 0.1));
    }
    assert_eq!(start.instances.len(), 3);
    // Both wheels draw the same mesh.
    let wheels: Vec<usize> =
        start.instances.iter().map(|instance| instance.mesh).filter(|&mesh| mesh == 0).collect();
    assert_eq!(wheels.len(), 2);
}

/// 84 skinned instances, nested deeply: all finite, and inside the box that the pose gives.
pub(crate) fn recursive_skeletons_stay_finite() {
    let scene = model("RecursiveSkeletons/RecursiveSkeletons.glb");
    for time in [0.0, 0.3, 1.7] {
        let pose = scene.pose(Some(0), time);
        assert_eq!((pose.instances.len(), pose.left_out), (84, 0));
        let bounds = pose.bounds(&scene);
        for instance in &pose.instances {
            assert_eq!(instance.joints.len(), 10);
            for part in &scene.meshes[instance.mesh].primitives {
                let skinned = skin_primitive(part, instance);
                let slack = Vec3::splat(1e-3);
                assert!(
                    skinned
                        .positions
                        .iter()
                        .all(|p| p.cmpge(bounds.min - slack).all() && p.cmple(bounds.max + slack).all())
                );
                assert!(skinned.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-4));
            }
        }
    }
}

/// Mirrored instances are detected, and their triangles have the winding of those of the other reader.
pub(crate) fn negative_scales_are_known() {
    let scene = model("NegativeScaleTest/NegativeScaleTest.glb");
    let pose = scene.pose(None, 0.0);
    let mirrored = pose.instances.iter().filter(|instance| instance.mirrored).count();
    assert!(mirrored > 0 && mirrored < pose.instances.len(), "{mirrored}");
}
