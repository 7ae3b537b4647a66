//! Poses: animations, skins, morph targets, lights and cameras in the world.

use crate::figure::figure;
use crate::{document::with, good};
use downpour_scene::scene::{Lens, LightKind, Local, Play, Scene, skin_primitive};
use glam::{Affine3A, Quat, Vec3};
use serde_json::json;

fn close(a: Vec3, b: Vec3) {
    assert!(a.distance(b) < 1e-5, "{a} {b}");
}

fn vertices(scene: &Scene, time: f32) -> Vec<Vec3> {
    let pose = scene.pose(Some(0), time);
    assert_eq!((pose.instances.len(), pose.left_out), (1, 0));
    let instance = &pose.instances[0];
    skin_primitive(&scene.meshes[instance.mesh].primitives[0], instance).positions
}

/// Numbers of the file, taken over as they are.
#[test]
fn the_figure_is_read() {
    let scene = good(&figure());
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!((scene.nodes.len(), &scene.roots[..]), (5, &[0, 3, 4][..]));
    assert_eq!(scene.skins[0].joints, [0, 1]);
    assert_eq!(scene.skins[0].inverse_bind[1], Affine3A::from_translation(Vec3::new(0.0, -1.0, 0.0)));
    let light = &scene.lights[0];
    assert_eq!((light.intensity, light.range, light.color), (40.0, Some(9.0), Vec3::new(1.0, 0.5, 0.0)));
    assert_eq!(light.kind, LightKind::Spot { inner: 0.0, outer: 0.5 });
    let far = Some(50.0);
    assert_eq!(scene.cameras[0].lens, Lens::Perspective { yfov: 1.0, aspect: None, near: 0.1, far });
    assert_eq!((scene.animations[0].name.as_str(), scene.animations[0].length_s()), ("walk", 3.0));
    // Without normals in the file each corner has that of its face, in the space of the mesh.
    assert_eq!(scene.meshes[0].primitives[0].normals, [Vec3::Z; 3]);
    assert_eq!(scene.meshes[0].primitives[0].material, 0);
    assert_eq!(scene.materials.len(), 1);
}

/// At rest a skinned mesh is at its joints, not at its node.
#[test]
fn a_skin_stands_where_its_joints_are() {
    let scene = good(&figure());
    let instance = &scene.pose(None, 0.0).instances[0];
    let skinned = skin_primitive(&scene.meshes[0].primitives[0], instance);
    close(skinned.positions[0], Vec3::new(0.0, 0.0, 5.0));
    close(skinned.positions[2], Vec3::new(0.0, 2.0, 5.0));
    close(skinned.normals[2], Vec3::Z);
}

/// At each key the values of the file; between them those of the formulae; after the end from the beginning.
#[test]
fn movements_meet_their_keys() {
    let scene = good(&figure());
    // Key 1: the hip has moved 2 m, the knee has turned a quarter, so that points above it are to its left; the
    // morph target moves vertex 1 by 4 m.
    let at_key = vertices(&scene, 1.0);
    close(at_key[0], Vec3::new(2.0, 0.0, 0.0));
    close(at_key[1], Vec3::new(3.0, 0.0, 4.0));
    close(at_key[2], Vec3::new(1.0, 1.0, 0.0));
    // At 1/2: an eighth of a turn (slerp); a spline with flat ends is 3 t^2 - 2 t^3, 1/2 in the middle.
    let half = 0.5f32.sqrt();
    let middle = vertices(&scene, 0.5);
    close(middle[0], Vec3::new(1.0, 0.0, 0.0));
    close(middle[1], Vec3::new(2.0, 0.0, 0.0));
    close(middle[2], Vec3::new(1.0 - half, 1.0 + half, 0.0));
    // At 1/4: 3/16 - 2/64 = 5/32 of the shift, a sixteenth of a turn.
    let quarter = vertices(&scene, 0.25);
    let angle = std::f32::consts::FRAC_PI_8;
    close(quarter[0], Vec3::new(2.0 * 5.0 / 32.0, 0.0, 0.0));
    let turned = Quat::from_rotation_z(angle).mul_vec3(Vec3::Y);
    close(quarter[2], Vec3::new(2.0 * 5.0 / 32.0, 1.0, 0.0) + turned);
    for (time, same) in [(3.0, 0.0), (4.0, 1.0), (-2.0, 1.0), (f32::NAN, 0.0), (301.0, 1.0)] {
        for (a, b) in vertices(&scene, time).into_iter().zip(vertices(&scene, same)) {
            close(a, b);
        }
    }
}

#[test]
fn lights_and_cameras_are_in_the_world() {
    let scene = good(&figure());
    let pose = scene.pose(None, 0.0);
    close(pose.lights[0].position, Vec3::new(0.0, 2.0, 5.0));
    close(pose.lights[0].direction, Vec3::NEG_Z);
    // Half a turn about Y; the scale of 2 has no effect.
    close(pose.cameras[0].forward, Vec3::Z);
    close(pose.cameras[0].up, Vec3::Y);
    // Half a second: the knee has turned by an eighth, and the lamp is 1 m above it.
    let pose = scene.pose(Some(0), 0.5);
    let half = 0.5f32.sqrt();
    close(pose.lights[0].position, Vec3::new(1.0 - half, 1.0 + half, 0.0));
    assert_eq!(pose.world(9), None);
}

/// An infinite number in a track does not reach the drawn meshes.
#[test]
fn what_leads_too_far_is_left_out() {
    let mut scene = good(&figure());
    scene.animations[0].channels[1].track.values.fill(3e38);
    let pose = scene.pose(Some(0), 0.5);
    assert_eq!((pose.instances.len(), pose.left_out), (0, 1));
    assert!(pose.lights.iter().all(|light| light.position.is_finite()));
    // Invalid links and cycles are ignored.
    scene.nodes[2].children = vec![0, 2, 77];
    scene.nodes[4].mesh = Some(8);
    scene.roots.push(99);
    scene.animations[0].channels[0].node = 55;
    assert!(
        scene
            .pose_of(&[Play { animation: 0, time_s: 1.0 }, Play { animation: 4, time_s: 1.0 }])
            .instances
            .is_empty()
    );
}

/// A scene in another one moves as a whole, by its animation, with its materials.
#[test]
fn scenes_are_put_together() {
    let figure = good(&figure());
    let mut street = good(&crate::document::triangle());
    assert_eq!(street.materials.len(), 1);
    let turn =
        Affine3A::from_rotation_translation(Quat::from_rotation_y(std::f32::consts::FRAC_PI_2), Vec3::X);
    let first = street.append(figure.clone(), turn);
    let second = street.append(figure, Affine3A::from_scale(Vec3::splat(3.0)));
    assert_eq!((first, second, &street.roots[..]), (6, 12, &[0, 6, 12][..]));
    assert_eq!((street.meshes[2].primitives[0].material, street.materials.len()), (2, 3));
    let plays = [Play { animation: 0, time_s: 1.0 }, Play { animation: 1, time_s: 0.0 }];
    let pose = street.pose_of(&plays);
    assert_eq!((pose.instances.len(), pose.lights.len(), pose.cameras.len()), (3, 2, 2));
    let position = |instance: usize| {
        let instance = &pose.instances[instance];
        skin_primitive(&street.meshes[instance.mesh].primitives[0], instance).positions
    };
    // (1, 1, 0) of `movements_meet_their_keys`, turned about Y: x to -z, and shifted.
    close(position(1)[2], Vec3::new(1.0, 1.0, -1.0));
    close(position(2)[2], Vec3::new(0.0, 6.0, 0.0));
    let model = street.triangles(&pose);
    assert_eq!((model.indices.len(), model.positions.len()), (3, 9));
    assert!(matches!(street.nodes[6].local, Local::Matrix(_)));
}

/// Rotations as normalized integers, and weights for two targets.
#[test]
fn quantized_rotations_are_unit_quaternions() {
    let mut bytes = crate::figure::bytes();
    let turns: [i16; 12] = [0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 0, 32767];
    bytes[268..292].copy_from_slice(&turns.iter().flat_map(|part| part.to_le_bytes()).collect::<Vec<_>>());
    let short =
        json!({"bufferView": 5, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC4"});
    let document = with(crate::figure::figure_of(&bytes), &[("/accessors/5", short)]);
    close(vertices(&good(&document), 1.0)[2], Vec3::new(1.0, 1.0, 0.0));
}
