//! A front door: paneled leaves, frame, fanlight, step, surround.

use glam::Vec3;

use super::{House, Opening, REVEAL_M};
use crate::material::Material;
use crate::mesh::{BEHIND, Mesh, plain, tinted};

/// Width of the opening.
pub(super) const WIDTH_M: f32 = 1.30;
/// Height of the leaves, and of leaves and fanlight.
const LEAF_M: f32 = 2.15;
const HEIGHT_M: f32 = 2.62;
/// Height of the step.
const STEP_M: f32 = 0.14;

/// The opening in the front for a door whose middle is at `x`.
pub(super) fn opening(house: &House, x: f32) -> Opening {
    let low = house.foot;
    Opening { x: [x - WIDTH_M / 2.0, x + WIDTH_M / 2.0], y: [low, low + STEP_M + HEIGHT_M], is_window: false }
}

/// Draws the door into its opening.
pub(super) fn door(house: &House, x: f32, mesh: &mut Mesh) {
    leaf(house, x, mesh);
    let stone = house.stone_paint();
    let half = WIDTH_M / 2.0;
    let top = house.foot + STEP_M + HEIGHT_M;
    for side in [-1.0, 1.0] {
        let middle = x + side * (half + 0.13);
        let p = |dx: f32, y: f32, z: f32| Vec3::new(middle + dx, y, z);
        mesh.beveled(stone, p(-0.13, house.foot, 0.0), p(0.13, top + 0.12, 0.07), 0.01);
        mesh.beveled(stone, p(-0.15, house.foot, 0.0), p(0.15, house.foot + 0.5, 0.10), 0.012);
        mesh.beveled(stone, p(-0.15, top - 0.14, 0.0), p(0.15, top + 0.12, 0.10), 0.01);
    }
    mesh.beveled(stone, Vec3::new(x - half, top, 0.0), Vec3::new(x + half, top + 0.26, 0.06), 0.01);
    mesh.beveled(stone, Vec3::new(x - 0.14, top - 0.02, 0.0), Vec3::new(x + 0.14, top + 0.30, 0.13), 0.02);
    let y = top + 0.26;
    let ledge = [
        [0.0, y],
        [0.08, y],
        [0.10, y + 0.04],
        [0.20, y + 0.07],
        [0.24, y + 0.12],
        [0.24, y + 0.15],
        [0.0, y + 0.18],
    ];
    mesh.molding(stone, [x - half - 0.34, x + half + 0.34], 0.0, &ledge);
}

/// Leaves, frame, fanlight and step alone.
pub(super) fn leaf(house: &House, x: f32, mesh: &mut Mesh) {
    let paint = tinted(Material::Joinery, house.door);
    let frame = tinted(Material::Joinery, house.door.map(|c| c * 1.15));
    let half = WIDTH_M / 2.0;
    let low = house.foot + STEP_M;
    let (z, top) = (-REVEAL_M, low + HEIGHT_M);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    for side in [-1.0, 1.0] {
        let (edge, inner) = (x + side * half, x + side * (half - 0.07));
        mesh.cuboid(
            frame,
            p(edge.min(inner), low - STEP_M, z - 0.1),
            p(edge.max(inner), top, z + 0.05),
            BEHIND,
        );
    }
    mesh.cuboid(frame, p(x - half, top - 0.06, z - 0.1), p(x + half, top, z + 0.05), BEHIND);
    mesh.cuboid(
        frame,
        p(x - half, low + LEAF_M, z - 0.1),
        p(x + half, low + LEAF_M + 0.09, z + 0.07),
        BEHIND,
    );
    let brass = tinted(Material::Alloy, [0.75, 0.58, 0.30]);
    for side in [-1.0f32, 1.0] {
        let (a, b) = (x + side * 0.005, x + side * (half - 0.07));
        let (l, r) = (a.min(b), a.max(b));
        mesh.cuboid(paint, p(l, low, z - 0.06), p(r, low + LEAF_M, z - 0.02), BEHIND);
        for [from, to] in [[l, l + 0.085], [r - 0.085, r]] {
            mesh.beveled(paint, p(from, low, z - 0.02), p(to, low + LEAF_M, z + 0.012), 0.006);
        }
        for [from, to] in [[0.0, 0.20], [0.86, 0.98], [1.44, 1.53], [2.03, LEAF_M]] {
            mesh.beveled(paint, p(l + 0.085, low + from, z - 0.02), p(r - 0.085, low + to, z + 0.010), 0.006);
        }
        // Raised fields of the panels.
        for [from, to] in [[0.26, 0.80], [1.04, 1.38], [1.59, 1.97]] {
            mesh.beveled(paint, p(l + 0.13, low + from, z - 0.02), p(r - 0.13, low + to, z - 0.002), 0.022);
        }
        mesh.lathe(
            brass,
            p(x + side * 0.07, low + 1.0, z + 0.05),
            &[[0.0, -0.03], [0.022, -0.02], [0.03, 0.0], [0.022, 0.02], [0.0, 0.03]],
            8,
        );
    }
    mesh.cuboid(paint, p(x - 0.025, low, z - 0.02), p(x + 0.025, low + LEAF_M, z + 0.03), BEHIND);
    mesh.cuboid(brass, p(x + 0.16, low + 0.9, z + 0.008), p(x + 0.40, low + 0.95, z + 0.022), BEHIND);
    // Fanlight before a dark hall.
    let (l, r, y) = (x - half + 0.07, x + half - 0.07, [low + LEAF_M + 0.09, top - 0.06]);
    mesh.quad(plain(Material::Glass), [p(l, y[0], z), p(r, y[0], z), p(r, y[1], z), p(l, y[1], z)]);
    let dark = plain(Material::Soil);
    let deep = z - 0.09;
    mesh.quad(dark, [p(l, y[0], deep), p(r, y[0], deep), p(r, y[1], deep), p(l, y[1], deep)]);
    for k in 1..4 {
        let at = l + (r - l) * k as f32 / 4.0;
        mesh.cuboid(frame, p(at - 0.012, y[0], z - 0.01), p(at + 0.012, y[1], z + 0.02), BEHIND);
    }
    let mut step = house.stone_paint();
    step.tint *= 0.72;
    mesh.cuboid(step, p(x - half - 0.18, house.foot - 0.1, z - 0.1), p(x + half + 0.18, low, 0.30), 0);
}
