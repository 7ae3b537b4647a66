//! Rain in a view has the density of the rain, in each part of the picture and for each size, for any motion of camera
//! and shutter. Expectations are integrals of the size distribution.

mod setting;

use downpour_drop::air::Air;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
use downpour_math::ops::f64 as ops;
use downpour_sim::simulation::{Simulation, SimulationOptions, StepInput};
use downpour_sim::step::StepDrop;
use downpour_sim::view::View;
use downpour_wind::{Gusts, Keyed, UniformWind, Wind, WindField, WindPart, WindPrimitive, WindTornado};
use glam::{DVec3, Vec3};
use setting::{field, looking, vortex};

/// Number of parts of the picture along each of its sides, and along the distance.
const PARTS: usize = 5;

fn rain() -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0).expect("in range")
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

/// A tornado ahead of the eye, with an updraft of up to 7 m/s.
fn tornado() -> WindField {
    field(&[WindPrimitive::Tornado(WindTornado {
        circulation: 60.0,
        discharge: 50.0,
        base: Vec3::new(0.0, -5.0, -4.0),
        axis: Vec3::Y,
        height: 12.0,
        core_radius: 1.5,
    })])
}

/// Random numbers in 0 to 1: splitmix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((word ^ (word >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// One drop of [`direct`]: diameter, terminal speed, distance at which it is resolved; position and velocity.
struct Direct {
    diameter: f64,
    speed: f64,
    range: f64,
    position: DVec3,
    velocity: DVec3,
}

impl Direct {
    fn is_inside(&self, view: &View) -> bool {
        Self::is_within(view, self.position, self.range, 0.0)
    }

    /// True if a position is at most `slack` m outside the picture up to a range.
    fn is_within(view: &View, position: DVec3, range: f64, slack: f64) -> bool {
        let offset = position - view.eye;
        let depth = offset.dot(view.forward);
        let beyond = |across: f64, half: f64| (across.abs() - depth * half) / (1.0 + half * half).sqrt();
        beyond(offset.dot(view.right), view.half_width) <= slack
            && beyond(offset.dot(view.up), view.half_height) <= slack
            && offset.length() <= range + slack
    }

    /// The slip relaxes in v / g across the fall, and in v / 2g along it.
    fn fall(&mut self, field: &WindField, time_s: f64) {
        let middle = self.position + self.velocity * (0.5 * time_s);
        let settled = field.sample(middle.as_vec3()).as_dvec3() - DVec3::Y * self.speed;
        let kept = |factor: f64| ops::exp(-factor * 9.806_65 * time_s / self.speed);
        let kept = DVec3::new(kept(1.0), kept(2.0), kept(1.0));
        let before = self.velocity;
        self.velocity = settled + (before - settled) * kept;
        self.position += 0.5 * (before + self.velocity) * time_s;
    }

    /// Velocity of a drop of undisturbed rain: relaxed to the wind on a straight path through its position.
    fn settle(&mut self, field: &WindField) {
        let (there, steps) = (self.position, 16);
        let time_s = 3.0 * self.speed / 9.806_65 / f64::from(steps);
        let way = field.sample(there.as_vec3()).as_dvec3() - DVec3::Y * self.speed;
        self.velocity = way;
        for step in (0..steps).rev() {
            self.position = there - way * (time_s * (f64::from(step) + 1.0));
            self.fall(field, time_s);
        }
        self.position = there;
    }
}

/// Number of drops in a picture and their rate, mm/h, in a wind field: rain that is undisturbed outside the picture, drawn
/// there anew in every step, and followed inside; averaged from `from_s` to `to_s`.
fn direct(view: &View, field: &WindField, [from_s, to_s]: [f64; 2]) -> [f64; 2] {
    let (rain, time_s, bins) = (rain(), 1.0 / 120.0, 60);
    let of_bin = |k: usize| 0.1e-3 * ops::pow(79.99, k as f64 / bins as f64);
    let speed = |k| terminal_speed(FallSpeedModel::Beard1976, of_bin(k), &Air::standard()).expect("in range");
    let speeds: Vec<f64> = (0..=bins).map(speed).collect();
    let mut random = Random(7);
    let mut drops: Vec<Direct> = Vec::new();
    let [mut count, mut rate, mut samples] = [0.0; 3];
    for step in 0..=(to_s / time_s) as u32 {
        for drop in &mut drops {
            drop.fall(field, time_s);
        }
        drops.retain(|drop| drop.is_inside(view));
        for bin in 0..bins {
            let [low, high] = [of_bin(bin), of_bin(bin + 1)];
            let concentration =
                (0..8).map(|k| rain.concentration(low + (high - low) * (f64::from(k) + 0.5) / 8.0));
            let density = concentration.sum::<f64>() / 8.0 * (high - low);
            let largest = (high / (view.pixel_angle * view.least_pixels)).min(view.far);
            // A drop moves by less than this in a step.
            let margin = 15.0 * time_s;
            let near = margin + (drop_box(view, largest) - margin).max(DVec3::ZERO);
            let size = DVec3::new(2.0 * near.x, 2.0 * near.y, near.z) + margin * DVec3::new(2.0, 2.0, 2.0);
            let mean = density * size.element_product();
            let drawn = mean.floor() + if random.next() < mean.fract() { 1.0 } else { 0.0 };
            for _ in 0..drawn as u32 {
                let [x, y, z] = [0; 3].map(|_| random.next());
                let local = DVec3::new(x - 0.5, y - 0.5, z) * size - DVec3::Z * margin;
                let position = view.eye + view.right * local.x + view.up * local.y + view.forward * local.z;
                let fraction = random.next();
                let diameter = low + (high - low) * fraction;
                let speed = speeds[bin] + (speeds[bin + 1] - speeds[bin]) * fraction;
                let range = (diameter / (view.pixel_angle * view.least_pixels)).min(view.far);
                let mut drop = Direct { diameter, speed, range, position, velocity: DVec3::ZERO };
                let is_inside = drop.is_inside(view);
                if step == 0 && is_inside {
                    drop.settle(field);
                    drops.push(drop);
                } else if step > 0 && !is_inside && Direct::is_within(view, position, range, margin) {
                    // With the velocity of the wind first, to within 2 m/s: few come in.
                    let rough = field.sample(position.as_vec3()).as_dvec3() - DVec3::Y * speed;
                    if Direct::is_within(view, position + rough * time_s, range, 2.0 * time_s) {
                        drop.settle(field);
                        drop.fall(field, time_s);
                        drops.extend(drop.is_inside(view).then_some(drop));
                    }
                }
            }
        }
        if f64::from(step) * time_s >= from_s {
            samples += 1.0;
            count += drops.len() as f64;
            let solid = solid_angle(view.half_width, view.half_height);
            let of = |drop: &Direct| {
                let volume = solid * ops::pow(drop.range, 3.0) / 3.0;
                -drop.velocity.y * ops::pow(drop.diameter, 3.0) / volume
            };
            rate += std::f64::consts::FRAC_PI_6 * 3.6e6 * drops.iter().map(of).sum::<f64>();
        }
    }
    [count / samples, rate / samples]
}

/// Half the width, half the height and the depth of the picture up to a distance.
fn drop_box(view: &View, range: f64) -> DVec3 {
    let across = |half: f64| range * half / (1.0 + half * half).sqrt();
    DVec3::new(across(view.half_width), across(view.half_height), range)
}

/// Standard deviation of the rate of the drops in a picture, mm/h, of Poisson distributed counts.
fn rate_scatter(view: &View) -> f64 {
    let (air, rain, steps) = (Air::standard(), rain(), 2000);
    let of = |k: u32| {
        let d = 0.1e-3 + 7.9e-3 * (f64::from(k) + 0.5) / f64::from(steps);
        let range = (d / (view.pixel_angle * view.least_pixels)).min(view.far);
        let volume = solid_angle(view.half_width, view.half_height) * ops::pow(range, 3.0) / 3.0;
        let speed = terminal_speed(FallSpeedModel::Beard1976, d, &air).expect("in range");
        rain.concentration(d) * ops::pow(d * d * d * speed, 2.0) / volume * 7.9e-3 / f64::from(steps)
    };
    std::f64::consts::FRAC_PI_6 * 3.6e6 * (0..steps).map(of).sum::<f64>().sqrt()
}

/// Vortices fling drops out, and an updraft lifts them. What comes in after them is the undisturbed rain: the picture
/// holds what [`direct`] finds, for as long as it rains, and the disdrometer tells the rate of that.
#[test]
fn vortices_do_not_empty_the_picture() {
    let view = looking(DVec3::ZERO, 0.0, 0.1);
    let whole = expected(&rain(), &view, 0.1e-3, 8.0e-3);
    for (name, field) in [("vortex", vortex()), ("tornado", tornado())] {
        let now = StepInput { field: Some(&field), ..StepInput::new(&view, DVec3::ZERO, Vec3::ZERO) };
        let mut simulation = Simulation::new(&rain(), &SimulationOptions::default(), &now).expect("in range");
        let [mean, rate] = direct(&view, &field, [0.75, 2.0]);
        println!("{name}: {mean:.0} drops make {rate:.2} mm/h; {whole:.0} without it");
        // The mean is that of about two independent states. A drop that comes in remembers the wind at two points of its
        // path, and not on all of it: 4 %.
        let allowed = |sigma: f64, of: f64| 4.0 * sigma * 1.5_f64.sqrt() + 0.04 * of;
        let (most, most_rate) = (allowed(mean.sqrt(), mean), allowed(rate_scatter(&view), rate));
        for step in 1..=180 {
            simulation.advance(1.0 / 30.0, &now).expect("in range");
            if step % 60 == 0 {
                let seen = simulation.drops().iter().filter(|drop| part(drop, &view, 0.0).is_some());
                let (count, measured) = (seen.count() as f64, simulation.measured_rate_mm_h(None));
                println!("{name}, {} s: {count} drops, {measured:.2} mm/h", step / 30);
                assert!((count - mean).abs() < most, "{name}: {count} drops, {mean} +- {most} expected");
                assert!(
                    (measured - rate).abs() < most_rate,
                    "{name}: {measured} mm/h, {rate} +- {most_rate} expected"
                );
            }
        }
        assert!(mean > 0.85 * whole, "{name}: most of the rain is there");
    }
}
