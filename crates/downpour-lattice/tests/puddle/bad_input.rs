//! Bad input is an error that names the quantity; nothing panics, nothing becomes unstable silently.

use downpour_lattice::LatticeError;
use downpour_lattice::puddle::{Impact, Puddle, PuddleDamping, PuddleForm, PuddleOptions, PuddleWater, Wake};
use downpour_math::OutOfRange;

use crate::{hill, membrane, set, undamped};

fn refused(options: &PuddleOptions, quantity: &str) {
    let error = Puddle::new(options).expect_err(quantity);
    assert!(error.to_string().contains(quantity), "{error} does not name \"{quantity}\"");
}

#[test]
fn options_have_ranges() {
    let good = PuddleOptions::default();
    for size in [[0, 256], [256, 0], [63, 64], [4097, 64], [1_000_000, 1_000_000], [u32::MAX, u32::MAX]] {
        refused(&PuddleOptions { size, ..good.clone() }, "size of the lattice");
    }
    for cell_m in [0.0, -1.0, f32::NAN, f32::INFINITY, 1.0e-6, 2.0] {
        refused(&PuddleOptions { cell_m, ..good.clone() }, "edge of a cell");
    }
    for depth_m in [0.0, -0.01, f32::NAN, 1.0e-6, 1.0e9] {
        refused(&PuddleOptions { depth_m, ..good.clone() }, "depth");
    }
    for speed_m_s in [0.0, -1.0, f32::NAN, 1.0e6] {
        let form = PuddleForm::Membrane { speed_m_s };
        refused(&PuddleOptions { form, ..good.clone() }, "speed of the membrane");
    }
    for drag_per_s in [-1.0, f32::NAN, 1.0e9] {
        let damping = PuddleDamping::Rates { drag_per_s, viscosity_m2_s: 0.0 };
        refused(&PuddleOptions { damping, ..good.clone() }, "drag");
    }
    for viscosity_m2_s in [-1.0, f32::NAN, 1.0] {
        let damping = PuddleDamping::Rates { drag_per_s: 0.0, viscosity_m2_s };
        refused(&PuddleOptions { damping, ..good.clone() }, "viscosity");
    }
    let water = PuddleWater::default();
    refused(&PuddleOptions { water: PuddleWater { density: 0.0, ..water }, ..good.clone() }, "density");
    refused(&PuddleOptions { water: PuddleWater { gravity: f64::NAN, ..water }, ..good.clone() }, "gravity");
    let tension = PuddleWater { surface_tension: -0.1, ..water };
    refused(&PuddleOptions { water: tension, ..good.clone() }, "surface tension");
    refused(&PuddleOptions { degree: Some(0), ..good.clone() }, "degree");
    refused(&PuddleOptions { degree: Some(13), ..good.clone() }, "degree");
    refused(&PuddleOptions { max_wave_m: Some(f32::NAN), ..good.clone() }, "longest wavelength");
    refused(&PuddleOptions { max_substeps: 0, ..good.clone() }, "sub-steps");
    refused(&PuddleOptions { max_substeps: 65, ..good.clone() }, "sub-steps");
    refused(&PuddleOptions { steps_per_sweep: 0, ..good.clone() }, "steps per sweep");
    refused(&PuddleOptions { wave_energy_fraction: 1.5, ..good }, "energy");
}

#[test]
fn corners_of_the_ranges_work() {
    for (cell_m, depth_m) in [(1.0e-4, 1.0e-4), (1.0e-4, 1000.0), (1.0, 1.0e-4), (1.0, 1000.0)] {
        let mut puddle =
            Puddle::new(&PuddleOptions { cell_m, depth_m, ..undamped([64, 64]) }).expect("a puddle");
        set(&mut puddle, |x, y| hill(x, y, [30.0, 30.0], 4.0));
        let dt = puddle.max_step_s() as f32;
        puddle.step(0.99 * dt).expect("a step");
        let first = puddle.energy();
        for _ in 0..100 {
            puddle.step(7.9 * dt).expect("a step");
        }
        let ratio = puddle.energy() / first;
        assert!((0.9..1.1).contains(&ratio), "cells of {cell_m} m, {depth_m} m deep: {ratio}");
        assert_eq!(puddle.reset_cells(), 0);
    }
}

#[test]
fn time_steps_have_a_range() {
    let mut puddle = Puddle::new(&undamped([64, 64])).expect("a puddle");
    set(&mut puddle, |x, y| hill(x, y, [30.0, 30.0], 4.0));
    let before = puddle.heights();
    for dt in [0.0, -1.0, f32::NAN, f32::INFINITY, 1.0e-20] {
        let error = puddle.step(dt).expect_err("a time step");
        assert!(error.to_string().contains("time step"), "{error}");
    }
    // 10 s would be 2000 steps.
    let error = puddle.step(10.0).expect_err("10 s");
    assert!(error.to_string().contains("Courant number"), "{error}");
    assert!(puddle.heights() == before && puddle.steps() == 0, "a refused step moved the water");
    let most = 63.9 * puddle.max_step_s() as f32;
    assert_eq!(puddle.step(most).expect("64 parts"), 64);
}

/// 0.70 is allowed, 0.72 is not: divided into sub-steps where that is allowed, an error where it is not.
#[test]
fn the_courant_number_is_enforced() {
    let whole = PuddleOptions { max_substeps: 1, ..membrane([64, 64]) };
    let mut puddle = Puddle::new(&whole).expect("a puddle");
    let at = |courant: f32| courant * 0.01 / 0.3;
    assert!((puddle.courant(at(0.72)) - 0.72).abs() < 1.0e-6);
    assert_eq!(puddle.step(at(0.699)).expect("a Courant number of 0.699"), 1);
    match puddle.step(at(0.72)).expect_err("a Courant number of 0.72") {
        LatticeError::OutOfRange(OutOfRange { quantity, found, .. }) => {
            assert!(quantity.contains("Courant") && (found - 0.72).abs() < 1.0e-3, "{quantity} {found}");
        }
        other => panic!("{other}"),
    }
    let mut puddle = Puddle::new(&membrane([64, 64])).expect("a puddle");
    assert_eq!(puddle.step(at(0.72)).expect("two parts"), 2);
}

#[test]
fn masks_and_fields_are_as_large_as_the_lattice() {
    let options = undamped([64, 80]);
    for cells in [0, 64 * 64, 64 * 80 + 1] {
        let error = Puddle::with_land(&options, &vec![false; cells]).expect_err("a mask");
        assert!(error.to_string().contains("mask") && error.to_string().contains("5120"), "{error}");
    }
    let mut puddle = Puddle::new(&options).expect("a puddle");
    let error = puddle.set_state(&[0.0; 3], &[0.0; 64 * 80]).expect_err("a field");
    assert!(error.to_string().contains("heights"), "{error}");
    let error = puddle.set_state(&[0.0; 64 * 80], &[]).expect_err("a field");
    assert!(error.to_string().contains("velocities"), "{error}");
}

#[test]
fn all_land_and_one_cell_of_water_are_still() {
    for water in [None, Some(1000)] {
        let land: Vec<bool> = (0..64 * 64).map(|i| Some(i) != water).collect();
        let mut puddle = Puddle::with_land(&PuddleOptions::default_of([64, 64]), &land).expect("a puddle");
        puddle
            .seed(&[Impact { position_m: [0.05, 0.05], speed_m_s: 6.0, diameter_m: 2.0e-3 }])
            .expect("a drop on land");
        puddle.step(0.1).expect("a step");
        assert!(puddle.heights().iter().all(|&h| h == 0.0));
        assert!(puddle.normals().iter().all(|&n| n == [0.0, 1.0, 0.0]));
    }
}

#[test]
fn what_is_not_finite_is_set_to_rest_and_counted() {
    let mut puddle = Puddle::new(&undamped([64, 64])).expect("a puddle");
    let mut heights = vec![1.0e-4; 64 * 64];
    heights[100] = f32::NAN;
    heights[2000] = f32::INFINITY;
    assert_eq!(puddle.set_state(&heights, &[0.0; 64 * 64]).expect("heights"), 2);
    assert_eq!(puddle.reset_cells(), 2);
    puddle.step(0.05).expect("a step");
    assert!(puddle.heights().iter().all(|h| h.is_finite()));
    assert_eq!(puddle.reset_cells(), 2);
    // A height that overflows within the step: it and its surroundings are reset, and the rest continues.
    heights = vec![1.0e-4; 64 * 64];
    heights[64 * 30 + 30] = f32::MAX;
    assert_eq!(puddle.set_state(&heights, &[0.0; 64 * 64]).expect("heights"), 0);
    puddle.step(1.0e-3).expect("a step");
    let reset = puddle.reset_cells() - 2;
    assert!((1..=9 * 9).contains(&reset), "{reset} cells");
    assert!(puddle.heights().iter().chain(&puddle.velocities()).all(|h| h.is_finite()));
}

#[test]
fn impacts_and_objects_have_ranges() {
    let mut puddle = Puddle::new(&PuddleOptions::default()).expect("a puddle");
    let good = Impact { position_m: [0.1, 0.1], speed_m_s: 6.5, diameter_m: 2.0e-3 };
    let bad = [
        Impact { position_m: [f32::NAN, 0.1], ..good },
        Impact { position_m: [0.1, f32::INFINITY], ..good },
        Impact { speed_m_s: -1.0, ..good },
        Impact { speed_m_s: f32::NAN, ..good },
        Impact { speed_m_s: 1.0e9, ..good },
        Impact { diameter_m: 0.0, ..good },
        Impact { diameter_m: f32::NAN, ..good },
        Impact { diameter_m: 1.0, ..good },
    ];
    for impact in bad {
        puddle.seed(&[good, impact]).expect_err("an impact");
        assert!(
            puddle.heights().iter().all(|&h| h == 0.0),
            "{impact:?}: the good drop of a refused list fell"
        );
    }
    // Positions beyond the lattice are no error: rain falls beside a puddle too.
    puddle.seed(&[Impact { position_m: [-50.0, 1.0e5], ..good }]).expect("a drop elsewhere");
    assert!(puddle.heights().iter().all(|&h| h == 0.0));
    let wake = Wake { from_m: [0.1, 0.1], to_m: [0.11, 0.1], radius_m: 0.02, draft_m: 2.0e-3 };
    for bad in [
        Wake { radius_m: 0.0, ..wake },
        Wake { radius_m: f32::NAN, ..wake },
        Wake { draft_m: 0.006, ..wake },
        Wake { draft_m: -1.0, ..wake },
        Wake { from_m: [f32::NAN, 0.0], ..wake },
    ] {
        puddle.displace(&bad).expect_err("a wake");
    }
}

/// Short form of the defaults.
trait DefaultOf {
    fn default_of(size: [u32; 2]) -> PuddleOptions;
}

impl DefaultOf for PuddleOptions {
    fn default_of(size: [u32; 2]) -> PuddleOptions {
        PuddleOptions { size, ..PuddleOptions::default() }
    }
}
