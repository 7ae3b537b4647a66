//! Textures, samplers and images: glTF 2.0, sections 5.29, 5.26 and 5.18.
//!
//! A picture is color or plain data by its use in a material, so a texture of the file with both uses becomes two.
//! Images that no material uses are not opened.

use super::fields;
use crate::Budget;
use crate::base64;
use crate::error::{SceneError, quoted, size};
use crate::gltf::buffers::Buffers;
use crate::gltf::guard::Spot;
use crate::gltf::{MAX_FILE, irregular};
use crate::picture::{self, Picture};
use crate::sandbox::{Files, RelativePath};
use crate::scene::{Encoding, Filter, Sampler, Texture, Wrap};
use crate::uri::{self, Address};
use crate::warning::{WarningKind, Warnings};
use gltf::json::{Index, Root};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;
use std::sync::Arc;

/// A usable texture: an image and its sampler.
type Source = (usize, Sampler);

/// Textures of a file and their uses.
pub(super) struct Textures {
    sources: Vec<Option<Source>>,
    wanted: Vec<(Source, Encoding)>,
    known: BTreeMap<(Source, Encoding), usize>,
}

impl Textures {
    /// Reads textures and samplers.
    pub(super) fn read(document: &Spot<'_>) -> Result<Self, SceneError> {
        let mut samplers = Vec::new();
        document.each(&["samplers", "[]"], &mut |spot| {
            samplers.push(sampler(spot)?);
            Ok(())
        })?;
        let mut sources = Vec::new();
        document.each(&["textures", "[]"], &mut |texture| {
            let index = |key| {
                let member: Option<Spot<'_>> = texture.get(key)?;
                member.map_or(Ok(None), |index| Ok::<_, SceneError>(usize::try_from(index.whole()?).ok()))
            };
            let sampler = index("sampler")?.and_then(|index| samplers.get(index).copied());
            sources.push(index("source")?.map(|image| (image, sampler.unwrap_or(Sampler::USUAL))));
            Ok(())
        })?;
        Ok(Self { sources, wanted: Vec::new(), known: BTreeMap::new() })
    }

    /// Index in the scene's list of a texture of the file; `None`, with a warning, for one without an image.
    pub(super) fn used(
        &mut self,
        texture: usize,
        encoding: Encoding,
        warnings: &mut Warnings,
    ) -> Option<usize> {
        let Some(source) = self.sources.get(texture).copied().flatten() else {
            warnings.add(WarningKind::Ignored, format_args!("textures[{texture}]"), || {
                "left out: no source, or only one that an extension gives".into()
            });
            return None;
        };
        let next = self.wanted.len();
        let slot = *self.known.entry((source, encoding)).or_insert(next);
        if slot == next {
            self.wanted.push((source, encoding));
        }
        Some(slot)
    }

    /// Opens and decodes the images that are used, each once.
    pub(super) fn load(
        self,
        images: &Images<'_>,
        budget: &mut Budget,
        warnings: &mut Warnings,
    ) -> Result<Vec<Texture>, SceneError> {
        let mut pictures: BTreeMap<usize, Arc<Picture>> = BTreeMap::new();
        let mut all = Budget::vec_with_capacity(self.wanted.len(), "textures")?;
        for ((image, sampler), encoding) in self.wanted {
            let picture = match pictures.get(&image) {
                Some(picture) => Arc::clone(picture),
                None => {
                    let picture = images.open(image, budget, warnings)?;
                    Arc::clone(pictures.entry(image).or_insert(Arc::new(picture)))
                }
            };
            all.push(Texture { name: picture.name.clone(), picture, encoding, sampler });
        }
        Ok(all)
    }
}

/// A sampler; numbers are those of OpenGL.
fn sampler(spot: &Spot<'_>) -> Result<Sampler, SceneError> {
    let wrap = |key| match spot.get(key)? {
        None => Ok(Wrap::Repeat),
        Some(wrap) => match wrap.whole()? {
            10497 => Ok(Wrap::Repeat),
            33648 => Ok(Wrap::MirroredRepeat),
            33071 => Ok(Wrap::ClampToEdge),
            _ => Err(wrap.not("10497 (repeat), 33648 (mirrored repeat) or 33071 (clamp to edge)")),
        },
    };
    let mag = match spot.get("magFilter")? {
        None => Filter::Linear,
        Some(filter) => match filter.whole()? {
            9728 => Filter::Nearest,
            9729 => Filter::Linear,
            _ => return Err(filter.not("9728 (nearest) or 9729 (linear)")),
        },
    };
    let (min, mip) = match spot.get("minFilter")? {
        None => (Filter::Linear, Some(Filter::Linear)),
        Some(filter) => match filter.whole()? {
            9728 => (Filter::Nearest, None),
            9729 => (Filter::Linear, None),
            9984 => (Filter::Nearest, Some(Filter::Nearest)),
            9985 => (Filter::Linear, Some(Filter::Nearest)),
            9986 => (Filter::Nearest, Some(Filter::Linear)),
            9987 => (Filter::Linear, Some(Filter::Linear)),
            _ => return Err(filter.not("9728, 9729 or 9984 to 9987")),
        },
    };
    Ok(Sampler { wrap_s: wrap("wrapS")?, wrap_t: wrap("wrapT")?, mag, min, mip })
}

/// Sources of the bytes of images.
pub(super) struct Images<'a> {
    pub(super) document: Spot<'a>,
    pub(super) root: &'a Root,
    pub(super) buffers: &'a Buffers<'a>,
    pub(super) files: &'a dyn Files,
}

impl Images<'_> {
    /// Opens and decodes an image.
    fn open(
        &self,
        index: usize,
        budget: &mut Budget,
        warnings: &mut Warnings,
    ) -> Result<Picture, SceneError> {
        let location = format!("images[{index}]");
        let images = self.document.need("images")?;
        let Some(image) = images.item(index) else {
            return Err(SceneError::bad(location, "no such image", "an image of the list"));
        };
        let before = budget.bytes;
        let (name, bytes) = self.bytes(&image, &location, budget)?;
        let held = before.saturating_sub(budget.bytes);
        let name = match name {
            Some(path) => path,
            None => fields::name(&image)?,
        };
        // Only a file's name promises a kind: an image in a view may be called anything.
        let promise = if image.value.get("uri").is_some() { name.as_str() } else { "" };
        let picture = picture::decode(promise, &bytes, budget);
        let mut picture = picture.map_err(|error| error.inside(&location))?;
        // The encoded bytes are dropped here.
        budget.bytes = budget.bytes.saturating_add(held);
        for warning in &picture.warnings {
            warnings.add(warning.kind, &location, || warning.to_string());
        }
        picture.name = name;
        self.media_type(&image, warnings)?;
        Ok(picture)
    }

    fn media_type(&self, image: &Spot<'_>, warnings: &mut Warnings) -> Result<(), SceneError> {
        let Some(mime) = image.get("mimeType")? else { return Ok(()) };
        if !["image/png", "image/jpeg"].contains(&mime.text()?) {
            irregular(warnings, mime.trail, || {
                format!("media type {} of an image", quoted(mime.text().unwrap_or_default()))
            });
        }
        Ok(())
    }

    /// The encoded bytes, and the path if they are in a file.
    fn bytes(
        &self,
        image: &Spot<'_>,
        location: &str,
        budget: &mut Budget,
    ) -> Result<(Option<String>, Cow<'_, [u8]>), SceneError> {
        let lost = || SceneError::bad(location, "data outside its buffer", "data inside");
        if let Some(view) = image.get("bufferView")? {
            let view = u32::try_from(view.whole()?).ok().and_then(|view| self.root.get(Index::new(view)));
            let bytes = view.and_then(|view| self.buffers.view(view)).ok_or_else(lost)?;
            return Ok((None, Cow::Borrowed(bytes)));
        }
        let uri = image.need("uri")?;
        match uri::check(uri.text()?).map_err(|why| SceneError::bad(uri.trail, why.found, why.allowed))? {
            Address::Data { text, .. } => {
                let length = base64::decoded_len(text).ok_or_else(lost)?;
                budget.take_bytes(length as u64, location)?;
                let mut bytes = Budget::vec_with_capacity(length, location)?;
                base64::decode(text, length, &mut bytes);
                Ok((None, Cow::Owned(bytes)))
            }
            Address::File(path) => {
                let bytes = self.file(&path, budget).map_err(|error| error.at(uri.trail))?;
                Ok((Some(path.as_str().to_owned()), Cow::Owned(bytes)))
            }
        }
    }

    fn file(&self, path: &RelativePath, budget: &mut Budget) -> Result<Vec<u8>, SceneError> {
        let file = self.files.open(path)?;
        if file.size > MAX_FILE {
            let found = format!("{} has {}", quoted(path.as_str()), size(file.size));
            return Err(SceneError::limit("", found, format!("at most {}", size(MAX_FILE))));
        }
        budget.take_bytes(file.size, "")?;
        let mut bytes = Budget::vec_with_capacity(usize::try_from(file.size).unwrap_or(usize::MAX), "")?;
        let read = file.bytes.take(file.size).read_to_end(&mut bytes);
        read.map_err(|error| SceneError::io("", path.as_str(), &error))?;
        Ok(bytes)
    }
}
