//! Mip pyramid: the coarser levels of a map, each of about half the size of the one before. Twin of
//! `shaders/wgsl/common/pyramid.wgsl`.
//!
//! A texel is the mean of the four below it; where an odd size leaves a row or column over, the last one counts twice. All
//! levels lie in one list, the finest first, rows from the top.

/// A level of a pyramid, and the one that it is made of. The same layout as `PyramidLevel` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PyramidLevel {
    /// Columns and rows of the level that is made.
    pub size: [u32; 2],
    /// Columns and rows of the level that it is made of.
    pub source_size: [u32; 2],
    /// First texel of the level that is read.
    pub source: u32,
    /// First texel of the level that is made.
    pub target_texel: u32,
    /// 0.
    pub unused: [u32; 2],
}

/// Rounding of half an odd size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PyramidRounding {
    /// To the next smaller size, as textures of graphics APIs have it.
    Down,
    /// To the next larger size, so that each texel of a level lies below exactly one of the next.
    Up,
}

impl PyramidRounding {
    fn half(self, edge: u32) -> u32 {
        match self {
            Self::Down => (edge / 2).max(1),
            Self::Up => edge.div_ceil(2),
        }
    }
}

/// Levels below the finest of a map of `size` columns and rows, down to one texel.
///
/// ```
/// use downpour_math::pyramid::{PyramidRounding, pyramid_levels};
/// let levels = pyramid_levels([5, 2], PyramidRounding::Up);
/// assert_eq!(levels.iter().map(|level| level.size).collect::<Vec<_>>(), [[3, 1], [2, 1], [1, 1]]);
/// assert_eq!(levels.iter().map(|level| level.target_texel).collect::<Vec<_>>(), [10, 13, 15]);
/// ```
#[must_use]
pub fn pyramid_levels(size: [u32; 2], rounding: PyramidRounding) -> Vec<PyramidLevel> {
    let mut levels = Vec::new();
    let (mut source_size, mut source) = (size, 0);
    while source_size[0].max(source_size[1]) > 1 {
        let target_texel = source + source_size[0] * source_size[1];
        let size = source_size.map(|edge| rounding.half(edge));
        levels.push(PyramidLevel { size, source_size, source, target_texel, unused: [0; 2] });
        (source_size, source) = (size, target_texel);
    }
    levels
}

/// Mean of the four texels below a texel of a level.
#[must_use]
pub fn pyramid_texel<const N: usize>(texels: &[[f32; N]], level: &PyramidLevel, x: u32, y: u32) -> [f32; N] {
    let [edge, rows] = level.source_size;
    let (left, right) = (2 * x, (2 * x + 1).min(edge - 1));
    let [upper, lower] = [2 * y, (2 * y + 1).min(rows - 1)].map(|row| level.source + row * edge);
    let at = |i: u32| texels[i as usize];
    let [a, b, c, d] = [at(upper + left), at(upper + right), at(lower + left), at(lower + right)];
    std::array::from_fn(|k| (((a[k] + b[k]) + c[k]) + d[k]) * 0.25)
}

/// Appends a level to those that it is made of.
pub fn pyramid_append<const N: usize>(texels: &mut Vec<[f32; N]>, level: &PyramidLevel) {
    for y in 0..level.size[1] {
        for x in 0..level.size[0] {
            let texel = pyramid_texel(texels, level, x, y);
            texels.push(texel);
        }
    }
}

/// Appends all coarser levels to the finest one.
pub fn pyramid<const N: usize>(texels: &mut Vec<[f32; N]>, size: [u32; 2], rounding: PyramidRounding) {
    for level in pyramid_levels(size, rounding) {
        pyramid_append(texels, &level);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_has_the_mean_of_the_map() {
        let mut texels: Vec<[f32; 4]> =
            (0..64).map(|i| [i as f32, 1.0, (i % 8) as f32, (i / 8) as f32]).collect();
        pyramid(&mut texels, [8, 8], PyramidRounding::Down);
        assert_eq!(texels.len(), 64 + 16 + 4 + 1);
        assert_eq!(texels[84], [31.5, 1.0, 3.5, 3.5]);
        assert_eq!(texels[64], [4.5, 1.0, 0.5, 0.5]);
        // The second level begins where the shaders look for it: 4 (N^2 - n^2) / 3.
        assert_eq!(4 * (64 - 4) / 3, 80);
        assert_eq!(texels[80], [13.5, 1.0, 1.5, 1.5]);
    }

    #[test]
    fn the_last_column_of_an_odd_size_counts_twice() {
        let mut texels = vec![[1.0], [3.0], [8.0]];
        pyramid(&mut texels, [3, 1], PyramidRounding::Up);
        assert_eq!(texels[3..], [[2.0], [8.0], [5.0]]);
        let mut texels = vec![[1.0], [3.0], [8.0]];
        pyramid(&mut texels, [3, 1], PyramidRounding::Down);
        assert_eq!(texels[3..], [[2.0]]);
    }
}
