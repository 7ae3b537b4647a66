//! Warnings for extensions that are not drawn.

use crate::error::{SceneError, quoted};
use crate::gltf::guard::Spot;
use crate::warning::{WarningKind, Warnings};
use std::collections::BTreeMap;

/// Extensions that are read, or that have no effect on a picture.
const READ: [&str; 10] = [
    "KHR_lights_punctual",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "KHR_xmp",
];

/// Paths of objects whose extensions affect drawing.
const PATHS: [&[&str]; 4] = [
    &["materials", "[]", "extensions"],
    &["textures", "[]", "extensions"],
    &["nodes", "[]", "extensions"],
    &["extensions"],
];

/// Warns of unsupported extensions, each once.
pub(super) fn check(document: &Spot<'_>, warnings: &mut Warnings) -> Result<(), SceneError> {
    let mut unread: BTreeMap<String, usize> = BTreeMap::new();
    document.each(&["extensionsUsed", "[]"], &mut |name| {
        let name = name.text()?;
        if !READ.contains(&name) {
            unread.entry(name.to_owned()).or_insert(0);
        }
        Ok(())
    })?;
    for path in PATHS {
        document.each(path, &mut |extensions| {
            for (name, _) in extensions.members()?.filter(|(name, _)| !READ.contains(name)) {
                let count = unread.entry(name.to_owned()).or_insert(0);
                *count = count.saturating_add(1);
            }
            Ok(())
        })?;
    }
    for (name, count) in unread {
        warnings.add(WarningKind::Ignored, "extensionsUsed", || {
            format!("{} is not read; it is used by {count} objects", quoted(&name))
        });
    }
    Ok(())
}
