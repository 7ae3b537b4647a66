//! Names of materials in a weather file, checked against those of its models.

use super::fault::Positions;
use super::words::{nearest, nearest_first};
use downpour_scene::error::{SceneError, quoted};
use downpour_scene::scene::Scene;
use std::collections::BTreeSet;

/// Maximum length of the name of a material, in bytes.
const MAX_NAME: usize = 256;

/// Maximum number of names that an error lists.
const MAX_LISTED: usize = 12;

/// Checks the length of a name; `key` is the path of its key.
///
/// # Errors
/// The name is empty, or longer than 256 bytes.
pub(super) fn check_length(name: &str, key: &str, positions: &Positions<'_>) -> Result<(), SceneError> {
    if (1..=MAX_NAME).contains(&name.len()) {
        return Ok(());
    }
    let allowed = format!("a name of 1 to {MAX_NAME} bytes");
    Err(positions.bad(key, format!("{} bytes", name.len()), allowed))
}

/// Names of the materials of all models of a scene, each once.
pub(super) struct MaterialNames<'a>(BTreeSet<&'a str>);

impl<'a> MaterialNames<'a> {
    /// The names in a scene. Those that no weather file can hold are left out.
    pub(super) fn of(scene: &'a Scene) -> Self {
        let names = scene.materials.iter().map(|material| material.name.as_str());
        Self(names.filter(|name| (1..=MAX_NAME).contains(&name.len())).collect())
    }

    /// Checks that a model has a material of this name; `key` is the path of the key that names it.
    ///
    /// # Errors
    /// No model has one: with the names that are nearest to it.
    pub(super) fn check(&self, name: &str, key: &str) -> Result<(), SceneError> {
        if self.0.contains(name) {
            return Ok(());
        }
        let mut known: Vec<&str> = self.0.iter().copied().collect();
        let hint =
            nearest(name, &known).map_or_else(String::new, |near| format!(", perhaps {}", quoted(near)));
        let found = format!("{}, which no model has{hint}", quoted(name));
        nearest_first(name, &mut known);
        let others = known.len().saturating_sub(MAX_LISTED);
        let listed: Vec<String> = known.into_iter().take(MAX_LISTED).map(quoted).collect();
        let allowed = match (listed.is_empty(), others) {
            (true, _) => "a model with named materials".to_owned(),
            (false, 0) => listed.join(", "),
            (false, _) => format!("{}, and {others} more", listed.join(", ")),
        };
        Err(SceneError::bad(key, found, allowed))
    }
}
