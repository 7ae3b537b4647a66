//! Meshes of the scene: each read once, however many nodes draw it.

use super::primitives::{self, Reading};
use crate::error::SceneError;
use crate::gltf::growth::GrowthBudget;
use crate::gltf::plan;
use crate::scene::{Material, Mesh, Node, Skin};
use crate::warning::Warnings;

/// Bytes that a primitive costs however small it is.
const PER_PRIMITIVE: u64 = 512;

/// Reads the meshes that `drawn` nodes use; the others are empty.
///
/// Reads the meshes. A primitive without material gets the default one, which is then appended to `materials`.
pub(super) fn read(
    reading: &Reading<'_>,
    nodes: &[Node],
    drawn: &[usize],
    materials: &mut Vec<Material>,
    remaining: &mut GrowthBudget<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<Mesh>, SceneError> {
    let root = reading.root;
    let mut uses = vec![0u64; root.meshes.len()];
    for mesh in drawn.iter().filter_map(|&node| nodes.get(node)?.mesh) {
        if let Some(uses) = uses.get_mut(mesh) {
            *uses = uses.saturating_add(1);
        }
    }
    let given = materials.len();
    let mut default = None;
    let mut all = Vec::with_capacity(root.meshes.len());
    for (index, (json, &uses)) in root.meshes.iter().zip(&uses).enumerate() {
        let mut mesh = Mesh { name: json.name.clone().unwrap_or_default(), ..Mesh::default() };
        mesh.weights = json.weights.clone().unwrap_or_default();
        if uses > 0 {
            remaining.take((json.primitives.len() as u64).saturating_mul(PER_PRIMITIVE), "meshes")?;
            for (part, json) in json.primitives.iter().enumerate() {
                let path = format!("meshes[{index}].primitives[{part}]");
                let Some(shape) = plan::shape(root, json, format_args!("{path}"), warnings) else {
                    continue;
                };
                let material = json.material.map(|material| material.value());
                let used = material.and_then(|material| materials.get(material));
                let normal_map = used.and_then(|material| material.normal_texture);
                let read =
                    primitives::read(reading, json, &shape, &path, uses, normal_map, remaining, warnings)?;
                if let Some(mut primitive) = read {
                    primitive.material = material.unwrap_or_else(|| *default.get_or_insert(given));
                    if let Some(material) = materials.get(primitive.material) {
                        primitives::check_uvs(&primitive, material, &path, warnings);
                    }
                    mesh.primitives.push(primitive);
                }
            }
        }
        all.push(mesh);
    }
    if default.is_some() {
        materials.push(Material::default());
    }
    Ok(all)
}

/// Checks that each skin has the joints that its meshes use, and deducts the cost of a pose of them.
pub(super) fn check_joints(
    nodes: &[Node],
    drawn: &[usize],
    meshes: &[Mesh],
    skins: &[Skin],
    remaining: &mut GrowthBudget<'_>,
) -> Result<(), SceneError> {
    let lasts: Vec<Option<(usize, usize)>> = meshes.iter().map(last_joint).collect();
    for node in drawn.iter().filter_map(|&node| nodes.get(node)) {
        let Some(mesh) = node.mesh else { continue };
        let weights = meshes.get(mesh).map_or(0, |mesh| mesh.weights.len()).max(node.weights.len());
        let count = node.skin.and_then(|skin| skins.get(skin)).map_or(0, |skin| skin.joints.len());
        // A matrix in double and one in single precision.
        let matrices = (count as u64).saturating_mul(160);
        remaining.take(matrices.saturating_add((weights as u64).saturating_mul(8)), "nodes")?;
        let (Some(skin), Some((part, last))) = (node.skin, lasts.get(mesh).copied().flatten()) else {
            continue;
        };
        if last >= count {
            return Err(SceneError::bad(
                format_args!("meshes[{mesh}].primitives[{part}].attributes.JOINTS_0"),
                format!("joint {last}"),
                format!("0 to {}, as skins[{skin}] has {count} joints", count.saturating_sub(1)),
            ));
        }
    }
    Ok(())
}

/// Largest joint index of a mesh, with the primitive that uses it.
fn last_joint(mesh: &Mesh) -> Option<(usize, usize)> {
    let skinned = mesh.primitives.iter().enumerate().filter(|(_, part)| part.is_skinned());
    let each =
        skinned.map(|(nth, part)| (nth, part.joints.iter().flatten().max().copied().map_or(0, usize::from)));
    each.max_by_key(|&(_, last)| last)
}
