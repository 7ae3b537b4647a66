//! Many streets are valid: numbers, triangles, cars, hollows, and files that the project's own reader takes.

use downpour_scene::Budget;
use downpour_scene::gltf::{read_scene, read_triangles};
use downpour_street::{Car, Material, Mesh, Part, Paving, Street, StreetError, StreetSettings, TimeOfDay};
use glam::Vec3;
use rayon::prelude::*;

mod common;
use common::settings;

/// Number of streets.
const SEEDS: u64 = 40;

fn corners(part: &Part, triangle: &[u32]) -> [Vec3; 3] {
    [0, 1, 2].map(|k| part.vertices[triangle[k] as usize].position)
}

fn check_mesh(name: &str, mesh: &Mesh) {
    for (material, part) in &mesh.parts {
        assert!(!part.indices.is_empty() && part.indices.len().is_multiple_of(3), "{name} {material:?}");
        for vertex in &part.vertices {
            assert!(
                vertex.position.is_finite() && vertex.position.abs().max_element() < 1000.0,
                "{name} {material:?}"
            );
            assert!((vertex.normal.length() - 1.0).abs() < 1e-3, "{name} {material:?} {}", vertex.normal);
            assert!(vertex.uv.is_finite() && vertex.uv.abs().max_element() < 2000.0, "{name} {material:?}");
            assert!(
                vertex.tint.min_element() >= 0.0 && vertex.tint.max_element() <= 1.0,
                "{name} {material:?}"
            );
        }
        for triangle in part.indices.chunks_exact(3) {
            assert!(triangle.iter().all(|&k| (k as usize) < part.vertices.len()), "{name} {material:?}");
            let [a, b, c] = corners(part, triangle);
            assert!((b - a).cross(c - a).length() > 5e-7, "{name} {material:?} {a} {b} {c}");
        }
    }
}

/// Checks all of a street that its seed makes different. Returns its number of triangles.
fn check_street(settings: &StreetSettings) -> usize {
    let seed = settings.seed;
    let street = Street::generate(settings).unwrap_or_else(|error| panic!("{seed}: {error}"));
    for piece in street.pieces() {
        assert!(!piece.copies.is_empty(), "{seed} {}", piece.name);
        check_mesh(&format!("street {seed}, {}", piece.name), &piece.mesh);
    }
    for lamp in street.lamps() {
        assert!(
            lamp.intensity_cd > 0.0 && lamp.position[1] > 1.0 && lamp.position[1] < 9.0,
            "{seed} {lamp:?}"
        );
    }
    assert!(street.triangle_count() > 20_000, "{seed}");
    // Cars stand between the curbs, and not in each other.
    let cars = street.cars();
    for (k, car) in cars.iter().enumerate() {
        assert!(car.center_m[0].abs() + car.half_size_m[0] < settings.carriageway_m / 2.0, "{seed} {car:?}");
        for other in &cars[k + 1..] {
            let apart = |n: usize| {
                (car.center_m[n] - other.center_m[n]).abs() - car.half_size_m[n] - other.half_size_m[n]
            };
            assert!(apart(0) > 0.0 || apart(1) > 0.0, "{seed} {car:?} {other:?}");
        }
    }
    street.triangle_count()
}

#[test]
fn many_streets_are_valid() {
    (0..SEEDS).for_each(|seed| _ = check_street(&settings(seed)));
}

/// Streets of 80 m have about as many triangles as the shipped one.
#[test]
fn streets_of_the_default_length_are_valid() {
    (0..6u64).into_par_iter().for_each(|seed| {
        let settings = StreetSettings { seed, ..StreetSettings::default() };
        let triangles = check_street(&settings);
        assert!((280_000..520_000).contains(&triangles), "{seed}: {triangles}");
    });
}

/// A thousand streets, of seeds from the whole range too.
#[test]
#[ignore = "a thousand streets take half a minute"]
fn a_thousand_streets_are_valid() {
    (SEEDS..1000).into_par_iter().for_each(|number| {
        // Every fourth one has a large seed.
        let large = number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        check_street(&settings(if number % 4 == 3 { large } else { number }));
    });
}

/// Mean height of the carriageway within 0.4 m of a line along the street, from the mesh itself, at distances along it from a point.
fn mean_height(street: &Street, center: [f32; 2], from: f32, to: f32) -> f32 {
    let ground = street.pieces().iter().find(|piece| piece.name == "ground").expect("ground");
    let mut sum = (0.0, 0);
    for material in [Material::Setts, Material::Asphalt] {
        for vertex in ground.mesh.parts.get(&material).map_or(&[][..], |part| &part.vertices) {
            let (x, z) = (vertex.position.x - center[0], vertex.position.z - center[1]);
            if x.abs() < 0.4 && (from..to).contains(&z.abs()) {
                sum = (sum.0 + vertex.position.y, sum.1 + 1);
            }
        }
    }
    assert!(sum.1 > 0, "no ground at {center:?}");
    sum.0 / sum.1 as f32
}

/// Along the street the crown has no slope: what is lower there is the hollow. At its ends the street is flatter.
#[test]
fn hollows_are_below_their_surroundings() {
    for seed in 0..6 {
        let settings = StreetSettings { age: 0.3, ..settings(seed) };
        let street = Street::generate(&settings).unwrap();
        assert!(street.hollows().len() >= 2, "{seed}");
        let inside = |z: f32| z < -7.0 && z > 7.0 - settings.length_m;
        for hollow in street.hollows().iter().filter(|hollow| inside(hollow.center_m[1])) {
            let reach = hollow.radii_m[1];
            let middle = mean_height(&street, hollow.center_m, 0.0, 0.35);
            let around = mean_height(&street, hollow.center_m, 1.5 * reach, 1.5 * reach + 0.5);
            assert!(middle < around, "{seed} {hollow:?}: {middle} in {around}");
        }
    }
}

/// The texture on each surface has the size of its tile: meters of surface for each unit of its coordinates.
#[test]
fn textures_have_their_scale() {
    let cobbles = StreetSettings { furniture: 1.0, ..StreetSettings::default() };
    let asphalt = StreetSettings { paving: Paving::Asphalt, seed: 3, ..cobbles.clone() };
    let streets = [cobbles, asphalt].map(|settings| Street::generate(&settings).unwrap());
    for material in [
        Material::Asphalt,
        Material::Ashlar,
        Material::Bark,
        Material::Brick,
        Material::BrickPale,
        Material::Cloth,
        Material::Cover,
        Material::Curb,
        Material::Iron,
        Material::Joinery,
        Material::Plaster,
        Material::Roof,
        Material::Setts,
        Material::Slabs,
        Material::Stone,
        Material::Wood,
        Material::Zinc,
    ] {
        let (mut surface, mut picture) = (0.0, 0.0);
        let pieces = streets.iter().flat_map(Street::pieces);
        for part in pieces.filter_map(|piece| piece.mesh.parts.get(&material)) {
            for triangle in part.indices.chunks_exact(3) {
                let [a, b, c] = corners(part, triangle);
                let [p, q, r] = [0, 1, 2].map(|k| part.vertices[triangle[k] as usize].uv);
                surface += (b - a).cross(c - a).length();
                picture += (q - p).perp_dot(r - p).abs();
            }
        }
        assert!(surface > 0.0, "{material:?}");
        let tile_m = (surface / picture).sqrt();
        assert!((0.8..1.25).contains(&(tile_m / material.tile_m())), "{material:?} {tile_m}");
    }
}

#[test]
fn the_reader_takes_the_files_without_complaint() {
    let folder = tempfile::tempdir().unwrap();
    for seed in [1, 4] {
        let street = Street::generate(&settings(seed)).unwrap();
        for time in [TimeOfDay::Day, TimeOfDay::Night] {
            let path = folder.path().join(format!("{seed}_{time:?}.glb"));
            std::fs::write(&path, street.to_glb(time).unwrap()).unwrap();
            let model =
                read_triangles(&path, &mut Budget::default()).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(model.indices.len(), street.triangle_count());
            assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        }
    }
}

#[test]
fn the_same_settings_give_the_same_bytes() {
    let bytes = |seed| Street::generate(&settings(seed)).unwrap().to_gltf("s");
    let (one, again, other) = (bytes(5), bytes(5), bytes(6));
    assert_eq!(one.len(), 3);
    for (a, b) in one.iter().zip(&again) {
        assert!(a.name == b.name && a.bytes == b.bytes, "{}", a.name);
    }
    assert_ne!(one[0].bytes, other[0].bytes);
}

#[test]
fn windows_shine_as_often_as_they_should() {
    let area = |lit_windows: f32| {
        let street = Street::generate(&StreetSettings { lit_windows, ..settings(2) }).unwrap();
        let lit = |material: &Material| matches!(material, Material::Room(_));
        let surfaces = street.emissive_surfaces();
        surfaces.iter().filter(|surface| lit(&surface.material)).map(|surface| surface.area_m2).sum::<f32>()
    };
    assert_eq!(area(0.0), 0.0);
    assert!(area(0.3) > 10.0 && area(0.9) > 1.5 * area(0.3));
}

#[test]
fn lengths_beyond_the_ends_are_refused() {
    for length_m in [10.0, 2000.0, f32::NAN, f32::INFINITY] {
        let error = Street::generate(&StreetSettings { length_m, ..StreetSettings::default() }).unwrap_err();
        let StreetError::Setting { key, allowed, .. } = error else { panic!("{error}") };
        assert_eq!((key.as_str(), allowed.as_str()), ("length_m", "20 to 500"));
    }
    let longest = Street::generate(&StreetSettings { length_m: 500.0, ..StreetSettings::default() }).unwrap();
    assert!(longest.triangle_count() < 3_000_000, "{}", longest.triangle_count());
}

/// Where a wheel touches the road it stands still while the car goes on: its lowest points go back at 1 m/s in the car, its highest
/// ones forward, and its hubs stay. Both files of a car say so, and have its lamps by night.
#[test]
fn wheels_roll_at_a_meter_per_second() {
    let folder = tempfile::tempdir().expect("a folder");
    let car = Car::new(1).expect("a car");
    for file in car.to_gltf("car") {
        std::fs::write(folder.path().join(file.name), file.bytes).expect("written");
    }
    let glb = folder.path().join("car.glb");
    std::fs::write(&glb, car.to_glb(TimeOfDay::Night).expect("a file")).expect("written");
    let files = [(folder.path().join("car.gltf"), 0), (folder.path().join("car_night.gltf"), 2), (glb, 2)];
    for (path, lamps) in files {
        let scene = read_scene(&path, &mut Budget::default()).expect("a scene");
        assert!(scene.warnings.is_empty() && scene.textures.is_empty(), "{:?}", scene.warnings);
        assert_eq!(scene.animations.iter().map(|one| one.name.as_str()).collect::<Vec<_>>(), ["roll"]);
        assert_eq!(scene.pose(None, 0.0).lights.len(), lamps);
        let radius = 0.315;
        for time_s in [0.1, 0.7, 1.3, 1.9] {
            let step_s = 0.01;
            let (now, then) = (scene.pose(Some(0), time_s), scene.pose(Some(0), time_s + step_s));
            let wheels =
                now.instances.iter().zip(&then.instances).filter(|(one, _)| one.world.translation.y > 0.3);
            let mut count = 0;
            for (one, next) in wheels {
                count += 1;
                assert!(one.world.translation.distance(next.world.translation) < 1e-6);
                for (side, expected) in [(-radius, -1.0), (radius, 1.0)] {
                    let rim = one.world.translation + glam::Vec3A::new(0.0, side, 0.0);
                    let moved =
                        next.world.transform_point3a(one.world.inverse().transform_point3a(rim)) - rim;
                    assert!((moved.z / step_s - expected).abs() < 0.02, "{time_s} s, {side} m: {moved}");
                }
            }
            assert_eq!(count, 4);
        }
    }
}
