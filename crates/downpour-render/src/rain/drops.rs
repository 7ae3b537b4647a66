//! Drops as refractive particles that face the camera. Twin of `shaders/wgsl/render/drops.wgsl`, where the method is
//! described.

use downpour_math::ops;
use downpour_math::packing::{
    packing_octahedral_decode, packing_octahedral_encode, packing_unpack_snorm, packing_unpack_unorm,
};
use downpour_shaders::render::rain::{
    DROPS_DIRECTION, DROPS_ELEVATIONS, DROPS_OPAQUE, DROPS_SHIFT, DROPS_SKY, DROPS_SMALL_GRID,
    DROPS_STRAIGHT, DROPS_TEXEL_WORDS, DROPS_TILE, DROPS_VEIL_NEAR, DROPS_VEIL_QUARTERS, DROPS_VEIL_SPREAD,
};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::capture::{Capture, CaptureFrame};
use super::{DropMasks, Rain, Veil};
use crate::data::RenderFrame;

/// The picture as the drops' shader knows it. The same layout as `DropsFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct DropsFrame {
    /// The camera's axes: half the picture at distance 1.
    pub right: [f32; 3],
    /// Pixels across.
    pub width: u32,
    /// See `right`.
    pub up: [f32; 3],
    /// Pixels down.
    pub height: u32,
    /// The view direction.
    pub forward: [f32; 3],
    /// Width of a pixel at distance 1.
    pub pixel_angle: f32,
    /// Axes of the capture in the papers' form: the whole of it at distance 1.
    pub capture_right: [f32; 3],
    /// Texels along an edge of the capture.
    pub capture_size: u32,
    /// See `capture_right`.
    pub capture_up: [f32; 3],
    /// The coarsest level of the capture.
    pub capture_last: u32,
    /// The view direction of the capture.
    pub capture_forward: [f32; 3],
    /// Angle of a texel of the capture.
    pub capture_texel: f32,
    /// The form of refraction.
    pub form: u32,
    /// Texels along an edge of a mask.
    pub mask_size: u32,
    /// Tiles across the picture.
    pub tiles_across: u32,
    /// What the optical depth grows by beyond the table, 1/m.
    pub veil_beyond: f32,
    /// Optical depths of the drops that are not drawn ([`Veil`]).
    pub veil: [[f32; 4]; DROPS_VEIL_QUARTERS as usize],
}

/// A drop on the picture. The same layout as `DropsDrop` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct DropsDrop {
    /// From the eye to the drop's middle, of length 1.
    pub towards: [f32; 3],
    /// Metres from the eye.
    pub distance: f32,
    /// Place of the middle on the picture, pixels from the top left.
    pub place: [f32; 2],
    /// Equivalent radius over distance.
    pub slope: f32,
    /// Half the width of its mask, in equivalent radii.
    pub half_extent: f32,
    /// Place in the masks: rows of diameters, and of elevations.
    pub row: [f32; 2],
    /// Area on the picture, pixels.
    pub area: f32,
    /// Samples along an edge of a pixel; 0: the drop is below a pixel.
    pub grid: u32,
}

impl DropsFrame {
    pub(crate) fn new(
        picture: &RenderFrame,
        capture: &CaptureFrame,
        masks: &DropMasks,
        tiles_across: u32,
        veil: &Veil,
    ) -> Self {
        Self {
            right: picture.right,
            width: picture.width,
            up: picture.up,
            height: picture.height,
            forward: picture.forward,
            pixel_angle: picture.pixel_angle,
            capture_right: capture.frame.right,
            capture_size: capture.frame.width,
            capture_up: capture.frame.up,
            capture_last: capture.frame.width.ilog2(),
            capture_forward: capture.frame.forward,
            capture_texel: capture.frame.pixel_angle,
            form: capture.form as u32,
            mask_size: masks.size,
            tiles_across,
            veil_beyond: veil.beyond,
            veil: veil.table(),
        }
    }
}

/// The optical depth of the drops that are not drawn, up to a distance in metres.
#[must_use]
pub fn drops_veil(frame: &DropsFrame, distance: f32) -> f32 {
    let last = 4 * DROPS_VEIL_QUARTERS - 1;
    let position = 3.0 * ops::log2((distance / DROPS_VEIL_NEAR).max(1.0));
    let entry = (position as u32).min(last);
    let next = (entry + 1).min(last);
    let at = |k: u32| frame.veil[(k / 4) as usize][(k % 4) as usize];
    let farthest = DROPS_VEIL_NEAR * ops::exp2(last as f32 / 3.0);
    at(entry)
        + (at(next) - at(entry)) * (position - entry as f32).min(1.0)
        + frame.veil_beyond * (distance - farthest).max(0.0)
}

/// What a mask says.
#[derive(Clone, Copy, Debug, Default)]
struct DropsTexel {
    direction: Vec3,
    coverage: f32,
    reflected: Vec3,
    transmittance: f32,
}

/// What the kernel reads.
struct Buffers<'a> {
    frame: &'a DropsFrame,
    rain: &'a Rain,
    masks: &'a [u32],
    capture: &'a [[f32; 4]],
    clean: &'a [[f32; 4]],
}

/// A vector of length 1, or the vector itself if it has none.
fn drops_unit(v: Vec3) -> Vec3 {
    v / v.dot(v).sqrt().max(1.0e-20)
}

/// Adds a weighted texel to a sum. Texels outside the drop have no direction to add.
fn drops_add(sum: DropsTexel, texel: DropsTexel, weight: f32) -> DropsTexel {
    let covered = weight * texel.coverage;
    DropsTexel {
        direction: sum.direction + texel.direction * covered,
        coverage: sum.coverage + covered,
        reflected: sum.reflected + texel.reflected * covered,
        transmittance: sum.transmittance + texel.transmittance * covered,
    }
}

/// The right of the view of a drop whose axis is the world's vertical.
#[must_use]
pub fn drops_right(towards: Vec3) -> Vec3 {
    let sideways = Vec3::new(-towards.z, 0.0, towards.x);
    let level = sideways.dot(sideways);
    if level > 1.0e-12 { sideways / level.max(1.0e-20).sqrt() } else { Vec3::X }
}

impl Buffers<'_> {
    /// A texel of a mask.
    fn drops_mask_texel(&self, layer: u32, column: i32, row: i32) -> DropsTexel {
        let last = self.frame.mask_size as i32 - 1;
        let (x, y) = (column.clamp(0, last) as u32, row.clamp(0, last) as u32);
        let at =
            (((layer * self.frame.mask_size + y) * self.frame.mask_size + x) * DROPS_TEXEL_WORDS) as usize;
        let [coverage, transmittance] = packing_unpack_unorm(self.masks[at + 2]);
        DropsTexel {
            direction: packing_octahedral_decode(packing_unpack_snorm(self.masks[at])).into(),
            coverage,
            reflected: packing_octahedral_decode(packing_unpack_snorm(self.masks[at + 1])).into(),
            transmittance,
        }
    }

    /// A mask between its texels: sums weighted by coverage. (u, v) in [0, 1] from the top left.
    fn drops_mask_layer(&self, sum: DropsTexel, layer: u32, u: f32, v: f32, weight: f32) -> DropsTexel {
        let x = u * self.frame.mask_size as f32 - 0.5;
        let y = v * self.frame.mask_size as f32 - 0.5;
        let (left, top) = (x.floor() as i32, y.floor() as i32);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let texel = |column, row| self.drops_mask_texel(layer, column, row);
        let s = drops_add(sum, texel(left, top), weight * (1.0 - fx) * (1.0 - fy));
        let s = drops_add(s, texel(left + 1, top), weight * fx * (1.0 - fy));
        let s = drops_add(s, texel(left, top + 1), weight * (1.0 - fx) * fy);
        drops_add(s, texel(left + 1, top + 1), weight * fx * fy)
    }

    /// What the masks say for a drop at (x, y) in units of half the mask, up and right: between diameters and elevations.
    fn drops_mask(&self, row: [f32; 2], x: f32, y: f32) -> DropsTexel {
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
        DropsTexel {
            direction: drops_unit(sum.direction),
            coverage: sum.coverage,
            reflected: drops_unit(sum.reflected),
            transmittance: sum.transmittance / sum.coverage.max(1.0e-20),
        }
    }

    /// A texel of a level of the capture. Beyond an edge the octahedral map goes on at the edge's mirror image.
    fn drops_capture_texel(&self, level: u32, column: i32, row: i32) -> Vec3 {
        let whole = self.frame.capture_size;
        let size = whole >> level;
        let edge = size as i32;
        let (mut x, mut y) = (column, row);
        if self.frame.form == DROPS_DIRECTION {
            if x < 0 || x >= edge {
                x = x.clamp(0, edge - 1);
                y = edge - 1 - y;
            }
            if y < 0 || y >= edge {
                y = y.clamp(0, edge - 1);
                x = edge - 1 - x;
            }
        }
        let (x, y) = (x.clamp(0, edge - 1) as u32, y.clamp(0, edge - 1) as u32);
        let first = 4 * (whole * whole - size * size) / 3;
        Vec4::from(self.capture[(first + y * size + x) as usize]).truncate()
    }

    /// A level of the capture at a place of [0, 1], bilinear.
    fn drops_capture_level(&self, level: u32, place: Vec2) -> Vec3 {
        let size = (self.frame.capture_size >> level) as f32;
        let (x, y) = (place.x * size - 0.5, place.y * size - 0.5);
        let (left, top) = (x.floor() as i32, y.floor() as i32);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let texel = |column, row| self.drops_capture_texel(level, column, row);
        let upper = texel(left, top) * (1.0 - fx) + texel(left + 1, top) * fx;
        let lower = texel(left, top + 1) * (1.0 - fx) + texel(left + 1, top + 1) * fx;
        upper * (1.0 - fy) + lower * fy
    }

    /// The capture at a place of [0, 1], for a footprint of some angle.
    fn drops_capture_at(&self, place: Vec2, footprint: f32) -> Vec3 {
        let last = self.frame.capture_last as f32;
        let level = ops::log2((footprint / self.frame.capture_texel).max(1.0e-6)).clamp(0.0, last);
        let low = level.floor();
        let part = level - low;
        let near = self.drops_capture_level(low as u32, place) * (1.0 - part);
        if part == 0.0 {
            return near;
        }
        near + self.drops_capture_level(low as u32 + 1, place) * part
    }

    /// The place in the papers' capture of a ray, shifted by what the mask says: the refracted ray meets the plane of the
    /// capture as far from the ray's own place as the tangent of its deviation.
    fn drops_shifted(&self, ray: Vec3, texel: &DropsTexel) -> Vec2 {
        let frame = self.frame;
        let [right, up, forward] =
            [frame.capture_right, frame.capture_up, frame.capture_forward].map(Vec3::from);
        let depth = ray.dot(forward).max(1.0e-3);
        let deep = (-texel.direction.z).max(1.0e-3);
        let shift = Vec2::new(
            texel.direction.x / deep / right.dot(right).sqrt(),
            texel.direction.y / deep / up.dot(up).sqrt(),
        );
        let place = Vec2::new(ray.dot(right) / right.dot(right), ray.dot(up) / up.dot(up)) / depth + shift;
        Vec2::new(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y).clamp(Vec2::ZERO, Vec2::ONE)
    }

    /// The ray through a place of the picture, in pixels from the top left, of any length.
    fn drops_ray(&self, x: f32, y: f32) -> Vec3 {
        let frame = self.frame;
        let u = 2.0 * x / frame.width as f32 - 1.0;
        let v = 1.0 - 2.0 * y / frame.height as f32;
        Vec3::from(frame.forward) + Vec3::from(frame.right) * u + Vec3::from(frame.up) * v
    }

    /// What a drop shows at (x, y), in units of half its mask, for samples that are `spacing` equivalent radii apart:
    /// radiance times coverage, and coverage. `lean` is what the ray differs from the ray to the drop's middle.
    fn drops_sample(&self, drop: &DropsDrop, x: f32, y: f32, lean: Vec3, spacing: f32) -> Vec4 {
        let texel = self.drops_mask(drop.row, x, y);
        if texel.coverage <= 0.0 {
            return Vec4::ZERO;
        }
        let towards = Vec3::from(drop.towards);
        let right = drops_right(towards);
        let up = right.cross(towards);
        // A sphere's deviation 2 (asin q - asin(q / n)) and its derivative, for the footprint.
        let q = ((x * x + y * y) * drop.half_extent * drop.half_extent).min(0.98);
        let bend = 2.0 / (1.0 - q).sqrt();
        if self.frame.form == DROPS_SHIFT {
            let place = self.drops_shifted(towards + lean, &texel);
            let radiance = self.drops_capture_at(place, spacing * (bend - DROPS_STRAIGHT));
            return radiance.extend(1.0) * texel.coverage;
        }
        let mut sum = Vec3::ZERO;
        // What comes through, then what is mirrored.
        let shares = [
            (texel.direction, texel.transmittance, bend - DROPS_STRAIGHT),
            (texel.reflected, 1.0 - texel.transmittance, bend),
        ];
        for (seen, weight, spread) in shares {
            let direction = right * seen.x + up * seen.y - towards * seen.z + lean;
            let place = Vec2::from(packing_octahedral_encode(direction.to_array())) * 0.5 + 0.5;
            sum += self.drops_capture_at(place, spacing * spread) * weight;
        }
        sum.extend(1.0) * texel.coverage
    }

    /// The share of a pixel that a drop of less than a pixel covers: its area, over the pixels round its middle.
    fn drops_spread(drop: &DropsDrop, x: u32, y: u32) -> f32 {
        let wx = (1.0 - (x as f32 + 0.5 - drop.place[0]).abs()).max(0.0);
        let wy = (1.0 - (y as f32 + 0.5 - drop.place[1]).abs()).max(0.0);
        (drop.area * wx * wy).min(1.0)
    }

    /// A drop over a pixel: radiance times coverage, and coverage. Below a pixel it is its mean radiance.
    fn drops_pixel(&self, drop: &DropsDrop, x: u32, y: u32) -> Vec4 {
        let small = drop.grid == 0;
        let spread = Self::drops_spread(drop, x, y);
        if small && spread <= 0.0 {
            return Vec4::ZERO;
        }
        let towards = Vec3::from(drop.towards);
        let right = drops_right(towards);
        let up = right.cross(towards);
        let n = if small { DROPS_SMALL_GRID } else { drop.grid };
        let extent = drop.half_extent * drop.slope;
        let spacing = if small {
            2.0 * drop.half_extent / n as f32
        } else {
            self.frame.pixel_angle / (drop.slope * n as f32)
        };
        let mut sum = Vec4::ZERO;
        for k in 0..n * n {
            let dx = ((k % n) as f32 + 0.5) / n as f32;
            let dy = ((k / n) as f32 + 0.5) / n as f32;
            let (mut sx, mut sy, mut lean) = (2.0 * dx - 1.0, 2.0 * dy - 1.0, Vec3::ZERO);
            if !small {
                let ray = self.drops_ray(x as f32 + dx, y as f32 + dy);
                let depth = ray.dot(towards).max(1.0e-6);
                lean = ray / depth - towards;
                sx = lean.dot(right) / extent;
                sy = lean.dot(up) / extent;
            }
            if sx.abs() < 1.0 && sy.abs() < 1.0 {
                sum += self.drops_sample(drop, sx, sy, lean, spacing);
            }
        }
        if small {
            return (sum.truncate() / sum.w.max(1.0e-20)).extend(1.0) * spread;
        }
        sum / (n * n) as f32
    }

    /// What drops that are not drawn show before a pixel, and what is left of what is behind them.
    fn drops_veiled(&self, x: u32, y: u32, distance: f32) -> Vec4 {
        if distance >= DROPS_SKY {
            return Vec4::W;
        }
        let left = ops::exp(-drops_veil(self.frame, distance));
        let ray = self.drops_ray(x as f32 + 0.5, y as f32 + 0.5);
        let place = if self.frame.form == DROPS_SHIFT {
            self.drops_shifted(ray, &DropsTexel { direction: Vec3::NEG_Z, ..DropsTexel::default() })
        } else {
            Vec2::from(packing_octahedral_encode(ray.to_array())) * 0.5 + 0.5
        };
        (self.drops_capture_at(place, DROPS_VEIL_SPREAD) * (1.0 - left)).extend(left)
    }

    /// The rain over a pixel: radiance, and the transmittance of the scene behind it. Drops are in order of distance.
    fn drops_over(&self, x: u32, y: u32) -> Vec4 {
        let tile = ((y / DROPS_TILE) * self.frame.tiles_across + x / DROPS_TILE) as usize;
        let scene = self.clean[(y * self.frame.width + x) as usize][3];
        let (mut radiance, mut transmittance) = (Vec3::ZERO, 1.0);
        let tiles = &self.rain.tiles;
        for &index in &tiles[tiles[tile] as usize..tiles[tile + 1] as usize] {
            let drop = &self.rain.list[index as usize];
            if drop.distance >= scene || transmittance < DROPS_OPAQUE {
                break;
            }
            let shown = self.drops_pixel(drop, x, y);
            radiance += shown.truncate() * transmittance;
            transmittance *= 1.0 - shown.w;
        }
        let veiled = self.drops_veiled(x, y, scene);
        (radiance + veiled.truncate() * transmittance).extend(veiled.w * transmittance)
    }
}

impl Rain {
    /// The rain over a scene: radiance, and the transmittance of the scene behind it; rows from the top. `clean` is the
    /// scene's picture with its distances.
    #[must_use]
    pub fn layer(&self, clean: &[[f32; 4]], masks: &DropMasks, capture: &Capture) -> Vec<[f32; 4]> {
        let buffers =
            Buffers { frame: &self.frame, rain: self, masks: &masks.words, capture: &capture.texels, clean };
        let (width, buffers) = (self.frame.width, &buffers);
        (0..self.frame.height)
            .into_par_iter()
            .flat_map_iter(|y| (0..width).map(move |x| buffers.drops_over(x, y).to_array()))
            .collect()
    }
}
