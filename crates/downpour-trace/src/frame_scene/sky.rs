//! The sky of a weather as light.

use downpour_scene::sky::SkyMap;

use crate::sky_light::SkyLight;

/// The least columns and rows from which light is summed up: skies by a formula have a single column, or a single pixel.
const MIN_SIZE: [u32; 2] = [16, 32];

/// Memory per pixel of a map, in bytes, while its light is prepared.
const BYTES_PER_PIXEL: u64 = 48;

/// Memory that [`light`] takes up at most, in bytes.
pub(super) fn bytes(map: &SkyMap) -> u64 {
    let [columns, rows] = repeats(map).map(u64::from);
    (map.radiance.len() as u64).saturating_mul(columns).saturating_mul(rows).saturating_mul(BYTES_PER_PIXEL)
}

/// The light of a map; a map without pixels is a dark sky.
pub(super) fn light(map: &SkyMap) -> SkyLight {
    let (width, height) = (map.width as usize, map.height as usize);
    if width == 0 || height == 0 || map.radiance.len() != width * height {
        return SkyLight::uniform([0.0; 3]);
    }
    let [columns, rows] = repeats(map);
    if columns == 1 && rows == 1 {
        return SkyLight::new(map.width, map.height, &map.radiance);
    }
    let mut finer = Vec::new();
    for row in map.radiance.chunks(width) {
        let wide: Vec<[f32; 3]> =
            row.iter().flat_map(|&pixel| std::iter::repeat_n(pixel, columns as usize)).collect();
        for _ in 0..rows {
            finer.extend_from_slice(&wide);
        }
    }
    SkyLight::new(map.width * columns, map.height * rows, &finer)
}

/// Number of times that each pixel is repeated along a row, and each row down.
fn repeats(map: &SkyMap) -> [u32; 2] {
    [MIN_SIZE[0].div_ceil(map.width.max(1)), MIN_SIZE[1].div_ceil(map.height.max(1))]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Irradiance over pi from the harmonics, for a normal.
    fn irradiance(light: &SkyLight, [x, y, z]: [f32; 3]) -> f32 {
        let basis = [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y];
        light.irradiance.iter().zip(basis).map(|(factor, b)| factor[1] * b).sum()
    }

    /// A uniform sky of radiance L lights every surface with pi L.
    #[test]
    fn a_uniform_sky_lights_all_sides_alike() {
        let light = light(&SkyMap::uniform([1.0, 2.0, 3.0]));
        for normal in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]
        {
            let found = irradiance(&light, normal);
            assert!((found - 2.0).abs() < 0.01, "{normal:?}: {found}");
        }
    }

    /// Moon & Spencer: the ground receives 7 pi / 9 of the zenith's radiance, and walls the same on all sides. The
    /// harmonics of degree 2 have 1 % of error here.
    #[test]
    fn an_overcast_sky_has_no_side() {
        let light = light(&SkyMap::overcast([1.0; 3]));
        let ground = irradiance(&light, [0.0, 1.0, 0.0]);
        assert!((ground - 7.0 / 9.0).abs() < 0.02, "{ground}");
        let walls: Vec<f32> =
            [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8]]
                .map(|normal| irradiance(&light, normal))
                .into();
        for wall in &walls {
            assert!((wall - walls[0]).abs() < 1.0e-3, "{walls:?}");
        }
    }

    #[test]
    fn a_map_without_pixels_is_dark() {
        let none = SkyMap { width: 0, height: 0, radiance: Vec::new(), warnings: Vec::new() };
        assert!(light(&none).texels.iter().all(|texel| texel[0] == 0.0));
    }
}
