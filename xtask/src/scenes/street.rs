//! Plan of the street: positions of the houses.

use std::collections::BTreeMap;

use glam::Vec3;

use super::ground::{CROSS_FAR_M, CROSS_NEAR_M, CROSS_REACH_M, HALF_STREET_M, START_M, ground};
use super::house::{House, Joinery, Roof, Shop, StoneColor, WindowDesign, WindowKind, window};
use super::material::Material;
use super::mesh::{Mesh, turn};
use super::model::{Lamp, Model, Piece, Placement};

const CLAY: [f32; 3] = [0.30, 0.135, 0.085];
const BROWN: [f32; 3] = [0.185, 0.115, 0.085];
const SLATE: [f32; 3] = [0.105, 0.112, 0.125];

/// Default house of a row: most houses differ little from it.
const PLAIN: House = House {
    width_m: 7.0,
    stories: 3,
    wall: Material::Brick,
    tint: [0.92; 3],
    stone: StoneColor::Limestone,
    joinery: Joinery::White,
    windows: WindowKind::Sash,
    bays: 3,
    door: [0.04, 0.07, 0.055],
    door_bay: 0,
    shop: None,
    roof: Roof::Pitched { pitch_deg: 38.0, tiles: SLATE },
    seed: 0,
};

/// A plastered house.
const fn plastered(tint: [f32; 3]) -> House {
    House {
        wall: Material::Plaster,
        tint,
        stone: StoneColor::Painted,
        windows: WindowKind::Casement,
        ..PLAIN
    }
}

/// The left side, from behind the eye to the cross street.
fn left() -> Vec<House> {
    vec![
        House {
            width_m: 7.6,
            wall: Material::BrickPale,
            roof: Roof::Parapet { height_m: 0.8 },
            door_bay: 2,
            ..PLAIN
        },
        House { width_m: 6.9, door: [0.10, 0.02, 0.018], ..PLAIN },
        House {
            width_m: 8.3,
            bays: 4,
            door_bay: 1,
            roof: Roof::Pitched { pitch_deg: 42.0, tiles: CLAY },
            ..plastered([0.66, 0.60, 0.48])
        },
        House {
            width_m: 7.4,
            stories: 4,
            tint: [0.85, 0.82, 0.80],
            stone: StoneColor::Sandstone,
            roof: Roof::Mansard { tiles: SLATE, dormers: 2 },
            door_bay: 2,
            ..PLAIN
        },
        House {
            width_m: 8.1,
            windows: WindowKind::Sash,
            shop: Some(Shop {
                sign: Material::SignBooks,
                paint: [0.020, 0.048, 0.038],
                awning: Some([[0.46, 0.43, 0.35], [0.035, 0.085, 0.06]]),
            }),
            ..plastered([0.60, 0.57, 0.50])
        },
        House {
            width_m: 6.6,
            bays: 2,
            wall: Material::BrickPale,
            stone: StoneColor::Limestone,
            joinery: Joinery::Cream,
            door: [0.03, 0.05, 0.10],
            door_bay: 1,
            ..PLAIN
        },
        House {
            width_m: 7.9,
            stories: 3,
            roof: Roof::Pitched { pitch_deg: 36.0, tiles: BROWN },
            ..plastered([0.46, 0.49, 0.48])
        },
        House {
            width_m: 7.2,
            stories: 4,
            tint: [1.0, 0.95, 0.92],
            door_bay: 2,
            roof: Roof::Parapet { height_m: 1.0 },
            ..PLAIN
        },
        House {
            width_m: 8.8,
            bays: 4,
            door_bay: 3,
            roof: Roof::Mansard { tiles: BROWN, dormers: 3 },
            ..plastered([0.62, 0.50, 0.36])
        },
    ]
}

/// The right side, from the cross street to behind the eye.
fn right() -> Vec<House> {
    vec![
        House {
            width_m: 8.0,
            stories: 4,
            bays: 4,
            wall: Material::BrickPale,
            door_bay: 1,
            roof: Roof::Parapet { height_m: 0.9 },
            ..PLAIN
        },
        House {
            width_m: 6.8,
            door_bay: 2,
            roof: Roof::Pitched { pitch_deg: 40.0, tiles: CLAY },
            ..plastered([0.64, 0.62, 0.58])
        },
        House {
            width_m: 7.7,
            tint: [0.88, 0.84, 0.82],
            joinery: Joinery::Cream,
            door: [0.13, 0.10, 0.03],
            ..PLAIN
        },
        House {
            width_m: 8.0,
            stories: 3,
            windows: WindowKind::Sash,
            shop: Some(Shop {
                sign: Material::SignCafe,
                paint: [0.11, 0.028, 0.022],
                awning: Some([[0.50, 0.46, 0.38], [0.20, 0.035, 0.028]]),
            }),
            roof: Roof::Pitched { pitch_deg: 38.0, tiles: SLATE },
            ..PLAIN
        },
        House {
            width_m: 7.0,
            stories: 4,
            bays: 3,
            door_bay: 0,
            roof: Roof::Mansard { tiles: SLATE, dormers: 2 },
            ..plastered([0.58, 0.55, 0.49])
        },
        House {
            width_m: 8.2,
            bays: 4,
            door_bay: 2,
            wall: Material::BrickPale,
            stone: StoneColor::Sandstone,
            joinery: Joinery::Green,
            roof: Roof::Pitched { pitch_deg: 38.0, tiles: BROWN },
            ..PLAIN
        },
        House {
            width_m: 6.9,
            stories: 3,
            door_bay: 1,
            door: [0.02, 0.03, 0.06],
            ..plastered([0.55, 0.44, 0.38])
        },
        House { width_m: 7.5, stories: 3, tint: [0.95, 0.9, 0.88], door_bay: 2, ..PLAIN },
        House { width_m: 8.7, bays: 4, ..plastered([0.62, 0.58, 0.50]) },
    ]
}

/// The far side of the cross street, from left to right: the fourth closes the view.
fn far() -> Vec<House> {
    vec![
        House { width_m: 7.5, ..PLAIN },
        House { width_m: 7.0, door_bay: 1, ..plastered([0.60, 0.57, 0.52]) },
        House {
            width_m: 7.8,
            stories: 4,
            wall: Material::BrickPale,
            roof: Roof::Parapet { height_m: 0.8 },
            door_bay: 2,
            ..PLAIN
        },
        House {
            width_m: 9.6,
            stories: 4,
            bays: 5,
            door_bay: 2,
            roof: Roof::Mansard { tiles: SLATE, dormers: 3 },
            ..plastered([0.67, 0.62, 0.52])
        },
        House { width_m: 7.2, stories: 3, tint: [0.9, 0.86, 0.84], door_bay: 0, ..PLAIN },
        House { width_m: 7.4, stories: 3, ..plastered([0.50, 0.52, 0.50]) },
        House { width_m: 7.5, wall: Material::BrickPale, ..PLAIN },
    ]
}

/// Start of a row of houses, x and z, and its rotation, degrees: its fronts look along +z rotated by the angle.
struct Start([f32; 2], f32);

impl Start {
    /// Position of a point of a house whose left end is `along` the row.
    fn position(&self, p: Vec3, along: f32) -> [f32; 3] {
        let (c, s) = turn(self.1);
        let x = p.x + along;
        [self.0[0] + c * x + s * p.z, p.y, self.0[1] - s * x + c * p.z]
    }
}

/// A row of houses, and the positions of its copies.
struct Row {
    houses: Vec<House>,
    starts: Vec<Start>,
}

fn rows() -> Vec<Row> {
    let half = HALF_STREET_M;
    let far_z = CROSS_FAR_M - (half - super::ground::HALF_ROAD_M);
    let end = House { bays: 4, width_m: 11.8, stories: 4, ..plastered([0.6, 0.56, 0.48]) };
    vec![
        Row { houses: left(), starts: vec![Start([-half, START_M], 90.0)] },
        Row { houses: right(), starts: vec![Start([half, CROSS_NEAR_M + 2.6], -90.0)] },
        Row { houses: far(), starts: vec![Start([-CROSS_REACH_M, far_z], 0.0)] },
        // Behind the eye, and at the ends of the cross street.
        Row {
            houses: vec![end],
            starts: vec![
                Start([5.9, START_M - 0.2], 180.0),
                Start([-CROSS_REACH_M + 0.5, -43.8], 90.0),
                Start([CROSS_REACH_M - 0.5, -55.6], -90.0),
            ],
        },
    ]
}

/// The street: ground and houses.
pub(super) fn street() -> Model {
    let mut pieces = vec![Piece {
        name: "ground".to_owned(),
        mesh: ground(),
        copies: vec![Placement { position: [0.0; 3], turn_deg: 0.0 }],
    }];
    let mut frames: BTreeMap<WindowDesign, Vec<Placement>> = BTreeMap::new();
    let mut lamps: Vec<Lamp> = Vec::new();
    let mut seed = 0;
    for (number, row) in rows().into_iter().enumerate() {
        let mut along = 0.0;
        let mut mesh = Mesh::default();
        for house in row.houses {
            seed += 1;
            let house = House { seed, ..house };
            let built = house.build();
            mesh.add(&built.mesh, [along, 0.0, 0.0], 0.0);
            for start in &row.starts {
                for window in &built.windows {
                    let copy =
                        Placement { position: start.position(window.corner, along), turn_deg: start.1 };
                    frames.entry(window.design).or_default().push(copy);
                }
                let placed =
                    |lamp: &Lamp| Lamp { position: start.position(lamp.position.into(), along), ..*lamp };
                lamps.extend(built.lamps.iter().map(placed));
            }
            along += house.width_m;
        }
        let copies = row
            .starts
            .iter()
            .map(|start| Placement { position: start.position(Vec3::ZERO, 0.0), turn_deg: start.1 });
        pieces.push(Piece { name: format!("row {}", number + 1), mesh, copies: copies.collect() });
    }
    for (design, copies) in frames {
        let WindowDesign { kind, joinery, dressing, stone } = design;
        let name = format!("{kind:?} {joinery:?} {dressing:?} {stone:?}").to_lowercase();
        pieces.push(Piece { name, mesh: window(design), copies });
    }
    Model { name: "street", pieces, lamps, paints: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_fill_their_street() {
        let length = START_M - (CROSS_NEAR_M + 2.6);
        for row in [left(), right()] {
            let sum: f32 = row.iter().map(|house| house.width_m).sum();
            assert!((sum - length).abs() < 0.35, "{sum} of {length}");
        }
        let sum: f32 = far().iter().map(|house| house.width_m).sum();
        assert!((sum - 2.0 * CROSS_REACH_M).abs() < 0.35, "{sum}");
    }

    #[test]
    fn the_street_is_no_larger_than_allowed() {
        let count = street().triangle_count();
        assert!((20_000..125_000).contains(&count), "{count} triangles");
    }
}
