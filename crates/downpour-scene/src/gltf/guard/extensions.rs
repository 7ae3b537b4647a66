//! Extensions: required ones must be supported.

use super::spot::Spot;
use crate::error::SceneError;

/// Extensions that a file may require: those that are read, and those that leave geometry as it is.
const KNOWN: [&str; 17] = [
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
];

/// Extension that allows integer positions.
pub(super) const QUANTIZATION: &str = "KHR_mesh_quantization";

/// Checks the two lists of names.
pub(super) fn check(document: &Spot<'_>) -> Result<(), SceneError> {
    document.each(&["extensionsUsed", "[]"], &mut |name| name.text().map(drop))?;
    document.each(&["extensionsRequired", "[]"], &mut |name| {
        if KNOWN.contains(&name.text()?) {
            return Ok(());
        }
        let text = name.text()?;
        let compressed =
            ["draco", "meshopt", "basisu", "webp", "avif"].iter().any(|part| text.contains(part));
        let error = name.not("no required extension but those that Downpour knows");
        Err(if compressed {
            error.with_advice("export again without mesh or texture compression")
        } else {
            error.with_advice("export again without that extension")
        })
    })
}

/// True if the file declares that it uses an extension.
pub(super) fn used(document: &Spot<'_>, extension: &str) -> bool {
    ["extensionsUsed", "extensionsRequired"].iter().any(|list| {
        let names = document.value.get(*list).and_then(|names| names.as_array());
        names.is_some_and(|names| names.iter().any(|name| name.as_str() == Some(extension)))
    })
}
