//! Budget of memory, time and nodes for a file from outside.
//!
//! A few bytes can ask for a great deal: an accessor without data, a mesh drawn ten thousand times. One
//! [`Budget`] goes through every reader of a scene; each deducts its needs before it allocates, and the
//! remainder is available to the next.

use crate::error::{SceneError, size};
use std::fmt;

const RAISE: &str = "raise the budget, or split or simplify the model";

/// Remaining budget. A reader lowers it by the size of the data that it returns.
///
/// ```
/// use downpour_scene::Budget;
/// let small = Budget { bytes: 64 << 20, ..Budget::default() };
/// assert!(small.vertices > 1_000_000);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Memory, in bytes; default 2 GiB.
    pub bytes: u64,
    /// Pixels of all images together; default 2^28.
    pub pixels: u64,
    /// Vertices of all meshes together, each instance counted; default 50 million.
    pub vertices: u64,
    /// Nodes of all scenes together; default 1 million.
    pub nodes: u64,
    /// Textures and images, the larger number of both; default 4096.
    pub textures: u64,
}

impl Default for Budget {
    fn default() -> Self {
        Self { bytes: 2 << 30, pixels: 1 << 28, vertices: 50_000_000, nodes: 1_000_000, textures: 4096 }
    }
}

impl Budget {
    /// Deducts memory, in bytes; `item` names its use in the message.
    ///
    /// # Errors
    /// [`SceneError::OverLimit`] if less is left.
    pub fn take_bytes(&mut self, wanted: u64, item: impl fmt::Display) -> Result<(), SceneError> {
        take(&mut self.bytes, wanted).map_err(|left| {
            SceneError::limit(
                item,
                format!("{} needed", size(wanted)),
                format!("{} left in the budget", size(left)),
            )
            .with_advice(RAISE)
        })
    }

    /// Takes vertices.
    pub(crate) fn take_vertices(&mut self, wanted: u64, item: impl fmt::Display) -> Result<(), SceneError> {
        take(&mut self.vertices, wanted).map_err(|left| over(item, wanted, left, "vertices"))
    }

    /// Deducts nodes; `item` names their use in the message.
    ///
    /// # Errors
    /// [`SceneError::OverLimit`] if fewer are left.
    pub fn take_nodes(&mut self, wanted: u64, item: impl fmt::Display) -> Result<(), SceneError> {
        take(&mut self.nodes, wanted).map_err(|left| over(item, wanted, left, "nodes"))
    }

    /// Takes textures.
    pub(crate) fn take_textures(&mut self, wanted: u64, item: impl fmt::Display) -> Result<(), SceneError> {
        take(&mut self.textures, wanted).map_err(|left| over(item, wanted, left, "textures"))
    }

    /// Returns an empty vector with capacity for `count` elements, or the limit error of a machine that is out of memory.
    pub(crate) fn vec_with_capacity<T>(count: usize, item: impl fmt::Display) -> Result<Vec<T>, SceneError> {
        let mut room = Vec::new();
        match room.try_reserve_exact(count) {
            Ok(()) => Ok(room),
            Err(_) => {
                let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
                Err(SceneError::limit(item, format!("{} needed", size(bytes)), "the memory of the machine")
                    .with_advice(RAISE))
            }
        }
    }
}

/// Deducts from the remainder, or returns it if it is too small.
fn take(left: &mut u64, wanted: u64) -> Result<(), u64> {
    *left = left.checked_sub(wanted).ok_or(*left)?;
    Ok(())
}

fn over(item: impl fmt::Display, wanted: u64, left: u64, what: &str) -> SceneError {
    SceneError::limit(item, format!("{wanted} {what}"), format!("{left} {what} left in the budget"))
        .with_advice(RAISE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_refused_is_not_taken() {
        let mut budget = Budget { bytes: 100, ..Budget::default() };
        budget.take_bytes(60, "a").unwrap();
        let error = budget.take_bytes(41, "b").unwrap_err();
        assert!(matches!(error, SceneError::OverLimit(_)));
        assert_eq!(error.fault().found, "41 bytes needed");
        assert_eq!(error.fault().allowed, "40 bytes left in the budget");
        budget.take_bytes(40, "c").unwrap();
        assert_eq!(budget.bytes, 0);
        assert!(Budget::vec_with_capacity::<[u8; 1 << 20]>(usize::MAX, "d").is_err());
    }
}
