//! A shop on the ground floor: glazed front with pilasters, sign and awning, and the room behind.

use glam::{Vec2, Vec3};

use super::{Built, DEPTH_M, House, Opening, Shop, door};
use crate::material::Material;
use crate::mesh::{BEHIND, BELOW, LEFT, Mesh, Paint, plain, tinted};
use crate::noise::{hash, mix};
use crate::textures::SIGNS;

/// Height of the glass over the pavement, and of the board above.
const GLASS_M: f32 = 2.62;
const BOARD_M: [f32; 2] = [2.74, 3.22];
/// Projection of the awning, and the heights of its edges over the pavement.
const AWNING_M: [f32; 3] = [1.25, 2.78, 2.36];
/// Depth of the room.
const ROOM_M: f32 = 3.2;
/// Width at the right of the house door.
const DOOR_M: f32 = 1.7;

/// The opening of a shop in the front; it takes in the door beside it.
pub(super) fn opening(house: &House) -> Opening {
    let y = [house.foot, house.foot + GLASS_M + 0.1];
    Opening { x: [0.3, house.width_m - 0.3], y, is_window: false }
}

impl Shop {
    /// Draws the shop.
    pub(super) fn build(&self, house: &House, built: &mut Built) {
        let low = house.foot;
        let mesh = &mut built.mesh;
        let (left, right) = (0.3, house.width_m - 0.3 - DOOR_M);
        let paint = tinted(Material::Joinery, self.paint);
        let entrance = [mix(left, right, 0.5) - 0.48, mix(left, right, 0.5) + 0.48];
        self.glazing(mesh, [left, right], entrance, low);
        // The house's door, between wall and shop.
        let middle = right + DOOR_M * 0.5;
        let (material, tint) = house.base;
        let wall = tinted(material, tint);
        let half = door::WIDTH_M / 2.0;
        let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        let top = low + GLASS_M + 0.14;
        for [a, b] in [[right, middle - half], [middle + half, house.width_m - 0.3]] {
            mesh.cuboid(wall, p(a, low - 0.05, -0.3), p(b, top, 0.0), BEHIND | BELOW);
        }
        mesh.cuboid(wall, p(middle - half, low + 2.76, -0.3), p(middle + half, top, 0.0), BEHIND);
        door::leaf(house, middle, mesh);
        built.doors = vec![entrance, [middle - half, middle + half]];
        // Pilasters with base and capital, board, ledge.
        for x in [left - 0.18, right - 0.1] {
            mesh.beveled(paint, p(x, low, 0.0), p(x + 0.28, low + BOARD_M[1], 0.09), 0.012);
            mesh.beveled(paint, p(x - 0.03, low, 0.0), p(x + 0.31, low + 0.34, 0.12), 0.012);
            mesh.beveled(paint, p(x + 0.05, low + 0.5, 0.0), p(x + 0.23, low + 2.5, 0.105), 0.014);
            mesh.beveled(paint, p(x - 0.03, low + 2.62, 0.0), p(x + 0.31, low + 2.74, 0.14), 0.012);
        }
        let (a, b) = (left - 0.2, right + 0.2);
        mesh.cuboid(paint, p(a, low + GLASS_M - 0.02, -0.05), p(b, low + BOARD_M[1] + 0.06, 0.07), BEHIND);
        let y = low + BOARD_M[1] + 0.06;
        let ledge = [
            [0.0, y],
            [0.10, y],
            [0.12, y + 0.03],
            [0.22, y + 0.06],
            [0.24, y + 0.10],
            [0.24, y + 0.12],
            [0.0, y + 0.15],
        ];
        mesh.molding(paint, [a - 0.06, b + 0.06], 0.0, &ledge);
        let z = 0.085;
        let wide = ((b - a) / 2.0 - 0.35).min(2.1);
        let (x0, x1) = (mix(a, b, 0.5) - wide, mix(a, b, 0.5) + wide);
        let height = (wide / 4.0).min(0.5 * (BOARD_M[1] - BOARD_M[0]));
        let center = (BOARD_M[0] + BOARD_M[1]) / 2.0;
        let v = |t: f32| (self.sign as f32 + t) / SIGNS as f32;
        mesh.quad_uv(
            plain(Material::Sign),
            [
                p(x0, low + center - height, z),
                p(x1, low + center - height, z),
                p(x1, low + center + height, z),
                p(x0, low + center + height, z),
            ],
            [[0.0, v(0.99)], [1.0, v(0.99)], [1.0, v(0.01)], [0.0, v(0.01)]].map(Vec2::from),
        );
        if let Some(stripes) = self.awning {
            awning(mesh, [a, b], low, stripes);
        }
        projecting(self, mesh, b + 0.25, low);
        let is_open = hash(house.seed as i32, 3, 350) < 0.8;
        room(mesh, house.seed, [left, right], low, is_open);
    }

    /// Stall riser, and panes with bars on both sides of a glazed door.
    fn glazing(&self, mesh: &mut Mesh, [left, right]: [f32; 2], door: [f32; 2], low: f32) {
        let paint = tinted(Material::Joinery, self.paint);
        let (z, top) = (-0.10, low + GLASS_M);
        let mut bar = |x: [f32; 2], y: [f32; 2], thick: f32| {
            mesh.cuboid(paint, Vec3::new(x[0], y[0], z - 0.03), Vec3::new(x[1], y[1], z + thick), 0);
        };
        for side in [[left, door[0]], [door[1], right]] {
            bar(side, [low, low + 0.48], 0.03);
            bar(side, [low + 0.48, low + 0.54], 0.06);
            bar(side, [top - 0.06, top], 0.03);
            let middle = mix(side[0], side[1], 0.5);
            for x in [side[0] + 0.02, middle, side[1] - 0.02] {
                bar([x - 0.025, x + 0.025], [low + 0.54, top - 0.06], 0.03);
            }
            bar(side, [low + 2.0, low + 2.04], 0.02);
        }
        bar([door[0], door[0] + 0.1], [low + 0.02, top], 0.02);
        bar([door[1] - 0.1, door[1]], [low + 0.02, top], 0.02);
        bar(door, [low + 0.02, low + 0.3], 0.02);
        bar(door, [low + 2.05, low + 2.15], 0.02);
        bar(door, [top - 0.06, top], 0.02);
        let p = |x: f32, y: f32| Vec3::new(x, low + y, z - 0.01);
        mesh.quad(
            plain(Material::Glass),
            [p(left, 0.02), p(right, 0.02), p(right, GLASS_M), p(left, GLASS_M)],
        );
        mesh.block(
            tinted(Material::Stone, [0.4, 0.39, 0.36]),
            [door[0] - 0.1, low - 0.1, -0.2],
            [1.16, 0.12, 0.32],
        );
    }
}

/// A small sign on an arm, across the pavement.
fn projecting(shop: &Shop, mesh: &mut Mesh, x: f32, low: f32) {
    let iron = tinted(Material::Iron, [0.10; 3]);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, low + y, z);
    mesh.bar(iron, p(x, 3.32, 0.0), p(x, 3.32, 0.82), 0.025);
    mesh.bar(iron, p(x, 3.02, 0.0), p(x, 3.30, 0.5), 0.014);
    let paint = tinted(Material::Joinery, shop.paint);
    mesh.cuboid(paint, p(x - 0.018, 2.74, 0.18), p(x + 0.018, 3.26, 0.76), 0);
    let v = |t: f32| (shop.sign as f32 + t) / SIGNS as f32;
    for side in [-1.0f32, 1.0] {
        let at = x + side * 0.02;
        let (z0, z1) = if side > 0.0 { (0.74, 0.20) } else { (0.20, 0.74) };
        mesh.quad_uv(
            plain(Material::Sign),
            [p(at, 2.96, z0), p(at, 2.96, z1), p(at, 3.04, z1), p(at, 3.04, z0)],
            [[0.0, v(0.95)], [1.0, v(0.95)], [1.0, v(0.05)], [0.0, v(0.05)]].map(Vec2::from),
        );
    }
}

/// Cloth in stripes from under the board outwards, with a valance and arms.
fn awning(mesh: &mut Mesh, [a, b]: [f32; 2], low: f32, stripes: [[f32; 3]; 2]) {
    let [out, high, end] = AWNING_M;
    let count = ((b - a) / 0.24).round() as usize;
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, low + y, z);
    for k in 0..count {
        let paint = tinted(Material::Cloth, stripes[k % 2]);
        let x0 = mix(a, b, k as f32 / count as f32);
        let x1 = mix(a, b, (k + 1) as f32 / count as f32);
        // The cloth sags a little between wall and bar.
        let rows = 5;
        let point =
            |x: f32, t: f32| p(x, mix(high, end, t) - 0.09 * 4.0 * t * (1.0 - t) * 0.5, 0.08 + out * t);
        for row in 0..rows {
            let (s, t) = (row as f32 / rows as f32, (row + 1) as f32 / rows as f32);
            mesh.quad(paint, [point(x0, t), point(x1, t), point(x1, s), point(x0, s)]);
        }
        // The valance is below the bar, with a rounded edge.
        let z = 0.08 + out;
        let middle = (x0 + x1) * 0.5;
        let outline = [
            p(x0, end, z),
            p(x0, end - 0.13, z),
            p(mix(x0, middle, 0.5), end - 0.18, z),
            p(middle, end - 0.195, z),
            p(mix(middle, x1, 0.5), end - 0.18, z),
            p(x1, end - 0.13, z),
            p(x1, end, z),
        ];
        mesh.polygon(paint, &outline);
    }
    let iron = tinted(Material::Iron, [0.12; 3]);
    for x in [a + 0.06, b - 0.06] {
        let arm = [(p(x, 2.2, 0.02), 0.014), (p(x, end - 0.02, 0.06 + out), 0.014)];
        mesh.tube(iron, &arm, 6);
    }
    mesh.tube(iron, &[(p(a, end, 0.07 + out), 0.018), (p(b, end, 0.07 + out), 0.018)], 7);
}

/// The room: floor, walls, shelves with goods, a table in the window, light.
fn room(mesh: &mut Mesh, seed: u32, [left, right]: [f32; 2], low: f32, is_open: bool) {
    let (front, back, top) = (-0.2, -ROOM_M, low + GLASS_M + 0.1);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let wall = tinted(Material::Goods, [0.36, 0.30, 0.23]);
    let floor = tinted(Material::Wood, [0.36, 0.25, 0.16]);
    let y = low + 0.02;
    mesh.quad(floor, [p(left, y, front), p(right, y, front), p(right, y, back), p(left, y, back)]);
    mesh.quad(wall, [p(left, low, back), p(right, low, back), p(right, top, back), p(left, top, back)]);
    // Shelves along the sides are painted.
    let middle = mix(front, back, 0.5);
    let shelves = Paint { material: Material::Room(0), tint: Vec3::splat(0.8) };
    for (z0, z1, view) in [(front, middle, 1), (middle, back, 5)] {
        let q = |x: f32, z0: f32, z1: f32| [p(x, low, z0), p(x, low, z1), p(x, top, z1), p(x, top, z0)];
        mesh.quad_uv(shelves, q(left, z0, z1), super::room::cell(view));
        mesh.quad_uv(shelves, q(right, z1, z0), super::room::cell(6 - view));
    }
    mesh.quad(wall, [p(left, top, front), p(left, top, back), p(right, top, back), p(right, top, front)]);
    let wood = tinted(Material::Wood, [0.33, 0.21, 0.12]);
    let random = |n: i32| hash(n, seed as i32, 351);
    // Shelves along the back, filled with goods of the size of books and boxes.
    let mut id = 0;
    for level in 0..4 {
        let y = low + 0.35 + 0.52 * level as f32;
        mesh.block(wood, [left + 0.15, y, back + 0.02], [right - left - 0.3, 0.03, 0.3]);
        let mut x = left + 0.2;
        while x < right - 0.3 {
            id += 1;
            let (wide, tall) = (mix(0.08, 0.26, random(id)), mix(0.16, 0.34, random(id + 1000)));
            if random(id + 5000) > 0.12 {
                let hue = [random(id + 2000), random(id + 3000), random(id + 4000)];
                let gray = mix(0.05, 0.42, hue[0] * hue[0]);
                let color = [gray * mix(0.9, 1.5, hue[1]), gray, gray * mix(0.55, 1.05, hue[2])];
                mesh.cuboid(
                    tinted(Material::Goods, color),
                    p(x, y + 0.03, back + 0.05),
                    p(x + wide, y + 0.03 + tall, back + 0.25),
                    BEHIND | BELOW | LEFT,
                );
            }
            x += wide + 0.008;
        }
    }
    // Tables behind the glass, with piles.
    for (k, x) in [mix(left, right, 0.2), mix(left, right, 0.8)].into_iter().enumerate() {
        mesh.block(wood, [x - 0.6, low + 0.55, -0.95], [1.2, 0.04, 0.7]);
        for [dx, dz] in [[-0.55, -0.9], [0.5, -0.9], [-0.55, -0.32], [0.5, -0.32]] {
            mesh.block(wood, [x + dx, low, dz], [0.05, 0.55, 0.05]);
        }
        for pile in 0..7 {
            let n = 7000 + 100 * k as i32 + pile * 9;
            let (px, pz) = (x - 0.5 + 0.15 * pile as f32, -0.85 + 0.4 * random(n));
            let mut y = low + 0.59;
            for layer in 0..2 {
                let tall = mix(0.02, 0.09, random(n + layer + 1));
                let color = [0u32, 1, 2].map(|c| mix(0.05, 0.55, random(n + 10 * layer + c as i32 + 400)));
                mesh.block(tinted(Material::Goods, color), [px, y, pz], [0.13, tall, 0.19]);
                y += tall;
            }
        }
    }
    for x in [mix(left, right, 0.28), mix(left, right, 0.72)] {
        let (y, z) = (top - 0.01, -1.3);
        let half = [0.55, 0.12];
        mesh.quad(
            if is_open { plain(Material::ShopLight) } else { tinted(Material::Goods, [0.7; 3]) },
            [
                p(x - half[0], y, z - half[1]),
                p(x + half[0], y, z - half[1]),
                p(x + half[0], y, z + half[1]),
                p(x - half[0], y, z + half[1]),
            ],
        );
    }
    const { assert!(ROOM_M < DEPTH_M) };
}
