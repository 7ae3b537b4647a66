//! Lamps of the specimen against closed forms: solid angles, reflection on a sphere, the balance of light.

use downpour_drop::DropShape;
use downpour_drop::optics::{WATER_INDEX, optics_fresnel};
use downpour_math::ops::f64 as ops;
use downpour_specimen::{
    Image, Sky, SpecimenError, SpecimenLamp, SpecimenOptions, render_specimen, render_specimen_f64,
    render_specimen_scalar,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

const DARK: [[f32; 3]; 2] = [[0.0; 3]; 2];

fn lamp(yaw: f64, pitch: f64, radius: f64, radiance: f32) -> SpecimenLamp {
    SpecimenLamp::new(yaw, pitch, radius, [radiance, 0.5 * radiance, 0.0]).expect("a lamp")
}

fn picture(shape: &DropShape, options: &SpecimenOptions, lamps: &[SpecimenLamp]) -> Image {
    let sky = Sky::new(2, 1, &DARK).and_then(|sky| sky.with_lamps(lamps)).expect("a sky");
    render_specimen(shape, options, sky).expect("a picture")
}

/// Beside the drop, a lamp covers 2 pi (1 - cos r) of the directions.
#[test]
fn a_lamp_has_its_solid_angle() {
    let shape = DropShape::sphere(1.0e-4).unwrap();
    for (radius_deg, pitch) in [(1.0f64, 0.1), (6.0, -0.12)] {
        let options = SpecimenOptions {
            distance_m: 10.0,
            fov: Some(0.6),
            size: [150, 150],
            samples: 4,
            ..SpecimenOptions::default()
        };
        let radius = radius_deg.to_radians();
        let image = picture(&shape, &options, &[lamp(PI + 0.1, pitch, radius, 3.0)]);
        let step = 2.0 * ops::tan(0.3) / 150.0;
        let mut light = 0.0;
        for (i, pixel) in image.pixels.iter().enumerate() {
            let [x, y] = [i % 150, i / 150].map(|c| (c as f64 - 74.5) * step);
            let square = 1.0 + x * x + y * y;
            light += f64::from(pixel[0]) * step * step / (square * square.sqrt());
        }
        let wanted = 3.0 * TAU * (1.0 - ops::cos(radius));
        assert!((light / wanted - 1.0).abs() < 0.02, "{radius_deg}: {light} for {wanted}");
    }
}

/// A lamp at 90 degrees to the axis is mirrored by a sphere at a slope of 45 degrees, with the radiance of
/// Fresnel's law, and is visible directly with its color.
#[test]
fn a_sphere_mirrors_a_lamp_where_and_as_it_should() {
    let shape = DropShape::sphere(2.0e-3).unwrap();
    let options = SpecimenOptions { distance_m: 10.0, size: [80, 80], ..SpecimenOptions::default() };
    let image = picture(&shape, &options, &[lamp(FRAC_PI_2, 0.0, 0.15, 100.0)]);
    // The drop fills 80 % of 80 pixels.
    let position = 40.0 + 32.0 * ops::sin(FRAC_PI_4);
    let pixel = image.pixel(position as u32, 39);
    let wanted = 100.0 * optics_fresnel(ops::cos(FRAC_PI_4), 1.333) as f32;
    // The samples of a pixel are not symmetric about its middle.
    assert!((pixel[0] / wanted - 1.0).abs() < 0.015, "{pixel:?}, wanted {wanted}");
    assert!((pixel[1] / pixel[0] - 0.5).abs() < 1.0e-6 && pixel[2] == 0.0, "{pixel:?}");
    assert_eq!(image.pixel(80 - position as u32, 39)[0], 0.0, "the other side");
}

/// Two lamps of half the sky each make a uniform sky, in which a drop is invisible.
#[test]
fn a_sky_of_two_lamps_hides_drop_and_streak() {
    let shape = DropShape::new(3.0e-3).unwrap();
    let halves = [lamp(0.7, 0.3, FRAC_PI_2, 2.0), lamp(0.7 + PI, -0.3, FRAC_PI_2, 2.0)];
    for exposure_s in [0.0, 1.0e-3] {
        let options =
            SpecimenOptions { size: [24, 24], pitch: 0.4, exposure_s, ..SpecimenOptions::default() };
        let image = picture(&shape, &options, &halves);
        let worst = image.pixels.iter().map(|p| (p[0] - 2.0).abs()).fold(0.0, f32::max);
        assert!(worst < 4.0e-3, "{exposure_s}: {worst}");
    }
}

#[test]
fn lanes_scalars_and_doubles_see_the_same_lamps() {
    let shape = DropShape::new(2.0e-3).unwrap();
    let lamps = [lamp(2.9, 0.1, 0.2, 5.0), lamp(1.5, -0.3, 0.3, 2.0)];
    let map = vec![[0.3; 3]; 32];
    let sky = Sky::new(8, 4, &map).unwrap().with_lamps(&lamps).unwrap();
    let options = SpecimenOptions { size: [37, 29], samples: 3, ..SpecimenOptions::default() };
    let fast = render_specimen(&shape, &options, sky).unwrap();
    let plain = render_specimen_scalar(&shape, &options, sky).unwrap();
    assert!(fast == plain, "lanes have the bits of scalars");
    let exact = render_specimen_f64(&shape, &options, sky).unwrap();
    let pairs = fast.pixels.iter().zip(&exact.pixels);
    let apart = pairs.filter(|(a, b)| (a[0] - b[0]).abs() > 1.0e-3).count();
    assert!(apart * 100 < fast.pixels.len(), "{apart} pixels");
    let unlit = render_specimen(&shape, &options, Sky::new(8, 4, &map).unwrap()).unwrap();
    let brighter = fast.pixels.iter().zip(&unlit.pixels).filter(|(a, b)| a[0] > b[0] + 0.1).count();
    assert!(brighter > 20, "{brighter} pixels show a lamp");
}

#[test]
fn bad_lamps_are_refused() {
    for (yaw, pitch, radius, radiance, words) in [
        (f64::NAN, 0.0, 0.1, 1.0, "yaw of a lamp"),
        (0.0, 1.6, 0.1, 1.0, "pitch of a lamp is 91"),
        (0.0, f64::NAN, 0.1, 1.0, "pitch of a lamp"),
        (0.0, 0.0, 0.0, 1.0, "angular radius of a lamp is 0 degrees; allowed: 0.01 to 90"),
        (0.0, 0.0, 1.6, 1.0, "angular radius"),
        (0.0, 0.0, 0.1, -1.0, "radiance of a lamp is -1"),
        (0.0, 0.0, 0.1, f32::INFINITY, "radiance"),
        (0.0, 0.0, 0.1, f32::NAN, "radiance"),
    ] {
        let error = SpecimenLamp::new(yaw, pitch, radius, [1.0, radiance, 0.0]).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
    let many = [lamp(0.0, 0.0, 0.1, 1.0); 9];
    let error = Sky::new(2, 1, &DARK).unwrap().with_lamps(&many).unwrap_err();
    assert!(matches!(error, SpecimenError::Size { found: 9, max: 8, .. }), "{error}");
}

/// Mean radiance over a sphere's disk of the light of a lamp of radiance 1, by quadrature over the impact parameter: the plane
/// laws of a sphere, order by order, with unpolarized light at each interface. `scattering` is the angle between the direction of
/// the light and the direction to the eye.
fn sphere_shows(scattering: f64, radius: f64) -> f64 {
    let steps = 200_000;
    let (mut sum, lamp) = (0.0, ops::cos(radius));
    for k in 0..steps {
        let b = (f64::from(k) + 0.5) / f64::from(steps);
        let (incident, refracted) = (ops::asin(b), ops::asin(b / WATER_INDEX));
        let mirrored: f64 = optics_fresnel(ops::cos(incident), WATER_INDEX);
        let mut fraction = mirrored;
        for p in 0..12 {
            if p > 0 {
                fraction = (1.0 - mirrored) * (1.0 - mirrored) * ops::pow(mirrored, f64::from(p - 1));
            }
            // Van de Hulst, Light scattering by small particles, 12.21: the deflection of order p.
            let angle = if p == 0 {
                PI - 2.0 * incident
            } else {
                2.0 * (incident - refracted) + f64::from(p - 1) * (PI - 2.0 * refracted)
            };
            // Fraction of the ring of that angle in the lamp's disk.
            let (s, c) = (ops::sin(angle) * ops::sin(scattering), ops::cos(angle) * ops::cos(scattering));
            let edge =
                if s.abs() < 1.0e-12 { -2.0 * f64::from(c >= lamp) + 1.0 } else { (lamp - c) / s.abs() };
            let within = ops::acos(edge.clamp(-1.0, 1.0)) / PI;
            sum += 2.0 * b / f64::from(steps) * fraction * within;
        }
    }
    sum
}

/// The image of a small lamp in a drop is narrower than a sample of the picture, and a falling drop draws it out along a column:
/// all lines of samples at one position across would meet it, or miss it, alike. The streak still has the light of the sphere.
#[test]
fn a_streak_has_the_light_of_a_lamp_that_is_smaller_than_its_samples() {
    let shape = DropShape::sphere(2.0e-3).unwrap();
    let radius = 1.5_f64.to_radians();
    // A drop is 8 pixels across, 32 samples; its images of the lamp are half a sample wide.
    let options = SpecimenOptions {
        distance_m: 20.0,
        fov: Some(2.0 * ops::atan(0.5 * 40.0 * 0.25e-3 / 20.0)),
        size: [12, 40],
        exposure_s: 1.0e-3,
        instants: 192,
        ..SpecimenOptions::default()
    };
    for scattering_deg in [40.0f64, 60.0, 142.0] {
        let scattering = scattering_deg.to_radians();
        let image = picture(&shape, &options, &[lamp(PI - scattering, 0.0, radius, 1.0e4)]);
        let light: f64 = image.pixels.iter().map(|pixel| f64::from(pixel[0])).sum();
        let found = light / (PI * 16.0);
        let wanted = 1.0e4 * sphere_shows(scattering, radius);
        println!("{scattering_deg}: {:.4}", found / wanted);
        assert!((found / wanted - 1.0).abs() < 0.1, "{scattering_deg} degrees: {found} for {wanted}");
    }
}

/// More samples per pixel of a drop at rest approach the same quadrature.
#[test]
fn a_drop_at_rest_has_the_light_of_a_small_lamp() {
    let shape = DropShape::sphere(2.0e-3).unwrap();
    let (scattering, radius) = (1.3f64, 2.0_f64.to_radians());
    let error = |samples: u32| {
        let options =
            SpecimenOptions { distance_m: 20.0, size: [100, 100], samples, ..SpecimenOptions::default() };
        let image = picture(&shape, &options, &[lamp(PI - scattering, 0.0, radius, 1.0e4)]);
        let light: f64 = image.pixels.iter().map(|pixel| f64::from(pixel[0])).sum();
        // The drop is 80 pixels high.
        (light / (PI * 1600.0) / (1.0e4 * sphere_shows(scattering, radius)) - 1.0).abs()
    };
    let [four, sixteen] = [error(4), error(16)];
    println!("{four:.4}, {sixteen:.4}");
    assert!(sixteen < 0.02 && sixteen < four, "{four}, {sixteen}");
}
