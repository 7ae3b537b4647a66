//! Furniture of the pavements: what stands where, as far as there is room.

use crate::dice::Dice;
use crate::furniture;
use crate::ground::{Ground, PAVEMENT_FALL};
use crate::mesh::Mesh;
use crate::model::Placement;
use crate::settings::StreetSettings;
use crate::tree;

use super::Plan;
use super::occupancy::{Footprint, Occupancy, Use};

/// Distance from the face of the curb to what stands along it, meters.
const CURB_M: f32 = 0.45;
/// Distance from there to the trunks of trees, meters.
const TREE_M: f32 = 0.40;
/// Distance along the street that a thing may be moved to where there is room, meters; trees, which need much, farther.
const REACH_M: f32 = 1.6;
const TREE_REACH_M: f32 = 4.0;

/// A piece of furniture and the ground that it takes.
struct Item {
    name: &'static str,
    make: fn() -> Mesh,
    sort: Use,
    /// Half the ground that it takes across and along the street, meters.
    half_size_m: [f32; 2],
}

const BIN: Item = Item { name: "bin", make: furniture::bin, sort: Use::Curb, half_size_m: [0.24, 0.24] };
const BOLLARD: Item =
    Item { name: "bollard", make: furniture::bollard, sort: Use::Curb, half_size_m: [0.10, 0.10] };
const SIGN_POST: Item =
    Item { name: "sign post", make: furniture::sign_post, sort: Use::Curb, half_size_m: [0.31, 0.05] };
const BENCH: Item =
    Item { name: "bench", make: furniture::bench, sort: Use::Front, half_size_m: [0.29, 0.86] };
const PLANTER: Item =
    Item { name: "planter", make: furniture::planter, sort: Use::Front, half_size_m: [0.27, 0.27] };
const BICYCLE: Item =
    Item { name: "bicycle", make: furniture::bicycle, sort: Use::Front, half_size_m: [0.32, 0.88] };
/// A table between two chairs.
const TABLE: Item =
    Item { name: "table", make: furniture::table, sort: Use::Front, half_size_m: [0.36, 0.96] };
const TREE: Item = Item {
    name: "tree",
    make: tree::tree,
    sort: Use::Tree,
    half_size_m: [tree::grate::GRATE_M, tree::grate::GRATE_M],
};

/// One of the two pavements.
struct Side<'a> {
    ground: &'a Ground,
    /// -1 on the left, 1 on the right.
    sign: f32,
}

impl Side<'_> {
    /// A placement at distances from the middle and along the street, turned by an angle from where the front looks at the road.
    fn at(&self, x: f32, z: f32, turn_deg: f32) -> Placement {
        let facing = if self.sign > 0.0 { -90.0 } else { 90.0 };
        Placement::new(self.sign * x, self.ground.pavement_height(x), z, facing + turn_deg)
    }

    fn footprint(&self, item: &Item, x: f32, z: f32) -> Footprint {
        Footprint::new(item.sort, [self.sign * x, z], item.half_size_m)
    }
}

/// Puts furniture on both pavements, as far as there is room.
pub(super) fn furnish(settings: &StreetSettings, ground: &Ground, taken: &mut Occupancy, plan: &mut Plan) {
    let mut dice = Dice::new(settings.seed, 203);
    let curb = ground.half_road + CURB_M;
    let wall = ground.half_street();
    for sign in [-1.0f32, 1.0] {
        let side = Side { ground, sign };
        let mut z = -dice.range(1.5, 4.0);
        while z > -ground.length + 1.5 {
            if dice.chance(settings.furniture) {
                let mut put = |item: &Item, x: f32, turn_deg: f32| {
                    let reach = if item.sort == Use::Tree { TREE_REACH_M } else { REACH_M };
                    let z = taken.settle(side.footprint(item, x, z), reach)?;
                    plan.place(item.name, item.make, side.at(x, z, turn_deg));
                    Some(z)
                };
                match dice.below(11) {
                    0 => _ = put(&BIN, curb, 0.0),
                    // It is read along the street.
                    1 => _ = put(&SIGN_POST, curb - 0.1, 90.0 * sign),
                    2 | 3 | 9 | 10 if ground.pavement > 2.2 => {
                        let x = wall - 0.80;
                        let spin = dice.range(0.0, 360.0);
                        let angles = [dice.range(-14.0, 14.0), dice.range(-14.0, 14.0) + 180.0];
                        if let Some(z) = put(&TABLE, x, spin) {
                            for (dz, angle) in [0.62, -0.62].into_iter().zip(angles) {
                                let y = ground.pavement_height(x);
                                let at = Placement::new(sign * x, y, z + dz, angle + 180.0);
                                plan.place("chair", furniture::chair, at);
                            }
                        }
                    }
                    // It leans against the house.
                    4 => _ = put(&BICYCLE, wall - 0.47, 0.0),
                    5 if ground.pavement > 2.6 => {
                        let x = curb + TREE_M;
                        if let Some(z) = put(&TREE, x, dice.range(0.0, 360.0)) {
                            // Along +x the pavement rises, away from the road.
                            let turn_deg = if sign > 0.0 { 0.0 } else { 180.0 };
                            let flat = Placement::new(sign * x, ground.pavement_height(x), z, turn_deg);
                            plan.place("grate", || tree::grate::grate(PAVEMENT_FALL), flat);
                        }
                    }
                    6 => _ = put(&BENCH, wall - 0.55, 0.0),
                    7 => _ = put(&PLANTER, wall - 0.45, 0.0),
                    _ => {
                        // A row of three, with gaps where something else stands.
                        for k in [-1.0, 0.0, 1.0] {
                            let z = z + 1.3 * k;
                            if taken.take_free(side.footprint(&BOLLARD, curb, z)) {
                                plan.place(BOLLARD.name, BOLLARD.make, side.at(curb, z, 0.0));
                            }
                        }
                    }
                }
            }
            z -= dice.range(1.9, 3.6);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Footprints are as large as what stands on them below the height of a head; leaves may hang over.
    #[test]
    fn footprints_are_as_large_as_their_things() {
        for item in [BIN, BOLLARD, SIGN_POST, BENCH, PLANTER, BICYCLE, TREE] {
            let mesh = (item.make)();
            let bark = mesh.parts.iter().filter(|(material, _)| **material != crate::Material::Leaf);
            let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
            for vertex in bark.flat_map(|(_, part)| &part.vertices).filter(|vertex| vertex.position.y < 1.9) {
                (low, high) = (low.min(vertex.position), high.max(vertex.position));
            }
            let reach = high.max(-low);
            // The front of a sign looks along the street, that of the rest across it.
            let size = if item.name == "sign post" { [reach.x, reach.z] } else { [reach.z, reach.x] };
            for (half, own) in size.into_iter().zip(item.half_size_m) {
                assert!(half < own + 1e-3, "{} {size:?}", item.name);
            }
        }
    }
}
