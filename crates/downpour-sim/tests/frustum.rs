//! Rain in a view has the density of the rain, in each part of the picture and for each size, for any motion of camera
//! and shutter. Expectations are integrals of the size distribution.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_math::ops::f64 as ops;
use downpour_sim::simulation::{Simulation, SimulationOptions, StepInput};
use downpour_sim::step::StepDrop;
use downpour_sim::view::View;
use downpour_wind::{Gusts, Keyed, UniformWind, Wind, WindPart};
use glam::{DVec3, Vec3};

/// Number of parts of the picture along each of its sides, and along the distance.
const PARTS: usize = 5;

fn rain() -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0).expect("in range")
}

/// A camera at a position that looks along an azimuth and an elevation, radians.
fn looking(eye: DVec3, azimuth: f64, elevation: f64) -> View {
    let (level, up) = (ops::cos(elevation), ops::sin(elevation));
    let forward = DVec3::new(level * ops::sin(azimuth), up, -level * ops::cos(azimuth));
    let right = forward.cross(DVec3::Y).normalize();
    View { eye, forward, right, up: right.cross(forward), far: 8.0, ..View::default() }
}

/// Solid angle of a picture, sr.
fn solid_angle(wide: f64, high: f64) -> f64 {
    4.0 * ops::asin(wide * high / ((1.0 + wide * wide) * (1.0 + high * high)).sqrt())
}

/// Number of drops between two diameters in a picture, each size up to the distance at which it is resolved.
fn expected(rain: &DropSizeDistribution, view: &View, from: f64, to: f64) -> f64 {
    let solid = solid_angle(view.half_width, view.half_height);
    let steps = 4000;
    let of = |k: u32| {
        let d = from + (to - from) * (f64::from(k) + 0.5) / f64::from(steps);
        let range = (d / (view.pixel_angle * view.least_pixels)).min(view.far);
        rain.concentration(d) * solid * range * range * range / 3.0
    };
    (0..steps).map(of).sum::<f64>() * (to - from) / f64::from(steps)
}

/// Part of the picture that a drop is in, of equal volume for its size; `None` outside.
fn part(drop: &StepDrop, view: &View, ahead_s: f64) -> Option<usize> {
    let at = Vec3::from(drop.position).as_dvec3() + Vec3::from(drop.velocity).as_dvec3() * ahead_s;
    let offset = at - view.eye;
    let range = (f64::from(drop.diameter()) / (view.pixel_angle * view.least_pixels)).min(view.far);
    let (x, y, z) = (offset.dot(view.right), offset.dot(view.up), offset.dot(view.forward));
    let (wide, high) = (view.half_width, view.half_height);
    if z <= 0.0 || x.abs() > z * wide || y.abs() > z * high || offset.length() > range {
        return None;
    }
    // Equal parts of the solid angle: slices of the azimuth's fraction, then of the height within the slice.
    let signed = |x: f64| 2.0 * ops::asin(x * high / ((1.0 + x * x) * (1.0 + high * high)).sqrt());
    let fraction_x = 0.5 + 0.5 * signed(x / z) / signed(wide);
    let sine = ops::sin(ops::atan2(y, (x * x + z * z).sqrt()));
    let fraction_y = 0.5 + 0.5 * sine / (high / (1.0 + high * high + (x / z) * (x / z)).sqrt());
    let fraction_z = ops::pow(offset.length() / range, 3.0);
    let cell = |fraction: f64| ((fraction * PARTS as f64) as usize).min(PARTS - 1);
    Some((cell(fraction_x) * PARTS + cell(fraction_y)) * PARTS + cell(fraction_z))
}

/// Chi-square against an expectation, minus its mean, in its standard deviations. The counts are Poisson distributed.
fn excess(counts: &[f64], expected: &[f64]) -> f64 {
    let chi: f64 = counts.iter().zip(expected).map(|(n, mean)| (n - mean) * (n - mean) / mean).sum();
    let freedom = counts.len() as f64;
    (chi - freedom) / (2.0 * freedom).sqrt()
}

/// Compares a state with the rain: in parts of the picture, and by sizes.
fn check(simulation: &Simulation, view: &View, ahead_s: f64, when: &str) {
    let rain = rain();
    let mut parts = vec![0.0; PARTS * PARTS * PARTS];
    let edges: Vec<f64> = (0..=12).map(|k| 0.1e-3 * ops::pow(55.0, f64::from(k) / 12.0)).collect();
    let mut sizes = vec![0.0; edges.len() - 1];
    for drop in simulation.drops() {
        if let Some(part) = part(drop, view, ahead_s) {
            parts[part] += 1.0;
            let above = edges.partition_point(|&edge| edge <= f64::from(drop.diameter()));
            if (1..edges.len()).contains(&above) {
                sizes[above - 1] += 1.0;
            }
        }
    }
    let mean = expected(&rain, view, 0.1e-3, 8.0e-3) / parts.len() as f64;
    let of_sizes: Vec<f64> = edges.windows(2).map(|pair| expected(&rain, view, pair[0], pair[1])).collect();
    let (of_parts, by_size) = (excess(&parts, &vec![mean; parts.len()]), excess(&sizes, &of_sizes));
    let total = parts.iter().sum::<f64>() / (mean * parts.len() as f64);
    println!("{when}: {of_parts:.1}, sizes {by_size:.1}, {total:.3} of the rain");
    assert!(mean > 15.0, "{mean}");
    assert!(of_parts.abs() < 4.0, "{when}: {of_parts} standard deviations over the picture");
    assert!(
        by_size.abs() < 4.0,
        "{when}: {by_size} standard deviations over the sizes: {sizes:?}, {of_sizes:?}"
    );
}

/// Steps of 1/60 s along a path of the camera.
fn run(name: &str, options: &SimulationOptions, wind: &UniformWind, path: impl Fn(u32) -> View) {
    let ahead_s = 0.5 * (options.shutter_s + options.wait_s);
    let first = path(0);
    let air = |step: u32| wind.prepared(f64::from(step) / 60.0);
    let start = air(0);
    let now =
        StepInput { air: Some(&start), ..StepInput::new(&first, DVec3::ZERO, start.velocity().as_vec3()) };
    let mut simulation = Simulation::new(&rain(), options, &now).expect("in range");
    check(&simulation, &first, ahead_s, &format!("{name}, at first"));
    for step in 1..=45 {
        let view = path(step);
        let air = air(step);
        let then =
            StepInput { air: Some(&air), ..StepInput::new(&view, DVec3::ZERO, air.velocity().as_vec3()) };
        simulation.advance(1.0 / 60.0, &then).expect("in range");
        if step % 15 == 0 {
            check(&simulation, &view, ahead_s, &format!("{name}, step {step}"));
        }
    }
}

fn uniform(speed: impl Into<Keyed<f64>>, towards: DVec3, gusts: Option<Gusts>) -> UniformWind {
    let part = WindPart::uniform(&speed.into(), &towards.into()).expect("in range");
    Wind::new(vec![part], gusts, None).expect("in range").air().clone()
}

fn steady() -> UniformWind {
    uniform(4.5, DVec3::new(2.0, 0.0, 1.0), None)
}

#[test]
fn density_is_the_rains_when_only_the_rain_moves() {
    let options = SimulationOptions::default();
    run("fall", &options, &uniform(0.0, DVec3::X, None), |_| looking(DVec3::ZERO, 0.3, 0.1));
    let storm = uniform(23.0, DVec3::new(2.0, 0.1, -1.2), None);
    run("storm", &options, &storm, |_| looking(DVec3::ZERO, 0.3, 0.1));
    // From a breeze to a storm and back within a second.
    let keys = Keyed::new(vec![(0.0, 2.0), (0.4, 20.0), (0.8, 0.0)]).expect("in range");
    let squall = uniform(keys, DVec3::X, Some(Gusts { intensity: 0.4, ..Gusts::default() }));
    run("squall", &options, &squall, |_| looking(DVec3::ZERO, 0.3, -0.7));
}

#[test]
fn density_is_the_rains_when_the_camera_turns() {
    let options = SimulationOptions::default();
    let turn = std::f64::consts::TAU / 60.0;
    run("pan", &options, &steady(), |k| looking(DVec3::ZERO, turn * f64::from(k), 0.0));
    run("tilt", &options, &steady(), |k| looking(DVec3::ZERO, 0.0, -1.2 + 0.05 * f64::from(k)));
    run("straight up", &options, &steady(), |_| looking(DVec3::ZERO, 0.0, 1.5));
}

#[test]
fn density_is_the_rains_when_the_eye_moves() {
    let options = SimulationOptions::default();
    run("dolly", &options, &steady(), |k| {
        let eye = DVec3::new(0.0, 1.7, -0.4 * f64::from(k));
        View { velocity: DVec3::new(0.0, 0.0, -24.0), ..looking(eye, 0.0, 0.0) }
    });
    run("backwards", &options, &steady(), |k| looking(DVec3::new(0.0, 1.7, 0.4 * f64::from(k)), 0.0, 0.0));
    run("jumps", &options, &steady(), |k| {
        looking(DVec3::X * f64::from(k / 10) * 1234.5, f64::from(k / 7), 0.0)
    });
}

#[test]
fn density_is_the_rains_when_the_picture_zooms() {
    let options = SimulationOptions::default();
    let zoomed = |factor: f64| {
        let view = looking(DVec3::ZERO, 0.0, 0.1);
        let [half_width, half_height, pixel_angle] =
            [view.half_width, view.half_height, view.pixel_angle].map(|x| x * factor);
        View { half_width, half_height, pixel_angle, ..view }
    };
    run("in", &options, &steady(), |k| zoomed(ops::pow(0.985, f64::from(k))));
    run("out", &options, &steady(), |k| zoomed(ops::pow(0.985, 45.0 - f64::from(k))));
    let wide = View { half_width: 4.0, half_height: 3.0, ..zoomed(1.0) };
    run("wide", &options, &steady(), |_| wide);
}

/// With a margin for the shutter, around the middle of the time that pictures cover.
#[test]
fn density_is_the_rains_with_a_shutter() {
    for shutter_s in [1.0 / 60.0, 0.075] {
        let options = SimulationOptions { shutter_s, wait_s: 1.0 / 60.0, ..SimulationOptions::default() };
        run("shutter", &options, &steady(), |_| looking(DVec3::ZERO, 0.3, 0.1));
        let turn = std::f64::consts::TAU / 60.0;
        run("shutter, pan", &options, &steady(), |k| View {
            turning: DVec3::Y * -60.0 * turn,
            ..looking(DVec3::ZERO, turn * f64::from(k), 0.0)
        });
    }
}
