//! A scene being put together: meshes, materials, textures and lamps become the buffers of [`data`](crate::data).

mod lamp_glass;
mod relief;
mod texture;

use std::collections::BTreeMap;
use std::sync::Arc;

use downpour_bvh::Bvh;
use downpour_shaders::render::scene::{SCENE_LAMP_GLASS, SCENE_SPOT_GLASS, SCENE_UNLIT};
use glam::{Affine3A, Vec2, Vec3, Vec4};

use crate::data::{RenderCorner, SceneData};
use crate::emitter::{self, mean_emission};
use crate::material::{MaterialLook, TextureSlot};
use crate::sky_light::SkyLight;
use downpour_render::light::LightSource;

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
    texels: Vec<u32>,
    lights: Vec<LightSource>,
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
        self.texels.extend_from_slice(texels);
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
        self.positions.len()
    }

    /// Builds the hierarchy and the buffers.
    #[must_use]
    pub fn build(mut self, sky: &SkyLight) -> SceneData {
        if self.materials.is_empty() {
            self.materials.push(MaterialLook::default());
        }
        if self.positions.is_empty() {
            // A triangle far below and too small to be seen: a hierarchy has at least one.
            self.positions.push([[0.0, -1.0e6, 0.0], [1.0e-3, -1.0e6, 0.0], [0.0, -1.0e6, 1.0e-3]]);
            self.corners.push([RenderCorner { normal: [0.0, 1.0, 0.0], ..RenderCorner::default() }; 3]);
        }
        let shining: Vec<usize> = (0..self.corners.len()).filter(|&k| self.shines(k)).collect();
        let owners = lamp_glass::owners(&self.positions, &shining, &self.lights);
        self.mark_lamp_glass(&owners);
        let bvh = Bvh::new(&self.positions);
        let mut triangles = bvh.triangles;
        let last_material = self.materials.len() as u32 - 1;
        let mut corners = Vec::with_capacity(3 * triangles.len());
        let mut emitters = Vec::new();
        let mut glass: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        for (leaf, triangle) in (0u32..).zip(&mut triangles) {
            let index = triangle.index as usize;
            for mut corner in self.corners[index] {
                corner.material = corner.material.min(last_material);
                corners.push(corner);
            }
            triangle.index = leaf;
            let material = self.corners[index][0].material.min(last_material);
            triangle.lets_through = u32::from(self.materials[material as usize].lets_through());
            match owners.get(&index) {
                Some(&lamp) => glass.entry(lamp).or_default().push(leaf),
                None if shining.binary_search(&index).is_ok() => emitters.push(leaf),
                None => {}
            }
        }
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
            self.texels.push(u32::MAX);
        }
        let mut data = SceneData {
            nodes: Arc::new(bvh.nodes),
            triangles: Arc::new(triangles),
            corners: Arc::new(corners),
            table,
            texels: Arc::new(self.texels),
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
            let texels = Arc::make_mut(&mut data.texels);
            data.emitters = texels.len() as u32;
            texels.extend(words);
        }
        data
    }

    /// True if triangle `k` shines.
    fn shines(&self, k: usize) -> bool {
        let material = self.materials.get(self.corners[k][0].material as usize);
        material
            .is_some_and(|look| look.flags & SCENE_UNLIT == 0 && look.emission.iter().any(|&part| part > 0.0))
    }

    /// Gives triangles that are the glass of lamps a material of their own.
    fn mark_lamp_glass(&mut self, owners: &BTreeMap<usize, usize>) {
        let mut marked: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (&triangle, &lamp) in owners {
            let of = self.corners[triangle][0].material;
            let flag = match self.lights[lamp] {
                LightSource::Spot { .. } => SCENE_SPOT_GLASS,
                _ => SCENE_LAMP_GLASS,
            };
            let own = *marked.entry((of, flag)).or_insert_with(|| {
                let look = self.materials[of as usize];
                self.materials.push(MaterialLook { flags: look.flags | flag, ..look });
                self.materials.len() as u32 - 1
            });
            for corner in &mut self.corners[triangle] {
                corner.material = own;
            }
        }
    }
}
