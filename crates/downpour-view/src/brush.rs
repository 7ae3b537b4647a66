//! Puddles that are painted on the ground: a mask beside the weather file, and the puddle that has it.

use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};

/// Texels of a mask along an edge.
const TEXELS: usize = 256;

/// Edge of the square that a mask covers, m.
pub const SQUARE_M: f64 = 16.0;

/// Depth of white, mm.
pub const DEPTH_MM: f64 = 12.0;

/// A brush, with the mask that it paints.
#[derive(Clone, Debug)]
pub struct Brush {
    /// True while pointers paint.
    pub is_on: bool,
    /// Radius, m.
    pub radius_m: f64,
    /// The mask of the stroke, once it has begun.
    pub mask: Option<Mask>,
}

impl Default for Brush {
    fn default() -> Self {
        Self { is_on: false, radius_m: 1.0, mask: None }
    }
}

/// Painted depth over a square of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// Middle of the square, m.
    pub center: DVec3,
    /// Depth of each texel, 0 to 255: columns along X, rows along Z.
    depth: Vec<u8>,
}

impl Mask {
    /// A dry square.
    #[must_use]
    pub fn new(center: DVec3) -> Self {
        Self { center, depth: vec![0; TEXELS * TEXELS] }
    }

    /// Paints a round spot, deep in the middle and shallow at its shore.
    pub fn paint(&mut self, at: DVec3, radius_m: f64) {
        let texel = SQUARE_M / TEXELS as f64;
        let corner = DVec2::new(self.center.x, self.center.z) - DVec2::splat(0.5 * SQUARE_M);
        for (index, depth) in self.depth.iter_mut().enumerate() {
            let (column, row) = (index % TEXELS, index / TEXELS);
            let place = corner + DVec2::new(column as f64 + 0.5, row as f64 + 0.5) * texel;
            let part = (place - DVec2::new(at.x, at.z)).length() / radius_m.max(1.0e-3);
            if part < 1.0 {
                let painted = (255.0 * (1.0 - part * part)).round() as u8;
                *depth = (*depth).max(painted);
            }
        }
    }

    /// Volume of the water at the depth of white, m^3.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        let texel = SQUARE_M / TEXELS as f64;
        let sum: f64 = self.depth.iter().map(|&depth| f64::from(depth) / 255.0).sum();
        sum * DEPTH_MM * 1.0e-3 * texel * texel
    }

    /// The mask as the bytes of a PNG.
    ///
    /// # Errors
    /// Message of the encoder.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        use image::ImageEncoder as _;
        let mut bytes = Vec::new();
        let size = TEXELS as u32;
        let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
        encoder
            .write_image(&self.depth, size, size, image::ExtendedColorType::L8)
            .map_err(|e| e.to_string())?;
        Ok(bytes)
    }
}

/// Name for a picture beside a weather file that no file has yet.
#[must_use]
pub fn free_picture(place: &Path) -> PathBuf {
    let stem = place.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = |number: u32| place.with_file_name(format!("{stem}_{number:03}.png"));
    (1..10_000).map(name).find(|path| !path.exists()).unwrap_or_else(|| name(10_000))
}

/// Name for a mask beside a weather file that no file has yet.
#[must_use]
pub fn free_name(place: &Path) -> String {
    let stem = place.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = |number: u32| format!("{stem}_puddle_{number}.png");
    let is_free = |number: &u32| !place.with_file_name(name(*number)).exists();
    name((1..10_000).find(is_free).unwrap_or(10_000))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A paraboloid has half the volume of its cylinder.
    #[test]
    fn a_spot_has_the_volume_of_a_paraboloid() {
        let mut mask = Mask::new(DVec3::new(3.0, 0.1, -2.0));
        let at = DVec3::new(4.0, 0.1, -1.0);
        mask.paint(at, 2.0);
        let expected = 0.5 * std::f64::consts::PI * 4.0 * DEPTH_MM * 1.0e-3;
        assert!((mask.volume_m3() / expected - 1.0).abs() < 0.01);
        let once = mask.clone();
        mask.paint(at, 2.0);
        assert_eq!(mask, once, "painting again does not make it deeper");
        assert!(mask.png().unwrap().starts_with(b"\x89PNG"));
    }
}
