//! Pose of a scene: transforms of all objects at a time.
//!
//! The world matrix of a node is that of its parent times its local one (glTF 2.0, section 3.5.3), computed in double
//! precision. A skinned mesh is transformed by its joints: the transform of its node has no effect on it
//! (section 3.7.3.3).

use super::REACH;
use super::light::PlacedLight;
use super::mesh::{Bounds, Mesh};
use super::{Local, Node, Parts, PlacedCamera, Property, Scene};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Quat, Vec3};

/// Minimum ratio of the volume of a matrix to the product of the lengths of its columns. Below it the columns lie in
/// one plane but for rounding.
const FLAT: f64 = 1e-10;

/// An animation and the time in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Play {
    /// Index of the animation.
    pub animation: usize,
    /// Time in seconds; beyond the animation's length it repeats.
    pub time_s: f32,
}

/// A node that is somewhere else than its scene says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// The node.
    pub node: usize,
    /// From the node to its parent, instead of its own transform.
    pub transform: DAffine3,
}

/// The state of a scene at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// All meshes that are drawn, in the order of the walk from the roots down.
    pub instances: Vec<Instance>,
    /// Every light.
    pub lights: Vec<PlacedLight>,
    /// Every camera.
    pub cameras: Vec<PlacedCamera>,
    /// Number of meshes that are not drawn because their transform has no inverse, as one with a scale of 0, or leads
    /// farther than [`REACH`] from the origin.
    pub left_out: usize,
    world: Vec<DAffine3>,
}

/// A mesh with its transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Node of the mesh.
    pub node: usize,
    /// The mesh.
    pub mesh: usize,
    /// From the mesh to the world.
    pub world: Affine3A,
    /// For normals: the inverse transpose of `world`. Normalize after it.
    pub normal: Mat3,
    /// True if the transform mirrors, so that triangles are clockwise: swap two corners, or the sides that are
    /// culled. The sign of the bitangents is reversed too.
    pub mirrored: bool,
    /// For primitives with joints: from the mesh to the world, for each joint of the skin; `world` and `normal`
    /// are not for them. Empty without a skin.
    pub joints: Vec<Affine3A>,
    /// The weights of the morph targets.
    pub weights: Vec<f32>,
}

impl Pose {
    /// The world matrix of a node, drawn or not.
    #[must_use]
    pub fn world(&self, node: usize) -> Option<Affine3A> {
        self.world.get(node).map(narrow)
    }

    /// The world matrix of a node in double precision.
    #[must_use]
    pub fn world_f64(&self, node: usize) -> Option<DAffine3> {
        self.world.get(node).copied()
    }

    /// Bounding box of all instances, in meters. Skinned and morphed ones lie in it, but may not fill it.
    #[must_use]
    pub fn bounds(&self, scene: &Scene) -> Bounds {
        let each = self.instances.iter().filter_map(|instance| {
            let mesh = scene.meshes.get(instance.mesh)?;
            Some(extent(mesh, instance))
        });
        each.fold(Bounds::default(), Bounds::union)
    }
}

impl Scene {
    /// Pose at a time in seconds of one animation, or at rest without one. Beyond the length of
    /// the animation it repeats.
    ///
    /// ```
    /// use downpour_scene::scene::{Mesh, Node, Scene};
    /// let node = Node { mesh: Some(0), ..Node::default() };
    /// let scene = Scene { meshes: vec![Mesh::default()], nodes: vec![node], roots: vec![0], ..Scene::default() };
    /// let pose = scene.pose(None, 0.0);
    /// assert_eq!(pose.instances.len(), 1);
    /// assert_eq!(pose.world(0), Some(glam::Affine3A::IDENTITY));
    /// ```
    #[must_use]
    pub fn pose(&self, animation: Option<usize>, time_s: f32) -> Pose {
        match animation {
            None => self.pose_of(&[]),
            Some(animation) => self.pose_of(&[Play { animation, time_s }]),
        }
    }

    /// Pose of several animations that run at once, each at its time; if two move the same
    /// property, the later in the list wins.
    #[must_use]
    pub fn pose_of(&self, plays: &[Play]) -> Pose {
        self.pose_with(plays, &[])
    }

    /// As [`Scene::pose_of`], with some nodes in other places. Animations that move such a node have no effect on it.
    #[must_use]
    pub fn pose_with(&self, plays: &[Play], places: &[Placed]) -> Pose {
        let mut locals: Vec<Local> = self.nodes.iter().map(|node| node.local).collect();
        let mut weights: Vec<Option<Vec<f32>>> = vec![None; self.nodes.len()];
        let mut value = Vec::new();
        for play in plays {
            let Some(animation) = self.animations.get(play.animation) else { continue };
            let time = animation.wrapped(play.time_s);
            for channel in &animation.channels {
                channel.track.sample(time, &mut value);
                match (channel.property, locals.get_mut(channel.node), weights.get_mut(channel.node)) {
                    (Property::Weights, _, Some(weights)) => {
                        *weights = Some(value.iter().map(|&part| single(part)).collect());
                    }
                    (property, Some(Local::Parts(parts)), _) => move_parts(parts, property, &value),
                    _ => {}
                }
            }
        }
        let mut locals: Vec<DAffine3> = locals.iter().map(Local::matrix).collect();
        for place in places {
            if let Some(local) = locals.get_mut(place.node) {
                *local = place.transform;
            }
        }
        let (world, drawn) = self.walk(&locals);
        let mut pose = Pose { world, ..Pose::default() };
        for node in drawn {
            self.add_node(node, weights.get_mut(node).and_then(Option::take), &mut pose);
        }
        pose
    }

    /// For each node, whether what it shows may move while some animations run and some nodes are [placed](Placed): it, a node above it or a
    /// joint of its skin is among those that they move. Numbers without an animation or a node have no effect.
    ///
    /// ```
    /// use downpour_scene::scene::{Node, Scene};
    /// let node = |children: &[usize]| Node { children: children.to_vec(), ..Node::default() };
    /// let scene = Scene { nodes: vec![node(&[1]), node(&[]), node(&[])], roots: vec![0, 2], ..Scene::default() };
    /// assert_eq!(scene.moving_nodes(&[], &[0]), [true, true, false]);
    /// ```
    #[must_use]
    pub fn moving_nodes(&self, animations: &[usize], placed: &[usize]) -> Vec<bool> {
        let of = animations.iter().filter_map(|&animation| self.animations.get(animation));
        let mut open: Vec<usize> = of.flat_map(|of| &of.channels).map(|channel| channel.node).collect();
        open.extend(placed);
        let mut moves = vec![false; self.nodes.len()];
        while let Some(node) = open.pop() {
            if let (Some(moves), Some(node)) =
                (moves.get_mut(node).filter(|moves| !**moves), self.nodes.get(node))
            {
                *moves = true;
                open.extend(&node.children);
            }
        }
        let is_bent = |node: &Node| {
            let skin = node.skin.and_then(|skin| self.skins.get(skin));
            let joints = skin.map_or(&[][..], |skin| &skin.joints);
            joints.iter().any(|&joint| moves.get(joint).is_some_and(|&moves| moves))
        };
        let bent: Vec<bool> = self.nodes.iter().map(is_bent).collect();
        for (moves, is_bent) in moves.iter_mut().zip(bent) {
            *moves |= is_bent;
        }
        moves
    }

    /// Nodes below the roots, in the order of the walk.
    pub(crate) fn drawn(&self) -> Vec<usize> {
        let locals: Vec<DAffine3> = self.nodes.iter().map(|node| node.local.matrix()).collect();
        self.walk(&locals).1
    }

    /// World matrices of all nodes, and the nodes below the roots in the order of the walk.
    fn walk(&self, locals: &[DAffine3]) -> (Vec<DAffine3>, Vec<usize>) {
        let mut world: Vec<Option<DAffine3>> = vec![None; self.nodes.len()];
        let mut drawn = Vec::new();
        let mut open: Vec<(usize, DAffine3)> =
            self.roots.iter().rev().map(|&root| (root, DAffine3::IDENTITY)).collect();
        let mut is_child = vec![false; self.nodes.len()];
        for &child in self.nodes.iter().flat_map(|node| &node.children) {
            if let Some(is_child) = is_child.get_mut(child) {
                *is_child = true;
            }
        }
        // After the scene, nodes outside it: joints may be among them.
        let elsewhere = is_child.iter().enumerate().filter(|(_, is_child)| !**is_child).map(|(node, _)| node);
        let mut rest = elsewhere.fuse();
        let mut in_scene = true;
        loop {
            let Some((node, parent)) = open.pop() else {
                in_scene = false;
                match rest.next() {
                    Some(root) => open.push((root, DAffine3::IDENTITY)),
                    None => break,
                }
                continue;
            };
            // Each node is visited once, even with invalid links in a scene made by hand.
            let (Some(slot @ None), Some(local)) = (world.get_mut(node), locals.get(node)) else { continue };
            let matrix = product(&parent, local);
            *slot = Some(matrix);
            if in_scene {
                drawn.push(node);
            }
            let children = self.nodes.get(node).map_or(&[][..], |node| &node.children);
            open.extend(children.iter().rev().map(|&child| (child, matrix)));
        }
        (world.into_iter().map(|matrix| matrix.unwrap_or(DAffine3::IDENTITY)).collect(), drawn)
    }

    /// Adds the objects of a node to the pose.
    fn add_node(&self, index: usize, weights: Option<Vec<f32>>, pose: &mut Pose) {
        let (Some(node), Some(&world)) = (self.nodes.get(index), pose.world.get(index)) else { return };
        let direction = |axis: DVec3| {
            let turned = world.matrix3.mul_vec3(axis);
            turned.try_normalize().unwrap_or(axis)
        };
        let position = world.translation.as_vec3();
        let forward = direction(DVec3::NEG_Z);
        if let Some(light) = node.light.filter(|&light| light < self.lights.len() && position.is_finite()) {
            pose.lights.push(PlacedLight { node: index, light, position, direction: forward.as_vec3() });
        }
        if let Some(camera) =
            node.camera.filter(|&camera| camera < self.cameras.len() && position.is_finite())
        {
            let up = direction(DVec3::Y).reject_from_normalized(forward);
            let up = up.try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
            let (forward, up) = (forward.as_vec3(), up.as_vec3());
            pose.cameras.push(PlacedCamera { node: index, camera, eye: position, forward, up });
        }
        let Some((mesh, shape)) = node.mesh.and_then(|mesh| Some((mesh, self.meshes.get(mesh)?))) else {
            return;
        };
        let weights = weights.unwrap_or_else(|| {
            if node.weights.is_empty() { shape.weights.clone() } else { node.weights.clone() }
        });
        let joints = self.joints(node.skin, &pose.world);
        let instance = instance(index, mesh, &world, &joints, weights);
        match instance.filter(|instance| within_reach(shape, instance)) {
            Some(instance) => pose.instances.push(instance),
            None => pose.left_out = pose.left_out.saturating_add(1),
        }
    }

    /// The matrices of a skin.
    fn joints(&self, skin: Option<usize>, world: &[DAffine3]) -> Vec<DAffine3> {
        let Some(skin) = skin.and_then(|skin| self.skins.get(skin)) else { return Vec::new() };
        let each = skin.joints.iter().enumerate().map(|(nth, &joint)| {
            let bind =
                skin.inverse_bind.get(nth).map_or(DAffine3::IDENTITY, |&bind| Local::Matrix(bind).matrix());
            world.get(joint).map_or(bind, |world| product(world, &bind))
        });
        each.collect()
    }
}

/// Stores an animated value.
fn move_parts(parts: &mut Parts, property: Property, value: &[f64]) {
    match (property, value) {
        (Property::Translation, &[x, y, z]) => parts.translation = Vec3::new(single(x), single(y), single(z)),
        (Property::Scale, &[x, y, z]) => parts.scale = Vec3::new(single(x), single(y), single(z)),
        (Property::Rotation, &[x, y, z, w]) => {
            parts.rotation = Quat::from_xyzw(single(x), single(y), single(z), single(w));
        }
        _ => {}
    }
}

/// An instance; `None` if its transform has no inverse. With a skin only the joints matter.
fn instance(
    node: usize,
    mesh: usize,
    world: &DAffine3,
    joints: &[DAffine3],
    weights: Vec<f32>,
) -> Option<Instance> {
    let normal = normal_map(&world.matrix3);
    let mirrored = world.matrix3.determinant() < 0.0;
    let (world, normal, mirrored) = match (normal, joints.first()) {
        (Some(normal), None) => (narrow(world), normal, mirrored),
        (None, None) => return None,
        // The first joint with a volume determines the handedness of the others.
        (_, Some(first)) => {
            let solid = joints.iter().find(|joint| normal_map(&joint.matrix3).is_some()).unwrap_or(first);
            let normal = normal.unwrap_or(Mat3::IDENTITY);
            (narrow(world), normal, solid.matrix3.determinant() < 0.0)
        }
    };
    let finite = world.is_finite() && normal.is_finite() && joints.iter().all(DAffine3::is_finite);
    let finite = finite && weights.iter().all(|weight| weight.is_finite());
    let joints: Vec<Affine3A> = joints.iter().map(narrow).collect();
    (finite && joints.iter().all(Affine3A::is_finite)).then_some(Instance {
        node,
        mesh,
        world,
        normal,
        mirrored,
        joints,
        weights,
    })
}

/// Inverse transpose; `None` if columns lie in a plane, or numbers are not finite.
fn normal_map(linear: &DMat3) -> Option<Mat3> {
    let volume = linear.determinant();
    let lengths = linear.x_axis.length() * linear.y_axis.length() * linear.z_axis.length();
    // NaN and infinity fail the comparisons.
    let solid = volume.abs() > FLAT * lengths && volume.abs() < f64::MAX;
    let normal = linear.inverse().transpose();
    // Only the direction matters: scaled to fit single precision for any scale of the node.
    let largest = normal.x_axis.abs().max(normal.y_axis.abs()).max(normal.z_axis.abs()).max_element();
    let scaled = if (1e-18..1e18).contains(&largest) { normal } else { scaled(&normal, largest) };
    (solid && normal.is_finite()).then(|| scaled.as_mat3()).filter(Mat3::is_finite)
}

fn scaled(matrix: &DMat3, largest: f64) -> DMat3 {
    DMat3::from_cols_array(&matrix.to_cols_array().map(|part| part / largest))
}

/// Bounding box of an instance in the world.
fn extent(mesh: &Mesh, instance: &Instance) -> Bounds {
    let (mut rigid, mut bent) = (Bounds::default(), Bounds::default());
    for part in mesh.primitives.iter().filter(|part| !part.bounds.is_empty()) {
        let weights = instance.weights.iter().zip(&part.morphs);
        let grown: f32 = weights.map(|(weight, morph)| weight.abs() * morph.farthest).sum();
        let Bounds { min, max } = part.bounds;
        let grown = Bounds {
            min: Vec3::new(min.x - grown, min.y - grown, min.z - grown),
            max: Vec3::new(max.x + grown, max.y + grown, max.z + grown),
        };
        let skinned = part.is_skinned() && !instance.joints.is_empty();
        let all = if skinned { &mut bent } else { &mut rigid };
        *all = all.union(grown);
    }
    // Each box once through each of its matrices.
    let through = |bounds: Bounds, matrices: &[Affine3A]| {
        let corners = bounds.corners();
        let each = |matrix: &Affine3A| Bounds::of(&corners.map(|corner| matrix.transform_point3(corner)));
        let matrices = if bounds.is_empty() { &[] } else { matrices };
        matrices.iter().map(each).fold(Bounds::default(), Bounds::union)
    };
    through(rigid, std::slice::from_ref(&instance.world)).union(through(bent, &instance.joints))
}

fn within_reach(mesh: &Mesh, instance: &Instance) -> bool {
    let bounds = extent(mesh, instance);
    let far = bounds.min.abs().max(bounds.max.abs()).max_element();
    bounds.is_empty() || f64::from(far) <= REACH
}

/// The map `a` after `b`.
fn product(a: &DAffine3, b: &DAffine3) -> DAffine3 {
    DAffine3 { matrix3: a.matrix3.mul_mat3(&b.matrix3), translation: a.transform_point3(b.translation) }
}

fn narrow(matrix: &DAffine3) -> Affine3A {
    Affine3A::from_mat3_translation(matrix.matrix3.as_mat3(), matrix.translation.as_vec3())
}

/// Double to single precision.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is meant; what overflows is left out afterwards"
)]
fn single(value: f64) -> f32 {
    value as f32
}
