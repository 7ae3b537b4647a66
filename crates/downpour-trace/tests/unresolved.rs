//! Rain that is not drawn drop by drop: what it takes out and what it scatters, held against integrals that are written here.

use std::f64::consts::{FRAC_PI_2, PI};

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw, ExtinctionEfficiency};
use downpour_math::ops::f64 as ops;
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::picture::PictureOptions;
use downpour_render::rain::light::DropLightOptions;
use downpour_render::rain::{DropMasks, Exposure, MediumOptions, Rain, RainMedium, RainOptions, StreakTable};
use downpour_sim::field::RainField;
use downpour_sim::resolved::{Region, Resolved};
use downpour_sim::view::View;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::capture::trace_environment;
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::picture::render_picture;
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::Fog;
use glam::{Affine3A, DVec3, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Simpson's rule.
fn integral(low: f64, high: f64, steps: u32, f: impl Fn(f64) -> f64) -> f64 {
    let width = (high - low) / f64::from(2 * steps);
    (0..=2 * steps)
        .map(|k| {
            let weight = if k == 0 || k == 2 * steps { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            weight * f(low + width * f64::from(k))
        })
        .sum::<f64>()
        * width
        / 3.0
}

/// Terminal speed of E. Brandes et al. 2002, m/s, of a diameter in mm.
fn brandes(mm: f64) -> f64 {
    -0.1021 + mm * (4.932 + mm * (-0.9551 + mm * (0.07934 - mm * 0.002362)))
}

/// Drops per m^3 and mm, by diameter in mm, of Marshall & Palmer's law, scaled until they carry the rate.
fn marshall_palmer(rate: f64) -> impl Fn(f64) -> f64 {
    let slope = 4.1 * ops::pow(rate, -0.21);
    let carried = 6.0e-4 * PI * integral(0.1, 8.0, 400, |d| ops::exp(-slope * d) * brandes(d) * d * d * d);
    move |d| rate / carried * ops::exp(-slope * d)
}

/// Area that drops cover per volume of air along a level path, 1/m: ellipsoids of revolution with the axis ratio of
/// M. Thurai et al. 2007.
fn covered(rate: f64) -> f64 {
    let count = marshall_palmer(rate);
    let ratio = |d: f64| {
        if d < 1.5 {
            1.17 - 0.516 * d + 0.47 * d * d - 0.132 * d * d * d - 8.5e-3 * d * d * d * d
        } else {
            1.065 - 6.25e-2 * d - 3.99e-3 * d * d + 7.66e-4 * d * d * d - 4.095e-5 * d * d * d * d
        }
    };
    // Seen from the side an oblate drop of the volume of a sphere covers the third root of its axis ratio.
    let outline = |d: f64| if d < 0.7 { 1.0 } else { ops::cbrt(ratio(d)) };
    integral(0.1, 8.0, 400, |d| count(d) * PI / 4.0 * d * d * 1.0e-6 * outline(d))
}

/// Cross-section of a sphere of water by scattering angle over that of its disk, 1/sr: orders 0 to 3 of geometric optics, from
/// rays that are spread evenly over the disk and counted in `BINS` intervals of the angle.
fn phase() -> impl Fn(f64) -> f64 {
    const BINS: usize = 90;
    let (rays, index) = (100_000, 1.3330);
    let mut bins = vec![0.0; BINS];
    for k in 0..rays {
        let b = ((f64::from(k) + 0.5) / f64::from(rays)).sqrt();
        let (i, r) = (ops::asin(b), ops::asin(b / index));
        let (ci, cr) = (ops::cos(i), ops::cos(r));
        let amplitudes = [(ci - index * cr) / (ci + index * cr), (index * ci - cr) / (index * ci + cr)];
        for order in 0..4 {
            let fraction: f64 = amplitudes
                .iter()
                .map(|a| {
                    let reflected = a * a;
                    let within = (1..order).fold((1.0 - reflected) * (1.0 - reflected), |s, _| s * reflected);
                    0.5 * if order == 0 { reflected } else { within }
                })
                .sum();
            let turn = 2.0 * i - 2.0 * f64::from(order) * r + (f64::from(order) - 1.0) * PI;
            let angle = ops::acos(ops::cos(turn).clamp(-1.0, 1.0));
            bins[((angle / PI * BINS as f64) as usize).min(BINS - 1)] += fraction / f64::from(rays);
        }
    }
    for (k, bin) in bins.iter_mut().enumerate() {
        let edge = |k: usize| ops::cos(k as f64 * PI / BINS as f64);
        *bin /= 2.0 * PI * (edge(k) - edge(k + 1));
    }
    move |angle| bins[((angle / PI * BINS as f64) as usize).min(BINS - 1)]
}

/// Single scattering of a lamp of intensity 1 along a ray up to a distance, by the phase function of the scattering angle.
fn scattered(phase: impl Fn(f64) -> f64, sigma: f64, lamp: DVec3, direction: DVec3, distance: f64) -> f64 {
    let nearest = lamp.dot(direction);
    let h = (lamp - direction * nearest).length();
    // s = nearest + h tan t: ds / r^2 = dt / h.
    let at = |s: f64| ops::atan((s - nearest) / h);
    integral(at(0.0), at(distance), 400, |t| {
        let s = nearest + h * ops::tan(t);
        phase(t + FRAC_PI_2) * sigma * ops::exp(-sigma * s) / h
    })
}

fn view(fov_y: f32) -> Viewpoint {
    Viewpoint { eye: Vec3::ZERO, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y }
}

/// A wall across the view at a distance, black; and lamps.
fn walled(distance: f32, lights: &[LightSource], sky: [f32; 3]) -> SceneData {
    screened(distance, 40.0 * distance, lights, sky)
}

/// The same, so many meters to each side.
fn screened(distance: f32, edge: f32, lights: &[LightSource], sky: [f32; 3]) -> SceneData {
    let mut builder = SceneBuilder::new();
    let corners = [
        [-edge, -edge, -distance],
        [edge, -edge, -distance],
        [edge, edge, -distance],
        [-edge, edge, -distance],
    ];
    add(&mut builder, &corners);
    for light in lights {
        builder.add_light(*light);
    }
    builder.build(&SkyLight::uniform(sky))
}

fn add(builder: &mut SceneBuilder, corners: &[[f32; 3]; 4]) {
    let black =
        downpour_trace::material::MaterialLook { base_color: [0.0, 0.0, 0.0, 1.0], ..Default::default() };
    let material = builder.add_material(black);
    let part = MeshPart::plain(corners, &[0, 1, 2, 0, 2, 3], material);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
}

/// Masks of all drops, traced once for all tests.
fn masks() -> &'static DropMasks {
    static MASKS: std::sync::OnceLock<DropMasks> = std::sync::OnceLock::new();
    MASKS.get_or_init(|| DropMasks::trace(1.333).expect("masks"))
}

/// Everything unresolved.
fn nothing_drawn() -> Resolved {
    Resolved {
        near: 0.05,
        far: 50.0,
        pixel_angle: 1.0e-3,
        least_pixels: 0.4,
        min_diameter: 1.0,
        region: Region::Everywhere,
    }
}

/// The layer of the medium alone: light of the rain, and transmittance.
fn layer(
    scene: &SceneData,
    seen: &Viewpoint,
    size: [u32; 2],
    medium: RainMedium,
    masks: &DropMasks,
) -> Vec<[f32; 4]> {
    spaced_layer(scene, seen, size, medium, masks, 1)
}

/// The same where one pixel in each cell of `spacing` times `spacing` looks for light.
fn spaced_layer(
    scene: &SceneData,
    seen: &Viewpoint,
    size: [u32; 2],
    medium: RainMedium,
    masks: &DropMasks,
    spacing: u32,
) -> Vec<[f32; 4]> {
    let options = RainOptions { medium, capture_size: 64, ..RainOptions::default() };
    let frame = RenderFrame::new(scene, seen, size, 1, 0, 3).expect("a frame").with_ray_spacing(spacing);
    // As in a picture: what is lit by lamps apart from its surroundings is not lit by their images.
    let frame = RenderFrame { suns_out: 1, ..frame };
    let rain = Rain::new(&frame.camera, seen.eye.as_dvec3(), &[], masks, &options);
    let view = SceneView { data: scene, frame: &frame };
    let clean = view.picture();
    let capture = trace_environment(scene, &frame, &rain.environment);
    let lights = rain.lights(&view, masks).expect("lamps");
    let medium = rain.medium_light(&lights).layer(&clean);
    let table: StreakTable = rain.streak_table(masks, &capture, &[]);
    rain.layer(&clean, masks, &capture, &table, &[], &medium)
}

fn law(rate: f64) -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate).expect("a rain")
}

/// A path through drops of which none is drawn keeps what they do not cover.
#[test]
fn unresolved_drops_take_out_what_they_cover() -> Outcome {
    let masks = masks();
    for (rate, distance) in [(5.0, 40.0), (25.0, 20.0), (100.0, 20.0), (100.0, 600.0)] {
        let medium = RainMedium::new(&law(rate), &nothing_drawn(), masks, &MediumOptions::default())?;
        let scene = walled(distance as f32, &[], [1.0; 3]);
        let layer = layer(&scene, &view(0.02), [4, 2], medium, masks);
        let expected = covered(rate) * distance;
        let found = -ops::ln(f64::from(layer[5][3]));
        assert!((found / expected - 1.0).abs() < 0.015, "{rate} mm/h, {distance} m: {found}, not {expected}");
    }
    Ok(())
}

/// Drops in a box are drawn; beyond it all of them are unresolved, and within it those that are too small.
#[test]
fn what_a_region_leaves_out_is_unresolved() -> Outcome {
    let masks = masks();
    let (rate, distance) = (50.0, 30.0);
    let large = integral(2.0, 8.0, 300, |d| marshall_palmer(rate)(d) * d * d)
        / integral(0.1, 8.0, 400, |d| marshall_palmer(rate)(d) * d * d);
    let region = Region::Box { center: DVec3::new(0.0, 0.0, -4.0), size: DVec3::splat(10.0) };
    // Everything from 2 mm on is drawn in the box, which the ray leaves after 9 m.
    let resolved =
        Resolved { near: 1.0e-9, least_pixels: 1.0e-6, min_diameter: 2.0e-3, region, ..nothing_drawn() };
    let medium = RainMedium::new(&law(rate), &resolved, masks, &MediumOptions::default())?;
    let scene = walled(distance as f32, &[], [1.0; 3]);
    let found = -ops::ln(f64::from(layer(&scene, &view(0.02), [4, 2], medium, masks)[5][3]));
    let expected = covered(rate) * (distance - large * 9.0);
    assert!((found / expected - 1.0).abs() < 0.02, "{found}, not {expected}");
    let rate_of_small = integral(0.1, 2.0, 300, |d| marshall_palmer(rate)(d) * brandes(d) * d * d * d)
        / integral(0.1, 8.0, 400, |d| marshall_palmer(rate)(d) * brandes(d) * d * d * d);
    let told = medium.unresolved_rate_mm_h() / rate;
    assert!((told / rate_of_small - 1.0).abs() < 0.03, "{told}, not {rate_of_small}");
    Ok(())
}

/// Lamps light unresolved drops as an integral over the ray says, at every angle.
#[test]
fn unresolved_drops_scatter_lamps_as_single_scattering_says() -> Outcome {
    let masks = masks();
    let (rate, distance) = (25.0, 30.0);
    let phase = phase();
    let size = [16u32, 12];
    for lamp in [DVec3::new(1.0, 2.0, -12.0), DVec3::new(-3.0, 0.5, -4.0), DVec3::new(0.7, 1.0, 2.0)] {
        let position = lamp.as_vec3();
        let light = LightSource::Point { radius: 0.0, position, intensity: Vec3::splat(1000.0), range: 0.0 };
        let scene = walled(distance as f32, &[light], [0.0; 3]);
        let medium = RainMedium::new(&law(rate), &nothing_drawn(), masks, &MediumOptions::default())?;
        let seen = view(0.9);
        let layer = layer(&scene, &seen, size, medium, masks);
        let (mut sum, mut of_truth) = (0.0, 0.0);
        for (pixel, direction) in layer.iter().zip(directions(size)) {
            let far = distance * direction.length();
            let direction = direction.normalize();
            let expected = 1000.0 * scattered(&phase, covered(rate), lamp, direction, far);
            let found = f64::from(pixel[0] + pixel[1] + pixel[2]) / 3.0;
            sum += found;
            of_truth += expected;
            // Colors of the bows are apart; next to the lamp a pixel is wide.
            if lamp.normalize().dot(direction) < 0.995 {
                assert!(
                    (found / expected - 1.0).abs() < 0.12,
                    "{lamp}, {direction}: {found}, not {expected}"
                );
            }
        }
        assert!((sum / of_truth - 1.0).abs() < 0.04, "{lamp}: {sum}, not {of_truth}");
    }
    Ok(())
}

/// Few pixels that look for the light of lamps find it for all: before a wall and beside it, near a lamp and far from it.
#[test]
fn few_pixels_that_look_find_the_same_light() -> Outcome {
    let masks = masks();
    let medium = RainMedium::new(&law(60.0), &nothing_drawn(), masks, &MediumOptions::default())?;
    let lamp = |x: f32, y: f32, z: f32| LightSource::Point {
        radius: 0.0,
        position: Vec3::new(x, y, z),
        intensity: Vec3::new(900.0, 1000.0, 1100.0),
        range: 0.0,
    };
    let [seen, aside, behind] = [lamp(0.4, 0.7, -8.0), lamp(2.0, 5.0, 3.0), lamp(-4.0, 3.0, -20.0)];
    let light = |pixel: &[f32; 4]| f64::from(pixel[0] + pixel[1] + pixel[2]);
    // So many meters of a wall to each side; none keeps light from any drop, so that no chance is in it.
    let in_all = |edge: f32, lamps: &[LightSource], spacing| {
        spaced_layer(&screened(12.0, edge, lamps, [0.0; 3]), &view(0.3), [96, 64], medium, masks, spacing)
    };
    let all = in_all(0.001, &[seen, aside], 1);
    let with_shadows: f64 = in_all(1.0, &[seen, aside, behind], 1).iter().map(light).sum();
    for spacing in [2, 3, 4] {
        let few = in_all(0.001, &[seen, aside], spacing);
        let apart: Vec<f64> = all.iter().zip(&few).map(|(a, b)| light(b) / light(a) - 1.0).collect();
        let worst = apart.iter().map(|apart| apart.abs()).fold(0.0, f64::max);
        let mean = apart.iter().sum::<f64>() / apart.len() as f64;
        assert!(worst < 0.06 && mean.abs() < 4.0e-3, "{spacing}: {worst}, {mean}");
        assert!(few.iter().zip(&all).all(|(few, all)| few[3] == all[3]));
        let found =
            in_all(1.0, &[seen, aside, behind], spacing).iter().map(light).sum::<f64>() / with_shadows;
        assert!((found - 1.0).abs() < 0.02, "{spacing}: {found}");
    }
    Ok(())
}

/// A lamp behind a wall lights nothing before it, a cone nothing beside it.
#[test]
fn shadows_and_cones_keep_light_from_unresolved_drops() -> Outcome {
    let masks = masks();
    let medium = RainMedium::new(&law(100.0), &nothing_drawn(), masks, &MediumOptions::default())?;
    let dark = LightSource::Point {
        radius: 0.0,
        position: Vec3::new(0.0, 0.0, -21.0),
        intensity: Vec3::splat(1.0e4),
        range: 0.0,
    };
    let behind = layer(&walled(20.0, &[dark], [0.0; 3]), &view(0.8), [24, 16], medium, masks);
    assert!(behind.iter().all(|pixel| pixel[..3] == [0.0; 3]));
    // Down from 10 m, 20 degrees wide: on a level ray lit from 10 - 3.64 to 10 + 3.64 m.
    let spot = LightSource::Spot {
        radius: 0.0,
        position: Vec3::new(0.0, 10.0, -10.0),
        direction: Vec3::NEG_Y,
        intensity: Vec3::splat(1.0e4),
        range: 0.0,
        inner: 0.34,
        outer: 0.35,
    };
    let lit = |distance: f32| {
        layer(&screened(distance, 0.5, &[spot], [0.0; 3]), &view(0.002), [3, 3], medium, masks)[4][1]
    };
    assert_eq!(lit(6.2), 0.0);
    assert!(lit(8.0) > 0.0);
    assert!((lit(14.0) / lit(30.0) - 1.0).abs() < 1.0e-3);
    // Half of what is lit, but for the angles of scattering.
    let phase = phase();
    let part = |low: f64, high: f64| {
        let angle = |s: f64| ops::atan((s - 10.0) / 10.0) + FRAC_PI_2;
        integral(angle(low), angle(high), 500, |a| phase(a) * ops::exp(-covered(100.0) * 10.0))
    };
    let expected = part(6.4, 10.0) / part(6.4, 13.6);
    let found = f64::from(lit(10.0) / lit(20.0));
    assert!((found / expected - 1.0).abs() < 0.05, "{found}, not {expected}");
    Ok(())
}

/// Under a roof there is no rain, drawn or not; in front of it there is.
#[test]
fn there_is_no_unresolved_rain_under_a_roof() -> Outcome {
    let masks = masks();
    let medium = RainMedium::new(&law(100.0), &nothing_drawn(), masks, &MediumOptions::default())?;
    let transmitted = |roof_end: f32| {
        let mut builder = SceneBuilder::new();
        let (low, high) = (-roof_end, 60.0);
        add(&mut builder, &[[-90.0, 4.0, low], [90.0, 4.0, low], [90.0, 4.0, high], [-90.0, 4.0, high]]);
        add(
            &mut builder,
            &[[-90.0, -90.0, -40.0], [90.0, -90.0, -40.0], [90.0, 90.0, -40.0], [-90.0, 90.0, -40.0]],
        );
        let scene = builder.build(&SkyLight::uniform([1.0; 3]));
        f64::from(layer(&scene, &view(0.05), [8, 6], medium, masks)[27][3])
    };
    assert_eq!(transmitted(39.9), 1.0);
    for roof in [20.0, 10.0, 3.0] {
        let found = -ops::ln(transmitted(roof)) / covered(100.0);
        // A slice of the grid is a quarter of its distance.
        let expected = 40.0 - f64::from(roof);
        assert!((found - expected).abs() < 0.3 * f64::from(roof), "{roof}: {found} m, not {expected}");
    }
    Ok(())
}

/// Means over pictures of one rain, of the middle of 4 degrees and of all: light of the rain, and what it takes out.
fn means(
    scene: &SceneData,
    fov_deg: f64,
    lines: u32,
    rate: f64,
    seeds: u64,
) -> Result<[[f64; 2]; 2], Box<dyn std::error::Error>> {
    let masks = masks();
    let fov = fov_deg.to_radians();
    let (half, inner) = (ops::tan(0.5 * fov), ops::tan(2f64.to_radians()));
    let mut sums = [[0.0; 2]; 2];
    for seed in 0..seeds {
        let seen = View {
            half_width: half,
            half_height: half,
            pixel_angle: 2.0 * half / f64::from(lines),
            shutter_s: 0.05,
            ..View::default()
        };
        let visible = RainField::new(&law(rate), seed)?.visible(&seen, 3.0)?;
        let medium = RainMedium::new(&law(rate), &visible.resolved, masks, &MediumOptions::default())?;
        let rain = RainOptions {
            medium,
            capture_size: 64,
            light: DropLightOptions::default(),
            ..RainOptions::default()
        };
        let options = PictureOptions {
            size: [lines, lines],
            grid: 1,
            sky_rays: 0,
            seed,
            rain,
            ..PictureOptions::default()
        };
        let picture = render_picture(scene, &view(fov as f32), &visible.drops, masks, &options)?;
        for (sum, edge) in sums.iter_mut().zip([inner, f64::INFINITY]) {
            let within = |i: usize| {
                let at = |k: u32| ((f64::from(k) + 0.5) / f64::from(lines) * 2.0 - 1.0) * half;
                at(i as u32 % lines).abs() < edge && at(i as u32 / lines).abs() < edge
            };
            let pixels = || picture.rain.iter().enumerate().filter(|(i, _)| within(*i));
            let weight = 1.0 / (pixels().count() as f64 * seeds as f64);
            sum[0] += weight * pixels().map(|(_, pixel)| f64::from(pixel[1])).sum::<f64>();
            sum[1] += weight * pixels().map(|(_, pixel)| f64::from(1.0 - pixel[3])).sum::<f64>();
        }
    }
    Ok(sums)
}

/// Mean of a function of the direction over a square picture, half as wide as `half` at distance 1.
fn mean_over(half: f64, f: impl Fn(DVec3) -> f64) -> f64 {
    integral(-half, half, 12, |x| integral(-half, half, 12, |y| f(DVec3::new(x, y, -1.0))))
        / (4.0 * half * half)
}

/// The mean light of a lamp's glow, and what the rain takes out, whether three drops in a hundred are drawn or nearly all.
#[test]
fn the_same_rain_is_as_bright_from_every_view() -> Outcome {
    let light = LightSource::Point {
        radius: 0.0,
        position: Vec3::new(0.4, 1.6, -12.0),
        intensity: Vec3::splat(1000.0),
        range: 0.0,
    };
    let scene = walled(20.0, &[light], [0.0; 3]);
    let phase = phase();
    let inner = ops::tan(2f64.to_radians());
    let truth = integral(-inner, inner, 12, |x| {
        integral(-inner, inner, 12, |y| {
            let direction = DVec3::new(x, y, -1.0);
            let lamp = DVec3::new(0.4, 1.6, -12.0);
            1000.0 * scattered(&phase, covered(50.0), lamp, direction.normalize(), 20.0 * direction.length())
        })
    }) / (4.0 * inner * inner);
    let taken = 1.0 - ops::exp(-covered(50.0) * 20.0);
    for (fov, lines, seeds) in [(40.0, 60, 2), (40.0, 240, 2), (20.0, 160, 3), (10.0, 160, 4), (4.5, 160, 6)]
    {
        let [[light, out], _] = means(&scene, fov, lines, 50.0, seeds)?;
        println!(
            "{fov} degrees, {lines} lines: light {light:.4} of {truth:.4}, taken {out:.4} of {taken:.4}"
        );
        assert!((light / truth - 1.0).abs() < 0.08, "{fov} degrees, {lines} lines: {light}, not {truth}");
        assert!((out / taken - 1.0).abs() < 0.06, "{fov} degrees, {lines} lines: {out}, not {taken}");
    }
    Ok(())
}

/// Without a wall, before a black sky: the light of a lamp 12 m away that rain scatters on the whole ray.
#[test]
fn rain_before_a_black_sky_is_as_bright_from_every_view() -> Outcome {
    let lamp = DVec3::new(0.4, 1.6, -12.0);
    let mut builder = SceneBuilder::new();
    builder.add_light(LightSource::Point {
        radius: 0.0,
        position: lamp.as_vec3(),
        intensity: Vec3::splat(1000.0),
        range: 0.0,
    });
    let scene = builder.build(&SkyLight::uniform([0.0; 3]));
    let (phase, sigma) = (phase(), covered(50.0));
    let truth = |half: f64| {
        mean_over(half, |direction| 1000.0 * scattered(&phase, sigma, lamp, direction.normalize(), 1000.0))
    };
    let of_middle = truth(ops::tan(2f64.to_radians()));
    for (fov, lines, seeds) in [(40.0, 60, 3), (40.0, 240, 2), (20.0, 160, 3), (10.0, 160, 4)] {
        let [[light, _], [all, _]] = means(&scene, fov, lines, 50.0, seeds)?;
        let of_all = truth(ops::tan((0.5 * fov).to_radians()));
        println!(
            "{fov} degrees, {lines} lines: {light:.4} of {of_middle:.4} in the middle, {all:.4} of {of_all:.4} in all"
        );
        assert!(
            (light / of_middle - 1.0).abs() < 0.08,
            "{fov} degrees, {lines} lines: {light}, not {of_middle}"
        );
        assert!((all / of_all - 1.0).abs() < 0.05, "{fov} degrees, {lines} lines: {all}, not {of_all}");
    }
    Ok(())
}

/// The light of the sun that rain scatters before a black sky, from the side and from ahead. Rain beyond 50 m belongs to the
/// sky.
#[test]
fn rain_in_the_sun_is_as_bright_from_every_view() -> Outcome {
    let phase = phase();
    for travels in [DVec3::new(0.9, -0.4, 0.1), DVec3::new(-0.3, -0.6, 0.7)] {
        let travels = travels.normalize();
        let mut builder = SceneBuilder::new();
        builder.add_light(LightSource::Directional {
            direction: travels.as_vec3(),
            irradiance: Vec3::splat(10.0),
        });
        let scene = builder.build(&SkyLight::uniform([0.0; 3]));
        let truth = |half: f64| {
            mean_over(half, |direction| {
                let angle = ops::acos((-travels.dot(direction.normalize())).clamp(-1.0, 1.0));
                10.0 * phase(angle) * (1.0 - ops::exp(-covered(50.0) * 50.0))
            })
        };
        let of_middle = truth(ops::tan(2f64.to_radians()));
        for (fov, lines, seeds) in [(40.0, 60, 2), (40.0, 240, 2), (10.0, 160, 3)] {
            let [[light, _], [all, _]] = means(&scene, fov, lines, 50.0, seeds)?;
            let of_all = truth(ops::tan((0.5 * fov).to_radians()));
            let name = format!("{fov} degrees, {lines} lines");
            println!("{name}: {light:.5} of {of_middle:.5} in the middle, {all:.5} of {of_all:.5} in all");
            assert!((light / of_middle - 1.0).abs() < 0.05, "{name}: {light}, not {of_middle}");
            assert!((all / of_all - 1.0).abs() < 0.04, "{name}: {all}, not {of_all}");
        }
    }
    Ok(())
}

/// With the total efficiency rain takes out twice what it covers.
#[test]
fn the_total_efficiency_takes_out_twice() -> Outcome {
    let distance = 20.0;
    let scene = walled(distance as f32, &[], [1.0; 3]);
    let options = MediumOptions { efficiency: ExtinctionEfficiency::Total, ..MediumOptions::default() };
    let medium = RainMedium::new(&law(25.0), &nothing_drawn(), masks(), &options)?;
    let found = -ops::ln(f64::from(layer(&scene, &view(0.02), [4, 2], medium, masks())[5][3]));
    let expected = 2.0 * covered(25.0) * distance;
    assert!((found / expected - 1.0).abs() < 0.015, "{found}, not {expected}");
    Ok(())
}

/// Drops and medium together vanish in even light, and before the sky, too.
#[test]
fn all_of_the_rain_vanishes_in_even_light() -> Outcome {
    let masks = masks();
    let seen = View { half_width: 0.4, half_height: 0.4, pixel_angle: 0.8 / 48.0, ..View::default() };
    let visible = RainField::new(&law(200.0), 1)?.visible(&seen, 3.0)?;
    let medium = RainMedium::new(&law(200.0), &visible.resolved, masks, &MediumOptions::default())?;
    let exposure = Exposure { shutter_s: 1.0 / 100.0, ..Exposure::default() };
    let rain = RainOptions { medium, exposure, capture_size: 64, ..RainOptions::default() };
    let options =
        PictureOptions { size: [48, 48], grid: 1, sky_rays: 0, seed: 1, rain, ..PictureOptions::default() };
    let scene = SceneBuilder::new().build(&SkyLight::uniform([0.25, 0.5, 2.0]));
    let fov = 2.0 * ops::atan(0.4);
    let picture = render_picture(&scene, &view(fov as f32), &visible.drops, masks, &options)?;
    let taken: f64 = picture.rain.iter().map(|pixel| f64::from(1.0 - pixel[3])).sum::<f64>() / 2304.0;
    assert!(taken > 0.05, "{taken}");
    for pixel in picture.radiance() {
        for (found, expected) in pixel.iter().zip([0.25, 0.5, 2.0]) {
            assert!((found / expected - 1.0).abs() < 2.0e-3, "{pixel:?}");
        }
    }
    Ok(())
}

/// Phase function of Henyey & Greenstein 1941, 1/sr.
fn henyey_greenstein(g: f64, cos: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * ops::pow(1.0 + g * g - 2.0 * g * cos, 1.5))
}

/// Directions of the pixels of a picture of 0.9 radians up and down.
fn directions([width, height]: [u32; 2]) -> impl Iterator<Item = DVec3> {
    let half = ops::tan(0.45);
    let [w, h] = [width, height].map(|n| 0.5 * f64::from(n));
    (0..width * height).map(move |i| {
        let [u, v] = [(f64::from(i % width) + 0.5) / w - 1.0, 1.0 - (f64::from(i / width) + 0.5) / h];
        DVec3::new(u * half * w / h, v * half, -1.0)
    })
}

fn fog(extinction_per_m: f64, asymmetry: f64) -> RainMedium {
    let fog = Fog { extinction_per_m, height_m: None, base_m: 0.0, asymmetry, albedo: 0.9 };
    RainMedium::default().with_fog(Some(&fog), 0.0)
}

#[test]
fn fog_scatters_lamps_as_single_scattering_says() {
    let (sigma, distance, size) = (0.02, 30.0, [16u32, 12]);
    for g in [0.0, 0.6, 0.85] {
        for lamp in [DVec3::new(1.0, 2.0, -12.0), DVec3::new(-3.0, 0.5, -4.0), DVec3::new(0.7, 1.0, 2.0)] {
            let position = lamp.as_vec3();
            let light =
                LightSource::Point { radius: 0.0, position, intensity: Vec3::splat(1000.0), range: 0.0 };
            let scene = walled(distance as f32, &[light], [0.0; 3]);
            let layer = layer(&scene, &view(0.9), size, fog(sigma, g), masks());
            let (mut sum, mut of_truth) = (0.0, 0.0);
            for (pixel, direction) in layer.iter().zip(directions(size)) {
                let far = distance * direction.length();
                let direction = direction.normalize();
                // Light that goes on as it came has come from straight ahead.
                let phase = |angle: f64| henyey_greenstein(g, ops::cos(angle));
                let expected = 900.0 * scattered(phase, sigma, lamp, direction, far);
                let found = f64::from(pixel[0]);
                // Next to the lamp a pixel of 4 degrees is wide.
                if lamp.normalize().dot(direction) < 0.99 {
                    sum += found;
                    of_truth += expected;
                    assert!((found / expected - 1.0).abs() < 0.06, "{g}, {lamp}: {found}, not {expected}");
                }
            }
            assert!((sum / of_truth - 1.0).abs() < 0.03, "{g}, {lamp}: {sum}, not {of_truth}");
        }
    }
}

/// Before a sky that fog hides a ray collects all of the sun's light that is scattered into it; before a wall that of the way there.
#[test]
fn fog_scatters_the_sun_as_single_scattering_says() {
    let size = [16u32, 12];
    for (g, travels) in [
        (0.0, DVec3::new(0.3, -0.5, 0.4)),
        (0.7, DVec3::new(-0.2, -0.6, -0.5)),
        (0.7, DVec3::new(0.5, -0.3, 1.0)),
    ] {
        let travels = travels.normalize();
        let light = LightSource::Directional { direction: travels.as_vec3(), irradiance: Vec3::splat(10.0) };
        let scene = screened(400.0, 0.01, &[light], [0.0; 3]);
        let layer = layer(&scene, &view(0.9), size, fog(0.01, g), masks());
        for (pixel, direction) in layer.iter().zip(directions(size)) {
            let expected = 9.0 * henyey_greenstein(g, -travels.dot(direction.normalize()));
            let found = f64::from(pixel[0]);
            assert!((found / expected - 1.0).abs() < 0.03, "{g}, {direction}: {found}, not {expected}");
            assert!(pixel[3] < 1.0e-6, "the sky is hidden");
        }
    }
}
