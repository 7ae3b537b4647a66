//! Whole scenes: all supported objects of a document, each once.

mod animations;
mod cameras;
mod extensions;
mod fields;
mod flat;
mod lights;
mod materials;
mod meshes;
mod nodes;
mod primitives;
mod tangents;
mod textures;
mod vertices;
mod weights;

use super::growth::GrowthBudget;
use super::guard::{Checked, Spot};
use super::{buffers, document};
use crate::Budget;
use crate::error::SceneError;
use crate::sandbox::Files;
use crate::scene::Scene;
use crate::warning::{WarningKind, Warnings};
use primitives::Reading;
use std::collections::BTreeSet;
use textures::{Images, Textures};

/// Reads a checked document. `source` is the length of the file, in bytes.
pub(super) fn read(
    mut checked: Checked,
    binary: Option<&[u8]>,
    source: u64,
    files: &dyn Files,
    budget: &mut Budget,
    mut warnings: Warnings,
) -> Result<Scene, SceneError> {
    let warnings = &mut warnings;
    let whole = Spot::document(&checked.value);
    extensions::check(&whole, warnings)?;
    let lights_at = lights::of_nodes(&whole)?;
    let root = document::typed(&mut checked)?;
    let rest = Spot::document(&checked.value);

    let mut textures = Textures::read(&rest)?;
    let mut scene = Scene {
        materials: materials::read(&rest, &mut textures, warnings)?,
        lights: lights::read(&rest, warnings)?,
        cameras: cameras::read(&rest)?,
        ..Scene::default()
    };
    let buffers = buffers::load(&root, binary, files, budget)?;
    let reading = Reading { root: &root, buffers: &buffers };
    let mut remaining = GrowthBudget::new(budget, source.saturating_add(buffers.from_files));
    (scene.nodes, scene.roots) = nodes::read(&root, &lights_at, &mut remaining)?;
    scene.skins = nodes::skins(&rest, &root, &buffers, &mut remaining, warnings)?;
    let drawn = scene.drawn();
    let materials = &mut scene.materials;
    scene.meshes = meshes::read(&reading, &scene.nodes, &drawn, materials, &mut remaining, warnings)?;
    meshes::check_joints(&scene.nodes, &drawn, &scene.meshes, &scene.skins, &mut remaining)?;
    scene.animations = animations::read(&rest, &reading, &scene.nodes, &mut remaining, warnings)?;
    let images = Images { document: rest, root: &root, buffers: &buffers, files };
    scene.textures = textures.load(&images, budget, warnings)?;
    at_rest(&scene, &drawn, warnings);
    scene.warnings = std::mem::take(warnings).finish();
    Ok(scene)
}

/// Warns of meshes that are invisible at rest.
fn at_rest(scene: &Scene, drawn: &[usize], warnings: &mut Warnings) {
    let pose = scene.pose(None, 0.0);
    let shown: BTreeSet<usize> = pose.instances.iter().map(|instance| instance.node).collect();
    // An animated scale may be 0 for a while.
    let kind = if scene.animations.is_empty() { WarningKind::Dropped } else { WarningKind::Irregular };
    for &node in drawn.iter().filter(|node| !shown.contains(node)) {
        if scene.nodes.get(node).is_some_and(|node| node.mesh.is_some()) {
            warnings.add(kind, format_args!("nodes[{node}]"), || {
                "dropped: its transform has no inverse (a scale or rotation of 0), or leads too far away"
                    .into()
            });
        }
    }
    let empty = scene.meshes.iter().all(|mesh| mesh.primitives.is_empty());
    if empty && scene.lights.is_empty() && scene.cameras.is_empty() {
        warnings.add(WarningKind::Empty, "", || "no triangles, lights or cameras".into());
    }
}
