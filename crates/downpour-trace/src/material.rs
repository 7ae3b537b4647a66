//! Materials and textures as rows of the scene's table. Twin of `shaders/wgsl/render/material.wgsl`.

use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_LAMP_GLASS, SCENE_MASKED, SCENE_MATERIAL_ROWS, SCENE_NONE, SCENE_SLOT_ROWS,
    SCENE_SPOT_GLASS, SCENE_UNLIT,
};
use glam::{Vec3, Vec4};

use crate::data::SceneData;

pub(crate) const MATERIAL_ROWS: usize = SCENE_MATERIAL_ROWS as usize;
const SLOT_ROWS: usize = SCENE_SLOT_ROWS as usize;

/// Appearance of a surface: glTF's metallic-roughness, with indices of texture slots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialLook {
    /// Base color, linear, and alpha.
    pub base_color: [f32; 4],
    /// Emitted radiance.
    pub emission: [f32; 3],
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// 0 mirror, 1 rough.
    pub roughness: f32,
    /// Strength of the normal map.
    pub normal_scale: f32,
    /// Strength of the occlusion map.
    pub occlusion_strength: f32,
    /// Alpha below which a masked material is transparent.
    pub alpha_cutoff: f32,
    /// `SCENE_MASKED`, `SCENE_BLENDED`, `SCENE_DOUBLE_SIDED`, `SCENE_UNLIT`.
    pub flags: u32,
    /// Fraction of light that passes a thin dielectric.
    pub transmission: f32,
    /// Fraction of the light not reflected by the gloss that leaves the surface on its other side, scattered evenly.
    pub diffuse_transmission: f32,
    /// Color of that light.
    pub diffuse_transmission_color: [f32; 3],
    /// Refractive index.
    pub ior: f32,
    /// Fraction of the surface that soaks up rain and darkens; `None`: by roughness and metalness.
    pub porosity: Option<f32>,
    /// Slots of base color, metallic-roughness, normal, emission, occlusion, transmission, diffuse transmission and its color.
    pub maps: [Option<u32>; 8],
}

impl Default for MaterialLook {
    /// glTF's default material, but not metallic: a mesh without a material is gray plastic, not a mirror.
    fn default() -> Self {
        Self {
            base_color: [1.0; 4],
            emission: [0.0; 3],
            metallic: 0.0,
            roughness: 1.0,
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            alpha_cutoff: 0.5,
            flags: 0,
            transmission: 0.0,
            diffuse_transmission: 0.0,
            diffuse_transmission_color: [1.0; 3],
            ior: 1.5,
            porosity: None,
            maps: [None; 8],
        }
    }
}

impl MaterialLook {
    /// True if light may pass: through holes, through the surface itself, or out of a lamp's glass.
    pub(crate) fn lets_through(&self) -> bool {
        let flags = SCENE_MASKED | SCENE_BLENDED | SCENE_LAMP_GLASS | SCENE_SPOT_GLASS;
        self.flags & flags != 0 || self.transmission > 0.0
    }

    /// True if it lights the scene.
    pub(crate) fn shines(&self) -> bool {
        self.flags & SCENE_UNLIT == 0 && self.emission.iter().any(|&part| part > 0.0)
    }

    pub(crate) fn rows(&self, slots: u32) -> [[u32; 4]; MATERIAL_ROWS] {
        let bits = |v: [f32; 4]| v.map(f32::to_bits);
        let [r, g, b] = self.emission;
        let [red, green, blue] = self.diffuse_transmission_color;
        let map = |k: usize| self.maps[k].map_or(SCENE_NONE, |slot| slots + slot * SCENE_SLOT_ROWS);
        [
            bits(self.base_color),
            bits([r, g, b, self.metallic]),
            bits([self.roughness, self.normal_scale, self.occlusion_strength, self.alpha_cutoff]),
            [
                self.flags,
                self.transmission.to_bits(),
                self.ior.to_bits(),
                self.porosity.unwrap_or(-1.0).to_bits(),
            ],
            [map(0), map(1), map(2), map(3)],
            [map(4), map(5), map(6), map(7)],
            bits([red, green, blue, self.diffuse_transmission]),
        ]
    }
}

/// A texture as a material uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureSlot {
    /// Rows of the 2 x 2 part of the coordinates' transform.
    pub matrix: [f32; 4],
    /// Offset of the coordinates.
    pub offset: [f32; 2],
    /// Index of the set of coordinates: 0 or 1.
    pub uv_set: u32,
    /// Flags: `SCENE_ROOTED`, `SCENE_REPEAT_U`, `SCENE_REPEAT_V`, ...
    pub flags: u32,
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// First texel.
    pub first: u32,
    /// Levels, each half as large as the one before.
    pub levels: u32,
}

impl TextureSlot {
    pub(crate) fn rows(&self) -> [[u32; 4]; SLOT_ROWS] {
        [
            self.matrix.map(f32::to_bits),
            [self.offset[0].to_bits(), self.offset[1].to_bits(), self.uv_set, self.flags],
            [self.width, self.height, self.first, self.levels],
        ]
    }
}

/// A material as the shaders read it: rows of a table. Twin of the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderMaterial {
    /// Base color, linear, and alpha.
    pub base: Vec4,
    /// Emitted radiance.
    pub emission: Vec3,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// 0 mirror, 1 rough.
    pub roughness: f32,
    /// Strength of the normal map.
    pub normal_scale: f32,
    /// Strength of the occlusion map.
    pub occlusion_strength: f32,
    /// Alpha below which a masked material is transparent.
    pub cutoff: f32,
    /// `SCENE_MASKED`, `SCENE_BLENDED`, `SCENE_DOUBLE_SIDED`, `SCENE_UNLIT`.
    pub flags: u32,
    /// Fraction of light that passes a thin dielectric.
    pub transmission: f32,
    /// Fraction of light that leaves it on its other side, scattered evenly.
    pub diffuse_transmission: f32,
    /// Color of that light.
    pub diffuse_transmission_color: Vec3,
    /// Refractive index.
    pub ior: f32,
    /// Porosity; below 0: by the roughness.
    pub porosity: f32,
    /// Rows of the slots of base color, metallic-roughness, normal and emission; `SCENE_NONE` for none.
    pub maps: [u32; 4],
    /// Rows of the slots of occlusion, transmission, diffuse transmission and its color.
    pub more: [u32; 4],
}

/// A texture slot as the shaders read it. Twin of the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSlot {
    /// Rows of the 2 x 2 part of the coordinates' transform.
    pub matrix: [f32; 4],
    /// Offset of the coordinates.
    pub offset: [f32; 2],
    /// Set of coordinates, 0 or 1.
    pub uv_set: u32,
    /// Flags: `SCENE_ROOTED`, `SCENE_REPEAT_U`, `SCENE_REPEAT_V`, ...
    pub flags: u32,
    /// Width, height, first texel, and levels.
    pub image: [u32; 4],
}

impl SceneData {
    /// Reads a material.
    pub(crate) fn material_load(&self, index: u32) -> RenderMaterial {
        let first = (index * SCENE_MATERIAL_ROWS) as usize;
        let rows = &self.table[first..first + MATERIAL_ROWS];
        let numbers = |k: usize| Vec4::from(rows[k].map(f32::from_bits));
        let (glow, look, through) = (numbers(1), numbers(2), numbers(6));
        let [flags, transmission, ior, porosity] = rows[3];
        RenderMaterial {
            base: numbers(0),
            emission: glow.truncate(),
            metallic: glow.w,
            roughness: look.x,
            normal_scale: look.y,
            occlusion_strength: look.z,
            cutoff: look.w,
            flags,
            transmission: f32::from_bits(transmission),
            diffuse_transmission: through.w,
            diffuse_transmission_color: through.truncate(),
            ior: f32::from_bits(ior),
            porosity: f32::from_bits(porosity),
            maps: rows[4],
            more: rows[5],
        }
    }

    /// Sets the emission of all materials to 0, and unlit ones, which show their base color by no light, to black.
    pub(crate) fn remove_emission(&mut self) {
        self.emitters = 0;
        let (materials, _) = self.table[..self.slots as usize].as_chunks_mut::<MATERIAL_ROWS>();
        for [base, glow, _, state, ..] in materials {
            glow[..3].fill(0);
            if state[0] & SCENE_UNLIT != 0 {
                base[..3].fill(0);
            }
        }
    }

    /// Reads a texture slot.
    pub(crate) fn material_slot(&self, row: u32) -> RenderSlot {
        let first = row as usize;
        let rows = &self.table[first..first + SLOT_ROWS];
        let [x, y, uv_set, flags] = rows[1];
        RenderSlot {
            matrix: rows[0].map(f32::from_bits),
            offset: [x, y].map(f32::from_bits),
            uv_set,
            flags,
            image: rows[2],
        }
    }
}

/// Meaning of the numbers of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureUse {
    /// Colors, sRGB in the file.
    Color,
    /// Numbers: roughness, occlusion.
    Data,
    /// Normals in the space of a surface's tangents.
    Normals,
}
