//! The ridge of water ahead of a blade: film behind it, rest at the end of a sweep, drainage.

use downpour_lattice::glass::ridge::glass_ridge_is;
use downpour_lattice::glass::{
    Glass, GlassContact, GlassOptions, GlassTexture, GlassWetting, GlassWiper, GlassWiperKey,
    GlassWiperMotion,
};
use downpour_math::ops::f64 as ops;

const CELL_M: f64 = 0.6e-3;

/// A pane that a blade of 80 mm sweeps once, from the right to the left, between these angles in degrees and in this time.
fn pane(tilt_rad: f64, film_m: f64, life_s: f64, angles: [f64; 2], time_s: f64) -> GlassOptions {
    let key = |time_s, angle: f64| GlassWiperKey { time_s, angle_rad: angle.to_radians() };
    GlassOptions {
        size: [200, 200],
        cell_m: CELL_M,
        tilt_rad,
        affinity: GlassTexture::Even,
        friction: GlassTexture::Even,
        wetting: GlassWetting { film_life_s: life_s, ..GlassWetting::default() },
        wipers: vec![GlassWiper {
            pivot_m: [0.06, 0.13],
            inner_m: 0.03,
            outer_m: 0.11,
            motion: GlassWiperMotion::Keys(vec![key(0.0, angles[0]), key(time_s, angles[1])]),
            film_m,
            worn: Vec::new(),
        }],
        ..GlassOptions::default()
    }
}

/// Drops of 0.4 mm^3 each 3.6 mm.
fn wetted(options: &GlassOptions) -> Glass {
    let mut glass = Glass::new(options).expect("a pane");
    for y in (2..198).step_by(6) {
        for x in (2..198).step_by(6) {
            glass.pour(x, y, 0.4e-9).expect("a drop");
        }
    }
    glass
}

/// Water in ridges, and all other water in a sector swept by the blade: from 35 to 105 mm from the pivot, angles in degrees.
fn water(glass: &Glass, from: f64, to: f64) -> (u64, u64) {
    let (mut ridge, mut rest) = (0, 0);
    for (i, (&mass, motion)) in glass.mass().iter().zip(glass.motion()).enumerate() {
        let x = ((i % 200) as f64 + 0.5) * CELL_M - 0.06;
        let y = 0.13 - ((i / 200) as f64 + 0.5) * CELL_M;
        let angle = ops::atan2(y, x).to_degrees();
        if glass_ridge_is(motion[1]) {
            ridge += u64::from(mass);
        } else if (from..to).contains(&angle) && (0.035..0.105).contains(&ops::hypot(x, y)) {
            rest += u64::from(mass);
        }
    }
    (ridge, rest)
}

/// A blade leaves as much water as its film is thick, in droplets finer than drops of rain, which dry within seconds.
#[test]
fn a_blade_leaves_the_film_that_was_asked_and_it_dries() {
    let swept = |film_m, life_s| {
        let mut glass = wetted(&pane(0.0, film_m, life_s, [50.0, 130.0], 0.5));
        glass.step(0.5).expect("a step");
        glass
    };
    let mut glass = swept(0.5e-6, f64::INFINITY);
    // The sector between 60 and 110 degrees has been passed by the blade, and not by the ridge's end.
    let area = 0.5 * (0.105f64 * 0.105 - 0.035 * 0.035) * 50f64.to_radians();
    let expected = 0.5e-6 * area / Glass::UNIT_M3;
    let (_, film) = water(&glass, 60.0, 110.0);
    assert!((film as f64 / expected - 1.0).abs() < 0.25, "{film} for {expected}");
    glass.step(3.0).expect("a step");
    assert!(water(&glass, 60.0, 110.0).1 >= film, "it stays where nothing dries");
    let mut drying = swept(0.5e-6, 0.5);
    let before = water(&drying, 60.0, 110.0).1 as f64;
    drying.step(1.0).expect("a step");
    let after = water(&drying, 60.0, 110.0).1 as f64;
    // Two mean lives: exp(-2) is 0.135.
    assert!((after / before - 0.135).abs() < 0.05, "{after} of {before}");
    assert_eq!(drying.totals().lost(), 0);
    assert_eq!(water(&swept(0.0, 0.5), 60.0, 110.0).1, 0);
}

/// At the end of a sweep the ridge stays as a line: level glass keeps it, upright glass lets it drain.
#[test]
fn a_ridge_stays_at_the_end_of_a_sweep_and_drains_down_an_upright_pane() {
    let mut level = wetted(&pane(0.0, 0.0, 1.0, [40.0, 90.0], 0.4));
    level.step(0.45).expect("a step");
    let (swept, _) = water(&level, 0.0, 1.0);
    // The drops of the sector, of 0.4 mm^3 each 3.6 mm, within the reach of the ridge.
    let area = 0.5 * (0.11f64 * 0.11 - 0.03 * 0.03) * 50f64.to_radians();
    let expected = 0.4e-9 / (3.6e-3 * 3.6e-3) * area / Glass::UNIT_M3;
    assert!((swept as f64 / expected - 1.0).abs() < 0.25, "{swept} for {expected}");
    level.step(5.0).expect("a step");
    let (kept, _) = water(&level, 0.0, 1.0);
    assert!(kept as f64 > 0.95 * swept as f64, "{kept} of {swept}");

    // An upright blade: the ridge runs down its own length.
    let mut upright = wetted(&pane(std::f64::consts::FRAC_PI_2, 0.0, 1.0, [40.0, 90.0], 0.4));
    upright.step(0.45).expect("a step");
    let (before, _) = water(&upright, 0.0, 1.0);
    upright.step(6.0).expect("a step");
    let (after, _) = water(&upright, 0.0, 1.0);
    assert!(before > 10_000 && 2 * after < before, "{after} of {before}");
    assert!(upright.is_sound());
}

/// Width and speed of a ridge against the closed forms of a thin parabola: area 4/3 of half-width times height, mean speed
/// 8/35 of weight times height squared over viscosity.
#[test]
fn a_thin_ridge_is_a_parabola() {
    let angle = 8f64.to_radians();
    let contact = GlassContact { advancing_rad: angle, receding_rad: angle, ..GlassContact::default() };
    let area = 2.0e-6;
    let half = contact.ridge(area);
    let height = half * ops::tan(0.5 * angle);
    assert!((4.0 / 3.0 * half * height / area - 1.0).abs() < 0.01, "{half}, {height}");
    let speed = contact.ridge_speed(area, 9790.0, 1.0e-3);
    let steps = 2000;
    let (mut cubes, mut sum) = (0.0, 0.0);
    for k in 0..steps {
        let x = (f64::from(k) + 0.5) / f64::from(steps);
        let h = height * (1.0 - x * x);
        cubes += h * h * h;
        sum += h;
    }
    let expected = 9790.0 / 1.0e-3 * cubes / (3.0 * sum);
    assert!((speed / expected - 1.0).abs() < 1.0e-3, "{speed} for {expected}");
}
