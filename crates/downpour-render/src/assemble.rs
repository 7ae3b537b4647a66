//! From a scene of files to the renderer's buffers: what a pose shows, its materials, textures and lamps.

use std::collections::HashMap;

use downpour_scene::picture::Pixels;
use downpour_scene::scene::{
    AlphaMode, Encoding, LightKind, Material, Pose, Scene, TextureRef, Wrap, skin_primitive,
};
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_DOUBLE_SIDED, SCENE_MASKED, SCENE_MIRROR_U, SCENE_MIRROR_V, SCENE_REPEAT_U,
    SCENE_REPEAT_V, SCENE_UNLIT,
};
use glam::Vec3;

use crate::data::{MeshPart, SceneBuilder};
use crate::light::LightSource;
use crate::material::{MaterialLook, TextureSlot, TextureUse};

/// Luminous efficacy that turns photometric lamps into the scale of the sky map: candela and lux over 683 lm/W at
/// the eye's best would be watts; pictures use the efficacy of daylight, 100 lm/W, so that a lux of sun light and a
/// watt of sky agree.
pub const DAYLIGHT_EFFICACY: f32 = 100.0;

impl SceneBuilder {
    /// Adds all that a pose of a scene shows. Photometric lights are multiplied by `light_scale` (1 over
    /// [`DAYLIGHT_EFFICACY`] where the sky map is in watts).
    pub fn add_scene(&mut self, scene: &Scene, pose: &Pose, light_scale: f32) {
        let mut slots: HashMap<usize, TextureSlot> = HashMap::new();
        let materials: Vec<u32> =
            scene.materials.iter().map(|m| self.add_scene_material(scene, m, &mut slots)).collect();
        let fallback = self.add_material(MaterialLook::default());
        for instance in &pose.instances {
            let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
            for primitive in &mesh.primitives {
                let moved = skin_primitive(primitive, instance);
                let arrays = |v: &[Vec3]| v.iter().map(Vec3::to_array).collect::<Vec<_>>();
                let (positions, normals) = (arrays(&moved.positions), arrays(&moved.normals));
                let tangents: Vec<[f32; 4]> = moved.tangents.iter().map(glam::Vec4::to_array).collect();
                let uvs: [Vec<[f32; 2]>; 2] =
                    std::array::from_fn(|k| primitive.uvs[k].iter().map(glam::Vec2::to_array).collect());
                let colours: Option<Vec<[f32; 4]>> =
                    primitive.colors.as_ref().map(|c| c.iter().map(glam::Vec4::to_array).collect());
                let part = MeshPart {
                    positions: &positions,
                    normals: (normals.len() == positions.len()).then_some(&normals),
                    tangents: (tangents.len() == positions.len()).then_some(&tangents),
                    uvs: [Some(&uvs[0]), Some(&uvs[1])],
                    colours: colours.as_deref(),
                    indices: &primitive.indices,
                    material: materials.get(primitive.material).copied().unwrap_or(fallback),
                };
                self.add_mesh(&part, &glam::Affine3A::IDENTITY);
            }
        }
        for placed in &pose.lights {
            let Some(light) = scene.lights.get(placed.light) else { continue };
            let strength = light.color * (light.intensity * light_scale);
            let range = light.range.unwrap_or(0.0);
            let (position, direction) = (placed.position, placed.direction);
            self.add_light(match light.kind {
                LightKind::Directional => LightSource::Directional { direction, irradiance: strength },
                LightKind::Point => LightSource::Point { position, intensity: strength, range },
                LightKind::Spot { inner, outer } => {
                    LightSource::Spot { position, direction, intensity: strength, range, inner, outer }
                }
            });
        }
    }

    fn add_scene_material(
        &mut self,
        scene: &Scene,
        material: &Material,
        slots: &mut HashMap<usize, TextureSlot>,
    ) -> u32 {
        let (mode, alpha_cutoff) = match material.alpha_mode {
            AlphaMode::Mask { cutoff } => (SCENE_MASKED, cutoff),
            AlphaMode::Blend => (SCENE_BLENDED, 0.5),
            _ => (0, 0.5),
        };
        let textures = [
            &material.base_color_texture,
            &material.metallic_roughness_texture,
            &material.normal_texture,
            &material.emissive_texture,
            &material.occlusion_texture,
            &material.transmission_texture,
        ];
        let maps = textures.map(|t| t.as_ref().and_then(|t| self.add_texture_use(scene, t, slots)));
        self.add_material(MaterialLook {
            base_colour: material.base_color.into(),
            emission: material.emissive.into(),
            metallic: material.metallic,
            roughness: material.roughness,
            normal_scale: material.normal_scale,
            occlusion_strength: material.occlusion_strength,
            alpha_cutoff,
            flags: mode
                | if material.double_sided { SCENE_DOUBLE_SIDED } else { 0 }
                | if material.unlit { SCENE_UNLIT } else { 0 },
            transmission: material.transmission,
            ior: material.ior,
            maps,
        })
    }

    /// A slot for one use of a texture; its texels are stored once.
    fn add_texture_use(
        &mut self,
        scene: &Scene,
        used: &TextureRef,
        slots: &mut HashMap<usize, TextureSlot>,
    ) -> Option<u32> {
        let texture = scene.textures.get(used.texture)?;
        let stored = match slots.get(&used.texture) {
            Some(slot) => *slot,
            None => {
                let of =
                    if texture.encoding == Encoding::Srgb { TextureUse::Colour } else { TextureUse::Data };
                let picture = &texture.picture;
                let bytes: Vec<[u8; 4]> = match &picture.pixels {
                    Pixels::Rgba8(pixels) => pixels.clone(),
                    Pixels::RgbaF32(pixels) => {
                        pixels.iter().map(|p| p.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8)).collect()
                    }
                };
                let slot = self.texture(picture.width, picture.height, &bytes, of);
                slots.insert(used.texture, slot);
                slot
            }
        };
        let (columns, offset) = (used.transform.matrix2.to_cols_array(), used.transform.translation);
        let wrap = |w: Wrap, repeat: u32, mirror: u32| match w {
            Wrap::Repeat => repeat,
            Wrap::MirroredRepeat => mirror,
            Wrap::ClampToEdge => 0,
        };
        let kept = stored.flags & downpour_shaders::render::scene::SCENE_ROOTED;
        let sampler = texture.sampler;
        let slot = TextureSlot {
            // Rows, from glam's columns.
            matrix: [columns[0], columns[2], columns[1], columns[3]],
            offset: offset.into(),
            uv_set: used.uv_set as u32,
            flags: kept
                | wrap(sampler.wrap_s, SCENE_REPEAT_U, SCENE_MIRROR_U)
                | wrap(sampler.wrap_t, SCENE_REPEAT_V, SCENE_MIRROR_V),
            ..stored
        };
        Some(self.add_slot(slot))
    }
}
