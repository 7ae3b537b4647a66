//! A sky from a file: Radiance HDR or OpenEXR; with a warning, PNG or JPEG.
//!
//! Numbers of 8 bits are decoded by IEC 61966-2-1 (sRGB). They end at 1, so the sun of such a picture is as bright
//! as a white wall.

use super::{MAX_RADIANCE, SkyMap};
use crate::Budget;
use crate::error::{SceneError, shown_path};
use crate::picture::{self, Picture, Pixels};
use crate::sandbox::open_named;
use crate::warning::{WarningKind, Warnings};
use downpour_math::color::srgb_to_linear;
use std::path::Path;

/// Reads a sky map. The budget is lowered by its pixels and by their size.
///
/// # Errors
/// [`SceneError`]: the file cannot be read, is no picture, is damaged, or is too large; see
/// [`picture::decode`].
///
/// ```no_run
/// use downpour_scene::{Budget, sky::{SUN_THRESHOLD, read_sky}};
/// let mut sky = read_sky("park.hdr".as_ref(), &mut Budget::default())?;
/// if let Some(sun) = sky.extract_sun(SUN_THRESHOLD) {
///     println!("sun at {:?}", sun.direction);
/// }
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
pub fn read_sky(path: &Path, budget: &mut Budget) -> Result<SkyMap, SceneError> {
    let name = shown_path(path);
    let file = open_named(path)?;
    let bytes = file.read_all(budget).map_err(|error| error.in_file(&name))?;
    read_sky_from_bytes(&name, &bytes, budget)
}

/// Reads a sky map from the bytes of its file; `name` is its name in messages. The budget is lowered as by
/// [`read_sky`].
///
/// # Errors
/// As [`picture::decode`].
pub fn read_sky_from_bytes(name: &str, bytes: &[u8], budget: &mut Budget) -> Result<SkyMap, SceneError> {
    let mut remaining = *budget;
    let picture = picture::decode(name, bytes, &mut remaining)?;
    let pixels = picture.pixels.len() as u64;
    // The picture is there until the map is made.
    remaining.take_bytes(pixels.saturating_mul(12), "pixels").map_err(|error| error.in_file(name))?;
    let map = from_picture(picture)?;
    budget.pixels = remaining.pixels;
    budget.bytes = budget.bytes.saturating_sub(pixels.saturating_mul(12));
    Ok(map)
}

/// Makes a sky map of a picture. Alpha is left out.
///
/// Radiances below 0 become 0, those above [`MAX_RADIANCE`] become that; both are counted in a warning.
///
/// # Errors
/// [`SceneError::OverLimit`] if there is no memory for it.
pub fn from_picture(picture: Picture) -> Result<SkyMap, SceneError> {
    let Picture { name, width, height, pixels, warnings: earlier } = picture;
    let mut warnings = Warnings::default();
    let mut radiance =
        Budget::vec_with_capacity(pixels.len(), "pixels").map_err(|error| error.in_file(&name))?;
    if u64::from(width) != u64::from(height).saturating_mul(2) {
        warnings.add(WarningKind::Irregular, "", || {
            format!("{width} x {height} pixels, taken as a whole sphere though not twice as wide as high")
        });
    }
    match pixels {
        Pixels::Rgba8(pixels) => {
            warnings.add(WarningKind::Irregular, "", || {
            "8 bits per color, decoded as sRGB: no light is brighter than white; better an .hdr or .exr".into()
            });
            let mut linear = [0.0f32; 256];
            for (value, level) in linear.iter_mut().zip(0u8..=255) {
                *value = srgb_to_linear(f32::from(level) / 255.0);
            }
            let decode = |level: u8| linear.get(usize::from(level)).copied().unwrap_or_default();
            radiance.extend(pixels.iter().map(|&[r, g, b, _]| [decode(r), decode(g), decode(b)]));
        }
        Pixels::RgbaF32(pixels) => {
            let (mut negative, mut above) = (0u64, 0u64);
            radiance.extend(pixels.iter().map(|&[r, g, b, _]| {
                let color = [r, g, b];
                let any = |test: fn(f32) -> bool| u64::from(color.into_iter().any(test));
                negative = negative.saturating_add(any(|value| value < 0.0));
                above = above.saturating_add(any(|value| value > MAX_RADIANCE));
                // A picture made by hand may hold a NaN, which `clamp` would keep.
                color.map(|value| if value.is_nan() { 0.0 } else { value.clamp(0.0, MAX_RADIANCE) })
            }));
            if negative > 0 {
                let what = format!("{negative} pixels below 0, taken as 0");
                warnings.add(WarningKind::Dropped, "pixels", || what);
            }
            if above > 0 {
                let what = format!("{above} pixels above {MAX_RADIANCE:e}, taken as that");
                warnings.add(WarningKind::Dropped, "pixels", || what);
            }
        }
    }
    let warnings = earlier.into_iter().chain(warnings.finish()).collect();
    Ok(SkyMap { width, height, radiance, warnings })
}
