//! Pictures from files: PNG, JPEG, Radiance HDR, OpenEXR.
//!
//! Sources: W3C, "Portable Network Graphics (PNG) Specification", third edition; ITU-T T.81 (JPEG); Ward,
//! "Real Pixels", Graphics Gems II (1991), for Radiance HDR; Academy Software Foundation, "OpenEXR File Layout".
//!
//! The kind of a file follows from its first bytes, never from its name; a name of another kind is an error, since one
//! of the two is a mistake. Pixels are in rows from the top, left to right. [`Pixels::Rgba8`] are the numbers
//! of the file: sRGB color or plain data by the use of the picture.
//! [`Pixels::RgbaF32`] are linear: Radiance values are divided by the file's `EXPOSURE`, so both are radiances.
//!
//! Limits: a side of 65 535 pixels, and a [`Budget`]. A small file may not become large either: decoding
//! needs at most 704 MiB and 256 bytes for each byte of the file, which a picture of a scene never reaches.

mod exr;
mod exr_header;
mod gray;
mod radiance;
mod raster;

use crate::Budget;
use crate::error::{SceneError, quoted, size};
use crate::magic;
use crate::warning::Warning;
use std::path::Path;

pub use gray::{Gray16, decode_gray16};

/// The longest side of a picture, in pixels.
pub const MAX_SIDE: u32 = 65_535;

/// Memory that any file may need for decoding, in bytes.
const BASE_COST: u64 = 704 << 20;

/// Additional memory for decoding per byte of a file.
const COST_PER_BYTE: u64 = 256;

/// Supported formats, for messages.
const READABLE: &str = "a PNG, JPEG, Radiance HDR or OpenEXR image";

/// A picture: rows from the top, left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Name of the file in messages.
    pub name: String,
    /// Pixels in a row; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// `width * height` pixels.
    pub pixels: Pixels,
    /// Parts that were dropped or repaired.
    pub warnings: Vec<Warning>,
}

/// Red, green, blue and alpha (not multiplied in) of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Integers of the file; 16 bits are rounded to 8.
    Rgba8(Vec<[u8; 4]>),
    /// Linear, scene-referred and finite; may be negative.
    RgbaF32(Vec<[f32; 4]>),
}

impl Pixels {
    /// Number of pixels.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Rgba8(pixels) => pixels.len(),
            Self::RgbaF32(pixels) => pixels.len(),
        }
    }

    /// True if there are no pixels.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Size in memory, in bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let each = match self {
            Self::Rgba8(_) => size_of::<[u8; 4]>(),
            Self::RgbaF32(_) => size_of::<[f32; 4]>(),
        };
        (self.len() as u64).saturating_mul(each as u64)
    }
}

impl Picture {
    /// Strict form: the same picture, unless pixels were replaced.
    ///
    /// # Errors
    /// [`SceneError::BadInput`] with the text of the first warning of a loss.
    pub fn strict(self) -> Result<Self, SceneError> {
        match self.warnings.iter().find(|warning| warning.kind.is_loss()) {
            None => Ok(self),
            Some(loss) => {
                let error = SceneError::bad(&loss.location, loss.what.as_str(), "pixels that are all of use");
                Err(error.in_file(&self.name))
            }
        }
    }
}

/// Reads a picture from the bytes of its file.
///
/// `name` is the name of the file in messages; if it ends like a picture's (`.png`), the bytes must be of that kind.
/// The budget is lowered by the pixels and by their size.
///
/// # Errors
/// [`SceneError`]: the bytes are not a supported picture, are truncated or damaged, are of another kind than
/// the name, or exceed the budget.
///
/// ```
/// use downpour_scene::{Budget, picture::{Pixels, decode}};
/// // A Radiance HDR image of one pixel: 128/256 * 2^(129 - 128) = 1 in red, half of that in green.
/// let file = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x40\x00\x81";
/// let picture = decode("one.hdr", file, &mut Budget::default())?;
/// assert_eq!(picture.pixels, Pixels::RgbaF32(vec![[1.0, 0.5, 0.0, 1.0]]));
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
pub fn decode(name: &str, bytes: &[u8], budget: &mut Budget) -> Result<Picture, SceneError> {
    let read = || {
        let kind = Kind::of(bytes)?;
        kind.check_name(name)?;
        match kind {
            Kind::Png => raster::decode(bytes, image::ImageFormat::Png, budget),
            Kind::Jpeg => raster::decode(bytes, image::ImageFormat::Jpeg, budget),
            Kind::Radiance => radiance::decode(bytes, budget),
            Kind::OpenExr => exr::decode(bytes, budget),
        }
    };
    let mut picture: Picture = read().map_err(|error| error.in_file(name))?;
    let pixels = u64::from(picture.width).saturating_mul(u64::from(picture.height));
    budget.pixels = budget.pixels.saturating_sub(pixels);
    budget.bytes = budget.bytes.saturating_sub(picture.pixels.bytes());
    name.clone_into(&mut picture.name);
    Ok(picture)
}

/// The kinds that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Png,
    Jpeg,
    Radiance,
    OpenExr,
}

impl Kind {
    /// The kind by the first bytes.
    fn of(bytes: &[u8]) -> Result<Self, SceneError> {
        let begins = |magic: &[u8]| bytes.starts_with(magic);
        if begins(b"\x89PNG\r\n\x1a\n") {
            Ok(Self::Png)
        } else if begins(b"\xff\xd8\xff") {
            Ok(Self::Jpeg)
        } else if begins(b"#?RADIANCE") || begins(b"#?RGBE") {
            Ok(Self::Radiance)
        } else if begins(b"\x76\x2f\x31\x01") {
            Ok(Self::OpenExr)
        } else {
            Err(SceneError::bad("", magic::found(bytes), READABLE))
        }
    }

    /// The kind that a name's ending promises. `Some(None)` is a picture of a kind that cannot be read.
    fn promised(extension: &str) -> Option<Option<Self>> {
        match extension.to_ascii_lowercase().as_str() {
            "png" | "apng" => Some(Some(Self::Png)),
            "jpg" | "jpeg" | "jpe" | "jfif" => Some(Some(Self::Jpeg)),
            "hdr" | "rgbe" | "pic" => Some(Some(Self::Radiance)),
            "exr" => Some(Some(Self::OpenExr)),
            "gif" | "webp" | "bmp" | "tga" | "tif" | "tiff" | "dds" | "ktx" | "ktx2" | "avif" | "heic"
            | "psd" | "jxl" | "qoi" => Some(None),
            _ => None,
        }
    }

    /// Refuses a name that promises another kind.
    fn check_name(self, name: &str) -> Result<(), SceneError> {
        let Some(extension) = Path::new(name).extension().and_then(|e| e.to_str()) else { return Ok(()) };
        match Self::promised(extension) {
            None => Ok(()),
            Some(promised) if promised == Some(self) => Ok(()),
            Some(_) => {
                let found = format!("{} with the ending {}", self.name(), quoted(&format!(".{extension}")));
                let allowed = format!("{} for {}", self.endings(), self.name());
                Err(SceneError::bad("", found, allowed).with_advice("rename or convert the file"))
            }
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Png => "a PNG image",
            Self::Jpeg => "a JPEG image",
            Self::Radiance => "a Radiance HDR image",
            Self::OpenExr => "an OpenEXR image",
        }
    }

    fn endings(self) -> &'static str {
        match self {
            Self::Png => ".png",
            Self::Jpeg => ".jpg or .jpeg",
            Self::Radiance => ".hdr",
            Self::OpenExr => ".exr",
        }
    }
}

/// Refuses a size that cannot be, that the budget does not allow, or that costs more than such a file may.
///
/// `cost` is the most memory that decoding needs at one time, in bytes, the file itself not counted.
fn check_cost(
    location: &str,
    (width, height): (u32, u32),
    cost: u64,
    file: &[u8],
    budget: &Budget,
) -> Result<(), SceneError> {
    let shown = || format!("{width} x {height} pixels");
    if width == 0 || height == 0 {
        return Err(SceneError::bad(location, shown(), "at least 1 x 1 pixels"));
    }
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(SceneError::limit(location, shown(), format!("sides of at most {MAX_SIDE} pixels")));
    }
    let pixels = u64::from(width).saturating_mul(u64::from(height));
    if pixels > budget.pixels {
        let allowed = format!("{} pixels left in the budget", budget.pixels);
        return Err(SceneError::limit(location, shown(), allowed).with_advice("scale the picture down"));
    }
    let mut remaining = *budget;
    remaining.take_bytes(file.len() as u64, location)?;
    remaining.take_bytes(cost, location).map_err(|error| error.with_advice("scale the picture down"))?;
    let most = BASE_COST.saturating_add(COST_PER_BYTE.saturating_mul(file.len() as u64));
    if cost > most {
        let found = format!("{} in a file of {} bytes: {} to decode", shown(), file.len(), size(cost));
        let allowed = format!("{} for a file of this length", size(most));
        return Err(SceneError::limit(location, found, allowed).with_advice("scale the picture down"));
    }
    Ok(())
}

std::thread_local! {
    static IS_GUARDED: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

/// True while this thread is within a decoder of another crate whose panics become errors. A program's panic hook can call
/// it and print nothing: the error has the message.
#[must_use]
pub fn is_guarded() -> bool {
    IS_GUARDED.get()
}

/// Runs a decoder of another crate. A panic in it is the file's fault, and must not be the caller's end.
fn guarded<T>(decoder: impl FnOnce() -> Result<T, SceneError>) -> Result<T, SceneError> {
    let before = IS_GUARDED.replace(true);
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(decoder));
    IS_GUARDED.set(before);
    result.unwrap_or_else(|_| {
        Err(SceneError::bad("pixels", "data that the decoder stumbles over", "a whole and undamaged picture"))
    })
}

/// Error of a decoder, with its message.
fn damaged(error: &impl std::fmt::Display) -> SceneError {
    let found = format!("cannot be decoded: {}", crate::error::escaped(&error.to_string()));
    SceneError::bad("pixels", found, "a whole and undamaged picture")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_of_a_decoder_is_an_error_and_a_hook_can_tell() {
        let error = guarded::<()>(|| {
            assert!(is_guarded());
            // This panic is reported by the test's panic hook.
            panic!("a decoder stumbles")
        })
        .expect_err("a panic");
        assert!(!is_guarded() && error.to_string().contains("stumbles over"), "{error}");
        assert!(guarded(|| Ok(is_guarded())).expect("no panic"));
    }
}
