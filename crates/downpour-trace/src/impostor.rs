//! Reflections on wet surfaces by impostors: N. Tatarchuk & J. Isidoro 2006, section 6.3. Twin of `shaders/wgsl/render/impostor.wgsl`.
//!
//! By default reflections are found by rays. In this form, by name, wet ground and puddles show a reflection buffer of half the
//! picture's size, in half floats:
//!
//! - a small environment map from near the ground ahead of the eye;
//! - billboards of lamps and of groups of triangles that shine ([`list`]), their colors more saturated, mirrored in level ground and
//!   stretched toward the viewer ([`draw`]);
//! - blurred vertically, pass by pass ([`blur`]).
//!
//! A texel is the reflection in level ground there. A surface looks it up where level ground would mirror the way its own does, of
//! whose relief and ripples a part warps it, times `ka = saturate(1 - f^2)`, `f = (1 - n.v) f0`.
//!
//! Limits: a reflection is neither sharper nor blurrier for smoother or rougher surfaces; one level of the ground for all; billboards
//! hide one another, but nothing else hides a part of one. Smooth wet surfaces (cars) and what is dry keep their rays.

pub mod blur;
pub mod draw;
pub mod list;

use downpour_math::packing::{packing_pack_half, packing_unpack_half};
use downpour_shaders::render::impostor::{IMPOSTOR_ASIDE, IMPOSTOR_WARP};
use glam::{UVec2, Vec2, Vec3};

use crate::scene::SceneView;

/// A color as a texel.
#[must_use]
pub fn impostor_pack(light: Vec3) -> [u32; 2] {
    [packing_pack_half([light.x, light.y]), packing_pack_half([light.z, 0.0])]
}

/// The color of a texel.
#[must_use]
pub fn impostor_unpack(texel: [u32; 2]) -> Vec3 {
    let [[red, green], [blue, _]] = texel.map(packing_unpack_half);
    Vec3::new(red, green, blue)
}

/// Factor of a reflection toward a viewer, who sees the surface at a cosine; `edge` is the paper's f0.
#[must_use]
pub fn impostor_attenuation(cosine: f32, edge: f32) -> f32 {
    let f = (1.0 - cosine) * edge;
    (1.0 - f * f).max(0.0)
}

impl SceneView<'_> {
    /// Columns and rows of the buffer.
    #[must_use]
    pub fn impostor_size(&self) -> UVec2 {
        UVec2::from(self.frame.camera.size().map(|edge| edge.div_ceil(2)))
    }

    /// Position in the buffer, in texels from the top left, of what is mirrored along a direction by a surface that is seen along `towards`.
    #[must_use]
    pub fn impostor_place(&self, along: Vec3, towards: Vec3) -> Vec2 {
        let camera = &self.frame.camera;
        let level = Vec3::new(along.x, -along.y, along.z);
        let is_before = level.dot(camera.forward) > IMPOSTOR_ASIDE;
        camera.camera_project(if is_before { level } else { towards }) * 0.5
    }

    /// A texel of the buffer; beyond its edges, the nearest one.
    fn impostor_texel(&self, column: i32, row: i32) -> Vec3 {
        let size = self.impostor_size().as_ivec2();
        let (x, y) = (column.clamp(0, size.x - 1), row.clamp(0, size.y - 1));
        impostor_unpack(self.data.impostor_picture[(y * size.x + x) as usize])
    }

    /// The buffer at a position in texels, bilinear.
    fn impostor_light(&self, place: Vec2) -> Vec3 {
        let size = self.impostor_size().as_vec2();
        let at = place.clamp(Vec2::ZERO, size) - 0.5;
        let low = at.floor();
        let part = at - low;
        let (left, top) = (low.x as i32, low.y as i32);
        let row = |row: i32| {
            self.impostor_texel(left, row) * (1.0 - part.x) + self.impostor_texel(left + 1, row) * part.x
        };
        row(top) * (1.0 - part.y) + row(top + 1) * part.y
    }

    /// Radiance that a surface mirrors to a viewer who sees it along `towards`, before its reflectance. Its normal warps what its facet
    /// mirrors.
    pub(crate) fn impostor_mirrored(&self, facet: Vec3, normal: Vec3, towards: Vec3) -> Vec3 {
        let warped = facet + (normal - facet) * IMPOSTOR_WARP;
        let unit = warped / warped.dot(warped).sqrt();
        let along = towards - unit * (2.0 * towards.dot(unit));
        let cosine = (-towards.dot(normal)).clamp(0.0, 1.0);
        let factor = impostor_attenuation(cosine, self.frame.impostor_edge);
        self.impostor_light(self.impostor_place(along, towards)) * factor
    }
}
