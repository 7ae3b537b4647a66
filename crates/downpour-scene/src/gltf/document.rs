//! From checked values to the typed objects of the `gltf` crate.
//!
//! Only what geometry needs is made. Each object is made by itself, so that one that does not fit is named.

use super::guard::{Checked, Trail};
use crate::error::{SceneError, escaped};
use gltf::json::{Index, Root};
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Makes the typed objects.
pub(super) fn typed(checked: Checked) -> Result<Root, SceneError> {
    let mut value = checked.value;
    Ok(Root {
        accessors: list(&mut value, "accessors")?,
        buffers: list(&mut value, "buffers")?,
        buffer_views: list(&mut value, "bufferViews")?,
        meshes: list(&mut value, "meshes")?,
        nodes: list(&mut value, "nodes")?,
        scenes: list(&mut value, "scenes")?,
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
