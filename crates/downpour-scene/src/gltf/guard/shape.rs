//! Frame of a document: lists of objects at its top, a version, and cameras with the members that their type requires.

use super::spot::Spot;
use crate::error::SceneError;
use serde_json::Value;

/// The lists at the top of a document.
pub(super) const LISTS: [&str; 13] = [
    "accessors",
    "animations",
    "buffers",
    "bufferViews",
    "cameras",
    "images",
    "materials",
    "meshes",
    "nodes",
    "samplers",
    "scenes",
    "skins",
    "textures",
];

/// Adds members that the specification allows to omit and the typed reader requires.
pub(super) fn complete(value: &mut Value) -> Result<(), SceneError> {
    if let Some(scenes) = value.get_mut("scenes").and_then(Value::as_array_mut) {
        for scene in scenes.iter_mut().filter_map(Value::as_object_mut) {
            scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
        }
    }
    Ok(())
}

/// Lists hold objects, extensions are objects, and the version is one that we read.
pub(super) fn check(document: &Spot<'_>) -> Result<(), SceneError> {
    document.object()?;
    version(document)?;
    for list in LISTS {
        document.each(&[list, "[]"], &mut |item| {
            item.object()?;
            item.each(&["name"], &mut |name| name.text().map(drop))?;
            item.each(&["extensions", "*"], &mut |extension| extension.object().map(drop))
        })?;
    }
    document.each(&["extensions", "*"], &mut |extension| extension.object().map(drop))?;
    document.each(&["meshes", "[]"], &mut |mesh| {
        let primitives = mesh.need("primitives")?;
        primitives.items()?.try_for_each(|primitive| {
            primitive.need("attributes")?.object()?;
            primitive.each(&["extensions", "*"], &mut |extension| extension.object().map(drop))
        })
    })
}

fn version(document: &Spot<'_>) -> Result<(), SceneError> {
    let asset = document.need("asset")?;
    let version = asset.need("version")?;
    for (spot, least) in [(Some(version), false), (asset.get("minVersion")?, true)] {
        let Some(spot) = spot else { continue };
        let text = spot.text()?;
        // A later minor version may be read as 2.0, unless it declares that it requires more.
        let known = text.strip_prefix("2.").is_some_and(|minor| {
            !minor.is_empty() && minor.bytes().all(|b| b.is_ascii_digit()) && (!least || minor == "0")
        });
        if !known {
            let allowed = if least { "\"2.0\"" } else { "\"2.0\" or a later \"2.x\"" };
            return Err(spot.not(allowed).with_advice("convert the file to glTF 2.0"));
        }
    }
    Ok(())
}

/// Cameras: the object that the type names, with positive numbers.
pub(super) fn cameras(document: &Spot<'_>) -> Result<(), SceneError> {
    document.each(&["cameras", "[]"], &mut |camera| {
        let kind = camera.need("type")?;
        let numbers: &[&str] = match kind.text()? {
            "perspective" => &["yfov", "znear"],
            "orthographic" => &["xmag", "ymag", "zfar", "znear"],
            _ => return Err(kind.not("\"perspective\" or \"orthographic\"")),
        };
        let lens = camera.need(kind.text()?)?;
        for key in numbers {
            let member = lens.need(key)?;
            let number = member.number()?;
            // An orthographic camera may mirror (negative magnification) and have its near plane at 0.
            let fine = match *key {
                "xmag" | "ymag" => number != 0.0,
                "znear" if numbers.len() == 4 => number >= 0.0,
                _ => number > 0.0,
            };
            if !fine {
                return Err(member.not("a positive number"));
            }
        }
        let near = lens.need("znear")?.number()?;
        lens.each(&["zfar"], &mut |far| {
            if far.number()? > near {
                Ok(())
            } else {
                Err(far.not(format!("more than znear, which is {near}")))
            }
        })?;
        lens.each(&["aspectRatio"], &mut |aspect| {
            if aspect.number()? > 0.0 { Ok(()) } else { Err(aspect.not("a positive number")) }
        })
    })
}
