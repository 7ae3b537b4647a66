//! Reasons why there is no puddle.

use downpour_drop::DropError;
use downpour_lattice::LatticeError;

/// Error of puddles.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PuddleError {
    /// The lattice of the ripples.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The rain on it.
    #[error(transparent)]
    Rain(#[from] DropError),
}
