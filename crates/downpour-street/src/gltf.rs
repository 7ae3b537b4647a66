//! A street or a car as glTF 2.0: documents for day and night that share one binary file, or one .glb.
//!
//! Positions and texture coordinates are floats, normals and tints integers (`KHR_mesh_quantization`).

use glam::Vec3;
use serde_json::{Value, json};

use crate::car::Car;
use crate::error::StreetError;
use crate::material::Material;
use crate::mesh::{Part, Vertex, turn};
use crate::model::{Lamp, Piece, Placement};
use crate::street::Street;
use crate::textures::textures;

/// A file of a street.
#[derive(Clone, Debug)]
pub struct File {
    /// Name of the file.
    pub name: String,
    /// Bytes of the file.
    pub bytes: Vec<u8>,
}

/// Light of the variant of a street.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeOfDay {
    /// All lamps are off.
    Day,
    /// Lamps burn and windows are lit.
    Night,
}

/// The binary file and the offset of each part in it.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Material>,
}

/// Parts of a file.
#[derive(Clone, Copy)]
struct Parts<'a> {
    pieces: &'a [Piece],
    lamps: &'a [Lamp],
}

impl Street {
    /// `NAME.gltf`, `NAME_night.gltf` if it has lamps, and `NAME.bin`; textures are expected in the folder `textures` beside them
    /// ([`textures`]).
    #[must_use]
    pub fn to_gltf(&self, name: &str) -> Vec<File> {
        self.parts().to_gltf(name)
    }

    /// The street in one file, with its textures.
    ///
    /// # Errors
    /// [`StreetError::Texture`] if a texture cannot be encoded.
    pub fn to_glb(&self, time: TimeOfDay) -> Result<Vec<u8>, StreetError> {
        self.parts().to_glb(time)
    }

    fn parts(&self) -> Parts<'_> {
        Parts { pieces: self.pieces(), lamps: self.lamps() }
    }
}

impl Car {
    /// `NAME.gltf`, `NAME_night.gltf` and `NAME.bin`. It has no textures.
    #[must_use]
    pub fn to_gltf(&self, name: &str) -> Vec<File> {
        self.parts().to_gltf(name)
    }

    /// The car in one file.
    ///
    /// # Errors
    /// [`StreetError::Texture`] if a texture cannot be encoded.
    pub fn to_glb(&self, time: TimeOfDay) -> Result<Vec<u8>, StreetError> {
        self.parts().to_glb(time)
    }

    fn parts(&self) -> Parts<'_> {
        Parts { pieces: self.pieces(), lamps: self.lamps() }
    }
}

impl Parts<'_> {
    fn to_gltf(self, name: &str) -> Vec<File> {
        let mut buffer = lay_out(self);
        let rolling = roll(self, &mut buffer);
        let uri = format!("{name}.bin");
        let mut files = Vec::new();
        let is_lit = !self.lamps.is_empty();
        for (end, time) in [("", TimeOfDay::Day), ("_night", TimeOfDay::Night)] {
            if time == TimeOfDay::Night && !is_lit {
                continue;
            }
            let (mut root, images) = document(self, &buffer, rolling.as_ref(), time);
            if !images.is_empty() {
                root["images"] =
                    images.iter().map(|name| json!({"uri": format!("textures/{name}")})).collect();
            }
            root["buffers"] = json!([{"uri": uri, "byteLength": buffer.bytes.len()}]);
            files.push(File { name: format!("{name}{end}.gltf"), bytes: format!("{root}\n").into_bytes() });
        }
        files.push(File { name: uri, bytes: buffer.bytes });
        files
    }

    fn to_glb(self, time: TimeOfDay) -> Result<Vec<u8>, StreetError> {
        let mut buffer = lay_out(self);
        let rolling = roll(self, &mut buffer);
        let (mut root, images) = document(self, &buffer, rolling.as_ref(), time);
        if !images.is_empty() {
            let textures = textures()?;
            let mut listed = Vec::new();
            for name in images {
                let Some(texture) = textures.iter().find(|texture| texture.name == name) else { continue };
                let kind = if name.ends_with(".png") { "image/png" } else { "image/jpeg" };
                listed.push(
                    json!({"name": name, "mimeType": kind, "bufferView": buffer.view(&texture.bytes, None)}),
                );
            }
            root["images"] = json!(listed);
        }
        root["bufferViews"] = json!(buffer.views);
        root["buffers"] = json!([{"byteLength": buffer.bytes.len()}]);
        let mut text = root.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let total = 12 + 8 + text.len() + 8 + buffer.bytes.len();
        let mut glb = Vec::with_capacity(total);
        glb.extend(b"glTF");
        for word in [2, total as u32, text.len() as u32] {
            glb.extend(word.to_le_bytes());
        }
        glb.extend(b"JSON");
        glb.extend(text);
        glb.extend((buffer.bytes.len() as u32).to_le_bytes());
        glb.extend(b"BIN\0");
        glb.extend(buffer.bytes);
        Ok(glb)
    }
}

/// Number of keys of a turn of a wheel: each is a quarter of it from the one before.
const TURN_KEYS: usize = 5;

/// Animation of the wheels, as at 1 m/s.
fn roll(parts: Parts<'_>, buffer: &mut Buffer) -> Option<Value> {
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    let mut node = 0;
    for piece in parts.pieces {
        let Some(radius) = piece.rolls_on_m else {
            node += piece.copies.len();
            continue;
        };
        let quarter_s = std::f32::consts::FRAC_PI_2 * radius;
        let times: Vec<f32> = (0..TURN_KEYS).map(|key| key as f32 * quarter_s).collect();
        let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
        let view = buffer.view(&floats(&times), None);
        let input = buffer.accessor(json!({
            "bufferView": view, "componentType": 5126, "count": TURN_KEYS, "type": "SCALAR",
            "min": [times[0]], "max": [times[TURN_KEYS - 1]],
        }));
        for copy in &piece.copies {
            let turns: Vec<f32> = (0..TURN_KEYS).flat_map(|key| rolled(*copy, 90.0 * key as f32)).collect();
            let view = buffer.view(&floats(&turns), None);
            let output = buffer.accessor(
                json!({"bufferView": view, "componentType": 5126, "count": TURN_KEYS, "type": "VEC4"}),
            );
            channels.push(json!({"sampler": samplers.len(), "target": {"node": node, "path": "rotation"}}));
            samplers.push(json!({"input": input, "output": output}));
            node += 1;
        }
    }
    (!channels.is_empty()).then(|| json!({"name": "roll", "samplers": samplers, "channels": channels}))
}

/// Rotation of a copy that has rolled by an angle in degrees toward +z: its own turn first, then about x.
fn rolled(copy: Placement, degrees: f32) -> [f32; 4] {
    let ((c, s), (d, t)) = (turn(degrees / 2.0), turn(copy.turn_deg / 2.0));
    [s * d, c * t, s * t, c * d]
}

fn lay_out(parts: Parts<'_>) -> Buffer {
    let mut all = Buffer::default();
    for piece in parts.pieces {
        let mut primitives = Vec::new();
        for (&material, part) in &piece.mesh.parts {
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

/// The document without images and buffers, and the names of its images.
fn document(
    parts: Parts<'_>,
    buffer: &Buffer,
    rolling: Option<&Value>,
    time: TimeOfDay,
) -> (Value, Vec<&'static str>) {
    let is_night = time == TimeOfDay::Night;
    let mut images: Vec<&'static str> = Vec::new();
    let mut texture = |name: &'static str| {
        images.iter().position(|&known| known == name).unwrap_or_else(|| {
            images.push(name);
            images.len() - 1
        })
    };
    let materials: Vec<Value> =
        buffer.materials.iter().map(|&material| material.gltf(is_night, &mut texture)).collect();
    let mut nodes = Vec::new();
    for (index, piece) in parts.pieces.iter().enumerate() {
        for copy in &piece.copies {
            nodes.push(node(json!({"mesh": index}), copy.position, yaw(copy.turn_deg)));
        }
    }
    let lamps: &[Lamp] = if is_night { parts.lamps } else { &[] };
    for (index, lamp) in lamps.iter().enumerate() {
        let extension = json!({"name": lamp.name, "extensions": {"KHR_lights_punctual": {"light": index}}});
        nodes.push(node(extension, lamp.position, lamp.direction.map_or([0.0, 0.0, 0.0, 1.0], aim)));
    }
    let mut used = vec!["KHR_mesh_quantization"];
    let text = materials.iter().map(Value::to_string).collect::<String>();
    for extension in [
        "KHR_materials_diffuse_transmission",
        "KHR_materials_emissive_strength",
        "KHR_materials_transmission",
    ] {
        if text.contains(extension) {
            used.push(extension);
        }
    }
    let all: Vec<usize> = (0..nodes.len()).collect();
    let mut root = json!({
        "asset": {"version": "2.0", "generator": "downpour-street", "copyright": "Downpour, MIT OR Apache-2.0"},
        "scene": 0,
        "scenes": [{"nodes": all}],
        "nodes": nodes,
        "meshes": buffer.meshes,
        "materials": materials,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
    });
    if !images.is_empty() {
        root["textures"] = (0..images.len()).map(|source| json!({"source": source})).collect();
    }
    if let Some(rolling) = rolling {
        root["animations"] = json!([rolling]);
    }
    if !lamps.is_empty() {
        used.push("KHR_lights_punctual");
        root["extensions"] =
            json!({"KHR_lights_punctual": {"lights": lamps.iter().map(light).collect::<Vec<_>>()}});
    }
    root["extensionsUsed"] = json!(used);
    root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    (root, images)
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
