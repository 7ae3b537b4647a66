//! `[[material]]`: what a weather file says of the materials of its models.

use super::fault::Positions;
use super::load::narrowed;
use super::material_names::{MaterialNames, check_length};
use super::quantity::{Fraction, In};
use downpour_scene::error::{SceneError, quoted};
use downpour_scene::scene::Scene;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Values that replace those of the materials of a name, in all models.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialOverride {
    /// Name of the materials in the models.
    pub name: String,
    /// Fraction of the surface that soaks up rain and darkens, 0 to 1, in place of `porosity` in the `extras` of the models.
    pub porosity: f64,
}

impl MaterialOverride {
    fn checked(index: usize, table: &MaterialTable, positions: &Positions<'_>) -> Result<Self, SceneError> {
        check_length(&table.name, &name_key(index), positions)?;
        Ok(Self { name: table.name.clone(), porosity: table.porosity.0 })
    }
}

/// All overrides of a file.
///
/// # Errors
/// A name that no material can have, or that an earlier entry has.
pub(super) fn checked(
    tables: &[MaterialTable],
    positions: &Positions<'_>,
) -> Result<Vec<MaterialOverride>, SceneError> {
    let mut first = BTreeMap::new();
    let mut overrides = Vec::new();
    for (index, table) in tables.iter().enumerate() {
        overrides.push(MaterialOverride::checked(index, table, positions)?);
        if let Some(earlier) = first.insert(table.name.as_str(), index) {
            let found = format!("{} again, as in {}", quoted(&table.name), name_key(earlier));
            return Err(positions.bad(&name_key(index), found, "each name once"));
        }
    }
    Ok(overrides)
}

/// Replaces what the overrides give in the materials of a scene.
///
/// # Errors
/// A name that no material of the scene has.
pub(super) fn apply(overrides: &[MaterialOverride], scene: &mut Scene) -> Result<(), SceneError> {
    if overrides.is_empty() {
        return Ok(());
    }
    let names = MaterialNames::of(scene);
    for (index, one) in overrides.iter().enumerate() {
        names.check(&one.name, &name_key(index))?;
    }
    let by_name: BTreeMap<&str, &MaterialOverride> =
        overrides.iter().map(|one| (one.name.as_str(), one)).collect();
    for material in &mut scene.materials {
        if let Some(one) = by_name.get(material.name.as_str()) {
            material.porosity = Some(narrowed(one.porosity));
        }
    }
    Ok(())
}

/// Path of the name of an entry.
fn name_key(index: usize) -> String {
    format!("material[{index}].name")
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    name: String,
    porosity: In<Fraction>,
}
