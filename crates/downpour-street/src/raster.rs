//! Pictures for textures: computed from a function of the tile, encoded as JPEG or PNG.

use downpour_math::color::linear_to_srgb;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

/// A tile of linear values, four per texel.
#[derive(Clone, Debug)]
pub(crate) struct Raster {
    width: u32,
    height: u32,
    texels: Vec<[f32; 4]>,
}

/// File formats of textures.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Format {
    /// Gray JPEG of colors: sRGB.
    GrayColor,
    /// JPEG of colors: sRGB.
    Color,
    /// Gray JPEG of numbers: linear.
    GrayData,
    /// JPEG of numbers: linear.
    Data,
    /// PNG of colors with coverage.
    Cutout,
    /// Gray PNG of numbers: linear.
    Mask,
}

/// Quality of JPEG files: errors stay below the noise of the surfaces.
const QUALITY: u8 = 80;

impl Raster {
    /// Makes a tile of a function of the coordinates of texels' centers, in [0, 1) from the upper left.
    pub(crate) fn new(width: u32, height: u32, texel: impl Fn(f32, f32) -> [f32; 4]) -> Self {
        let texels = (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .map(|(x, y)| texel((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32))
            .collect();
        Self { width, height, texels }
    }

    /// A tile of one value per texel.
    pub(crate) fn gray(width: u32, height: u32, texel: impl Fn(f32, f32) -> f32) -> Self {
        Self::new(width, height, |u, v| {
            let value = texel(u, v);
            [value, value, value, 1.0]
        })
    }

    /// Normal map of a surface whose heights are the first component, in meters; `width_m` is the edge of the tile.
    ///
    /// Slopes are central differences; the tile repeats. Green points up (to smaller v), as in glTF.
    pub(crate) fn normals(&self, width_m: f32) -> Self {
        let (w, h) = (self.width as i32, self.height as i32);
        let at = |x: i32, y: i32| self.texels[(y.rem_euclid(h) * w + x.rem_euclid(w)) as usize][0];
        let scale = w as f32 / (2.0 * width_m);
        let texels = (0..h)
            .flat_map(|y| (0..w).map(move |x| (x, y)))
            .map(|(x, y)| {
                let dx = (at(x + 1, y) - at(x - 1, y)) * scale;
                let dy = (at(x, y - 1) - at(x, y + 1)) * scale;
                let length = (1.0 + dx * dx + dy * dy).sqrt();
                [-dx / length * 0.5 + 0.5, -dy / length * 0.5 + 0.5, 1.0 / length * 0.5 + 0.5, 1.0]
            })
            .collect();
        Self { width: self.width, height: self.height, texels }
    }

    /// Number of texels.
    pub(crate) fn texel_count(&self) -> usize {
        self.texels.len()
    }

    /// Mean of the first three components.
    #[cfg(test)]
    pub(crate) fn mean(&self) -> [f32; 3] {
        let n = self.texels.len() as f32;
        std::array::from_fn(|k| self.texels.iter().map(|t| t[k]).sum::<f32>() / n)
    }

    /// Least and largest value of the second component, and its standard deviation.
    #[cfg(test)]
    pub(crate) fn spread(&self) -> [f32; 3] {
        let (mean, n) = (self.mean()[1], self.texels.len() as f32);
        let of = || self.texels.iter().map(|texel| texel[1]);
        let variance = of().map(|value| (value - mean) * (value - mean)).sum::<f32>() / n;
        [of().fold(f32::MAX, f32::min), of().fold(f32::MIN, f32::max), variance.sqrt()]
    }

    /// The bytes of the file.
    pub(crate) fn encode(&self, format: Format) -> Result<Vec<u8>, String> {
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        let color = |v: f32| byte(linear_to_srgb(v.clamp(0.0, 1.0)));
        let (w, h) = (self.width, self.height);
        let mut bytes = Vec::new();
        let texels = self.texels.iter();
        let done = match format {
            Format::GrayColor | Format::GrayData => {
                let is_color = matches!(format, Format::GrayColor);
                let gray: Vec<u8> = texels.map(|t| if is_color { color(t[0]) } else { byte(t[0]) }).collect();
                jpeg(&mut bytes).write_image(&gray, w, h, ExtendedColorType::L8)
            }
            Format::Color | Format::Data => {
                let is_color = matches!(format, Format::Color);
                let rgb: Vec<u8> = texels
                    .flat_map(|t| [t[0], t[1], t[2]].map(|v| if is_color { color(v) } else { byte(v) }))
                    .collect();
                jpeg(&mut bytes).write_image(&rgb, w, h, ExtendedColorType::Rgb8)
            }
            Format::Mask => {
                let gray: Vec<u8> = texels.map(|t| byte(t[0])).collect();
                png(&mut bytes).write_image(&gray, w, h, ExtendedColorType::L8)
            }
            Format::Cutout => {
                let rgba: Vec<u8> =
                    texels.flat_map(|t| [color(t[0]), color(t[1]), color(t[2]), byte(t[3])]).collect();
                png(&mut bytes).write_image(&rgba, w, h, ExtendedColorType::Rgba8)
            }
        };
        done.map_err(|error| error.to_string())?;
        Ok(bytes)
    }
}

fn jpeg(bytes: &mut Vec<u8>) -> JpegEncoder<&mut Vec<u8>> {
    JpegEncoder::new_with_quality(bytes, QUALITY)
}

fn png(bytes: &mut Vec<u8>) -> PngEncoder<&mut Vec<u8>> {
    PngEncoder::new_with_quality(bytes, CompressionType::Best, FilterType::Adaptive)
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_scene::Budget;
    use downpour_scene::picture::{Pixels, decode};

    #[test]
    fn a_slope_has_the_normal_of_its_rise() {
        // Height x / 10 along a tile of 1 m: the normal leans to -x by 0.1.
        let slope = Raster::gray(32, 8, |u, _| u / 10.0).normals(1.0);
        let [x, y, z, _] = slope.texels[8 * 16 + 16];
        let wanted = 1.0 / (1.01f32).sqrt();
        assert!((x * 2.0 - 1.0 + 0.1 * wanted).abs() < 1e-5 && (y - 0.5).abs() < 1e-6);
        assert!((z * 2.0 - 1.0 - wanted).abs() < 1e-5);
    }

    #[test]
    fn a_color_comes_back_from_its_file() {
        let made = Raster::new(16, 16, |_, _| [0.2, 0.5, 0.05, 0.5]);
        for (name, format, alpha) in [("a.jpg", Format::Color, 255), ("a.png", Format::Cutout, 128)] {
            let bytes = made.encode(format).expect("encoded");
            let picture = decode(name, &bytes, &mut Budget::default()).expect("a picture");
            let Pixels::Rgba8(pixels) = picture.pixels else { panic!("8 bits") };
            // IEC 61966-2-1: 0.2, 0.5 and 0.05 are 124, 188 and 63.
            for (found, wanted) in pixels[40].into_iter().zip([124, 188, 63, alpha]) {
                assert!(i32::from(found).abs_diff(wanted) <= 2, "{name}: {:?}", pixels[40]);
            }
        }
    }
}
