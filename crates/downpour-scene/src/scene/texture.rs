//! A picture together with the way to sample it (glTF 2.0, sections 3.8.3 and 3.8.4).

use crate::picture::Picture;
use std::fmt;
use std::sync::Arc;

/// A picture, how its numbers are meant, and how it is sampled.
#[derive(Clone)]
pub struct Texture {
    /// What messages call it.
    pub name: String,
    /// The pixels, shared by all textures of the same image.
    pub picture: Arc<Picture>,
    /// What the numbers of the pixels mean; decided by the use that materials make of them.
    pub encoding: Encoding,
    /// How it is sampled.
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

/// What the numbers of pixels mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Encoding {
    /// Colours with the transfer function of sRGB; alpha is linear.
    Srgb,
    /// Numbers as they are: normals, roughness and the like.
    Linear,
}

/// How a texture is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Sampler {
    /// What lies beyond the left and right border.
    pub wrap_s: Wrap,
    /// What lies beyond the upper and lower border.
    pub wrap_t: Wrap,
    /// Between pixels, where the texture is enlarged.
    pub mag: Filter,
    /// Between pixels, where the texture is made smaller.
    pub min: Filter,
    /// Between levels of a pyramid; `None` where only the full size is used.
    pub mip: Option<Filter>,
}

impl Sampler {
    /// Repeating, linear, with a pyramid: what is taken where a file does not say.
    pub const USUAL: Self = Self {
        wrap_s: Wrap::Repeat,
        wrap_t: Wrap::Repeat,
        mag: Filter::Linear,
        min: Filter::Linear,
        mip: Some(Filter::Linear),
    };
}

/// What lies beyond the border of a texture.
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

/// What is taken between pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Filter {
    /// The nearest.
    Nearest,
    /// The mean of those around, weighted by nearness.
    #[default]
    Linear,
}
