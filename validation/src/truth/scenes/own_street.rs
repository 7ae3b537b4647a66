//! The project's own street as both renderers can read it: without relief in normals, without colors of corners and without panes of
//! glass, so that what is compared is light among its real shapes, materials and textures. At night its lamps are points without glass, given
//! beside the model; its windows and signs shine.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::super::{run, write};

/// Extension of lamps.
const LAMPS: &str = "KHR_lights_punctual";
/// Extension of panes.
const PANES: &str = "KHR_materials_transmission";
/// Material of the glass of lamps, which are points here: both renderers would leave them shut in.
const LAMP_GLASS: &str = "lamp_glass";

/// The street by day or by night.
#[derive(Clone, Debug)]
pub(super) struct OwnStreet {
    /// Its model.
    pub(super) file: PathBuf,
    /// Lamps: position in meters, intensity.
    pub(super) lamps: Vec<([f64; 3], [f64; 3])>,
}

/// Where its eye stands and looks.
pub(super) const EYE: [f64; 3] = [-1.2, 1.6, -6.0];
/// Where to.
pub(super) const AT: [f64; 3] = [0.6, 2.5, -30.0];
/// Its vertical field of view, degrees.
pub(super) const FOV_DEG: f64 = 50.0;

impl OwnStreet {
    /// Writes the street, with what it names, into a folder.
    pub(super) fn write(folder: &Path, of_night: bool) -> Result<Self, String> {
        let models = run::root().join("assets/scenes/street/models");
        let stem = if of_night { "street_night" } else { "street" };
        let source = models.join(format!("{stem}.gltf"));
        let text =
            std::fs::read_to_string(&source).map_err(|error| format!("{}: {error}", source.display()))?;
        let mut model: Value =
            serde_json::from_str(&text).map_err(|error| format!("{}: {error}", source.display()))?;
        let lamps = lamps(&model);
        simplify(&mut model);
        for list in ["buffers", "images"] {
            for named in model[list].as_array().into_iter().flatten() {
                let name = named["uri"].as_str().ok_or("a file without a name")?;
                copy(&models.join(name), &folder.join(name))?;
            }
        }
        let file = folder.join(format!("own-{stem}.gltf"));
        write(&file, model.to_string().as_bytes())?;
        Ok(Self { file, lamps: if of_night { lamps } else { Vec::new() } })
    }
}

/// Copies a file, with its folder.
fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let say = |error: std::io::Error| format!("{}: {error}", from.display());
    if let Some(folder) = to.parent() {
        std::fs::create_dir_all(folder).map_err(say)?;
    }
    std::fs::copy(from, to).map(|_| ()).map_err(say)
}

/// Lamps of a model whose nodes with lamps are not turned by others.
fn lamps(model: &Value) -> Vec<([f64; 3], [f64; 3])> {
    let lights = &model["extensions"][LAMPS]["lights"];
    let three = |value: &Value, none: f64| [0, 1, 2].map(|k| value[k].as_f64().unwrap_or(none));
    let nodes = model["nodes"].as_array().into_iter().flatten();
    nodes
        .filter_map(|node| {
            let light = &lights[usize::try_from(node["extensions"][LAMPS]["light"].as_u64()?).ok()?];
            let candela = light["intensity"].as_f64().unwrap_or(1.0);
            Some((three(&node["translation"], 0.0), three(&light["color"], 1.0).map(|part| part * candela)))
        })
        .collect()
}

/// Leaves out what the comparison leaves out.
fn simplify(model: &mut Value) {
    let remove = |value: &mut Value, key: &str| {
        value.as_object_mut().and_then(|object| object.remove(key));
    };
    let materials = model["materials"].as_array_mut();
    let panes: Vec<bool> = materials
        .into_iter()
        .flatten()
        .map(|material| {
            for key in ["normalTexture", "occlusionTexture"] {
                remove(material, key);
            }
            material["name"] == LAMP_GLASS || material["extensions"].get(PANES).is_some()
        })
        .collect();
    let is_pane = |part: &Value| {
        let material = part["material"].as_u64().and_then(|index| usize::try_from(index).ok());
        material.and_then(|index| panes.get(index)).copied().unwrap_or(false)
    };
    let mut kept = Vec::new();
    for mesh in model["meshes"].as_array_mut().into_iter().flatten() {
        if let Some(parts) = mesh["primitives"].as_array_mut() {
            let has_others = parts.iter().any(|part| !is_pane(part));
            // A mesh without parts is not allowed: one of panes alone stays, and is nowhere.
            parts.retain(|part| !has_others || !is_pane(part));
            for part in parts.iter_mut() {
                for key in ["COLOR_0", "TANGENT"] {
                    remove(&mut part["attributes"], key);
                }
            }
            kept.push(has_others);
        }
    }
    for node in model["nodes"].as_array_mut().into_iter().flatten() {
        let mesh = node["mesh"].as_u64().and_then(|index| usize::try_from(index).ok());
        if mesh.is_some_and(|index| !kept.get(index).copied().unwrap_or(false)) {
            remove(node, "mesh");
        }
        remove(node, "extensions");
    }
    remove(model, "extensions");
    for list in ["extensionsUsed", "extensionsRequired"] {
        if let Some(names) = model[list].as_array_mut() {
            names.retain(|name| name != LAMPS && name != PANES);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn panes_relief_and_lamps_are_left_out() {
        let mut model = json!({
            "extensions": { LAMPS: { "lights": [{ "intensity": 5.0, "color": [1.0, 0.5, 0.2] }] } },
            "extensionsUsed": [LAMPS, "KHR_mesh_quantization"],
            "nodes": [
                { "mesh": 0 }, { "mesh": 1 }, { "mesh": 2 },
                { "translation": [1.0, 4.0, -2.0], "extensions": { LAMPS: { "light": 0 } } }
            ],
            "meshes": [
                { "primitives": [{ "material": 0, "attributes": { "POSITION": 0, "COLOR_0": 2 } }] },
                { "primitives": [{ "material": 1, "attributes": { "POSITION": 0 } }] },
                { "primitives": [{ "material": 2, "attributes": { "POSITION": 0 } }] }
            ],
            "materials": [{ "normalTexture": { "index": 0 } }, { "extensions": { PANES: {} } }, { "name": LAMP_GLASS }],
        });
        assert_eq!(lamps(&model), [([1.0, 4.0, -2.0], [5.0, 2.5, 1.0])]);
        simplify(&mut model);
        assert!(model["materials"][0].get("normalTexture").is_none());
        assert!(model["meshes"][0]["primitives"][0]["attributes"].get("COLOR_0").is_none());
        assert_eq!([0, 1, 2].map(|node| model["nodes"][node].get("mesh").is_some()), [true, false, false]);
        assert_eq!(model["extensionsUsed"], json!(["KHR_mesh_quantization"]));
        assert!(lamps(&model).is_empty());
    }

    #[test]
    fn the_shipped_street_can_be_compared() {
        let folder = tempfile::tempdir().expect("a folder");
        let day = OwnStreet::write(folder.path(), false).expect("the street");
        assert!(day.lamps.is_empty() && day.file.exists());
        let night = OwnStreet::write(folder.path(), true).expect("the street by night");
        assert_eq!(night.lamps.len(), 11);
    }
}
