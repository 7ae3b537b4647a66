//! The sky as light: the map itself, the same at coarser and coarser levels, and its irradiance.
//!
//! Each level has half the texels of the one before along both edges: means over solid angle, so that a ray as wide as a
//! texel finds the light of all that it covers. Irradiance is the projection on spherical harmonics of degree 2
//! (R. Ramamoorthi, P. Hanrahan, SIGGRAPH 2001); it serves where no ray is traced.

use downpour_math::ops;
use downpour_scene::sky::uv_to_direction;
use downpour_shaders::render::scene::SCENE_SKY_LEVELS;
use glam::Vec3;

/// Rows of the coarsest level, at least.
const COARSEST: u32 = 4;

/// Sky map with levels and irradiance, as the shaders read it.
#[derive(Clone, Debug)]
pub struct SkyLight {
    /// Texels of all levels.
    pub texels: Vec<[f32; 4]>,
    /// Width, height and first texel of each level.
    pub levels: [[u32; 4]; SCENE_SKY_LEVELS as usize],
    /// Irradiance over pi as spherical harmonics of degree 2, their factors included.
    pub irradiance: [[f32; 4]; 9],
}

/// A level of the map while it is being filtered.
struct Level {
    width: u32,
    height: u32,
    texels: Vec<Vec3>,
}

impl Level {
    /// The next coarser level: means over the sphere, not over the map. Texels that two of the new ones share count for
    /// both by their parts.
    fn halve(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let (columns, rows) = (parts(self.width, width), parts(self.height, height));
        let texels = rows
            .iter()
            .flat_map(|row| columns.iter().map(move |column| (row, column)))
            .map(|(row, column)| {
                let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
                for &(y, high) in row {
                    let area = row_area(y, self.height) * high;
                    for &(x, wide) in column {
                        sum += self.texels[(y * self.width + x) as usize] * (area * wide);
                        weight += area * wide;
                    }
                }
                sum / weight
            })
            .collect();
        Self { width, height, texels }
    }
}

/// Old texels under each of `new` texels along an edge of `old`, with their parts.
fn parts(old: u32, new: u32) -> Vec<Vec<(u32, f32)>> {
    // In units of an old texel over `new`: whole numbers.
    (0..u64::from(new))
        .map(|k| {
            let [old, new] = [u64::from(old), u64::from(new)];
            let (low, high) = (k * old, (k + 1) * old);
            (low / new..high.div_ceil(new))
                .map(|i| {
                    let inside = high.min((i + 1) * new) - low.max(i * new);
                    (i as u32, inside as f32 / new as f32)
                })
                .collect()
        })
        .collect()
}

/// Solid angle of a texel of row `j`, up to a factor.
fn row_area(j: u32, height: u32) -> f32 {
    ops::sin(std::f32::consts::PI * (j as f32 + 0.5) / height as f32)
}

/// The direction of the middle of a texel.
pub(crate) fn direction_of(x: u32, y: u32, width: u32, height: u32) -> Vec3 {
    uv_to_direction([(x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32]).into()
}

impl SkyLight {
    /// Builds the light of an equirectangular map: rows from the top, +Y up, u = 0.5 + atan2(z, x) / 2 pi.
    ///
    /// # Panics
    /// If the map is empty or its texels are not width times height.
    #[must_use]
    pub fn new(width: u32, height: u32, radiance: &[[f32; 3]]) -> Self {
        assert!(width > 0 && height > 0, "a sky map of {width} x {height}");
        assert_eq!(radiance.len(), width as usize * height as usize, "texels of a sky map");
        let source = Level { width, height, texels: radiance.iter().map(|&c| Vec3::from(c)).collect() };
        let irradiance = irradiance(&source);
        let mut texels: Vec<[f32; 4]> = source.texels.iter().map(|c| [c.x, c.y, c.z, 0.0]).collect();
        let mut levels = [[width, height, 0, 0]; SCENE_SKY_LEVELS as usize];
        let mut level = source;
        for k in 1..levels.len() {
            // Beyond the coarsest level, all are the same.
            levels[k] = levels[k - 1];
            if level.height > COARSEST {
                level = level.halve();
                levels[k] = [level.width, level.height, texels.len() as u32, 0];
                texels.extend(level.texels.iter().map(|c| [c.x, c.y, c.z, 0.0]));
            }
        }
        Self { texels, levels, irradiance }
    }

    /// Builds a sky of uniform radiance.
    #[must_use]
    pub fn uniform(radiance: [f32; 3]) -> Self {
        Self::new(8, 4, &[radiance; 32])
    }
}

/// Irradiance over pi: the map's projection on the nine harmonics, each times its fraction of a cosine lobe.
fn irradiance(map: &Level) -> [[f32; 4]; 9] {
    let mut sums = [[0.0f64; 3]; 9];
    let texel = std::f64::consts::TAU / f64::from(map.width) * std::f64::consts::PI / f64::from(map.height);
    for y in 0..map.height {
        let area = texel * f64::from(row_area(y, map.height));
        for x in 0..map.width {
            let d = direction_of(x, y, map.width, map.height).as_dvec3();
            let radiance = map.texels[(y * map.width + x) as usize].as_dvec3() * area;
            let basis = [
                1.0,
                d.y,
                d.z,
                d.x,
                d.x * d.y,
                d.y * d.z,
                3.0 * d.z * d.z - 1.0,
                d.x * d.z,
                d.x * d.x - d.y * d.y,
            ];
            for (sum, b) in sums.iter_mut().zip(basis) {
                for (s, r) in sum.iter_mut().zip(radiance.to_array()) {
                    *s += r * b;
                }
            }
        }
    }
    // (harmonic's factor)^2 times the cosine lobe's fraction (pi, 2 pi / 3, pi / 4), over pi.
    let pi = std::f64::consts::PI;
    let first = 1.0 / (4.0 * pi);
    let second = 3.0 / (4.0 * pi) * 2.0 / 3.0;
    let third = 15.0 / (4.0 * pi) * 0.25;
    let factors = [
        first,
        second,
        second,
        second,
        third,
        third,
        5.0 / (16.0 * pi) * 0.25,
        third,
        15.0 / (16.0 * pi) * 0.25,
    ];
    std::array::from_fn(|k| {
        let [r, g, b] = sums[k].map(|s| (s * factors[k]) as f32);
        [r, g, b, 0.0]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_uniform_sky_is_uniform_light() {
        let sky = SkyLight::uniform([1.0, 2.0, 3.0]);
        for texel in &sky.texels {
            assert!((texel[0] - 1.0).abs() < 1.0e-4 && (texel[2] - 3.0).abs() < 3.0e-4, "{texel:?}");
        }
        // The first harmonic is the mean; the others vanish up to the coarseness of the map.
        assert!((sky.irradiance[0][1] - 2.0).abs() < 0.06, "{:?}", sky.irradiance[0]);
    }

    /// Every level has the light of the map, whatever its size.
    #[test]
    fn each_level_has_the_mean_of_the_map() {
        for (w, h) in [(64, 32), (100, 50), (37, 19), (1, 32), (9, 64)] {
            let radiance: Vec<[f32; 3]> = (0..w * h).map(|i| [((i * 7919) % 101) as f32, 1.0, 2.0]).collect();
            let sky = SkyLight::new(w, h, &radiance);
            let mean = |[width, height, first, _]: [u32; 4]| {
                let (mut sum, mut weight) = (0.0f64, 0.0f64);
                for y in 0..height {
                    // The exact solid angle of a row.
                    let cosine =
                        |row: u32| ops::f64::cos(std::f64::consts::PI * f64::from(row) / f64::from(height));
                    let area = cosine(y) - cosine(y + 1);
                    for x in 0..width {
                        sum += f64::from(sky.texels[(first + y * width + x) as usize][0]) * area;
                        weight += area;
                    }
                }
                sum / weight
            };
            for level in sky.levels {
                let ratio = mean(level) / mean(sky.levels[0]);
                assert!((ratio - 1.0).abs() < 0.01, "{w} x {h}, {level:?}: {ratio}");
            }
            assert!(sky.levels[SCENE_SKY_LEVELS as usize - 1][1] <= 2 * COARSEST);
        }
    }

    /// A sky that is bright above by cos: the irradiance of a surface that looks up is 2/3 of the peak.
    #[test]
    fn irradiance_of_a_cosine_sky() {
        let (w, h) = (64, 32);
        let radiance: Vec<[f32; 3]> =
            (0..w * h).map(|i| [direction_of(i % w, i / w, w, h).y.max(0.0); 3]).collect();
        let sky = SkyLight::new(w, h, &radiance);
        let up = sky.irradiance[0][0] + sky.irradiance[1][0] - sky.irradiance[6][0] - sky.irradiance[8][0];
        assert!((up - 2.0 / 3.0).abs() < 0.02, "{up}");
    }
}
