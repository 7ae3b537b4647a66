//! Meshes: triangles with the data for shading, skinning and texturing.

use glam::{Vec2, Vec3, Vec4};

/// A shape of one or more primitives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Name in the file; may be empty.
    pub name: String,
    /// Its parts, one for each material. Empty for a mesh that no node of the scene draws.
    pub primitives: Vec<Primitive>,
    /// Default weights of the morph targets, used if neither node nor animation has others.
    pub weights: Vec<f32>,
}

/// Triangles of one material, in the space of the mesh.
///
/// Each list of vertex data has as many elements as `positions` or is empty. All numbers are finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitive {
    /// Vertices, in meters.
    pub positions: Vec<Vec3>,
    /// Unit normals: those of the file, or else those of the faces.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the sign of the bitangent in `w`: those of the file, or those of `MikkTSpace` if the
    /// material has a normal map. Empty otherwise.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates of sets 0 and 1, origin at the upper left; empty if the file has none.
    pub uvs: [Vec<Vec2>; 2],
    /// Linear colors that multiply the base color, in [0, 1].
    pub colors: Option<Vec<Vec4>>,
    /// Joints of the skin that move a vertex.
    pub joints: Vec<[u16; 4]>,
    /// Weight of each joint; the sum is 1.
    pub weights: Vec<[f32; 4]>,
    /// Shapes that this one can turn into.
    pub morphs: Vec<MorphTarget>,
    /// Three indices for each triangle, counter-clockwise seen from the front.
    pub indices: Vec<u32>,
    /// The material.
    pub material: usize,
    /// Bounding box of all vertices.
    pub bounds: Bounds,
}

/// Differences added to a primitive, times a weight.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// Added to positions, in meters; empty for none.
    pub positions: Vec<Vec3>,
    /// Added to normals; empty for none.
    pub normals: Vec<Vec3>,
    /// The length of the longest of `positions`, in meters.
    pub farthest: f32,
}

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The smallest coordinates, in meters.
    pub min: Vec3,
    /// The largest coordinates, in meters.
    pub max: Vec3,
}

impl Default for Bounds {
    /// The empty box.
    fn default() -> Self {
        Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY }
    }
}

impl Bounds {
    /// Bounding box of points.
    ///
    /// ```
    /// use downpour_scene::scene::Bounds;
    /// let bounds = Bounds::of(&[[1.0, 2.0, 0.0].into(), [-1.0, 3.0, 0.0].into()]);
    /// assert_eq!((bounds.min.x, bounds.max.y), (-1.0, 3.0));
    /// assert!(Bounds::of(&[]).is_empty());
    /// ```
    #[must_use]
    pub fn of(points: &[Vec3]) -> Self {
        let grow = |all: Self, &point: &Vec3| Self { min: all.min.min(point), max: all.max.max(point) };
        points.iter().fold(Self::default(), grow)
    }

    /// True if the box is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 8] {
        let (a, b) = (self.min, self.max);
        [
            a,
            Vec3::new(b.x, a.y, a.z),
            Vec3::new(a.x, b.y, a.z),
            Vec3::new(b.x, b.y, a.z),
            Vec3::new(a.x, a.y, b.z),
            Vec3::new(b.x, a.y, b.z),
            Vec3::new(a.x, b.y, b.z),
            b,
        ]
    }

    /// Bounding box of both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }
}

impl Primitive {
    /// True if it has joints for a skin.
    #[must_use]
    pub fn is_skinned(&self) -> bool {
        !self.joints.is_empty() && self.joints.len() == self.weights.len()
    }

    /// Size in memory, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let of = |count: usize, size: u64| (count as u64).saturating_mul(size);
        let [first, second] = &self.uvs;
        let morphs =
            self.morphs.iter().map(|morph| of(morph.positions.len().saturating_add(morph.normals.len()), 12));
        [
            of(self.positions.len(), 12),
            of(self.normals.len(), 12),
            of(self.tangents.len(), 16),
            of(first.len(), 8),
            of(second.len(), 8),
            of(self.colors.as_ref().map_or(0, Vec::len), 16),
            of(self.joints.len(), 8),
            of(self.weights.len(), 16),
            of(self.indices.len(), 4),
        ]
        .into_iter()
        .chain(morphs)
        .fold(0, u64::saturating_add)
    }
}
