//! Models as glTF 2.0: one binary file each, and a document for each variant (day, night, paints) that shares it.
//!
//! Positions and texture coordinates are floats, normals and tints integers (`KHR_mesh_quantization`).

use glam::Vec3;
use serde_json::{Value, json};

use super::material::Material;
use super::mesh::{Part, Vertex, turn};
use super::model::{Lamp, Model};

/// A file of a model.
pub(super) struct File {
    pub(super) name: String,
    pub(super) bytes: Vec<u8>,
}

/// A variant of a model.
struct Look {
    file: String,
    is_night: bool,
    paint: Option<[f64; 3]>,
}

/// The binary file and the offset of each part in it.
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Material>,
}

/// Makes all files of a model: `NAME.bin`, `NAME.gltf`, `NAME_night.gltf` if it has lamps, and one for each paint.
pub(super) fn files(model: &Model) -> Vec<File> {
    let buffer = lay_out(model);
    let shines = !model.lamps.is_empty();
    let mut looks = Vec::new();
    let mut add = |name: &str, paint| {
        looks.push(Look { file: format!("{name}.gltf"), is_night: false, paint });
        if shines {
            looks.push(Look { file: format!("{name}_night.gltf"), is_night: true, paint });
        }
    };
    if model.paints.is_empty() {
        add(model.name, None);
    }
    for (name, paint) in &model.paints {
        add(name, Some(*paint));
    }
    let mut files: Vec<File> = looks
        .iter()
        .map(|look| File { name: look.file.clone(), bytes: document(model, &buffer, look).into_bytes() })
        .collect();
    files.push(File { name: format!("{}.bin", model.name), bytes: buffer.bytes });
    files
}

fn lay_out(model: &Model) -> Buffer {
    let mut all = Buffer {
        bytes: Vec::new(),
        views: Vec::new(),
        accessors: Vec::new(),
        meshes: Vec::new(),
        materials: Vec::new(),
    };
    for piece in &model.pieces {
        let mut primitives = Vec::new();
        for (&material, part) in piece.mesh.parts.iter().filter(|(_, part)| !part.indices.is_empty()) {
            let index = all.materials.iter().position(|&m| m == material).unwrap_or_else(|| {
                all.materials.push(material);
                all.materials.len() - 1
            });
            primitives.push(all.primitive(part, material, index));
        }
        all.meshes.push(json!({"name": piece.name, "primitives": primitives}));
    }
    all
}

impl Buffer {
    fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        let mut view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn primitive(&mut self, part: &Part, material: Material, index: usize) -> Value {
        let layout = Layout::of(part, material);
        let mut bytes = Vec::with_capacity(part.vertices.len() * layout.stride());
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        for vertex in &part.vertices {
            (low, high) = (low.min(vertex.position), high.max(vertex.position));
            layout.write(vertex, &mut bytes);
        }
        let count = part.vertices.len();
        let vertices = self.view(&bytes, Some(layout.stride()));
        let is_short = count <= 1 << 16;
        let indices: Vec<u8> = if is_short {
            part.indices.iter().flat_map(|&k| (k as u16).to_le_bytes()).collect()
        } else {
            part.indices.iter().flat_map(|k| k.to_le_bytes()).collect()
        };
        let corners = self.view(&indices, None);
        let mut own = |offset: usize, component: u32, kind: &str, more: Value| {
            let mut accessor = json!({
                "bufferView": vertices, "byteOffset": offset, "componentType": component, "count": count, "type": kind,
            });
            if let Value::Object(more) = more {
                for (key, value) in more {
                    accessor[key] = value;
                }
            }
            self.accessor(accessor)
        };
        let normalized = || json!({"normalized": true});
        let bounds = json!({"min": low.to_array(), "max": high.to_array()});
        let mut attributes = json!({"POSITION": own(0, 5126, "VEC3", bounds)});
        let component = if layout.short_normals { 5122 } else { 5120 };
        attributes["NORMAL"] = json!(own(12, component, "VEC3", normalized()));
        attributes["COLOR_0"] = json!(own(layout.tint(), 5121, "VEC4", normalized()));
        if layout.has_uv {
            attributes["TEXCOORD_0"] = json!(own(layout.tint() + 4, 5126, "VEC2", json!({})));
        }
        let indices = self.accessor(json!({
            "bufferView": corners,
            "componentType": if is_short { 5123 } else { 5125 },
            "count": part.indices.len(),
            "type": "SCALAR",
        }));
        json!({"attributes": attributes, "indices": indices, "material": index})
    }
}

/// Vertex layout of a part: position, normal, tint, and texture coordinates if its material has a texture.
struct Layout {
    /// True if normals use 16 bits per component: 8 hold those of flat parts exactly.
    short_normals: bool,
    has_uv: bool,
}

impl Layout {
    fn of(part: &Part, material: Material) -> Self {
        let is_coarse = |v: f32| (v * 127.0 - (v * 127.0).round()).abs() < 1.0e-3;
        let short_normals =
            part.vertices.iter().any(|vertex| !vertex.normal.to_array().into_iter().all(is_coarse));
        Self { short_normals, has_uv: material.has_texture() }
    }

    /// Offset of the tint.
    fn tint(&self) -> usize {
        if self.short_normals { 20 } else { 16 }
    }

    fn stride(&self) -> usize {
        self.tint() + if self.has_uv { 12 } else { 4 }
    }

    fn write(&self, vertex: &Vertex, bytes: &mut Vec<u8>) {
        bytes.extend(vertex.position.to_array().iter().flat_map(|v| v.to_le_bytes()));
        let normal = vertex.normal.to_array();
        if self.short_normals {
            bytes.extend(normal.iter().flat_map(|v| ((v * 32767.0).round() as i16).to_le_bytes()));
            bytes.extend([0; 2]);
        } else {
            bytes.extend(normal.iter().flat_map(|v| ((v * 127.0).round() as i8).to_le_bytes()));
            bytes.push(0);
        }
        bytes.extend(vertex.tint.to_array().map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8));
        bytes.push(255);
        if self.has_uv {
            bytes.extend(vertex.uv.to_array().iter().flat_map(|v| v.to_le_bytes()));
        }
    }
}

/// A number of a document: six decimals are enough, and short.
fn short(v: f32) -> f64 {
    (f64::from(v) * 1.0e6).round() / 1.0e6
}

fn document(model: &Model, buffer: &Buffer, look: &Look) -> String {
    let mut images: Vec<&'static str> = Vec::new();
    let mut texture = |name: &'static str| {
        images.iter().position(|&known| known == name).unwrap_or_else(|| {
            images.push(name);
            images.len() - 1
        })
    };
    let materials: Vec<Value> = buffer
        .materials
        .iter()
        .map(|&material| {
            let mut made = material.gltf(look.is_night, &mut texture);
            if let (Material::CarPaint, Some([r, g, b])) = (material, look.paint) {
                made["pbrMetallicRoughness"]["baseColorFactor"] = json!([r, g, b, 1.0]);
            }
            made
        })
        .collect();
    let mut nodes = Vec::new();
    for (index, piece) in model.pieces.iter().enumerate() {
        for copy in &piece.copies {
            nodes.push(node(json!({"mesh": index}), copy.position, yaw(copy.turn_deg)));
        }
    }
    let lamps: &[Lamp] = if look.is_night { &model.lamps } else { &[] };
    for (index, lamp) in lamps.iter().enumerate() {
        let extension = json!({"name": lamp.name, "extensions": {"KHR_lights_punctual": {"light": index}}});
        nodes.push(node(extension, lamp.position, lamp.direction.map_or([0.0, 0.0, 0.0, 1.0], aim)));
    }
    let mut used = vec!["KHR_mesh_quantization"];
    let text = materials.iter().map(Value::to_string).collect::<String>();
    if text.contains("KHR_materials_emissive_strength") {
        used.push("KHR_materials_emissive_strength");
    }
    let all: Vec<usize> = (0..nodes.len()).collect();
    let mut root = json!({
        "asset": {"version": "2.0", "generator": "cargo xtask scenes", "copyright": "Downpour, MIT OR Apache-2.0"},
        "scene": 0,
        "scenes": [{"nodes": all}],
        "nodes": nodes,
        "meshes": buffer.meshes,
        "materials": materials,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"uri": format!("{}.bin", model.name), "byteLength": buffer.bytes.len()}],
    });
    if !images.is_empty() {
        root["images"] = images.iter().map(|name| json!({"uri": format!("textures/{name}")})).collect();
        root["textures"] = (0..images.len()).map(|source| json!({"source": source})).collect();
    }
    if !lamps.is_empty() {
        used.push("KHR_lights_punctual");
        root["extensions"] =
            json!({"KHR_lights_punctual": {"lights": lamps.iter().map(light).collect::<Vec<_>>()}});
    }
    root["extensionsUsed"] = json!(used);
    root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    format!("{root}\n")
}

fn node(mut node: Value, position: [f32; 3], rotation: [f32; 4]) -> Value {
    if position != [0.0; 3] {
        node["translation"] = json!(position.map(short));
    }
    if rotation != [0.0, 0.0, 0.0, 1.0] {
        node["rotation"] = json!(rotation.map(short));
    }
    node
}

fn light(lamp: &Lamp) -> Value {
    let mut light = json!({
        "name": lamp.name,
        "type": if lamp.direction.is_some() { "spot" } else { "point" },
        "color": lamp.color.map(short),
        "intensity": short(lamp.intensity_cd),
        "range": short(lamp.range_m),
    });
    if lamp.direction.is_some() {
        let [inner, outer] = lamp.cone_deg.map(|angle| short(angle.to_radians()));
        light["spot"] = json!({"innerConeAngle": inner, "outerConeAngle": outer});
    }
    light
}

/// The turn about the vertical by an angle in degrees, as a quaternion.
fn yaw(degrees: f32) -> [f32; 4] {
    let (c, s) = turn(degrees / 2.0);
    [0.0, s, 0.0, c]
}

/// The turn that takes -z to a direction.
fn aim(direction: [f32; 3]) -> [f32; 4] {
    let to = Vec3::from(direction).normalize_or_zero();
    let from = Vec3::NEG_Z;
    let dot = from.dot(to);
    if dot < -0.999_999 {
        return [0.0, 1.0, 0.0, 0.0];
    }
    let axis = from.cross(to);
    let w = 1.0 + dot;
    let length = (axis.length_squared() + w * w).sqrt();
    [axis.x / length, axis.y / length, axis.z / length, w / length]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lamp_shines_where_it_is_aimed() {
        for to in [Vec3::NEG_Y, Vec3::new(0.3, -0.2, 1.0).normalize(), Vec3::Z] {
            let [x, y, z, w] = aim(to.to_array());
            let q = glam::Quat::from_xyzw(x, y, z, w);
            assert!((q * Vec3::NEG_Z - to).length() < 1e-6, "{to}");
        }
    }
}
