//! The streak of a specimen: furnace, weights, agreement with the drop at rest, with instants, and with f64.

use downpour_drop::DropShape;
use downpour_drop::mesh::DropSurface;
use downpour_drop::oscillation::Amplitudes;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_math::vector::{dot, normalize, scale};
use downpour_specimen::trace::SpecimenRay;
use downpour_specimen::wobble::{
    SpecimenWobble, specimen_wobble_bounce, specimen_wobble_enter, specimen_wobble_meet,
    specimen_wobble_surface,
};
use downpour_specimen::{
    Image, Sky, SpecimenMotion, SpecimenOptions, render_specimen, render_specimen_f64, render_specimen_scalar,
};

fn drop(diameter_mm: f64) -> DropShape {
    DropShape::new(diameter_mm * 1.0e-3).expect("a diameter")
}

fn streak(exposure_s: f64, pitch: f64) -> SpecimenOptions {
    SpecimenOptions {
        size: [16, 40],
        samples: 2,
        pitch,
        yaw: 0.3,
        exposure_s,
        instants: 3,
        oscillation: Amplitudes::GARG_NAYAR_OBLATE,
        phase: [0.2, 0.7],
        ..SpecimenOptions::default()
    }
}

fn random_sky() -> Vec<[f32; 3]> {
    (0..32 * 16)
        .map(|i| {
            let [r, g, b, _] = rng_draw([5, 6], i, 0, 0).map(rng_unit);
            [r, g, b]
        })
        .collect()
}

fn apart(a: &Image, b: &Image) -> [f64; 2] {
    let all: Vec<f64> = a.pixels.iter().zip(&b.pixels).map(|(a, b)| f64::from((a[0] - b[0]).abs())).collect();
    [all.iter().copied().fold(0.0, f64::max), all.iter().sum::<f64>() / all.len() as f64]
}

#[test]
fn a_uniform_sky_hides_the_streak() {
    let radiance = [[1.0, 0.5, 2.0]; 8];
    let sky = Sky::new(4, 2, &radiance).unwrap();
    let mut worst = 0.0f32;
    for (diameter, exposure_s, pitch) in [
        (0.5, 0.002, 0.0),
        (2.0, 0.01, 0.7),
        (4.0, 0.002, -1.2),
        (6.0, 0.004, 0.1),
        (3.0, 0.0, 0.3),
        (9.0, 0.001, 1.5),
    ] {
        let image = render_specimen(&drop(diameter), &streak(exposure_s, pitch), sky).unwrap();
        for pixel in &image.pixels {
            worst = worst.max((pixel[0] - 1.0).abs()).max((pixel[1] - 0.5).abs()).max((pixel[2] - 2.0).abs());
        }
    }
    println!("furnace: {worst:e}");
    assert!(worst < 1.0e-5, "{worst:e}");
}

/// A drop that hardly moves, and one that hardly oscillates, equal the one at rest, which another tracer draws.
///
/// From above, light is trapped in the drop of 3 mm by total reflection and its exit depends on rounding: the picture of the
/// drop at rest itself is 4e-2 and in the mean 9e-5 from its reference in f64. All but these few pixels have to agree.
#[test]
fn a_short_exposure_is_the_drop_at_rest() {
    let radiance = random_sky();
    let sky = Sky::new(32, 16, &radiance).unwrap();
    for (diameter, pitch, caught, mean_bound) in
        [(1.0, 0.0, 0, 1.0e-5), (3.0, 0.5, 40, 2.0e-4), (5.0, -0.4, 2, 1.0e-5)]
    {
        let fov = Some(1.3 * diameter * 1.0e-2);
        let still =
            SpecimenOptions { fov, oscillation: Amplitudes::NONE, size: [40, 40], ..streak(0.0, pitch) };
        let short = SpecimenOptions { exposure_s: 1.0e-9, ..still };
        let faint = SpecimenOptions { oscillation: Amplitudes::new(1.0e-9, 1.0e-9).unwrap(), ..still };
        let rest = render_specimen(&drop(diameter), &still, sky).unwrap();
        for options in [short, faint] {
            let image = render_specimen(&drop(diameter), &options, sky).unwrap();
            let [worst, mean] = apart(&image, &rest);
            let off =
                image.pixels.iter().zip(&rest.pixels).filter(|(a, b)| (a[0] - b[0]).abs() > 3.0e-4).count();
            println!(
                "{diameter} mm: worst {worst:.1e}, mean {mean:.1e}, {off} of {} pixels off",
                rest.pixels.len()
            );
            assert!(off <= caught && mean < mean_bound, "{diameter} mm: {off} off, {worst:e}, mean {mean:e}");
        }
    }
}

/// One instant per sample, at a random position in the exposure for each, has the light of many: the weights of the
/// instants and of the uncovered time sum to 1 for any number of instants.
#[test]
fn no_more_and_no_less_light_than_the_instants() {
    let radiance = random_sky();
    let sky = Sky::new(32, 16, &radiance).unwrap();
    let mean = |instants: u32| {
        let options = SpecimenOptions { instants, size: [12, 30], ..streak(0.002, 0.0) };
        let image = render_specimen(&drop(2.0), &options, sky).unwrap();
        image.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / image.pixels.len() as f64
    };
    let (few, many) = (mean(1), mean(48));
    println!("mean radiance: {few} of 1 instant, {many} of 48");
    assert!((few / many - 1.0).abs() < 2.0e-2, "{few} {many}");
}

#[test]
fn paths_and_threads_give_the_same_bits() {
    let radiance = random_sky();
    let sky = Sky::new(32, 16, &radiance).unwrap();
    let options = streak(0.003, 0.4);
    let one = render_specimen(&drop(3.0), &options, sky).unwrap();
    assert!(one == render_specimen_scalar(&drop(3.0), &options, sky).unwrap());
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert!(one == pool.install(|| render_specimen(&drop(3.0), &options, sky)).unwrap(), "{threads}");
    }
}

#[test]
fn f32_agrees_with_f64() {
    let radiance = random_sky();
    let sky = Sky::new(32, 16, &radiance).unwrap();
    for (diameter, exposure_s, pitch) in [(1.0, 0.01, 0.0), (3.0, 0.002, 0.7), (5.0, 0.004, -0.4)] {
        let options = streak(exposure_s, pitch);
        let single = render_specimen(&drop(diameter), &options, sky).unwrap();
        let double = render_specimen_f64(&drop(diameter), &options, sky).unwrap();
        let [worst, mean] = apart(&single, &double);
        println!("{diameter} mm: worst {worst:.1e}, mean {mean:.1e}");
        assert!(worst < 5.0e-3 && mean < 3.0e-5, "{diameter} mm: worst {worst:e}, mean {mean:e}");
    }
}

fn motion(diameter: f64, amplitudes: [f64; 2]) -> SpecimenMotion {
    let oscillation = Amplitudes::new(amplitudes[0], amplitudes[1]).expect("amplitudes within their range");
    let options = SpecimenOptions { oscillation, phase: [0.1, 0.6], ..SpecimenOptions::default() };
    options.motion(&drop(diameter)).expect("a motion").expect("not at rest")
}

fn wobble(motion: &SpecimenMotion, seconds: f64) -> SpecimenWobble<f64> {
    SpecimenWobble {
        coefficients: motion.drop.shape().coefficients(),
        state: motion.drop.at(seconds, 0.0).state(),
        index: 1.333,
        inverse_wide: motion.inverse_wide,
        inverse_tall: motion.inverse_tall,
    }
}

fn direction(random: u32) -> [f64; 3] {
    let [x, y, z, _] = rng_draw([8, 9], random, 0, 0).map(|w| 2.0 * f64::from(rng_unit(w)) - 1.0);
    normalize([x, y, z + 1.0e-3])
}

/// Points and normals of the tracer are those of the drop itself, and the spheroid holds it at all times.
#[test]
fn the_surface_is_that_of_the_drop() {
    for (diameter, amplitudes) in [(1.0, [0.3, 0.3]), (4.0, [0.2, 0.1]), (8.0, [0.0, 0.2])] {
        let motion = motion(diameter, amplitudes);
        let radius = motion.drop.shape().equivalent_radius();
        for i in 0..400u32 {
            let seconds = 0.001 * f64::from(i);
            let (instant, traced) = (motion.drop.at(seconds, 0.0), wobble(&motion, seconds));
            let along = direction(i);
            let r = instant.radius_along(along) / radius;
            let surface = specimen_wobble_surface(&traced, scale(along, r));
            assert!(surface.excess.abs() < 1.0e-12, "{diameter} mm: {:e}", surface.excess);
            let normal = normalize(surface.half_gradient);
            assert!((dot(normal, instant.normal_along(along)) - 1.0).abs() < 1.0e-12, "{diameter} mm");
            let [x, y, z] = scale(along, r);
            let gauge = (x * x + z * z) * motion.inverse_wide + y * y * motion.inverse_tall;
            assert!(gauge <= 1.0, "{diameter} mm: {gauge}");
        }
    }
}

/// No hollow or bulge is missed: the tracer finds the first crossing of a search in a thousand steps, in drops far from
/// convex as well.
#[test]
fn the_first_crossing_is_found() {
    let (mut hits, mut wrong) = (0, 0);
    for i in 0..600u32 {
        let motion = motion(2.0, [0.2, [0.1, 0.2, 0.3][i as usize % 3]]);
        let traced = wobble(&motion, 0.0007 * f64::from(i));
        let (d, across) = (direction(2 * i), direction(2 * i + 1));
        let foot: [f64; 3] = std::array::from_fn(|k| across[k] - dot(across, d) * d[k]);
        let ray = SpecimenRay { foot: scale(foot, 1.2), reach: 50.0, direction: d };
        let excess = |origin: [f64; 3], d: [f64; 3], s: f64| {
            specimen_wobble_surface(&traced, std::array::from_fn(|k| origin[k] + s * d[k])).excess
        };
        let walk = (0..=4000).map(|n| f64::from(n) * 1.0e-3 - 2.0).find(|&s| excess(ray.foot, d, s) < 0.0);
        let found = specimen_wobble_meet(&traced, &ray);
        match (walk, found) {
            (Some(walk), Some(s)) => {
                hits += 1;
                wrong += usize::from((walk - s).abs() > 2.0e-3);
                let inside = specimen_wobble_enter(&traced, &ray, s);
                let next = specimen_wobble_bounce(&traced, &inside, 0.0);
                let chord: [f64; 3] = std::array::from_fn(|k| next.point[k] - inside.point[k]);
                let length = dot(chord, inside.inside);
                let out = (1..=4000)
                    .map(|n| f64::from(n) * 1.0e-3)
                    .find(|&t| excess(inside.point, inside.inside, t) > 0.0);
                wrong += usize::from(out.is_none_or(|t| (t - length).abs() > 2.0e-3));
            }
            (None, None) => {}
            // A chord shorter than a step of the search.
            (None, Some(_)) => {}
            (Some(_), None) => wrong += 1,
        }
    }
    println!("{hits} hits, {wrong} crossings are not the first");
    assert!(hits > 250 && wrong <= 2, "{hits} {wrong}");
}

#[test]
fn what_cannot_be_is_refused() {
    let shape = drop(2.0);
    let fine = streak(0.01, 0.0);
    assert_eq!(fine.check(&shape), Ok(()));
    for (bad, word) in [
        (SpecimenOptions { exposure_s: -0.01, ..fine }, "exposure is -0.01 s"),
        (SpecimenOptions { exposure_s: f64::NAN, ..fine }, "exposure is NaN"),
        (SpecimenOptions { exposure_s: 1.5, ..fine }, "0 to 1"),
        (SpecimenOptions { instants: 0, ..fine }, "instants of an exposure is 0"),
        (SpecimenOptions { instants: 4097, ..fine }, "1 to 4096"),
        (SpecimenOptions { phase: [f64::NAN, 0.0], ..fine }, "phase"),
        (SpecimenOptions { pitch: 1.57, exposure_s: 0.5, ..fine }, "from the path of the drop"),
    ] {
        let error = bad.check(&shape).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
    }
}
