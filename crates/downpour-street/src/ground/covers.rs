//! Manhole covers in the road, gullies in the gutters.

use downpour_math::ops;
use glam::Vec3;

use super::Ground;
use crate::dice::Dice;
use crate::material::Material;
use crate::mesh::{Mesh, plain, tinted};

/// Distance between gullies along a gutter.
const GULLIES_M: f32 = 14.0;

pub(super) fn covers(ground: &Ground, mesh: &mut Mesh) {
    let mut dice = Dice::new(ground.random, 111);
    let mut z = -dice.range(4.0, 10.0);
    while z > -ground.length + 2.0 {
        cover(ground, mesh, dice.range(-0.5, 0.5) * ground.half_road, z);
        z -= dice.range(11.0, 22.0);
    }
    for side in [-1.0, 1.0] {
        let mut z = -dice.range(3.0, 9.0);
        while z > -ground.length + 3.0 {
            gully(ground, mesh, side, z);
            z -= GULLIES_M;
        }
    }
}

/// A round cover in its frame.
fn cover(ground: &Ground, mesh: &mut Mesh, x: f32, z: f32) {
    // The frame lies as high as the highest point of its rim.
    let around = |k: i32| {
        let angle = k as f32 / 28.0 * std::f32::consts::TAU;
        (ops::cos(angle), -ops::sin(angle))
    };
    let rim = |k: i32| {
        let (c, s) = around(k);
        ground.road_height(x + 0.36 * c, z + 0.36 * s)
    };
    let y = (0..28).map(rim).fold(f32::MIN, f32::max) - 0.012;
    let foot = Vec3::new(x, y, z);
    mesh.lathe(
        tinted(Material::Iron, [0.30, 0.28, 0.26]),
        foot,
        &[[0.37, -0.03], [0.37, 0.016], [0.36, 0.02], [0.312, 0.02], [0.308, 0.012]],
        28,
    );
    let ring: Vec<Vec3> = (0..28)
        .map(|k| {
            let (c, s) = around(k);
            foot + Vec3::new(0.308 * c, 0.0145, 0.308 * s)
        })
        .collect();
    mesh.polygon(plain(Material::Cover), &ring);
}

/// A grating over a shaft in the gutter.
fn gully(ground: &Ground, mesh: &mut Mesh, side: f32, z: f32) {
    let x = side * (ground.half_road - 0.17);
    let y = 0.012 + ground.gutter_wave(z, u32::from(side > 0.0)).max(0.0);
    let bars = tinted(Material::Iron, [0.28, 0.26, 0.24]);
    mesh.block(plain(Material::Soil), [x - 0.15, y - 0.06, z - 0.22], [0.30, 0.05, 0.44]);
    for bar in 0..7 {
        mesh.block(bars, [x - 0.15, y - 0.03, z - 0.215 + bar as f32 * 0.066], [0.30, 0.034, 0.03]);
    }
    for edge in [-0.165, 0.145] {
        mesh.block(bars, [x + edge, y - 0.03, z - 0.235], [0.02, 0.038, 0.47]);
    }
}
