//! The check before the parse: the whole document, on plain JSON values.
//!
//! The parser that makes typed objects trusts what it reads: it cuts 64-bit indices to 32 bits, indexes without
//! looking and multiplies counts by strides. So nothing reaches it before each number, index, range and link of
//! the document has been looked at here, in this order: numbers and shape, version and extensions, buffers,
//! views, accessors, links between objects, attributes, images and cameras, and the tree of nodes. What is wrong
//! is an error; what is odd but clear becomes a warning ([`oddities`]).

mod accessors;
mod attributes;
mod data;
mod extensions;
mod links;
mod nodes;
mod numbers;
mod oddities;
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

/// A document in which each index, range and link holds. Nothing else makes one.
pub(super) struct Checked {
    pub(super) value: Value,
}

/// What the checks have found so far and later ones build on.
struct Facts<'a> {
    document: Spot<'a>,
    buffers: Vec<u64>,
    views: Vec<ViewFacts>,
    accessors: Vec<AccessorFacts>,
}

impl Facts<'_> {
    /// How many objects the document has in a list at its top; 0 if it has no such list.
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
    oddities::look(&facts, warnings)?;
    Ok(Checked { value })
}
