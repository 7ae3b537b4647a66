//! Accessors: known formats, and no element outside its view.
//!
//! An element has component size times components bytes; a matrix starts each column on a multiple of 4 bytes
//! (glTF 2.0, section 3.6.2.4). The last element ends at `byteOffset + stride (count - 1) + size`, less the
//! padding of its last column, which is computed without wrapping.

use super::data::ViewFacts;
use super::spot::Spot;
use crate::error::SceneError;
use crate::gltf::MAX_ELEMENTS;
use gltf::json::accessor::{ComponentType, Type};

/// A checked accessor.
#[derive(Clone, Copy)]
pub(super) struct AccessorFacts {
    pub(super) kind: Type,
    pub(super) component: ComponentType,
    pub(super) normalized: bool,
    pub(super) count: u64,
    pub(super) view: Option<usize>,
    pub(super) offset: u64,
}

/// Checks all accessors.
pub(super) fn check(document: &Spot<'_>, views: &[ViewFacts]) -> Result<Vec<AccessorFacts>, SceneError> {
    let mut all = Vec::new();
    document.each(&["accessors", "[]"], &mut |accessor| {
        all.push(one(accessor, views)?);
        Ok(())
    })?;
    Ok(all)
}

fn one(accessor: &Spot<'_>, views: &[ViewFacts]) -> Result<AccessorFacts, SceneError> {
    let component = component(&accessor.need("componentType")?)?;
    let kind = kind(&accessor.need("type")?)?;
    let normalized = match accessor.get("normalized")? {
        None => false,
        Some(flag) => flag.value.as_bool().ok_or_else(|| flag.not("true or false"))?,
    };
    let count_spot = accessor.need("count")?;
    let count = count_spot.positive()?;
    let offset = accessor.whole_or_zero("byteOffset")?;
    let size = Size::of(kind, component);
    let view = match accessor.get("bufferView")? {
        None => None,
        Some(view) => {
            let index = view.index_into("bufferViews", views.len())?;
            within(&count_spot, index, views, offset, count, size)?;
            Some(index)
        }
    };
    // After the range: a count beyond its view is a mistake, one without data a cost.
    if count > MAX_ELEMENTS {
        return Err(SceneError::limit(
            count_spot.trail,
            format!("{count} elements, over the vertex limit"),
            format!("at most {MAX_ELEMENTS}"),
        ));
    }
    if let Some(sparse) = accessor.get("sparse")? {
        self::sparse(&sparse, views, count, size)?;
    }
    for key in ["min", "max"] {
        accessor.each(&[key, "[]"], &mut |bound| bound.number().map(drop))?;
    }
    Ok(AccessorFacts { kind, component, normalized, count, view, offset })
}

fn sparse(sparse: &Spot<'_>, views: &[ViewFacts], most: u64, size: Size) -> Result<(), SceneError> {
    let count_spot = sparse.need("count")?;
    let count = count_spot.positive()?;
    if count > most {
        return Err(count_spot.not(format!("1 to {most}, the accessor's count")));
    }
    let indices = sparse.need("indices")?;
    let kind = indices.need("componentType")?;
    let index_size = match component(&kind)? {
        index @ (ComponentType::U8 | ComponentType::U16 | ComponentType::U32) => {
            Size::of(Type::Scalar, index)
        }
        _ => return Err(kind.not("5121, 5123 or 5125 (unsigned integers)")),
    };
    for (part, size) in [(indices, index_size), (sparse.need("values")?, size)] {
        let view_spot = part.need("bufferView")?;
        let view = view_spot.index_into("bufferViews", views.len())?;
        if views.get(view).is_some_and(|view| view.stride.is_some()) {
            return Err(view_spot.wrong("a view with byteStride", "packed sparse data"));
        }
        within(&count_spot, view, views, part.whole_or_zero("byteOffset")?, count, size)?;
    }
    Ok(())
}

/// Checks that the elements lie inside the view.
fn within(
    count_spot: &Spot<'_>,
    index: usize,
    views: &[ViewFacts],
    offset: u64,
    count: u64,
    size: Size,
) -> Result<(), SceneError> {
    let view = views.get(index).copied().unwrap_or(ViewFacts { offset: 0, length: 0, stride: None });
    let Size { whole, last } = size;
    let stride = view.stride.unwrap_or(whole);
    if stride < whole {
        return Err(count_spot.wrong(
            format!("elements of {whole} bytes, but bufferViews[{index}] has byteStride {stride}"),
            format!("byteStride from {whole} on"),
        ));
    }
    let end = || count.checked_sub(1)?.checked_mul(stride)?.checked_add(last)?.checked_add(offset);
    if end().is_some_and(|end| end <= view.length) {
        return Ok(());
    }
    let room = view.length.saturating_sub(offset);
    let most = match room.checked_sub(last) {
        Some(rest) if offset <= view.length => rest.checked_div(stride).unwrap_or(0).saturating_add(1),
        _ => 0,
    };
    Err(count_spot.wrong(
        format!("{count} elements of {whole} bytes from byteOffset {offset} on, stride {stride}"),
        format!("at most {most}, as bufferViews[{index}] has {} bytes", view.length),
    ))
}

fn component(spot: &Spot<'_>) -> Result<ComponentType, SceneError> {
    Ok(match spot.whole()? {
        5120 => ComponentType::I8,
        5121 => ComponentType::U8,
        5122 => ComponentType::I16,
        5123 => ComponentType::U16,
        5125 => ComponentType::U32,
        5126 => ComponentType::F32,
        _ => return Err(spot.not("5120, 5121, 5122, 5123, 5125 or 5126")),
    })
}

fn kind(spot: &Spot<'_>) -> Result<Type, SceneError> {
    Ok(match spot.text()? {
        "SCALAR" => Type::Scalar,
        "VEC2" => Type::Vec2,
        "VEC3" => Type::Vec3,
        "VEC4" => Type::Vec4,
        "MAT2" => Type::Mat2,
        "MAT3" => Type::Mat3,
        "MAT4" => Type::Mat4,
        _ => return Err(spot.not("SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4")),
    })
}

/// The bytes of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gltf) struct Size {
    /// Size with the padding of matrix columns: the stride of tightly packed elements.
    pub(in crate::gltf) whole: u64,
    /// Without the padding after the last column, which the last element may lack.
    pub(in crate::gltf) last: u64,
}

impl Size {
    /// The size of an element of this format.
    pub(in crate::gltf) fn of(kind: Type, component: ComponentType) -> Self {
        let (columns, rows) = match kind {
            Type::Scalar => (1u64, 1u64),
            Type::Vec2 => (1, 2),
            Type::Vec3 => (1, 3),
            Type::Vec4 => (1, 4),
            Type::Mat2 => (2, 2),
            Type::Mat3 => (3, 3),
            Type::Mat4 => (4, 4),
        };
        let column = rows.saturating_mul(component.size() as u64);
        let apart = if columns > 1 { column.next_multiple_of(4) } else { column };
        let last = apart.saturating_mul(columns.saturating_sub(1)).saturating_add(column);
        Self { whole: apart.saturating_mul(columns), last }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// glTF 2.0, section 3.6.2.4: columns of matrices of 1- and 2-byte components are padded.
    #[test]
    fn matrix_columns_are_padded() {
        for (kind, component, whole, last) in [
            (Type::Vec3, ComponentType::F32, 12, 12),
            (Type::Vec3, ComponentType::U8, 3, 3),
            (Type::Mat2, ComponentType::I8, 8, 6),
            (Type::Mat3, ComponentType::U8, 12, 11),
            (Type::Mat3, ComponentType::I16, 24, 22),
            (Type::Mat4, ComponentType::F32, 64, 64),
        ] {
            assert_eq!(Size::of(kind, component), Size { whole, last });
        }
    }
}
