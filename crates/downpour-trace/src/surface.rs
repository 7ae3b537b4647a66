//! Surface that a ray finds: the nearest triangle that is not a hole, and its material there. Twin of
//! `shaders/wgsl/render/surface.wgsl`.

use downpour_bvh::{Hit, bvh_blocker, bvh_hit};
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_LAYERS, SCENE_MASKED, SCENE_NONE, SCENE_UNLIT, SURFACE_BENT, SURFACE_DENSE,
    SURFACE_GRAZING, SURFACE_OBLIQUE, SURFACE_OPEN, SURFACE_POROUS,
};
use downpour_sim::shelter::Holes;
use glam::{Vec3, Vec4};

use crate::data::{RenderCorner, SceneData};
use crate::material::RenderMaterial;
use crate::texture::TextureFootprint;

/// Everything that shading needs at a hit.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Position.
    pub position: Vec3,
    /// Opacity.
    pub alpha: f32,
    /// Normal for shading; faces the viewer.
    pub normal: Vec3,
    /// 0 mirror, 1 rough.
    pub roughness: f32,
    /// The triangle's own normal, facing the viewer.
    pub facet: Vec3,
    /// Ambient occlusion of the material: fraction of the environment that is visible.
    pub occlusion: f32,
    /// Albedo of the diffuse base.
    pub diffuse: Vec3,
    /// Flags of the material.
    pub flags: u32,
    /// Reflectance at normal incidence.
    pub normal_reflectance: Vec3,
    /// Fraction of light that passes.
    pub transmission: f32,
    /// Emitted radiance.
    pub emission: Vec3,
    /// Curvature, 1/m: how much the normal turns per meter.
    pub bend: f32,
    /// Fraction that soaks up rain and darkens.
    pub porosity: f32,
    /// Fraction that a film of water covers.
    pub film: f32,
    /// Square of the alpha by which its roughness allows for what the ray's footprint does not resolve of its relief and of its bend.
    pub variance: f32,
    /// Fraction of the light from behind that it scatters toward the viewer, as leaves do.
    pub diffuse_transmission: Vec3,
}

/// Rain falls through what is not seen: where a masked material is below its cutoff, or one that is blended has no alpha. Where
/// one is blended and has some, it is there: glass keeps off the rain.
impl Holes for SceneData {
    fn is_hole(&self, hit: &Hit) -> bool {
        self.surface_is_open(hit)
    }
}

/// Variance of the slopes along both axes that a bent surface has within the footprint of a ray, of a width across it, that meets it at a
/// cosine: those of a box.
#[must_use]
pub fn surface_turn(bend: f32, width: f32, cosine: f32) -> f32 {
    let across = bend * width;
    let along = across / cosine.abs().max(SURFACE_BENT);
    (across * across + along * along) / 12.0
}

/// Roughness of a surface whose microfacets have a relief under them, with a variance of its slopes along both axes together: squares of
/// alphas add up, as the alpha of Beckmann's distribution is the root of that variance.
#[must_use]
pub fn surface_roughness(own: f32, variance: f32) -> f32 {
    let alpha = own * own;
    (alpha * alpha + variance).sqrt().sqrt().min(1.0)
}

/// Fraction of a surface that soaks up rain: its material's own where that is not below 0; else rough stone, plaster and cloth do,
/// metal, smooth paint and leaves do not.
#[must_use]
pub fn surface_porosity(own: f32, flags: u32, roughness: f32, metallic: f32) -> f32 {
    if own >= 0.0 {
        return own.min(1.0);
    }
    if flags & SCENE_MASKED != 0 {
        return 0.0;
    }
    let x = ((roughness - SURFACE_DENSE) / (SURFACE_POROUS - SURFACE_DENSE)).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x) * (1.0 - metallic)
}

impl SceneData {
    fn corners_of(&self, hit: &Hit) -> &[RenderCorner] {
        let first = hit.triangle as usize * 3;
        &self.corners[first..first + 3]
    }

    fn mix(&self, hit: &Hit, field: impl Fn(&RenderCorner) -> Vec4) -> Vec4 {
        let corners = self.corners_of(hit);
        let w = 1.0 - hit.u - hit.v;
        field(&corners[0]) * w + field(&corners[1]) * hit.u + field(&corners[2]) * hit.v
    }

    /// A texture of a material's row, or white.
    fn surface_texture(&self, row: u32, uv: Vec4, footprint: &TextureFootprint) -> Vec4 {
        if row == SCENE_NONE { Vec4::ONE } else { self.texture_sample(row, uv, footprint) }
    }

    /// Alpha at a hit.
    pub(crate) fn surface_alpha(&self, material: &RenderMaterial, hit: &Hit) -> f32 {
        material.base.w
            * self.surface_texture(material.maps[0], self.surface_uv(hit), &TextureFootprint::default()).w
            * self.surface_color(hit).w
    }

    /// Emitted radiance at a hit.
    pub(crate) fn surface_emission(&self, hit: &Hit, footprint: &TextureFootprint) -> Vec3 {
        let material = self.material_load(self.corners_of(hit)[0].material);
        material.emission * self.surface_texture(material.maps[3], self.surface_uv(hit), footprint).truncate()
    }

    /// True if there is a hole at a hit.
    fn surface_is_open(&self, hit: &Hit) -> bool {
        let material = self.material_load(self.corners_of(hit)[0].material);
        if material.flags & (SCENE_MASKED | SCENE_BLENDED) == 0 {
            return false;
        }
        let least = if material.flags & SCENE_MASKED != 0 { material.cutoff } else { SURFACE_OPEN };
        self.surface_alpha(&material, hit) < least
    }

    /// Returns the nearest surface up to a distance. Holes are skipped: where a masked material is below its cutoff, or one
    /// that is blended has no alpha. Twelve holes in a row end the ray.
    #[must_use]
    pub fn surface_hit(&self, origin: Vec3, direction: Vec3, nearest: f32, farthest: f32) -> Option<Hit> {
        self.surface_walk::<false>(origin, direction, nearest, farthest)
    }

    /// Returns what is in the way of a ray up to a distance: any surface through which nothing passes, or the nearest of all if
    /// it is one that lets light through.
    #[must_use]
    pub fn surface_blocker(&self, origin: Vec3, direction: Vec3, nearest: f32, farthest: f32) -> Option<Hit> {
        self.surface_walk::<true>(origin, direction, nearest, farthest)
    }

    /// The nearest surface up to a distance or, if `ANY`, any through which nothing passes.
    fn surface_walk<const ANY: bool>(
        &self,
        origin: Vec3,
        direction: Vec3,
        nearest: f32,
        farthest: f32,
    ) -> Option<Hit> {
        let (origin, direction) = (origin.into(), direction.into());
        let mut from_distance = nearest;
        for _ in 0..SCENE_LAYERS {
            let walk = if ANY { bvh_blocker } else { bvh_hit };
            let hit = walk(&self.nodes, &self.triangles, origin, direction, from_distance, farthest)?;
            if !self.surface_is_open(&hit) {
                return Some(hit);
            }
            from_distance = hit.distance + nearest;
        }
        None
    }

    /// Texture coordinates at a hit.
    fn surface_uv(&self, hit: &Hit) -> Vec4 {
        self.mix(hit, |c| c.uv.into())
    }

    /// Vertex color at a hit.
    fn surface_color(&self, hit: &Hit) -> Vec4 {
        self.mix(hit, |c| c.color.into())
    }

    /// Footprint of a ray's cone, of a width in m at the hit, on the triangle: as wide across the ray, and in the direction in which the ray
    /// goes over the triangle longer by the cosine between ray and normal.
    fn surface_footprint(
        &self,
        hit: &Hit,
        geometric: Vec3,
        direction: Vec3,
        width: f32,
        taps: f32,
    ) -> TextureFootprint {
        let [a, b, c] = [0, 1, 2].map(|k| Vec4::from(self.corners_of(hit)[k].uv));
        let (b, c) = (b - a, c - a);
        let triangle = &self.triangles[hit.triangle as usize];
        let (edge_1, edge_2) = (Vec3::from(triangle.edge_1), Vec3::from(triangle.edge_2));
        let normal = geometric / geometric.dot(geometric).sqrt().max(1.0e-20);
        let cosine = normal.dot(direction);
        let over = direction - normal * cosine;
        let chosen = if over.dot(over) > SURFACE_OBLIQUE { over } else { edge_1 };
        let along = chosen / chosen.dot(chosen).sqrt().max(1.0e-20);
        let across = normal.cross(along);
        // What the edges are to be multiplied by for one meter in a direction.
        let inverse = width / geometric.dot(geometric).max(1.0e-30);
        let longer = inverse / cosine.abs().max(SURFACE_GRAZING);
        let mapped =
            |axis: Vec3| b * axis.cross(edge_2).dot(geometric) + c * edge_1.cross(axis).dot(geometric);
        TextureFootprint { along: mapped(along) * longer, across: mapped(across) * inverse, taps }
    }

    /// The cross product of the edges of the triangle that was hit: its normal, as long as twice its area.
    pub(crate) fn surface_edges(&self, hit: &Hit) -> Vec3 {
        let triangle = &self.triangles[hit.triangle as usize];
        Vec3::from(triangle.edge_1).cross(Vec3::from(triangle.edge_2))
    }

    /// The normal of the triangle that was hit, facing the viewer.
    pub(crate) fn surface_facet(&self, hit: &Hit, direction: Vec3) -> Vec3 {
        let geometric = self.surface_edges(hit);
        let facing = if geometric.dot(direction) > 0.0 { -1.0 } else { 1.0 };
        geometric * (facing / geometric.dot(geometric).sqrt().max(1.0e-20))
    }

    /// Change of the corners' normals per meter of the triangle that was hit.
    fn surface_bend(&self, hit: &Hit) -> f32 {
        let triangle = &self.triangles[hit.triangle as usize];
        let [a, b, c] = [0, 1, 2].map(|k| Vec3::from(self.corners_of(hit)[k].normal));
        let (edge_1, edge_2) = (Vec3::from(triangle.edge_1), Vec3::from(triangle.edge_2));
        let turned = (b - a).dot(b - a) + (c - a).dot(c - a);
        let length = edge_1.dot(edge_1) + edge_2.dot(edge_2);
        (turned / length.max(1.0e-20)).sqrt()
    }

    /// Everything that shading needs at a hit. `cone` is the width of the ray at distance 1; `taps`: see [`TextureFootprint`].
    #[must_use]
    pub fn surface_at(&self, hit: &Hit, origin: Vec3, direction: Vec3, cone: f32, taps: f32) -> Surface {
        let material = self.material_load(self.corners_of(hit)[0].material);
        let geometric = self.surface_edges(hit);
        let facing = if geometric.dot(direction) > 0.0 { -1.0 } else { 1.0 };
        let facet = self.surface_facet(hit, direction);

        let uv = self.surface_uv(hit);
        let footprint = self.surface_footprint(hit, geometric, direction, cone * hit.distance, taps);
        let (flags, maps, more) = (material.flags, material.maps, material.more);

        let base = material.base * self.surface_texture(maps[0], uv, &footprint) * self.surface_color(hit);
        let rough = self.surface_texture(maps[1], uv, &footprint);
        let metallic = (material.metallic * rough.z).clamp(0.0, 1.0);
        let roughness = (material.roughness * rough.y).clamp(0.0, 1.0);
        let emission = material.emission * self.surface_texture(maps[3], uv, &footprint).truncate();
        let occlusion =
            1.0 + material.occlusion_strength * (self.surface_texture(more[0], uv, &footprint).x - 1.0);
        let transmission = material.transmission * self.surface_texture(more[1], uv, &footprint).x;

        let mut normal = self.mix(hit, |c| Vec3::from(c.normal).extend(0.0)).truncate() * facing;
        let bend = self.surface_bend(hit);
        let mut variance = surface_turn(bend, cone * hit.distance, facet.dot(direction));
        if maps[2] != SCENE_NONE {
            let tangent = self.mix(hit, |c| c.tangent.into());
            let relief = self.surface_texture(maps[2], uv, &footprint);
            let side = (normal * facing).cross(tangent.truncate()) * tangent.w;
            let scale = material.normal_scale;
            normal += tangent.truncate() * (relief.x * scale) + side * (relief.y * scale);
            variance += relief.z * (scale * scale);
        }
        normal /= normal.dot(normal).sqrt().max(1.0e-20);
        // A shading normal that faces away from the viewer is bent back to the horizon.
        let away = normal.dot(direction);
        if away > 0.0 {
            normal -= direction * (away + 0.01);
            normal /= normal.dot(normal).sqrt().max(1.0e-20);
        }
        // Unlit, the base color is all that is seen.
        let unlit = flags & SCENE_UNLIT != 0;
        let dielectric = (material.ior - 1.0) / (material.ior + 1.0);
        let f0 = if unlit { 0.0 } else { dielectric * dielectric };
        let metallic = if unlit { 0.0 } else { metallic };
        let color = base.truncate();
        let (mut behind, mut reflected) = (Vec3::ZERO, 1.0 - metallic);
        if self.is_translucent && !unlit {
            let texture = self.surface_texture(more[2], uv, &footprint);
            let part = (material.diffuse_transmission * texture.w).clamp(0.0, 1.0);
            let tint = self.surface_texture(more[3], uv, &footprint).truncate();
            behind = material.diffuse_transmission_color * tint * (part * reflected);
            reflected *= 1.0 - part;
        }
        Surface {
            position: origin + direction * hit.distance,
            alpha: base.w,
            normal,
            roughness: surface_roughness(roughness, variance),
            facet,
            occlusion: occlusion.clamp(0.0, 1.0),
            diffuse: color * reflected,
            flags,
            normal_reflectance: Vec3::splat(f0) * (1.0 - metallic) + color * metallic,
            transmission: transmission.clamp(0.0, 1.0) * (1.0 - metallic),
            emission,
            bend,
            porosity: surface_porosity(material.porosity, flags, roughness, metallic),
            film: 0.0,
            variance,
            diffuse_transmission: behind,
        }
    }
}
