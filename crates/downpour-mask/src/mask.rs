//! Refraction mask and its options.

use crate::{MaskError, View};
use downpour_math::OutOfRange;

/// Smallest and largest number of pixels along an edge of a mask.
pub const SIZES: std::ops::RangeInclusive<u32> = 4..=4096;

/// One texel: the viewer's ray through it after the drop. The same layout as `MaskTexel` in WGSL.
///
/// Directions are in the frame of the view: x right, y up, z toward the viewer. Light that comes straight from
/// behind the drop has the direction (0, 0, -1).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct MaskTexel {
    /// Direction of the scene point seen through the drop, of length 1; 0 in texels that were not traced.
    pub direction: [f32; 3],
    /// Covered fraction of the texel, in [0, 1].
    pub coverage: f32,
    /// Direction of the scene point seen by reflection on the outside, of length 1; 0 in texels that were not traced.
    pub reflected: [f32; 3],
    /// Fraction of unpolarized light transmitted by both interfaces, in [0, 1].
    pub transmittance: f32,
    /// Direction of the scene point seen by light that was reflected inside once without being totally reflected, of
    /// length 1; 0 in texels that were not traced.
    pub internal: [f32; 3],
    /// Fraction of unpolarized light on that path, in [0, 1].
    pub internal_transmittance: f32,
    /// Number of total reflections inside the drop before `direction`; 9 if the light does not leave.
    pub reflections: u32,
    /// Padding of the WGSL layout.
    pub padding: [u32; 3],
}

impl MaskTexel {
    /// Fraction of unpolarized light reflected on the outside: exact Fresnel at the angle between `reflected` and the
    /// viewer. 0 in texels that were not traced.
    #[must_use]
    pub fn reflectance(&self, refractive_index: f32) -> f32 {
        if self.reflected == [0.0; 3] {
            return 0.0;
        }
        // The normal halves the angle between viewer and reflection: cos^2 i = (1 + reflected.z) / 2.
        let cosine = ((1.0 + self.reflected[2]) * 0.5).max(0.0).sqrt();
        let [s, p] = downpour_drop::optics::optics_fresnel_polarized(cosine, refractive_index);
        (s + p) * 0.5
    }
}

/// A square image of the refraction by a drop, seen from one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// Pixels along an edge.
    pub size: u32,
    /// Volume-equivalent diameter in meters.
    pub diameter: f64,
    /// Direction from which the drop is seen.
    pub view: View,
    /// Refractive index of water relative to air.
    pub refractive_index: f64,
    /// Half the width of the image in units of the volume-equivalent radius: the drop's largest half width and a
    /// border of one texel.
    pub half_extent: f64,
    /// Rows from the top, each from the left.
    pub texels: Vec<MaskTexel>,
}

impl Mask {
    /// Width of a texel in units of the volume-equivalent radius.
    #[must_use]
    pub fn texel_width(&self) -> f64 {
        2.0 * self.half_extent / f64::from(self.size)
    }

    /// Texel in column `column` of row `row`.
    ///
    /// # Panics
    /// If either is not below [`Mask::size`].
    #[must_use]
    pub fn texel(&self, column: u32, row: u32) -> &MaskTexel {
        assert!(column < self.size && row < self.size, "texel ({column}, {row}) of a mask of {}", self.size);
        &self.texels[row as usize * self.size as usize + column as usize]
    }

    /// Center of a texel in units of the volume-equivalent radius.
    #[must_use]
    pub fn texel_center(&self, column: u32, row: u32) -> [f64; 2] {
        let middle = f64::from(self.size) * 0.5;
        let width = self.texel_width();
        [(f64::from(column) + 0.5 - middle) * width, (middle - f64::from(row) - 0.5) * width]
    }
}

/// Options of a mask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaskOptions {
    /// Pixels along an edge: 4 to 4096.
    pub size: u32,
    /// Direction from which the drop is seen.
    pub view: View,
    /// Refractive index of water relative to air: above 1, to 4.
    pub refractive_index: f64,
}

impl Default for MaskOptions {
    /// 512 pixels, from the side, water at 20 C for the sodium line (1.3330).
    fn default() -> Self {
        Self { size: 512, view: View::SIDE, refractive_index: 1.333 }
    }
}

impl MaskOptions {
    /// Checks the options.
    ///
    /// # Errors
    /// [`MaskError::Size`] or [`MaskError::OutOfRange`].
    pub fn check(&self) -> Result<(), MaskError> {
        if !SIZES.contains(&self.size) {
            return Err(MaskError::Size { found: self.size, min: *SIZES.start(), max: *SIZES.end() });
        }
        if !(self.refractive_index > 1.0 && self.refractive_index <= 4.0) {
            return Err(MaskError::OutOfRange(OutOfRange {
                quantity: "refractive index",
                found: self.refractive_index,
                unit: "relative to air",
                allowed: "above 1, up to 4".into(),
            }));
        }
        Ok(())
    }
}
