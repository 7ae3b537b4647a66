//! A scene as plain data, for renderers and simulators, without files or a GPU.
//!
//! The model is that of glTF 2.0 (Khronos Group, version 2.0.1, ISO/IEC 12113:2022): meshes of triangles, metallic
//! and rough materials, a forest of nodes, skins, animations, lights and cameras. Axes are right-handed, +Y up,
//! in meters; front faces are counter-clockwise; colors of factors are linear with the primaries of BT.709.
//!
//! A [`Scene`] has no time; [`Scene::pose`] returns the transforms at a time. Objects name each other by index.
//! Scenes from a reader of this crate have valid indices only; an invalid one in a scene made by hand is ignored.

mod animation;
mod append;
mod camera;
mod interpolation;
mod light;
mod material;
mod mesh;
mod node;
mod pose;
mod skin;
mod skinning;
mod texture;

use crate::warning::Warning;

pub use animation::{Animation, Channel, Interpolation, Property, Track};
pub use camera::{Camera, Lens, PlacedCamera};
pub use light::{Light, LightKind, PlacedLight};
pub use material::{AlphaMode, Material, TextureRef};
pub use mesh::{Bounds, Mesh, MorphTarget, Primitive};
pub use node::{Local, Node, Parts};
pub use pose::{Instance, Placed, Play, Pose};
pub use skin::Skin;
pub use skinning::{SkinnedPrimitive, skin_primitive};
pub use texture::{Encoding, Filter, Sampler, Texture, Wrap};

/// Maximum distance of a vertex from the origin, in meters. Beyond it the steps between `f32` numbers are 64 m, and
/// squares of distances come near the end of the range of `f32`.
pub const REACH: f64 = 1e9;

/// Everything that a scene file holds.
///
/// ```
/// use downpour_scene::{Budget, sandbox::NoFiles, gltf::read_scene_from_bytes};
/// let json = br#"{
///     "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
///     "nodes": [{"camera": 0, "translation": [0, 1.7, 5]}],
///     "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}]
/// }"#;
/// let scene = read_scene_from_bytes("eye.gltf", json, &NoFiles, &mut Budget::default())?;
/// let pose = scene.pose(None, 0.0);
/// assert_eq!(pose.cameras[0].eye, [0.0, 1.7, 5.0].into());
/// assert_eq!(pose.cameras[0].forward, [0.0, 0.0, -1.0].into());
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name of the file in messages.
    pub name: String,
    /// Shapes; one may be drawn at many nodes.
    pub meshes: Vec<Mesh>,
    /// Materials of the surfaces.
    pub materials: Vec<Material>,
    /// Pictures with their samplers.
    pub textures: Vec<Texture>,
    /// Forest of nodes.
    pub nodes: Vec<Node>,
    /// Root nodes of the scene. Nodes that are not below them are not drawn.
    pub roots: Vec<usize>,
    /// Sets of joints that bend meshes.
    pub skins: Vec<Skin>,
    /// Movements of nodes over time.
    pub animations: Vec<Animation>,
    /// Lamps and suns.
    pub lights: Vec<Light>,
    /// Eyes.
    pub cameras: Vec<Camera>,
    /// Parts that were dropped or repaired.
    pub warnings: Vec<Warning>,
}

impl Scene {
    /// The number of triangles of all meshes, each counted once.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        let corners = self.meshes.iter().flat_map(|mesh| &mesh.primitives).map(|part| part.indices.len());
        corners.fold(0usize, usize::saturating_add) / 3
    }

    /// Size of geometry, animations and nodes in memory, in bytes; pictures are not counted.
    pub(crate) fn bytes(&self) -> u64 {
        let meshes = self.meshes.iter().flat_map(|mesh| &mesh.primitives).map(Primitive::bytes);
        let tracks = self.animations.iter().flat_map(|animation| &animation.channels);
        let tracks = tracks.map(|channel| channel.track.bytes());
        let nodes = (self.nodes.len() as u64).saturating_mul(size_of::<Node>() as u64);
        meshes.chain(tracks).fold(nodes, u64::saturating_add)
    }
}
