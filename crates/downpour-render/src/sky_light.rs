//! The sky as light: the map itself, the same prefiltered for rough reflection, and its irradiance.
//!
//! Rough reflection is the mean of the sky weighted by the GGX lobe of a viewer who looks along the normal (B. Karis,
//! "Real shading in Unreal Engine 4", 2013); irradiance is the projection on spherical harmonics of degree 2
//! (R. Ramamoorthi, P. Hanrahan, SIGGRAPH 2001).

use downpour_math::ops;
use downpour_shaders::render::scene::SCENE_SKY_LEVELS;
use glam::Vec3;
use rayon::prelude::*;

/// Size of the prefiltered levels.
const FILTERED: (u32, u32) = (128, 64);
/// Directions per texel of a prefiltered level.
const SAMPLES: u32 = 96;

/// The sky as the shaders read it.
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
    fn bilinear(&self, direction: Vec3) -> Vec3 {
        let u = 0.5 + ops::atan2(direction.z, direction.x) / std::f32::consts::TAU;
        let horizontal = (direction.x * direction.x + direction.z * direction.z).sqrt();
        let v = 0.5 - ops::atan2(direction.y, horizontal) / std::f32::consts::PI;
        let (w, h) = (self.width as i32, self.height as i32);
        let x = u * w as f32 - 0.5;
        let y = (v * h as f32 - 0.5).clamp(0.0, h as f32 - 1.0);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let column = |k: i32| (x.floor() as i32 + k).rem_euclid(w);
        let row = |k: i32| (y.floor() as i32 + k).min(h - 1);
        let at = |i: i32, j: i32| self.texels[(j * w + i) as usize];
        let top = at(column(0), row(0)) * (1.0 - fx) + at(column(1), row(0)) * fx;
        let bottom = at(column(0), row(1)) * (1.0 - fx) + at(column(1), row(1)) * fx;
        top * (1.0 - fy) + bottom * fy
    }

    /// The next coarser level: means over the sphere, not over the map.
    fn halve(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let (sx, sy) = (self.width / width, self.height / height);
        let texels = (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .map(|(x, y)| {
                let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
                for j in y * sy..(y + 1) * sy {
                    let area = row_area(j, self.height);
                    for i in x * sx..(x + 1) * sx {
                        sum += self.texels[(j * self.width + i) as usize] * area;
                        weight += area;
                    }
                }
                sum / weight
            })
            .collect();
        Self { width, height, texels }
    }
}

/// Solid angle of a texel of row `j`, up to a factor.
fn row_area(j: u32, height: u32) -> f32 {
    ops::sin(std::f32::consts::PI * (j as f32 + 0.5) / height as f32)
}

/// The direction of the middle of a texel.
fn direction_of(x: u32, y: u32, width: u32, height: u32) -> Vec3 {
    let phi = std::f32::consts::TAU * ((x as f32 + 0.5) / width as f32 - 0.5);
    let elevation = std::f32::consts::PI * (0.5 - (y as f32 + 0.5) / height as f32);
    let r = ops::cos(elevation);
    Vec3::new(r * ops::cos(phi), ops::sin(elevation), r * ops::sin(phi))
}

impl SkyLight {
    /// The light of an equirectangular map: rows from the top, +Y up, u = 0.5 + atan2(z, x) / 2 pi.
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
        let mut chain = vec![source];
        while chain[chain.len() - 1].width > 8 && chain[chain.len() - 1].height > 4 {
            let next = chain[chain.len() - 1].halve();
            chain.push(next);
        }
        for (k, level) in levels.iter_mut().enumerate().skip(1) {
            let roughness = k as f32 / (SCENE_SKY_LEVELS - 1) as f32;
            *level = [FILTERED.0, FILTERED.1, texels.len() as u32, 0];
            texels.extend(prefilter(&chain, roughness));
        }
        Self { texels, levels, irradiance }
    }

    /// A sky of one radiance.
    #[must_use]
    pub fn uniform(radiance: [f32; 3]) -> Self {
        Self::new(8, 4, &[radiance; 32])
    }
}

/// A level of the sky as a surface of some roughness reflects it.
fn prefilter(chain: &[Level], roughness: f32) -> Vec<[f32; 4]> {
    let alpha2 = (roughness * roughness) * (roughness * roughness);
    // Microfacet normals at equal shares of the lobe, and the level whose texels are as wide as a share.
    let texel_angle = |level: &Level| std::f32::consts::PI / level.height as f32;
    let lobe: Vec<(Vec3, f32, usize)> = (0..SAMPLES)
        .map(|k| {
            let u = (k as f32 + 0.5) / SAMPLES as f32;
            let phi = std::f32::consts::TAU * ((k as f32 * 0.618_034) % 1.0);
            let cosine2 = (1.0 - u) / (1.0 + (alpha2 - 1.0) * u);
            let (cosine, sine) = (cosine2.sqrt(), (1.0 - cosine2).max(0.0).sqrt());
            let half = Vec3::new(sine * ops::cos(phi), sine * ops::sin(phi), cosine);
            let light = half * (2.0 * cosine) - Vec3::Z;
            let d = alpha2
                / (std::f32::consts::PI
                    * ((cosine2 * (alpha2 - 1.0) + 1.0) * (cosine2 * (alpha2 - 1.0) + 1.0)));
            // The light's density is that of the half vector over 4 cos.
            let share = 1.0 / (SAMPLES as f32 * (d * 0.25).max(1.0e-6));
            let width = share.sqrt();
            let level = chain.iter().position(|l| texel_angle(l) >= width * 0.7).unwrap_or(chain.len() - 1);
            (light, light.z.max(0.0), level)
        })
        .collect();
    (0..FILTERED.0 * FILTERED.1)
        .into_par_iter()
        .map(|i| {
            let normal = direction_of(i % FILTERED.0, i / FILTERED.0, FILTERED.0, FILTERED.1);
            let (tangent, other) = normal.any_orthonormal_pair();
            let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
            for &(light, cosine, level) in &lobe {
                if cosine > 0.0 {
                    let direction = tangent * light.x + other * light.y + normal * light.z;
                    sum += chain[level].bilinear(direction) * cosine;
                    weight += cosine;
                }
            }
            let mean = sum / weight;
            [mean.x, mean.y, mean.z, 0.0]
        })
        .collect()
}

/// Irradiance over pi: the map's projection on the nine harmonics, each times its share of a cosine lobe.
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
    // (harmonic's factor)^2 times the cosine lobe's share (pi, 2 pi / 3, pi / 4), over pi.
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
