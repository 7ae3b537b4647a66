//! A bent and moving figure: two joints, a morph target, an animation, a light and a camera; for tests to spoil.

use crate::document::{data_uri, floats};
use serde_json::{Value, json};

/// Offset of the data of each kind, in bytes.
pub(crate) const TIMES: usize = 256;
pub(crate) const TURNS: usize = 268;
pub(crate) const WEIGHTS: usize = 60;

/// Its data: triangle, joints, weights, inverse bind matrices, morph, times, rotations, shifts, morph weights.
pub(crate) fn bytes() -> Vec<u8> {
    let half = 0.5f32.sqrt();
    // 0: positions of a triangle; vertex 2 follows joint 1.
    let mut bytes = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
    // 36: joints as bytes, and 12 more to keep offsets simple.
    bytes.extend([0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0]);
    bytes.extend([0; 12]);
    // 60: weights.
    bytes.extend(floats(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]));
    // 108: inverse bind matrices: identity, and one meter down.
    for height in [0.0, -1.0] {
        bytes.extend(floats(&[
            1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, height, 0.0, 1.0,
        ]));
    }
    // 236: padding; 256: times.
    bytes.extend([0; 20]);
    bytes.extend(floats(&[0.0, 1.0, 3.0]));
    // 268: rotations about Z: none, a quarter, none.
    bytes.extend(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half, 0.0, 0.0, 0.0, 1.0]));
    // 316: shifts of the cubic spline: three keys of tangent, value, tangent.
    for value in [0.0, 2.0, 2.0] {
        bytes.extend(floats(&[0.0, 0.0, 0.0, value, 0.0, 0.0, 0.0, 0.0, 0.0]));
    }
    // 424: morph weights; 436: morph displacements.
    bytes.extend(floats(&[0.0, 1.0, 0.5]));
    bytes.extend(floats(&[0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0]));
    bytes
}

/// The figure.
pub(crate) fn figure() -> Value {
    figure_of(&bytes())
}

/// The same document on other bytes.
pub(crate) fn figure_of(bytes: &[u8]) -> Value {
    let view =
        |offset: usize, length: usize| json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
    let accessor = |view: usize, component: u32, count: usize, kind: &str| json!({"bufferView": view, "componentType": component, "count": count, "type": kind});
    json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "scene": 0,
        "scenes": [{"nodes": [0, 3, 4]}],
        "nodes": [
            {"name": "hip", "children": [1], "translation": [0, 0, 5]},
            {"name": "knee", "translation": [0, 1, 0], "children": [2]},
            {"name": "lamp", "translation": [0, 1, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"name": "eye", "camera": 0, "rotation": [0, 1, 0, 0], "scale": [2, 2, 2]},
            {"name": "skin", "mesh": 0, "skin": 0, "translation": [100, 0, 0]}
        ],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2},
            "targets": [{"POSITION": 8}]
        }], "weights": [0.0]}],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": 3}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1, "zfar": 50}}],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "intensity": 40, "range": 9, "color": [1, 0.5, 0], "spot": {"outerConeAngle": 0.5}}
        ]}},
        "animations": [{
            "name": "walk",
            "samplers": [
                {"input": 4, "output": 5},
                {"input": 4, "output": 6, "interpolation": "CUBICSPLINE"},
                {"input": 4, "output": 7, "interpolation": "STEP"}
            ],
            "channels": [
                {"sampler": 0, "target": {"node": 1, "path": "rotation"}},
                {"sampler": 1, "target": {"node": 0, "path": "translation"}},
                {"sampler": 2, "target": {"node": 4, "path": "weights"}}
            ]
        }],
        "accessors": [
            accessor(0, 5126, 3, "VEC3"),
            accessor(1, 5121, 3, "VEC4"),
            accessor(2, 5126, 3, "VEC4"),
            accessor(3, 5126, 2, "MAT4"),
            accessor(4, 5126, 3, "SCALAR"),
            accessor(5, 5126, 3, "VEC4"),
            accessor(6, 5126, 9, "VEC3"),
            accessor(7, 5126, 3, "SCALAR"),
            accessor(8, 5126, 3, "VEC3")
        ],
        "bufferViews": [
            view(0, 36), view(36, 12), view(60, 48), view(108, 128), view(256, 12), view(268, 48),
            view(316, 108), view(424, 12), view(436, 36)
        ],
        "buffers": [{"byteLength": bytes.len(), "uri": data_uri(bytes)}]
    })
}
