//! Obstacles that stop rain in a host application.

use downpour_math::in_range;
use downpour_shaders::render::scene::SCENE_MASKED;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::frame_scene::MAX_TRIANGLES;
use downpour_trace::material::{MaterialLook, TextureUse};
use downpour_trace::sky_light::SkyLight;
use glam::Affine3A;

use super::RainError;

/// Largest number of texels of an alpha texture along an edge.
const MAX_EDGE: u32 = 8192;

/// Triangles that stop rain and light, in the host's world.
#[derive(Clone, Copy, Debug)]
pub struct ObstacleMesh<'a> {
    /// Corners, m.
    pub triangles: &'a [[[f32; 3]; 3]],
    /// Holes through which rain and light pass, as in leaves, fences and gratings; `None`: there are none.
    pub holes: Option<AlphaHoles<'a>>,
}

impl<'a> ObstacleMesh<'a> {
    /// Triangles without holes.
    #[must_use]
    pub fn solid(triangles: &'a [[[f32; 3]; 3]]) -> Self {
        Self { triangles, holes: None }
    }
}

/// Holes of a mesh: where the alpha of a texture is below a cutoff, as in glTF's alpha mode `MASK`.
#[derive(Clone, Copy, Debug)]
pub struct AlphaHoles<'a> {
    /// Texture coordinates of the corners of each triangle: (0, 0) is the upper left corner of the texture; beyond 0 to 1 it repeats.
    pub uvs: &'a [[[f32; 2]; 3]],
    /// Columns and rows of the texture, 1 to 8192 each; above 2048 it is halved until it fits.
    pub size: [u32; 2],
    /// Alpha of its texels, row by row from the top; in between it is interpolated.
    pub alpha: &'a [u8],
    /// Alpha below which there is a hole, 0 to 1.
    pub cutoff: f32,
}

impl AlphaHoles<'_> {
    fn check(&self, triangles: usize) -> Result<(), RainError> {
        let wrong = |found: String, allowed: String| {
            Err(RainError::Texture { what: "alpha texture of obstacles", found, allowed })
        };
        let [columns, rows] = self.size;
        if self.size.iter().any(|edge| !(1..=MAX_EDGE).contains(edge)) {
            return wrong(format!("{columns} x {rows} texels"), format!("1 to {MAX_EDGE} each"));
        }
        let texels = u64::from(columns) * u64::from(rows);
        if self.alpha.len() as u64 != texels {
            let allowed = format!("{texels}, for {columns} x {rows} texels");
            return wrong(format!("{} values", self.alpha.len()), allowed);
        }
        if self.uvs.len() != triangles {
            let allowed = format!("those of the {triangles} triangles");
            return wrong(format!("coordinates of {} triangles", self.uvs.len()), allowed);
        }
        in_range("alpha cutoff of obstacles", self.cutoff, "", &(0.0..=1.0), 1.0, "0 to 1")?;
        Ok(())
    }
}

/// A scene of obstacles alone.
pub(super) fn scene_of(meshes: &[ObstacleMesh<'_>]) -> Result<SceneData, RainError> {
    let found = meshes.iter().map(|mesh| mesh.triangles.len() as u64).sum();
    if found > MAX_TRIANGLES {
        return Err(RainError::TooMany { quantity: "triangles", found, allowed: MAX_TRIANGLES });
    }
    let mut builder = SceneBuilder::new();
    let solid = builder.add_material(MaterialLook::default());
    for mesh in meshes {
        let positions: Vec<[f32; 3]> = mesh.triangles.iter().flatten().copied().collect();
        let indices: Vec<u32> = (0..positions.len() as u32).collect();
        let plain = MeshPart::plain(&positions, &indices, solid);
        let Some(holes) = mesh.holes else {
            builder.add_mesh(&plain, &Affine3A::IDENTITY);
            continue;
        };
        holes.check(mesh.triangles.len())?;
        let texels: Vec<[u8; 4]> = holes.alpha.iter().map(|&alpha| [255, 255, 255, alpha]).collect();
        let slot = builder.texture(holes.size[0], holes.size[1], &texels, TextureUse::Data);
        let slot = builder.add_slot(slot);
        let look = MaterialLook {
            flags: SCENE_MASKED,
            alpha_cutoff: holes.cutoff,
            maps: [Some(slot), None, None, None, None, None, None, None],
            ..MaterialLook::default()
        };
        let material = builder.add_material(look);
        let uvs: Vec<[f32; 2]> = holes.uvs.iter().flatten().copied().collect();
        let part = MeshPart { uvs: [Some(&uvs), None], material, ..plain };
        builder.add_mesh(&part, &Affine3A::IDENTITY);
    }
    Ok(builder.build(&SkyLight::uniform([0.0; 3])))
}
