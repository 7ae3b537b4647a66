//! Energy, volume, rest, walls, borders, threads.

use downpour_lattice::puddle::{Puddle, PuddleBorder, PuddleDamping, PuddleOptions, PuddleStorage};
use rayon::prelude::*;

use crate::{hill, membrane, set, undamped};

/// An island and a spit as obstacles.
fn land(size: [u32; 2]) -> Vec<bool> {
    let [nx, ny] = size.map(|n| n as usize);
    let is_land = |x: usize, y: usize| {
        let (dx, dy) = (x as f64 - 40.0, y as f64 - 20.0);
        dx * dx + dy * dy < 60.0 || (x == 12 && y > 30)
    };
    (0..nx * ny).map(|i| is_land(i % nx, i / nx)).collect()
}

/// Largest relative deviation of the energy from the first, over some steps.
fn energy_drift(options: &PuddleOptions, steps: u32, probes: u32) -> f64 {
    let mut puddle = Puddle::with_land(options, &land(options.size)).expect("a puddle");
    set(&mut puddle, |x, y| hill(x, y, [20.0, 20.0], 4.0));
    let dt = 0.999 * puddle.max_step_s() as f32;
    puddle.step(dt).expect("a step");
    let first = puddle.energy();
    let mut worst: f64 = 0.0;
    for _ in 0..probes {
        for _ in 0..steps / probes / 8 {
            assert_eq!(puddle.step(8.0 * dt).expect("a step"), 8);
        }
        worst = worst.max((puddle.energy() / first - 1.0).abs());
    }
    worst
}

#[test]
fn energy_stays_without_damping() {
    for options in [undamped([64, 64]), membrane([64, 64])] {
        let drift = energy_drift(&options, 4000, 5);
        assert!(drift < 1.0e-4, "{drift}: {options:?}");
    }
}

#[test]
#[ignore = "a million steps take two minutes"]
fn energy_stays_for_a_million_steps() {
    [undamped([64, 64]), membrane([64, 64])].par_iter().for_each(|options| {
        let drift = energy_drift(options, 1_000_000, 20);
        println!("{:?}: energy within {drift:e} of the first", options.form);
        assert!(drift < 1.0e-3, "{drift}: {options:?}");
    });
}

#[test]
fn level_water_stays_level_among_islands() {
    for options in
        [undamped([64, 64]), membrane([64, 64]), PuddleOptions { depth_m: 0.5, ..undamped([64, 64]) }]
    {
        let land = land(options.size);
        let mut puddle = Puddle::with_land(&options, &land).expect("a puddle");
        set(&mut puddle, |_, _| 0.7e-3);
        let before = puddle.heights();
        for _ in 0..50 {
            puddle.step(8.0 * puddle.max_step_s() as f32).expect("a step");
        }
        assert!(puddle.heights() == before, "level water moved");
        assert!(puddle.velocities().iter().all(|&v| v == 0.0));
        assert!(before.iter().zip(&land).all(|(&h, &land)| h == if land { 0.0 } else { 0.7e-3 }));
    }
}

#[test]
fn volume_stays() {
    let options = undamped([64, 64]);
    let mut puddle = Puddle::with_land(&options, &land(options.size)).expect("a puddle");
    set(&mut puddle, |x, y| hill(x, y, [20.0, 20.0], 4.0));
    let before = puddle.volume();
    for _ in 0..100 {
        puddle.step(0.03).expect("a step");
    }
    assert!((puddle.volume() / before - 1.0).abs() < 1.0e-4, "{} of {before}", puddle.volume());
}

#[test]
fn nothing_passes_a_wall() {
    let options = undamped([64, 64]);
    let wall: Vec<bool> = (0..64 * 64).map(|i| i % 64 == 30).collect();
    let mut puddle = Puddle::with_land(&options, &wall).expect("a puddle");
    set(&mut puddle, |x, y| if x < 30 { hill(x, y, [15.0, 30.0], 4.0) } else { 0.0 });
    for _ in 0..60 {
        puddle.step(0.01).expect("a step");
    }
    let heights = puddle.heights();
    let side = |columns: std::ops::Range<usize>| {
        columns.flat_map(|x| (0..64).map(move |y| y * 64 + x)).map(|i| heights[i].abs()).fold(0.0, f32::max)
    };
    assert_eq!(side(30..64), 0.0);
    assert!(side(0..30) > 1.0e-5);
}

#[test]
fn an_open_border_lets_ripples_go() {
    for options in [undamped([192, 192]), membrane([192, 192])] {
        let left = |border| {
            let mut puddle = Puddle::new(&PuddleOptions { border, ..options.clone() }).expect("a puddle");
            set(&mut puddle, |x, y| hill(x, y, [96.0, 96.0], 4.0));
            puddle.step(1.0e-3).expect("a step");
            let first = puddle.energy();
            // Time enough to cross the lattice twice at the slowest speed.
            let time = 2.0 * 192.0 * options.cell_m / 0.2;
            for _ in 0..20 {
                puddle.step(time / 20.0).expect("a step");
            }
            puddle.energy() / first
        };
        assert!((left(PuddleBorder::Reflecting) - 1.0).abs() < 1.0e-2);
        let open = left(PuddleBorder::Open);
        assert!(open < 1.0e-3, "{open} of the energy is left: {:?}", options.form);
    }
}

#[test]
fn damping_takes_energy_at_its_rate() {
    // Viscosity alone, one wave of 16 mm: amplitude rate 2 nu k^2, on the lattice 4 nu lambda / 2.
    let damping = PuddleDamping::Rates { drag_per_s: 0.5, viscosity_m2_s: 1.0e-5 };
    let mut puddle = Puddle::new(&PuddleOptions { damping, ..undamped([128, 64]) }).expect("a puddle");
    let k = std::f64::consts::TAU / 0.016;
    set(&mut puddle, |x, _| 1.0e-3 * downpour_math::ops::f64::cos(k * (x as f64 + 0.5) * 2.0e-3));
    puddle.step(1.0e-3).expect("a step");
    let mut before = puddle.energy();
    let first = before;
    for _ in 0..20 {
        puddle.step(0.01).expect("a step");
        assert!(puddle.energy() <= before * 1.0001, "energy rose");
        before = puddle.energy();
    }
    let rate = -0.5 * downpour_math::ops::f64::ln(before / first) / 0.2;
    let law = 0.5 + 2.0 * 1.0e-5 * k * k;
    assert!((rate / law - 1.0).abs() < 0.08, "{rate} 1/s, law {law}");
}

#[test]
fn a_damped_field_ends_in_zeros() {
    let damping = PuddleDamping::Rates { drag_per_s: 500.0, viscosity_m2_s: 0.0 };
    let mut puddle = Puddle::new(&PuddleOptions { damping, ..undamped([64, 64]) }).expect("a puddle");
    set(&mut puddle, |x, _| if x % 2 == 0 { 1.0e-18 } else { -1.0e-18 });
    for _ in 0..100 {
        puddle.step(0.02).expect("a step");
    }
    let small = |v: &f32| *v == 0.0 || v.abs() >= 1.0e-20;
    assert!(puddle.heights().iter().all(small) && puddle.velocities().iter().all(small));
    assert!(puddle.velocities().iter().all(|&v| v == 0.0), "it still moves");
}

/// The bits do not depend on the number of threads and of steps per sweep.
#[test]
fn bits_do_not_depend_on_how_the_work_is_cut() {
    let run = |threads: usize, steps_per_sweep: u32, form_size: [u32; 2]| {
        let options = PuddleOptions { steps_per_sweep, border: PuddleBorder::Open, ..undamped(form_size) };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut puddle = Puddle::with_land(
                &options,
                &(0..form_size[0] * form_size[1]).map(|i| i % 97 == 5).collect::<Vec<_>>(),
            )
            .expect("a puddle");
            set(&mut puddle, |x, y| hill(x, y, [30.0, 100.0], 4.0));
            for _ in 0..5 {
                puddle.step(0.03).expect("a step");
            }
            puddle.heights().iter().map(|h| h.to_bits()).collect::<Vec<_>>()
        })
    };
    // Wider than a tile, and not a multiple of anything.
    let size = [601, 131];
    let one = run(1, 1, size);
    assert!(one.iter().any(|&bits| bits != 0));
    assert!(one == run(2, 1, size), "threads");
    assert!(one == run(3, 3, size), "threads and steps per sweep");
}

#[test]
fn sixteen_bits_are_close() {
    let run = |storage| {
        let mut puddle = Puddle::new(&PuddleOptions {
            storage,
            ..PuddleOptions { size: [128, 128], ..Default::default() }
        })
        .expect("a puddle");
        set(&mut puddle, |x, y| hill(x, y, [50.0, 60.0], 4.0));
        for _ in 0..30 {
            puddle.step(1.0 / 60.0).expect("a step");
        }
        puddle.heights()
    };
    let (full, half) = (run(PuddleStorage::Full), run(PuddleStorage::Half));
    let rms = |values: &mut dyn Iterator<Item = f32>| values.map(|v| f64::from(v * v)).sum::<f64>().sqrt();
    let error = rms(&mut full.iter().zip(&half).map(|(a, b)| a - b)) / rms(&mut full.iter().copied());
    println!("16 bits: {error:e} of the rms height after 0.5 s");
    assert!(error > 0.0, "16 bits are not used");
    assert!(error < 2.0e-2, "{error}");
}
