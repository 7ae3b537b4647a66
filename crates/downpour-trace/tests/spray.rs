//! Spray over what rain hits, held against integrals in closed form: level ground, the top of a wall, shelter, even light.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::spray::Spray;
use downpour_math::ops::f64 as ops;
use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::{DropMasks, MediumOptions, RainMedium, RainOptions};
use downpour_shaders::render::scene::SCENE_UNLIT;
use downpour_sim::resolved::{Region, Resolved};
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::material::MaterialLook;
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, Vec3};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// Thick enough that it is seen by the square of a pixel's digits, not so thick that nothing comes through.
const SPRAY: Spray = Spray { extinction: 0.2, height_m: 0.05 };

const EYE_M: f64 = 1.6;

fn masks() -> &'static DropMasks {
    static MASKS: std::sync::OnceLock<DropMasks> = std::sync::OnceLock::new();
    MASKS.get_or_init(|| DropMasks::trace(1.333).expect("masks"))
}

/// Boxes between two corners each, which shine as much as the sky, and a lamp.
fn scene(boxes: &[[Vec3; 2]], sky: f32, lamp: Option<LightSource>) -> SceneData {
    let mut builder = SceneBuilder::new();
    let look =
        MaterialLook { flags: SCENE_UNLIT, base_color: [sky, sky, sky, 1.0], ..MaterialLook::default() };
    let material = builder.add_material(look);
    for [low, high] in boxes {
        let corner = |k: usize| {
            let of = |bit: usize, axis: usize| if k >> bit & 1 == 1 { high[axis] } else { low[axis] };
            [of(0, 0), of(1, 1), of(2, 2)]
        };
        let corners: Vec<[f32; 3]> = (0..8).map(corner).collect();
        let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let indices: Vec<u32> = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
        builder.add_mesh(&MeshPart::plain(&corners, &indices, material), &Affine3A::IDENTITY);
    }
    if let Some(lamp) = lamp {
        builder.add_light(lamp);
    }
    builder.build(&SkyLight::uniform([sky; 3]))
}

/// Ground of 1 km, whose top is at 0.
fn ground() -> [Vec3; 2] {
    [Vec3::new(-500.0, -1.0, -500.0), Vec3::new(500.0, 0.0, 500.0)]
}

/// A little unresolved rain of a mean velocity, m/s.
fn medium(velocity: Vec3) -> Outcome<RainMedium> {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 2.0)?;
    let resolved = Resolved {
        near: 0.05,
        far: 50.0,
        pixel_angle: 0.01,
        least_pixels: 100.0,
        min_diameter: 8.0e-3,
        region: Region::Everywhere,
    };
    let options = MediumOptions { velocity, ..MediumOptions::default() };
    Ok(RainMedium::new(&rain, &resolved, masks(), &options)?)
}

/// Camera, and columns and rows of its picture.
#[derive(Clone, Copy)]
struct Shot {
    eye: Vec3,
    forward: Vec3,
    fov_y: f32,
    size: [u32; 2],
}

impl Shot {
    fn picture(&self, scene: &SceneData, velocity: Vec3, spray: Option<Spray>) -> Outcome<Picture> {
        let rain =
            RainOptions { medium: medium(velocity)?, spray, capture_size: 64, ..RainOptions::default() };
        let options =
            PictureOptions { size: self.size, grid: 1, sky_rays: 0, rain, ..PictureOptions::default() };
        let view = Viewpoint { eye: self.eye, forward: self.forward, up: Vec3::Y, fov_y: self.fov_y };
        Ok(render_picture(scene, &view, &[], masks(), &options)?)
    }

    /// Optical depth of the spray before each pixel.
    fn depths(&self, scene: &SceneData, velocity: Vec3, spray: Spray) -> Outcome<Vec<f64>> {
        let [with, without] = [Some(spray), None].map(|spray| self.picture(scene, velocity, spray));
        let (with, without) = (with?, without?);
        let both = with.rain.iter().zip(&without.rain);
        Ok(both.map(|(with, without)| -ops::ln(f64::from(with[3]) / f64::from(without[3]))).collect())
    }

    /// Angle of the middle of a row above the middle of the picture, radians.
    fn angle(&self, row: u32) -> f64 {
        let up = 1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(self.size[1]);
        ops::atan(up * ops::tan(0.5 * f64::from(self.fov_y)))
    }
}

const DOWN: Vec3 = Vec3::new(0.0, -6.0, 0.0);

/// Over level ground: the extinction times the height, over the sine of the ray's slope; none before the sky above.
#[test]
fn level_ground_has_the_depth_of_its_column() -> Outcome {
    let shot =
        Shot { eye: Vec3::new(3.3, EYE_M as f32, 7.1), forward: Vec3::NEG_Z, fov_y: 0.8, size: [3, 160] };
    let depths = shot.depths(&scene(&[ground()], 1.0, None), DOWN, SPRAY)?;
    let mut distances = Vec::new();
    for row in 0..shot.size[1] {
        let (found, angle) = (depths[(3 * row + 1) as usize], shot.angle(row));
        if angle >= 0.0 {
            assert_eq!(found, 0.0, "{row}");
            continue;
        }
        let distance = EYE_M / ops::sin(-angle);
        // Beyond it the map ends.
        if distance < 190.0 {
            let expected = SPRAY.extinction * SPRAY.height_m / ops::sin(-angle);
            assert!((found / expected - 1.0).abs() < 0.01, "{distance} m: {found}, not {expected}");
            distances.push(distance);
        }
    }
    assert!(distances[0] > 100.0 && distances.len() > 70, "{distances:?}");
    Ok(())
}

/// Over the top of a wall: the profile of the law at any distance, so that its height on the picture is inverse to the distance. The same at
/// several fields of view and sizes.
#[test]
fn a_halo_has_the_same_height_at_any_distance() -> Outcome {
    for distance in [2.0f32, 5.0, 12.0, 40.0] {
        let (top, thick) = (1.5, 1.0);
        let wall = [Vec3::new(-30.0, 0.0, -distance - thick), Vec3::new(30.0, top, -distance)];
        let scene = scene(&[ground(), wall], 1.0, None);
        for rows in [61, 241] {
            // 40 cm of the wall's plane.
            let shot = Shot {
                eye: Vec3::new(0.7, top, 0.4),
                forward: Vec3::NEG_Z,
                fov_y: 2.0 * ops::atan(0.2 / f64::from(distance + 0.4)) as f32,
                size: [5, rows],
            };
            let depths = shot.depths(&scene, DOWN, SPRAY)?;
            let mut heights = Vec::new();
            for row in 0..rows {
                let slope = ops::tan(shot.angle(row));
                let [near, far] = [0.4 + distance, 0.4 + distance + thick].map(f64::from);
                // The integral of exp(-slope t / h) from the wall's front to its back.
                let rate = slope / SPRAY.height_m;
                if slope > 0.0 && near * slope < 0.15 {
                    let mean = (ops::exp(-rate * near) - ops::exp(-rate * far)) / rate;
                    let expected = SPRAY.extinction * mean * (1.0 + slope * slope).sqrt();
                    let found = depths[(5 * row + 2) as usize];
                    // The wall begins and ends between texels.
                    let texel = 0.025 * ops::pow(2.0, ops::log2((far / 6.35).max(1.0)).ceil());
                    let error = (found / expected - 1.0).abs();
                    assert!(error < 0.05 + texel, "{distance} m, {rows}: {found}, not {expected}");
                    heights.push((near * slope, found, expected));
                }
            }
            // Half of it is left at 0.69 of the height, at any distance.
            let foot = heights.iter().min_by(|a, b| a.0.total_cmp(&b.0)).ok_or("no heights")?;
            for (height, found, expected) in &heights {
                let shape = (found / foot.1) / (expected / foot.2);
                assert!((shape - 1.0).abs() < 0.1, "{distance} m, {rows}: {shape} at {height} m");
            }
        }
    }
    Ok(())
}

/// No spray on what a roof keeps dry, and in a wind none in the lee of a wall; the edge is sharp.
#[test]
fn nothing_sprays_where_no_rain_falls() -> Outcome {
    // A roof over 6 m x 6 m of ground that is seen from above beside it.
    let roof = [Vec3::new(-3.0, 3.0, -9.0), Vec3::new(3.0, 3.1, -3.0)];
    let shot = Shot {
        eye: Vec3::new(0.0, 1.0, 0.0),
        forward: Vec3::new(0.0, -0.15, -1.0),
        fov_y: 0.5,
        size: [3, 200],
    };
    let depths = shot.depths(&scene(&[ground(), roof], 1.0, None), DOWN, SPRAY)?;
    let middle = 0.15f64;
    let mut counts = [0; 2];
    for row in 0..shot.size[1] {
        let down = ops::atan(middle) - shot.angle(row);
        let hit = 1.0 / ops::tan(down);
        let found = depths[(3 * row + 1) as usize];
        if (3.3..8.9).contains(&hit) {
            // What the ray meets before the roof's edge is far above the ground.
            let before = 1.0 - 3.0 * ops::tan(down);
            let most =
                SPRAY.extinction * SPRAY.height_m / ops::sin(down) * ops::exp(-before / SPRAY.height_m);
            // Between a texel on the roof and one beside it heights run up steeply, through what is seen.
            assert!(found <= 1.1 * most + 1.5e-4, "{hit} m: {found}, at most {most}");
            counts[0] += 1;
        } else if hit > 0.0 && hit < 2.9 {
            let expected = SPRAY.extinction * SPRAY.height_m / ops::sin(down);
            assert!((found / expected - 1.0).abs() < 0.02, "{hit} m: {found}, not {expected}");
            counts[1] += 1;
        }
    }
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");

    // Rain that comes from +X at 45 degrees, behind a wall 2 m high: 2 m of dry ground, seen along it.
    let wall = [Vec3::new(0.0, 0.0, -50.0), Vec3::new(0.2, 2.0, 50.0)];
    let scene = scene(&[ground(), wall], 1.0, None);
    let wind = Vec3::new(-5.0, -5.0, 0.0);
    let seen = |x: f32| {
        let shot = Shot {
            eye: Vec3::new(x, 1.0, 0.0),
            forward: Vec3::new(0.0, -0.2, -1.0),
            fov_y: 0.02,
            size: [1, 1],
        };
        shot.depths(&scene, wind, SPRAY).map(|depths| depths[0])
    };
    let expected = SPRAY.extinction * SPRAY.height_m / (0.2 / 1.04f64.sqrt());
    // The map runs up steeply between the top of the wall and the ground behind it.
    assert!(seen(-0.5)? < 1.0e-3 && seen(-1.5)? < 1.0e-3, "{} and {}", seen(-0.5)?, seen(-1.5)?);
    for x in [-2.1, -3.0, 1.0] {
        assert!((seen(x)? / expected - 1.0).abs() < 0.03, "{x} m: {}, not {expected}", seen(x)?);
    }
    Ok(())
}

/// In even light spray cannot be seen, and its depth is as much more as its extinction is.
#[test]
fn even_light_stays_even() -> Outcome {
    let wall = [Vec3::new(-2.0, 0.0, -6.0), Vec3::new(1.0, 1.2, -5.0)];
    let scene = scene(&[ground(), wall], 1.0, None);
    let shot = Shot {
        eye: Vec3::new(0.3, 1.3, 0.0),
        forward: Vec3::new(0.0, -0.1, -1.0),
        fov_y: 0.7,
        size: [48, 32],
    };
    let picture = shot.picture(&scene, DOWN, Some(SPRAY))?;
    let most = picture.radiance().iter().flatten().fold(0.0f32, |most, light| most.max((light - 1.0).abs()));
    assert!(most < 5.0e-3, "furnace: {most}");
    let [once, twice] =
        [1.0, 2.0].map(|k| shot.depths(&scene, DOWN, Spray { extinction: k * SPRAY.extinction, ..SPRAY }));
    let (once, twice) = (once?, twice?);
    assert!(once.iter().sum::<f64>() > 100.0 * 0.01);
    for (once, twice) in once.iter().zip(&twice) {
        assert!((twice - 2.0 * once).abs() < 1.0e-4 + 3.0e-3 * once, "{once} and {twice}");
    }
    assert!(picture.clean == shot.picture(&scene, DOWN, None)?.clean);
    Ok(())
}

/// Under the sun spray gives as much light as unresolved rain that takes out as much, and none in the shade.
#[test]
fn the_sun_lights_spray_as_it_lights_rain() -> Outcome {
    let sun = |y: f32| LightSource::Directional {
        direction: Vec3::new(0.3, y, 0.4).normalize(),
        irradiance: Vec3::new(3.0, 2.0, 1.0),
    };
    let shot = Shot {
        eye: Vec3::new(0.0, 1.6, 0.0),
        forward: Vec3::new(0.1, -0.12, -1.0),
        fov_y: 0.1,
        size: [12, 8],
    };
    // A black world: all light is the sun's.
    let lit = scene(&[ground()], 0.0, Some(sun(-0.5)));
    let [with, without] = [Some(SPRAY), None].map(|spray| shot.picture(&lit, DOWN, spray));
    let (with, without) = (with?, without?);
    let ratios = with.rain.iter().zip(&without.rain).map(|(with, without)| {
        let of_rain = f64::from(without[0]) / f64::from(1.0 - without[3]);
        let share = f64::from(with[3] / without[3]);
        f64::from(with[0] - without[0]) / f64::from(without[3]) / (1.0 - share) / of_rain
    });
    // What is open to the rain is known between cells, so that some pixels are brighter by a hundredth.
    let mean = ratios.sum::<f64>() / with.rain.len() as f64;
    assert!((mean - 1.0).abs() < 0.01, "{mean}");
    // The sun is below the ground.
    let dark = shot.picture(&scene(&[ground()], 0.0, Some(sun(0.5))), DOWN, Some(SPRAY))?;
    assert!(dark.rain.iter().all(|pixel| pixel[0] < 1.0e-6), "light from below the ground");
    Ok(())
}

/// A scene without anything, and rain that comes from below, have no spray.
#[test]
fn spray_needs_something_to_hit() -> Outcome {
    let shot = Shot { eye: Vec3::Y, forward: Vec3::NEG_Z, fov_y: 0.7, size: [12, 8] };
    let empty = scene(&[], 1.0, None);
    assert!(shot.picture(&empty, DOWN, Some(SPRAY))?.rain == shot.picture(&empty, DOWN, None)?.rain);
    let full = scene(&[ground()], 1.0, None);
    let upward = -DOWN;
    assert!(shot.picture(&full, upward, Some(SPRAY))?.rain == shot.picture(&full, upward, None)?.rain);
    Ok(())
}
