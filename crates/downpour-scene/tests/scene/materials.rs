//! Materials, textures, samplers, images, lights.

use crate::document::{floats, spoiled, triangle_of, with};
use crate::exit_code::ExitCode as _;
use crate::{good, png, png_uri, warned};
use downpour_scene::gltf::{read_scene, read_scene_from_bytes};
use downpour_scene::picture::Pixels;
use downpour_scene::scene::{AlphaMode, Encoding, Filter, LightKind, Material, Sampler, Wrap};
use downpour_scene::{Budget, sandbox::NoFiles};
use glam::{Vec2, Vec3, Vec4};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::sync::Arc;

fn textured(material: &Value) -> Value {
    spoiled(&[
        ("/materials", json!([material])),
        ("/textures", json!([{"source": 0, "sampler": 0}, {"source": 0}])),
        ("/samplers", json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9985}])),
        ("/images", json!([{"uri": png_uri()}])),
    ])
}

fn near(a: f32, b: f32) -> bool {
    (a - b).abs() < 1e-6
}

#[test]
fn every_factor_is_read() {
    let scene = good(&textured(&json!({
        "name": "glass",
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.25},
        "emissiveFactor": [0.5, 0.25, 1],
        "alphaMode": "MASK", "alphaCutoff": 0.75, "doubleSided": true,
        "occlusionTexture": {"index": 0, "strength": 0.5},
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 8},
            "KHR_materials_ior": {"ior": 1.333},
            "KHR_materials_diffuse_transmission": {
                "diffuseTransmissionFactor": 0.625, "diffuseTransmissionColorFactor": [0.5, 1, 0.25],
                "diffuseTransmissionTexture": {"index": 0}, "diffuseTransmissionColorTexture": {"index": 0}
            },
            "KHR_materials_transmission": {"transmissionFactor": 0.875},
            "KHR_materials_unlit": {},
            "KHR_materials_clearcoat": {"clearcoatFactor": 1}
        },
        "extras": {"porosity": 0.375, "note": "kept by nobody"}
    })));
    let material = &scene.materials[0];
    assert_eq!((material.base_color, material.metallic), (Vec4::new(0.1, 0.2, 0.3, 0.4), 0.5));
    assert_eq!((material.roughness, material.emissive), (0.25, Vec3::new(4.0, 2.0, 8.0)));
    assert_eq!((material.alpha_mode, material.double_sided), (AlphaMode::Mask { cutoff: 0.75 }, true));
    assert_eq!((material.ior, material.transmission, material.unlit), (1.333, 0.875, true));
    assert_eq!((material.occlusion_strength, material.name.as_str()), (0.5, "glass"));
    assert_eq!(material.porosity, Some(0.375));
    assert_eq!(material.diffuse_transmission, 0.625);
    assert_eq!(material.diffuse_transmission_color, Vec3::new(0.5, 1.0, 0.25));
    let [amount, color] =
        [&material.diffuse_transmission_texture, &material.diffuse_transmission_color_texture]
            .map(|used| used.as_ref().map(|used| scene.textures[used.texture].encoding));
    assert_eq!((amount, color), (Some(Encoding::Linear), Some(Encoding::Srgb)));
    warned(&scene, "\"KHR_materials_clearcoat\" is not read");
    let plain = good(&textured(&json!({})));
    assert_eq!(plain.materials[0], Material::default());
    assert!(plain.textures.is_empty());
}

/// One image, two encodings: color for one use, data for another; each sampler as in the file.
#[test]
fn encodings_follow_the_use() {
    let scene = good(&textured(&json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
        "emissiveTexture": {"index": 0},
        "occlusionTexture": {"index": 1, "texCoord": 1}
    })));
    let material = &scene.materials[0];
    let encoding = |used: Option<downpour_scene::scene::TextureRef>| {
        let texture = used.map(|used| &scene.textures[used.texture]).expect("a texture");
        (texture.encoding, texture.sampler)
    };
    let own = Sampler {
        wrap_s: Wrap::ClampToEdge,
        wrap_t: Wrap::MirroredRepeat,
        mag: Filter::Nearest,
        min: Filter::Linear,
        mip: Some(Filter::Nearest),
    };
    assert_eq!(encoding(material.base_color_texture), (Encoding::Srgb, own));
    assert_eq!(encoding(material.emissive_texture), (Encoding::Srgb, own));
    assert_eq!(encoding(material.metallic_roughness_texture), (Encoding::Linear, own));
    assert_eq!(encoding(material.occlusion_texture), (Encoding::Linear, Sampler::USUAL));
    assert_eq!((scene.textures.len(), material.occlusion_texture.map(|used| used.uv_set)), (3, Some(1)));
    assert!(scene.textures.iter().all(|texture| Arc::ptr_eq(&texture.picture, &scene.textures[0].picture)));
    assert_eq!(scene.textures[0].picture.pixels, Pixels::Rgba8(vec![[255, 0, 0, 255], [0, 255, 0, 128]]));
}

/// `KHR_texture_transform`: offset x rotation x scale, turned counter-clockwise as seen in the picture, in which
/// the second coordinate points down.
#[test]
fn textures_are_transformed() {
    let quarter = std::f32::consts::FRAC_PI_2;
    let map = json!({"offset": [0.5, 0.25], "rotation": quarter, "scale": [2, 3], "texCoord": 1});
    let scene = good(&textured(&json!({
        "normalTexture": {"index": 0, "extensions": {"KHR_texture_transform": map}}
    })));
    let used = scene.materials[0].normal_texture.expect("a texture");
    assert_eq!(used.uv_set, 1);
    for (from, to) in [([0.0, 0.0], [0.5, 0.25]), ([1.0, 0.0], [0.5, -1.75]), ([0.0, 1.0], [3.5, 0.25])] {
        assert!(used.at(Vec2::from_array(from)).distance(to.into()) < 1e-6, "{from:?}");
    }
}

#[test]
fn what_is_out_of_range_is_held_and_told() {
    let scene = good(&textured(&json!({
        "pbrMetallicRoughness": {"metallicFactor": 1.5, "baseColorFactor": [1, -0.5, 1, 1]},
        "emissiveTexture": {"index": 0, "texCoord": 2}
    })));
    let material = &scene.materials[0];
    assert_eq!((material.metallic, material.base_color.y, material.emissive_texture), (1.0, 0.0, None));
    warned(&scene, "materials[0].pbrMetallicRoughness.metallicFactor: 1.5, not from 0 to 1: taken as 1");
    warned(&scene, "baseColorFactor[1]: -0.5, not from 0 to 1: taken as 0");
    warned(&scene, "materials[0].emissiveTexture: left out: texture coordinates of set 2");
    let bare =
        with(textured(&json!({"emissiveTexture": {"index": 0}})), &[("/textures/0", json!({"sampler": 0}))]);
    warned(&good(&bare), "textures[0]: left out: no source");
}

/// Images in a file beside the scene, in the binary chunk, and inline; and the message of each if it is missing.
#[test]
fn images_come_from_three_places() {
    let material = json!({"emissiveTexture": {"index": 0}});
    let beside = with(textured(&material), &[("/images/0/uri", json!("maps/a%20b.png"))]);
    let read = |document: &Value, files: &BTreeMap<String, Vec<u8>>, budget: &mut Budget| {
        read_scene_from_bytes("test.gltf", document.to_string().as_bytes(), files, budget)
    };
    let mut files = BTreeMap::from([("maps/a b.png".to_owned(), png())]);
    let mut budget = Budget::default();
    let scene = read(&beside, &files, &mut budget).expect("valid");
    assert_eq!((scene.textures[0].name.as_str(), scene.textures[0].picture.width), ("maps/a b.png", 2));
    assert_eq!(Budget::default().pixels - budget.pixels, 2);
    files.insert("maps/a b.png".into(), b"GIF89a".to_vec());
    let error = read(&beside, &files, &mut Budget::default()).expect_err("no PNG");
    assert_eq!(error.exit_code(), 2);
    let message = error.to_string();
    assert!(message.starts_with("test.gltf: images[0]: maps/a b.png: a GIF image"), "{message}");
    let error = read(&beside, &BTreeMap::new(), &mut Budget::default()).expect_err("no file");
    assert_eq!(error.exit_code(), 5);
    assert!(
        error.to_string().starts_with("test.gltf: images[0].uri: \"maps/a b.png\" cannot be read"),
        "{error}"
    );
    // An image that no material uses is not opened.
    let unused = with(beside, &[("/materials/0", json!({}))]);
    assert!(read(&unused, &BTreeMap::new(), &mut Budget::default()).is_ok());

    let mut bytes = floats(&[0.0; 18]);
    bytes.extend([0, 0, 1, 0, 2, 0, 0, 0]);
    bytes.extend(png());
    let inside = with(
        triangle_of(&bytes),
        &[
            ("/materials", json!([material])),
            ("/textures", json!([{"source": 0}])),
            ("/images", json!([{"bufferView": 3, "mimeType": "image/png", "name": "two.jpg"}])),
            ("/bufferViews/3", json!({"buffer": 0, "byteOffset": 80, "byteLength": png().len()})),
        ],
    );
    assert_eq!(good(&inside).textures[0].picture.height, 1);
    let mut none = Budget { pixels: 1, ..Budget::default() };
    let error =
        read_scene_from_bytes("a", inside.to_string().as_bytes(), &NoFiles, &mut none).expect_err("2 pixels");
    assert_eq!((error.exit_code(), none.pixels), (3, 1));
    let cut = with(inside, &[("/bufferViews/3/byteLength", json!(40))]);
    let error = crate::read(&cut).expect_err("half a PNG");
    assert!(error.exit_code() == 2 && error.to_string().starts_with("test: images[0]: "), "{error}");
}

/// On disk, nothing outside the folder is opened.
#[test]
#[cfg(unix)]
fn images_stay_beneath_the_folder() {
    let outside = tempfile::tempdir().expect("a folder");
    fs::write(outside.path().join("a.png"), png()).expect("written");
    let folder = tempfile::tempdir().expect("a folder");
    std::os::unix::fs::symlink(outside.path().join("a.png"), folder.path().join("link.png")).expect("a link");
    let material = json!({"emissiveTexture": {"index": 0}});
    for (uri, code, words) in [
        ("../a.png", 2, "leaves the scene folder"),
        ("/etc/passwd", 2, "is absolute"),
        ("http://a/b.png", 2, "has a scheme"),
        ("link.png", 2, "leaves the scene folder through a link"),
        ("missing.png", 5, "\"missing.png\" cannot be read"),
    ] {
        let path = folder.path().join("scene.gltf");
        let document = with(textured(&material), &[("/images/0/uri", json!(uri))]);
        fs::write(&path, document.to_string()).expect("written");
        let error = read_scene(&path, &mut Budget::default()).expect_err(uri);
        let message = error.to_string();
        assert!(
            error.exit_code() == code && message.contains(words) && message.contains("images[0].uri"),
            "{message}"
        );
    }
}

#[test]
fn lights_have_their_sorts() {
    let lights = json!([
        {"type": "directional", "intensity": 100_000, "name": "sun"},
        {"type": "point", "color": [2, 1, 0]},
        {"type": "spot", "spot": {"innerConeAngle": 0.9}}
    ]);
    let scene = good(&spoiled(&[("/extensions", json!({"KHR_lights_punctual": {"lights": lights}}))]));
    assert_eq!((scene.lights[0].kind, scene.lights[0].intensity), (LightKind::Directional, 100_000.0));
    assert_eq!((scene.lights[1].kind, scene.lights[1].intensity), (LightKind::Point, 1.0));
    let LightKind::Spot { inner, outer } = scene.lights[2].kind else { panic!("no spot") };
    assert!(near(inner, outer) && inner < outer && near(outer, std::f32::consts::FRAC_PI_4));
    warned(&scene, "lights[1].color: more than 1");
    warned(&scene, "innerConeAngle 0.9 is not below outerConeAngle");
    // No node has the light, so none shines.
    assert!(scene.pose(None, 0.0).lights.is_empty());
}
