//! The specimen's pictures: furnace, orientation, agreement of the paths, options.

use downpour_drop::DropShape;
use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_specimen::sky::{specimen_sky, specimen_sky_position, specimen_turns};
use downpour_specimen::{
    Image, MAX_SIZE, Sky, SpecimenError, SpecimenOptions, render_specimen, render_specimen_f64,
    render_specimen_scalar,
};

fn drop(diameter_mm: f64) -> DropShape {
    DropShape::new(diameter_mm * 1.0e-3).expect("a diameter")
}

fn small(pitch: f64, yaw: f64) -> SpecimenOptions {
    SpecimenOptions { size: [48, 36], samples: 2, pitch, yaw, ..SpecimenOptions::default() }
}

/// A sky of 32 x 16 texels of random radiance up to 1.
fn random_sky() -> Vec<[f32; 3]> {
    (0..32 * 16)
        .map(|i| {
            let [r, g, b, _] = rng_draw([5, 6], i, 0, 0).map(rng_unit);
            [r, g, b]
        })
        .collect()
}

fn mean(image: &Image, columns: std::ops::Range<u32>, rows: std::ops::Range<u32>) -> f32 {
    let all: Vec<f32> = rows.flat_map(|row| columns.clone().map(move |c| image.pixel(c, row)[0])).collect();
    all.iter().sum::<f32>() / all.len() as f32
}

#[test]
fn a_uniform_sky_hides_the_drop() {
    let radiance = [[1.0, 0.5, 2.0]; 8];
    let sky = Sky::new(4, 2, &radiance).unwrap();
    let mut worst = 0.0f32;
    for (diameter, pitch, yaw) in [
        (0.1, 0.0, 0.0),
        (1.0, 0.3, 2.0),
        (3.0, -1.2, 0.0),
        (6.0, 0.5, -1.0),
        (9.0, -1.5, 4.0),
        (9.0, 0.2, 1.0),
    ] {
        let image = render_specimen(&drop(diameter), &small(pitch, yaw), sky).unwrap();
        for pixel in &image.pixels {
            worst = worst.max((pixel[0] - 1.0).abs()).max((pixel[1] - 0.5).abs()).max((pixel[2] - 2.0).abs());
        }
    }
    println!("furnace: {worst:e}");
    assert!(worst < 1.0e-5, "{worst:e}");
}

#[test]
fn the_picture_in_the_drop_is_upside_down() {
    // Light above, dark below.
    let radiance = [[[1.0; 3]; 32], [[0.0; 3]; 32]].concat();
    let sky = Sky::new(2, 32, &radiance).unwrap();
    for diameter in [1.0, 5.0] {
        let image = render_specimen(&drop(diameter), &small(0.0, 0.5), sky).unwrap();
        let (top, bottom) = (mean(&image, 20..28, 6..12), mean(&image, 20..28, 24..30));
        assert!(bottom > 0.8 && top < 0.2, "{diameter} mm: top {top}, bottom {bottom}");
        // The background is upright; right in the middle it is the horizon.
        let (above, below) = (mean(&image, 0..2, 0..6), mean(&image, 0..2, 30..36));
        assert!(above > below, "{above} {below}");
    }
}

#[test]
fn the_picture_in_the_drop_is_mirrored() {
    // Light where x > 0: a quarter turn to each side of u = 0.5. Seen from +Z, +X is on the right.
    let radiance: Vec<_> = (0..64).map(|i| [f32::from(u8::from((16..48).contains(&i))); 3]).collect();
    let sky = Sky::new(64, 1, &radiance).unwrap();
    let image = render_specimen(&drop(2.0), &small(0.0, 0.0), sky).unwrap();
    let (left, right) = (mean(&image, 12..20, 16..20), mean(&image, 28..36, 16..20));
    assert!(left > 0.8 && right < 0.2, "left {left}, right {right}");
    assert!(mean(&image, 44..48, 16..20) > mean(&image, 0..4, 16..20), "the background is not");
}

/// A light overhead is visible above the drop's middle, reflected by the outside.
#[test]
fn the_outside_reflects() {
    let mut radiance = vec![[0.0; 3]; 64 * 32];
    radiance[..64 * 4].fill([1.0; 3]);
    let sky = Sky::new(64, 32, &radiance).unwrap();
    let options = SpecimenOptions { size: [48, 48], samples: 4, ..SpecimenOptions::default() };
    let image = render_specimen(&drop(1.0), &options, sky).unwrap();
    // 45 degrees up on the sphere, where R = 2.8 %; the row of it: 24 - 24 * 0.8 * sin 45.
    let seen = mean(&image, 24..25, 10..11);
    assert!((seen - 0.028).abs() < 4.0e-3, "{seen}");
}

#[test]
fn lanes_scalars_and_threads_give_the_same_bits() {
    let radiance = random_sky();
    let sky = Sky::new(32, 16, &radiance).unwrap();
    for (size, samples) in [([48, 36], 2), ([1, 1], 1), ([7, 5], 3), ([1, 9], 4)] {
        let options = SpecimenOptions { size, samples, ..small(0.4, 1.0) };
        let fast = render_specimen(&drop(5.0), &options, sky).unwrap();
        assert_eq!([fast.width, fast.height], size);
        assert_eq!(fast.pixels.len(), (size[0] * size[1]) as usize);
        let plain = render_specimen_scalar(&drop(5.0), &options, sky).unwrap();
        assert!(fast == plain, "{size:?}");
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let again = pool.install(|| render_specimen(&drop(5.0), &options, sky)).unwrap();
            assert!(fast == again, "{size:?} with {threads} threads");
        }
    }
}

#[test]
fn f32_agrees_with_f64() {
    let radiance = random_sky();
    let sky = Sky::new(32, 16, &radiance).unwrap();
    for (diameter, pitch, most, typical) in
        [(1.0, 0.0, 1.0e-4, 1.0e-6), (3.0, 0.7, 1.0e-4, 4.0e-6), (6.0, -0.4, 2.0e-4, 6.0e-6)]
    {
        let options = small(pitch, 0.3);
        let single = render_specimen(&drop(diameter), &options, sky).unwrap();
        let double = render_specimen_f64(&drop(diameter), &options, sky).unwrap();
        let apart = |(a, b): (&[f32; 3], &[f32; 3])| f64::from((a[0] - b[0]).abs());
        let mut all: Vec<f64> = single.pixels.iter().zip(&double.pixels).map(apart).collect();
        all.sort_by(f64::total_cmp);
        // Close to the critical angle a ray may take another path: one pixel in two hundred may.
        let worst = all[all.len() - 1 - all.len() / 200];
        let average = all.iter().sum::<f64>() / all.len() as f64;
        println!("{diameter} mm: worst {worst:.1e}, mean {average:.1e}");
        assert!(worst < most && average < typical, "{diameter} mm: worst {worst:e}, mean {average:e}");
    }
}

#[test]
fn each_color_has_its_index() {
    let radiance = random_sky();
    let sky = Sky::new(32, 16, &radiance).unwrap();
    let indices = [1.33, 1.335, 1.34];
    let with = |refractive_index| SpecimenOptions { refractive_index, ..small(0.2, 0.0) };
    let all = render_specimen(&drop(2.0), &with(indices), sky).unwrap();
    for (c, &index) in indices.iter().enumerate() {
        let one = render_specimen(&drop(2.0), &with([index; 3]), sky).unwrap();
        assert!(all.pixels.iter().zip(&one.pixels).all(|(a, b)| a[c] == b[c]), "color {c}");
    }
}

#[test]
fn turns_are_those_of_atan2() {
    let mut worst = 0.0f64;
    for i in 0..20_000u32 {
        let [x, y, ..] = rng_draw([1, 2], i, 0, 0).map(|w| 2.0 * rng_unit(w) - 1.0);
        let exact = ops::f64::atan2(y.into(), x.into()) / std::f64::consts::TAU;
        worst = worst.max((f64::from(specimen_turns(y, x)) - exact).abs());
    }
    println!("turns: {worst:e}");
    assert!(worst < 4.0e-8, "{worst:e}");
    let axes = [
        ([0.0, 1.0], 0.0f32),
        ([1.0, 0.0], 0.25),
        ([-1.0, 0.0], -0.25),
        ([0.0, -1.0], 0.5),
        ([0.0, 0.0], 0.0),
    ];
    for ([y, x], turns) in axes {
        assert_eq!(specimen_turns(y, x), turns, "{y} {x}");
    }
}

#[test]
fn a_sky_map_lies_as_agreed() {
    let near = |a: [f32; 2], b: [f32; 2]| (a[0] - b[0]).abs() < 1.0e-6 && (a[1] - b[1]).abs() < 1.0e-6;
    for (direction, position) in [
        ([1.0, 0.0, 0.0], [0.5, 0.5]),
        ([0.0, 0.0, 1.0], [0.75, 0.5]),
        ([0.0, 0.0, -1.0], [0.25, 0.5]),
        ([0.0, 2.0, 0.0], [0.5, 0.0]),
        ([0.0, -0.1, 0.0], [0.5, 1.0]),
        ([1.0, 1.0, 0.0], [0.5, 0.25]),
    ] {
        assert!(near(specimen_sky_position(direction), position), "{direction:?}");
    }
    let texels: Vec<[f32; 3]> = (0..8u8).map(|i| [f32::from(i), 0.0, 1.0]).collect();
    let sky = Sky::new(4, 2, &texels).unwrap();
    let at = |u: f32, v: f32| specimen_sky(sky, [u, v])[0];
    assert_eq!(at(0.125, 0.25), 0.0, "the middle of the first texel");
    assert_eq!(at(0.25, 0.5), 2.5, "between four");
    assert_eq!(at(0.0, 0.0), 1.5, "the seam, half of the last and half of the first");
    assert_eq!(at(1.0, 0.0), 1.5, "the seam from the other side");
    assert_eq!(at(0.375, 1.0), 5.0, "the last row goes on to the pole");
}

#[test]
fn what_cannot_be_is_refused() {
    let shape = drop(2.0);
    let fine = small(0.0, 0.0);
    let text = |options: SpecimenOptions| options.check(&shape).unwrap_err().to_string();
    assert_eq!(fine.check(&shape), Ok(()));
    assert_eq!(text(SpecimenOptions { size: [0, 4], ..fine }), "picture width is 0; allowed: 1 to 16384");
    assert_eq!(text(SpecimenOptions { size: [4, 0], ..fine }), "picture height is 0; allowed: 1 to 16384");
    let over = SpecimenOptions { size: [MAX_SIZE + 1, 4], ..fine }.check(&shape).unwrap_err();
    assert!(matches!(over, SpecimenError::Size { found: 16_385, .. }));
    assert_eq!(over.to_string(), "picture width is 16385; allowed: 1 to 16384");
    assert!(text(SpecimenOptions { samples: 17, ..fine }).contains("allowed: 1 to 16"));
    assert!(text(SpecimenOptions { samples: 0, ..fine }).contains("is 0"));
    for (bad, word) in [
        (SpecimenOptions { distance_m: 1.0e-3, ..fine }, "camera distance is 0.001 m"),
        (SpecimenOptions { distance_m: f64::NAN, ..fine }, "NaN"),
        (SpecimenOptions { distance_m: f64::INFINITY, ..fine }, "inf"),
        (SpecimenOptions { yaw: f64::NAN, ..fine }, "yaw"),
        (SpecimenOptions { pitch: 1.6, ..fine }, "-90 to 90"),
        (SpecimenOptions { fov: Some(0.0), ..fine }, "field of view is 0 degrees"),
        (SpecimenOptions { fov: Some(f64::NAN), ..fine }, "field of view"),
        (SpecimenOptions { fov: Some(3.1), ..fine }, "up to 175"),
        (SpecimenOptions { refractive_index: [1.3, 0.9, 1.3], ..fine }, "refractive index is 0.9"),
    ] {
        let error = bad.check(&shape).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
        let radiance = [[1.0; 3]];
        let rendered = render_specimen(&shape, &bad, Sky::new(1, 1, &radiance).unwrap());
        assert!(rendered.is_err(), "{word}");
    }
    let texels = [[1.0; 3], [f32::NAN; 3]];
    assert!(matches!(Sky::new(0, 1, &[]), Err(SpecimenError::Size { found: 0, .. })));
    assert!(Sky::new(3, 1, &texels).unwrap_err().to_string().contains("2 texels; allowed: 3 x 1 = 3"));
    assert!(Sky::new(2, 1, &texels).unwrap_err().to_string().contains("column 1 of row 0"));
}

/// Views at the limits of the options have finite light only.
#[test]
fn extreme_views_are_finite() {
    let radiance = random_sky();
    let sky = Sky::new(32, 16, &radiance).unwrap();
    let quarter = std::f64::consts::FRAC_PI_2;
    for (diameter, options) in [
        (0.001, small(quarter, 0.0)),
        (9.0, SpecimenOptions { distance_m: 5.8e-3, fov: Some(3.05), ..small(-quarter, 0.0) }),
        (9.0, SpecimenOptions { distance_m: 1000.0, ..small(0.0, -1.0e9) }),
        (9.0, SpecimenOptions { refractive_index: [1.0, 2.4, 4.0], ..small(0.6, 3.0) }),
        (3.0, SpecimenOptions { fov: Some(1.0e-9), ..small(0.6, 3.0) }),
    ] {
        let image = render_specimen(&drop(diameter), &options, sky).unwrap();
        for pixel in &image.pixels {
            assert!(pixel.iter().all(|c| (0.0..=1.0 + 1.0e-5).contains(c)), "{diameter} mm: {pixel:?}");
        }
    }
}
