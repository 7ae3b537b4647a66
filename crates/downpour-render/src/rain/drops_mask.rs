//! Masks between their texels, diameters and elevations. Twin of `shaders/wgsl/render/drops_mask.wgsl`.

use downpour_math::packing::{packing_octahedral_decode, packing_unpack_snorm, packing_unpack_unorm};
use downpour_shaders::render::rain::{DROPS_ELEVATIONS, DROPS_TEXEL_WORDS};
use glam::Vec3;

use super::drops_frame::DropsView;

/// Values of a mask at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DropsTexel {
    pub(super) direction: Vec3,
    pub(super) coverage: f32,
    pub(super) reflected: Vec3,
    pub(super) transmittance: f32,
    /// Direction of the light that is reflected inside once.
    pub(super) internal: Vec3,
    pub(super) internal_transmittance: f32,
    /// Fraction that is reflected outside.
    pub(super) reflectance: f32,
}

/// A vector of length 1, or the vector itself if it has none.
pub(super) fn drops_mask_unit(v: Vec3) -> Vec3 {
    v / v.dot(v).sqrt().max(1.0e-20)
}

/// Adds a weighted texel to a sum. Texels outside the drop have no direction to add.
fn drops_mask_add(sum: DropsTexel, texel: DropsTexel, weight: f32) -> DropsTexel {
    let covered = weight * texel.coverage;
    DropsTexel {
        direction: sum.direction + texel.direction * covered,
        coverage: sum.coverage + covered,
        reflected: sum.reflected + texel.reflected * covered,
        transmittance: sum.transmittance + texel.transmittance * covered,
        internal: sum.internal + texel.internal * covered,
        internal_transmittance: sum.internal_transmittance + texel.internal_transmittance * covered,
        reflectance: sum.reflectance + texel.reflectance * covered,
    }
}

/// Normalizes a sum of weighted texels.
fn drops_mask_mean(sum: DropsTexel) -> DropsTexel {
    let whole = sum.coverage.max(1.0e-20);
    DropsTexel {
        direction: drops_mask_unit(sum.direction),
        coverage: sum.coverage,
        reflected: drops_mask_unit(sum.reflected),
        transmittance: sum.transmittance / whole,
        internal: drops_mask_unit(sum.internal),
        internal_transmittance: sum.internal_transmittance / whole,
        reflectance: sum.reflectance / whole,
    }
}

impl DropsView<'_> {
    /// A texel of a mask.
    fn drops_mask_texel(&self, layer: u32, column: i32, row: i32) -> DropsTexel {
        let last = self.frame.mask_size as i32 - 1;
        let (x, y) = (column.clamp(0, last) as u32, row.clamp(0, last) as u32);
        let at =
            (((layer * self.frame.mask_size + y) * self.frame.mask_size + x) * DROPS_TEXEL_WORDS) as usize;
        let direction =
            |word: usize| packing_octahedral_decode(packing_unpack_snorm(self.masks[at + word])).into();
        let [coverage, transmittance] = packing_unpack_unorm(self.masks[at + 3]);
        let [internal_transmittance, reflectance] = packing_unpack_unorm(self.masks[at + 4]);
        DropsTexel {
            direction: direction(0),
            coverage,
            reflected: direction(1),
            transmittance,
            internal: direction(2),
            internal_transmittance,
            reflectance,
        }
    }

    /// A mask between its texels: sums weighted by coverage. (u, v) in [0, 1] from the top left.
    fn drops_mask_layer(&self, sum: DropsTexel, layer: u32, u: f32, v: f32, weight: f32) -> DropsTexel {
        let x = u * self.frame.mask_size as f32 - 0.5;
        let y = v * self.frame.mask_size as f32 - 0.5;
        let (left, top) = (x.floor() as i32, y.floor() as i32);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let texel = |column, row| self.drops_mask_texel(layer, column, row);
        let s = drops_mask_add(sum, texel(left, top), weight * (1.0 - fx) * (1.0 - fy));
        let s = drops_mask_add(s, texel(left + 1, top), weight * fx * (1.0 - fy));
        let s = drops_mask_add(s, texel(left, top + 1), weight * (1.0 - fx) * fy);
        drops_mask_add(s, texel(left + 1, top + 1), weight * fx * fy)
    }

    /// Values of the masks for a drop at (x, y) in units of half the mask, right and up, interpolated between diameters and
    /// elevations.
    pub(super) fn drops_mask_at(&self, row: [f32; 2], x: f32, y: f32) -> DropsTexel {
        let (u, v) = (0.5 + 0.5 * x, 0.5 - 0.5 * y);
        let low = row.map(f32::floor);
        let part = [row[0] - low[0], row[1] - low[1]];
        let first = low[0] as u32 * DROPS_ELEVATIONS + low[1] as u32;
        let mut sum = DropsTexel::default();
        // Two elevations of two diameters.
        for k in 0..4 {
            let of_diameter = if k >= 2 { part[0] } else { 1.0 - part[0] };
            let weight = of_diameter * if k & 1 == 1 { part[1] } else { 1.0 - part[1] };
            if weight > 0.0 {
                let layer = first + (k / 2) * DROPS_ELEVATIONS + (k & 1);
                sum = self.drops_mask_layer(sum, layer, u, v, weight);
            }
        }
        drops_mask_mean(sum)
    }
}
