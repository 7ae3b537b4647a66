//! Textures: a picture and its sampler (glTF 2.0, sections 3.8.3 and 3.8.4).

use crate::picture::Picture;
use std::fmt;
use std::sync::Arc;

/// A picture with its encoding and its sampler.
#[derive(Clone)]
pub struct Texture {
    /// Name in messages.
    pub name: String,
    /// The pixels, shared by all textures of the same image.
    pub picture: Arc<Picture>,
    /// Encoding of the pixels; determined by the use in materials.
    pub encoding: Encoding,
    /// Sampler.
    pub sampler: Sampler,
}

impl fmt::Debug for Texture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Texture")
            .field("name", &self.name)
            .field("size", &(self.picture.width, self.picture.height))
            .field("encoding", &self.encoding)
            .field("sampler", &self.sampler)
            .finish()
    }
}

/// Encoding of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Encoding {
    /// Colors with the transfer function of sRGB; alpha is linear.
    Srgb,
    /// Plain numbers: normals, roughness and similar data.
    Linear,
}

/// Sampler of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Sampler {
    /// Wrap mode beyond the left and right border.
    pub wrap_s: Wrap,
    /// Wrap mode beyond the upper and lower border.
    pub wrap_t: Wrap,
    /// Filter for magnification.
    pub mag: Filter,
    /// Filter for minification.
    pub min: Filter,
    /// Filter between mip levels; `None` if only the full size is used.
    pub mip: Option<Filter>,
}

impl Sampler {
    /// Repeating, linear, with mip levels: the default if a file has no sampler.
    pub const USUAL: Self = Self {
        wrap_s: Wrap::Repeat,
        wrap_t: Wrap::Repeat,
        mag: Filter::Linear,
        min: Filter::Linear,
        mip: Some(Filter::Linear),
    };
}

/// Wrap mode of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Wrap {
    /// The texture again.
    #[default]
    Repeat,
    /// The texture again, mirrored each second time.
    MirroredRepeat,
    /// The pixels of the border.
    ClampToEdge,
}

/// Filter between pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Filter {
    /// The nearest.
    Nearest,
    /// The mean of those around, weighted by nearness.
    #[default]
    Linear,
}
