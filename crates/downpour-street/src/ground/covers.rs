//! Manhole covers in the road, gullies in the gutters.

use downpour_math::ops;
use glam::Vec3;

use super::{GUTTER_LOW_M, GUTTER_M, Ground};
use crate::dice::Dice;
use crate::material::Material;
use crate::mesh::{Mesh, plain, tinted};

/// Distance between gullies along a gutter.
const GULLIES_M: f32 = 14.0;

/// Distances from the curb between which the gutter is open at a gully: points of the profile of the gutter.
pub(super) const GULLY_REACH_M: [f32; 2] = [GUTTER_LOW_M, GUTTER_M];

/// Half the length of that opening.
const GULLY_HALF_M: f32 = 0.22;

/// Width of a bar of the grating.
const BAR_M: f32 = 0.03;

/// Depth of a shaft: what lies below all streets is deeper.
const SHAFT_M: f32 = 0.24;

/// Depth of a gutter's low part at a gully, distance along the gutter at which 1/e of it is left, and at which nothing is.
const DIP_M: f32 = 0.02;
const DIP_REACH_M: f32 = 0.8;
const DIP_END_M: f32 = 6.0 * DIP_REACH_M;

/// A gully in a gutter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gully {
    /// -1 on the left, 1 on the right.
    side: f32,
    z: f32,
}

impl Gully {
    /// Number of its gutter: 1 on the right.
    fn gutter(&self) -> u32 {
        u32::from(self.side > 0.0)
    }
}

/// Where the manhole covers, x and z, and the gullies of a street are.
pub(super) fn plan(random: u64, length: f32, half_road: f32) -> (Vec<[f32; 2]>, Vec<Gully>) {
    let mut dice = Dice::new(random, 111);
    let mut covers = Vec::new();
    let mut z = -dice.range(4.0, 10.0);
    while z > -length + 2.0 {
        covers.push([dice.range(-0.5, 0.5) * half_road, z]);
        z -= dice.range(11.0, 22.0);
    }
    let mut gullies = Vec::new();
    for side in [-1.0, 1.0] {
        let mut z = -dice.range(3.0, 9.0);
        while z > -length + 3.0 {
            gullies.push(Gully { side, z });
            z -= GULLIES_M;
        }
    }
    (covers, gullies)
}

impl Ground {
    /// The parts of the gutter on a side, 1 on the right, that gullies open: from z to z.
    pub(super) fn openings(&self, side: u32) -> Vec<[f32; 2]> {
        let own = self.gullies.iter().filter(|gully| gully.gutter() == side);
        own.map(|gully| [gully.z - GULLY_HALF_M, gully.z + GULLY_HALF_M]).collect()
    }

    /// How much the gutter on a side, 1 on the right, is lower at z, where water runs to a gully.
    pub(super) fn gutter_dip(&self, z: f32, side: u32) -> f32 {
        let is_near = |gully: &&Gully| gully.gutter() == side && (z - gully.z).abs() < DIP_END_M;
        let dip = |gully: &Gully| {
            let away = (z - gully.z) / DIP_REACH_M;
            DIP_M * ops::exp(-away * away)
        };
        self.gullies.iter().filter(is_near).map(dip).sum()
    }
}

pub(super) fn covers(ground: &Ground, mesh: &mut Mesh) {
    for &[x, z] in &ground.covers {
        cover(ground, mesh, x, z);
    }
    for gully in &ground.gullies {
        grating(ground, mesh, gully);
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

/// A grating over a shaft in the gutter, as low as the gutter is at the curb.
fn grating(ground: &Ground, mesh: &mut Mesh, gully: &Gully) {
    let top = ground.gutter_wave(gully.z, gully.gutter()) + 0.002;
    let road = top + ground.edge();
    let bars = tinted(Material::Iron, [0.28, 0.26, 0.24]);
    let wall = plain(Material::Soil);
    // From the curb to the road, and along the gutter.
    let [near, far] = GULLY_REACH_M;
    let half = GULLY_HALF_M;
    let mut block = |paint, across: [f32; 2], heights: [f32; 2], along: [f32; 2]| {
        let x = across.map(|distance| gully.side * (ground.half_road - distance));
        let low = [x[0].min(x[1]), heights[0], gully.z + along[0]];
        mesh.block(paint, low, [(x[1] - x[0]).abs(), heights[1] - heights[0], along[1] - along[0]]);
    };
    let pitch = (2.0 * half - BAR_M) / 6.0;
    for bar in 0..7u8 {
        let from = pitch * f32::from(bar) - half;
        block(bars, [near, far], [top - 0.034, top], [from, from + BAR_M]);
    }
    block(bars, [near - 0.004, near + 0.016], [top - 0.034, top + 0.002], [-half, half]);
    block(bars, [far - 0.016, far + 0.004], [top - 0.034, road], [-half, half]);
    // The shaft, under the gutter around it.
    let (floor, rim) = (top - SHAFT_M, top - 0.004);
    block(wall, [near - 0.03, near], [floor, rim], [-half - 0.03, half + 0.03]);
    block(wall, [far, far + 0.03], [floor, rim], [-half - 0.03, half + 0.03]);
    block(wall, [near, far], [floor, rim], [-half - 0.03, -half]);
    block(wall, [near, far], [floor, rim], [half, half + 0.03]);
    block(wall, [near, far], [floor - 0.02, floor], [-half, half]);
}
