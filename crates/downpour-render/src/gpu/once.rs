//! Pipelines that are made when they are first asked for.

use std::sync::OnceLock;

use downpour_gpu::GpuError;

/// What is made when it is first asked for.
pub(super) fn once<T>(
    cell: &OnceLock<T>,
    make: impl FnOnce() -> Result<T, GpuError>,
) -> Result<&T, GpuError> {
    if let Some(known) = cell.get() {
        return Ok(known);
    }
    let made = make()?;
    Ok(cell.get_or_init(|| made))
}
