//! Oscillation against the published frequencies, and conservation of volume.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use downpour_drop::mesh::{DropMesh, DropSurface as _};
use downpour_drop::oscillation::{
    Amplitudes, DropOscillation, DropOscillationTime, Fluids, FrequencyLaw, OscillatingDrop, Oscillation,
    drop_oscillation_angular_frequency, drop_oscillation_azimuth, drop_oscillation_damping_time,
    drop_oscillation_displacement, drop_oscillation_frequency, drop_oscillation_inverse_cube_root,
    drop_oscillation_legendre_20, drop_oscillation_legendre_31, drop_oscillation_outline,
    drop_oscillation_phase, drop_oscillation_radius, drop_oscillation_sine, drop_oscillation_state,
    drop_oscillation_state_rousseau_2008, drop_oscillation_turns, drop_oscillation_volume, lamb_damping_time,
};
use downpour_drop::shape::DropShape;
use downpour_math::ops::f64::{cos, exp, pow, sin};
use downpour_math::quadrature::GaussLegendre;
use downpour_math::rng::seed_words;

const WATER: Fluids = Fluids::AT_20_C;
const PRESETS: [Amplitudes; 2] = [Amplitudes::GARG_NAYAR_EVEN, Amplitudes::GARG_NAYAR_OBLATE];

fn oscillation(diameter: f64, amplitudes: Amplitudes) -> Oscillation {
    Oscillation::new(diameter, amplitudes, &WATER, FrequencyLaw::default()).expect("in range")
}

/// Pairs of displacements over all phases of both modes.
fn displacements(amplitudes: Amplitudes) -> impl Iterator<Item = [f64; 2]> {
    let [a20, a31] = amplitudes.pair();
    (0..16 * 16).map(move |k| {
        let phase = |k: i32| sin(TAU * f64::from(k) / 16.0);
        [a20 * phase(k % 16), a31 * phase(k / 16)]
    })
}

/// Mean over the sphere.
fn sphere_mean(f: impl Fn(f64, f64) -> f64) -> f64 {
    let rule = GaussLegendre::new(24);
    let circle = 24;
    rule.integrate(-1.0, 1.0, |x| {
        (0..circle).map(|k| f(x, TAU * f64::from(k) / f64::from(circle))).sum::<f64>()
    }) / (2.0 * f64::from(circle))
}

/// Diameter (mm), f2, f3, f4 (Hz), tau2, tau3 (s) at 20 C, by Rayleigh and Lamb.
const TABLE: [[f64; 6]; 12] = [
    [0.5, 972.122, 1882.505, 2916.365, 0.012, 0.004],
    [1.0, 343.697, 665.566, 1031.091, 0.05, 0.018],
    [1.5, 187.085, 362.288, 561.255, 0.112, 0.04],
    [2.0, 121.515, 235.313, 364.546, 0.199, 0.071],
    [2.5, 86.949, 168.376, 260.848, 0.311, 0.111],
    [3.0, 66.144, 128.088, 198.433, 0.448, 0.16],
    [3.2, 60.041, 116.27, 180.124, 0.51, 0.182],
    [3.5, 52.49, 101.646, 157.469, 0.61, 0.218],
    [4.0, 42.962, 83.196, 128.886, 0.797, 0.285],
    [5.0, 30.741, 59.53, 92.224, 1.246, 0.445],
    [6.0, 23.386, 45.286, 70.157, 1.794, 0.641],
    [7.0, 18.558, 35.937, 55.674, 2.442, 0.872],
];

#[test]
fn frequencies_and_damping() {
    for [mm, f2, f3, f4, tau2, tau3] in TABLE {
        let d = mm * 1.0e-3;
        for (n, expected) in [(2, f2), (3, f3), (4, f4)] {
            let f = FrequencyLaw::Rayleigh1879.frequency(n, d, &WATER).unwrap();
            assert!((f / expected - 1.0).abs() < 2.0e-5, "{mm} {n}: {f}");
            let lamb = FrequencyLaw::LambTwoFluid.frequency(n, d, &WATER).unwrap();
            assert!((-6.0e-4..-3.0e-4).contains(&(lamb / f - 1.0)), "{mm} {n}: {lamb}");
            let omega = drop_oscillation_angular_frequency(n, 0.5 * d as f32, 0.072736, 998.204);
            assert!((f64::from(omega) / (TAU * f) - 1.0).abs() < 4.0e-7, "{mm} {n}: {omega}");
        }
        for (n, expected) in [(2, tau2), (3, tau3)] {
            let tau = lamb_damping_time(n, d, &WATER).unwrap();
            assert!((tau - expected).abs() < 5.1e-4, "{mm} {n}: {tau}");
            let single = drop_oscillation_damping_time(n, 0.5 * d as f32, 1.0034e-6);
            assert!((f64::from(single) / tau - 1.0).abs() < 4.0e-7, "{mm} {n}: {single}");
        }
    }
    // The effect of the air at 3 mm, and the period of the database of Garg & Nayar.
    let at = |law: FrequencyLaw, d: f64| law.frequency(2, d, &WATER).unwrap();
    let ratio = at(FrequencyLaw::LambTwoFluid, 3.0e-3) / at(FrequencyLaw::Rayleigh1879, 3.0e-3);
    assert!((ratio - 1.0 + 4.0e-4).abs() < 1.0e-5, "{ratio}");
    assert!((60.0 / at(FrequencyLaw::Rayleigh1879, 3.2e-3) - 1.0).abs() < 1.0e-3);
    assert_eq!(drop_oscillation_angular_frequency(1, 1.0e-3, 0.07, 1000.0), 0.0);
    assert_eq!(drop_oscillation_angular_frequency(0, 1.0e-3, 0.07, 1000.0), 0.0);
}

#[test]
fn legendre_functions() {
    assert_eq!(drop_oscillation_legendre_20(0.0), -0.5);
    assert_eq!(drop_oscillation_legendre_20(1.0), 1.0);
    assert_eq!(drop_oscillation_legendre_31(0.0), 1.5);
    assert_eq!(drop_oscillation_legendre_31(1.0f32), 0.0);
    assert_eq!(drop_oscillation_legendre_31(1.0f32.next_up()), 0.0);
    let largest = (0..=10_000).map(|i| drop_oscillation_legendre_31(f64::from(i) * 1.0e-4).abs());
    assert!((largest.fold(0.0, f64::max) - 2.0656).abs() < 1.0e-4);
    // Orthogonal, and of the norm of unnormalized functions: 2 / (2n + 1) (n + m)! / (n - m)!.
    let rule = GaussLegendre::new(12);
    let (p20, p31) = (drop_oscillation_legendre_20::<f64>, drop_oscillation_legendre_31::<f64>);
    let norms =
        [rule.integrate(-1.0, 1.0, |x| p20(x) * p20(x)), rule.integrate(-1.0, 1.0, |x| p31(x) * p31(x))];
    assert!((norms[0] - 2.0 / 5.0).abs() < 1.0e-14 && (norms[1] - 24.0 / 7.0).abs() < 1.0e-13, "{norms:?}");
}

/// The closed form is the mean of the cube.
#[test]
fn volume_in_closed_form() {
    for amplitudes in PRESETS.into_iter().chain([Amplitudes::new(0.3, 0.3).unwrap()]) {
        for displacement in displacements(amplitudes) {
            let state = drop_oscillation_state_rousseau_2008(displacement);
            let cube = sphere_mean(|x, phi| {
                let r = drop_oscillation_radius(state, x, cos(phi));
                r * r * r
            });
            let volume = drop_oscillation_volume(displacement);
            assert!((volume - cube).abs() < 1.0e-13, "{displacement:?}: {volume} for {cube}");
            assert!((1.0..1.4).contains(&volume));
        }
    }
}

/// Equation 2 alone increases the volume.
#[test]
fn the_printed_equation_loses_the_volume() {
    for (amplitudes, expected) in PRESETS.into_iter().zip([1.0323, 1.0512]) {
        let largest = displacements(amplitudes).map(drop_oscillation_volume).fold(0.0, f64::max);
        assert!((largest - expected).abs() < 1.0e-4, "{largest}");
    }
}

#[test]
fn the_volume_is_kept() {
    let (mut worst, mut worst_single) = (0.0f64, 0.0f64);
    for amplitudes in PRESETS {
        for displacement in displacements(amplitudes) {
            let state = drop_oscillation_state(displacement);
            let volume = sphere_mean(|x, phi| pow(drop_oscillation_radius(state, x, cos(phi)), 3.0));
            worst = worst.max((volume - 1.0).abs());
            let state = drop_oscillation_state(displacement.map(|s| s as f32)).map(f64::from);
            let volume = sphere_mean(|x, phi| pow(drop_oscillation_radius(state, x, cos(phi)), 3.0));
            worst_single = worst_single.max((volume - 1.0).abs());
        }
    }
    assert!(worst < 1.0e-13 && worst_single < 1.0e-6, "{worst} {worst_single}");
    for i in 0..=400 {
        let volume = 1.0 + f64::from(i) * 1.0e-3;
        let root = drop_oscillation_inverse_cube_root(volume);
        assert!((root * root * root * volume - 1.0).abs() < 1.0e-14, "{volume}");
    }
}

/// About the equilibrium shape too, and the drop at rest is that shape.
#[test]
fn the_equilibrium_shape_keeps_its_volume() {
    for mm in [0.5, 2.0, 4.0, 7.0] {
        let shape = DropShape::new(mm * 1.0e-3).unwrap();
        let drop = OscillatingDrop::new(
            shape,
            oscillation(mm * 1.0e-3, Amplitudes::GARG_NAYAR_OBLATE).with_phases([0.1, 0.6]),
        );
        for k in 0..10 {
            let instant = drop.at(f64::from(k) * 1.7e-3, 0.0);
            let cube = sphere_mean(|x, phi| {
                let away = (1.0 - x * x).max(0.0).sqrt();
                pow(instant.radius_along([away * cos(phi), -x, -away * sin(phi)]), 3.0)
            });
            assert!((4.0 / 3.0 * PI * cube / shape.volume() - 1.0).abs() < 1.0e-12, "{mm}");
        }
        let rest = OscillatingDrop::new(shape, oscillation(mm * 1.0e-3, Amplitudes::NONE)).at(0.37, 0.0);
        for theta in [0.0, 0.4, 1.5, 3.0] {
            assert!((rest.radius(theta, 1.0) / shape.radius(theta) - 1.0).abs() < 1.0e-14);
        }
        let sphere = OscillatingDrop::about_sphere(mm * 1.0e-3, *drop.oscillation()).unwrap().at(1.0e-3, 0.0);
        let expected = drop_oscillation_state(drop.oscillation().displacement(1.0e-3, 0.0));
        assert!((0..3).all(|k| (sphere.state()[k] - expected[k]).abs() < 1.0e-14));
        let printed = drop.at_rousseau_2008(1.0e-3, 0.0);
        assert_eq!(printed.state()[2], 1.0);
    }
}

/// To second order the two modes together move the center of mass toward phi = pi by 54/35 s2 s3 r0.
#[test]
fn the_center_of_mass_moves_sideways() {
    for displacement in [[0.01, 0.01], [-0.02, 0.01], [0.2, 0.1]] {
        let state = drop_oscillation_state(displacement);
        let sideways = sphere_mean(|x, phi| {
            let away = (1.0 - x * x).max(0.0).sqrt();
            0.75 * pow(drop_oscillation_radius(state, x, cos(phi)), 4.0) * away * cos(phi)
        });
        let expected = -54.0 / 35.0 * displacement[0] * displacement[1];
        assert!((sideways - expected).abs() < 0.15 * expected.abs(), "{sideways} for {expected}");
    }
}

#[test]
fn left_and_right() {
    let both = [0.07, 0.05];
    for (displacement, phi) in [([0.07, 0.0], 0.3), (both, 0.3), (both, 1.2), (both, FRAC_PI_2)] {
        let state = drop_oscillation_state(displacement);
        let [left, right] = drop_oscillation_outline(state, cos(phi));
        assert!((left - drop_oscillation_radius(state, 0.0, cos(phi))).abs() < 1.0e-15);
        assert!((right - drop_oscillation_radius(state, 0.0, cos(phi + PI))).abs() < 1.0e-15);
        // From behind, left is right.
        let behind = drop_oscillation_outline(state, cos(phi + PI));
        assert!((behind[0] - right).abs() < 1.0e-15 && (behind[1] - left).abs() < 1.0e-15);
        let is_even = displacement[1] == 0.0 || phi == FRAC_PI_2;
        assert_eq!((left - right).abs() < 1.0e-15, is_even, "{displacement:?} {phi}");
        if !is_even {
            assert!(left > right, "a positive s3 pushes outwards at phi = 0");
        }
    }
    let drop =
        OscillatingDrop::about_sphere(3.0e-3, oscillation(3.0e-3, Amplitudes::GARG_NAYAR_EVEN)).unwrap();
    let instant = drop.at(0.002, 0.0);
    let expected = drop_oscillation_outline(instant.state(), cos(0.8));
    for (found, expected) in instant.outline(0.8).iter().zip(expected) {
        assert!((found / (1.5e-3 * expected) - 1.0).abs() < 1.0e-14);
    }
}

/// The normal is perpendicular to the surface, and the mesh is closed.
#[test]
fn normals_and_mesh_of_an_oscillating_drop() {
    let shape = DropShape::new(5.0e-3).unwrap();
    let motion = oscillation(5.0e-3, Amplitudes::GARG_NAYAR_OBLATE).with_phases([0.25, 0.25]);
    let instant = OscillatingDrop::new(shape, motion).at(0.0, 0.0);
    let direction = |theta: f64, phi: f64| [sin(theta) * cos(phi), -cos(theta), -sin(theta) * sin(phi)];
    let position = |theta: f64, phi: f64| direction(theta, phi).map(|d| d * instant.radius(theta, phi));
    for i in 1..40 {
        let (theta, phi) = (PI * f64::from(i) / 40.0, 2.4 * f64::from(i));
        let normal = instant.normal_along(direction(theta, phi));
        let h = 1.0e-5;
        for [a, b] in [
            [position(theta + h, phi), position(theta - h, phi)],
            [position(theta, phi + h), position(theta, phi - h)],
        ] {
            let along: f64 = (0..3).map(|k| normal[k] * (a[k] - b[k])).sum::<f64>() / (2.0 * h * 2.5e-3);
            assert!(along.abs() < 1.0e-8, "{theta} {phi}: {along}");
        }
        assert!((normal.iter().map(|n| n * n).sum::<f64>() - 1.0).abs() < 1.0e-14);
    }
    let mesh = DropMesh::icosphere(&instant, 4).unwrap();
    assert!((mesh.volume() / shape.volume() - 1.0).abs() < 0.01, "{}", mesh.volume() / shape.volume());
}

/// Phases of many drops: chi-square with 255 degrees of freedom over pairs, and over the azimuth, stays below
/// 340 (probability of exceeding it by chance: 3e-4 each).
#[test]
fn phases_are_uniform() {
    let n = 1 << 16;
    let (mut pairs, mut azimuths) = ([0u32; 256], [0u32; 256]);
    let seed = seed_words(11);
    for id in 0..n {
        let [p2, p3] = drop_oscillation_phase(seed, id);
        pairs[(p2 * 16.0) as usize * 16 + (p3 * 16.0) as usize] += 1;
        azimuths[(drop_oscillation_azimuth(seed, id) * 256.0) as usize] += 1;
    }
    for bins in [pairs, azimuths] {
        let expected = f64::from(n) / 256.0;
        let chi2: f64 =
            bins.iter().map(|&b| (f64::from(b) - expected) * (f64::from(b) - expected) / expected).sum();
        assert!(chi2 < 340.0, "{chi2}");
    }
    assert_eq!(drop_oscillation_phase(seed, 5), drop_oscillation_phase(seed, 5));
    assert_ne!(drop_oscillation_phase(seed, 5), drop_oscillation_phase(seed_words(12), 5));
}

/// After seconds, hours and days the phase in f32 is as accurate as in f64 at the start.
#[test]
fn the_phase_does_not_wear_out() {
    let motion = oscillation(1.0e-3, Amplitudes::GARG_NAYAR_OBLATE).of_drop(seed_words(3), 9);
    let gpu = motion.gpu();
    let mut worst = 0.0f64;
    for start in [0.0, 3.0, 1000.0, 40_000.0, 65_535.0, 65_536.0, 1.0e6] {
        for k in 0..500 {
            let time = start + f64::from(k) * 1.3e-3;
            let found = drop_oscillation_displacement(gpu, DropOscillationTime::from_seconds(time), 0.0);
            for (mode, found) in found.into_iter().enumerate() {
                // The frequency in the shader, 2^-17 Hz from the law's at most.
                let f = f64::from(gpu.frequency[mode]) / 65536.0;
                assert!((f - motion.frequency()[mode]).abs() < 7.7e-6);
                let turns = (f * time).rem_euclid(1.0) + f64::from(gpu.phase[mode]);
                let expected = motion.amplitudes().pair()[mode] * sin(TAU * turns);
                worst = worst.max((f64::from(found) - expected).abs());
            }
        }
    }
    assert!(worst < 4.0e-7, "{worst}");
    // An offset within an exposure is the same as a later time.
    let late = drop_oscillation_displacement(gpu, DropOscillationTime::from_seconds(7.008), 0.0);
    let base = DropOscillationTime::from_seconds(7.0);
    let shifted =
        drop_oscillation_displacement(gpu, DropOscillationTime { offset: base.offset + 0.008, ..base }, 0.0);
    assert!((0..2).all(|k| (late[k] - shifted[k]).abs() < 1.0e-6), "{late:?} {shifted:?}");
}

#[test]
fn time_in_ticks() {
    let at = DropOscillationTime::from_seconds;
    assert_eq!(at(1.0), DropOscillationTime { ticks: 65536, offset: 0.0 });
    assert_eq!(at(-1.0), at(65535.0));
    assert_eq!(at(f64::NAN), DropOscillationTime::default());
    assert_eq!(at(-1.0e-30).ticks, 0);
    for seconds in [0.1, 17.3, 65535.99999, 123_456.789] {
        let DropOscillationTime { ticks, offset } = at(seconds);
        assert!((0.0..=1.0 / 65536.0).contains(&offset));
        let back = f64::from(ticks) / 65536.0 + f64::from(offset);
        assert!((back - seconds.rem_euclid(65536.0)).abs() < 1.0e-10, "{seconds}: {back}");
    }
    assert_eq!(drop_oscillation_frequency(TAU as f32 * 100.0), 100 * 65536);
    assert_eq!(drop_oscillation_frequency(-1.0), 0);
    assert_eq!(drop_oscillation_frequency(1.0e30), u32::MAX - 255);
    // 2 Hz for an eighth of a second: a quarter of a turn.
    assert_eq!(drop_oscillation_turns(2 * 65536, 0.5, at(0.125)), 0.75);
    for (turns, sine) in [(0.0, 0.0), (0.25, 1.0), (0.75, -1.0), (5.25, 1.0), (-0.25, -1.0)] {
        assert!((drop_oscillation_sine(turns) - sine).abs() < 1.0e-7, "{turns}");
    }
}

#[test]
fn damping() {
    let motion = oscillation(2.0e-3, Amplitudes::GARG_NAYAR_EVEN).with_phases([0.25, 0.25]);
    let [tau2, tau3] = motion.damping_time();
    assert!((tau2 - 0.1993).abs() < 1.0e-4 && (tau3 / tau2 - 5.0 / 14.0).abs() < 1.0e-12);
    assert_eq!(motion.displacement(0.0, tau2), [0.1, 0.1]);
    let damped = motion.damped();
    let [s2, s3] = damped.displacement(0.0, tau2);
    assert!((s2 - 0.1 * exp(-1.0)).abs() < 1.0e-15 && (s3 - 0.1 * exp(-14.0 / 5.0)).abs() < 1.0e-15);
    assert_eq!(damped.displacement(0.0, -1.0), [0.1, 0.1]);
    let single = drop_oscillation_displacement(damped.gpu(), DropOscillationTime::default(), tau2 as f32);
    assert!((f64::from(single[0]) - s2).abs() < 1.0e-8 && (f64::from(single[1]) - s3).abs() < 1.0e-8);
    assert_eq!(motion.gpu().damping, [0.0; 2]);
}

#[test]
fn refused_numbers() {
    for d in [f64::NAN, f64::INFINITY, 0.0, -1.0e-3, 1.0e-46, 0.049e-3, 9.1e-3] {
        assert!(Oscillation::new(d, Amplitudes::NONE, &WATER, FrequencyLaw::default()).is_err(), "{d}");
    }
    assert!(Oscillation::new(0.05e-3, Amplitudes::NONE, &WATER, FrequencyLaw::default()).is_ok());
    let stiff = Fluids { surface_tension: 1.0, water_density: 100.0, ..WATER };
    assert!(Oscillation::new(0.05e-3, Amplitudes::NONE, &stiff, FrequencyLaw::default()).is_err());
    for bad in [f64::NAN, -0.1, 0.31, f64::INFINITY] {
        assert!(Amplitudes::new(bad, 0.1).is_err() && Amplitudes::new(0.1, bad).is_err(), "{bad}");
    }
    let error = FrequencyLaw::Rayleigh1879.frequency(1, 2.0e-3, &WATER).unwrap_err();
    assert_eq!(error.to_string(), "degree of the mode is 1 (a whole number); allowed: 2 to 100");
    let thick = Fluids { kinematic_viscosity: f64::NAN, ..WATER };
    assert!(lamb_damping_time(2, 2.0e-3, &thick).is_err());
    assert_eq!(size_of::<DropOscillation>(), 32);
    assert_eq!(size_of::<DropOscillationTime>(), 8);
}

/// Water at the temperature of the air: published values at 5 and 30 C, and frequencies that scale with the root of
/// the surface tension.
#[test]
fn the_air_decides_what_the_water_is_like() {
    use downpour_drop::air::Air;
    for (celsius, tension, density, viscosity) in
        [(5.0, 0.074942, 999.964, 1.5183e-6), (30.0, 0.071194, 995.647, 0.8007e-6)]
    {
        let fluids = Fluids::in_air(&Air::new(celsius, 101_325.0).unwrap());
        assert!((fluids.surface_tension / tension - 1.0).abs() < 2.0e-4, "{fluids:?}");
        assert!((fluids.water_density / density - 1.0).abs() < 2.0e-4, "{fluids:?}");
        assert!((fluids.kinematic_viscosity / viscosity - 1.0).abs() < 5.0e-3, "{fluids:?}");
        let law = FrequencyLaw::Rayleigh1879;
        let ratio =
            law.frequency(2, 2.0e-3, &fluids).unwrap() / law.frequency(2, 2.0e-3, &Fluids::AT_20_C).unwrap();
        let expected = (tension / density * 998.204 / 0.072736f64).sqrt();
        assert!((ratio / expected - 1.0).abs() < 2.0e-4, "{ratio}, not {expected}");
    }
}
