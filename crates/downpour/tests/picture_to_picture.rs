//! What stays on a GPU from picture to picture: light of the rain, while nothing changes that it is found from; no drop.

#![cfg(feature = "wgpu")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod device;

use downpour::drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour::gpu::LimitSet;
use downpour::render::camera::Viewpoint;
use downpour::render::light::LightSource;
use downpour::render::picture::{Picture, PictureOptions};
use downpour::render::rain::{DropMasks, Exposure, MediumOptions, RainMedium, RainOptions};
use downpour::sim::field::RainField;
use downpour::trace::builder::{MeshPart, SceneBuilder};
use downpour::trace::data::SceneData;
use downpour::trace::frame_scene::view_of;
use downpour::trace::gpu::{PictureDrops, PictureRenderer, PictureUse};
use downpour::trace::kept::PlateUse;
use downpour::trace::sky_light::SkyLight;
use glam::{Affine3A, DVec3, Vec3};

/// A lamp over a floor with a wall behind it.
fn scene(intensity: f32) -> SceneData {
    let mut builder = SceneBuilder::new();
    let corners = [[-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [9.0, 0.0, 9.0], [-9.0, 0.0, 9.0]];
    builder.add_mesh(&MeshPart::plain(&corners, &[0, 2, 1, 0, 3, 2], 0), &Affine3A::IDENTITY);
    let wall = [[-9.0, 0.0, -4.0], [1.0, 0.0, -4.0], [1.0, 3.0, -4.0], [-9.0, 3.0, -4.0]];
    builder.add_mesh(&MeshPart::plain(&wall, &[0, 1, 2, 0, 2, 3], 0), &Affine3A::IDENTITY);
    builder.add_light(LightSource::Point {
        position: Vec3::new(0.5, 2.0, -1.0),
        radius: 0.0,
        intensity: Vec3::splat(intensity),
        range: 0.0,
    });
    builder.build(&SkyLight::uniform([0.02, 0.03, 0.05]))
}

/// All that a picture is of.
#[derive(Clone)]
struct Shown {
    scene: SceneData,
    viewpoint: Viewpoint,
    masks: DropMasks,
    rate_mm_h: f64,
    time_s: f64,
    seed: u64,
}

impl Shown {
    fn first() -> Self {
        Self {
            scene: scene(20.0),
            viewpoint: Viewpoint {
                eye: Vec3::new(0.0, 1.2, 5.0),
                forward: Vec3::NEG_Z,
                up: Vec3::Y,
                fov_y: 0.8,
            },
            masks: DropMasks::trace(1.333).unwrap(),
            rate_mm_h: 80.0,
            time_s: 1.0,
            seed: 4,
        }
    }

    fn draw(&self, renderer: &PictureRenderer, kept_frames: u32) -> Picture {
        let size = [64, 36];
        let law = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, self.rate_mm_h).unwrap();
        let depth = [0.1, 50.0];
        let view =
            view_of(&self.viewpoint, DVec3::ZERO, size, depth, 1.0 / 60.0, &Default::default()).unwrap();
        let visible = RainField::new(&law, 3).unwrap().visible(&view, self.time_s).unwrap();
        let medium =
            RainMedium::new(&law, &visible.resolved, &self.masks, &MediumOptions::default()).unwrap();
        let exposure = Exposure { shutter_s: 1.0 / 60.0, time_s: self.time_s, ..Exposure::default() };
        let rain = RainOptions { medium, exposure, capture_size: 64, ..RainOptions::default() };
        let options = PictureOptions { size, grid: 1, seed: self.seed, rain, ..PictureOptions::default() };
        let of = PictureUse { plate: PlateUse { kept_frames, ..PlateUse::default() }, tone: None };
        let drops = PictureDrops::Listed(&visible.drops);
        let drawn = renderer.draw_for(of, &self.scene, &self.viewpoint, drops, &self.masks, &options);
        drawn.unwrap().read().unwrap()
    }
}

/// Whatever has changed since the last picture, one by itself is the same to the bit; so is the one after that, in which nothing has but
/// the drops, even if another picture was drawn between.
#[test]
fn light_that_stays_is_that_of_a_picture_by_itself() {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return };
    let [live, own] = [0; 2].map(|_| PictureRenderer::new(&gpu).unwrap());
    let mut shown = Shown::first();
    let mut last = Vec::new();
    for change in 0..6 {
        match change {
            0 => {}
            1 => shown.rate_mm_h = 30.0,
            2 => shown.scene = scene(60.0),
            3 => shown.masks = DropMasks::trace(1.31).unwrap(),
            // Far enough that all around is traced at once.
            4 => shown.viewpoint.eye.x += 1.5,
            _ => shown.viewpoint.fov_y *= 1.1,
        }
        for step in 0..4 {
            shown.time_s += 0.1;
            if step == 2 {
                // A picture that keeps nothing, such as that of a flash.
                Shown { scene: scene(500.0), rate_mm_h: 200.0, ..shown.clone() }.draw(&live, 0);
            }
            let (found, expected) = (shown.draw(&live, 1), shown.draw(&own, 0));
            assert!(found.clean == expected.clean && found.environment == expected.environment);
            let apart = found.rain.iter().zip(&expected.rain).filter(|(a, b)| a != b).count();
            assert!(apart == 0, "change {change}, step {step}: {apart} of {} pixels", expected.rain.len());
            assert!(step > 0 || found.rain != last, "change {change} shows");
            last = found.rain;
        }
    }
}

/// The light of unresolved rain stays: a picture that would draw other rays to lamps shows those of the first.
#[test]
fn light_stays_while_nothing_changes() {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return };
    let [live, own] = [0; 2].map(|_| PictureRenderer::new(&gpu).unwrap());
    let first = Shown::first();
    let other = Shown { seed: 5, ..first.clone() };
    let before = first.draw(&live, 1);
    assert!(other.draw(&live, 1).rain == before.rain);
    assert!(other.draw(&own, 1).rain != before.rain, "other rays differ");
}

/// A picture without drops after one with drops has none.
#[test]
fn no_drop_stays() {
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return };
    let [live, own] = [0; 2].map(|_| PictureRenderer::new(&gpu).unwrap());
    let before = Shown { time_s: 1.0, rate_mm_h: 200.0, ..Shown::first() };
    let dry = Shown { rate_mm_h: 0.0, ..before.clone() };
    assert!(before.draw(&live, 0).drawn.len() > 1);
    let (found, expected) = (dry.draw(&live, 0), dry.draw(&own, 0));
    assert!(found.drawn.is_empty() && expected.drawn.is_empty());
    assert!(found.rain == expected.rain && found.rain.iter().all(|pixel| *pixel == [0.0, 0.0, 0.0, 1.0]));
}
