//! Materials: the metallic and rough model of glTF 2.0 (section 3.9 and appendix B), with the
//! extensions `KHR_materials_diffuse_transmission`, `_emissive_strength`, `_ior`, `_transmission` and `_unlit`.

use glam::{Affine2, Vec2, Vec3, Vec4};

/// Material of a primitive. Colors of factors are linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the file; may be empty.
    pub name: String,
    /// Reflectance (dielectric: diffuse; metal: at normal incidence) with coverage in `w`; each in [0, 1].
    pub base_color: Vec4,
    /// Multiplies `base_color`; sRGB.
    pub base_color_texture: Option<TextureRef>,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// 0 mirror to 1 matt; its square is the width of the GGX distribution.
    pub roughness: f32,
    /// Green multiplies `roughness`, blue `metallic`; linear.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Multiplies x and y of the normal map.
    pub normal_scale: f32,
    /// Normals in the space of the tangents, from [0, 1] to [-1, 1]; linear.
    pub normal_texture: Option<TextureRef>,
    /// 0 no to 1 full occlusion by the texture.
    pub occlusion_strength: f32,
    /// Red is the part of the surrounding light that arrives; linear.
    pub occlusion_texture: Option<TextureRef>,
    /// Radiance that the surface sends out, factor times strength, in candela per square meter.
    pub emissive: Vec3,
    /// Multiplies `emissive`; sRGB.
    pub emissive_texture: Option<TextureRef>,
    /// Meaning of the alpha of the base color.
    pub alpha_mode: AlphaMode,
    /// True if the back is visible too, with its normal reversed.
    pub double_sided: bool,
    /// True if the base color is shown as it is, without light.
    pub unlit: bool,
    /// The part of light that passes through the surface instead of being scattered by it, in [0, 1].
    pub transmission: f32,
    /// Red multiplies `transmission`; linear.
    pub transmission_texture: Option<TextureRef>,
    /// The part of the light not reflected by the gloss that leaves the surface on its other side, scattered evenly, in [0, 1]: that of
    /// leaves, paper and cloth.
    pub diffuse_transmission: f32,
    /// Alpha multiplies `diffuse_transmission`; linear.
    pub diffuse_transmission_texture: Option<TextureRef>,
    /// Color of that light, as `base_color` is that of reflected light; each in [0, 1].
    pub diffuse_transmission_color: Vec3,
    /// Multiplies `diffuse_transmission_color`; sRGB.
    pub diffuse_transmission_color_texture: Option<TextureRef>,
    /// Index of refraction; 1 or more, or 0 for a surface that reflects all light as the extension allows.
    pub ior: f32,
    /// Fraction that soaks up rain and darkens, in [0, 1]: `porosity` of the material's `extras`, or what a weather file gives in its place.
    /// `None`: by roughness and metalness.
    pub porosity: Option<f32>,
}

/// Meaning of the alpha of the base color.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha has no effect.
    #[default]
    Opaque,
    /// The surface exists where alpha is at least the cutoff.
    Mask {
        /// Minimum alpha of the surface.
        cutoff: f32,
    },
    /// Coverage: the background shows through.
    Blend,
}

/// The use of a texture by a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// The texture.
    pub texture: usize,
    /// Set of texture coordinates, 0 or 1. If the primitive has no such set, all are (0, 0).
    pub uv_set: usize,
    /// `KHR_texture_transform`: from the coordinates of the vertices to those of the texture.
    pub transform: Affine2,
}

impl TextureRef {
    /// Sampling position in the texture for coordinates of a vertex.
    ///
    /// ```
    /// use downpour_scene::scene::TextureRef;
    /// use glam::{Affine2, Vec2};
    /// let tiled = TextureRef { texture: 0, uv_set: 0, transform: Affine2::from_scale(Vec2::splat(4.0)) };
    /// assert_eq!(tiled.at(Vec2::new(0.5, 0.25)), Vec2::new(2.0, 1.0));
    /// ```
    #[must_use]
    pub fn at(&self, uv: Vec2) -> Vec2 {
        self.transform.transform_point2(uv)
    }
}

impl Default for Material {
    /// White, metallic and rough: the default of the specification for a primitive without material.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_scale: 1.0,
            normal_texture: None,
            occlusion_strength: 1.0,
            occlusion_texture: None,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            transmission: 0.0,
            transmission_texture: None,
            diffuse_transmission: 0.0,
            diffuse_transmission_texture: None,
            diffuse_transmission_color: Vec3::ONE,
            diffuse_transmission_color_texture: None,
            ior: 1.5,
            porosity: None,
        }
    }
}

impl Material {
    /// All uses of textures.
    pub fn textures(&self) -> impl Iterator<Item = &TextureRef> {
        [
            &self.base_color_texture,
            &self.metallic_roughness_texture,
            &self.normal_texture,
            &self.occlusion_texture,
            &self.emissive_texture,
            &self.transmission_texture,
            &self.diffuse_transmission_texture,
            &self.diffuse_transmission_color_texture,
        ]
        .into_iter()
        .flatten()
    }

    /// All uses of textures, to change them.
    pub(crate) fn textures_mut(&mut self) -> impl Iterator<Item = &mut TextureRef> {
        [
            &mut self.base_color_texture,
            &mut self.metallic_roughness_texture,
            &mut self.normal_texture,
            &mut self.occlusion_texture,
            &mut self.emissive_texture,
            &mut self.transmission_texture,
            &mut self.diffuse_transmission_texture,
            &mut self.diffuse_transmission_color_texture,
        ]
        .into_iter()
        .flatten()
    }
}
