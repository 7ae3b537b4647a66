//! Vertex data: normals, tangents, colors, texture coordinates; and mirrored instances.

use crate::document::{data_uri, floats, spoiled, triangle, triangle_of, with};
use crate::exit_code::ExitCode as _;
use crate::{good, read, warned};
use downpour_scene::gltf::read_scene_from_bytes;
use downpour_scene::scene::{Primitive, Scene, skin_primitive};
use downpour_scene::{Budget, sandbox::NoFiles};
use glam::{Vec2, Vec3, Vec4};
use serde_json::{Value, json};

fn part(scene: &Scene) -> &Primitive {
    &scene.meshes[0].primitives[0]
}

/// A square of two triangles with texture coordinates, colors and one shared edge.
fn square(extra: &[(&str, Value)]) -> Value {
    let mut bytes = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    bytes.extend(floats(&[0.0, 0.0, 2.0].repeat(4)));
    bytes.extend(floats(&[0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]));
    bytes.extend([255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 255, 255, 255, 0]);
    bytes.extend([0, 1, 2, 2, 1, 3]);
    bytes.extend([0; 2]);
    let view = |offset: usize, length: usize, stride: Option<usize>| {
        let mut view = json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        view
    };
    let document = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "materials": [{}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 4}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC3"},
            {"bufferView": 4, "componentType": 5121, "count": 6, "type": "SCALAR"}
        ],
        "bufferViews": [view(0, 48, None), view(48, 48, None), view(96, 32, None), view(128, 16, Some(4)), view(144, 6, None)],
        "buffers": [{"byteLength": bytes.len(), "uri": data_uri(&bytes)}]
    });
    with(document, extra)
}

const ATTRIBUTES: &str = "/meshes/0/primitives/0/attributes";

#[test]
fn normals_are_given_or_flat() {
    let flat = good(&square(&[]));
    assert_eq!((part(&flat).positions.len(), &part(&flat).normals[..]), (6, &[Vec3::Z; 6][..]));
    assert_eq!(part(&flat).indices, [0, 1, 2, 3, 4, 5]);
    let given = good(&square(&[(ATTRIBUTES, json!({"POSITION": 0, "NORMAL": 1}))]));
    assert_eq!((part(&given).positions.len(), &part(&given).normals[..]), (4, &[Vec3::Z; 4][..]));
    assert_eq!(part(&given).indices, [0, 1, 2, 2, 1, 3]);
    assert_eq!((part(&given).bounds.min, part(&given).bounds.max), (Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)));
}

#[test]
fn colors_and_coordinates_follow_their_vertices() {
    let attributes = json!({"POSITION": 0, "TEXCOORD_1": 2, "COLOR_0": 3});
    let scene = good(&square(&[(ATTRIBUTES, attributes)]));
    let colors = part(&scene).colors.as_ref().expect("colors");
    assert_eq!((colors[1], colors[5]), (Vec4::new(0.0, 1.0, 0.0, 1.0), Vec4::ONE));
    assert_eq!((part(&scene).uvs[0].len(), part(&scene).uvs[1][5]), (0, Vec2::new(1.0, 0.0)));
}

/// Tangents are computed only for normal maps, and only with texture coordinates.
#[test]
fn tangents_are_made_for_normal_maps() {
    let attributes = json!({"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2});
    let mapped = [
        (ATTRIBUTES, attributes),
        ("/materials/0", json!({"normalTexture": {"index": 0, "scale": 0.5}})),
        ("/textures", json!([{"source": 0}])),
        ("/images", json!([{"uri": crate::png_uri()}])),
        ("/meshes/0/primitives/0/material", json!(0)),
    ];
    let scene = good(&square(&mapped));
    assert_eq!(part(&scene).tangents.len(), 4);
    for tangent in &part(&scene).tangents {
        // Red of the normal map is right of the picture; green is up, and up is -V: w = 1 on an unmirrored square.
        assert!(tangent.distance(Vec4::new(1.0, 0.0, 0.0, 1.0)) < 1e-6, "{tangent}");
    }
    assert_eq!(scene.materials[0].normal_scale, 0.5);
    let plain = good(&square(&mapped[..1]));
    assert!(part(&plain).tangents.is_empty());
    let bare = good(&square(&mapped[1..]));
    assert!(part(&bare).tangents.is_empty());
    warned(&bare, "meshes[0].primitives[0]: no TEXCOORD_0, which its material uses");
}

/// A mirrored instance is flagged, its normals stay on their side, and the triangles of the model are reversed.
#[test]
fn mirrors_turn_triangles_over() {
    let scene = good(&spoiled(&[("/nodes/0/scale", json!([-2, 1, 1]))]));
    let pose = scene.pose(None, 0.0);
    let instance = &pose.instances[0];
    assert!(instance.mirrored && instance.joints.is_empty());
    let skinned = skin_primitive(part(&scene), instance);
    assert_eq!((skinned.positions[1], skinned.normals[1]), (Vec3::new(-2.0, 0.0, 0.0), Vec3::Z));
    let model = scene.triangles(&pose);
    assert_eq!(model.indices, [[0, 2, 1]]);
    assert_eq!(
        downpour_scene::gltf::read_triangles_from_bytes(
            "test",
            spoiled(&[("/nodes/0/scale", json!([-2, 1, 1]))]).to_string().as_bytes(),
            &NoFiles,
            &mut Budget::default(),
        )
        .expect("valid")
        .indices,
        model.indices
    );
}

#[test]
fn useless_shapes_are_dropped_with_a_warning() {
    let mut values =
        vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    values[4] = f32::NAN;
    let bytes = [floats(&values), vec![0, 0, 1, 0, 2, 0, 0, 0]].concat();
    let scene = good(&triangle_of(&bytes));
    assert!(scene.meshes[0].primitives.is_empty());
    warned(
        &scene,
        "meshes[0].primitives[0]: dropped: 1 positions, normals or other vertex data are not finite",
    );
    let flat = good(&spoiled(&[("/nodes/0/scale", json!([1, 0, 1]))]));
    assert!(flat.pose(None, 0.0).instances.is_empty());
    warned(&flat, "nodes[0]: dropped: its transform has no inverse");
    let far = good(&spoiled(&[("/nodes/0/translation", json!([1e38, 0, 0]))]));
    assert_eq!((far.pose(None, 0.0).left_out, far.meshes[0].primitives.len()), (1, 1));
    let turned = good(&spoiled(&[("/nodes/0/rotation", json!([0, 0, 0, 0]))]));
    assert_eq!(turned.pose(None, 0.0).left_out, 1);
}

/// Every instance counts against the budget, but each mesh is stored once.
#[test]
fn the_budget_is_kept() {
    let nodes: Vec<Value> = (0..100).map(|i| json!({"mesh": 0, "translation": [i, 0, 0]})).collect();
    let roots: Vec<usize> = (0..100).collect();
    let document = with(triangle(), &[("/nodes", json!(nodes)), ("/scenes/0/nodes", json!(roots))]);
    let text = document.to_string();
    let mut budget = Budget { vertices: 300, ..Budget::default() };
    let scene = read_scene_from_bytes("a", text.as_bytes(), &NoFiles, &mut budget).expect("enough");
    assert_eq!((scene.pose(None, 0.0).instances.len(), scene.triangle_count(), budget.vertices), (100, 1, 0));
    assert!(budget.bytes > (2 << 30) - 65_536, "{}", budget.bytes);
    let mut budget = Budget { vertices: 299, ..Budget::default() };
    let error = read_scene_from_bytes("a", text.as_bytes(), &NoFiles, &mut budget).expect_err("too many");
    assert_eq!((error.exit_code(), budget.vertices), (3, 299));
    // A skin of a thousand joints on a thousand nodes is a million matrices.
    let many = |count: usize| -> Vec<Value> { (0..count).map(|_| json!({"mesh": 0, "skin": 0})).collect() };
    let list: Vec<usize> = (0..3000).collect();
    let skinned = with(
        triangle(),
        &[
            ("/nodes", json!(many(3000))),
            ("/scenes/0/nodes", json!(list)),
            ("/skins", json!([{"joints": list}])),
        ],
    );
    let error = read(&skinned).expect_err("1.4 GB of matrices from 100 kB of text");
    assert_eq!(error.exit_code(), 3, "{error}");
}
