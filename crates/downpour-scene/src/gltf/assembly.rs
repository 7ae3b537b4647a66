//! From lists, strips and fans of corners to triangles (glTF 2.0, section 3.7.2.1).

use super::accessor::Elements;
use crate::error::SceneError;
use gltf::json::mesh::Mode;
use std::fmt;

/// Hands out each triangle of a primitive as three vertices below `vertices`.
///
/// Without `indices` the vertices follow each other.
pub(super) fn triangles(
    mut indices: Option<Elements<'_>>,
    mode: Mode,
    vertices: usize,
    path: impl fmt::Display,
    mut emit: impl FnMut([u32; 3]),
) -> Result<(), SceneError> {
    let corners = indices.as_ref().map_or(vertices, Elements::count);
    let (mut first, mut before, mut last) = (0u32, 0u32, 0u32);
    for nth in 0..corners {
        let index = match &mut indices {
            Some(elements) => elements.unsigned()?.unwrap_or(usize::MAX),
            None => nth,
        };
        let Some(corner) = u32::try_from(index).ok().filter(|_| index < vertices) else {
            let allowed = format!("0 to {}, as POSITION has {vertices}", vertices.saturating_sub(1));
            let path = format_args!("{path}.indices");
            return Err(SceneError::bad(path, format!("index {index} at element {nth}"), allowed));
        };
        if nth == 0 {
            first = corner;
        }
        let triangle = match mode {
            Mode::Triangles => (nth % 3 == 2).then_some([before, last, corner]),
            Mode::TriangleStrip if nth % 2 == 0 => Some([before, last, corner]),
            Mode::TriangleStrip => Some([before, corner, last]),
            _ => Some([last, corner, first]),
        };
        if let Some(triangle) = triangle.filter(|_| nth >= 2) {
            emit(triangle);
        }
        (before, last) = (last, corner);
    }
    Ok(())
}
