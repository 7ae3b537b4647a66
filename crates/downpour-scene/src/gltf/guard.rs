//! Check before the parse: the whole document, on plain JSON values.
//!
//! The parser that creates typed objects trusts its input: it cuts 64-bit indices to 32 bits, indexes without
//! bounds checks and multiplies counts by strides. So each number, index, range and link of the document is checked
//! first, in this order: numbers and shape, version and extensions, buffers, views, accessors, links between objects,
//! attributes, images and cameras, and the tree of nodes. A violation is an error; an irregularity with a clear
//! meaning is a warning ([`lints`]).

mod accessors;
mod attributes;
mod data;
mod extensions;
mod links;
mod lints;
mod nodes;
mod numbers;
mod shape;
mod spot;

use crate::Budget;
use crate::error::SceneError;
use crate::warning::Warnings;
use accessors::AccessorFacts;
use data::ViewFacts;
use serde_json::Value;

pub(super) use accessors::Size;
pub(super) use spot::{Spot, Trail};

/// A document in which each index, range and link is valid. Only the guard creates one.
pub(super) struct Checked {
    pub(super) value: Value,
}

/// Results of the checks so far, for later ones.
struct Facts<'a> {
    document: Spot<'a>,
    buffers: Vec<u64>,
    views: Vec<ViewFacts>,
    accessors: Vec<AccessorFacts>,
}

impl Facts<'_> {
    /// Number of objects in a list at the top of the document; 0 without the list.
    fn count(&self, list: &str) -> usize {
        self.document.value.get(list).and_then(Value::as_array).map_or(0, Vec::len)
    }
}

/// Checks a document. `binary` is the binary chunk of a GLB.
pub(super) fn check(
    mut value: Value,
    binary: Option<&[u8]>,
    budget: &mut Budget,
    warnings: &mut Warnings,
) -> Result<Checked, SceneError> {
    numbers::settle(&mut value)?;
    shape::complete(&mut value)?;
    let document = Spot::document(&value);
    shape::check(&document)?;
    extensions::check(&document)?;
    let mut facts = Facts { document, buffers: Vec::new(), views: Vec::new(), accessors: Vec::new() };
    budget.take_nodes(facts.count("nodes") as u64, "nodes")?;
    budget.take_textures(facts.count("textures").max(facts.count("images")) as u64, "images")?;
    facts.buffers = data::buffers(&document, binary, warnings)?;
    facts.views = data::views(&document, &facts.buffers)?;
    facts.accessors = accessors::check(&document, &facts.views)?;
    links::check(&facts)?;
    attributes::check(&facts)?;
    data::images(&document, warnings)?;
    shape::cameras(&document)?;
    nodes::check(&document)?;
    lints::check(&facts, warnings)?;
    Ok(Checked { value })
}
