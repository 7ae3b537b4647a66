//! Glow: light is kept, angles do not depend on the resolution, none is none.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour_math::ops::f64 as ops;
use downpour_render::camera::{Camera, Viewpoint};
use downpour_render::glow::{Glow, GlowDiffraction};
use downpour_render::picture::Picture;
use downpour_weather::GlowFilter;
use glam::Vec3;

const FOV: f32 = 0.8;

fn camera(size: [u32; 2]) -> Camera {
    let viewpoint = Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: FOV };
    viewpoint.camera(size, 0).unwrap()
}

/// A picture of one radiance and distance but for some pixels.
fn picture(size: [u32; 2], radiance: f32, distance: f32, lamps: &[([u32; 2], f32)]) -> Picture {
    let mut clean = vec![[radiance, radiance, radiance, distance]; (size[0] * size[1]) as usize];
    for &([x, y], light) in lamps {
        clean[(y * size[0] + x) as usize] = [light, 0.5 * light, 0.1 * light, distance];
    }
    Picture {
        size,
        rain: vec![[0.0, 0.0, 0.0, 1.0]; clean.len()],
        clean,
        drops_on_screen: 0,
        drawn: Vec::new(),
        environment: Vec::new(),
        through_glass: None,
        glow: Vec::new(),
        passes: Vec::new(),
        device: None,
    }
}

fn sum(pixels: impl Iterator<Item = f32>) -> f64 {
    pixels.map(f64::from).sum()
}

const GLARE: Glow = Glow { glare: 0.1, width: 1.0, filter: GlowFilter::Pyramid, diffraction: None };

fn kinds() -> [Glow; 4] {
    let drops = GlowDiffraction { extinction: 0.02, angle: 0.004 };
    [
        GLARE,
        Glow { width: 5.0, ..GLARE },
        Glow { filter: GlowFilter::Kawase, width: 4.0, ..GLARE },
        Glow { diffraction: Some(drops), ..GLARE },
    ]
}

#[test]
fn light_comes_back_around_and_the_mean_stays() {
    for glow in kinds() {
        for size in [[64, 64], [97, 61], [240, 135], [31, 7], [5, 3]] {
            // Lamps in the middle, beside a border and in a corner.
            let [width, height] = size;
            let lamps = [
                ([width / 2, height / 2], 900.0),
                ([1, height / 3], 50.0),
                ([width - 1, height - 1], 2000.0),
            ];
            let mut lit = picture(size, 0.2, 30.0, &lamps);
            let before = lit.radiance();
            lit.add_glow(&glow, &camera(size));
            let after = lit.radiance();
            for k in 0..3 {
                let total = sum(before.iter().map(|p| p[k]));
                let now = sum(after.iter().map(|p| p[k]));
                assert!((now / total - 1.0).abs() < 1.0e-5, "{glow:?} {size:?}: {now} for {total}");
                // Gains and losses are one another's, to a thousandth of the light that was taken.
                let gained = sum(lit.glow.iter().map(|p| p[k].max(0.0)));
                let lost = sum(lit.glow.iter().map(|p| -p[k].min(0.0)));
                assert!(
                    gained > 0.0 && (gained / lost - 1.0).abs() < 1.0e-3,
                    "{glow:?}: {gained} for {lost}"
                );
            }
        }
    }
}

#[test]
fn one_color_stays() {
    for glow in kinds() {
        for size in [[64, 64], [97, 61], [31, 7]] {
            let mut even = picture(size, 0.7, 30.0, &[]);
            even.add_glow(&glow, &camera(size));
            let most = even.glow.iter().flatten().fold(0.0f32, |most, v| most.max(v.abs()));
            assert!(most < 2.0e-6, "{glow:?}: {most}");
        }
    }
}

#[test]
fn without_strength_there_is_none() {
    let size = [97, 61];
    let mut lit = picture(size, 0.2, 30.0, &[([40, 30], 900.0)]);
    let before = lit.clone();
    lit.add_glow(&Glow { glare: 0.0, ..GLARE }, &camera(size));
    assert_eq!(lit, before);
    let dry = GlowDiffraction { extinction: 0.0, angle: 0.001 };
    lit.add_glow(&Glow { glare: 0.0, diffraction: Some(dry), ..GLARE }, &camera(size));
    assert_eq!(lit, before);
}

/// Fraction of a lamp's light that is farther than an angle in degrees from it.
fn beyond(glow: &Glow, lines: u32, angle_deg: f64) -> f64 {
    let size = [lines, lines];
    let middle = lines / 2;
    // A lamp of the same angle in all pictures.
    let edge = lines / 60;
    let lamps: Vec<_> = (0..edge * edge).map(|k| ([middle + k % edge, middle + k / edge], 1.0e3)).collect();
    let mut lit = picture(size, 0.0, 1.0e30, &lamps);
    let camera = camera(size);
    lit.add_glow(glow, &camera);
    let center = f64::from(middle) + 0.5 * f64::from(edge) - 0.5;
    let reach = angle_deg.to_radians() / f64::from(camera.pixel_angle);
    let far = lit.radiance().into_iter().zip(0u32..).filter_map(|(p, i)| {
        let [x, y] = [i % lines, i / lines].map(|v| f64::from(v) - center);
        (x * x + y * y > reach * reach).then_some(p[0])
    });
    sum(far) / (f64::from(edge * edge) * 1.0e3)
}

#[test]
fn angles_do_not_depend_on_the_resolution() {
    for glow in [GLARE, Glow { filter: GlowFilter::Kawase, width: 3.0, ..GLARE }] {
        for angle in [1.5, 3.0, 6.0] {
            let [coarse, middle, fine] = [180, 300, 540].map(|lines| beyond(&glow, lines, angle));
            let allowed = 0.07 * fine + 5.0e-4;
            assert!((coarse - fine).abs() < allowed, "{glow:?} {angle}: {coarse} and {fine}");
            assert!((middle - fine).abs() < allowed, "{glow:?} {angle}: {middle} and {fine}");
        }
    }
}

/// Light between angles by the law of the CIE: the integral of `2 pi angle (10 / angle^3 + 5 / angle^2)`.
#[test]
fn glare_has_the_light_of_the_law_between_angles() {
    let between = |low: f64, high: f64| beyond(&GLARE, 540, low) - beyond(&GLARE, 540, high);
    let law = |low: f64, high: f64| 10.0 * (1.0 / low - 1.0 / high) + 5.0 * ops::ln(high / low);
    let found = between(1.5, 4.0) / between(4.0, 10.0);
    let wanted = law(1.5, 4.0) / law(4.0, 10.0);
    assert!((found / wanted - 1.0).abs() < 0.1, "{found} for {wanted}");
}

#[test]
fn diffraction_grows_with_the_depth_of_rain() {
    let size = [120, 120];
    let taken = |distance: f32| {
        let mut lit = picture(size, 0.0, distance, &[([60, 60], 1000.0)]);
        let drops = GlowDiffraction { extinction: 0.01, angle: 0.05 };
        lit.add_glow(&Glow { glare: 0.0, diffraction: Some(drops), ..GLARE }, &camera(size));
        f64::from(-lit.glow[(60 * size[0] + 60) as usize][0]) / 1000.0
    };
    let [near, far] = [taken(10.0), taken(100.0)];
    let ratio = (1.0 - ops::exp(-0.1)) / (1.0 - ops::exp(-1.0));
    assert!((near / far / ratio - 1.0).abs() < 1.0e-3, "{near} {far}");
    // The sky is as it is seen through the rain beyond 50 m.
    let sky = taken(1.0e30) / far;
    assert!((sky / ((1.0 - ops::exp(-0.5)) / (1.0 - ops::exp(-1.0))) - 1.0).abs() < 1.0e-3);
}
