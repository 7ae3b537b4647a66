//! Nodes with their transforms, and the skins that name them.

use super::fields;
use crate::error::SceneError;
use crate::gltf::accessor::Elements;
use crate::gltf::buffers::Buffers;
use crate::gltf::growth::GrowthBudget;
use crate::gltf::guard::Spot;
use crate::gltf::{instances, irregular};
use crate::scene::{Local, Node, Parts, Skin};
use crate::warning::Warnings;
use glam::{Affine3A, Mat3A, Quat, Vec3A};
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{self, Index, Root};

/// All nodes, and the roots of the scene. A file without nodes shows each of its meshes once.
pub(super) fn read(
    root: &Root,
    lights: &[Option<usize>],
    remaining: &mut GrowthBudget<'_>,
) -> Result<(Vec<Node>, Vec<usize>), SceneError> {
    let count = root.nodes.len().max(root.meshes.len()) as u64;
    remaining.take(count.saturating_mul(size_of::<Node>() as u64), "nodes")?;
    if root.nodes.is_empty() {
        let each = |mesh| Node { mesh: Some(mesh), ..Node::default() };
        return Ok(((0..root.meshes.len()).map(each).collect(), (0..root.meshes.len()).collect()));
    }
    let nodes = root.nodes.iter().enumerate().map(|(index, node)| Node {
        name: node.name.clone().unwrap_or_default(),
        children: node.children.iter().flatten().map(Index::value).collect(),
        local: local(node),
        mesh: node.mesh.map(|mesh| mesh.value()),
        skin: node.skin.map(|skin| skin.value()),
        camera: node.camera.map(|camera| camera.value()),
        light: lights.get(index).copied().flatten(),
        weights: node.weights.clone().unwrap_or_default(),
    });
    Ok((nodes.collect(), instances::roots(root)))
}

fn local(node: &json::Node) -> Local {
    if let Some(columns) = node.matrix {
        return Local::Matrix(affine(columns));
    }
    let usual = Parts::default();
    let [x, y, z, w] = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |turn| turn.0.map(f64::from));
    let length = (x * x + y * y + z * z + w * w).sqrt();
    let unit = [x, y, z, w].map(|part| if length > 0.0 { fields::single(part / length) } else { 0.0 });
    Local::Parts(Parts {
        translation: node.translation.map_or(usual.translation, Into::into),
        rotation: Quat::from_array(unit),
        scale: node.scale.map_or(usual.scale, Into::into),
    })
}

/// A matrix given by its columns. The last row is 0 0 0 1 by the specification.
fn affine(columns: [f32; 16]) -> Affine3A {
    let [a, b, c, _, d, e, f, _, g, h, i, _, x, y, z, _] = columns;
    let matrix3 = Mat3A::from_cols(Vec3A::new(a, b, c), Vec3A::new(d, e, f), Vec3A::new(g, h, i));
    Affine3A { matrix3, translation: Vec3A::new(x, y, z) }
}

/// All skins.
pub(super) fn skins(
    document: &Spot<'_>,
    root: &Root,
    buffers: &Buffers<'_>,
    remaining: &mut GrowthBudget<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<Skin>, SceneError> {
    let mut all = Vec::new();
    document.each(&["skins", "[]"], &mut |spot| {
        let mut joints = Vec::new();
        let list = spot.need("joints")?;
        for joint in list.items()? {
            joints.push(usize::try_from(joint.whole()?).unwrap_or(usize::MAX));
        }
        if joints.is_empty() {
            return Err(list.not("one joint or more"));
        }
        remaining.take((joints.len() as u64).saturating_mul(64), spot.trail)?;
        let inverse_bind = match spot.get("inverseBindMatrices")? {
            None => vec![Affine3A::IDENTITY; joints.len()],
            Some(link) => inverse_bind(&link, joints.len(), root, buffers, warnings)?,
        };
        all.push(Skin { name: fields::name(spot)?, joints, inverse_bind });
        Ok(())
    })?;
    Ok(all)
}

fn inverse_bind(
    link: &Spot<'_>,
    joints: usize,
    root: &Root,
    buffers: &Buffers<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<Affine3A>, SceneError> {
    let index = Index::new(u32::try_from(link.whole()?).unwrap_or(u32::MAX));
    let fits = |accessor: &&json::Accessor| {
        let float =
            matches!(accessor.component_type, Checked::Valid(GenericComponentType(ComponentType::F32)));
        float && accessor.type_ == Checked::Valid(Type::Mat4)
    };
    if root.get(index).filter(fits).is_none() {
        return Err(link.wrong("an accessor of another format", "MAT4 of 5126 (float)"));
    }
    let mut elements = Elements::open(root, buffers, index)?;
    if elements.count() < joints {
        let found = format!("an accessor of {} elements", elements.count());
        return Err(link.wrong(found, format!("{joints} or more, as there are {joints} joints")));
    }
    let mut all = Vec::with_capacity(joints);
    let mut odd = 0usize;
    while let (true, Some(columns)) = (all.len() < joints, elements.numbers::<16>(0.0)?) {
        if !columns.iter().all(|part| part.is_finite()) {
            return Err(link.wrong(format!("not finite at element {}", all.len()), "finite numbers"));
        }
        let [_, _, _, a, _, _, _, b, _, _, _, c, _, _, _, d] = columns;
        odd = odd.saturating_add(usize::from([a, b, c, d] != [0.0, 0.0, 0.0, 1.0]));
        all.push(affine(columns.map(fields::single)));
    }
    if odd > 0 {
        irregular(warnings, link.trail, || format!("{odd} last rows other than 0 0 0 1: ignored"));
    }
    Ok(all)
}
