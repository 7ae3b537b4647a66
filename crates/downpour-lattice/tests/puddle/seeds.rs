//! Craters have their energy and no volume; wakes follow the dispersion law.

use std::f64::consts::PI;

use downpour_lattice::puddle::{DropRing, Impact, Puddle, PuddleBorder, PuddleOptions, Wake};

const DROP: Impact = Impact { position_m: [0.2563, 0.2571], speed_m_s: 6.5, diameter_m: 2.0e-3 };

fn deep() -> PuddleOptions {
    PuddleOptions { depth_m: 0.05, cell_m: 1.0e-3, size: [512, 512], degree: Some(4), ..Default::default() }
}

/// Energy of a surface at rest: rho g / 2 eta^2 + sigma / 2 grad^2.
fn potential(puddle: &Puddle) -> f64 {
    let o = puddle.options();
    let [nx, ny] = o.size.map(|n| n as usize);
    let heights = puddle.heights();
    let (cell, w) = (f64::from(o.cell_m), o.water);
    let at = |x: usize, y: usize| f64::from(heights[y * nx + x]);
    let mut sum = 0.0;
    for y in 0..ny - 1 {
        for x in 0..nx - 1 {
            let (h, dx, dy) = (at(x, y), at(x + 1, y) - at(x, y), at(x, y + 1) - at(x, y));
            sum += 0.5 * w.density * w.gravity * h * h * cell * cell
                + 0.5 * w.surface_tension * (dx * dx + dy * dy);
        }
    }
    sum
}

#[test]
fn a_crater_has_its_share_of_the_drops_energy() {
    for (diameter_m, speed_m_s) in [(1.5e-3, 5.4), (2.0e-3, 6.5), (4.0e-3, 8.8)] {
        let mut puddle = Puddle::new(&deep()).expect("a puddle");
        puddle.seed(&[Impact { diameter_m, speed_m_s, ..DROP }]).expect("a drop");
        let d = f64::from(diameter_m);
        let kinetic = PI / 12.0 * 998.2 * d * d * d * f64::from(speed_m_s * speed_m_s);
        let fraction = potential(&puddle) / kinetic;
        assert!((fraction / 0.02 - 1.0).abs() < 0.06, "{diameter_m} m: {fraction} of the energy");
    }
}

#[test]
fn a_crater_takes_no_water() {
    let options = PuddleOptions { size: [128, 128], ..Default::default() };
    let land: Vec<bool> = (0..128 * 128).map(|i| i % 128 > 90).collect();
    // In the open, at the border, in a corner, beside land.
    for position_m in [[0.1, 0.12], [0.001, 0.1], [0.0, 0.0], [0.178, 0.1]] {
        let mut puddle = Puddle::with_land(&options, &land).expect("a puddle");
        puddle.seed(&[Impact { position_m, ..DROP }]).expect("a drop");
        let moved: f64 = puddle.heights().iter().map(|&h| f64::from(h.abs())).sum::<f64>() * 4.0e-6;
        assert!(moved > 1.0e-9);
        assert!(puddle.volume().abs() < 1.0e-5 * moved, "{position_m:?}: {} of {moved} m^3", puddle.volume());
    }
}

#[test]
fn larger_and_faster_drops_make_higher_waves() {
    let height = |impact: Impact| {
        let mut puddle =
            Puddle::new(&PuddleOptions { depth_m: 0.02, ..Default::default() }).expect("a puddle");
        puddle.seed(&[impact]).expect("a drop");
        puddle.step(0.1).expect("a step");
        puddle.heights().iter().fold(0.0, |a: f32, h| a.max(h.abs()))
    };
    let sizes = [0.5e-3, 1.0e-3, 2.0e-3, 4.0e-3].map(|diameter_m| height(Impact { diameter_m, ..DROP }));
    assert!(sizes.windows(2).all(|w| w[0] < w[1]), "{sizes:?}");
    let speeds = [1.0, 3.0, 6.0].map(|speed_m_s| height(Impact { speed_m_s, ..DROP }));
    assert!(speeds.windows(2).all(|w| w[0] < w[1]), "{speeds:?}");
}

/// The order of drops changes rounding only, and the same drops give the same bits.
#[test]
fn the_same_drops_give_the_same_bits() {
    let run = || {
        let mut puddle = Puddle::new(&PuddleOptions::default()).expect("a puddle");
        puddle.seed(&[DROP, Impact { position_m: [0.25, 0.25], ..DROP }]).expect("drops");
        puddle.step(0.05).expect("a step");
        puddle.heights()
    };
    assert!(run() == run());
}

/// An object makes waves that move with it only if it is faster than the slowest wave: 0.22 m/s on 5 mm of water.
#[test]
fn a_wake_needs_a_speed() {
    let radiated = |speed: f32| {
        let options =
            PuddleOptions { size: [384, 128], border: PuddleBorder::Open, ..crate::undamped([384, 128]) };
        let mut puddle = Puddle::new(&options).expect("a puddle");
        let dt = 5.0e-3f32;
        let (mut x, mut ahead) = (0.1f32, 0.0);
        while x < 0.6 {
            // Slowly into the water, so that the start makes no wave.
            let draft_m = 1.0e-3 * ((x - 0.1) / 0.2).min(1.0);
            let next = x + speed * dt;
            let wake = |from: f32, to: f32, draft_m| Wake {
                from_m: [from, 0.128],
                to_m: [to, 0.128],
                radius_m: 0.012,
                draft_m,
            };
            puddle.displace(&wake(x, next, draft_m)).expect("a wake");
            puddle.step(dt).expect("a step");
            x = next;
            if x >= 0.6 {
                // The waves well behind the object.
                let heights = puddle.heights();
                let behind = heights.chunks(384).flat_map(|row| &row[180..270]);
                ahead = behind.map(|&h| f64::from(h * h)).sum::<f64>().sqrt();
            }
        }
        // A hundredth of the object's displacement.
        assert!(puddle.volume().abs() < 2.0e-8, "{} m^3", puddle.volume());
        ahead
    };
    let (slow, fast) = (radiated(0.12), radiated(0.35));
    assert!(fast > 4.0 * slow, "{slow} slow, {fast} fast");
}

/// A drop on a lattice makes the ring of the closed form: two methods that share the crater and the law of the water alone.
#[test]
fn a_ring_on_a_lattice_is_that_of_the_closed_form() {
    let options = PuddleOptions {
        size: [512, 512],
        cell_m: 1.5e-3,
        depth_m: 8.0e-3,
        border: PuddleBorder::Open,
        degree: Some(12),
        max_wave_m: Some(0.08),
        ..PuddleOptions::default()
    };
    let mut puddle = Puddle::new(&options).expect("a puddle");
    let middle = 256.5 * 1.5e-3;
    puddle
        .seed(&[Impact { position_m: [middle, middle], speed_m_s: 8.1, diameter_m: 3.0e-3 }])
        .expect("an impact");
    let ring = DropRing::new(&options, 3.0e-3, 8.1).expect("a ring");
    let mut time = 0.0;
    for until in [0.05, 0.1, 0.2, 0.3] {
        while time < until - 1.0e-6 {
            puddle.step(2.5e-3).expect("a step");
            time += 2.5e-3;
        }
        let heights = puddle.heights();
        let (mut square, mut error) = (0.0, 0.0);
        for cell in 0..180u16 {
            let found = f64::from(heights[256 * 512 + 256 + usize::from(cell)]);
            let distance = f64::from(cell) * 1.5e-3;
            let expected = ring.height(distance, time);
            // By area: what is far away counts as it is seen.
            square += expected * expected * distance;
            error += (found - expected) * (found - expected) * distance;
        }
        let relative = (error / square).sqrt();
        println!("{until} s: relative difference {relative}");
        assert!(relative < 0.12, "{until}: {relative}");
    }
}
