//! Wet glass before a scene: energy, lenses, focus, and the lattice that is stepped on.

use downpour_math::ops::f64 as ops;
use downpour_render::camera::Viewpoint;
use downpour_render::glass::water::{
    glass_picture_water_cap, glass_picture_water_leave, glass_picture_water_normal, glass_picture_water_top,
};
use downpour_render::glass::{GlassPicture, GlassPictureDrop, GlassPictureLight, PaneLattice, WetPane};
use downpour_render::light::LightSource;
use downpour_scene::scene::Scene;
use downpour_scene::sky::SkyMap;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::{RenderFrame, SceneData};
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::material::MaterialLook;
use downpour_trace::pane_shadow::{is_lit_through, set_pane};
use downpour_trace::scene::SceneView;
use downpour_trace::sky_light::SkyLight;
use downpour_weather::{Loaded, Weather};
use glam::{Affine3A, Vec2, Vec3};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const SIZE: [u32; 2] = [96, 64];
const CAPTURE: usize = (4 * 64 * 64 - 1) / 3;

/// A scene under an even sky, looking along -z.
fn frame_scene(glass: &str) -> Result<(Weather, FrameScene), Box<dyn std::error::Error>> {
    let text = format!(
        "[rain]\nrate_mm_h = 100\n[camera]\nposition_m = [0, 1.5, 0]\nfov_deg = 14\n[output]\nsize = [96, 64]\n[glass]\n{glass}"
    );
    let weather = Weather::parse("w.toml", &text)?;
    let sky = SkyMap::uniform([1.0; 3]);
    let loaded = Loaded {
        scene: Scene::default(),
        animations: Vec::new(),
        moving: Vec::new(),
        sky,
        sun: None,
        unscaled: None,
        masks: Vec::new(),
        drop_model: None,
        warnings: Vec::new(),
    };
    let frame_scene = FrameScene::new(&weather, &loaded, 0.0)?;
    Ok((weather, frame_scene))
}

/// The pane of a weather, ready to be looked through.
fn picture(glass: &str) -> Result<GlassPicture, Box<dyn std::error::Error>> {
    let (weather, frame_scene) = frame_scene(glass)?;
    let mut pane = WetPane::new(&weather, &frame_scene.viewpoint, 0.0)?.ok_or("no pane")?;
    pane.advance(0.0)?;
    let frame = RenderFrame::new(&frame_scene.data, &frame_scene.viewpoint, SIZE, 1, 0, 0)?;
    let lighting = SceneView { data: &frame_scene.data, frame: &frame };
    Ok(pane.picture(&frame_scene.viewpoint, &frame.camera, frame.grid, &lighting, CAPTURE, 0.0)?)
}

/// A picture far away, and a capture, of a radiance by the height of a direction: -1 to 1.
fn round(glass: &GlassPicture, radiance: impl Fn(f32) -> f32) -> [Vec<[f32; 4]>; 2] {
    let row = |y: u32| {
        let up = glass.frame.camera.up.y * (1.0 - 2.0 * (y as f32 + 0.5) / SIZE[1] as f32);
        let value = radiance(up);
        vec![[value, value, value, 1.0e30]; SIZE[0] as usize]
    };
    let picture = (0..SIZE[1]).flat_map(row).collect();
    let mut capture: Vec<[f32; 4]> = Vec::new();
    let mut size = 64u32;
    loop {
        for k in 0..size * size {
            let at = [k % size, k / size].map(|c| 2.0 * (c as f32 + 0.5) / size as f32 - 1.0);
            let [_, y, _] = downpour_math::packing::packing_octahedral_decode(at);
            let value = radiance(y);
            capture.push([value, value, value, 1.0e30]);
        }
        if size == 1 {
            break;
        }
        size /= 2;
    }
    [picture, capture]
}

/// One round drop in the middle of the pane, in all bins.
fn with_drop(glass: &mut GlassPicture, radius: f32) {
    let [width, height] = glass.frame.size;
    glass.drops = vec![drop([0.5 * width, 0.5 * height], radius)];
    let bins = (glass.frame.columns * glass.frame.rows) as usize;
    glass.bins = (0..=bins).map(|k| (bins + 1 + k) as u32).chain(std::iter::repeat_n(0, bins)).collect();
}

fn drop(center: [f32; 2], radius: f32) -> GlassPictureDrop {
    GlassPictureDrop {
        center,
        radius,
        sphere: radius * 1.4,
        along: [0.0, 1.0],
        behind: 1.0,
        droop: [0.0, 1.0],
        ..GlassPictureDrop::default()
    }
}

/// Light let through and light reflected add up to all that comes: before even light, whatever is on the glass vanishes.
#[test]
fn in_even_light_a_wet_pane_vanishes() -> Outcome {
    for keys in [
        "interior_ambient = 1\nbefore_s = 4\naperture_mm = 6\nfocus = 'glass'",
        "interior_ambient = 1\nbefore_s = 4\naperture_mm = 6",
        "interior_ambient = 1\nbefore_s = 3\naperture_mm = 0\ntilt_deg = 30\nspeed_m_s = 15\nadvancing_deg = 110\nreceding_deg = 60",
        "interior_ambient = 1\nbefore_s = 3\nfresnel = 'tatarchuk-2006'",
    ] {
        let glass = picture(keys)?;
        assert!(glass.drops.len() > 50, "{keys}: {} drops", glass.drops.len());
        let [behind, capture] = round(&glass, |_| 2.0);
        for (k, [r, g, b]) in glass.through(&behind, &capture).into_iter().enumerate() {
            assert!((r - 2.0).abs() < 2.0e-4 && r == g && g == b, "{keys}: pixel {k} is {r}");
        }
    }
    Ok(())
}

/// Dry glass lets (1 - R) / (1 + R) through, and moves nothing.
#[test]
fn a_dry_pane_dims_and_moves_nothing() -> Outcome {
    let glass = picture("interior_ambient = 0\nbefore_s = 0\naperture_mm = 0\nspeed_m_s = 0")?;
    let [mut behind, capture] = round(&glass, |_| 1.0);
    for (k, pixel) in behind.iter_mut().enumerate() {
        *pixel = [(k * 7919 % 101) as f32, 1.0, 0.0, 20.0];
    }
    let reflected = 0.26f32 * 0.26 / (2.52 * 2.52) * 4.0;
    let through = (1.0 - reflected) / (1.0 + reflected);
    for (k, seen) in glass.through(&behind, &capture).into_iter().enumerate() {
        let wanted = behind[k][0] * through;
        assert!((seen[0] - wanted).abs() < 0.02 + 4.0e-3 * wanted, "pixel {k}: {} not {wanted}", seen[0]);
    }
    Ok(())
}

/// The sky stands below the ground in a drop; around it, it stands above.
#[test]
fn a_drop_shows_the_far_scene_upside_down() -> Outcome {
    let mut glass = picture("interior_ambient = 0\nbefore_s = 0\naperture_mm = 0\nspeed_m_s = 0")?;
    // 24 pixels across.
    let radius = 0.19 * 0.5 * glass.frame.size[1];
    with_drop(&mut glass, radius);
    let [behind, capture] = round(&glass, |up| if up > 0.0 { 1.0 } else { 0.0 });
    let seen = glass.through(&behind, &capture);
    let at = |x: u32, y: u32| seen[(y * SIZE[0] + x) as usize][0];
    let mut compared = 0;
    for off in 2..5 {
        for x in 46..50 {
            assert!(at(x, 31 - off) < 0.05, "above the middle, {off} pixels: {}", at(x, 31 - off));
            assert!(at(x, 32 + off) > 0.8, "below the middle, {off} pixels: {}", at(x, 32 + off));
            compared += 1;
        }
    }
    assert_eq!(compared, 12);
    assert!(at(10, 20) > 0.8 && at(10, 45) < 0.05, "beside the drop");
    Ok(())
}

/// The cap is that of a sphere, and a ray leaves it where it meets the sphere.
#[test]
fn a_round_drop_is_a_cap_of_a_sphere() {
    let drop = drop([0.01, 0.02], 2.0e-3);
    let base = (2.8e-3f32.powf_2() - 2.0e-3f32.powf_2()).sqrt();
    for k in 0..200u32 {
        let angle = k as f32 * 2.4;
        let r = 1.9e-3 * (k as f32 / 200.0);
        let off = Vec2::new(downpour_math::ops::cos(angle), downpour_math::ops::sin(angle)) * r;
        let position = Vec2::from(drop.center) + off;
        let cap = glass_picture_water_cap(&drop, position);
        let height = (2.8e-3f32.powf_2() - r * r).sqrt() - base;
        assert!((cap.x - height).abs() < 2.0e-8, "{k}: {} {height}", cap.x);
        let normal = glass_picture_water_normal(Vec2::new(cap.y, cap.z));
        let radial = (off / 2.8e-3).extend((height + base) / 2.8e-3);
        assert!((normal - radial).length() < 1.0e-4, "{k}: {normal} {radial}");
        // A slanted ray, against the quadratic.
        let aside = Vec2::new(0.6, -0.3);
        let z = glass_picture_water_leave(&drop, position, aside);
        let on = off + aside * z;
        let miss = (on.length_squared() + (z + base) * (z + base)).sqrt() - 2.8e-3;
        assert!(miss.abs() < 3.0e-6, "{k}: {miss} off the sphere");
        assert!(z <= glass_picture_water_top(&drop));
    }
}

trait Squared {
    fn powf_2(self) -> f32;
}

impl Squared for f32 {
    fn powf_2(self) -> f32 {
        self * self
    }
}

/// Slopes are those of the height, for a drop with all that it may have.
#[test]
fn slopes_are_those_of_the_height() {
    let odd = GlassPictureDrop {
        along: [0.6, 0.8],
        behind: 0.6,
        lean: 0.5,
        droop: [-0.28, 0.96],
        lobes: [0.1, -0.2, 0.15, 0.1],
        ..drop([0.0, 0.0], 2.0e-3)
    };
    let step = 2.0e-5;
    for k in 0..400u32 {
        let position = Vec2::new((k % 20) as f32 - 9.7, (k / 20) as f32 - 9.6) * 1.4e-4;
        let cap = glass_picture_water_cap(&odd, position);
        let slope = |x, y| {
            let by = Vec2::new(x, y) * step;
            (glass_picture_water_cap(&odd, position + by).x - glass_picture_water_cap(&odd, position - by).x)
                / (2.0 * step)
        };
        let off = Vec2::new(slope(1.0, 0.0) - cap.y, slope(0.0, 1.0) - cap.z).length();
        assert!(off < 0.02, "{k} at {position}: {off}");
    }
}

/// A lens redistributes light and loses none: the mean of a picture that extends beyond its edge stays.
#[test]
fn blur_keeps_the_light() -> Outcome {
    let sharp = picture("interior_ambient = 0\nbefore_s = 0\naperture_mm = 0\nspeed_m_s = 0")?;
    let blurred =
        picture("interior_ambient = 0\nbefore_s = 0\naperture_mm = 20\nfocus = 'glass'\nspeed_m_s = 0")?;
    let light = |glass: &GlassPicture| -> (f64, f32) {
        let [mut behind, capture] = round(glass, |_| 0.0);
        // A lamp of 4 x 4 pixels in the middle of darkness.
        for (x, y) in (0..16).map(|k| (46 + k % 4, 30 + k / 4)) {
            behind[y * SIZE[0] as usize + x] = [100.0, 100.0, 100.0, 50.0];
        }
        let seen = glass.through(&behind, &capture);
        (seen.iter().map(|p| f64::from(p[0])).sum(), seen.iter().fold(0.0, |most, p| p[0].max(most)))
    };
    let ((sum, peak), (blurred_sum, blurred_peak)) = (light(&sharp), light(&blurred));
    assert!((blurred_sum / sum - 1.0).abs() < 0.03, "{blurred_sum} {sum}");
    assert!(blurred_peak < 0.6 * peak, "{blurred_peak} {peak}");
    Ok(())
}

/// Light of the image of a paraboloid source of integral 1 through a drop, as the sum over rings of the picture: a ray at
/// an angle from the drop's axis meets glass and sphere, in a plane.
fn shown(spread: f64, pane: f64, radius: f64) -> f64 {
    let (sphere, index) = (1.4 * radius, 1.333);
    let step = 1.0e-5;
    let ring = |k: u32| {
        let angle = (f64::from(k) + 0.5) * step;
        let position = pane * ops::sin(angle) / ops::cos(angle);
        let inside = ops::asin(ops::sin(angle) / index);
        let mut x = position;
        for _ in 0..20 {
            let height = (sphere * sphere - x * x).sqrt() - (sphere * sphere - radius * radius).sqrt();
            x = position + ops::sin(inside) / ops::cos(inside) * height;
        }
        let normal = ops::asin(x / sphere);
        let out = normal - ops::asin(index * ops::sin(normal - inside));
        let fraction = (1.0 - out * out / (spread * spread)).max(0.0);
        fraction * 2.0 / (std::f64::consts::PI * spread * spread) * std::f64::consts::TAU * angle * step
    };
    (0..6000).map(ring).sum()
}

/// A drop is a lens: all the light of a lamp that it shows is the irradiance that its image takes, whatever the resolution.
#[test]
fn a_drop_shows_a_lamp_as_bright_as_it_is() -> Outcome {
    let mut glass = picture("interior_ambient = 0\nbefore_s = 0\naperture_mm = 0\nspeed_m_s = 0")?;
    let [behind, capture] = round(&glass, |_| 0.0);
    let frame = &glass.frame;
    let ahead = frame.camera.forward;
    let pane = ahead.dot(glam::Vec3::from(frame.corner)) / ahead.dot(ahead).sqrt();
    let radius = 0.4 * frame.size[1];
    let pixel = frame.camera.pixel_angle;
    with_drop(&mut glass, radius);
    let dark = glass.through(&behind, &capture);
    assert!(dark.iter().all(|p| p[0] == 0.0), "a lamp where there is none");
    // Far away, straight ahead, with an irradiance of 5.
    let mut light = |half_angle: f32, least: f32| -> (f32, usize) {
        glass.lights = vec![GlassPictureLight {
            position: (ahead * 1.0e5).to_array(),
            radius: half_angle,
            color: [5.0; 3],
            distance: 1.0e5,
        }];
        glass.frame.lights = 1;
        glass.frame.lit_from = least;
        let seen = glass.through(&behind, &capture);
        let lit = seen.iter().filter(|p| p[0] > 0.0).count();
        (seen.iter().map(|p| p[0] * pixel * pixel).sum(), lit)
    };
    let reflected = 1.0 - 0.04 - 0.02;
    for half_angle in [0.0, 0.03] {
        let (sum, lit) = light(half_angle, 0.0);
        // Spread over one and a half of what samples a half pixel apart see, as they are turned apart in the middle.
        let apart = 0.5 * pixel * (1.0 + pane * (1.333 - 1.0) / (1.4 * radius));
        let spread = (half_angle * half_angle + 2.25 * apart * apart).sqrt();
        let law = 5.0 * reflected * shown(f64::from(spread), f64::from(pane), f64::from(radius)) as f32;
        println!("{half_angle}: {sum}, law {law}, {lit} pixels");
        assert!((sum / law - 1.0).abs() < 0.02, "{half_angle}: {sum}, law {law}, {lit} pixels");
    }
    assert_eq!(light(0.0, 1.1 * radius), (0.0, 0), "a drop below the threshold shows it");
    Ok(())
}

#[test]
fn time_may_be_divided_as_one_likes() -> Outcome {
    let keys = "before_s = 2\nspeed_m_s = [[-2, 0], [0, 8], [1, 3]]\nsize_m = [0.1, 0.08]\n[[glass.wiper]]\npivot_m = [0.05, \
                0.09]\nlength_m = 0.08\nfrom_deg = 20\nto_deg = 160\nperiod_s = 1.3\n";
    let (weather, frame_scene) = frame_scene(keys)?;
    let ends = |times: &[f64]| -> Result<Vec<u32>, Box<dyn std::error::Error>> {
        let mut pane = WetPane::new(&weather, &frame_scene.viewpoint, 0.0)?.ok_or("no pane")?;
        for &time in times {
            pane.advance(time)?;
        }
        let PaneLattice::Cpu(glass) = pane.lattice() else { panic!("a pane on a GPU") };
        assert!(glass.is_sound());
        Ok(pane.state()?.mass.clone())
    };
    let whole = ends(&[1.0])?;
    assert!(whole.iter().filter(|&&mass| mass > 0).count() > 20);
    assert_eq!(ends(&[-1.7, 0.0, 0.033, 0.41, 0.41, 1.0])?, whole);
    assert_ne!(ends(&[0.9])?, whole);
    Ok(())
}

#[test]
fn a_pane_that_is_not_before_the_eye_is_refused() -> Outcome {
    let (weather, _) = frame_scene("tilt_deg = 20")?;
    let text = "[camera]\nposition_m = [0, 2, 0]\npitch_deg = -30\n";
    let looks_down = Weather::parse("w.toml", text)?;
    let loaded = Loaded {
        scene: Scene::default(),
        animations: Vec::new(),
        moving: Vec::new(),
        sky: SkyMap::uniform([1.0; 3]),
        sun: None,
        unscaled: None,
        masks: Vec::new(),
        drop_model: None,
        warnings: Vec::new(),
    };
    let down = FrameScene::new(&looks_down, &loaded, 0.0)?;
    let error = WetPane::new(&weather, &down.viewpoint, 0.0).err().ok_or("a pane from outside")?;
    assert!(error.to_string().starts_with("glass: a pane tilted by 20.0 degrees"), "{error}");
    Ok(())
}

/// A sill between the eye and the pane, under a lamp outside, is lit through it: on the whole by what glass lets through, with the
/// shadows of the drops. With nothing on the eye's side no pane is hung.
#[test]
fn lamps_throw_the_shadows_of_drops_on_a_sill() -> Outcome {
    let glass = "distance_m = 0.5\nsize_m = [0.4, 0.3]\ncell_mm = 1.0\nbefore_s = 20";
    let (weather, mut frame_scene) = frame_scene(glass)?;
    let mut pane = WetPane::new(&weather, &frame_scene.viewpoint, 0.0)?.ok_or("no pane")?;
    pane.advance(0.0)?;
    assert!(!is_lit_through(&pane, &frame_scene), "there is nothing that could be lit");
    let mut builder = SceneBuilder::new();
    let white = builder.add_material(MaterialLook::default());
    let positions = [[-0.1, 1.36, -0.49], [0.1, 1.36, -0.49], [0.1, 1.36, -0.3], [-0.1, 1.36, -0.3]];
    let part = MeshPart::plain(&positions, &[0, 2, 1, 0, 3, 2], white);
    builder.add_mesh(&part, &Affine3A::IDENTITY);
    let lamp = Vec3::new(0.0, 1.5, -1.5);
    builder.add_light(LightSource::Point {
        radius: 0.0,
        position: lamp,
        intensity: Vec3::splat(100.0),
        range: 0.0,
    });
    frame_scene.data = builder.build(&SkyLight::uniform([0.0; 3]));
    assert!(is_lit_through(&pane, &frame_scene));
    // Straight down on the middle of the sill.
    let above =
        Viewpoint { eye: Vec3::new(0.0, 2.36, -0.42), forward: Vec3::NEG_Y, up: Vec3::NEG_Z, fov_y: 0.1 };
    let lit = |data: &SceneData| -> Result<Vec<f32>, Box<dyn std::error::Error>> {
        let frame = RenderFrame::new(data, &above, [96, 96], 1, 0, 0)?;
        Ok(SceneView { data, frame: &frame }.picture().iter().map(|pixel| pixel[0]).collect())
    };
    let open = lit(&frame_scene.data)?;
    set_pane(&pane, &mut frame_scene)?;
    let through = lit(&frame_scene.data)?;
    let fractions: Vec<f32> = through.iter().zip(&open).map(|(a, b)| a / b).collect();
    let mean = fractions.iter().sum::<f32>() / fractions.len() as f32;
    assert!((0.85..0.97).contains(&mean), "{mean}");
    let dark =
        fractions.iter().filter(|&&fraction| fraction < 0.5 * mean).count() as f32 / fractions.len() as f32;
    assert!((0.01..0.5).contains(&dark), "{dark} of the sill is in shadow");
    // The same again takes the place of the first.
    let rows = frame_scene.data.table.len();
    set_pane(&pane, &mut frame_scene)?;
    assert_eq!(frame_scene.data.table.len(), rows);
    Ok(())
}

/// Water in bands of 3 cm from the top of what is seen of a pane, m^3: caps of spheres.
fn bands(above_m: f64, seeds: u32) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let mut sums = vec![0.0; 8];
    for seed in 0..seeds {
        let glass = picture(&format!(
            "size_m = [0.12, 0.24]\ncell_mm = 1.5\nbefore_s = 60\nspeed_m_s = 4\nabove_m = {above_m}\nseed = {seed}"
        ))?;
        for drop in &glass.drops {
            let (r, sphere) = (f64::from(drop.radius), f64::from(drop.sphere));
            let height = sphere - (sphere * sphere - r * r).max(0.0).sqrt();
            let volume = std::f64::consts::PI * height * height * (sphere - height / 3.0);
            let band = (f64::from(drop.center[1]) / 0.03).floor();
            if (0.0..8.0).contains(&band) {
                sums[band as usize] += volume;
            }
        }
    }
    Ok(sums)
}

/// Drops run into what is seen of a pane from above it: its upper edge is not where they gather.
#[test]
fn a_pane_holds_as_much_water_at_the_top_of_the_picture_as_below() -> Outcome {
    let with_edge = bands(0.0, 3)?;
    let lower: f64 = with_edge[1..].iter().sum::<f64>() / 7.0;
    assert!(with_edge[0] > 1.3 * lower, "the edge of the glass: {with_edge:?}");
    let inflow = bands(0.15, 2)?;
    let mean: f64 = inflow.iter().sum::<f64>() / 8.0;
    assert!((0.4..1.4).contains(&(inflow[0] / mean)), "{inflow:?}");
    let halves: f64 = inflow[..4].iter().sum::<f64>() / inflow[4..].iter().sum::<f64>();
    assert!((0.65..1.5).contains(&halves), "{inflow:?}");
    Ok(())
}

/// Temperature and pressure of a weather reach the water of its pane and the frequencies of its drops.
#[test]
fn the_air_of_a_weather_reaches_pane_and_oscillation() -> Outcome {
    use downpour_render::rain::{Exposure, EyeMotion};
    let weather = Weather::parse(
        "w.toml",
        "[rain]\ntemperature_c = 5\npressure_hpa = 700\n[glass]\nsize_m = [0.1, 0.1]",
    )?;
    let pane = weather.glass.clone().ok_or("no pane")?;
    let options = pane.options([0.1, 0.1], &weather.rain, 0.0);
    assert_eq!(options.temperature_c, 5.0);
    assert_eq!(options.rain.air.pressure_pa(), 7.0e4);
    let exposure = Exposure::of_weather(&weather, EyeMotion::default(), 0.0);
    // Surface tension and density of water at 5 C (IAPWS).
    assert!((exposure.fluids.surface_tension - 0.074942).abs() < 1.0e-5);
    assert!((exposure.fluids.water_density - 999.964).abs() < 0.02);
    Ok(())
}

/// Before light of 1 and a dark room a blade is opaque at its angle: what is on its line is dark, what is beside it is as bright as
/// without it; a wiper that is not drawn changes nothing.
#[test]
fn a_blade_is_opaque_where_it_stands_and_nowhere_else() -> Outcome {
    let wiper = |angle: f64, more: &str| {
        format!(
            "interior_ambient = 0\naperture_mm = 0\nbefore_s = 0\nspeed_m_s = 0\nsize_m = [0.2, 0.14]\n[[glass.wiper]]\npivot_m = [0.1, \
             0.16]\nlength_m = 0.12\ninner_m = 0.03\nangle_deg = {angle}\n{more}"
        )
    };
    let bare = picture(&wiper(90.0, "is_drawn = false"))?;
    assert_eq!(bare.frame.blade_count, 0);
    let [behind, capture] = round(&bare, |_| 1.0);
    let clear = bare.through(&behind, &capture);
    for degrees in [90.0f64, 60.0, 120.0] {
        let glass = picture(&wiper(degrees, ""))?;
        let seen = glass.through(&behind, &capture);
        let (mut on, mut beside) = (0, 0);
        for (k, (seen, clear)) in seen.iter().zip(&clear).enumerate() {
            let (x, y) = (k % 96, k / 96);
            // Meters from the middle of the pane, which the picture's middle shows at 0.5 m; 7 degrees are 32 pixels.
            let per_pixel = 0.5 * ops::tan(7f64.to_radians()) / 32.0;
            let (right, up) = ((x as f64 + 0.5 - 48.0) * per_pixel, (32.0 - y as f64 - 0.5) * per_pixel);
            let (right, up) = (right, up + 0.09);
            let (sin, cos) = (ops::sin(degrees.to_radians()), ops::cos(degrees.to_radians()));
            let (along, aside) = (right * cos + up * sin, (up * cos - right * sin).abs());
            if (0.035..0.115).contains(&along) && aside < 0.003 {
                assert!(seen[0] < 0.1 && seen[0] > 0.0, "{degrees}: {x}, {y}: {}", seen[0]);
                on += 1;
            } else if along > 0.125 || aside > 0.0085 {
                assert_eq!(seen, clear, "{degrees}: {x}, {y}");
                beside += 1;
            }
        }
        assert!(on > 50 && beside > 2000, "{degrees}: {on} on it, {beside} beside it");
    }
    Ok(())
}

/// A window in a wind of 8 m/s gets the same water, to the bit, as one whose key says 8 m/s; in a wind from behind none.
#[test]
fn a_wind_drives_rain_against_a_window() -> Outcome {
    let water = |keys: &str| -> Result<Vec<u32>, Box<dyn std::error::Error>> {
        let (weather, frame_scene) = frame_scene(&format!("before_s = 2\nsize_m = [0.1, 0.1]\n{keys}"))?;
        let mut pane = WetPane::new(&weather, &frame_scene.viewpoint, 0.0)?.ok_or("no pane")?;
        pane.advance(0.0)?;
        Ok(pane.state()?.mass.clone())
    };
    let wind = |z: i32| water(&format!("[[wind]]\nuniform = {{ speed_m_s = 8, direction = [0, 0, {z}] }}\n"));
    let driven = wind(1)?;
    assert!(driven.iter().filter(|mass| **mass > 0).count() > 20);
    assert_eq!(driven, water("speed_m_s = 8")?);
    assert!(wind(-1)?.iter().all(|mass| *mass == 0));
    Ok(())
}

/// Before a key the pane is dry; once the rate is that of a rain without keys, drops are as many.
#[test]
fn a_rate_that_changes_wets_a_pane_when_it_rains() -> Outcome {
    let water = |rate: &str, time_s: f64| -> Result<u64, Box<dyn std::error::Error>> {
        let (weather, frame_scene) = frame_scene("before_s = 0\nsize_m = [0.1, 0.1]\nspeed_m_s = 8")?;
        let keyed = Weather::parse(
            "w.toml",
            &format!(
                "[rain]\nrate_mm_h = {rate}\n[camera]\nposition_m = [0, 1.5, 0]\nfov_deg = 14\n[output]\nsize = [96, 64]\n[glass]\nbefore_s = 0\nsize_m = [0.1, 0.1]\nspeed_m_s = 8"
            ),
        )?;
        assert_eq!(weather.glass, keyed.glass);
        let mut pane = WetPane::new(&keyed, &frame_scene.viewpoint, 0.0)?.ok_or("no pane")?;
        pane.advance(time_s)?;
        Ok(pane.state()?.mass.iter().map(|&mass| u64::from(mass)).sum())
    };
    let keys = "[[0, 0], [2, 0], [2.001, 100], [9, 100]]";
    assert_eq!(water(keys, 1.9)?, 0);
    let (late, plain) = (water(keys, 4.0)?, water("100", 2.0)?);
    assert!((late as f64 / plain as f64 - 1.0).abs() < 0.1, "{late}, not {plain}");
    Ok(())
}
