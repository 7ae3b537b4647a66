//! Links between objects: each index leads to an object that is there.
//!
//! One table lists the members that hold indices and the lists that they point into. A few are special: textures of
//! material extensions, samplers of an animation, lights of an extension.

use super::Facts;
use super::spot::Spot;
use crate::error::SceneError;

/// Path of an index, and the list that it points into.
const LINKS: [(&[&str], &str); 24] = [
    (&["scene"], "scenes"),
    (&["scenes", "[]", "nodes", "[]"], "nodes"),
    (&["nodes", "[]", "children", "[]"], "nodes"),
    (&["nodes", "[]", "mesh"], "meshes"),
    (&["nodes", "[]", "camera"], "cameras"),
    (&["nodes", "[]", "skin"], "skins"),
    (&["meshes", "[]", "primitives", "[]", "attributes", "*"], "accessors"),
    (&["meshes", "[]", "primitives", "[]", "indices"], "accessors"),
    (&["meshes", "[]", "primitives", "[]", "material"], "materials"),
    (&["meshes", "[]", "primitives", "[]", "targets", "[]", "*"], "accessors"),
    (&["images", "[]", "bufferView"], "bufferViews"),
    (&["textures", "[]", "source"], "images"),
    (&["textures", "[]", "sampler"], "samplers"),
    (&["textures", "[]", "extensions", "KHR_texture_basisu", "source"], "images"),
    (&["textures", "[]", "extensions", "EXT_texture_webp", "source"], "images"),
    (&["materials", "[]", "normalTexture", "index"], "textures"),
    (&["materials", "[]", "occlusionTexture", "index"], "textures"),
    (&["materials", "[]", "emissiveTexture", "index"], "textures"),
    (&["materials", "[]", "pbrMetallicRoughness", "baseColorTexture", "index"], "textures"),
    (&["materials", "[]", "pbrMetallicRoughness", "metallicRoughnessTexture", "index"], "textures"),
    (&["skins", "[]", "inverseBindMatrices"], "accessors"),
    (&["skins", "[]", "skeleton"], "nodes"),
    (&["skins", "[]", "joints", "[]"], "nodes"),
    (&["animations", "[]", "channels", "[]", "target", "node"], "nodes"),
];

/// Checks every index of the document except those that later checks cover.
pub(super) fn check(facts: &Facts<'_>) -> Result<(), SceneError> {
    let document = &facts.document;
    for (pattern, list) in LINKS {
        let count = facts.count(list);
        document.each(pattern, &mut |link| link.index_into(list, count).map(drop))?;
    }
    let textures = facts.count("textures");
    document.each(&["materials", "[]", "extensions", "*"], &mut |extension| {
        let is_texture =
            |(key, texture): &(&str, Spot<'_>)| key.ends_with("Texture") && texture.value.is_object();
        extension.members()?.filter(is_texture).try_for_each(|(_, texture)| {
            texture.each(&["index"], &mut |index| index.index_into("textures", textures).map(drop))
        })
    })?;
    animations(facts)?;
    lights(document)
}

fn animations(facts: &Facts<'_>) -> Result<(), SceneError> {
    let accessors = facts.count("accessors");
    facts.document.each(&["animations", "[]"], &mut |animation| {
        let samplers = animation.need("samplers")?;
        let count = samplers.items()?.try_fold(0usize, |count, sampler| {
            for key in ["input", "output"] {
                sampler.need(key)?.index_into("accessors", accessors)?;
            }
            Ok::<_, SceneError>(count.saturating_add(1))
        })?;
        animation.need("channels")?.items()?.try_for_each(|channel| {
            channel.need("sampler")?.index_into("samplers of this animation", count)?;
            channel.need("target")?.object().map(drop)
        })
    })
}

fn lights(document: &Spot<'_>) -> Result<(), SceneError> {
    let mut count = 0usize;
    document.each(&["extensions", "KHR_lights_punctual", "lights", "[]"], &mut |light| {
        count = count.saturating_add(1);
        light.object().map(drop)
    })?;
    document.each(&["nodes", "[]", "extensions", "KHR_lights_punctual"], &mut |light| {
        light.need("light")?.index_into("lights", count).map(drop)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    /// The value at the end of a pattern, with one element or member for each wildcard of the pattern.
    fn grown(pattern: &[&str], end: Value) -> Value {
        pattern.iter().rev().fold(end, |inner, &step| match step {
            "[]" => json!([inner]),
            "*" => json!({"POSITION": inner}),
            key => json!({key: inner}),
        })
    }

    fn checked(document: &Value) -> Result<(), SceneError> {
        let document = Spot::document(document);
        check(&Facts { document, buffers: Vec::new(), views: Vec::new(), accessors: Vec::new() })
    }

    #[test]
    fn every_link_of_the_table_is_followed() {
        for (pattern, list) in LINKS {
            let mut document = grown(pattern, json!(7));
            // Other required members of an animation.
            if let Some(animation) = document.pointer_mut("/animations/0") {
                animation["samplers"] = json!([{"input": 0, "output": 0}]);
                animation["channels"][0]["sampler"] = json!(0);
                document["accessors"] = json!([{}]);
            }
            let error = checked(&document).expect_err(list);
            assert_eq!(error.fault().found, "7", "{pattern:?}: {error}");
            let own = document.get(list).and_then(Value::as_array).map_or(0, Vec::len);
            if own == 0 {
                document[list] = vec![json!({}); 8].into();
                checked(&document).unwrap_or_else(|error| panic!("{pattern:?}: {error}"));
            }
        }
    }

    #[test]
    fn links_of_their_own_kind() {
        let texture = json!({"materials": [{"extensions": {"KHR_materials_sheen": {"sheenColorTexture": {"index": 1}}}}]});
        assert!(checked(&texture).is_err());
        let vendor = json!({"materials": [{"extensions": {"ACME_paint": {"paintTexture": "by name"}}}]});
        assert!(checked(&vendor).is_ok());
        let sampler = json!({"animations": [{"samplers": [], "channels": [{"sampler": 0, "target": {}}]}]});
        assert_eq!(checked(&sampler).unwrap_err().fault().location, "animations[0].channels[0].sampler");
    }
}
