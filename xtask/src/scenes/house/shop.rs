//! A shop on the ground floor: glazed front with pilasters, sign and awning, and the room behind.

use glam::{Vec2, Vec3};

use super::{DEPTH_M, House, Opening, door, ground_m};
use crate::scenes::material::Material;
use crate::scenes::mesh::{BEHIND, BELOW, LEFT, Mesh, plain, tinted};
use crate::scenes::model::Lamp;
use crate::scenes::noise::{hash, mix};

/// Parameters of a shop.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenes) struct Shop {
    pub(in crate::scenes) sign: Material,
    /// Paint of the front.
    pub(in crate::scenes) paint: [f32; 3],
    /// Stripes of the awning; without it there is none.
    pub(in crate::scenes) awning: Option<[[f32; 3]; 2]>,
}

/// Height of the glass over the pavement, and of the board above.
const GLASS_M: f32 = 2.62;
const BOARD_M: [f32; 2] = [2.72, 3.24];
/// Projection of the awning, and the heights of its edges over the pavement.
const AWNING_M: [f32; 3] = [1.35, 2.78, 2.28];
/// Depth of the room.
const ROOM_M: f32 = 3.2;
/// Width at the right of the house door.
const DOOR_M: f32 = 1.5;

/// The opening of a shop in the front; it takes in the door beside it.
pub(super) fn opening(house: &House) -> Opening {
    Opening { x: [0.3, house.width_m - 0.3], y: [ground_m(), ground_m() + GLASS_M], is_window: false }
}

impl Shop {
    /// Draws the shop.
    pub(super) fn build(&self, house: &House, mesh: &mut Mesh, lamps: &mut Vec<Lamp>) {
        let low = ground_m();
        let (left, right) = (0.3, house.width_m - 0.3 - DOOR_M);
        let paint = tinted(Material::Joinery, self.paint);
        self.glazing(mesh, [left, right], low);
        // The house's door, between wall and shop.
        let middle = right + DOOR_M * 0.5;
        let wall = house.wall_paint();
        for [a, b] in [[right, middle - 0.53], [middle + 0.53, house.width_m - 0.3]] {
            mesh.cuboid(wall, Vec3::new(a, low, -0.17), Vec3::new(b, low + GLASS_M, 0.0), BEHIND | BELOW);
        }
        door::leaf(house, middle, mesh);
        mesh.block(house.stone_paint(), [middle - 0.6, low - 0.1, -0.2], [1.2, 0.23, 0.42]);
        // Pilasters, board, ledge.
        for x in [left - 0.18, right - 0.1] {
            mesh.cuboid(paint, Vec3::new(x, low, 0.0), Vec3::new(x + 0.28, low + BOARD_M[1], 0.09), BEHIND);
            mesh.cuboid(paint, Vec3::new(x - 0.03, low, 0.0), Vec3::new(x + 0.31, low + 0.3, 0.12), BEHIND);
            mesh.cuboid(
                paint,
                Vec3::new(x - 0.03, low + 2.66, 0.0),
                Vec3::new(x + 0.31, low + 2.78, 0.13),
                BEHIND,
            );
        }
        let (a, b) = (left - 0.2, right + 0.2);
        mesh.cuboid(
            paint,
            Vec3::new(a, low + GLASS_M - 0.02, 0.0),
            Vec3::new(b, low + BOARD_M[1] + 0.06, 0.07),
            BEHIND,
        );
        mesh.block(paint, [a - 0.06, low + BOARD_M[1] + 0.06, 0.0], [b - a + 0.12, 0.09, 0.24]);
        let z = 0.085;
        let p = |x: f32, y: f32| Vec3::new(x, low + y, z);
        let (x0, x1) = (mix(a, b, 0.5) - 2.05, mix(a, b, 0.5) + 2.05);
        mesh.quad_uv(
            plain(self.sign),
            [p(x0, BOARD_M[0]), p(x1, BOARD_M[0]), p(x1, BOARD_M[1] - 0.01), p(x0, BOARD_M[1] - 0.01)],
            [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(Vec2::from),
        );
        if let Some(stripes) = self.awning {
            awning(mesh, [a, b], low, stripes);
        }
        room(mesh, house.seed, [left, right], low, lamps);
    }

    /// Stall riser, panes with bars, and a glazed door in the middle third.
    fn glazing(&self, mesh: &mut Mesh, [left, right]: [f32; 2], low: f32) {
        let paint = tinted(Material::Joinery, self.paint);
        let (z, top) = (-0.10, low + GLASS_M);
        let door = [mix(left, right, 0.5) - 0.48, mix(left, right, 0.5) + 0.48];
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
        mesh.block(
            tinted(Material::Stone, [0.4, 0.39, 0.36]),
            [door[0] - 0.1, low - 0.1, -0.2],
            [1.16, 0.12, 0.32],
        );
    }
}

/// Cloth in stripes from under the board outwards, with a valance and arms.
fn awning(mesh: &mut Mesh, [a, b]: [f32; 2], low: f32, stripes: [[f32; 3]; 2]) {
    let [out, high, end] = AWNING_M;
    let count = ((b - a) / 0.24).round() as usize;
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, low + y, z);
    for k in 0..count {
        let paint = tinted(Material::Fabric, stripes[k % 2]);
        let x0 = mix(a, b, k as f32 / count as f32);
        let x1 = mix(a, b, (k + 1) as f32 / count as f32);
        // The cloth sags a little between wall and bar.
        let rows = 5;
        let point =
            |x: f32, t: f32| p(x, mix(high, end, t) - 0.09 * 4.0 * t * (1.0 - t) * 0.5, 0.08 + out * t);
        for row in 0..rows {
            let (s, t) = (row as f32 / rows as f32, (row + 1) as f32 / rows as f32);
            mesh.quad(paint, [point(x0, t), point(x1, t), point(x1, s), point(x0, s)]);
            let down = Vec3::new(0.0, -0.004, 0.0);
            mesh.quad(paint, [point(x1, t), point(x0, t), point(x0, s), point(x1, s)].map(|p| p + down));
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
        let back: Vec<Vec3> = outline.iter().rev().map(|&p| p - Vec3::Z * 0.004).collect();
        mesh.polygon(paint, &back);
    }
    let iron = tinted(Material::Iron, [0.12; 3]);
    for x in [a + 0.06, b - 0.06] {
        let arm = [(p(x, 2.2, 0.02), 0.014), (p(x, end - 0.02, 0.06 + out), 0.014)];
        mesh.tube(iron, &arm, 6);
    }
    mesh.tube(iron, &[(p(a, end, 0.07 + out), 0.018), (p(b, end, 0.07 + out), 0.018)], 7);
}

/// The room: floor, walls, shelves with goods, a table in the window, light.
fn room(mesh: &mut Mesh, seed: u32, [left, right]: [f32; 2], low: f32, lamps: &mut Vec<Lamp>) {
    let (front, back, top) = (-0.2, -ROOM_M, low + GLASS_M + 0.1);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let wall = tinted(Material::Goods, [0.62, 0.57, 0.47]);
    let floor = tinted(Material::Wood, [0.30, 0.19, 0.11]);
    let y = low + 0.02;
    mesh.quad(floor, [p(left, y, front), p(right, y, front), p(right, y, back), p(left, y, back)]);
    mesh.quad(wall, [p(left, low, back), p(right, low, back), p(right, top, back), p(left, top, back)]);
    mesh.quad(wall, [p(left, low, front), p(left, low, back), p(left, top, back), p(left, top, front)]);
    mesh.quad(wall, [p(right, low, back), p(right, low, front), p(right, top, front), p(right, top, back)]);
    mesh.quad(wall, [p(left, top, front), p(left, top, back), p(right, top, back), p(right, top, front)]);
    let wood = tinted(Material::Wood, [0.33, 0.21, 0.12]);
    let random = |n: i32| hash(n, seed as i32, 351);
    // Shelves along the back, filled with goods of the size of books and boxes.
    let mut id = 0;
    for level in 0..5 {
        let y = low + 0.35 + 0.43 * level as f32;
        mesh.block(wood, [left + 0.15, y, back + 0.02], [right - left - 0.3, 0.03, 0.3]);
        let mut x = left + 0.2;
        while x < right - 0.3 {
            id += 1;
            let (wide, tall) = (mix(0.04, 0.16, random(id)), mix(0.16, 0.34, random(id + 1000)));
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
            for layer in 0..3 {
                let tall = mix(0.02, 0.09, random(n + layer + 1));
                let color = [0, 1, 2].map(|c| mix(0.05, 0.55, random(n + 10 * layer + c + 400)));
                mesh.block(tinted(Material::Goods, color), [px, y, pz], [0.13, tall, 0.19]);
                y += tall;
            }
        }
    }
    for x in [mix(left, right, 0.28), mix(left, right, 0.72)] {
        let (y, z) = (top - 0.01, -1.3);
        let half = [0.55, 0.12];
        mesh.quad(
            plain(Material::ShopLight),
            [
                p(x - half[0], y, z - half[1]),
                p(x + half[0], y, z - half[1]),
                p(x + half[0], y, z + half[1]),
                p(x - half[0], y, z + half[1]),
            ],
        );
    }
    // One lamp represents both panels.
    lamps.push(Lamp {
        name: "shop",
        position: [mix(left, right, 0.5), top - 0.13, -1.3],
        direction: None,
        cone_deg: [0.0; 2],
        color: [1.0, 0.76, 0.47],
        intensity_cd: 240.0,
        range_m: 8.0,
    });
    const { assert!(ROOM_M < DEPTH_M) };
}
