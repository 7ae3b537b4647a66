//! Checks of buffers, views into them, and images.

use super::spot::Spot;
use crate::base64;
use crate::error::{SceneError, quoted, size};
use crate::gltf::irregular;
use crate::uri::{self, Address};
use crate::warning::{WarningKind, Warnings};

/// A checked view.
#[derive(Clone, Copy)]
pub(super) struct ViewFacts {
    pub(super) offset: u64,
    pub(super) length: u64,
    pub(super) stride: Option<u64>,
}

/// Checks an address.
fn address<'a>(uri: &Spot<'a>) -> Result<Address<'a>, SceneError> {
    uri::check(uri.text()?).map_err(|refused| uri.wrong(refused.found, refused.allowed))
}

/// Length of a data URI's contents.
fn data_len(uri: &Spot<'_>, text: &str) -> Result<u64, SceneError> {
    match base64::decoded_len(text) {
        Some(length) => Ok(length as u64),
        None => Err(uri.not("base64 after RFC 4648")),
    }
}

/// Checks the buffers and returns their lengths in bytes. The length of a file is checked when it is opened.
pub(super) fn buffers(
    document: &Spot<'_>,
    binary: Option<&[u8]>,
    warnings: &mut Warnings,
) -> Result<Vec<u64>, SceneError> {
    let mut lengths = Vec::new();
    document.each(&["buffers", "[]"], &mut |buffer| {
        let length_spot = buffer.need("byteLength")?;
        let length = length_spot.positive()?;
        let has = if let Some(uri) = buffer.get("uri")? {
            match address(&uri)? {
                Address::File(_) => None,
                Address::Data { mime, text } => {
                    if !["", "application/octet-stream", "application/gltf-buffer"].contains(&mime) {
                        irregular(warnings, uri.trail, || format!("media type {} of a buffer", quoted(mime)));
                    }
                    Some(data_len(&uri, text)?)
                }
            }
        } else if let Some(binary) = binary.filter(|_| lengths.is_empty()) {
            let spare = (binary.len() as u64).saturating_sub(length);
            if spare > 3 {
                irregular(warnings, length_spot.trail, || {
                    format!("{} less than the binary chunk has: the end is ignored", size(spare))
                });
            }
            Some(binary.len() as u64)
        } else {
            let allowed = "a uri, or the binary chunk of a GLB as the first buffer";
            return Err(buffer.wrong("no uri and no binary chunk", allowed));
        };
        if let Some(has) = has.filter(|&has| has < length) {
            return Err(
                length_spot.wrong(format!("{length} bytes, but the data has {has}"), format!("1 to {has}"))
            );
        }
        lengths.push(length);
        Ok(())
    })?;
    if binary.is_some() && lengths.is_empty() {
        warnings.add(WarningKind::Ignored, "GLB chunk 1", || "no buffer uses the binary chunk".into());
    }
    Ok(lengths)
}

/// Checks that each view lies inside its buffer.
pub(super) fn views(document: &Spot<'_>, buffers: &[u64]) -> Result<Vec<ViewFacts>, SceneError> {
    let mut views = Vec::new();
    document.each(&["bufferViews", "[]"], &mut |view| {
        let buffer = view.need("buffer")?.index_into("buffers", buffers.len())?;
        let has = buffers.get(buffer).copied().unwrap_or(0);
        let offset = view.whole_or_zero("byteOffset")?;
        let length = view.need("byteLength")?.positive()?;
        if offset.checked_add(length).is_none_or(|end| end > has) {
            let found = format!("byteOffset {offset} and byteLength {length}");
            return Err(view.wrong(found, format!("an end within buffers[{buffer}], which has {has} bytes")));
        }
        let stride = match view.get("byteStride")? {
            None => None,
            Some(spot) => Some(match spot.whole()? {
                stride if (4..=252).contains(&stride) && stride.is_multiple_of(4) => stride,
                _ => return Err(spot.not("4 to 252, in steps of 4")),
            }),
        };
        views.push(ViewFacts { offset, length, stride });
        Ok(())
    })?;
    Ok(views)
}

/// Checks that each image has one source. The source's bytes are not looked at here.
pub(super) fn images(document: &Spot<'_>, warnings: &mut Warnings) -> Result<(), SceneError> {
    document.each(&["images", "[]"], &mut |image| {
        let (uri, view, mime) = (image.get("uri")?, image.get("bufferView")?, image.get("mimeType")?);
        if let Some(mime) = mime {
            mime.text()?;
        }
        match (uri, view) {
            (Some(uri), None) => match address(&uri)? {
                Address::File(_) => Ok(()),
                Address::Data { mime, text } => {
                    if !["image/png", "image/jpeg"].contains(&mime) {
                        irregular(warnings, uri.trail, || format!("media type {} of an image", quoted(mime)));
                    }
                    data_len(&uri, text).map(drop)
                }
            },
            (None, Some(_)) if mime.is_none() => Err(image.wrong("a bufferView without mimeType", "both")),
            (None, Some(_)) => Ok(()),
            (None, None) => Err(image.wrong("neither uri nor bufferView", "one of both")),
            (Some(_), Some(_)) => Err(image.wrong("uri and bufferView", "one of both")),
        }
    })
}
