//! Sky maps: directions, means, the sun.

mod exit_code;
mod picture_files;

use downpour_scene::picture::{Picture, Pixels};
use downpour_scene::sky::{
    MAX_RADIANCE, SUN_THRESHOLD, SkyMap, direction_to_uv, from_picture, read_sky, uv_to_direction,
};
use downpour_scene::{Budget, WarningKind};
use exit_code::ExitCode as _;
use picture_files::hdr;

fn map(width: u32, height: u32, color: impl Fn(u32, u32) -> [f32; 3]) -> SkyMap {
    let radiance =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| color(x, y)).collect();
    SkyMap { width, height, radiance, warnings: Vec::new() }
}

fn close(a: [f64; 3], b: [f64; 3], relative: f64) {
    for (a, b) in a.into_iter().zip(b) {
        assert!((a - b).abs() <= relative * b.abs().max(1e-12), "{a} {b}");
    }
}

#[test]
fn the_six_axes_are_where_the_convention_says() {
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let minus = |v: [f32; 3]| v.map(|c| -c);
    assert_eq!(direction_to_uv(x), [0.5, 0.5]);
    assert_eq!(direction_to_uv(z), [0.75, 0.5]);
    assert_eq!(direction_to_uv(minus(z)), [0.25, 0.5]);
    assert!([0.0, 1.0].contains(&direction_to_uv(minus(x))[0]));
    assert_eq!(direction_to_uv(y)[1], 0.0);
    assert_eq!(direction_to_uv(minus(y))[1], 1.0);
    // Huge, tiny and no length.
    assert_eq!(direction_to_uv([0.0, 0.0, 1e38]), [0.75, 0.5]);
    assert_eq!(direction_to_uv([0.0, 0.0, 1e-38]), [0.75, 0.5]);
    assert_eq!(direction_to_uv([0.0; 3]), [0.5, 0.5]);
    for i in 0..40 {
        for j in 1..20 {
            let uv = [(i as f32 + 0.5) / 40.0, j as f32 / 20.0];
            let direction = uv_to_direction(uv);
            let length: f32 = direction.iter().map(|c| c * c).sum();
            assert!((length - 1.0).abs() < 1e-6);
            let back = direction_to_uv(direction);
            assert!((back[0] - uv[0]).abs() < 2e-6 && (back[1] - uv[1]).abs() < 2e-6, "{uv:?} {back:?}");
        }
    }
}

#[test]
fn pixels_are_met_at_their_centers_and_mixed_between() {
    let sky = map(8, 4, |x, y| [x as f32, y as f32, 1.0]);
    for y in 0..4 {
        for x in 0..8 {
            let at = uv_to_direction([(x as f32 + 0.5) / 8.0, (y as f32 + 0.5) / 4.0]);
            let [r, g, b] = sky.radiance(at);
            let near = |a: f32, b: f32| (a - b).abs() < 1e-5;
            assert!(near(r, x as f32) && near(g, y as f32) && near(b, 1.0), "{x} {y}: {r} {g} {b}");
        }
    }
    // Midway between the last and the first column, and over the pole to the other side.
    let seam = sky.radiance(uv_to_direction([0.0, 0.625]));
    assert!((seam[0] - 3.5).abs() < 1e-5, "{seam:?}");
    let poles = map(8, 4, |x, y| [if y == 0 { x as f32 } else { 0.0 }, 0.0, 0.0]);
    // At the pole each column meets the one opposite: x and x + 4 (mod 8).
    let top = poles.radiance([1e-9, 1.0, 1e-9]);
    let opposite = poles.radiance([-1e-9, 1.0, -1e-9]);
    assert!((top[0] - opposite[0]).abs() < 1e-4, "the pole has one value: {top:?} {opposite:?}");
}

#[test]
fn solid_angles_fill_the_sphere() {
    for (width, height) in [(1, 1), (2, 1), (7, 3), (64, 32), (2048, 1024)] {
        let sky = map(width, height, |_, _| [0.0; 3]);
        let total: f64 = (0..height).map(|row| sky.solid_angle(row) * f64::from(width)).sum();
        assert!((total / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-12, "{width} x {height}: {total}");
    }
}

#[test]
fn means_are_those_of_the_laws() {
    close(SkyMap::uniform([0.25, 1.0, 3.0]).mean_radiance(), [0.25, 1.0, 3.0], 1e-12);
    assert_eq!(SkyMap::uniform([f32::NAN, -1.0, f32::INFINITY]).radiance, [[0.0; 3]]);
    // Moon & Spencer: the mean over the upper half is Z (1 + 2 * 1/2) / 3 = 2/3 Z; over the sphere, 1/3 Z.
    let overcast = SkyMap::overcast([3.0, 6.0, 9.0]);
    close(overcast.mean_radiance(), [1.0, 2.0, 3.0], 1e-6);
    // It lights the ground with 7 pi Z / 9.
    let lit: f64 = (0..overcast.height / 2)
        .map(|row| {
            let height = f64::from(overcast.height);
            let polar = std::f64::consts::PI * (f64::from(row) + 0.5) / height;
            f64::from(overcast.radiance[row as usize][0])
                * overcast.solid_angle(row)
                * downpour_math::ops::f64::cos(polar)
        })
        .sum();
    assert!((lit / (7.0 * std::f64::consts::PI * 3.0 / 9.0) - 1.0).abs() < 1e-4, "{lit}");
    // sin^2 of the elevation has the mean 1/3.
    let squared = map(16, 512, |_, y| {
        let polar = std::f64::consts::PI * (f64::from(y) + 0.5) / 512.0;
        let sine = downpour_math::ops::f64::cos(polar);
        [(sine * sine) as f32; 3]
    });
    close(squared.mean_radiance(), [1.0 / 3.0; 3], 1e-5);
}

#[test]
fn a_turn_moves_light_and_keeps_it() {
    let sky =
        map(64, 32, |x, y| [((x * 7 + y * 3) % 11) as f32, f32::from(u8::from(x == 32 && y == 16)), 0.5]);
    for yaw in [0.0, 0.3, 1.0, -2.0, 7.0] {
        close(sky.rotated(yaw).mean_radiance(), sky.mean_radiance(), 1e-6);
    }
    // Exact for whole pixels, and a full turn changes nothing.
    let tau = std::f64::consts::TAU;
    assert_eq!(sky.rotated(tau).radiance, sky.radiance);
    assert_eq!(sky.rotated(tau / 64.0).rotated(-tau / 64.0).radiance, sky.radiance);
    // A light along +X moves to -Z with a quarter turn.
    let lamp = |direction| map(64, 32, |_, _| [0.0; 3]).radiance.len() as f32 * sky_green(&sky, direction);
    assert!(lamp([1.0, -0.05, 0.05]) > 0.0);
    let quarter = sky.rotated(tau / 4.0);
    assert!(sky_green(&quarter, [0.05, -0.05, -1.0]) > 0.0);
    assert_eq!(sky_green(&quarter, [1.0, -0.05, 0.05]), 0.0);
}

fn sky_green(sky: &SkyMap, direction: [f32; 3]) -> f32 {
    sky.radiance(direction)[1]
}

/// A disk of known radius, direction and radiance is found as that.
#[test]
fn a_sun_is_taken_out_with_all_its_light() {
    let size = (2048, 1024);
    let (towards, radius) = (unit([0.4, 0.7, -0.6]), 0.02f32);
    let cos_radius = downpour_math::ops::cos(radius);
    let sky = map(size.0, size.1, |x, y| {
        let uv = [(x as f32 + 0.5) / size.0 as f32, (y as f32 + 0.5) / size.1 as f32];
        let direction = uv_to_direction(uv);
        let cosine: f32 = direction.iter().zip(towards).map(|(a, b)| a * b).sum();
        if cosine > cos_radius { [50_000.0, 40_000.0, 30_000.0] } else { [0.5, 0.7, 1.0] }
    });
    let mut rest = sky.clone();
    let sun = rest.extract_sun(SUN_THRESHOLD).unwrap();
    let omega = 2.0 * std::f64::consts::PI * (1.0 - f64::from(cos_radius));
    close(sun.irradiance_rgb.map(f64::from), [50_000.0 * omega, 40_000.0 * omega, 30_000.0 * omega], 0.02);
    let cosine: f32 = sun.direction.iter().zip(towards).map(|(a, b)| a * b).sum();
    assert!(cosine > 0.999_999, "{sun:?}");
    assert!((sun.angular_radius / radius - 1.0).abs() < 0.02, "{sun:?}");
    close(rest.mean_radiance(), [0.5, 0.7, 1.0], 1e-6);
    let together =
        |i: usize| rest.mean_radiance()[i] + f64::from(sun.irradiance_rgb[i]) / (4.0 * std::f64::consts::PI);
    close([together(0), together(1), together(2)], sky.mean_radiance(), 1e-6);
    // Once out, it is out.
    let before = rest.clone();
    assert_eq!(rest.extract_sun(SUN_THRESHOLD), None);
    assert_eq!(rest, before);
}

#[test]
fn a_sun_on_the_seam_or_at_the_pole_is_one() {
    let mut seam = map(64, 32, |x, y| if !(2..62).contains(&x) && y == 10 { [5000.0; 3] } else { [1.0; 3] });
    let sun = seam.extract_sun(SUN_THRESHOLD).unwrap();
    assert!(sun.direction[0] < -0.8 && sun.direction[2].abs() < 1e-3, "{sun:?}");
    assert!(seam.radiance.iter().all(|pixel| *pixel == [1.0; 3]));
    let mut pole = map(64, 32, |_, y| if y == 0 { [5000.0; 3] } else { [1.0; 3] });
    assert!(pole.extract_sun(SUN_THRESHOLD).unwrap().direction[1] > 0.999);
}

#[test]
fn no_sun_in_an_even_an_empty_or_a_half_bright_sky() {
    for mut sky in [
        SkyMap::uniform([1.0; 3]),
        SkyMap::uniform([0.0; 3]),
        SkyMap::overcast([1.0; 3]),
        map(64, 32, |_, y| if y < 2 { [1e5; 3] } else { [0.0; 3] }),
        SkyMap { width: 0, height: 0, radiance: Vec::new(), warnings: Vec::new() },
        map(4, 2, |_, _| [MAX_RADIANCE; 3]),
        // A lamp far away: bright, small, and with little light.
        map(512, 256, |x, y| if (x, y) == (100, 130) { [40.0; 3] } else { [1.0; 3] }),
    ] {
        let before = sky.clone();
        assert_eq!(sky.extract_sun(SUN_THRESHOLD), None);
        assert_eq!(sky, before);
    }
}

#[test]
fn eight_bits_are_decoded_and_said() {
    let pixels = Pixels::Rgba8(vec![[0, 255, 188, 0], [10, 11, 128, 255]]);
    let picture = Picture { name: "a.png".into(), width: 2, height: 1, pixels, warnings: Vec::new() };
    let sky = from_picture(picture).unwrap();
    // IEC 61966-2-1: 188 is 0.50289, 10 is 10/255/12.92, 11 is just above the straight part, 128 is 0.21586.
    let expected = [[0.0, 1.0, 0.502_887], [0.003_035_27, 0.003_346_54, 0.215_861]];
    for (pixel, expected) in sky.radiance.iter().zip(expected) {
        for (is, was) in pixel.iter().zip(expected) {
            assert!((is - was).abs() <= 2e-6, "{is} {was}");
        }
    }
    assert_eq!(sky.warnings.len(), 1);
    assert!(sky.warnings[0].what.contains("sRGB") && !sky.warnings[0].kind.is_loss());
}

/// E15: values that cannot be light become none, and are counted.
#[test]
fn light_below_zero_or_without_end_is_counted() {
    let pixels = Pixels::RgbaF32(vec![[-1e30, 1.0, 2.0, 1.0], [1e30, 0.0, 0.0, 1.0], [-0.1, -0.1, 3.0, 0.0]]);
    let picture = Picture { name: "a.exr".into(), width: 3, height: 1, pixels, warnings: Vec::new() };
    let sky = from_picture(picture).unwrap();
    assert_eq!(sky.radiance, [[0.0, 1.0, 2.0], [MAX_RADIANCE, 0.0, 0.0], [0.0, 0.0, 3.0]]);
    let words: Vec<String> = sky.warnings.iter().map(ToString::to_string).collect();
    assert!(words[0].contains("3 x 1 pixels"), "{words:?}");
    assert_eq!(words[1], "pixels: 2 pixels below 0, taken as 0");
    assert_eq!(words[2], "pixels: 1 pixels above 1e12, taken as that");
    assert_eq!(sky.warnings[1].kind, WarningKind::Dropped);
}

#[test]
fn files_are_read_within_the_budget() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.hdr");
    std::fs::write(&path, hdr("", 2, 1, &[128, 0, 0, 129, 0, 128, 0, 128])).unwrap();
    let mut budget = Budget::default();
    let sky = read_sky(&path, &mut budget).unwrap();
    assert_eq!(sky.radiance, [[1.0, 0.0, 0.0], [0.0, 0.5, 0.0]]);
    assert_eq!(budget.bytes, Budget::default().bytes - 24);
    assert_eq!(budget.pixels, Budget::default().pixels - 2);
    let mut small = Budget { bytes: 100, ..Budget::default() };
    assert_eq!(read_sky(&path, &mut small).unwrap_err().exit_code(), 3);
    assert_eq!(read_sky(&folder.path().join("none.hdr"), &mut budget).unwrap_err().exit_code(), 5);
    assert_eq!(read_sky(folder.path(), &mut budget).unwrap_err().exit_code(), 2);
    #[cfg(unix)]
    assert_eq!(read_sky("/dev/zero".as_ref(), &mut budget).unwrap_err().exit_code(), 2);
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|c| c * c).sum::<f32>().sqrt();
    v.map(|c| c / length)
}
