//! Motion of a drop in a uniform wind, in closed form, against numerical integration in small steps.

use downpour_wind::{Followed, Gusts, Keyed, UniformWind, Wind, WindPart, WindPrimitive, WindUniform};
use glam::{DVec3, Vec3};

fn even(parts: Vec<WindPart>, gusts: Option<Gusts>) -> UniformWind {
    Wind::new(parts, gusts, None).expect("a wind").uniform().expect("the same everywhere")
}

fn keyed() -> WindPart {
    let keys = vec![
        (-40.0, DVec3::new(3.0, 0.0, 1.0)),
        (-1.0, DVec3::new(-2.0, 1.0, 4.0)),
        (0.5, DVec3::new(9.0, -1.0, 0.0)),
        (0.6, DVec3::new(2.0, 0.0, -6.0)),
        (30.0, DVec3::new(12.0, 0.5, 3.0)),
        (50_000.0, DVec3::new(-4.0, 0.0, 8.0)),
        (99_990.0, DVec3::new(5.0, 0.0, 5.0)),
        (99_999.5, DVec3::new(15.0, 2.0, 0.0)),
    ];
    WindPart::Uniform(Keyed::new(keys).expect("good keys"))
}

fn steady() -> WindPart {
    WindPart::from(WindPrimitive::Uniform(WindUniform { speed: 7.0, direction: Vec3::new(1.0, 0.2, -2.0) }))
}

const GUSTS: Gusts = Gusts { intensity: 0.3, length: 40.0, seed: 11 };

fn winds() -> Vec<(&'static str, UniformWind)> {
    vec![
        ("constant", even(vec![steady()], None)),
        ("keyed", even(vec![keyed()], None)),
        ("gusts", even(vec![steady()], Some(GUSTS))),
        ("keyed gusts", even(vec![keyed(), steady()], Some(GUSTS))),
    ]
}

/// y' = (w - y) / tau and its integral, from `start` to `end`, by the classical Runge-Kutta rule; y starts at the
/// closed form.
fn stepped(air: &UniformWind, tau: f64, start: f64, end: f64, steps: u32) -> (DVec3, DVec3) {
    let h = (end - start) / f64::from(steps);
    let (mut y, mut way) = (air.followed(start, tau).velocity, DVec3::ZERO);
    let mut left = air.velocity(start);
    for k in 0..steps {
        let time = start + h * f64::from(k);
        let (middle, right) = (air.velocity(time + 0.5 * h), air.velocity(time + h));
        let k1 = (left - y) / tau;
        let k2 = (middle - y - k1 * (0.5 * h)) / tau;
        let k3 = (middle - y - k2 * (0.5 * h)) / tau;
        let k4 = (right - y - k3 * h) / tau;
        way += y * h + (k1 + k2 + k3) * (h * h / 6.0);
        y += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
        left = right;
    }
    (y, way)
}

/// Velocity and displacement, over windows that contain keys and at least 20 tau, so that the start is forgotten.
#[test]
fn drops_do_what_their_equation_says() {
    for (name, air) in winds() {
        for tau in [0.05, 1.0] {
            for (start, end) in
                [(-100.0, -80.0), (-20.0, 2.0), (0.0, 35.0), (99_985.0, 100_000.0), (1.0e5, 1.0e5 + 21.0)]
            {
                let steps = (end - start) * 200.0;
                let (velocity, way) = stepped(&air, tau, start, end, steps as u32);
                let (first, last) = (air.followed(start, tau), air.followed(end, tau));
                let what = format!("{name}, tau {tau}, {start} to {end}");
                // Steps that contain a key, and the fastest sinusoids, cost accuracy: both of the order of the step.
                let scale = if name.contains("gusts") { 2.0e-2 } else { 2.0e-3 };
                let off = velocity.distance(last.velocity);
                assert!(off < scale, "{what}: velocity {velocity}, not {}: {off}", last.velocity);
                let off = way.distance(last.displacement - first.displacement);
                assert!(off < scale, "{what}: way {way}: {off}");
            }
        }
    }
}

/// A start in any other state is forgotten: the closed form is the state that began long ago.
#[test]
fn the_state_is_the_one_that_began_long_ago() {
    for (name, air) in winds() {
        for (tau, end) in [(0.05, -39.0), (1.0, 0.55), (1.0, 31.0)] {
            let (steps, start) = (16_000, end - 40.0 * tau);
            let h = 40.0 * tau / f64::from(steps);
            // The exact step for a wind that is linear within it, from rest.
            let mut y = DVec3::ZERO;
            let fade = downpour_math::ops::f64::exp(-h / tau);
            for k in 0..steps {
                let time = start + h * f64::from(k);
                let (a, b) = (air.velocity(time), air.velocity(time + h));
                let slope = (b - a) / h;
                y = (y - a + slope * tau) * fade + b - slope * tau;
            }
            let found = air.followed(end, tau).velocity;
            assert!(y.distance(found) < 3.0e-3, "{name}, tau {tau}, {end}: {found}, not {y}");
        }
    }
}

/// d/dt of the displacement is the velocity, and both start at the right values.
#[test]
fn the_way_is_the_integral_of_the_velocity() {
    for (name, air) in winds() {
        for tau in [0.0, 0.05, 1.0] {
            assert!(air.followed(0.0, tau).displacement.length() < 1.0e-9, "{name}");
            for time in [-100.0, -39.5, -0.3, 0.0, 0.55, 17.0, 60_000.0, 99_999.0, 1.0e5] {
                let h = 5.0e-6;
                let ahead = air.followed(time + h, tau).displacement;
                let behind = air.followed(time - h, tau).displacement;
                let slope = (ahead - behind) / (2.0 * h);
                let velocity = air.followed(time, tau).velocity;
                // Displacements of 1e6 m have 1e-10 m of digits, divided by 1e-5 s; the fastest sinusoid has 1150
                // rad/s.
                assert!(
                    slope.distance(velocity) < 2.0e-4,
                    "{name}, tau {tau}, {time}: {slope}, not {velocity}"
                );
            }
        }
    }
}

#[test]
fn without_inertia_a_drop_is_air() {
    for (_, air) in winds() {
        for time in [-1.0e3, -40.0, 0.0, 0.6, 12.0, 1.0e5] {
            for none in [0.0, -1.0, f64::NAN] {
                assert_eq!(air.followed(time, none).velocity, air.velocity(time));
            }
            let nearly = air.followed(time, 1.0e-9);
            assert!(nearly.velocity.distance(air.velocity(time)) < 1.0e-4, "{time}");
            assert_eq!(air.prepared(time).velocity(), air.velocity(time));
            for odd in [f64::INFINITY, 1.0e300, f64::MIN_POSITIVE] {
                let Followed { velocity, displacement } = air.followed(time, odd);
                assert!(velocity.is_finite() && displacement.is_finite(), "{odd} {velocity} {displacement}");
            }
        }
    }
}

/// Amplitude and lag of a first-order filter: 1 / sqrt(1 + (omega tau)^2) for a single sinusoid. Of many gusts, the
/// variance of the response is that of the spectrum times 1 / (1 + (omega tau)^2).
#[test]
fn slow_drops_keep_the_slow_gusts() {
    use downpour_math::ops::f64::{exp, ln};
    let air = even(vec![WindPart::Uniform(DVec3::new(10.0, 0.0, 0.0).into())], Some(GUSTS));
    for tau in [0.1, 1.0, 5.0] {
        let n = 6000;
        let variance: f64 = (0..n)
            .map(|k| air.followed(f64::from(k) * 713.7, tau).velocity.x - 10.0)
            .map(|v| v * v / f64::from(n))
            .sum();
        let (low, high, steps) = (ln(1.0e-7), ln(1.0e3), 4000);
        let step = (high - low) / f64::from(steps);
        let wanted: f64 = (0..steps)
            .map(|k| {
                let f = exp(low + step * (f64::from(k) + 0.5));
                let z = std::f64::consts::TAU * f * tau;
                GUSTS.spectrum_along(f, 10.0) / (1.0 + z * z) * f * step
            })
            .sum();
        // One sinusoid represents a band of half an octave.
        assert!((variance / wanted - 1.0).abs() < 0.1, "tau {tau}: {variance}, not {wanted}");
    }
}

/// A ramp that begins at 0: y = m (t - tau (1 - e^(-t / tau))).
#[test]
fn a_ramp_has_its_textbook_answer() {
    let ramp = Keyed::new(vec![(0.0, DVec3::ZERO), (100.0, DVec3::X * 50.0)]).expect("good keys");
    let air = even(vec![WindPart::Uniform(ramp)], None);
    for tau in [0.05, 0.7, 4.0] {
        for time in [0.01, 0.5, 3.0, 40.0] {
            let fade = downpour_math::ops::f64::exp(-time / tau);
            let found = air.followed(time, tau);
            let velocity = 0.5 * (time - tau * (1.0 - fade));
            let way = 0.5 * (0.5 * time * time - tau * time + tau * tau * (1.0 - fade));
            assert!((found.velocity.x - velocity).abs() < 1.0e-12, "{tau} {time}");
            assert!((found.displacement.x - way).abs() < 1.0e-10, "{tau} {time}");
        }
    }
}

/// Steady, keyed and calm: displacement of the mean wind, which carries the turbulence.
#[test]
fn the_mean_wind_carries() {
    let air = even(vec![keyed(), steady()], Some(GUSTS));
    let calm = even(vec![keyed(), steady()], None);
    for time in [-100.0, -1.0, 0.0, 0.55, 29.0, 70_000.0, 2.0e5] {
        let way = calm.followed(time, 0.0).displacement;
        assert!(air.mean_displacement(time).distance(way) < 1.0e-8 * (1.0 + way.length()), "{time}");
        assert_eq!(air.mean(time), calm.velocity(time));
    }
    assert_eq!(even(vec![], None).followed(5.0, 1.0), Followed::default());
}

/// Turbulence and vortices vary in space.
#[test]
fn other_winds_are_not_uniform() {
    let vortex = downpour_wind::WindSingularity {
        form: downpour_wind::WindForm::Line,
        strength: 1.0,
        center: Vec3::ZERO,
        axis: Vec3::Y,
        core_radius: 1.0,
        core: downpour_wind::WindCore::Rosenhead,
    };
    let parts = vec![steady(), WindPart::from(WindPrimitive::Vortex(vortex))];
    assert!(Wind::new(parts, None, None).expect("a wind").uniform().is_none());
    let eddies = Some(downpour_wind::Turbulence::default());
    assert!(Wind::new(vec![steady()], None, eddies).expect("a wind").uniform().is_none());
    assert!(Wind::default().uniform().is_some());
}
