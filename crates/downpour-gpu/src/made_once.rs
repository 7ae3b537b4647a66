//! Pipelines and the like that are made when they are first asked for.

use std::sync::OnceLock;

/// A value that is made when it is first asked for; after an error it is tried again.
///
/// # Errors
/// Those of `make`.
pub fn made_once<T, E>(kept: &OnceLock<T>, make: impl FnOnce() -> Result<T, E>) -> Result<&T, E> {
    if let Some(known) = kept.get() {
        return Ok(known);
    }
    let made = make()?;
    Ok(kept.get_or_init(|| made))
}
