//! Many models in one scene.

use super::{Local, Node, Scene};
use glam::Affine3A;

impl Scene {
    /// Adds another scene to this one, with a transform, and returns the node above it.
    ///
    /// Indices of the other scene are moved up: its animation `i` becomes `self.animations.len() + i` of before.
    ///
    /// ```
    /// use downpour_scene::scene::{Node, Scene};
    /// use glam::{Affine3A, Vec3};
    /// let lamp = Scene { nodes: vec![Node::default()], roots: vec![0], ..Scene::default() };
    /// let mut street = Scene::default();
    /// for i in 0..3 {
    ///     street.append(lamp.clone(), Affine3A::from_translation(Vec3::new(12.0 * i as f32, 0.0, 0.0)));
    /// }
    /// assert_eq!((street.roots.len(), street.nodes.len()), (3, 6));
    /// ```
    pub fn append(&mut self, other: Scene, transform: Affine3A) -> usize {
        let (meshes, materials, textures) = (self.meshes.len(), self.materials.len(), self.textures.len());
        let (nodes, skins, lights) = (self.nodes.len(), self.skins.len(), self.lights.len());
        let cameras = self.cameras.len();
        self.meshes.extend(other.meshes.into_iter().map(|mut mesh| {
            mesh.primitives.iter_mut().for_each(|part| raise(&mut part.material, materials));
            mesh
        }));
        self.materials.extend(other.materials.into_iter().map(|mut material| {
            material.textures_mut().for_each(|used| raise(&mut used.texture, textures));
            material
        }));
        self.textures.extend(other.textures);
        self.nodes.extend(other.nodes.into_iter().map(|mut node| {
            node.children.iter_mut().for_each(|child| raise(child, nodes));
            let links = [
                (&mut node.mesh, meshes),
                (&mut node.skin, skins),
                (&mut node.light, lights),
                (&mut node.camera, cameras),
            ];
            links.into_iter().for_each(|(link, by)| link.iter_mut().for_each(|index| raise(index, by)));
            node
        }));
        self.skins.extend(other.skins.into_iter().map(|mut skin| {
            skin.joints.iter_mut().for_each(|joint| raise(joint, nodes));
            skin
        }));
        self.animations.extend(other.animations.into_iter().map(|mut animation| {
            animation.channels.iter_mut().for_each(|channel| raise(&mut channel.node, nodes));
            animation
        }));
        self.lights.extend(other.lights);
        self.cameras.extend(other.cameras);
        self.warnings.extend(other.warnings);
        let children = other.roots.into_iter().map(|root| root.saturating_add(nodes)).collect();
        let node = self.nodes.len();
        self.nodes.push(Node {
            name: other.name,
            children,
            local: Local::Matrix(transform),
            ..Node::default()
        });
        self.roots.push(node);
        node
    }
}

fn raise(index: &mut usize, by: usize) {
    *index = index.saturating_add(by);
}
