//! Craters that are made away from the lattice they are for, on any thread.

use std::sync::Arc;

use super::model::Model;
use super::seed::{Impact, PuddleSeed, craters};
use crate::error::LatticeError;

/// Craters of some impacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Craters(pub(crate) Vec<PuddleSeed>);

impl Craters {
    /// True if there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Maker of the craters of a puddle.
#[derive(Clone, Debug)]
pub struct CraterMaker(Arc<Model>);

impl CraterMaker {
    pub(crate) fn new(model: &Model) -> Self {
        Self(Arc::new(model.clone()))
    }

    /// Craters of impacts.
    ///
    /// # Errors
    /// As [`Puddle::seed`](super::Puddle::seed).
    pub fn craters(&self, impacts: &[Impact]) -> Result<Craters, LatticeError> {
        craters(&self.0, impacts).map(Craters)
    }
}
