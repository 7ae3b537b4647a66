//! Frames of small scenes that are put together here.

use downpour_math::OutOfRange;
use std::sync::Arc;

use downpour_render::RenderError;
use downpour_scene::picture::{Picture, Pixels};
use downpour_scene::scene::{
    Camera, Encoding, Lens, Light, LightKind, Local, Material, Mesh, Node, Primitive, Sampler, Scene,
    Texture, TextureRef,
};
use downpour_scene::sky::{SkyMap, Sun};
use downpour_weather::{CameraPose, Loaded, Weather};
use glam::{Affine2, Affine3A, DVec3, Vec2, Vec3};

use super::{CameraChoice, FrameScene, FrameSceneError, MAX_TRIANGLES};

/// A triangle in the plane z = 0, `count` times.
fn triangles(count: u32) -> Primitive {
    Primitive {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        uvs: [vec![Vec2::ZERO; 3], Vec::new()],
        indices: [0, 1, 2].repeat(count as usize),
        bounds: downpour_scene::scene::Bounds { min: Vec3::ZERO, max: Vec3::ONE },
        ..Primitive::default()
    }
}

fn node(mesh: Option<usize>, position: Vec3) -> Node {
    Node { mesh, local: Local::Matrix(Affine3A::from_translation(position)), ..Node::default() }
}

fn scene(nodes: Vec<Node>) -> Scene {
    let roots = (0..nodes.len()).collect();
    let meshes = vec![Mesh { primitives: vec![triangles(1)], ..Mesh::default() }];
    Scene { meshes, nodes, roots, ..Scene::default() }
}

fn loaded(scene: Scene) -> Loaded {
    let sky = SkyMap::uniform([1.0; 3]);
    Loaded {
        scene,
        animations: Vec::new(),
        moving: Vec::new(),
        sky,
        sun: None,
        unscaled: None,
        masks: Vec::new(),
        drop_model: None,
        warnings: Vec::new(),
    }
}

fn frame_scene(weather: &Weather, loaded: &Loaded) -> FrameScene {
    FrameScene::new(weather, loaded, 0.0).expect("a scene of a frame")
}

#[test]
fn the_weather_comes_before_the_scene_and_the_scene_before_a_frame() {
    let mut all = scene(vec![node(Some(0), Vec3::ZERO), node(None, Vec3::new(0.0, 1.0, 9.0))]);
    let of = |lens| Camera { name: String::new(), lens };
    all.cameras = vec![
        of(Lens::Orthographic { xmag: 1.0, ymag: 1.0, near: 0.1, far: 9.0 }),
        of(Lens::Perspective { yfov: 0.5, aspect: None, near: 0.2, far: Some(30.0) }),
    ];
    all.nodes[0].camera = Some(0);
    all.nodes[1].camera = Some(1);
    let (weather, all) = (Weather::default(), loaded(all));
    let found = frame_scene(&weather, &all);
    assert_eq!(
        (found.camera.clone(), found.viewpoint.eye),
        (CameraChoice::Scene(1), Vec3::new(0.0, 1.0, 9.0))
    );
    assert!((found.viewpoint.fov_y - 0.5).abs() < 1.0e-6);
    let view = found.view().expect("a view");
    assert!((view.near - 0.2).abs() < 1.0e-6 && (view.far - 30.0).abs() < 1.0e-6, "{view:?}");
    let mut own = weather.clone();
    own.camera.path = Some(CameraPose { position: DVec3::new(1.0, 2.0, 3.0), forward: DVec3::X }.into());
    own.camera.fov = Some(1.0);
    let found = frame_scene(&own, &all);
    assert_eq!((found.camera.clone(), found.viewpoint.fov_y), (CameraChoice::Weather, 1.0));
    assert_eq!((found.viewpoint.eye, found.viewpoint.forward), (Vec3::new(1.0, 2.0, 3.0), Vec3::X));
    assert_eq!(
        frame_scene(&weather, &loaded(scene(vec![node(Some(0), Vec3::ZERO)]))).camera,
        CameraChoice::Framing
    );
    let nothing = frame_scene(&weather, &loaded(Scene::default()));
    assert_eq!((nothing.camera.clone(), nothing.triangles), (CameraChoice::Standing, 0));
    assert_eq!(nothing.viewpoint.eye, Vec3::new(0.0, 1.6, 0.0));
}

/// A step of 1 cm, 10 000 km away: single precision has steps of 1 m there.
#[test]
fn far_away_small_steps_are_kept() {
    let far = 1.0e7;
    let mut all =
        scene(vec![node(None, Vec3::new(far as f32, 0.0, 0.0)), node(Some(0), Vec3::new(0.01, 0.0, 0.0))]);
    all.nodes[0].children = vec![1];
    all.roots = vec![0];
    let mut weather = Weather::default();
    let position = DVec3::new(far, 0.0, 5.0);
    weather.camera.path = Some(CameraPose { position, forward: DVec3::NEG_Z }.into());
    let found = frame_scene(&weather, &loaded(all));
    assert_eq!(found.origin, position);
    assert_eq!(found.viewpoint.eye, Vec3::ZERO);
    let (low, _) = found.data.bounds();
    assert!((low - Vec3::new(0.01, 0.0, -5.0)).length() < 1.0e-4, "{low}");
    assert_eq!(found.view().expect("a view").eye, position);
}

/// Intensity over pi, since the buffers hold what a white surface shows.
#[test]
fn lamps_and_the_sun_have_the_unit_of_the_sky() {
    let mut all = scene(vec![node(Some(0), Vec3::ZERO), node(None, Vec3::Y)]);
    let kind = LightKind::Point;
    all.lights = vec![Light {
        name: String::new(),
        color: Vec3::ONE,
        intensity: 100.0,
        range: None,
        radius: None,
        kind,
    }];
    all.nodes[1].light = Some(0);
    let mut all = loaded(all);
    let direction = [0.0, 1.0, 0.0];
    all.sun = Some(Sun { direction, irradiance_rgb: [10.0, 20.0, 30.0], angular_radius: 0.005 });
    let found = frame_scene(&Weather::default(), &all);
    assert_eq!((found.data.light_count, found.lamps), (2, 1));
    // The wetness comes after them.
    let rows = found.data.table[found.data.lights as usize..found.data.wetness as usize].to_vec();
    let number = |row: usize, k: usize| f32::from_bits(rows[row][k]);
    let pi = std::f32::consts::PI;
    assert!((number(2, 0) - 100.0 / pi).abs() < 1.0e-4, "{}", number(2, 0));
    let sun = rows.len() / 2;
    assert!((number(sun + 2, 1) - 20.0 / pi).abs() < 1.0e-5, "{}", number(sun + 2, 1));
    assert_eq!(number(sun + 1, 1), -1.0, "the light of a sun above goes down");
}

/// An atlas that several files bring along is stored once, and a picture that only looks like it is not taken for it.
#[test]
fn pictures_of_the_same_pixels_are_stored_once() {
    let picture = |value: u8| {
        let pixels = Pixels::Rgba8(vec![[value; 4]; 64]);
        Arc::new(Picture { name: String::new(), width: 8, height: 8, pixels, warnings: Vec::new() })
    };
    let texels = |pictures: &[(Arc<Picture>, Encoding)]| {
        let mut all = scene(vec![node(Some(0), Vec3::ZERO)]);
        for (index, (picture, encoding)) in pictures.iter().enumerate() {
            let (name, sampler) = (String::new(), Sampler::default());
            all.textures.push(Texture { name, picture: picture.clone(), encoding: *encoding, sampler });
            let used = TextureRef { texture: index, uv_set: 0, transform: Affine2::IDENTITY };
            all.materials.push(Material { base_color_texture: Some(used), ..Material::default() });
        }
        frame_scene(&Weather::default(), &loaded(all)).data.texels.len()
    };
    let (srgb, linear) = (Encoding::Srgb, Encoding::Linear);
    let one = texels(&[(picture(7), srgb)]);
    let shared = picture(7);
    assert_eq!(texels(&[(shared.clone(), srgb), (shared, srgb)]), one);
    assert_eq!(texels(&[(picture(7), srgb), (picture(7), srgb), (picture(7), srgb)]), one);
    assert_eq!(texels(&[(picture(7), srgb), (picture(8), srgb)]), 2 * one);
    assert_eq!(texels(&[(picture(7), srgb), (picture(7), linear)]), 2 * one);
}

#[test]
fn too_many_triangles_are_over_a_limit() {
    let mut all = scene((0..5).map(|x| node(Some(0), Vec3::X * x as f32)).collect());
    all.meshes[0].primitives = vec![triangles(MAX_TRIANGLES as u32 / 5 + 1)];
    let error = FrameScene::new(&Weather::default(), &loaded(all), 0.0).expect_err("a limit");
    assert!(matches!(error, FrameSceneError::OverLimit { .. }));
    assert!(error.to_string().starts_with("triangles of the scene"), "{error}");
}

#[test]
fn times_and_sizes_are_checked() {
    let all = loaded(Scene::default());
    for time in [f64::NAN, f64::INFINITY, 1.1e6] {
        let error = FrameScene::new(&Weather::default(), &all, time).expect_err("no time");
        assert!(matches!(error, FrameSceneError::Render(RenderError::OutOfRange(OutOfRange { .. }))));
    }
    let mut weather = Weather::default();
    for size in [[0, 5], [16_385, 1]] {
        weather.size = size;
        let error = FrameScene::new(&weather, &all, 0.0).expect_err("no size");
        assert!(matches!(error, FrameSceneError::Render(RenderError::Size { found, .. }) if found == size));
    }
}

/// Darkness around a subject does not change how it is exposed.
#[test]
fn exposure_is_of_what_is_lit() {
    let mut weather = Weather::default();
    let lit = vec![[0.5; 4]; 100];
    let half: Vec<[f32; 4]> = lit.iter().copied().chain(vec![[0.0, 0.0, 0.0, 1.0e30]; 100]).collect();
    let exposure = frame_scene(&weather, &loaded(Scene::default())).exposure(&lit);
    assert!((exposure - 0.36).abs() < 1.0e-3, "{exposure}");
    assert_eq!(frame_scene(&weather, &loaded(Scene::default())).exposure(&half), exposure);
    weather.camera.exposure_ev = 2.0;
    assert!(
        (frame_scene(&weather, &loaded(Scene::default())).exposure(&half) / exposure - 4.0).abs() < 1.0e-5
    );
    assert_eq!(frame_scene(&Weather::default(), &loaded(Scene::default())).exposure(&[[0.0; 4]; 4]), 1.0);
}

/// A frame's scene that is seen at another time is as wet as one that is made for it, and dry if the weather says so.
#[test]
fn wetness_is_that_of_the_time() {
    let mut weather = Weather::default();
    weather.wetness.rained_m = Some(0.0);
    let all = loaded(scene(vec![node(None, Vec3::ZERO)]));
    let at = |time_s: f64| FrameScene::new(&weather, &all, time_s).expect("a scene of a frame").data.table;
    let first = FrameScene::new(&weather, &all, 0.0).expect("a scene of a frame");
    assert_eq!(first.data.wetness, 0, "nothing has fallen yet");
    let later = first.seen_at(&weather, &all, 60.0).expect("a scene of a frame");
    assert_eq!(later.data.table, at(60.0));
    let latest = later.seen_at(&weather, &all, 90.0).expect("a scene of a frame");
    assert_eq!(latest.data.table, at(90.0));
    assert_ne!(at(60.0), at(90.0));
    assert_eq!(latest.seen_at(&weather, &all, 0.0).expect("a scene of a frame").data.table, first.data.table);
    weather.wetness.is_enabled = false;
    assert_eq!(FrameScene::new(&weather, &all, 60.0).expect("a scene of a frame").data.wetness, 0);
}

/// Frames of a scene in which something moves have what stands still in the same places of their buffers, and all else is what it is in a
/// frame alone.
#[test]
fn what_stands_still_is_the_same_in_all_frames() {
    use downpour_scene::scene::{Animation, Channel, Interpolation, Parts, Property, Track};

    // A lamp with glass beside it, a wall, and a thing that goes by with a child.
    let mut all = scene(vec![node(Some(0), Vec3::ZERO), node(Some(1), Vec3::X), node(Some(2), Vec3::Z)]);
    all.meshes = (0..3)
        .map(|k| Mesh { primitives: vec![Primitive { material: k, ..triangles(9) }], ..Mesh::default() })
        .collect();
    all.materials = vec![
        Material::default(),
        Material { emissive: Vec3::splat(9.0), ..Material::default() },
        Material::default(),
    ];
    let moving = Node { local: Local::Parts(Parts::default()), children: vec![2], ..Node::default() };
    all.nodes.push(moving);
    all.roots = vec![0, 1, 3];
    let values = vec![0.0, 0.0, 0.0, 4.0, 0.0, 0.0];
    let track = Track {
        times: vec![0.0, 2.0],
        values,
        width: 3,
        interpolation: Interpolation::Linear,
        ..Track::default()
    };
    all.animations = vec![Animation {
        name: String::new(),
        channels: vec![Channel { node: 3, property: Property::Translation, track }],
    }];
    assert_eq!(all.moving_nodes(&[0], &[]), [false, false, true, true]);
    let mut all = loaded(all);
    all.animations = vec![Some(0)];
    let weather = Weather::default();
    let first = FrameScene::new(&weather, &all, 0.0).expect("a scene");
    let later = first.moved(&weather, &all, 1.0).expect("a scene");
    let alone = FrameScene::new(&weather, &all, 1.0).expect("a scene");
    assert_eq!((later.triangles, later.data.triangles.len()), (27, 27));
    assert!(later.data.nodes == alone.data.nodes && later.data.triangles == alone.data.triangles);
    assert!(later.data.corners == alone.data.corners && later.data.table == alone.data.table);
    assert!(later.data.texels == alone.data.texels && later.data.emitters == alone.data.emitters);
    let still = later.data.still_ranges(&first.data).expect("one scene");
    assert_eq!((still.triangles.clone(), still.corners.clone()), (0..18, 0..54));
    assert!(later.data.nodes[still.nodes.clone()] == first.data.nodes[still.nodes]);
    assert!(later.data.triangles[still.triangles.clone()] == first.data.triangles[still.triangles]);
    assert!(later.data.triangles[18..] != first.data.triangles[18..]);
    assert!(later.data.texels[still.texels.clone()] == first.data.texels[still.texels]);
    // Another scene shares nothing, and what stands still has no such parts.
    assert_eq!(alone.data.still_ranges(&first.data), None);
    all.animations.clear();
    let resting = FrameScene::new(&weather, &all, 0.0).expect("a scene");
    assert_eq!(resting.data.still_ranges(&resting.data), None);
}
