//! A front door: panelled leaf, frame, fanlight, step.

use glam::Vec3;

use super::{House, Opening, ground_m, window};
use crate::scenes::material::Material;
use crate::scenes::mesh::{BEHIND, Mesh, tinted};

/// Width of the opening.
const WIDTH_M: f32 = 1.06;
/// Height of the leaf, and of leaf and fanlight.
const LEAF_M: f32 = 2.1;
const HEIGHT_M: f32 = 2.55;
/// Height of the step.
const STEP_M: f32 = 0.13;

/// The opening in the front for a door whose middle is at `x`.
pub(super) fn opening(x: f32) -> Opening {
    let low = ground_m();
    Opening { x: [x - WIDTH_M / 2.0, x + WIDTH_M / 2.0], y: [low, low + STEP_M + HEIGHT_M], is_window: false }
}

/// Draws the door into its opening.
pub(super) fn door(house: &House, x: f32, mesh: &mut Mesh) {
    leaf(house, x, mesh);
    let step = house.stone_paint();
    mesh.block(step, [x - 0.72, ground_m() - 0.1, -0.2], [1.44, STEP_M + 0.1, 0.56]);
    // Stone posts and a hood on brackets.
    let top = ground_m() + STEP_M + HEIGHT_M;
    let half = WIDTH_M / 2.0;
    for side in [-1.0, 1.0] {
        let middle = x + side * (half + 0.11);
        mesh.cuboid(
            step,
            Vec3::new(middle - 0.11, ground_m(), 0.0),
            Vec3::new(middle + 0.11, top + 0.1, 0.06),
            BEHIND,
        );
        mesh.cuboid(
            step,
            Vec3::new(middle - 0.09, top + 0.1, 0.0),
            Vec3::new(middle + 0.09, top + 0.32, 0.22),
            BEHIND,
        );
    }
    mesh.block(step, [x - half - 0.32, top + 0.32, 0.0], [WIDTH_M + 0.64, 0.12, 0.34]);
    mesh.cuboid(step, Vec3::new(x - half, top, 0.0), Vec3::new(x + half, top + 0.32, 0.03), BEHIND);
}

/// Leaf, frame and fanlight alone.
pub(super) fn leaf(house: &House, x: f32, mesh: &mut Mesh) {
    let paint = tinted(Material::Joinery, house.door);
    let frame = tinted(Material::Joinery, [0.55, 0.53, 0.48]);
    let half = WIDTH_M / 2.0;
    let low = ground_m() + STEP_M;
    let (z, top) = (-0.15, low + HEIGHT_M);
    for side in [-1.0, 1.0] {
        let edge = x + side * half;
        let inner = edge - side * 0.07;
        mesh.cuboid(
            frame,
            Vec3::new(edge.min(inner), low - STEP_M, z),
            Vec3::new(edge.max(inner), top, z + 0.07),
            BEHIND,
        );
    }
    mesh.cuboid(frame, Vec3::new(x - half, top - 0.06, z), Vec3::new(x + half, top, z + 0.07), BEHIND);
    mesh.cuboid(
        frame,
        Vec3::new(x - half, low + LEAF_M, z),
        Vec3::new(x + half, low + LEAF_M + 0.08, z + 0.09),
        BEHIND,
    );
    let (l, r) = (x - half + 0.07, x + half - 0.07);
    mesh.cuboid(paint, Vec3::new(l, low, z - 0.02), Vec3::new(r, low + LEAF_M, z + 0.01), BEHIND);
    // Stiles and rails are in front of sunk panels.
    let middle = x;
    for [a, b] in [[l, l + 0.11], [middle - 0.05, middle + 0.05], [r - 0.11, r]] {
        mesh.cuboid(paint, Vec3::new(a, low, z), Vec3::new(b, low + LEAF_M, z + 0.035), BEHIND);
    }
    for [a, b] in [[0.0, 0.22], [0.78, 0.92], [1.52, 1.62], [1.98, LEAF_M]] {
        mesh.cuboid(paint, Vec3::new(l, low + a, z), Vec3::new(r, low + b, z + 0.032), BEHIND);
    }
    let brass = tinted(Material::Alloy, [0.75, 0.55, 0.25]);
    mesh.lathe(
        brass,
        Vec3::new(r - 0.06, low + 0.98, z + 0.07),
        &[[0.0, -0.025], [0.022, -0.015], [0.028, 0.0], [0.022, 0.015], [0.0, 0.025]],
        6,
    );
    mesh.block(brass, [middle - 0.11, low + 0.83, z + 0.03], [0.22, 0.045, 0.015]);
    let light = Opening { x: [l, r], y: [low + LEAF_M + 0.08, top - 0.06], is_window: true };
    window::glaze(mesh, house.seed.is_multiple_of(3), 5, &light, z + 0.01);
    mesh.cuboid(
        frame,
        Vec3::new(x - 0.012, low + LEAF_M + 0.08, z),
        Vec3::new(x + 0.012, top - 0.06, z + 0.03),
        BEHIND,
    );
}
