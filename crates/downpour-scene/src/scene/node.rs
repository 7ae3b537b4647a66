//! Nodes with their transforms (glTF 2.0, section 3.5).

use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3, Quat, Vec3};

/// A node of the forest, and the objects at it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Name in the file; may be empty.
    pub name: String,
    /// Nodes that move with it.
    pub children: Vec<usize>,
    /// Transform relative to its parent.
    pub local: Local,
    /// The mesh that is drawn here.
    pub mesh: Option<usize>,
    /// The skin that bends the mesh.
    pub skin: Option<usize>,
    /// Camera at this node.
    pub camera: Option<usize>,
    /// The light that shines from here.
    pub light: Option<usize>,
    /// Weights of the morph targets; empty for those of the mesh.
    pub weights: Vec<f32>,
}

/// A transform relative to the parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Local {
    /// Any affine map. Animations leave it as it is.
    Matrix(Affine3A),
    /// Scale, then rotation, then translation.
    Parts(Parts),
}

/// The parts of a transform: translation x rotation x scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    /// In meters.
    pub translation: Vec3,
    /// A unit quaternion; zero for a file's rotation of length 0, which has no inverse.
    pub rotation: Quat,
    /// Scale along the node's axes.
    pub scale: Vec3,
}

impl Default for Parts {
    fn default() -> Self {
        Self { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE }
    }
}

impl Default for Local {
    fn default() -> Self {
        Self::Parts(Parts::default())
    }
}

impl Local {
    /// The map in double precision.
    #[must_use]
    pub fn matrix(&self) -> DAffine3 {
        match self {
            Self::Matrix(matrix) => {
                let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(glam::Vec3A::as_dvec3);
                DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: matrix.translation.as_dvec3() }
            }
            Self::Parts(parts) => parts.matrix(),
        }
    }
}

impl Parts {
    /// The map in double precision. The rotation is made a unit quaternion first; one of length 0 gives a map
    /// without inverse.
    #[must_use]
    pub fn matrix(&self) -> DAffine3 {
        let [x, y, z, w] = self.rotation.to_array().map(f64::from);
        let length = (x * x + y * y + z * z + w * w).sqrt();
        let translation = self.translation.as_dvec3();
        if length == 0.0 {
            return DAffine3::from_scale_rotation_translation(DVec3::ZERO, DQuat::IDENTITY, translation);
        }
        let rotation = DQuat::from_xyzw(x / length, y / length, z / length, w / length);
        DAffine3::from_scale_rotation_translation(self.scale.as_dvec3(), rotation, translation)
    }
}
