//! Valid documents and broken ones made from them, and the invariants of everything that is read.

#![allow(dead_code, unused_imports, reason = "each test binary uses its part of this module")]

pub(crate) mod broken;
pub(crate) mod modes;
pub(crate) mod triangle;

use downpour_scene::gltf::{TriangleModel, read_triangles_from_bytes};
use downpour_scene::sandbox::NoFiles;
use downpour_scene::scene::{Scene, skin_primitive};
use downpour_scene::{Budget, SceneError};
use serde_json::Value;

pub(crate) use triangle::{data_uri, floats, glb, spoiled, triangle, triangle_of, with};

/// Reads a document that needs no other files.
pub(crate) fn read(document: &Value) -> Result<TriangleModel, SceneError> {
    read_bytes(document.to_string().as_bytes())
}

/// Reads bytes that need no other files.
pub(crate) fn read_bytes(bytes: &[u8]) -> Result<TriangleModel, SceneError> {
    read_triangles_from_bytes("test", bytes, &NoFiles, &mut Budget::default())
}

/// Checks the invariants of a model.
pub(crate) fn check(model: &TriangleModel) {
    let finite = |vectors: &[[f32; 3]]| vectors.iter().flatten().all(|part| part.is_finite());
    assert!(finite(&model.positions));
    assert!(model.positions.iter().flatten().all(|part| part.abs() <= 1e9));
    if let Some(normals) = &model.normals {
        assert_eq!(normals.len(), model.positions.len());
        for normal in normals {
            let square: f32 = normal.iter().map(|part| part * part).sum();
            assert!((square - 1.0).abs() < 1e-5, "{normal:?}");
        }
    }
    assert!(model.indices.iter().flatten().all(|&index| (index as usize) < model.positions.len()));
}

/// Checks the invariants of a message: one line, no control characters, of limited length.
pub(crate) fn check_message(message: &str) {
    assert!(!message.chars().any(char::is_control), "{message:?}");
    assert!(message.chars().count() < 600, "{message}");
}

/// Checks the invariants of a scene: finite numbers and valid indices, in any pose.
pub(crate) fn check_scene(scene: &Scene) {
    for part in scene.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let count = part.positions.len();
        assert!(count > 0 && part.positions.iter().all(|p| p.abs().max_element() <= 1e9));
        assert!(part.normals.len() == count && part.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
        for list in [part.tangents.len(), part.uvs[0].len(), part.uvs[1].len(), part.joints.len()] {
            assert!(list == 0 || list == count);
        }
        assert!(part.tangents.iter().all(|t| (t.truncate().length() - 1.0).abs() < 1e-3 && t.w.abs() == 1.0));
        assert!(part.uvs.iter().flatten().all(|uv| uv.is_finite()));
        assert!(part.weights.iter().all(|w| (w.iter().sum::<f32>() - 1.0).abs() < 1e-5));
        assert_eq!(part.weights.len(), part.joints.len());
        assert!(part.indices.len() % 3 == 0 && part.indices.iter().all(|&index| (index as usize) < count));
        assert!(part.material < scene.materials.len());
    }
    for material in &scene.materials {
        assert!(material.textures().all(|used| used.texture < scene.textures.len() && used.uv_set < 2));
        assert!(material.textures().all(|used| used.transform.is_finite()));
        assert!(material.emissive.min_element() >= 0.0);
    }
    for node in &scene.nodes {
        assert!(node.mesh.is_none_or(|mesh| mesh < scene.meshes.len()));
        assert!(node.skin.is_none_or(|skin| skin < scene.skins.len()));
        assert!(node.light.is_none_or(|light| light < scene.lights.len()));
    }
    let poses = (0..scene.animations.len().min(3)).flat_map(|i| [0.0, 0.37, 1.9].map(|time| (Some(i), time)));
    for (animation, time) in poses.chain([(None, 0.0)]) {
        let pose = scene.pose(animation, time);
        for instance in &pose.instances {
            assert!(instance.world.is_finite() && instance.normal.is_finite());
            for part in &scene.meshes[instance.mesh].primitives {
                let last = part.joints.iter().flatten().max().map_or(0, |&joint| usize::from(joint));
                assert!(!part.is_skinned() || instance.joints.is_empty() || last < instance.joints.len());
                let skinned = skin_primitive(part, instance);
                assert!(skinned.positions.iter().chain(&skinned.normals).all(|v| v.is_finite()));
            }
        }
        assert!(pose.lights.iter().all(|light| light.position.is_finite() && light.direction.is_finite()));
        assert!(pose.cameras.iter().all(|eye| eye.eye.is_finite() && eye.up.dot(eye.forward).abs() < 1e-5));
    }
}
