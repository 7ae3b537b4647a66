//! Lints: warnings about irregularities with a clear meaning, so that the author of a file can mend it.
//!
//! The document has passed the checks; a reader that ignores these warnings is still safe. The rules are those of the
//! glTF 2.0 specification that concern Downpour, in the wording of the Khronos validator.

use super::attributes::is_known;
use super::shape::LISTS;
use super::spot::Spot;
use super::{Facts, accessors::AccessorFacts};
use crate::error::{SceneError, quoted};
use crate::gltf::irregular;
use crate::warning::{WarningKind, Warnings};
use gltf::json::accessor::{ComponentType, Type};
use serde_json::Value;
use std::collections::BTreeSet;

/// Checks the whole document.
pub(super) fn check(facts: &Facts<'_>, warnings: &mut Warnings) -> Result<(), SceneError> {
    let document = &facts.document;
    for list in LISTS {
        document.each(&[list], &mut |list| empty(list, warnings))?;
    }
    extensions(document, warnings)?;
    let mut number = 0usize;
    document.each(&["accessors", "[]"], &mut |accessor| {
        let known = facts.accessors.get(number).copied();
        number = number.saturating_add(1);
        known.map_or(Ok(()), |known| self::accessor(accessor, known, facts, warnings))
    })?;
    document.each(&["images", "[]", "bufferView"], &mut |view| {
        strided(facts, view, view.value.as_u64(), "an image", warnings)
    })?;
    meshes(facts, warnings)?;
    document.each(&["nodes", "[]"], &mut |node| self::node(node, document.value, warnings))
}

fn empty(list: &Spot<'_>, warnings: &mut Warnings) -> Result<(), SceneError> {
    if list.items()?.next().is_none() {
        irregular(warnings, list.trail, || "an empty list".into());
    }
    Ok(())
}

fn extensions(document: &Spot<'_>, warnings: &mut Warnings) -> Result<(), SceneError> {
    let mut used = BTreeSet::new();
    for list in ["extensionsUsed", "extensionsRequired"] {
        let mut here = BTreeSet::new();
        document.each(&[list, "[]"], &mut |name| {
            let text = name.text()?;
            if !here.insert(text.to_owned()) {
                irregular(warnings, name.trail, || format!("{} for the second time", quoted(text)));
            }
            if list == "extensionsRequired" && !used.contains(text) {
                irregular(warnings, name.trail, || format!("{} is not in extensionsUsed", quoted(text)));
            }
            Ok(())
        })?;
        used.append(&mut here);
    }
    for owner in [&["extensions", "*"][..], &["meshes", "[]", "primitives", "[]", "extensions", "*"]] {
        let (_, path) = owner.split_last().unwrap_or((&"", &[]));
        document.each(path, &mut |extensions| {
            extensions.members()?.for_each(|(name, extension)| {
                if !used.contains(name) {
                    irregular(warnings, extension.trail, || "not in extensionsUsed".into());
                }
                if name.contains("draco") || name.contains("meshopt") {
                    warnings.add(WarningKind::Ignored, extension.trail, || {
                        "compressed data; the plain data beside it is read".into()
                    });
                }
            });
            Ok(())
        })?;
    }
    Ok(())
}

fn accessor(
    spot: &Spot<'_>,
    accessor: AccessorFacts,
    facts: &Facts<'_>,
    warnings: &mut Warnings,
) -> Result<(), SceneError> {
    if accessor.normalized && matches!(accessor.component, ComponentType::F32 | ComponentType::U32) {
        irregular(warnings, spot.trail, || "normalized has no meaning for this component type".into());
    }
    let Some(view) = accessor.view.and_then(|view| facts.views.get(view)) else {
        return spot.each(&["byteOffset"], &mut |offset| {
            irregular(warnings, offset.trail, || "byteOffset without bufferView".into());
            Ok(())
        });
    };
    let size = accessor.component.size() as u64;
    let matrix = matches!(accessor.kind, Type::Mat2 | Type::Mat3 | Type::Mat4);
    let unit = if matrix { size.max(4) } else { size };
    let start = view.offset.saturating_add(accessor.offset);
    let stride = view.stride.unwrap_or(unit);
    if [accessor.offset, start, stride].iter().any(|offset| !offset.is_multiple_of(unit)) {
        irregular(warnings, spot.trail, || format!("begins at byte {start}, not aligned to {unit} bytes"));
    }
    Ok(())
}

/// Warns of a view with a stride whose data must have none.
fn strided(
    facts: &Facts<'_>,
    spot: &Spot<'_>,
    view: Option<u64>,
    what: &str,
    warnings: &mut Warnings,
) -> Result<(), SceneError> {
    let view = view.and_then(|view| facts.views.get(usize::try_from(view).ok()?));
    if view.is_some_and(|view| view.stride.is_some()) {
        irregular(warnings, spot.trail, || format!("{what} in a view with byteStride"));
    }
    Ok(())
}

fn linked(facts: &Facts<'_>, link: &Spot<'_>) -> Option<AccessorFacts> {
    facts.accessors.get(usize::try_from(link.value.as_u64()?).ok()?).copied()
}

fn meshes(facts: &Facts<'_>, warnings: &mut Warnings) -> Result<(), SceneError> {
    // Accessor that uses a view without stride as vertex data.
    let mut tenants: Vec<Option<u64>> = vec![None; facts.views.len()];
    facts.document.each(&["meshes", "[]"], &mut |mesh| {
        let primitives = mesh.need("primitives")?;
        empty(&primitives, warnings)?;
        let mut targets = None;
        for primitive in primitives.items()? {
            primitive.each(&["indices"], &mut |indices| {
                let view = linked(facts, indices).and_then(|accessor| accessor.view);
                strided(facts, indices, view.map(|view| view as u64), "indices", warnings)
            })?;
            let attributes = primitive.need("attributes")?;
            let names = attributes.object()?;
            for (name, link) in attributes.members()? {
                attribute(facts, name, &link, &mut tenants, warnings);
            }
            let numbered = |prefix| names.keys().filter(|name| name.starts_with(prefix)).count();
            if numbered("JOINTS_") != numbered("WEIGHTS_") {
                irregular(warnings, attributes.trail, || "not as many JOINTS as WEIGHTS".into());
            }
            primitive.each(&["targets", "[]"], &mut |target| {
                for (name, link) in target.members()? {
                    if !is_known(name, true) || !names.contains_key(name) {
                        irregular(warnings, link.trail, || "a morph target of no attribute: ignored".into());
                    }
                }
                Ok(())
            })?;
            let here = length(primitive.value.get("targets"));
            if *targets.get_or_insert(here) != here {
                irregular(warnings, primitive.trail, || {
                    format!("{here} morph targets, but other primitives of the mesh have another number")
                });
            }
        }
        mesh.each(&["weights"], &mut |weights| {
            weights_fit(weights, targets.unwrap_or(0), warnings);
            Ok(())
        })
    })
}

fn attribute(
    facts: &Facts<'_>,
    name: &str,
    link: &Spot<'_>,
    tenants: &mut [Option<u64>],
    warnings: &mut Warnings,
) {
    if !is_known(name, false) {
        irregular(warnings, link.trail, || "not an attribute of glTF 2.0: ignored".into());
    }
    let Some(accessor) = linked(facts, link) else { return };
    if accessor.component == ComponentType::U32 {
        irregular(warnings, link.trail, || "32-bit integers as vertex data".into());
    }
    let Some((tenant, view)) =
        accessor.view.and_then(|view| Some((tenants.get_mut(view)?, facts.views.get(view)?)))
    else {
        return;
    };
    let mine = link.value.as_u64();
    if view.stride.is_none() && tenant.is_some() && *tenant != mine {
        irregular(warnings, link.trail, || "uses the same view as another, without byteStride".into());
    }
    *tenant = mine;
    let stride = view.stride.unwrap_or_else(|| super::Size::of(accessor.kind, accessor.component).whole);
    if ![accessor.offset, stride].iter().all(|offset| offset.is_multiple_of(4)) {
        irregular(warnings, link.trail, || "vertex data not aligned to 4 bytes".into());
    }
}

fn length(list: Option<&Value>) -> usize {
    list.and_then(Value::as_array).map_or(0, Vec::len)
}

fn weights_fit(weights: &Spot<'_>, targets: usize, warnings: &mut Warnings) {
    let count = length(Some(weights.value));
    if count != targets {
        irregular(warnings, weights.trail, || format!("{count} weights for {targets} morph targets"));
    }
}

fn node(node: &Spot<'_>, document: &Value, warnings: &mut Warnings) -> Result<(), SceneError> {
    node.each(&["children"], &mut |children| empty(children, warnings))?;
    let has = |key: &str| node.value.get(key).is_some();
    if has("matrix") && ["translation", "rotation", "scale"].into_iter().any(has) {
        irregular(warnings, node.trail, || {
            "both matrix and translation, rotation or scale: matrix is taken".into()
        });
    }
    node.each(&["matrix"], &mut |matrix| {
        let row = [3, 7, 11, 15].map(|at| matrix.value.get(at).and_then(Value::as_f64));
        if row != [Some(0.0), Some(0.0), Some(0.0), Some(1.0)] {
            irregular(warnings, matrix.trail, || "a last row other than 0 0 0 1: ignored".into());
        }
        Ok(())
    })?;
    node.each(&["rotation"], &mut |rotation| {
        let square: f64 =
            rotation.items()?.filter_map(|part| part.value.as_f64()).map(|part| part * part).sum();
        if (square - 1.0).abs() > 1e-3 {
            irregular(warnings, rotation.trail, || format!("length {:.4}, not 1", square.sqrt()));
        }
        Ok(())
    })?;
    let mesh = node.value.get("mesh").and_then(Value::as_u64).and_then(|mesh| usize::try_from(mesh).ok());
    let Some(mesh) = mesh else {
        for key in ["skin", "weights"] {
            node.each(&[key], &mut |member| {
                irregular(warnings, member.trail, || format!("{key} without mesh"));
                Ok(())
            })?;
        }
        return Ok(());
    };
    let first = document.get("meshes").and_then(|meshes| meshes.get(mesh)?.get("primitives")?.get(0));
    node.each(&["weights"], &mut |weights| {
        weights_fit(weights, length(first.and_then(|primitive| primitive.get("targets"))), warnings);
        Ok(())
    })?;
    let skinned = first.is_some_and(|primitive| primitive.pointer("/attributes/JOINTS_0").is_some());
    if skinned != has("skin") {
        let what =
            if skinned { "a skinned mesh without skin" } else { "a skin on a mesh that has no joints" };
        irregular(warnings, node.trail, || what.into());
    }
    Ok(())
}
