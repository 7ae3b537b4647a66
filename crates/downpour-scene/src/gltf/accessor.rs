//! Elements of an accessor in order, with sparse substitution.
//!
//! Source: glTF 2.0, sections 3.6.2.2 (formats), 3.6.2.3 (sparse) and 3.11 (normalized integers).

use super::buffers::Buffers;
use super::guard::Size;
use crate::error::SceneError;
use gltf::json::accessor::{ComponentType, GenericComponentType, IndexComponentType};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, Root};

/// An element of an accessor that has no data: all its bytes are 0.
static ZEROS: [u8; 64] = [0; 64];

/// The elements of one accessor in their order.
pub(super) struct Elements<'a> {
    number: usize,
    base: Option<&'a [u8]>,
    stride: usize,
    size: usize,
    component: ComponentType,
    normalized: bool,
    count: usize,
    next: usize,
    sparse: Option<Sparse<'a>>,
}

/// Remaining substituted elements.
struct Sparse<'a> {
    indices: std::slice::ChunksExact<'a, u8>,
    component: ComponentType,
    values: std::slice::ChunksExact<'a, u8>,
    /// The next substitution.
    ahead: Option<(usize, &'a [u8])>,
}

impl<'a> Elements<'a> {
    /// Opens an accessor.
    pub(super) fn open(
        root: &'a Root,
        buffers: &'a Buffers<'_>,
        index: Index<Accessor>,
    ) -> Result<Self, SceneError> {
        let number = index.value();
        Self::try_open(root, buffers, index).ok_or_else(|| misplaced(number))?
    }

    /// Opens the accessor; `None` on a defect that the guard should have found.
    fn try_open(
        root: &'a Root,
        buffers: &'a Buffers<'_>,
        index: Index<Accessor>,
    ) -> Option<Result<Self, SceneError>> {
        let number = index.value();
        let accessor = root.get(index)?;
        let Checked::Valid(GenericComponentType(component)) = accessor.component_type else { return None };
        let Checked::Valid(kind) = accessor.type_ else { return None };
        let size = usize::try_from(Size::of(kind, component).whole).ok()?;
        let (base, stride) = match accessor.buffer_view {
            None => (None, size),
            Some(view) => {
                let view = root.get(view)?;
                let offset = usize::try_from(accessor.byte_offset.map_or(0, |offset| offset.0)).ok()?;
                (Some(buffers.view(view)?.get(offset..)?), view.byte_stride.map_or(size, |stride| stride.0))
            }
        };
        let mut elements = Self {
            number,
            base,
            stride,
            size,
            component,
            normalized: accessor.normalized,
            count: usize::try_from(accessor.count.0).ok()?,
            next: 0,
            sparse: None,
        };
        if let Some(sparse) = &accessor.sparse {
            let count = usize::try_from(sparse.count.0).ok()?;
            let Checked::Valid(IndexComponentType(component)) = sparse.indices.component_type else {
                return None;
            };
            let part = |view, offset: u64, size: usize| {
                let bytes = buffers.view(root.get(view)?)?.get(usize::try_from(offset).ok()?..)?;
                Some(bytes.get(..count.checked_mul(size)?)?.chunks_exact(size))
            };
            elements.sparse = Some(Sparse {
                indices: part(sparse.indices.buffer_view, sparse.indices.byte_offset.0, component.size())?,
                component,
                values: part(sparse.values.buffer_view, sparse.values.byte_offset.0, size)?,
                ahead: None,
            });
            if let Err(error) = elements.substitute() {
                return Some(Err(error));
            }
        }
        Some(Ok(elements))
    }

    /// Number of elements.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Moves on to the next substitution; their indices must increase and lie within the accessor.
    fn substitute(&mut self) -> Result<(), SceneError> {
        let Some(sparse) = &mut self.sparse else { return Ok(()) };
        let before = sparse.ahead.take();
        let (Some(path), Some(value)) = (sparse.indices.next(), sparse.values.next()) else { return Ok(()) };
        let at = unsigned(sparse.component, path).ok_or_else(|| misplaced(self.number))?;
        let least = before.map_or(0, |(before, _)| before.saturating_add(1));
        if !(least..self.count).contains(&at) {
            return Err(SceneError::bad(
                format_args!("accessors[{}].sparse.indices", self.number),
                format!("{at}, out of range or not above the one before"),
                format!("increasing indices from {least} to {}", self.count.saturating_sub(1)),
            ));
        }
        sparse.ahead = Some((at, value));
        Ok(())
    }

    /// The bytes of the next element; `None` after the last.
    fn advance(&mut self) -> Result<Option<&'a [u8]>, SceneError> {
        let at = self.next;
        if at >= self.count {
            return Ok(None);
        }
        self.next = at.saturating_add(1);
        if let Some((_, value)) =
            self.sparse.as_ref().and_then(|sparse| sparse.ahead).filter(|&(path, _)| path == at)
        {
            self.substitute()?;
            return Ok(Some(value));
        }
        let bytes = match self.base {
            None => ZEROS.get(..self.size),
            Some(base) => at
                .checked_mul(self.stride)
                .and_then(|start| base.get(start..))
                .and_then(|rest| rest.get(..self.size)),
        };
        bytes.map(Some).ok_or_else(|| misplaced(self.number))
    }

    /// The next element as three numbers.
    pub(super) fn vector(&mut self) -> Result<Option<[f64; 3]>, SceneError> {
        let Some(bytes) = self.advance()? else { return Ok(None) };
        let mut parts = bytes.chunks_exact(self.component.size());
        let mut part = || parts.next().and_then(|bytes| number(self.component, self.normalized, bytes));
        match (part(), part(), part()) {
            (Some(x), Some(y), Some(z)) => Ok(Some([x, y, z])),
            _ => Err(misplaced(self.number)),
        }
    }

    /// The next element as `N` numbers; missing ones are `rest`. Not for matrices of small integers.
    pub(super) fn numbers<const N: usize>(&mut self, rest: f64) -> Result<Option<[f64; N]>, SceneError> {
        let Some(bytes) = self.advance()? else { return Ok(None) };
        let mut all = [rest; N];
        for (part, bytes) in all.iter_mut().zip(bytes.chunks_exact(self.component.size())) {
            *part = number(self.component, self.normalized, bytes).ok_or_else(|| misplaced(self.number))?;
        }
        Ok(Some(all))
    }

    /// The next element as four unsigned integers.
    pub(super) fn quartet(&mut self) -> Result<Option<[usize; 4]>, SceneError> {
        let Some(bytes) = self.advance()? else { return Ok(None) };
        let mut all = [0; 4];
        for (part, bytes) in all.iter_mut().zip(bytes.chunks_exact(self.component.size())) {
            *part = unsigned(self.component, bytes).ok_or_else(|| misplaced(self.number))?;
        }
        Ok(Some(all))
    }

    /// The next element as an unsigned integer.
    pub(super) fn unsigned(&mut self) -> Result<Option<usize>, SceneError> {
        let Some(bytes) = self.advance()? else { return Ok(None) };
        unsigned(self.component, bytes).map(Some).ok_or_else(|| misplaced(self.number))
    }
}

/// Error for defects that the guard should have found: an error instead of a panic.
fn misplaced(number: usize) -> SceneError {
    SceneError::bad(format_args!("accessors[{number}]"), "data outside its buffer", "data inside")
}

fn unsigned(component: ComponentType, bytes: &[u8]) -> Option<usize> {
    match component {
        ComponentType::U8 => bytes.first().map(|&byte| usize::from(byte)),
        ComponentType::U16 => Some(usize::from(u16::from_le_bytes(*bytes.first_chunk()?))),
        ComponentType::U32 => usize::try_from(u32::from_le_bytes(*bytes.first_chunk()?)).ok(),
        _ => None,
    }
}

/// A component as a number. Normalized integers: c / 255, max(c / 127, -1) and so on.
fn number(component: ComponentType, normalized: bool, bytes: &[u8]) -> Option<f64> {
    let (value, full) = match component {
        ComponentType::I8 => (f64::from(i8::from_le_bytes(*bytes.first_chunk()?)), f64::from(i8::MAX)),
        ComponentType::U8 => (f64::from(*bytes.first()?), f64::from(u8::MAX)),
        ComponentType::I16 => (f64::from(i16::from_le_bytes(*bytes.first_chunk()?)), f64::from(i16::MAX)),
        ComponentType::U16 => (f64::from(u16::from_le_bytes(*bytes.first_chunk()?)), f64::from(u16::MAX)),
        ComponentType::U32 => (f64::from(u32::from_le_bytes(*bytes.first_chunk()?)), f64::from(u32::MAX)),
        ComponentType::F32 => return Some(f64::from(f32::from_le_bytes(*bytes.first_chunk()?))),
    };
    Some(if normalized { (value / full).max(-1.0) } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// glTF 2.0, section 3.11: both ends of each normalized integer.
    #[test]
    fn normalized_integers() {
        let cases: [(ComponentType, &[u8], f64); 8] = [
            (ComponentType::U8, &[255], 1.0),
            (ComponentType::U8, &[51], 0.2),
            (ComponentType::I8, &[127], 1.0),
            (ComponentType::I8, &[128], -1.0),
            (ComponentType::I8, &[129], -1.0),
            (ComponentType::U16, &[255, 255], 1.0),
            (ComponentType::I16, &[0, 128], -1.0),
            (ComponentType::I16, &[0, 0], 0.0),
        ];
        for (component, bytes, value) in cases {
            assert_eq!(number(component, true, bytes), Some(value));
        }
        assert_eq!(number(ComponentType::I16, false, &[0, 128]), Some(-32768.0));
        assert_eq!(number(ComponentType::F32, true, &2.5f32.to_le_bytes()), Some(2.5));
        assert_eq!(number(ComponentType::U16, false, &[1]), None);
    }
}
