//! Coarser levels of a square map whose edge is a power of two. Twin of `shaders/wgsl/render/reduce.wgsl`.

/// A level that is made of the one before. The same layout as `ReduceLevel` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ReduceLevel {
    /// Texels along an edge of the level that is made.
    pub size: u32,
    /// First texel of the level that is read.
    pub source: u32,
    /// First texel of the level that is made.
    pub target_texel: u32,
    /// 0.
    pub unused: u32,
}

/// The levels below the finest of a map of `size` texels along an edge, down to one texel.
#[must_use]
pub fn reduce_levels(size: u32) -> Vec<ReduceLevel> {
    let mut levels = Vec::new();
    let (mut size, mut source) = (size, 0);
    while size > 1 {
        let target_texel = source + size * size;
        size /= 2;
        levels.push(ReduceLevel { size, source, target_texel, unused: 0 });
        source = target_texel;
    }
    levels
}

/// The mean of the four texels below a texel.
#[must_use]
pub fn reduce_texel(texels: &[[f32; 4]], level: &ReduceLevel, x: u32, y: u32) -> [f32; 4] {
    let edge = level.size * 2;
    let first = level.source + 2 * y * edge + 2 * x;
    let at = |i: u32| texels[i as usize];
    let (a, b, c, d) = (at(first), at(first + 1), at(first + edge), at(first + edge + 1));
    std::array::from_fn(|k| ((a[k] + b[k]) + (c[k] + d[k])) * 0.25)
}

/// Appends all coarser levels to the finest one.
pub(crate) fn reduce(texels: &mut Vec<[f32; 4]>, size: u32) {
    for level in reduce_levels(size) {
        for y in 0..level.size {
            for x in 0..level.size {
                let texel = reduce_texel(texels, &level, x, y);
                texels.push(texel);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_has_the_mean_of_the_map() {
        let mut texels: Vec<[f32; 4]> =
            (0..64).map(|i| [i as f32, 1.0, (i % 8) as f32, (i / 8) as f32]).collect();
        reduce(&mut texels, 8);
        assert_eq!(texels.len(), 64 + 16 + 4 + 1);
        assert_eq!(texels[84], [31.5, 1.0, 3.5, 3.5]);
        assert_eq!(texels[64], [4.5, 1.0, 0.5, 0.5]);
        // The second level begins where the shader looks for it: 4 (N^2 - n^2) / 3.
        assert_eq!(4 * (64 - 4) / 3, 80);
        assert_eq!(texels[80], [13.5, 1.0, 1.5, 1.5]);
    }
}
