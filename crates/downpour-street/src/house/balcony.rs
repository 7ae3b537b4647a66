//! Railings of iron, balconies of stone, flower boxes.

use glam::Vec3;

use super::{House, Story};
use crate::material::Material;
use crate::mesh::{BEHIND, Mesh, Paint, tinted};
use crate::noise::{hash, mix};
use crate::tree::foliage::Twig;

const IRON: [f32; 3] = [0.085, 0.088, 0.088];

/// Bars between two rails along x, with rings under the upper one.
fn bars(mesh: &mut Mesh, x: [f32; 2], y: [f32; 2], z: f32, gap: f32) {
    let iron = tinted(Material::Iron, IRON);
    let p = |x: f32, y: f32| Vec3::new(x, y, z);
    for (at, thick) in [(y[0], 0.018), (y[1], 0.032), (y[1] - 0.12, 0.014)] {
        mesh.bar(iron, p(x[0], at), p(x[1], at), thick);
    }
    let count = ((x[1] - x[0]) / gap).round().max(1.0) as i32;
    for k in 0..=count {
        let at = x[0] + (x[1] - x[0]) * k as f32 / count as f32;
        mesh.bar(iron, p(at, y[0]), p(at, y[1] - 0.12), 0.014);
        if k < count && k % 2 == 0 && gap > 0.14 {
            // A cross between the upper rails.
            let next = x[0] + (x[1] - x[0]) * (k + 1) as f32 / count as f32;
            mesh.bar(iron, p(at, y[1] - 0.115), p(next, y[1] - 0.01), 0.010);
            mesh.bar(iron, p(next, y[1] - 0.115), p(at, y[1] - 0.01), 0.010);
        }
    }
}

/// A railing in the opening of a window.
pub(super) fn rail([w, _]: [f32; 2], mesh: &mut Mesh) {
    bars(mesh, [0.0, w], [0.06, 0.92], -0.03, 0.125);
}

/// Bars before a window of the ground floor.
pub(super) fn grille([w, h]: [f32; 2], mesh: &mut Mesh) {
    let iron = tinted(Material::Iron, IRON);
    let p = |x: f32, y: f32| Vec3::new(x, y, -0.05);
    let count = (w / 0.14).round() as i32;
    for k in 1..count {
        let x = w * k as f32 / count as f32;
        mesh.bar(iron, p(x, 0.0), p(x, h), 0.016);
    }
    for y in [0.2 * h, 0.8 * h] {
        mesh.bar(iron, p(0.0, y), p(w, y), 0.02);
    }
}

/// A slab on consoles with balusters and a rail of stone.
pub(super) fn stone([w, _]: [f32; 2], paint: Paint, mesh: &mut Mesh) {
    let (a, b, out) = (-0.28, w + 0.28, 0.46);
    slab(mesh, paint, [a, b], -0.12, out);
    for x in [a + 0.1, b - 0.26] {
        console(mesh, paint, x, -0.27);
    }
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let (low, high) = (-0.08, 0.62);
    mesh.cuboid(paint, p(a + 0.02, high, out - 0.20), p(b - 0.02, high + 0.11, out - 0.02), 0);
    for x in [a + 0.02, b - 0.18] {
        mesh.cuboid(paint, p(x, low, out - 0.19), p(x + 0.16, high, out - 0.03), 0);
        mesh.cuboid(paint, p(x + 0.02, low, 0.0), p(x + 0.14, high, 0.06), BEHIND);
        mesh.cuboid(paint, p(x + 0.02, high, 0.0), p(x + 0.14, high + 0.11, out - 0.2), BEHIND);
    }
    let count = ((b - a - 0.4) / 0.17).round() as i32;
    for k in 0..count {
        let x = a + 0.26 + (b - a - 0.52) * k as f32 / (count - 1).max(1) as f32;
        let profile = [
            [0.055, 0.0],
            [0.055, 0.05],
            [0.03, 0.07],
            [0.06, 0.26],
            [0.028, 0.5],
            [0.05, 0.64],
            [0.055, high - low],
        ];
        mesh.lathe(paint, p(x, low, out - 0.11), &profile, 6);
    }
}

/// A molded slab before the wall; its top is at `top`.
fn slab(mesh: &mut Mesh, paint: Paint, x: [f32; 2], top: f32, out: f32) {
    let profile = [
        [0.0, top - 0.14],
        [out - 0.10, top - 0.14],
        [out - 0.09, top - 0.10],
        [out - 0.03, top - 0.08],
        [out, top - 0.05],
        [out, top + 0.03],
        [0.0, top + 0.045],
    ];
    mesh.molding(paint, x, 0.0, &profile);
}

/// A bracket under a slab, 16 cm wide.
fn console(mesh: &mut Mesh, paint: Paint, x: f32, top: f32) {
    let profile = [
        [0.0, top - 0.38],
        [0.05, top - 0.36],
        [0.08, top - 0.24],
        [0.16, top - 0.16],
        [0.30, top - 0.10],
        [0.34, top],
        [0.0, top],
    ];
    mesh.molding(paint, [x, x + 0.16], 0.0, &profile);
}

/// A balcony along all windows of a story, with an iron railing.
pub(super) fn long(house: &House, floor: f32, _story: &Story, mesh: &mut Mesh) {
    let paint = house.stone_paint();
    let (a, b, out) = (0.12, house.width_m - 0.22, 0.62);
    let top = floor + 0.10;
    slab(mesh, paint, [a, b], top, out);
    for bay in 0..=house.bays {
        let x = 0.45 + (house.width_m - 0.9) * bay as f32 / house.bays as f32;
        console(mesh, paint, (x - 0.08).clamp(a, b - 0.16), top - 0.14);
    }
    let y = [top + 0.10, top + 0.98];
    bars(mesh, [a + 0.03, b - 0.03], y, out - 0.05, 0.15);
    // The ends go back to the wall.
    let iron = tinted(Material::Iron, IRON);
    for x in [a + 0.03, b - 0.03] {
        for (at, thick) in [(y[0], 0.018), (y[1], 0.032), (y[1] - 0.12, 0.014)] {
            mesh.bar(iron, Vec3::new(x, at, 0.0), Vec3::new(x, at, out - 0.05), thick);
        }
        for k in 1..4 {
            let z = (out - 0.05) * k as f32 / 4.0;
            mesh.bar(iron, Vec3::new(x, y[0], z), Vec3::new(x, y[1] - 0.12, z), 0.014);
        }
        mesh.bar(iron, Vec3::new(x, top, out - 0.05), Vec3::new(x, y[1], out - 0.05), 0.028);
    }
}

/// A box with plants on the sill.
pub(super) fn flowers(w: f32, mesh: &mut Mesh) {
    let clay = tinted(Material::Stone, [0.40, 0.20, 0.13]);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let z = [-0.16, 0.02];
    mesh.cuboid(clay, p(0.12, 0.0, z[0]), p(w - 0.12, 0.16, z[1]), 0);
    let count = (w * 7.0) as i32;
    for k in 0..count {
        let r = |n: u32| hash(k, 5, 360 + n);
        let x = 0.14 + (w - 0.28) * k as f32 / count as f32;
        let at = p(x, 0.13 + 0.05 * r(0), z[0] + 0.05 + 0.08 * r(1));
        let along = Vec3::Y + p(1.4 * (r(2) - 0.5), 0.0, 1.2 * (r(3) - 0.5));
        let tint = Vec3::splat(0.7 + 0.3 * r(4));
        Twig { at, along, size: mix(0.18, 0.26, r(5)), out: Vec3::Z, tint, id: 9200 + k }.grow(mesh);
    }
}
