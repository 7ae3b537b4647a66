//! Drops that leave an edge against published sizes, and their fall from rest against a numeric integration.

use approx::assert_relative_eq;
use downpour_drop::drip::{self, Drip};
use downpour_drop::fall_speed::{fall_from_rest, time_of_fall};
use downpour_drop::{DropError, water};
use downpour_math::ops::f64 as ops;

/// The fit of B.-B. Lee, P. Ravindra, E.-S. Chan, Chem. Eng. Commun. 195, 889 (2008) to drops of many liquids.
fn lee_ravindra_chan(x: f64) -> f64 {
    let c = [1.0, -0.9121, -2.109, 13.38, -27.29, 27.53, -13.58, 2.593];
    c.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

#[test]
fn the_fraction_is_that_of_a_published_fit() {
    for k in 30..=120 {
        let x = 0.01 * f64::from(k);
        assert_relative_eq!(drip::detached_fraction(x), lee_ravindra_chan(x), max_relative = 0.02);
    }
    assert_eq!(drip::detached_fraction(0.0), 1.0);
    assert_eq!(drip::detached_fraction(9.0), drip::detached_fraction(1.2));
}

/// A pharmacist's dropper, 3.0 mm wide: 20 drops of water at 20 C are 1.000 g +- 0.050 g (European Pharmacopoeia 2.1.1), 1 per
/// second. Slow drops are a little lighter.
#[test]
fn twenty_drops_of_a_dropper_are_a_gram() {
    let drop = Drip::new(1.5e-3, 20.0).unwrap();
    let milliliters = drop.volume() * 1.0e6;
    assert!((0.045..0.050).contains(&milliliters), "{milliliters} ml");
    let gram = 20.0 * drop.volume() * water::density(20.0).unwrap() * 1.0e3;
    assert!((gram - 1.0).abs() < 0.055, "{gram} g");
}

/// Tate's law with a constant fraction of 0.6 to 0.65: 28 mg or 3.8 mm off an edge of 1 mm, 4.75 mm off 2 mm.
#[test]
fn drops_are_as_large_as_tate_says() {
    let weight = |radius: f64, f: f64| std::f64::consts::TAU * radius * 0.072_736 * f / 9.806_65;
    assert_relative_eq!(weight(1.0e-3, 0.6), 28.0e-6, max_relative = 0.01);
    for (radius, f, diameter) in [(2.0e-3, 0.6, 4.75e-3), (2.0e-3, 0.65, 4.88e-3), (2.5e-3, 0.62, 5.17e-3)] {
        let drop = Drip::new(radius, 20.0).unwrap();
        assert_relative_eq!(drop.diameter_m, diameter, max_relative = 0.03);
        let of_weight = drip::sphere_diameter(weight(radius, f) / 998.204);
        assert_relative_eq!(drop.diameter_m, of_weight, max_relative = 0.03);
    }
    // The cap: 2.10 grains of 64.799 mg.
    let largest = Drip::new(20.0e-3, 20.0).unwrap();
    assert_eq!(largest.diameter_m, drip::MAX_DIAMETER_M);
    assert_relative_eq!(largest.volume() * 998.204, 2.10 * 64.799e-6, max_relative = 0.01);
    let broad = Drip::new(drip::BROAD_RADIUS_M, 20.0).unwrap();
    assert!((4.8e-3..5.4e-3).contains(&broad.diameter_m), "{broad:?}");
}

#[test]
fn a_drop_of_a_diameter_is_that_of_its_edge() {
    for radius in [0.2e-3, 1.0e-3, 2.4e-3, 4.0e-3] {
        let drop = Drip::new(radius, 10.0).unwrap();
        let again = Drip::of_diameter(drop.diameter_m, 10.0).unwrap();
        assert_relative_eq!(again.detached, drop.detached, max_relative = 1.0e-4);
    }
}

/// 2 pi times the square root of 2 sigma / (rho g): 3.854 mm at 20 C.
#[test]
fn drops_stand_at_the_distance_of_the_fastest_wave() {
    assert_relative_eq!(
        drip::spacing(20.0).unwrap(),
        std::f64::consts::TAU * 3.8546e-3,
        max_relative = 1.0e-3
    );
}

#[test]
fn water_hangs_and_falls_and_none_is_lost() {
    let drop = Drip::new(2.0e-3, 20.0).unwrap();
    let volume = |fraction: f64| drip::sphere_volume(drop.hanging_diameter(fraction));
    assert_relative_eq!(volume(1.0) - volume(0.0), drop.volume(), max_relative = 1.0e-9);
    assert_relative_eq!(volume(0.25) - volume(0.0), 0.25 * drop.volume(), max_relative = 1.0e-9);
    assert_relative_eq!(volume(1.0) * drop.detached, drop.volume(), max_relative = 1.0e-9);
    for flow in [0.0, 1.0e-9, 3.0e-7, 5.9e-7, 6.5e-7, 2.0e-6, 2.0e-5] {
        let found = drop.flow(flow);
        let sum = found.per_s * drip::sphere_volume(found.diameter_m);
        assert_relative_eq!(sum, flow, max_relative = 1.0e-9);
        assert_eq!(found.is_jet, flow / drop.volume() > drip::MAX_DRIPPING_PER_S);
        assert!(found.diameter_m <= drip::MAX_DIAMETER_M);
    }
}

/// Rayleigh: a wave of 4.508 diameters has the volume of a drop of 1.88; the jet has the Weber number 4.
#[test]
fn a_jet_breaks_as_rayleigh_says() {
    let ratio = ops::cbrt(1.5 * 4.508);
    assert_relative_eq!(drip::JET_DROP_RATIO, ratio, max_relative = 0.01);
    let drop = Drip::new(2.0e-3, 20.0).unwrap();
    let flow = 1.0e-6;
    let diameter = drop.jet_diameter(flow);
    let speed = flow / (std::f64::consts::FRAC_PI_4 * diameter * diameter);
    assert_relative_eq!(998.204 * speed * speed * diameter / 0.072_736, 4.0, max_relative = 1.0e-3);
    assert_relative_eq!(drop.flow(flow).diameter_m, 1.88 * diameter, max_relative = 1.0e-9);
}

/// Integration in small steps of `dv/dt = g (1 - v^2 / vt^2)`.
#[test]
fn a_fall_from_rest_solves_its_equation() {
    for terminal in [2.0, 9.0] {
        let (mut y, mut v, step) = (0.0, 0.0f64, 1.0e-5);
        for k in 0..200_000u32 {
            if k % 20_000 == 0 {
                let [distance, speed] = fall_from_rest(terminal, f64::from(k) * step);
                assert!((distance - y).abs() < 1.0e-4 && (speed - v).abs() < 1.0e-4, "{k}: {distance} {y}");
                assert!((time_of_fall(terminal, distance) - f64::from(k) * step).abs() < 1.0e-6, "{k}");
            }
            // Midpoint rule.
            let slope = |v: f64| 9.806_65 * (1.0 - v * v / (terminal * terminal));
            let middle = v + 0.5 * step * slope(v);
            v += step * slope(middle);
            y += step * middle;
        }
    }
    // Where the series ends.
    let [below, above] = [0.99, 1.01].map(|k| fall_from_rest(9.0, k * 1.0e-2 * 9.0 / 9.806_65)[0]);
    assert_relative_eq!(above / below, (1.01f64 / 0.99) * (1.01 / 0.99), max_relative = 1.0e-5);
    assert_eq!(fall_from_rest(0.0, 1.0), [0.0; 2]);
    assert_eq!(time_of_fall(0.0, 1.0), f64::INFINITY);
}

#[test]
fn values_out_of_range_are_refused() {
    let refused = |found: Result<Drip, DropError>| found.unwrap_err().to_string();
    assert!(refused(Drip::new(0.0, 20.0)).contains("radius of an edge is 0 mm"));
    assert!(refused(Drip::new(f64::NAN, 20.0)).contains("allowed: 0.05 to 1000"));
    assert!(refused(Drip::new(1.0e-3, 80.0)).contains("temperature"));
    assert!(
        refused(Drip::of_diameter(7.0e-3, 20.0)).contains("diameter of a drip is 7 mm; allowed: 0.5 to 6.4")
    );
    assert!(drip::spacing(99.0).is_err());
}
