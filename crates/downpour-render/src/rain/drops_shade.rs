//! Radiance along one ray through a drop. Twin of `shaders/wgsl/render/drops_shade.wgsl`, where the method is described.

use downpour_math::packing::packing_octahedral_encode;
use downpour_shaders::render::rain::{DROPS_SHIFT, DROPS_STRAIGHT};
use glam::{Vec2, Vec3, Vec4};

use super::drops_frame::DropsView;
use super::drops_mask::DropsTexel;

/// A drop as a ray meets it.
#[derive(Clone, Copy, Debug)]
pub(super) struct DropsShade {
    /// From the eye to the drop's middle, of length 1.
    pub(super) towards: Vec3,
    /// Half the width of its mask, in equivalent radii.
    pub(super) half_extent: f32,
    /// Right of its mask, of length 1.
    pub(super) right: Vec3,
    /// Difference of the ray from `towards` at the same distance along it.
    pub(super) lean: Vec3,
    /// Equivalent radii between samples.
    pub(super) spacing: f32,
    /// Index of its mask, fractional: diameter, elevation.
    pub(super) mask_index: [f32; 2],
}

impl DropsView<'_> {
    /// The position in the papers' capture of a ray, shifted by what the mask says.
    pub(super) fn drops_shade_shifted(&self, ray: Vec3, texel: &DropsTexel) -> Vec2 {
        self.drops_capture_shifted(ray, texel.direction)
    }

    /// Light of a drop at (x, y), in units of half its mask: radiance times coverage, and coverage.
    pub(super) fn drops_shade_ray(&self, drop: &DropsShade, x: f32, y: f32) -> Vec4 {
        self.drops_shade_texel(drop, &self.drops_mask_at(drop.mask_index, x, y), x, y)
    }

    /// The same by the values of the mask there.
    pub(super) fn drops_shade_texel(&self, drop: &DropsShade, texel: &DropsTexel, x: f32, y: f32) -> Vec4 {
        if texel.coverage <= 0.0 {
            return Vec4::ZERO;
        }
        let right = drop.right;
        let up = right.cross(drop.towards);
        // A sphere's deviation 2 (asin q - asin(q / n)) and its derivative, for the footprint.
        let q = ((x * x + y * y) * drop.half_extent * drop.half_extent).min(0.98);
        let bend = 2.0 / (1.0 - q).sqrt();
        if self.frame.form == DROPS_SHIFT {
            let position = self.drops_shade_shifted(drop.towards + drop.lean, texel);
            let sum = self.drops_capture_at(position, drop.spacing * (bend - DROPS_STRAIGHT));
            return sum.extend(1.0) * texel.coverage;
        }
        let rest = (1.0 - texel.transmittance - texel.reflectance - texel.internal_transmittance).max(0.0);
        let mut sum = self.drops_capture_texel(self.frame.capture_last, 0, 0) * rest;
        // Transmitted light, light mirrored at the outside, and light reflected inside.
        for (seen, weight, bends) in [
            (texel.direction, texel.transmittance, bend - DROPS_STRAIGHT),
            (texel.reflected, texel.reflectance, bend),
            (texel.internal, texel.internal_transmittance, (bend - 2.0 * DROPS_STRAIGHT).abs().max(1.0)),
        ] {
            let direction = right * seen.x + up * seen.y - drop.towards * seen.z + drop.lean;
            let position = Vec2::from(packing_octahedral_encode(direction.to_array())) * 0.5 + 0.5;
            sum += self.drops_capture_at(position, drop.spacing * bends) * weight;
        }
        sum.extend(1.0) * texel.coverage
    }
}
