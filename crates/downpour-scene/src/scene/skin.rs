//! Skins: glTF 2.0, section 3.7.3.

use glam::Affine3A;

/// Joints that bend a mesh. The matrix of joint `i` is the world matrix of its node times `inverse_bind[i]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Name in the file; may be empty.
    pub name: String,
    /// Nodes.
    pub joints: Vec<usize>,
    /// Transforms from the space of the mesh to that of each joint; as many as joints.
    pub inverse_bind: Vec<Affine3A>,
}
