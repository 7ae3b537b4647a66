//! Streaks that are summed up are those that are laid one over the other: a picture of many drops, each of which is drawn alone as well.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_render::camera::Viewpoint;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::{DropMasks, Exposure, RainOptions};
use downpour_sim::field::{FallingDrop, RainField};
use downpour_sim::view::View;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::material::MaterialLook;
use downpour_trace::picture::render_picture;
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, Vec3};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

const SIZE: [u32; 2] = [24, 32];
const HALF: f64 = 0.3;
const SHUTTER_S: f64 = 1.0 / 60.0;

/// A dark wall, a bright floor and a sky: what drops show differs from place to place.
fn yard() -> SceneData {
    let mut builder = SceneBuilder::new();
    let of = |color| MaterialLook { base_color: [color, color, color, 1.0], ..MaterialLook::default() };
    let (wall, floor) = (builder.add_material(of(0.02)), builder.add_material(of(0.9)));
    let mut square = |at: [[f32; 3]; 4], material| {
        builder.add_mesh(&MeshPart::plain(&at, &[0, 1, 2, 0, 2, 3], material), &Affine3A::IDENTITY);
    };
    let back = [[-9.0, -1.0, -6.0], [9.0, -1.0, -6.0], [9.0, 5.0, -6.0], [-9.0, 5.0, -6.0]];
    let ground = [[-9.0, -1.0, 6.0], [9.0, -1.0, 6.0], [9.0, -1.0, -6.0], [-9.0, -1.0, -6.0]];
    square(back, wall);
    square(ground, floor);
    builder.build(&SkyLight::uniform([1.0; 3]))
}

/// The drops before the eye that take out the most light.
fn drops(many: usize) -> Outcome<Vec<FallingDrop>> {
    let law = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 500.0)?;
    let seen = View {
        half_width: HALF,
        half_height: HALF * f64::from(SIZE[1]) / f64::from(SIZE[0]),
        pixel_angle: 2.0 * HALF / f64::from(SIZE[0]),
        least_pixels: 0.1,
        shutter_s: SHUTTER_S,
        ..View::default()
    };
    let mut drops = RainField::new(&law, 5)?.visible(&seen, 1.0)?.drops;
    let slope = |drop: &FallingDrop| f64::from(drop.diameter) / drop.position.length();
    drops.sort_by(|a, b| slope(b).total_cmp(&slope(a)));
    drops.truncate(many);
    Ok(drops)
}

fn masks() -> &'static DropMasks {
    static MASKS: std::sync::OnceLock<DropMasks> = std::sync::OnceLock::new();
    MASKS.get_or_init(|| DropMasks::trace(1.333).expect("masks"))
}

fn shown(scene: &SceneData, drops: &[FallingDrop]) -> Outcome<Picture> {
    let view = Viewpoint {
        eye: Vec3::ZERO,
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 2.0 * downpour_math::ops::f64::atan(HALF * f64::from(SIZE[1]) / f64::from(SIZE[0])) as f32,
    };
    let exposure = Exposure { shutter_s: SHUTTER_S, time_s: 1.0, seed: 3, ..Exposure::default() };
    let rain = RainOptions { capture_size: 32, exposure, ..RainOptions::default() };
    let options = PictureOptions { size: SIZE, grid: 1, sky_rays: 1, rain, ..PictureOptions::default() };
    Ok(render_picture(scene, &view, drops, masks(), &options)?)
}

#[test]
fn sums_are_streaks_one_over_the_other() -> Outcome {
    let scene = yard();
    let mut drops = drops(100)?;
    assert!(drops.len() == 100, "{}", drops.len());
    let all = shown(&scene, &drops)?.rain;
    // The farthest first: each over those before it.
    drops.sort_by(|a, b| b.position.length().total_cmp(&a.position.length()));
    let mut laid = vec![[0.0f64, 0.0, 0.0, 1.0]; all.len()];
    for drop in &drops {
        let alone = shown(&scene, std::slice::from_ref(drop))?.rain;
        for (laid, over) in laid.iter_mut().zip(&alone) {
            let over = over.map(f64::from);
            *laid = [0, 1, 2, 3].map(|k| if k < 3 { over[k] + over[3] * laid[k] } else { over[3] * laid[3] });
        }
    }
    let covered = laid.iter().filter(|pixel| pixel[3] < 0.99).count();
    assert!(covered > all.len() / 8, "{covered} of {} pixels", all.len());
    let [mut light, mut apart] = [0.0f64; 2];
    for (laid, all) in laid.iter().zip(&all) {
        // 16 bits of coverage, and drops that are not summed up.
        assert!((laid[3] - f64::from(all[3])).abs() < 4.0e-5, "{laid:?} {all:?}");
        for k in 0..3 {
            let off = (laid[k] - f64::from(all[k])).abs();
            // Two streaks of other radiances that cover a twentieth each differ by a four hundredth where they cross.
            assert!(off < 2.5e-3, "{laid:?} {all:?}");
            light += laid[k];
            apart += laid[k] - f64::from(all[k]);
        }
    }
    assert!((apart / light).abs() < 1.0e-3, "{apart} of {light}");
    Ok(())
}
