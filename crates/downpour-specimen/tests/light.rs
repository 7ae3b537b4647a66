//! Light of the specimen against closed forms: the sphere, the balance of fractions, the outline.

use downpour_drop::DropShape;
use downpour_drop::optics::optics_fresnel;
use downpour_math::ops::f64 as ops;
use downpour_math::vector::{add_scaled, dot, normalize, scale, sub};
use downpour_shaders::render::specimen::{SPECIMEN_MIN_FRACTION, SPECIMEN_REFLECTIONS};
use downpour_specimen::trace::{
    Receiver, SpecimenCamera, specimen_hits, specimen_light, specimen_ray, upright_drop,
};
use downpour_specimen::{SpecimenOptions, default_fov};

const INDEX: f64 = 1.333;

/// Everything that leaves, in order.
struct All<R>(Vec<([R; 3], R)>);

impl<R> Receiver<R> for All<R> {
    fn receive(&mut self, direction: [R; 3], fraction: R) {
        self.0.push((direction, fraction));
    }
}

fn options(pitch: f64) -> SpecimenOptions {
    SpecimenOptions { pitch, yaw: 0.7, size: [64, 48], samples: 1, ..SpecimenOptions::default() }
}

fn camera(shape: &DropShape, pitch: f64) -> SpecimenCamera {
    options(pitch).camera(shape).expect("a camera")
}

/// Outermost sample between the middle and `far` (which misses) that still meets the drop.
fn edge(shape: &DropShape, camera: &SpecimenCamera, far: [f64; 2]) -> f64 {
    let drop = upright_drop(shape, INDEX);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let hits = specimen_hits(&drop, &specimen_ray(camera, far[0] * middle, far[1] * middle));
        (low, high) = if hits { (middle, high) } else { (low, middle) };
    }
    low
}

#[test]
fn a_sphere_sends_light_where_the_formula_says() {
    let shape = DropShape::sphere(2.0e-3).unwrap();
    let drop = upright_drop(&shape, INDEX);
    let camera = camera(&shape, 0.4);
    let mut seen = 0;
    for i in 0..200 {
        let position = [f64::from(i % 20) - 9.3, f64::from(i / 20) * 2.0 - 9.1];
        let ray = specimen_ray(&camera, position[0], position[1]);
        let offset = dot(ray.foot, ray.foot).sqrt();
        if !(0.01..0.999).contains(&offset) {
            continue;
        }
        seen += 1;
        let outward = scale(ray.foot, 1.0 / offset);
        let (incidence, refraction) = (ops::asin(offset), ops::asin(offset / INDEX));
        let reflectance = optics_fresnel(ops::cos(incidence), INDEX);
        let mut all = All(Vec::new());
        specimen_light(&drop, &camera, position, &mut all);
        let pi = std::f64::consts::PI;
        let turns = (0..all.0.len()).map(|k| match k {
            // Light that never entered turns in the other direction.
            0 => -(pi - 2.0 * incidence),
            _ => 2.0 * (incidence - refraction) + (k as f64 - 1.0) * (pi - 2.0 * refraction),
        });
        for (k, (&(direction, fraction), turn)) in all.0.iter().zip(turns).enumerate() {
            let expected = add_scaled(scale(ray.direction, ops::cos(turn)), outward, -ops::sin(turn));
            let apart = sub(normalize(direction), expected);
            assert!(dot(apart, apart).sqrt() < 1.0e-9, "order {k} at {offset}: {direction:?} {expected:?}");
            let expected = match k {
                0 => reflectance,
                _ => (1.0 - reflectance) * (1.0 - reflectance) * ops::pow(reflectance, k as f64 - 1.0),
            };
            // The last exit includes the light that is not followed.
            let slack = if k + 1 == all.0.len() { f64::from(SPECIMEN_MIN_FRACTION) } else { 1.0e-12 };
            assert!((fraction - expected).abs() <= slack, "order {k} at {offset}: {fraction} {expected}");
        }
    }
    assert!(seen > 100, "{seen}");
}

/// Sum of the fractions of all light on all rays: worst distance from 1 in f64 and f32, and the mean and the maximum fraction
/// that leaves only because of the limit of reflections.
fn balance(diameter_mm: f64, pitch: f64) -> [f64; 4] {
    let shape = DropShape::new(diameter_mm * 1.0e-3).expect("a diameter");
    let drop = upright_drop(&shape, INDEX);
    let camera = camera(&shape, pitch);
    let (mut apart, mut single, mut forced, mut most, mut rays) = (0.0f64, 0.0f64, 0.0, 0.0f64, 0.0);
    for i in 0..64 * 48 {
        let position = [f64::from(i % 64) - 31.5, f64::from(i / 64) - 23.5];
        let mut all = All(Vec::new());
        specimen_light(&drop, &camera, position, &mut all);
        apart = apart.max((all.0.iter().map(|l| l.1).sum::<f64>() - 1.0).abs());
        if all.0.len() > SPECIMEN_REFLECTIONS as usize + 1 {
            let last = all.0[all.0.len() - 1].1;
            forced += last;
            most = most.max(last);
        }
        rays += f64::from(u8::from(all.0.len() > 1));
        let mut all = All(Vec::new());
        specimen_light(&drop, &camera, position.map(|c| c as f32), &mut all);
        single = single.max(f64::from((all.0.iter().map(|l| l.1).sum::<f32>() - 1.0).abs()));
    }
    [apart, single, forced / rays, most]
}

#[test]
fn all_shares_sum_to_one() {
    for (diameter, pitch) in [(0.5, 0.0), (2.0, 1.0), (4.0, -0.5), (6.0, 0.0), (6.0, -1.5), (9.0, 0.5)] {
        let [apart, single, forced, most] = balance(diameter, pitch);
        println!(
            "{diameter} mm, pitch {pitch}: {apart:.1e} {single:.1e}, forced {forced:.1e}, most {most:.1e}"
        );
        assert!(apart < 1.0e-12 && single < 1.0e-6, "{diameter} mm: {apart:e} {single:e}");
        assert!(forced < 1.0e-2 && most < 1.0, "{diameter} mm: {forced:e}, {most:e}");
    }
}

#[test]
fn the_outline_of_a_sphere_is_where_it_should_be() {
    for (diameter, distance) in
        [(1.0e-3, 0.1), (5.0e-3, 0.02), (2.0e-5, 0.1), (4.0e-3, 2.2e-3), (2.0e-3, 500.0)]
    {
        let shape = DropShape::sphere(diameter).unwrap();
        let options = SpecimenOptions { distance_m: distance, ..options(0.3) };
        let camera = options.camera(&shape).unwrap();
        // The tangent cone from the camera.
        let sine = 0.5 * diameter / distance;
        let expected = sine / (1.0 - sine * sine).sqrt() / camera.step;
        assert!((expected / 24.0 - 0.8).abs() < 1.0e-9, "80 % of the height: {expected}");
        for [x, y] in [[1.0, 0.0], [0.0, -1.0], [0.6, 0.8]] {
            let far = [x * 24.0, y * 24.0];
            let found = 24.0 * edge(&shape, &camera, far);
            assert!((found / expected - 1.0).abs() < 1.0e-9, "{diameter} {distance}: {found} {expected}");
        }
        // In f32, from just inside to just outside.
        let drop = upright_drop(&shape, INDEX);
        for (scale, hit) in [(0.9999, true), (1.0001, false)] {
            let position = [(expected * 0.6 * scale) as f32, (expected * 0.8 * scale) as f32];
            assert_eq!(specimen_hits(&drop, &specimen_ray(&camera, position[0], position[1])), hit);
        }
    }
}

#[test]
fn a_drop_fills_four_fifths_of_the_height() {
    // Grazing rays may miss the ripple on the bottom of the largest drops.
    for (diameter, slack) in [(1.0e-3, 1.0e-7), (5.0e-3, 1.0e-7), (7.0e-3, 2.0e-3), (9.0e-3, 1.5e-2)] {
        for pitch in [0.0, 0.5, -1.0, std::f64::consts::FRAC_PI_2] {
            let shape = DropShape::new(diameter).unwrap();
            let camera = camera(&shape, pitch);
            let filled = (edge(&shape, &camera, [0.0, 24.0]) + edge(&shape, &camera, [0.0, -24.0])) / 2.0;
            assert!((filled - 0.8).abs() < slack, "{diameter} m at {pitch}: {filled}");
        }
    }
    let shape = DropShape::new(2.0e-3).unwrap();
    let (fov, height) = (default_fov(&shape, 0.1, 0.0).unwrap(), shape.extent_up() + shape.extent_down());
    assert!((fov * 0.08 / height - 1.0).abs() < 1.0e-3, "{fov}, {height}");
}

/// Objects behind the camera are invisible, even if the line of sight extended backwards meets the drop.
#[test]
fn nothing_behind_the_camera_is_seen() {
    let shape = DropShape::new(6.0e-3).unwrap();
    let drop = upright_drop(&shape, INDEX);
    let mut camera = camera(&shape, 0.3);
    camera.step *= -1.0;
    camera.back = scale(camera.back, -1.0);
    camera.distance *= -1.0;
    assert!(!specimen_hits(&drop, &specimen_ray(&camera, 0.5f64, 0.5)));
}
