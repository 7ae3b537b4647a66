//! Frame data of a picture through a pane: pane, lens and camera.

use downpour_math::ops;
use downpour_math::pyramid::{PyramidLevel, PyramidRounding, pyramid_append, pyramid_levels};
use downpour_shaders::render::glass::{GLASS_PICTURE_BLADES, GLASS_PICTURE_LEVELS};

use super::blade::GlassPictureBlade;
use super::light::GlassPictureLight;
use super::picture::PaneTracer;
use super::water::GlassPictureDrop;
use crate::camera::Camera;

/// Samples of a pixel, at most.
const MAX_SAMPLES: u32 = 1024;

/// Angle between neighbours of a spiral of even density, radians: the golden one.
const GOLDEN: f32 = 2.399_963_2;

/// The plastic number's inverse and its square: places of a plane, evenly spread.
const PLASTIC: [f32; 2] = [0.754_877_7, 0.569_840_3];

/// Constants of all pixels. The same layout as `GlassPictureFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassPictureFrame {
    /// Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    pub unread: u32,
    /// Number of lamps.
    pub lights: u32,
    /// Least radius of the discs of drops that show lamps, m.
    pub lit_from: f32,
    /// Number of wipers.
    pub blade_count: u32,
    /// The camera.
    pub camera: Camera,
    /// The pane's right in the world.
    pub across: [f32; 3],
    /// Bins along x.
    pub columns: u32,
    /// Down the pane.
    pub down: [f32; 3],
    /// Bins along y.
    pub rows: u32,
    /// Out of the pane, away from the eye.
    pub outward: [f32; 3],
    /// Bins in a meter.
    pub bins: f32,
    /// From the eye to the pane's upper left corner, m.
    pub corner: [f32; 3],
    /// Cells of the lattice in a meter.
    pub cells: f32,
    /// Width and height of the pane, m.
    pub size: [f32; 2],
    /// Cells of the lattice.
    pub wet_size: [u32; 2],
    /// Radius of the lens, m.
    pub lens: f32,
    /// Focus: the glass or the scene behind it.
    pub focus: u32,
    /// The reflectance of water.
    pub fresnel: u32,
    /// Light of the eye's side, relative to that of the environment.
    pub room: f32,
    /// Samples of a pixel.
    pub samples: u32,
    /// The coarsest level of the picture.
    pub last: u32,
    /// Texels along an edge of the capture.
    pub capture_size: u32,
    /// Its coarsest level.
    pub capture_last: u32,
    /// Angle of a texel of the capture.
    pub capture_texel: f32,
    /// Height of the film where [`GlassPicture::wet`] is largest, m; 0 for no film.
    pub film: f32,
    /// Refractive index of water.
    pub water: f32,
    /// First row of pixels of a dispatch.
    pub first_row: u32,
    /// Width, height and first texel of each level of the picture.
    pub levels: [[u32; 4]; GLASS_PICTURE_LEVELS as usize],
    /// Wipers.
    pub blades: [GlassPictureBlade; GLASS_PICTURE_BLADES as usize],
}

/// A pane with its drops, ready to be looked through.
#[derive(Clone, Debug, PartialEq)]
pub struct GlassPicture {
    /// Constants of all pixels.
    pub frame: GlassPictureFrame,
    /// The drops.
    pub drops: Vec<GlassPictureDrop>,
    /// Index of the beginning of each bin's list of drops (one more than there are bins), then the lists.
    pub bins: Vec<u32>,
    /// Height of the film of the cells, 65535 for `frame.film`: two to a word.
    pub wet: Vec<u32>,
    /// Samples: a place of the lens, in its radius, and of the pixel.
    pub lens: Vec<[f32; 4]>,
    /// Lamps and the sun, or one that gives no light.
    pub lights: Vec<GlassPictureLight>,
}

impl GlassPicture {
    /// The picture through the pane, on the CPU: the same bits for any number of threads. `behind` is radiance and distance
    /// of what stands behind it, `capture` what is round the eye, all levels; both as a [`Picture`](crate::picture::Picture)
    /// has them.
    #[must_use]
    pub fn through(&self, behind: &[[f32; 4]], capture: &[[f32; 4]]) -> Vec<[f32; 3]> {
        PaneTracer { glass: self, behind: &self.with_levels(behind), capture }.picture()
    }

    /// A picture with its coarser levels.
    pub(crate) fn with_levels(&self, behind: &[[f32; 4]]) -> Vec<[f32; 4]> {
        let mut texels = behind.to_vec();
        for level in self.coarser_levels() {
            pyramid_append(&mut texels, &level);
        }
        texels
    }

    /// Levels of the picture behind the pane, below the finest.
    pub(crate) fn coarser_levels(&self) -> Vec<PyramidLevel> {
        pyramid_levels(self.frame.camera.size(), PyramidRounding::Up)
    }
}

/// Width, height and first texel of each level of a picture, and the number of the coarsest.
pub(super) fn levels([width, height]: [u32; 2]) -> ([[u32; 4]; GLASS_PICTURE_LEVELS as usize], u32) {
    let mut levels = [[0; 4]; GLASS_PICTURE_LEVELS as usize];
    levels[0] = [width, height, 0, 0];
    let mut last = 0;
    for (row, level) in levels[1..].iter_mut().zip(pyramid_levels([width, height], PyramidRounding::Up)) {
        let [columns, rows] = level.size;
        *row = [columns, rows, level.target_texel, 0];
        last += 1;
    }
    (levels, last)
}

/// Places of the lens and of the pixel. A lens of no size has a quarter of the samples.
pub(super) fn samples(grid: u32, lens: f32) -> Vec<[f32; 4]> {
    let open = lens > 0.0;
    let count = (grid * grid * if open { 16 } else { 4 }).clamp(1, MAX_SAMPLES);
    let share = |x: f32| x - x.floor();
    (0..count)
        .map(|k| {
            let radius = if open { ((k as f32 + 0.5) / count as f32).sqrt() } else { 0.0 };
            let angle = GOLDEN * k as f32;
            let pixel = PLASTIC.map(|step| share(0.5 + step * (k + 1) as f32));
            [radius * ops::cos(angle), radius * ops::sin(angle), pixel[0], pixel[1]]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_at_one_texel() {
        for size in [[1, 1], [800, 450], [16_384, 16_384], [16_384, 1], [3, 7]] {
            let (levels, last) = levels(size);
            let [width, height, first, _] = levels[last as usize];
            assert_eq!([width, height], [1, 1], "{size:?}");
            let before: u32 = levels[..last as usize].iter().map(|l| l[0] * l[1]).sum();
            assert_eq!(first, before);
        }
    }

    #[test]
    fn samples_fill_the_lens_and_the_pixel() {
        for (grid, lens) in [(1, 0.0), (2, 1.0e-3), (4, 1.0e-3)] {
            let all = samples(grid, lens);
            let mean = |k: usize| all.iter().map(|s| s[k]).sum::<f32>() / all.len() as f32;
            assert!(mean(0).abs() < 0.1 && mean(1).abs() < 0.1, "{grid}");
            assert!((mean(2) - 0.5).abs() < 0.15 && (mean(3) - 0.5).abs() < 0.15, "{grid}");
            let squared = all.iter().map(|s| s[0] * s[0] + s[1] * s[1]).sum::<f32>() / all.len() as f32;
            assert!((squared - if lens > 0.0 { 0.5 } else { 0.0 }).abs() < 1.0e-3, "{grid}: {squared}");
        }
    }
}
