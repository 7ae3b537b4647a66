//! From a scene of files to the renderer's buffers: what a pose shows, its materials, textures and lamps.

use std::borrow::Cow;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher as _};
use std::sync::Arc;

use downpour_scene::picture::{Picture, Pixels};
use downpour_scene::scene::{
    AlphaMode, Encoding, Instance, Light, LightKind, Material, PlacedLight, Pose, Scene, TextureRef, Wrap,
    skin_primitive,
};
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_DOUBLE_SIDED, SCENE_MASKED, SCENE_MIRROR_U, SCENE_MIRROR_V, SCENE_REPEAT_U,
    SCENE_REPEAT_V, SCENE_UNLIT,
};
use glam::{Affine3A, DVec3};

use crate::builder::{MeshPart, SceneBuilder, ScenePart};
use crate::material::{MaterialLook, TextureSlot, TextureUse};
use downpour_render::light::LightSource;

/// Pictures that are in the scene already, each by what it is used for.
#[derive(Default)]
struct Stored<'a> {
    by_pointer: HashMap<(*const Picture, TextureUse), TextureSlot>,
    /// A kit of parts has one atlas, which each of its files brings along.
    by_content: HashMap<(u64, TextureUse), (&'a Arc<Picture>, TextureSlot)>,
}

/// Materials and textures of a scene: what no pose of it changes, and most of the work.
#[derive(Clone, Debug)]
pub(crate) struct SceneLooks {
    /// They alone.
    builder: SceneBuilder,
    /// Index of each material of the scene, and of one for what has none.
    materials: Vec<u32>,
    fallback: u32,
}

impl SceneLooks {
    /// Materials and textures of a scene.
    #[must_use]
    pub(crate) fn new(scene: &Scene) -> Self {
        let (mut builder, mut stored) = (SceneBuilder::new(), Stored::default());
        let materials =
            scene.materials.iter().map(|m| builder.add_scene_material(scene, m, &mut stored)).collect();
        let fallback = builder.add_material(MaterialLook::default());
        Self { builder, materials, fallback }
    }

    /// Builder of scenes of these materials and textures, which are shared.
    #[must_use]
    pub(crate) fn builder(&self) -> SceneBuilder {
        self.builder.clone()
    }

    /// The meshes of a pose whose node is `wanted`, as a part of scenes of these materials, relative to `origin`, meters.
    pub(crate) fn part(
        &self,
        scene: &Scene,
        pose: &Pose,
        origin: DVec3,
        wanted: impl Fn(usize) -> bool,
    ) -> ScenePart {
        let mut builder = self.builder();
        builder.add_meshes(self, scene, pose, origin, wanted);
        builder.take_part()
    }

    /// The builder of the only scene of them: without a copy of the textures.
    pub(crate) fn take_builder(&mut self) -> SceneBuilder {
        std::mem::take(&mut self.builder)
    }
}

impl SceneBuilder {
    /// Adds the meshes of a pose of a scene whose node is `wanted` to the builder of its looks, relative to `origin`, meters: far from the
    /// world's origin single precision is coarse, near the eye it need not be.
    pub(crate) fn add_meshes(
        &mut self,
        looks: &SceneLooks,
        scene: &Scene,
        pose: &Pose,
        origin: DVec3,
        wanted: impl Fn(usize) -> bool,
    ) {
        for instance in pose.instances.iter().filter(|instance| wanted(instance.node)) {
            let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
            let instance = relative(instance, pose, origin);
            for primitive in &mesh.primitives {
                let moved = skin_primitive(primitive, &instance);
                let positions: &[[f32; 3]] = bytemuck::cast_slice(&moved.positions);
                let normals: &[[f32; 3]] = bytemuck::cast_slice(&moved.normals);
                let tangents: &[[f32; 4]] = bytemuck::cast_slice(&moved.tangents);
                let [first, second] = &primitive.uvs;
                let part = MeshPart {
                    positions,
                    normals: (normals.len() == positions.len()).then_some(normals),
                    tangents: (tangents.len() == positions.len()).then_some(tangents),
                    uvs: [Some(bytemuck::cast_slice(first)), Some(bytemuck::cast_slice(second))],
                    colors: primitive.colors.as_deref().map(bytemuck::cast_slice),
                    indices: &primitive.indices,
                    material: looks.materials.get(primitive.material).copied().unwrap_or(looks.fallback),
                };
                self.add_mesh(&part, &Affine3A::IDENTITY);
            }
        }
    }

    /// Adds the lamps of a pose of a scene, relative to `origin`, meters.
    ///
    /// They keep their numbers: 1 is what the sky's radiance of 1 is, so that a lamp of `I` candela lights a surface
    /// at a distance `r` with `I / r^2` where radiance is in cd/m^2.
    pub(crate) fn add_lamps(&mut self, scene: &Scene, pose: &Pose, origin: DVec3) {
        for placed in &pose.lights {
            let Some(light) = scene.lights.get(placed.light) else { continue };
            self.add_light(light_source(light, placed, pose, origin));
        }
    }

    fn add_scene_material<'a>(
        &mut self,
        scene: &'a Scene,
        material: &Material,
        stored: &mut Stored<'a>,
    ) -> u32 {
        let (mode, alpha_cutoff) = match material.alpha_mode {
            AlphaMode::Mask { cutoff } => (SCENE_MASKED, cutoff),
            AlphaMode::Blend => (SCENE_BLENDED, 0.5),
            _ => (0, 0.5),
        };
        let textures = [
            (&material.base_color_texture, false),
            (&material.metallic_roughness_texture, false),
            (&material.normal_texture, true),
            (&material.emissive_texture, false),
            (&material.occlusion_texture, false),
            (&material.transmission_texture, false),
            (&material.diffuse_transmission_texture, false),
            (&material.diffuse_transmission_color_texture, false),
        ];
        let maps = textures.map(|(used, is_relief)| {
            used.as_ref().and_then(|used| self.add_texture_use(scene, used, is_relief, stored))
        });
        self.add_material(MaterialLook {
            base_color: material.base_color.into(),
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
            diffuse_transmission: material.diffuse_transmission,
            diffuse_transmission_color: material.diffuse_transmission_color.into(),
            ior: material.ior,
            porosity: material.porosity,
            maps,
        })
    }

    /// A slot for one use of a texture; its texels are stored once.
    fn add_texture_use<'a>(
        &mut self,
        scene: &'a Scene,
        used: &TextureRef,
        is_relief: bool,
        stored: &mut Stored<'a>,
    ) -> Option<u32> {
        let texture = scene.textures.get(used.texture)?;
        let of = match texture.encoding {
            _ if is_relief => TextureUse::Normals,
            Encoding::Srgb => TextureUse::Color,
            _ => TextureUse::Data,
        };
        let picture = &texture.picture;
        let key = (Arc::as_ptr(picture), of);
        let slot = match stored.by_pointer.get(&key) {
            Some(slot) => *slot,
            None => {
                let content = (digest(picture), of);
                let slot = match stored.by_content.get(&content) {
                    Some((known, slot)) if same(known, picture) => *slot,
                    _ => {
                        let slot = self.add_picture(picture, of);
                        stored.by_content.insert(content, (picture, slot));
                        slot
                    }
                };
                stored.by_pointer.insert(key, slot);
                slot
            }
        };
        let (columns, offset) = (used.transform.matrix2.to_cols_array(), used.transform.translation);
        let wrap = |w: Wrap, repeat: u32, mirror: u32| match w {
            Wrap::Repeat => repeat,
            Wrap::MirroredRepeat => mirror,
            Wrap::ClampToEdge => 0,
        };
        let kept = slot.flags & !(SCENE_REPEAT_U | SCENE_REPEAT_V);
        let sampler = texture.sampler;
        let slot = TextureSlot {
            // Rows, from glam's columns.
            matrix: [columns[0], columns[2], columns[1], columns[3]],
            offset: offset.into(),
            uv_set: used.uv_set as u32,
            flags: kept
                | wrap(sampler.wrap_s, SCENE_REPEAT_U, SCENE_MIRROR_U)
                | wrap(sampler.wrap_t, SCENE_REPEAT_V, SCENE_MIRROR_V),
            ..slot
        };
        Some(self.add_slot(slot))
    }

    fn add_picture(&mut self, picture: &Picture, of: TextureUse) -> TextureSlot {
        let bytes: Cow<'_, [[u8; 4]]> = match &picture.pixels {
            Pixels::Rgba8(pixels) => Cow::Borrowed(pixels),
            Pixels::RgbaF32(pixels) => {
                pixels.iter().map(|p| p.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8)).collect()
            }
        };
        self.texture(picture.width, picture.height, &bytes, of)
    }
}

/// An instance whose position is relative to `origin`.
pub(crate) fn relative<'a>(instance: &'a Instance, pose: &Pose, origin: DVec3) -> Cow<'a, Instance> {
    if origin == DVec3::ZERO {
        return Cow::Borrowed(instance);
    }
    let mut moved = instance.clone();
    if let Some(world) = pose.world_f64(instance.node) {
        moved.world.translation = (world.translation - origin).as_vec3a();
    }
    for joint in &mut moved.joints {
        joint.translation -= origin.as_vec3a();
    }
    Cow::Owned(moved)
}

/// A number that pictures of the same pixels share.
fn digest(picture: &Picture) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write_u32(picture.width);
    hasher.write_u32(picture.height);
    match &picture.pixels {
        Pixels::Rgba8(pixels) => hasher.write(bytemuck::cast_slice(pixels)),
        Pixels::RgbaF32(pixels) => hasher.write(bytemuck::cast_slice(pixels)),
    }
    hasher.finish()
}

fn same(a: &Picture, b: &Picture) -> bool {
    (a.width, a.height) == (b.width, b.height) && a.pixels == b.pixels
}

/// A light of a pose, relative to `origin`.
pub(crate) fn light_source(light: &Light, placed: &PlacedLight, pose: &Pose, origin: DVec3) -> LightSource {
    let strength = light.color * light.intensity;
    let range = light.range.unwrap_or(0.0);
    let radius = light.radius.unwrap_or(0.0);
    let position = pose.world_f64(placed.node).map_or(placed.position.as_dvec3(), |w| w.translation);
    let (position, direction) = ((position - origin).as_vec3(), placed.direction);
    match light.kind {
        LightKind::Directional => LightSource::Directional { direction, irradiance: strength },
        LightKind::Point => LightSource::Point { position, radius, intensity: strength, range },
        LightKind::Spot { inner, outer } => {
            LightSource::Spot { position, radius, direction, intensity: strength, range, inner, outer }
        }
    }
}
