//! Nothing in a street stands in anything else, and nothing before a door.

use downpour_math::ops;
use downpour_street::{Material, Mesh, Placement, Street, StreetSettings};
use rayon::prelude::*;

mod common;
use common::settings;

/// A rectangle of ground: x and z of its lowest and highest corner.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    low: [f32; 2],
    high: [f32; 2],
}

impl Rectangle {
    fn around([x, z]: [f32; 2], [a, b]: [f32; 2]) -> Self {
        Self { low: [x - a, z - b], high: [x + a, z + b] }
    }

    /// Distance to another one along the axis on which they are farther apart; below 0 they overlap.
    fn gap(&self, other: &Self) -> f32 {
        let gap = |k: usize| (other.low[k] - self.high[k]).max(self.low[k] - other.high[k]);
        gap(0).max(gap(1))
    }
}

/// The ground under a copy of a mesh below the height of a head, without leaves.
fn ground_of(mesh: &Mesh, copy: &Placement) -> Rectangle {
    let turn = copy.turn_deg.to_radians();
    let (cos, sin) = (ops::cos(turn), ops::sin(turn));
    let mut found = Rectangle { low: [f32::MAX; 2], high: [f32::MIN; 2] };
    let solid = mesh.parts.iter().filter(|(material, _)| **material != Material::Leaf);
    for vertex in solid.flat_map(|(_, part)| &part.vertices).filter(|vertex| vertex.position.y < 1.9) {
        let p = vertex.position;
        let at = [cos * p.x + sin * p.z + copy.position[0], -sin * p.x + cos * p.z + copy.position[2]];
        for (k, at) in at.into_iter().enumerate() {
            found.low[k] = found.low[k].min(at);
            found.high[k] = found.high[k].max(at);
        }
    }
    found
}

/// Names of what stands on the pavements. A tree stands in its grate, and a table between its chairs.
const FURNITURE: [&str; 10] =
    ["lamp", "grate", "bollard", "bin", "bench", "bicycle", "table", "chair", "sign post", "planter"];

fn check(settings: &StreetSettings) -> usize {
    let street = Street::generate(settings).expect("a street");
    let seed = settings.seed;
    let mut all: Vec<(&str, Rectangle)> = Vec::new();
    for piece in street.pieces().iter().filter(|piece| FURNITURE.contains(&piece.name.as_str())) {
        all.extend(piece.copies.iter().map(|copy| (piece.name.as_str(), ground_of(&piece.mesh, copy))));
    }
    let count = all.len();
    let (curb, wall) = (settings.carriageway_m / 2.0, settings.carriageway_m / 2.0 + settings.pavement_m);
    for (name, own) in &all {
        let [near, far] = [own.low[0].abs().min(own.high[0].abs()), own.low[0].abs().max(own.high[0].abs())];
        assert!(near > curb && far < wall - 0.12, "{seed} {name} {own:?}: {curb} to {wall}");
    }
    all.extend(street.cars().iter().map(|car| ("car", Rectangle::around(car.center_m, car.half_size_m))));
    all.extend(
        street.doorways().iter().map(|way| ("doorway", Rectangle::around(way.center_m, way.half_size_m))),
    );
    for (k, (name, own)) in all.iter().enumerate() {
        for (other_name, other) in &all[k + 1..] {
            let gap = own.gap(other);
            let are_ways = *name == "doorway" && *other_name == "doorway";
            assert!(are_ways || gap > 0.0, "{seed} {name} {own:?}, {other_name} {other:?}: {gap}");
        }
    }
    // Trees do not stand in the lanterns' light.
    let trees = all.iter().filter(|(name, _)| *name == "grate");
    for ((_, tree), (_, lamp)) in
        trees.flat_map(|tree| all.iter().filter(|(name, _)| *name == "lamp").map(move |lamp| (tree, lamp)))
    {
        assert!(tree.gap(lamp) > 1.1, "{seed} {tree:?} {lamp:?}");
    }
    count
}

#[test]
fn nothing_stands_in_anything_else() {
    (0..200).into_par_iter().for_each(|seed| _ = check(&StreetSettings { furniture: 1.0, ..settings(seed) }));
}

/// Streets of the length and widths of the shipped one, which are furnished.
#[test]
fn streets_of_the_default_length_are_furnished() {
    (0..24u64).into_par_iter().for_each(|seed| {
        let count = check(&StreetSettings { seed, ..StreetSettings::default() });
        assert!((40..110).contains(&count), "{seed}: {count}");
    });
}

/// Every house along the street has a door, and each shop one more; every lamp has found room.
#[test]
fn doors_and_lamps_are_there() {
    for seed in 0..24 {
        let settings = StreetSettings { seed, lamp_spacing_m: 6.0, ..StreetSettings::default() };
        let street = Street::generate(&settings).unwrap();
        assert!((22..45).contains(&street.doorways().len()), "{seed}: {}", street.doorways().len());
        let lamps = street.lamps().iter().filter(|lamp| lamp.name == "street lamp").count();
        assert!((11..16).contains(&lamps), "{seed}: {lamps}");
    }
}
