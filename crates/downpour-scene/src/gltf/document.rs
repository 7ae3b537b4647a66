//! From checked values to the typed objects of the `gltf` crate.
//!
//! Only objects that geometry needs are converted; the others stay plain values. Each object is converted separately, so
//! that an error names it.

use super::guard::{Checked, Trail};
use crate::error::{SceneError, escaped};
use gltf::json::{Index, Root};
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Makes the typed objects. They are taken out of the document.
pub(super) fn typed(checked: &mut Checked) -> Result<Root, SceneError> {
    let value = &mut checked.value;
    Ok(Root {
        accessors: list(value, "accessors")?,
        buffers: list(value, "buffers")?,
        buffer_views: list(value, "bufferViews")?,
        meshes: list(value, "meshes")?,
        nodes: list(value, "nodes")?,
        scenes: list(value, "scenes")?,
        scene: value.get("scene").and_then(Value::as_u64).and_then(|i| u32::try_from(i).ok()).map(Index::new),
        ..Root::default()
    })
}

fn list<T: DeserializeOwned>(value: &mut Value, key: &'static str) -> Result<Vec<T>, SceneError> {
    let Some(Value::Array(items)) = value.get_mut(key).map(Value::take) else { return Ok(Vec::new()) };
    let make = |(index, item)| {
        serde_json::from_value(item).map_err(|error| {
            let trail = Trail::DOCUMENT.key(key);
            SceneError::bad(
                trail.index(index),
                escaped(&error.to_string()),
                "what glTF 2.0 says of this object",
            )
        })
    };
    items.into_iter().enumerate().map(make).collect()
}
