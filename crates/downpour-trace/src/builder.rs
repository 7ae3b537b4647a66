//! A scene being put together: meshes, materials, textures and lamps become the buffers of [`data`](crate::data).

mod lamp_glass;
mod part;
mod relief;
mod texture;

use std::collections::BTreeMap;
use std::sync::Arc;

use downpour_shaders::render::scene::{SCENE_LAMP_GLASS, SCENE_SPOT_GLASS};
use glam::{Affine3A, Vec2, Vec3, Vec4};

use crate::data::{RenderCorner, SceneData};
use crate::emitter::{self, mean_emission};
use crate::material::{MaterialLook, TextureSlot};
use crate::sky_light::SkyLight;
use crate::still_part::StillPart;
use downpour_render::light::LightSource;
pub(crate) use part::ScenePart;
use part::concatenated;

/// Triangle mesh to be added to a scene, in its own space.
#[derive(Clone, Copy, Debug)]
pub struct MeshPart<'a> {
    /// Positions of the vertices, meters.
    pub positions: &'a [[f32; 3]],
    /// Vertex normals; `None`: the triangles' normals.
    pub normals: Option<&'a [[f32; 3]]>,
    /// Tangents with handedness; only normal maps need them.
    pub tangents: Option<&'a [[f32; 4]]>,
    /// First and second set of texture coordinates.
    pub uvs: [Option<&'a [[f32; 2]]>; 2],
    /// Vertex colors, linear.
    pub colors: Option<&'a [[f32; 4]]>,
    /// Three vertices per triangle. Triangles with an index out of range are left out.
    pub indices: &'a [u32],
    /// Index of the material.
    pub material: u32,
}

impl<'a> MeshPart<'a> {
    /// A mesh of positions and triangles alone.
    #[must_use]
    pub fn plain(positions: &'a [[f32; 3]], indices: &'a [u32], material: u32) -> Self {
        Self { positions, normals: None, tangents: None, uvs: [None; 2], colors: None, indices, material }
    }
}

/// Builder of a [`SceneData`].
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    corners: Vec<[RenderCorner; 3]>,
    positions: Vec<[[f32; 3]; 3]>,
    materials: Vec<MaterialLook>,
    slots: Vec<TextureSlot>,
    texels: Arc<Vec<u32>>,
    lights: Vec<LightSource>,
    /// What stands still in a scene that moves.
    still: Option<Arc<ScenePart>>,
}

impl SceneBuilder {
    /// Creates an empty builder.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the texels of a texture with all its levels, and gives the index of the first.
    pub(crate) fn push_texels(&mut self, texels: &[u32]) -> u32 {
        let first = self.texels.len() as u32;
        Arc::make_mut(&mut self.texels).extend_from_slice(texels);
        first
    }

    /// Adds a texture slot and returns its index.
    pub fn add_slot(&mut self, slot: TextureSlot) -> u32 {
        self.slots.push(slot);
        self.slots.len() as u32 - 1
    }

    /// Adds a material and returns its index.
    pub fn add_material(&mut self, material: MaterialLook) -> u32 {
        self.materials.push(material);
        self.materials.len() as u32 - 1
    }

    /// Adds a light.
    pub fn add_light(&mut self, light: LightSource) {
        self.lights.push(light);
    }

    /// Adds a mesh, placed by `transform`. A mirroring transform turns the triangles over.
    pub fn add_mesh(&mut self, part: &MeshPart<'_>, transform: &Affine3A) {
        let mirrored = transform.matrix3.determinant() < 0.0;
        let normal_matrix = transform.matrix3.inverse().transpose();
        let vertex = |i: u32| -> Option<(Vec3, RenderCorner)> {
            let i = i as usize;
            let position = transform.transform_point3(Vec3::from(*part.positions.get(i)?));
            let normal = part
                .normals
                .and_then(|n| n.get(i))
                .map_or(Vec3::ZERO, |&n| (normal_matrix * Vec3::from(n)).normalize_or_zero());
            let tangent = part.tangents.and_then(|t| t.get(i)).map_or(Vec4::ZERO, |&t| {
                let t = Vec4::from(t);
                let turned = (transform.matrix3 * t.truncate()).normalize_or_zero();
                turned.extend(if mirrored { -t.w } else { t.w })
            });
            let uv = |set: usize| part.uvs[set].and_then(|u| u.get(i)).map_or(Vec2::ZERO, |&u| Vec2::from(u));
            let corner = RenderCorner {
                normal: normal.into(),
                material: part.material,
                tangent: tangent.into(),
                uv: [uv(0).x, uv(0).y, uv(1).x, uv(1).y],
                color: part.colors.and_then(|c| c.get(i)).copied().unwrap_or([1.0; 4]),
            };
            (position.is_finite()).then_some((position, corner))
        };
        for triangle in part.indices.chunks_exact(3) {
            let order = if mirrored { [0, 2, 1] } else { [0, 1, 2] };
            let [a, b, c] = order.map(|k| vertex(triangle[k]));
            let (Some(a), Some(b), Some(c)) = (a, b, c) else { continue };
            let facet = (b.0 - a.0).cross(c.0 - a.0);
            if facet.length_squared() == 0.0 {
                continue;
            }
            let flat: [f32; 3] = facet.normalize_or_zero().into();
            let corner = |mut corner: RenderCorner| {
                if corner.normal == [0.0; 3] {
                    corner.normal = flat;
                }
                corner
            };
            self.positions.push([a.0.into(), b.0.into(), c.0.into()]);
            self.corners.push([corner(a.1), corner(b.1), corner(c.1)]);
        }
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.positions.len() + self.still.as_ref().map_or(0, |still| still.triangle_count())
    }

    /// Takes the triangles that are there so far as a part of scenes of these materials.
    pub(crate) fn take_part(&mut self) -> ScenePart {
        // A scene has one material at least.
        if self.materials.is_empty() {
            self.materials.push(MaterialLook::default());
        }
        let (positions, corners) = (std::mem::take(&mut self.positions), std::mem::take(&mut self.corners));
        ScenePart::new(&positions, &corners, &self.materials)
    }

    /// Puts a part of the scene, which stands still, before all other triangles.
    pub(crate) fn set_still(&mut self, still: Arc<ScenePart>) {
        self.still = Some(still);
    }

    /// Builds the hierarchy and the buffers.
    #[must_use]
    pub fn build(mut self, sky: &SkyLight) -> SceneData {
        if self.triangle_count() == 0 {
            // A triangle far below and too small to be seen: a hierarchy has at least one.
            self.positions.push([[0.0, -1.0e6, 0.0], [1.0e-3, -1.0e6, 0.0], [0.0, -1.0e6, 1.0e-3]]);
            self.corners.push([RenderCorner { normal: [0.0, 1.0, 0.0], ..RenderCorner::default() }; 3]);
        }
        let own = self.take_part();
        let still = self.still.take();
        let ScenePart { mut bvh, mut corners, shining } = match &still {
            Some(still) => still.joined(&own),
            None => own,
        };
        let owners = lamp_glass::owners(&bvh.triangles, &shining, &self.lights);
        let glass_looks = self.lamp_glass_looks(&corners, &owners);
        for &(leaf, material) in &glass_looks {
            bvh.triangles[leaf as usize].lets_through = 1;
            for corner in &mut corners[3 * leaf as usize..3 * leaf as usize + 3] {
                corner.material = material;
            }
        }
        let mut glass: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        for (&leaf, &lamp) in &owners {
            glass.entry(lamp).or_default().push(leaf);
        }
        let emitters: Vec<u32> = shining.into_iter().filter(|leaf| !owners.contains_key(leaf)).collect();
        let mut table: Vec<[u32; 4]> = Vec::new();
        let slots = (self.materials.len() * crate::material::MATERIAL_ROWS) as u32;
        for material in &self.materials {
            table.extend(material.rows(slots));
        }
        for slot in &self.slots {
            table.extend(slot.rows());
        }
        let lights = table.len() as u32;
        for light in &self.lights {
            table.extend(light.rows());
        }
        if self.texels.is_empty() {
            self.push_texels(&[u32::MAX]);
        }
        let still = still.map(|part| {
            let count = part.triangle_count() as u32;
            let glass = glass_looks.into_iter().filter(|&(leaf, _)| leaf < count).collect();
            Arc::new(StillPart { part, glass, texels: self.texels.len() })
        });
        let mut data = SceneData {
            nodes: Arc::new(bvh.nodes),
            triangles: Arc::new(bvh.triangles),
            corners: Arc::new(corners),
            table,
            shared: Vec::new(),
            texels: self.texels,
            slots,
            lights,
            light_count: self.lights.len() as u32,
            puddles: 0,
            puddle_count: 0,
            pane: 0,
            wetness: 0,
            glazing: 0,
            emitters: 0,
            is_translucent: self.materials.iter().any(|material| material.diffuse_transmission > 0.0),
            sky: Arc::new(sky.texels.clone()),
            sky_levels: sky.levels,
            sky_irradiance: sky.irradiance,
            impostors: None,
            impostor_picture: Arc::default(),
            still,
            #[cfg(feature = "wgpu")]
            ripples: None,
        };
        for (lamp, parts) in glass {
            let parts: Vec<_> = parts.iter().map(|&triangle| mean_emission(&data, triangle)).collect();
            let light = &self.lights[lamp];
            let is_spot = matches!(light, LightSource::Spot { .. });
            data.set_lamp_glass(lamp as u32, lamp_glass::radius(light, &parts), is_spot);
        }
        let words = emitter::words(&data, &emitters);
        if !words.is_empty() {
            data.emitters = data.texels.len() as u32;
            match Arc::get_mut(&mut data.texels) {
                Some(texels) => texels.extend(words),
                // Textures that other frames share.
                None => data.texels = Arc::new(concatenated(&data.texels, &words)),
            }
        }
        data
    }

    /// Materials of the glass of lamps, by triangle: each has one of its own, which is made here.
    fn lamp_glass_looks(
        &mut self,
        corners: &[RenderCorner],
        owners: &BTreeMap<u32, usize>,
    ) -> Vec<(u32, u32)> {
        let mut made: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let look = |(&leaf, &lamp): (&u32, &usize)| {
            let of = corners[3 * leaf as usize].material;
            let flag = match self.lights[lamp] {
                LightSource::Spot { .. } => SCENE_SPOT_GLASS,
                _ => SCENE_LAMP_GLASS,
            };
            let own = *made.entry((of, flag)).or_insert_with(|| {
                let look = self.materials[of as usize];
                self.materials.push(MaterialLook { flags: look.flags | flag, ..look });
                self.materials.len() as u32 - 1
            });
            (leaf, own)
        };
        owners.iter().map(look).collect()
    }
}
