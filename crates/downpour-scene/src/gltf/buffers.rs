//! The bytes of all buffers: opened only after the guard has passed, each file once.

use crate::Budget;
use crate::base64;
use crate::error::{SceneError, size};
use crate::sandbox::{Files, RelativePath};
use crate::uri::{self, Address};
use gltf::json::{Buffer, Root, buffer};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;

/// The bytes of a document's buffers.
pub(super) struct Buffers<'a> {
    /// Bytes that were read, once for each file even if several buffers name it.
    sources: Vec<Cow<'a, [u8]>>,
    /// For each buffer its source and its length.
    buffers: Vec<(usize, usize)>,
    /// Number of bytes from other files.
    pub(super) from_files: u64,
}

impl Buffers<'_> {
    /// Bytes of a view. The guard has checked that it lies inside its buffer.
    pub(super) fn view(&self, view: &buffer::View) -> Option<&[u8]> {
        let &(source, length) = self.buffers.get(view.buffer.value())?;
        let bytes = self.sources.get(source)?.get(..length)?;
        let offset = usize::try_from(view.byte_offset.map_or(0, |offset| offset.0)).ok()?;
        bytes.get(offset..)?.get(..usize::try_from(view.byte_length.0).ok()?)
    }
}

/// Opens all buffers.
pub(super) fn load<'a>(
    root: &Root,
    binary: Option<&'a [u8]>,
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<Buffers<'a>, SceneError> {
    let mut all = Buffers { sources: Vec::new(), buffers: Vec::new(), from_files: 0 };
    let longest = longest(root);
    let mut opened: BTreeMap<RelativePath, usize> = BTreeMap::new();
    for (index, buffer) in root.buffers.iter().enumerate() {
        let location = format!("buffers[{index}]");
        let length = bytes_of(buffer, &location)?;
        let address = match &buffer.uri {
            None => None,
            Some(uri) => {
                Some(uri::check(uri).map_err(|why| SceneError::bad(&location, why.found, why.allowed))?)
            }
        };
        let source = match address {
            None => Cow::Borrowed(binary.unwrap_or_default()),
            Some(Address::Data { text, .. }) => {
                budget.take_bytes(length as u64, &location)?;
                let mut bytes = Budget::vec_with_capacity(length, &location)?;
                base64::decode(text, length, &mut bytes);
                Cow::Owned(bytes)
            }
            Some(Address::File(path)) => {
                if let Some(&source) = opened.get(&path) {
                    all.buffers.push((source, length));
                    continue;
                }
                let &(longest, wanted) = longest.get(&path).unwrap_or(&(index, length as u64));
                let bytes = read(&path, wanted, files, budget)
                    .map_err(|error| error.at(format_args!("buffers[{longest}].uri")))?;
                all.from_files = all.from_files.saturating_add(bytes.len() as u64);
                opened.insert(path, all.sources.len());
                Cow::Owned(bytes)
            }
        };
        all.buffers.push((all.sources.len(), length));
        all.sources.push(source);
    }
    Ok(all)
}

fn bytes_of(buffer: &Buffer, location: &str) -> Result<usize, SceneError> {
    let length = buffer.byte_length.0;
    usize::try_from(length)
        .map_err(|_| SceneError::limit(location, size(length), "the address space of this machine"))
}

/// For each file the longest buffer that names it, with its length in bytes.
fn longest(root: &Root) -> BTreeMap<RelativePath, (usize, u64)> {
    let mut longest = BTreeMap::new();
    for (index, buffer) in root.buffers.iter().enumerate() {
        let Some(Ok(Address::File(path))) = buffer.uri.as_deref().map(uri::check) else { continue };
        let entry = longest.entry(path).or_insert((index, 0));
        if buffer.byte_length.0 > entry.1 {
            *entry = (index, buffer.byte_length.0);
        }
    }
    longest
}

/// The first bytes of a file.
fn read(
    path: &RelativePath,
    wanted: u64,
    files: &dyn Files,
    budget: &mut Budget,
) -> Result<Vec<u8>, SceneError> {
    let file = files.open(path)?;
    if file.size < wanted {
        let found = format!("byteLength {wanted}, but the file has {} bytes", file.size);
        return Err(SceneError::bad("", found, format!("byteLength up to {}", file.size)));
    }
    budget.take_bytes(wanted, "")?;
    let mut bytes = Budget::vec_with_capacity(usize::try_from(wanted).unwrap_or(usize::MAX), "")?;
    file.bytes
        .take(wanted)
        .read_to_end(&mut bytes)
        .map_err(|error| SceneError::io("", path.as_str(), &error))?;
    if (bytes.len() as u64) < wanted {
        let cut = std::io::Error::from(std::io::ErrorKind::UnexpectedEof);
        return Err(SceneError::io("", path.as_str(), &cut));
    }
    Ok(bytes)
}
